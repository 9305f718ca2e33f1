"""The function that cuts the faces of a surface where they meet, and its result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.counting import counted, listed
from delone._base.immutable import ReadOnly
from delone._base.numbers import as_nonnegative
from delone.errors import CrossingFacesError, InputError
from delone.solids.surface.check import as_faces

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices, Rows

__all__ = ["ImprintedSurface", "imprint_surface"]

_SHOWN = 5


@dataclass(frozen=True, eq=False, kw_only=True)
class ImprintedSurface(ReadOnly):
    """The result of `imprint_surface`: faces that meet only in vertices and edges, or are the same.

    Parameters
    ----------
    points : ndarray of float64, shape (n + nadded, 3)
        The points of the input, followed by those added where faces cut each other.
    faces : ndarray of int32, shape (k, 3)
        The vertices of each face, oriented like its source. Where sources overlap in one plane,
        each has its own copy of the common faces.
    source : ndarray of int32, shape (k,)
        The input face that each is a part of, ascending.
    nadded : int
        Number of points added.
    largest_distance : float
        The largest distance of a vertex of a face from its source, in units of the coordinates. No
        point of the result is farther away from the input.
    tolerance : float
        The distance below which vertices, edges and faces were joined.
    rounds : int
        Number of times that all faces were cut.
    merged : ndarray of int64, shape (m, 2)
        Rows of points that are not used, because they are within the tolerance of another
        point, and the rows that replace them.
    subdivided : ndarray of int64, shape (s,)
        Input faces that were cut into several parts.
    collapsed : ndarray of int64, shape (c,)
        Input faces without a part: they have no area, or are thinner than the tolerance.
    nfaces : int
        Number of input faces.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 1), (9, 1, 0)]
    >>> cut = delone.imprint_surface(points, [(0, 1, 2), (3, 4, 5)])
    >>> cut.nadded, cut.source.tolist()
    (2, [0, 0, 0, 0, 1, 1, 1, 1])
    >>> print(cut)
    2 faces cut into 8, 2 points added, 0 merged
    largest distance from the input 0, tolerance 5.7e-14
    """

    points: Floats
    faces: Indices
    source: Indices
    nadded: int
    largest_distance: float
    tolerance: float
    rounds: int
    merged: Rows
    subdivided: Rows
    collapsed: Rows
    nfaces: int

    def __str__(self) -> str:
        lines = [
            f"{self.nfaces:,} faces cut into {len(self.faces):,}, "
            f"{counted(self.nadded, 'point')} added, {len(self.merged):,} merged",
            f"largest distance from the input {self.largest_distance:.2g}, "
            f"tolerance {self.tolerance:.2g}",
        ]
        if len(self.collapsed):
            rows = self.collapsed.tolist()
            lines.append(
                f"{counted(len(rows), 'input face')} without a part, thinner than the tolerance: "
                f"{listed(rows, _SHOWN)}"
            )
        return "\n".join(lines)


def imprint_surface(
    points: ArrayLike,
    faces: ArrayLike,
    *,
    tolerance: float | None = None,
    workers: int | None = None,
) -> ImprintedSurface:
    """Cut faces where they cross, overlap or touch, so that bodies in contact can be meshed.

    Parameters
    ----------
    points : array_like of float, shape (n, 3)
        Coordinates.
    faces : array_like of int, shape (m, 3)
        The vertices of each triangle, rows of `points`: one or more closed surfaces, walls or
        sheets, which may cross each other or themselves.
    tolerance : float, optional
        Vertices, edges and faces closer than this are joined. The default and the minimum are a few
        rounding errors of the largest coordinate (between 3.6e-15 and 7.1e-15 of it). Give a larger
        one for parts whose contact faces are not exactly in one plane, such as parts rounded to
        single precision in a file.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.

    Returns
    -------
    ImprintedSurface
        The faces, each with the input face that it is a part of, and the largest distance between
        them.

    Raises
    ------
    CrossingFacesError
        Parts of faces still cross after 16 rounds, or the number of parts keeps growing, because
        details are not much larger than the tolerance; the error contains the pairs of input faces.
        Also if parts of a closed surface are not closed; then each pair is one face, twice.
    InputError
        `tolerance` is negative, infinite or NaN, or no face is left because all are thinner.
    NonFiniteError, ShapeError, DtypeError, MemoryError
        As for `check_surface`.

    See Also
    --------
    check_surface : Find faces that cross or touch.
    resolve_touches : Subdivide faces that touch, without new points.
    tetrahedralize : With ``imprint=True``, does this first.

    Notes
    -----
    Vertices within the tolerance of each other become one. Vertices within the tolerance of an edge
    or a face become vertices of it. A vertex is added where an edge crosses an edge or a face, and
    where three faces meet at a point. Each face becomes the constrained Delaunay triangulation of
    the vertices on it, with the lines that it shares with other faces as segments, projected along
    an axis. Where faces overlap in one plane, both get the same triangles.

    Added vertices are rounded to doubles, so parts are not exactly in the planes of their sources:
    `largest_distance` says how far away they are. Rounds are repeated as long as parts cross,
    and up to four times until nothing is within the tolerance of anything else that it is not
    joined with. Distances are computed in doubles; the exact tests of `check_surface` decide
    whether parts cross.

    Regions are kept: what a closed surface enclosed is enclosed by its parts. Volumes enclosed by
    two bodies become separate regions, with a winding number of 2. The result does not depend
    on the order of points and faces, apart from numbering. The time is linear in the number of
    pairs of faces whose bounding boxes meet, up to logarithmic factors, for each round.

    Examples
    --------
    A small cube on a larger one, where the area of contact is not a union of faces:

    >>> import delone, numpy as np
    >>> corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    >>> cube = delone.ConvexHull(corners)
    >>> points = np.concatenate((cube.points * 2, cube.points + (0.5, 0.5, 2)))
    >>> faces = np.concatenate((cube.simplices, cube.simplices + 8))
    >>> cut = delone.imprint_surface(points, faces)
    >>> cut.largest_distance, delone.check_surface(cut.points, cut.faces).nregions
    (0.0, 2)
    """
    given, rows = as_faces(points, faces)
    margin = 0.0 if tolerance is None else as_nonnegative(tolerance, name="tolerance", finite=True)
    made = _core.imprint_surface3(given, rows, margin, as_workers(workers))
    if len(made.crossing):
        raise _failure(made.crossing.astype(np.int64), made.tolerance, made.rounds)
    if len(rows) and not len(made.faces):
        extent = float(np.ptp(given[rows.ravel()], axis=0).max())
        raise InputError(
            f"tolerance={made.tolerance:g} leaves no face of the surface, which extends over "
            f"{extent:g}: all are thinner"
        )
    parts = np.bincount(made.source, minlength=len(rows))
    return ImprintedSurface(
        points=np.concatenate((given, made.added)),
        faces=made.faces,
        source=made.source,
        nadded=len(made.added),
        largest_distance=made.distance,
        tolerance=made.tolerance,
        rounds=made.rounds,
        merged=made.merged.astype(np.int64),
        subdivided=np.flatnonzero(parts > 1),
        collapsed=np.flatnonzero(parts == 0),
        nfaces=len(rows),
    )


def _failure(pairs: Rows, tolerance: float, rounds: int) -> CrossingFacesError:
    count = len(pairs)
    alone = pairs[:, 0] == pairs[:, 1]
    if alone.all():
        faces = counted(count, "face")
        what = f"parts of {faces} have edges without a partner, first face {pairs[0, 0]}"
    else:
        first, second = pairs[~alone][0]
        what = f"parts of faces still cross, first {first} and {second}"
    return CrossingFacesError(
        f"{what}, after {counted(rounds, 'round')}; `error.pairs` lists all: details there are not "
        f"much larger than the tolerance {tolerance:.2g}; give a larger tolerance, or repair the "
        "surface",
        pairs=pairs,
        kinds=np.full(count, "crossing"),
        count=count,
    )
