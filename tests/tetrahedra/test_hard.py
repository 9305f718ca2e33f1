"""Surfaces that are hard to fill: notches, slits, spikes, wedges, and extreme coordinates.

Each is recovered twice: with flips, and by points alone, which otherwise are the rare case.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone import _core

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from solids import Surface

DRAFTS = Path(__file__).parents[3] / "shared" / "data" / "surfaces" / "tetgentests"
WIDTHS = [2.0**-3, 1e-5, 1e-10]


def column(outline: Sequence[tuple[float, float]]) -> Surface:
    """An outline extruded; its first vertex sees all others."""
    n = len(outline)
    points = [(x, y, z) for z in (0.0, 1.0) for x, y in outline]
    faces = [face for k in range(1, n - 1) for face in ((0, k + 1, k), (n, n + k, n + k + 1))]
    for k in range(n):
        j = (k + 1) % n
        faces += [(k, j, n + k), (j, n + j, n + k)]
    return np.array(points), np.array(faces)


def slit(width: float) -> Surface:
    """A block with a slit from one side to beyond its middle."""
    return column([(1, 2), (4, 2 + width), (4, 4), (0, 4), (0, 0), (4, 0), (4, 2 - width)])


def spike(width: float) -> Surface:
    """A block with a thin needle of ten times its height."""
    side = [(0.5 + width, 1.0), (0.5, 10.0), (0.5 - width, 1.0)]
    return column([(0.5, 0.0), (1.0, 0.0), (1.0, 1.0), *side, (0.0, 1.0), (0.0, 0.0)])


def wedge(width: float) -> Surface:
    return column([(0.0, 0.0), (1.0, -width), (1.0, width)])


def notches(count: int, gap: float = 0.125) -> Surface:
    """A block with notches from above and below whose edges nearly meet, all on a saddle.

    Faces have no consistent orientation.
    """
    size, high, half = 4.0, 20.0, 0.25
    corners = [(x, y, z) for z in (-high, high) for y in (-size, size) for x in (-size, size)]
    points, faces = list(corners), []
    middle = [2.0 * k - count + 1.0 for k in range(count)]
    rows: dict[tuple[int, int, int, str], int] = {}
    for above in (1, 0):
        for k, m in enumerate(middle):
            for end, along in enumerate((-size, size)):
                tip = m * along + (gap if above else -gap)
                z = high if above else -high
                for name, across, height in (
                    ("low", m - half, z),
                    ("tip", m, tip),
                    ("high", m + half, z),
                ):
                    rows[above, k, end, name] = len(points)
                    points.append((across, along, height) if above else (along, across, height))
    for above in (1, 0):
        at = lambda k, end, name, above=above: rows[above, k, end, name]  # noqa: E731
        # The corners at the rim of the notches, by the side across and the end along.
        base = 4 * above
        rim = [[base, base + 2], [base + 1, base + 3]] if above else [[0, 1], [2, 3]]
        far = 4 - base
        other = [[far, far + 2], [far + 1, far + 3]] if above else [[4, 5], [6, 7]]
        for k in range(count):
            for one in ("low", "high"):
                quad = [at(k, 0, one), at(k, 0, "tip"), at(k, 1, "tip"), at(k, 1, one)]
                faces += [quad[:3], [quad[0], quad[2], quad[3]]]
        edges = [rim[0]]
        for k in range(count):
            edges += [[at(k, 0, "low"), at(k, 1, "low")], [at(k, 0, "high"), at(k, 1, "high")]]
        edges.append(rim[1])
        for (a, b), (c, d) in zip(edges[::2], edges[1::2], strict=True):
            faces += [[a, b, c], [b, d, c]]
        for end in (0, 1):
            tips = [at(k, end, "tip") for k in range(count)]
            first, last = other[0][end], other[1][end]
            faces += [[first, a, b] for a, b in pairwise(tips)]
            faces += [[first, last, tips[-1]]]
            faces += [[first, rim[0][end], at(0, end, "low")]]
            faces += [[first, at(0, end, "low"), tips[0]]]
            faces += [[last, rim[1][end], at(count - 1, end, "high")]]
            faces += [[last, at(count - 1, end, "high"), tips[-1]]]
            for k in range(count - 1):
                a, b = at(k, end, "high"), at(k + 1, end, "low")
                faces += [[tips[k], a, b], [tips[k], b, tips[k + 1]]]
    return np.array(points), np.array(faces)


def shells(count: int) -> Surface:
    """Boxes in boxes, alternately turned."""
    parts = []
    for k in range(count):
        points, faces = solids.box((k, k, k), (20 - k, 20 - k, 20 - k))
        parts.append((points, faces[:, ::-1] if k % 2 else faces))
    return solids.joined(*parts)


def star(count: int, least: float, seed: int) -> Surface:
    """Random directions, their distances at random between a number and 1."""
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    hull = delone.ConvexHull(points)
    return hull.points * random.uniform(least, 1.0, (count, 1)), hull.simplices


SURFACES: dict[str, Callable[[], Surface]] = {
    **{f"slit {w:g}": lambda w=w: slit(w) for w in WIDTHS},  # type: ignore[misc]
    **{f"spike {w:g}": lambda w=w: spike(w) for w in WIDTHS},  # type: ignore[misc]
    **{f"wedge {w:g}": lambda w=w: wedge(w) for w in WIDTHS},  # type: ignore[misc]
    "notches 1": lambda: notches(1),
    "notches 2": lambda: notches(2),
    "notches 3": lambda: notches(3),
    "notches 4": lambda: notches(4),
    "shells": lambda: shells(7),
    "Schoenhardt": solids.schoenhardt,
    "torus": solids.torus,
}


def judge(mesh: delone.TetMesh, points: Any, faces: Any) -> None:
    """Judge in fractions: positive tetrahedra, all faces, and the volume that these enclose."""
    assert np.array_equal(mesh.points[: len(points)], points)
    uses = solids.triangles(mesh.simplices)
    assert set(uses.values()) <= {1, 2}
    assert {frozenset(face) for face in np.asarray(faces).tolist()} <= set(uses)
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(mesh.points, mesh.boundary)
    assert mesh.validate(), str(mesh.validate())


@pytest.mark.parametrize("name", SURFACES)
def test_with_flips(name: str) -> None:
    points, faces = SURFACES[name]()
    check = delone.check_surface(points, faces)
    assert check and check.closed and not check.npairs
    mesh = delone.tetrahedralize(points, faces, inside="parity")
    judge(mesh, points, faces)


def test_a_try_that_was_given_up_leaves_the_segment_behind() -> None:
    # Flips for one goal do not reach it, but the segment is an edge when they end: it was then
    # searched for as missing, and the error said that an edge contains a vertex.
    points, faces = star(1000, 0.3, 5)
    judge(delone.tetrahedralize(points, faces), points, faces)


@pytest.mark.parametrize("name", SURFACES)
def test_by_points_alone(name: str) -> None:
    points, faces = SURFACES[name]()
    made = _core.recover_faces(points, faces.astype(np.int32), 1_000_000, False, 1)
    assert not len(made.crowded)
    assert made.counts.flipped_edges == made.counts.flipped_faces == 0
    assert np.array_equal(made.points[: len(points)], points)
    uses = solids.triangles(made.tetrahedra)
    assert set(uses.values()) <= {1, 2}
    assert {frozenset(face) for face in faces.tolist()} <= set(uses)
    # All that is enclosed, by whichever rule.
    whole = delone.tetrahedralize(points, faces, inside="enclosed")
    wanted = solids.filled(whole.points, whole.simplices)
    assert solids.filled(made.points, made.tetrahedra) == wanted


@pytest.mark.parametrize(("thickness", "fits"), [(1, False), (2, True), (9, True)])
def test_points_alone_among_the_smallest_doubles(thickness: int, fits: bool) -> None:
    # Vectors between such points were too short for doubles, and the recovery ended with "a sector
    # has no point". A slab one double thick has no room for points, and the error says so.
    depth = (18, 18 + thickness)
    points = np.array([(x, y, z) for x in (-6, -3) for y in depth for z in (-30, -2)])
    faces = [(1, 3, 2), (1, 2, 0), (4, 6, 7), (4, 7, 5), (4, 5, 0), (5, 1, 0)]
    faces += [(2, 3, 6), (3, 7, 6), (2, 6, 4), (2, 4, 0), (1, 5, 7), (1, 7, 3)]
    rows = np.array(faces, dtype=np.int32)
    for scale in (1.0, 5e-324):
        made = _core.recover_faces(points * scale, rows, 1_000_000, False, 1)
        if fits or scale == 1.0:
            volume = solids.filled(made.points, made.tetrahedra)
            assert volume == Fraction(3 * 28 * thickness) * Fraction(scale) ** 3
        else:
            assert not len(made.tetrahedra)
            assert len(made.crowded)


@pytest.mark.parametrize("name", ["Schoenhardt", "notches 2"])
def test_points_alone_are_in_any_order_the_same(name: str) -> None:
    points, faces = SURFACES[name]()
    rng = np.random.default_rng(1)
    row, face = rng.permutation(len(points)), rng.permutation(len(faces))
    other = np.argsort(row)[faces[face]].astype(np.int32)
    first = _core.recover_faces(points, faces.astype(np.int32), 1_000_000, False, 1)
    second = _core.recover_faces(points[row], other, 1_000_000, False, 3)
    one, two = (
        sorted(sorted(map(tuple, made.points[corners].tolist())) for corners in made.tetrahedra)
        for made in (first, second)
    )
    assert one == two
    assert len(first.points) > len(points)


@pytest.mark.parametrize("count", [1, 4, 7])
def test_volumes_of_shells(count: int) -> None:
    points, faces = shells(count)
    sizes = [Fraction(20 - 2 * k) ** 3 for k in range(count)]
    wanted = sum((size * (-1) ** k for k, size in enumerate(sizes)), Fraction(0))
    mesh = delone.tetrahedralize(points, faces)
    assert solids.filled(mesh.points, mesh.simplices) == wanted


@pytest.mark.parametrize("surface", [solids.torus, lambda: slit(2.0**-3)])
@pytest.mark.parametrize("scale", [1e300, 2.0**-1060, 1e-310])
def test_extreme_coordinates(surface: Callable[[], Surface], scale: float) -> None:
    """Subnormal numbers are a lattice: rounding to it makes another surface, which is judged."""
    points, faces = surface()
    points = points * scale
    assert np.isfinite(points).all()
    check = delone.check_surface(points, faces)
    assert check
    judge(delone.tetrahedralize(points, faces), points, faces)


def test_the_least_box() -> None:
    points, faces = solids.box((0, 0, 0), (5e-324, 5e-324, 5e-324))
    mesh = delone.tetrahedralize(points, faces)
    judge(mesh, points, faces)
    assert solids.filled(mesh.points, mesh.simplices) == Fraction(5e-324) ** 3


@pytest.mark.skipif(not DRAFTS.is_dir(), reason="needs public surfaces")
@pytest.mark.parametrize("kind", ["slit", "spike", "wedge"])
def test_public_drafts(kind: str) -> None:
    paths = sorted((DRAFTS / "testingdrafts").glob(f"{kind}-*.smesh"))
    assert len(paths) >= 5
    for path in paths:
        # Facets of these files turn in any direction, so all that they enclose is filled.
        mesh = delone.tetrahedralize(path)
        assert mesh.validate(), path.name
        with pytest.raises(delone.InputError, match="oriented alike"):
            delone.tetrahedralize(path, inside="winding")
