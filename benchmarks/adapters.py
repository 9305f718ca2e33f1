"""One call per peer: an array of points in, arrays out, on one thread unless its name says more.

An adapter imports its library and returns the call to be timed; what the call returns goes, outside
the timed part, through the adapter's `simplices`, which yields vertex numbers for the judge. Each
call does what its library offers that comes nearest to "simplices and neighbours as arrays".
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Simplices = NDArray[np.int32]


@dataclass(frozen=True)
class Adapter:
    """A peer: the call that is timed, how the judge reads its answer, and how input is read."""

    call: Callable[[Any], Any]
    simplices: Callable[[Any, Any], NDArray[Any]]
    version: str
    load: Callable[[str], Any] = np.load


def rows_of(points: Points, coordinates: Points) -> Simplices:
    """Find each coordinate pair among `points`, to give geometries their vertex numbers back."""
    keys = complex_keys(points)
    order = np.argsort(keys, kind="stable")
    place = np.searchsorted(keys[order], complex_keys(coordinates))
    return order[np.minimum(place, len(keys) - 1)].astype(np.int32)


def complex_keys(points: Points) -> NDArray[np.complex128]:
    """View each point as one number, ordered by x and then y, with one zero."""
    return np.ascontiguousarray(points + 0.0).view(np.complex128).ravel()


def delone(workers: int = 1) -> Adapter:
    """Delone itself: `simplices` and `neighbors` are there when the constructor returns."""
    import delone as library

    return Adapter(
        lambda points: library.Delaunay(points, workers=workers),
        lambda _, answer: np.asarray(answer.simplices),
        library.__version__,
    )


def scipy() -> Adapter:
    """SciPy's Qhull: `simplices` and `neighbors` are there when the constructor returns."""
    import scipy as library
    from scipy.spatial import Delaunay

    return Adapter(Delaunay, lambda _, answer: np.asarray(answer.simplices), library.__version__)


def triangle() -> Adapter:
    """Shewchuk's Triangle: switch n asks for neighbours."""
    from importlib.metadata import version

    import triangle as library

    return Adapter(
        lambda points: library.triangulate({"vertices": points}, "n"),
        lambda _, answer: np.asarray(answer["triangles"], dtype=np.int32),
        version("triangle"),
    )


def startinpy() -> Adapter:
    """Startinpy: needs a third column; its smallest snap tolerance; triangles, no neighbours."""
    from importlib.metadata import version

    import startinpy as library

    def call(points: Points) -> Any:
        terrain = library.DT()
        terrain.snap_tolerance = 1e-300
        terrain.insert(np.column_stack([points, np.zeros(len(points))]), "BBox")
        return terrain.points, terrain.triangles

    def simplices(points: Points, answer: Any) -> Simplices:
        coordinates, triangles = answer
        return rows_of(points, coordinates[triangles.ravel(), :2]).reshape(-1, 3)

    return Adapter(call, simplices, version("startinpy"))


def shapely() -> Adapter:
    """Shapely's GEOS: geometries; their coordinates are taken out, there are no neighbours."""
    import shapely as library

    def call(points: Points) -> Any:
        triangles = library.delaunay_triangles(library.multipoints(points))
        return library.get_coordinates(triangles)

    def simplices(points: Points, answer: Any) -> Simplices:
        corners = answer.reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
        return rows_of(points, corners).reshape(-1, 3)

    return Adapter(call, simplices, library.__version__)


PEERS: dict[str, Callable[[], Adapter]] = {
    "delone": delone,
    "delone-2-workers": lambda: delone(2),
    "scipy": scipy,
    "triangle": triangle,
    "startinpy": startinpy,
    "shapely": shapely,
}
