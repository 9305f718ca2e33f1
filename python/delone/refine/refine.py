"""The function `mesh`: the input becomes a constrained triangulation, which is then refined.

The core inserts the vertices (its module comment names the papers). This module converts the input
to domains, assigns markers, and starts the rounds that evaluate varying sizes.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import (
    as_callback,
    as_count,
    as_flag,
    as_limit,
    as_plain_array,
    as_workers,
    refuse_masks,
)
from delone._base.counting import listed
from delone._base.values import as_labels, require_shape
from delone.constrained import geodata
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.polygons import inside_of
from delone.constrained.segments import open_ends
from delone.errors import DtypeError, InputError
from delone.refine import domains
from delone.refine.domains import Domain
from delone.refine.meshed import Mesh
from delone.refine.rounds import MOST_ADDED, Limits, as_min_angle, rounds

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Indices

__all__ = ["filled", "mesh"]

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
    """Fill a domain with triangles that have no small angles.

    Parameters
    ----------
    domain : ConstrainedDelaunay, tuple of two arrays, or geometry
        What is meshed: the triangles of a constrained triangulation; the area that segments
        enclose, as ``(points, segments)``; or the inside of polygons, in any form that
        `from_geometry` accepts, such as a ring of coordinates (k, 2), with lines and points in them
        as further edges and vertices. If there are only lines, what they enclose is meshed.
    min_angle : float, optional
        Lower bound on angles in degrees, from 0 to below 60. Smaller angles remain only where the
        angles of the input force them. Refinement terminates in practice up to 33 degrees; above
        that, the limit on points is often reached first.
    max_area : float or mapping, optional
        Largest area of a triangle, up to rounding of its area, in the square of the unit of the
        points; or a mapping from regions to areas.
    size : float, mapping, callable, tuple or DataArray, optional
        Target edge length: no triangle is larger than the equilateral one with that edge. A number;
        a mapping from regions to numbers; a function that takes positions (k, 2) and returns k
        lengths; ``(triangulation, values)`` with a length for each of its points, linear in
        between; or an xarray DataArray with dimensions y and x, linear between cells.
    max_points : int, optional
        Maximum number of added points; by default 5,000,000. Sizes that require more raise an error
        before refinement starts. If angles need more, refinement stops at the limit, and the report
        of the mesh says so. Needles between lines that nearly touch may use 1/64 of it in total;
        needles that need more are not refined, and the report lists them.
    conforming : bool, optional
        Segments are edges of the mesh or chains of edges. This is always the case; the only valid
        value is True.
    delaunay : bool, optional
        Make every triangle Delaunay, even across segments, at the cost of more points: the
        diametral circles of subsegments are emptied, not only the lenses inside them.
    smooth : int, optional
        Number of iterations of ``Mesh.smooth`` at the end.
    holes, regions : array_like, optional
        Seeds, as for `ConstrainedDelaunay`; only with ``(points, segments)``.
    fixed : bool, "boundary" or array_like of bool, shape (s,), optional
        Segments that must not be split: all of them, those on the boundary, or those in a mask.
        Angles next to them may stay small.
    segment_markers : array_like of int, shape (s,), optional
        A number for each segment, which its subsegments and the points on them inherit; 0 means
        none. By default the segments of geometries are numbered by ring or line: 1 for the first
        ring, 2 for the next, in the order of the coordinates. Segments from arrays have 0.
    point_markers : array_like of int, shape (n,), optional
        A number for each point. Where it is 0, the marker of a segment that ends there is used.
    crossing : {"split", "raise"}, optional
        Whether crossing segments are split or raise an error: by default geometries are split, and
        arrays raise an error.
    progress : callable, optional
        Called regularly with the number of added points and the smallest angle in degrees.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        As for `from_geometry`: treat longitudes and latitudes as coordinates of a plane.

    Returns
    -------
    Mesh
        The mesh, immutable. If a limit was reached, or angles of the input do not allow the bound,
        its ``report`` says so and lists the triangles.

    Raises
    ------
    InputError
        `min_angle` is not in [0, 60); a size is NaN, zero or negative (the message gives the
        position); the segments do not enclose anything; an argument does not fit the domain.
    BudgetExceededError
        The sizes require more points than `max_points`.
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
    off-centers (A. Üngör 2004), splits at powers of two around sharp corners, and the rule of
    Miller, Pav and Walkington (2005) for the triangles there. It terminates in practice for angles
    up to 33 degrees (close relatives provably up to 20.7 and 26.6 degrees, see the mathematics
    page), unless `max_points` stops it earlier. A needle between lines, such as a triangle of
    height h over a side of length 1, takes about 0.5 / h points at 25 degrees and 0.1 / h at 5,
    unless its sides happen to be split in the same way, like sides of equal length: then one point
    may be enough. Needles are refined last. Refinement takes about a microsecond per triangle, and
    memory is linear.

    Next to fixed segments, no bound holds, and if sizes are given, angles there may become far
    smaller than those of the input: points are added as close to the segment as the size requires,
    but the segment must not be split. Sizes equal to the lengths of the fixed segments avoid this.

    Points on segments are rounded to doubles, so a segment may bend there by the rounding error.

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
        MOST_ADDED if max_points is None else as_limit(max_points, name="max_points"),
        as_flag(delaunay, name="delaunay"),
        as_callback(progress, name="progress"),
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
    """Mesh the triangles of a constrained triangulation, whose regions are `region`.

    `sizes` are `max_area` and `size` of `mesh`, `markers` those of segments and points. Seconds are
    added to `stages`.
    """
    clock = time.perf_counter()
    if not base.nsimplex:
        raise InputError(f"the domain is empty: {_why_empty(base)}")
    part = base.part_of_segment
    start = domains.of_constrained(
        base,
        region=region,
        segment_markers=_segment_markers(part, markers[0]),
        point_markers=as_labels(markers[1], base.npoints - base.nadded, name="point_markers"),
        frozen=_fixed(fixed, len(part)),
    )
    if isinstance(fixed, str):
        start = start._replace(lines=start.lines._replace(frozen=_on_boundary(start)))
    made, counts = rounds(start, sizes, limits)
    stages["refine"] = time.perf_counter() - clock
    return Mesh._of(made, counts, limits.min_angle, stages, limits.workers)._refer(base)


