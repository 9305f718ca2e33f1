"""Pads: polygons with a plane, and the side slopes that run down or up from their edges.

Each edge has a facet: the plane through it that falls (or rises) outward at the given slope. Around
a convex corner, facets of the same slope touch the cone of that slope: enough of them that the
directions of neighbors differ by no more than `CORNERS`. Neighbors meet halfway between their
directions, so a facet covers what lies between two rays. Where facets overlap, next to reflex
corners, the highest one applies in fill, and the lowest one in cut.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_number
from delone.errors import InputError
from delone.terrain.extent import inside_of_rings, refuse_crossing_rings
from delone.terrain.lines import rings_of

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices
    from delone.constrained.delaunay import ConstrainedDelaunay

__all__ = ["CORNERS", "Facets", "Pad", "facets_of", "inside", "pad_of", "plane_at"]

# The largest angle between neighboring facets at a corner.
CORNERS = {"round": math.radians(15), "miter": math.radians(120)}
# Angles up to this many radians count as zero.
_STRAIGHT = 1e-9


class Pad(NamedTuple):
    """A polygon and its plane."""

    points: Floats  # (p, 2)
    edges: Indices  # (e, 2), rows of `points`; the inside is to the left
    mesh: ConstrainedDelaunay  # of the rings
    within: Bools  # which of its triangles are inside
    plane: tuple[float, float, float]  # heights c + a x + b y


class Facets(NamedTuple):
    """Planes of slopes, and where they are: between two rays and up to a distance."""

    start: Floats  # (k, 2), where the first ray starts: an edge's start, or a corner
    end: Floats  # (k, 2), where the last ray starts
    first: Floats  # (k, 2), the first ray, up to the distance 1
    last: Floats  # (k, 2)
    height: Floats  # (k,), at `start`
    gradient: Floats  # (k, 2)
    outward: Floats  # (k, 2), the direction away from the pad, of length 1
    rise: Floats  # (k,), 1 if it rises outward (cut), -1 if it falls (fill)
    mildest: Floats  # (k,), no facet of its kind is milder at any distance from the pad

    @classmethod
    def none(cls) -> Facets:
        """Those of a pad without side slopes."""
        pairs, numbers = np.empty((0, 2)), np.empty(0)
        return cls(pairs, pairs, pairs, pairs, numbers, pairs, pairs, numbers, numbers)

    @classmethod
    def joined(cls, parts: list[Facets]) -> Facets:
        """Combine several."""
        return cls(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def at(self, k: Any, points: Floats) -> Floats:
        """Heights of facets, one for each point or one for all."""
        apart = points - self.start[k]
        found: Floats = self.height[k] + (self.gradient[k] * apart).sum(axis=-1)
        return found


def plane_at(plane: tuple[float, float, float], points: Floats) -> Floats:
    """Heights of a plane."""
    a, b, c = plane
    found: Floats = c + a * points[..., 0] + b * points[..., 1]
    return found


def pad_of(polygon: Any, z: Any, crs: str | None) -> Pad:
    """Return the polygon, or the union of several whose own rings do not cross, and its plane."""
    plane = _plane(z)
    rings = rings_of(polygon, name="polygon", crs=crs)
    if not rings:
        raise InputError("polygon has no ring")
    refuse_crossing_rings("polygon: edges", rings)
    mesh, within = inside_of_rings(rings)
    beside = np.append(within, False)[mesh.neighbors]
    triangle, side = np.nonzero(within[:, None] & ~beside & (mesh.constrained))
    edges = np.column_stack(
        [mesh.simplices[triangle, (side + turn) % 3] for turn in (1, 2)]
    ).astype(np.int32)
    if not len(edges):
        raise InputError("polygon has no area: each point is inside an even number of rings")
    used, rows = np.unique(edges, return_inverse=True)
    return Pad(mesh.points[used], rows.reshape(-1, 2).astype(np.int32), mesh, within, plane)


def _plane(z: Any) -> tuple[float, float, float]:
    try:
        numbers = [as_number(each, name="z") for each in z]
    except TypeError:
        numbers = [0.0, 0.0, as_number(z, name="z")]
    if len(numbers) != 3 or not np.isfinite(numbers).all():
        raise InputError(f"z must be a height, or a plane (a, b, c), finite; got {z!r:.60}")
    return numbers[0], numbers[1], numbers[2]


def inside(points: Floats, pad: Pad) -> Bools:
    """Which points are inside a pad, or on its edge."""
    simplex = pad.mesh.find_simplex(points)
    found: Bools = (simplex >= 0) & pad.within[simplex]
    return found


def facets_of(pad: Pad, slope: float, rise: int, corners: str) -> Facets:
    """Return the facets of side slopes: they rise outward if `rise` is 1, fall if it is -1."""
    a, b = (pad.points[end] for end in pad.edges.T)
    along = b - a
    along /= np.hypot(*along.T)[:, None]
    normal = np.column_stack((along[:, 1], -along[:, 0]))
    grade = along @ np.array(pad.plane[:2])
    if not (np.abs(grade) < slope).all():
        raise InputError(
            f"the pad itself falls by {np.abs(grade).max():.6g} along an edge: side slopes must be "
            f"steeper, got {slope:.6g}"
        )
    across = np.sqrt(slope**2 - grade**2)
    gradient = grade[:, None] * along + rise * across[:, None] * normal
    outward = rise * gradient / slope
    lean = [_angle(*pair) for pair in zip(normal, outward, strict=True)]
    first, last = outward.copy(), outward.copy()
    wedges: list[list[Floats]] = []
    for i, j in _corners(pad):
        # On a tilted pad, slopes lean, so there may be more than half a turn between them.
        turn = _angle(along[i], along[j]) + lean[j] - lean[i]
        if turn <= _STRAIGHT:
            continue
        count = math.ceil(turn / CORNERS[corners] * (1 - _STRAIGHT))
        start = math.atan2(outward[i][1], outward[i][0])
        angles = start + turn / count * np.arange(1, count)
        faces = np.vstack(
            (outward[i], np.column_stack((np.cos(angles), np.sin(angles))), outward[j])
        )
        halves = faces[:-1] + faces[1:]
        rays = halves / (halves * faces[:-1]).sum(axis=1)[:, None]
        last[i], first[j] = rays[0], rays[-1]
        corner = np.broadcast_to(b[i], (count - 1, 2))
        wedges.append(
            [corner, corner, rays[:-1], rays[1:], rise * slope * faces[1:-1], faces[1:-1]]
        )
    parts = [[a, b, first, last, gradient, outward], *wedges]
    starts, ends, firsts, lasts, gradients, outwards = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    heights = plane_at(pad.plane, starts)
    mildest = slope * math.cos(CORNERS[corners] / 2)
    return Facets(
        starts,
        ends,
        firsts,
        lasts,
        heights,
        gradients,
        outwards,
        np.full(len(starts), float(rise)),
        np.full(len(starts), mildest),
    )


def _corners(pad: Pad) -> list[tuple[int, int]]:
    """Return the pairs of edges with ground between them, at the end of the first edge.

    Parts of a pad that touch at a point have several such pairs there.
    """
    direction = pad.points[pad.edges[:, 1]] - pad.points[pad.edges[:, 0]]
    leaving: dict[int, list[int]] = {}
    for edge, vertex in enumerate(pad.edges[:, 0].tolist()):
        leaving.setdefault(vertex, []).append(edge)
    pairs = []
    for edge, vertex in enumerate(pad.edges[:, 1].tolist()):
        back = -direction[edge]
        # The next edge counter-clockwise from the way back: between them is the outside.
        angles = {
            other: _angle(back, direction[other]) % (2 * math.pi) for other in leaving[vertex]
        }
        pairs.append((edge, min(angles, key=angles.__getitem__)))
    return pairs


def _angle(u: Floats, v: Floats) -> float:
    """The angle from one vector to another, above -pi and up to pi."""
    return math.atan2(float(_cross(u, v)), float(u @ v))


def _cross(u: Floats, v: Floats) -> Floats:
    found: Floats = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return found
