"""Suffixes, missing files, missing libraries, and files that appear whole or not at all."""

import os
import sys

import numpy as np
import pytest

from delone import (
    ConvexHull,
    Delaunay,
    DtypeError,
    FileFormatError,
    InputError,
    MissingExtraError,
    OutputError,
    PeriodicDelaunay,
    RegularTriangulation,
    ShapeError,
    Voronoi,
    improve,
)
from delone._base.atomic import replacing
from delone.compat.scipy import Delaunay as DropIn
from delone.io import input_suffixes, output_suffixes, read_mesh, read_points, write_mesh

# It asks once, when it is imported, which libraries are there: before tests take some away.
pytest.importorskip("pyogrio")
MESH = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])


def test_unknown_suffixes_name_the_known_ones(tmp_path):
    (tmp_path / "a.doc").write_text("1")
    with pytest.raises(FileFormatError) as caught:
        read_points(tmp_path / "a.doc")
    assert all(suffix in str(caught.value) for suffix in (".doc", *input_suffixes()))
    with pytest.raises(FileFormatError) as caught:
        write_mesh(tmp_path / "b", MESH)
    assert all(suffix in str(caught.value) for suffix in output_suffixes())
    assert "\n" not in str(caught.value)


def test_missing_empty_and_folder(tmp_path):
    for read in (read_points, read_mesh):
        with pytest.raises(FileNotFoundError, match="no such file"):
            read(tmp_path / "a.npz")
        (tmp_path / "empty.npz").touch()
        with pytest.raises(FileFormatError, match="is empty"):
            read(tmp_path / "empty.npz")
        with pytest.raises(FileFormatError, match="is a folder"):
            read(tmp_path)


def test_options_that_do_not_apply(tmp_path):
    (tmp_path / "a.csv").write_text("1,2\n3,4\n")
    with pytest.raises(FileFormatError, match="classes"):
        read_points(tmp_path / "a.csv", classes=[2])
    with pytest.raises(FileFormatError, match="layers"):
        read_points(tmp_path / "a.csv", layer="a")
    (tmp_path / "a.npy.gz").write_text("1")
    with pytest.raises(FileFormatError, match="decompress"):
        read_points(tmp_path / "a.npy.gz")


@pytest.mark.parametrize(
    ("suffix", "library", "extra"),
    [
        (".las", "laspy", "las"),
        (".laz", "lazrs", "las"),
        (".gpkg", "pyogrio", "geo"),
        (".geojson", "geopandas", "geo"),
        (".parquet", "pyarrow", "geo"),
        (".msh", "meshio", "mesh"),
    ],
)
def test_missing_library_to_read(tmp_path, monkeypatch, suffix, library, extra):
    (tmp_path / f"a{suffix}").write_bytes(b"anything")
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingExtraError, match=rf'pip install "delone\[{extra}\]"') as caught:
        read_points(tmp_path / f"a{suffix}")
    assert caught.value.extra == extra


@pytest.mark.parametrize(
    ("suffix", "library", "extra"),
    [
        (".vtu", "meshio", "mesh"),
        (".xdmf", "h5py", "mesh"),
        (".med", "h5py", "mesh"),
        (".gpkg", "shapely", "geo"),
        (".png", "matplotlib.figure", "plot"),
        (".svg", "matplotlib.figure", "plot"),
    ],
)
def test_missing_library_to_write(tmp_path, monkeypatch, suffix, library, extra):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingExtraError) as caught:
        write_mesh(tmp_path / f"a{suffix}", MESH)
    assert caught.value.extra == extra
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", output_suffixes())
@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, OSError])
def test_failure_in_the_middle_leaves_what_was_there(tmp_path, monkeypatch, suffix, error):
    target = tmp_path / f"a{suffix}"
    target.write_bytes(b"old")

    def write_half(path, *_, **__):
        path.write_bytes(b"half")
        path.with_name(path.name + "-journal").write_bytes(b"half")
        raise error("disk is full")

    module = {".gpkg": "vector", ".geojson": "vector", ".npz": "arrays"}.get(suffix, "mesh")
    module = "picture" if suffix in (".png", ".svg") else module
    module = "fem" if suffix in (".xdmf", ".med", ".inp", ".su2", ".vtk", ".mesh") else module
    module = "triangle" if suffix in (".node", ".ele", ".poly") else module
    module = "tetgen" if suffix in (".smesh", ".face") else module
    module = {".off": "off", ".glb": "gltf", ".json": "cityjson"}.get(suffix, module)
    module = "landxml" if suffix in (".xml", ".landxml") else module
    monkeypatch.setattr(f"delone.io.{module}.write_mesh", write_half)
    with pytest.raises(error):
        write_mesh(target, MESH)
    assert [path.name for path in tmp_path.iterdir()] == [target.name]
    assert target.read_bytes() == b"old"


@pytest.mark.filterwarnings("ignore::delone.UnitsWarning")
@pytest.mark.parametrize("suffix", output_suffixes())
def test_success_replaces_and_leaves_nothing_else(tmp_path, suffix):
    target = tmp_path / f"a b{suffix}"
    target.write_bytes(b"old")
    write_mesh(target, MESH, z=None if suffix == ".su2" else np.zeros(MESH.npoints))
    assert [path.name for path in tmp_path.iterdir()] == [target.name]
    assert target.stat().st_size > 30


def test_targets_that_cannot_be(tmp_path):
    with pytest.raises(FileNotFoundError, match="folder"):
        write_mesh(tmp_path / "nowhere" / "a.npz", MESH)
    (tmp_path / "a.npz").mkdir()
    with pytest.raises(IsADirectoryError):
        write_mesh(tmp_path / "a.npz", MESH)
    with pytest.raises(OSError, match="not a regular file"):
        write_mesh_to_null()


