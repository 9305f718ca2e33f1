"""3-D clips: convex polyhedra from boxes, half-spaces, or hulls of points.

The core takes corners, faces and planes. Those of a box are given; those of half-spaces are
computed exactly (`halfspaces`) and rounded once; those of a hull are its facets, each a whole
polygon.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_vectors, require_finite
from delone._tiling.space.geometry import face_normals
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, DeloneError, InputError
from delone.hull import ConvexHull
from delone.voronoi.halfspaces import common_part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Polyhedron", "as_polyhedron", "loaded", "saved"]

# The faces of a box, whose corners are numbered by bits, counter-clockwise as seen from outside: x
# low, x high, y low, and so on.
_FACES = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
# The maximum number of points in a box, and of planes that are compared with all boxes together.
_BOX, _BATCH = 64, 256
_BOX_NAME, _SOLID_NAME = "a box", "a convex polyhedron"
_CHOICES = (
    "clip must be 'box', a box ((xmin, ymin, zmin), (xmax, ymax, zmax)), half-spaces (k, 4), "
    "points (k, 3) or a convex hull"
)


@dataclass(frozen=True, eq=False, kw_only=True)
class Polyhedron:
    """A convex polyhedron to which 3-D cells are clipped.

    Parameters
    ----------
    points : ndarray of float64, shape (p, 3)
        Its corners.
    starts, corners : ndarray of int32
        Faces as compressed rows of `points`, counter-clockwise as seen from outside.
    planes : ndarray of float64, shape (f, 4)
        For each face n and c: the interior is ``n @ x <= c``.
    name : str
        A short description.

    Examples
    --------
    >>> from delone import Voronoi
    >>> sites = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
    >>> clip = Voronoi(sites, clip="box").clip
    >>> clip.name, clip.bounds.tolist()
    ('a box', [[0.0, 0.0, 0.0], [4.0, 4.0, 4.0]])
    """

    points: Floats
    starts: Indices
    corners: Indices
    planes: Floats
    name: str

    @property
    def bounds(self) -> Floats:
        """The smallest and the largest coordinates, (2, 3)."""
        return np.stack((self.points.min(axis=0), self.points.max(axis=0)))

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Tell which points are inside, including the boundary."""
        beyond: NDArray[np.bool_] = points @ self.planes[:, :3].T > self.planes[:, 3]
        found: NDArray[np.bool_] = ~np.any(beyond, axis=1)
        return found


def as_polyhedron(clip: Any, points: Floats) -> Polyhedron | None:
    """Return the clip that a caller of `Voronoi` gave; None and a `Polyhedron` are unchanged."""
    if clip is None or isinstance(clip, Polyhedron):
        return clip
    if isinstance(clip, str):
        if clip != "box":
            raise InputError(f"{_CHOICES}; got {clip!r:.80}")
        return _box(np.stack((points.min(axis=0), points.max(axis=0))))
    if hasattr(clip, "simplices") and hasattr(clip, "points"):
        clip = np.asarray(clip.points)[np.unique(clip.simplices)]
    try:
        # Rows of different lengths have no shape.
        shape = np.shape(clip)
        array = as_vectors(clip, shape[-1] if shape else 0, name="clip")
    except (DeloneError, ValueError) as error:
        raise InputError(f"{_CHOICES}; {error}") from error
    require_finite(np.atleast_2d(array), name="clip")
    if shape in ((2, 3), (6,)):
        return _box(array.reshape(2, 3))
    if len(shape) == 2 and shape[1] == 4:
        return _common(array)
    if len(shape) == 2 and shape[1] == 3:
        return _hull(array)
    raise InputError(f"{_CHOICES}; got an array of shape {shape}")


