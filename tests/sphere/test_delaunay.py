"""Triangulations of directions against brute force in integers, and their laws.

Laws: the order of the rows, the lengths of the vectors and the exact symmetries of the cube change
nothing but the names.
"""

from __future__ import annotations

import itertools
import pickle
import random
from itertools import pairwise

import numpy as np
import pytest

import delone
import directions as oracle
from delone import sphere

LATTICE = [v for v in itertools.product((-2, -1, 0, 1, 2), repeat=3) if any(v)]
AXES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
CUBE = list(itertools.product((-1, 1), repeat=3))


RING = [v for v in LATTICE if v[2] == 0 and max(map(abs, v)) <= 1]
UPPER = [v for v in LATTICE if v[2] > 0]


def gauss(rng):
    return tuple(rng.gauss(0, 1) for _ in range(3))


def near(x, rng):
    return x + 1e-15 * rng.randint(-9, 9)


def any_length(rng):
    return tuple(x * 2.0 ** rng.randint(-900, 900) for x in gauss(rng))


# Sets of vectors, from a number of them and a generator.
KINDS = {
    "lattice": lambda n, rng: [rng.choice(LATTICE) for _ in range(n)],
    "closed half": lambda n, rng: [v for v in rng.choices(LATTICE, k=n + 4) if v[2] >= 0],
    "ring and cap": lambda n, rng: RING + rng.choices(UPPER, k=n % 4),
    "ring and poles": lambda n, rng: RING[: n % 7 + 2] + AXES[4:][: rng.randint(1, 2)],
    "cube": lambda n, rng: CUBE + rng.sample(AXES, n % 5),
    "scattered": lambda n, rng: [gauss(rng) for _ in range(n)],
    "lengths": lambda _, rng: [any_length(rng) for _ in range(6)],
    "tight": lambda n, rng: [tuple(near(x, rng) for x in (1.0, 0.0, 0.5)) for _ in range(n)],
}


def sample(kind, rng):
    return KINDS[kind](rng.randint(3, 11), rng)


def triangles(vectors):
    """The triangles, canonical; an empty set where there are none."""
    try:
        return oracle.canonical(sphere.Delaunay(xyz=np.array(vectors, dtype=float)).simplices)
    except delone.DegenerateInputError:
        return set()


def check_topology(mesh):
    """Neighbors across each edge, and as many triangles as the directions have."""
    ends = {}
    for t, corners in enumerate(mesh.simplices.tolist()):
        for k in range(3):
            edge = corners[(k + 1) % 3], corners[(k + 2) % 3]
            assert edge not in ends
            ends[edge] = (t, k)
    for (a, b), (t, k) in ends.items():
        assert mesh.neighbors[t, k] == ends.get((b, a), (-1,))[0]
    distinct = mesh.npoints - len(mesh.duplicates)
    border = int((mesh.neighbors < 0).sum())
    assert mesh.nsimplex == 2 * distinct - (border + 2 if border else 4)
    assert mesh.covers_sphere == (border == 0)
    used = np.unique(mesh.simplices)
    assert used.tolist() == np.unique(mesh.duplicate_of).tolist()


def check_locally(mesh):
    """Every triangle is positive, and every edge locally Delaunay with ties: so is all of it."""
    whole = [oracle.whole(v) for v in mesh.vectors.tolist()]
    for t, corners in enumerate(mesh.simplices.tolist()):
        a, b, c = (whole[v] for v in corners)
        assert oracle.orient(a, b, c) > 0
        for beside in mesh.neighbors[t].tolist():
            if beside > t:
                (apex,) = set(mesh.simplices[beside].tolist()) - set(corners)
                assert not oracle.is_inside(a, b, c, whole[apex])
    for tail, head in mesh.boundary.tolist():
        # A hull: no vertex of the boundary is beyond an edge of it.
        for other in np.unique(mesh.boundary).tolist():
            assert oracle.orient(whole[tail], whole[head], whole[other]) >= 0


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_what_brute_force_finds(kind):
    rng = random.Random(kind)
    found = 0
    for _ in range(25 if kind != "lengths" else 8):
        vectors = sample(kind, rng)
        if len(vectors) < 3:
            continue
        whole = [oracle.whole(v) for v in vectors]
        want = oracle.brute(whole)
        try:
            mesh = sphere.Delaunay(xyz=vectors)
        except delone.DegenerateInputError:
            assert not want
            continue
        found += 1
        assert oracle.canonical(mesh.simplices) == want
        check_topology(mesh)
        assert mesh.duplicate_of.tolist() == oracle.firsts(whole)
    assert found > 4


