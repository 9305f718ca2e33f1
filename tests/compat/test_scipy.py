"""The drop-in beside scipy.spatial.Delaunay itself: values, errors, habits."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from fractions import Fraction
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest

import delone
from delone import datasets
from delone.compat import scipy as drop_in
from delone.compat.scipy import (
    ConvexHull,
    Delaunay,
    DimensionError,
    QhullError,
    Voronoi,
    convex_hull_plot_2d,
    delaunay_plot_2d,
    tsearch,
)
from delone.predicates import incircle, orient2d
from delone.testing import assert_delaunay, triangle_set

spatial = pytest.importorskip("scipy.spatial")

OPTIONS: dict[str, dict[str, Any]] = {
    "default": {},
    "Qc": {"qhull_options": "Qc"},
    "Qbb Qc": {"qhull_options": "Qbb Qc"},
    "incremental": {"incremental": True},
    "furthest": {"furthest_site": True},
    "furthest Qbb": {"furthest_site": True, "qhull_options": "Qbb Qc"},
}


@pytest.fixture(params=OPTIONS)
def pair(request: pytest.FixtureRequest) -> tuple[Any, Any, Any]:
    """Ours, SciPy's, and the number that SciPy gives to each of our triangles."""
    points = np.random.default_rng(5).random((80, 2)) * [3, 1] + [1, 7]
    options = OPTIONS[request.param]
    ours, theirs = Delaunay(points, **options), spatial.Delaunay(points, **options)
    place = {tuple(sorted(t)): i for i, t in enumerate(theirs.simplices.tolist())}
    order = np.array([place[tuple(sorted(t))] for t in ours.simplices.tolist()])
    assert len(order) == len(place)
    return ours, theirs, order


def test_lifting_is_the_same(pair: Any) -> None:
    ours, theirs, order = pair
    assert ours.paraboloid_scale == pytest.approx(theirs.paraboloid_scale, rel=1e-13)
    assert ours.paraboloid_shift == pytest.approx(theirs.paraboloid_shift, rel=1e-13)
    queries = np.random.default_rng(6).random((3, 4, 2)) * 10
    assert np.allclose(ours.lift_points(queries), theirs.lift_points(queries), rtol=1e-12)
    assert ours.lift_points(queries[0, 0]).shape == theirs.lift_points(queries[0, 0]).shape
    assert np.allclose(ours.equations, theirs.equations[order], rtol=0, atol=1e-9)


def test_plane_distance_is_the_same(pair: Any) -> None:
    ours, theirs, order = pair
    queries = np.random.default_rng(6).random((3, 4, 2)) * 3
    expected = theirs.plane_distance(queries)[..., order]
    assert np.allclose(ours.plane_distance(queries), expected, rtol=0, atol=1e-9)
    assert ours.plane_distance(queries[0, 0]).shape == (ours.nsimplex,)


@pytest.mark.sampled(3)
def test_find_simplex_is_the_same(pair: Any) -> None:
    ours, theirs, order = pair
    queries = np.random.default_rng(7).random((500, 2)) * [3, 1] + [1, 7]
    found, expected = ours.find_simplex(queries), theirs.find_simplex(queries)
    inside = found >= 0
    assert np.array_equal(inside, expected >= 0)
    assert np.array_equal(order[found[inside]], expected[inside])
    assert np.array_equal(tsearch(ours, queries), found)


@pytest.mark.sampled(3)
def test_arrays_are_those_of_scipy(pair: Any) -> None:
    ours, theirs, _ = pair
    for name in (
        "points",
        "simplices",
        "neighbors",
        "equations",
        "convex_hull",
        "coplanar",
        "vertex_to_simplex",
        "transform",
        "good",
        "min_bound",
        "max_bound",
    ):
        mine, other = getattr(ours, name), getattr(theirs, name)
        assert (mine.dtype, mine.shape) == (other.dtype, other.shape), name
        assert mine.flags.writeable == other.flags.writeable, name
        assert mine.flags.c_contiguous, name
    for name in ("ndim", "npoints", "nsimplex", "furthest_site"):
        assert getattr(ours, name) == getattr(theirs, name), name
    hulls = [{frozenset(edge) for edge in tri.convex_hull.tolist()} for tri in (ours, theirs)]
    assert hulls[0] == hulls[1]
    around = [
        [set(indices[start:end].tolist()) for start, end in pairwise(indptr)]
        for indptr, indices in (ours.vertex_neighbor_vertices, theirs.vertex_neighbor_vertices)
    ]
    assert around[0] == around[1]


