"""The command ``delone sphere``: counts, files, and what it refuses."""

import meshio
import numpy as np
import pytest

from delone import sphere
from delone.io import write_mesh


def stations(tmp_path, rows, header="lat,lon,depth"):
    file = tmp_path / "stations.csv"
    np.savetxt(file, rows, delimiter=",", header=header, comments="", fmt="%.17g")
    return file


@pytest.fixture
def world(tmp_path):
    """Five hundred stations of the whole Earth, two with names of the same place."""
    random = np.random.default_rng(4)
    rows = np.column_stack(
        (random.uniform(-90, 90, 500), random.uniform(-180, 180, 500), np.arange(500))
    )
    rows[7, :2], rows[450, :2] = (10, -180), (10, 180)
    return stations(tmp_path, rows)


def test_counts_are_those_of_the_mesh(world, figures):
    found = figures("sphere", world)
    assert (found["points"], found["distinct"]) == (500, 499)
    assert found["triangles"] == {"count": 2 * 499 - 4, "expected": 2 * 499 - 4}
    assert found["edges"] == {"count": 3 * 499 - 6, "expected": 3 * 499 - 6}
    assert found["whole_sphere"] and found["boundary_edges"] == 0
    assert found["share_of_sphere"] == pytest.approx(1, rel=1e-12)
    [twin] = found["duplicates"]["first"]
    assert (twin["row"], twin["same_as"], abs(twin["lon"])) == (450, 7, 180)


def test_a_hull(tmp_path, command, figures):
    file = stations(tmp_path, [(0, 0), (0, 90), (90, 0), (40, 40)], "lat,lon")
    found = figures("sphere", file)
    assert not found["whole_sphere"] and found["boundary_edges"] == 3
    assert found["triangles"] == {"count": 3, "expected": 3}
    assert found["edges"] == {"count": 6, "expected": 6}
    assert found["share_of_sphere"] == pytest.approx(1 / 8, rel=1e-12)
    _, out, _ = command("sphere", file)
    assert "0.125 of the sphere, inside 3 arcs" in out and "3 = 2n - h - 2" in out


@pytest.mark.parametrize("suffix", [".vtu", ".ply", ".msh"])
def test_files_have_the_mesh_and_the_heights(world, tmp_path, command, suffix):
    target = tmp_path / f"mesh{suffix}"
    assert command("sphere", world, "-o", target, "-q") == (0, "", "")
    rows = np.loadtxt(world, delimiter=",", skiprows=1)
    mesh = sphere.Delaunay(lonlat=rows[:, [1, 0]])
    read = meshio.read(target)
    assert (read.points == mesh.points).all()
    assert (read.cells_dict["triangle"] == mesh.simplices).all()
    assert (read.point_data["depth"] == rows[:, 2]).all()
    if suffix == ".vtu":
        assert (read.point_data["latitude"] == mesh.lonlat[:, 1]).all()


def test_edges_other_formats_and_radians(world, tmp_path, command):
    targets = [tmp_path / f"mesh{suffix}" for suffix in (".obj", ".stl", ".xdmf", ".inp")]
    assert command("sphere", world, *(part for each in targets for part in ("-o", each)))[0] == 0
    for target in targets:
        assert len(meshio.read(target).cells_dict["triangle"]) == 994
    lines = tmp_path / "edges.vtu"
    assert command("sphere", world, "-o", lines, "--edges")[0] == 0
    assert len(meshio.read(lines).cells_dict["line"]) == 1491
    rows = np.radians(np.loadtxt(world, delimiter=",", skiprows=1)[:, [1, 0]])
    angles = stations(tmp_path, rows, "lon,lat")
    assert command("sphere", angles, "--radians", "-o", lines, "-q")[0] == 0
    want = sphere.Delaunay(lonlat=rows, degrees=False)
    assert (meshio.read(lines).points == want.points).all()


@pytest.mark.deep
def test_images_show_the_globe(world, tmp_path, command):
    image = pytest.importorskip("matplotlib.image")
    found = []
    for name, more in {
        "heights": (),
        "edges": ("--edges",),
        "pole": ("--view", "0,90"),
        "far": ("--view=180,-20",),
    }.items():
        target = tmp_path / f"{name}.png"
        assert command("sphere", world, "-o", target, "-q", *more) == (0, "", "")
        found.append(image.imread(target)[..., :3])
        # A globe on white, with more than edges.
        assert (found[-1][0] == 1).all()
        assert 0.3 < (found[-1].min(axis=2) < 0.99).mean() < 0.9
    colored, edges, pole, far = (each[400:900, 300:800] for each in found)
    assert np.ptp(colored, axis=2).mean() > 3 * np.ptp(edges, axis=2).mean()
    assert not (colored == pole).all() and not (pole == far).all()
    target = tmp_path / "globe.svg"
    assert command("sphere", world, "-o", target, "-q")[0] == 0
    assert "<svg" in target.read_text()


def test_conventions_of_longitudes_are_noted(tmp_path, command):
    file = stations(tmp_path, [(0, -170), (0, 350), (20, 10), (80, 90), (-80, 0)], "lat,lon")
    code, _, err = command("sphere", file)
    assert code == 0 and "delone: note:" in err and "more than one turn" in err
    assert command("sphere", file, "-q") == (0, "", "")


def test_what_is_refused(world, tmp_path, command):
    (tmp_path / "other").mkdir()
    beyond = stations(tmp_path / "other", [(0, 0), (1, 95), (2, 3), (3, 4)], "lon,lat")
    code, _, err = command("sphere", beyond)
    assert code == 4 and "latitude beyond a pole" in err and "line 3 of" in err
    circle = stations(tmp_path / "other", [(0, 0), (1, 0), (2, 0), (3, 0)], "lon,lat")
    assert command("sphere", circle)[0] == 4
    target = tmp_path / "mesh.gpkg"
    code, _, err = command("sphere", world, "-o", target)
    assert code == 2 and ".vtu" in err and ".png" in err and not target.exists()
    for view in ("5", "1,2,3", "1,91", "x,y"):
        code, _, err = command("sphere", world, "--view", view)
        assert code == 2 and "--view" in err
    code, _, err = command("sphere", world, "--crs", "EPSG:28992")
    assert code == 2 and "EPSG:28992" in err and "delone triangulate" in err
    assert command("sphere", world, "--crs", "EPSG:4326", "-q")[0] == 0
    assert command("sphere", world, "-o", world)[0] == 2


def test_a_mesh_of_the_sphere_is_written_by_python(tmp_path):
    mesh = sphere.Delaunay(xyz=np.random.default_rng(1).normal(size=(50, 3)))
    write_mesh(tmp_path / "mesh.vtu", mesh, attributes={"area": mesh.areas})
    read = meshio.read(tmp_path / "mesh.vtu")
    assert (read.cell_data["area"][0] == mesh.areas).all()


@pytest.mark.parametrize("name", ["interpolate", "crossval", "triangulate"])
def test_planar_commands_name_the_sphere(world, command, name):
    more = {"interpolate": ("--value", "depth", "--grid", "3x3", "--method", "linear")}
    code, _, err = command(name, world, *more.get(name, ()))
    assert "delone.sphere" in err
    assert code in (0, 4)