@pytest.mark.parametrize("kind", KINDS)
def test_order_lengths_and_names_of_axes_do_not_matter(kind):
    rng = random.Random(f"laws {kind}")
    for _ in range(10):
        vectors = sample(kind, rng)
        distinct = [
            v for i, v in enumerate(oracle.firsts([oracle.whole(v) for v in vectors])) if v == i
        ]
        vectors = [vectors[i] for i in distinct]
        base = triangles(vectors)
        order = rng.sample(range(len(vectors)), len(vectors))
        moved = triangles([vectors[i] for i in order])
        assert oracle.canonical([[order[v] for v in t] for t in moved]) == base
        powers = [2.0 ** rng.randint(-60, 60) for _ in vectors]
        longer = [tuple(x * s for x in v) for v, s in zip(vectors, powers, strict=True)]
        assert triangles(longer) == base
        if kind in {"lattice", "cube", "closed half"}:
            factors = [rng.choice((3, 5, 7, 1000003)) for _ in vectors]
            longer = [tuple(x * s for x in v) for v, s in zip(vectors, factors, strict=True)]
            assert triangles(longer) == base


@pytest.mark.parametrize("kind", ["scattered", "tight"])
def test_exact_symmetries_move_the_triangles_along(kind):
    # Without ties, which are decided by an order that the symmetries change.
    rng = random.Random(f"symmetries {kind}")
    vectors = np.array([v for _ in range(4) for v in sample(kind, rng)])
    vectors = vectors[sorted(set(oracle.firsts([oracle.whole(v) for v in vectors.tolist()])))]
    base = triangles(vectors)
    assert base
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((-1.0, 1.0), repeat=3):
            moved = triangles(vectors[:, axes] * signs)
            even = sum(a > b for a, b in itertools.combinations(axes, 2)) % 2 == 0
            mirrored = even != (np.prod(signs) > 0)
            turned = [t[::-1] if mirrored else t for t in moved]
            assert oracle.canonical(turned) == base


def test_every_direction_of_a_fine_grid_is_a_vertex():
    # The hull of the rounded unit vectors keeps a part of them only.
    step = 0.01 / 6371e3
    i, j = np.mgrid[:40, :40]
    lon, lat = 0.3 + step * i.ravel(), 0.8 + step * j.ravel()
    grid = np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    for vectors in (grid, grid * np.linspace(1, 3, len(grid))[:, None]):
        mesh = sphere.Delaunay(xyz=vectors)
        assert len(mesh.duplicates) == 0
        check_topology(mesh)
        check_locally(mesh)


@pytest.mark.parametrize("spacing", [1.0, 1e-2, 1e-3, 1e-6])
def test_scattered_directions_at_any_spacing(spacing):
    rng = np.random.default_rng(5)
    vectors = np.array([0.3, -0.6, 0.7]) + spacing / 6371e3 * rng.normal(size=(300, 3))
    mesh = sphere.Delaunay(xyz=vectors)
    check_topology(mesh)
    check_locally(mesh)


