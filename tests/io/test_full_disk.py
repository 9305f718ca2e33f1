"""A disk that takes no more: one error that names the file, and nothing left behind.

The limit that the system sets on the size of the files of a process stands for the disk. It needs
no privilege, and writing beyond it fails as on a full disk, with another number.
"""

import contextlib
import errno
import json
import os
import pickle
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from delone import Delaunay, Mesh, OutputError, Voronoi, mesh
from delone._base.atomic import replacing
from delone.cli import run
from delone.cli.tables import write_table
from delone.distributed import triangulate
from delone.distributed.store.files import Store
from delone.interpolate import grid
from delone.io import geotiff, output_suffixes, raster_suffixes, write_mesh, write_raster

resource = pytest.importorskip("resource", reason="limits of POSIX systems")
for _library in ("meshio", "h5py", "pyogrio", "geopandas", "rasterio", "netCDF4", "matplotlib"):
    pytest.importorskip(_library)

RNG = np.random.default_rng(0)
POINTS, HEIGHTS = RNG.random((700, 2)), RNG.random(700)
PLANE, SPACE = Delaunay(POINTS), Delaunay(RNG.random((150, 3)))
RASTER = grid(POINTS, HEIGHTS, resolution=0.01)
SQUARE = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]]}
Write = Callable[[Path], None]


def _cells(file: Path) -> None:
    table = Voronoi(POINTS).to_geopandas({"site": np.arange(len(POINTS))})
    with replacing(file) as beside:
        write_table(table, beside, layer="cells", multi=True)


def _writers() -> Iterator[tuple[str, str, Write]]:
    for suffix in output_suffixes():
        z = HEIGHTS if suffix in (".json", ".xml", ".landxml") else None
        yield "plane", suffix, lambda file, z=z: write_mesh(file, PLANE, z=z)
    for suffix in (".gpkg", ".geojson", ".vtu", ".msh"):
        yield "edges", suffix, lambda file: write_mesh(file, PLANE, edges=True)
    for suffix in (".vtu", ".msh", ".xdmf", ".npz", ".poly"):
        yield "mesh", suffix, lambda file: write_mesh(file, _quality_mesh())
    for suffix in (".vtu", ".msh", ".npz"):
        yield "space", suffix, lambda file: write_mesh(file, SPACE)
    for suffix in raster_suffixes():
        yield "raster", suffix, lambda file: write_raster(file, RASTER)
    for suffix in (".gpkg", ".geojson", ".fgb", ".parquet"):
        yield "cells", suffix, _cells
    yield "save", ".npz", PLANE.save


def _quality_mesh() -> Mesh:
    return mesh(SQUARE, max_area=0.001)


WRITERS = list(_writers())


