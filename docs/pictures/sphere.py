"""Pictures of geographic data: what the plane makes of it, and the sphere."""

import matplotlib.pyplot as plt
import numpy as np

from delone import datasets, sphere
from delone.interpolate import Linear

# Sites on the globe, and waves in each field, about 5000 km long.
SITES = 4000
WAVES = 20
NUMBER = 8.0


def field(units: np.ndarray) -> np.ndarray:
    """A field that looks alike everywhere on the globe, at unit vectors."""
    random = np.random.default_rng(2)
    waves = random.normal(size=(WAVES, 3))
    waves *= NUMBER / np.linalg.norm(waves, axis=1, keepdims=True)
    return np.cos(units @ waves.T + random.uniform(0, 6, WAVES)).sum(axis=1) / np.sqrt(WAVES / 2)


def errors() -> None:
    """The errors of linear interpolation on a map, in the plane and on the sphere."""
    mesh = sphere.Delaunay(xyz=np.random.default_rng(1).normal(size=(SITES, 3)))
    values = field(mesh.points)
    lon, lat = np.meshgrid(np.linspace(-180, 180, 361), np.linspace(-90, 90, 181))
    nodes = np.stack((lon, lat), axis=-1)
    across = np.radians(lon), np.radians(lat)
    units = np.stack(
        (
            np.cos(across[1]) * np.cos(across[0]),
            np.cos(across[1]) * np.sin(across[0]),
            np.sin(across[1]),
        ),
        axis=-1,
    )
    truth = field(units.reshape(-1, 3)).reshape(lon.shape)
    _, axes = plt.subplots(2, 1, figsize=(8.4, 8.2), layout="constrained")
    for ax, (name, made) in zip(
        axes,
        {"plane": Linear(mesh.lonlat, values), "sphere": sphere.Linear(mesh, values)}.items(),
        strict=True,
    ):
        shown = ax.pcolormesh(lon, lat, np.abs(made(nodes) - truth), vmax=0.3, cmap="magma_r")
        ax.set_facecolor("#8fb8d8")
        ax.axhline(60, color="black", linewidth=0.6)
        ax.axhline(-60, color="black", linewidth=0.6)
        ax.set(title=name, xlabel="degrees east", ylabel="degrees north", aspect="equal")
    axes[0].figure.colorbar(shown, ax=axes, label="absolute error", extend="max")


def triangles() -> None:
    """Triangles around the date line and 60 degrees north, seen from above."""
    mesh = sphere.Delaunay(xyz=np.random.default_rng(1).normal(size=(SITES, 3)))
    flat = Linear(mesh.lonlat).triangulation
    east = np.array([np.cos(np.pi), np.sin(np.pi), 0.0])
    up = np.array([east[0] * 0.5, 0.0, np.sqrt(0.75)])
    right = np.cross((0.0, 0.0, 1.0), east)
    view = np.column_stack((mesh.points @ right, mesh.points @ np.cross(up, right)))
    seen = mesh.points @ up > 0.85
    _, axes = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained")
    for ax, (name, made) in zip(
        axes, {"plane": flat.simplices, "sphere": mesh.simplices}.items(), strict=True
    ):
        ax.triplot(*view.T, made[seen[made].all(axis=1)], linewidth=0.6)
        ax.plot([0, 0], [-0.5, 0.5], color="tab:red", linewidth=0.8)
        ax.set(title=name, aspect="equal", xticks=[], yticks=[], xlim=(-0.3, 0.3), ylim=(-0.3, 0.3))


def clipped() -> None:
    """Cells clipped to the land, seen from two sides."""
    sites = np.random.default_rng(6).normal(size=(300, 3))
    diagram = sphere.Voronoi(xyz=sites, clip=datasets.land())
    colors = np.random.default_rng(6).permutation(300) % 10
    _, axes = plt.subplots(1, 2, figsize=(8.4, 4.2), layout="constrained")
    for ax, view in zip(axes, ((20, 20), (180, 40)), strict=True):
        diagram.plot(ax, values=colors, view=view, cmap="tab10", colorbar=False, points=False)
