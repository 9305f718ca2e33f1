"""Files of all kinds as sources, and what is wrong with some."""

from __future__ import annotations

import struct
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets, distributed
from delone.distributed.run import sources
from delone.errors import (
    DegenerateInputError,
    DtypeError,
    FileFormatError,
    InputError,
    NonFiniteError,
)
from delone.io import read_points

if TYPE_CHECKING:
    from collections.abc import Callable

LIDAR = Path(__file__).parents[2] / "examples" / "data" / "ahn3_crop_100m.laz"
POINTS = datasets.uniform(900)


def table(path: Path, points: Any, **columns: Any) -> Path:
    import pyarrow
    import pyarrow.parquet

    columns = {"x": points[:, 0], "y": points[:, 1], **columns}
    pyarrow.parquet.write_table(pyarrow.table(columns), path, row_group_size=100)
    return path


def test_decimals_of_parquet_are_the_doubles_of_their_digits(tmp_path: Path) -> None:
    import pyarrow

    rng = np.random.default_rng(6)
    texts = [[f"{number / 1000:.3f}" for number in rng.integers(0, 10**9, 400)] for _ in "xyz"]
    x, y, z = (
        pyarrow.array([Decimal(text) for text in column], pyarrow.decimal128(20, 3))
        for column in texts
    )
    path = table(tmp_path / "a.parquet", np.zeros((400, 2)), x=x, y=y, z=z)
    tin = distributed.triangulate(path, tmp_path / "tin", tile_points=100)
    right = np.array(texts, dtype=float).T
    for tile in tin.tiles():
        assert np.array_equal(tile.points, right[tile.ids, :2])
        assert np.array_equal(tile.attributes["z"], right[tile.ids, 2])
    table(path, np.zeros((400, 2)), x=x, y=pyarrow.array([Decimal(2**60 + 1)] * 400))
    with pytest.raises(FileFormatError, match="more digits"):
        distributed.triangulate(path, tmp_path / "again", tile_points=100)


def test_parquet_in_several_files(
    tmp_path: Path, canonical: Callable[[Any], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    # Pieces begin and end within row groups.
    monkeypatch.setattr(sources, "PIECE", 130)
    folder = tmp_path / "points"
    folder.mkdir()
    for i in range(3):
        some = slice(300 * i, 300 * i + 300)
        kind = np.arange(300 * i, 300 * i + 300, dtype=np.int16)
        table(folder / f"{i}.parquet", POINTS[some], z=POINTS[some, 0], kind=kind)
    right = canonical(Delaunay(POINTS).simplices)
    for number, source in enumerate([folder, str(folder / "*.parquet"), sorted(folder.iterdir())]):
        out = tmp_path / f"tin{number}"
        tin = distributed.triangulate(source, out, tile_points=200, attributes=["kind"])
        assert np.array_equal(canonical(tin.read_simplices()), right)
        tile = tin.tile(0)
        assert np.array_equal(tile.attributes["kind"], tile.ids)
        assert tile.attributes["kind"].dtype == np.int16
        assert np.array_equal(tile.attributes["z"], tile.points[:, 0])


def test_other_files(tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    np.save(tmp_path / "points.npy", POINTS)
    text = "\n".join(f"{x!r},{y!r}" for x, y in POINTS.tolist())
    (tmp_path / "points.csv").write_text("x,y\n" + text)
    right = canonical(Delaunay(POINTS).simplices)
    for name in ("points.npy", "points.csv"):
        tin = distributed.triangulate(tmp_path / name, tmp_path / f"{name}.tin", tile_points=300)
        assert np.array_equal(canonical(tin.read_simplices()), right)


@pytest.fixture
def lidar() -> Any:
    pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    from delone.io import read_points

    return read_points(LIDAR)


def test_lidar(
    lidar: Any, tmp_path: Path, canonical: Callable[[Any], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sources, "PIECE", 7001)
    tin = distributed.triangulate(
        LIDAR, tmp_path / "tin", tile_points=5000, attributes=["classification"]
    )
    assert tin.crs == lidar.crs
    right = Delaunay(lidar.points)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))
    assert tin.tile(0).attributes["classification"].dtype == np.uint8


@pytest.mark.parametrize("empty", [False, True])
def test_copc(lidar: Any, write_copc: Callable[..., Any], empty: bool, tmp_path: Path) -> None:
    import laspy

    from delone.io import las, read_points

    path = tmp_path / "survey.copc.laz"
    some = slice(0, 40_000)
    order = write_copc(path, lidar.points[some], lidar.z[some], empty=empty)
    # Another reader finds the octree.
    with laspy.CopcReader.open(path) as file:
        assert len(file.query()) == len(order)
        assert len(file.query(level=0)) == len(order) / 8
    whole = read_points(path)
    np.testing.assert_allclose(whole.points, lidar.points[order], atol=1e-6)
    # Chunks end at 5,000, 14,179, 14,219, and 31,918 points.
    for start in (0, 3001, 5000, 9003, 14_178, 14_200, 39_000):
        for stop in (start + 1, start + 60, start + 997, 40_000):
            found = las.read_range(path, start, stop, attributes=["intensity"])
            assert np.array_equal(found.points, whole.points[start:stop])
            assert np.array_equal(found.z, whole.z[start:stop])


def test_copc_in_pieces(
    lidar: Any,
    write_copc: Callable[..., Any],
    tmp_path: Path,
    canonical: Callable[[Any], Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from delone.io import read_points

    path = tmp_path / "survey.copc.laz"
    write_copc(path, lidar.points[:40_000], lidar.z[:40_000])
    monkeypatch.setattr(sources, "PIECE", 3001)
    tin = distributed.triangulate(path, tmp_path / "tin", tile_points=9000)
    right = Delaunay(read_points(path).points)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))


def test_classes_are_chosen(lidar: Any, tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    from delone.io import read_points

    whole = read_points(LIDAR, attributes=["classification"])
    ground = np.flatnonzero(whole.attributes["classification"] == 2)
    tin = distributed.triangulate(LIDAR, tmp_path / "tin", tile_points=4000, classes=[2])
    right = ground[Delaunay(whole.points[ground]).simplices]
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right))


def test_a_piece_may_have_no_point_of_the_classes(
    lidar: Any, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    import laspy

    # The first file has ground points, the second one none.
    for name, code in (("a.las", 2), ("b.las", 6)):
        made = laspy.create(point_format=0, file_version="1.2")
        made.header.scales = [0.01] * 3
        some = slice(0, 400) if code == 2 else slice(400, 800)
        made.x, made.y, made.z = *lidar.points[some].T, lidar.z[some]
        made.classification = np.full(400, code, dtype=np.uint8)
        made.write(tmp_path / name)
    files = [tmp_path / "a.las", tmp_path / "b.las"]
    tin = distributed.triangulate(files, tmp_path / "tin", tile_points=100, classes=[2])
    right = Delaunay(read_points(files[0]).points)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))


