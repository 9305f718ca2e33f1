"""What ``volume`` prints and writes: figures with their units, and a row for each polygon."""

from __future__ import annotations

import math
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from delone._base.atomic import check_target, replacing
from delone._base.extras import require
from delone._base.units import lengths_of_crs
from delone.cli.constraints import geometries_of
from delone.cli.exits import protect_inputs, writing
from delone.cli.notes import note
from delone.cli.surfaces import curves_of
from delone.cli.tables import TABLE_SUFFIXES, ready_table, write_table
from delone.terrain import Volumes

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from delone.cli.report import Stopwatch
    from delone.cli.surfaces import SurfaceOptions
    from delone.io import GeometrySet
    from delone.terrain import Volume

__all__ = [
    "ROW_SUFFIXES",
    "read_regions",
    "ready_rows",
    "volume_figures",
    "volume_rows",
    "write_rows",
]

ROW_SUFFIXES = (".csv", *TABLE_SUFFIXES)
_SUMS = ("cut", "fill", "net", "cut_area", "fill_area", "area")
_NUMBERS = (*_SUMS, "region_area", "coverage")
# The number of rows that are printed; the table contains all.
_SHOWN = 20


def read_regions(path: Path, layer: str | None, options: SurfaceOptions) -> GeometrySet:
    """Read polygons with all columns."""
    return geometries_of(path, layer=layer, attributes="all", **curves_of(path, options.chord))


def ready_rows(output: Sequence[Path], inputs: Sequence[Path]) -> None:
    """Check that the table can be written before any work is done."""
    with writing():
        protect_inputs(list(output), *inputs)
        for path in output:
            if path.suffix.lower() != ".csv":
                ready_table(path, "a table of volumes", also=".csv")
                continue
            require("pandas", extra="geo", what="a table of volumes")
            check_target(path)


def write_rows(
    found: Volumes, lots: GeometrySet, output: Sequence[Path], watch: Stopwatch, *, quiet: bool
) -> None:
    """Write a row for each polygon, with the columns of its layer."""
    columns = {}
    for name, values in lots.attributes.items():
        free = name
        # Terminates, because there are finitely many names.
        while free in columns or free in (*_NUMBERS, "geometry"):
            free = f"layer_{free}"
        if free != name:
            note(f"the column {name!r:.80} of the layer is {free!r:.80} in the table", quiet=quiet)
        columns[free] = values
    with writing(), ExitStack() as stack:
        for path in output:
            with watch.stage(f"write {path.name}"):
                target = stack.enter_context(replacing(path))
                if path.suffix.lower() == ".csv":
                    found.to_pandas(columns).to_csv(target, index=False)
                else:
                    crs = found.crs or lots.crs
                    table = found.to_geopandas(columns, crs=crs)
                    write_table(table, target, layer="volumes", multi=True)


def volume_figures(found: Volume | Volumes) -> dict[str, Any]:
    """Return the figures of one volume, or of several volumes with their sums."""
    units = {"volume_units": found.volume_units, "area_units": found.area_units}
    if not isinstance(found, Volumes):
        return {name: getattr(found, name) for name in _SUMS} | units
    columns = {name: getattr(found, name).tolist() for name in _NUMBERS}
    rows = [
        {"row": row} | {name: _known(column[row]) for name, column in columns.items()}
        for row in range(len(found))
    ]
    sums = {name: math.fsum(columns[name]) for name in _SUMS}
    beside = {"regions": len(found), "regions_not_covered_entirely": int(found.partial.sum())}
    return beside | sums | units | {"rows": rows}


def _known(number: float) -> float | None:
    return None if math.isnan(number) else number


def volume_rows(found: Volume | Volumes, lots: GeometrySet | None) -> list[tuple[str, str]]:
    """Return rows to print: unknown units, and the first polygons."""
    unknown = []
    if found.units is None:
        unknown.append("of heights: --units")
    if lengths_of_crs(found.crs) is None:
        unknown.append("of x and y: --crs")
    rows = [("unknown units", ", ".join(unknown))] if unknown else []
    if not isinstance(found, Volumes) or lots is None:
        return rows
    volume, area = (f" {unit}" if unit else "" for unit in (found.volume_units, found.area_units))
    names = _names(lots)
    for row in range(min(len(found), _SHOWN)):
        cut, fill, net = (f"{getattr(found, name)[row]:.6g}{volume}" for name in _SUMS[:3])
        share = found.coverage[row]
        covered = "no area" if math.isnan(share) else f"{share:.4g} covered"
        text = f"cut {cut}, fill {fill}, net {net}, area {found.area[row]:.6g}{area}, {covered}"
        rows.append((f"region {names[row]}", text))
    if len(found) > _SHOWN:
        rows.append(("...", f"{len(found) - _SHOWN:,} more"))
    return rows


def _names(lots: GeometrySet) -> list[str]:
    """Return a name for each polygon: the first column of text, or the number of the row."""
    for values in lots.attributes.values():
        texts = values.tolist()
        if texts and all(isinstance(each, str) for each in texts):
            return [f"{each:.40}" for each in texts]
    return [str(row) for row in range(len(lots))]
