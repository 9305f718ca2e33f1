"""The octree of COPC files: which chunks may have points inside a box.

Each node is a chunk, and its points are in a cube (specification 1.0). All pages of the hierarchy
are read, 32 bytes for each node, and compared with the chunks of the file: each must be one node.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["is_copc", "nodes_within"]

_ENTRY = np.dtype([("key", "<i4", 4), ("offset", "<u8"), ("size", "<i4"), ("points", "<i4")])
# Levels of an octree whose cubes doubles can distinguish.
_DEEPEST = 50


def is_copc(header: Any) -> bool:
    """Return whether a file has an octree, which its first record then describes."""
    return bool(header.vlrs) and type(header.vlrs[0]).__name__ == "CopcInfoVlr"


def nodes_within(
    path: Path, header: Any, starts: Rows, box: tuple[float, float, float, float]
) -> Bools:
    """Return which chunks, by the bytes at which they start, may have points inside a box."""
    nodes = _nodes(path, header.vlrs[0])
    order = np.argsort(nodes["offset"])
    nodes = nodes[order]
    if not np.array_equal(nodes["offset"].astype(np.int64), starts):
        raise FileFormatError(
            f"{path} is corrupt: the {len(nodes)} nodes of its octree with points "
            f"are not the {len(starts)} chunks of the file"
        )
    level = nodes["key"][:, 0]
    if len(level) and not 0 <= level.min() <= level.max() <= _DEEPEST:
        raise FileFormatError(f"{path} is corrupt: a node of its octree is at level {level.max()}")
    low, side = _cubes(path, header.vlrs[0], nodes)
    # Coordinates are rounded to a multiple of the scale.
    slack = np.abs(header.scales[:2]) + 1e-9 * float(header.vlrs[0].halfsize)
    beyond = (low + side[:, None] + slack < box[:2]) | (low - slack > box[2:])
    return np.asarray(~beyond.any(axis=1))


def _cubes(path: Path, info: Any, nodes: NDArray[Any]) -> tuple[Floats, Floats]:
    """Return the lower corners of nodes, (n, 2), and their sides."""
    half = float(info.halfsize)
    if not (np.isfinite(half) and half > 0 and np.isfinite(info.center).all()):
        raise FileFormatError(f"{path} is corrupt: its octree has no center, or no size")
    side = 2 * half / 2.0 ** nodes["key"][:, 0]
    return np.asarray(info.center)[:2] - half + nodes["key"][:, 1:3] * side[:, None], side


def _nodes(path: Path, info: Any) -> NDArray[Any]:
    """Return the nodes that have points."""
    size = path.stat().st_size
    pages = [(int(info.hierarchy_root_offset), int(info.hierarchy_root_size))]
    known, found = set(pages), [np.empty(0, dtype=_ENTRY)]
    with path.open("rb") as file:
        while pages:  # each page is read once
            start, room = pages.pop()
            if start < 0 or room < 0 or start + room > size or room % _ENTRY.itemsize:
                raise FileFormatError(f"{path} is truncated: its octree is not in the file")
            file.seek(start)
            entries = np.frombuffer(file.read(room), dtype=_ENTRY)
            found.append(entries[entries["points"] > 0])
            for entry in entries[entries["points"] == -1]:
                page = int(entry["offset"]), int(entry["size"])
                if page in known:
                    raise FileFormatError(f"{path} is corrupt: its octree contains a page twice")
                known.add(page)
                pages.append(page)
    return np.concatenate(found)
