"""Files of models as their conventions say, through ``Grid``, the accessor and the command."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone.sphere import Grid, Overlaps

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

xarray = pytest.importorskip("xarray")
netcdf = pytest.importorskip("netCDF4")
import delone.xarray  # noqa: E402, F401  (it registers the accessors)

N = 5


def _cube() -> tuple[Any, Any, Any]:
    """Places of the corners of a cubed sphere by face, distinct nodes, and the corners of cells."""
    edges = np.tan(np.linspace(-np.pi / 4, np.pi / 4, N + 1))
    y, x = np.meshgrid(edges, edges, indexing="ij")
    o = np.ones_like(x)
    faces = [(o, x, y), (-x, o, y), (-o, -x, y), (x, -o, y), (-y, x, o), (y, x, -o)]
    places = np.array([np.stack(face, axis=-1) for face in faces])
    places /= np.linalg.norm(places, axis=-1, keepdims=True)
    flat = places.reshape(-1, 3)
    _, first, number = np.unique(
        np.round(flat, 9) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    at = number.reshape(6, N + 1, N + 1)
    around = at[:, :-1, :-1], at[:, :-1, 1:], at[:, 1:, 1:], at[:, 1:, :-1]
    return places, flat[first], np.stack(around, axis=-1).reshape(-1, 4)


PLACES, NODES, QUADS = _cube()
TRIANGLES = np.concatenate((QUADS[:, :3], QUADS[:, [0, 2, 3]]))


def heights(cells: Any) -> Any:
    """A field that tells the order of cells."""
    return NODES[cells].mean(axis=1) @ [0.3, 0.5, 0.8]


def angles(vectors: Any) -> tuple[Any, Any]:
    return np.arctan2(vectors[..., 1], vectors[..., 0]), np.arcsin(np.clip(vectors[..., 2], -1, 1))


def put(file: Any, name: str, kind: str, dims: str, values: Any, **attributes: Any) -> None:
    variable = file.createVariable(name, kind, tuple(dims.split()))
    variable[...] = values
    for key, value in attributes.items():
        variable.setncattr(key, value)


def exodus(file: Any, blocks: list[Any], *, axes: bool) -> None:
    """Exodus II: nodes by axis or in one table, elements by block, fields by block."""
    file.setncatts({"api_version": np.float32(5), "version": np.float32(5), "title": "mesh"})
    total = sum(map(len, blocks))
    sizes = {"num_dim": 3, "num_nodes": len(NODES), "num_elem": total, "num_el_blk": len(blocks)}
    for name, size in {**sizes, "len_string": 33, "time_step": None, "num_elem_var": 1}.items():
        file.createDimension(name, size)
    put(file, "time_whole", "f8", "time_step", [0.0])
    put(file, "eb_status", "i4", "num_el_blk", 1)
    put(file, "eb_prop1", "i4", "num_el_blk", np.arange(len(blocks)) + 1)
    file["eb_prop1"].setncattr("name", "ID")
    if axes:
        for k, axis in enumerate("xyz"):
            put(file, f"coord{axis}", "f8", "num_nodes", NODES[:, k])
    else:
        put(file, "coord", "f8", "num_dim num_nodes", NODES.T)
    for b, table in enumerate(blocks, 1):
        file.createDimension(f"num_el_in_blk{b}", len(table))
        file.createDimension(f"num_nod_per_el{b}", table.shape[1])
        kind = {3: "TRI3", 4: "SHELL4"}[table.shape[1]]
        dims = f"num_el_in_blk{b} num_nod_per_el{b}"
        put(file, f"connect{b}", "i4", dims, table + 1, elem_type=kind)
        field = f"vals_elem_var1eb{b}"
        put(file, field, "f8", f"time_step num_el_in_blk{b}", heights(table)[None])
    put(file, "elem_map", "i4", "num_elem", np.arange(total) + 1)


def icon(file: Any) -> None:
    """A grid of ICON with a field: angles in radians, cells last in the connectivity."""
    for name, size in {"cell": len(TRIANGLES), "vertex": len(NODES), "nv": 3}.items():
        file.createDimension(name, size)
    centers = NODES[TRIANGLES].sum(axis=1)
    centers /= np.linalg.norm(centers, axis=1)[:, None]
    for k, (axis, angle) in enumerate((("lon", "longitude"), ("lat", "latitude"))):
        words = {"units": "radian", "standard_name": f"grid_{angle}"}
        put(file, f"c{axis}", "f8", "cell", angles(centers)[k], bounds=f"c{axis}_vertices", **words)
        put(file, f"v{axis}", "f8", "vertex", angles(NODES)[k], **words)
        corners = angles(NODES[TRIANGLES])[k]
        put(file, f"c{axis}_vertices", "f8", "cell nv", corners, units="radian")
    put(file, "vertex_of_cell", "i4", "nv cell", TRIANGLES.T + 1)
    put(file, "ta", "f8", "cell", heights(TRIANGLES), coordinates="clat clon", units="K")


def geos(file: Any) -> None:
    """A cubed sphere of GEOS: six faces, corners of each, and dimensions that look like angles."""
    sizes = {"nf": 6, "Ydim": N, "Xdim": N, "YCdim": N + 1, "XCdim": N + 1, "lev": 2, "time": 1}
    for name, size in sizes.items():
        file.createDimension(name, size)
    centers = NODES[QUADS].sum(axis=1).reshape(6, N, N, 3)
    centers /= np.linalg.norm(centers, axis=-1, keepdims=True)
    east, north = (np.degrees(part) for part in angles(centers))
    put(file, "nf", "i4", "nf", np.arange(1, 7), long_name="cubed-sphere face", axis="e")
    fake = "Fake {} for GrADS Compatibility"
    put(
        file,
        "Xdim",
        "f8",
        "Xdim",
        east[0, 0],
        long_name=fake.format("Longitude"),
        units="degrees_east",
    )
    put(
        file,
        "Ydim",
        "f8",
        "Ydim",
        north[0, :, 0],
        long_name=fake.format("Latitude"),
        units="degrees_north",
    )
    corners = [np.degrees(part) for part in angles(PLACES)]
    put(file, "lons", "f8", "nf Ydim Xdim", east % 360, units="degrees_east")
    put(file, "lats", "f8", "nf Ydim Xdim", north, units="degrees_north")
    put(file, "corner_lons", "f8", "nf YCdim XCdim", corners[0] % 360, units="degrees_east")
    put(file, "corner_lats", "f8", "nf YCdim XCdim", corners[1], units="degrees_north")
    put(file, "lev", "f8", "lev", [1, 2], units="layer")
    field = np.broadcast_to(heights(QUADS).reshape(6, N, N), (1, 2, 6, N, N))
    put(file, "T", "f8", "time lev nf Ydim Xdim", field, coordinates="lons lats", units="K")


def exodus_in_one_block(file: Any) -> None:
    exodus(file, [QUADS], axes=True)


# How each is written, the cells in order, the field, and the format of the file.
FILES: dict[str, tuple[Callable[[Any], None], Any, str, str]] = {
    "Exodus": (exodus_in_one_block, QUADS, "vals_elem_var1eb1", "NETCDF3_CLASSIC"),
    "ICON": (icon, TRIANGLES, "ta", "NETCDF4"),
    "GEOS-CS": (geos, QUADS, "T", "NETCDF4"),
}


def written(path: Path, write: Callable[[Any], None], kind: str) -> Any:
    with netcdf.Dataset(path, "w", format=kind) as file:
        write(file)
    with xarray.open_dataset(path) as ds:
        return ds.load()


def is_sphere_of(grid: Grid, cells: list[Any]) -> Any:
    """The same cells, made of arrays; a grid is checked against them."""
    corners = NODES[np.concatenate([table.ravel() for table in cells])]
    lengths = np.concatenate([np.full(len(table), table.shape[1]) for table in cells])
    expected = Grid.from_mesh(xyz=corners, starts=np.append(0, np.cumsum(lengths)))
    assert np.allclose(grid.areas, expected.areas, rtol=1e-13, atol=0)
    assert grid.areas.sum() == pytest.approx(4 * np.pi, rel=1e-14)
    assert not grid.report.reversed.size
    assert grid.validate()
    return expected


@pytest.mark.parametrize("name", FILES)
def test_a_file_of_a_model(name: str, tmp_path: Path, figures: Callable[..., Any]) -> None:
    write, cells, field, kind = FILES[name]
    path, out = tmp_path / "model.nc", tmp_path / "out.nc"
    ds = written(path, write, kind)
    expected = is_sphere_of(Grid.from_dataset(ds), [cells])
    target = Grid.from_lonlat(np.arange(0, 361, 30), np.arange(-90, 91, 30))
    wanted = Overlaps(expected, target).to_weights("conservative").apply(heights(cells))
    assert np.abs(wanted).max() > 0.4
    figures("regrid", path, "30x30", "-o", out)
    with xarray.open_dataset(out) as read:
        for found in (ds.delone.regrid("30x30")[field], read[field]):
            assert found.dims[-2:] == ("lat", "lon")
            values = found.values.reshape(-1, 6, 12)
            assert np.allclose(values, wanted.reshape(6, 12), rtol=0, atol=1e-12)


def test_an_exodus_file_with_blocks(tmp_path: Path) -> None:
    """All nodes are in one table; the second block has triangles."""
    blocks = [QUADS[:60], np.concatenate((QUADS[60:, :3], QUADS[60:, [0, 2, 3]]))]
    ds = written(tmp_path / "mesh.g", lambda f: exodus(f, blocks, axes=False), "NETCDF3_CLASSIC")
    is_sphere_of(Grid.from_dataset(ds), blocks)


@pytest.mark.parametrize("left", ["vertex_of_cell", "clon_vertices"])
def test_an_icon_file_with_one_way_to_say_it(left: str, tmp_path: Path) -> None:
    ds = written(tmp_path / "icon.nc", icon, "NETCDF4")
    gone = ["clon_vertices", "clat_vertices"] if left == "vertex_of_cell" else ["vertex_of_cell"]
    is_sphere_of(Grid.from_dataset(ds.drop_vars(gone)), [TRIANGLES])