def test_nearly_flat_triangles_have_no_transform() -> None:
    points = [(0, 0), (1, 0), (2, 0), (1, 1e-14), (1, -3)]
    ours, theirs = Delaunay(points), spatial.Delaunay(points, qhull_options="Qbb Q0 Qz")
    flat = np.isnan(ours.transform).all(axis=(1, 2))
    assert flat.any()
    assert not flat.all()
    assert np.isnan(theirs.transform).any() == flat.any()
    exact = delone.Delaunay(points).transform
    assert np.isfinite(exact).all()
    assert np.array_equal(ours.transform[~flat], exact[~flat])


def test_triangles_are_exact() -> None:
    points = datasets.utm_millimeters(2000)
    tri = Delaunay(points)
    assert_delaunay(points, tri.simplices, neighbors=tri.neighbors)
    # An in-plane distance is 0 at the corners, to a rounding of the differences.
    own = tri.plane_distance(points[tri.simplices[:20]])[np.arange(20), :, np.arange(20)]
    assert (np.abs(own) < 1e-9).all()


def circle_holds_all(points: Any, triangle: Any) -> bool:
    rows = [[Fraction(x) for x in p] for p in points]
    (ax, ay), (bx, by), (cx, cy) = (rows[i] for i in triangle)

    def inside(x: Fraction, y: Fraction) -> Fraction:
        u, v, w = [
            (px - x, py - y, (px - x) ** 2 + (py - y) ** 2)
            for px, py in ((ax, ay), (bx, by), (cx, cy))
        ]
        return (
            u[2] * (v[0] * w[1] - v[1] * w[0])
            + v[2] * (w[0] * u[1] - w[1] * u[0])
            + w[2] * (u[0] * v[1] - u[1] * v[0])
        )

    return all(inside(x, y) >= 0 for x, y in rows)


@pytest.mark.parametrize("name", sorted(datasets.GENERATORS))
def test_furthest_site_triangles_hold_all_points(name: str) -> None:
    points = datasets.GENERATORS[name](60, seed=8)
    tri = Delaunay(points, furthest_site=True)
    assert all(circle_holds_all(points, t) for t in tri.simplices.tolist())
    # They tile the hull: as many as extreme points less two, of the same area, all mutual.
    mesh = delone.Delaunay(points)
    assert tri.nsimplex == len(np.unique(tri.simplices)) - 2
    with np.errstate(over="ignore", invalid="ignore"):
        areas = [exact_area(points, tri.simplices), exact_area(points, mesh.simplices)]
    assert areas[0] == areas[1]
    for t, row in enumerate(tri.neighbors.tolist()):
        for k, beyond in enumerate(row):
            if beyond >= 0:
                edge = set(tri.simplices[t].tolist()) - {int(tri.simplices[t, k])}
                assert edge < set(tri.simplices[beyond].tolist())
    queries = points[:20]
    assert (tri.find_simplex(queries) >= 0).all()
    assert len(tri.coplanar) == 0


def exact_area(points: Any, simplices: Any) -> Fraction:
    total = Fraction(0)
    for triangle in simplices.tolist():
        (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in points[i]] for i in triangle)
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert area > 0
        total += area
    return total


@pytest.mark.parametrize("name", ["pythagorean_circle", "circle", "grid", "uniform"])
def test_furthest_site_does_not_depend_on_the_order_of_rows(name: str) -> None:
    points = datasets.GENERATORS[name](300, seed=8)
    order = np.random.default_rng(0).permutation(len(points))
    one = Delaunay(points, furthest_site=True).simplices
    two = Delaunay(points[order], furthest_site=True).simplices
    assert triangle_set(order[two]) == triangle_set(one)


@pytest.mark.parametrize("n", [5, 9, 12])
@pytest.mark.parametrize("seed", range(3))
def test_furthest_site_triangles_of_a_circle_are_those_of_the_perturbed_heights(
    n: int, seed: int
) -> None:
    points = datasets.pythagorean_circle(n, seed=seed)
    expected = set()
    for a, b, c in combinations(range(n), 3):
        triangle = (a, b, c) if orient2d(points[a], points[b], points[c]) > 0 else (a, c, b)
        others = points[[i for i in range(n) if i not in triangle]]
        if (incircle(*points[list(triangle)], others, ties="canonical") > 0).all():
            expected.add(triangle)
    assert len(expected) == n - 2
    assert triangle_set(Delaunay(points, furthest_site=True).simplices) == expected


