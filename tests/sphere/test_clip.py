"""Cells of directions clipped to polygons: known areas, and brute force at sampled places."""

from __future__ import annotations

import itertools
import pickle
import random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import directions as oracle
from delone import datasets, sphere

if TYPE_CHECKING:
    from pathlib import Path

AXES = [(0, 90), (0, 0), (90, 0), (180, 0), (-90, 0), (0, -90)]
CUBE = list(itertools.product((-1, 1), repeat=3))
NORTH = [(0, 0), (90, 0), (180, 0), (270, 0)]
LEFT: dict[str, Any] = {"winding": "ccw", "sides": "arc"}

# Regions here have few corners on purpose; what is said of it is tested elsewhere.
pytestmark = pytest.mark.filterwarnings("ignore::delone.sphere.PolygonWarning")


def polygon(*rings: Any) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": [list(ring) for ring in rings]}


def cap(latitude: float, count: int = 12) -> list[tuple[float, float]]:
    return [(360 / count * k - 180, latitude) for k in range(count)]


def square(lon: float, lat: float, size: float) -> list[tuple[float, float]]:
    return [
        (lon - size, lat - size),
        (lon + size, lat - size),
        (lon + size, lat + size),
        (lon - size, lat + size),
    ]


# Regions, of which each interior is to the left of the outer ring.
REGIONS: dict[str, Any] = {
    "northern half": polygon(NORTH),
    "around the pole": polygon(cap(40)),
    "around the south pole": polygon(cap(-35)[::-1]),
    "across the date line": polygon(square(180, 10, 30)),
    "hole": polygon(square(20, 5, 40), square(25, 0, 15)[::-1]),
    "ring around the sphere": polygon(cap(-20), cap(25)[::-1]),
    "notch": polygon([(-60, -50), (60, -50), (60, 50), (5, 50), (0, -40), (-5, 50), (-60, 50)]),
    "two parts": [polygon(square(0, 0, 20)), polygon(square(170, -50, 20))],
    "overlapping": [polygon(square(0, 0, 20)), polygon(square(10, 10, 20))],
    "nearly all": polygon(square(100, 20, 5)[::-1]),
}


def whole_of(region: Any) -> list[list[list[Any]]]:
    """The rings of each polygon as vectors of integers, from the documented meaning of degrees."""
    parts = region if isinstance(region, list) else [region]
    found = []
    for part in parts:
        rings = []
        for ring in part["coordinates"]:
            vectors = sphere.Delaunay(lonlat=[*ring, *AXES]).vectors[: len(ring)]
            rings.append([oracle.whole(v) for v in vectors.tolist()])
        found.append(rings)
    return found


def is_inside(rings: list[Any], inner: Any, place: Any) -> bool | None:
    """Whether a place is in a polygon, like `inner`; None where an arc meets a corner."""
    crossings = 0
    for ring in rings:
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
            signs = [oracle.orient(a, b, inner), oracle.orient(a, b, place)]
            others = [oracle.orient(inner, place, a), oracle.orient(inner, place, b)]
            if 0 in signs + others:
                return None
            # Both arcs are shorter than half a circle and cross on the same side of the sphere.
            if signs[0] != signs[1] and others[0] != others[1] and others[0] == -signs[0]:
                crossings += 1
    return crossings % 2 == 0


def near(ring: Any) -> Any:
    """A place just left of the middle of the first side of a ring."""
    a, b = (np.array([float(x) for x in v]) / max(map(abs, v)) for v in ring[:2])
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    left = np.cross(a, b)
    return oracle.whole(((a + b) / np.linalg.norm(a + b) + 1e-6 * left).tolist())


def inside_any(parts: list[Any], place: Any) -> bool | None:
    found = []
    for rings in parts:
        # By way of another place, as the shorter arc to the opposite one is not unique.
        answers = is_inside(rings, near(rings[0]), place)
        if answers is None:
            return None
        found.append(answers)
    return any(found)


