"""Pictures of the tutorial on finite elements in 3-D, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np

import delone
from delone import plot


def ball(size: float) -> np.ndarray:
    """Points on the unit sphere and a shaken lattice inside, about `size` apart."""
    count = round(4 * np.pi / (0.87 * size**2))
    row = np.arange(count) + 0.5
    height, angle = 1 - 2 * row / count, np.pi * (1 + np.sqrt(5)) * row
    ring = np.sqrt(1 - height**2)
    surface = np.column_stack((ring * np.cos(angle), ring * np.sin(angle), height))
    axis = np.arange(-1, 1 + size, size)
    lattice = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    lattice += np.random.default_rng(0).uniform(-0.2 * size, 0.2 * size, lattice.shape)
    return np.concatenate((surface, lattice[np.linalg.norm(lattice, axis=1) < 1 - 0.6 * size]))


def cut_and_slivers() -> None:
    """A ball cut open, its slivers before improvement, and the angles before and after."""
    plain = delone.Delaunay(ball(0.14))
    better = delone.improve(plain, min_angle=20)
    radius = np.linalg.norm(better.points, axis=1)
    pictures = (
        ("solution on the improved mesh", better, {"values": 1 - radius**2, "cut": "x"}),
        ("slivers before, below 5 degrees", plain, {"below": 5}),
    )
    _, row = plt.subplots(1, 3, figsize=(12, 3.9), layout="constrained")
    for ax, (title, shape, options) in zip(row[:2], pictures, strict=True):
        ax.imshow(plot.image(shape, colorbar=False, **options))
        ax.set_title(title, fontsize="medium")
        ax.set_axis_off()
    bins = np.arange(0, 75, 2.5)
    for mesh, name in ((plain, "before"), (better, "after")):
        row[2].hist(mesh.quality().smallest_dihedral, bins, alpha=0.6, label=name)
    row[2].axvline(20, color="black", linewidth=1)
    row[2].set_title("smallest dihedral angle of each tetrahedron", fontsize="medium")
    row[2].set(xlabel="degrees", ylabel="tetrahedra")
    row[2].legend()
