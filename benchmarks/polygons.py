"""The insides of polygons: delone and the mapbox_earcut wheel, with the error of the area.

Small calls are timed in batches of at least a tenth of a second, the peers in turns in one process.
The error compares the exact sum of the triangles' areas with the exact area inside by the even-odd
rule; crossings that are rounded to doubles leave a trace of it in an answer that is right.
"""

import time
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

import evenodd
import lines
import numpy as np
import report
from lines import Rings

CORPUS = Path(__file__).parents[1] / "tests" / "corpus"
BATCH = 0.1


class Filler(NamedTuple):
    """A peer: prepares its input outside the clock, is called, and yields points, triangles."""

    name: str
    prepare: Callable[[Rings], tuple[Any, ...]]
    call: Callable[..., Any]
    triangles: Callable[[Rings, Any], tuple[np.ndarray, np.ndarray]]


def delone() -> Filler:
    """Delone: a ring as an array, several as a list of arrays."""
    import delone as library

    def prepare(rings: Rings) -> tuple[Any, ...]:
        return (rings.points,) if len(rings.starts) == 2 else (rings.split(),)

    def triangles(_: Rings, answer: Any) -> tuple[np.ndarray, np.ndarray]:
        return answer.points, answer.simplices

    name = f"delone {library.__version__}"
    return Filler(name, prepare, library.triangulate_polygon, triangles)


def earcut() -> Filler:
    """Earcut: points, and the ends of rings."""
    import mapbox_earcut as library

    def prepare(rings: Rings) -> tuple[Any, ...]:
        return rings.points, rings.starts[1:].astype(np.uint32)

    def triangles(rings: Rings, answer: Any) -> tuple[np.ndarray, np.ndarray]:
        return rings.points, answer.reshape(-1, 3)

    name = f"mapbox_earcut {version('mapbox_earcut')}"
    return Filler(name, prepare, library.triangulate_float64, triangles)


def batch(call: Callable[..., Any], given: tuple[Any, ...], calls: int) -> float:
    """Return the seconds of one of several calls."""
    start = time.perf_counter()
    for _ in range(calls):
        call(*given)
    return (time.perf_counter() - start) / calls


def table(rings: Rings, fillers: list[Filler], runs: int) -> str:
    """Return the table of one polygon."""
    given = [filler.prepare(rings) for filler in fillers]
    once = [batch(f.call, g, 1) for f, g in zip(fillers, given, strict=True)]
    calls = [max(1, int(BATCH / seconds)) for seconds in once]
    times: list[list[float]] = [[] for _ in fillers]
    for _ in range(runs):
        for seconds, filler, arrays, count in zip(times, fillers, given, calls, strict=True):
            seconds.append(batch(filler.call, arrays, count))
    exact, base = evenodd.area(rings.split()), report.median(times[0])
    found = []
    for seconds, filler, arrays in zip(times, fillers, given, strict=True):
        points, simplices = filler.triangles(rings, filler.call(*arrays))
        error = float(evenodd.triangle_area(points, simplices) / exact - 1)
        middle = report.median(seconds)
        cells = [f"{1e6 * middle:.3g}", report.ratio(middle / base)]
        found.append([filler.name, *cells, f"{len(simplices):,}", f"{error:.2g}"])
    head = ["peer", "microseconds", "times delone", "triangles", "error of the area"]
    return report.table(head, found)


def tables(runs: int) -> str:
    """Return the tables of a small ring and of a large polygon that crosses itself."""
    fillers = [delone()]
    try:
        fillers.append(earcut())
    except (ImportError, PackageNotFoundError) as error:
        print(f"Without earcut: {error}\n")
    water = lines.corpus_polygon(CORPUS / "earcut-water-huge.json")
    parts = [
        ("a ring of 100 vertices", lines.star_ring(100)),
        (f"earcut's water-huge: {len(water.points):,} points", water),
    ]
    return "\n\n".join(f"{title}\n\n{table(rings, fillers, runs)}" for title, rings in parts)