def _segment_markers(part: Indices, given: ArrayLike | None) -> Indices:
    """Return the given markers; by default one for each ring and line of geometries."""
    if given is None:
        return part + np.int32(1)
    return as_labels(given, len(part), name="segment_markers")


def _fixed(fixed: bool | str | ArrayLike, count: int) -> Bools:
    wanted = "fixed must be a bool, 'boundary' or a mask"
    if isinstance(fixed, str):
        if fixed != "boundary":
            raise InputError(f"{wanted}, got {fixed!r:.80}")
        return np.zeros(count, dtype=bool)
    array = as_plain_array(fixed, "fixed")
    if array.dtype.kind != "b":
        raise DtypeError(f"{wanted}, got an array of dtype {array.dtype}")
    if array.ndim:
        require_shape(array, (count,), "fixed")
    return np.broadcast_to(array, (count,)).copy()


def _on_boundary(domain: Domain) -> Bools:
    """Return which lines have the domain on one side only."""
    sides = domains.sides_in(domain)[domain.labels >= 0]
    found: Bools = np.bincount(sides[sides >= 0], minlength=len(domain.lines.ends)) == 1
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
    pair = isinstance(domain, tuple) and len(domain) == 2 and not geodata.is_geometry(domain[0])
    if not pair and (holes is not None or regions is not None):
        raise InputError("holes and regions are only supported with (points, segments)")
    if isinstance(domain, ConstrainedDelaunay):
        if crossing is not None:
            raise InputError("crossing cannot be set for a ConstrainedDelaunay")
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
        # A ring of coordinates that crosses itself is more likely a set of points.
        rings = geodata.rings_of_numbers(domain, "domain")
        how = crossing or ("split" if rings is None else "raise")
        domain = domain if rings is None else geodata.polygon_of(rings)
        base = inside_of(domain, crossing=how, workers=workers, planar=planar)
        region = base.polygon_of_simplex if base._options.boundary == "polygons" else base.region
    return base, region


def _refuse_points(domain: Any) -> None:
    """Reject points without segments, and suggest what to pass instead."""
    refuse_masks(domain, "domain")
    first = domain[0] if isinstance(domain, list | tuple | np.ndarray) and len(domain) else ()
    if isinstance(first, list | tuple | np.ndarray) and (
        len(first) == 3 or (len(first) == 2 and len(domain) < 3)
    ):
        numbers = all(isinstance(each, int | float | np.number) for each in first)
        if numbers:
            raise InputError(
                "the domain is points without segments, which do not enclose anything: pass "
                "(points, segments), or a ring of at least three points in 2-D; "
                "for the convex hull, pass delone.ConstrainedDelaunay(points, [])"
            )


def _why_empty(base: ConstrainedDelaunay) -> str:
    """Return why no triangle is left; for an open outline, with its loose ends."""
    if base._options.boundary == "hull":
        return "the holes removed all triangles"
    loose = open_ends(base.segments, base.simplices, base.npoints)
    if not loose.size:
        return "the segments form no closed ring, or only rings around holes"
    positions = ", ".join(f"({x!r}, {y!r})" for x, y in base.points[loose[:3]].tolist())
    rows = listed(loose, _FIRST)
    return f"the outline is open: only one segment ends at points {rows}, the first at {positions}"
