"""The construction of a TIN from the surface of a file, with the triangles of the file.

The faces are reproduced by a constrained Delaunay triangulation: their edges that it would not
otherwise contain are constraints. So a surface from a file is an ordinary TIN.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice
from delone._base.counting import counted
from delone._base.georeference import warn_of_degrees
from delone._base.numbers import as_nonnegative
from delone._tiling.plane import topology
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import CrossingSegmentsError, InputError
from delone.predicates import orient2d
from delone.terrain import building
from delone.terrain.gathering import HARD, SOFT, Lines
from delone.terrain.heights import POLICIES, claims_of_points, resolved
from delone.terrain.lines import Ring

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows
    from delone.io import SurfaceFile

__all__ = ["build_faces", "with_lines"]

_LINES = ("breaklines", "soft_breaklines")
_RINGS = ("boundary", "holes", "islands")
_AFRESH = "faces=False (--retriangulate) triangulates its points and lines afresh"


def with_lines(surface: SurfaceFile, options: dict[str, Any]) -> dict[str, Any]:
    """Return options for `TIN.from_points`, with the lines of a file added to the given ones."""
    merged = dict(options)
    for name in (*_LINES, *_RINGS):
        # Each ring of a file is a polygon, and several rings form a union.
        own = [Ring(line.copy()) for line in getattr(surface, name)]
        given = options.get(name)
        if own:
            merged[name] = own if given is None else [*own, given]
    return merged


def build_faces(surface: SurfaceFile, options: dict[str, Any]) -> building.Built:
    """Return the surface of the faces of a file; edges on its breaklines are breaklines."""
    duplicates, crossing = (options.get(name, "raise") for name in ("duplicates", "crossing"))
    as_choice(duplicates, POLICIES, name="duplicates")
    as_choice(crossing, POLICIES, name="crossing")
    without = {"snap": 0, "crossing": "raise"}
    for name in (*_LINES, *_RINGS, "max_edge", "voids", "level", "snap", "crossing"):
        given = options.get(name)
        if given is not None and given is not False and given != without.get(name):
            raise InputError(f"{surface.source} has faces, so {name} changes nothing: {_AFRESH}")
    system = building.system_of(options.get("crs"), surface)
    units = building.settled_units(
        building.stated_units(options.get("units"), surface.units, surface.source),
        system,
        surface.lengths,
        surface.source,
    )
    warn_of_degrees(
        surface,
        surface.points[:, :2],
        planar=options.get("planar", False),
        by=building.degrees_of(system),
    )
    rows, corners = np.unique(surface.faces, return_inverse=True)
    points = surface.points[rows]
    faces = _upward(points[:, :2], corners.reshape(-1, 3), surface.source)
    mesh, lines = _with_edges(surface, points[:, :2], faces, options.get("workers"))
    z = resolved(
        mesh.points,
        claims_of_points(mesh.duplicate_of, points[:, 2]),
        claims_of_points(np.empty(0, dtype=np.int32), np.empty(0)),
        duplicates=duplicates,
        crossing="raise",
        tolerance=as_nonnegative(options.get("tolerance", 0.0), name="tolerance", finite=True),
    )
    kept = topology.triangles_among(mesh.simplices, faces)
    return building.compact(mesh, z, kept, building.is_soft(mesh, lines), system, units)


def _upward(points: Floats, faces: Rows, source: str) -> Rows:
    """Return counter-clockwise faces by the first row at each place; drop those without area."""
    _, first, same = np.unique(points + 0.0, axis=0, return_index=True, return_inverse=True)
    found: Rows = first[same.reshape(-1)][faces]
    turn = orient2d(*(points[found[:, k]] for k in range(3)))
    found[turn < 0] = found[turn < 0][:, ::-1]
    found = found[turn != 0]
    if not len(found):
        raise InputError(f"{source}: no face has an area")
    sides = found[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
    order = np.lexsort(sides.T)
    twice = (np.diff(sides[order], axis=0) == 0).all(axis=1)
    if twice.any():
        raise _overlap(points[sides[order[:-1][twice]][:, 0]], source)
    return found


def _with_edges(
    surface: SurfaceFile, points: Floats, faces: Rows, workers: int | None
) -> tuple[ConstrainedDelaunay, Lines]:
    """Triangulate with the edges on breaklines, and with those that would otherwise be missing."""
    sides = np.unique(np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1), axis=0)
    keys = _keys(sides, len(points))
    hard, soft = (
        _on_lines(given, points, keys) for given in (surface.breaklines, surface.soft_breaklines)
    )
    kinds = np.concatenate((np.full(len(hard), HARD), np.full(len(soft), SOFT)))
    wanted = np.concatenate((hard, soft))
    for extent in ("missing", "missing", "all"):
        mesh = _triangulated(points, wanted, surface.source, workers)
        if np.count_nonzero(topology.triangles_among(mesh.simplices, faces)) == len(faces):
            break
        known = _keys(mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), len(points))
        more = sides[~np.isin(keys, known)] if extent == "missing" else sides
        wanted = np.concatenate((wanted, more))
        kinds = np.concatenate((kinds, np.full(len(more), SOFT)))
    else:
        mesh = _triangulated(points, wanted, surface.source, workers)
        bad = ~topology.triangles_among(faces, mesh.simplices)
        if bad.any():
            raise _overlap(points[faces[bad][:, 0]], surface.source)
    return mesh, Lines(
        np.empty((0, 3)),
        np.empty(0, dtype=bool),
        wanted.astype(np.int32),
        kinds.astype(np.int8),
        np.full(len(kinds), -1, dtype=np.int32),
    )


def _triangulated(
    points: Floats, segments: Rows, source: str, workers: int | None
) -> ConstrainedDelaunay:
    try:
        return ConstrainedDelaunay(points, segments.astype(np.int32), workers=workers, planar=True)
    except CrossingSegmentsError as error:
        raise _overlap(error.points, source) from error


def _overlap(places: Floats, source: str) -> InputError:
    x, y = places[0]
    return InputError(
        f"{source}: faces overlap, or an edge passes through a point, at "
        f"{counted(len(places), 'place')}, first ({x:.10g}, {y:.10g}): correct them; {_AFRESH}"
    )


def _on_lines(lines: Iterable[Floats], points: Floats, keys: Rows) -> Rows:
    """Return the edges, by row, whose ends follow each other on a line."""
    row = {place: at for at, place in reversed(list(enumerate(map(tuple, points.tolist()))))}
    found = [np.empty((0, 2), dtype=np.int64)]
    for line in lines:
        at = np.array([row.get(place, -1) for place in map(tuple, line[:, :2].tolist())])
        pairs = np.column_stack((at[:-1], at[1:]))
        pairs = pairs[(pairs >= 0).all(axis=1)].astype(np.int64)
        found.append(pairs[np.isin(_keys(pairs, len(points)), keys)])
    return np.concatenate(found)


def _keys(pairs: NDArray[Any], npoints: int) -> Rows:
    a, b = pairs.T
    found: Rows = topology.edge_keys(a, b, npoints)
    return found
