"""What tests of tiles share: triangles in one order, a writer of COPC files."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

pytest.importorskip("pyarrow")

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray


@pytest.fixture
def canonical() -> Callable[[Any], Any]:
    """Triangles from their smallest corner on, in lexicographic order."""

    def canonical(simplices: Any) -> Any:
        s = np.asarray(simplices, dtype=np.int64)
        k = s.argmin(axis=1)
        turned = np.stack([s[np.arange(len(s)), (k + j) % 3] for j in range(3)], axis=1)
        return turned[np.lexsort(turned.T[::-1])]

    return canonical


@pytest.fixture
def write_copc() -> Callable[..., NDArray[Any]]:
    """What writes small COPC files."""
    pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    return _write_copc


def _write_copc(
    path: Path, points: NDArray[np.float64], z: NDArray[np.float64], *, empty: bool = False
) -> NDArray[Any]:
    """Write points in millimetres, then if need be an empty chunk; return the order of rows.

    A COPC file is a LAZ file of point format 6 to 8 with chunks of any size, one for each node of
    an octree, the record ``copc`` 1 first among the records before the points, and the hierarchy
    behind them (specification 1.0). Of the octree there are two levels here: every eighth point,
    and the rest by quadrants.
    """
    import laspy
    import lazrs
    from laspy.vlrs.known import LasZipVlr

    low = np.array([*points.min(axis=0), z.min()])
    half = float((np.array([*points.max(axis=0), z.max()]) - low).max() / 2)
    nodes = _nodes(points, low + half)
    order = np.concatenate([rows for _, rows in nodes])

    las = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
    las.header.scales, las.header.offsets = np.full(3, 1e-3), np.floor(low)
    las.x, las.y, las.z = points[order, 0], points[order, 1], z[order]
    header = las.header
    header.update(las.points)

    vlr = lazrs.LazVlr.new_for_compression(6, 0, use_variable_size_chunks=True)
    info = laspy.VLR("copc", 1, "COPC info VLR", b"\0" * 160)
    header.vlrs.extend([info, LasZipVlr(vlr.record_data())])
    header.are_points_compressed = True
    with path.open("wb+") as file:
        header.write_to(file)
        data = file.tell()
        compressor = lazrs.LasZipCompressor(file, vlr)
        end = 0
        for _, rows in nodes:
            compressor.compress_many(las.points.array[end : end + len(rows)].tobytes())
            end += len(rows)
            if end < len(points) or empty:
                compressor.finish_current_chunk()
        compressor.done()
        file.seek(data)
        sizes = [size for _, size in lazrs.read_chunk_table(file, vlr)][: len(nodes)]
        starts = data + 8 + np.cumsum([0, *sizes])
        entries = [
            (*key, start, size, len(rows))
            for (key, rows), start, size in zip(nodes, starts[:-1].tolist(), sizes, strict=True)
        ]
        file.seek(0, 2)
        hierarchy = file.tell()
        pages = b"".join(struct.pack("<4iQ2i", *entry) for entry in entries)
        file.write(struct.pack("<H16sHQ32s", 0, b"copc", 1000, len(pages), b"hierarchy") + pages)
        # What is known at last goes into the header and the record behind it.
        file.seek(235)
        file.write(struct.pack("<QI", hierarchy, 1))
        file.seek(375 + 54)
        center = low + half
        file.write(
            struct.pack("<5d2Q2d", *center, half, half / 8, hierarchy + 60, len(pages), 0, 0)
        )
    return order


def _nodes(points: NDArray[Any], center: NDArray[Any]) -> list[tuple[tuple[int, ...], Any]]:
    """Level and place of nodes, and the rows that they hold."""
    rows = np.arange(len(points))
    rest = rows[rows % 8 != 0]
    quadrant = (points[rest] >= center[:2]).astype(int)
    nodes = [((0, 0, 0, 0), rows[::8])]
    for i in range(2):
        for j in range(2):
            some = rest[(quadrant == (i, j)).all(axis=1)]
            if len(some):
                nodes.append(((1, i, j, 0), some))
    return nodes
