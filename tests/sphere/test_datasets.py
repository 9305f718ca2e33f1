"""Grids of datasets: each convention, what is inferred, and what is refused."""

from __future__ import annotations

import pickle
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid, Overlaps
from delone.sphere.gaussian import gaussian_bounds

if TYPE_CHECKING:
    from collections.abc import Callable

xarray = pytest.importorskip("xarray")

GRIDS = Path(__file__).parents[3] / "shared" / "data" / "climate"
LON, LAT = np.arange(0, 361, 30.0), np.arange(-90, 91, 30.0)
BOXES = Grid.from_lonlat(LON, LAT)
QUADS = Grid.from_curvilinear(*np.meshgrid(LON, LAT))
X, Y = np.meshgrid(LON, LAT)
EAST, NORTH = {"units": "degrees_east"}, {"units": "degrees_north"}


def around(table: Any) -> Any:
    """The four corners of each cell, (rows, columns, 4)."""
    return np.stack((table[:-1, :-1], table[:-1, 1:], table[1:, 1:], table[1:, :-1]), axis=2)


NODES = around(np.arange(X.size).reshape(X.shape)).reshape(-1, 4)


def middle(edges: Any) -> Any:
    return (edges[1:] + edges[:-1]) / 2


def cf(**attributes: Any) -> Any:
    return xarray.Dataset(
        {
            "lon_bnds": (("lon", "nv"), np.column_stack((LON[:-1], LON[1:]))),
            "lat_bnds": (("lat", "nv"), np.column_stack((LAT[:-1], LAT[1:]))),
        },
        coords={
            "lon": ("lon", middle(LON), {**EAST, "bounds": "lon_bnds"} | attributes),
            "lat": ("lat", middle(LAT), {**NORTH, "bounds": "lat_bnds"} | attributes),
        },
    )


def curvilinear() -> Any:
    return xarray.Dataset(
        {
            "xs": (("j", "i", "nv"), around(X)),
            "ys": (("nv", "j", "i"), np.moveaxis(around(Y), 2, 0)),
        },
        coords={
            "nav_lon": (("j", "i"), around(X).mean(axis=2), {**EAST, "bounds": "xs"}),
            "nav_lat": (("j", "i"), around(Y).mean(axis=2), {**NORTH, "bounds": "ys"}),
            "x": ("i", np.arange(12.0)),
        },
    )


def corners() -> Any:
    return xarray.Dataset(
        coords={
            "lon": (("j", "i"), around(X).mean(axis=2), EAST),
            "lat": (("j", "i"), around(Y).mean(axis=2), NORTH),
            "lon_b": (("jb", "ib"), X),
            "lat_b": (("jb", "ib"), Y),
        }
    )


def listed(**dims: Any) -> Any:
    return xarray.Dataset(
        {
            "a": (("cell", "nv"), around(X).reshape(-1, 4)),
            "b": (("cell", "nv"), around(Y).reshape(-1, 4)),
        },
        coords={
            "lon": ("cell", around(X).mean(axis=2).ravel(), {**EAST, "bounds": "a"}),
            "lat": ("cell", around(Y).mean(axis=2).ravel(), {**NORTH, "bounds": "b"}),
        },
    )


def ugrid(table: Any = NODES, *, swapped: bool = False, **connectivity: Any) -> Any:
    table = np.asarray(table)
    dims = ("n", "face") if "transposed" in connectivity else ("face", "n")
    connectivity.pop("transposed", None)
    nodes = "y x" if swapped else "x y"
    return xarray.Dataset(
        {
            "mesh": ((), 0, {"cf_role": "mesh_topology", "node_coordinates": nodes,
                             "face_node_connectivity": "faces", "face_dimension": "face"}),
            "faces": (dims, table, connectivity),
            "x": ("node", X.flatten(), {"standard_name": "longitude", **EAST}),
            "y": ("node", Y.flatten(), {"standard_name": "latitude", **NORTH}),
        }
    )  # fmt: skip


def scrip(**units: Any) -> Any:
    x, y = around(X).reshape(-1, 4), around(Y).reshape(-1, 4)
    if units.get("units") == "radians":
        x, y = np.radians(x), np.radians(y)
    mask = np.ones(72, dtype=int)
    mask[5] = 0
    return xarray.Dataset(
        {
            "grid_dims": ("grid_rank", [12, 6]),
            "grid_corner_lon": (("grid_size", "grid_corners"), x, units),
            "grid_corner_lat": (("grid_size", "grid_corners"), y, units),
            "grid_imask": ("grid_size", mask),
        }
    )


