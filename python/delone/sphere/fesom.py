"""Meshes of FESOM in text files, and cells around the nodes of meshes: the median dual."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_simplices
from delone.errors import FileFormatError, InputError
from delone.sphere.coordinates import units_of

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows
    from delone.sphere.grid_report import GridReport

__all__ = ["median_dual", "read_text"]


def read_text(folder: str | os.PathLike[str]) -> tuple[Floats, Rows]:
    """Return longitudes and latitudes in degrees, and triangles, of nod2d.out and elem2d.out."""
    nodes = _table(Path(folder) / "nod2d.out", 4)
    triangles = _table(Path(folder) / "elem2d.out", 3)
    order = nodes[:, 0] - 1
    if not np.array_equal(np.sort(order), np.arange(len(nodes))):
        raise FileFormatError(f"nod2d.out: nodes must have the numbers 1 to {len(nodes)}")
    lonlat = np.empty((len(nodes), 2))
    lonlat[order.astype(np.int64)] = nodes[:, 1:3]
    numbers = (triangles - 1).astype(np.int64)
    return lonlat, as_simplices(numbers, len(lonlat), 2, name="elem2d.out").astype(np.int64)


def _table(path: Path, columns: int) -> Floats:
    """Return the rows of a file whose first line is their number."""
    try:
        with path.open(encoding="utf-8") as file:
            count = int(file.readline())
            found = np.loadtxt(file, ndmin=2)
    except ValueError as error:
        raise FileFormatError(f"{path.name} must be a table of numbers: {error}") from error
    if found.shape != (count, columns):
        raise FileFormatError(
            f"{path.name} must have {count} rows of {columns} numbers, got {found.shape}"
        )
    return found


def median_dual(
    vectors: Floats, corners: Rows, starts: Rows, report: GridReport
) -> tuple[Any, ...]:
    """Return the arrays of the core for cells around the nodes of polygons.

    Polygons are rows of `corners`, as compressed rows, with the `report` of a grid of them: some
    run clockwise, and some have no area and take no part. The corners of a cell are the middles of
    the polygons and of the edges around its node, and at the boundary the node itself.
    """
    places = units_of(vectors, None)
    sums = np.zeros((len(starts) - 1, 3))
    lengths = np.diff(starts)
    of = np.repeat(np.arange(len(lengths)), lengths)
    for axis in range(3):
        sums[:, axis] = np.bincount(of, places[corners, axis], len(lengths))
    middles = units_of(sums, None) if len(sums) else sums
    # Around each node, the edge before and after each of its polygons, counterclockwise.
    steps: list[dict[int, tuple[int, int]]] = [{} for _ in places]
    every, ends = corners.tolist(), starts.tolist()
    turned, empty = set(report.reversed.tolist()), set(report.empty.tolist())
    for t in range(len(lengths)):
        if t in empty:
            continue
        row = every[ends[t] : ends[t + 1]]
        if t in turned:
            row.reverse()
        for k, node in enumerate(row):
            one, other = row[(k + 1) % len(row)], row[k - 1]
            if one in steps[node]:
                raise InputError(
                    f"cells {steps[node][one][1]} and {t} overlap: both are on one side of the "
                    f"edge of nodes {node} and {one}"
                )
            steps[node][one] = other, t
    return _joined(places, middles, steps)


def _joined(
    places: Floats, middles: Floats, steps: list[dict[int, tuple[int, int]]]
) -> tuple[Any, ...]:
    """Return the rings around nodes."""
    corners: list[NDArray[np.float64]] = []
    rings, cells = [0], [0]
    for node, around in enumerate(steps):
        # Chains of polygons; each begins at the boundary if it reaches it.
        first = sorted(set(around) - {other for other, _ in around.values()})
        while around:
            start = first.pop() if first else min(around)
            at, open_ = start, start not in {other for other, _ in around.values()}
            ring = [places[node]] if open_ else []
            while at in around:
                ring.append(places[node] + places[at])
                at, t = around.pop(at)
                ring.append(middles[t])
            if open_:
                ring.append(places[node] + places[at])
            corners.extend(ring)
            rings.append(rings[-1] + len(ring))
        cells.append(len(rings) - 1)
    found = units_of(np.array(corners).reshape(-1, 3), None)
    starts = np.array(rings, dtype=np.int64), np.array(cells, dtype=np.int64)
    return (found, *starts, np.zeros(len(rings) - 1, dtype=np.bool_))