def test_torn_and_lying_lidar_files(lidar: Any, tmp_path: Path) -> None:
    whole = LIDAR.read_bytes()
    torn = tmp_path / "torn.laz"
    torn.write_bytes(whole[: len(whole) // 2])
    lying = tmp_path / "lying.laz"
    at = 247 if whole[25] >= 4 else 107
    lying.write_bytes(whole[:at] + b"\xff\xff\xff\x7f" + whole[at + 4 :])
    modest = tmp_path / "modest.laz"
    modest.write_bytes(whole[:at] + b"\xe8\x03\0\0" + whole[at + 4 :])
    for path in (torn, lying, modest):
        with pytest.raises(FileFormatError, match=path.name):
            distributed.triangulate(path, tmp_path / "tin")
    # Bytes in the middle say nothing of themselves; the decoder finds out, or reads other points.
    with pytest.raises(FileFormatError, match="has no 'colour'"):
        distributed.triangulate(LIDAR, tmp_path / "tin", attributes=["colour"])
    assert not (tmp_path / "tin").exists()


@pytest.mark.parametrize("change", ["move", "shift", "shorten", "remove"])
def test_a_file_that_changes_under_a_run_is_noticed(change: str, tmp_path: Path) -> None:
    source, points = tmp_path / "a.npy", datasets.uniform(2000)
    other = {"move": datasets.uniform(2000, seed=5), "shift": points + 10, "shorten": points[1:]}
    np.save(source, points)

    def tell(progress: distributed.Progress) -> None:
        if progress.stage == "deal" and progress.done == 0:
            source.unlink()
            if change in other:
                np.save(source, other[change])

    with pytest.raises(FileFormatError, match=r"a\.npy has changed since"):
        distributed.triangulate(source, tmp_path / "tin", tile_points=300, progress=tell)
    assert not (tmp_path / "tin" / "manifest.json").exists()


def test_arrays_in_files_are_taken_whole_or_refused(tmp_path: Path) -> None:
    source = tmp_path / "a.npy"
    np.save(source, datasets.uniform(50))
    whole = source.read_bytes()
    for content in (whole + b"more", whole[:-1], whole[:90], b"hello"):
        source.write_bytes(content)
        with pytest.raises(FileFormatError) as error:
            distributed.triangulate(source, tmp_path / "tin")
        with pytest.raises(FileFormatError) as same:
            read_points(source)
        assert str(error.value) == str(same.value)


def test_missing_files_and_columns(tmp_path: Path) -> None:
    path = table(tmp_path / "points.parquet", POINTS)
    with pytest.raises(FileFormatError, match="kind"):
        distributed.triangulate(path, tmp_path / "tin", attributes=["kind"])
    with pytest.raises(FileFormatError, match="east"):
        distributed.triangulate(path, tmp_path / "tin", columns=["east", "north"])
    with pytest.raises(FileNotFoundError):
        distributed.triangulate(tmp_path / "gone.laz", tmp_path / "tin")
    with pytest.raises(InputError, match="no file matches"):
        distributed.triangulate(str(tmp_path / "*.laz"), tmp_path / "tin")
    with pytest.raises(InputError, match="twice"):
        distributed.triangulate([path, path], tmp_path / "tin")
    other = table(tmp_path / "other.parquet", POINTS, z=POINTS[:, 0])
    with pytest.raises(InputError, match="heights"):
        distributed.triangulate([path, other], tmp_path / "tin")


def test_mixed_reference_systems(tmp_path: Path) -> None:
    geopandas = pytest.importorskip("geopandas")
    for code in (4326, 28992):
        points = geopandas.points_from_xy(POINTS[:, 0], POINTS[:, 1])
        frame = geopandas.GeoDataFrame(geometry=points, crs=code)
        frame.to_parquet(tmp_path / f"{code}.parquet")
    with pytest.raises(InputError, match=r"mixed reference systems: .*28992.*4326"):
        distributed.triangulate(tmp_path, tmp_path.parent / "tin")


def test_rows_that_are_not_finite(tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    points = POINTS.copy()
    points[[3, 700]] = np.nan
    points[512, 1] = np.inf
    with pytest.raises(NonFiniteError) as caught:
        distributed.triangulate(points, tmp_path / "tin", tile_points=300)
    assert caught.value.rows.tolist() == [3, 512, 700]
    assert caught.value.count == 3
    # As the error proposes, in the same place.
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=300, nan="drop")
    assert tin.manifest["dropped"] == 3
    kept = np.flatnonzero(np.isfinite(points).all(axis=1))
    right = kept[Delaunay(points[kept]).simplices]
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right))
    with pytest.raises(InputError, match="nan must be"):
        distributed.triangulate(points, tmp_path / "third", nan="ignore")


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"k": ["a"] * 900}, "is not one number per row"),
        ({"k": [None, *range(1, 900)]}, None),
        ({"k": [None, *range(1 << 60, (1 << 60) + 899)]}, r"beyond (the )?2\*\*53"),
        ({"K": range(900)}, None),
        ({"K": range(900), "k": range(900)}, None),
        ({"x": range(1 << 60, (1 << 60) + 900), "k": range(900)}, r"column 'x' .* 2\*\*53"),
        ({"z": [None, *range(1 << 60, (1 << 60) + 899)], "k": range(900)}, r"column 'z'"),
    ],
)
def test_columns_are_carried_whole_or_refused(columns: Any, words: Any, tmp_path: Path) -> None:
    path = table(tmp_path / "points.parquet", POINTS, **columns)
    options: dict[str, Any] = {"tile_points": 300, "attributes": ["k"]}
    if words is not None:
        with pytest.raises(FileFormatError, match=words) as caught:
            distributed.triangulate(path, tmp_path / "tin", **options)
        assert "points.parquet" in str(caught.value)
        # Nothing is left that other arguments could not go on from.
        assert not (tmp_path / "tin").exists()
        return
    tin = distributed.triangulate(path, tmp_path / "tin", **options)
    right = np.array(columns.get("k", columns.get("K")), dtype=float)
    for tile in tin.tiles():
        assert np.array_equal(tile.attributes["k"], right[tile.ids], equal_nan=True)


