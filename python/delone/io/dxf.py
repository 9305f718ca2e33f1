"""DXF drawings: faces, points and lines of the model space, with ezdxf (extra ``dxf``).

Blocks and references to other drawings are not followed.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError
from delone.extras import require
from delone.io.surfacefile import SurfaceFile

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone.io.geometryset import GeometrySet
    from delone.io.pointset import PointSet

    Floats = NDArray[np.float64]

__all__ = ["read_geometries", "read_points", "read_surface"]

# $INSUNITS.
_UNITS = {1: "in", 2: "ft", 3: "mi", 4: "mm", 5: "cm", 6: "m", 7: "km", 21: "us-ft"}
_KINDS = ("3DFACE", "POINT", "LINE", "LWPOLYLINE", "POLYLINE")
_SHOWN = 20


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str], layer: str | None
) -> PointSet:
    """Read the points of a drawing; see `delone.io.read_points`."""
    _refuse_columns(path, columns, attributes)
    return read_surface(path, name=layer, order="enz").as_points()


def read_geometries(
    path: Path, *, columns: Sequence[str | int] | None, layer: str | None
) -> GeometrySet:
    """Read the lines of a drawing; see `delone.io.read_geometries`."""
    _refuse_columns(path, columns, ())
    return read_surface(path, name=layer, order="enz").as_geometries()


def _refuse_columns(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> None:
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: points of DXF have x, y and z, and no other columns")


def read_surface(path: Path, *, name: str | None, order: str) -> SurfaceFile:
    """Read faces, points and lines; `name` has layers, separated by commas."""
    if order != "enz":
        raise FileFormatError(f"{path}: DXF files have the easting first; order is for LandXML")
    drawing = _drawing(path)
    space = drawing.modelspace()
    layers = _layers(space, name, str(path))
    faces: list[Floats] = []
    points: list[Floats] = []
    lines: list[Floats] = []
    others = Counter[str]()
    for entity in space:
        if layers is not None and entity.dxf.layer.casefold() not in layers:
            continue
        kind = entity.dxftype()
        if kind == "3DFACE":
            faces += _triangles(entity)
        elif kind == "POINT":
            points.append(_rows([entity.dxf.location], entity, path))
        elif kind in _KINDS and not _is_mesh(entity):
            lines.append(_rows(_vertices(entity, path), entity, path))
        else:
            others[kind] += 1
    if not (faces or points or lines):
        found = ", ".join(f"{count} {kind}" for kind, count in others.most_common(_SHOWN))
        raise FileFormatError(
            f"{path} contains none of {', '.join(_KINDS)} in its model space"
            + (f", only {found}: explode them first" if found else "")
        )
    unit = _UNITS.get(int(drawing.header.get("$INSUNITS", 0) or 0))
    corners, rows = _joined(faces, path)
    return SurfaceFile(
        points=corners if faces else np.concatenate((np.empty((0, 3)), *points)),
        faces=rows,
        breaklines=tuple(line for line in lines if len(line) > 1),
        units=unit,
        lengths=unit,
        name=name,
        source=str(path),
    )


def _drawing(path: Path) -> Any:
    ezdxf = require("ezdxf", extra="dxf", what="reading DXF")
    try:
        return ezdxf.readfile(path)
    except (FileNotFoundError, PermissionError, MemoryError):
        raise
    # Libraries answer garbage with errors of many types.
    except Exception as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise FileFormatError(f"{path} cannot be read as DXF: {reason}") from error


def _layers(space: Any, name: str | None, source: str) -> set[str] | None:
    """The layers to be read, in lower case; None for all."""
    if name is None:
        return None
    known = sorted({entity.dxf.layer for entity in space})
    folded = {each.casefold() for each in known}
    wanted = [name] if name.casefold() in folded else [part.strip() for part in name.split(",")]
    missing = [each for each in wanted if each.casefold() not in folded]
    if missing:
        shown = ", ".join(known[:_SHOWN]) + (", ..." if len(known) > _SHOWN else "")
        raise FileFormatError(
            f"{source} has nothing on layer {missing[0]!r}; its layers are {shown or 'none'}"
        )
    return {each.casefold() for each in wanted}


def _is_mesh(entity: Any) -> bool:
    return entity.dxftype() == "POLYLINE" and bool(
        entity.is_poly_face_mesh or entity.is_polygon_mesh
    )


def _triangles(entity: Any) -> list[Floats]:
    """The one or two triangles of a 3DFACE; a fourth corner that repeats one is none."""
    corners = [tuple(each) for each in entity.wcs_vertices()]
    distinct = list(dict.fromkeys(corners))
    if len(distinct) < 3:
        return []
    found = [np.array(distinct[:3], dtype=np.float64)]
    if len(distinct) == 4:
        found.append(np.array([distinct[0], *distinct[2:]], dtype=np.float64))
    return found


def _vertices(entity: Any, path: Path) -> list[Any]:
    kind = entity.dxftype()
    if kind == "LINE":
        return [entity.dxf.start, entity.dxf.end]
    if kind == "LWPOLYLINE":
        bent = any(bulge for *_, bulge in entity.get_points("xyb"))
        found = list(entity.vertices_in_wcs())
        closed = entity.closed
    else:
        bent = entity.has_arc
        found = list(entity.points_in_wcs())
        closed = entity.is_closed
    if bent:
        raise FileFormatError(
            f"{path}: {_named(entity)} has arcs (bulges): replace them by straight segments"
        )
    if closed and found:
        found.append(found[0])
    return found


def _rows(places: list[Any], entity: Any, path: Path) -> Floats:
    found = np.array([tuple(place) for place in places], dtype=np.float64).reshape(-1, 3)
    if not np.isfinite(found).all():
        raise FileFormatError(f"{path}: {_named(entity)} has a coordinate that is not finite")
    return found


def _named(entity: Any) -> str:
    return f"{entity.dxftype()} {entity.dxf.handle} on layer {entity.dxf.layer!r:.40}"


def _joined(faces: list[Floats], path: Path) -> tuple[Floats, NDArray[np.int32]]:
    """Distinct corners in the order of the file, and the faces as their rows."""
    if not faces:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int32)
    corners = np.concatenate(faces)
    if not np.isfinite(corners).all():
        raise FileFormatError(f"{path}: a 3DFACE has a coordinate that is not finite")
    row: dict[tuple[float, ...], int] = {}
    rows = [row.setdefault(tuple(corner), len(row)) for corner in corners.tolist()]
    return np.array(list(row)), np.array(rows, dtype=np.int32).reshape(-1, 3)
