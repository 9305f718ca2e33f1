"""One large lidar file on one machine: seconds a stage, peak memory a point, exact validation.

``python benchmarks/lidar.py autzen.laz`` or the environment variable DELONE_LIDAR names the file;
the tables of benchmarks/README.md use autzen.laz of the PDAL project's sample data. The report is
that of ``Delaunay.stages`` and ``Delaunay.validate``; the memory is the peak of the call beyond
what the process holds before it, so the coordinates themselves are not in it.
"""

import os
import sys
import time
from pathlib import Path

import memory
import numpy as np
import report


def read(file: Path) -> np.ndarray:
    """Return the x and y of a LAS or LAZ file, read in chunks so that little else is held."""
    import laspy

    with laspy.open(file) as source:
        points = np.empty((source.header.point_count, 2))
        row = 0
        for chunk in source.chunk_iterator(1 << 20):
            points[row : row + len(chunk), 0] = chunk.x
            points[row : row + len(chunk), 1] = chunk.y
            row += len(chunk)
    return points


def main() -> None:
    """Triangulate, measure and validate the file that is named."""
    name = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("DELONE_LIDAR", "")
    if not name:
        sys.exit("usage: python benchmarks/lidar.py FILE.laz (or set DELONE_LIDAR)")
    from delone import Delaunay

    points = read(Path(name))
    before = memory.start()
    start = time.perf_counter()
    mesh = Delaunay(points, workers=1)
    seconds = time.perf_counter() - start
    grown = memory.peak() - before
    distinct = len(np.unique(mesh.duplicate_of))
    rows = [["points", f"{len(points):,}"], ["distinct", f"{distinct:,}"]]
    rows += [["triangles", f"{len(mesh.simplices):,}"]]
    rows += [[f"seconds, {stage}", f"{time:.3g}"] for stage, time in mesh.stages.items()]
    rows += [["seconds, in all", f"{seconds:.3g}"]]
    rows += [["ns a point", f"{1e9 * seconds / len(points):.0f}"]]
    rows += [["peak bytes a point beyond the input", f"{grown / len(points):.0f}"]]
    start = time.perf_counter()
    verdict = str(mesh.validate())
    rows += [["validation", f"{verdict} ({time.perf_counter() - start:.3g} s)"]]
    print(f"{Path(name).name}, one thread; {report.machine()}\n")
    print(report.table(["", "value"], rows))


if __name__ == "__main__":
    main()
