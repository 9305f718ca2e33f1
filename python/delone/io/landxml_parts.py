"""The elements of a LandXML surface: numbers, points, faces, lines and units."""

from __future__ import annotations

import re
import sys
from array import array
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.units import as_units
from delone.errors import FileFormatError, InputError
from delone.io.surfacefile import SurfaceFile

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["ORDERS", "Draft", "Head"]

# The positions of x and y among the first two numbers of a point.
ORDERS = {"nez": (1, 0), "enz": (0, 1)}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_POINT = re.compile(r"\s*{0}\s+{0}\s+{0}\s*".format(f"({_NUMBER.pattern.replace('(', '(?:')})"))
_EPSG = re.compile(r"\d{1,6}")
# Lines by the element around them: breaklines, contours, boundaries, and points.
_AROUND = ("Breakline", "Contour", "Boundary", "DataPoints", "Chain", "Watershed")
# Elements of a surface that are counted, not read.
_LEFT_OUT = ("RetWall", "PointFile")
_HOLES = ("void", "hole", "hide", "inner")


class Head:
    """What the file declares before the surfaces: units and reference system."""

    def __init__(self, source: str, order: tuple[int, int]) -> None:
        self.source, self.order = source, order
        self.lengths: str | None = None
        self.units: str | None = None
        self.crs: str | None = None

    def begin(self, tag: str, element: Any) -> None:
        """Record an element."""
        if tag in ("Metric", "Imperial"):
            self.lengths = self._unit(element, "linearUnit")
            self.units = self._unit(element, "elevationUnit") or self.lengths
        elif tag == "CoordinateSystem" and self.crs is None:
            code = (element.get("epsgCode") or "").strip().upper().removeprefix("EPSG:")
            wkt = (element.get("ogcWktCode") or "").strip()
            if code and not _EPSG.fullmatch(code):
                raise self.fault(element, f"epsgCode {code!r:.40} is not a number")
            self.crs = f"EPSG:{int(code)}" if code and int(code) else wkt or None

    def _unit(self, element: Any, name: str) -> str | None:
        value = element.get(name)
        try:
            return as_units(value, name=name)
        except InputError as error:
            raise self.fault(element, str(error)) from error

    def fault(self, element: Any, what: str) -> FileFormatError:
        """Return an error that names the line of an element."""
        return FileFormatError(f"{self.source}, line {element.sourceline}: {what}")

    def numbers(self, element: Any, width: int) -> Floats:
        """Return the numbers of an element as rows (k, 3): x, y and height, NaN without one."""
        words = (element.text or "").split()
        for word in words:
            if not _NUMBER.fullmatch(word):
                raise self.fault(element, f"{word!r:.40} is not a finite number")
        if not words or len(words) % width:
            raise self.fault(
                element, f"{width} numbers for each point are needed, got {len(words)} numbers"
            )
        values = np.array(words, dtype=np.float64).reshape(-1, width)
        if not np.isfinite(values).all():
            raise self.fault(element, "a number is beyond the range of doubles")
        rows = np.full((len(values), 3), np.nan)
        rows[:, :2] = values[:, self.order]
        if width == 3:
            rows[:, 2] = values[:, 2]
        return rows


