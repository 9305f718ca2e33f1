"""Quality meshes compared with those of other libraries: seconds, counts, angles.

delone, the package ``triangle``, spade, CGAL's mesher and, where it is installed, gmsh mesh a
fractal ring and, where ``--coastline`` or the environment variable DELONE_COASTLINE names the land
polygons of Natural Earth, their largest outline, at two caps of area each. Each run is a process of
its own, so that one library cannot slow another down, and none can take the table along where it
ends the process; the libraries take turns run by run.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import crates
import lines
import numpy as np
import report

TRIANGLES = (100_000, 1_000_000)
ANGLE = 30
# CGAL proves its end up to here, and does not come to it on all inputs above.
CGAL_ANGLE = 20.7
# Triangles of a mesh have on average this part of the cap in Triangle, where sizes decide.
SHARE = 0.6
# Above so many seconds one run is enough.
LONG = 12
HEAD = ["library", "triangles", "seconds", "us each", "times delone", "below", "angles"]


def ring() -> lines.Lines:
    """A fractal ring with 28,672 segments that all meet alike."""
    corners = np.arange(7) * 2 * np.pi / 7
    points = np.column_stack((np.cos(corners), np.sin(corners)))
    for _ in range(12):
        step = np.roll(points, -1, axis=0) - points
        side = np.where(np.arange(len(points)) % 2 == 0, 0.19, -0.19)[:, None]
        middle = points + step / 2 + side * step[:, ::-1] * (1, -1)
        points = np.stack((points, middle), axis=1).reshape(-1, 2)
    return outline(points)


def continent(file: Path) -> lines.Lines:
    """The largest outline of a file of land."""
    given = lines.coastline(file)
    first = np.flatnonzero(np.diff(given.segments[:, 0], prepend=-2) != 1)
    counts = np.diff(first, append=len(given.segments))
    longest = int(np.argmax(counts))
    start = int(given.segments[first[longest], 0])
    points = given.points[start : start + counts[longest]]
    _, distinct = np.unique(points, axis=0, return_index=True)
    return outline(points[np.sort(distinct)])


def outline(points: np.ndarray) -> lines.Lines:
    """Close a ring."""
    rows = np.arange(len(points), dtype=np.int32)
    return lines.Lines(points, np.column_stack((rows, np.roll(rows, -1))))


def area(given: lines.Lines) -> float:
    """The area inside a ring."""
    x, y = given.points.T
    return abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))) / 2


def with_delone(given: lines.Lines, cap: float) -> tuple[float, np.ndarray]:
    """Mesh with delone, on one thread."""
    import delone

    start = time.perf_counter()
    mesh = delone.mesh((given.points, given.segments), min_angle=ANGLE, max_area=cap, workers=1)
    seconds = time.perf_counter() - start
    return seconds, mesh.points[mesh.simplices]


def with_triangle(given: lines.Lines, cap: float) -> tuple[float, np.ndarray]:
    """Mesh with the package triangle."""
    import triangle

    tri = {"vertices": given.points, "segments": given.segments}
    start = time.perf_counter()
    out = triangle.triangulate(tri, f"pq{ANGLE}a{cap:.17f}")
    seconds = time.perf_counter() - start
    return seconds, np.asarray(out["vertices"])[np.asarray(out["triangles"])]


def with_gmsh(given: lines.Lines, cap: float) -> tuple[float, np.ndarray]:
    """Mesh with gmsh's Delaunay algorithm; it knows sizes of edges, and no bound of angles."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Algorithm", 5)
    edge = float(np.sqrt(4 / np.sqrt(3) * SHARE * cap))
    for i, (x, y) in enumerate(given.points.tolist(), 1):
        gmsh.model.geo.addPoint(x, y, 0, edge, i)
    for i, (u, v) in enumerate(given.segments.tolist(), 1):
        gmsh.model.geo.addLine(u + 1, v + 1, i)
    gmsh.model.geo.addCurveLoop(list(range(1, len(given.segments) + 1)), 1)
    gmsh.model.geo.addPlaneSurface([1], 1)
    gmsh.model.geo.synchronize()
    start = time.perf_counter()
    gmsh.model.mesh.generate(2)
    seconds = time.perf_counter() - start
    tags, places, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags] = np.arange(len(tags))
    _, _, nodes = gmsh.model.mesh.getElements(2)
    return seconds, places.reshape(-1, 3)[row[nodes[0]].reshape(-1, 3), :2]


