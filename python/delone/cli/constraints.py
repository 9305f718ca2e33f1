"""Lines and polygons of a file: reading, triangulation and report."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import Delaunay, from_geometry
from delone._base.counting import counted
from delone._base.extras import require
from delone.cli.exits import Exit, Failure
from delone.errors import CrossingSegmentsError, NonFiniteError
from delone.io import GeometrySet, LeftOutWarning, read_geometries, read_points, read_surface
from delone.io.registry import holds_geometries, holds_surface

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone import ConstrainedDelaunay
    from delone.cli.report import Mesh
    from delone.io import PointSet

__all__ = [
    "Constraints",
    "constraint_figures",
    "constraint_rows",
    "geometries_of",
    "read_input",
    "triangulated",
]

_FIRST = 3


class Constraints(NamedTuple):
    """The command-line options for lines and polygons."""

    crossing: str | None  # None if not given
    outline: bool  # remove triangles outside
    conforming: bool  # add vertices until all segments are Delaunay edges
    max_points: int | None  # the maximum number of vertices to add

    def require_none(self, source: str) -> None:
        """Reject options that do not apply to points."""
        given = [f"--{name.replace('_', '-')}" for name in self._fields if self._is_given(name)]
        if given:
            raise Failure(
                f"{given[0]} is for lines and polygons; {source} contains only points", Exit.USAGE
            )

    def _is_given(self, name: str) -> bool:
        return getattr(self, name) not in (None, False)


def geometries_of(path: Path, **options: Any) -> GeometrySet:
    """Read lines and polygons, and warn about features without a geometry."""
    found = read_geometries(path, **options)
    _warn_of_missing(found)
    return found


def _warn_of_missing(found: GeometrySet) -> None:
    shapely = require("shapely", extra="geo", what="geometries")
    missing = shapely.is_missing(found.geometries) | shapely.is_empty(found.geometries)
    number = int(missing.sum())
    if number:
        verb = "has" if number == 1 else "have"
        warnings.warn(
            f"{found.source}: {number:,} of {counted(len(found), 'feature')} {verb} no geometry",
            LeftOutWarning,
            stacklevel=3,
        )


def read_input(
    source: Path,
    *,
    columns: Sequence[str | int] | None,
    classes: Sequence[int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
    chord: float | None = None,
) -> PointSet | GeometrySet:
    """Read points, or geometries if there are lines or areas among them."""
    if holds_surface(source) and source.exists() and columns is None and classes is None:
        sheet = read_surface(source, layer=layer, chord=chord)
        sheet.warn_left_out()
        lines = (
            sheet.breaklines,
            sheet.soft_breaklines,
            sheet.boundary,
            sheet.holes,
            sheet.islands,
        )
        return sheet.as_geometries(points=True) if any(map(len, lines)) else sheet.as_points()
    if classes is None and holds_geometries(source):
        found = read_geometries(source, columns=columns, layer=layer, chord=chord)
        if found.only_points:
            return found.as_points()
        _warn_of_missing(found)
        return found
    return read_points(
        source,
        columns=columns,
        classes=classes,
        layer=layer,
        attributes=tuple(attributes),
        chord=chord,
    )


def triangulated(
    survey: PointSet | GeometrySet, constraints: Constraints, **options: Any
) -> tuple[Mesh, NDArray[np.float64] | None]:
    """Triangulate the input, with `method` and `workers`; also return the heights of its points."""
    if not isinstance(survey, GeometrySet):
        constraints.require_none(survey.source)
        return Delaunay(survey.points, **options), survey.z
    options |= {
        "crossing": constraints.crossing or "split",
        "conforming": constraints.conforming,
        "max_points": constraints.max_points,
        "boundary": _boundary(survey, constraints.outline),
    }
    try:
        mesh = from_geometry(survey.geometries, **options)
    except CrossingSegmentsError as error:
        raise Failure(f"{survey.source}: {_crossing(error)}", Exit.DEGENERATE) from error
    except NonFiniteError as error:
        raise not_finite(survey, error) from error
    if not mesh.nsimplex:
        raise Failure(f"{survey.source}: no line or ring encloses an area", Exit.DEGENERATE)
    return mesh, survey.z_of(mesh)


def not_finite(survey: GeometrySet, error: NonFiniteError) -> Failure:
    """Return the error for features with NaN or infinity."""
    first = ", ".join(map(str, error.rows.tolist())) + (", ..." if error.count > 10 else "")
    return Failure(f"{survey.source}: NaN or infinity in features {first}", Exit.DEGENERATE)


def _crossing(error: CrossingSegmentsError) -> str:
    points = [f"({x!r}, {y!r})" for x, y in error.points[:_FIRST].tolist()]
    pairs = "1 pair of segments crosses" if len(error.pairs) == 1 else (
        f"{len(error.pairs):,} pairs of segments cross"
    )  # fmt: skip
    more = ", ..." if len(error.pairs) > _FIRST else ""
    return f"{pairs}, at {', '.join(points)}{more}; --crossing split adds vertices there"


def _boundary(survey: GeometrySet, outline: bool) -> str:
    """Return the boundary option: for lines alone, the inside is what they enclose."""
    if not outline:
        return "hull"
    return "polygons" if len(survey.areas) else "outline"


def constraint_figures(mesh: ConstrainedDelaunay, survey: GeometrySet) -> dict[str, Any]:
    """Return the figures on lines and polygons: counts, and the first crossings."""
    report = mesh.report
    names = ("repeated", "overlaps", "through", "zero", "steiner")
    return {
        "features": len(survey),
        "segments": len(mesh.input_segments),
        "pieces": len(mesh.segments),
        "added": mesh.nadded,
        "regions": len(np.unique(mesh.region)),
        "crossings": {"count": len(report.crossings), "first": _first(mesh, report.crossings)},
        **{name: len(getattr(report, name)) for name in names},
    }


def _first(mesh: ConstrainedDelaunay, crossings: NDArray[np.int32]) -> list[dict[str, Any]]:
    features = mesh.geometry_of_segment[crossings[:_FIRST, :2]].tolist()
    points = mesh.points[crossings[:_FIRST, 2]].tolist()
    return [
        {"features": pair, "x": x, "y": y} for pair, (x, y) in zip(features, points, strict=True)
    ]


def constraint_rows(figures: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the rows of the report on lines and polygons, without counts of zero."""
    rows = [
        ("features", f"{figures['features']:,}"),
        ("segments", f"{figures['segments']:,} in {figures['pieces']:,} pieces"),
    ]
    rows += [
        (name, f"{figures[key]:,}")
        for name, key in (
            ("repeated segments", "repeated"),
            ("overlapping pairs", "overlaps"),
            ("zero-length segments", "zero"),
            ("points on segments", "through"),
        )
        if figures[key]
    ]
    if figures["crossings"]["count"]:
        rows.append(("crossings", _crossings(figures["crossings"])))
    if figures["added"]:
        rows.append(("added vertices", f"{figures['added']:,}"))
    return [*rows, ("regions", f"{figures['regions']:,}")]


def _crossings(crossings: dict[str, Any]) -> str:
    lines = [f"{crossings['count']:,}, split"]
    for each in crossings["first"]:
        a, b = each["features"]
        who = f"feature {a} crosses itself" if a == b else f"features {a} and {b} cross"
        lines.append(f"{who} at ({each['x']!r}, {each['y']!r})")
    if crossings["count"] > len(crossings["first"]):
        lines.append("...")
    return "\n".join(lines)
