"""The object that is explored: its scene, and triangulations of moved points."""

from __future__ import annotations

import math
import threading
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import counted
from delone._base.values import as_values
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.errors import InputError, NonFiniteError
from delone.explorer.scene import QUALITIES, as_explorable, packed, scene_of
from delone.periodic import PeriodicDelaunay
from delone.refine.meshed import Mesh
from delone.regular import RegularTriangulation
from delone.voronoi.diagram import Voronoi

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats
    from delone.explorer.scene import Explorable, Scene

__all__ = ["Exploration"]


class Exploration:
    """An object, its values, and what the view needs to show and to change it.

    Any number of threads may use it; they wait for each other.
    """

    def __init__(
        self, mesh: Any, *, values: ArrayLike | None = None, quality: str = "smallest_angle"
    ) -> None:
        self.mesh: Explorable = as_explorable(mesh)
        # The values of the given rows; points added by a triangulation have none.
        self._values = (
            None if values is None else as_values(values, self.mesh.npoints, name="values")
        )
        self._quality = quality
        self._lock = threading.Lock()
        self._scene: Scene = scene_of(self.mesh, self._values, quality)

    @property
    def movable(self) -> int:
        """How many rows, from the first, may be moved: all but added points; none of a Mesh."""
        if isinstance(self.mesh, Mesh):
            return 0
        added = self.mesh.nadded if isinstance(self.mesh, ConstrainedDelaunay) else 0
        return self.mesh.npoints - added

    def described(self) -> str:
        """Return a description of the object, for titles and screen readers."""
        if isinstance(self.mesh, Voronoi):
            return f"Voronoi diagram of {counted(self.mesh.npoints, 'site')}"
        points = counted(self.mesh.npoints, "point")
        return f"{type(self.mesh).__name__} of {points}: {counted(self._ntriangles, 'triangle')}"

    @property
    def _ntriangles(self) -> int:
        return len(self._scene.triangles)

    def packed(self) -> bytes:
        """Return the scene as a block of bytes."""
        with self._lock:
            return self._packed()

    def _packed(self) -> bytes:
        header = {
            "label": self.described(),
            "movable": self.movable,
            "qualityName": self._quality.replace("_", " "),
            "qualityRange": QUALITIES[self._quality],
            "diagram": isinstance(self.mesh, Voronoi),
        }
        return packed(self._scene, header)

    def move(self, vertex: Any, x: Any, y: Any) -> bytes:
        """Move a point of the scene, retriangulate, and return the scene.

        If that is not possible, the error says why, and nothing changes.
        """
        with self._lock:
            row, place = self._target(vertex, x, y)
            points = np.array(self.mesh.points)
            points[row] = place
            mesh = triangulated(self.mesh, points)
            values = self._values_of(mesh)
            scene = scene_of(mesh, values, self._quality)
            self.mesh, self._scene, self._values = mesh, scene, values
            return self._packed()

    def _target(self, vertex: Any, x: Any, y: Any) -> tuple[int, tuple[float, float]]:
        """Return the row and its new coordinates, checked."""
        if not isinstance(vertex, Integral) or isinstance(vertex, bool):
            raise InputError(f"a point is named by its number; got {vertex!r:.80}")
        row = int(vertex)
        if not 0 <= row < self.movable:
            raise InputError(f"point {row} does not exist or cannot be moved")
        return row, (_as_coordinate(x, row), _as_coordinate(y, row))

    def _values_of(self, mesh: Explorable) -> Floats | None:
        """The values of the points of another triangulation; NaN for added points."""
        if self._values is None:
            return None
        found = np.full(mesh.npoints, np.nan)
        found[: self.movable] = self._values[: self.movable]
        return found


def _as_coordinate(given: Any, row: int) -> float:
    if not isinstance(given, Real) or isinstance(given, bool):
        raise InputError(f"coordinates are numbers; got {given!r:.80}")
    try:
        number = float(given)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise NonFiniteError("coordinates are NaN or infinite", rows=[row])
    return number


def triangulated(mesh: Explorable, points: Floats) -> Explorable:
    """Return the object of the same kind and with the same options for moved points."""
    if isinstance(mesh, ConstrainedDelaunay):
        given = points[: mesh.npoints - mesh.nadded].copy()
        segments = mesh.input_segments
        options = mesh._arguments()
        return type(mesh)._of_geometries(given, segments, mesh._given.origin, **options)
    if isinstance(mesh, RegularTriangulation):
        return RegularTriangulation(points, mesh.weights, workers=mesh.workers, planar=True)
    if isinstance(mesh, PeriodicDelaunay):
        return PeriodicDelaunay(points, mesh.periods, weights=mesh.weights, workers=mesh.workers)
    if isinstance(mesh, Voronoi):
        kept = {"clip": mesh.clip, "weights": mesh.weights, "periods": mesh.periods}
        return Voronoi(points, **kept, workers=mesh.workers, planar=True)
    return Delaunay(points, workers=mesh.workers, planar=True)
