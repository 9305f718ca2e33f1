"""Tetrahedra inside closed surfaces, also by TetGen if installed: seconds, memory, added points.

``python benchmarks/filling.py sphere:6 roofs part.stl`` takes noisy spheres (each level has four
times the triangles of the one before; level 8 has 1.3 million), the shipped lidar roofs closed to a
solid, and files. ``--help`` has options.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
import report
from numpy.typing import NDArray
from rounds import HEAD, Module, compete
from solid_adapters import PEERS, Surface, save

import delone
from delone.compat.tetgen import TetGen

TILE = Path(__file__).parents[1] / "examples" / "data" / "ahn3_crop_100m.laz"
BASE = 5.0


def sphere(level: int, noise: float = 0.2) -> Surface:
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
    return Surface(points + random.normal(size=points.shape) * noise * 2.0**-level / 3, faces)


def roofs(file: Path = TILE) -> Surface:
    """Return the ground and roofs of a lidar tile, with walls down to a base below them.

    The base repeats the points of the hull alone, so it has long triangles and the top short ones.
    """
    points = delone.io.read_points(file)
    ground = delone.Delaunay(points)
    used = np.unique(ground.simplices)
    top = np.column_stack((points.points, points.z))[used]
    faces = np.searchsorted(used, ground.simplices)
    rim = np.searchsorted(used, ground.hull)
    base = top[rim] * [1, 1, 0] + [0, 0, top[:, 2].min() - BASE]
    below = len(top) + np.arange(len(rim))
    floor = delone.Delaunay(base[:, :2]).simplices[:, ::-1] + len(top)
    after, after_below = np.roll(rim, -1), np.roll(below, -1)
    walls = np.column_stack((rim, below, after_below)), np.column_stack((rim, after_below, after))
    return Surface(np.concatenate((top, base)), np.concatenate((faces, floor, *walls)))


def surface(name: str) -> Surface:
    """Return a surface by its name or from a file."""
    if name.startswith("sphere:"):
        return sphere(int(name.removeprefix("sphere:")))
    if name == "roofs":
        return roofs()
    given = TetGen(name)
    return Surface(given.v, given.f)


def row(peer: Module, base: Module) -> list[str]:
    """Return a peer's line of the table."""
    counts: NDArray[np.int64] | list[str] = ["", "", ""]
    if peer.times.warm:
        counts = np.load(peer.answer)
    return [peer.times.name, *peer.times.cells(base.times), *(f"{count:,}" for count in counts)]


def main() -> None:
    """Print one table per surface."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("surfaces", nargs="*", default=["sphere:6"])
    parser.add_argument("--peers", default=",".join(PEERS), help="which peers take part")
    parser.add_argument("--rounds", type=int, default=3, help="processes of each peer (default 3)")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds a run may take")
    given = parser.parse_args()
    for name in given.surfaces:
        made = surface(name)
        print(f"\n`{Path(name).name}`, {len(made.faces):,} triangles\n")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "surface.npz"
            save(made, file)
            peers = [
                Module(peer, file, module="solid_adapters", limit=given.limit)
                for peer in given.peers.split(",")
            ]
            compete(peers, given.rounds, 1)
            rows = [row(peer, peers[0]) for peer in peers]
        print(report.table(["peer", *HEAD, "tetrahedra", "added", "faces kept"], rows), flush=True)


if __name__ == "__main__":
    main()
