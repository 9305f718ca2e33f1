"""Reference systems on their way from files through triangulations into files."""

from __future__ import annotations

import copy
import pickle
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import ConstrainedDelaunay, CRSWarning, Delaunay
from delone._base.georeference import as_crs, crs_of
from delone.errors import DtypeError, FileFormatError, InputError
from delone.interpolate import grid
from delone.io import GeometrySet, read_geometries, read_points, write_mesh, write_raster

pyproj = pytest.importorskip("pyproj")
geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")

DUTCH = "EPSG:28992"
BOXES = [shapely.box(0, 0, 400, 300), shapely.LineString([(0, 0), (400, 300)])]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "lines.gpkg"
    geopandas.GeoDataFrame(geometry=BOXES, crs=DUTCH).to_file(path, driver="GPKG")
    return path


def test_geometry_sets_are_triangulated_with_their_system(file: Path) -> None:
    lines = read_geometries(file)
    mesh = delone.from_geometry(lines)
    assert mesh.crs == DUTCH
    assert mesh.to_geopandas().crs == DUTCH
    assert mesh.to_geopandas(crs=4326).crs == "EPSG:4326"
    plain = delone.from_geometry(lines.geometries)
    assert plain.crs is None and plain.to_geopandas().crs is None
    assert (plain.simplices == mesh.simplices).all()
    assert (plain.geometry_of_segment == mesh.geometry_of_segment).all()
    assert delone.from_geometry(lines.geometries, crs=lines.crs).crs == DUTCH
    assert delone.from_geometry([lines, *BOXES]).crs == DUTCH
    assert delone.mesh(lines, size=200).nsimplex > 0


def test_tables_and_series_have_one(file: Path) -> None:
    frame = geopandas.read_file(file)
    for given in (frame, frame.geometry, frame.geometry.values, [frame, frame.geometry]):
        assert delone.from_geometry(given).crs == DUTCH
    assert delone.from_geometry(frame.geometry.tolist()).crs is None
    assert delone.from_geometry(frame, crs=pyproj.CRS(28991)).crs == "EPSG:28991"


def test_two_systems_are_refused(file: Path) -> None:
    frame = geopandas.read_file(file)
    with pytest.raises(InputError, match=r"EPSG:28992 and in EPSG:32631.*to_crs"):
        delone.from_geometry([frame, frame.to_crs(32631)])
    with pytest.warns(CRSWarning, match="some geometries is EPSG:28992; that of others is unknown"):
        assert delone.from_geometry([frame, frame.set_crs(None, allow_override=True)]).crs == DUTCH
    same = frame.set_crs(pyproj.CRS(DUTCH).to_wkt(), allow_override=True)
    assert delone.from_geometry([frame, same]).crs == DUTCH


def test_it_is_kept(file: Path, tmp_path: Path) -> None:
    mesh = delone.from_geometry(read_geometries(file))
    with mesh.edit() as edit:
        edit.insert_points([(100, 50)])
    mesh.save(tmp_path / "a.npz")
    write_mesh(tmp_path / "b.npz", mesh)
    write_mesh(tmp_path / "c.npz", mesh, crs="EPSG:28991")
    kept = [
        pickle.loads(pickle.dumps(mesh)),
        copy.deepcopy(mesh),
        edit.result,
        ConstrainedDelaunay.load(tmp_path / "a.npz"),
        ConstrainedDelaunay.load(tmp_path / "b.npz"),
    ]
    assert [each.crs for each in kept] == [DUTCH] * 5
    assert ConstrainedDelaunay.load(tmp_path / "c.npz").crs == "EPSG:28991"
    assert read_points(tmp_path / "a.npz").crs == DUTCH
    long = delone.from_geometry(BOXES, crs=pyproj.CRS(DUTCH).to_wkt())
    long.save(tmp_path / "d.npz")
    assert ConstrainedDelaunay.load(tmp_path / "d.npz").crs == long.crs
    assert ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], []).crs is None
    with pytest.raises(FileFormatError, match="'crs' is the name"):
        write_mesh(tmp_path / "e.npz", mesh, attributes={"crs": np.zeros(mesh.npoints)})


