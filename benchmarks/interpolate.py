"""Location and interpolation side by side with SciPy, CGAL, startinpy and MetPy.

Sites are uniform in a square, queries as well: in random order, and in rows as a raster has them.
One thread for everybody unless a line says more; medians of warm calls, which take turns, all
equally often. A peer that is slow is asked for as many of the queries as it answers in a second,
and the line says how many. ``python benchmarks/interpolate.py --help`` has options.
"""

import argparse
import importlib.util
import statistics
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.interpolate
import scipy.spatial
from crates import build_cgal, runs_of
from rounds import alternate

from delone import Delaunay
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor

# Queries of the first, short call to a peer, and the seconds that each call may take.
FEW, PATIENCE = 20, 1.0
HEAD = ("", "delone", "a query", "peer", "seconds", "a query", "times delone")
Call = Callable[[], Any]


def median(call: Call, runs: int) -> float:
    """Seconds of a warm call, the median of some runs."""
    return alternate({"": call}, runs)[""]


def patient(call: Callable[[Any], Any], queries: Any) -> tuple[Call, int]:
    """Return a call with as many of the queries as are practical, and their number."""
    # The first call may have to make what later ones use.
    call(queries[:1])
    each = median(lambda: call(queries[:FEW]), 1) / FEW
    count = int(min(len(queries), max(FEW, PATIENCE / each)))
    return lambda: call(queries[:count]), count


def against(ours: Call, theirs: tuple[Call, int], runs: int) -> tuple[float, tuple[float, int]]:
    """Seconds of both, in turns, and how many queries the peer was asked."""
    call, count = theirs
    own, peer = alternate({"delone": ours, "peer": call}, runs).values()
    return own, (peer, count)


