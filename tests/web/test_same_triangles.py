"""What the module for pages computes is what Python computes, on the whole corpus."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, ConvexHull, Delaunay, DeloneError, Voronoi, _core
from delone.predicates import incircle, orient2d

if TYPE_CHECKING:
    from collections.abc import Callable

    Run = Callable[[list[dict[str, Any]]], list[dict[str, Any]]]

CORPUS = Path(__file__).parents[1] / "corpus"
METHODS = _core.methods2()


def call(name: str, *args: Any) -> dict[str, Any]:
    return {"call": name, "args": list(args)}


def corpus(folder: str = "") -> dict[str, dict[str, Any]]:
    files = sorted((CORPUS / folder).glob("*.json"))
    return {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in files}


def flat(rows: Any) -> list[float]:
    return [float(x) for row in rows for x in row]


def integers(array: Any) -> list[int]:
    return [int(x) for x in np.asarray(array).ravel()]


def random(count: int, ndim: int, seed: int = 1) -> Any:
    return np.random.default_rng(seed).random((count, ndim))


def test_triangles_of_the_corpus(run: Run) -> None:
    cases = corpus()
    points = {name: case["points"] for name, case in cases.items()}
    points["scattered"] = random(2_000, 2).tolist()
    points["larger than a block"] = random(70_000, 2).tolist()
    found = run([call("triangulate", flat(rows)) for rows in points.values()])
    for (name, rows), answer in zip(points.items(), found, strict=True):
        assert "value" in answer, (name, answer)
        value, right = answer["value"], Delaunay(rows)
        assert value["triangles"] == integers(right.simplices), name
        assert value["neighbors"] == integers(right.neighbors), name
        assert value["hull"] == integers(ConvexHull(rows).vertices), name
        repeats = np.flatnonzero(right.duplicate_of != np.arange(len(rows)))
        pairs = [[row, right.duplicate_of[row]] for row in repeats]
        assert value["duplicates"] == integers(pairs), name


def test_all_methods_agree(node: Run) -> None:
    points = random(500, 2)
    found = node([call("triangulate", flat(points), {"method": name}) for name in METHODS])
    right = [integers(Delaunay(points, method=name).simplices) for name in METHODS]
    assert [answer["value"]["triangles"] for answer in found] == right


def test_tetrahedra_of_the_corpus(run: Run) -> None:
    points = {name: case["points"] for name, case in corpus("space").items()}
    points["scattered"] = random(300, 3).tolist()
    found = run([call("tetrahedra", flat(rows)) for rows in points.values()])
    for (name, rows), answer in zip(points.items(), found, strict=True):
        value, right = answer["value"], Delaunay(rows)
        assert value["tetrahedra"] == integers(right.simplices), name
        assert value["neighbors"] == integers(right.neighbors), name
        assert np.array_equal(value["volumes"], right.volumes), name
        assert np.allclose(value["minDihedral"], right.quality().smallest_dihedral), name
        assert np.allclose(value["maxDihedral"], right.quality().largest_dihedral), name
        assert len(value["hull"]) == 3 * (right.neighbors < 0).sum(), name


def rings(case: dict[str, Any]) -> list[int]:
    ends = [*case["rings"][1:], len(case["points"])]
    segments = [
        (i, i + 1 if i + 1 < end else start)
        for start, end in zip(case["rings"], ends, strict=True)
        for i in range(start, end)
    ]
    return integers(segments)


def test_segments_of_the_corpus(run: Run) -> None:
    cases = {name: case for name, case in corpus().items() if "rings" in case and "bad" not in name}
    split = {"crossing": "split"}
    found = run([call("constrain", flat(c["points"]), rings(c), split) for c in cases.values()])
    for (name, case), answer in zip(cases.items(), found, strict=True):
        segments = np.reshape(rings(case), (-1, 2))
        value, right = (
            answer["value"],
            ConstrainedDelaunay(case["points"], segments, crossing="split"),
        )
        assert value["triangles"] == integers(right.simplices), name
        assert value["neighbors"] == integers(right.neighbors), name
        assert value["points"] == right.points.ravel().tolist(), name
        assert value["subsegments"] == integers(right.segments), name
        edges = set(map(tuple, np.sort(right.segments, axis=1).tolist()))
        opposite = right.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        walls = [int(tuple(sorted(edge)) in edges) for edge in opposite.tolist()]
        assert value["constrained"] == walls, name
        assert value["added"] == len(right.points) - len(case["points"]), name


def test_errors_are_those_of_python(run: Run) -> None:
    square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
    cases = {name: case["points"] for name, case in corpus("degenerate").items() if case["points"]}
    found = run([call("triangulate", flat(rows)) for rows in cases.values()])
    for (name, rows), answer in zip(cases.items(), found, strict=True):
        with pytest.raises(DeloneError) as caught:
            Delaunay(rows)
        assert answer["error"] == type(caught.value).__name__, name
        assert answer["message"] == str(caught.value), name
        assert answer["rows"] == caught.value.chain.tolist(), name
    infinite, crossing, method, box = run([
        call("triangulate", [0, 0, 1, "NaN", 1, 1]),
        call("constrain", flat(square), [0, 2, 1, 3]),
        call("triangulate", flat(square), {"method": "magic"}),
        call("voronoi", flat(square), [1, 1, 0, 0]),
    ])  # fmt: skip
    assert (infinite["error"], infinite["rows"]) == ("NonFiniteError", [1])
    assert (crossing["error"], crossing["rows"]) == ("CrossingSegmentsError", [0, 1])
    with pytest.raises(DeloneError) as caught:
        Delaunay([(0, 0), (1, math.nan), (1, 1)])
    assert infinite["message"] == str(caught.value)
    with pytest.raises(DeloneError) as caught:
        ConstrainedDelaunay(square, [(0, 2), (1, 3)])
    assert crossing["message"] == str(caught.value)
    assert (method["error"], box["error"]) == ("InputError", "InputError")


def test_signs_are_exact_beside_plain_ones(run: Run) -> None:
    # Kettner and others: one point in steps of the last place, beside a line through two others.
    step = 2.0**-53
    triples = [
        [0.5 + i * step, 0.5 + j * step, 12.0, 12.0, 24.0, 24.0]
        for i in range(20) for j in range(20)
    ]  # fmt: skip
    corners = np.reshape(triples, (-1, 3, 2))
    right = integers(orient2d(corners[:, 0], corners[:, 1], corners[:, 2]))
    circles = np.concatenate([corners, np.broadcast_to([3.0, 0.25], (len(corners), 1, 2))], axis=1)
    exact = integers(incircle(*circles.transpose(1, 0, 2)))
    found, plain, inside = run([
        call("orientations", flat(triples)),
        call("orientations", flat(triples), {"naive": True}),
        call("incircles", flat(circles.reshape(-1, 8))),
    ])  # fmt: skip
    assert found["value"] == right
    assert inside["value"] == exact
    # The plain formula is wrong for some of them, which is what pages show.
    assert 0 < sum(a != b for a, b in zip(plain["value"], right, strict=True)) < len(right)


def test_ties_of_one_call_are_those_of_many(node: Run) -> None:
    square = [0, 0, 1, 0, 1, 1, 0, 1]
    first = [0, 0, 1, 0, 1, 1]
    found = node([
        call("incircle", *square), call("incircleNaive", *square),
        call("incircleCanonical", *square), call("incirclesCanonical", square * 2),
        call("orient2d", *first), call("orient2dNaive", *first),
        call("incircleCanonical", *square[2:], 0, 0), call("orient2d", *first[:5], "NaN"),
    ])  # fmt: skip
    *values, last, bad = found
    assert [each["value"] for each in values[:3]] == [0, 0, -1]
    assert [each["value"] for each in values[3:]] == [[-1, -1], 1, 1]
    assert last["value"] == 1
    assert bad["error"] == "NonFiniteError"


def test_cells_circles_location_and_statistics(run: Run) -> None:
    points, queries = random(60, 2), random(40, 2, 2) * 1.5 - 0.25
    mesh = Delaunay(points)
    given = {
        "triangles": integers(mesh.simplices),
        "neighbors": integers(mesh.neighbors),
        "duplicates": [],
    }
    xy = flat(points)
    circles, cells, location, statistics, hull = (answer["value"] for answer in run([
        call("circumcircles", xy, given["triangles"]),
        call("voronoi", xy, [-1, -1, 2, 2]),
        call("locate", xy, given, flat(queries)),
        call("statistics", xy, given),
        call("hull", xy),
    ]))  # fmt: skip
    assert circles["centers"] == mesh.circumcenters.ravel().tolist()
    reach = np.linalg.norm(points[mesh.simplices[:, 1]] - mesh.circumcenters, axis=1)
    assert circles["radii"] == pytest.approx(reach.tolist())
    clipped = Voronoi(points, clip=(-1, -1, 2, 2))
    assert np.allclose(cells["areas"], clipped.cell_areas, rtol=1e-13)
    assert sum(cells["areas"]) == pytest.approx(9)
    edges = set(map(tuple, np.sort(mesh.edges, axis=1).tolist()))
    across = {
        tuple(sorted((row, other)))
        for row in range(60)
        for other in cells["across"][cells["starts"][row] : cells["starts"][row + 1]]
        if other >= 0
    }
    assert across <= edges
    assert len(across) > 100
    assert location["triangle"] == integers(mesh.find_simplex(queries))
    inside = np.array(location["triangle"]) >= 0
    weights = np.array(location["weights"], dtype=float).reshape(-1, 3)
    corners = points[mesh.simplices[np.array(location["triangle"])[inside]]]
    assert np.allclose(np.einsum("qk,qkd->qd", weights[inside], corners), queries[inside])
    assert np.isnan(weights[~inside]).all()
    assert 5 < inside.sum() < 35
    distance = np.linalg.norm(points[None] - queries[:, None], axis=2)
    assert location["nearest"] == integers(distance.argmin(axis=1))
    assert statistics["areas"] == mesh.areas.tolist()
    assert statistics["area"] == pytest.approx(mesh.areas.sum())
    angles = mesh.quality().smallest_angle
    assert np.allclose(statistics["angles"], angles, rtol=1e-14)
    assert statistics["minAngle"] == min(statistics["angles"])
    assert statistics["medianAngle"] == pytest.approx(np.median(angles))
    assert (statistics["minArea"], statistics["maxArea"]) == (mesh.areas.min(), mesh.areas.max())
    assert hull == integers(ConvexHull(points).vertices)


def test_refined_meshes_keep_their_bounds(run: Run) -> None:
    outline = [0, 0, 4, 0, 4, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2]
    segments = [0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4]
    options = {"minAngle": 28, "maxArea": 0.1, "holes": [1.5, 1.5]}
    (answer, empty) = run([
        call("mesh", outline, segments, options),
        call("mesh", outline, segments[:6]),
    ])  # fmt: skip
    value = answer["value"]
    corners = np.reshape(value["points"], (-1, 2))[np.reshape(value["triangles"], (-1, 3))]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    assert areas.min() > 0
    assert areas.max() <= 0.1
    assert areas.sum() == pytest.approx(11)
    assert value["complete"]
    assert value["added"] == len(value["points"]) // 2 - 8
    assert (empty["error"], empty["message"][:19]) == ("InputError", "the domain is empty")
