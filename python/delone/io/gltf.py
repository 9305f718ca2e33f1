"""GLB, the binary form of glTF 2.0: triangles with normals for viewers and game engines.

glTF coordinates have 32 bits, with y upward: points are relative to a local origin, an integer
corner below all of them; x is unchanged, y is the height, and -z points north. The origin and the
reference system are in ``extras`` of the node. Lengths in glTF are in meters; if another unit is
known, it becomes the scale of the node. The format follows the Khronos specification, version
2.0.11.
"""

from __future__ import annotations

import json
import struct
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.units import METERS, lengths_of_crs
from delone.errors import FileFormatError, InputError
from delone.io.content import content

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["write_local", "write_mesh"]

# Constants of the specification.
_FLOAT, _UINT = 5126, 5125
_ARRAY, _ELEMENTS = 34962, 34963
_LINES, _TRIANGLES = 1, 4
_JSON, _BIN = 0x4E4F534A, 0x004E4942
# Chunk sizes have 32 bits.
_LARGEST = (1 << 32) - 1


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Write triangles with smooth normals, or edges as lines; heights are upward."""
    wanted.refuse(".glb files", "attributes", use=".vtu or .ply")
    crs, edges = wanted.crs, wanted.edges
    found = content(triangulation, z=wanted.z, edges=edges).bare()
    used, inverse = np.unique(found.simplices, return_inverse=True)
    rows: Indices = inverse.reshape(found.simplices.shape).astype(np.int32)
    points = np.zeros((len(used), 3))
    points[:, : found.points.shape[1]] = found.points[used]
    origin = np.floor(points.min(axis=0)) if len(points) else np.zeros(3)
    with np.errstate(over="ignore"):
        local = _upright(points - origin).astype(np.float32)
    if not np.isfinite(local).all():
        raise InputError("coordinates of .glb files have 32 bits: the extent exceeds them")
    arrays = {"POSITION": local}
    if not edges:
        arrays["NORMAL"] = _upright(_normals(points - origin, rows)).astype(np.float32)
    node: dict[str, Any] = {"mesh": 0, "extras": {"origin": origin.tolist()}}
    if crs:
        node["extras"]["crs"] = crs
    scale = _scale(crs, getattr(triangulation, "units", None))
    if scale != [1.0, 1.0, 1.0]:
        node["scale"] = scale
    _write(path, node, arrays, rows.astype(np.uint32), _LINES if edges else _TRIANGLES)


def write_local(path: Path, points: Floats, simplices: Indices) -> None:
    """Write triangles between points in meters around an origin: east, north and up."""
    arrays = {
        "POSITION": _upright(points).astype(np.float32),
        "NORMAL": _upright(_normals(points, simplices)).astype(np.float32),
    }
    _write(path, {"mesh": 0}, arrays, simplices.ravel().astype(np.uint32), _TRIANGLES)


def _upright(xyz: Floats) -> Floats:
    """Convert from z upward to y upward."""
    return np.column_stack((xyz[:, 0], xyz[:, 2], -xyz[:, 1]))


def _normals(points: Floats, rows: Indices) -> Floats:
    """Return unit normals of vertices: area-weighted sums of the normals of their triangles."""
    a, b, c = (points[rows[:, k]] for k in range(3))
    # Scaled to a largest side of 1: squares of tiny or large extents would overflow or underflow.
    size = float(np.abs(points).max(initial=0)) or 1.0
    across = np.cross((b - a) / size, (c - a) / size)
    found = np.zeros_like(points)
    for corner in range(3):
        np.add.at(found, rows[:, corner], across)
    length = np.sqrt((found**2).sum(axis=1))
    flat = length == 0
    found[flat], length[flat] = (0.0, 0.0, 1.0), 1.0
    normals: Floats = found / length[:, None]
    return normals


def _scale(crs: str | None, heights: str | None) -> list[float]:
    """Return meters per unit of x, of heights and of y; 1 where the unit is unknown."""
    plane = METERS.get(lengths_of_crs(crs) or "m", 1.0)
    return [plane, METERS.get(heights or "", plane), plane]


def _write(
    path: Path,
    node: dict[str, Any],
    arrays: Mapping[str, NDArray[np.float32]],
    rows: NDArray[np.uint32],
    mode: int,
) -> None:
    """Write one mesh with the values of its vertices."""
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    blobs = []
    start = 0
    for name, values in (*arrays.items(), ("", rows.ravel())):
        # Each has a multiple of four bytes, as the format requires.
        data = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()
        target = _ARRAY if name else _ELEMENTS
        views.append({"buffer": 0, "byteOffset": start, "byteLength": len(data), "target": target})
        accessor: dict[str, Any] = {
            "bufferView": len(accessors),
            "componentType": _FLOAT if name else _UINT,
            "count": len(values),
            "type": "VEC3" if name else "SCALAR",
        }
        if name == "POSITION":
            accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        accessors.append(accessor)
        blobs.append(data)
        start += len(data)
    primitive: dict[str, Any] = {
        "attributes": {name: row for row, name in enumerate(arrays)},
        "indices": len(arrays),
        "mode": mode,
    }
    if mode == _TRIANGLES:
        primitive["material"] = 0
    document = {
        "asset": {"version": "2.0", "generator": "delone"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [primitive]}],
        "materials": [
            {
                "doubleSided": True,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.7, 0.66, 0.58, 1.0],
                    "metallicFactor": 0.0,
                    "roughnessFactor": 1.0,
                },
            }
        ],
        "buffers": [{"byteLength": start}],
        "bufferViews": views,
        "accessors": accessors,
    }
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + start
    if size > _LARGEST:
        raise FileFormatError(".glb files have at most 4 GiB: simplify the mesh, or use .ply")
    with path.open("wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, size))
        file.write(struct.pack("<II", len(text), _JSON) + text)
        file.write(struct.pack("<II", start, _BIN))
        for data in blobs:
            file.write(data)
