"""The entry points: `plan` estimates the resources of a run, `triangulate` performs it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_callback, as_choice, as_count, as_flag, as_least
from delone._base.extras import require
from delone._base.georeference import as_crs, is_geographic, warn_of_degrees
from delone.distributed.arguments import as_classes, as_names, as_path
from delone.distributed.read.opened import TiledDelaunay, open
from delone.distributed.run.costs import Plan, estimate
from delone.distributed.run.executors import Executor, Processes, Serial
from delone.distributed.run.run import Progress, Run
from delone.distributed.run.sources import Choice, find
from delone.distributed.store.files import Store
from delone.errors import InputError

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

__all__ = ["plan", "triangulate"]

# Row numbers are stored as 64 bits and read back as signed integers.
_ROWS = (1 << 63) - 1


def triangulate(
    source: Any,
    output: str | os.PathLike[str],
    *,
    tile_points: int = 2_000_000,
    executor: Any = "serial",
    resume: bool = True,
    columns: Sequence[str | int] | None = None,
    classes: Sequence[int] | None = None,
    attributes: Sequence[str] = (),
    nan: str = "raise",
    progress: Callable[[Progress], None] | None = None,
    crs: Any = None,
    planar: bool = False,
) -> TiledDelaunay:
    """Triangulate more points than fit into memory, in tiles that form one triangulation.

    Parameters
    ----------
    source : path, sequence of paths, or array_like of shape (n, 2) or (n, 3)
        LAS, LAZ (including COPC), Parquet, npy or anything else that `delone.io.read_points` reads:
        a file, a glob, a folder of Parquet files, or several of these; or an array, with heights in
        a third column.
    output : path
        A new folder, or that of an interrupted run.
    tile_points : int, optional
        Points in a tile, on average, from 3 to 2^27. A worker needs about 200 bytes for each point.
    executor : {"serial", "processes"} or dask.distributed.Client, optional
        The executor of the tasks: this process, with all cores; one process per core, which ends
        with this one; or a Dask cluster whose machines can access the output folder.
    resume : bool, optional
        Whether to resume an interrupted run with the same source and arguments. Finished tiles are
        not recomputed.
    columns, classes, attributes
        As in `delone.io.read_points`; attributes, which must be numeric, go to the vertices.
    nan : {"raise", "drop"}, optional
        What to do with rows whose x, y or height is NaN or infinite: raise an error that names
        them, or drop them. Attributes are copied unchanged, including NaN; so are heights that are
        given as an attribute.
    progress : callable, optional
        Called regularly with a `Progress`.
    crs : str, int or pyproj.CRS, optional
        The reference system of the coordinates, by default that of the files. Nothing is
        transformed.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Returns
    -------
    TiledDelaunay
        The finished output, as `open` returns it.

    Raises
    ------
    InputError
        An argument is not one of its choices; the output folder does not contain such a run; the
        files have different reference systems.
    DtypeError
        An argument has the wrong type.
    NonFiniteError
        Coordinates or heights are NaN or infinite, and `nan` is ``"raise"``; ``error.rows`` has the
        first rows.
    DegenerateInputError
        The points span no area.
    FileFormatError, FileNotFoundError
        A file is missing, truncated, or lacks a column.
    MissingExtraError
        pyarrow is not installed (extra ``dask``), or a library for reading the source.
    OSError
        The output cannot be written, because the disk is full, for example. Finished work is kept.
    BusyError
        Another run is using this output.
    DeloneError
        The scheduler, or too many workers, were lost. Finished work is kept.

    Warns
    -----
    GeographicWarning
        The reference system has longitudes and latitudes. The warning is issued when the run has
        finished and the range of the coordinates is known.

    Notes
    -----
    The plane is partitioned by a k-d tree over a sample. A tile triangulates its points, those of
    strips around it and the corners of the hull, and keeps each triangle whose closed circumdisk,
    rounded outward, contains no unknown area. For the other triangles it queries the tiles that
    their disks meet. These return points in conflict, found exactly, which are inserted into the
    open part of the tile until no triangle is open. Because ties are broken by coordinates, all
    tiles agree, and the union is the triangulation that `delone.Delaunay` computes, triangle for
    triangle. The proof is in the documentation, under mathematics.

    Memory is that of one tile per worker, whatever the number of points, plus the corners of the
    hull, which every tile receives. On disk, a run needs about 120 bytes per point; half of this
    remains. The folder contains ``manifest.json``, which is written last,
    ``vertices/tile=*.parquet`` and ``triangles/tile=*.parquet``.

    Examples
    --------
    >>> import tempfile
    >>> from delone import Delaunay, datasets, distributed
    >>> from delone.testing import same_triangles
    >>> points = datasets.uniform(1000)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     tin = distributed.triangulate(points, folder + "/tin", tile_points=250)
    ...     same_triangles(tin.read_simplices(), Delaunay(points).simplices)
    True
    """
    nan = as_choice(nan, ("raise", "drop"), name="nan")
    planar = as_flag(planar, name="planar")
    folder = as_path(output, name="output")
    tell = as_callback(progress, name="progress") or _silent
    go_on = as_flag(resume, name="resume")
    require("pyarrow", extra="dask", what="triangulating in tiles")
    size = _tile_points(tile_points)
    worker = _executor(executor)
    choice = _choice(columns, classes, attributes)
    found = find(source, choice)
    if crs is not None:
        system = as_crs(crs)
        found = replace(found, crs=system, identity=found.identity | {"crs": system})
    run = Run(Store(folder), found, choice, size, nan, worker, tell)
    try:
        run.go(go_on)
    finally:
        if isinstance(worker, Processes):
            worker.close()
    made = open(folder)
    by = made.crs if made.crs is not None and is_geographic(made.crs) else None
    warn_of_degrees(source, np.reshape(made.bounds, (2, 2)), planar=planar or by is None, by=by)
    return made


def plan(
    source: Any,
    *,
    tile_points: int = 2_000_000,
    workers: int = 1,
    columns: Sequence[str | int] | None = None,
    classes: Sequence[int] | None = None,
    attributes: Sequence[str] = (),
) -> Plan:
    """Estimate the resources of a run, from the headers of files and measured constants.

    Parameters
    ----------
    source
        As in `triangulate`; or the number of points.
    tile_points : int, optional
        Points in a tile.
    workers : int, optional
        Number of concurrent tasks.
    columns, classes, attributes
        As in `triangulate`.

    Returns
    -------
    Plan
        Tiles, tasks, memory, disk, time.

    Raises
    ------
    InputError, FileFormatError, FileNotFoundError
        As in `triangulate`.

    Examples
    --------
    >>> from delone import distributed
    >>> distributed.plan(10**12).ntiles
    500000
    """
    size = _tile_points(tile_points)
    as_least(workers, 1, name="workers")
    choice = _choice(columns, classes, attributes)
    if isinstance(source, int | np.integer):
        count = as_count(int(source) if isinstance(source, np.integer) else source, name="source")
        if count > _ROWS:
            raise InputError(f"source must have at most {_ROWS} points (63 bits)")
    else:
        count = find(source, choice).count
    return estimate(count, size, workers, len(choice.attributes))


def _choice(
    columns: Sequence[str | int] | None,
    classes: Sequence[int] | None,
    attributes: Sequence[str],
) -> Choice:
    names = as_names(attributes, name="attributes")
    clash = sorted({"id", "x", "y", "z", "owned"} & set(names))
    if clash:
        raise InputError(
            f"{clash[0]!r:.80} is a column of its own and cannot be one of the attributes"
        )
    return Choice(
        None if columns is None else as_names(columns, name="columns", places=True),
        None if classes is None else as_classes(classes),
        names,
    )


def _tile_points(tile_points: int) -> int:
    size = as_least(tile_points, 3, name="tile_points")
    if not 3 <= size <= 1 << 27:
        raise InputError(f"tile_points must be from 3 to {1 << 27}, got {size}")
    return size


_EXECUTORS: dict[str, Callable[[], Executor]] = {"serial": Serial, "processes": Processes}


def _executor(executor: Any) -> Executor:
    if isinstance(executor, Serial | Processes):
        return executor
    if isinstance(executor, str) and executor in _EXECUTORS:
        return _EXECUTORS[executor]()
    # A caller with a client has already imported its library.
    library = sys.modules.get("distributed")
    if library is None or not isinstance(executor, library.Client):
        raise InputError(
            f"executor must be {' or '.join(map(repr, _EXECUTORS))} or a dask.distributed.Client, "
            f"got {executor!r:.60}"
        )
    from delone.distributed.run.dask import DaskExecutor

    return DaskExecutor(executor)


def _silent(_: Progress) -> None:
    pass
