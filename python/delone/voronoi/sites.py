"""From sites to their triangulation, and to the arrays of its dual."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.duplicates import first_rows
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError
from delone.periodic import PeriodicDelaunay, as_periods, vertex_of
from delone.regular import RegularTriangulation, triangulated
from delone.voronoi import dual, torus

if TYPE_CHECKING:
    from delone._base.types import Floats
    from delone._core import Diagram2, Diagram3

__all__ = ["in_plane", "in_space", "repeated"]

_NO_SITE = "there are no points; a diagram needs at least one"


def in_plane(
    points: Floats, weights: Floats | None, workers: int | None
) -> tuple[Delaunay | RegularTriangulation | None, Diagram2]:
    """Triangulate 2-D sites, and compute the dual; the mesh is None if all are on one line."""
    return _delaunay(points, workers) if weights is None else _regular(points, weights, workers)


def _delaunay(points: Floats, workers: int | None) -> tuple[Delaunay | None, Diagram2]:
    try:
        mesh = Delaunay(points, workers=workers)
    except DegenerateInputError as error:
        if not len(error.chain):
            raise DegenerateInputError(_NO_SITE, reason="too few points") from None
        arrays = dual.of_chain(points, error.chain.astype(np.int32))
        arrays.region[:] = arrays.region[first_rows(points)]
        return None, arrays
    arrays = _core.voronoi2(mesh.points, None, mesh.simplices, mesh.neighbors, as_workers(workers))
    duplicate, first = mesh._duplicates.T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays


def _regular(
    points: Floats, weights: Floats, workers: int | None
) -> tuple[RegularTriangulation | None, Diagram2]:
    found, chain = triangulated(points, weights, workers)
    mesh = None
    if len(found["simplices"]):
        mesh = RegularTriangulation._from_arrays(found, {}, workers)
        topology = mesh.simplices, mesh.neighbors, as_workers(workers)
        arrays = _core.voronoi2(points, weights, *topology)
    elif len(chain):
        arrays = dual.of_chain(points, chain)
    else:
        raise DegenerateInputError(_NO_SITE, reason="too few points")
    duplicate, first = found["duplicates"].T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays


def refuse_periods(periods: Any) -> None:
    """Reject periods of cells that are not in 2-D."""
    if periods is not None:
        raise InputError("periods are only available in 2-D")


def repeated(
    points: Floats, weights: Floats | None, periods: Any, workers: int | None
) -> tuple[PeriodicDelaunay | None, torus.PeriodicDual, tuple[float | None, float | None]]:
    """Triangulate periodic sites, compute the dual, and return them with the checked periods.

    The mesh is None if all copies lie on one line.
    """
    torus.require_room(points, as_periods(periods))
    try:
        mesh = PeriodicDelaunay(points, periods, weights=weights, workers=workers)
    except DegenerateInputError as error:
        if not len(error.chain):
            raise
        lengths = as_periods(periods)
        arrays = torus.of_line(points, error.chain.astype(np.int32), lengths)
        region = arrays.cells.region
        region[:] = region[vertex_of(points, weights)]
        return None, arrays, lengths
    return mesh, torus.of_periodic(mesh, as_workers(workers)), mesh.periods


def in_space(
    points: Floats, weights: Floats | None, workers: int | None
) -> tuple[Delaunay | RegularTriangulation, Diagram3]:
    """Triangulate 3-D sites, and compute the dual."""
    mesh: Delaunay | RegularTriangulation
    if weights is None:
        mesh = Delaunay(points, workers=workers)
    else:
        found, _ = triangulated(points, weights, workers)
        mesh = RegularTriangulation._from_arrays(found, {}, workers)
    topology = mesh.simplices, mesh.neighbors, as_workers(workers)
    arrays = _core.voronoi3(points, weights, *topology)
    duplicate, first = mesh._duplicates.T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays
