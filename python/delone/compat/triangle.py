"""Drop-in replacement for the package ``triangle``: its functions, dictionaries and switches.

That package wraps J. R. Shewchuk's program Triangle (1996). Here the input and output keys are the
same, but delone does the work; no code of either is used. Vertices of the input keep their rows,
and added ones follow; the order of triangles and the positions of added vertices are delone's own.
"""

from __future__ import annotations

import re
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import LARGEST_LIMIT, as_points, as_segments
from delone._base.values import as_labels, require_mapping
from delone._tiling.plane import topology
from delone.compat.triangle_input import (
    Given,
    Switches,
    again,
    interpolated,
    keys_of,
    not_reached,
    rows_of,
)
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.errors import DtypeError, InputError
from delone.refine.meshed import Mesh
from delone.refine.refine import filled
from delone.refine.rounds import MOST_ADDED, Limits, as_min_angle

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices

__all__ = ["convex_hull", "delaunay", "triangulate", "voronoi"]

_KEYS = (
    "vertices", "vertex_attributes", "vertex_markers", "triangles", "triangle_attributes",
    "triangle_max_area", "segments", "segment_markers", "holes", "regions", "neighbors", "edges",
    "edge_markers",
)  # fmt: skip
_SWITCH = re.compile(r"([qaS])((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)?|([A-Za-z])")
_KNOWN = "pqaAcDejnrvXYS"
# Algorithms, verbosity and checks of Triangle, which do not change the result.
_WITHOUT_EFFECT = "XviFlsCQVz"
_REFUSED = {
    "u": "a test of triangles in C that is compiled into Triangle; use size= of delone.mesh",
    "o": "triangles of second order with six nodes",
    "B": "output without markers; leave out the keys",
    "P": "output without segments; leave out the key",
    "N": "output without vertices; leave out the key",
    "E": "output without triangles; leave out the key",
    "I": "iteration numbers in file names",
    "g": "Geomview files",
    "O": "ignored holes; leave out the key holes",
}
_DEFAULT_ANGLE = 20.0


