"""Soundings to a grid of depths by natural neighbors, written as a compressed NumPy file.

python benchmarks/jobs/soundings_to_grid.py --cells 250000
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from sidebyside import compare, stage

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np


def _input(given: argparse.Namespace) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions in kilometers, depths, and the places of the grid, (rows, columns, 2)."""
    with stage("read"):
        import numpy as np

        from delone.datasets import baja

        survey = baja()
        points, first = np.unique(survey.points, axis=0, return_index=True)
        scale = 111.2 * np.array((np.cos(np.radians(24.0)), 1))
        low, high = points.min(axis=0), points.max(axis=0)
        side = round(given.cells**0.5)
        x, y = (np.linspace(a, b, side) for a, b in zip(low * scale, high * scale, strict=True))
        places = np.stack(np.meshgrid(x, y), axis=-1)
        return points * scale, survey.z[first], places


def delone(given: argparse.Namespace, folder: Path) -> str:
    points, depth, places = _input(given)
    with stage("import"):
        from delone.interpolate import NaturalNeighbor
    with stage("triangulate"):
        surface = NaturalNeighbor(points, depth)
    with stage("interpolate"):
        found = surface(places)
    return _written(found, folder)


def startinpy(given: argparse.Namespace, folder: Path) -> str:
    points, depth, places = _input(given)
    with stage("import"):
        import numpy as np
        import startinpy
    with stage("triangulate"):
        triangulation = startinpy.DT()
        triangulation.insert(np.column_stack((points, depth)), insertionstrategy="BBox")
    with stage("interpolate"):
        found = triangulation.interpolate({"method": "NNI"}, places.reshape(-1, 2))
    return _written(found.reshape(places.shape[:2]), folder)


def metpy(given: argparse.Namespace, folder: Path) -> str:
    points, depth, places = _input(given)
    with stage("import"):
        from metpy.interpolate import natural_neighbor_to_grid
    with stage("triangulate and interpolate"):
        found = natural_neighbor_to_grid(*points.T, depth, places[..., 0], places[..., 1])
    return _written(found, folder)


def _written(found: np.ndarray, folder: Path) -> str:
    import numpy as np

    with stage("write"):
        np.savez_compressed(folder / "depths.npz", depths=found)
    return f"{np.isfinite(found).sum():,} cells, mean {np.nanmean(found):.3f}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--cells", type=int, default=250_000, help="cells of the grid")
    compare(__doc__, {"delone": delone, "startinpy": startinpy, "MetPy": metpy}, parser)
