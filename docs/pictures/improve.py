"""A picture of improved tetrahedra, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np

import delone


def histogram() -> None:
    """Smallest dihedral angles before and after, of three sets of points."""
    rng = np.random.default_rng(3)
    axes = np.meshgrid(*3 * [np.arange(14.0)], indexing="ij")
    lattice = np.stack(axes, axis=-1).reshape(-1, 3)
    inner = ((lattice > 0) & (lattice < 13)).all(axis=1)
    lattice[inner] += rng.uniform(-0.3, 0.3, (int(inner.sum()), 3))
    i = np.arange(700) + 0.5
    angle, z = np.pi * (1 + 5**0.5) * i, 1 - 2 * i / 700
    sphere = np.column_stack((np.cos(angle), np.sin(angle), z / np.sqrt(1 - z * z)))
    sphere *= np.sqrt(1 - z * z)[:, None]
    ball = rng.normal(size=(2000, 3))
    ball *= (0.94 * rng.random(2000) ** (1 / 3) / np.linalg.norm(ball, axis=1))[:, None]
    sets = {
        "a shaken lattice": lattice,
        "a ball": np.concatenate((sphere, ball)),
        "uniform points": rng.random((2500, 3)),
    }
    _, row = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
    for ax, (name, points) in zip(row, sets.items(), strict=True):
        report = delone.improve(delone.Delaunay(points), min_angle=20).report
        report.plot(ax)
        ends = f"{report.smallest_before:.2g}° to {report.smallest_after:.2g}°"
        ax.set_title(f"{name}: smallest angle {ends}", fontsize="medium")
        ax.set(ylabel=ax.get_ylabel() if ax is row[0] else "")
