"""NumPy files: layouts, headers that lie, objects, torn archives."""

import io
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from delone import (
    ConvexHull,
    Delaunay,
    FileFormatError,
    PeriodicDelaunay,
    RegularTriangulation,
    Voronoi,
)
from delone.io import read_mesh, read_points, write_mesh

TABLE = np.array([[0, 0, 5.0], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])


@pytest.mark.parametrize("dtype", ["<f8", ">f8", "<f4", "<i4", "<i8"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_npy(tmp_path, dtype, order):
    np.save(tmp_path / "a.npy", np.asarray(TABLE, dtype=dtype, order=order))
    survey = read_points(tmp_path / "a.npy")
    assert survey.points.dtype == np.float64
    assert np.array_equal(survey.points, TABLE[:, :2])
    assert np.array_equal(survey.z, TABLE[:, 2])
    assert np.array_equal(
        read_points(tmp_path / "a.npy", columns=["2", "0"]).points, TABLE[:, [2, 0]]
    )
    (tmp_path / "a.npy").write_bytes(b"")  # the points must not be a view of the file
    assert survey.points[1, 0] == 4


def test_records(tmp_path):
    records = np.zeros(3, dtype=[("lat", "f8"), ("lon", "f4"), ("depth", "i2"), ("q", "i4")])
    records["lon"], records["depth"], records["q"] = [1, 2, 3], [4, 5, 6], [7, 8, 9]
    np.save(tmp_path / "a.npy", records)
    survey = read_points(tmp_path / "a.npy", attributes=["q"])
    assert survey.points.tolist() == [[1, 0], [2, 0], [3, 0]]
    assert survey.z.tolist() == [4, 5, 6]
    assert survey.attributes["q"].tolist() == [7, 8, 9]


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_npz(tmp_path, save):
    file = tmp_path / "a.npz"
    save(file, points=TABLE[:, :2], z=TABLE[:, 2], other=np.zeros(2))
    assert np.array_equal(read_points(file).z, TABLE[:, 2])
    save(file, anything=TABLE)
    assert np.array_equal(read_points(file).points, TABLE[:, :2])
    save(file, y=TABLE[:, 1], x=TABLE[:, 0])
    assert np.array_equal(read_points(file).points, TABLE[:, :2])
    save(file, a=TABLE, b=TABLE[:3])
    assert len(read_points(file, layer="b")) == 3
    with pytest.raises(FileFormatError, match="arrays are a, b"):
        read_points(file, layer="c")


def header(shape, descr="<f8"):
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": descr, "fortran_order": False, "shape": shape}
    )
    return file.getvalue()


@pytest.mark.parametrize("rows", [100, 10**9, 10**12, 10**18, 10**30, -1])
def test_header_that_claims_more_than_is_there(tmp_path, rows):
    lie = header((rows, 2)) + bytes(160)
    (tmp_path / "a.npy").write_bytes(lie)
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.npy")
    with zipfile.ZipFile(tmp_path / "a.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("points.npy", lie)
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.npz")


def test_entry_that_claims_to_expand_beyond_reason(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.npz", "w") as archive:
        archive.writestr("points.npy", header((10**12, 2)))
    raw = bytearray((tmp_path / "a.npz").read_bytes())
    at = raw.rindex(b"PK\x01\x02") + 24  # size in the table of contents
    raw[at : at + 4] = (2**32 - 2).to_bytes(4, "little")
    (tmp_path / "a.npz").write_bytes(raw)
    with pytest.raises(FileFormatError, match="more than 200 times"):
        read_points(tmp_path / "a.npz")


@pytest.mark.parametrize(
    "array",
    [
        np.array([[object()] * 2] * 3),
        np.zeros((3, 2), dtype=complex),
        np.array([["a", "b"]]),
        np.zeros(5),
        np.zeros((5, 1)),
        np.array([[2**53 + 1, 0], [1, 1]]),
    ],
)
def test_arrays_that_are_no_points(tmp_path, array):
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.npy")


def test_torn_and_garbage(tmp_path):
    np.savez(tmp_path / "whole.npz", points=TABLE)
    np.save(tmp_path / "whole.npy", TABLE)
    for name in ("whole.npz", "whole.npy"):
        whole = (tmp_path / name).read_bytes()
        torn = tmp_path / f"torn{name[-4:]}"
        for length in (1, 7, 60, len(whole) // 2, len(whole) - 1):
            torn.write_bytes(whole[:length])
            with pytest.raises(FileFormatError):
                read_points(torn)
        for seed in range(10):
            torn.write_bytes(np.random.default_rng(seed).bytes(500))
            with pytest.raises(FileFormatError):
                read_points(torn)


def test_header_that_python_cannot_parse(tmp_path):
    np.save(tmp_path / "a.npy", TABLE)
    raw = (tmp_path / "a.npy").read_bytes()
    for wrong in (b"{'descr': (((((", b"{'descr': lambda", b"[1,2] #########"):
        (tmp_path / "a.npy").write_bytes(raw[:10] + wrong + raw[10 + len(wrong) :])
        with pytest.raises(FileFormatError):
            read_points(tmp_path / "a.npy")


def test_mesh_there_and_back(tmp_path):
    mesh = Delaunay(TABLE[:, :2])
    file = tmp_path / "mesh.npz"
    write_mesh(file, mesh, z=TABLE[:, 2], crs="EPSG:28992", attributes={"weight": np.arange(5)})
    again = read_mesh(file)
    assert np.array_equal(again.simplices, mesh.simplices)
    assert np.array_equal(again.neighbors, mesh.neighbors)
    assert np.array_equal(again.z, TABLE[:, 2])
    survey = read_points(file, attributes=["weight"])
    assert survey.crs == "EPSG:28992"
    assert survey.attributes["weight"].tolist() == [0, 1, 2, 3, 4]
    assert np.array_equal(Delaunay.load(file).simplices, mesh.simplices)
    with pytest.raises(FileFormatError, match="rename"):
        write_mesh(file, mesh, attributes={"points": np.arange(5)})
    with pytest.raises(FileFormatError, match="edges"):
        write_mesh(file, mesh, edges=True)
    assert len(read_points(file)) == 5


def test_mesh_with_an_index_out_of_range(tmp_path):
    np.savez(tmp_path / "a.npz", points=TABLE[:, :2], simplices=np.array([[0, 1, 5]]))
    with pytest.raises(FileFormatError, match="row 0"):
        read_mesh(tmp_path / "a.npz")
    np.savez(tmp_path / "a.npz", points=TABLE[:, :2])
    with pytest.raises(FileFormatError, match="no triangles"):
        read_mesh(tmp_path / "a.npz")


def test_bytes_behind_the_array(tmp_path):
    np.save(tmp_path / "a.npy", TABLE)
    with (tmp_path / "a.npy").open("ab") as file:
        np.save(file, TABLE)  # a second array, which would be left out
    with pytest.raises(FileFormatError, match="more follow"):
        read_points(tmp_path / "a.npy")


@pytest.mark.parametrize(
    "dtype",
    [
        [("x", "<f8", (2,)), ("y", "<f8")],
        [("x", "<f8"), ("y", "<f8", (1,))],
        [("x", "<f8", (2,)), ("y", "<f8", (2,))],
        [("x", "<f8"), ("y", "<f8"), ("z", "<f8", (3,))],
        [("x", [("a", "<f8")]), ("y", "<f8")],
    ],
    ids=str,
)
def test_fields_of_several_numbers_are_no_coordinates(tmp_path, dtype):
    table = np.zeros(4, dtype=dtype)
    np.save(tmp_path / "a.npy", table)
    np.savez(tmp_path / "a.npz", points=table)
    for name in ("a.npy", "a.npz"):
        with pytest.raises(FileFormatError, match=name):
            read_points(tmp_path / name)


def test_records_have_one_axis(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((4, 2), dtype=[("x", "<f8"), ("y", "<f8")]))
    with pytest.raises(FileFormatError, match="records of shape"):
        read_points(tmp_path / "a.npy")


def test_arrays_of_coordinates_have_one_shape(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.zeros((2, 3)), y=np.zeros((3, 2)))
    with pytest.raises(FileFormatError, match="different shapes"):
        read_points(tmp_path / "a.npz")
    np.savez(tmp_path / "a.npz", x=np.zeros((2, 3)), y=np.zeros((2, 3)))
    assert read_points(tmp_path / "a.npz").points.shape == (6, 2)


@pytest.mark.skipif(sys.platform != "linux", reason="a limit on memory")
@pytest.mark.parametrize("name", ["a.npz", "b.npz"])
def test_what_memory_has_no_room_for_is_not_torn(tmp_path, name):
    # Two megabytes of file, 128 of memory; zeros alone would expand too far.
    x = np.zeros(1 << 23)
    x[: 1 << 17] = np.random.default_rng(0).random(1 << 17)
    if name == "a.npz":
        np.savez_compressed(tmp_path / name, points=np.column_stack((x, x)))
    else:
        np.savez_compressed(tmp_path / name, x=x, y=x)
    code = (
        "import resource, sys; from pathlib import Path; from delone.cli import run\n"
        "import delone.io.arrays, delone.cli.info\n"
        "now = int(Path('/proc/self/statm').read_text().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (now + (1 << 26),) * 2)\n"
        "sys.exit(run(['info', sys.argv[1]]))\n"
    )
    file = tmp_path / name
    done = subprocess.run(
        [sys.executable, "-c", code, str(file)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (7, "")
    assert done.stderr.startswith(f"delone: {file} needs more memory than is available")


@pytest.mark.parametrize("points", [TABLE[:, :2], TABLE])
def test_a_regular_triangulation_there_and_back(tmp_path, points):
    mesh = RegularTriangulation(points, np.linspace(0, 0.1, len(points)))
    write_mesh(tmp_path / "a.npz", mesh)
    again = read_mesh(tmp_path / "a.npz")
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.simplices, mesh.simplices)
    assert np.array_equal(again.neighbors, mesh.neighbors)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (lambda: PeriodicDelaunay(TABLE[:, :2], (99, 99)), "across the periods.*PeriodicDelaunay"),
        (lambda: ConvexHull(TABLE), r"a surface.*ConvexHull\.load"),
        (lambda: ConvexHull(TABLE[:, :2]), r"a surface.*ConvexHull\.load"),
        (lambda: Voronoi(TABLE[:, :2]), r"cells.*Voronoi\.load"),
    ],
)
def test_what_is_no_mesh_says_so(tmp_path, made, message):
    made().save(tmp_path / "a.npz")
    with pytest.raises(FileFormatError, match=message):
        read_mesh(tmp_path / "a.npz")