def esmf() -> Any:
    return xarray.Dataset(
        {
            "nodeCoords": (("node", "two"), np.column_stack((X.ravel(), Y.ravel())),
                           {"units": "degrees"}),
            "elementConn": (("elements", "most"), NODES + 1),
            "numElementConn": ("elements", np.full(72, 4, dtype=np.int8)),
            "elementMask": ("elements", np.arange(72) % 2),
        }
    )  # fmt: skip


def esmf_ragged() -> Any:
    return esmf().drop_vars("elementConn").assign(elementConn=("all", NODES.ravel() + 1))


def mpas() -> Any:
    # Padding is anything.
    table = np.column_stack((NODES + 1, np.full(72, 3)))
    return xarray.Dataset(
        {
            "lonVertex": ("nVertices", np.radians(X.ravel())),
            "latVertex": ("nVertices", np.radians(Y.ravel())),
            "verticesOnCell": (("nCells", "maxEdges"), table),
            "nEdgesOnCell": ("nCells", np.full(72, 4)),
            "lonCell": ("nCells", np.radians(around(X).mean(axis=2).ravel())),
            "latCell": ("nCells", np.radians(around(Y).mean(axis=2).ravel())),
        },
        attrs={"on_a_sphere": "YES"},
    )


TRIANGLES = np.concatenate((NODES[:, :3], NODES[:, [0, 2, 3]]))


def icon() -> Any:
    return xarray.Dataset(
        {
            "vlon": ("vertex", np.radians(X.ravel()), {"units": "radian"}),
            "vlat": ("vertex", np.radians(Y.ravel())),
            "vertex_of_cell": (("nv", "cell"), TRIANGLES.T + 1),
            "clon": ("cell", np.zeros(144)),
        }
    )


def icon_corners() -> Any:
    x, y = (np.radians(table.ravel()[TRIANGLES]) for table in (X, Y))
    return xarray.Dataset(
        {"clon_vertices": (("cell", "nv"), x), "clat_vertices": (("cell", "nv"), y)}
    )


def fesom() -> Any:
    return xarray.Dataset(
        {"lon": ("nod2", X.ravel()), "lat": ("nod2", Y.ravel()),
         "triag_nodes": (("elem", "three"), TRIANGLES[:, ::-1] + 1)}
    )  # fmt: skip


def exodus(*, axes: bool = False, **edges: Any) -> Any:
    lon, lat = np.radians(X.ravel()), np.radians(Y.ravel())
    xyz = np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    # A triangle and quadrilaterals in two blocks; a corner is padded.
    first = np.column_stack((NODES[:40] + 1, np.zeros(40, dtype=int)))
    nodes = (
        {f"coord{a}": ("num_nodes", xyz[:, k]) for k, a in enumerate("xyz")}
        if axes
        else {"coord": (("num_dim", "num_nodes"), xyz.T)}
    )
    return xarray.Dataset(
        {**nodes, "connect1": (("el1", "n1"), first), "connect2": (("el2", "n2"), NODES[40:] + 1),
         **edges}
    )  # fmt: skip


def oasis() -> Any:
    return xarray.Dataset(
        {
            "torc.lon": (("y", "x"), around(X).mean(axis=2)),
            "torc.lat": (("y", "x"), around(Y).mean(axis=2)),
            "torc.clo": (("crn", "y", "x"), np.moveaxis(around(X), 2, 0)),
            "torc.cla": (("crn", "y", "x"), np.moveaxis(around(Y), 2, 0)),
            "torc.msk": (("y", "x"), (np.arange(72) % 2).reshape(6, 12)),
        }
    )


def geos() -> Any:
    lon, lat = (np.stack((table[:, :7], table[:, 6:])) for table in (X, Y))
    return xarray.Dataset(
        {"corner_lons": (("nf", "YC", "XC"), lon), "corner_lats": (("nf", "YC", "XC"), lat)}
    )


def uxgrid() -> Any:
    least = np.iinfo(np.int64).min
    table = np.column_stack((NODES, np.full(72, least)))
    return SimpleNamespace(
        node_lon=xarray.DataArray(X.ravel(), dims="n_node", attrs=EAST),
        node_lat=xarray.DataArray(Y.ravel(), dims="n_node", attrs=NORTH),
        face_node_connectivity=xarray.DataArray(
            table, dims=("n_face", "most"), attrs={"_FillValue": least, "start_index": 0}
        ),
    )


