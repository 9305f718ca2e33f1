"""The class TIN: what becomes of points, lines and heights; slopes, profiles and files."""

from __future__ import annotations

import warnings
from fractions import Fraction

import numpy as np
import pytest

from delone import (
    ConflictingValuesError,
    CrossingSegmentsError,
    DtypeError,
    InputError,
    NonFiniteError,
)
from delone.interpolate import Grid, raster
from delone.io import write_mesh
from delone.terrain import TIN, slopes

SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)]


def random_tin(seed: int = 0, **options) -> TIN:
    return TIN.from_points(np.random.default_rng(seed).random((300, 3)), **options)


def test_breaklines_are_edges_with_their_heights():
    tin = TIN.from_points(SQUARE, breaklines=[[(1, 2, 9), (3, 2, 5)]])
    assert tin.heights((2, 2)) == 7
    ends = {frozenset(map(tuple, tin.points[row].tolist())) for row in tin.breaklines}
    assert ends == {frozenset({(1.0, 2.0), (3.0, 2.0)})}
    assert tin.validate()


def test_lines_without_heights_are_on_the_points():
    tin = TIN.from_points(SQUARE, breaklines=[np.array([(1.0, 1), (3.0, 3)])])
    assert tin.heights([(1, 1), (2, 2), (3, 3)]).tolist() == [2, 4, 6]
    with pytest.raises(InputError, match=r"without heights is outside the points at \("):
        TIN.from_points(SQUARE, breaklines=[[(1, 1), (5, 1)]])


@pytest.mark.parametrize(("policy", "z"), [("min", 3), ("max", 5), ("mean", 4)])
def test_conflicts_at_crossings(policy, z):
    lines = [[(1, 1, 3), (3, 3, 3)], [(1, 3, 5), (3, 1, 5)]]
    with pytest.raises(ConflictingValuesError, match=r"at 1 place: \(2, 2\): 3 to 5.*crossing="):
        TIN.from_points(SQUARE, breaklines=lines)
    assert TIN.from_points(SQUARE, breaklines=lines, crossing=policy).heights((2, 2)) == z
    same = [[(1, 1, 2), (3, 3, 6)], [(1, 3, 6), (3, 1, 2)]]
    assert TIN.from_points(SQUARE, breaklines=same).heights((2, 2)) == 4


def test_conflicts_where_a_line_passes_through_another_one_or_a_point():
    with pytest.raises(ConflictingValuesError, match=r"lines .*\(2, 2\)"):
        TIN.from_points(SQUARE, breaklines=[[(1, 2, 0), (3, 2, 0)], [(2, 2, 1), (2, 3, 1)]])
    points = [*SQUARE, (2, 2, 1)]
    with pytest.raises(ConflictingValuesError, match=r"a line and a point .*\(2, 2\): 0 to 1"):
        TIN.from_points(points, breaklines=[[(1, 2, 0), (3, 2, 0)]])


@pytest.mark.parametrize(("policy", "z"), [("min", 1), ("max", 4), ("mean", 2)])
def test_duplicates_with_different_heights(policy, z):
    points = [*SQUARE, (2, 1, 1), (2, 1, 4), (2, 1, 1)]
    with pytest.raises(ConflictingValuesError, match=r"points .*\(2, 1\): 1 to 4") as caught:
        TIN.from_points(points)
    assert caught.value.rows.tolist() == [[5, 4]]
    tin = TIN.from_points(points, duplicates=policy)
    assert tin.npoints == 5 and tin.heights((2, 1)) == z


def test_walls_are_conflicts():
    with pytest.raises(ConflictingValuesError, match=r"\(2, 1\): 0 to 3"):
        TIN.from_points(SQUARE, breaklines=[[(2, 1, 0), (2, 1, 3)]])


def test_bad_heights_are_named():
    with pytest.raises(NonFiniteError, match="xyz: 1 of 4 rows holds NaN"):
        TIN.from_points([*SQUARE[:3], (0, 4, np.nan)])
    with pytest.raises(NonFiniteError, match="breaklines"):
        TIN.from_points(SQUARE, breaklines=[np.array([(1, 1, np.inf), (2, 2, 0)])])


