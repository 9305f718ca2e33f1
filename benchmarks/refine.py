"""Quality meshes side by side with the package ``triangle``: seconds, counts, angles.

Each run is a process of its own, so that one library cannot slow another down, and none can take
the table along where it ends the process. Inputs are a fractal ring and, where the file is given, a
continent of Natural Earth. Run it: ``python benchmarks/refine.py [ne_10m_land.geojson.gz]``.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import lines
import numpy as np

REPEATS = 3
TRIANGLES = (100_000, 1_000_000)
ANGLE = 30
# Seconds after which a library is given up.
PATIENCE = 300
LIBRARIES = ("delone", "triangle")


def ring() -> lines.Lines:
    """A ring of Koch's curves over a heptagon with 28,672 segments."""
    corners = np.arange(7) * 2 * np.pi / 7
    points = np.column_stack((np.cos(corners), np.sin(corners)))
    for _ in range(12):
        step = np.roll(points, -1, axis=0) - points
        side = np.where(np.arange(len(points)) % 2 == 0, 0.19, -0.19)[:, None]
        middle = points + step / 2 + side * step[:, ::-1] * (1, -1)
        points = np.stack((points, middle), axis=1).reshape(-1, 2)
    rows = np.arange(len(points), dtype=np.int32)
    return lines.Lines(points, np.column_stack((rows, np.roll(rows, -1))))


def continent(file: str) -> lines.Lines:
    """The largest polygon of a file of land, its outer ring alone."""
    import gzip

    opened = gzip.open if file.endswith(".gz") else open
    with opened(file) as source:
        features = json.load(source)["features"]
    polygons = []
    for feature in features:
        shape = feature["geometry"]
        polygons += [shape["coordinates"]] if shape["type"] == "Polygon" else shape["coordinates"]
    outer = np.array(max(polygons, key=lambda polygon: len(polygon[0]))[0])[:-1]
    _, first = np.unique(outer, axis=0, return_index=True)
    outer = outer[np.sort(first)]
    rows = np.arange(len(outer), dtype=np.int32)
    return lines.Lines(outer, np.column_stack((rows, np.roll(rows, -1))))


def area(given: lines.Lines) -> float:
    """The area inside of a ring."""
    x, y = given.points.T
    return abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))) / 2


def run(library: str, given: lines.Lines, cap: float) -> dict:
    """Mesh once, and measure what came out by one and the same code."""
    if library == "delone":
        import delone

        start = time.perf_counter()
        mesh = delone.mesh((given.points, given.segments), min_angle=ANGLE, max_area=cap, workers=1)
        seconds = time.perf_counter() - start
        points, simplices = mesh.points, mesh.simplices
    else:
        import triangle

        tri = {"vertices": given.points, "segments": given.segments}
        start = time.perf_counter()
        out = triangle.triangulate(tri, f"pq{ANGLE}a{cap:.17f}")
        seconds = time.perf_counter() - start
        points, simplices = np.asarray(out["vertices"]), np.asarray(out["triangles"], np.int32)
    from delone.quality import below, measured

    quality = measured(points, simplices)
    return {
        "seconds": seconds,
        "triangles": len(simplices),
        "below": len(below(points, simplices, ANGLE)),
        "smallest": float(quality.smallest_angle.min()),
        "largest": float(quality.largest_angle.max()),
    }


def best(library: str, file: Path, cap: float) -> dict | str:
    """The fastest of several runs, each in a process of its own."""
    found = []
    for _ in range(REPEATS):
        command = [sys.executable, __file__, "--one", library, str(file), repr(cap)]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=PATIENCE, check=False
            )
        except subprocess.TimeoutExpired:
            return f"no end within {PATIENCE} s"
        if done.returncode:
            return f"ended with {done.returncode}"
        found.append(json.loads(done.stdout))
    return min(found, key=lambda each: each["seconds"])


def cap_for(given: lines.Lines, wanted: int) -> float:
    """The cap of areas at which Triangle makes about so many triangles, where it is installed."""
    return area(given) / wanted * 1.65


def main() -> None:
    """Print the table."""
    if sys.argv[1:2] == ["--one"]:
        _, _, library, file, cap = sys.argv
        print(json.dumps(run(library, lines.load(file), float(cap))))
        return
    inputs = {"ring": ring()}
    if len(sys.argv) > 1:
        inputs["continent"] = continent(sys.argv[1])
    head = ("input", "segments", "library", "triangles", "seconds", "us each", "below", "angles")
    print(("{:<10}{:>9} {:<10}{:>11}{:>9}{:>9}{:>7} {:>15}").format(*head))
    with tempfile.TemporaryDirectory() as folder:
        for name, given in inputs.items():
            file = Path(folder) / f"{name}.npz"
            lines.save(given, file)
            for wanted in TRIANGLES:
                for library in LIBRARIES:
                    found = best(library, file, cap_for(given, wanted))
                    print(
                        f"{name:<10}{len(given.segments):>9,} {library:<10}{_row(found)}",
                        flush=True,
                    )


def _row(found: dict | str) -> str:
    if isinstance(found, str):
        return found
    each = found["seconds"] / found["triangles"] * 1e6
    return (
        f"{found['triangles']:>11,}{found['seconds']:>9.3f}{each:>9.3f}{found['below']:>7}"
        f" {found['smallest']:>6.2f} -{found['largest']:>7.2f}"
    )


if __name__ == "__main__":
    main()
