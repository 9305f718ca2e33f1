"""Rasters of heights as points: centers of cells, nodata, reference systems, bounds."""

import warnings

import numpy as np
import pytest
import rasterio

from delone.errors import FileFormatError, InputError
from delone.interpolate import grid
from delone.io import LeftOutWarning, read_points, read_raster, write_raster
from delone.terrain import TIN

HEIGHTS = np.array([[5, 6, 7], [8, -9999, 10]], dtype=np.float32)
ASC = (
    "ncols 3\nnrows 2\nxll{0} {1}\nyll{0} {2}\ncellsize 4\nNODATA_value -9999\n5 6 7\n8 -9999 10\n"
)
CENTERS = [[102, 206, 5], [106, 206, 6], [110, 206, 7], [102, 202, 8], [110, 202, 10]]


def tif(path, values=HEIGHTS, *, transform=None, tags=None, **profile):
    bands = values[None] if values.ndim == 2 else values
    given = {
        "driver": "GTiff", "count": len(bands), "height": bands.shape[1], "width": bands.shape[2],
        "dtype": bands.dtype, "nodata": -9999, "crs": "EPSG:28992",
        "transform": transform or rasterio.Affine(4, 0, 100, 0, -4, 208),
    }  # fmt: skip
    with rasterio.open(path, "w", **given | profile) as file:
        file.update_tags(**tags or {})
        file.write(bands)
    return path


def places(survey):
    return np.column_stack((survey.points, survey.z)).tolist()


def test_cells_are_points_at_their_centers(tmp_path):
    with pytest.warns(LeftOutWarning, match="1 cell without a height"):
        survey = read_raster(tif(tmp_path / "a.tif"))
    assert places(survey) == CENTERS
    assert survey.crs == "EPSG:28992"
    with pytest.warns(LeftOutWarning):
        assert places(read_points(tmp_path / "a.tif")) == CENTERS


def test_pixels_that_are_points_are_where_they_are(tmp_path):
    path = tif(tmp_path / "a.tif", tags={"AREA_OR_POINT": "Point"})
    with pytest.warns(LeftOutWarning):
        assert places(read_raster(path)) == CENTERS


@pytest.mark.parametrize(("word", "x", "y"), [("corner", 100, 200), ("center", 102, 202)])
def test_ascii_grids(word, x, y, tmp_path):
    path = tmp_path / "a.asc"
    path.write_text(ASC.format(word, x, y))
    with pytest.warns(LeftOutWarning, match="1 cell"):
        survey = read_raster(path)
    assert places(survey) == CENTERS
    assert survey.crs is None
    path.with_suffix(".prj").write_text(rasterio.CRS.from_epsg(28992).to_wkt(version="WKT1_ESRI"))
    with pytest.warns(LeftOutWarning, match="1 cell"):
        assert "RD_New" in read_raster(path).crs or "28992" in read_raster(path).crs


def test_rotated_rasters(tmp_path):
    turned = rasterio.Affine(3, 4, 100, 4, -3, 200)
    survey = read_raster(tif(tmp_path / "a.tif", HEIGHTS.clip(0), transform=turned))
    assert places(survey)[:2] == [[103.5, 200.5, 5], [106.5, 204.5, 6]]
    assert places(survey)[3] == [107.5, 197.5, 8]


def test_scale_offset_nan_and_bands(tmp_path):
    values = np.array([[[1, 2], [3, 4]], [[np.nan, 6], [np.inf, 8]]])
    path = tif(tmp_path / "a.tif", values)
    with rasterio.open(path, "r+") as file:
        file.scales, file.offsets = (1, 0.5), (0, 10)
    with pytest.raises(FileFormatError, match="2 bands"):
        read_raster(path)
    with pytest.raises(FileFormatError, match="no band 3"):
        read_raster(path, band=3)
    assert read_points(path, layer="1").z.tolist() == [1, 2, 3, 4]
    with pytest.warns(LeftOutWarning, match="2 cells"):
        assert read_raster(path, band=2).z.tolist() == [13, 14]
    with pytest.raises(InputError, match="band"):
        read_raster(path, band=0)


