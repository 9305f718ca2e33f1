"""Constrained triangulations of directions against integers: arcs, crossings, and their laws.

An edge is an arc of the input exactly if integers say so, and all others are locally Delaunay with
ties. There is one such triangulation, so this decides about every triangle.
"""

from __future__ import annotations

import itertools
import pickle
import random
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest

import delone
import directions as oracle
from delone import sphere
from delone.sphere.crossings import _along

LATTICE = [v for v in itertools.product((-2, -1, 0, 1, 2), repeat=3) if any(v)]
KINDS = {
    "lattice": lambda n, rng: rng.sample(LATTICE, n),
    "half": lambda n, rng: rng.sample([v for v in LATTICE if v[2] >= 0], n),
    "scattered": lambda n, rng: [tuple(rng.gauss(0, 1) for _ in range(3)) for _ in range(n)],
    "plane": lambda n, rng: [(rng.randint(-3, 3), rng.randint(-3, 3), 4) for _ in range(n)],
}


def is_opposite(a, b):
    return oracle.compare(a, tuple(-x for x in b)) == 0


def place(a, b, p):
    """How far p is along the arc a b, between 0 and 1 if it is inside; None if it is not on it."""
    normal = oracle.cross(a, b)
    if oracle.dot(normal, p):
        return None
    square = oracle.dot(normal, normal)
    # p = x a + y b up to a positive factor.
    x = Fraction(oracle.dot(oracle.cross(p, b), normal), square)
    y = Fraction(oracle.dot(oracle.cross(a, p), normal), square)
    return y / (x + y) if x > 0 and y > 0 else None


def do_cross(a, b, c, d):
    """Whether two arcs have one point in common, inside both; another formula than the core's."""
    m, n = oracle.cross(a, b), oracle.cross(c, d)
    meet = oracle.cross(m, n)
    if not any(meet):
        return False
    both = (meet, tuple(-x for x in meet))
    return any(place(a, b, p) is not None and place(c, d, p) is not None for p in both)


def pieces_of(whole, segments, rows):
    """The edges that the arcs consist of."""
    found = set()
    for i, j in segments:
        a, b = whole[i], whole[j]
        if oracle.compare(a, b) == 0:
            continue
        inside = [(t, v) for v in rows if (t := place(a, b, whole[v])) is not None]
        ends = [next(r for r in rows if oracle.compare(whole[r], x) == 0) for x in (a, b)]
        chain = [ends[0], *(v for _, v in sorted(inside)), ends[1]]
        found |= {frozenset(pair) for pair in pairwise(chain)}
    return found


def some_arcs(whole, count, rng):
    """Random arcs that do not cross, except at directions that are given."""
    arcs = []
    for _ in range(8 * count):
        i, j = rng.randrange(len(whole)), rng.randrange(len(whole))
        if is_opposite(whole[i], whole[j]):
            continue
        if not any(crosses_at_no_vertex(whole, (i, j), other) for other in arcs):
            arcs.append((i, j))
        if len(arcs) == count:
            break
    return arcs


def crosses_at_no_vertex(whole, s, t):
    a, b, c, d = (whole[v] for v in (*s, *t))
    if not do_cross(a, b, c, d):
        return False
    return not any(place(a, b, p) is not None and place(c, d, p) is not None for p in whole)


def check(mesh, segments):
    """The marked edges are the arcs, and no other edge can be flipped."""
    whole = [oracle.whole(v) for v in mesh.vectors.tolist()]
    rows = sorted(set(mesh.duplicate_of.tolist()))
    marked = set()
    for t, corners in enumerate(mesh.simplices.tolist()):
        a, b, c = (whole[v] for v in corners)
        assert oracle.orient(a, b, c) > 0
        for k, beside in enumerate(mesh.neighbors[t].tolist()):
            edge = frozenset((corners[(k + 1) % 3], corners[(k + 2) % 3]))
            if mesh.constrained[t, k]:
                marked.add(edge)
            elif beside >= 0:
                (apex,) = set(mesh.simplices[beside].tolist()) - set(corners)
                assert not oracle.is_inside(a, b, c, whole[apex])
            if beside >= 0:
                back = mesh.neighbors[beside].tolist().index(t)
                assert mesh.constrained[beside, back] == mesh.constrained[t, k]
    assert marked == pieces_of(whole, segments, rows)
    assert {frozenset(ends) for ends in mesh.segments.tolist()} == marked
    assert len(mesh.segments) == len(marked)
    plain = sphere.Delaunay(xyz=mesh.vectors)
    assert mesh.nsimplex == plain.nsimplex
    assert mesh.covers_sphere == plain.covers_sphere