def test_boundary_holes_and_outer_edges():
    x = np.arange(9.0)
    grid = np.array([(i, j, 0.0) for i in x for j in x])
    ring = [(0.5, 0.5), (7.5, 0.5), (7.5, 7.5), (0.5, 7.5)]
    hole = [(2.5, 2.5), (5.5, 2.5), (5.5, 5.5), (2.5, 5.5)]
    tin = TIN.from_points(grid, boundary=[ring], holes=[hole])
    assert tin.areas.sum() == 49 - 9
    assert np.isnan(tin.heights([(4, 4), (0.2, 0.2)])).all()
    assert tin.validate()
    # The bay between two towers of points: two corners of it have short outer edges.
    bay = grid[(grid[:, 1] < 2) | (np.abs(grid[:, 0] - 4) > 2)]
    assert TIN.from_points(bay).areas.sum() == 64
    assert TIN.from_points(bay, max_edge=1.5).areas.sum() == 64 - 6 * 7 + 1
    line = [(1, 5, 0), (7, 5, 0)]
    kept = TIN.from_points(bay, max_edge=1.5, breaklines=[line])
    assert kept.areas.sum() == 64 - 6 * 3
    bowtie = [(1, 1), (7, 7), (7, 1), (1, 7)]
    with pytest.raises(CrossingSegmentsError, match=r"cross at 1 place, first \(4, 4\)"):
        TIN.from_points(grid, boundary=[bowtie])
    with pytest.raises(InputError, match="no triangle is left"):
        TIN.from_points(grid, max_edge=0.1)


def test_rasters_leave_out_cells_without_values():
    values = np.arange(12.0).reshape(3, 4)
    values[0, 0] = np.nan
    tin = TIN.from_raster(Grid(values, np.arange(4.0), np.arange(3.0)))
    assert tin.npoints == 11
    assert tin.heights((2, 1)) == 6
    with pytest.raises(InputError, match="a raster must have"):
        TIN.from_raster(values)


def test_slopes_of_planes():
    for a, b in [(0.0, 0.0), (1.0, 0.0), (0.0, -2.0), (-0.5, 0.25)]:
        xy = np.random.default_rng(1).random((50, 2))
        tin = TIN.from_points(np.column_stack((xy, a * xy[:, 0] + b * xy[:, 1])))
        assert tin.gradients == pytest.approx(np.tile([a, b], (tin.nsimplex, 1)), abs=1e-9)
        assert tin.slope == pytest.approx(np.degrees(np.arctan(np.hypot(a, b))), abs=1e-7)
        if (a, b) == (0, 0):
            assert np.isnan(tin.aspect).all()
            continue
        downhill = np.degrees(np.arctan2(-a, -b)) % 360
        assert np.cos(np.radians(tin.aspect - downhill)) == pytest.approx(1)
        assert tin.normals @ [a, b, -1] == pytest.approx(-np.sqrt(1 + a * a + b * b))


@pytest.mark.parametrize(("azimuth", "altitude", "z_factor"), [(315, 45, 1), (100, 30, 2.5)])
def test_hillshade_is_that_of_gdal(azimuth, altitude, z_factor):
    tin = random_tin()
    # The formula of gdaldem: cos(zenith) cos(slope) + sin(zenith) sin(slope) cos(azimuth - aspect).
    x, y = (tin.gradients * z_factor).T
    zenith, slope = np.radians(90 - altitude), np.arctan(np.hypot(x, y))
    aspect = np.arctan2(-x, -y)
    shade = np.cos(zenith) * np.cos(slope)
    shade += np.sin(zenith) * np.sin(slope) * np.cos(np.radians(azimuth) - aspect)
    found = tin.hillshade(azimuth=azimuth, altitude=altitude, z_factor=z_factor)
    assert found == pytest.approx(np.clip(shade, 0, 1))


def test_slivers_of_a_rotated_grid_are_shaded():
    x, y = map(np.ravel, np.meshgrid(np.arange(31.0), np.arange(31.0)))
    c, s = np.cos(np.radians(25)), np.sin(np.radians(25))
    z = 5 * np.sin(x / 3) + 4 * np.cos(y / 4)
    tin = TIN.from_points(np.column_stack((x * c - y * s, x * s + y * c, z)))
    steep = np.abs(tin.gradients).max(axis=1) > 1e12
    assert 20 < steep.sum() < 200
    assert np.isfinite(tin.gradients).all()
    for factor in (1.0, 1e300):
        shade = tin.hillshade(z_factor=factor)
        assert (shade >= 0).all() and (shade <= 1).all()
    assert np.linalg.norm(tin.normals, axis=1) == pytest.approx(1)
    # The light lies in the plane of the gradient, and both directions are horizontal.
    downhill = np.radians(tin.aspect[steep])
    expected = np.cos(np.radians(45)) * np.cos(downhill - np.radians(315))
    assert tin.hillshade()[steep] == pytest.approx(np.clip(expected, 0, 1), abs=1e-9)
    assert tin.hillshade(z_factor=0) == pytest.approx(np.sin(np.radians(45)))


