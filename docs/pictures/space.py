"""A picture of points in space, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np

from delone import ConvexHull, Delaunay, datasets, plot


def tetrahedra() -> None:
    """Tetrahedra cut open, the same apart, and a convex hull with its flat facets."""
    points = datasets.uniform(250, ndim=3, seed=1)
    mesh = Delaunay(points)
    corners = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(-1, 3)
    cut = np.array([p for c in corners for p in (c + (1 - 2 * c) * 0.3 * np.eye(3))])
    hull = ConvexHull(np.concatenate((cut, 0.5 + 0.4 * (points - 0.5))))
    size = np.log10(mesh.volumes)
    pictures = (
        ("tetrahedra before a cut, by their volumes", mesh, {"values": size, "cut": "x"}),
        ("the same, shrunk", mesh, {"values": size, "cut": "x", "shrink": 0.7}),
        ("a convex hull, by its facets", hull, {"values": hull.facet_of, "cmap": "tab20"}),
    )
    _, row = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
    for ax, (title, shape, options) in zip(row, pictures, strict=True):
        ax.imshow(plot.image(shape, colorbar=False, **options))
        ax.set_title(title, fontsize="medium")
        ax.set_axis_off()
