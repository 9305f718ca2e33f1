"""`validate` of triangulations of directions: proofs of right arrays, and what wrong ones get."""

from __future__ import annotations

import itertools
import random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import directions as oracle
from delone import datasets, sphere
from delone._tiling.plane import topology
from delone.sphere.exact import _sign_of_roots, circles, turns, turns_at, whole
from delone.sphere.validation import validate

if TYPE_CHECKING:
    from numpy.typing import NDArray

CUBE = list(itertools.product((-1.0, 1.0), repeat=3))
LATTICE = [v for v in itertools.product(range(-2, 3), repeat=3) if any(v)]
SCATTERED = np.random.default_rng(3).normal(size=(70_000, 3))
NAMES = ("vectors", "simplices", "neighbors", "duplicates")

SETS: dict[str, Any] = {
    "cube": CUBE,
    "cube and axes": [*CUBE, (1, 0, 0), (0, 1, 0)],
    "lattice": LATTICE,
    "upper half, closed": [v for v in LATTICE if v[2] >= 0],
    "upper half": [v for v in LATTICE if v[2] > 0],
    "three": [(1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "a centimeter apart": np.add((0.5, 0.5, 1), 1e-9 * np.array(LATTICE[:60])),
    "lengths": [np.array(v) * 2.0 ** (k % 7 * 100 - 300) for k, v in enumerate(CUBE)],
    "scattered": SCATTERED[:2000],
}


def checked(vectors: Any, simplices: Any, **others: Any) -> Any:
    """The report of triangles, whose neighbors follow from them unless they are given."""
    vectors = np.array(vectors, dtype=float)
    simplices = np.array(simplices, dtype=np.int32)
    beside = others.get("neighbors", topology.neighbors(simplices, len(vectors)))
    again = others.get("duplicates", np.empty((0, 2), dtype=np.int32))
    units = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return validate(vectors, units, simplices, beside, again)


def flipped(mesh: sphere.Delaunay, t: int, k: int) -> NDArray[np.int32]:
    """The triangles with the edge opposite corner k of triangle t flipped."""
    simplices = np.array(mesh.simplices)
    u = mesh.neighbors[t, k]
    a, b, c = (simplices[t, (k + i) % 3] for i in range(3))
    d = simplices[u, mesh.neighbors[u].tolist().index(t)]
    simplices[t], simplices[u] = (a, b, d), (a, d, c)
    return simplices


@pytest.mark.parametrize("name", SETS)
def test_right(name: str) -> None:
    mesh = sphere.Delaunay(xyz=SETS[name])
    assert mesh.validate().ok, str(mesh.validate())


def test_edges_that_are_not_delaunay() -> None:
    mesh = sphere.Delaunay(xyz=SCATTERED)
    # Triangles whose pairs lie beyond the first block of rows.
    for t in range(60_000, 60_050):
        report = checked(mesh.vectors, flipped(mesh, t, 1))
        if not report.orientation.size:
            break
    pair = sorted((t, int(mesh.neighbors[t, 1])))
    assert pair in np.sort(report.delaunay, axis=1).tolist()
    assert not report.ties.size


def test_ties() -> None:
    mesh = sphere.Delaunay(xyz=CUBE)
    found = 0
    for t, k in itertools.product(range(12), range(3)):
        report = checked(CUBE, flipped(mesh, t, k))
        # The diagonal of a face; at other edges triangles turn over.
        if not report.orientation.size:
            pair = sorted((t, int(mesh.neighbors[t, k])))
            assert report.ties.tolist() == [pair]
            assert not report.delaunay.size
            assert "not canonical" in str(report)
            found += 1
    assert found == 12


def test_a_surface_that_covers_the_sphere_twice() -> None:
    turn = np.radians(120 * np.arange(6) + np.array([0, 0, 0, 5, 5, 5]))
    around = np.column_stack((np.cos(turn), np.sin(turn), np.zeros(6)))
    vectors = [(0, 0, 1), (0, 0, -1), *around]
    upper = [(0, 2 + i, 2 + (i + 1) % 6) for i in range(6)]
    lower = [(1, 2 + (i + 1) % 6, 2 + i) for i in range(6)]
    report = checked(vectors, upper + lower)
    # Each direction is in two triangles.
    assert len(report.overlaps) == 1
    assert not report.count.size
    assert "overlaps the first one" in str(report)


def test_a_hull_that_winds_twice() -> None:
    turn = np.radians(144 * np.arange(5))
    star = np.column_stack((np.cos(turn), np.sin(turn), np.full(5, 2.0)))
    report = checked([(0, 0, 1), *star], [(0, 1 + i, 1 + (i + 1) % 5) for i in range(5)])
    assert len(report.overlaps)
    assert not report.hull.size
    assert not report.count.size


def test_a_notch_in_a_hull() -> None:
    mesh = sphere.Delaunay(xyz=[(-1, -1, 2), (1, -1, 2), (1, 1, 2), (-1, 1, 2), (0, 0.3, 2)])
    t = np.flatnonzero((mesh.neighbors < 0).any(axis=1))[0]
    report = checked(mesh.vectors, mesh.simplices[np.arange(4) != t])
    # The boundary turns right at vertex 4.
    assert 4 in report.hull[:, 1]
    assert not report.delaunay.size


def test_wrong_elements() -> None:
    mesh = sphere.Delaunay(xyz=[*LATTICE, (4, 4, 4)])
    arrays = {name: np.array(getattr(mesh, name)) for name in NAMES}
    rest = {name: arrays[name] for name in ("neighbors", "duplicates")}
    simplices = arrays["simplices"].copy()
    simplices[5] = simplices[5, ::-1]
    assert checked(mesh.vectors, simplices, **rest).edges.size
    swapped = arrays["neighbors"].copy()
    swapped[3, [0, 1]] = swapped[3, [1, 0]]
    report = checked(mesh.vectors, arrays["simplices"], **rest | {"neighbors": swapped})
    assert report.neighbors.tolist() == [3]
    vectors = np.vstack((mesh.vectors, [(1, 5, 9)]))
    report = checked(vectors, arrays["simplices"], duplicates=arrays["duplicates"])
    assert report.missing.tolist() == [len(mesh.vectors)]
    assert report.count.size == 2
    wrong = arrays["duplicates"].copy()
    wrong[0, 1] += 1
    report = checked(mesh.vectors, arrays["simplices"], duplicates=wrong)
    assert report.repeats.tolist() == [wrong[0, 0]]
    # A triangle turned over by its vertex.
    vectors = mesh.vectors.copy()
    vectors[0] = -vectors[0]
    assert checked(vectors, arrays["simplices"], duplicates=arrays["duplicates"]).orientation.size


def test_arcs() -> None:
    vectors = np.random.default_rng(5).normal(size=(60, 3))
    rows = np.random.default_rng(6).integers(0, 60, size=(25, 2))
    mesh = sphere.ConstrainedDelaunay(xyz=vectors, segments=rows, crossing="split")
    assert mesh.nadded
    assert mesh.validate().ok, str(mesh.validate())
    # Without the exemption of arcs it is not Delaunay.
    assert checked(mesh.vectors, mesh.simplices).delaunay.size
    # Another arc in the place of the first has other ends, and is not covered.
    given = mesh._given._replace(segments=np.roll(mesh.input_segments, 1, axis=0))
    other = sphere.ConstrainedDelaunay._restored(mesh.vectors, given, mesh._made, True, None)
    assert other.validate().uncovered.size


def test_a_vertex_that_bends_an_arc() -> None:
    sites = [(0, 0), (20, 0), (10, 0), (10, 20), (10, -20)]
    mesh = sphere.ConstrainedDelaunay(lonlat=sites, segments=[(0, 1)])
    assert mesh.report.through.tolist() == [[0, 2]]
    assert mesh.validate().ok
    moved = mesh.vectors.copy()
    moved[2, 2] = 1e-12
    other = sphere.ConstrainedDelaunay._restored(moved, mesh._given, mesh._made, True, None)
    assert other.validate().bent.tolist() == [[0, 2]]


def test_the_shipped_coast() -> None:
    mesh = sphere.from_geometry(datasets.land())
    assert mesh.validate().ok, str(mesh.validate())


@pytest.mark.parametrize("seed", range(8))
def test_signs_against_integers(seed: int) -> None:
    rng = random.Random(seed)
    spread = rng.choice((1.0, 1e-4, 1e-9, 1e-15))
    middle = np.array([rng.gauss(0, 1) for _ in range(3)])
    pool = [middle + spread * np.array([rng.gauss(0, 1) for _ in range(3)]) for _ in range(8)]
    pool = [v * 2.0 ** rng.randint(-400, 400) for v in pool]
    if seed % 2:
        pool += [np.array(v, dtype=float) for v in rng.sample(LATTICE, 6) + CUBE[:4]]
    vectors = np.array(pool)
    mesh = sphere.Delaunay(xyz=vectors)
    units, given_ = mesh.points, [oracle.whole(v) for v in vectors.tolist()]
    rows = list(itertools.permutations(range(len(vectors)), 4))
    rows = [r for r in rng.sample(rows, 150) if oracle.orient(*(given_[v] for v in r[:3])) > 0]
    four = np.array(rows, dtype=np.int32).reshape(-1, 4)
    plain, broken = circles(vectors, units, four)
    for row, sign, canonical in zip(rows, plain.tolist(), broken.tolist(), strict=True):
        given = [given_[v] for v in row]
        assert sign == oracle.in_circle(*given)
        distinct = all(oracle.compare(given[3], v) for v in given[:3])
        flat = sign == 0 and oracle.orient(*given[1:]) == oracle.orient(*given[:2], given[3]) == 0
        if distinct and not flat:
            assert (canonical > 0) == oracle.is_inside(*given)
    corners = [vectors[four[:, k]] for k in range(3)]
    assert (turns(*corners) > 0).all()
    place = whole(vectors[0].tolist())
    signs = turns_at(vectors, units, four[:, :2], place)
    assert signs.tolist() == [oracle.orient(given_[r[0]], given_[r[1]], place) for r in rows]


def test_doubtful_signs_beyond_the_first_block() -> None:
    vectors = np.array([*CUBE, (1.0, 2.0, 3.0)])
    units = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    # Faces of the cube tie; most rows do not.
    # Four corners of a face tie; the other rows do not.
    plain_row, tie = (6, 2, 7, 8), (7, 5, 1, 3)
    assert oracle.orient(*(tuple(map(int, vectors[v])) for v in tie[:3])) != 0
    rows = np.array([plain_row] * 66_000 + [tie] * 5, dtype=np.int32)
    plain, broken = circles(vectors, units, rows)
    assert (plain[:66_000] != 0).all()
    assert (plain[66_000:] == 0).all()
    assert (broken[66_000:] != 0).all()


def test_sums_of_roots_that_almost_vanish() -> None:
    for n in (10, 2**40, 2**60, 2**500):
        # Of equal sums under the roots, those farther apart have the smaller sum of roots.
        four = [n, n + 3, n + 1, n + 2]
        assert _sign_of_roots(four, [1, 1, -1, -1]) == -1
        assert _sign_of_roots(four, [-1, -1, 1, 1]) == 1
        assert _sign_of_roots([n, n + 3, n + 3, n], [1, 1, -1, -1]) == 0
        assert _sign_of_roots([4 * n, n, n, 0], [1, -1, -1, 0]) == 0