def test_furthest_site_cocircular_triangles_are_those_of_the_perturbed_heights() -> None:
    # The same infinitesimals on the other side of the hull: the smallest corner is cut off first.
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    assert triangle_set(Delaunay(square).simplices) == {(0, 1, 2), (0, 2, 3)}
    assert triangle_set(Delaunay(square, furthest_site=True).simplices) == {(0, 1, 3), (1, 2, 3)}


def test_duplicates_are_coplanar() -> None:
    points = [(0, 0), (1, 0), (0, 1), (1, 0), (0, 0)]
    tri = Delaunay(points)
    assert tri.coplanar[:, [0, 2]].tolist() == [[3, 1], [4, 0]]
    assert tri.vertex_to_simplex.tolist() == [0] * 5
    without = Delaunay(points, qhull_options="Qbb")
    assert without.coplanar.shape == (0, 3)
    assert without.vertex_to_simplex.tolist() == [0, 0, 0, -1, -1]


def test_points_can_be_added() -> None:
    points = datasets.uniform(60)
    tri = Delaunay(points[:10], incremental=True)
    before = tri.simplices
    tri.transform, tri.equations, tri.convex_hull  # noqa: B018
    tri.add_points(points[10:30])
    assert before is not tri.simplices
    tri.add_points(points[30:].tolist(), restart=True)
    whole = Delaunay(points)
    # The same triangles in another order: place[t] is that of triangle t of `whole`.
    rows = {frozenset(corners): t for t, corners in enumerate(tri.simplices.tolist())}
    place = np.array([rows[frozenset(corners)] for corners in whole.simplices.tolist()])
    assert np.array_equal(tri.points, points)
    for t, other in enumerate(place):
        corners = dict(zip(tri.simplices[other], tri.neighbors[other], strict=True))
        for corner, neighbor in zip(whole.simplices[t], whole.neighbors[t], strict=True):
            assert corners[corner] == (place[neighbor] if neighbor >= 0 else -1)
    assert set(map(frozenset, tri.convex_hull)) == set(map(frozenset, whole.convex_hull))
    assert (tri.npoints, tri.nsimplex) == (60, whole.nsimplex)
    assert len(tri.equations) == len(tri.transform) == len(tri.good) == tri.nsimplex
    queries = points + 1e-3
    found, expected = tri.find_simplex(queries), whole.find_simplex(queries)
    assert np.array_equal(found, np.where(expected < 0, -1, place[expected]))


def test_points_can_be_added_in_3d() -> None:
    points = datasets.uniform(60, ndim=3)
    tri = Delaunay(points[:30], incremental=True)
    tri.add_points(points[30:])
    assert set(map(frozenset, tri.simplices)) == set(map(frozenset, Delaunay(points).simplices))
    again = pickle.loads(pickle.dumps(tri))
    again.add_points([(2, 2, 2)])
    assert again.npoints == 61


def test_furthest_site_points_can_be_added() -> None:
    tri = Delaunay([(0, 0), (1, 0), (0, 1)], furthest_site=True, incremental=True)
    tri.add_points([(5, 5)])
    assert tri.nsimplex == 2


def test_what_cannot_be_added_changes_nothing() -> None:
    tri = Delaunay([(0, 0), (1, 0), (0, 1)], incremental=True)
    simplices = tri.simplices
    for bad in ([(np.nan, 1)], [(1, 2, 3)], [1, 2], "ab"):
        with pytest.raises(ValueError, match=r"points|row"):
            tri.add_points(bad)
    with pytest.raises(QhullError):
        tri.add_points([(np.inf, 1)])
    assert tri.simplices is simplices
    assert tri.npoints == len(tri.points) == 3


def test_adding_needs_an_open_triangulation() -> None:
    tri = Delaunay([(0, 0), (1, 0), (0, 1)])
    with pytest.raises(RuntimeError):
        tri.add_points([(1, 1)])
    tri.close()
    tri = Delaunay([(0, 0), (1, 0), (0, 1)], incremental=True)
    tri.close()
    tri.close()
    with pytest.raises(RuntimeError):
        tri.add_points([(1, 1)])
    assert tri.nsimplex == 1