def test_each_second_row_and_column(tmp_path):
    values = np.arange(35.0).reshape(5, 7)
    survey = read_raster(tif(tmp_path / "a.tif", values), step=2)
    assert survey.z.tolist() == values[::2, ::2].ravel().tolist()
    assert survey.points[1].tolist() == [110, 206]


def test_what_delone_writes_is_read(tmp_path):
    points = np.random.default_rng(5).integers(0, 400, (40, 2)) / 4
    points[:2] = (0, 0), (100, 100)
    raster = grid(points, points.sum(axis=1), resolution=5)
    write_raster(tmp_path / "a.tif", raster, crs="EPSG:28992")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LeftOutWarning)
        survey = read_raster(tmp_path / "a.tif")
    nodes = {
        (x, y): raster.values[i, j] for i, y in enumerate(raster.y) for j, x in enumerate(raster.x)
    }
    assert len(survey) == np.isfinite(raster.values).sum()
    for x, y, z in places(survey):
        assert nodes[x, y] == z
    assert TIN.from_points(survey).crs == "EPSG:28992"


def test_sizes_are_bounded_and_the_message_says_how_to_sample(tmp_path):
    path = tif(tmp_path / "a.tif", np.ones((30, 40)))
    with pytest.raises(FileFormatError, match=r"40 x 30 cells, .* step=4 ") as caught:
        read_raster(path, max_points=100)
    assert "--step" in str(caught.value)
    assert len(read_raster(path, max_points=100, step=4)) == 80

    # A sparse file of a few bytes that declares 10 TB, in huge blocks.
    huge = {"height": 2**20, "width": 2**20, "count": 1, "dtype": "float64", "driver": "GTiff"}
    where = {"transform": rasterio.Affine(2, 0, 0, 0, -2, 0), "SPARSE_OK": True, "BIGTIFF": "YES"}
    with rasterio.open(tmp_path / "b.tif", "w", **huge, **where, tiled=True):
        pass
    with pytest.raises(FileFormatError, match="step="):
        read_raster(tmp_path / "b.tif")


def test_what_is_no_raster_of_heights_is_refused(tmp_path):
    (tmp_path / "a.tif").write_bytes(b"II*\0 is no raster")
    with pytest.raises(FileFormatError, match=r"truncated or not a \.tif"):
        read_raster(tmp_path / "a.tif")
    (tmp_path / "b.tif").write_text("<VRTDataset rasterXSize='1' rasterYSize='1'></VRTDataset>")
    with pytest.raises(FileFormatError, match=r"truncated or not a \.tif"):
        read_raster(tmp_path / "b.tif")
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        tif(tmp_path / "c.tif", transform=rasterio.Affine.identity())
    with pytest.raises(FileFormatError, match="no georeference"):
        read_raster(tmp_path / "c.tif")
    with pytest.raises(FileFormatError, match="complex"):
        read_raster(tif(tmp_path / "d.tif", np.ones((2, 2), complex), nodata=None))
    with pytest.raises(FileFormatError, match="no cell has a height"):
        read_raster(tif(tmp_path / "e.tif", np.full((2, 2), -9999.0)))
    with pytest.raises(FileFormatError, match="not a raster"):
        read_raster(tmp_path / "f.csv")


def test_files_beside_a_raster_are_not_opened(tmp_path):
    path = tif(tmp_path / "a.tif", HEIGHTS.clip(0), crs=None)
    (tmp_path / "a.tif.aux.xml").write_text(
        "<PAMDataset><SRS>EPSG:4326</SRS><GeoTransform>0,1,0,0,0,-1</GeoTransform></PAMDataset>"
    )
    (tmp_path / "a.tfw").write_text("1\n0\n0\n-1\n0\n0\n")
    survey = read_raster(path)
    assert survey.crs is None
    assert survey.points[0].tolist() == [102, 206]
    (tmp_path / "b.asc").write_text(ASC.format("corner", 100, 200))
    (tmp_path / "secret").write_text("x")
    (tmp_path / "b.prj").symlink_to(tmp_path / "secret")
    with pytest.raises(FileFormatError, match="link to another file"):
        read_raster(tmp_path / "b.asc")
