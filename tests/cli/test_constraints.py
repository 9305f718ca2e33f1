"""delone triangulate and info for lines and polygons: constraints, what is said of them, files."""

import gzip
import json

import geopandas
import meshio
import numpy as np
import pytest
import shapely

from delone import ConstrainedDelaunay, from_geometry
from delone.io import read_mesh, read_points

LAKE = [(3, 3), (5, 3), (5, 5), (3, 5)]
LAND = shapely.Polygon([(0, 0), (10, 0), (10, 8), (0, 8)], [LAKE])
ROAD = shapely.LineString([(-2, 1), (12, 7)])
TOWN = shapely.Point(8, 6)


@pytest.fixture
def coast(tmp_path):
    """A square with a lake, a road that crosses both, and a point."""
    return save(tmp_path / "coast.geojson", [LAND, ROAD, TOWN], height=[1.0, 2.0, 3.0])


def save(file, geometries, **columns):
    geopandas.GeoDataFrame(columns, geometry=geometries, crs="EPSG:28992").to_file(file)
    return file


def total_area(mesh):
    corners = mesh.points[mesh.simplices]
    return shapely.area(shapely.polygons(corners)).sum()


def test_lines_and_polygons_are_constraints(coast, tmp_path, figures):
    out = tmp_path / "mesh.vtu"
    found = figures("triangulate", coast, "-o", out)
    mesh = from_geometry([LAND, ROAD, TOWN])
    assert np.array_equal(read_mesh(out).simplices, mesh.simplices)
    assert np.array_equal(meshio.read(out).cell_data["region"][0], mesh.region)
    said = found["constraints"]
    assert said["features"] == 3
    assert (said["segments"], said["pieces"]) == (9, len(mesh.segments)) == (9, 17)
    assert said["added"] == said["crossings"]["count"] == 4
    assert {tuple(each["features"]) for each in said["crossings"]["first"]} == {(0, 1)}
    assert [said["crossings"]["first"][0][k] for k in "xy"] == mesh.points[
        mesh.report.crossings[0, 2]
    ].tolist()
    assert said["regions"] == len(set(mesh.region.tolist()))
    assert found["points"] == 11 + 4
    assert found["triangles"] == {"count": mesh.nsimplex, "expected": 2 * 15 - len(mesh.hull) - 2}
    assert found["triangles"]["count"] == found["triangles"]["expected"]
    assert found["edges"] == {"count": len(mesh.edges), "expected": len(mesh.edges)}
    assert found["crs"] == "EPSG:28992"


def test_report_for_people(tmp_path, command):
    lines = [
        LAND,
        shapely.LineString([(1, 1), (1, 1), (7, 1), (9, 1)]),
        shapely.LineString([(7, 1), (1, 1)]),
        shapely.LineString([(6, 1), (8, 1)]),
        ROAD,
    ]
    file = save(tmp_path / "a.gpkg", lines)
    code, out, err = command("triangulate", file)
    assert (code, err) == (0, "")
    rows = dict(line.split("  ", 1) for line in out.splitlines() if "  " in line)
    rows = {name: value.strip() for name, value in rows.items()}
    assert rows["features"] == "5"
    assert rows["repeated segments"] == "1"
    assert rows["zero-length segments"] == "1"
    assert int(rows["overlapping pairs"]) >= 1
    assert int(rows["points on segments"]) >= 1
    assert rows["crossings"] == "4, split"
    assert rows["added vertices"] == "4"
    assert "features 0 and 4 cross at (" in out
    assert "= 2n - h - 2" in out
    code, out, _ = command("triangulate", save(tmp_path / "b.gpkg", [LAND]))
    assert code == 0
    for word in ("crossings", "repeated", "overlapping", "zero-length", "on segments", "added"):
        assert word not in out


def test_crossings_may_be_an_error(coast, tmp_path, command):
    out = tmp_path / "mesh.vtu"
    code, text, err = command("triangulate", coast, "--crossing", "raise", "-o", out)
    assert (code, text) == (4, "")
    assert err.count("\n") == 1
    assert "4 pairs of segments cross, at (" in err
    assert "--crossing split" in err
    assert not out.exists()
    assert command("triangulate", coast, "--crossing", "split")[0] == 0
    code, _, err = command("triangulate", coast, "--crossing", "perhaps")
    assert code == 2
    assert "'split'" in err