def area_left(ring: Any) -> float:
    """The area left of a ring, 0 to 4 pi: solid angles of triangles from a fixed direction."""
    lon, lat = np.radians(np.array(ring, dtype=float)).T
    a = np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    b, c = np.roll(a, -1, axis=0), np.array((0.48, -0.6, 0.64))
    det = np.einsum("ij,ij->i", np.cross(a, b), np.broadcast_to(c, a.shape))
    total = 2 * np.arctan2(det, 1 + (a * b).sum(axis=1) + a @ c + b @ c).sum()
    return float(total % (4 * np.pi))


@pytest.mark.parametrize("name", [name for name in REGIONS if name != "overlapping"])
def test_areas_sum_to_that_of_the_region(name: str) -> None:
    region = REGIONS[name] if isinstance(REGIONS[name], list) else [REGIONS[name]]
    expected = 0.0
    for part in region:
        outer, *holes = part["coordinates"]
        expected += area_left(outer) - sum(area_left(hole[::-1]) for hole in holes)
    for sites in (CUBE, np.random.default_rng(7).normal(size=(500, 3))):
        diagram = sphere.Voronoi(xyz=sites, clip=REGIONS[name], **LEFT)
        assert np.isclose(diagram.cell_areas.sum(), expected, rtol=1e-12)


@pytest.mark.parametrize("name", REGIONS)
@pytest.mark.parametrize("kind", ["scattered", "cube", "hemisphere", "circle"])
@pytest.mark.sampled(6)
def test_sampled_places_are_in_the_right_cells(name: str, kind: str) -> None:
    rng = np.random.default_rng(len(name))
    sites: Any = {
        "scattered": rng.normal(size=(25, 3)),
        "cube": CUBE,
        "hemisphere": np.abs(rng.normal(size=(9, 3))),
        "circle": [(1, 0, 0), (0, 1, 0), (-3, 1, 0), (-1, -5, 0), (9, -1, 0)],
    }[kind]
    diagram = sphere.Voronoi(xyz=sites, clip=REGIONS[name], **LEFT)
    whole = sphere.Voronoi(xyz=sites)
    assert (diagram.cell_areas <= whole.cell_areas + 1e-12).all()
    # Places, exactly inside or outside; none of them is within rounding of two cells.
    parts = whole_of(REGIONS[name])
    places = rng.normal(size=(3000, 3))
    units = diagram.points
    hits = np.zeros(len(sites))
    count = 0
    left = diagram._left
    labels = left.cell[left.mesh.find_simplex(places)]
    for place, label in zip(places, labels.tolist(), strict=True):
        inside = inside_any(parts, oracle.whole(place.tolist()))
        if inside is None:
            continue
        owner = int((units @ place).argmax())
        assert label == (owner if inside else -1)
        count += 1
        hits[owner] += inside
    assert count > 2900
    assert np.allclose(hits / count * 4 * np.pi, diagram.cell_areas, atol=0.25)


def test_octahedron() -> None:
    half = sphere.Voronoi(lonlat=AXES, clip=polygon(NORTH), radius=2.0)
    assert np.allclose(half.cell_areas / (4 * np.pi), np.array([2, 1, 1, 1, 1, 0]) / 3)
    # Half a ridge down from each corner of the northern cell.
    upright = np.arccos(1 / 3)
    indptr, indices, sizes = half.neighbors
    assert np.allclose(sizes[: indptr[1]], 2 * upright)
    assert indices[indptr[1] : indptr[2]].tolist() == [0, 2, 4]
    assert np.allclose(sizes[indptr[1] : indptr[2]], [2 * upright, upright, upright])
    # An octant, with a corner at three sites and one at a vertex of the diagram.
    octant = sphere.Voronoi(lonlat=AXES, clip=polygon([(0, 0), (90, 0), (0, 90)]))
    assert np.allclose(octant.cell_areas, np.array([1, 1, 1, 0, 0, 0]) * np.pi / 6)
    corner = np.degrees(np.arctan(np.sqrt(0.5)))
    lune = sphere.Voronoi(lonlat=AXES, clip=polygon([(45, corner), (45, -corner), (90, 0)]))
    assert np.flatnonzero(lune.cell_areas > 1e-12).tolist() == [2]