def made(vectors, segments, **options):
    arrays = np.array(vectors, dtype=float)
    return sphere.ConstrainedDelaunay(xyz=arrays, segments=segments, **options)


@pytest.mark.parametrize("kind", KINDS)
def test_arcs_are_edges_and_the_others_are_delaunay(kind):
    rng = random.Random(kind)
    crossed = through = 0
    for _ in range(40):
        vectors = KINDS[kind](rng.randint(6, 22), rng)
        whole = [oracle.whole(v) for v in vectors]
        arcs = some_arcs(whole, rng.randint(1, 12), rng)
        try:
            mesh = made(vectors, arcs)
        except delone.DegenerateInputError:
            continue
        check(mesh, arcs)
        through += len(mesh.report.through)
        plain = oracle.canonical(sphere.Delaunay(xyz=mesh.vectors).simplices)
        crossed += plain != oracle.canonical(mesh.simplices)
    assert crossed > 8
    assert through > 8 or kind == "scattered"


@pytest.mark.parametrize("kind", KINDS)
def test_order_lengths_and_directions_of_arcs_do_not_matter(kind):
    rng = random.Random(f"laws {kind}")
    for _ in range(15):
        vectors = list(dict.fromkeys(KINDS[kind](rng.randint(8, 20), rng)))
        whole = [oracle.whole(v) for v in vectors]
        if len(set(oracle.firsts(whole))) < len(vectors):
            continue
        arcs = some_arcs(whole, 9, rng)
        base = made(vectors, arcs)
        order = rng.sample(range(len(vectors)), len(vectors))
        where = {v: i for i, v in enumerate(order)}
        turned = [
            tuple(where[v] for v in rng.sample(arc, 2)) for arc in rng.sample(arcs, len(arcs))
        ]
        longer = [tuple(x * 2.0 ** (7 * i - 60) for x in vectors[v]) for i, v in enumerate(order)]
        moved = made(longer, turned, workers=2)
        named = [[order[v] for v in t] for t in moved.simplices.tolist()]
        assert oracle.canonical(named) == oracle.canonical(base.simplices)
        assert {frozenset(order[v] for v in s) for s in moved.segments.tolist()} == {
            frozenset(s) for s in base.segments.tolist()
        }


def test_exact_symmetries_move_the_triangles_along():
    rng = random.Random("symmetries")
    vectors = np.array(KINDS["scattered"](40, rng))
    arcs = some_arcs([oracle.whole(v) for v in vectors.tolist()], 12, rng)
    base = oracle.canonical(made(vectors, arcs).simplices)
    assert base != oracle.canonical(sphere.Delaunay(xyz=vectors).simplices)
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((-1.0, 1.0), repeat=3):
            moved = oracle.canonical(made(vectors[:, axes] * signs, arcs).simplices)
            even = sum(a > b for a, b in itertools.combinations(axes, 2)) % 2 == 0
            mirrored = even != (np.prod(signs) > 0)
            assert oracle.canonical(t[::-1] if mirrored else t for t in moved) == base


@pytest.mark.parametrize("kind", KINDS)
def test_all_pairs_that_cross_are_named(kind):
    rng = random.Random(f"cross {kind}")
    found = 0
    for _ in range(60):
        vectors = KINDS[kind](rng.randint(6, 14), rng)
        whole = [oracle.whole(v) for v in vectors]
        arcs = [rng.sample(range(len(vectors)), 2) for _ in range(rng.randint(2, 14))]
        arcs = [arc for arc in arcs if not is_opposite(*(whole[v] for v in arc))]
        want = [
            [i, j]
            for i, j in itertools.combinations(range(len(arcs)), 2)
            if crosses_at_no_vertex(whole, arcs[i], arcs[j])
        ]
        try:
            made(vectors, arcs)
        except delone.DegenerateInputError:
            continue
        except delone.CrossingSegmentsError as error:
            found += len(want)
            assert error.pairs.tolist() == want
            assert error.points.shape == (len(want), 2)
        else:
            assert not want
    assert found > 50


def test_where_arcs_cross_is_told():
    corners = [(170, -10), (-170, 10), (170, 10), (-170, -10), (0, 89)]
    with pytest.raises(delone.CrossingSegmentsError, match=r"segments 0 and 1 cross at") as caught:
        sphere.ConstrainedDelaunay(lonlat=corners, segments=[(0, 1), (2, 3), (0, 4)])
    assert caught.value.pairs.tolist() == [[0, 1]]
    assert abs(caught.value.points[0, 0]) == pytest.approx(180)
    assert caught.value.points[0, 1] == pytest.approx(0, abs=1e-12)