@pytest.mark.parametrize("unit", [1e-200, 2.0**-700, 1.0, 1e200])
def test_gradients_of_any_size_have_normals(unit):
    tin = TIN.from_points([(0, 0, 0), (unit, 0, 1), (0, unit, 2)])
    assert tin.gradients * unit == pytest.approx(np.array([(1.0, 2.0)]))
    length = np.hypot(np.sqrt(5.0), unit) if unit < 1e100 else unit
    expected = np.array([(-1.0, -2.0, unit)]) / length
    assert tin.normals == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.filterwarnings("error")
def test_heights_with_a_range_beyond_the_largest_double():
    """Slopes and profiles are those of the same heights in a smaller unit."""
    random = np.random.default_rng(8)
    xy = random.random((300, 2)) * 5000
    z = random.choice([-1, 1], 300) * random.uniform(0.1, 1.79, 300)
    small = TIN.from_points(np.column_stack((xy, np.ldexp(z, 100))))
    tall = TIN.from_points(np.column_stack((xy, np.ldexp(z, 1023))))
    inside = np.isfinite(tall.gradients).all(axis=1)
    assert inside.mean() > 0.9
    assert np.array_equal(tall.gradients[inside], np.ldexp(small.gradients[inside], 923))
    assert np.array_equal(tall.slope, small.slope)
    one, two = (tin.profile([(500, 500), (4500, 4000)]) for tin in (tall, small))
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(np.ldexp(one.z, -923), two.z)


@pytest.mark.parametrize("block", [1 << 18, 40])
def test_positions_on_a_slanted_side_have_heights(monkeypatch, block):
    monkeypatch.setattr(slopes, "_BLOCK", block)  # of one row, or of all
    tin = TIN.from_points([(0, 0, 0), (3, 1, 3), (1, 3, 1)])
    side = np.linspace(0, 1, 31)[:, None] * (3, 1)
    assert np.isnan(tin.heights(side)).any()
    assert tin.heights(side, tolerance=1e-15) == pytest.approx(side[:, 0])
    options = {"x": np.linspace(0, 3, 31), "y": np.linspace(0, 1, 31), "tolerance": 1e-15}
    assert np.diagonal(tin.raster(**options).values) == pytest.approx(side[:, 0])
    assert np.diagonal(tin.raster("slope", **options).values) == pytest.approx(45)
    with pytest.raises(InputError, match="tolerance must be at least 0"):
        tin.raster(tolerance=-1, resolution=1)


def test_rasters_sample_the_surface():
    tin = random_tin()
    for what in ("height", "slope", "aspect", "hillshade"):
        found = tin.raster(what, shape=(30, 20))
        assert found.values.shape == (20, 30)
        node = np.array([found.x[7], found.y[11]])
        expected = tin.heights(node)
        if what != "height":
            column = tin.hillshade() if what == "hillshade" else getattr(tin, what)
            expected = column[tin.find_simplex(node)]
        assert found.values[11, 7] == expected
    with pytest.raises(InputError, match="what must be"):
        tin.raster("color", shape=(2, 2))


def exact_profile(tin, a, b):
    """The shares of a segment where it meets edges, and the heights there, by fractions."""
    a, b = ([Fraction(x) for x in p] for p in (a, b))
    found = {}
    for p, q in tin.edges:
        (px, py), (qx, qy) = ([Fraction(x) for x in tin.points[v].tolist()] for v in (p, q))
        dx, dy = b[0] - a[0], b[1] - a[1]
        ex, ey = qx - px, qy - py
        turn = dx * ey - dy * ex
        if not turn:
            continue
        share = ((px - a[0]) * ey - (py - a[1]) * ex) / turn
        along = ((px - a[0]) * dy - (py - a[1]) * dx) / turn
        if 0 < share < 1 and 0 <= along <= 1:
            low, high = Fraction(float(tin.z[p])), Fraction(float(tin.z[q]))
            found[share] = low + along * (high - low)
    return sorted(found.items())