def test_a_region_along_ridges() -> None:
    """The cells of a cube's vertices are octants: sides along ridges, through vertices."""
    octant = polygon([(0, 0), (90, 0), (0, 90)])
    diagram = sphere.Voronoi(xyz=CUBE, clip=octant)
    assert np.allclose(diagram.cell_areas, [0] * 7 + [np.pi / 2])
    assert [len(parts) for parts in diagram.polygons()] == [0] * 7 + [1]
    quarter = polygon([(-90, 0), (0, 0), (90, 0), (0, 90)])
    diagram = sphere.Voronoi(xyz=CUBE, clip=quarter)
    assert np.flatnonzero(diagram.cell_areas > 0).tolist() == [5, 7]
    assert np.allclose(diagram.neighbors.sizes, np.pi / 2)


@pytest.mark.parametrize("seed", range(6))
def test_rounded_ridges_make_no_slivers(seed: int) -> None:
    rng = random.Random(seed)
    step = rng.choice((10, 15, 20))
    grid = [(x + step / 2, y) for x in range(-180, 180, step) for y in range(-60, 61, step)]
    west, south = step * rng.randint(-5, 3), step * rng.randint(-2, 0) - step / 2
    east, north = west + 2 * step, south + 2 * step
    # Sides along the meridians between cells; not along parallels, which are no great circles.
    box = polygon([(west, south), (east, south), (east, north), (west, north)])
    diagram = sphere.Voronoi(lonlat=grid, clip=box)
    region = sphere.from_geometry(box)
    assert np.isclose(diagram.cell_areas.sum(), region.areas[region.polygon_of_simplex >= 0].sum())
    lon = np.array(grid)[diagram.cell_areas > 0, 0]
    assert (lon > west).all()
    assert (lon < east).all()
    # Cells across the sides are no neighbors.
    assert (diagram.cell_areas[diagram.neighbors.indices] > 0).all()
    assert [len(parts) for parts in diagram.polygons()] == (diagram.cell_areas > 0).tolist()


def test_polygons() -> None:
    notch = sphere.Voronoi(lonlat=[(0, 0), (170, 5), (90, 80), (90, -80)], clip=REGIONS["notch"])
    # The notch divides the northern cell, and leaves the first one whole and not convex.
    parts = notch.polygons()
    assert [len(each) for each in parts] == [1, 0, 2, 1]
    assert [len(rings) for each in parts for rings in each] == [1, 1, 1, 1]
    hole = sphere.Voronoi(lonlat=AXES, clip=polygon(square(0, 0, 40), square(0, 0, 20)[::-1]))
    (outer, inner), *others = hole.polygons()[1]
    assert not others
    assert np.abs(outer).max() > 39
    assert np.allclose(np.abs(inner).max(), 20)
    # Counter-clockwise outside, clockwise inside.
    assert signed(outer) > 0 > signed(inner)
    assert hole.polygons()[2] == []
    twice = sphere.Voronoi(lonlat=[*AXES, AXES[1]], clip=polygon(square(0, 0, 9)))
    assert np.array_equal(twice.polygons()[6][0][0], twice.polygons()[1][0][0])
    assert twice.cell_areas[6] == twice.cell_areas[1]


def signed(ring: np.ndarray) -> float:
    x, y = ring.T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def test_polygons_are_the_cells() -> None:
    diagram = sphere.Voronoi(
        xyz=np.random.default_rng(2).normal(size=(60, 3)), clip=datasets.land()
    )
    again = []
    for parts in diagram.polygons():
        area = 0.0
        for rings in parts:
            mesh = sphere.from_geometry(
                [
                    {"type": "Polygon", "coordinates": rings},
                    {"type": "MultiPoint", "coordinates": AXES},
                ]
            )
            area += float(mesh.areas[mesh.polygon_of_simplex == 0].sum())
        again.append(area)
    assert np.allclose(again, diagram.cell_areas, atol=1e-9)
    land = sphere.from_geometry(datasets.land())
    total = land.areas[land.polygon_of_simplex >= 0].sum()
    assert np.isclose(diagram.cell_areas.sum(), total, rtol=1e-13)
    whole = sphere.Voronoi(lonlat=AXES).polygons()
    assert [len(rings[0]) for parts in whole for rings in parts] == [4] * 6


