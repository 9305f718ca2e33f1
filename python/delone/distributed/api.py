"""The two functions to begin with: `plan` says what a run will need, `triangulate` does it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_choice, as_count, as_flag
from delone.distributed.arguments import as_callback, as_classes, as_names, as_path
from delone.distributed.read.opened import TiledDelaunay, open
from delone.distributed.run.costs import Plan, estimate
from delone.distributed.run.executors import Executor, Processes, Serial
from delone.distributed.run.run import Progress, Run
from delone.distributed.run.sources import Choice, find
from delone.distributed.store.files import Store
from delone.errors import InputError
from delone.extras import require
from delone.georeference import as_crs

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

__all__ = ["plan", "triangulate"]

# Numbers of rows are stored in 64 bits, and read back with a sign.
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
) -> TiledDelaunay:
    """Triangulate more points than memory holds, in tiles whose union is the one triangulation.

    Parameters
    ----------
    source : path, sequence of paths, or array_like of shape (n, 2) or (n, 3)
        LAS, LAZ (COPC, too), Parquet, npy or what else `delone.io.read_points` reads: a file, a
        glob, a folder of Parquet files, several of these; or an array, with heights in a third
        column.
    output : path
        A folder, new or of an interrupted run.
    tile_points : int, optional
        Points in a tile, on average, from 3 to 2^27. A worker needs some 200 bytes for each.
    executor : {"serial", "processes"} or dask.distributed.Client, optional
        Who works: this process, with all cores; one process for each core, which ends with this
        one; a Dask cluster whose machines see the folder of the output.
    resume : bool, optional
        Whether to go on with an interrupted run of the same source and arguments. Tiles that are
        finished are not done again.
    columns, classes, attributes
        As in `delone.io.read_points`; attributes, which must be numbers, go to the vertices.
    nan : {"raise", "drop"}, optional
        What to do with rows whose x, y or height is NaN or infinite: refuse them by number, or
        leave them out. Attributes are carried as they are, NaN included; so are heights that come
        as an attribute.
    progress : callable, optional
        Is told how far the run is, as `Progress`.
    crs : str, int or pyproj.CRS, optional
        The reference system of the coordinates, by default that of the files. Nothing is
        transformed.

    Returns
    -------
    TiledDelaunay
        The finished output, as `open` returns it.

    Raises
    ------
    InputError
        An argument is none of its choices; the output holds something else; files have different
        reference systems.
    DtypeError
        An argument is of the wrong type.
    NonFiniteError
        Coordinates or heights are NaN or infinite, and `nan` is ``"raise"``; ``error.rows`` has
        the first.
    DegenerateInputError
        The points span no area.
    FileFormatError, FileNotFoundError
        A file is missing, torn, or lacks a column.
    MissingExtraError
        pyarrow is not installed (extra ``dask``), or a library that reads the source.
    OSError
        The output cannot be written; a full disk says so. What is done is kept.
    BusyError
        Another run is at work in this output.
    DeloneError
        The scheduler or too many workers are gone. What is done is kept.

    Notes
    -----
    The plane is cut by a k-d tree over a sample. A tile triangulates its points, those of strips
    around it and the corners of the hull, and keeps each triangle whose closed circumdisk, rounded
    outward, holds no unknown space. About the others it asks the tiles that the disks meet, which
    tell points in conflict, found exactly; what they tell is inserted in the part of the tile that
    is still open, until none is. As ties go by coordinates, all tiles agree, and the union is the
    triangulation that `delone.Delaunay` makes, triangle for triangle. The proof is in the
    documentation, under mathematics.

    Memory is that of one tile for each worker, whatever the number of points, but for the corners
    of the hull, which each tile gets. On disk a run needs some 120 bytes a point, of which half
    stay. The folder holds ``manifest.json``, which is written last, ``vertices/tile=*.parquet`` and
    ``triangles/tile=*.parquet``.

    Examples
    --------
    >>> import tempfile
    >>> from delone import Delaunay, datasets, distributed
    >>> from delone.testing import same_triangles
    >>> points = datasets.uniform(1000)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     tin = distributed.triangulate(points, folder + "/tin", tile_points=250)
    ...     same_triangles(tin.simplices(), Delaunay(points).simplices)
    True
    """
    nan = as_choice(nan, ("raise", "drop"), name="nan")
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
    return open(folder)


def plan(
    source: Any,
    *,
    tile_points: int = 2_000_000,
    workers: int = 1,
    columns: Sequence[str | int] | None = None,
    classes: Sequence[int] | None = None,
    attributes: Sequence[str] = (),
) -> Plan:
    """Say what a run will need, from what files announce and from measured constants.

    Parameters
    ----------
    source
        As in `triangulate`; or the number of points.
    tile_points : int, optional
        Points in a tile.
    workers : int, optional
        Tasks at a time.
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
    >>> distributed.plan(10**12).tiles
    500000
    """
    size = _tile_points(tile_points)
    if as_count(workers, name="workers") < 1:
        raise InputError(f"workers must be at least 1, got {workers}")
    choice = _choice(columns, classes, attributes)
    if isinstance(source, int | np.integer):
        count = as_count(int(source) if isinstance(source, np.integer) else source, name="source")
        if count > _ROWS:
            raise InputError(f"source must be at most {_ROWS} points, which 63 bits number")
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
        raise InputError(f"{clash[0]!r} is a column of its own, not to be named among attributes")
    return Choice(
        None if columns is None else as_names(columns, name="columns", places=True),
        None if classes is None else as_classes(classes),
        names,
    )


def _tile_points(tile_points: int) -> int:
    size = as_count(tile_points, name="tile_points")
    if not 3 <= size <= 1 << 27:
        raise InputError(f"tile_points must be from 3 to {1 << 27}, got {size}")
    return size


_EXECUTORS: dict[str, Callable[[], Executor]] = {"serial": Serial, "processes": Processes}


def _executor(executor: Any) -> Executor:
    if isinstance(executor, Serial | Processes):
        return executor
    if isinstance(executor, str) and executor in _EXECUTORS:
        return _EXECUTORS[executor]()
    # Who has a client has imported its library.
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
