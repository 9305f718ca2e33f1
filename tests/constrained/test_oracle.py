"""The oracle: what is right passes, and each kind of damage is caught and named.

Right triangulations come from the reference in plain Python, so that nothing here needs the core.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, datasets
from delone.errors import InputError
from delone.reference import constrained_delaunay
from delone.reference.constrained import meeting
from delone.testing import ConstrainedArrays, assert_constrained_delaunay, assert_regions

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def ring(first: int, count: int) -> list[tuple[int, int]]:
    return [(first + k, first + (k + 1) % count) for k in range(count)]


def nested() -> tuple[Any, Any]:
    """A square in a square with points between, beside and on the edges of both."""
    outer = [(0, 0), (12, 0), (12, 12), (0, 12)]
    inner = [(3, 3), (9, 3), (9, 9), (3, 9)]
    rest = [(6, 3), (6, 0), (1, 5), (5, 6), (7, 7), (6, 8), (10, 2), (2, 11), (14, 6), (5, 6)]
    return outer + inner + rest, [*ring(0, 4), *ring(4, 4), (4, 8), (5, 4), (11, 17), (7, 7)]


def monotone(seed: int) -> tuple[Any, Any]:
    """A zigzag through random points from left to right, which cannot cross itself."""
    points = datasets.uniform(60, seed=seed)
    order = np.argsort(points[:, 0])[::3]
    return points, list(pairwise(order.tolist()))


def lattice() -> tuple[Any, Any]:
    points = datasets.grid(49, seed=1)
    at = {tuple(np.round(p, 9)): row for row, p in enumerate(points.tolist())}
    rows = [at[key] for key in sorted(at)]
    return points, [(rows[0], rows[9]), (rows[48], rows[14]), (rows[3], rows[24])]


CASES = {"nested": nested(), "zigzag": monotone(4), "zigzag 2": monotone(5), "lattice": lattice()}


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> tuple[ConstrainedArrays, Any]:
    points, segments = CASES[request.param]
    made = constrained_delaunay(points, segments)
    return ConstrainedArrays.of(points, *made), segments


def refused(
    mesh: ConstrainedArrays, segments: Any, words: str | None = None, **options: Any
) -> None:
    with pytest.raises(AssertionError, match=words):
        assert_constrained_delaunay(mesh, segments, **options)


def sources_of(mesh: ConstrainedArrays) -> dict[tuple[int, int], list[int]]:
    indptr, rows = mesh.segment_source
    return {
        tuple(edge): np.asarray(rows)[start:end].tolist()
        for edge, (start, end) in zip(
            np.asarray(mesh.segments).tolist(), pairwise(np.asarray(indptr).tolist()), strict=True
        )
    }


def again(mesh: ConstrainedArrays, **changes: Any) -> ConstrainedArrays:
    """The same with other triangles or sources, and what follows from them."""
    simplices = changes.get("simplices", mesh.simplices)
    return ConstrainedArrays.of(mesh.points, simplices, changes.get("sources", sources_of(mesh)))


def test_right_ones_pass(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    assert_constrained_delaunay(mesh, segments)
    assert_constrained_delaunay(mesh, np.array(segments, dtype=np.uint16), canonical=False)
    assert_constrained_delaunay(mesh, segments, split=True, tolerance=0.0)
    assert_constrained_delaunay(mesh, segments, complete=False)


def test_every_flip_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    neighbors = np.asarray(mesh.neighbors)
    simplices = np.asarray(mesh.simplices)
    flips = 0
    for t, k in np.argwhere(neighbors > np.arange(len(neighbors))[:, None]).tolist():
        s = int(neighbors[t, k])
        p, u, v = (int(simplices[t, (k + i) % 3]) for i in range(3))
        (q,) = set(simplices[s].tolist()) - {u, v}
        after = simplices.copy()
        after[t], after[s] = (p, u, q), (q, v, p)
        refused(again(mesh, simplices=after), segments)
        flips += 1
    assert flips > 10


def test_every_wrong_flag_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    flags = np.asarray(mesh.constrained)
    for t, k in np.ndindex(flags.shape):
        damaged = flags.copy()
        damaged[t, k] ^= True
        word = "but not flagged" if flags[t, k] else "but is not a subsegment"
        refused(mesh._replace(constrained=damaged), segments, f"{word}.*:\n  triangle {t}: edge")


def test_an_edge_flagged_on_both_sides_is_caught() -> None:
    mesh = ConstrainedArrays.of(SQUARE, *constrained_delaunay(SQUARE, []))
    flags = [(False, True, False), (False, False, True)]
    refused(mesh._replace(constrained=flags), [], "2 edge sides are flagged")


def test_every_swapped_neighbour_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    neighbors = np.asarray(mesh.neighbors)
    for t in range(len(neighbors)):
        damaged = neighbors.copy()
        damaged[t] = np.roll(damaged[t], 1)
        refused(mesh._replace(neighbors=damaged), segments, f"wrong neighbors:\n  triangle {t}:")


def test_every_dropped_or_turned_triangle_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    for t in range(len(np.asarray(mesh.simplices))):
        simplices = np.asarray(mesh.simplices)
        refused(again(mesh, simplices=np.delete(simplices, t, axis=0)), segments)
        turned = simplices.copy()
        turned[t] = turned[t, ::-1]
        refused(again(mesh, simplices=turned), segments, "counter-clockwise")


def test_every_missing_subsegment_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    for edge in sources_of(mesh):
        rest = {other: rows for other, rows in sources_of(mesh).items() if other != edge}
        # Where the edge is not Delaunay, it is that which is said first.
        refused(again(mesh, sources=rest), segments, "not covered from end to end")
        refused(again(mesh, sources=rest), segments, "not covered", split=True)


def test_every_wrong_source_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    for edge, rows in sources_of(mesh).items():
        for row in range(len(segments)):
            changed = sorted(set(rows) ^ {row})
            words = "covered|line of its row|a subsegment without a row"
            refused(again(mesh, sources=sources_of(mesh) | {edge: changed}), segments, words)


def test_a_surplus_subsegment_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    for t in np.asarray(mesh.simplices).tolist():
        for edge in pairwise(sorted(t)):
            if edge not in sources_of(mesh):
                surplus = again(mesh, sources=sources_of(mesh) | {edge: [0]})
                refused(surplus, segments, "not on the line of its row")


def test_a_segment_that_is_nowhere_is_caught(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, segments = case
    last = len(segments)
    refused(mesh, [*segments, (1, 2)], f"segment is not covered from end to end:\n  row {last}: ")
    assert_constrained_delaunay(mesh, [*segments, (2, 2)])


def test_subsegments_joined_over_a_vertex_are_caught() -> None:
    points, segments = [*SQUARE, (2, 2)], [(0, 2)]
    mesh = ConstrainedArrays.of(points, *constrained_delaunay(points, segments))
    refused(again(mesh, sources={(0, 2): [0]}), segments, "not an edge of a triangle")
    assert_constrained_delaunay(again(mesh, sources={(4, 0): [0], (2, 4): [0]}), segments)
    doubled = mesh._replace(
        segments=[(0, 4), (2, 4), (4, 2)], segment_source=([0, 1, 2, 3], [0, 0, 0])
    )
    refused(doubled, segments, "listed more than once")


def test_a_tie_under_segments_is_named() -> None:
    points = [*SQUARE, (6, 2)]
    made = constrained_delaunay(points, [(1, 2)])
    mesh = ConstrainedArrays.of(points, *made)
    other = again(mesh, simplices=[(0, 1, 3), (1, 2, 3), (1, 4, 2)])
    assert_constrained_delaunay(other, [(1, 2)], canonical=False)
    refused(other, [(1, 2)], r"1 edge is not canonical.*\n  edge 1 .*, 3 ")


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (([0, 1, 2], [0, 0]), "does not match 1 subsegment"),
        (([0, 0], []), "a subsegment without a row"),
        (([1, 1], [0]), "a subsegment without a row"),
        (([0, 2], [0]), "a subsegment without a row"),
        (([0, 1], [3]), "outside 0 to 2"),
        (([0, 2], [1, 0]), "are not ascending"),
        (([0, 2], [1, 1]), "not ascend"),
    ],
)
def test_sources_are_checked(source: Any, words: str) -> None:
    points, segments = SQUARE, [(0, 2), (2, 0), (1, 1)]
    mesh = ConstrainedArrays.of(points, *constrained_delaunay(points, segments))
    assert_constrained_delaunay(mesh, segments)
    refused(mesh._replace(segment_source=source), segments, words)


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("segments", [(0, 4)], "outside the rows 0 to 3:\n  subsegment 0"),
        ("segments", [(0.0, 2.0)], "mesh.segments must hold integers"),
        ("segments", [(0, 2, 1)], r"mesh.segments must have shape \(q, 2\)"),
        ("constrained", [[0, 1, 0], [0, 0, 1]], "constrained must contain booleans"),
        ("constrained", [[True, False, False]], "constrained must have shape"),
        ("neighbors", [[-1, 1, -1]], "neighbors must have shape"),
        ("simplices", [(0, 1, 9), (0, 2, 3)], "outside the rows"),
    ],
)
def test_arrays_are_checked(field: str, value: Any, words: str) -> None:
    mesh = ConstrainedArrays.of(SQUARE, *constrained_delaunay(SQUARE, [(0, 2)]))
    refused(mesh._replace(**{field: value}), [(0, 2)], words)


def test_given_segments_are_checked() -> None:
    mesh = ConstrainedArrays.of(SQUARE, *constrained_delaunay(SQUARE, [(0, 2)]))
    refused(mesh, [(0, 4)], "segment 0: ")
    refused(mesh, [(0.0, 2.0)], "segments must hold integers")
    with pytest.raises(InputError, match="NaN"):
        assert_constrained_delaunay(
            mesh._replace(points=[(0, 0), (np.nan, 0), (1, 1), (0, 1)]), [(0, 2)]
        )


def split_pair(slack: float = 0.0) -> tuple[ConstrainedArrays, list[tuple[int, int]], float]:
    """Two segments that cross off the lattice of doubles; the crossing is moved by some slack."""
    points = [(0.0, 0.0), (1.0, 0.1), (0.0, 0.2), (1.0, 0.3)]
    segments = [(0, 3), (1, 2)]
    x, y = meeting(*(points[v] for v in (0, 3, 1, 2)))
    points.append((x, y + slack))
    pieces = [(0, 4), (3, 4), (1, 4), (2, 4)]
    triangles = constrained_delaunay(points, pieces).triangles
    sources = dict(zip(pieces, ([0], [0], [1], [1]), strict=True))
    return ConstrainedArrays.of(points, triangles, sources), segments, slack


def test_a_split_crossing_may_be_off_by_rounding_alone() -> None:
    mesh, segments, _ = split_pair()
    refused(mesh, segments, "not on the line")
    assert_constrained_delaunay(mesh, segments, split=True)
    refused(mesh, segments, "more than 0.0 away", split=True, tolerance=0.0)
    mesh, segments, slack = split_pair(2.0**-45)
    refused(mesh, segments, "subsegments are more than .* away from its row", split=True)
    assert_constrained_delaunay(mesh, segments, split=True, tolerance=slack)
    refused(mesh, segments, "away", split=True, tolerance=slack / 2)


def test_a_vertex_beyond_the_end_of_its_row_is_far() -> None:
    points = [(0, 0), (2, 0), (4, 0), (1, 3)]
    mesh = ConstrainedArrays.of(points, *constrained_delaunay(points, [(0, 2)]))
    refused(mesh, [(0, 1)], "1 subsegment is more than 1.9 away", split=True, tolerance=1.9)


@pytest.mark.parametrize(
    "chain",
    [
        [(0, 4)],  # ends half way
        [(0, 4), (4, 2), (4, 1)],  # has a branch
        [(0, 4), (4, 2), (0, 1), (1, 2)],  # goes twice
        [(0, 4), (4, 1)],  # ends elsewhere
        [(0, 4), (2, 3)],  # has a gap
        [(0, 1), (1, 4), (4, 0)],  # goes round
    ],
)
def test_a_chain_that_is_no_path_is_caught(chain: list[tuple[int, int]]) -> None:
    points = [*SQUARE, (2, 2)]
    triangles = constrained_delaunay(points, []).triangles
    mesh = ConstrainedArrays.of(points, triangles, {edge: [0] for edge in chain})
    refused(mesh, [(0, 2)], "not covered from end to end", split=True, tolerance=100.0)


def areas(mesh: ConstrainedArrays) -> np.ndarray:
    """Areas by union of triangles across edges without flags."""
    neighbors, flags = np.asarray(mesh.neighbors), np.asarray(mesh.constrained)
    label = np.arange(len(neighbors))
    for _ in label:
        for t, k in np.argwhere((neighbors >= 0) & ~flags):
            label[t] = label[neighbors[t, k]] = min(label[t], label[neighbors[t, k]])
    return label


def test_removed_areas_leave_a_boundary_of_subsegments() -> None:
    points, segments = nested()
    mesh = ConstrainedArrays.of(points, *constrained_delaunay(points, segments))
    label = areas(mesh)
    hole = label == label[[set(t) >= {12, 13} for t in np.asarray(mesh.simplices).tolist()]][0]
    assert 0 < hole.sum() < len(hole) and len(set(label.tolist())) == 3
    holed = again(mesh, simplices=np.asarray(mesh.simplices)[~hole])
    assert_constrained_delaunay(holed, segments, complete=False)
    refused(holed, segments, "not a vertex of any triangle|boundary")
    for t in range(len(np.asarray(holed.simplices))):
        if not ((np.asarray(holed.neighbors)[t] >= 0) & ~np.asarray(holed.constrained)[t]).any():
            continue  # an area of its own, or a hull edge on each side that is open
        torn = again(holed, simplices=np.delete(np.asarray(holed.simplices), t, axis=0))
        refused(torn, segments, "neither a subsegment nor", complete=False)


def test_regions_are_told_apart(case: tuple[ConstrainedArrays, Any]) -> None:
    mesh, _ = case
    label = areas(mesh)
    assert_regions(mesh, label)
    assert_regions(mesh, 7 - label)
    if len(set(label.tolist())) > 1:
        with pytest.raises(AssertionError, match="label of another area"):
            assert_regions(mesh, np.zeros_like(label))
    for t in range(len(label)):
        if (label == label[t]).sum() > 1:
            damaged = label.copy()
            damaged[t] = label.max() + 1
            with pytest.raises(AssertionError, match="not have the label of its area"):
                assert_regions(mesh, damaged)


def test_regions_of_seeds() -> None:
    points, segments = nested()
    mesh = ConstrainedArrays.of(points, *constrained_delaunay(points, segments))
    inside = (
        areas(mesh)
        == areas(mesh)[[set(t) >= {12, 13} for t in np.asarray(mesh.simplices).tolist()]][0]
    )
    beyond = areas(mesh) == areas(mesh)[[16 in t for t in np.asarray(mesh.simplices).tolist()]][0]
    # Off the hull, on a segment, on its end, within, within again, between, on a vertex beyond.
    seeds = [(13, 13), (3, 5), (9, 9), (5, 5), (7, 5), (1.0, 1.0), (14, 6)]
    wanted = np.where(inside, 3, np.where(beyond, 6, 5))
    assert_regions(mesh, wanted, seeds=seeds)
    assert_regions(mesh, np.where(inside, 9, -1), seeds=seeds[:5], seed_labels=[1, 1, 1, 9, 1])
    with pytest.raises(AssertionError, match="wrong label"):
        assert_regions(mesh, np.where(inside, 4, np.where(beyond, 6, 5)), seeds=seeds)
    with pytest.raises(AssertionError, match="labels must have shape"):
        assert_regions(mesh, wanted[:-1])


@pytest.mark.parametrize("seed", range(4))
def test_regions_are_numbered_by_their_smallest_triangles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(-4, 5, (40, 2)), axis=0).astype(float)
    points = points[rng.permutation(len(points))]
    chosen = rng.permutation(len(points) - 1)[: 2 * seed + 3]
    segments = np.column_stack((chosen, chosen + 1))
    whole = ConstrainedDelaunay(points, segments, crossing="split")
    holed = ConstrainedDelaunay(
        points,
        segments,
        crossing="split",
        holes=whole.points[whole.simplices[0]].mean(axis=0)[None],
    )
    for mesh in (whole, holed):
        corners = [sorted(mesh.points[t].tolist()) for t in mesh.simplices]
        seen: list[int] = []
        for t in sorted(range(len(corners)), key=corners.__getitem__):
            if mesh.region[t] not in seen:
                seen.append(int(mesh.region[t]))
        assert seen == list(range(len(seen)))
        other = mesh.neighbors
        same = mesh.region[:, None] == mesh.region[other]
        assert same[(other >= 0) & ~mesh.constrained].all()