def test_the_outline_leaves_what_is_inside_of_polygons(coast, tmp_path, figures, command):
    out = tmp_path / "mesh.npz"
    found = figures("triangulate", coast, "--outline", "-o", out)
    assert found["area"] == pytest.approx(LAND.area)
    assert found["triangles"]["expected"] is None
    mesh = ConstrainedDelaunay.load(out)
    assert mesh.find_simplex([(4, 4), (-1, 1), (8, 1)]).tolist()[:2] == [-1, -1]
    assert total_area(mesh) == pytest.approx(LAND.area)
    assert np.array_equal(read_mesh(out).simplices, mesh.simplices)
    assert found["mean_degree"] == pytest.approx(
        2 * len(mesh.edges) / len(np.unique(mesh.simplices))
    )
    assert "2n - h - 2" not in command("triangulate", coast, "--outline")[1]


def test_an_island_in_a_lake_and_a_line_around_nothing(tmp_path, figures):
    island = shapely.box(3.5, 3.5, 4.5, 4.5)
    pond = shapely.LineString([(20, 0), (22, 0), (22, 2), (20, 0)])
    file = save(tmp_path / "a.geojson", [LAND, island, pond])
    found = figures("triangulate", file, "--outline")
    assert found["area"] == pytest.approx(LAND.area + island.area)
    # Without polygons, what lines enclose is all there is.
    found = figures("triangulate", save(tmp_path / "b.geojson", [pond, ROAD]), "--outline")
    assert found["area"] == pytest.approx(2)


def test_an_outline_around_nothing(tmp_path, command):
    code, _, err = command("triangulate", save(tmp_path / "a.geojson", [ROAD]), "--outline")
    assert code == 4
    assert "too few" in err or "one line" in err
    lines = [ROAD, shapely.LineString([(0, 8), (5, 9)])]
    code, _, err = command("triangulate", save(tmp_path / "a.geojson", lines), "--outline")
    assert code == 4
    assert "encloses" in err


def test_conforming(tmp_path, figures, command):
    kite = [shapely.LineString([(0, 0), (10, 0)]), shapely.MultiPoint([(5, 1), (5, -1)])]
    file = save(tmp_path / "a.geojson", kite)
    out = tmp_path / "a.vtu"
    assert figures("triangulate", file, "-o", out)["constraints"]["added"] == 0
    assert command("check", out)[0] == 1
    found = figures("triangulate", file, "--conforming", "-o", out)
    assert found["constraints"]["added"] == found["constraints"]["steiner"] > 0
    assert command("check", out)[0] == 0
    code, _, err = command("triangulate", file, "--conforming", "--max-points", 0)
    assert code == 4
    assert "limit of 0 vertices" in err


@pytest.mark.parametrize(
    "option", [("--outline",), ("--conforming",), ("--crossing", "split"), ("--max-points", "5")]
)
def test_options_of_lines_are_refused_for_points(survey, tmp_path, command, option):
    towns = save(tmp_path / "a.geojson", shapely.points(np.eye(3)[:, :2]))
    for file in (survey, towns):
        code, _, err = command("triangulate", file, *option)
        assert code == 2
        assert f"{option[0]} is for lines and polygons" in err


@pytest.mark.parametrize("suffix", [".geojson", ".gpkg", ".shp", ".fgb", ".parquet"])
def test_formats(tmp_path, figures, suffix):
    file = tmp_path / f"a{suffix}"
    frame = geopandas.GeoDataFrame(geometry=[LAND], crs="EPSG:28992")
    frame.to_parquet(file) if suffix == ".parquet" else frame.to_file(file)
    found = figures("triangulate", file)
    assert found["constraints"]["segments"] == 8
    assert found["area"] == 80


@pytest.mark.parametrize("suffix", [".geojson", ".gpkg", ".msh", ".obj", ".stl", ".ply", ".svg"])
def test_outputs(coast, tmp_path, command, suffix):
    out = tmp_path / f"out{suffix}"
    assert command("triangulate", coast, "--outline", "-o", out)[0] == 0
    if suffix in (".geojson", ".gpkg"):
        written = geopandas.read_file(out)
        assert written.geometry.area.sum() == pytest.approx(LAND.area)
        mesh = from_geometry([LAND, ROAD, TOWN], boundary="polygons")
        assert written.region.tolist() == mesh.region.tolist()
    elif suffix == ".msh":
        assert set(meshio.read(out).cell_data["region"][0].tolist()) == {0.0, 1.0}
    elif suffix == ".svg":
        assert "segments" in out.read_text()
    else:
        assert len(read_mesh(out).simplices) > 10


def test_edges_say_which_of_them_are_segments(coast, tmp_path, command):
    out = tmp_path / "edges.gpkg"
    assert command("triangulate", coast, "-o", out, "--edges")[0] == 0
    edges = geopandas.read_file(out)
    mesh = from_geometry([LAND, ROAD, TOWN])
    marked = edges[edges.segment == 1][["v0", "v1"]].to_numpy()
    assert sorted(map(tuple, marked.tolist())) == sorted(
        map(tuple, np.sort(mesh.segments, axis=1).tolist())
    )


def test_heights(coast, tmp_path, command):
    out = tmp_path / "mesh.vtu"
    assert command("triangulate", coast, "--columns", "height", "-o", out)[0] == 0
    z = read_mesh(out).z
    assert z[:8].tolist() == [1] * 8
    assert z[8:11].tolist() == [2, 2, 3]
    assert set(z[11:].tolist()) <= {1.0, 2.0}
    slope = shapely.from_wkt(["LINESTRING Z (0 0 10, 8 0 18)", "LINESTRING Z (2 -2 5, 2 6 9)"])
    save(tmp_path / "slope.gpkg", slope)
    assert command("triangulate", tmp_path / "slope.gpkg", "-o", out)[0] == 0
    assert read_mesh(out).z.tolist() == [10, 18, 5, 9, 12]


def test_a_saved_mesh_is_judged_for_what_it_is(coast, tmp_path, command, figures):
    out = tmp_path / "mesh.npz"
    assert command("triangulate", coast, "--outline", "--columns", "height", "-o", out)[0] == 0
    assert figures("check", out, "--canonical")["ok"]
    assert "a canonical constrained Delaunay triangulation, proven" in command("check", out)[1]
    assert len(read_points(out)) == 15


def test_info(coast, figures, command):
    found = figures("info", coast)
    assert found["features"] == 3
    assert found["kinds"] == {"Polygon": 1, "LineString": 1, "Point": 1}
    assert found["points"] == 10 + 2 + 1
    assert found["x"] == [-2, 12]
    assert "LineString: 1" in command("info", coast)[1]


def test_compressed(coast, tmp_path, figures, command):
    file = tmp_path / "coast.geojson.gz"
    file.write_bytes(gzip.compress(coast.read_bytes()))
    assert figures("triangulate", file)["triangles"] == figures("triangulate", coast)["triangles"]
    file.write_bytes(file.read_bytes()[:200])
    code, _, err = command("triangulate", file)
    assert code == 3
    assert "truncated" in err


def test_nan_names_the_feature(tmp_path, command):
    rings = {"type": "LineString", "coordinates": [[0, 0], [1, float("nan")], [2, 0]]}
    fine = {"type": "LineString", "coordinates": [[5, 5], [6, 7]]}
    features = [{"type": "Feature", "properties": {}, "geometry": g} for g in (fine, rings)]
    file = tmp_path / "a.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    code, _, err = command("triangulate", file, "--planar")
    assert code == 4
    assert err == f"delone: {file}: NaN or infinity in features 1\n"


def test_collections_and_missing_geometries(tmp_path, figures, command):
    file = save(tmp_path / "a.gpkg", [shapely.GeometryCollection([TOWN, ROAD]), None, TOWN])
    found = figures("triangulate", file, "--quiet")
    assert found["points"] == 3
    assert (found["constraints"]["features"], found["constraints"]["segments"]) == (3, 1)
    assert "a.gpkg: 1 of 3 features has no geometry" in command("triangulate", file)[2]