@pytest.mark.parametrize("seed", range(6))
def test_profiles_have_every_crossing(seed):
    tin = random_tin(seed)
    rng = np.random.default_rng(seed)
    a, b = rng.random((2, 2)) * 0.4 + [[0.1, 0.1], [0.5, 0.5]]
    found = tin.profile([a, b])
    expected = exact_profile(tin, a.tolist(), b.tolist())
    length = float(np.hypot(*(b - a)))
    assert found.distances[1:-1] == pytest.approx([float(s) * length for s, _ in expected])
    assert found.z[1:-1] == pytest.approx([float(z) for _, z in expected], abs=1e-9)
    assert found.z[[0, -1]] == pytest.approx(tin.heights([a, b]))


def test_profiles_through_vertices_along_edges_and_over_holes():
    x = np.arange(7.0)
    grid = np.array([(i, j, i * i + j) for i in x for j in x])
    along = TIN.from_points(grid).profile([(0, 3), (6, 3)])
    assert along.distances.tolist() == x.tolist()
    assert along.z.tolist() == (x * x + 3).tolist()
    hole = [(1.5, 1.5), (4.5, 1.5), (4.5, 4.5), (1.5, 4.5)]
    tin = TIN.from_points(grid, holes=[hole])
    found = tin.profile([(-1, 3), (8, 3)])
    assert np.isnan(found.z).sum() == 1
    gap = int(np.flatnonzero(np.isnan(found.z))[0])
    assert found.distances[[0, gap - 1, gap + 1, -1]].tolist() == [1, 2.5, 5.5, 7]
    assert len(tin.profile([(10, 10), (11, 10)])) == 0


def test_bent_lines_have_no_repeated_points():
    found = TIN.from_points(SQUARE).profile([(1, 0.5), (3, 0.5), (3, 2)])
    assert (np.diff(found.distances) > 0).all()
    assert found.distances[-1] == 3.5


def test_geometries_on_the_surface():
    shapely = pytest.importorskip("shapely")
    tin = TIN.from_points(SQUARE)
    ring = tin.drape(shapely.box(1, 1, 3, 3))
    assert ring.has_z and shapely.force_2d(ring).equals(shapely.box(1, 1, 3, 3))
    assert all(z == 2 * y for _, y, z in ring.exterior.coords)
    both = shapely.GeometryCollection([shapely.Point(1, 2), shapely.LineString([(0, 0), (4, 0)])])
    assert shapely.get_coordinates(tin.drape(both), include_z=True)[:, 2].tolist()[0] == 4
    with pytest.raises(InputError, match=r"\(5, 1\) is outside the surface"):
        tin.drape(shapely.LineString([(1, 1), (5, 1)]))


def test_lines_of_sight():
    hill = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)])
    assert not hill.line_of_sight((0, 2), (4, 2), height=1.7)
    # Over the summit, exactly and by a little.
    assert hill.line_of_sight((0, 2), (4, 2), height=3, target=3)
    assert not hill.line_of_sight((0, 2), (4, 2), height=2.99, target=3)
    assert hill.line_of_sight((1, 2), (1, 2))
    assert hill.line_of_sight((0, 2), (2, 2))
    with pytest.raises(InputError, match="outside"):
        hill.line_of_sight((0, 2), (9, 2))


def test_files_and_systems(tmp_path):
    tin = random_tin(crs=28992, breaklines=[[(0.2, 0.2), (0.8, 0.7)]], max_edge=0.2)
    tin.save(tmp_path / "a.npz")
    again = TIN.load(tmp_path / "a.npz")
    for name in ("xyz", "simplices", "neighbors", "breaklines", "soft"):
        assert np.array_equal(getattr(again, name), getattr(tin, name))
    assert again.crs == "EPSG:28992" and again.validate()
    assert again.contours(interval=0.1).crs == "EPSG:28992"


@pytest.mark.parametrize("suffix", [".ply", ".vtu", ".obj"])
def test_exported_files_have_the_heights(suffix, tmp_path):
    meshio = pytest.importorskip("meshio")
    tin = random_tin()
    write_mesh(tmp_path / f"a{suffix}", tin)
    found = meshio.read(tmp_path / f"a{suffix}")
    assert np.allclose(found.points, tin.xyz, rtol=0, atol=1e-15)
    assert np.array_equal(tin.to_meshio().points, tin.xyz)
    write_mesh(tmp_path / f"b{suffix}", tin, z=2 * tin.z)
    assert np.allclose(meshio.read(tmp_path / f"b{suffix}").points[:, 2], 2 * tin.z)