BAD: dict[str, Any] = {
    "two points": [(0, 0), (1, 1)],
    "line": [(0, 0), (1, 1), (2, 2), (3, 3)],
    "one place": [(1, 1)] * 5,
    "empty": np.zeros((0, 2)),
    "flat": np.arange(5.0),
    "one coordinate": np.zeros((5, 1)),
    "three axes": np.zeros((3, 2, 2)),
    "nan": [(0, 0), (1, 0), (np.nan, 1)],
    "infinity": [(0, 0), (1, 0), (np.inf, 1), (2, 2)],
    "masked": np.ma.masked_equal([(0.0, 0), (1, 0), (0, 7)], 7),
    "ragged": np.array([(0, 0), (1,)], dtype=object),
    "words": [("a", "b")] * 4,
}


# SciPy 1.13 raises IndexError for the first and crashes for the second; later versions raise
# ValueError for both.
NOT_ASKED = ("flat", "three axes")


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("furthest_site", [False, True])
def test_errors_are_of_the_kind_that_scipy_raises(name: str, furthest_site: bool) -> None:
    kind = ValueError
    if name not in NOT_ASKED:
        masked = name == "masked"
        with pytest.raises((ValueError, QhullError)) as theirs:
            spatial.Delaunay(np.ma.asanyarray(BAD[name]) if masked else np.array(BAD[name]))
        kind = QhullError if isinstance(theirs.value, QhullError) else ValueError
    with pytest.raises(kind):
        Delaunay(BAD[name], furthest_site=furthest_site)


def test_qhull_error_is_scipys_and_keeps_the_cause() -> None:
    assert QhullError is spatial.QhullError
    with pytest.raises(spatial.QhullError) as caught:
        Delaunay([(0, 0), (2, 2), (1, 1)])
    assert isinstance(caught.value.__cause__, delone.DegenerateInputError)
    assert caught.value.__cause__.chain.tolist() in ([0, 2, 1], [1, 2, 0])