@contextlib.contextmanager
def no_file_beyond(size: int) -> Iterator[None]:
    """Let no file of this process grow beyond a size."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


@pytest.mark.parametrize("case", WRITERS, ids=[f"{what}{suffix}" for what, suffix, _ in WRITERS])
@pytest.mark.deep("raster.png", "raster.svg", "plane.svg")
def test_every_format_says_so_and_leaves_nothing(tmp_path: Path, case: object) -> None:
    _, suffix, write = case  # type: ignore[misc]
    folder = tmp_path / "out"
    folder.mkdir()
    file = folder / f"a{suffix}"
    write(file)
    size = file.stat().st_size
    file.write_bytes(b"old")
    # Some libraries hold back the last part until the file is closed, and say nothing then.
    for room in (1, size // 3, size - 30_000, size - 9_000, size - 200, size - 1):
        if room < 1:
            continue
        with no_file_beyond(room), pytest.raises(OutputError) as caught:
            write(file)
        assert caught.value.errno == errno.EFBIG, (room, caught.value)
        assert caught.value.filename == str(file)
        assert os.listdir(folder) == [file.name]
        assert file.read_bytes() == b"old"
    write(file)
    assert file.stat().st_size == pytest.approx(size, rel=0.05)


def test_a_raster_of_tiles(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    np.save(tmp_path / "survey.npy", np.column_stack((POINTS, HEIGHTS)))
    tin = triangulate(tmp_path / "survey.npy", tmp_path / "tin", tile_points=300)
    tin.to_raster(0.02, folder / "dem.tif")
    size = (folder / "dem.tif").stat().st_size
    (folder / "dem.tif").unlink()
    # The values wait in a file of their own, 8 bytes each, which is smaller than this here.
    for room in (1, size - 1):
        with no_file_beyond(room), pytest.raises(OutputError) as caught:
            tin.to_raster(0.02, folder / "dem.tif")
        assert caught.value.filename == str(folder / "dem.tif")
        assert os.listdir(folder) == []


def test_notes_and_arrays_of_tiles(tmp_path: Path) -> None:
    store = Store(tmp_path)
    with no_file_beyond(10), pytest.raises(OutputError, match="resumes where it stopped") as caught:
        store.save("a.npy", POINTS)
    assert caught.value.filename == str(tmp_path / "a.npy")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    "arguments",
    [
        ["triangulate", "sites.csv", "-o", "out/a.{}"],
        ["voronoi", "sites.csv", "-o", "out/b.geojson", "-o", "out/a.{}"],
        ["interpolate", "sites.csv", "--grid", "90x90", "-o", "out/b.csv", "-o", "out/a.{}"],
        ["mesh", "square.geojson", "--max-area", "0.001", "-o", "out/b.npz", "-o", "out/a.{}"],
    ],
    ids=lambda arguments: arguments[0],
)
@pytest.mark.deep("triangulate")
def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    arguments: list[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    np.savetxt("sites.csv", np.column_stack((POINTS, HEIGHTS)), "%.3g", ",", header="x,y,z")
    Path("square.geojson").write_text(json.dumps(SQUARE))
    Path("out").mkdir()
    suffixes = {"triangulate": ["gpkg", "msh", "png"], "interpolate": ["nc", "tif"]}
    for suffix in suffixes.get(arguments[0], ["gpkg"]):
        call = [word.format(suffix) for word in arguments] + ["--quiet"] * (
            arguments[0] != "interpolate"
        )
        assert run(call) == 0
        room = Path(f"out/a.{suffix}").stat().st_size - 1
        for file in Path("out").iterdir():
            file.unlink()
        capsys.readouterr()
        with no_file_beyond(room):
            assert run(call) == 5
        assert re.match(r"delone: out/[ab]\.\w+: File too large", capsys.readouterr().err)
        assert os.listdir("out") == []


def test_the_cause_is_found_behind_other_errors(tmp_path: Path) -> None:
    target = tmp_path / "a.vtu"

    def write(beside: Path) -> None:
        beside.write_bytes(b"half")
        try:
            raise OSError(errno.ENOSPC, "No space left on device")
        finally:
            raise ValueError("the archive is still open")

    with pytest.raises(OutputError) as caught, replacing(target) as beside:
        write(beside)
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(target))
    assert pickle.loads(pickle.dumps(caught.value)).filename == str(target)
    assert os.listdir(tmp_path) == []


def test_errors_of_other_files_and_bugs_pass(tmp_path: Path) -> None:
    for error in (OSError(errno.ENOSPC, "full", "/elsewhere/b.las"), TypeError("a bug")):
        with pytest.raises(type(error)) as caught, replacing(tmp_path / "a.vtu"):
            raise error
        assert caught.value is error


ODD = ("b**c", "[x]q", "語" * 80, "a;b'{c}%d%s#$HOME ~ü?!")
PLAIN = [case for case in WRITERS if case[0] in ("plane", "raster", "cells")]


@pytest.mark.skipif(os.name == "nt", reason="characters that Windows has not in names")
@pytest.mark.parametrize("case", PLAIN, ids=[f"{what}{suffix}" for what, suffix, _ in PLAIN])
@pytest.mark.sampled(11)
def test_names_are_no_patterns(tmp_path: Path, case: object) -> None:
    _, suffix, write = case  # type: ignore[misc]
    for name in ODD if suffix in (".vtu", ".csv") else ODD[-1:]:
        file = tmp_path / f"{name}{suffix}"
        write(file)
        assert os.listdir(tmp_path) == [file.name]
        assert file.stat().st_size > 100
        with pytest.raises(KeyboardInterrupt), replacing(file) as beside:
            beside.write_bytes(b"torn")
            raise KeyboardInterrupt
        assert os.listdir(tmp_path) == [file.name]
        file.unlink()


@pytest.mark.parametrize("case", PLAIN, ids=[f"{what}{suffix}" for what, suffix, _ in PLAIN])
@pytest.mark.sampled(11)
def test_folders_are_no_patterns(tmp_path: Path, case: object) -> None:
    _, suffix, write = case  # type: ignore[misc]
    folder = tmp_path / "[a-z]*" / "a;b'{c}%d%s#$HOME ~ü"
    folder.mkdir(parents=True)
    write(folder / f"a{suffix}")
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [folder / f"a{suffix}"]


def test_a_folder_that_looks_like_an_address(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("a!b", "a;b?c"):
        folder = tmp_path / name
        (folder / "b").mkdir(parents=True)
        monkeypatch.chdir(folder)
        with pytest.raises(OutputError, match=r"/a\.gpkg cannot be written: .*without !"):
            write_mesh(folder / "a.gpkg", PLANE)
        write_mesh(folder / "a.geojson", PLANE)
        files = [path for path in tmp_path.rglob("*") if path.is_file()]
        assert files == [folder / "a.geojson"]
        files[0].unlink()


def test_a_raster_with_a_block_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A block that was not written reads as no values, without an error of GDAL."""
    parts, calls = geotiff._parts, []

    def some(values: np.ndarray) -> list[object]:
        calls.append(values)
        found = list(parts(values))
        return found[:-1] if len(calls) == 1 else found

    monkeypatch.setattr(geotiff, "_parts", some)
    raster = grid(POINTS, HEIGHTS, shape=(5, 300), extrapolate="nearest")
    with pytest.raises(OutputError, match="values are missing"):
        write_raster(tmp_path / "a.tif", raster)
    assert os.listdir(tmp_path) == []