def triangulate(tri: Mapping[str, Any], opts: str = "") -> dict[str, Any]:
    """Triangulate or mesh the contents of a dictionary.

    Parameters
    ----------
    tri : mapping
        Arrays by name: ``vertices`` (n, 2), ``vertex_attributes`` (n, k), ``vertex_markers``,
        ``segments`` (s, 2), ``segment_markers``, ``holes`` (h, 2), ``regions`` (r, 4) of x, y,
        attribute and maximum area; and for switch ``r``, ``triangles`` (m, 3),
        ``triangle_attributes`` (m, k) and ``triangle_max_area``.
    opts : str, optional
        Switches:

        - ``p``: the segments are edges; triangles outside them and in holes are removed;
        - ``c``: with or without ``p``, the convex hull is kept and bounded by segments;
        - ``q``: no angle below 20 degrees, or below the number that follows;
        - ``a``: no triangle larger than the number that follows; without a number, the areas of
          ``regions``, or with ``r`` of ``triangle_max_area``, are used if they are above 0;
        - ``A``: triangles get the attribute of their region, 0 without one;
        - ``D``: every triangle is Delaunay, including across segments;
        - ``r``: the given triangles are refined, together with ``q`` or ``a``;
        - ``S``: add at most this many vertices;
        - ``Y``: add none on the boundary; ``YY`` none on any segment. Triangles there may keep
          small angles and large areas: a warning says how many;
        - ``e``: return ``edges`` and ``edge_markers``; ``n``: return ``neighbors``;
        - ``j``: omit vertices that no triangle uses.

        ``X i F l s C Q V v z`` are accepted and change nothing: arithmetic is always exact, and as
        in the package, ``v`` returns nothing here; see `voronoi`. All other switches raise an error
        that names them.

    Returns
    -------
    dict
        ``vertices``, ``vertex_markers`` (n, 1), ``triangles``, and if requested or given
        ``vertex_attributes`` (linearly interpolated), ``triangle_attributes``, ``segments``,
        ``segment_markers``, ``neighbors``, ``edges``, ``edge_markers``, ``holes``, ``regions``.
        Boundary edges without a marker have 1, and so do boundary vertices.

    Raises
    ------
    InputError
        An unknown key, a switch that is not supported, or an outline that encloses no area.
    ShapeError, DtypeError, NonFiniteError, DegenerateInputError, BudgetExceededError
        As for `delone.mesh`.

    Warns
    -----
    UserWarning
        ``Y`` left segments unsplit at the expense of angles or areas. The message says how many
        triangles miss the requested bounds.

    Notes
    -----
    Without ``q``, ``a`` and ``D`` no vertex is added, except at crossings of segments, which become
    vertices as in Triangle. Where Triangle would terminate the process on bad input, an exception
    is raised.

    Examples
    --------
    >>> from delone.compat.triangle import triangulate
    >>> square = {"vertices": [(0, 0), (0, 1), (1, 1), (1, 0)]}
    >>> out = triangulate(square, "qa0.2")
    >>> sorted(out), len(out["triangles"])
    (['triangles', 'vertex_markers', 'vertices'], 8)
    >>> triangulate(square, "u")
    Traceback (most recent call last):
    ...
    delone.errors.InputError: switch u is not supported: a test of triangles in C that is compiled \
into Triangle; use size= of delone.mesh
    """
    require_mapping(tri, "tri")
    if not isinstance(opts, str):
        raise DtypeError(f"opts must be a string of switches, got {opts!r:.60}")
    switches = _parsed(opts)
    unknown = sorted(set(tri) - set(_KEYS))
    if unknown:
        raise InputError(f"unknown key {unknown[0]!r:.80}; known are {', '.join(_KEYS)}")
    if "vertices" not in tri:
        raise InputError("key 'vertices' is missing")
    points = as_points(tri["vertices"], ndim=2, name="vertices")
    base: Given | ConstrainedDelaunay
    if "r" in switches.on:
        made, attributes, base = again(tri, points, switches)
    else:
        made, attributes, base = _meshed(tri, points, switches)
    missed = not_reached(tri, made, base, switches)
    if missed:
        warnings.warn(missed, UserWarning, stacklevel=2)
    return _output(tri, points, switches, (made, attributes, base))


def _parsed(opts: str) -> Switches:
    on: list[str] = []
    angle, area, steiner = 0.0, None, None
    for match in _SWITCH.finditer(opts):
        letter, number = match[1] or match[3], match[2]
        if letter in _REFUSED or letter not in _KNOWN + _WITHOUT_EFFECT:
            reason = _REFUSED.get(letter, "Triangle has no such switch")
            raise InputError(f"switch {letter} is not supported: {reason}")
        on.append(letter)
        if letter == "q":
            angle = float(number) if number else _DEFAULT_ANGLE
        elif letter == "a" and number:
            area = float(number)
        elif letter == "S":
            steiner = int(min(float(number or 0), LARGEST_LIMIT))
    rest = _SWITCH.sub("", opts).strip()
    if rest:
        raise InputError(f"switches {opts!r:.80} contain {rest!r:.80}, which belongs to no switch")
    fixed: bool | str = on.count("Y") > 1 or ("boundary" if "Y" in on else False)
    return Switches(frozenset(on), angle, area, steiner, fixed)


