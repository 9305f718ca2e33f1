"""
Heat through an assembly
========================

A chip heats a plate with round pins. The bodies are triangulated separately, and their contact faces share only
a plane. ``imprint=True`` cuts the faces where they meet, so one mesh conforms to all bodies, and heat flows
from one to the next.

Install: ``pip install "delone[fem,pyvista]"``.
"""

import numpy as np
import pyvista
import skfem
from skfem.helpers import dot, grad

import delone

# %%
# Each body is the convex hull of its corners. The chip is rotated, so its edges cross those of the plate's triangles.


def prism(outline, low, high):
    """The surface of an upright prism."""
    flat = np.asarray(outline, dtype=float)
    levels = [np.column_stack((flat, np.full(len(flat), z))) for z in (low, high)]
    hull = delone.ConvexHull(np.concatenate(levels))
    return hull.points, hull.simplices


def polygon(count, radius, degrees):
    """The corners of a regular polygon around the origin."""
    angles = np.radians(degrees) + np.linspace(0, 2 * np.pi, count, endpoint=False)
    return radius * np.column_stack((np.cos(angles), np.sin(angles)))


circle = polygon(24, 0.3, 0)
plate = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
bodies = [prism(polygon(4, 0.85, 25), -0.2, 0), prism(plate, 0, 0.3)]
bodies += [
    prism(circle + np.array((x, y)), 0.3, 1.5) for x in (-1.2, 0, 1.2) for y in (-1.2, 0, 1.2)
]
seeds = [points.mean(axis=0) for points, _ in bodies]

first = np.cumsum([0] + [len(points) for points, _ in bodies])
points = np.concatenate([points for points, _ in bodies])
faces = np.concatenate([own + start for (_, own), start in zip(bodies, first[:-1], strict=True)])
print(delone.check_surface(points, faces))

# %%
# The seeds label the chip 0, the plate 1, and the pins 2. The report contains the largest distance between the cut faces
# and the given ones.

labels = np.minimum(np.arange(len(bodies)), 2)
mesh = delone.tetrahedralize(
    points,
    faces,
    imprint=True,
    regions=np.column_stack((seeds, labels)),
    boundary="surface",
    size=0.25,
)
print(mesh.report)
assert mesh.validate()
volumes = [mesh.volumes[mesh.region == label].sum() for label in range(3)]
pin = 24 / 2 * 0.3**2 * np.sin(2 * np.pi / 24) * 1.2
assert np.allclose(volumes, [2 * 0.85**2 * 0.2, 4**2 * 0.3, 9 * pin])

# %%
# The chip produces heat, and every free surface loses it to the air. Conductivities differ by body.

CONDUCTIVITY, POWER, LOSS = np.array([1.5, 4.0, 2.0]), 10.0, 0.5
elements = skfem.Basis(mesh.to_skfem(), skfem.ElementTetP1())
conductivity = CONDUCTIVITY[mesh.region][:, None] * np.ones_like(elements.dx)
heated = (mesh.region == 0)[:, None] * np.ones_like(elements.dx)
air = skfem.FacetBasis(elements.mesh, skfem.ElementTetP1())


@skfem.BilinearForm
def conduction(u, v, w):
    """Heat flow inside."""
    return w.conductivity * dot(grad(u), grad(v))


@skfem.BilinearForm
def loss(u, v, w):
    """Heat flow to the air."""
    return LOSS * u * v


@skfem.LinearForm
def source(v, w):
    """Heat that the chip produces."""
    return POWER * w.heated * v


matrix = conduction.assemble(elements, conductivity=conductivity) + loss.assemble(air)
temperature = skfem.solve(matrix, source.assemble(elements, heated=heated))
# In equilibrium, the air takes what the chip produces.
taken = (loss.assemble(air) @ temperature).sum()
assert np.isclose(taken, POWER * volumes[0])

# %%
# The front is cut away. The temperature is continuous across the contact faces; its slope is not.

grid = mesh.to_pyvista()
grid["temperature"] = temperature
cut = grid.clip(normal=(1, 0, 0), origin=(0, 0, 0)).extract_surface(algorithm="dataset_surface")
plot = pyvista.Plotter(off_screen=True, window_size=(900, 600))
plot.add_mesh(cut, scalars="temperature", cmap="coolwarm", show_edges=True, line_width=0.5)
plot.camera_position = [(6, -3.5, 3.5), (-0.5, 0, 0.3), (0, 0, 1)]
plot.show()
