"""A lidar tile to a picture of its heights: reading, triangulating, drawing with matplotlib.

python benchmarks/jobs/lidar_to_picture.py examples/data/ahn3_crop_100m.laz
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from sidebyside import compare, stage

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np


def delone(given: argparse.Namespace, folder: Path) -> str:
    plt = _pyplot()
    with stage("import"):
        from delone import Delaunay
        from delone.io import read_points
    with stage("read"):
        survey = read_points(given.file)
    with stage("triangulate"):
        mesh = Delaunay(survey.points, planar=True)
    with stage("draw"):
        figure, ax = plt.subplots(figsize=(8, 8))
        mesh.plot(ax, z=survey.z)
        figure.savefig(folder / "tile.png", dpi=100)
    return f"{mesh.nsimplex:,} triangles"


def matplotlib(given: argparse.Namespace, folder: Path) -> str:
    plt = _pyplot()
    xyz = _read(given.file)
    with stage("triangulate"):
        from matplotlib.tri import Triangulation

        mesh = Triangulation(*xyz[:, :2].T)
    return _drawn(plt, mesh, xyz, folder)


def scipy(given: argparse.Namespace, folder: Path) -> str:
    plt = _pyplot()
    xyz = _read(given.file)
    with stage("triangulate"):
        from matplotlib.tri import Triangulation
        from scipy.spatial import Delaunay

        mesh = Triangulation(*xyz[:, :2].T, Delaunay(xyz[:, :2] - xyz[0, :2]).simplices)
    return _drawn(plt, mesh, xyz, folder)


def _drawn(plt: object, mesh: object, xyz: np.ndarray, folder: Path) -> str:
    with stage("draw"):
        figure, ax = plt.subplots(figsize=(8, 8))
        ax.tripcolor(mesh, xyz[:, 2], shading="gouraud")
        ax.set_aspect("equal")
        figure.savefig(folder / "tile.png", dpi=100)
    return f"{len(mesh.triangles):,} triangles"


def _pyplot() -> object:
    with stage("import"):
        import matplotlib as package

        package.use("agg")
        from matplotlib import pyplot

        return pyplot


def _read(file: str) -> np.ndarray:
    with stage("read"):
        import laspy

        return laspy.read(file).xyz


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("file", help="a LAS or LAZ file")
    compare(__doc__, {"delone": delone, "matplotlib": matplotlib, "SciPy": scipy}, parser)