def test_a_thousand_directions_of_the_whole_sphere():
    rng = np.random.default_rng(6)
    vectors = rng.normal(size=(1000, 3)) * np.exp(rng.normal(size=(1000, 1)) * 20)
    mesh = sphere.Delaunay(xyz=vectors)
    assert mesh.covers_sphere
    check_topology(mesh)
    check_locally(mesh)
    again = sphere.Delaunay(xyz=vectors, workers=3)
    assert np.array_equal(again.simplices, mesh.simplices)


def test_more_rows_than_one_thread_takes_at_a_time():
    rng = np.random.default_rng(11)
    vectors = rng.normal(size=(40_000, 3))
    mesh = sphere.Delaunay(xyz=vectors, workers=2)
    check_topology(mesh)
    assert np.array_equal(mesh.simplices, sphere.Delaunay(xyz=vectors, workers=1).simplices)
    # No vertex beside a triangle is inside its circle, as far as rounding can tell.
    corners = mesh.points[mesh.simplices]
    away = ((mesh.circumcenters - corners[:, 0]) ** 2).sum(axis=1)
    for k in range(3):
        others = mesh.points[mesh.simplices[mesh.neighbors[:, k]]]
        distance = ((mesh.circumcenters[:, None] - others) ** 2).sum(axis=2)
        assert np.all(distance.min(axis=1) > away - 1e-13)
    assert mesh.areas.sum() == pytest.approx(4 * np.pi, rel=1e-13)


def test_the_last_row_may_cover_the_sphere():
    # All others in one hemisphere, so that the hull has many boundary edges until then.
    rng = np.random.default_rng(7)
    ring = np.arange(300) * 2 * np.pi / 300
    vectors = np.column_stack((np.cos(ring), np.sin(ring), np.full(300, 0.01)))
    cap = rng.normal(size=(300, 3))
    cap[:, 2] = np.abs(cap[:, 2]) + 0.1
    vectors = np.vstack((vectors, cap))
    hull = sphere.Delaunay(xyz=vectors)
    assert not hull.covers_sphere
    check_topology(hull)
    check_locally(hull)
    whole = sphere.Delaunay(xyz=np.vstack((vectors, [(0.1, 0.2, -1.0)])))
    assert whole.covers_sphere
    check_topology(whole)
    check_locally(whole)


def test_a_grid_of_degrees_with_poles_and_both_names_of_the_date_line():
    lon, lat = np.meshgrid(np.arange(-180, 181, 10.0), np.arange(-90, 91, 10.0))
    mesh = sphere.Delaunay(lonlat=np.column_stack((lon.ravel(), lat.ravel())))
    # 36 meridians of 17 points, and two poles.
    assert mesh.npoints - len(mesh.duplicates) == 36 * 17 + 2
    assert mesh.covers_sphere
    check_topology(mesh)
    check_locally(mesh)
    assert abs(mesh.areas.sum() - 4 * np.pi) < 1e-12


@pytest.mark.parametrize("pole", [90.0, -90.0])
@pytest.mark.parametrize("spacing", [0.01, 0.001])
def test_rings_about_a_pole_at_small_spacing(pole, spacing):
    # The unit vectors of all of them are nearly the same doubles, and many tie nearly.
    step = np.copysign(spacing / 111_000, -pole)
    turns, rings = np.meshgrid(np.arange(-180, 180, 15.0), np.arange(1, 13))
    lonlat = np.column_stack((turns.ravel(), pole + step * rings.ravel()))
    mesh = sphere.Delaunay(lonlat=[*lonlat, (77.0, pole), (-3.0, pole)])
    assert mesh.duplicates.tolist() == [[289, 288]]
    assert not mesh.covers_sphere
    check_topology(mesh)
    check_locally(mesh)