@pytest.mark.parametrize("other", [np.arange(450.0), np.arange(450, dtype=np.uint64)])
def test_files_whose_attributes_have_other_types(other: Any, tmp_path: Path) -> None:
    table(tmp_path / "0.parquet", POINTS[:450], k=np.arange(450))
    table(tmp_path / "1.parquet", POINTS[450:], k=other)
    source = str(tmp_path / "*.parquet")
    tin = distributed.triangulate(source, tmp_path / "tin", tile_points=300, attributes=["k"])
    for tile in tin.tiles():
        assert np.array_equal(tile.attributes["k"], tile.ids % 450)
    table(tmp_path / "0.parquet", POINTS[:450], k=np.arange(450) + (1 << 53))
    with pytest.raises(DtypeError, match=r"attribute 'k' .* of row 1 is beyond (the )?2\*\*53"):
        distributed.triangulate(source, tmp_path / "tin2", tile_points=300, attributes=["k"])
    assert not (tmp_path / "tin2").exists()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("scale", [float("inf"), float("nan"), 1e308])
def test_scales_of_a_header_beyond_the_range(scale: float, tmp_path: Path) -> None:
    laspy = pytest.importorskip("laspy")
    las = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
    las.header.scales = np.full(3, 0.01)
    las.x, las.y = np.round(POINTS.T, 2)
    las.add_extra_dim(laspy.ExtraBytesParams(name="normal", type="3f4"))
    path = tmp_path / "points.las"
    las.write(str(path))
    with pytest.raises(FileFormatError, match=r"'normal' is not one number per row \(float32, sev"):
        distributed.triangulate(path, tmp_path / "tin", attributes=["normal"])
    whole = bytearray(path.read_bytes())
    whole[131:139] = struct.pack("<d", scale)
    path.write_bytes(whole)
    with pytest.raises(NonFiniteError, match="points have NaN") as caught:
        distributed.triangulate(path, tmp_path / "tin")
    assert caught.value.count > 800
    assert not (tmp_path / "tin").exists()


