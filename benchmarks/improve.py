"""Improvement of tetrahedra: seconds, and dihedral angles before and after.

Sets: uniform points in a cube, a lattice whose inner points are shaken, and a ball with well spaced
points on its sphere. "inside" is the least angle in the middle eight tenths of the box. Run it:
``python benchmarks/improve.py [how many points, 20000 by default]``.
"""

import sys
import time

import numpy as np

import delone
from delone._tiling.space.quality import measured

GOALS = (15, 20, 25)


def uniform(count: int) -> np.ndarray:
    """Points in the unit cube."""
    return np.random.default_rng(0).random((count, 3))


def lattice(count: int) -> np.ndarray:
    """A cubic lattice; points inside are off by up to 0.3."""
    side = round(count ** (1 / 3))
    axes = np.meshgrid(*3 * [np.arange(float(side))], indexing="ij")
    points = np.stack(axes, axis=-1).reshape(-1, 3)
    inner = ((points > 0) & (points < side - 1)).all(axis=1)
    points[inner] += np.random.default_rng(1).uniform(-0.3, 0.3, (int(inner.sum()), 3))
    return points


def ball(count: int) -> np.ndarray:
    """Points in a ball, and on its sphere as many as the spacing asks for."""
    rng = np.random.default_rng(2)
    rim = round(4.8 * count ** (2 / 3))
    i = np.arange(rim) + 0.5
    angle, z = np.pi * (1 + 5**0.5) * i, 1 - 2 * i / rim
    radius = np.sqrt(1 - z * z)
    inner = rng.normal(size=(count, 3))
    inner *= (0.95 * rng.random(count) ** (1 / 3) / np.linalg.norm(inner, axis=1))[:, None]
    outer = np.column_stack((radius * np.cos(angle), radius * np.sin(angle), z))
    return np.concatenate((outer, inner))


def inside(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """Tell which tetrahedra have their centre a tenth of the box or more away from its sides."""
    low, high = points.min(axis=0), points.max(axis=0)
    centres = (points[simplices].mean(axis=1) - low) / (high - low)
    return ((centres > 0.1) & (centres < 0.9)).all(axis=1)


def row(name: str, points: np.ndarray, goal: float) -> None:
    """Improve once, and print a line of the table."""
    simplices = delone.Delaunay(points).simplices
    before = measured(points, simplices).smallest_dihedral
    within = before[inside(points, simplices)].min()
    start = time.process_time()
    mesh = delone.improve((points, simplices), min_angle=goal)
    seconds = time.process_time() - start
    after = mesh.quality().smallest_dihedral
    then = after[inside(mesh.points, mesh.simplices)].min()
    cells = [
        f"{name:8}{goal:5}{len(points):9}{len(simplices):10}",
        f"{before.min():9.4f}{within:9.4f}{np.count_nonzero(before < goal):9}",
        f"{after.min():9.2f}{then:9.2f}{np.count_nonzero(after < goal):9}",
        f"{mesh.report.passes:7}{seconds:9.2f}{seconds / len(simplices) * 1e6:9.1f}",
    ]
    print("".join(cells), flush=True)


def main() -> None:
    """Print the table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    print(f"{'':32}{'before':^27}{'after':^27}")
    print(
        f"{'set':8}{'goal':>5}{'points':>9}{'tetra':>10}"
        + f"{'least':>9}{'inside':>9}{'below':>9}" * 2
        + f"{'passes':>7}{'seconds':>9}{'us each':>9}"
    )
    for name, make in (("uniform", uniform), ("lattice", lattice), ("ball", ball)):
        points = make(count)
        for goal in GOALS:
            row(name, points, goal)


if __name__ == "__main__":
    main()