def test_arcs_between_opposite_directions_are_refused_by_row():
    octahedron = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-3, 0, 0), (0, -1, 0), (0, 0, -1)]
    arcs = [(0, 1), (0, 3), (2, 4), (5, 2)]
    with pytest.raises(delone.DirectionError, match="2 segments join, first row 1,") as caught:
        made(octahedron, arcs)
    assert caught.value.rows.tolist() == [1, 3]
    assert caught.value.count == 2
    with pytest.raises(delone.DirectionError, match="segment 0 joins"):
        sphere.ConstrainedDelaunay(
            lonlat=[(0, 0), (180, 0), (0, 80), (9, -70), (99, 0)], segments=[(0, 1)]
        )
    # By the least amount it is not opposite.
    near = [*octahedron[:3], (-3, 0, 1e-300), *octahedron[4:]]
    mesh = made(near, [(0, 3)])
    assert {frozenset(s) for s in mesh.segments.tolist()} == {frozenset((0, 2)), frozenset((2, 3))}


def test_what_cannot_be_a_segment_is_refused():
    lonlat = [(0, 0), (90, 0), (0, 80), (180, -10)]
    with pytest.raises(delone.InputError, match="indices outside 0 to 3; first: row 1"):
        sphere.ConstrainedDelaunay(lonlat=lonlat, segments=[(0, 1), (0, 4)])
    with pytest.raises(delone.ShapeError, match="segments must have shape"):
        sphere.ConstrainedDelaunay(lonlat=lonlat, segments=[(0, 1, 2)])
    with pytest.raises(delone.InputError, match="crossing"):
        sphere.ConstrainedDelaunay(lonlat=lonlat, segments=[], crossing="bend")


def test_no_segments_give_the_plain_triangulation_and_a_report_lists_odd_ones():
    lonlat = [(0, 0), (90, 0), (0, 80), (180, -10), (360, 0), (45, 0)]
    mesh = sphere.ConstrainedDelaunay(lonlat=lonlat, segments=[])
    plain = sphere.Delaunay(lonlat=lonlat)
    assert np.array_equal(mesh.simplices, plain.simplices)
    assert not mesh.constrained.any()
    assert mesh.segments.shape == (0, 2)
    mesh = sphere.ConstrainedDelaunay(
        lonlat=lonlat, segments=[(0, 4), (0, 1), (5, 1), (1, 4), (2, 0)]
    )
    report = mesh.report
    assert report.zero.tolist() == [0]
    assert report.repeated.tolist() == [[3, 1]]
    assert report.overlaps.tolist() == [[2, 1]]
    assert report.through.tolist() == [[1, 5], [3, 5]]
    assert report.duplicates.tolist() == [[4, 0]]
    assert mesh.segments.tolist() == [[0, 5], [5, 1], [2, 0]]
    start, source = mesh.segment_source
    rows = [source[i:j].tolist() for i, j in pairwise(start.tolist())]
    assert rows == [[1, 3], [1, 2, 3], [4]]
    assert mesh.segment_forward.tolist() == [True, False, True, True, False, True]
    assert mesh.input_segments.tolist() == [[0, 4], [0, 1], [5, 1], [1, 4], [2, 0]]
    assert mesh.geometry_of_segment.tolist() == [-1] * 5
    assert (mesh.polygon_of_simplex == -1).all()
    assert repr(mesh) == (
        "<ConstrainedDelaunay of 6 directions (1 duplicate) and 5 segments: 5 triangles>"
    )


def test_it_is_kept_by_pickle_and_answers_queries():
    rng = np.random.default_rng(3)
    lonlat = np.column_stack((rng.uniform(-180, 180, 400), rng.uniform(-90, 90, 400)))
    wall = [(i, i + 1) for i in range(35)]
    meridian = [(10 * i - 175, 0.5) for i in range(36)]
    lonlat = np.concatenate((meridian, lonlat))
    mesh = sphere.ConstrainedDelaunay(lonlat=lonlat, segments=[*wall, (35, 0)])
    again = pickle.loads(pickle.dumps(mesh))
    assert again.simplices.tolist() == mesh.simplices.tolist()
    assert again.region.tolist() == mesh.region.tolist()
    assert int(mesh.region.max()) == 1
    queries = rng.normal(size=(3000, 3))
    found = mesh.find_simplex(queries)
    corners = mesh.points[mesh.simplices[found]]
    for k in range(3):
        sides = np.cross(corners[:, k], corners[:, (k + 1) % 3])
        assert (np.einsum("kj,kj->k", sides, queries) > -1e-12).all()
    products = queries @ mesh.points.T
    assert np.array_equal(mesh.nearest(queries), products.argmax(axis=1))
    values = sphere.Linear(mesh, mesh.points[:, 2])
    assert np.array_equal(values(mesh.vectors), mesh.points[:, 2])


