"""Time and memory of `tetrahedralize` for a subdivided, noisy sphere.

Run ``python benchmarks/filling.py 6 7 8``: each level has four times the triangles of the one
before, and level 8 has 1.3 million.
"""

from __future__ import annotations

import resource
import sys
import time
from itertools import pairwise

import numpy as np

import delone


def sphere(level: int, noise: float = 0.2) -> tuple[np.ndarray, np.ndarray]:
    """Return an icosahedron divided `level` times, with noise of a part of its edges."""
    points = np.array([(0, x, y * 1.618) for x in (-1, 1) for y in (-1, 1)])
    points = np.concatenate([np.roll(points, k, axis=1) for k in range(3)])
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = delone.ConvexHull(points).simplices
    for _ in range(level):
        ends = faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        pairs, middle = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
        a, b, c = faces.T
        u, v, w = middle.reshape(-1, 3).T + len(points)
        added = points[pairs].mean(axis=1)
        points = np.concatenate((points, added / np.linalg.norm(added, axis=1)[:, None]))
        parts = (a, w, v), (w, b, u), (v, u, c), (u, v, w)
        faces = np.concatenate([np.column_stack(part) for part in parts])
    random = np.random.default_rng(level)
    return points + random.normal(size=points.shape) * noise * 2.0**-level / 3, faces


def main() -> None:
    """Print one line per level."""
    for level in map(int, sys.argv[1:] or ["6"]):
        points, faces = sphere(level)
        told: list[tuple[str, float]] = []
        mesh = delone.tetrahedralize(
            points, faces, progress=lambda stage, _, told=told: told.append((stage, time.time()))
        )
        steps = [f"{name} {after - before:.1f} s" for (name, before), (_, after) in pairwise(told)]
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{len(faces):,} triangles: {mesh.nsimplex:,} tetrahedra, {mesh.nadded} points added, "
            f"{told[-1][1] - told[0][1]:.1f} s ({', '.join(steps)}), {peak:,.0f} MiB",
            flush=True,
        )


if __name__ == "__main__":
    main()
