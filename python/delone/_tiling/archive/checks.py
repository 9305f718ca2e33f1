"""Checks of the arrays of a file, in linear time: everything that methods rely on.

Reading trusts nothing: every index is checked against its range, and simplices against each other,
so that walks in the core terminate and stay inside. Whether simplices are Delaunay is not checked:
``validate()`` proves it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.duplicates import first_rows
from delone._tiling.plane.topology import (
    among,
    boundary_edges,
    boundary_next,
    edge_keys,
    half_edges,
    unjoined,
)
from delone._tiling.space.locking import sides
from delone._tiling.space.topology import boundary_faces

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

__all__ = [
    "ContradictionError",
    "check_bands",
    "check_constrained",
    "check_contours",
    "check_delaunay",
    "check_diagram",
    "check_graph",
    "check_input",
    "check_kept",
    "check_live",
    "check_mesh",
    "check_range",
    "check_segments",
    "check_shape",
    "check_surface",
    "check_tetrahedra",
    "require",
]


class ContradictionError(Exception):
    """The arrays of a file contradict each other."""


def require(condition: bool | np.bool_, message: str) -> None:
    """Raise a ContradictionError where a condition does not hold."""
    if not condition:
        raise ContradictionError(message)


def check_delaunay(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    duplicates: NDArray[np.int32],
) -> None:
    """Check simplices that tile a convex hull."""
    n, m = len(points), len(simplices)
    _check_simplices(points, simplices, neighbors)
    check_range("duplicates", duplicates, 0, n)
    _check_duplicates(points, simplices, duplicates)
    if points.shape[1] > 3:
        require((neighbors < 0).any(), "it has no boundary")
        return
    if points.shape[1] == 3:
        _check_closed(boundary_faces(simplices, neighbors), n, convex=True)
        return
    boundary = boundary_edges(simplices, neighbors)
    require(len(boundary) > 0, "it has no boundary")
    cycle = boundary_next(boundary, int(boundary[0, 0]))
    require(len(cycle) == len(boundary), "the boundary is not one cycle")
    expected = 2 * (n - len(duplicates)) - len(boundary) - 2
    require(m == expected, f"it has {m} triangles, {expected} are expected")


def check_surface(**arrays: NDArray[Any]) -> None:
    """Check triangles with heights that tile a convex hull, of which some are kept, and lines."""
    points, simplices = arrays["points"], arrays["all_simplices"]
    none = np.empty((0, 2), dtype=np.int32)
    check_delaunay(points, simplices, arrays["all_neighbors"], none)
    require(len(arrays["z"]) == len(points), "heights and points do not match")
    require(np.isfinite(arrays["z"]).all(), "a height is not finite")
    require(len(arrays["kept"]) == len(simplices), "kept and triangles do not match")
    require(arrays["kept"].any(), "it has no triangle")
    check_range("breaklines", arrays["breaklines"], 0, len(points))
    require(len(arrays["soft"]) == len(arrays["breaklines"]), "soft and breaklines do not match")
    ends = simplices[:, [[1, 2], [2, 0], [0, 1]]]
    edges = edge_keys(ends[..., 0], ends[..., 1], len(points)).ravel()
    a, b = arrays["breaklines"].T
    lines = edge_keys(a, b, len(points))
    require(among(lines, edges).all(), "a breakline is not an edge")


def check_tetrahedra(**arrays: NDArray[Any]) -> None:
    """Check tetrahedra with any boundary, their regions and input faces, and their report."""
    points, simplices, neighbors = arrays["points"], arrays["simplices"], arrays["neighbors"]
    _check_simplices(points, simplices, neighbors)
    _check_joined(simplices, neighbors)
    _check_closed(boundary_faces(simplices, neighbors), len(points))
    require(len(arrays["region"]) == len(simplices), "regions and tetrahedra do not match")
    _check_faces(**arrays)
    added = int(arrays["added"][0])
    if len(arrays["refinement"]):
        added -= _check_refinement(**arrays)
    if len(arrays["recovery"]):
        _check_recovery(most=added, **arrays)
    if not len(arrays["counts"]) and (len(arrays["recovery"]) or len(arrays["refinement"])):
        return
    require(len(arrays["weights"]) == len(points), "weights and points do not match")
    require((arrays["weights"] >= 0).all(), "weights are not numbers of at least 0")
    _check_improvement(**arrays)


def _check_faces(**arrays: NDArray[Any]) -> None:
    """Check that input faces are faces of tetrahedra, and the number of added points."""
    points, faces = arrays["points"], arrays["input_faces"]
    check_range("input_faces", faces, 0, len(points))
    check_range("face_source", arrays["face_source"], 0, 2**31)
    for name in ("face_source", "face_markers"):
        require(len(arrays[name]) == len(faces), f"{name} and input_faces do not match")
    require(np.isfinite(arrays["holes"]).all(), "a seed of a hole is not finite")
    require(len(arrays["added"]) == 1, "added is not one number")
    check_range("added", arrays["added"], 0, len(points) + 1)
    found = sides(arrays["simplices"], faces, len(points)).face
    require(len(np.unique(found[found >= 0])) == len(faces), "an input face is not in the mesh")


def _check_refinement(**arrays: NDArray[Any]) -> int:
    """Check the report of a refinement, and return how many points it added."""
    counts, bounds = arrays["refinement"], arrays["refinement_bounds"]
    require(len(counts) == 5 and len(bounds) == 4, "the report is incomplete")
    check_range("refinement", counts, 0, 2**31)
    require(counts[4] <= 1, "refinement does not end with a flag")
    require((bounds >= 0).all(), "refinement_bounds contains a value below 0")
    for name in ("too_large", "above_ratio"):
        check_range(name, arrays[name], 0, len(arrays["simplices"]))
        require((np.diff(arrays[name]) > 0).all(), f"{name} is out of order")
    added = int(counts[:4].sum())
    require(added <= arrays["added"][0], "the report counts other added points")
    return added


def _check_recovery(*, most: int, **arrays: NDArray[Any]) -> None:
    """Check the report of a recovery, which added at most that many points."""
    require(len(arrays["recovery"]) == 11, "the report is incomplete")
    check_range("recovery", arrays["recovery"], 0, 2**63)
    require(arrays["recovery"][0] <= most, "the report counts other added points")
    check_range("duplicate_points", arrays["duplicate_points"], 0, len(arrays["points"]))
    check_range("recut", arrays["recut"], 0, len(arrays["points"]))
    check_range("recut_source", arrays["recut_source"], 0, 2**31)
    require(
        len(arrays["recut"]) == len(arrays["recut_source"]), "recut and recut_source do not match"
    )
    check_range("imprinted", arrays["imprinted"], 0, 2**31)
    largest = arrays["imprint_distance"]
    require(len(largest) == 1 and np.isfinite(largest).all(), "the report is incomplete")
    require((largest >= 0).all(), "imprint_distance is below 0")
    for name in ("subdivided", "repeated", "degenerate", "dangling", "outside"):
        check_range(name, arrays[name], 0, 2**31)
        require((np.diff(arrays[name]) > 0).all(), f"{name} is out of order")


def _check_improvement(**arrays: NDArray[Any]) -> None:
    """Check the report of an improvement; its angles are not measured again."""
    angles, counts, bounds = arrays["angles"], arrays["counts"], arrays["bounds"]
    classes = len(bounds) - 1
    require(len(arrays["before"]) == len(arrays["after"]) == classes, "histograms do not match")
    require(len(arrays["below"]) == len(arrays["cause"]), "rows and causes do not match")
    require(len(angles) == 5 and len(counts) == 12, "the report is incomplete")
    # The goal, then the smallest angle before and after, then the largest before and after.
    require(
        (angles >= 0).all() and (angles <= 180).all(), "angles contains a value outside 0 to 180"
    )
    require((angles[1:3] <= angles[3:]).all(), "in angles, a smallest one is above the largest")
    require((bounds >= 0).all() and (bounds[1:] > bounds[:-1]).all(), "bounds are out of order")
    check_range("counts", counts, 0, 2**63)
    require(counts[11] <= 1, "counts does not end with a flag")
    bound = arrays["surface_distance"]
    require(len(bound) == 1 and np.isfinite(bound).all(), "the report is incomplete")
    require((bound >= 0).all(), "surface_distance is below 0")
    require(counts[7] <= arrays["added"][0], "an improvement added more points than there are")
    for name in ("before", "after"):
        check_range(name, arrays[name], 0, 2**63)
    nsimplex = len(arrays["simplices"])
    require(arrays["after"].sum() == nsimplex, "after does not count all tetrahedra")
    check_range("below", arrays["below"], 0, nsimplex)
    require((np.diff(arrays["below"]) > 0).all(), "below is out of order")
    check_range("cause", arrays["cause"], 0, 6)
    edges = arrays["wall_edges"]
    require(len(edges) == len(arrays["below"]), "wall_edges and below do not match")
    check_range("wall_edges", edges, -1, len(arrays["points"]))
    walls = arrays["cause"] == 0
    require((edges[~walls] == -1).all(), "wall_edges has an edge for another cause")
    known = (edges[walls] >= 0).all() and (edges[walls, 0] < edges[walls, 1]).all()
    require(known, "wall_edges does not have the ends of each edge in order")


def check_input(**arrays: NDArray[Any]) -> None:
    """Check input from which the results are recomputed."""
    require(len(arrays["points"]) > 0, "it has no points")
    require(np.isfinite(arrays["points"]).all(), "a coordinate is not finite")


def check_shape(**arrays: NDArray[Any]) -> None:
    """Check the input from which a shape is recomputed."""
    check_input(**arrays)
    alpha = arrays["alpha"]
    require(len(alpha) == 1 and not np.isnan(alpha).any(), "alpha is not one number")
    negative = bool(alpha[0] < 0)
    require(
        not negative or len(arrays["weights"]) > 0, "alpha is negative, and there are no weights"
    )


def check_kept(
    points: NDArray[np.float64],
    simplices: NDArray[np.int32],
    neighbors: NDArray[np.int32],
    kept: NDArray[np.bool_],
) -> None:
    """Check simplices, some of which are kept; points that span nothing have none."""
    require(len(kept) == len(simplices), "kept and simplices do not match")
    if len(simplices):
        _check_simplices(points, simplices, neighbors)
        _check_joined(simplices, neighbors)
    else:
        require(np.isfinite(points).all(), "a coordinate is not finite")
        require(not len(neighbors), "it has neighbors but no simplices")


def check_contours(**arrays: NDArray[Any]) -> None:
    """Check lines with levels."""
    points, level, levels = arrays["points"], arrays["level"], arrays["levels"]
    _check_starts("starts", arrays["starts"], len(points), len(level), 2)
    require(len(arrays["index"]) == len(level), "index and lines do not match")
    require(np.isfinite(levels).all() and (np.diff(levels) > 0).all(), "levels are out of order")
    require(np.isin(level, levels).all(), "a line has a level that does not exist")
    _check_counts(points, arrays["counts"], 4)


def check_bands(**arrays: NDArray[Any]) -> None:
    """Check polygons between heights."""
    points, rings, polygons = (arrays[name] for name in ("points", "ring_starts", "polygon_starts"))
    low, high = arrays["low"], arrays["high"]
    _check_starts("ring_starts", rings, len(points), len(rings) - 1, 4)
    _check_starts("polygon_starts", polygons, len(rings) - 1, len(low), 1)
    require((points[rings[:-1]] == points[rings[1:] - 1]).all(), "a ring is not closed")
    require(len(high) == len(low), "low and high do not match")
    require(np.isfinite(low).all() and np.isfinite(high).all(), "a height is not finite")
    require((low <= high).all(), "a range is empty")
    _check_counts(points, arrays["counts"], 4)


def _check_starts(name: str, starts: NDArray[np.int64], end: int, count: int, least: int) -> None:
    """Check the starts of parts, each of which has at least that many entries."""
    require(
        len(starts) == count + 1 and count >= 0, f"{name} does not have one start for each part"
    )
    require(starts[0] == 0 and starts[-1] == end, f"{name} does not run from 0 to {end}")
    require((np.diff(starts) >= least).all(), f"{name} has a part of fewer than {least}")


def _check_counts(points: NDArray[np.float64], counts: NDArray[np.int64], length: int) -> None:
    """Check that points are finite, and the counts of what is left out."""
    require(np.isfinite(points).all(), "a coordinate is not finite")
    require(len(counts) == length and (counts >= 0).all(), f"counts is not {length} numbers")


def check_live(**arrays: NDArray[Any]) -> None:
    """Check points and segments with their handles."""
    points, handles, segments = arrays["points"], arrays["handles"], arrays["segments"]
    require(np.isfinite(points).all(), "a coordinate is not finite")
    require(len(arrays["numbers"]) == 3, "its numbers are incomplete")
    total, split, segments_total = arrays["numbers"].tolist()
    require(split in (0, 1), "whether crossings are split is not a flag")
    for name, given, end, items in (
        ("handles", handles, total, len(points)),
        ("segments", segments, segments_total, len(arrays["ends"])),
    ):
        require(0 <= end < 2**32 - 1, f"{name} has a next number that is out of range")
        check_range(name, given, 0, end)
        require((np.diff(given) > 0).all(), f"{name} is out of order")
        require(len(given) == items, f"{name} does not have {items} entries")
    require((np.diff(arrays["added"]) > 0).all(), "added is out of order")
    require(np.isin(arrays["added"], handles).all(), "added has a handle that does not exist")
    ends = arrays["ends"].ravel()
    own = handles[~np.isin(handles, arrays["added"])]
    require(np.isin(ends, own).all(), "a segment has an end that does not exist")
    flat = points.shape[1] == 2
    require(flat or not len(segments) + segments_total + split, "it has segments in 3-D")


def check_diagram(**arrays: NDArray[Any]) -> None:
    """Check the sites of a diagram, and its clip."""
    check_input(**arrays)
    ndim = arrays["points"].shape[1]
    require(len(arrays["weights"]) in (0, len(arrays["points"])), "weights and points do not match")
    require(len(arrays["periods"]) in (0, 2), "it does not have two periods")
    require(len(arrays["box"]) in (0, 2 * ndim), "the box is incomplete")
    shape = "outline" if ndim == 2 else "corners"
    require(not (len(arrays["box"]) and len(arrays[shape])), "it has two clips")
    if ndim == 3:
        _check_polyhedron(*(arrays[name] for name in ("corners", "starts", "faces", "planes")))


def check_graph(
    points: NDArray[np.float64],
    edges: NDArray[np.int32],
    duplicates: NDArray[np.int32],
    directed: NDArray[np.bool_],
) -> None:
    """Check the edges of a graph, and which rows are duplicates."""
    require(np.isfinite(points).all(), "a coordinate is not finite")
    check_range("edges", edges, 0, len(points))
    require(len(directed) == 1, "directed is not one flag")
    tail, head = edges.T.astype(np.int64)
    require((tail != head).all(), "an edge joins a point to itself")
    require(bool(directed[0]) or (tail < head).all(), "an edge has the larger row first")
    require((np.diff(tail << 32 | head) > 0).all(), "edges are out of order")
    first = first_rows(points) if len(points) else np.empty(0, dtype=np.int64)
    rows = np.flatnonzero(first != np.arange(len(points)))
    expected = np.column_stack((rows, first[rows]))
    require(np.array_equal(duplicates, expected), "duplicates are not those of points")


# The plane of a face contains its corners up to this fraction of the products that are summed.
_ROUNDING = 2.0**-40


def _check_polyhedron(
    corners: NDArray[np.float64],
    starts: NDArray[np.int32],
    faces: NDArray[np.int32],
    planes: NDArray[np.float64],
) -> None:
    """Check that faces close a surface, and that the planes match them."""
    if not len(planes):
        empty = len(corners) == len(starts) == len(faces) == 0
        require(empty, "the polyhedron has no planes")
        return
    require(np.isfinite(corners).all() and np.isfinite(planes).all(), "the clip is not finite")
    require(len(starts) == len(planes) + 1, "faces and planes do not match")
    require(starts[0] == 0 and starts[-1] == len(faces), "faces are out of range")
    require((np.diff(starts) > 2).all(), "a face has fewer than three corners")
    check_range("faces", faces, 0, len(corners))
    following = np.arange(1, len(faces) + 1)
    following[starts[1:] - 1] = starts[:-1]
    closed = _is_closed(faces, faces[following], len(corners), once=True)
    require(closed, "the clip is not one closed surface")
    normal, offset = (np.repeat(each, np.diff(starts), axis=0) for each in np.split(planes, [3], 1))
    with np.errstate(all="ignore"):
        terms = np.column_stack((normal * corners[faces], -offset))
        near = np.abs(terms.sum(axis=1)) <= _ROUNDING * np.abs(terms).sum(axis=1)
    require(near.all(), "a plane does not contain its face")


def _check_simplices(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> None:
    """Check ranges, then that neighbors are mutual and simplices positively oriented."""
    require(np.isfinite(points).all(), "a coordinate is not finite")
    require(len(simplices) > 0, "it has no simplices")
    require(neighbors.shape == simplices.shape, "it has simplices but no neighbors")
    check_range("simplices", simplices, 0, len(points))
    check_range("neighbors", neighbors, -1, len(simplices))
    _check_sound(points, simplices, neighbors)


def _check_joined(simplices: NDArray[np.int32], neighbors: NDArray[np.int32]) -> None:
    """Check that simplices with a common side are neighbors; a convex boundary implies this."""
    rows = unjoined(simplices, neighbors)
    if len(rows):
        kind = "triangle" if simplices.shape[1] == 3 else "tetrahedron"
        raise ContradictionError(f"{kind} {rows[0]} has neighbors that are not mutual")


def _check_closed(boundary: NDArray[np.int32], npoints: int, *, convex: bool = False) -> None:
    require(len(boundary) > 3, "it has no boundary")
    closed = _is_closed(boundary.ravel(), boundary[:, [1, 2, 0]].ravel(), npoints, once=convex)
    require(closed, "the boundary is not one closed surface")


def _is_closed(
    tail: NDArray[np.int32], head: NDArray[np.int32], npoints: int, *, once: bool
) -> bool:
    """Return whether edges occur equally often in both directions, and, if required, once."""
    tail, head = tail.astype(np.int64), head.astype(np.int64)
    keys, reverse = np.sort(tail * npoints + head), np.sort(head * npoints + tail)
    return bool((keys == reverse).all() and (not once or (keys[1:] > keys[:-1]).all()))


def _check_sound(
    points: NDArray[np.float64], simplices: NDArray[np.int32], neighbors: NDArray[np.int32]
) -> None:
    """Check that neighbors are mutual and simplices positively oriented, given their range."""
    fault = _core.fault(points, simplices, neighbors, as_workers(None))
    if fault is None:
        return
    (kind, row), flat = fault, points.shape[1] == 2
    simplex = {2: "triangle", 3: "tetrahedron"}.get(points.shape[1], "simplex")
    turn = "is not counter-clockwise" if flat else "is not positively oriented"
    wrong = "has neighbors that are not mutual" if kind == "neighbors" else turn
    raise ContradictionError(f"{simplex} {row} {wrong}")


def check_range(name: str, indices: NDArray[np.int32], lowest: int, end: int) -> None:
    """Check that indices are at least `lowest` and below `end`."""
    inside = indices.size == 0 or (indices.min() >= lowest and indices.max() < end)
    require(inside, f"{name} has an index outside {lowest} to {end - 1}")


def _check_duplicates(
    points: NDArray[np.float64], simplices: NDArray[np.int32], duplicates: NDArray[np.int32]
) -> None:
    row, first = duplicates.T
    require((row[1:] > row[:-1]).all() and (first < row).all(), "duplicates are out of order")
    require((points[row] == points[first]).all(), "a duplicate lies elsewhere")
    vertex = np.zeros(len(points), dtype=bool)
    vertex[simplices] = True
    other = np.ones(len(points), dtype=bool)
    other[row] = False
    require((vertex == other).all(), "vertices and duplicates are not all the points")


def check_constrained(**arrays: NDArray[Any]) -> None:
    """Check the triangles as those of `Delaunay`, and that segments fit them."""
    names = ("points", "simplices", "neighbors", "duplicates")
    check_delaunay(**{name: arrays[name] for name in names})
    _check_options(arrays["options"])
    points = arrays["points"]
    ninput = len(points) - len(arrays["added"])
    require(ninput > 0 and (arrays["added"] == points[ninput:]).all(), "added points lie elsewhere")
    check_segments(arrays, ninput, conforming=bool(arrays["options"][3]))
    seeds = np.concatenate((arrays["holes"], arrays["regions"]))
    require(np.isfinite(seeds).all(), "a seed is not finite")
    require(len(arrays["parts"]) == len(arrays["input"]), "geometries and segments do not match")
    check_range("parts", arrays["parts"], -1, 2**31 - 1)
    check_range("labels", arrays["labels"], 0, 2**31)
    require(len(arrays["regions"]) == len(arrays["labels"]), "seeds and labels do not match")


def check_segments(
    arrays: Mapping[str, NDArray[Any]], ninput: int, *, conforming: bool = False
) -> None:
    """Check that segments, of which the last points were added, fit the triangles."""
    n, m = len(arrays["points"]), len(arrays["simplices"])
    require(arrays["constrained"].shape == (m, 3), "it has no edge flags")
    check_range("input", arrays["input"], 0, ninput)
    check_range("segments", arrays["segments"], 0, n)
    _check_flags(arrays)
    _check_sources(arrays)
    rows = len(arrays["input"])
    for name, indices, end in (
        ("zero", arrays["zero"], rows),
        ("through", arrays["through"][:, 0], rows),
        ("through", arrays["through"][:, 1], n),
        ("crossings", arrays["crossings"][:, :2], rows),
        ("crossings", arrays["crossings"][:, 2], n),
    ):
        check_range(name, indices, 0, end)
    _check_vertices(arrays, ninput, conforming)
    geometries, rings = arrays["geometries"], arrays["rings"]
    require(len(geometries) == len(rings) == rows, "geometries and segments do not match")
    require((geometries[rings] >= 0).all(), "the side of a ring has no geometry")
    check_range("geometries", geometries, -1, 2**31)


def _check_options(options: NDArray[np.int64]) -> None:
    limits = 2, 1, 1, 1, 2**31 - 1
    valid = len(options) == 5 and (options >= 0).all() and (options <= limits).all()
    require(valid, "its options are invalid")


def _check_flags(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Check that the flagged edges are the subsegments, each once."""
    simplices, segments, n = arrays["simplices"], arrays["segments"], len(arrays["points"])
    edges = edge_keys(simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]], n)
    keys = np.sort(edge_keys(segments[:, 0], segments[:, 1], n))
    require((keys[1:] > keys[:-1]).all(), "a subsegment is repeated")
    require((among(edges, keys) == arrays["constrained"]).all(), "edge flags are wrong")
    require(among(keys, edges.ravel()).all(), "a subsegment is not an edge")


