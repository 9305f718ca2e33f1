"""The class ConstrainedDelaunay of directions: its edges include arcs of great circles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_flag, as_limit, as_segments, as_workers
from delone._base.counting import counted
from delone._base.immutable import kept, sealed
from delone._base.renames import renamed
from delone.constrained import segments
from delone.errors import CrossingSegmentsError, DirectionError, InternalError
from delone.sphere.coordinates import directions_of, lonlat_of
from delone.sphere.crossings import split
from delone.sphere.delaunay import Delaunay
from delone.sphere.land import Rings, first_polygon
from delone.sphere.sides import Origin

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.constrained.segments import SegmentReport
    from delone.sphere.validation import ConstrainedSphereReport

__all__ = ["WINDINGS", "ConstrainedDelaunay", "Given", "most_added"]

_CROSSINGS = ("raise", "split")
WINDINGS = ("ccw", "cw", "smaller")
# The number of vertices that a call may add by default.
_MOST_ADDED = 1_000_000


class Given(NamedTuple):
    """The input of a constrained triangulation other than directions."""

    # (s, 2): the segments.
    segments: Indices
    origin: Origin
    # Which side of outer rings is their inside.
    winding: str
    # The given vectors, without added ones.
    npoints: int

    def sealed(self) -> Given:
        """Return a copy with read-only arrays."""
        origin = Origin._make(map(sealed, self.origin))
        return self._replace(segments=sealed(self.segments), origin=origin)


@renamed(polygon="polygon_of_simplex")
class ConstrainedDelaunay(segments.SegmentArrays, Delaunay):
    """The constrained Delaunay triangulation of directions and arcs: coastlines on the sphere.

    Parameters
    ----------
    lonlat : array_like, shape (n, 2), optional
        Longitudes and latitudes, as for `Delaunay`.
    xyz : array_like, shape (n, 3), optional
        Vectors of any length. Give either this or `lonlat`.
    segments : array_like of int, shape (s, 2)
        Arcs that the triangulation must contain, as pairs of rows: the shorter arc of the great
        circle through both. They may repeat, overlap, have zero length or pass through points;
        `report` lists those that do. May be empty.
    crossing : {"raise", "split"}, optional
        Whether arcs that cross raise an error, or are split at a new vertex.
    max_points : int, optional
        Maximum number of added vertices; by default 1,000,000.
    degrees : bool, optional
        Whether angles are in degrees (the default) or in radians.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    vectors : ndarray of float64, shape (n + nadded, 3)
        The given vectors, then the crossings.
    constrained : ndarray of bool, shape (m, 3)
        Whether the edge opposite vertex k of triangle t is part of an arc.
    segments : ndarray of int32, shape (q, 2)
        The subsegments: the edges into which points split the arcs.

    Raises
    ------
    CrossingSegmentsError
        Arcs cross, and `crossing` is ``"raise"``; ``error.pairs`` has the pairs of their rows
        (2**20 at most), and ``error.points`` where they cross: longitudes and latitudes, rounded.
    BudgetExceededError
        More than `max_points` vertices would have to be added.
    DirectionError
        The ends of an arc are opposite directions, so neither arc is shorter; ``error.rows`` has
        the first such rows of `segments`. Or as for `Delaunay`.
    InputError
        A segment refers to a row that does not exist; the message names the rows.
    DegenerateInputError, NonFiniteError, ShapeError, DtypeError, MemoryError, KeyboardInterrupt
        As for `Delaunay`.

    Warns
    -----
    LongitudeWarning
        As for `Delaunay`.

    Notes
    -----
    Each edge that is not part of an arc is locally Delaunay: no direction that is visible from its
    triangles, without crossing an arc, lies inside their circles. Ties are broken as in `Delaunay`,
    so a set of directions and arcs has one triangulation, whatever the order and the lengths of the
    rows. An arc that passes exactly through a direction is split there. Predicates are exact, so an
    arc that misses it by any amount is not.

    Arcs that cross are split at their exact intersection, each coordinate of which is rounded once.
    The parts bend there by the rounding error; parts that cross others for that reason are split
    again. This is done in Python, because real borders have few crossings.

    Arcs are inserted into the Delaunay triangulation by the same code as in the plane (M. V.
    Anglada, "An improved incremental algorithm for constructing restricted Delaunay
    triangulations", 1997): most sides of a coast are edges already, and an arc that crosses k edges
    takes about k log k steps. `nearest` uses a second triangulation, without arcs, which is
    computed on first use.

    See Also
    --------
    from_geometry : The same for polygons, with land and sea.
    delone.ConstrainedDelaunay : The same in the plane.

    Examples
    --------
    >>> from delone import sphere
    >>> ring = [(170, -10), (-170, -10), (-170, 10), (170, 10)]
    >>> mesh = sphere.ConstrainedDelaunay(
    ...     lonlat=[*ring, (180, 3), (0, 0), (0, 90), (0, -90)],
    ...     segments=[(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)],
    ... )
    >>> mesh
    <ConstrainedDelaunay of 8 directions and 5 segments: 12 triangles, the whole sphere>
    >>> int(mesh.region.max()) + 1
    3
    """

    __slots__ = ("_given", "_made")

    _given: Given
    _made: _core.ConstrainedTriangulation

    def __init__(
        self,
        *,
        lonlat: ArrayLike | None = None,
        xyz: ArrayLike | None = None,
        segments: ArrayLike,
        crossing: str = "raise",
        max_points: int | None = None,
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        as_flag(degrees, name="degrees")
        most = most_added(crossing, max_points)
        vectors = directions_of(lonlat, xyz, degrees=degrees, workers=workers)
        rows = np.array(as_segments(segments, len(vectors)))
        origin = Origin.of_arrays(len(rows))
        self._compute(vectors, Given(rows, origin, "ccw", len(vectors)), most, degrees, workers)

    @classmethod
    def _of_geometries(
        cls, vectors: Floats, given: Given, most: int | None, degrees: bool, workers: int | None
    ) -> Self:
        """Triangulate private arrays, with the origin of each segment."""
        made = cls.__new__(cls)
        made._compute(vectors, given, most, degrees, workers)
        return made

    def _compute(
        self, vectors: Floats, given: Given, most: int | None, degrees: bool, workers: int | None
    ) -> None:
        """Let the core triangulate; split crossings if a limit for them is given."""
        try:
            if most is None:
                made = _core.sphere_constrained(vectors, given.segments, as_workers(workers))
            else:
                vectors, made = split(vectors, given.segments, most, as_workers(workers))
        except InternalError as error:
            error.points = vectors
            raise
        except CrossingSegmentsError as error:
            raise _with_places(error, vectors, given.segments) from None
        except DirectionError as error:
            raise _between_opposites(error, vectors, given) from None
        self._put(vectors, given, made, degrees, workers)

    def _put(
        self,
        vectors: Floats,
        given: Given,
        made: _core.ConstrainedTriangulation,
        degrees: bool,
        workers: int | None,
    ) -> None:
        made = _core.ConstrainedTriangulation(*map(sealed, made.arrays()))
        self._hold(
            vectors=sealed(vectors),
            simplices=made.simplices,
            neighbors=made.neighbors,
            duplicates=made.duplicates,
            degrees=degrees,
            workers=workers,
            made=made,
            given=given.sealed(),
        )

    @classmethod
    def _restored(cls, *values: Any) -> Self:
        made = cls.__new__(cls)
        made._put(*values)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        values = (self._vectors, self._given, self._made, self._degrees, self._workers)
        return type(self)._restored, values

    def _saved(self) -> dict[str, NDArray[Any]]:
        made, given = self._made, self._given
        names = "segments", "source_start", "source", "forward", "zero", "through", "crossings"
        options = self._degrees, WINDINGS.index(given.winding), given.npoints
        return (
            self._arrays()
            | {"constrained": made.constrained}
            | {name: getattr(made, name) for name in names}
            | {"input": given.segments, **given.origin._asdict()}
            | {"options": np.array(options, dtype=np.int64)}
        )

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        degrees, winding, npoints = arrays["options"].tolist()
        origin = Origin(*(arrays[name] for name in Origin._fields))
        given = Given(arrays["input"], origin, WINDINGS[winding], npoints)
        made = _core.ConstrainedTriangulation(
            np.empty((0, 2)),
            *(arrays[name] for name in ("simplices", "neighbors", "constrained", "duplicates")),
            *(arrays[name] for name in ("segments", "source_start", "source", "forward")),
            *(arrays[name] for name in ("zero", "through", "crossings")),
        )
        return cls._restored(arrays["vectors"], given, made, bool(degrees), None)

    def validate(self) -> ConstrainedSphereReport:
        """Prove that this is the canonical constrained triangulation, or list the faults.

        Returns
        -------
        ConstrainedSphereReport
            Truthy if there are no faults: triangles are counter-clockwise and tile the sphere or
            the exact hull, each edge is a subsegment or locally Delaunay, ties are broken
            canonically, and the subsegments of each row form a path from one end to the other,
            which is straight if the row has no crossings.

        Notes
        -----
        As for `Delaunay.validate`.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(0, 0), (90, 0), (0, 90), (-135, -35)]
        >>> print(sphere.ConstrainedDelaunay(lonlat=sites, segments=[(0, 1)]).validate())
        a canonical constrained Delaunay triangulation of directions
        """
        from delone.sphere.validation import validate_constrained

        ends = self.duplicate_of[self._given.segments]
        return validate_constrained(self._vectors, self.points, self._made, ends, self.nadded)

    def _counts(self) -> str:
        return f"{super()._counts()} and {counted(len(self._given.segments), 'segment')}"

    @property
    def constrained(self) -> Bools:
        """Whether the edge opposite each vertex is part of an arc, (m, 3)."""
        return self._made.constrained

    @property
    def nadded(self) -> int:
        """Number of added vertices; they are the last rows of `vectors`."""
        return len(self._vectors) - self._given.npoints

    @property
    @kept
    def report(self) -> SegmentReport:
        """The input report: duplicates, overlaps and more, row by row."""
        ends = self.duplicate_of[self._given.segments]
        return segments.SegmentReport(**segments.listed(self._made, ends))

    @property
    @kept
    def _component(self) -> Indices:
        return _core.components2(self._neighbors, self._made.constrained)

    @property
    @kept
    def region(self) -> Indices:
        """The region of each triangle, (m,): the same where no arc separates triangles.

        Regions are numbered from 0 in the order of their smallest triangles. Triangles are compared
        by their smallest corners, then their middle ones, then their largest; corners by the
        coordinates of `points`, x first.
        """
        return sealed(_core.numbered_components(self.points, self._simplices, self._component))

    @property
    @kept
    def polygon_of_simplex(self) -> Indices:
        """The first polygon that contains each triangle, (m,), as the number of its geometry.

        -1 if there is none, such as the sea if polygons are land, and in triangulations of arrays.
        See `from_geometry` for the rule.
        """
        component = self._component
        given = self._given
        rings = Rings(given.origin, self.duplicate_of[given.segments], given.winding)
        found = first_polygon(self._made, self.areas, component, rings)
        return sealed(found[component])

    @property
    @kept
    def _bare(self) -> Delaunay:
        """The triangulation without arcs, whose edges lead to the nearest vertex."""
        return Delaunay(xyz=self._vectors, workers=self._workers)

    def nearest(self, xi: ArrayLike) -> Indices:
        """Return the rows of the points nearest to directions, whatever arcs are between them.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.

        Returns
        -------
        ndarray of int32, shape (...)
            As `Delaunay.nearest`.

        Raises
        ------
        DirectionError
            A latitude is beyond a pole, or a longitude exceeds three turns.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2) or (..., 3).

        Examples
        --------
        >>> from delone import sphere
        >>> mesh = sphere.ConstrainedDelaunay(
        ...     lonlat=[(170, 0), (-170, 0), (180, 10), (180, -10)], segments=[(2, 3)]
        ... )
        >>> mesh.nearest([(175, 1), (-171, 1)])
        array([0, 1], dtype=int32)
        """
        return self._ask(xi, self._bare._locator.nearest)


def most_added(crossing: str, max_points: int | None) -> int | None:
    """Return how many vertices may be added; None if crossings are errors."""
    most = _MOST_ADDED if max_points is None else as_limit(max_points, name="max_points")
    return most if as_choice(crossing, _CROSSINGS, name="crossing") == "split" else None


def _between_opposites(error: DirectionError, vectors: Floats, given: Given) -> DirectionError:
    """Return the error for a side between opposite directions, with its geometry and its ends.

    Errors about segments that the caller numbered stay unchanged.
    """
    row = int(error.rows[0])
    (a, b), geometry = given.segments[row], int(given.origin.geometries[row])
    if geometry < 0:
        return error
    places = [f"({x:.10g}, {y:.10g})" for x, y in lonlat_of(vectors[[a, b]]).tolist()]
    more = "" if error.count == 1 else f" ({error.count} do)"
    return DirectionError(
        f"a side of geometry {geometry} joins the opposite directions {places[0]} and {places[1]}"
        f"{more}, which no single shorter arc joins: add a point between them",
        rows=np.array([geometry]),
        count=error.count,
    )


def _with_places(
    error: CrossingSegmentsError, vectors: Floats, rows: Indices
) -> CrossingSegmentsError:
    """Return the error with the places where arcs cross, as longitudes and latitudes."""
    if not len(error.pairs):
        return error
    units = _core.sphere_units(vectors, 1)
    a, b, c, d = (units[rows[error.pairs[:, i]][:, j]] for i in (0, 1) for j in (0, 1))
    place = np.cross(np.cross(a, b), np.cross(c, d))
    place *= np.sign(np.einsum("kj,kj->k", place, a + b))[:, None]
    # For arcs between almost equal directions, rounding may leave no intersection.
    lost = ~place.any(axis=1)
    place[lost] = (a + b)[lost]
    points = lonlat_of(place)
    (s, t), (lon, lat) = error.pairs[0].tolist(), points[0].tolist()
    where = f"at longitude {lon:.6g}, latitude {lat:.6g}"
    count = len(points)
    text = f"{count} pairs of segments cross, first {s} and {t} {where}"
    if count == 1:
        text = f"segments {s} and {t} cross {where}"
    message = f'{text}; crossing="split" makes crossings vertices'
    return CrossingSegmentsError(message, pairs=error.pairs, points=points)