def filled(value: Any, dtype: Any, start: int = 0) -> Any:
    """Connectivity with a column of padding."""
    return np.column_stack((NODES + start, np.full(72, value))).astype(dtype)


HALVES = Grid.from_mesh(lonlat=np.stack((X.ravel()[TRIANGLES], Y.ravel()[TRIANGLES]), axis=2))
KINDS: dict[str, tuple[Callable[[], Any], Grid, tuple[int, ...]]] = {
    "CF": (cf, BOXES, (6, 12)),
    "CF, two dimensions": (curvilinear, QUADS, (6, 12)),
    "CF, corners": (corners, QUADS, (6, 12)),
    "CF, one dimension": (listed, QUADS, (72,)),
    "UGRID": (ugrid, QUADS, (72,)),
    "UGRID from 1": (lambda: ugrid(NODES + 1, start_index=1), QUADS, (72,)),
    "UGRID, latitude first": (lambda: ugrid(swapped=True), QUADS, (72,)),
    "UGRID, transposed": (lambda: ugrid(NODES.T, transposed=True), QUADS, (72,)),
    "UGRID, -1": (lambda: ugrid(filled(-1, int)), QUADS, (72,)),
    "UGRID, fill": (lambda: ugrid(filled(999, int), _FillValue=999), QUADS, (72,)),
    "UGRID, unsigned": (lambda: ugrid(filled(2**32 - 1, np.uint32)), QUADS, (72,)),
    "UGRID, NaN": (lambda: ugrid(filled(np.nan, float, 1), start_index=1), QUADS, (72,)),
    "SCRIP": (lambda: scrip(units="degrees"), QUADS, (6, 12)),
    "SCRIP, radians": (lambda: scrip(units="radians"), QUADS, (6, 12)),
    "ESMF": (esmf, QUADS, (72,)),
    "ESMF, ragged": (esmf_ragged, QUADS, (72,)),
    "MPAS": (mpas, QUADS, (72,)),
    "ICON": (icon, HALVES, (144,)),
    "ICON, corners": (icon_corners, HALVES, (144,)),
    "FESOM": (fesom, HALVES, (144,)),
    "Exodus": (exodus, QUADS, (72,)),
    "Exodus, axes": (lambda: exodus(axes=True), QUADS, (72,)),
    "OASIS": (oasis, QUADS, (6, 12)),
    "GEOS-CS": (geos, QUADS, (2, 6, 6)),
    "uxarray": (uxgrid, QUADS, (72,)),
    "uxarray, fields": (lambda: SimpleNamespace(uxgrid=uxgrid()), QUADS, (72,)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_conventions(kind: str) -> None:
    make, expected, shape = KINDS[kind]
    grid = Grid.from_dataset(make(), cells="faces" if kind == "FESOM" else None)
    assert grid.grid_shape == shape
    assert grid.edges == expected.edges
    assert not grid.report.reversed.size or kind == "FESOM"
    areas = grid.areas
    if kind == "GEOS-CS":
        areas = np.concatenate(list(areas.reshape(shape)), axis=1).ravel()
    assert np.allclose(areas, expected.areas, rtol=1e-14, atol=0)
    assert np.isclose(grid.areas.sum(), 4 * np.pi, rtol=1e-14)
    assert grid.validate()
    centers = grid.centers_lonlat
    if kind == "GEOS-CS":
        centers = np.concatenate(list(centers.reshape(*shape, 2)), axis=1).reshape(-1, 2)
    lon, lat = np.radians(np.stack((centers, expected.centers_lonlat), axis=1).T)
    away = np.sin(lat[0]) * np.sin(lat[1]) + np.cos(lat[0]) * np.cos(lat[1]) * np.cos(
        lon[0] - lon[1]
    )
    assert away.min() > np.cos(np.radians(12))


def test_masks() -> None:
    assert Grid.from_dataset(cf()).mask is None
    grid = Grid.from_dataset(scrip(units="degrees"))
    assert grid.report.masked.tolist() == [5]
    assert "1 cell masked" in repr(grid.report)
    # 1 is used, but of OASIS 0.
    assert np.flatnonzero(Grid.from_dataset(esmf()).mask)[:2].tolist() == [1, 3]
    assert np.flatnonzero(Grid.from_dataset(oasis()).mask)[:2].tolist() == [0, 2]
    again = pickle.loads(pickle.dumps(grid))
    assert np.array_equal(again.mask, grid.mask)
    box = pickle.loads(pickle.dumps(BOXES))
    assert box.mask is None
    assert [edges.tolist() for edges in box.bounds] == [LON.tolist(), LAT.tolist()]
    assert np.array_equal(box.centers_lonlat, BOXES.centers_lonlat)


def test_the_direction_of_bounds_and_of_rows_changes_nothing() -> None:
    ds = cf()
    turned = ds.assign(lat_bnds=ds.lat_bnds[:, ::-1])
    assert np.array_equal(Grid.from_dataset(turned).areas, BOXES.areas)
    down = ds.isel(lat=slice(None, None, -1))
    expected = BOXES.areas.reshape(6, 12)[::-1].ravel()
    assert np.array_equal(Grid.from_dataset(down).areas, expected)


def test_edges_are_chosen() -> None:
    assert Grid.from_dataset(cf(), edges="arc").edges == "arc"
    assert np.array_equal(Grid.from_dataset(cf(), edges="arc").areas, QUADS.areas)
    grid = Grid.from_dataset(scrip(units="degrees"), edges="parallel")
    assert np.array_equal(grid.areas, BOXES.areas)
    assert grid.report.masked.tolist() == [5]
    skew = scrip(units="degrees")
    skew["grid_corner_lat"][3, 1] += 1
    with pytest.raises(delone.InputError, match="between meridians and parallels"):
        Grid.from_dataset(skew, edges="parallel")


def test_bounds_that_differ_by_a_rounding_meet() -> None:
    ds = cf()
    at = np.linspace(0, 360, 3601)
    centers = middle(at).astype(np.float32)
    bounds = np.column_stack((centers - np.float32(0.05), centers + np.float32(0.05)))
    assert not np.array_equal(bounds[1:, 0], bounds[:-1, 1])
    ds = ds.drop_vars(("lon", "lon_bnds")).assign(lon_bnds=(("lon", "nv"), bounds))
    ds = ds.assign_coords(lon=("lon", centers, {**EAST, "bounds": "lon_bnds"}))
    grid = Grid.from_dataset(ds)
    assert grid.report.merged > 100
    assert np.isclose(grid.areas.sum(), 4 * np.pi, rtol=1e-14)
    apart = cf()
    apart["lon_bnds"][3, 0] += 0.1
    with pytest.raises(delone.InputError, match="entries 2 and 3 do not meet"):
        Grid.from_dataset(apart)


def test_inferred_bounds_are_halfway() -> None:
    ds = cf().drop_vars(("lon_bnds", "lat_bnds"))
    for part in ds.coords.values():
        del part.attrs["bounds"]
    with pytest.raises(delone.InputError, match=r"lon has no bounds.*infer_bounds=True"):
        Grid.from_dataset(ds)
    assert np.array_equal(Grid.from_dataset(ds, infer_bounds=True).areas, BOXES.areas)
    # Of uneven rows; the last one ends at the pole, and not beyond.
    lat = np.array([-40.0, 0, 20, 80])
    grid = Grid.from_dataset(ds.drop_vars("lat").assign_coords(lat=("lat", lat, NORTH)),
                             infer_bounds=True)  # fmt: skip
    assert grid.bounds is not None
    assert grid.bounds[1].tolist() == [-60, -20, 10, 50, 90]
    with pytest.raises(delone.InputError, match="one center only"):
        Grid.from_dataset(ds.isel(lat=slice(1)), infer_bounds=True)


def boxes(rows: Any, columns: list[Any], dtype: Any = float, **extra: Any) -> Any:
    """A reduced grid: cells of rows between parallels, with as many columns as each row has."""
    lat = [pair for pair, edges in zip(rows, columns, strict=True) for _ in edges[1:]]
    lon = [pair for edges in columns for pair in pairwise(edges)]
    x, y = (np.array(table, dtype=dtype) for table in (lon, lat))
    return xarray.Dataset(
        {"x": (("cell", "nv"), x), "y": (("cell", "nv"), y)},
        coords={
            "lon": ("cell", x.mean(axis=1), {**EAST, "bounds": "x"}),
            "lat": ("cell", y.mean(axis=1), {**NORTH, "bounds": "y"}),
        },
    ).assign(**extra)


def test_lists_of_cells_between_meridians_and_parallels() -> None:
    expected = Grid.from_gaussian(8, "octahedral")
    rows, columns = gaussian_bounds(8, "octahedral")
    parallels = list(pairwise(rows))
    ds = boxes(parallels, columns)
    grid = Grid.from_dataset(ds)
    assert (grid.edges, grid.grid_shape, grid.report.merged) == ("parallel", (expected.ncells,), 0)
    assert np.allclose(grid.areas, expected.areas, rtol=1e-13)
    assert grid.areas.sum() == pytest.approx(4 * np.pi, rel=1e-14)
    assert np.array_equal(grid.centers_lonlat[:, 1], ds.lat.values)
    assert np.allclose(grid.rings[0], expected.rings[0], atol=1e-14)
    assert grid.validate()
    # Any order of cells, and of the bounds of each.
    order = np.random.default_rng(0).permutation(grid.ncells)
    moved = ds.isel(cell=order, nv=[1, 0])
    moved["x"] = moved.x - 360 * (np.arange(grid.ncells) % 2)[:, None]
    assert np.allclose(Grid.from_dataset(moved).areas, grid.areas[order], rtol=1e-13)
    # Bounds in float32 meet, between columns and between rows and once around.
    other = boxes(parallels, [edges - edges[0] + 0.1 for edges in columns], np.float32)
    other["y"][:, 0] = np.nextafter(other.y[:, 0].values, np.float32(90))
    rounded = Grid.from_dataset(other)
    assert rounded.report.merged > 500
    assert rounded.areas.sum() == pytest.approx(4 * np.pi, rel=1e-14)
    again = pickle.loads(pickle.dumps(grid))
    assert np.array_equal(again.areas, grid.areas)
    # Sides of great circles, if wanted.
    arcs = Grid.from_dataset(ds, edges="arc")
    assert (arcs.edges, arcs.ncells) == ("arc", grid.ncells)
    assert np.allclose(arcs.areas, grid.areas, rtol=0.2)


def test_lists_of_boxes_with_gaps_overlaps_and_wide_cells() -> None:
    # Two cells that overlap between the same parallels, a gap, a cell around, one over the date
    # line by its center alone, one of 200 degrees, and one that overlaps the first from the west.
    lon = np.array([[0.0, 20], [10, 30], [50, 60], [-180, 180], [-170, 170], [0, 200], [-10, 5]])
    lat = np.array([[0.0, 10], [0, 10], [10, 0], [80, 90], [-10, 0], [-90, -80], [0, 10]])
    ds = boxes(lat, [*lon])
    ds["lon"] = ("cell", [10.0, 20, 55, 0, 180, 100, -2], ds.lon.attrs)
    grid = Grid.from_dataset(ds)
    width = np.radians([20, 20, 10, 360, 20, 200, 15])
    sines = np.abs(np.diff(np.sin(np.radians(lat)), axis=1))[:, 0]
    assert np.allclose(grid.areas, width * sines, rtol=1e-14)
    assert grid.validate().overlapping.tolist() == [[0, 1], [0, 6]]
    shares = Overlaps(Grid.from_lonlat([0, 20], [0, 10]), grid).matrix.toarray()[:, 0]
    assert np.allclose(shares / grid.areas, [1, 0.5, 0, 0, 0, 0, 1 / 3], atol=1e-15)
    target = Grid.from_lonlat([-175, 175], [-10, 0])
    assert np.isclose(Overlaps(target, grid).matrix.toarray()[4, 0], grid.areas[4] / 2)
    for table, what in ((lon, "x"), (lat, "y")):
        flat = table.copy()
        flat[2] = flat[2, 0]
        with pytest.raises(delone.InputError, match=r"x and y: 1 cell has no width.*first cell 2"):
            Grid.from_dataset(ds.assign({what: (("cell", "nv"), flat)}))
    with pytest.raises(delone.DirectionError, match="y: cell 3 reaches beyond a pole"):
        Grid.from_dataset(ds.assign(y=(("cell", "nv"), lat + np.eye(7)[:, [3, 3]])))


def test_inferred_cells_of_a_list_are_nearest_to_their_centers() -> None:
    sites = np.random.default_rng(5).normal(size=(60, 3))
    places = delone.sphere.Delaunay(xyz=sites).lonlat
    ds = xarray.Dataset(
        coords={"lon": ("cell", places[:, 0], EAST), "lat": ("cell", places[:, 1], NORTH)}
    )
    with pytest.raises(delone.InputError, match=r"lon has no bounds.*infer_bounds=True"):
        Grid.from_dataset(ds)
    grid = Grid.from_dataset(ds, infer_bounds=True)
    expected = Grid.from_voronoi(delone.sphere.Voronoi(lonlat=places))
    assert np.array_equal(grid.areas, expected.areas)
    assert np.array_equal(grid.centers_lonlat, places)
    with pytest.raises(delone.InputError, match="centers 3 and 60 are the same place"):
        Grid.from_dataset(ds.isel(cell=[*range(60), 3]), infer_bounds=True)
    with pytest.raises(delone.InputError, match="all centers are within a hemisphere"):
        Grid.from_dataset(ds.isel(cell=np.flatnonzero(places[:, 1] > 0)), infer_bounds=True)


def test_inferred_corners_are_in_the_middle() -> None:
    x, y = np.meshgrid(np.arange(10.0, 20), np.arange(-3.0, 4))
    ds = xarray.Dataset(coords={"lon": (("j", "i"), x, EAST), "lat": (("j", "i"), y, NORTH)})
    with pytest.raises(delone.InputError, match="lon has no bounds"):
        Grid.from_dataset(ds)
    grid = Grid.from_dataset(ds, infer_bounds=True)
    expected = Grid.from_curvilinear(*np.meshgrid(np.arange(9.5, 20), np.arange(-3.5, 4)))
    assert grid.grid_shape == (7, 10)
    assert np.allclose(grid.areas, expected.areas, rtol=1e-3)
    assert np.allclose(grid.centers_lonlat, expected.centers_lonlat, atol=1e-3)


def test_padding_and_cells_without_corners() -> None:
    ds = listed()
    table = ds.a.values.copy()
    a = np.column_stack((table, np.full(72, np.nan)))
    b = np.column_stack((ds.b.values, np.full(72, np.nan)))
    a[7], b[7] = np.nan, np.nan
    ds = ds.assign(a=(("cell", "five"), a), b=(("cell", "five"), b))
    grid = Grid.from_dataset(ds)
    assert grid.report.empty.tolist() == [7]
    assert np.array_equal(np.delete(grid.areas, 7), np.delete(QUADS.areas, 7))
    a[3, 1] = b[3, 1] = np.nan
    with pytest.raises(delone.InputError, match="a: cell 3 has a missing corner before others"):
        Grid.from_dataset(ds.assign(a=(("cell", "five"), a), b=(("cell", "five"), b)))
    a[3, 1] = 0
    with pytest.raises(delone.NonFiniteError, match="b: 1 entry is not finite"):
        Grid.from_dataset(ds.assign(a=(("cell", "five"), a), b=(("cell", "five"), b)))


def test_latitudes_beyond_a_pole_by_rounding_are_the_pole() -> None:
    ds = scrip(units="radians")
    for name in ("grid_corner_lon", "grid_corner_lat"):
        ds[name] = (ds[name].dims, ds[name].values.astype(np.float32), {"units": "radians"})
    grid = Grid.from_dataset(ds)
    assert np.isclose(grid.areas.sum(), 4 * np.pi, rtol=1e-14)
    ds = ugrid()
    ds["y"][-1] = 90.000001
    assert np.isclose(Grid.from_dataset(ds).areas.sum(), 4 * np.pi, rtol=1e-14)
    ds["y"][-1] = 91
    with pytest.raises(delone.DirectionError, match="y: 1 entry is beyond a pole") as caught:
        Grid.from_dataset(ds)
    assert caught.value.rows.tolist() == [90]


def test_units_are_read_and_not_guessed() -> None:
    with pytest.raises(delone.InputError, match="grid_corner_lon has no attribute units"):
        Grid.from_dataset(scrip())
    grid = Grid.from_dataset(scrip(), degrees=True)
    assert np.array_equal(grid.areas, QUADS.areas)
    with pytest.raises(delone.InputError, match="which degrees=False contradicts"):
        Grid.from_dataset(scrip(units="degrees"), degrees=False)
    with pytest.raises(delone.InputError, match="lon has the units 'm'"):
        Grid.from_dataset(cf(units="m"), coords=("lon", "lat"))
    ds = xarray.Dataset(coords={"lon": ("lon", middle(LON)), "lat": ("lat", middle(LAT))})
    with pytest.raises(delone.InputError, match="lon has no attribute units"):
        Grid.from_dataset(ds, infer_bounds=True)
    assert Grid.from_dataset(ds, infer_bounds=True, degrees=True).grid_shape == (6, 12)
    # Units of bounds are their own, if they have some.
    ds = cf()
    ds["lon_bnds"] = (ds.lon_bnds.dims, np.radians(ds.lon_bnds.values), {"units": "radians"})
    assert np.allclose(Grid.from_dataset(ds).areas, BOXES.areas, rtol=1e-14)


def test_one_of_several() -> None:
    two = cf().assign_coords(
        TLON=(("j", "i"), around(X).mean(axis=2), EAST),
        TLAT=(("j", "i"), around(Y).mean(axis=2), NORTH),
        ULON=(("j", "i"), around(X).mean(axis=2), EAST),
    )
    # Coordinates of their own axes come first.
    assert np.array_equal(Grid.from_dataset(two).areas, BOXES.areas)
    two = two.drop_vars(("lon", "lat")).assign(TLON_b=(("a", "b"), X), TLAT_b=(("a", "b"), Y))
    with pytest.raises(delone.InputError, match="longitudes and latitudes TLON, ULON, TLAT"):
        Grid.from_dataset(two)
    grid = Grid.from_dataset(two, coords=("TLON", "TLAT"))
    assert np.array_equal(grid.areas, QUADS.areas)
    with pytest.raises(delone.InputError, match="no variable 'lon'"):
        Grid.from_dataset(two, coords=("lon", "lat"))
    both = oasis().assign({"lmdz.clo": (("c", "k"), np.zeros((4, 2))),
                           "lmdz.cla": (("c", "k"), np.zeros((4, 2)))})  # fmt: skip
    with pytest.raises(delone.InputError, match="the grids torc, lmdz of OASIS: give name="):
        Grid.from_dataset(both)
    assert Grid.from_dataset(both, name="torc").grid_shape == (6, 12)
    meshes = ugrid().assign(other=((), 0, ugrid().mesh.attrs))
    with pytest.raises(delone.InputError, match="the meshes mesh, other of UGRID: give name="):
        Grid.from_dataset(meshes)
    meshes = meshes.assign(t=("face", np.zeros(72), {"mesh": "other"}))
    assert Grid.from_dataset(meshes, name="t").ncells == 72
    mixed = xarray.merge((cf(), listed().rename(lon="x", lat="y", nv="four")))
    mixed["t"] = ("cell", np.zeros(72))
    assert Grid.from_dataset(mixed, name="t").grid_shape == (72,)
    with pytest.raises(delone.InputError, match="no variable 'none'"):
        Grid.from_dataset(mixed, name="none")


def test_healpix() -> None:
    whole = Grid.from_healpix(4, "nested")
    crs = ((), 0, {"grid_mapping_name": "healpix", "healpix_nside": 4, "healpix_order": "nest"})
    ds = xarray.Dataset({"t": ("cell", np.zeros(192)), "crs": crs})
    assert np.array_equal(Grid.from_dataset(ds).areas, whole.areas)
    part = ds.isel(cell=slice(10, 20)).assign_coords(
        cell=("cell", np.arange(10, 20), {"standard_name": "healpix_index"})
    )
    assert np.array_equal(Grid.from_dataset(part).areas, whole.areas[10:20])
    level = {"grid_mapping_name": "healpix", "refinement_level": 2, "indexing_scheme": "ring"}
    ring = ds.assign(crs=((), 0, level))
    assert np.array_equal(Grid.from_dataset(ring).rings[0], Grid.from_healpix(4).rings[0])
    for attrs, message in (
        ({"healpix_order": "nest"}, "neither the attribute healpix_nside"),
        ({"healpix_nside": 4}, "must be nested or ring"),
        ({"healpix_nside": 8, "healpix_order": "ring"}, "no dimension of 768 pixels"),
    ):
        wrong = ds.assign(crs=((), 0, {"grid_mapping_name": "healpix"} | attrs))
        with pytest.raises(delone.InputError, match=message):
            Grid.from_dataset(wrong)


PROJECTED = "projection_x_coordinate"


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (xarray.Dataset, delone.InputError, "looked for UGRID.*Its variables: none"),
        (lambda: "file.nc", delone.DtypeError, r"xarray.open_dataset\(path\)"),
        (lambda: cf().drop_vars("lat_bnds"), delone.InputError, "which the dataset lacks"),
        (
            lambda: ugrid(NODES + 1),
            delone.InputError,
            r"0 to 90; first cell 71, node 91: if nodes are counted from 1, set .* to 1$",
        ),
        (lambda: ugrid(NODES + 2), delone.InputError, r"first cell \d+, node 9\d$"),
        (lambda: ugrid(NODES, start_index=1), delone.InputError, "out of range 1 to 91"),
        (lambda: ugrid(NODES + 0.5), delone.InputError, "72 cells have a node out of range"),
        (lambda: ugrid().drop_vars("x"), delone.InputError, "no variable 'x', its coordinate"),
        (lambda: ugrid().drop_vars("faces"), delone.InputError, "no variable 'faces', its faces"),
        (
            lambda: ugrid().assign(x=("node", X.ravel())),
            delone.InputError,
            "neither by standard_name nor by units.*set their units to degrees_east",
        ),
        (
            lambda: ugrid().assign(x=("node", X.ravel(), {"standard_name": PROJECTED})),
            delone.InputError,
            "x is a projection_x_coordinate, not a longitude or latitude: transform the corners",
        ),
        (
            lambda: xarray.Dataset(coords={"x": ("x", [0.0, 5e3], {"standard_name": PROJECTED})}),
            delone.InputError,
            "x is a projection_x_coordinate",
        ),
        (
            lambda: xarray.Dataset(coords={"r": ("r", [0, 5], {"standard_name": "grid_latitude"})}),
            delone.InputError,
            "r is a grid_latitude, not a longitude or latitude",
        ),
        (
            lambda: mpas().assign_attrs(on_a_sphere="NO"),
            delone.InputError,
            "the mesh of MPAS is planar",
        ),
        (
            lambda: exodus(edge_type1=(("el1", "n1"), np.ones((40, 5), dtype=int))),
            delone.InputError,
            'sides are parallels: give edges="arc"',
        ),
        (
            lambda: listed().drop_vars("a"),
            delone.InputError,
            "lon has the bounds 'a', which the dataset lacks",
        ),
        (
            lambda: xarray.Dataset(coords={"lon": ("c", [1.0], EAST), "lat": ("c", [1.0], NORTH)}),
            delone.InputError,
            "to use the places nearest to each center as its cell",
        ),
    ],
)
def test_what_is_refused(make: Callable[[], Any], error: Any, message: str) -> None:
    with pytest.raises(error, match=message):
        Grid.from_dataset(make())