def with_program(program: Path, angle: float) -> Callable[..., tuple[float, np.ndarray]]:
    """Mesh with a compiled program."""

    def meshed(given: lines.Lines, cap: float) -> tuple[float, np.ndarray]:
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "lines", Path(folder) / "corners"
            given.points.astype("<f8").tofile(file)
            given.segments.astype("<u4").tofile(f"{file}.segments")
            command = [str(program), str(file), str(angle), repr(cap), str(out)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            return float(done.stdout), np.fromfile(out, "<f8").reshape(-1, 3, 2)

    return meshed


RUST = crates.CRATE / "target" / "release" / "refine"
CGAL = crates.CRATE / "target" / "cgal_refine"
LIBRARIES = {
    "delone": with_delone,
    "triangle": with_triangle,
    "spade": with_program(RUST, ANGLE),
    f"CGAL {CGAL_ANGLE}": with_program(CGAL, CGAL_ANGLE),
    "CGAL": with_program(CGAL, ANGLE),
    "gmsh": with_gmsh,
}


def one(library: str, file: str, cap: float) -> dict:
    """Mesh once, and measure what came out by one and the same code."""
    from delone._tiling.plane.quality import below, measured

    seconds, corners = LIBRARIES[library](lines.load(file), cap)
    points = np.ascontiguousarray(corners.reshape(-1, 2))
    simplices = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    a, b, c = corners.transpose(1, 0, 2)
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    simplices[turn < 0] = simplices[turn < 0][:, ::-1]
    quality = measured(points, simplices)
    return {
        "seconds": seconds,
        "triangles": len(simplices),
        "below": len(below(points, simplices, ANGLE)),
        "smallest": float(quality.smallest_angle.min()),
        "largest": float(quality.largest_angle.max()),
    }


def turn(library: str, file: Path, cap: float, limit: float) -> dict | str:
    """Run a library in a process of its own."""
    command = [sys.executable, __file__, "--one", library, str(file), repr(cap)]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        output, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        # Programs that it started end as well.
        os.killpg(process.pid, 9)
        process.wait()
        return f"no end in {limit:.0f} s"
    return json.loads(output) if process.returncode == 0 else f"ends with {process.returncode}"


def table(given: lines.Lines, wanted: int, names: list[str], options: argparse.Namespace) -> str:
    """Mesh with all libraries in turns; the lines of the table."""
    cap = area(given) / wanted / SHARE
    found: dict[str, list[dict]] = {name: [] for name in names}
    ended: dict[str, str] = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "lines.npz"
        lines.save(given, file)
        for _ in range(options.runs):
            for name in names:
                if name in ended or (found[name] and found[name][0]["seconds"] > LONG):
                    continue
                made = turn(name, file, cap, options.limit)
                if isinstance(made, str):
                    ended[name] = made
                else:
                    found[name].append(made)
    base = None
    rows = []
    for name in names:
        if name in ended:
            rows.append([name, ended[name], "", "", "", "", ""])
            continue
        made = found[name][0]
        seconds = report.median([run["seconds"] for run in found[name]])
        each = seconds / made["triangles"]
        base = base or each
        rows.append(
            [
                name,
                f"{made['triangles']:,}",
                report.seconds(seconds),
                f"{each * 1e6:.2f}",
                report.ratio(each / base),
                f"{made['below']:,}",
                f"{made['smallest']:.4g} to {made['largest']:.4g}",
            ]
        )
    return report.table(HEAD, rows)


def daring(runs: int = 6) -> str:
    """Bounds above 33 degrees, on a square with segments at random that meet at no small angle."""
    import warnings

    import delone

    warnings.simplefilter("ignore")
    rows = []
    for angle in (33, 34, 35):
        for seed in range(runs):
            rng = np.random.default_rng(seed)
            domain = random_segments(rng, 100)
            mesh = delone.mesh(domain, min_angle=angle, max_points=200_000)
            told = mesh.report
            rows.append(
                [
                    str(angle),
                    str(seed),
                    f"{mesh.nsimplex:,}",
                    "no end" if told.exhausted else "ends",
                    f"{told.smallest_angle:.2f}",
                ]
            )
    return report.table(["bound", "seed", "triangles", "with 200,000 points", "smallest"], rows)


def random_segments(rng: np.random.Generator, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Segments in a square that stay apart by a quarter of their lengths, and so meet nowhere."""
    points = [np.array([(0.0, 0), (1, 0), (1, 1), (0, 1)])]
    kept: list[np.ndarray] = []
    while len(kept) < count:
        middle, turned = rng.uniform(0.05, 0.95, 2), rng.uniform(0, np.pi)
        step = 0.02 * np.array([np.cos(turned), np.sin(turned)])
        if all(np.hypot(*(middle - other)) > 0.05 for other in kept):
            kept.append(middle)
            points.append(np.array([middle - step, middle + step]))
    pairs = 4 + np.arange(2 * count).reshape(-1, 2)
    return np.concatenate(points), np.concatenate(([(0, 1), (1, 2), (2, 3), (3, 0)], pairs))


def options() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--coastline", default=os.environ.get("DELONE_COASTLINE"), help="GeoJSON")
    parser.add_argument("--runs", type=int, default=3, help="runs for each library (default 3)")
    parser.add_argument("--limit", type=float, default=120.0, help="seconds a run may take")
    parser.add_argument("--libraries", help="names, with commas between; by default what is there")
    return parser.parse_known_args()[0]


def available() -> list[str]:
    """Build what is compiled, and return the libraries that are there."""
    import importlib.util

    crates.build()
    missing = {name for name in ("triangle", "gmsh") if importlib.util.find_spec(name) is None}
    if crates.build_cgal("cgal_refine") is None:
        missing |= {name for name in LIBRARIES if name.startswith("CGAL")}
    return [name for name in LIBRARIES if name not in missing]


def main() -> None:
    """Print the tables."""
    if sys.argv[1:2] == ["--one"]:
        _, _, library, file, cap = sys.argv
        print(json.dumps(one(library, file, float(cap))))
        return
    arguments = options()
    names = available()
    if arguments.libraries:
        names = [name for name in names if name in arguments.libraries.split(",")]
    inputs = {"fractal ring": ring()}
    if arguments.coastline:
        inputs["largest outline"] = continent(Path(arguments.coastline))
    print(f"Quality meshes, {arguments.runs} runs; {report.machine()}\n")
    for name, given in inputs.items():
        for wanted in TRIANGLES:
            text = table(given, wanted, names, arguments)
            print(f"{name}, {len(given.segments):,} segments, cap for {wanted:,}\n\n{text}\n")
            sys.stdout.flush()
    print(daring())


if __name__ == "__main__":
    main()
