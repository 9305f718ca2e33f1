"""From sites to the triangulation whose dual a diagram is, and to the arrays of the diagram."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone.delaunay import Delaunay
from delone.duplicates import first_rows
from delone.errors import DegenerateInputError
from delone.periodic import PeriodicDelaunay, as_periods, vertex_of
from delone.regular import RegularTriangulation, triangulated
from delone.voronoi import dual, torus

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import Diagram2, Diagram3

    Floats = NDArray[np.float64]

__all__ = ["in_plane", "in_space", "repeated"]

_NO_SITE = "there is no point; a diagram needs one"


def in_plane(
    points: Floats, weights: Floats | None, workers: int
) -> tuple[Delaunay | RegularTriangulation | None, Diagram2]:
    """Triangulate sites in the plane, and take the dual.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    workers : int
        How many threads may work.

    Returns
    -------
    mesh : Delaunay, RegularTriangulation or None
        The triangulation; None where all sites lie on one line.
    arrays : Diagram2
        As `dual` describes them.

    Raises
    ------
    DegenerateInputError
        There is no site.
    """
    return _plain(points, workers) if weights is None else _power(points, weights, workers)


def _plain(points: Floats, workers: int) -> tuple[Delaunay | None, Diagram2]:
    try:
        mesh = Delaunay(points, workers=workers)
    except DegenerateInputError as error:
        if not len(error.chain):
            raise DegenerateInputError(_NO_SITE, reason="too few points") from None
        arrays = dual.of_chain(points, error.chain.astype(np.int32))
        arrays.region[:] = arrays.region[first_rows(points)]
        return None, arrays
    arrays = _core.voronoi2(mesh.points, None, mesh.simplices, mesh.neighbors, workers)
    duplicate, first = mesh._duplicates.T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays


def _power(
    points: Floats, weights: Floats, workers: int
) -> tuple[RegularTriangulation | None, Diagram2]:
    found, chain = triangulated(points, weights)
    mesh = None
    if len(found["simplices"]):
        mesh = RegularTriangulation._from_arrays(found, {}, workers)
        arrays = _core.voronoi2(points, weights, mesh.simplices, mesh.neighbors, workers)
    elif len(chain):
        arrays = dual.of_chain(points, chain)
    else:
        raise DegenerateInputError(_NO_SITE, reason="too few points")
    duplicate, first = found["duplicates"].T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays


def repeated(
    points: Floats, weights: Floats | None, periods: Any, workers: int
) -> tuple[PeriodicDelaunay | None, torus.PeriodicDual, tuple[float | None, float | None]]:
    """Triangulate sites that come again at a period, and take the dual.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    periods : tuple of two floats or None
        As the caller gave them.
    workers : int
        How many threads may work.

    Returns
    -------
    mesh : PeriodicDelaunay or None
        The triangulation; None where all copies lie on one line.
    arrays : PeriodicDual
        As `torus` describes them.
    periods : tuple of two floats or None
        The same, checked.
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
    return mesh, torus.of_periodic(mesh, workers), mesh.periods


def in_space(
    points: Floats, weights: Floats | None, workers: int
) -> tuple[Delaunay | RegularTriangulation, Diagram3]:
    """Triangulate sites in space, and take the dual.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    workers : int
        How many threads may work.

    Returns
    -------
    mesh : Delaunay or RegularTriangulation
        The triangulation.
    arrays : Diagram3
        As `delone.voronoi.space` describes them.
    """
    mesh: Delaunay | RegularTriangulation
    if weights is None:
        mesh = Delaunay(points, workers=workers)
    else:
        found, _ = triangulated(points, weights)
        mesh = RegularTriangulation._from_arrays(found, {}, workers)
    arrays = _core.voronoi3(points, weights, mesh.simplices, mesh.neighbors, workers)
    duplicate, first = mesh._duplicates.T
    arrays.region[duplicate] = arrays.region[first]
    return mesh, arrays
