"""Diagrams of points in space: duality, exact measures, nearest sites, clips, ties, weights."""

from __future__ import annotations

import copy
import itertools
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import Delaunay, RegularTriangulation, Voronoi
from delone.errors import DegenerateInputError, InputError, NonFiniteError, ShapeError
from delone.predicates import insphere
from rational import Vector, cross, dot, minus, ulps
from rational import exact as exact_points
from tiers import examples

GRID = np.array(list(itertools.product(range(4), repeat=3)), dtype=float)


def uniform(n: int, seed: int) -> Any:
    return np.random.default_rng(seed).random((n, 3))


def meeting(planes: list[tuple[Vector, Fraction]]) -> Vector | None:
    """Where three planes n . x = c meet."""
    (a, ca), (b, cb), (c, cc) = planes
    det = dot(a, cross(b, c))
    if det == 0:
        return None
    parts = cross(b, c), cross(c, a), cross(a, b)
    x, y, z = ((ca * parts[0][k] + cb * parts[1][k] + cc * parts[2][k]) / det for k in range(3))
    return x, y, z


def exact_center(corners: list[Vector], weights: list[Fraction] | None = None) -> Vector:
    a, *others = corners
    w, *heavy = weights or [Fraction(0)] * 4
    planes = []
    for p, v in zip(others, heavy, strict=True):
        way = minus(p, a)
        planes.append((way, (dot(p, p) - dot(a, a) - v + w) / 2))
    found = meeting(planes)
    assert found is not None
    return found


def exact_volume(planes: list[tuple[Vector, Fraction]]) -> Fraction:
    """The volume where n . x <= c for all planes: corners by brute force, faces in turn."""
    corners = {
        p
        for three in itertools.combinations(planes, 3)
        if (p := meeting(list(three))) is not None and all(dot(n, p) <= c for n, c in planes)
    }
    if len(corners) < 4:
        return Fraction(0)
    middle = tuple(sum((p[k] for p in corners), Fraction(0)) / len(corners) for k in range(3))
    volume = Fraction(0)
    for normal, offset in {
        (tuple(x / max(map(abs, n)) for x in n), c / max(map(abs, n))) for n, c in planes
    }:
        face = [p for p in corners if dot(normal, p) == offset]
        if len(face) < 3:
            continue
        # Triangles of all pairs that have the rest of the face on one side of them.
        for p, q in itertools.permutations(face, 2):
            side = cross(normal, minus(q, p))
            turns = [dot(side, minus(r, p)) for r in face if r not in (p, q)]
            between = [
                r
                for r in face
                if r not in (p, q)
                and dot(side, minus(r, p)) == 0
                and 0 < dot(minus(r, p), minus(q, p)) < dot(minus(q, p), minus(q, p))
            ]
            if all(t >= 0 for t in turns) and not between:
                o = face[0]
                volume += dot(minus(o, middle), cross(minus(p, middle), minus(q, middle))) / 6
    return volume


def exact_cells(points: Any, weights: Any, bounds: Any) -> list[Fraction]:
    """Volumes of the cells within a box, by all half-spaces."""
    sites = exact_points(points)
    heavy = [Fraction(w) for w in np.asarray(weights, dtype=float).tolist()]
    (low, high) = exact_points(bounds)
    box = []
    for k in range(3):
        axis = [Fraction(0)] * 3
        axis[k] = Fraction(1)
        box += [(tuple(axis), high[k]), (tuple(-x for x in axis), -low[k])]
    found = []
    for i, p in enumerate(sites):
        planes = list(box)
        for j, q in enumerate(sites):
            if j != i:
                offset = (dot(q, q) - dot(p, p) + heavy[i] - heavy[j]) / 2
                planes.append((minus(q, p), offset))
        found.append(exact_volume(planes))
    return found


@pytest.mark.parametrize("offset", [0.0, -0.5, 1e4])
@pytest.mark.parametrize("stretch", [1.0, 1e-7])
def test_vertices_are_within_four_units_in_the_last_place(offset: float, stretch: float) -> None:
    points = uniform(60, 1) * [1.0, 1.0, stretch] + offset
    diagram = Voronoi(points)
    assert diagram.triangulation is not None
    exact = exact_points(points)
    for corners, vertex in zip(
        diagram.triangulation.simplices.tolist(), diagram.simplex_vertices, strict=True
    ):
        center = exact_center([exact[v] for v in corners])
        for found, true in zip(diagram.vertices[vertex].tolist(), center, strict=True):
            assert ulps(found, true) <= 4


def test_points_of_three_coordinates_make_a_diagram_of_space() -> None:
    diagram = Voronoi(uniform(20, 0))
    assert type(diagram) is Voronoi
    assert diagram.ndim == 3
    again = pickle.loads(pickle.dumps(diagram))
    assert type(again) is Voronoi
    assert np.array_equal(again.vertices, diagram.vertices)
    assert copy.deepcopy(diagram) is diagram
    with pytest.raises(AttributeError):
        diagram.vertices = None  # type: ignore[misc, assignment]
    assert type(Voronoi([(0, 0), (1, 0), (0, 1)])) is Voronoi


def tied(points: Any, mesh: Any, t: int, other: int) -> bool:
    apex = mesh.simplices[other][mesh.neighbors[other] == t][0]
    return bool(insphere(*points[mesh.simplices[t]], points[apex]) == 0)


@pytest.mark.parametrize("seed", range(4))
def test_each_ridge_is_the_dual_of_an_edge_of_polytopes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 4, (60, 3)).astype(float) if seed % 2 else rng.random((60, 3))
    diagram = Voronoi(points)
    mesh: Any = diagram.triangulation
    vertex = diagram.simplex_vertices
    for t, k in np.ndindex(mesh.simplices.shape):
        other = mesh.neighbors[t, k]
        if other >= 0:
            assert tied(points, mesh, t, other) == (vertex[t] == vertex[other])
    assert set(vertex.tolist()) == set(range(len(diagram.vertices)))
    around: dict[tuple[int, ...], set[int]] = {}
    for t, row in enumerate(mesh.simplices.tolist()):
        for edge in itertools.combinations(sorted(row), 2):
            around.setdefault(edge, set()).add(int(vertex[t]))
    hull = {
        edge
        for face in mesh.convex_hull.tolist()
        for edge in itertools.combinations(sorted(face), 2)
    }
    seen = set()
    for pair, vertices in zip(diagram.ridge_points, diagram.ridge_vertices, strict=True):
        edge = tuple(sorted(pair.tolist()))
        seen.add(edge)
        assert set(vertices) - {-1} == around[edge]
        assert len(set(vertices)) == len(vertices) >= 3 - (edge in hull)
        assert (-1 in vertices) == (edge in hull)
    assert len(seen) == len(diagram.ridge_points)
    # Edges without a ridge are diagonals: their ridge would have no area.
    for edge, vertices in around.items():
        if edge not in seen:
            assert len(vertices) <= 2
        elif edge not in hull:
            assert len(vertices) >= 3


def test_ridges_go_round_as_seen_from_the_second_site() -> None:
    diagram = Voronoi(uniform(120, 3))
    for (a, b), ridge in zip(diagram.ridge_points, diagram.ridge_vertices, strict=True):
        if -1 in ridge:
            assert ridge[0] == -1
            continue
        corners = diagram.vertices[ridge]
        way = diagram.points[b] - diagram.points[a]
        around = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0])
        assert (around @ way > -1e-12 * np.abs(corners).max() ** 2).all()
        middle = (diagram.points[a] + diagram.points[b]) / 2
        size = np.abs(corners).max()
        assert np.abs((corners - middle) @ way).max() < 1e-13 * size