def _check_sources(arrays: Mapping[str, NDArray[Any]]) -> None:
    start, source = arrays["source_start"], arrays["source"]
    require(
        len(start) == len(arrays["segments"]) + 1 and start[0] == 0 and start[-1] == len(source),
        "sources of segments are out of range",
    )
    require((np.diff(start) > 0).all(), "a segment has no source")
    require(len(arrays["forward"]) == len(source), "directions of segments are out of range")
    check_range("source", source, 0, len(arrays["input"]))


def _check_vertices(arrays: Mapping[str, NDArray[Any]], ninput: int, conforming: bool) -> None:
    """Check that rows contain the listed vertices, and that the others were added."""
    through, crossings = arrays["through"], arrays["crossings"]
    n = len(arrays["points"])
    first = np.arange(n)
    first[arrays["duplicates"][:, 0]] = arrays["duplicates"][:, 1]
    row = np.repeat(arrays["source"].astype(np.int64), 2)
    owner = np.repeat(np.arange(len(arrays["segments"])), np.diff(arrays["source_start"]))
    contained = np.sort(row * n + arrays["segments"][owner].ravel())
    for name, rows, vertices in (
        ("through", through[:, 0], through[:, 1]),
        ("crossings", crossings[:, 0], crossings[:, 2]),
        ("crossings", crossings[:, 1], crossings[:, 2]),
    ):
        keys = rows.astype(np.int64) * n + first[vertices]
        require(among(keys, contained).all(), f"{name} has a vertex that its row does not contain")
    require((crossings[:, 0] < crossings[:, 1]).all(), "crossings has a row that crosses itself")
    known = np.zeros(n, dtype=bool)
    known[first[crossings[:, 2]]] = True
    require(conforming or known[ninput:].all(), "added has a point that is not in crossings")
    known[ninput:] = True
    known[first[np.concatenate((arrays["input"].ravel(), through[:, 1]))]] = True
    require(known[arrays["segments"]].all(), "added lacks a vertex of a segment")