def write_mesh_to_null():
    with replacing(os.devnull):
        raise AssertionError("the target was accepted")


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")
def test_a_link_stays_a_link(tmp_path):
    (tmp_path / "real.npz").touch()
    (tmp_path / "link.npz").symlink_to(tmp_path / "real.npz")
    write_mesh(tmp_path / "link.npz", MESH)
    assert (tmp_path / "link.npz").is_symlink()
    assert len(read_points(tmp_path / "real.npz")) == 5


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege on Windows")
def test_a_link_to_itself_is_an_error(tmp_path):
    (tmp_path / "a.npz").symlink_to(tmp_path / "b.npz")
    (tmp_path / "b.npz").symlink_to(tmp_path / "a.npz")
    for write in (MESH.save, lambda path: write_mesh(path, MESH)):
        with pytest.raises(OSError, match="link"):
            write(tmp_path / "a.npz")
    assert (tmp_path / "a.npz").is_symlink()
    assert (tmp_path / "b.npz").is_symlink()


def test_nothing_written_is_an_error(tmp_path):
    with pytest.raises(OSError, match="nothing was written"), replacing(tmp_path / "a"):
        pass


def test_numpy_is_enough_for_its_own_files(tmp_path, monkeypatch):
    for library in ("laspy", "meshio", "pyogrio", "geopandas", "pyarrow", "matplotlib", "typer"):
        monkeypatch.setitem(sys.modules, library, None)
    write_mesh(tmp_path / "a.npz", MESH)
    np.savetxt(tmp_path / "a.csv", MESH.points, delimiter=",")
    assert np.array_equal(
        read_points(tmp_path / "a.csv").points, read_points(tmp_path / "a.npz").points
    )


CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".npz", ".png", ".ply"])
@pytest.mark.parametrize(
    "other", [ConvexHull(MESH.points), Voronoi(MESH.points), Voronoi(CUBE), None, (1, 2)]
)
def test_what_is_no_triangulation_is_refused(tmp_path, suffix, other):
    with pytest.raises(InputError, match=type(other).__name__):
        write_mesh(tmp_path / f"a{suffix}", other)
    assert not list(tmp_path.iterdir())


def test_npz_holds_what_can_be_loaded(tmp_path):
    weighted = RegularTriangulation(MESH.points, np.zeros(5))
    for other in (weighted, improve(Delaunay(CUBE)), PeriodicDelaunay([(0, 0)], (1, 1))):
        write_mesh(tmp_path / "a.npz", other)
        found = type(other).load(tmp_path / "a.npz")
        assert np.array_equal(found.simplices, other.simplices)


def test_improved_tetrahedra_have_a_picture(tmp_path):
    pytest.importorskip("pyvista")
    write_mesh(tmp_path / "a.png", improve(Delaunay([*CUBE, (0.4, 0.5, 0.6)])))
    assert (tmp_path / "a.png").stat().st_size > 1000


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".gpkg", ".geojson", ".png", ".svg"])
def test_the_drop_in_is_written_but_for_its_edges(tmp_path, suffix):
    """It has the attributes of SciPy's class, and edges are none of them."""
    drop_in = DropIn(MESH.points)
    with pytest.raises(InputError, match=r"edges to write; write delone\.Delaunay"):
        write_mesh(tmp_path / f"a{suffix}", drop_in, edges=True)
    if suffix in (".png", ".svg"):
        with pytest.raises(InputError, match=r"delone\.compat.*draw delone\.Delaunay"):
            write_mesh(tmp_path / f"a{suffix}", drop_in)
        assert not list(tmp_path.iterdir())
    else:
        write_mesh(tmp_path / f"a{suffix}", drop_in)
        assert len(list(tmp_path.iterdir())) == 1


def test_the_drop_in_in_space_has_a_picture(tmp_path):
    pytest.importorskip("pyvista")
    write_mesh(tmp_path / "a.png", DropIn([*CUBE, (0.4, 0.5, 0.6)]))
    assert (tmp_path / "a.png").stat().st_size > 1000


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".npz", ".png"])
def test_heights_of_points_in_space_are_their_own(tmp_path, suffix):
    cube = Delaunay(CUBE)
    for solid in (cube, improve(cube)):
        with pytest.raises(FileFormatError, match="z must be None"):
            write_mesh(tmp_path / f"a{suffix}", solid, z=np.zeros(8))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".npz", ".vtu", ".msh", ".ply"])
@pytest.mark.parametrize(
    ("attributes", "error"),
    [
        (5, DtypeError),
        ({"a": [None] * 5}, DtypeError),
        ({"a": [[1, 2], [3]]}, ShapeError),
        ({"a": [1.0, 2.0]}, ShapeError),
    ],
)
def test_attributes_that_fit_nothing_are_refused(tmp_path, suffix, attributes, error):
    with pytest.raises(error, match="attribute"):
        write_mesh(tmp_path / f"a{suffix}", MESH, attributes=attributes)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".ply"])
def test_meshes_hold_numbers(tmp_path, suffix):
    with pytest.raises(DtypeError, match="real numbers"):
        write_mesh(tmp_path / f"a{suffix}", MESH, attributes={"a": ["x"] * 5})


@pytest.mark.parametrize("error", [FileFormatError, OutputError, RuntimeError])
def test_temporary_names_are_in_no_message(tmp_path, error):
    target = tmp_path / "heights.tif"
    for form in (str, lambda path: path.name):
        with (
            pytest.raises((FileFormatError, OutputError, RuntimeError)) as caught,
            replacing(target) as file,
        ):
            raise error(f"{form(file)} is too large")
        own = error is not RuntimeError  # an error of Python itself is a bug, and stays as it is
        assert ("heights.tif is too large" in str(caught.value)) is own