def test_long_arcs_across_many_triangles():
    # Nearly half a turn, through thousands of triangles, in more than one cavity.
    rng = np.random.default_rng(4)
    vectors = rng.normal(size=(20_000, 3))
    vectors[:3] = (1, 0, 1e-3), (-1, 1e-2, 0), (0, 1e-3, -1)
    arcs = [(0, 1), (1, 2), (2, 0)]
    mesh = sphere.ConstrainedDelaunay(xyz=vectors, segments=arcs)
    assert mesh.constrained.sum() == 6
    assert int(mesh.region.max()) == 1
    areas = np.bincount(mesh.region, weights=mesh.areas)
    assert areas.sum() == pytest.approx(4 * np.pi)
    small = sphere.ConstrainedDelaunay(xyz=[*vectors[:3].tolist(), (-9, -9, 9)], segments=arcs)
    assert areas.min() == pytest.approx(np.bincount(small.region, weights=small.areas).min())
    for t, k in zip(*np.nonzero((mesh.neighbors > -1) & ~mesh.constrained), strict=True):
        if t % 40 == 0:
            corners = mesh.simplices[t].tolist()
            (apex,) = set(mesh.simplices[mesh.neighbors[t, k]].tolist()) - set(corners)
            whole = [oracle.whole(v) for v in mesh.vectors[[*corners, apex]].tolist()]
            assert not oracle.is_inside(*whole)


@pytest.mark.parametrize("kind", KINDS)
def test_crossings_become_vertices(kind):
    rng = random.Random(f"split {kind}")
    added = 0
    for _ in range(40):
        vectors = KINDS[kind](rng.randint(6, 14), rng)
        whole = [oracle.whole(v) for v in vectors]
        arcs = [rng.sample(range(len(vectors)), 2) for _ in range(rng.randint(2, 12))]
        arcs = [arc for arc in arcs if not is_opposite(*(whole[v] for v in arc))]
        try:
            mesh = made(vectors, arcs, crossing="split")
        except delone.DegenerateInputError:
            continue
        want = {
            pair
            for pair in itertools.combinations(range(len(arcs)), 2)
            if crosses_at_no_vertex(whole, arcs[pair[0]], arcs[pair[1]])
        }
        found = mesh.report.crossings.tolist()
        # Arcs that overlap may bend in different ways, and then cross.
        more = {(s, t) for s, t, _ in found} - want
        assert len(found) == len(want) + len(more)
        assert not more or kind != "scattered"
        check(mesh, mesh.segments.tolist())
        added += mesh.nadded
        assert len(mesh.vectors) == len(vectors) + mesh.nadded
        for s, t, v in found:
            # At the crossing, up to rounding.
            for row in (s, t):
                a, b = (np.array(vectors[i], dtype=float) for i in arcs[row])
                normal = np.cross(a, b)
                assert abs(normal @ mesh.points[v]) < 1e-14 * np.linalg.norm(a) * np.linalg.norm(b)
        start, source = mesh.segment_source
        for row, (i, j) in enumerate(arcs):
            parts = [
                mesh.segments[k] if mesh.segment_forward[at] else mesh.segments[k][::-1]
                for k in range(len(start) - 1)
                for at in range(start[k], start[k + 1])
                if source[at] == row
            ]
            first = mesh.duplicate_of[i], mesh.duplicate_of[j]
            ends = [(tail, 1) for tail, _ in parts] + [(head, -1) for _, head in parts]
            degree = {v: sum(n for w, n in ends if w == v) for v, _ in ends}
            open_ends = {v: n for v, n in degree.items() if n}
            assert open_ends == ({} if first[0] == first[1] else {first[0]: 1, first[1]: -1})
        moved = made(vectors, [arc[::-1] for arc in arcs[::-1]], crossing="split")
        assert {tuple(v) for v in moved.vectors.tolist()} == {
            tuple(v) for v in mesh.vectors.tolist()
        }
    assert added > 30


