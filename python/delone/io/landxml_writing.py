"""LandXML 1.2 output of one surface: points, faces, lines, units and reference system."""

from __future__ import annotations

import re
import time
import warnings
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from delone._base.georeference import caller_level, parsed
from delone._base.units import UnitsWarning, as_units, lengths_of_crs
from delone.errors import FileFormatError
from delone.exchange.parts import boundary
from delone.io.content import content, require_finite_heights
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["write_mesh"]

_SPACE = "http://www.landxml.org/schema/LandXML-1.2"
_METRIC = {"mm": "millimeter", "cm": "centimeter", "m": "meter", "km": "kilometer"}
_IMPERIAL = {"ft": "foot", "us-ft": "USSurveyFoot", "in": "inch", "mi": "mile"}
_ELEVATION = {"m": "meter", "km": "kilometer", "ft": "feet", "mi": "miles"}
_REST = {
    "Metric": 'areaUnit="squareMeter" volumeUnit="cubicMeter" temperatureUnit="celsius" '
    'pressureUnit="milliBars"',
    "Imperial": 'areaUnit="squareFoot" volumeUnit="cubicFeet" temperatureUnit="fahrenheit" '
    'pressureUnit="inchHG"',
}


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write points with heights, triangles, breaklines and outlines; ids are rows from 1."""
    files, crs = f"{path.suffix} files of surfaces", wanted.crs
    wanted.refuse(files, "edges", "attributes")
    wanted.require_heights(files)
    check_system(crs, path.suffix)
    parts = content(triangulation, z=wanted.z).whole()
    own = content(triangulation).own
    segments = np.empty((0, 2), dtype=np.int32) if own.segments is None else own.segments
    soft = np.asarray(getattr(triangulation, "soft", np.zeros(len(segments), dtype=bool)))
    units = as_units(getattr(triangulation, "units", None))
    require_finite_heights(parts.points, files)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(_head(crs, units, path))
        file.write('<Surfaces><Surface name="surface">\n<SourceData>\n')
        file.writelines(_boundaries(parts.points, parts.simplices))
        file.writelines(_breaklines(parts.points, segments, soft))
        file.write('</SourceData>\n<Definition surfType="TIN">\n<Pnts>\n')
        for row, point in enumerate(parts.points.tolist(), start=1):
            file.write(f'<P id="{row}">{_text(point)}</P>\n')
        file.write("</Pnts>\n<Faces>\n")
        for a, b, c in (parts.simplices + np.int32(1)).tolist():
            file.write(f"<F>{a} {b} {c}</F>\n")
        file.write("</Faces>\n</Definition>\n</Surface></Surfaces>\n</LandXML>\n")


def _text(point: list[float]) -> str:
    """Northing, easting and height, with all digits."""
    x, y, z = point
    return f"{y!r} {x!r} {z!r}"


def _head(crs: str | None, units: str | None, path: Path) -> Iterator[str]:
    day, hour = time.strftime("%Y-%m-%d"), time.strftime("%H:%M:%S")
    yield '<?xml version="1.0" encoding="UTF-8"?>\n'
    yield f'<LandXML xmlns="{_SPACE}" version="1.2" date="{day}" time="{hour}">\n'
    yield _units(lengths_of_crs(crs) or units, units, path)
    if crs is not None:
        yield f"<CoordinateSystem {_system(crs)}/>\n"
    yield '<Application name="delone"/>\n'


def _units(lengths: str | None, heights: str | None, path: Path) -> str:
    if lengths is None or heights is None:
        warnings.warn(
            f"the units of the heights are unknown, and the {path.suffix} file names none: give "
            'units="m" or another unit to the TIN',
            UnitsWarning,
            stacklevel=caller_level(),
        )
        return ""
    kind = "Metric" if lengths in _METRIC else "Imperial"
    words = f'linearUnit="{_METRIC.get(lengths) or _IMPERIAL[lengths]}" {_REST[kind]}'
    if lengths != heights:
        if heights not in _ELEVATION:
            raise FileFormatError(
                f"{path.suffix} files cannot store heights in {heights} with x and y in {lengths}: "
                "convert the heights"
            )
        words += f' elevationUnit="{_ELEVATION[heights]}"'
    return f"<Units><{kind} {words}/></Units>\n"


def _system(crs: str) -> str:
    if not re.fullmatch(r"EPSG:\d+", crs):
        known = parsed(crs)
        code = None if known is None else known.to_epsg(min_confidence=100)
        if code is None:
            return f"ogcWktCode={quoteattr(crs)}"
        crs = f"EPSG:{code}"
    return f'epsgCode="{crs.removeprefix("EPSG:")}"'


def _boundaries(points: Floats, simplices: Indices) -> Iterator[str]:
    yield "<Boundaries>\n"
    for ring in _chains(boundary(simplices).tolist(), directed=True):
        x, y = (points[ring, :2] - points[ring[0], :2]).T
        outer = float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) > 0
        kind = "outer" if outer else "void"
        yield f'<Boundary bndType="{kind}" edgeTrim="true">{_list(points, ring)}</Boundary>\n'
    yield "</Boundaries>\n"


def _breaklines(points: Floats, segments: Indices, soft: NDArray[np.bool_]) -> Iterator[str]:
    if not len(segments):
        return
    yield "<Breaklines>\n"
    for kind, rows in (("", ~soft), (' desc="soft"', soft)):
        for chain in _chains(segments[rows].tolist()):
            line = _list(points, chain)
            yield f'<Breakline brkType="standard"{kind}>{line}</Breakline>\n'
    yield "</Breaklines>\n"


def _list(points: Floats, rows: Iterable[int]) -> str:
    return f"<PntList3D>{' '.join(_text(points[row].tolist()) for row in rows)}</PntList3D>"


def _chains(edges: list[Any], *, directed: bool = False) -> Iterator[list[int]]:
    """Join edges into lines, which end where not exactly two edges meet, and then into rings."""
    around: dict[int, list[int]] = {}
    for row, (a, b) in enumerate(edges):
        around.setdefault(a, []).append(row)
        if not directed:
            around.setdefault(b, []).append(row)
    free = [True] * len(edges)
    plain = 1 if directed else 2
    ends = [v for v, rows in around.items() if len(rows) != plain]
    for start in (*ends, *around):
        for row in around[start]:
            if free[row]:
                yield _chain(edges, around, free, start, row, directed)


def _chain(  # noqa: PLR0917
    edges: list[Any],
    around: dict[int, list[int]],
    free: list[bool],
    start: int,
    row: int,
    directed: bool,
) -> list[int]:
    """Follow edges from a vertex, starting with one of them, as long as that is unambiguous."""
    chain = [start]
    while True:
        free[row] = False
        a, b = edges[row]
        chain.append(b if a == chain[-1] else a)
        rows = around.get(chain[-1], [])
        following = [each for each in rows if free[each]]
        ended = chain[-1] == start if directed else len(rows) != 2
        if ended or not following:
            return chain
        row = following[0]
