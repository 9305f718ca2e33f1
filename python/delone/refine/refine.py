"""Meshes of domains: what is given becomes a constrained triangulation, and that is refined.

The core inserts the vertices (its head names the papers); here are the domains that it is given,
the markers that go along, and the rounds in which sizes that vary are asked for.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import (
    as_choice,
    as_count,
    as_flag,
    as_plain_array,
    as_workers,
)
from delone._masks import refuse_masks
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.polygons import from_geometry
from delone.errors import DtypeError, InputError, ShapeError
from delone.refine import domains
from delone.refine.domains import Domain
from delone.refine.meshed import Mesh
from delone.refine.rounds import MOST_ADDED, Limits, as_min_angle, rounds

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["as_rows", "filled", "mesh"]

_FIRST = 10
_DOMAINS = "a ConstrainedDelaunay, (points, segments) or geometries"


def mesh(
    domain: Any,
    *,
    min_angle: float = 30.0,
    max_area: Any = None,
    size: Any = None,
    max_points: int | None = None,
    conforming: bool = True,
    delaunay: bool = False,
    smooth: int = 0,
    holes: ArrayLike | None = None,
    regions: ArrayLike | None = None,
    fixed: bool | str | ArrayLike = False,
    segment_markers: ArrayLike | None = None,
    point_markers: ArrayLike | None = None,
    crossing: str | None = None,
    progress: Callable[[int, float], object] | None = None,
    workers: int | None = None,
    planar: bool = False,
) -> Mesh:
    """Fill a domain with triangles that have no small angle.

    Parameters
    ----------
    domain : ConstrainedDelaunay, tuple of two arrays, or geometry
        What is meshed: the triangles that a constrained triangulation keeps; the area that segments
        enclose, as ``(points, segments)``; or the inside of polygons, whatever `from_geometry`
        takes, with lines and points in them as further edges and vertices.
    min_angle : float, optional
        No angle is smaller, in degrees, except where the angles of the input force it: at least 0
        and below 60. Up to 26 the end is proven, up to 33 it comes in practice, and above often not
        before the limit on points.
    max_area : float or mapping, optional
        No triangle is larger, but for the rounding of its area, in the square of the unit of the
        points; a mapping has areas by region.
    size : float, mapping, callable, tuple or DataArray, optional
        The length of edges that is wanted: no triangle is larger than the equilateral one with that
        edge. A number; a mapping of regions to numbers; a function that takes places (k, 2) and
        returns k lengths; ``(triangulation, values)`` with a length for each of its points, linear
        in between; or a DataArray of xarray with dimensions y and x, linear between cells.
    max_points : int, optional
        How many points may be added; by default 5,000,000. Sizes that cannot do with so few are
        refused before the work starts. Where angles need more, the work ends there, and the report
        of the mesh says so. Needles between lines that nearly touch may take 1/64 of it together;
        those that need more are left, and the report says where.
    conforming : bool, optional
        Segments are edges of the mesh or chains of edges: always so, the only choice is True.
    delaunay : bool, optional
        Make every triangle Delaunay, also across segments, at the price of more points: the circles
        over the pieces of segments are emptied, not only lenses in them.
    smooth : int, optional
        How many rounds of ``Mesh.smooth`` follow.
    holes, regions : array_like, optional
        Seeds, as for `ConstrainedDelaunay`; for ``(points, segments)`` alone.
    fixed : bool, "boundary" or array_like of bool, shape (s,), optional
        Segments that may not be split: all, those on the boundary, or those named. Angles next to
        them may stay small.
    segment_markers : array_like of int, shape (s,), optional
        A number for each segment, which its pieces and the points on them inherit; 0 is none. By
        default the segments of geometries are numbered by ring or line: 1 for the first ring, 2 for
        the next, in the order of the coordinates. Those of arrays have 0.
    point_markers : array_like of int, shape (n,), optional
        A number for each point. Where it is 0 the marker of a segment that ends there counts.
    crossing : {"split", "raise"}, optional
        Whether segments that cross get a vertex there: by default geometries do and arrays do not.
    progress : callable, optional
        Called now and then with the number of points added and the smallest angle in degrees.
    workers : int, optional
        Number of threads; by default one for each core. The result is the same.
    planar : bool, optional
        As for `from_geometry`: longitudes and latitudes are meant as coordinates of a plane.

    Returns
    -------
    Mesh
        The mesh, immutable. Where a limit ended the work, or angles of the input do not allow the
        bound, its ``report`` says so and names the triangles.

    Raises
    ------
    InputError
        `min_angle` is not in [0, 60); a size is NaN, zero or negative, then the message names the
        place; the segments enclose nothing; an argument does not fit the domain.
    BudgetExceededError
        The sizes ask for more than `max_points`.
    CrossingSegmentsError, DegenerateInputError, NonFiniteError, ShapeError, DtypeError
        As for `ConstrainedDelaunay`.
    KeyboardInterrupt
        Ctrl-C was pressed.

    Warns
    -----
    UserWarning
        `min_angle` is above 33.

    Notes
    -----
    Delaunay refinement (J. Ruppert 1995) with the diametral lenses of L. P. Chew (1993),
    off-centres (A. Üngör 2004), cuts at powers of two around sharp corners, and the rule of Miller,
    Pav and Walkington (2005) for triangles there, so that it ends for angles up to 26 degrees, in
    practice up to 33, unless `max_points` ends it before. A needle between lines, like a triangle
    of height h over a side of length 1, takes about 0.5 / h points at 25 degrees and 0.1 / h at 5,
    unless its sides happen to be cut alike, as two of equal length are: then one may do. All else
    is refined before needles are. Time is about a microsecond a triangle, memory linear.

    Next to fixed segments no bound holds, and with sizes angles there may become far smaller than
    those of the input: points come as near to the segment as the size asks for, and it may not be
    split. Sizes of the length of the fixed segments keep what there was.

    Points on segments are rounded to doubles, so that pieces of a segment may bend by that much.

    Examples
    --------
    >>> import delone
    >>> outer, inner = [(0, 0), (6, 0), (6, 6), (0, 6)], [(2, 2), (4, 2), (4, 4), (2, 4)]
    >>> rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    >>> mesh = delone.mesh((outer + inner, rings), holes=[(3, 3)], size=1)
    >>> bool(mesh.report), float(mesh.areas.sum())
    (True, 32.0)
    >>> square = {"type": "Polygon", "coordinates": [outer]}
    >>> near = delone.mesh(square, size=lambda xy: 0.1 + 0.3 * xy[:, 0])
    >>> left, right = near.areas[near.find_simplex([(0.1, 3), (5.5, 3)])]
    >>> bool(10 * left < right)
    True
    """
    if not as_flag(conforming, name="conforming"):
        raise InputError("a mesh always conforms to its segments: conforming must be True")
    limits = Limits(
        as_min_angle(min_angle),
        MOST_ADDED if max_points is None else as_count(max_points, name="max_points"),
        as_flag(delaunay, name="delaunay"),
        progress,
        workers,
    )
    as_workers(workers)
    rounds = as_count(smooth, name="smooth")
    clock = time.perf_counter()
    base, region = _base(domain, holes, regions, crossing, workers=workers, planar=planar)
    stages = {"triangulate": time.perf_counter() - clock}
    found = filled(
        base,
        region,
        limits,
        sizes=(max_area, size),
        fixed=fixed,
        markers=(segment_markers, point_markers),
        stages=stages,
    )
    return found.smooth(rounds) if rounds else found


def filled(
    base: ConstrainedDelaunay,
    region: Indices,
    limits: Limits,
    *,
    sizes: tuple[Any, Any],
    fixed: bool | str | ArrayLike,
    markers: tuple[ArrayLike | None, ArrayLike | None],
    stages: dict[str, float],
) -> Mesh:
    """Mesh what a constrained triangulation keeps.

    Parameters
    ----------
    base : ConstrainedDelaunay
        The triangulation.
    region : ndarray of int32, shape (m,)
        The region of each of its triangles.
    limits : Limits
        How far.
    sizes : tuple
        `max_area` and `size` of `mesh`.
    fixed : bool, "boundary" or array_like of bool
        As for `mesh`.
    markers : tuple
        `segment_markers` and `point_markers` of `mesh`.
    stages : dict
        Seconds so far, by stage; those of the refinement are added.

    Returns
    -------
    Mesh
        The mesh.

    Raises
    ------
    InputError
        As for `mesh`.
    """
    clock = time.perf_counter()
    if not base.nsimplex:
        raise InputError(f"the domain has no inside: {_why_empty(base)}")
    count = len(base.input_segments)
    start = domains.of_constrained(
        base,
        region=region,
        segment_markers=_segment_markers(base, markers[0]),
        point_markers=as_rows(markers[1], base.npoints - base.nadded, "point_markers"),
        frozen=_fixed(fixed, count),
    )
    if isinstance(fixed, str):
        start = start._replace(lines=start.lines._replace(frozen=_on_boundary(start)))
    made, counts = rounds(start, sizes, limits)
    stages["refine"] = time.perf_counter() - clock
    return Mesh._of(made, counts, limits.min_angle, stages, limits.workers)


def as_rows(values: ArrayLike | None, count: int, name: str) -> Indices:
    """Return a number for each row; 0 where nothing is given.

    Parameters
    ----------
    values : array_like of int, shape (count,) or (count, 1), or None
        The numbers.
    count : int
        How many there must be.
    name : str
        What the argument is called in error messages.

    Returns
    -------
    ndarray of int32, shape (count,)
        The numbers.

    Raises
    ------
    ShapeError, DtypeError, InputError
        There are more or fewer, or they are no integers of 32 bits.

    Examples
    --------
    >>> from delone.refine.refine import as_rows
    >>> as_rows(None, 2, "markers"), as_rows([[3], [4]], 2, "markers")
    (array([0, 0], dtype=int32), array([3, 4], dtype=int32))
    """
    if values is None:
        return np.zeros(count, dtype=np.int32)
    array = as_plain_array(values, name)
    if array.shape not in ((count,), (count, 1)):
        raise ShapeError(f"{name} must have shape ({count},), got {array.shape}")
    if array.dtype.kind not in "iu" and array.size:
        raise DtypeError(f"{name} must be integers, got dtype {array.dtype}")
    limit = np.iinfo(np.int32)
    if array.size and (int(array.min()) < limit.min or int(array.max()) > limit.max):
        raise InputError(f"{name} must be integers of 32 bits")
    return array.reshape(count).astype(np.int32)


def _segment_markers(base: ConstrainedDelaunay, given: ArrayLike | None) -> Indices:
    """Return the markers given, or one for each ring and line of geometries."""
    if given is None:
        return base.part_of_segment + np.int32(1)
    return as_rows(given, len(base.input_segments), "segment_markers")


def _fixed(fixed: bool | str | ArrayLike, count: int) -> Bools:
    if isinstance(fixed, str):
        as_choice(fixed, ("boundary",), name="fixed")
        return np.zeros(count, dtype=bool)
    array = as_plain_array(fixed, "fixed")
    if array.dtype.kind != "b":
        raise DtypeError(f"fixed must be booleans or 'boundary', got dtype {array.dtype}")
    if array.shape not in ((), (count,)):
        raise ShapeError(f"fixed must have shape ({count},), got {array.shape}")
    return np.broadcast_to(array, (count,)).copy()


def _on_boundary(domain: Domain) -> Bools:
    """Tell which lines have the domain on one side only."""
    t, k = np.nonzero((domain.sides >= 0) & (domain.labels[:, None] >= 0))
    sides = np.bincount(domain.sides[t, k], minlength=len(domain.lines.ends))
    found: Bools = sides == 1
    return found


def _base(
    domain: Any,
    holes: ArrayLike | None,
    regions: ArrayLike | None,
    crossing: str | None,
    *,
    workers: int | None,
    planar: bool,
) -> tuple[ConstrainedDelaunay, Indices]:
    """Return a constrained triangulation of the domain, and the region of each triangle."""
    pair = isinstance(domain, tuple) and len(domain) == 2 and not _is_geometry(domain[0])
    if not pair and (holes is not None or regions is not None):
        raise InputError("holes and regions go with (points, segments) only")
    if isinstance(domain, ConstrainedDelaunay):
        if crossing is not None:
            raise InputError("crossing is settled where a ConstrainedDelaunay is given")
        base, region = domain, domain.region
    elif pair:
        base = ConstrainedDelaunay(
            *domain,
            holes=holes,
            regions=regions,
            boundary="outline",
            crossing=crossing or "raise",
            workers=workers,
            planar=planar,
        )
        region = base.region
    elif domain is None:
        raise DtypeError(f"domain must be {_DOMAINS}, got None")
    else:
        _refuse_points(domain)
        base = from_geometry(
            domain,
            boundary="polygons",
            crossing=crossing or "split",
            workers=workers,
            planar=planar,
        )
        region = base.polygon
    return base, region


def _refuse_points(domain: Any) -> None:
    """Refuse points alone, and say of what they may be the corners."""
    refuse_masks(domain, "domain")
    first = domain[0] if isinstance(domain, list | tuple | np.ndarray) and len(domain) else ()
    if isinstance(first, list | tuple | np.ndarray) and len(first) in (2, 3):
        numbers = all(isinstance(each, int | float | np.number) for each in first)
        if numbers:
            raise InputError(
                "the domain is points alone, which enclose nothing: give (points, segments), "
                'or the ring as {"type": "Polygon", "coordinates": [points]}; of the convex hull '
                "give delone.ConstrainedDelaunay(points, [])"
            )


def _is_geometry(thing: Any) -> bool:
    return isinstance(thing, dict) or any(
        hasattr(thing, name) for name in ("geom_type", "__geo_interface__")
    )


def _why_empty(base: ConstrainedDelaunay) -> str:
    """Say why no triangle is left; where an outline is open, at which vertices with one segment."""
    if base._options.boundary == "hull":
        return "holes took all triangles of the triangulation"
    degree = np.bincount(base.segments.ravel(), minlength=base.npoints)
    loose = np.flatnonzero(degree == 1)
    if not loose.size:
        return "no ring of segments encloses anything that is no hole"
    rows = ", ".join(map(str, loose[:_FIRST].tolist())) + (", ..." if loose.size > _FIRST else "")
    places = ", ".join(f"({x!r}, {y!r})" for x, y in base.points[loose[:3]].tolist())
    return f"the outline is open; only one segment ends at points {rows}, the first at {places}"
