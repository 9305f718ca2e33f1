"""One call per peer on points and segments: a `Lines` in, a triangulation of the convex hull out.

As in `adapters`; but what goes to the judge is the coordinates of the triangles' corners, of shape
(m, 3, 2), because peers number vertices in their own ways and may add some.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from adapters import Adapter
from lines import Lines, load
from numpy.typing import NDArray


def corners(_: Lines, answer: Any) -> NDArray[np.float64]:
    """Return the corners of the triangles of one of delone's classes."""
    return np.asarray(answer.points[answer.simplices])


def delone(workers: int = 1, crossing: str = "raise") -> Adapter:
    """Delone itself: triangles, neighbours and constrained edges are there on return."""
    import delone as library

    def call(lines: Lines) -> Any:
        return library.ConstrainedDelaunay(*lines, crossing=crossing, workers=workers)

    return Adapter(call, corners, library.__version__, load)


def delone_unconstrained() -> Adapter:
    """Delone without the segments."""
    import delone as library

    def call(lines: Lines) -> Any:
        return library.Delaunay(lines.points, workers=1)

    return Adapter(call, corners, library.__version__, load)


def load_distinct(file: str) -> Lines:
    """Read points and segments, each point once."""
    points, segments = load(file)
    distinct, row = np.unique(points, axis=0, return_inverse=True)
    return Lines(distinct, row.reshape(-1)[segments].astype(np.int32))


def triangle(read: Callable[[str], Lines] = load) -> Adapter:
    """Shewchuk's Triangle: p for segments, which it splits where they cross, c for the hull.

    It may end its process where points repeat, hence the variant that gets distinct ones.
    """
    from importlib.metadata import version

    import triangle as library

    def call(lines: Lines) -> Any:
        return library.triangulate({"vertices": lines.points, "segments": lines.segments}, "pc")

    def taken(_: Lines, answer: Any) -> NDArray[np.float64]:
        return np.asarray(answer["vertices"][answer["triangles"]])

    return Adapter(call, taken, version("triangle"), read)


PEERS: dict[str, Callable[[], Adapter]] = {
    "delone": delone,
    "delone-2-workers": lambda: delone(2),
    "delone-no-segments": delone_unconstrained,
    "triangle": triangle,
    "triangle-distinct-points": lambda: triangle(load_distinct),
    "delone-split": lambda: delone(1, "split"),
}

CONSTRAINED = (
    "delone",
    "delone-2-workers",
    "delone-no-segments",
    "triangle",
    "triangle-distinct-points",
)
SPLITTING = ("delone-split", "triangle")
