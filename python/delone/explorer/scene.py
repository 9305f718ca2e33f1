"""Scenes: what the view shows of an object, as named arrays in one block of bytes.

A block begins with the length of a header in 4 bytes (little-endian), then the header (JSON, padded
with spaces so that both take a multiple of 8 bytes), then the arrays, each padded to a multiple of
8 bytes. The header contains the type and the position of each array under ``"arrays"``, and plain
values.
"""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from delone._base.arrays import as_choice, as_plain_array
from delone._base.values import as_values
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.errors import InputError, ShapeError
from delone.periodic import PeriodicDelaunay
from delone.refine.meshed import Mesh
from delone.regular import RegularTriangulation
from delone.voronoi.diagram import Voronoi

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices

    Explorable: TypeAlias = (
        Delaunay | ConstrainedDelaunay | Mesh | RegularTriangulation | PeriodicDelaunay | Voronoi
    )

__all__ = ["QUALITIES", "Scene", "as_explorable", "packed", "scene_of"]

# Measures by which triangles can be colored, with the range of the colors; None for the range of
# the values.
QUALITIES: dict[str, tuple[float, float] | None] = {
    "smallest_angle": (0.0, 60.0),
    "largest_angle": (60.0, 180.0),
    "area": None,
    "radius_ratio": None,
    "edge_ratio": None,
}
# With more sites, Voronoi edges would double the amount of data that is computed and sent.
_MOST_SITES = 200_000
_CLASSES = "Delaunay, ConstrainedDelaunay, Mesh, RegularTriangulation, PeriodicDelaunay or Voronoi"


class Scene(NamedTuple):
    """The arrays of the view; it draws the rows of `points`."""

    points: Floats  # (k, 2)
    triangles: Indices  # (m, 3)
    rows: Indices | None = None  # (k,): of each point; copies come after the rows themselves
    dual: Floats | None = None  # (e, 4): edges of the Voronoi diagram
    constrained: Indices | None = None  # (s, 2)
    quality: Floats | None = None  # (m,)
    values: Floats | None = None  # (k,)


def as_explorable(mesh: Any) -> Explorable:
    """Return an object that can be explored, triangulating points; errors say what is supported."""
    kinds = (
        *(Delaunay, ConstrainedDelaunay, Mesh),
        *(RegularTriangulation, PeriodicDelaunay, Voronoi),
    )
    if isinstance(mesh, kinds):
        if mesh.ndim != 2:
            raise InputError(
                f"this {type(mesh).__name__} is 3-D, and only 2-D ones can be explored; draw it "
                "with its method plot"
            )
        return mesh
    if hasattr(mesh, "simplices"):
        raise InputError(
            f"a {type(mesh).__name__} cannot be explored: pass a 2-D {_CLASSES}, or points of "
            "shape (n, 2)"
        )
    shape = as_plain_array(mesh, "points").shape
    if len(shape) == 2 and shape[1] == 3:
        raise ShapeError(
            f"points of shape {shape} are 3-D, and only 2-D points can be explored: pass two "
            "columns, and the third as values"
        )
    return Delaunay(mesh, planar=True)


def scene_of(mesh: Explorable, values: ArrayLike | None, quality: str) -> Scene:
    """Return the scene of an object; `values` contains a number for each of its points."""
    as_choice(quality, tuple(QUALITIES), name="quality")
    heights = as_values(values, mesh.npoints, name="values")
    if isinstance(mesh, Voronoi):
        return _of_voronoi(mesh, heights, quality)
    if isinstance(mesh, PeriodicDelaunay):
        return _of_periodic(mesh, heights, quality)
    segmented = isinstance(mesh, ConstrainedDelaunay | Mesh)
    dual = None
    if not segmented and mesh.npoints <= _MOST_SITES:
        weights = mesh.weights if isinstance(mesh, RegularTriangulation) else None
        dual = _edges_of_cells(Voronoi(mesh.points, weights=weights, planar=True))
    return Scene(
        mesh.points,
        mesh.simplices,
        dual=dual,
        constrained=mesh.segments if isinstance(mesh, ConstrainedDelaunay | Mesh) else None,
        quality=_quality(mesh, quality),
        values=heights,
    )