def test_neighbors_are_symmetric_and_inside() -> None:
    diagram = sphere.Voronoi(
        xyz=np.random.default_rng(4).normal(size=(40, 3)), clip=REGIONS["hole"]
    )
    indptr, indices, sizes = diagram.neighbors
    rows = np.repeat(np.arange(40), np.diff(indptr))
    table = {(int(a), int(b)): s for a, b, s in zip(rows, indices, sizes, strict=True)}
    assert table
    assert all(table[b, a] == size for (a, b), size in table.items())
    assert (diagram.cell_areas[rows] > 0).all()
    whole = sphere.Voronoi(xyz=diagram.vectors)
    lengths = dict(zip(map(tuple, whole.ridge_points.tolist()), whole.ridge_lengths, strict=True))
    shorter = [table[a, b] < length - 1e-9 for (a, b), length in lengths.items() if (a, b) in table]
    assert any(shorter)
    assert not all(shorter)
    assert all(
        table[a, b] <= length + 1e-12 for (a, b), length in lengths.items() if (a, b) in table
    )


def test_other_forms(tmp_path: Path) -> None:
    shapely = pytest.importorskip("shapely")
    box = shapely.Polygon(square(20, 5, 40))
    diagram = sphere.Voronoi(lonlat=AXES, clip=box)
    turned = sphere.Voronoi(lonlat=AXES, clip=box.reverse(), winding="cw")
    assert np.allclose(diagram.cell_areas, turned.cell_areas)
    smaller = sphere.Voronoi(lonlat=AXES, clip=box.reverse(), winding="smaller")
    assert np.allclose(diagram.cell_areas, smaller.cell_areas)
    radians = sphere.Voronoi(
        lonlat=np.radians(AXES), clip=polygon(np.radians(square(20, 5, 40))), degrees=False
    )
    assert np.allclose(diagram.cell_areas, radians.cell_areas)
    mesh = sphere.Delaunay(lonlat=AXES)
    assert np.array_equal(
        sphere.Voronoi.from_delaunay(mesh, clip=box).cell_areas, diagram.cell_areas
    )
    diagram.save(tmp_path / "a.npz")
    for again in (sphere.Voronoi.load(tmp_path / "a.npz"), pickle.loads(pickle.dumps(diagram))):
        assert np.array_equal(again.cell_areas, diagram.cell_areas)
        assert repr(again) == repr(diagram)
        assert "clipped" in repr(again)


def test_a_plot_of_clipped_cells() -> None:
    mpl = pytest.importorskip("matplotlib")
    mpl.use("Agg")
    diagram = sphere.Voronoi(lonlat=AXES, clip=REGIONS["hole"])
    ax = diagram.plot(values=np.arange(6), view=(20, 5))
    image = np.ma.filled(ax.images[0].get_array().astype(float), np.nan)
    # Nothing in the hole or beyond the region.
    assert np.isnan(image[400, 430])
    assert np.isnan(image[400, 790])
    assert image[400, 250] == 1
    assert np.isfinite(image).mean() < 0.5


@pytest.mark.parametrize(
    ("clip", "error", "message"),
    [
        ({"type": "LineString", "coordinates": NORTH}, delone.InputError, "polygons"),
        ([], delone.InputError, "polygons"),
        (5, delone.InputError, "clip: 5"),
        (polygon([(0, 0), (10, 0), (20, 0)]), delone.InputError, "no area"),
        (polygon([(0, 0), (180, 0), (0, 90)]), delone.DirectionError, "opposite"),
        (polygon([(0, 0), (10, 95), (20, 0)]), delone.DirectionError, "latitude"),
        (polygon([(0, 0), (10, np.nan), (20, 0)]), delone.NonFiniteError, "NaN"),
    ],
)
def test_regions_that_are_refused(clip: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        sphere.Voronoi(lonlat=AXES, clip=clip)