@pytest.mark.parametrize("latitude", [0.0, 60.0, -89.0])
@pytest.mark.parametrize("spacing", [0.01, 0.001])
def test_lattices_of_degrees_at_small_spacing(latitude, spacing):
    step = spacing / 111_000
    i, j = np.mgrid[-8:9, -8:9]
    lonlat = np.column_stack((180.0 + step * i.ravel(), latitude + step * j.ravel()))
    mesh = sphere.Delaunay(lonlat=lonlat)
    assert len(mesh.duplicates) == 0
    check_topology(mesh)
    check_locally(mesh)
    # One meridian is one great circle, whatever the spacing.
    with pytest.raises(delone.DegenerateInputError) as caught:
        sphere.Delaunay(lonlat=lonlat[i.ravel() == 3])
    chain = caught.value.chain
    turned = np.roll(chain, -int(chain.argmin()))
    assert turned.tolist() in (list(range(17)), [0, *range(16, 0, -1)])


def test_caps_of_any_size():
    # From a nanometer to all but a cap as small, about a center off the axes.
    rng = np.random.default_rng(12)
    center = np.array([0.5, -0.3, 0.2])
    for size in (1e-16, 1e-12, 1e-6, 1e-2, 1.0):
        way = np.cross(center, rng.normal(size=(200, 3)))
        for sign in (1.0, -1.0):
            mesh = sphere.Delaunay(xyz=[*(center + size * way), *(sign * center + size * way[:3])])
            assert mesh.covers_sphere == (sign < 0)
            check_topology(mesh)
            check_locally(mesh)


