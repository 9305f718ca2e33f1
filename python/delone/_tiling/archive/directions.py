"""Checks of the arrays of files with triangulations of directions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._tiling.archive.checks import check_range, check_segments, require
from delone._tiling.plane.topology import boundary_edges, boundary_next, neighbors

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "check_constrained",
    "check_delaunay",
    "check_grid",
    "check_overlaps",
    "check_sites",
]


def check_sites(**arrays: NDArray[Any]) -> None:
    """Check vectors, the radius, the unit of angles, and the clip."""
    _check_vectors(arrays["vectors"])
    radius, winding = arrays["radius"], arrays["winding"]
    require(len(radius) == 1 and 0 < radius[0] < np.inf, "radius is not one positive number")
    require(len(arrays["degrees"]) == 1, "degrees is not one flag")
    require(len(winding) == 1 and winding[0] in (0, 1, 2), "winding is unknown")
    corners, sides = arrays["corners"], arrays["sides"]
    for name in ("geometries", "outer"):
        require(len(arrays[name]) == len(sides), f"{name} and sides do not match")
    check_range("geometries", arrays["geometries"], 0, 2**31)
    check_range("sides", sides, 0, len(corners))
    if len(corners):
        _check_vectors(corners)
        require(len(sides) > 0, "corners have no sides")


def check_overlaps(**arrays: NDArray[Any]) -> None:
    """Check compressed rows of positive areas, and the areas and shapes of both grids."""
    indptr, indices, areas = arrays["indptr"], arrays["indices"], arrays["areas"]
    sources, targets = arrays["source_areas"], arrays["target_areas"]
    require(len(indptr) == len(targets) + 1, "indptr and target_areas do not match")
    require(indptr[0] == 0 and indptr[-1] == len(areas), "indptr does not partition areas")
    require((np.diff(indptr) >= 0).all(), "indptr descends")
    require(len(indices) == len(areas), "indices and areas do not match")
    check_range("indices", indices, 0, len(sources))
    for name, cells in (("source", sources), ("target", targets)):
        sums, shape = arrays[f"{name}_sums"], arrays[f"{name}_shape"]
        require(len(sums) == len(cells), f"{name}_sums and {name}_areas do not match")
        fits = len(shape) > 0 and (shape >= 0).all() and (shape <= len(cells)).all()
        require(fits and int(np.prod(shape)) == len(cells), f"{name}_shape does not fit")
        if f"{name}_turned" in arrays:
            check_range(f"{name}_turned", arrays[f"{name}_turned"], 0, len(cells))
        for values in (cells, sums):
            require(bool((np.isfinite(values) & (values >= 0)).all()), f"{name}: a wrong area")
    require(bool((np.isfinite(areas) & (areas > 0)).all()), "an area is not positive")


def check_grid(**arrays: NDArray[Any]) -> None:
    """Check that starts partition corners or meridians, and that shape, mask and edges fit."""
    shape, mask = arrays["shape"], arrays["mask"]
    require(0 < len(shape) < 4 and bool((shape >= 0).all()), "shape is not a shape of cells")
    count = math.prod(shape.tolist())
    if "meridians" in arrays:
        tangents, starts, numbers = (arrays[name] for name in ("places", "starts", "numbers"))
        require(len(starts) == len(tangents) + 1, "starts and tangents do not match")
        _check_starts("starts", starts, len(arrays["meridians"]), least=2)
        require(len(numbers) == len(arrays["meridians"]), "numbers and meridians do not match")
        require(len(tangents) > 0, "it has no rows")
        require(bool((tangents[:, 0] < tangents[:, 1]).all()), "a row has no height")
        require(bool(np.isfinite(arrays["meridians"]).all()), "a coordinate is not finite")
        check_range("numbers", numbers, -1, count)
        # Each cell is one run of columns of its row; the last meridian of a row has none.
        used = numbers >= 0
        used[starts[1:] - 1] = False
        used[1:] &= (numbers[1:] != numbers[:-1]) | ~used[:-1]
        cells = np.sort(numbers[used])
        require(np.array_equal(cells, np.arange(count)), "numbers has cells of no or several runs")
    else:
        _check_starts("rings", arrays["rings"], len(arrays["places"]))
        _check_starts("cells", arrays["cells"], len(arrays["rings"]) - 1)
        require(len(arrays["holes"]) == len(arrays["rings"]) - 1, "holes and rings do not match")
        require(len(arrays["cells"]) == count + 1, "shape and cells do not match")
        _check_vectors(arrays["places"])
    require(len(mask) in {0, count}, "mask and shape do not match")
    given = arrays["centers"]
    require(len(given) in {0, count}, "centers and shape do not match")
    require(bool(np.isfinite(given).all()), "a center is not finite")
    inside = (given >= (-1080, -90)) & (given <= (1080, 90))
    require(bool(inside.all()), "a center is beyond a pole")
    edges = [len(arrays[name]) for name in ("rows", "columns")]
    fits = edges == [0, 0] or [size - 1 for size in edges] == shape.tolist()
    require(fits, "rows and columns do not fit the shape")
    for name in ("rows", "columns"):
        steps = np.diff(arrays[name])
        require(bool((steps > 0).all() or (steps < 0).all()), f"{name} do not ascend or descend")
    merged = arrays["merged"]
    require(len(merged) == 1 and merged[0] >= 0, "merged is not one count")


def _check_starts(name: str, starts: NDArray[Any], count: int, *, least: int = 0) -> None:
    """Check that numbers partition that many entries into parts of at least a given size."""
    whole = len(starts) > 0 and starts[0] == 0 and starts[-1] == count
    require(bool(whole and (np.diff(starts) >= least).all()), f"{name} is not a partition")


def check_delaunay(**arrays: NDArray[Any]) -> None:
    """Check triangles that tile the sphere or a hull on it."""
    _check_triangles(**arrays)
    options = arrays["options"]
    require(len(options) == 1 and options[0] in (0, 1), "options is not one flag")


def check_constrained(**arrays: NDArray[Any]) -> None:
    """Check the triangles as those of a Delaunay triangulation, and that arcs fit them."""
    _check_triangles(**arrays)
    options, n = arrays["options"], len(arrays["vectors"])
    limits = 1, 2, n
    valid = len(options) == 3 and (options >= 0).all() and (options <= limits).all()
    require(valid and options[2] > 0, "its options are invalid")
    check_segments(arrays | {"points": arrays["vectors"]}, int(options[2]))
    require(len(arrays["outer"]) == len(arrays["rings"]), "outer and rings do not match")
    require((arrays["rings"] | ~arrays["outer"]).all(), "outer has a side that is not of a ring")


def _check_triangles(**arrays: NDArray[Any]) -> None:
    vectors, simplices, duplicates = (
        arrays[name] for name in ("vectors", "simplices", "duplicates")
    )
    n, m = len(vectors), len(simplices)
    _check_vectors(vectors)
    require(m > 0, "it has no triangles")
    require(arrays["neighbors"].shape == simplices.shape, "it has no neighbors of triangles")
    check_range("simplices", simplices, 0, n)
    check_range("duplicates", duplicates, 0, n)
    tail, head = (simplices[:, k].ravel().astype(np.int64) for k in ([1, 2, 0], [2, 0, 1]))
    keys = np.sort(tail * n + head)
    require((keys[1:] > keys[:-1]).all(), "simplices has an edge twice")
    expected = neighbors(simplices, n)
    require((arrays["neighbors"] == expected).all(), "neighbors are not those of simplices")
    a, b, c = (vectors[simplices[:, k]] for k in range(3))
    require((_core.orient3d(np.zeros_like(a), a, b, c) > 0).all(), "a triangle is turned over")
    h = _sides(boundary_edges(simplices, expected))
    triangles = 2 * (n - len(duplicates)) - (h + 2 if h else 4)
    require(m == triangles, f"it has {m} triangles, {triangles} are expected")
    _check_duplicates(vectors, simplices, duplicates)


def _sides(boundary: NDArray[np.int32]) -> int:
    """Return the number of sides of a boundary, which must be one cycle or nothing."""
    if len(boundary):
        cycle = boundary_next(boundary, int(boundary[0, 0]))
        require(len(cycle) == len(boundary), "the boundary is not one cycle")
    return len(boundary)


def _check_vectors(vectors: NDArray[np.float64]) -> None:
    require(len(vectors) > 0, "it has no vectors")
    require(np.isfinite(vectors).all(), "a coordinate is not finite")
    require(vectors.any(axis=1).all(), "a vector is zero")


def _check_duplicates(
    vectors: NDArray[np.float64], simplices: NDArray[np.int32], duplicates: NDArray[np.int32]
) -> None:
    row, first = duplicates.T
    require((row[1:] > row[:-1]).all() and (first < row).all(), "duplicates are out of order")
    a, b = vectors[row], vectors[first]
    same = (np.sign(a) == np.sign(b)).all()
    for pair in ([0, 1], [1, 2], [2, 0]):
        one, other = (np.ascontiguousarray(each[:, pair]) for each in (a, b))
        same = same and not _core.orient2d(np.zeros_like(one), one, other).any()
    require(same, "a duplicate has another direction")
    is_vertex = np.zeros(len(vectors), dtype=bool)
    is_vertex[simplices] = True
    others = np.ones(len(vectors), dtype=bool)
    others[row] = False
    require((is_vertex == others).all(), "vertices and duplicates are not all the vectors")
