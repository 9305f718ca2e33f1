"""What the figures of tetrahedra start with."""

from __future__ import annotations

from typing import Any

import numpy as np
from live_answers import flat, key

import delone

# Two corners of a square are lowered and two are lifted by these heights; the first is nearly that
# of a regular tetrahedron.
HEIGHTS = (36, 28, 20, 14, 9, 5, 2, 1)
# The pictures without scripts, and the first ones, look from here.
TURN, TILT = 25.0, 14.0


def corners(height: int) -> list[list[int]]:
    """Return the corners of a tetrahedron in a sphere around the origin."""
    return [[50, 0, -height], [0, 50, height], [-50, 0, -height], [0, -50, height]]


def sliver() -> dict[str, Any]:
    """Return the figure of one tetrahedron that is made flatter."""
    answers = {}
    for height in HEIGHTS:
        mesh = delone.Delaunay(corners(height))
        quality = mesh.quality()
        answers[key("tetrahedra", flat(corners(height)))] = {
            "tetrahedra": flat(mesh.simplices.tolist()),
            "volumes": mesh.volumes.tolist(),
            "minDihedral": quality.smallest_dihedral.tolist(),
            "maxDihedral": quality.largest_dihedral.tolist(),
        }
    faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
    return {
        "points": corners(HEIGHTS[0]),
        "heights": list(HEIGHTS),
        "answers": answers,
        "picture": seen(np.array(corners(14)), faces, (-80, -40, 80, 40)),
    }


def ball() -> np.ndarray:
    """Return points on a sphere, and a slightly disturbed lattice inside."""
    k = np.arange(44) + 0.5
    z, turn = 1 - k / 22, np.pi * (1 + 5**0.5) * k
    wide = np.sqrt(1 - z * z)
    sphere = np.rint(300 * np.stack([wide * np.cos(turn), wide * np.sin(turn), z], axis=1))
    axis = np.arange(-330, 331, 110)
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    lattice += np.random.default_rng(1).integers(-6, 7, lattice.shape)
    return np.vstack([sphere, lattice[np.linalg.norm(lattice, axis=1) < 212]])


def slivers() -> dict[str, Any]:
    """Return the figure of a mesh in three states: Delaunay, after flips, after moves too."""
    first = delone.Delaunay(ball())
    flipped = delone.improve(first, smooth=False)
    meshes = [first, flipped, delone.improve(first)]
    faces = first.convex_hull.tolist()
    return {
        "points": first.points.tolist(),
        "meshes": [
            {
                "points": np.round(mesh.points, 3).ravel().tolist(),
                "tetrahedra": flat(mesh.simplices.tolist()),
                "angles": np.round(mesh.quality().smallest_dihedral, 3).tolist(),
                "moved": np.flatnonzero((mesh.points != first.points).any(axis=1)).tolist(),
            }
            for mesh in meshes
        ],
        "answers": {},
        "picture": seen(first.points, faces, (-320, -320, 320, 320)),
    }


def seen(
    points: np.ndarray, faces: list[list[int]], view: tuple[float, float, float, float]
) -> dict[str, Any]:
    """Return a picture of points in 3-D, projected as spin.js does."""
    a, e = np.radians([TURN, TILT])
    x, y, z = points.T
    across = x * np.cos(a) - y * np.sin(a)
    up = (x * np.sin(a) + y * np.cos(a)) * np.sin(e) + z * np.cos(e)
    flat_points = np.round(np.stack([across, up], axis=1), 2).tolist()
    return {"points": flat_points, "triangles": faces, "view": view}