def _meshed(
    tri: Mapping[str, Any], points: Floats, switches: Switches
) -> tuple[Mesh, Floats | None, ConstrainedDelaunay]:
    """Mesh points and segments; return the attributes of triangles, and the input mesh."""
    planar = "p" in switches.on
    segments = as_segments(tri.get("segments", ()) if planar else (), len(points))
    seeds = rows_of(tri.get("regions"), 4, "regions") if planar else np.empty((0, 4))
    labeled = np.column_stack((seeds[:, :2], np.arange(len(seeds))))
    base = ConstrainedDelaunay(
        points,
        segments,
        holes=tri.get("holes") if planar else None,
        regions=labeled if len(seeds) else None,
        boundary="outline" if planar and "c" not in switches.on else "hull",
        crossing="split",
    )
    area: Any = switches.area
    if "a" in switches.on and area is None:
        present = set(np.unique(base.region).tolist())
        area = {i: a for i, a in enumerate(seeds[:, 3].tolist()) if a > 0 and i in present}
    # S stops the refinement, as in Triangle, where mesh() would raise an error.
    limits = Limits(
        as_min_angle(switches.angle),
        MOST_ADDED if switches.steiner is None else switches.steiner,
        "D" in switches.on,
        None,
        None,
        refuse=switches.steiner is None,
        sizes_yield=True,
    )
    markers = tri.get("segment_markers") if planar else None, tri.get("vertex_markers")
    sizes, fixed = (area, None), switches.fixed
    found = filled(base, base.region, limits, sizes=sizes, fixed=fixed, markers=markers, stages={})
    attributes = None
    if "A" in switches.on and len(seeds):
        attributes = np.append(seeds[:, 2], 0.0)[found.region][:, None]
    return found, attributes, base


def _output(
    tri: Mapping[str, Any],
    points: Floats,
    switches: Switches,
    made: tuple[Mesh, Floats | None, Any],
) -> dict[str, Any]:
    found, attributes, base = made
    number, vertices = _rows(found, points, jettison="j" in switches.on)
    out: dict[str, Any] = {"vertices": vertices}
    n = len(vertices)
    boundary = number[found.boundary]
    markers = np.zeros(n, dtype=np.int32)
    if tri.get("vertex_markers") is not None:
        given = as_labels(tri["vertex_markers"], len(points), name="vertex_markers")
        markers[: min(n, len(points))] = given if "j" not in switches.on else 0
    markers[number] = found.point_markers
    on_boundary = np.zeros(n, dtype=bool)
    on_boundary[boundary] = True
    markers[on_boundary & (markers == 0)] = 1
    if tri.get("vertex_attributes") is not None:
        columns = rows_of(tri["vertex_attributes"], None, "vertex_attributes", len(points))
        values = np.empty((n, columns.shape[1]))
        if "j" not in switches.on:
            values[: len(points)] = columns
        values[number] = interpolated(found, columns, base)
        out["vertex_attributes"] = values
    out["vertex_markers"] = markers[:, None]
    out["triangles"] = number[found.simplices]
    if attributes is not None:
        out["triangle_attributes"] = attributes
    if "n" in switches.on:
        out["neighbors"] = found.neighbors.copy()
    marks = _segment_markers(found)
    has_segments = "p" in switches.on or "c" in switches.on or "r" in switches.on
    if has_segments and ("r" not in switches.on or "segments" in tri):
        out["segments"] = number[found.segments]
        out["segment_markers"] = marks[:, None]
    if "e" in switches.on:
        out["edges"] = number[found.edges]
        out["edge_markers"] = _of_edges(found, marks)[:, None]
    for name in ("holes", "regions"):
        if tri.get(name) is not None and "p" in switches.on:
            out[name] = rows_of(tri[name], None, name)
    return out


def _rows(found: Mesh, points: Floats, *, jettison: bool) -> tuple[Indices, Floats]:
    """Return the row of each point of a mesh in the output, and the points there."""
    if jettison:
        return np.arange(found.npoints, dtype=np.int32), found.points.copy()
    added = found.point_source < 0
    number = found.point_source.copy()
    number[added] = len(points) + np.arange(np.count_nonzero(added), dtype=np.int32)
    return number, np.concatenate((points, found.points[added]))