def _box(bounds: Floats) -> Polyhedron:
    low, high = bounds
    if not (low < high).all():
        raise InputError(
            f"the box of clip has no volume: {low.tolist()} must be below {high.tolist()} in each "
            f"coordinate"
        )
    corner = np.arange(8)[:, None] >> np.arange(3) & 1
    planes = np.zeros((6, 4))
    planes[np.arange(6), np.arange(6) // 2] = [-1, 1, -1, 1, -1, 1]
    planes[:, 3] = np.stack((-low, high), axis=1).reshape(-1)
    return Polyhedron(
        points=np.where(corner == 1, high, low),
        starts=np.arange(0, 25, 4, dtype=np.int32),
        corners=np.array(_FACES, dtype=np.int32).reshape(-1),
        planes=planes,
        name=_BOX_NAME,
    )


def _hull(points: Floats) -> Polyhedron:
    try:
        hull = ConvexHull(points)
    except DegenerateInputError as error:
        raise InputError("the points of clip span no volume") from error
    lengths = [len(facet) for facet in hull.facets]
    used, corners = np.unique(np.concatenate(hull.facets), return_inverse=True)
    triangles = hull.simplices[np.unique(hull.facet_of, return_index=True)[1]]
    normal = face_normals(points, triangles)
    starts = np.cumsum([0, *lengths])
    own = np.maximum.reduceat(
        (np.repeat(normal, lengths, axis=0) * points[used[corners]]).sum(axis=1), starts[:-1]
    )
    # Rounding must not place a corner outside a plane.
    offset = _farthest(normal, points[used], own)
    return Polyhedron(
        points=points[used],
        starts=starts.astype(np.int32),
        corners=corners.reshape(-1).astype(np.int32),
        planes=np.column_stack((normal, offset)),
        name=_SOLID_NAME,
    )


def _farthest(normals: Floats, points: Floats, least: Floats) -> Floats:
    """Return the largest product of each normal with any of the points: `least` or slightly more.

    Only points in boxes that extend that far are considered.
    """
    boxes = _in_boxes(points)
    middle, half = (boxes.max(axis=1) + boxes.min(axis=1)) / 2, np.ptp(boxes, axis=1) / 2
    found = least.copy()
    for rows in np.array_split(np.arange(len(normals)), max(1, len(normals) // _BATCH)):
        bound = normals[rows] @ middle.T + np.abs(normals[rows]) @ half.T
        # A bound on the rounding error of products and sums.
        bound += 2.0**-48 * (np.abs(normals[rows]) @ np.abs(boxes).max(axis=1).T)
        plane, box = np.nonzero(bound >= least[rows, None])
        reached = np.einsum("ik,ijk->ij", normals[rows[plane]], boxes[box]).max(axis=1)
        np.maximum.at(found, rows[plane], reached)
    return found


def _in_boxes(points: Floats) -> Floats:
    """Return the points in groups of nearby ones, (k, j, 3); some points are in two groups."""
    groups = np.arange(len(points))[None]
    while groups.shape[1] > _BOX:
        size = groups.shape[1]
        at = points[groups]
        axis = np.ptp(at, axis=1).argmax(axis=1)
        along = np.take_along_axis(at, axis[:, None, None], axis=2)[:, :, 0]
        order = np.take_along_axis(groups, np.argsort(along, axis=1), axis=1)
        groups = np.concatenate((order[:, : (size + 1) // 2], order[:, size // 2 :]))
    return points[groups]


def _common(halfspaces: Floats) -> Polyhedron:
    """Return the polyhedron of all x with n @ x + d <= 0."""
    largest = np.abs(halfspaces[:, :3]).max(axis=1)
    if not (largest > 0).all():
        row = int(largest.argmin())
        raise InputError(f"row {row} of clip is not a half-space: its normal is zero")
    points, faces, rows = common_part(halfspaces)
    try:
        Delaunay(points)
    except DegenerateInputError:
        raise InputError(
            "the intersection of the half-spaces of clip is so thin that its corners, rounded to "
            "doubles, span no volume"
        ) from None
    # Scaled by powers of two, so that planes are exactly the given ones; with components of at most
    # 1/4 their products with corners stay within the range of doubles.
    power = np.frexp(largest[rows])[1] + 2
    planes = np.ldexp(halfspaces[rows], -power[:, None])
    planes[:, 3] *= -1
    starts = np.cumsum([0, *map(len, faces)])
    return Polyhedron(
        points=points,
        starts=starts.astype(np.int32),
        corners=np.concatenate(faces).astype(np.int32),
        planes=planes,
        name=_SOLID_NAME,
    )


def saved(clip: Polyhedron | None) -> dict[str, NDArray[Any]]:
    """Return the arrays of a file: the six numbers of a box, or a polyhedron; others are empty."""
    found: dict[str, NDArray[Any]] = {
        "box": np.empty(0),
        "corners": np.empty((0, 3)),
        "faces": np.empty(0, dtype=np.int32),
        "starts": np.empty(0, dtype=np.int32),
        "planes": np.empty((0, 4)),
    }
    if clip is None:
        return found
    if clip.name == _BOX_NAME:
        return found | {"box": clip.bounds.reshape(-1)}
    return found | {
        "corners": clip.points,
        "faces": clip.corners,
        "starts": clip.starts,
        "planes": clip.planes,
    }


def loaded(arrays: dict[str, NDArray[Any]]) -> Any:
    """Return the clip of the arrays that `saved` returns; a box as an array, (2, 3)."""
    if len(arrays["box"]):
        return arrays["box"].reshape(2, 3)
    if not len(arrays["planes"]):
        return None
    return Polyhedron(
        points=arrays["corners"],
        starts=arrays["starts"],
        corners=arrays["faces"],
        planes=arrays["planes"],
        name=_SOLID_NAME,
    )