def amount(seconds: float) -> str:
    """Return a time as text in a fitting unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.0f} ns"


def line(
    what: str,
    ours: float,
    count: int,
    peer: str = "",
    theirs: tuple[float, int] | None = None,
) -> None:
    """Print a row of the table."""
    cells = [what, amount(ours), amount(ours / count), "", "", "", ""]
    if theirs is not None:
        seconds, asked = theirs
        name = peer if asked == count else f"{peer}, {asked:,} queries"
        times = seconds / asked * count / ours
        cells[3:] = [name, amount(seconds), amount(seconds / asked), f"{times:.3g}"]
    print("| " + " | ".join(cells) + " |", flush=True)


def orders(count: int) -> dict[str, Any]:
    """Queries in random order, and row by row."""
    rng = np.random.default_rng(2)
    side = int(np.sqrt(count))
    nodes = (np.arange(side) + 0.5) / side
    rows = np.stack(np.meshgrid(nodes, nodes), axis=-1).reshape(-1, 2)
    return {"random": rng.random((count, 2)), "rows": rows}


def cgal(points: Any, queries: Any, runs: int) -> dict[str, float]:
    """CGAL's seconds for location and for Sibson's weights; nothing where it is not installed."""
    program = build_cgal("cgal_fields")
    if program is None:
        return {}
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / name for name in ("sites", "queries")]
        for file, array in zip(files, (points, queries), strict=True):
            array.astype("<f8").tofile(file)
        command = [str(program), str(runs), *map(str, files)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    return {name: statistics.median(times) for name, times in runs_of(done.stdout).items()}


def location(sites: int, count: int, runs: int) -> None:
    """find_simplex, many at once, one at a time, and with two threads."""
    points = np.random.default_rng(1).random((sites, 2))
    mesh, twin = Delaunay(points, workers=1), Delaunay(points, workers=2)
    scipys = scipy.spatial.Delaunay(points).find_simplex
    print(f"\n{sites:,} sites, {count:,} queries:\n")
    head()
    for order, queries in orders(count).items():
        ask = lambda q=queries: mesh.find_simplex(q)  # noqa: E731
        ours, theirs = against(ask, patient(scipys, queries), runs)
        line(f"`find_simplex`, {order}", ours, len(queries), "SciPy", theirs)
        if order == "random" and (found := cgal(points, queries, min(runs, 3))):
            line("", ours, len(queries), "CGAL, sorting", (found["locate"], count))
        two = median(lambda q=queries: twin.find_simplex(q), runs)
        line(f"two threads: {ours / two:.2f} times one", two, len(queries))
    singles = list(np.random.default_rng(3).random((2000, 2)))
    few = singles[:FEW]
    ours, theirs = against(
        lambda: [mesh.find_simplex(q) for q in singles],
        (lambda: [scipys(q) for q in few], len(few)),
        runs,
    )
    line("`find_simplex`, one at a time", ours, len(singles), "SciPy", theirs)
    empty = np.empty((0, 2))
    ours = median(lambda: [mesh.find_simplex(empty) for _ in range(2000)], runs)
    line("the call itself, without a query", ours, 2000)


def fields(sites: int, count: int, runs: int) -> None:
    """From points to values, another field, and natural neighbours."""
    points = np.random.default_rng(1).random((sites, 2))
    values = np.sin(9 * points[:, 0]) * points[:, 1]
    print(f"\n{sites:,} sites, {count:,} queries:\n")
    head()
    for order, queries in orders(count).items():
        linear(points, values, queries, order, runs)
        natural(points, values, queries, order, runs)


def linear(points: Any, values: Any, queries: Any, order: str, runs: int) -> None:
    """The interpolators that SciPy has, and the next field."""
    count = len(queries)
    pairs: dict[str, tuple[Any, Any]] = {
        "Linear": (Linear, scipy.interpolate.LinearNDInterpolator),
        "CloughTocher": (CloughTocher, scipy.interpolate.CloughTocher2DInterpolator),
    }
    for name, (own, scipys) in pairs.items():
        calls = {
            "ours": lambda f=own: f(points, values, workers=1)(queries),
            "build": lambda f=scipys: f(points, values),
        }
        ask, asked = patient(scipys(points, values), queries)
        ours, building, asking = alternate(calls | {"ask": ask}, runs).values()
        theirs = (building * asked / count + asking, asked)
        line(f"`{name}`, points to values, {order}", ours, count, "SciPy", theirs)
    made = Linear(points, values, workers=1)
    made(queries[:1])
    line("the next field", median(lambda: made(queries, values=values), runs), count)
    table = made.weights_at(queries)
    line("the next field by `weights_at`", median(lambda: table @ values, runs), count)


def natural(points: Any, values: Any, queries: Any, order: str, runs: int) -> None:
    """Natural neighbours, of which SciPy has none."""
    count = len(queries)
    seconds = {}
    for kind in ("sibson", "laplace", "farin", "sibson1"):
        made = NaturalNeighbor(points, values, kind=kind, workers=1)
        made(queries[:1])
        seconds[kind] = median(lambda n=made: n(queries), runs)
        rate = count / seconds[kind] / 1e6
        line(f"`{kind}`, {order}: {rate:.2f} million/s", seconds[kind], count)
    if order != "random":
        return
    ours = seconds["sibson"]
    if found := cgal(points, queries, min(runs, 3)):
        line("", ours, count, "CGAL Sibson weights", (found["sibson"], count))
    if importlib.util.find_spec("startinpy"):
        import startinpy

        mesh = startinpy.DT()
        mesh.insert(np.column_stack((points, values)))
        call = lambda q: mesh.interpolate({"method": "NNI"}, q)  # noqa: E731
        ask, asked = patient(call, queries)
        line("", ours, count, "startinpy NNI", (median(ask, runs), asked))
    if importlib.util.find_spec("metpy"):
        from metpy.interpolate import natural_neighbor_to_points

        call = lambda q: natural_neighbor_to_points(points, values, q)  # noqa: E731
        # It triangulates in the call.
        line("", ours, count, "MetPy natural", (median(lambda: call(queries[:FEW]), runs), FEW))


def head() -> None:
    """Print the head of a table."""
    print("| " + " | ".join(HEAD) + " |")
    print("|" + "---|" * len(HEAD), flush=True)


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=100_000, help="sites; tenfold for location")
    parser.add_argument("--queries", type=int, help="ten times the sites unless given")
    parser.add_argument("--runs", type=int, default=5, help="runs for each line (default 5)")
    # `make bench` gives all programs the same options.
    given = parser.parse_known_args()[0]
    count = given.queries or 10 * given.n
    location(10 * given.n, count, given.runs)
    fields(given.n, count, given.runs)


if __name__ == "__main__":
    main()