def test_files_have_that_of_the_triangulation(file: Path, tmp_path: Path) -> None:
    mesh = delone.from_geometry(read_geometries(file))
    write_mesh(tmp_path / "a.gpkg", mesh)
    assert geopandas.read_file(tmp_path / "a.gpkg").crs == DUTCH
    write_mesh(tmp_path / "a.gpkg", mesh, crs=pyproj.CRS("EPSG:28991"))
    assert geopandas.read_file(tmp_path / "a.gpkg").crs == "EPSG:28991"


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".ply", ".obj", ".stl", ".xdmf", ".inp"])
def test_formats_without_a_place_for_it_warn(suffix: str, tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    pytest.importorskip("h5py")
    mesh = Delaunay([(0, 0), (400, 0), (0, 300)])
    with pytest.warns(
        CRSWarning, match=rf"\{suffix} files cannot store a reference system; EPSG:28992"
    ):
        write_mesh(tmp_path / f"a{suffix}", mesh, crs=DUTCH)
    with warnings.catch_warnings():
        warnings.simplefilter("error", CRSWarning)
        write_mesh(tmp_path / f"a{suffix}", mesh)
        # What nobody asked for is not missed.
        write_mesh(tmp_path / f"a{suffix}", delone.from_geometry(BOXES, crs=DUTCH))


def test_formats_with_a_place_do_not_warn(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    mesh = Delaunay([(0, 0), (400, 0), (0, 300)])
    with warnings.catch_warnings():
        warnings.simplefilter("error", CRSWarning)
        for suffix in (".gpkg", ".geojson", ".npz", ".png", ".svg"):
            write_mesh(tmp_path / f"a{suffix}", mesh, crs=DUTCH)
    solid = Delaunay(np.vstack((np.zeros(3), np.eye(3))))
    with pytest.warns(CRSWarning, match="npz"):
        write_mesh(tmp_path / "solid.npz", solid, crs=DUTCH)


def test_rasters(tmp_path: Path) -> None:
    ramp = grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], resolution=1)
    with pytest.warns(CRSWarning, match="csv files cannot store a reference system"):
        write_raster(tmp_path / "a.csv", ramp, crs=DUTCH)
    rasterio = pytest.importorskip("rasterio")
    for crs in (DUTCH, 28992, pyproj.CRS(DUTCH)):
        write_raster(tmp_path / "a.tif", ramp, crs=crs, units="m")
        with rasterio.open(tmp_path / "a.tif") as file:
            assert file.crs.to_epsg() == 28992 and file.units == ("m",)


def test_what_is_no_system() -> None:
    assert as_crs(None) is None and as_crs("") is None
    assert as_crs(np.int64(4326)) == "EPSG:4326"
    for odd in (True, 1.5, [4326]):
        with pytest.raises(DtypeError, match="crs must be a reference system"):
            as_crs(odd)
    assert crs_of(object()) is None
    assert crs_of(geopandas.GeoDataFrame({"a": [1]})) is None
    assert crs_of(GeometrySet(geometries=np.array(BOXES), crs=DUTCH)) == DUTCH


def netcdf(tmp_path: Path, **options: Any) -> Any:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("netCDF4")
    ramp = grid([(4, 50), (8, 50), (4, 54)], [0.0, 4.0, 4.0], resolution=1)
    write_raster(tmp_path / "a.nc", ramp, name="depth", **options)
    with xarray.open_dataset(tmp_path / "a.nc", decode_coords=False) as file:
        np.testing.assert_array_equal(file.depth.values, ramp.values)
        return file.load()


@pytest.mark.parametrize(
    ("crs", "names", "units"),
    [
        ("EPSG:4326", ("longitude", "latitude"), ("degrees_east", "degrees_north")),
        (DUTCH, ("projection_x_coordinate", "projection_y_coordinate"), ("metre", "metre")),
    ],
)
def test_netcdf_by_the_cf_conventions(tmp_path: Path, crs: str, names: Any, units: Any) -> None:
    file = netcdf(tmp_path, crs=crs, units="m")
    assert file.attrs["Conventions"] == "CF-1.8"
    assert file.depth.attrs == {"long_name": "depth", "units": "m", "grid_mapping": "crs"}
    assert tuple(file[axis].attrs["standard_name"] for axis in "xy") == names
    assert tuple(file[axis].attrs["units"] for axis in "xy") == units
    assert [file[axis].attrs["axis"] for axis in "xy"] == ["X", "Y"]
    assert "_FillValue" not in file.x.encoding and np.isnan(file.depth.encoding["_FillValue"])
    assert file.crs.dims == () and pyproj.CRS.from_cf(file.crs.attrs) == pyproj.CRS(crs)


def test_netcdf_without_a_system(tmp_path: Path) -> None:
    file = netcdf(tmp_path)
    assert set(file.data_vars) == {"depth"}
    assert file.depth.attrs == {"long_name": "depth"}
    assert (file.x.attrs, file.y.attrs) == ({"axis": "X"}, {"axis": "Y"})
    with pytest.raises(FileFormatError, match="does not know"):
        netcdf(tmp_path, crs="EPSG:1")


def test_netcdf_is_read_by_gdal(tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    netcdf(tmp_path, crs=DUTCH)
    with rasterio.Env() as environment:
        if "netCDF" not in environment.drivers():
            pytest.skip("this GDAL reads no NetCDF")
        with rasterio.open(tmp_path / "a.nc") as file:
            assert file.crs.to_epsg() == 28992
            assert tuple(file.bounds) == (4, 50, 8, 54)


@pytest.mark.parametrize("crs", ["nope", "EPSG:1", 1])
def test_systems_that_do_not_exist_are_refused(crs: Any) -> None:
    ring = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 0)]]}
    with pytest.raises(InputError, match=r"crs must be a reference system .* pyproj does not know"):
        delone.from_geometry(ring, crs=crs)
    assert delone.from_geometry(ring, crs=28992).crs == DUTCH


def test_without_pyproj_any_name_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(delone._base.georeference, "_has_pyproj", lambda: False)
    ring = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 0)]]}
    assert delone.from_geometry(ring, crs="nope").crs == "nope"
