"""DXF drawings: faces, points and lines of the model space, with ezdxf (extra ``dxf``).

Blocks are expanded, curves become chords, hidden layers are left out. References to other drawings
are not followed.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import DeloneError, FileFormatError
from delone.io.dxf_entities import KINDS, Drawn
from delone.io.surfacefile import SurfaceFile

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats
    from delone.io.geometryset import GeometrySet
    from delone.io.pointset import PointSet

__all__ = ["read_geometries", "read_points", "read_surface"]

# $INSUNITS.
_UNITS = {1: "in", 2: "ft", 3: "mi", 4: "mm", 5: "cm", 6: "m", 7: "km", 21: "us-ft"}
_SHOWN = 20


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    layer: str | None,
    chord: float | None = None,
) -> PointSet:
    """Read the points of a drawing; see `delone.io.read_points`."""
    _refuse_columns(path, columns, attributes)
    found = read_surface(path, name=layer, order="enz", chord=chord)
    found.warn_left_out()
    return found.as_points()


def read_geometries(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
    chord: float | None = None,
) -> GeometrySet:
    """Read the lines of a drawing; see `delone.io.read_geometries`."""
    _refuse_columns(path, columns, attributes)
    found = read_surface(path, name=layer, order="enz", chord=chord)
    found.warn_left_out()
    return found.as_geometries()


def _refuse_columns(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> None:
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: points of DXF have x, y and z, and no other columns")


def read_surface(
    path: Path, *, name: str | None, order: str, chord: float | None = None
) -> SurfaceFile:
    """Read faces, points and lines; `name` contains layers, separated by commas."""
    if order != "enz":
        raise FileFormatError(f"{path}: DXF files have the easting first; order is for LandXML")
    drawing = _drawing(path)
    space = drawing.modelspace()
    drawn = Drawn(drawing, str(path), path.stat().st_size, chord)
    layers = _layers(drawing, space, name, str(path))
    try:
        drawn.add(space, layers)
    except (DeloneError, MemoryError):
        raise
    # Libraries answer entities that are wrong with errors of many types.
    except Exception as error:
        reason = str(error).partition("\n")[0] or type(error).__name__
        raise FileFormatError(f"{path} has an entity that cannot be read: {reason:.100}") from error
    if not (drawn.faces or drawn.points or drawn.lines):
        found = _listed(drawn.left_out)
        raise FileFormatError(
            f"{path} contains none of {', '.join(KINDS)} in its model space"
            + (f", only {found}" if found else "")
        )
    unit = _UNITS.get(int(drawing.header.get("$INSUNITS", 0) or 0))
    corners, rows = _joined(drawn.faces, path)
    if drawn.faces and drawn.points:
        drawn.left_out["POINT beside faces"] += len(drawn.points)
    return SurfaceFile(
        points=corners if drawn.faces else np.concatenate((np.empty((0, 3)), *drawn.points)),
        faces=rows,
        breaklines=tuple(line for line in drawn.lines if len(line) > 1),
        units=unit,
        lengths=unit,
        name=name,
        source=str(path),
        left_out=dict(+drawn.left_out),
        curves=drawn.curves,
        quads=drawn.quads,
    )


def _listed(counts: Counter[str]) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in counts.most_common(_SHOWN) if count)


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


def _layers(drawing: Any, space: Any, name: str | None, source: str) -> set[str] | None:
    """The layers to read, in lower case; None for all."""
    if name is None:
        return None
    inside = [block for block in drawing.blocks if not block.is_any_layout]
    known = sorted({str(each.dxf.layer) for part in (space, *inside) for each in part})
    folded = {each.casefold() for each in known}
    wanted = [name] if name.casefold() in folded else [part.strip() for part in name.split(",")]
    missing = [each for each in wanted if each.casefold() not in folded]
    if missing:
        shown = ", ".join(known[:_SHOWN]) + (", ..." if len(known) > _SHOWN else "")
        raise FileFormatError(
            f"{source} has nothing on layer {missing[0]!r:.80}; its layers are {shown or 'none'}"
        )
    return {each.casefold() for each in wanted}


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