def check_mesh(**arrays: NDArray[Any]) -> None:
    """Check triangles that need not fill a hull, and lines under their edges."""
    points, simplices, neighbors = arrays["points"], arrays["simplices"], arrays["neighbors"]
    n, m, lines = len(points), len(simplices), len(arrays["ends"])
    _check_simplices(points, simplices, neighbors)
    _check_joined(simplices, neighbors)
    require(arrays["sides"].shape == simplices.shape, "it has no triangle sides")
    for name, indices, least, end in (
        ("sides", arrays["sides"], -1, lines),
        ("on", arrays["on"], -1, lines),
        ("ends", arrays["ends"], 0, n),
        ("point_source", arrays["point_source"], -1, 2**31),
        ("source", arrays["source"], 0, 2**31),
        ("counts", arrays["counts"], 0, 2**63),
    ):
        check_range(name, indices, least, end)
    for wanted, names in (
        (m, ("region",)),
        (n, ("on", "point_source", "point_markers")),
        (lines, ("frozen", "line_markers", "line_geometries")),
        (len(arrays["source"]), ("forward",)),
        (lines + 1, ("start",)),
        (4, ("counts",)),
        (1, ("bound",)),
        (0, ("duplicates",)),
    ):
        for name in names:
            require(len(arrays[name]) == wanted, f"{name} does not have {wanted} entries")
    start = arrays["start"]
    require(start[0] == 0 and start[-1] == len(arrays["source"]), "sources are out of range")
    require((np.diff(start) >= 0).all(), "sources are out of order")
    require((arrays["bound"] >= 0).all() and (arrays["bound"] < 60).all(), "its angle is invalid")
    vertex = np.zeros(n, dtype=bool)
    vertex[simplices] = True
    require(vertex.all(), "a point is not a vertex")
    require(arrays["counts"][3] <= 1, "counts does not end with a flag")
    _check_sides(arrays)
    _check_lines(arrays)


