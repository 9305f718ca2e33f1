"""Intersections of many small polygons with an outline that may have very many corners.

If the outline has many corners, polygons and outline are halved together until there are few on
both sides, so that no polygon is compared with corners far from it. The same crossing may then be
rounded differently for the two polygons that share it: corners that differ only by rounding are
merged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.geopandas import shapely_or_say
from delone.voronoi.outline import areal_parts, next_corner, times, unit_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["as_polygons", "intersections", "with_shared_corners"]

# Outlines with fewer corners than this are not halved, nor are fewer polygons than this.
_FEW_CORNERS, _FEW_POLYGONS = 256, 8
# The box around polygons is larger by this fraction of its extent.
_MARGIN = 2.0**-6
_POLYGON = 3
# Corners within this fraction of the largest coordinate, 64 units in the last place, are merged if
# they are at most this many positions apart in the order in which they are sorted.
_SAME, _PLACES = 2.0**-46, 4


def as_polygons(starts: Indices, corners: Floats) -> NDArray[Any]:
    """Return shapely polygons, empty ones for cells without corners."""
    shapely = shapely_or_say()
    sizes = np.diff(starts)
    filled = sizes > 0
    # Rings repeat their first corner at the end.
    begins = starts[:-1][filled]
    closed = np.insert(corners, starts[1:][filled], corners[begins], axis=0)
    rings = np.concatenate(([0], np.cumsum(sizes[filled] + 1)))
    parts = np.concatenate(([0], np.cumsum(filled)))
    offsets = (rings.astype(np.int64), parts.astype(np.int64))
    found: NDArray[Any] = shapely.from_ragged_array(shapely.GeometryType.POLYGON, closed, offsets)
    _make_sound(found, starts, corners)
    return found


def _make_sound(polygons: NDArray[Any], starts: Indices, corners: Floats) -> None:
    """Replace cells whose corners are not in convex order, because of rounding, by their hulls.

    Cells a few units in the last place wide may also have lost their area: they become empty.
    """
    shapely = shapely_or_say()
    after = next_corner(starts, len(corners))
    a, b, c = corners, corners[after], corners[after[after]]
    with np.errstate(all="ignore"):
        (px, py), (qx, qy) = (b - a).T, (c - b).T
        left, right = px * qy, py * qx
        doubtful = ~(left - right > 2.0**-50 * (np.abs(left) + np.abs(right)))
    rows = np.unique(np.repeat(np.arange(len(polygons)), np.diff(starts))[doubtful])
    unit = unit_of(corners)
    rows = rows[~shapely.is_valid(times(polygons[rows], unit))]
    if len(rows):
        hulls = shapely.convex_hull(times(polygons[rows], unit))
        hulls[shapely.get_type_id(hulls) != _POLYGON] = shapely.Polygon()
        polygons[rows] = times(hulls, 1 / unit)


def intersections(geometries: NDArray[Any], outline: Any, *, areal: bool = True) -> NDArray[Any]:
    """Intersect many small geometries with one that may have very many corners."""
    shapely = shapely_or_say()
    found = np.full(len(geometries), shapely.Polygon(), dtype=object)
    boxes = shapely.bounds(geometries)
    # Empty geometries have no box.
    _halve(geometries, boxes, np.flatnonzero(~np.isnan(boxes[:, 0])), outline, found)
    return areal_parts(found) if areal else found


def _halve(
    geometries: NDArray[Any],
    boxes: Floats,
    rows: NDArray[np.int64],
    outline: Any,
    found: NDArray[Any],
) -> None:
    """Intersect some of the geometries; each call gets half as many as the previous one."""
    shapely = shapely_or_say()
    if len(rows) <= _FEW_POLYGONS or shapely.get_num_coordinates(outline) <= _FEW_CORNERS:
        found[rows] = shapely.intersection(geometries[rows], outline)
        return
    centers = boxes[rows, :2] / 2 + boxes[rows, 2:] / 2
    axis = int(np.argmax(np.ptp(centers, axis=0)))
    order = rows[np.argsort(centers[:, axis], kind="stable")]
    for half in np.array_split(order, 2):
        low, high = boxes[half, :2].min(axis=0), boxes[half, 2:].max(axis=0)
        margin = _MARGIN * (high - low).max()
        around = shapely.box(*(low - margin), *(high + margin))
        local = areal_parts(np.array([shapely.intersection(outline, around)]))[0]
        _halve(geometries, boxes, half, local, found)


def with_shared_corners(cut: NDArray[Any], corners: Floats, outline: Any) -> NDArray[Any]:
    """Merge corners that differ only by rounding: crossings that were computed more than once.

    Corners of whole cells and of the outline do not move.
    """
    shapely = shapely_or_say()
    places, owner = shapely.get_coordinates(cut, return_index=True)
    if not len(places):
        return cut
    distinct, number = np.unique(_as_complex(places), return_inverse=True)
    known = np.isin(distinct, _as_complex(np.vstack((corners, shapely.get_coordinates(outline)))))
    # Known corners first: merged corners get the smallest number.
    rank = np.empty(len(distinct), dtype=np.int64)
    by_rank = np.argsort(~known, kind="stable")
    rank[by_rank] = np.arange(len(distinct))
    close = float(np.abs(places).max()) * _SAME
    order = np.argsort(distinct.real * 0.8 + distinct.imag * 0.6)
    name = rank[order]
    for shift in range(1, min(_PLACES, len(order) - 1) + 1):
        step = distinct[order[shift:]] - distinct[order[:-shift]]
        near = (np.abs(step.real) <= close) & (np.abs(step.imag) <= close)
        near &= ~(known[order[shift:]] & known[order[:-shift]])
        least = np.minimum(name[shift:], name[:-shift])
        name[shift:] = np.where(near, least, name[shift:])
        name[:-shift] = np.where(near, least, name[:-shift])
    moved = distinct.copy()
    moved[order] = distinct[by_rank[name]]
    if np.array_equal(moved, distinct):
        return cut
    new = moved[number.reshape(-1)]
    changed = np.unique(owner[new != _as_complex(places)])
    mask = np.isin(owner, changed)
    mended = shapely.set_coordinates(
        cut[changed].copy(), np.column_stack((new.real, new.imag))[mask]
    )
    sound = shapely.is_valid(mended)
    found = cut.copy()
    found[changed[sound]] = mended[sound]
    return found


def _as_complex(places: Floats) -> NDArray[np.complex128]:
    found: NDArray[np.complex128] = np.ascontiguousarray(places + 0.0).view(np.complex128)[:, 0]
    return found
