"""DXF drawings of surfaces, contours, points, profiles and cross sections, with ezdxf.

Each kind of thing is on its own layers. Maps are drawn at their coordinates, with heights as z;
profiles and sections are drawn in a plane, with distances to the right and heights upward. Numbers
are written with all digits, so reading returns the same doubles.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_number
from delone._base.atomic import replacing
from delone._base.extras import require
from delone._base.units import as_units, lengths_of_crs
from delone.errors import FileFormatError, InputError

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["write_drawing"]

# $INSUNITS.
_UNITS = {"in": 1, "ft": 2, "mi": 3, "mm": 4, "cm": 5, "m": 6, "km": 7, "us-ft": 21}
# AutoCAD colors; the surfaces in profiles use them in turn.
_GRAY, _WHITE, _GREEN, _BROWN = 8, 7, 94, 34
_TURN = (34, 1, 5, 3, 6, 4)
# The default text height, as a fraction of the length of a profile or of the extent of points.
_TEXT = 1 / 120
# The approximate number of labeled heights and distances in a profile.
_TICKS = 8


def write_drawing(
    path: str | os.PathLike[str],
    *things: Any,
    text_height: float | None = None,
    exaggeration: float = 1.0,
    units: str | None = None,
) -> None:
    """Write surfaces, contours, points or profiles to a DXF drawing (extra ``dxf``).

    Parameters
    ----------
    path : str or path-like
        The file, ``.dxf``. An existing one is replaced only once the new one is complete.
    *things : TIN, Contours, PointSet, Profile, Profiles or CrossSections
        What is drawn: surfaces as 3DFACE on the layer ``TIN`` and their breaklines as 3-D polylines
        on ``BREAKLINES`` and ``SOFT_BREAKLINES``; contours as 3-D polylines on ``CONTOURS`` and
        ``CONTOURS_INDEX``, with a `text_height` also labels, of index contours if there are any, on
        ``CONTOURS_TEXT``; points as POINT on ``POINTS``, with their heights as text on
        ``POINTS_TEXT``; profiles and cross sections as polylines on ``PROFILE_`` and the name of
        the surface, with a frame, text and stations on ``PROFILE_FRAME`` and ``PROFILE_TEXT``.
        The layers of a second object of the same kind end in ``_2``.
    text_height : float, optional
        The height of text in drawing units; by default a readable one.
    exaggeration : float, optional
        The factor for heights in profiles; labels show the true heights.
    units : str, optional
        The unit of the drawing, such as ``"m"``; by default that of the reference system of
        `things`, or that of their heights. If unknown, the drawing has none.

    Raises
    ------
    InputError
        Something cannot be drawn, `exaggeration` or `text_height` is not above 0, or maps and
        profiles are mixed.
    FileFormatError
        The suffix is not ``.dxf``.
    MissingExtraError
        ezdxf is not installed.
    OutputError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import read_surface, write_drawing
    >>> from delone.terrain import TIN
    >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "site.dxf"
    ...     write_drawing(file, tin, tin.contours(interval=2))
    ...     len(read_surface(file, layer="TIN").faces), len(read_surface(file).breaklines)
    (2, 4)
    """
    if not str(path).lower().endswith(".dxf"):
        raise FileFormatError(f"{path}: drawings are written to .dxf")
    factor = as_number(exaggeration, name="exaggeration")
    size = None if text_height is None else as_number(text_height, name="text_height")
    if not (0 < factor < math.inf and (size is None or 0 < size < math.inf)):
        raise InputError("exaggeration and text_height must be above 0 and finite")
    ezdxf = require("ezdxf", extra="dxf", what="writing DXF")
    drawing = ezdxf.new("R2010")
    drawing.header["$INSUNITS"] = _UNITS.get(as_units(units) or _units_of(things) or "", 0)
    sheet = _Sheet(drawing, size, factor)
    kinds = [sheet.add(thing) for thing in things]
    if not things:
        raise InputError("nothing to draw")
    if len(set(kinds)) > 1:
        raise InputError("maps and profiles are in different planes: write them to two drawings")
    with replacing(path) as target:
        drawing.saveas(str(target))


def _units_of(things: Sequence[Any]) -> str | None:
    """Return the unit of x and y of things; if unknown, that of their heights."""
    for thing in things:
        found = lengths_of_crs(getattr(thing, "crs", None)) or getattr(thing, "units", None)
        if found:
            return str(found)
    return None


class _Sheet:
    """A drawing to which things are added."""

    def __init__(self, drawing: Any, text: float | None, factor: float) -> None:
        self._drawing, self._space = drawing, drawing.modelspace()
        self._text, self._factor = text, factor
        enums = require("ezdxf.enums", extra="dxf", what="writing DXF")
        self._middle = enums.TextEntityAlignment.MIDDLE_CENTER
        self._counts: dict[str, int] = {}

    def add(self, thing: Any) -> str:
        """Draw a thing, and return whether it is a map or a profile."""
        if hasattr(thing, "simplices") and hasattr(thing, "breaklines"):
            self._surface(thing)
        elif hasattr(thing, "starts") and hasattr(thing, "level"):
            self._contours(thing)
        elif hasattr(thing, "sections"):
            self._sections(thing)
            return "profile"
        elif hasattr(thing, "distances") and hasattr(thing, "z"):
            z = thing.z.reshape(len(thing.z), -1)
            names = getattr(thing, "names", ("surface",))
            self._profile(thing.distances, z, names, end=self._suffix("PROFILE"))
            return "profile"
        elif hasattr(thing, "points") and hasattr(thing, "z") and not hasattr(thing, "simplices"):
            self._points(thing)
        else:
            raise InputError(
                "a drawing takes TIN, Contours, PointSet, Profile, Profiles and CrossSections; "
                f"got {type(thing).__name__}"
            )
        return "map"

    def _suffix(self, kind: str) -> str:
        count = self._counts[kind] = self._counts.get(kind, 0) + 1
        return "" if count == 1 else f"_{count}"

    def _layer(self, name: str, color: int) -> dict[str, Any]:
        layers = self._drawing.layers
        if not layers.has_entry(name):
            layers.add(name, color=color)
        return {"layer": name}

    def _polyline(self, points: Floats, on: dict[str, str]) -> None:
        closed = len(points) > 3 and (points[0] == points[-1]).all()
        rows = points[: -1 if closed else None].tolist()
        self._space.add_polyline3d(rows, close=bool(closed), dxfattribs=on)

    def _write(
        self, text: str, place: tuple[float, float], size: float, on: dict[str, str]
    ) -> None:
        self._space.add_text(text, height=size, dxfattribs=on).set_placement(place)

    def _surface(self, tin: Any) -> None:
        end = self._suffix("TIN")
        xyz = np.column_stack((tin.points, tin.z))
        on = self._layer(f"TIN{end}", _GREEN)
        for corners in xyz[tin.simplices].tolist():
            self._space.add_3dface(corners, dxfattribs=on)
        for name, some in (("BREAKLINES", ~tin.soft), ("SOFT_BREAKLINES", tin.soft)):
            for chain in chains(tin.breaklines[some]):
                self._polyline(xyz[chain], self._layer(f"{name}{end}", 1 if name[0] == "B" else 2))

    def _contours(self, contours: Any) -> None:
        end = self._suffix("CONTOURS")
        for k, (start, stop) in enumerate(pairwise(contours.starts.tolist())):
            points = contours.points[start:stop]
            name = "CONTOURS_INDEX" if contours.index[k] else "CONTOURS"
            color = 32 if contours.index[k] else _BROWN
            on = self._layer(f"{name}{end}", color)
            self._polyline(np.column_stack((points, np.full(len(points), contours.level[k]))), on)
        # Labels are written if a text height is given.
        if self._text is None:
            return
        labels = contours.labels(length=4 * self._text, index=bool(contours.index.any()))
        on = self._layer(f"CONTOURS_TEXT{end}", _BROWN)
        for row, text in enumerate(labels.text):
            place = (*labels.points[row].tolist(), float(labels.level[row]))
            turned = on | {"rotation": float(labels.angle[row])}
            made = self._space.add_text(text, height=self._text, dxfattribs=turned)
            made.set_placement(place, align=self._middle)

    def _points(self, points: Any) -> None:
        end = self._suffix("POINTS")
        on, texts = self._layer(f"POINTS{end}", _WHITE), self._layer(f"POINTS_TEXT{end}", _GRAY)
        z = np.zeros(len(points.points)) if points.z is None else points.z
        extent = float(np.ptp(points.points, axis=0).max(initial=0)) if len(z) else 0.0
        size = self._text or extent * _TEXT / 2 or 1.0
        for x, y, height in np.column_stack((points.points, z)).tolist():
            if not all(map(math.isfinite, (x, y, height))):
                raise InputError("a point is not finite: leave out what is NaN first")
            self._space.add_point((x, y, height), dxfattribs=on)
            if points.z is not None:
                self._write(f"{height:.6g}", (x + size / 2, y + size / 2), size, texts)

    def _sections(self, given: Any) -> None:
        end = self._suffix("PROFILE")
        width = given.left + given.right
        heights = [one.z[~np.isnan(one.z)] for one in given.sections]
        spans = [float(np.ptp(z)) * self._factor if len(z) else 0.0 for z in heights]
        size = self._text or width * _TEXT * 2
        # A column, the first station at the top; each has room for its labels.
        y = 0.0
        for k, one in enumerate(given.sections):
            y -= spans[k] + 10 * size
            at = one.distances - given.left
            title = f"{round(float(given.stations[k]), 3):.12g}"
            place = {"origin": (0.0, y), "title": title, "start": -given.left}
            self._profile(at, one.z, one.names, end=end, size=size, **place)

    def _profile(
        self,
        distances: Floats,
        z: Floats,
        names: Sequence[str],
        *,
        end: str,
        origin: tuple[float, float] = (0.0, 0.0),
        title: str | None = None,
        start: float = 0.0,
        size: float | None = None,
    ) -> None:
        """Draw heights over distances, with a frame; the lowest height is at the origin."""
        known = z[~np.isnan(z)]
        if not len(known):
            if title is not None:
                texts = self._layer(f"PROFILE_TEXT{end}", _WHITE)
                self._write(f"{title}: no heights", origin, size or 1.0, texts)
            return
        low, high = float(known.min()), float(known.max())
        length = float(distances[-1]) - start
        size = size or self._text or length * _TEXT or 1.0
        # Height labels must not overlap.
        step = _nice(max((high - low) / _TICKS, 1.6 * size / self._factor))
        base = math.floor(low / step) * step
        for k, name in enumerate(names):
            on = self._layer(_layer_name(f"PROFILE_{name}{end}"), _TURN[k % len(_TURN)])
            for run in _runs(z[:, k]):
                up = origin[1] + (z[run, k] - base) * self._factor
                rows = np.column_stack((origin[0] + distances[run], up)).tolist()
                self._space.add_lwpolyline(rows, dxfattribs=on)
        frame = self._layer(f"PROFILE_FRAME{end}", _GRAY)
        texts = self._layer(f"PROFILE_TEXT{end}", _WHITE)
        left, right = origin[0] + start, origin[0] + float(distances[-1])
        top = origin[1] + (high - base) * self._factor
        corners = [(left, origin[1]), (right, origin[1]), (right, top), (left, top)]
        self._space.add_lwpolyline(corners, close=True, dxfattribs=frame)
        for tick in _ticks(base, high, step):
            y = origin[1] + (tick - base) * self._factor
            self._space.add_line((left - size / 2, y), (left, y), dxfattribs=frame)
            self._write(f"{tick:.10g}", (left - 7 * size, y - size / 2), size, texts)
        for tick in _ticks(start, float(distances[-1]), _nice(length / _TICKS)):
            x = origin[0] + tick
            self._space.add_line((x, origin[1] - size / 2), (x, origin[1]), dxfattribs=frame)
            self._write(f"{tick:.10g}", (x - size, origin[1] - 2 * size), size, texts)
        if title is not None:
            self._write(title, (left, top + size), 1.5 * size, texts)


def chains(edges: Rows) -> Iterator[list[int]]:
    """Yield chains of vertices with each edge once; they end where not exactly two edges meet."""
    beside: dict[int, list[int]] = {}
    for u, v in edges.tolist():
        beside.setdefault(u, []).append(v)
        beside.setdefault(v, []).append(u)
    left = {(min(u, v), max(u, v)) for u, v in edges.tolist()}
    ends = [vertex for vertex, others in beside.items() if len(others) != 2]
    # Chains from ends first, then what is left: rings.
    for vertex in [*ends, *beside]:
        for other in beside[vertex]:
            if (min(vertex, other), max(vertex, other)) not in left:
                continue
            chain = [vertex, other]
            left.remove((min(vertex, other), max(vertex, other)))
            # Each step removes an edge, so this terminates.
            while len(beside[chain[-1]]) == 2 and chain[-1] != vertex:
                a, b = beside[chain[-1]]
                after = b if a == chain[-2] else a
                left.remove((min(chain[-1], after), max(chain[-1], after)))
                chain.append(after)
            yield chain


def _runs(z: Floats) -> list[NDArray[np.int64]]:
    """Return the rows of each part between gaps that has at least two points."""
    rows = np.split(np.arange(len(z)), np.flatnonzero(np.isnan(z)))
    found = [part[~np.isnan(z[part])] for part in rows]
    return [part for part in found if len(part) > 1]


def _layer_name(name: str) -> str:
    """Return a name that CAD programs accept."""
    return "".join("_" if each in "<>/\\\":;?*|=',`" else each for each in name)[:255]


def _nice(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, at least as large as a step."""
    if not step > 0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(step))
    return next((k * power for k in (1, 2, 5) if k * power >= step), 10 * power)


def _ticks(low: float, high: float, step: float) -> list[float]:
    """Return the multiples of a step from one number to another."""
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(k * step, 12) for k in range(first, last + 1)]
