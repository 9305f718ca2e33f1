"""
Regions with two materials and boundary conditions by name
==========================================================

Heat flows through a plate of two materials, from a hot pipe to a cold side. The mesh passes the numbers of the
materials and boundaries to scikit-fem, which selects elements and conditions by name.

Install: ``pip install "delone[fem,plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import skfem
from skfem.helpers import dot, grad

import delone

# %%
# Points and segments, with a marker for each segment: 1 insulated, 2 cold, 3 the pipe. The interface between the
# materials has the marker 9. It divides the plate into two regions, each labeled by a seed inside it.

INSULATED, COLD, PIPE, INTERFACE = 1, 2, 3, 9
corners = [(0, 0), (4, 0), (4, 2), (0, 2), (2.2, 0), (1.6, 2)]
angle = np.linspace(0, 2 * np.pi, 32, endpoint=False)
pipe = np.column_stack((0.8 + 0.35 * np.cos(angle), 1 + 0.35 * np.sin(angle)))
points = np.vstack((corners, pipe))

outer = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0)]
ring = [(6 + i, 6 + (i + 1) % 32) for i in range(32)]
segments = [*outer, (4, 5), *ring]
markers = [INSULATED, INSULATED, COLD, *[INSULATED] * 3, INTERFACE, *[PIPE] * 32]

COPPER, STEEL = 1, 2
mesh = delone.mesh(
    (points, segments),
    holes=[(0.8, 1)],
    regions=[(0.1, 1, COPPER), (3.9, 1, STEEL)],
    segment_markers=markers,
    size={COPPER: 0.15, STEEL: 0.08},
)
print(mesh.report)
for name, number in (("copper", COPPER), ("steel", STEEL)):
    print(f"{name}: area {mesh.areas[mesh.region == number].sum():.3f}")

# %%
# In scikit-fem these are the subdomains ``region 1``, ``region 2`` and the boundaries ``marker 1`` and so on. The
# conductivity is constant in each element, in W/(m K).

fem = mesh.to_skfem()
print(sorted(fem.subdomains), sorted(fem.boundaries))
basis = skfem.Basis(fem, skfem.ElementTriP1())
conductivity = basis.with_element(skfem.ElementTriP0()).zeros()
conductivity[fem.subdomains[f"region {COPPER}"]] = 400
conductivity[fem.subdomains[f"region {STEEL}"]] = 50


@skfem.BilinearForm
def conduction(u, v, w):
    """Return the bilinear form of heat conduction."""
    return w["conductivity"] * dot(grad(u), grad(v))


field = basis.with_element(skfem.ElementTriP0()).interpolate(conductivity)
matrix = conduction.assemble(basis, conductivity=field)
hot = basis.get_dofs(f"marker {PIPE}").flatten()
cold = basis.get_dofs(f"marker {COLD}").flatten()
temperature = basis.zeros()
temperature[hot], temperature[cold] = 90, 20
fixed = np.concatenate((hot, cold))
temperature = skfem.solve(*skfem.condense(matrix, x=temperature, D=fixed))

# %%
# The heat that leaves the pipe arrives at the cold side.

flow = matrix @ temperature
print(f"{flow[hot].sum():.1f} W leave the pipe, {-flow[cold].sum():.1f} W arrive")
assert np.isclose(flow[hot].sum(), -flow[cold].sum())

# %%
# A common mistake is a seed that misses its region, here because the seed of the hole is not in the pipe. The mesh
# then fills the pipe, and no error is raised: compare the area with the expected one.

wrong = delone.mesh((points, segments), holes=[(0.8, 3)], regions=[(0.1, 1, 1)], size=0.15)
print(f"area {wrong.areas.sum():.3f} instead of {mesh.areas.sum():.3f}")

# %%
# The materials, and the temperature with isotherms.

figure, (top, bottom) = plt.subplots(2, 1, figsize=(7, 7.4), layout="constrained", sharex=True)
mesh.plot(top, vertices=False, title="Copper, with the pipe, and steel")
colors = bottom.tripcolor(mesh.to_matplotlib(), temperature, shading="gouraud", cmap="inferno")
bottom.tricontour(mesh.to_matplotlib(), temperature, levels=14, colors="white", linewidths=0.6)
bottom.set(aspect="equal", title="Temperature, 20 on the right, 90 at the pipe")
figure.colorbar(colors, ax=bottom, label="degrees Celsius")
plt.show()
