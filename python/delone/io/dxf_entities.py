"""The visible entities of a DXF drawing, with blocks expanded, as faces, points and lines.

Entities on hidden layers, and entities that cannot be part of a surface, are counted by type.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import FileFormatError
from delone.io.facets import facet_triangles

if TYPE_CHECKING:
    from collections.abc import Iterator

    from delone._base.types import Floats

__all__ = ["KINDS", "Drawn"]

_CURVES = ("ARC", "CIRCLE", "ELLIPSE", "SPLINE", "HELIX")
KINDS = ("3DFACE", "POINT", "LINE", "LWPOLYLINE", "POLYLINE", "MESH", *_CURVES)
# The number of entities to which blocks may expand; for larger files, one for each 16 bytes.
_ALWAYS, _BYTES = 1 << 18, 16
# The number of chords that curves may become, by the same rule.
_VERTICES = 1 << 22
# The default distance of chords from a curve, as a fraction of its extent.
_RELATIVE = 1e-3
# Vertices of a polyline that are control points of a curve and not drawn.
_FRAME = 16
# Chords within this fraction of the extent of a curve would number a million.
_FINEST = 1e-12
# Corners of a 3DFACE, at most.
_FACE = 4


class Drawn:
    """What a drawing shows: corners of triangles, points, lines, and counts of everything else."""

    def __init__(self, drawing: Any, source: str, size: int, chord: float | None) -> None:
        self.faces: list[Floats] = []
        self.points: list[Floats] = []
        self.lines: list[Floats] = []
        self.left_out = Counter[str]()
        self.curves = self.quads = 0
        self._drawing, self._source, self._chord = drawing, source, chord
        self._left, self._vertices = max(_ALWAYS, size // _BYTES), max(_VERTICES, size)

    def add(self, space: Any, layers: set[str] | None) -> None:
        """Read all entities of a layout on these layers; by default, on all that are not hidden."""
        for entity, layer, hidden in self._expanded(space, "0", False, ()):
            if layers is not None and layer.casefold() not in layers:
                continue
            # A layer that is named is read, hidden or not.
            if (hidden and layers is None) or entity.dxf.get("invisible", 0):
                self.left_out["hidden"] += 1
                continue
            self._take(entity)

    def _expanded(
        self, entities: Any, inherited: str, hidden: bool, blocks: tuple[str, ...]
    ) -> Iterator[tuple[Any, str, bool]]:
        """Yield entities with the layer that they are drawn on, and whether it is hidden."""
        for entity in entities:  # at most as many as the size of the file allows
            self._left -= 1
            if self._left < 0:
                raise FileFormatError(
                    f"{self._source}: its blocks contain far more than its size suggests; explode "
                    f"them first"
                )
            # In blocks, layer 0 is that of the reference.
            own = str(entity.dxf.layer)
            layer = inherited if blocks and own == "0" else own
            if entity.dxftype() != "INSERT":
                yield entity, layer, hidden or self._is_hidden(layer)
                continue
            yield from self._of_block(entity, layer, hidden, blocks)

    def _of_block(
        self, insert: Any, layer: str, hidden: bool, blocks: tuple[str, ...]
    ) -> Iterator[tuple[Any, str, bool]]:
        name = str(insert.dxf.name)
        block = insert.block()
        if block is None or block.block.is_xref or block.block.is_xref_overlay:
            self.left_out["external reference" if block is not None else "INSERT"] += 1
            return
        if name.casefold() in blocks:
            raise FileFormatError(f"{self._source}: block {name!r:.40} contains itself")
        self.left_out["ATTRIB"] += len(insert.attribs)
        # A layer that is off hides only its own entities; a frozen one hides the whole block.
        gone = hidden or self._is_hidden(layer, frozen=True) or bool(insert.dxf.get("invisible", 0))
        inner = (*blocks, name.casefold())

        def skipped(entity: Any, _: str) -> None:
            self.left_out[entity.dxftype()] += 1

        if insert.mcount > max(self._left, 1):
            raise FileFormatError(
                f"{self._source}: {_named(insert)} repeats block {name!r:.40} {insert.mcount} times"
            )
        # Their number is within what is left, which was just compared.
        for one in insert.multi_insert() if insert.mcount > 1 else (insert,):
            found = one.virtual_entities(skipped_entity_callback=skipped)
            yield from self._expanded(found, layer, gone, inner)

    def _is_hidden(self, name: str, *, frozen: bool = False) -> bool:
        layers = self._drawing.layers
        if not layers.has_entry(name):
            return False
        layer = layers.get(name)
        return bool(layer.is_frozen() or (not frozen and layer.is_off()))

    def _take(self, entity: Any) -> None:
        """Store an entity according to its type."""
        kind = entity.dxftype()
        if kind == "3DFACE":
            self._take_face([tuple(each) for each in entity.wcs_vertices()])
        elif kind == "POINT":
            self.points.append(self._rows([entity.dxf.location], entity))
        elif kind == "LINE":
            self.lines.append(self._rows([entity.dxf.start, entity.dxf.end], entity))
        elif kind == "MESH" or (kind == "POLYLINE" and _is_mesh(entity)):
            self._take_mesh(entity)
        elif kind in _CURVES:
            self.lines.append(self._chords(entity))
        elif kind in ("LWPOLYLINE", "POLYLINE") and entity.has_arc:
            self.lines.append(self._bulges(entity))
        elif kind == "LWPOLYLINE":
            self.lines.append(self._closed(list(entity.vertices_in_wcs()), entity.closed, entity))
        elif kind == "POLYLINE":
            places = [
                place
                for place, vertex in zip(entity.points_in_wcs(), entity.vertices, strict=True)
                if not vertex.dxf.flags & _FRAME
            ]
            self.lines.append(self._closed(places, entity.is_closed, entity))
        else:
            self.left_out[kind] += 1

    def _take_face(self, corners: list[tuple[float, ...]]) -> None:
        found = _triangles(corners)
        self.quads += len(found) == 2
        self.faces += found

    def _take_mesh(self, entity: Any) -> None:
        """Read the triangles of a MESH, a polyface or a polygon mesh."""
        builder = require("ezdxf.render", extra="dxf", what="reading DXF").MeshBuilder
        made = builder.from_mesh(entity) if entity.dxftype() == "MESH" else None
        if made is None:
            made = builder.from_polyface(entity)
        elif entity.dxf.get("subdivision_levels", 0):
            self.left_out["smoothing of a MESH"] += 1
        points = self._rows(list(made.vertices), entity)
        for face in made.faces:
            rows = list(face)
            if not all(0 <= row < len(points) for row in rows):
                raise FileFormatError(f"{self._source}: {_named(entity)} has no such vertex")
            corners = list(dict.fromkeys(map(tuple, points[rows].tolist())))
            if len(corners) <= _FACE:
                self._take_face(corners)
                continue
            places = np.array(corners)
            polygon = [list(range(len(places)))]
            made_of = facet_triangles(places, polygon, np.empty((0, 3)), self._source)
            self.faces += [places[triangle] for triangle in made_of]

    def _chords(self, entity: Any) -> Floats:
        """Return a curve as chords within the given distance of it."""
        self.curves += 1
        kind = entity.dxftype()
        if kind in ("ARC", "CIRCLE"):
            radius = abs(float(entity.dxf.radius))
            # A circle needs at least three chords.
            chord, extent = self._distance(radius, entity), radius
            chord = min(chord, radius / 2)
        else:
            tool = entity.construction_tool()
            control = (
                [entity.dxf.major_axis, (0, 0, 0)] if kind == "ELLIPSE" else tool.control_points
            )
            extent = float(np.ptp(self._rows(list(control), entity), axis=0).max())
            chord = self._distance(extent, entity)
        if not extent:
            return np.empty((0, 3))
        places = list(self._counted(entity.flattening(chord), entity))
        rows = self._rows(places, entity)
        if kind == "CIRCLE" or (kind == "SPLINE" and entity.closed) or _is_whole(entity):
            rows[-1] = rows[0]
        return rows

    def _distance(self, extent: float, entity: Any) -> float:
        chord = _RELATIVE * extent if self._chord is None else self._chord
        if chord < _FINEST * extent:
            raise FileFormatError(
                f"{self._source}: {_named(entity)} has too many chords within {chord:g}; give a "
                "larger chord="
            )
        return chord

    def _counted(self, places: Any, entity: Any) -> Iterator[Any]:
        """Yield places, at most as many as the size of the file allows."""
        for place in places:
            self._vertices -= 1
            if self._vertices < 0:
                raise FileFormatError(
                    f"{self._source}: {_named(entity)} has too many chords; give a larger chord="
                )
            yield place

    def _bulges(self, entity: Any) -> Floats:
        """Return a polyline whose arcs become chords; its vertices stay where they are."""
        self.curves += 1
        math = require("ezdxf.math", extra="dxf", what="reading DXF")
        if entity.dxftype() == "LWPOLYLINE":
            corners = [tuple(row) for row in entity.get_points("xyb")]
            closed, height = entity.closed, float(entity.dxf.elevation)
        else:
            corners = [
                (each.dxf.location.x, each.dxf.location.y, each.dxf.get("bulge", 0.0))
                for each in entity.vertices
            ]
            closed, height = entity.is_closed, float(entity.dxf.elevation.z)
        self._rows(corners, entity)
        places = [(x, y, height) for x, y, _ in corners[:1]]
        for (x, y, bulge), end in zip(corners, corners[1:] + corners[:1] * closed, strict=False):
            if bulge and (x, y) != end[:2]:
                center, first, last, radius = math.bulge_to_arc((x, y), end[:2], bulge)
                chord = min(self._distance(radius, entity), radius / 2)
                angle = 4 * abs(np.arctan(bulge))
                count = math.arc_segment_count(radius, angle, chord)
                turned = np.arange(1, count) / count * (angle if bulge > 0 else -angle)
                turned += first if bulge > 0 else last
                around = zip(np.cos(turned).tolist(), np.sin(turned).tolist(), strict=True)
                places += [
                    (center.x + radius * c, center.y + radius * s, height)
                    for c, s in self._counted(around, entity)
                ]
            places.append((*end[:2], height))
        return self._rows(list(entity.ocs().points_to_wcs(map(math.Vec3, places))), entity)

    def _closed(self, places: list[Any], closed: bool, entity: Any) -> Floats:
        return self._rows([*places, places[0]] if closed and places else places, entity)

    def _rows(self, places: list[Any], entity: Any) -> Floats:
        found = np.array([tuple(place) for place in places], dtype=np.float64).reshape(-1, 3)
        if not np.isfinite(found).all():
            raise FileFormatError(
                f"{self._source}: {_named(entity)} has a coordinate that is not finite"
            )
        return found


def _named(entity: Any) -> str:
    return f"{entity.dxftype()} {entity.dxf.handle} on layer {entity.dxf.layer!r:.40}"


def _is_whole(entity: Any) -> bool:
    """Whether an ellipse is complete, as ezdxf decides it."""
    if entity.dxftype() != "ELLIPSE":
        return False
    span = float(entity.construction_tool().param_span)
    return bool(np.isclose(span, 2 * np.pi, rtol=1e-9, atol=0))


def _is_mesh(entity: Any) -> bool:
    return bool(entity.is_poly_face_mesh or entity.is_polygon_mesh)


def _triangles(corners: list[tuple[float, ...]]) -> list[Floats]:
    """The one or two triangles of a face; a fourth corner that repeats another does not count."""
    distinct = list(dict.fromkeys(corners))
    if len(distinct) < 3:
        return []
    found = [np.array(distinct[:3], dtype=np.float64)]
    if len(distinct) == 4:
        found.append(np.array([distinct[0], *distinct[2:]], dtype=np.float64))
    return found