def _check_sides(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Check that neighbors are mutual and agree on the lines and regions between them."""
    simplices, neighbors = arrays["simplices"], arrays["neighbors"]
    sides, region = arrays["sides"], arrays["region"]
    inner = neighbors >= 0
    require((sides[~inner] >= 0).all(), "the boundary has an edge on no line")
    t, k = np.nonzero(inner)
    across = neighbors[t, k]
    back = (neighbors[across] == t[:, None]) & (
        simplices[across] != simplices[t, (k + 1) % 3][:, None]
    ) & (simplices[across] != simplices[t, (k + 2) % 3][:, None])  # fmt: skip
    other = sides[across, back.argmax(axis=1)]
    require((other == sides[t, k]).all(), "two triangles disagree on the line between them")
    same = (region[across] == region[t]) | (other >= 0)
    require(same.all(), "a region ends where there is no line")


def _check_lines(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Check that subsegments of a line are a path between its ends, over the points on it."""
    on, ends, sides = arrays["on"], arrays["ends"], arrays["sides"]
    n = len(arrays["points"])
    t, k = np.nonzero(sides >= 0)
    line = sides[t, k]
    pair = np.sort(np.column_stack(half_edges(arrays["simplices"], t, k)), axis=1)
    for corner in pair.T:
        known = (on[corner] == line) | (ends[line] == corner[:, None]).any(axis=1)
        require(known.all(), "on and ends lack a point of a line")
    _, once = np.unique(edge_keys(pair[:, 0], pair[:, 1], n), return_index=True)
    subsegments = np.bincount(line[once], minlength=len(ends))
    points = np.bincount(on[on >= 0], minlength=len(ends))
    require((subsegments == points + 1).all(), "on does not match the subsegments of a line")
    require((arrays["point_source"][on >= 0] < 0).all(), "on has a point of the input")
    require(arrays["counts"][0] >= (on >= 0).sum(), "counts lacks points that lie on segments")