def test_without_scipy_the_error_is_our_own() -> None:
    code = """
import sys
sys.modules["scipy"] = None
from delone.compat.scipy import Delaunay, QhullError
assert issubclass(QhullError, RuntimeError), QhullError.__mro__
assert QhullError.__module__ == "delone.compat.scipy"
try:
    Delaunay([(0, 0), (1, 1)])
except QhullError as error:
    print("told")
print(Delaunay([(0, 0), (1, 0), (0, 1)]).nsimplex)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.split() == ["told", "1"], done.stderr


@pytest.mark.parametrize("d", [9, 12])
def test_other_dimensions_are_left_to_scipy(d: int) -> None:
    with pytest.raises(DimensionError, match=r"scipy\.spatial") as caught:
        Delaunay(np.random.default_rng(0).random((10, d)))
    assert isinstance(caught.value, NotImplementedError)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    "options",
    [
        "",
        "QJ",
        "QJ Pp",
        "Qt",
        "Qbb Qc Qz Q12",
        "Qz Q12 Qx",
        "Q0",
        "QR0",
        "Tv",
        "Fv",
        "Qs Qi",
        "C-0",
        "C0",
        "A-1",
        "QbB",
        "QbB Qc Qz",
    ],
)
def test_options_about_rounding_change_nothing(options: str) -> None:
    points = datasets.uniform(50)
    tri = Delaunay(points, qhull_options=options)
    assert np.array_equal(tri.simplices, Delaunay(points).simplices)
    assert spatial.Delaunay(points, qhull_options=options).npoints == 50


@pytest.mark.parametrize("options", ["X", "Qj", "Qbb X"])
def test_unknown_options_are_errors_of_qhull(options: str) -> None:
    for kind in (spatial.Delaunay, Delaunay):
        with pytest.raises(QhullError):
            kind(datasets.uniform(10), qhull_options=options)


KINDS = {
    "Delaunay triangulation": Delaunay,
    "Voronoi diagram": Voronoi,
    "convex hull": ConvexHull,
}


@pytest.mark.parametrize("what", [*KINDS])
@pytest.mark.parametrize(
    "options",
    ["Qb0:0", "QB1:2", "QV0", "A-0.9", "A0.9", "C-0.01", "A", "Pd0", "R5", "v", "H0", "Qg"],
)
def test_options_for_another_result_are_refused_by_name(options: str, what: str) -> None:
    with pytest.raises(ValueError, match=f"'{options}' is not supported for the {what}"):
        KINDS[what](datasets.uniform(10), qhull_options=options)


@pytest.mark.parametrize("options", ["Qu", "Qu Qc", "Qbb Qc Qu"])
def test_the_option_of_the_furthest_site(options: str) -> None:
    points = datasets.uniform(30)
    ours, theirs = (kind(points, qhull_options=options) for kind in (Delaunay, spatial.Delaunay))
    assert ours.furthest_site
    triangles = [{frozenset(t) for t in tri.simplices.tolist()} for tri in (ours, theirs)]
    assert triangles[0] == triangles[1]
    by_flag = Delaunay(points, furthest_site=True)
    assert np.array_equal(ours.simplices, by_flag.simplices)
    diagram, other = (kind(points, qhull_options=options) for kind in (Voronoi, spatial.Voronoi))
    assert diagram.furthest_site
    np.testing.assert_allclose(
        np.sort(diagram.vertices, axis=0), np.sort(other.vertices, axis=0), rtol=1e-9
    )
    with pytest.raises(NotImplementedError):
        Delaunay(np.random.default_rng(0).random((9, 3)), qhull_options=options)


def test_options_that_qhull_refuses() -> None:
    points = datasets.uniform(10)
    for kinds, options in (
        ((spatial.Delaunay, Delaunay, spatial.Voronoi, Voronoi), "Qu Qz"),
        ((spatial.ConvexHull, ConvexHull), "Qu"),
        ((spatial.ConvexHull, ConvexHull), "Qz"),
    ):
        for kind in kinds:
            with pytest.raises(QhullError):
                kind(points, qhull_options=options)
    with pytest.raises(QhullError, match="not for the convex hull"):
        ConvexHull(points, qhull_options="Qu")


def test_hulls_of_scaled_points_are_hulls() -> None:
    points = datasets.uniform(30) * [10, 1]
    for options in ("QbB", "C-0", "A-1"):
        ours = ConvexHull(points, qhull_options=options)
        assert np.array_equal(ours.simplices, ConvexHull(points).simplices)
        assert ours.volume == ConvexHull(points).volume
    theirs = spatial.ConvexHull(points, qhull_options="QbB")
    assert {frozenset(s) for s in theirs.simplices.tolist()} == {
        frozenset(s) for s in ConvexHull(points).simplices.tolist()
    }


@pytest.mark.parametrize("what", [*KINDS])
def test_points_on_a_line_have_none_of_it(what: str) -> None:
    with pytest.raises(QhullError, match=f"there is no {what}$"):
        KINDS[what]([(0, 0), (1, 1), (2, 2)])
    with pytest.raises(QhullError, match=f"there is no {what}$"):
        KINDS[what]([(0, 0, 0), (1, 1, 0), (2, 2, 0), (0, 4, 0)])


def test_pictures_beside_scipy() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    points = datasets.uniform(20)
    for kind, peer, draw, draw_peer in (
        (Delaunay, spatial.Delaunay, delaunay_plot_2d, spatial.delaunay_plot_2d),
        (ConvexHull, spatial.ConvexHull, convex_hull_plot_2d, spatial.convex_hull_plot_2d),
    ):
        mine, other = Figure().add_subplot(), Figure().add_subplot()
        assert draw(kind(points), mine) is mine.figure
        draw_peer(peer(points), other)
        assert drawn_edges(mine) == drawn_edges(other)
        np.testing.assert_array_equal(mine.lines[0].get_xydata(), other.lines[0].get_xydata())
        assert mine.get_xlim() == other.get_xlim() and mine.get_ylim() == other.get_ylim()
        with pytest.raises(ValueError, match="not 2-D"):
            draw(kind(np.random.default_rng(0).random((9, 3))), mine)


def drawn_edges(ax: Any) -> set[frozenset[tuple[float, ...]]]:
    """Segments of collections, and of the second line, whose gaps are NaN."""
    segments = [s for each in ax.collections for s in each.get_segments()]
    for line in ax.lines[1:2]:
        way = line.get_xydata()
        segments += [way[i : i + 2] for i in range(len(way) - 1)]
    return {
        frozenset(map(tuple, np.asarray(s).tolist()))
        for s in segments
        if np.isfinite(s).all() and len(s) == 2
    }


@pytest.mark.parametrize("options", ["Qz", "Qbb", "Qc QbB"])
def test_options_that_do_not_go_with_adding(options: str) -> None:
    for kind in (spatial.Delaunay, Delaunay):
        with pytest.raises(ValueError):
            kind(datasets.uniform(10), incremental=True, qhull_options=options)


def test_options_must_be_text() -> None:
    with pytest.raises(TypeError):
        Delaunay(datasets.uniform(10), qhull_options=5)  # type: ignore[arg-type]


def test_booleans_and_objects_are_taken_as_scipy_takes_them() -> None:
    flags = np.array([(True, False), (False, True), (False, False)])
    assert Delaunay(flags).nsimplex == 1
    boxed = np.array([(0, 0.0), (1, 0), (0, 1)], dtype=object)
    assert np.array_equal(Delaunay(boxed).points, boxed.astype(float))
    with pytest.raises(ValueError, match=str(2**53 + 1)):
        Delaunay(np.array([(0, 0), (2**53 + 1, 0), (0, 1)], dtype=object))
    assert Delaunay(boxed).find_simplex(boxed).tolist() == [0, 0, 0]
    assert Delaunay(boxed).find_simplex(flags).tolist() == [0, 0, 0]


def test_queries_are_taken_exactly() -> None:
    tri = Delaunay([(0, 0), (1, 0), (0, 1)])
    for bad in ([(1j, 0)], [("a", "b")], [(2**53 + 1, 0)]):
        with pytest.raises(ValueError, match="xi"):
            tri.find_simplex(bad)


def test_points_are_the_array_given() -> None:
    points = np.array(datasets.uniform(10))
    assert Delaunay(points).points is points
    assert spatial.Delaunay(points).points is points
    with pytest.raises(AttributeError):
        Delaunay(points).points = points  # type: ignore[misc]


def test_arrays_may_be_changed_and_replaced() -> None:
    tri = Delaunay(datasets.uniform(30))
    expected = tri.find_simplex(tri.points)
    tri.simplices.sort()
    tri.simplices = tri.simplices[:5]
    tri.neighbors[:] = -7
    assert len(tri.simplices) == 5
    assert np.array_equal(tri.find_simplex(tri.points), expected)


def test_copies_and_pickles() -> None:
    tri = Delaunay(datasets.uniform(30), incremental=True)
    tri.equations  # noqa: B018
    for again in (pickle.loads(pickle.dumps(tri)), copy.copy(tri), copy.deepcopy(tri)):
        assert np.array_equal(again.simplices, tri.simplices)
        again.add_points([(2, 2)])
        assert again.npoints == 31
    assert tri.npoints == 30


@pytest.mark.parametrize("bad", [1, 1.5, None, object()])
def test_single_values_are_no_points(bad: Any) -> None:
    tri = Delaunay(datasets.uniform(10))
    for method in (tri.find_simplex, tri.lift_points, tri.plane_distance):
        with pytest.raises(IndexError):
            method(bad)


def test_queries_of_another_dimension_are_refused() -> None:
    tri = Delaunay(datasets.uniform(10))
    for method in (tri.find_simplex, tri.lift_points, tri.plane_distance):
        with pytest.raises(ValueError, match="2 coordinates"):
            method([2, 2, 2])
    assert tri.find_simplex(np.empty((0, 2))).shape == (0,)


def test_the_module_offers_the_names_of_scipy() -> None:
    for name in ("Delaunay", "QhullError", "tsearch"):
        assert name in drop_in.__all__
        assert hasattr(spatial, name)


def test_interpolation_along_the_diagonal_of_documentation() -> None:
    # The recipe of SciPy's documentation: barycentric coordinates from `transform`.
    points = np.array([[0, 0], [0, 1.1], [1, 0], [1, 1]])
    tri = Delaunay(points)
    p = np.array([(0.1, 0.2), (1.5, 0.5), (0.5, 1.05)])
    found = tri.find_simplex(p)
    assert (found >= 0).tolist() == [True, False, True]
    b = tri.transform[found[0], :2].dot(np.transpose(p - tri.transform[found[0], 2]))
    weights = np.c_[np.transpose(b), 1 - b.sum(axis=0)]
    assert np.allclose(weights[0] @ points[tri.simplices[found[0]]], p[0])
