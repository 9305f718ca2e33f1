"""Points, triangles and edges as geometries: GeoJSON, GeoPackage, Shapefile, FlatGeobuf.

The format libraries are pyogrio, geopandas and shapely (extra ``geo``). Only points are read as
points: the vertices of lines and areas would be a silent reinterpretation. Use `read_geometries`
for those.
"""

from __future__ import annotations

import io
import warnings
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone._base.files import cut_short, without
from delone.errors import DeloneError, FileFormatError
from delone.exchange.geopandas import to_geopandas
from delone.io.compressed import SUFFIXES
from delone.io.content import content
from delone.io.gdal import admitted, check_driver, local_name
from delone.io.geometryset import GeometrySet
from delone.io.pointset import PointSet, find_column
from delone.io.rings import open_ring
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = [
    "attribute_names",
    "from_frame",
    "geometries_of",
    "plain_name",
    "read_geometries",
    "read_points",
    "require_index",
    "require_libraries",
    "system_of",
    "write_layer",
    "write_mesh",
]

# Layers are written in parts, so that only the geometries of one part are in memory.
_PART = 1 << 18
# When GDAL closes files of these formats, it does not report whether the last part was written, so
# their bytes are written here. Seventeen digits would reproduce every double, but with up to
# nineteen GDAL treats a run of 0 or 9 near the end as a rounding error: 0.19999999999999996 becomes
# 0.2.
_IN_MEMORY: dict[str, dict[str, Any]] = {
    "GeoJSON": {"SIGNIFICANT_FIGURES": 20},
    "FlatGeobuf": {},
}


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    layer: str | None,
    everything: bool = False,
) -> PointSet:
    """Read points from a file of geometries; see `delone.io.read_points`."""
    frame = _read(path, columns, None if everything else attributes, layer)
    return from_frame(
        frame, columns=columns, attributes=None if everything else attributes, source=str(path)
    )


def read_geometries(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
    everything: bool = False,
) -> GeometrySet:
    """Read points, lines and areas; see `delone.io.read_geometries`."""
    wanted = None if everything else attributes
    frame = _read(path, columns, wanted, layer)
    return geometries_of(frame, columns=columns, source=str(path), attributes=wanted)


def _read(
    path: Path,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str] | None,
    layer: str | None,
) -> Any:
    """Return a GeoDataFrame of all features and the requested columns, by default all."""
    pyogrio = require("pyogrio", extra="geo", what=f"reading {path.suffix}")
    require("geopandas", extra="geo", what=f"reading {path.suffix}")
    source = str(path)
    with _corrupt_is_an_error(source), admitted(path) as name:
        layer = _layer(pyogrio, name, layer, path)
        facts = _facts(pyogrio, name, layer, path)
        if facts["geometry_type"] is None:
            raise FileFormatError(
                f"{source}: {layer or 'its table'} has no column of geometries; write the "
                "coordinates to a CSV or Parquet file to read them as points"
            )
        fields = list(facts["fields"])
        wanted = (*_height(columns), *(attributes or ()))
        kept = [fields[find_column(fields, column, source)] for column in wanted]
        kept = fields if attributes is None else kept
        frame = pyogrio.read_dataframe(name, layer=layer, columns=kept)
    if len(frame) < facts["features"]:
        raise cut_short(source, f"{facts['features']} features", len(frame))
    return frame


def _facts(pyogrio: Any, name: str, layer: str | None, path: Path) -> dict[str, Any]:
    """Return pyogrio's description of a layer, before its features are read."""
    facts: dict[str, Any] = pyogrio.read_info(name, layer=layer, force_feature_count=True)
    check_driver(path, facts["driver"])
    check_system(facts["crs"], str(path))
    return facts


def attribute_names(path: Path, *, layer: str | None) -> list[str]:
    """Return the names of all attributes of a layer, or none if the file cannot be read."""
    pyogrio = require("pyogrio", extra="geo", what=f"reading {path.suffix}")
    try:
        with _corrupt_is_an_error(str(path)), admitted(path) as name:
            return [str(field) for field in _facts(pyogrio, name, layer, path)["fields"]]
    except FileFormatError:
        return []  # Reading the points reports what is wrong with the file.


def from_frame(
    frame: Any,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str] | None,
    source: str,
) -> PointSet:
    """Extract Points and MultiPoints from a GeoDataFrame; `columns` is as in `geometries_of`.

    By default all columns are attributes; other geometries as text.
    """
    shapely = require("shapely", extra="geo", what="reading geometries")
    found = geometries_of(frame, columns=columns, source=source)
    points = found.as_points()
    index = np.repeat(np.arange(len(found)), shapely.get_num_coordinates(found.geometries))
    values = _attributes(frame, attributes, source)
    return replace(points, attributes={name: column[index] for name, column in values.items()})


def _attributes(frame: Any, wanted: Sequence[str] | None, source: str) -> dict[str, NDArray[Any]]:
    """Return columns of a GeoDataFrame, by default all but its geometry."""
    if wanted is None:
        own = frame.geometry.name
        wanted = [str(name) for name in frame.columns if name != own]
    return {name: _values(frame[_same(frame, name, source)]) for name in wanted}


def _values(column: Any) -> NDArray[Any]:
    """Return a column as an array; further geometries become text."""
    if str(column.dtype) != "geometry":
        return np.asarray(column)
    shapely = require("shapely", extra="geo", what="reading geometries")
    texts = shapely.to_wkt(np.asarray(column.values), rounding_precision=-1)
    return np.asarray(texts, dtype=object)