def test_many_rows_of_few_directions():
    rng = np.random.default_rng(8)
    lattice = np.array(LATTICE, dtype=float)
    rows = rng.integers(len(lattice), size=5000)
    vectors = lattice[rows] * rng.choice([1.0, 2.0, 3.0, 5.0, 0.1 * 10], size=(5000, 1))
    mesh = sphere.Delaunay(xyz=vectors)
    check_topology(mesh)
    firsts = {}
    for row, vector in enumerate(vectors.astype(int).tolist()):
        scale = np.gcd.reduce(vector)
        firsts.setdefault(tuple(np.array(vector) // scale), []).append(row)
    for rows in firsts.values():
        assert set(mesh.duplicate_of[rows].tolist()) == {rows[0]}


def test_too_few_directions_and_great_circles():
    for vectors in ([], [(1, 2, 3)], [(1, 2, 3), (2, 4, 6)], [(1, 0, 0), (-2, 0, 0)]):
        with pytest.raises(delone.DegenerateInputError) as caught:
            sphere.Delaunay(xyz=np.array(vectors, dtype=float).reshape(-1, 3))
        assert caught.value.reason == "too few points"
        assert "`error.chain` has the first row of each" in str(caught.value)
        assert len(caught.value.chain) == len({tuple(np.sign(v)) for v in vectors})
    # A meridian, from degrees: rows in order around it.
    latitudes = [10.0, 90.0, -45.0, 80.0, -90.0, 0.0]
    lonlat = [(37.25, b) for b in latitudes] + [(-142.75, 30.0), (217.25, 30.0)]
    with pytest.raises(delone.DegenerateInputError) as caught:
        sphere.Delaunay(lonlat=lonlat)
    assert caught.value.reason == "one great circle"
    chain = caught.value.chain.tolist()
    want = [4, 2, 5, 0, 3, 1, 6]
    turned = [want[i:] + want[:i] for i in range(7)]
    assert chain in turned + [each[::-1] for each in turned]


def test_the_chain_of_a_lattice_circle_goes_around_once():
    rng = random.Random(9)
    circle = [(a, b, -a - b) for a in range(-4, 5) for b in range(-4, 5) if (a, b) != (0, 0)]
    rng.shuffle(circle)
    with pytest.raises(delone.DegenerateInputError) as caught:
        sphere.Delaunay(xyz=circle)
    chain = [circle[row] for row in caught.value.chain.tolist()]
    assert len(chain) == len(set(oracle.firsts([oracle.whole(v) for v in circle])))
    normal = (1, 1, 1)
    turns = {oracle.orient(normal, a, b) for a, b in pairwise([*chain, chain[0]])}
    assert turns in ({1}, {-1})
    sizes = [np.arctan2(b - (c := -a - b), np.sqrt(3) * a) for a, b, _ in chain]
    assert sum(abs(x - y) > np.pi for x, y in pairwise([*sizes, sizes[0]])) == 1
    assert c is not None


@pytest.mark.parametrize(
    ("lonlat", "rows"),
    [
        ([(0, 0), (10, 90.1), (0, -91)], [1, 2]),
        ([(0, 0), (1081, 0), (0, 1)], [1]),
        ([(45, 120), (50, 130), (40, 10)], [0, 1]),
    ],
)
def test_angles_beyond_what_there_is_are_refused(lonlat, rows):
    with pytest.raises(delone.DirectionError, match=f"first row {rows[0]}") as caught:
        sphere.Delaunay(lonlat=lonlat)
    assert caught.value.rows.tolist() == rows
    assert caught.value.count == len(rows)


def test_rows_without_a_direction_are_named():
    with pytest.raises(delone.DirectionError, match="first row 1") as caught:
        sphere.Delaunay(xyz=[(1, 0, 0), (0, 0, -0.0), (0, 1, 0), (0, 0, 0)])
    assert caught.value.rows.tolist() == [1, 3]
    with pytest.raises(delone.NonFiniteError) as finite:
        sphere.Delaunay(xyz=[(1, 0, 0), (0, np.nan, 0), (0, 1, 0)])
    assert finite.value.rows.tolist() == [1]
    with pytest.raises(delone.NonFiniteError):
        sphere.Delaunay(lonlat=[(1, 0), (0, np.inf), (0, 1)])


def test_arguments():
    corners = [(0, 0), (90, 0), (0, 90)]
    for wrong in ({}, {"lonlat": corners, "xyz": np.eye(3)}):
        with pytest.raises(TypeError, match="give one of"):
            sphere.Delaunay(**wrong)
    with pytest.raises(delone.ShapeError, match="see lonlat"):
        sphere.Delaunay(xyz=corners)
    with pytest.raises(delone.ShapeError, match="see xyz"):
        sphere.Delaunay(lonlat=np.eye(3))
    with pytest.raises(delone.InputError):
        sphere.Delaunay(lonlat=corners, degrees="no")


def test_two_conventions_of_longitudes_are_reported():
    with pytest.warns(sphere.LongitudeWarning, match=r"-170 \(row 0\) to 350 \(row 2\)"):
        mesh = sphere.Delaunay(lonlat=[(-170, 0), (190, 0), (350, 10), (10, 20)])
    assert mesh.duplicates.tolist() == [[1, 0]]
    assert np.allclose(mesh.lonlat, [(-170, 0), (-170, 0), (-10, 10), (10, 20)])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("longitudes", [(-180, 0, 180), (0, 120, 360), (-0.5, 120, 359.5)])
def test_one_convention_is_no_reason_to_warn(longitudes):
    sphere.Delaunay(lonlat=[*((lon, 0) for lon in longitudes), (30, 30), (100, -50)])


def test_it_is_immutable_and_can_be_pickled():
    mesh = sphere.Delaunay(lonlat=[(0, 90), (0, 0), (120, 0), (-120, 0)])
    again = pickle.loads(pickle.dumps(mesh))
    assert repr(again) == repr(mesh) == "<Delaunay of 4 directions: 3 triangles>"
    assert np.array_equal(again.simplices, mesh.simplices)
    for name in ("vectors", "points", "lonlat", "simplices", "neighbors", "areas", "edges"):
        assert not getattr(mesh, name).flags.writeable
    with pytest.raises(AttributeError):
        mesh.simplices = mesh.simplices


def test_vectors_are_copied():
    vectors = np.eye(3)
    mesh = sphere.Delaunay(xyz=vectors)
    vectors[:] = 0
    assert np.array_equal(mesh.vectors, np.eye(3))