def test_only_the_class_methods_make_a_surface():
    with pytest.raises(TypeError, match="from_points"):
        TIN(SQUARE)


def test_points_outside_of_the_boundary_do_not_count():
    rng = np.random.default_rng(0)
    xy = rng.random((500, 2)) * 100
    z = np.where(xy[:, 0] > 50, 1000.0, 0.0) + rng.random(500)
    inside = [(5, 5), (25, 5), (25, 95), (5, 95)]
    tin = TIN.from_points(np.column_stack((xy, z)), boundary=inside)
    corners = np.unique(tin.simplices)
    low, high = tin.z[corners].min(), tin.z[corners].max()
    assert high < 2 and tin.z.max() > 1000
    assert f"heights {low:.6g} to {high:.6g}" in repr(tin)
    levels = tin.contours(interval=0.25).levels
    assert low <= levels.min() < 0.5 < levels.max() <= high
    grid = tin.raster(resolution=5)
    assert grid.extent == (5, 25, 5, 95)
    assert np.isfinite(grid.values).all()
    assert {tin.bands(interval=0.25).low.min(), tin.bands(interval=0.25).high.max()} == {low, high}


def test_a_line_outside_has_an_empty_profile_and_says_so():
    tin = TIN.from_points(SQUARE)
    with pytest.warns(UserWarning, match="outside the surface: the profile has no points"):
        assert len(tin.profile([(50, 50), (60, 60)])) == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(tin.profile([(-1, -1), (60, 60)]))


@pytest.mark.parametrize("what", ["slope", "aspect", "hillshade"])
def test_rasters_of_triangles_are_those_of_the_triangles(monkeypatch, what):
    from delone.terrain import slopes

    monkeypatch.setattr(slopes, "_BLOCK", 500)
    random = np.random.default_rng(3)
    points = np.column_stack((1e5 + random.random((300, 2)) * 90, random.random(300) * 20))
    points[:30, 2] = 7  # level triangles have no aspect
    tin = TIN.from_points(points, max_edge=20)
    light = {"azimuth": 100, "altitude": 20, "z_factor": 3} if what == "hillshade" else {}
    found = tin.raster(what, resolution=1.7, **light)
    simplex = tin.find_simplex(np.stack(np.meshgrid(found.x, found.y), axis=-1))
    of_triangles = tin.hillshade(**light) if light else getattr(tin, what)
    right = np.where(simplex < 0, np.nan, of_triangles[simplex])
    assert np.array_equal(found.values, right, equal_nan=True)
    assert (simplex < 0).any() and len(np.unique(simplex)) > 200


@pytest.mark.parametrize("what", ["height", "slope", "aspect", "hillshade"])
@pytest.mark.parametrize(
    ("x", "words"),
    [
        ([], "x must have shape"),
        ([1, np.nan], "x must be finite and ascending"),
        ([2, 1], "x must be finite and ascending"),
        (["a"], "x must hold real numbers"),
        ([[1, 2]], "x must have shape"),
    ],
)
def test_nodes_of_rasters_are_checked(what, x, words):
    tin = TIN.from_points([(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)])
    with pytest.raises((InputError, DtypeError), match=words):
        tin.raster(what, x=x, y=[1, 2])
    if what != "hillshade":
        with pytest.raises(InputError, match='azimuth: these options are for what="hillshade"'):
            tin.raster(what, resolution=1, azimuth=10)


@pytest.mark.parametrize(
    "nodes",
    [{"resolution": 1}, {"shape": (10, 10)}, {"x": np.arange(0, 5, 0.5), "y": np.arange(10)}],
)
def test_rasters_beyond_the_free_memory_are_refused(monkeypatch, nodes):
    tin = TIN.from_points([(0, 0, 0), (10, 0, 4), (10, 10, 4), (0, 10, 0)])
    assert tin.raster(**nodes).values.shape == (10, 10)
    monkeypatch.setattr(raster, "free_memory", lambda: raster._SPARE + 8 * 99)
    with pytest.raises(MemoryError, match="10 x 10 cells"):
        tin.raster(**nodes)