def test_why_there_are_no_points(tmp_path: Path) -> None:
    with pytest.raises(DegenerateInputError, match="no points but 9 with NaN"):
        distributed.triangulate(np.full((9, 2), np.nan), tmp_path / "tin", nan="drop")
    pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    with pytest.raises(DegenerateInputError, match="no points of class 9 or 12"):
        distributed.triangulate(LIDAR, tmp_path / "tin", classes=[9, 12])
    assert not (tmp_path / "tin").exists()


def test_folders_of_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home = tmp_path / "a home of Émile"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setenv("USERPROFILE", str(home))
    monkeypatch.chdir(tmp_path)
    table(home / "points [1].parquet", POINTS)
    for source in ("~/points [1].parquet", "~/*.parquet"):
        tin = distributed.triangulate(source, "~/tin", tile_points=300)
        assert tin.path == home / "tin"
    assert distributed.open("~/tin").npoints == 900
    assert sorted(p.name for p in tmp_path.iterdir()) == [home.name]


def test_heights_that_are_not_finite_are_no_points(
    tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    z = np.arange(900.0)
    z[[5, 600]] = np.nan
    z[31] = np.inf
    path = table(tmp_path / "points.parquet", POINTS, z=z)
    for source in (path, np.column_stack([POINTS, z])):
        with pytest.raises(NonFiniteError, match="height") as caught:
            distributed.triangulate(source, tmp_path / "tin", tile_points=300)
        assert caught.value.rows.tolist() == [5, 31, 600]
    tin = distributed.triangulate(path, tmp_path / "tin", tile_points=300, nan="drop")
    assert (tin.manifest["dropped"], tin.npoints) == (3, 897)
    kept = np.flatnonzero(np.isfinite(z))
    assert np.array_equal(
        canonical(tin.read_simplices()), canonical(kept[Delaunay(POINTS[kept]).simplices])
    )
    inside = POINTS[kept][tin.find_simplex(POINTS[kept]) >= 0]
    assert np.isfinite(tin.interpolate(inside)).all()
    assert tin.validate(), str(tin.validate())


def test_attributes_that_are_not_finite_are_carried(
    tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    value = np.arange(900.0)
    value[[5, 600]] = np.nan
    value[31] = np.inf
    path = table(tmp_path / "points.parquet", POINTS, value=value, height=value)
    tin = distributed.triangulate(
        path, tmp_path / "tin", tile_points=300, attributes=["value", "height"], columns=["x", "y"]
    )
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(POINTS).simplices))
    for tile in tin.tiles():
        assert np.array_equal(tile.attributes["value"], value[tile.ids], equal_nan=True)
        assert np.array_equal(tile.attributes["height"], value[tile.ids], equal_nan=True)
    # In triangles with such a corner there is no value.
    assert np.isnan(tin.interpolate(POINTS[[5, 600]], values="value")).all()
    assert tin.validate(), str(tin.validate())


@pytest.mark.parametrize(
    ("points", "reason"),
    [
        (np.empty((0, 2)), "too few points"),
        ([(1, 1)] * 9, "too few points"),
        ([(1, 1), (2, 2)], "collinear"),
        ([(i, 2 * i) for i in range(500)], "collinear"),
    ],
)
def test_points_that_span_no_area(points: Any, reason: str, tmp_path: Path) -> None:
    with pytest.raises(DegenerateInputError) as caught:
        distributed.triangulate(np.array(points, float), tmp_path / "tin", tile_points=100)
    assert caught.value.reason == reason


@pytest.mark.parametrize("size", [0, 2, -5, 1 << 40])
def test_sizes_of_tiles_out_of_range(size: int, tmp_path: Path) -> None:
    with pytest.raises(InputError):
        distributed.triangulate(POINTS, tmp_path / "tin", tile_points=size)