def test_rays_are_orthogonal_to_faces_of_the_hull_and_lead_outward() -> None:
    points = uniform(100, 4)
    diagram = Voronoi(points)
    mesh: Any = diagram.triangulation
    a, b, c = np.moveaxis(points[mesh.convex_hull], 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    rays = diagram.rays
    open_ridges = [i for i, ridge in enumerate(diagram.ridge_vertices) if -1 in ridge]
    assert sorted(rays.ridge.tolist()) == sorted(open_ridges * 2)
    assert np.abs(np.linalg.norm(rays.direction, axis=1) - 1).max() < 1e-15
    assert (np.abs(rays.direction @ normals.T - 1).min(axis=1) < 1e-14).all()
    assert {tuple(row) for row in rays.origin.tolist()} <= set(
        map(tuple, diagram.vertices.tolist())
    )


def test_regions_have_the_vertices_of_their_ridges() -> None:
    for points in (uniform(150, 5), GRID):
        diagram = Voronoi(points)
        of_site: dict[int, set[int]] = {i: set() for i in range(len(points))}
        for pair, ridge in zip(diagram.ridge_points, diagram.ridge_vertices, strict=True):
            for site in pair.tolist():
                of_site[site] |= set(ridge)
        for site, region in enumerate(diagram.point_region.tolist()):
            assert diagram.regions[region] == sorted(of_site[site])


def test_a_grid_has_cubes_for_cells() -> None:
    diagram = Voronoi(GRID, clip=((-0.5,) * 3, (3.5,) * 3))
    assert len(diagram.vertices) == 27
    assert {tuple(v) for v in diagram.vertices.tolist()} == set(
        itertools.product((0.5, 1.5, 2.5), repeat=3)
    )
    inner = [ridge for ridge in diagram.ridge_vertices if -1 not in ridge]
    assert {len(ridge) for ridge in inner} == {4}
    assert len(diagram.ridge_points) == 3 * 4 * 4 * 3
    assert diagram.cell_volumes == pytest.approx(np.ones(64), rel=1e-15)
    assert diagram.cell_areas == pytest.approx(np.full(64, 6.0), rel=1e-15)
    assert diagram.cell_centroids == pytest.approx(GRID, abs=1e-15)
    assert set(diagram.neighbors.sizes.tolist()) == {1.0}
    for i in (0, 21, 63):
        cell = diagram.cell(i)
        assert (len(cell.vertices), sorted(map(len, cell.faces))) == (8, [4] * 6)


def test_volumes_are_those_of_rational_arithmetic() -> None:
    points = np.random.default_rng(6).integers(0, 30, (9, 3)) / 2
    points = np.unique(points, axis=0)
    bounds = ((-3.0, -2.0, -5.0), (17.0, 16.0, 21.0))
    exact = exact_cells(points, np.zeros(len(points)), bounds)
    assert sum(exact) == 20 * 18 * 26
    found = Voronoi(points, clip=bounds).cell_volumes
    assert found == pytest.approx([float(v) for v in exact], rel=1e-13)


@settings(max_examples=examples(12, deep=50), deadline=None)
@given(st.lists(st.tuples(*[st.integers(0, 3)] * 3), min_size=5, max_size=9, unique=True))
@pytest.mark.deep
def test_cells_of_lattice_points_are_exact_in_a_box(sites: list[tuple[int, int, int]]) -> None:
    points = np.array(sites, dtype=float)
    bounds = ((-1.0, -1.0, -1.0), (4.0, 4.0, 4.0))
    try:
        diagram = Voronoi(points, clip=bounds)
    except DegenerateInputError:
        return
    exact = exact_cells(points, np.zeros(len(points)), bounds)
    assert diagram.cell_volumes == pytest.approx([float(v) for v in exact], rel=1e-12, abs=1e-12)
    assert sum(exact) == 125


@pytest.mark.parametrize("points", [uniform(400, 7), GRID, uniform(200, 8) * [1, 1, 1e-6]])
def test_bounded_cells_are_the_hulls_of_their_vertices(points: Any) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    diagram = Voronoi(points)
    for site in range(0, len(points), 7):
        region = diagram.regions[diagram.point_region[site]]
        if -1 in region:
            assert np.isinf(diagram.cell_volumes[site])
            assert np.isnan(diagram.cell_centroids[site]).all()
            assert diagram.cell(site).faces == ()
            continue
        corners = diagram.vertices[region]
        scale = np.ptp(corners, axis=0)
        hull = spatial.ConvexHull((corners - corners[0]) / scale, qhull_options="QJ Pp")
        assert diagram.cell_volumes[site] == pytest.approx(hull.volume * scale.prod(), rel=1e-6)
        check_body(diagram.cell(site))


def check_body(cell: Any) -> None:
    """Faces close the cell, each edge once each way, and have its measures."""
    edges = [
        (int(u), int(v))
        for face in cell.faces
        for u, v in zip(face, np.roll(face, -1), strict=True)
    ]
    assert len(set(edges)) == len(edges)
    assert {(v, u) for u, v in edges} == set(edges)
    assert len(cell.vertices) - len(edges) // 2 + len(cell.faces) == 2
    origin = cell.vertices[0]
    volume = area = 0.0
    for face in cell.faces:
        corners = cell.vertices[face] - origin
        around = np.cross(corners[1:-1] - corners[0], corners[2:] - corners[0]).sum(axis=0) / 2
        area += float(np.linalg.norm(around))
        volume += float(corners[0] @ around) / 3
    assert volume == pytest.approx(cell.volume, rel=1e-9)
    assert area == pytest.approx(cell.area, rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_clipped_cells_tile_the_box_and_have_the_queries_nearest_to_them(seed: int) -> None:
    points = uniform(300, seed) if seed else GRID / 3
    diagram = Voronoi(points, clip="box")
    size = np.ptp(points, axis=0).prod()
    assert diagram.cell_volumes.sum() == pytest.approx(size, rel=1e-13)
    weighted = (diagram.cell_volumes[:, None] * diagram.cell_centroids).sum(axis=0) / size
    assert weighted == pytest.approx((points.min(axis=0) + points.max(axis=0)) / 2, rel=1e-12)
    bodies = {site: diagram.cell(site) for site in range(0, len(points), 11)}
    for site, cell in bodies.items():
        check_body(cell)
        distance = ((points - cell.centroid) ** 2).sum(axis=1)
        assert distance[site] <= distance.min() * (1 + 1e-9)
        inside = cell.vertices.mean(axis=0) * 0.01 + cell.vertices * 0.99
        apart = ((inside[:, None] - points) ** 2).sum(axis=2)
        assert (apart[:, site] <= apart.min(axis=1) * (1 + 1e-9)).all()


def test_both_cells_say_the_same_of_a_face() -> None:
    diagram = Voronoi(uniform(200, 9), clip=((0.1,) * 3, (0.8, 0.9, 1.5)))
    indptr, indices, areas = diagram.neighbors
    owner = np.repeat(np.arange(diagram.npoints), np.diff(indptr))
    table = dict(zip(zip(owner.tolist(), indices.tolist(), strict=True), areas, strict=True))
    assert all(table[j, i] == area for (i, j), area in table.items())
    for i in range(0, 200, 9):
        cell = diagram.cell(i)
        assert sorted(cell.beyond[cell.beyond >= 0].tolist()) == cell.neighbors.tolist()


def test_convex_polyhedra_clip() -> None:
    points = uniform(150, 10)
    tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    halfspaces = [(-1, 0, 0, 0), (0, -2, 0, 0), (0, 0, -1, 0), (1, 1, 1, -1)]
    by_points = Voronoi(points, clip=tetrahedron)
    by_planes = Voronoi(points, clip=halfspaces)
    assert by_points.cell_volumes.sum() == pytest.approx(1 / 6, rel=1e-13)
    assert by_planes.cell_volumes == pytest.approx(by_points.cell_volumes, rel=1e-11, abs=1e-16)
    mesh = Delaunay(uniform(40, 11))
    volumes = Voronoi(points, clip=mesh).cell_volumes
    assert volumes.sum() == pytest.approx(mesh.volumes.sum(), rel=1e-12)
    assert (Voronoi(points, clip=((2, 2, 2), (3, 3, 3))).cell_volumes.sum()) == pytest.approx(1)


@pytest.mark.parametrize(
    ("clip", "message"),
    [
        ("ball", "clip must be"),
        (((0, 0, 0), (1, 0, 1)), "no volume"),
        ([(1, 0, 0, -1), (0, 1, 0, -1), (0, 0, 1, -1)], "unbounded in the direction"),
        ([(1, 0, 0, 1), (-1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1)], "no point"),
        ([(0, 0, 0, 1), (1, 0, 0, 1)], "not a half-space"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], "span no volume"),
        (((0, 0, 0), (1, float("nan"), 1)), "NaN or infinity"),
        ([(0, 0), (1, 1)], "clip must be"),
    ],
)
def test_clips_that_are_none_are_refused(clip: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Voronoi(uniform(10, 0), clip=clip)


def test_bad_input_gets_what_it_gets_in_the_plane() -> None:
    with pytest.raises(DegenerateInputError):
        Voronoi([(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)])
    with pytest.raises(NonFiniteError):
        Voronoi([(0, 0, float("nan")), (1, 0, 1), (0, 1, 1), (1, 1, 1)])
    with pytest.raises(InputError, match="2-D"):
        Voronoi(uniform(10, 0), periods=(1, 1))
    diagram = Voronoi(uniform(10, 0))
    with pytest.raises(AttributeError, match="only available in 2-D: `cell` has the faces"):
        diagram.polygons()
    for name in ("cell_perimeters", "ridge_offsets"):
        assert not hasattr(diagram, name)
    for name in ("cell_volumes", "ridge_areas"):
        assert hasattr(diagram, name) and not hasattr(Voronoi([(0, 0)]), name)


def test_duplicates_share_a_cell() -> None:
    points = np.concatenate((uniform(30, 12), uniform(30, 12)[::3]))
    diagram = Voronoi(points, clip="box")
    assert diagram.point_region[30:].tolist() == diagram.point_region[:30:3].tolist()
    assert diagram.duplicate_of[30:].tolist() == list(range(0, 30, 3))
    assert diagram.cell_volumes[:30].sum() == pytest.approx(np.ptp(points, axis=0).prod())
    assert diagram.cell(30).site == 0


def test_polyhedra_of_pyvista() -> None:
    pytest.importorskip("pyvista")
    diagram = Voronoi(uniform(40, 14), clip="box")
    grid = diagram.to_pyvista()
    assert grid.n_cells == 40
    assert grid.cell_data["site"].tolist() == list(range(40))
    assert np.array_equal(grid.cell_data["volume"], diagram.cell_volumes)
    assert grid.n_points == sum(len(diagram.cell(i).vertices) for i in range(40))
    assert np.array_equal(grid.points[: len(diagram.cell(0).vertices)], diagram.cell(0).vertices)


def test_answers_hang_neither_on_rows_nor_on_workers() -> None:
    points = np.concatenate((uniform(200, 13), GRID / 7))
    one, two = Voronoi(points, workers=1), Voronoi(points, workers=2)
    assert np.array_equal(one.vertices, two.vertices)
    assert one.ridge_vertices == two.ridge_vertices
    order = np.random.default_rng(0).permutation(len(points))
    shuffled = Voronoi(points[order])
    expected = sorted(map(tuple, one.vertices.tolist()))
    assert sorted(map(tuple, shuffled.vertices.tolist())) == expected
    pairs = {frozenset(pair) for pair in order[shuffled.ridge_points].tolist()}
    assert pairs == {frozenset(pair) for pair in one.ridge_points.tolist()}


@pytest.mark.parametrize("scale", [1e-150, 1e150, 5e-324, 1e300])
def test_the_ends_of_the_range_are_no_exception(scale: float) -> None:
    points = np.array(list(itertools.product(range(3), repeat=3))) * scale
    diagram = Voronoi(points)
    assert len(diagram.vertices) == 8
    assert {len(ridge) for ridge in diagram.ridge_vertices if -1 not in ridge} == {4}
    assert len(diagram.ridge_points) == 54
    assert np.isfinite(diagram.vertices).all()


@pytest.mark.parametrize(
    ("power", "weighted"),
    [(p, False) for p in (-1000, -530, -400, 400, 530, 900)] + [(p, True) for p in (-400, 400)],
)
@pytest.mark.filterwarnings("error")
def test_a_power_of_two_changes_no_neighbour(power: int, weighted: bool) -> None:
    """Areas and volumes beyond the range are infinite, and below it not 0; faces remain."""
    scale = 2.0**power
    points = np.concatenate((uniform(60, 3) - 0.5, GRID[:27] / 4))
    weights = np.random.default_rng(4).random(87) / 16 if weighted else None
    heavier = None if weights is None else weights * scale**2
    low, high = np.array((-0.4, -0.6, -0.5)), np.array((0.6, 0.5, 0.25))
    for box in (None, (low, high)):
        plain = Voronoi(points, weights=weights, clip=box)
        scaled = None if box is None else (low * scale, high * scale)
        found = Voronoi(points * scale, weights=heavier, clip=scaled)
        assert found.neighbors.indptr.tolist() == plain.neighbors.indptr.tolist()
        assert found.neighbors.indices.tolist() == plain.neighbors.indices.tolist()
        with np.errstate(all="ignore"):
            least = np.nextafter(0, 1)
            for name, times in (("volumes", 3), ("areas", 2)):
                wanted = getattr(plain, f"cell_{name}")
                expected = wanted.copy()
                for _ in range(times):
                    expected *= scale
                expected = np.where(wanted > 0, np.maximum(expected, least), 0)
                assert getattr(found, f"cell_{name}") == pytest.approx(
                    expected, rel=1e-12, abs=4e-322
                )
            areas = plain.neighbors.sizes * scale * scale
        assert found.neighbors.sizes == pytest.approx(
            np.maximum(areas, least), rel=1e-12, abs=4e-322
        )
        centroids = found.cell_centroids / scale
        assert centroids == pytest.approx(plain.cell_centroids, abs=1e-13, nan_ok=True)
        for site in range(0, len(points), 9):
            one, other = plain.cell(site), found.cell(site)
            assert sorted(one.beyond.tolist()) == sorted(other.beyond.tolist())
            size = np.ptp(one.vertices, axis=0) if len(one.vertices) else np.zeros(3)
            wide = np.ptp(other.vertices, axis=0) if len(other.vertices) else np.zeros(3)
            assert wide == pytest.approx(size * scale, rel=1e-11)


def test_a_vertex_beyond_the_range_is_a_ray() -> None:
    points = [(0, 0, 0), (1, 0, 5e-324), (-1, 1, 5e-324), (-1, -1, 5e-324), (0, 0, -1.0)]
    diagram = Voronoi(points)
    assert (diagram.simplex_vertices == -1).any()
    assert np.isfinite(diagram.vertices).all()
    beyond = np.flatnonzero(diagram.simplex_vertices == -1)
    corners = set(diagram.triangulation.simplices[beyond].ravel().tolist())  # type: ignore[union-attr]
    assert all(-1 in diagram.regions[diagram.point_region[site]] for site in corners)


SITES = st.lists(st.tuples(*[st.integers(0, 3)] * 3, st.integers(-2, 5)), min_size=5, max_size=14)


def least_power(mesh: RegularTriangulation) -> Fraction:
    """Prove that no site lies below the lifted plane of a tetrahedron; six times all volumes."""
    sites = exact_points(mesh.points)
    heights = [dot(p, p) - Fraction(w) for p, w in zip(sites, mesh.weights.tolist(), strict=True)]
    total = Fraction(0)
    for corners in mesh.simplices.tolist():
        origin = sites[corners[0]]
        rows = [minus(sites[v], origin) for v in corners[1:]]
        volume = dot(rows[0], cross(rows[1], rows[2]))
        assert volume > 0
        total += volume
        slope = meeting(
            [
                (row, heights[v] - heights[corners[0]])
                for row, v in zip(rows, corners[1:], strict=True)
            ]
        )
        assert slope is not None
        for p, height in zip(sites, heights, strict=True):
            assert height >= heights[corners[0]] + dot(slope, minus(p, origin))
    return total


@settings(max_examples=examples(12, deep=120), deadline=None)
@given(SITES)
def test_the_lower_side_of_the_lifted_hull(sites: list[tuple[int, int, int, int]]) -> None:
    table = np.array(sites, dtype=float)
    points, weights = table[:, :3], table[:, 3]
    try:
        mesh = RegularTriangulation(points, weights)
    except DegenerateInputError:
        with pytest.raises(DegenerateInputError):
            Delaunay(points)
        return
    whole = Delaunay(points)
    assert least_power(mesh) == 6 * Fraction(float(whole.volumes.sum())).limit_denominator(6)
    for t, k in np.ndindex(mesh.neighbors.shape):
        other = mesh.neighbors[t, k]
        if other >= 0:
            assert t in mesh.neighbors[other]
            assert len(set(mesh.simplices[t]) & set(mesh.simplices[other])) == 3
    order = np.random.default_rng(1).permutation(len(table))
    again = RegularTriangulation(points[order], weights[order])
    assert named(again) == named(mesh)


def named(mesh: RegularTriangulation) -> set[frozenset[tuple[float, ...]]]:
    table = np.column_stack((mesh.points, mesh.weights))
    return {frozenset(map(tuple, table[row].tolist())) for row in mesh.simplices}


@pytest.mark.parametrize("points", [uniform(300, 1), GRID, uniform(40, 2)])
def test_equal_weights_give_the_delaunay_triangulation(points: Any) -> None:
    mesh = RegularTriangulation(points, np.full(len(points), 0.75))
    plain = Delaunay(points)
    sets = [{frozenset(row) for row in m.simplices.tolist()} for m in (mesh, plain)]
    assert sets[0] == sets[1]
    assert not len(mesh.hidden)
    powered = Voronoi(points, weights=np.full(len(points), 0.75), clip="box")
    volumes = Voronoi(points, clip="box").cell_volumes
    assert powered.cell_volumes == pytest.approx(volumes, rel=1e-9, abs=1e-12)


def test_a_light_site_is_hidden() -> None:
    cube = list(itertools.product((0, 4), repeat=3))
    mesh = RegularTriangulation([*cube, (2, 2, 2)], [0] * 8 + [-12])
    assert repr(mesh) == "<RegularTriangulation of 9 points (1 hidden): 6 tetrahedra>"
    assert mesh.hidden.tolist() == [8]
    diagram = Voronoi([*cube, (2, 2, 2)], weights=[0] * 8 + [-12])
    assert diagram.hidden.tolist() == [8]
    assert diagram.cell_volumes[8] == 0
    assert not len(diagram.cell(8).neighbors)


@settings(max_examples=examples(12, deep=50), deadline=None)
@given(SITES.filter(lambda sites: len({s[:3] for s in sites}) == len(sites) < 10))
@pytest.mark.deep
def test_power_cells_in_a_box_are_those_of_all_half_spaces(
    sites: list[tuple[int, int, int, int]],
) -> None:
    table = np.array(sites, dtype=float)
    bounds = ((-2.0, -1.0, -1.0), (4.0, 5.0, 4.0))
    try:
        diagram = Voronoi(table[:, :3], weights=table[:, 3], clip=bounds)
    except DegenerateInputError:
        return
    exact = exact_cells(table[:, :3], table[:, 3], bounds)
    assert sum(exact) == 6 * 6 * 5
    assert diagram.cell_volumes == pytest.approx([float(v) for v in exact], rel=1e-11, abs=1e-11)


def test_queries_belong_to_the_site_of_least_power() -> None:
    rng = np.random.default_rng(3)
    points, weights = rng.random((150, 3)), rng.random(150) * 0.05
    diagram = Voronoi(points, weights=weights, clip="box")
    assert diagram.cell_volumes.sum() == pytest.approx(np.ptp(points, axis=0).prod(), rel=1e-12)
    for site in np.setdiff1d(np.arange(150), diagram.hidden)[::7].tolist():
        cell = diagram.cell(site)
        if cell.volume > 0:
            power = ((points - cell.centroid) ** 2).sum(axis=1) - weights
            assert power[site] <= power.min() + 1e-12


def test_weights_are_checked() -> None:
    with pytest.raises(ShapeError):
        RegularTriangulation(uniform(10, 0), [1, 2])
    with pytest.raises(DegenerateInputError):
        RegularTriangulation([(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)], [0, 1, 2, 3])


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1.0, 1e90])
@pytest.mark.filterwarnings("error")
def test_half_spaces_and_hulls_of_any_size(scale: float) -> None:
    sites = np.random.default_rng(0).random((40, 3))
    planes = [(1, 0, 0, -1), (-1, 0, 0, 0), (0, 1, 0, -1), (0, -1, 0, 0), (0, 0, 1, -1)]
    planes.append((0, 0, -1, 0))
    diagram = Voronoi(sites, clip=np.array(planes) * scale)
    assert diagram.cell_volumes.sum() == pytest.approx(1, rel=1e-12)
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * scale
    diagram = Voronoi(sites * scale, clip=corners)
    box = Voronoi(sites * scale, clip=(corners[0], corners[-1]))
    assert np.array_equal(diagram.neighbors.indices, box.neighbors.indices)
    diagram = Voronoi(sites, clip=np.array(planes) * 1e300)
    assert diagram.cell_volumes.sum() == pytest.approx(1, rel=1e-12)
    with pytest.raises(InputError, match="normal is zero"):
        Voronoi(sites, clip=[*planes, (0, 0, 0, -1)])


