"""Tables of geometries that commands write: cells, contours, profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.atomic import check_target
from delone.cli.exits import Exit, Failure
from delone.extras import require
from delone.io.vector import write_layer

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["TABLE_SUFFIXES", "ready_table", "write_table"]

_DRIVERS = {".gpkg": "GPKG", ".geojson": "GeoJSON", ".fgb": "FlatGeobuf"}
TABLE_SUFFIXES = (*_DRIVERS, ".parquet")


def ready_table(path: Path, what: str, *, also: str = "") -> None:
    """Check that a table of `what` can be written to a file before any work is done.

    `also` is a suffix that the caller writes.
    """
    if path.suffix.lower() not in TABLE_SUFFIXES:
        suffixes = " ".join([also] * bool(also) + [*TABLE_SUFFIXES])
        raise Failure(f"{path}: {what} can only be written to {suffixes}", Exit.USAGE)
    require("geopandas", extra="geo", what=f"writing {what}")
    if path.suffix.lower() == ".parquet":
        require("pyarrow.parquet", extra="geo", what="writing Parquet files")
    check_target(path)


def write_table(table: Any, path: Path, *, layer: str, multi: bool = False) -> None:
    """Write a GeoDataFrame in place; the suffix determines the format.

    `multi`: single geometries may be among parts of several.
    """
    suffix = path.suffix.lower()
    if suffix == ".parquet":
        table.to_parquet(path, index=False)
        return
    options: dict[str, Any] = {"driver": _DRIVERS[suffix], "promote_to_multi": multi}
    if suffix == ".fgb" and (table.geometry.isna() | table.geometry.is_empty).any():
        # The index of FlatGeobuf cannot contain empty geometries.
        options["SPATIAL_INDEX"] = "NO"
    write_layer(path, table, layer, **options)
