"""Reading back: simplices, location, values, rasters, tables, and the exact check."""

from __future__ import annotations

import errno
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, distributed
from delone.datasets import baja
from delone.distributed.read import dem
from delone.errors import FileFormatError, InputError
from delone.interpolate import Linear, grid

if TYPE_CHECKING:
    from collections.abc import Callable

SURVEY = baja()


@pytest.fixture(scope="module")
def tin(tmp_path_factory: pytest.TempPathFactory) -> distributed.TiledDelaunay:
    folder = tmp_path_factory.mktemp("baja") / "tin"
    points = np.column_stack([SURVEY.points, SURVEY.z])
    return distributed.triangulate(points, folder, tile_points=8000)


def queries() -> Any:
    low, high = SURVEY.points.min(axis=0), SURVEY.points.max(axis=0)
    dice = np.random.default_rng(4)
    inside = low + (high - low) * dice.random((3000, 2)) * 1.1
    return np.concatenate([inside, SURVEY.points[::7]])


def test_figures(tin: distributed.TiledDelaunay) -> None:
    right = Delaunay(SURVEY.points)
    assert (tin.npoints, tin.nsimplex) == (len(SURVEY.points), len(right.simplices))
    assert np.array_equal(tin.bounds, [*right.min_bound, *right.max_bound])
    assert str(tin.ntiles) in repr(tin)
    with pytest.raises(InputError, match="number must be an integer from 0"):
        tin.tile(tin.ntiles)


def test_find_simplex(tin: distributed.TiledDelaunay) -> None:
    asked = queries()
    found = tin.find_simplex(asked)
    right = Delaunay(SURVEY.points)
    assert np.array_equal(found < 0, right.find_simplex(asked) < 0)
    corners = tin.read_simplices()[found[found >= 0]]
    inside = asked[found >= 0]
    from delone.predicates import orient2d

    for k in range(3):
        a, b = (SURVEY.points[corners[:, (k + j) % 3]] for j in (0, 1))
        assert (orient2d(a, b, inside) >= 0).all()
    assert tin.find_simplex([np.nan, 0.0]).shape == ()
    assert tin.find_simplex([[[np.nan, 0.0]]]).tolist() == [[-1]]


def test_a_relative_folder_stays_where_it_is(
    tin: distributed.TiledDelaunay, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tin.path.parent)
    again = distributed.open(tin.path.name)
    monkeypatch.chdir("/")
    assert np.array_equal(again.read_simplices(), tin.read_simplices())


def test_interpolate(tin: distributed.TiledDelaunay) -> None:
    asked = queries()
    right = Linear(SURVEY.points, SURVEY.z, duplicates="first")(asked)
    np.testing.assert_allclose(tin.interpolate(asked), right, rtol=1e-12)
    with pytest.raises(InputError, match="has no 'depth'; it has z"):
        tin.interpolate(asked, values="depth")


