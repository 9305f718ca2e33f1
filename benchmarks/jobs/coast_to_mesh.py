"""A coastline to a mesh file with angles of at least 30 degrees: reading, meshing, writing.

    python benchmarks/jobs/coast_to_mesh.py ne_10m_land.geojson.gz --max-area 0.05

The outline is the largest polygon of the file, without holes. gmsh has no bound on angles: it gets
the edge length of equilateral triangles of that area.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from sidebyside import compare, stage

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np


def delone(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        import delone as package
        from delone.io import write_mesh
    ring, sides = _ring(given.file)
    with stage("mesh"):
        mesh = package.mesh((ring, sides), min_angle=30, max_area=given.max_area)
    with stage("write"):
        write_mesh(folder / "coast.msh", mesh)
    return f"{mesh.nsimplex:,} triangles"


def triangle(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        import meshio
        import triangle as package
    ring, sides = _ring(given.file)
    with stage("mesh"):
        found = package.triangulate(
            {"vertices": ring, "segments": sides}, f"pq30a{given.max_area:.12f}"
        )
    with stage("write"):
        cells = [("triangle", found["triangles"])]
        meshio.Mesh(found["vertices"], cells).write(folder / "coast.msh", file_format="gmsh")
    return f"{len(found['triangles']):,} triangles"


def gmsh(given: argparse.Namespace, folder: Path) -> str:
    with stage("import"):
        import gmsh as package
    ring, sides = _ring(given.file)
    with stage("mesh"):
        package.initialize()
        package.option.setNumber("General.Terminal", 0)
        size = (given.max_area * 4 / 3**0.5) ** 0.5
        geometry = package.model.geo
        for x, y in ring.tolist():
            geometry.addPoint(x, y, 0, size)
        lines = [geometry.addLine(a + 1, b + 1) for a, b in sides.tolist()]
        geometry.addPlaneSurface([geometry.addCurveLoop(lines)])
        geometry.synchronize()
        package.model.mesh.generate(2)
        count = sum(len(each) for each in package.model.mesh.getElements(2)[1])
    with stage("write"):
        package.write(str(folder / "coast.msh"))
    return f"{count:,} triangles"


def _ring(file: str) -> tuple[np.ndarray, np.ndarray]:
    """The corners of the largest polygon, and its sides as pairs of rows."""
    with stage("read"):
        import gzip
        import json
        from pathlib import Path

        import numpy as np

        data = Path(file).read_bytes()
        found = json.loads(gzip.decompress(data) if file.endswith(".gz") else data)
        rings = []
        for feature in found["features"]:
            parts = feature["geometry"]["coordinates"]
            whole = feature["geometry"]["type"] == "MultiPolygon"
            rings += [part[0] for part in parts] if whole else [parts[0]]
        ring = np.array(max(rings, key=len))[:-1]
        rows = np.arange(len(ring))
        return ring, np.column_stack((rows, np.roll(rows, -1)))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("file", help="GeoJSON of polygons, plain or compressed")
    parser.add_argument("--max-area", type=float, default=0.05, help="largest area of a triangle")
    compare(__doc__, {"delone": delone, "triangle": triangle, "gmsh": gmsh}, parser)