def geometries_of(
    frame: Any,
    *,
    columns: Sequence[str | int] | None,
    source: str,
    attributes: Sequence[str] | None = (),
) -> GeometrySet:
    """Extract the geometries of a GeoDataFrame; `columns` names the one column that is z, if any.

    For attributes, None means all.
    """
    if not hasattr(frame, "geometry") or not len(frame):
        raise without(source, "geometries")
    heights = None
    for name in _height(columns):
        heights = np.asarray(frame[_same(frame, name, source)], dtype=np.float64)
    return GeometrySet(
        geometries=np.asarray(frame.geometry.values),
        feature_heights=heights,
        crs=None if frame.crs is None else str(frame.crs.to_string()),
        source=source,
        attributes=_attributes(frame, attributes, source),
    )


def _height(columns: Sequence[str | int] | None) -> list[str | int]:
    if columns is not None and len(columns) != 1:
        raise FileFormatError(
            "geometries have x and y; --columns names the one attribute that is z"
        )
    return list(columns or ())


def _same(frame: Any, name: str | int, source: str) -> str:
    names = [str(column) for column in frame.columns]
    return names[find_column(names, name, source)]


def _layer(pyogrio: Any, name: str, layer: str | None, path: Path) -> str | None:
    if layer is not None and path.suffix.lower() in SUFFIXES:
        raise FileFormatError(f"{path}: compressed files of geometries have no layers")
    names = [str(found) for found, _ in pyogrio.list_layers(name)]
    if not names:
        raise without(path, "layers")
    if layer is not None and layer not in names:
        raise FileFormatError(
            f"{path} has no layer {layer!r:.80}; its layers are {', '.join(names)}"
        )
    if layer is None and len(names) > 1:
        raise FileFormatError(
            f"{path} has several layers; choose one (--layer): {', '.join(names)}"
        )
    return layer


@contextmanager
def _corrupt_is_an_error(source: str) -> Iterator[None]:
    try:
        with warnings.catch_warnings():
            # GDAL's warnings do not matter for reading points.
            warnings.filterwarnings("ignore", category=RuntimeWarning, module="pyogrio")
            # NaN is rejected where it is used, with the number of its feature.
            warnings.filterwarnings("ignore", category=RuntimeWarning, module="shapely")
            yield
    except (DeloneError, FileNotFoundError, PermissionError, MemoryError):
        raise
    except Exception as error:
        reason = str(error).partition("\n")[0].removeprefix(source).lstrip(": ")
        if "LinearRing" in reason:
            reason = open_ring(Path(source)) or reason
        raise FileFormatError(f"{source} cannot be read: {reason}") from error


def require_libraries(suffix: str) -> None:
    """Import the libraries for writing."""
    for module in ("shapely", "pyogrio", "geopandas"):
        require(module, extra="geo", what="writing geometries")


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write triangles as polygons, or edges as lines, with vertices as columns v0, v1 (, v2)."""
    require_libraries(path.suffix.lower())
    edges = wanted.edges
    parts = content(triangulation, z=wanted.z, edges=edges, attributes=wanted.attributes).whole()
    system = system_of(wanted.crs, path.suffix.lower())
    # Appending to GeoJSON is expensive in GDAL; it is a text format for small data.
    driver = "GeoJSON" if path.suffix.lower() == ".geojson" else "GPKG"
    count = len(parts.simplices)
    part = count if driver == "GeoJSON" else _PART
    layer = "edges" if edges else "triangles"
    for start in range(0, count, part):
        rows = slice(start, start + part)
        some = parts._replace(
            simplices=parts.simplices[rows],
            of_simplices={name: values[rows] for name, values in parts.of_simplices.items()},
        )
        options = {"append": True} if start else {}
        write_layer(path, to_geopandas(some, system), layer, driver=driver, **options)


def system_of(crs: str | None, suffix: str) -> Any:
    """Return a reference system that geopandas accepts."""
    if not crs:
        return None
    check_system(crs, suffix)
    pyproj = require("pyproj", extra="geo", what="writing a reference system")
    try:
        return pyproj.CRS.from_user_input(crs)
    except (pyproj.exceptions.CRSError, ValueError) as error:
        raise FileFormatError(
            f"{suffix} files cannot store the reference system {crs!r:.80}: it is unknown to pyproj"
        ) from error


def write_layer(path: Path, frame: Any, layer: str, *, driver: str, **options: Any) -> None:
    """Write a layer of geometries in place, and verify that all of it is in the file."""
    pyogrio = require("pyogrio", extra="geo", what="writing geometries")
    with warnings.catch_warnings():
        # A survey without a reference system is common and needs no warning.
        warnings.filterwarnings("ignore", message=".*crs.*")
        if driver not in _IN_MEMORY:
            name = plain_name(path)
            pyogrio.write_dataframe(frame, name, layer=layer, driver=driver, **options)
            if driver == "GPKG":
                require_index(pyogrio, name, layer)
            return
        content = io.BytesIO()
        pyogrio.write_dataframe(
            frame, content, layer=layer, driver=driver, **_IN_MEMORY[driver], **options
        )
    path.write_bytes(content.getbuffer())


def plain_name(path: Path) -> str:
    """Return a name that pyogrio cannot read as anything but this file."""
    try:
        return local_name(path)
    except FileFormatError as error:
        raise OSError(str(error)) from error


def require_index(pyogrio: Any, name: str, layer: str) -> None:
    """Verify that a GeoPackage has its spatial index, which is written last.

    GDAL does not report a failure.
    """
    facts = pyogrio.read_info(name, layer=layer)
    if not facts["capabilities"]["fast_spatial_filter"]:
        raise OSError("the spatial index is missing")
