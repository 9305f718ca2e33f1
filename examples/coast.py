"""An island, its lake and a road as a mesh for finite elements: segments, holes, conforming.

The coast is a fractal ring of some thousand segments, rough enough to cross itself. Its crossings
are split, the outside and the lake are removed, and vertices are added until every segment
is a Delaunay edge. Run it: ``python examples/coast.py``.
"""

import numpy as np

from delone import Delaunay, from_geometry, triangulate_polygon
from delone.testing import same_triangles

LEVELS = 8


def fractal(corners: list[tuple[float, float]], levels: int, seed: int) -> np.ndarray:
    """Break each side of a ring in its middle, sideways, again and again."""
    random = np.random.default_rng(seed)
    ring = np.array(corners, dtype=float)
    for _ in range(levels):
        step = np.roll(ring, -1, axis=0) - ring
        aside = step[:, ::-1] * (-1, 1) * random.uniform(-0.35, 0.35, (len(ring), 1))
        ring = np.stack((ring, ring + step / 2 + aside), axis=1).reshape(-1, 2)
    return ring


def main() -> None:
    """Make the mesh, prove it, and say what became of the input."""
    coast = fractal([(0, 0), (9, -1), (12, 5), (4, 8), (-1, 5)], LEVELS, seed=7)
    lake = [(4.0, 3.0), (6.0, 3.0), (6.0, 4.0), (4.0, 4.0)]
    land = {"type": "Polygon", "coordinates": [coast.tolist(), lake]}
    road = {"type": "LineString", "coordinates": [(-3, 2), (5, 1.5), (15, 2.5)]}
    mesh = from_geometry(
        [land, road], boundary="polygons", regions=[(5, 5, 1), (5, 1, 2)], conforming=True
    )
    assert mesh.validate()

    report = mesh.report
    print(f"{len(mesh.input_segments):,} segments, {len(report.crossings)} crossings")
    print(f"{mesh.nadded:,} vertices added, {mesh.nsimplex:,} triangles")
    # The triangles of the whole hull are those of the vertices alone, but for ties.
    whole = from_geometry([land, road], conforming=True)
    plain = Delaunay(whole.points)
    assert same_triangles(whole.simplices, plain.simplices)

    points, simplices = triangulate_polygon(land)
    u, v = points[simplices[:, 1:]].swapaxes(0, 1) - points[simplices[:, 0]]
    area = np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    north = mesh.areas[mesh.region == 1].sum()
    print(f"area {area:.4f}, of it {north:.4f} north of the road")
    assert np.isclose(area, mesh.areas.sum())


if __name__ == "__main__":
    main()
