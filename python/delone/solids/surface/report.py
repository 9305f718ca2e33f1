"""The result of the check of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from delone._base.counting import agreed, counted, listed
from delone._base.immutable import ReadOnly
from delone.errors import CrossingFacesError, DegenerateInputError, InputError, OpenSurfaceError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from delone._base.types import Rows

__all__ = ["KINDS", "SurfaceCheck", "crossing_error"]

# In the order of the core.
KINDS = (
    "crossing",
    "edge on edge",
    "vertex in face",
    "vertex on edge",
    "coplanar overlap",
    "folded",
)
_SHOWN = 5


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceCheck(ReadOnly):
    """The result of `check_surface`; truthy if no faces cross and a region is enclosed.

    Vertices are named by the first row with their coordinates. If no faces cross, edges, vertices,
    components and regions are those of the surface that `resolve_touches` returns; otherwise those
    of the faces as given.

    Parameters
    ----------
    nfaces, nedges : int
        Number of faces given, and of edges.
    duplicate_points : ndarray of int64, shape (k, 2)
        Rows of points, each with the first row of the same coordinates.
    repeated_vertices : ndarray of int64, shape (k,)
        Faces that use a vertex twice.
    collinear : ndarray of int64, shape (k,)
        Other faces without area: their corners are on one line.
    duplicate_faces : ndarray of int64, shape (k, 2)
        Rows of faces, each with the first row of the same vertices, in any order.
    pairs : ndarray of int64, shape (p, 2)
        Rows of faces that cross or touch other than at common vertices and edges, ascending.
    kinds : ndarray of str, shape (p,)
        The kind of each pair, see `check_surface`.
    crossing : ndarray of bool, shape (p,)
        Whether the pair crosses; otherwise it touches, and `resolve_touches` subdivides its faces.
    counts : dict of str to int
        The number of pairs of each kind, including those beyond the limit.
    ncrossing : int
        The number of pairs that cross, including those beyond the limit.
    boundary : ndarray of int64, shape (k, 2)
        The ends of edges of one face.
    nonmanifold_edges : ndarray of int64, shape (k, 2)
        The ends of edges of three faces or more.
    misoriented_edges : ndarray of int64, shape (k, 2)
        The ends of edges of two faces or more that their faces do not traverse equally often in
        both directions.
    nonmanifold_vertices : ndarray of int64, shape (k,)
        Vertices whose faces do not form one fan, closed or open.
    component : ndarray of int64, shape (m,)
        The component of each face; -1 for faces without area. Components are connected by edges.
    ncomponents : int
        The number of components.
    nregions : int or None
        The number of regions that the surface separates from the outside; None if faces cross.
    dangling : ndarray of int64, shape (k,)
        Faces of which a part has the same region on both sides.
    volume : float
        The signed volume, correctly rounded: the integral of the winding number, positive if
        normals point outward. NaN unless closed and oriented.
    volume_sign : int
        The exact sign of the volume: 1, 0 or -1; 0 if the volume is NaN.
    flat : bool
        Whether all faces are in one plane.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (2, 0, 0), (2, -1, 0), (0, 0, 3)]
    >>> check = delone.check_surface(points, [(0, 1, 2), (3, 0, 4), (3, 4, 1)])
    >>> check.kinds.tolist(), bool(check)
    (['vertex on edge', 'vertex on edge'], False)
    >>> check.boundary.tolist()
    [[0, 2], [0, 4], [1, 2], [1, 4]]
    """

    nfaces: int
    nedges: int
    duplicate_points: Rows
    repeated_vertices: Rows
    collinear: Rows
    duplicate_faces: Rows
    pairs: Rows
    kinds: NDArray[np.str_]
    crossing: NDArray[np.bool_]
    counts: dict[str, int]
    ncrossing: int
    boundary: Rows
    nonmanifold_edges: Rows
    misoriented_edges: Rows
    nonmanifold_vertices: Rows
    component: Rows
    ncomponents: int
    nregions: int | None
    dangling: Rows
    volume: float
    volume_sign: int
    flat: bool

    @property
    def npairs(self) -> int:
        """The number of pairs that cross or touch, including those beyond the limit."""
        return sum(self.counts.values())

    @property
    def ntouching(self) -> int:
        """The number of pairs that touch, including those beyond the limit."""
        return self.npairs - self.ncrossing

    @property
    def closed(self) -> bool:
        """Whether there are faces, and each edge has at least two."""
        return self.nedges > 0 and not len(self.boundary)

    @property
    def oriented(self) -> bool:
        """Whether each edge of two faces or more is traversed equally often in both directions.

        If the surface is also closed, winding numbers are defined.
        """
        return not len(self.misoriented_edges)

    @property
    def manifold(self) -> bool:
        """Whether edges have at most two faces, and the faces of each vertex form one fan."""
        return not len(self.nonmanifold_edges) and not len(self.nonmanifold_vertices)

    @property
    def ok(self) -> bool:
        """Whether no faces cross and the surface encloses a region."""
        return bool(self.nregions)

    def __bool__(self) -> bool:
        return self.ok

    def raise_if_bad(self) -> None:
        """Raise an error unless the check is truthy.

        Raises
        ------
        CrossingFacesError
            Faces cross; the error contains the listed pairs and kinds.
        DegenerateInputError
            All faces are in one plane.
        OpenSurfaceError
            Nothing is enclosed, and there are boundary edges.
        InputError
            There are no faces, or nothing is enclosed without any boundary edge.

        Examples
        --------
        >>> import delone
        >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
        >>> delone.check_surface(points, faces).raise_if_bad()
        """
        if self.ncrossing:
            raise crossing_error(
                self.pairs[self.crossing], self.kinds[self.crossing], self.ncrossing
            )
        if self.ok:
            return
        if self.flat:
            raise DegenerateInputError(
                "all faces are in one plane, so the surface encloses nothing", reason="coplanar"
            )
        if len(self.boundary):
            a, b = self.boundary[0]
            raise OpenSurfaceError(
                f"the surface encloses nothing: {counted(len(self.boundary), 'edge')} "
                f"{agreed(len(self.boundary), 'has', 'have')} only one face, first between the "
                f"points {a} and {b}; `error.edges` lists all of them: close the holes there",
                edges=self.boundary,
            )
        raise InputError("the surface encloses nothing" if self.nedges else "there are no faces")

    def __str__(self) -> str:
        return "\n".join([self._head(), self._parts(), *self._faults(), *self._pairs()])

    def _head(self) -> str:
        words = [
            "closed" if self.closed else "open",
            *(["oriented"] if self.oriented else ["inconsistently oriented"]),
            *(["manifold"] if self.manifold else ["non-manifold"]),
        ]
        head = (
            f"{', '.join(words)} surface of {counted(self.nfaces, 'face')} "
            f"and {counted(self.nedges, 'edge')}"
        )
        # NaN is unequal to itself.
        return f"{head}, volume {self.volume:.6g}" if self.volume == self.volume else head

    def _parts(self) -> str:
        line = counted(self.ncomponents, "component")
        return line if self.nregions is None else f"{line}, {_enclosed(self.nregions)}"

    def _faults(self) -> list[str]:
        found: list[tuple[Rows, str, str]] = [
            (self.boundary, "edge", "with one face"),
            (self.nonmanifold_edges, "edge", "with three faces or more"),
            (self.misoriented_edges, "edge", "with faces of inconsistent orientation"),
            (self.nonmanifold_vertices, "vertex", "whose faces are not one fan"),
            (self.repeated_vertices, "face", "with a repeated vertex"),
            (self.collinear, "face", "with collinear corners"),
            (self.duplicate_faces[:, 0], "face", "that repeat others"),
            (self.duplicate_points[:, 0], "point", "with the coordinates of others"),
            (self.dangling, "face", "with the same region on both sides"),
        ]
        return [
            f"{counted(len(rows), noun)} {what}: {_listed(rows)}"
            for rows, noun, what in found
            if len(rows)
        ]

    def _pairs(self) -> list[str]:
        if not self.npairs:
            return ["no faces cross or touch"]
        lines = []
        for kind, count in self.counts.items():
            if count:
                crossing = int(self.crossing[self.kinds == kind].sum())
                rows = self.pairs[self.kinds == kind]
                note = f", {crossing} of them crossing" if 0 < crossing < count else ""
                lines.append(f"{counted(count, 'pair')} of faces, {kind}{note}: {_listed(rows)}")
        if self.ntouching and not self.ncrossing:
            lines.append("no faces cross: resolve_touches subdivides those that touch")
        if len(self.pairs) < self.npairs:
            lines.append(f"{len(self.pairs)} pairs are listed: raise the limit for more")
        return lines


def _enclosed(count: int) -> str:
    return f"{counted(count, 'enclosed region')}" if count else "nothing is enclosed"


def _listed(rows: Rows) -> str:
    shown = rows.tolist() if rows.ndim == 1 else ["-".join(map(str, row)) for row in rows.tolist()]
    return listed(shown, _SHOWN)


def crossing_error(pairs: Rows, kinds: NDArray[np.str_], count: int) -> CrossingFacesError:
    """Return the error that names the pairs of faces that cross."""
    what = f"{counted(count, 'pair')} of faces {agreed(count, 'crosses', 'cross')}"
    if len(pairs):
        what += f", first {pairs[0, 0]} and {pairs[0, 1]} ({kinds[0]})"
    return CrossingFacesError(
        f"{what}; `error.pairs` and `error.kinds` list them: repair the surface there, or cut the "
        "faces with imprint_surface",
        pairs=pairs,
        kinds=kinds,
        count=count,
    )