class Draft:
    """A surface while it is being read."""

    def __init__(self, head: Head, name: str | None, line: int) -> None:
        self.head, self.name, self.line = head, name, line
        self._coordinates, self._rows = array("d"), dict[str, int]()
        self._faces, self._pending = array("q"), list[tuple[int, str, int]]()
        self._lines: dict[str, list[Floats]] = {}
        self._has_faces = self._is_grid = False
        self._around: Any = None
        self._kind = ""
        self._left_out = Counter[str]()
        self._quads = 0

    def begin(self, tag: str, element: Any) -> None:
        """Record the beginning of an element."""
        if tag in _AROUND:
            self._around, self._kind = element, tag
            wall = (element.get("brkType") or "").strip().casefold() == "wall"
            if tag == "Breakline" and (wall or element.get("brkWallHt") is not None):
                # The lower line of a wall is read, because a surface has one height at each place.
                self._left_out["upper line of a wall"] += 1
        elif tag in _LEFT_OUT:
            self._left_out[tag] += 1
        elif tag == "Definition":
            self._is_grid = (element.get("surfType") or "TIN").casefold() == "grid"

    def end(self, tag: str, element: Any) -> None:
        """Read an element at its end."""
        if tag == "P":
            self._point(element)
        elif tag == "F":
            self._face(element)
        else:
            rows = self.head.numbers(element, 2 if tag == "PntList2D" else 3)
            self._line(element, rows)

    def _point(self, element: Any) -> None:
        name = (element.get("id") or "").strip()
        if not name:
            raise self.head.fault(element, "this point has no id")
        if name in self._rows:
            raise self.head.fault(element, f"a second point has the id {name!r:.40}")
        if len(element):
            raise self.head.fault(element, f"point {name!r:.40} contains another element")
        three = _POINT.fullmatch(element.text or "")
        given = [float(word) for word in three.groups()] if three else []
        if given and max(map(abs, given)) <= sys.float_info.max:
            i, j = self.head.order
            self._coordinates.extend((given[i], given[j], given[2]))
        else:
            # The error, or a separator that is not plain white space.
            found = self.head.numbers(element, 3)
            if len(found) > 1:
                message = f"point {name!r:.40} has {found.size} numbers, not 3"
                raise self.head.fault(element, message)
            self._coordinates.extend(found[0].tolist())
        self._rows[name] = len(self._rows)

    def _face(self, element: Any) -> None:
        names = (element.text or "").split()
        if len(names) not in (3, 4):
            raise self.head.fault(
                element,
                f"a face has three points, or four in a grid, got {(element.text or '')!r:.60}",
            )
        self._has_faces = True
        if (element.get("i") or "0").strip() in ("1", "true"):
            return
        if (element.get("b") or "0").strip().strip("0 "):
            self._left_out["mark of breaklines (b) of a face"] += 1
        if len(names) == 4:
            self._quads += 1
            names = [names[k] for k in (0, 1, 2, 0, 2, 3)]
        rows = [self._rows.get(name, -1) for name in names]
        if -1 in rows:  # points may follow
            self._pending += [
                (len(self._faces) + place, name, element.sourceline)
                for place, (name, row) in enumerate(zip(names, rows, strict=True))
                if row < 0
            ]
        self._faces.extend(rows)

    def _triangles(self) -> NDArray[np.int64]:
        """Return the faces, each once, without those that repeat a corner."""
        faces = np.array(self._faces, dtype=np.int64).reshape(-1, 3)
        ordered = np.sort(faces, axis=1)
        flat = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
        _, first = np.unique(ordered, axis=0, return_index=True)
        kept = np.zeros(len(faces), dtype=bool)
        kept[first] = True
        self._left_out["face that repeats a corner"] += int(flat.sum())
        self._left_out["repeated face"] += int((~kept & ~flat).sum())
        found: NDArray[np.int64] = faces[kept & ~flat]
        return found

    def _line(self, element: Any, rows: Floats) -> None:
        around = self._around
        if around is None or self._kind in ("Chain", "Watershed"):
            self._left_out[self._kind or "list of points"] += 1
            return
        kind = self._kind
        if kind == "Boundary":
            given = (around.get("bndType") or "outer").strip().casefold()
            kind = "Hole" if given in _HOLES else "Island" if given == "island" else "Boundary"
        elif kind == "Breakline" and (around.get("desc") or "").strip() == "soft":
            kind = "Contour"
        elif kind == "Contour" and around.get("elev") is not None:
            level = around.get("elev").strip()
            if not _NUMBER.fullmatch(level):
                raise self.head.fault(around, f"elev {level!r:.40} is not a finite number")
            rows[:, 2] = float(level)
        if kind == "DataPoints" and np.isnan(rows[:, 2]).any():
            raise self.head.fault(element, "points of DataPoints have no heights")
        self._lines.setdefault(kind, []).append(rows)

    def finished(self) -> SurfaceFile:
        """Return the surface."""
        head = self.head
        if self._is_grid and not self._has_faces:
            raise FileFormatError(
                f"{head.source}, line {self.line}: {self.name!r:.60} is a grid without faces"
            )
        for place, name, line in self._pending:
            if name not in self._rows:
                raise FileFormatError(
                    f"{head.source}, line {line}: a face refers to point {name!r:.40}, which the "
                    "surface does not have"
                )
            self._faces[place] = self._rows[name]
        points = np.array(self._coordinates, dtype=np.float64).reshape(-1, 3)
        faces = self._triangles()
        if self._has_faces and not len(faces):
            raise FileFormatError(
                f"{head.source}, line {self.line}: all faces of surface {self.name!r:.80} are "
                "invisible, or repeat a corner"
            )
        measured = self._lines.get("DataPoints", ())
        if len(faces):
            self._left_out["DataPoints beside faces"] += sum(map(len, measured))
        else:
            points = np.concatenate((points, *measured))
        return SurfaceFile(
            points=points,
            faces=faces.astype(np.int32),
            breaklines=tuple(self._lines.get("Breakline", ())),
            soft_breaklines=tuple(self._lines.get("Contour", ())),
            boundary=tuple(self._lines.get("Boundary", ())),
            holes=tuple(self._lines.get("Hole", ())),
            islands=tuple(self._lines.get("Island", ())),
            units=head.units,
            lengths=head.lengths,
            crs=head.crs,
            name=self.name,
            source=head.source,
            left_out=dict(+self._left_out),
            quads=self._quads,
        )