def test_files_of_models() -> None:
    pytest.importorskip("netCDF4")
    if not GRIDS.is_dir():
        pytest.skip("needs the grids of models")
    for name, cells, area, near in (
        ("esmf_ne30_ne30pg3.grid.nc", 48600, "elementArea", 2e-12),
        ("scrip_ne30pg2_grid.nc", 21600, "grid_area", 1e-12),
        ("scrip_outCSne8_outCSne8.nc", 384, "grid_area", 1e-12),
        ("ugrid_outCSne30_outCSne30.ug", 5400, None, 0),
        ("mpas_QU_mesh.QU.1920km.151026.nc", 162, "areaCell", 1e-7),
    ):
        with xarray.open_dataset(GRIDS / name) as ds:
            grid = Grid.from_dataset(ds)
            assert grid.ncells == cells
            assert np.isclose(grid.areas.sum(), 4 * np.pi, rtol=1e-14)
            if area is not None:
                assert np.allclose(grid.areas, ds[area].values, rtol=near)
    # Corners of ne30pg2 are 21,608 directions instead of 21,602.
    with xarray.open_dataset(GRIDS / "scrip_ne30pg2_grid.nc") as ds:
        vectors = Grid.from_dataset(ds).rings[0]
    assert len(np.unique(vectors, axis=0)) == 21602
    with (
        xarray.open_dataset(GRIDS / "healpix_outCSne30_data.nc") as ds,
        pytest.raises(delone.InputError, match=r"the dataset has no grid.*Its variables: psi"),
    ):
        Grid.from_dataset(ds)