def test_raster_without_seams(tin: distributed.TiledDelaunay, tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    low, high = SURVEY.points.min(axis=0), SURVEY.points.max(axis=0)
    cell = float((high - low).max() / 300)
    tin.to_raster(cell, tmp_path / "dem.tif")
    mesh = Delaunay(SURVEY.points)
    right = grid(mesh, SURVEY.z, resolution=cell, duplicates="first")
    with rasterio.open(tmp_path / "dem.tif") as file:
        np.testing.assert_allclose(file.read(1)[::-1], right.values, rtol=1e-12)
        assert np.allclose(file.bounds, np.array(right.extent)[[0, 2, 1, 3]])
    assert [p.name for p in tmp_path.iterdir()] == ["dem.tif"]
    with pytest.raises(FileFormatError, match=r"\.tif"):
        tin.to_raster(cell, tmp_path / "dem.csv")
    with pytest.raises(InputError, match="above 0"):
        tin.to_raster(0.0, tmp_path / "dem.tif")


def test_cells_of_a_raster_need_not_be_square(
    tin: distributed.TiledDelaunay, tmp_path: Path
) -> None:
    rasterio = pytest.importorskip("rasterio")
    low, high = SURVEY.points.min(axis=0), SURVEY.points.max(axis=0)
    across, up = (high - low) / [40.5, 12.5]
    tin.to_raster((across, up), tmp_path / "dem.tif")
    right = grid(Delaunay(SURVEY.points), SURVEY.z, resolution=(across, up), duplicates="first")
    with rasterio.open(tmp_path / "dem.tif") as file:
        np.testing.assert_allclose(file.read(1)[::-1], right.values, rtol=1e-12)
        # The first cell begins at the least coordinates; rows of the file go down.
        assert file.transform.almost_equals(
            rasterio.Affine(across, 0, low[0], 0, -up, low[1] + up * len(right.y)), 1e-6
        )


@pytest.mark.parametrize("block", [1, 5, 1 << 18])
@pytest.mark.parametrize("sides", [(2.0, 2.0), (2.0, 0.625), (0.625, 2.0)])
def test_nodes_on_the_sides_of_the_hull(
    sides: tuple[float, float], block: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Centres of cells that lie on the last column or row of points have a value, too."""
    rasterio = pytest.importorskip("rasterio")
    monkeypatch.setattr(dem, "_BLOCK", block)
    x, y = (values.ravel() for values in np.meshgrid(np.arange(6.0), np.arange(6.0)))
    points = np.column_stack([x, y, 2 + 3 * x + 4 * y])
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=9)
    assert tin.ntiles == 4
    tin.to_raster(sides, tmp_path / "dem.tif")
    columns, rows = (np.arange(np.ceil(5 / side)) * side + side / 2 for side in sides)
    assert max(columns[-1], rows[-1]) == 5
    with rasterio.open(tmp_path / "dem.tif") as file:
        found = file.read(1)[::-1]
    np.testing.assert_allclose(found, 2 + 3 * columns + 4 * rows[:, None], rtol=1e-14)


def test_a_disk_without_room_for_a_raster(
    tin: distributed.TiledDelaunay, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("rasterio")
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage._replace(free=1000))
    with pytest.raises(OSError, match="on disk while it is computed") as caught:
        tin.to_raster(0.01, tmp_path / "dem.tif")
    assert caught.value.errno == errno.ENOSPC
    assert not list(tmp_path.iterdir())
    with pytest.raises(OSError, match="on disk"):
        tin.to_raster(1e-7, tmp_path / "dem.tif")
    # Before even the coordinates of its columns are made.
    with pytest.raises(OSError, match=r"needs .* on disk"):
        tin.to_raster(1e-14, tmp_path / "dem.tif")


@pytest.mark.skipif(sys.platform == "win32", reason="limits of processes are POSIX")
def test_a_disk_that_fills_up_under_a_raster(
    tin: distributed.TiledDelaunay, tmp_path: Path
) -> None:
    pytest.importorskip("rasterio")
    code = f"""
import errno, resource
from delone import distributed
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
try:
    distributed.open({str(tin.path)!r}).to_raster(0.01, {str(tmp_path / "dem.tif")!r})
except OSError as error:
    print(errno.errorcode[error.errno])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "EFBIG\n"
    assert not list(tmp_path.iterdir())


def test_dask_data_frames(tin: distributed.TiledDelaunay, canonical: Callable[[Any], Any]) -> None:
    pytest.importorskip("dask.dataframe")
    frame = tin.to_dask_dataframe()
    assert frame.npartitions == tin.ntiles
    triangles = frame.compute(scheduler="synchronous")[["a", "b", "c"]].to_numpy()
    assert np.array_equal(triangles, tin.read_simplices())
    vertices = tin.to_dask_dataframe("vertices").compute(scheduler="synchronous").sort_index()
    assert np.array_equal(vertices.index, np.arange(tin.npoints))
    assert np.array_equal(vertices[["x", "y"]].to_numpy(), SURVEY.points)
    assert np.array_equal(vertices["z"], SURVEY.z)
    with pytest.raises(InputError, match="table must be"):
        tin.to_dask_dataframe("edges")


def test_geoparquet(tin: distributed.TiledDelaunay, tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    tin.to_geoparquet(tmp_path / "triangles")
    files = sorted((tmp_path / "triangles").iterdir())
    assert len(files) == tin.ntiles
    frames = [geopandas.read_parquet(path) for path in files]
    assert sum(map(len, frames)) == tin.nsimplex
    area = sum(frame.area.sum() for frame in frames)
    assert area == pytest.approx(Delaunay(SURVEY.points).areas.sum())
    with pytest.raises(InputError, match="already exists"):
        tin.to_geoparquet(tmp_path / "triangles")


def test_the_proof_holds(tin: distributed.TiledDelaunay) -> None:
    assert str(tin.validate()) == "right"


def spoil(folder: Path, table: str, change: Callable[[dict[str, Any]], None]) -> None:
    """Change a table of the first tile."""
    import pyarrow
    import pyarrow.parquet

    path = folder / table / "tile=000000.parquet"
    found = pyarrow.parquet.read_table(path)
    columns = {name: found[name].to_numpy().copy() for name in found.column_names}
    change(columns)
    pyarrow.parquet.write_table(pyarrow.table(columns), path)


def drop(columns: dict[str, Any]) -> None:
    columns |= {name: values[1:] for name, values in columns.items()}


def turn(columns: dict[str, Any]) -> None:
    columns["a"][0], columns["b"][0] = columns["b"][0], columns["a"][0]


def move(columns: dict[str, Any]) -> None:
    columns["x"][0] = columns["x"].max() + 1.0


def flip(columns: dict[str, Any]) -> None:
    """The diagonal of two neighbours."""
    a, b, c = (columns[name] for name in "abc")
    t = 0
    u, v, p = a[t], b[t], c[t]
    for s in range(1, len(a)):
        corners = [a[s], b[s], c[s]]
        if u in corners and v in corners:
            q = next(w for w in corners if w not in (u, v))
            a[t], b[t], c[t] = u, q, p
            a[s], b[s], c[s] = q, v, p
            return
    pytest.fail("the first triangle has no neighbour there")


def twice(columns: dict[str, Any]) -> None:
    columns |= {name: np.append(values[1:], values[9]) for name, values in columns.items()}


def longer(columns: dict[str, Any]) -> None:
    columns |= {name: np.append(values, values[9]) for name, values in columns.items()}


def fold(columns: dict[str, Any]) -> None:
    columns["b"][0] = columns["a"][0]


def steal(columns: dict[str, Any]) -> None:
    """The number of a point that another tile owns."""
    columns["id"][0] = columns["id"][~columns["owned"]][0]


def disown(columns: dict[str, Any]) -> None:
    columns["owned"][:] = False


def renumber(columns: dict[str, Any]) -> None:
    columns["id"][0] = columns["id"][1]


@pytest.mark.parametrize(
    ("table", "change", "words"),
    [
        ("triangles", drop, "instead of"),
        ("triangles", longer, "instead of"),
        ("triangles", twice, "occurs twice"),
        ("triangles", turn, "not counter-clockwise"),
        ("triangles", fold, "not counter-clockwise"),
        ("triangles", flip, "not Delaunay"),
        ("vertices", move, "tile 0"),
        ("vertices", steal, "a point of tile"),
        ("vertices", renumber, "a vertex twice"),
        ("vertices", disown, "points is 0 instead of"),
    ],
)
@pytest.mark.sampled(3)
def test_what_is_wrong_is_found(
    tin: distributed.TiledDelaunay, table: str, change: Any, words: str, tmp_path: Path
) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    spoil(tmp_path / "tin", table, change)
    spoilt = distributed.open(tmp_path / "tin")
    report = spoilt.validate()
    assert not report
    assert "is not the file that was written" in str(report)
    assert words in str(report)
    for use in (spoilt.read_simplices, lambda: spoilt.find_simplex(SURVEY.points)):
        try:
            use()
        except FileFormatError as error:
            assert f"{table}/tile=000000.parquet" in error.args[0].replace("\\", "/")


def test_rows_are_as_many_as_the_manifest_says(
    tin: distributed.TiledDelaunay, tmp_path: Path
) -> None:
    for change in (drop, longer):
        shutil.copytree(tin.path, tmp_path / change.__name__)
        spoil(tmp_path / change.__name__, "triangles", change)
        with pytest.raises(FileFormatError, match=r"tile=000000\.parquet has \d+ rows; the manif"):
            distributed.open(tmp_path / change.__name__).read_simplices()


def absent(name: str) -> Callable[[dict[str, Any]], None]:
    return lambda columns: columns.__delitem__(name)


def holding(name: str, value: Any) -> Callable[[dict[str, Any]], None]:
    """A column whose first row is this, whatever its type becomes."""

    def change(columns: dict[str, Any]) -> None:
        columns[name] = [value, *columns[name].tolist()[1:]]

    return change


def said(name: str) -> Callable[[dict[str, Any]], None]:
    return lambda columns: columns.__setitem__(name, columns[name].astype(str))


@pytest.mark.parametrize(
    ("table", "change", "words"),
    [
        *[("triangles", absent(name), f"no column '{name}'") for name in "abc"],
        *[("vertices", absent(name), f"no column '{name}'") for name in ("id", "x", "z", "owned")],
        *[("triangles", said(name), f"column '{name}' has dtype") for name in "abc"],
        *[
            ("vertices", said(name), f"column '{name}' has dtype")
            for name in ("id", "y", "z", "owned")
        ],
        ("triangles", holding("a", None), "'a' has gaps"),
        ("vertices", holding("x", None), "'x' has gaps"),
        ("vertices", holding("owned", None), "'owned' has gaps"),
        ("triangles", holding("a", -1), "not a row of the vertices"),
        ("triangles", holding("c", 1 << 40), "not a row of the vertices"),
        ("vertices", holding("x", float("nan")), "not finite"),
        ("vertices", holding("y", float("inf")), "not finite"),
        ("vertices", holding("id", len(SURVEY.points)), "not a row of the source"),
        ("vertices", holding("id", -1), "not a row of the source"),
    ],
)
@pytest.mark.sampled(6)
def test_tables_of_another_kind_are_refused_by_name(
    tin: distributed.TiledDelaunay, table: str, change: Any, words: str, tmp_path: Path
) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    spoil(tmp_path / "tin", table, change)
    spoilt = distributed.open(tmp_path / "tin")
    with pytest.raises(FileFormatError, match=words) as caught:
        spoilt.read_simplices()
    assert f"{table}/tile=000000.parquet" in caught.value.args[0].replace("\\", "/")
    assert words in str(spoilt.validate())


def test_bytes_that_change_in_a_table(tmp_path: Path) -> None:
    """Whatever they are, they are torn, or hold other numbers, which the hash tells."""
    dice = np.random.default_rng(11)
    points = dice.random((1500, 3))
    spoilt = distributed.triangulate(points, tmp_path / "tin", tile_points=400)
    for table in ("vertices", "triangles"):
        path = tmp_path / "tin" / table / "tile=000001.parquet"
        whole = np.frombuffer(path.read_bytes(), dtype=np.uint8)
        for number in range(60):
            # What Parquet says of its columns stands at the end.
            changed = whole.copy()
            low = 0 if number % 2 else len(whole) - 1500
            changed[dice.integers(low, len(whole), 2)] = dice.integers(0, 256, 2)
            path.write_bytes(changed[: dice.integers(len(whole))] if number % 5 == 0 else changed)
            try:
                spoilt.find_simplex(points[::50, :2])
            except FileFormatError as error:
                assert path.name in str(error)
            if number % 5 < 2 and path.read_bytes() != whole.tobytes():
                report = spoilt.validate()
                assert not report
                assert path.name in str(report)
        path.write_bytes(whole)
    assert spoilt.validate()


@pytest.mark.parametrize("left", [0, 200])
def test_a_torn_manifest(tin: distributed.TiledDelaunay, tmp_path: Path, left: int) -> None:
    torn = tmp_path / "torn"
    shutil.copytree(tin.path, torn)
    manifest = torn / "manifest.json"
    manifest.write_text(manifest.read_text(encoding="utf-8")[:left], encoding="utf-8")
    with pytest.raises(FileFormatError, match=r"manifest\.json is truncated"):
        distributed.open(torn)


def test_torn_outputs(tin: distributed.TiledDelaunay, tmp_path: Path) -> None:
    shutil.copytree(tin.path, tmp_path / "tin")
    path = tmp_path / "tin" / "triangles" / "tile=000000.parquet"
    path.write_bytes(path.read_bytes()[:-9])
    torn = distributed.open(tmp_path / "tin")
    with pytest.raises(FileFormatError, match="truncated"):
        torn.read_simplices()
    assert "cannot be read" in str(torn.validate())
    path.unlink()
    with pytest.raises(FileFormatError, match="is missing"):
        distributed.open(tmp_path / "tin")
    (tmp_path / "tin" / "manifest.json").write_text('{"format": "other"}')
    with pytest.raises(FileFormatError, match="it is not"):
        distributed.open(tmp_path / "tin")
