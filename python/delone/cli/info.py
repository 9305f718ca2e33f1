"""The contents of a file of points or other geometries: the command ``delone info``."""

from __future__ import annotations

from collections import Counter
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import agreed, counted
from delone.cli.constraints import read_input
from delone.cli.exits import reading
from delone.cli.options import (
    Classes,
    Columns,
    Flat,
    Input,
    Json,
    Layer,
    Solid,
    class_numbers,
    space_or_plane,
    split,
)
from delone.cli.referenced import Crs, referenced, require_known
from delone.cli.report import finite_or_none
from delone.cli.show import print_json, print_rows, spinner
from delone.cli.solid import is_space
from delone.io import GeometrySet
from delone.io.registry import is_lidar, is_point_tiles

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.cli.show import Row
    from delone.io import PointSet

__all__ = ["info"]

_CLASSES = {
    0: "never classified",
    1: "unclassified",
    2: "ground",
    3: "low vegetation",
    4: "medium vegetation",
    5: "high vegetation",
    6: "building",
    7: "low noise",
    9: "water",
    10: "rail",
    11: "road",
    17: "bridge",
    18: "high noise",
}


def info(
    source: Input,
    *,
    classes: Classes = None,
    columns: Columns = None,
    layer: Layer = None,
    in_space: Solid = False,
    in_plane: Flat = False,
    crs: Crs = None,
    as_json: Json = False,
) -> None:
    """Describe the contents of a file without triangulating it."""
    space = space_or_plane(in_space, in_plane)
    require_known(crs)
    with spinner(as_json) as say:
        say(f"reading {source.name}")
        figures, rows = _described(
            source,
            columns=split(columns),
            classes=class_numbers(classes),
            layer=layer,
            space=space,
            crs=crs,
        )
    if as_json:
        print_json(figures)
    else:
        print_rows(str(source), rows)


def _described(
    source: Path,
    *,
    columns: list[str] | None,
    classes: list[int] | None,
    layer: str | None,
    space: bool | None = None,
    crs: str | None = None,
) -> tuple[dict[str, Any], list[Row]]:
    """Read a file and return figures and rows of its contents; `crs` replaces that of the file.

    By default, `delone.cli.solid.is_space` decides whether points are 3-D (`space`).
    """
    with reading():
        tiles = _header(source) if is_point_tiles(source) and source.exists() else None
        classified = is_lidar(source) if tiles is None else "classification" in tiles["dimensions"]
        survey = read_input(
            source,
            columns=columns,
            classes=classes,
            layer=layer,
            attributes=("classification",) if classified else (),
        )
        header = tiles or (_header(source) if is_lidar(source) else {})
        solid = is_space(source, space, survey)
    survey = referenced(survey, crs, planar=True, quiet=False)
    if isinstance(survey, GeometrySet):
        figures = _figures(survey.all_points()) | _of_geometries(survey)
    else:
        figures = _figures(survey, solid=solid) | header
    figures.setdefault("file_bytes", source.stat().st_size)
    return figures, _rows(figures)


def _of_geometries(survey: GeometrySet) -> dict[str, Any]:
    kinds = [getattr(each, "geom_type", "none") for each in survey.geometries.tolist()]
    return {"features": len(survey), "kinds": dict(Counter(kinds).most_common())}


def _header(source: Path) -> dict[str, Any]:
    from delone.io import ept, las

    return ept.describe(source) if is_point_tiles(source) else las.describe(source)


def _figures(survey: PointSet, *, solid: bool = False) -> dict[str, Any]:
    finite = np.isfinite(survey.points).all(axis=1)
    if solid and survey.z is not None:
        finite &= np.isfinite(survey.z)
    figures: dict[str, Any] = {
        "input": survey.source,
        "crs": survey.crs,
        "dimensions_of_points": 3 if solid else 2,
        "points": len(survey),
        "not_finite": int(np.count_nonzero(~finite)),
        "x": _range(survey.points[:, 0]),
        "y": _range(survey.points[:, 1]),
        "z": None if survey.z is None else _range(survey.z),
    }
    if "classification" in survey.attributes:
        found, counts = np.unique(survey.attributes["classification"], return_counts=True)
        figures["classes"] = {
            str(number): count
            for number, count in zip(found.tolist(), counts.tolist(), strict=True)
        }
    return figures


def _range(values: NDArray[np.float64]) -> list[float] | None:
    known = values[np.isfinite(values)] if not np.isfinite(values).all() else values
    if not len(known):
        return None
    return [float(known.min()), float(known.max())]


def _rows(figures: dict[str, Any]) -> list[Row]:
    rows = [
        ("size", f"{figures['file_bytes']:,} bytes"),
        *_feature_rows(figures),
        ("points", f"{figures['points']:,}"),
        ("reference system", (figures["crs"] or "unknown").partition("\n")[0][:100]),
    ]
    if figures["not_finite"]:
        rows.append(
            (
                "NaN or infinity",
                f"{figures['not_finite']:,} {agreed(figures['not_finite'], 'row', 'rows')}",
            )
        )
    for axis in "xyz":
        if figures[axis] is not None:
            low, high = figures[axis]
            rows.append((axis, f"{low!r} to {high!r}"))
    solid = figures["dimensions_of_points"] == 3
    if (density := _density(figures, "xyz" if solid else "xy")) is not None:
        unit = "volume" if solid else "area"
        rows.append(("mean density", f"{density:.4g} points per unit of {unit} of the box"))
    if "classes" in figures:
        named = [
            f"{number} {_CLASSES.get(int(number), '')}".strip() + f": {count:,}"
            for number, count in figures["classes"].items()
        ]
        rows.append(("classes", "\n".join(named)))
    if "las_version" in figures:
        rows.append(
            ("LAS", f"version {figures['las_version']}, point format {figures['point_format']}")
        )
    if "ept_data" in figures:
        nodes = counted(figures["ept_nodes"], "node")
        rows.append(("EPT", f"{nodes} of type {figures['ept_data']}"))
    if "dimensions" in figures:
        rows.append(("dimensions", ", ".join(figures["dimensions"])))
    return rows


def _feature_rows(figures: dict[str, Any]) -> list[Row]:
    if "features" not in figures:
        return []
    kinds = "\n".join(f"{kind}: {count:,}" for kind, count in figures["kinds"].items())
    return [("features", f"{figures['features']:,}"), ("kinds", kinds)]


def _density(figures: dict[str, Any], axes: str) -> float | None:
    if not all(figures[axis] for axis in axes):
        return None
    size = prod(high - low for low, high in (figures[axis] for axis in axes))
    return finite_or_none(figures["points"] / size) if size > 0 else None