def stops_of(kind, rng):
    """An arc, and directions near it that may be as near to each other as roundings."""
    a, b = np.array([1.0, 0, rng.random()]), np.array([rng.choice((1e-3, -0.9)), 1, rng.random()])
    if kind == "equal":
        # Stops that differ in z alone are at one angle.
        a, b = np.eye(3)[rng.sample((0, 1), 2)]
    if kind == "tiny":
        a, b = a * 2.0**-1060, b * 2.0**900
    middle = a / np.abs(a).max() + b / np.abs(b).max()
    middle /= np.abs(middle).max()
    stops = {tuple(middle.tolist())}
    for _ in range(rng.randint(1, 8)):
        step = [rng.randint(-3, 3) * 2.0**-52 for _ in range(3)]
        if kind == "scattered":
            step = (rng.uniform(-0.3, 0.3) * (b / np.abs(b).max() - a)).tolist()
        stops.add(tuple((middle + step).tolist()))
    return a, b, rng.sample(sorted(stops), len(stops))


@pytest.mark.parametrize("kind", ["near", "equal", "tiny", "scattered"])
def test_stops_are_in_exact_order_along_their_arcs(kind):
    rng = random.Random(f"stops {kind}")
    equal = 0
    vectors, rows, stops, want = [], [], [], []
    for arc in range(60):
        a, b, places = stops_of(kind, rng)
        u = len(vectors)
        vectors += [a.tolist(), b.tolist(), *map(list, places)]
        rows += [(u, u + 1), (u + 1, u)]
        stops += [(2 * arc + k, u + 2 + i) for k in (0, 1) for i in range(len(places))]
        # The place of a direction on the arc's plane, as a fraction of both ends.
        p, q = oracle.whole(a.tolist()), oracle.whole(b.tolist())
        normal = oracle.cross(p, q)
        angle = {}
        for i, x in enumerate(map(oracle.whole, places)):
            left = Fraction(oracle.dot(oracle.cross(x, q), normal))
            right = Fraction(oracle.dot(oracle.cross(p, x), normal))
            angle[u + 2 + i] = right / (left + right) if left + right else None
        equal += len(angle) - len(set(angle.values()))
        forward = 1 if a.tolist() < b.tolist() else -1
        order = sorted(angle, key=lambda v: (angle[v], [forward * x for x in vectors[v]]))
        want += [(2 * arc, v) for v in order] + [(2 * arc + 1, v) for v in order[::-1]]
    part, stop = _along(np.array(vectors), np.array(rows), np.array(sorted(stops)))
    assert list(zip(part.tolist(), stop.tolist(), strict=True)) == want
    assert (equal > 0) == (kind == "equal")


def test_crossings_do_not_touch_other_arcs():
    rng = np.random.default_rng(5)
    # Short arcs along a parallel, and one that crosses every tenth.
    lon = np.arange(400) * 0.5
    ends = np.column_stack((lon, np.full(400, 10.0)))
    across = [(x, y) for x in lon[::10] + 0.25 for y in (5.0, 15.0)]
    sides = [(i, i + 1) for i in range(399)]
    arcs = sides + [(400 + 2 * k, 401 + 2 * k) for k in range(40)]
    order = rng.permutation(len(arcs))
    mesh = sphere.ConstrainedDelaunay(
        lonlat=np.concatenate((ends, across)),
        segments=[arcs[k] for k in order],
        crossing="split",
    )
    assert mesh.nadded == 40
    start, source = mesh.segment_source
    count = np.bincount(source, minlength=len(arcs))
    crossed = {k for s, t, _ in mesh.report.crossings.tolist() for k in (s, t)}
    assert {int(order[k]) for k in crossed} == {*range(0, 399, 10), *range(399, 439)}
    assert [2 if k in crossed else 1 for k in range(len(arcs))] == count.tolist()
    assert len(start) - 1 == len(mesh.segments) == 399 + 40 + 80


def test_the_limit_on_crossings():
    lonlat = [(0, 0), (10, 1), (0, 1), (10, 0), (0, 89), (0, -89), (180, 0)]
    with pytest.raises(delone.BudgetExceededError, match="found 1 crossings, more than the limit"):
        sphere.ConstrainedDelaunay(
            lonlat=lonlat, segments=[(0, 1), (2, 3)], crossing="split", max_points=0
        )
    mesh = sphere.ConstrainedDelaunay(
        lonlat=lonlat, segments=[(0, 1), (2, 3)], crossing="split", max_points=1
    )
    assert mesh.nadded == 1
    assert mesh.lonlat[-1] == pytest.approx([5, 0.5], abs=0.01)
