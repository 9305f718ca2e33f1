"""Survey points (CgPoints) and alignments in LandXML; curves and spirals become chords.

Alignments are in plan: they consist of lines, arcs, clothoids and irregular lines, each of which
begins where the previous one ends.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.errors import FileFormatError
from delone.io.landxml_parts import ORDERS, Head

if TYPE_CHECKING:
    from collections.abc import Iterable

    from delone._base.types import Floats

__all__ = ["Alignment", "Survey"]

# The maximum number of chords that the curves of a file may become.
_CHORDS = 1 << 22
# The default distance of chords from a curve, as a fraction of the radius.
_RELATIVE = 1e-3
# Programs write millimeters, rarely more digits: elements that are farther apart leave a gap.
_GAP = 0.01
# Redundant data, such as a radius and a center, may differ by this fraction of the radius.
_SAME = 1e-3
_ELEMENTS = ("Line", "Curve", "Spiral", "IrregularLine", "Chain")
# The parts of alignments that are not read.
_LEFT_OUT = ("StaEquation", "Profile", "CrossSects", "Superelevation")
_ELSEWHERE = ("Parcel", "PlanFeature", "Roadway", "PipeNetwork")
# Gauss-Legendre points and weights: exact up to rounding for chords of spirals.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


class Alignment(NamedTuple):
    """An alignment: its name, the station of its start, and its line, (k, 2)."""

    name: str
    start: float
    line: Floats


class _Element(NamedTuple):
    """An element of an alignment: its attributes, and positions or names of its points, by tag."""

    tag: str
    given: dict[str, str]
    places: dict[str, Floats | str]
    line: int


class Survey:
    """Points and alignments while they are being read."""

    def __init__(self, source: str, order: str = "nez") -> None:
        self.head = Head(source, ORDERS[order])
        self.left_out = Counter[str]()
        self._points: dict[str, Floats] = {}
        self._rows: list[tuple[Floats, str, str, str]] = []
        self._drafts: list[tuple[str, float, list[_Element]]] = []
        self._elements: list[_Element] | None = None
        self._places: dict[str, Floats | str] = {}
        self._surface = self._others = 0

    def begin(self, tag: str, element: Any) -> None:
        """Take note of an element that begins."""
        if tag == "Surface":
            self._surface += 1
        elif tag in _ELSEWHERE:
            self._others += 1
            self.left_out[tag] += 1
        elif self._surface or self._others:
            return
        elif tag == "Alignment":
            self._elements = []
            start = (element.get("staStart") or "0").strip()
            name = (element.get("name") or "").strip()
            self._drafts.append((name, self._number(element, start, "staStart"), self._elements))
        elif self._elements is None:
            self.head.begin(tag, element)
        elif tag in _ELEMENTS:
            self._places = {}
        elif tag in _LEFT_OUT:
            self.left_out[f"{tag} of an alignment"] += 1

    def end(self, tag: str, element: Any) -> None:
        """Read an element that ends."""
        if tag == "Surface":
            self._surface -= 1
        elif tag in _ELSEWHERE:
            self._others -= 1
        elif self._surface or self._others:
            return
        elif tag == "CgPoint":
            self._point(element)
        elif tag == "Alignment":
            self._elements = None
        elif self._elements is not None and tag in ("Start", "End", "Center", "PI"):
            reference = (element.get("pntRef") or "").strip()
            self._places[tag] = reference or self._place(element)
        elif self._elements is not None and tag in ("PntList2D", "PntList3D"):
            self._places["points"] = self.head.numbers(element, int(tag[-2]))
        elif self._elements is not None and tag in _ELEMENTS:
            given = {str(name): str(value) for name, value in element.attrib.items()}
            self._elements.append(_Element(tag, given, self._places, element.sourceline))

    def _place(self, element: Any) -> Floats:
        """Return the numbers of a point: two or three."""
        width = len((element.text or "").split())
        rows = self.head.numbers(element, 3 if width == 3 else 2)
        if len(rows) != 1:
            raise self.head.fault(element, f"a point has two or three numbers, got {width}")
        place: Floats = rows[0]
        return place

    def _number(self, element: Any, text: str, name: str) -> float:
        try:
            found = float(text)
        except ValueError:
            found = math.nan
        if not math.isfinite(found):
            raise self.head.fault(element, f"{name} {text!r:.40} is not a finite number")
        return found

    def _point(self, element: Any) -> None:
        name = (element.get("name") or "").strip()
        if not (element.text or "").strip() and element.get("pntRef"):
            self.left_out["CgPoint that refers to another"] += 1
            return
        place = self._place(element)
        known = self._points.get(name)
        if name and known is not None:
            if not np.array_equal(known, place, equal_nan=True):
                raise self.head.fault(
                    element, f"a second CgPoint has the name {name!r:.40} and other coordinates"
                )
            self.left_out["repeated CgPoint"] += 1
            return
        self._points[name] = place
        code, said = ((element.get(each) or "").strip() for each in ("code", "desc"))
        self._rows.append((place, name, code, said))

    @property
    def has_points(self) -> bool:
        """Whether there are points."""
        return bool(self._rows)

    @property
    def names(self) -> list[str]:
        """The names of the alignments."""
        return [name for name, *_ in self._drafts]

    def points(self) -> tuple[Floats, dict[str, Any]]:
        """Return points, (n, 3), NaN for missing heights, and their name, code and desc."""
        places = np.array([place for place, *_ in self._rows]).reshape(-1, 3)
        words = zip(*(words for _, *words in self._rows), strict=True)
        columns = [np.array(column, dtype=object) for column in words] or [np.empty(0, object)] * 3
        return places, dict(zip(("name", "code", "desc"), columns, strict=True))

    def alignments(self, chord: float | None, name: str | None = None) -> list[Alignment]:
        """Return the alignments, by default all."""
        budget = _CHORDS
        found = []
        for own, start, elements in self._drafts:
            if name is not None and own != name:
                continue
            parts = []
            for element in elements:
                # Coordinates near the limit of doubles overflow, and the result is rejected.
                with np.errstate(over="ignore", invalid="ignore"):
                    parts.append(self._part(element, chord, budget))
                budget -= len(parts[-1])
            if not parts:
                self.left_out["alignment without a line in plan"] += 1
                continue
            found.append(Alignment(own, start, self._joined(parts, elements, own)))
        return found

    def _joined(self, parts: list[Floats], elements: Iterable[_Element], name: str) -> Floats:
        """Join the elements of an alignment."""
        rows = [parts[0]]
        for part, element in zip(parts[1:], list(elements)[1:], strict=True):
            with np.errstate(over="ignore"):
                gap = float(np.hypot(*(part[0] - rows[-1][-1])))
            if not gap <= _GAP:
                raise self._fault(
                    element,
                    f"alignment {name!r:.40} has a gap of {gap:.6g} before this {element.tag}",
                )
            rows.append(part[1:])
        return np.concatenate(rows)

    def _fault(self, element: _Element, what: str) -> FileFormatError:
        return FileFormatError(f"{self.head.source}, line {element.line}: {what}")

    def _at(self, element: _Element, tag: str) -> Floats:
        """Return a position of an element, (2,)."""
        place = element.places.get(tag)
        if isinstance(place, str):
            if place not in self._points:
                raise self._fault(element, f"there is no CgPoint {place!r:.40}")
            place = self._points[place]
        if place is None:
            raise self._fault(element, f"this {element.tag} has no {tag}")
        return place[:2]

    def _part(self, element: _Element, chord: float | None, budget: int) -> Floats:
        """Return the points of an element, (k, 2)."""
        if element.tag == "Line":
            return np.array([self._at(element, "Start"), self._at(element, "End")])
        if element.tag == "Curve":
            return self._arc(element, chord, budget)
        if element.tag == "Spiral":
            return self._clothoid(element, chord, budget)
        listed = element.places.get("points")
        if element.tag == "Chain" or listed is None or isinstance(listed, str):
            raise self._fault(element, f"a {element.tag} without a list of points is not read")
        return listed[:, :2]

    def _sense(self, element: _Element) -> float:
        rotation = element.given.get("rot", "").strip().casefold()
        if rotation not in ("cw", "ccw"):
            raise self._fault(element, f"rot must be cw or ccw, got {rotation!r:.40}")
        return 1.0 if rotation == "ccw" else -1.0

    def _arc(self, element: _Element, chord: float | None, budget: int) -> Floats:
        if element.given.get("crvType", "arc").strip().casefold() != "arc":
            raise self._fault(element, "curves other than arcs are not read")
        start, end, center = (self._at(element, tag) for tag in ("Start", "End", "Center"))
        sense, radii = self._sense(element), [np.hypot(*(p - center)) for p in (start, end)]
        radius = float(max(radii))
        if not abs(radii[0] - radii[1]) <= _SAME * radius or not 0 < radius < math.inf:
            raise self._fault(
                element, "the start and the end of this arc are not equally far from its center"
            )
        first, last = (math.atan2(*(p - center)[::-1]) for p in (start, end))
        turn = sense * (last - first) % (2 * math.pi) or 2 * math.pi
        far = min(_RELATIVE * radius if chord is None else chord, radius)
        # The sagitta of a chord over an angle is radius (1 - cos(angle / 2)).
        step = 4 * math.asin(math.sqrt(far / (2 * radius)))
        count = self._count(element, turn, step, budget)
        angles = first + sense * turn * np.arange(1, count) / count
        between = center + radius * np.column_stack((np.cos(angles), np.sin(angles)))
        return np.vstack((start, between, end))

    def _clothoid(self, element: _Element, chord: float | None, budget: int) -> Floats:
        kind = element.given.get("spiType", "clothoid").strip()
        if kind.casefold() != "clothoid":
            raise self._fault(element, f"spirals of the type {kind!r:.40} are not read")
        start, end, corner = (self._at(element, tag) for tag in ("Start", "End", "PI"))
        length = self._positive(element, "length")
        bends = [1 / self._positive(element, f"radius{each}") for each in ("Start", "End")]
        if not 0 < max(bends) < math.inf or (start == corner).all():
            raise self._fault(element, "this spiral has no direction, or no radius")
        sense, radius = self._sense(element), 1 / max(bends)
        far = min(_RELATIVE * radius if chord is None else chord, radius)
        # A chord of length l is about l^2 / (8 radius) away from the curve.
        count = self._count(element, length, math.sqrt(8 * radius * far), budget)
        heading = math.atan2(*(corner - start)[::-1])
        ends = length * np.arange(count + 1) / count
        along = (ends[:-1, None] + ends[1:, None]) / 2 + _NODES * length / count / 2
        angles = heading + sense * (
            bends[0] * along + (bends[1] - bends[0]) * along**2 / (2 * length)
        )
        steps = [(turn(angles) * _WEIGHTS).sum(axis=1) for turn in (np.cos, np.sin)]
        line = np.zeros((count + 1, 2))
        line[1:] = np.cumsum(np.column_stack(steps) * length / count / 2, axis=0)
        away = end - start - line[-1]
        if not np.hypot(*away) <= max(_GAP, _SAME * length):
            raise self._fault(
                element, f"this spiral does not reach its end by {np.hypot(*away):.6g}"
            )
        # The rounding error of the file is spread along the curve.
        found: Floats = start + line + away * (ends / length)[:, None]
        found[-1] = end
        return found

    def _positive(self, element: _Element, name: str) -> float:
        """Return a length or a radius, which may be infinite."""
        text = element.given.get(name, "").strip()
        try:
            found = float(text)
        except ValueError:
            found = math.nan
        if not found > 0 or (name == "length" and found == math.inf):
            raise self._fault(element, f"{name} of this {element.tag} is {text!r:.40}")
        return found

    def _count(self, element: _Element, whole: float, step: float, budget: int) -> int:
        chords = whole / step if step > 0 else math.inf
        if not chords < budget:
            raise self._fault(
                element, f"curves would become more than {_CHORDS:,} chords: choose a larger chord"
            )
        return max(2, math.ceil(chords))
