"""Tables of geometries that commands write: cells, contours, profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.atomic import check_target
from delone._base.extras import require
from delone.cli.exits import require_suffix
from delone.cli.notes import note
from delone.errors import FileFormatError
from delone.io.vector import write_layer

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["APPENDED", "TABLE_SUFFIXES", "ready_table", "write_table"]

_DRIVERS = {
    ".gpkg": "GPKG",
    ".geojson": "GeoJSON",
    ".fgb": "FlatGeobuf",
    ".shp": "ESRI Shapefile",
    ".kml": "LIBKML",
    ".sqlite": "SQLite",
    ".mif": "MapInfo File",
}
TABLE_SUFFIXES = (*_DRIVERS, ".parquet")
# Formats that allow adding rows to a file.
APPENDED = (".gpkg", ".shp", ".sqlite")
# Maximum length of a column name in a Shapefile.
_SHORT = 10


def ready_table(path: Path, what: str, *, also: str = "") -> None:
    """Check that a table of `what` can be written to a file before any work is done.

    `also` is a suffix that the caller writes.
    """
    require_suffix(path, [*[also] * bool(also), *TABLE_SUFFIXES], what)
    require("geopandas", extra="geo", what=f"writing {what}")
    if path.suffix.lower() == ".parquet":
        require("pyarrow.parquet", extra="geo", what="writing Parquet files")
    check_target(path)


def write_table(
    table: Any, path: Path, *, layer: str, multi: bool = False, append: bool = False
) -> None:
    """Write a GeoDataFrame in place; the suffix determines the format.

    `multi`: the table may contain both single and multipart geometries. `append`: the file already
    has rows; for suffixes in `APPENDED`.
    """
    suffix = path.suffix.lower()
    if suffix == ".parquet":
        table.to_parquet(path, index=False)
        return
    options: dict[str, Any] = {"driver": _DRIVERS[suffix], "promote_to_multi": multi}
    if append:
        options["append"] = True
    if suffix == ".kml":
        if table.crs is None:
            raise FileFormatError(
                "KML has longitudes and latitudes, and the reference system is unknown: give --crs"
            )
        table = table.to_crs(4326)
    elif suffix == ".shp":
        # The layer is named after the file; otherwise GDAL would write further rows to another
        # file.
        table, layer = _with_short_names(table), path.stem
    if suffix == ".fgb" and (table.geometry.isna() | table.geometry.is_empty).any():
        # The index of FlatGeobuf cannot contain empty geometries.
        options["SPATIAL_INDEX"] = "NO"
    write_layer(path, table, layer, **options)


def _with_short_names(table: Any) -> Any:
    """Return a table with column names that Shapefiles allow; print a note about changed names."""
    names: dict[str, str] = {}
    for name in map(str, table.columns.drop(table.geometry.name)):
        short, number = name[:_SHORT], 1
        # Terminates, because there are finitely many names.
        while short in names.values():
            number += 1
            short = f"{name[: _SHORT - len(str(number))]}{number}"
        names[name] = short
        if short != name:
            note(
                f"Shapefiles allow only short names: the column {name!r:.80} is written as "
                f"{short!r}"
            )
    return table.rename(columns=names)
