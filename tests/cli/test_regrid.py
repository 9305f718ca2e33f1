"""The command ``delone regrid``: files, weights, variables, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from delone import sphere

xarray = pytest.importorskip("xarray")
netcdf = pytest.importorskip("netCDF4")
import delone.xarray  # noqa: E402, F401  (it registers the accessors)

LON, LAT = np.arange(0, 361, 20.0), np.arange(-90, 91, 20.0)


@pytest.fixture
def model(tmp_path):
    """Two fields of four times, of which one has missing values."""
    rng = np.random.default_rng(3)
    rain = rng.random((4, 9, 18)).astype(np.float32)
    rain[:, 2:4, 3:9] = np.nan
    ds = xarray.Dataset(
        {
            "rain": (("time", "lat", "lon"), rain, {"units": "mm"}),
            "height": (("lat", "lon"), rng.random((9, 18))),
            "lon_bnds": (("lon", "b"), np.column_stack((LON[:-1], LON[1:]))),
            "lat_bnds": (("lat", "b"), np.column_stack((LAT[:-1], LAT[1:]))),
        },
        coords={
            "lon": ("lon", LON[:-1] + 10, {"units": "degrees_east", "bounds": "lon_bnds"}),
            "lat": ("lat", LAT[:-1] + 10, {"units": "degrees_north", "bounds": "lat_bnds"}),
            "time": (
                "time",
                np.arange(4.0),
                {"units": "months since 2001-01-01"},
            ),
        },
    )
    path = tmp_path / "model.nc"
    ds.to_netcdf(path, unlimited_dims=["time"])
    return path


def opened(path):
    with xarray.open_dataset(path, decode_times=False) as ds:
        return ds.load()


def test_a_file_to_a_file(model, tmp_path, figures):
    out = tmp_path / "out.nc"
    found = figures("regrid", model, "30x30", "-o", out)
    ds = opened(out)
    expected = opened(model).delone.regrid("30x30")
    assert np.array_equal(ds.rain.values, expected.rain.values, equal_nan=True)
    assert ds.rain.dtype == np.float32
    assert ds.rain.attrs == {"units": "mm"}
    assert ds.rain.dims == ("time", "lat", "lon")
    # Times in units that nothing decodes remain what they are.
    assert ds.time.attrs["units"] == "months since 2001-01-01"
    with netcdf.Dataset(out) as file:
        assert file.dimensions["time"].isunlimited()
    assert found["variables"] == ["rain", "height"]
    assert found["source"] == {"cells": 162, "shape": [9, 18], "sides": "parallel"}
    assert found["target"]["shape"] == [6, 12]
    assert found["target_covered"] == pytest.approx(1, rel=1e-14)
    assert found["weights"] == len(
        sphere.Overlaps(
            sphere.Grid.from_lonlat(LON, LAT),
            sphere.Grid.from_lonlat(np.arange(0, 361, 30), np.arange(-90, 91, 30)),
        ).areas
    )
    assert found["outputs"] == [str(out)]


def test_weights_of_second_order(model, tmp_path, figures):
    out = tmp_path / "out.nc"
    figures("regrid", model, "7.5x7.5", "--order", "2", "--limiter", "-o", out)
    expected = opened(model).delone.regrid("7.5x7.5", order=2, limiter=True)
    assert np.array_equal(opened(out).rain.values, expected.rain.values, equal_nan=True)
    first = opened(model).delone.regrid("7.5x7.5")
    assert not np.array_equal(first.rain.values, expected.rain.values, equal_nan=True)


def test_what_is_left_out_is_said(model, tmp_path, command):
    more = tmp_path / "more.nc"
    opened(model).assign(zonal=("lat", np.zeros(9))).to_netcdf(more)
    code, out, err = command("regrid", more, "healpix:2", "-o", tmp_path / "out.nc")
    assert "zonal" not in opened(tmp_path / "out.nc")
    assert code == 0
    assert err.startswith("delone: note: zonal (lat): not in the result")
    assert command("regrid", more, "healpix:2", "-q") == (0, "", "")
    assert "9 x 18 cells, parallels" in out
    assert "48 cells, arcs of great circles" in out


def test_weights_in_and_out(model, tmp_path, figures):
    table, one, two = (tmp_path / name for name in ("map.nc", "one.nc", "two.nc"))
    options = "--method", "normalized", "--skipna", "--min-fraction", "0.4"
    found = figures("regrid", model, "healpix:4", *options, "-o", one, "--save-weights", table)
    assert found["method"] == "normalized"
    assert found["outputs"] == [str(one), str(table)]
    weights = sphere.Weights.from_netcdf(table)
    assert len(weights.values) == found["weights"]
    # The method is that of the file.
    again = figures("regrid", model, "healpix:4", "--weights", table, *options[2:], "-o", two)
    assert again["method"] == "normalized"
    a, b = opened(one), opened(two)
    assert a.identical(b)
    assert np.isnan(a.rain).any()
    assert not np.isnan(a.height).any()


def test_grids_of_other_files_and_variables(model, tmp_path, command, figures):
    bare, out = tmp_path / "bare.nc", tmp_path / "out.nc"
    ds = opened(model)
    ds.drop_vars([*ds.coords, "lon_bnds", "lat_bnds"]).to_netcdf(bare)
    code, _, err = command("regrid", bare, "30x30", "-o", out)
    assert code == 2
    assert "the dataset has no grid" in err
    found = figures("regrid", bare, model, "--grid", model, "--variables", "height", "-o", out)
    assert found["variables"] == ["height"]
    result = opened(out)
    assert np.allclose(result.height.values, ds.height.values, rtol=1e-14)
    assert set(result.data_vars) == {"height", "lon_bnds", "lat_bnds"}


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_pictures(model, tmp_path, figures, suffix):
    pytest.importorskip("matplotlib")
    picture, file = tmp_path / f"maps{suffix}", tmp_path / "out.nc"
    found = figures("regrid", model, "healpix:2", "-o", picture, "-o", file)
    assert found["outputs"] == [str(picture), str(file)]
    heads = {".png": b"\x89PNG", ".svg": b"<?xml", ".pdf": b"%PDF"}
    assert picture.read_bytes().startswith(heads[suffix])
    if suffix == ".svg":
        text = picture.read_text()
        assert "rain, 162 cells" in text
        assert "rain, 48 cells" in text
        assert "rain, difference from the nearest source cell" in text
        # Amounts of cells of other sizes have no difference.
        figures("regrid", model, "healpix:2", "--method", "sum", "-o", picture)
        assert "difference" not in picture.read_text()
    assert opened(file).rain.shape == (4, 48)


def test_fields_at_nodes_and_bilinear_on_quadrilaterals(tmp_path, figures, command):
    lon, lat = np.meshgrid(np.arange(0.0, 41, 10), np.arange(-20.0, 21, 10))
    lon += lat / 7
    at = np.arange(25).reshape(5, 5)
    faces = np.stack((at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]), axis=2).reshape(-1, 4)
    ds = xarray.Dataset(
        {
            "mesh": ((), 0, {"cf_role": "mesh_topology", "node_coordinates": "x y",
                             "face_node_connectivity": "faces"}),
            "faces": (("face", "four"), faces, {"start_index": 0}),
            "x": ("node", lon.ravel(), {"units": "degrees_east"}),
            "y": ("node", lat.ravel(), {"units": "degrees_north"}),
            "t": ("node", 3 + lat.ravel()),
        }
    )  # fmt: skip
    ds.to_netcdf(tmp_path / "mesh.nc")
    out = tmp_path / "out.nc"
    found = figures(
        "regrid", tmp_path / "mesh.nc", "2x2", "--cells", "nodes", "--method", "bilinear", "-o", out
    )
    assert (found["source"]["cells"], found["variables"]) == (25, ["t"])
    result = opened(out).t
    inside = result.sel(lat=slice(-20, 20), lon=slice(12, 28))
    # Parallels are not straight: between 10 degrees of longitude they bend by this much.
    assert np.abs(inside - 3 - inside.lat).max() < 0.1
    assert inside.notnull().all()
    code, _, err = command("regrid", tmp_path / "mesh.nc", "2x2", "--cells", "edges")
    assert (code, "cells must be" in err) == (2, True)


def test_without_an_output_only_the_report(model, tmp_path, figures):
    before = sorted(tmp_path.iterdir())
    assert figures("regrid", model, "1x1")["weights"] == 64800
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("{model}", "7x7"), 2, "7 degrees do not divide"),
        (("{model}", "nowhere"), 2, "no grid is called 'nowhere'"),
        (("none.nc", "1x1"), 3, "none.nc: No such file"),
        (("{text}", "1x1"), 3, "not a NetCDF file"),
        (("{model}", "{text}"), 3, "not a NetCDF file"),
        (
            ("{model}", "1x1", "-o", "a.tif"),
            2,
            "the output can only be written to .nc .nc4 .cdf .png",
        ),
        (("{model}", "1x1", "--save-weights", "a.png"), 2, "only be written to .nc .nc4 .cdf"),
        (("{model}", "1x1", "-o", "{model}"), 2, "would replace the input"),
        (("{model}", "1x1", "--coords", "lon"), 2, "a longitude and a latitude"),
        (("{model}", "1x1", "--variables", "snow"), 2, "no variable 'snow'; it has rain"),
        (("{model}", "1x1", "--method", "cubic"), 2, "method"),
        (("{model}", "1x1", "--order", "3"), 2, "order must be"),
        (("{model}", "1x1", "--limiter"), 2, "limiter is for --order 2"),
        (("{model}", "1x1", "--method", "sum", "--order", "2"), 2, "--order 2 is for conservative"),
        (("{bare}", "1x1"), 2, "give --infer-bounds"),
        (("{bare}", "1x1", "--infer-bounds", "--radians"), 2, "contradicts"),
        (("{model}", "1x1", "--weights", "{text}"), 3, "not a NetCDF file"),
        (("{model}", "1x1", "--min-fraction", "2"), 2, "--min-fraction must be from 0 to 1"),
    ],
)
def test_what_is_refused(model, command, arguments, code, message):
    tmp_path = model.parent
    bare, text = tmp_path / "bare.nc", tmp_path / "text.nc"
    ds = opened(model).drop_vars(["lon_bnds", "lat_bnds"])
    for name in ("lon", "lat"):
        del ds[name].attrs["bounds"]
    ds.to_netcdf(bare)
    text.write_text("no file")
    given = [str(each).format(model=model, bare=bare, text=text) for each in arguments]
    found, out, err = command("regrid", *given)
    assert found == code, err
    assert message in err
    assert out == ""


def test_fields_on_other_dimensions(tmp_path, command):
    # The mesh is in one file, and the field in another one, which calls its cells differently.
    pytest.importorskip("matplotlib")
    mesh, field = tmp_path / "mesh.nc", tmp_path / "field.nc"
    places = {"units": "degrees"}
    corners = np.array([[(0, 0), (10, 0), (10, 9)], [(0, 0), (10, 9), (0, 9)]], dtype=float)
    names = ("grid_size", "grid_corners")
    xarray.Dataset(
        {
            "grid_corner_lon": (names, corners[..., 0], places),
            "grid_corner_lat": (names, corners[..., 1], places),
        }
    ).to_netcdf(mesh)
    xarray.Dataset({"psi": ("ncol", [1.0, 2.0])}).to_netcdf(field)
    for name in ("maps.png", "out.nc"):
        # A file without a field would look like a success.
        written = tmp_path / name
        options = str(field), "30x30", "--grid", str(mesh), "-o", str(written)
        code, _, errors = command("regrid", *options)
        assert code == 2
        assert "grid of 2 cells. Dimensions of variables: psi has ncol 2. Give those of" in errors
        assert not written.exists()
        assert command("regrid", *options, "--dims", "ncol")[0] == 0
        assert written.exists()
    # Without an output, only the report is wanted.
    assert command("regrid", str(field), "30x30", "--grid", str(mesh))[0] == 0


def test_files_without_fields(tmp_path, command):
    mesh = tmp_path / "mesh.nc"
    lon, lat = (
        ("x", [5.0, 15.0], {"units": "degrees_east"}),
        ("y", [5.0, 9.0], {"units": "degrees_north"}),
    )
    xarray.Dataset(coords={"x": lon, "y": lat}).to_netcdf(mesh)
    options = str(mesh), "30x30", "--infer-bounds", "-o", str(tmp_path / "out.nc")
    code, _, errors = command("regrid", *options)
    assert code != 0
    assert "there are no fields to regrid" in errors


def test_an_error_of_one_file_leaves_none(model, tmp_path, command, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(sphere.Weights, "to_netcdf", full)
    out, table = tmp_path / "out.nc", tmp_path / "w.nc"
    code, _, err = command("regrid", model, "30x30", "-o", out, "--save-weights", table)
    assert (code, f"{table}: No space" in err) == (5, True), err
    assert not out.exists() and not table.exists()