def test_a_picture_without_a_window() -> None:
    pyvista = pytest.importorskip("pyvista")
    diagram = Voronoi(uniform(5, 2), clip="box")
    plotter = diagram.plot(off_screen=True, color="white", scalars=None)
    assert plotter.off_screen and len(plotter.actors) == 1
    plotter.close()
    own = pyvista.Plotter(off_screen=True)
    assert diagram.plot(own) is own
    with pytest.raises(InputError, match="new plotter"):
        diagram.plot(own, off_screen=True)
    own.close()
    with pytest.raises(InputError, match="off_screen must be True, False or None"):
        diagram.plot(off_screen="yes")


def test_ridges_have_the_areas_of_their_polygons() -> None:
    points = uniform(40, 12)
    diagram = Voronoi(points)
    closed = [-1 not in ridge for ridge in diagram.ridge_vertices]
    assert 0 < sum(closed) < len(closed)
    for ridge, whole, area in zip(
        diagram.ridge_vertices, closed, diagram.ridge_areas.tolist(), strict=True
    ):
        if not whole:
            assert area == np.inf
            continue
        around = diagram.vertices[ridge]
        sides = around[1:] - around[0]
        turned = np.cross(sides[:-1], sides[1:]).sum(axis=0) / 2
        assert area == pytest.approx(np.linalg.norm(turned), rel=1e-8, abs=1e-12)


def test_in_a_clip_ridges_have_the_areas_of_what_is_left() -> None:
    # Sites of a grid: each cell is a cube, but for the outer ones, which the clip makes boxes.
    diagram = Voronoi(GRID, clip=((-1.0, -1, -1), (3.5, 3.5, 3.5)))
    size = np.array([1.5, 1.0, 1.0, 1.0])
    expected = []
    for a, b in GRID[diagram.ridge_points].astype(int):
        other = np.flatnonzero(a == b)
        expected.append(np.prod(size[a[other]]) if len(other) == 2 else 0.0)
    assert sorted(set(expected)) == [1.0, 1.5, 2.25]
    assert diagram.ridge_areas.tolist() == pytest.approx(expected, rel=1e-14)