def _quality(mesh: Any, name: str) -> Floats:
    found: Floats = getattr(mesh.quality(), name)
    return found


def _of_periodic(mesh: PeriodicDelaunay, values: Floats | None, quality: str) -> Scene:
    """The triangles of one period: the points as given, then the copies that are corners."""
    own = np.column_stack((np.arange(mesh.npoints), np.zeros((mesh.npoints, 2), dtype=np.int64)))
    corners = np.concatenate((mesh.simplices[..., None], mesh.offsets), axis=2).reshape(-1, 3)
    keys, place = np.unique(np.concatenate((own, corners)), axis=0, return_inverse=True)
    copied = np.ones(len(keys), dtype=bool)
    copied[place.ravel()[: len(own)]] = False
    number = np.empty(len(keys), dtype=np.int64)
    number[place.ravel()[: len(own)]] = np.arange(len(own))
    number[copied] = len(own) + np.arange(np.count_nonzero(copied))
    triangles = number[place.ravel()[len(own) :]].reshape(-1, 3)
    rows = np.concatenate((np.arange(len(own)), keys[copied, 0])).astype(np.int32)
    points = mesh.points[rows]
    points[triangles.ravel()] = mesh.corners.reshape(-1, 2)
    return Scene(
        points,
        triangles.astype(np.int32),
        rows=rows,
        quality=_quality(mesh, quality),
        values=None if values is None else values[rows],
    )


def _of_voronoi(diagram: Voronoi, values: Floats | None, quality: str) -> Scene:
    """The sites, the cells, and the triangles that are dual to them."""
    dual = _edges_of_cells(diagram)
    mesh = diagram.triangulation
    if mesh is None or isinstance(mesh, PeriodicDelaunay):
        nothing = np.empty((0, 3), dtype=np.int32)
        return Scene(diagram.points, nothing, dual=dual, values=values)
    return Scene(
        diagram.points, mesh.simplices, dual=dual, quality=_quality(mesh, quality), values=values
    )


def _edges_of_cells(diagram: Voronoi) -> Floats:
    """The edges of all cells, (e, 4), clipped or with rays that extend beyond the view."""
    if diagram.clip is not None or diagram.periods is not None:
        starts, corners, _ = diagram._left.simple()
        after = np.arange(1, len(corners) + 1)
        after[np.asarray(starts[1:]) - 1] = starts[:-1]
        return np.hstack((corners, corners[after]))
    starts, entries = diagram.ridge_rows
    ends = entries[np.asarray(starts[:-1])[:, None] + (0, 1)]
    ends = ends[(ends >= 0).all(axis=1)]
    rays = diagram.rays
    points = diagram.points
    # Long enough to end outside a view of the points, wherever the ray begins.
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    away = np.abs(rays.origin - points.mean(axis=0)).max(axis=1, initial=0.0)
    tips = rays.origin + (100.0 * (extent + away))[:, None] * rays.direction
    lines = np.hstack((diagram.vertices[ends[:, 0]], diagram.vertices[ends[:, 1]]))
    return np.concatenate((lines, np.hstack((rays.origin, tips))))


def packed(scene: Scene, header: dict[str, Any]) -> bytes:
    """Return a scene and other plain values as one block of bytes."""
    kinds = {"triangles": "<i4", "rows": "<i4", "constrained": "<i4"}
    arrays, blocks, place = {}, [], 0
    for name, array in scene._asdict().items():
        if array is None:
            continue
        kind = kinds.get(name, "<f8")
        block = np.ascontiguousarray(array, dtype=kind).tobytes()
        arrays[name] = {"kind": kind[1:], "start": place, "length": array.size}
        blocks += [block, bytes(-len(block) % 8)]
        place += len(block) + -len(block) % 8
    text = json.dumps(header | {"arrays": arrays}, allow_nan=False).encode()
    text += b" " * (-(4 + len(text)) % 8)
    return b"".join((struct.pack("<I", len(text)), text, *blocks))