def _segment_markers(found: Mesh) -> Indices:
    """Markers of subsegments, 1 on the boundary if there is none."""
    marks = found.segment_markers.copy()
    n = found.npoints
    keys = keys_of(found.segments, n)
    rim = topology.among(keys, keys_of(found.boundary, n))
    marks[rim & (marks == 0)] = 1
    return marks


def _of_edges(found: Mesh, marks: Indices) -> Indices:
    of_edges = np.zeros(len(found.edges), dtype=np.int32)
    of_edges[_core.facet_rows(found.edges, found.segments, found.npoints, False)] = marks
    return of_edges


def delaunay(pts: ArrayLike) -> Indices:
    """Return the Delaunay triangles of points.

    Parameters
    ----------
    pts : array_like, shape (n, 2)
        Points.

    Returns
    -------
    ndarray of int32, shape (m, 3)
        Triangles, counter-clockwise.

    Raises
    ------
    DegenerateInputError
        The points span no area.
    ShapeError, DtypeError, NonFiniteError
        `pts` is not a finite real array of shape (n, 2).

    Examples
    --------
    >>> from delone.compat.triangle import delaunay
    >>> len(delaunay([(0, 0), (0, 1), (0.5, 0.5), (1, 1), (1, 0)]))
    4
    """
    return _of_the_plane(pts).simplices.copy()


def convex_hull(pts: ArrayLike) -> Indices:
    """Return the edges of the convex hull of points.

    Parameters
    ----------
    pts : array_like, shape (n, 2)
        Points.

    Returns
    -------
    ndarray of int32, shape (h, 2)
        Edges, each with the points on its left; a side is split at points that lie on it.

    Raises
    ------
    DegenerateInputError
        The points span no area.
    ShapeError, DtypeError, NonFiniteError
        `pts` is not a finite real array of shape (n, 2).

    Examples
    --------
    >>> from delone.compat.triangle import convex_hull
    >>> len(convex_hull([(0, 0), (0, 1), (1, 1), (1, 0)]))
    4
    """
    return _of_the_plane(pts).convex_hull.copy()


def voronoi(pts: ArrayLike) -> tuple[Floats, Indices, Indices, Floats]:
    """Return the Voronoi diagram of points.

    Parameters
    ----------
    pts : array_like, shape (n, 2)
        Points.

    Returns
    -------
    points : ndarray of float64, shape (m, 2)
        The center of the circle of each Delaunay triangle.
    edges : ndarray of int32, shape (k, 2)
        Bounded edges as rows of these.
    ray_origin : ndarray of int32, shape (h,)
        The origin of each unbounded edge.
    ray_direct : ndarray of float64, shape (h, 2)
        Its direction, with the length of the hull edge that it crosses.

    Raises
    ------
    DegenerateInputError
        The points span no area.
    ShapeError, DtypeError, NonFiniteError
        `pts` is not a finite real array of shape (n, 2).

    Examples
    --------
    >>> from delone.compat.triangle import voronoi
    >>> points, edges, origin, direction = voronoi([(0, 0), (0, 1), (0.5, 0.5), (1, 1), (1, 0)])
    >>> points.shape, edges.shape, direction.shape
    ((4, 2), (4, 2), (4, 2))
    """
    found = _of_the_plane(pts)
    t, k = np.nonzero(found.neighbors > np.arange(found.nsimplex, dtype=np.int32)[:, None])
    edges = np.column_stack((t, found.neighbors[t, k])).astype(np.int32)
    origin, k = np.nonzero(found.neighbors < 0)
    tail, head = (found.simplices[origin, (k + i) % 3] for i in (1, 2))
    along = found.points[head] - found.points[tail]
    direction = np.column_stack((along[:, 1], -along[:, 0]))
    return found.circumcenters.copy(), edges, origin.astype(np.int32), direction


def _of_the_plane(pts: ArrayLike) -> Delaunay:
    return Delaunay(as_points(pts, ndim=2, name="pts"))
