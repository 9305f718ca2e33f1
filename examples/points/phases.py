"""
Find stable compounds: the phase diagram of four elements from a convex hull
============================================================================

A compound is stable if no mixture of other compounds with the same composition has a lower energy. If energy is
plotted against composition, the stable compounds are the vertices of the lower convex hull. With four elements, this
is a hull in 4-D: three atomic fractions and an energy.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import ConvexHull

rng = np.random.default_rng(3)
elements = "Li", "Mn", "Ni", "O"
# Numbers of atoms in each formula, as in the results of a structure search: the elements, then 150 candidates.
atoms = np.vstack((np.eye(4, dtype=int), rng.integers(0, 4, (150, 4))))
atoms = np.unique(atoms[atoms.sum(axis=1) > 0] // np.gcd.reduce(
    atoms[atoms.sum(axis=1) > 0], axis=1)[:, None], axis=0)  # fmt: skip
shares = atoms / atoms.sum(axis=1, keepdims=True)
metals, oxygen = shares[:, :3].sum(axis=1), shares[:, 3]
# Energies in eV per atom relative to the elements: oxides have low energies, and structures differ at random.
energy = -6 * metals * oxygen - 0.8 * shares[:, 0] * oxygen + rng.exponential(0.6, len(shares))
energy[(shares == 1).any(axis=1)] = 0


def formula(row):
    """Return a formula such as LiMn2O4."""
    return "".join(e + (str(n) if n > 1 else "") for e, n in zip(elements, row, strict=True) if n)


# %%
# The four fractions add up to one, so one column is redundant: leave it out. A common mistake is to keep all four.
# Except for the rounding of thirds and sevenths, the points then lie in a flat, and the hull consists of rounding
# errors.

print(f"sums other than 1: {(shares.sum(axis=1) != 1).sum()} of {len(shares)}")
hull = ConvexHull(np.column_stack((shares[:, :3], energy)))
print(hull)

# %%
# The lower facets are those whose outer normal points toward lower energies. The vertices of a lower facet are phases
# in equilibrium, and all of them are stable. (The facets over the faces of the composition tetrahedron are vertical
# up to rounding, and are left out.)

lower = hull.equations[:, 3] < -1e-9
phases = hull.simplices[lower]
stable = np.unique(phases)
print(f"{len(stable)} stable phases, {len(phases)} mixtures of four phases")
print(", ".join(formula(atoms[k]) for k in stable))

# %%
# The height of a candidate above the hull is the energy that is released when it decomposes. The lower hull is the
# maximum of the planes of its facets. Candidates within about 0.05 eV of it are worth a second look.

normal, offset = hull.equations[lower, :4], hull.equations[lower, 4]
planes = -(shares[:, :3] @ normal[:, :3].T + offset) / normal[:, 3]
above = energy - planes.max(axis=1)
assert np.abs(above[stable]).max() < 1e-12
near = np.setdiff1d(np.flatnonzero(above < 0.05), stable)
print("nearly stable:", ", ".join(f"{formula(atoms[k])} ({1000 * above[k]:.0f} meV)" for k in near))

# %%
# What does a given composition decompose into? The phases are the vertices of the facet whose plane is highest there,
# and their fractions are the solution of a linear system.

sought = np.array([0.3, 0.15, 0.12, 0.43])
heights = -(normal[:, :3] @ sought[:3] + offset) / normal[:, 3]
corners = phases[heights.argmax()]
parts = np.linalg.solve(shares[corners].T, sought)
assert (parts > -1e-12).all()
print(" + ".join(f"{p:.2f} {formula(atoms[k])}" for p, k in zip(parts, corners, strict=True)))

# %%
# Compositions are points in a tetrahedron with an element at each corner. Lines connect phases that coexist in
# equilibrium. Gray points are candidates that are not stable.

place = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0], [0.5, 0.75**0.5 / 3, (2 / 3) ** 0.5]])
at = shares @ place
figure = plt.figure(figsize=(9.4, 4.4), layout="constrained")
axes = figure.add_subplot(1, 2, 1, projection="3d")
pairs = phases[:, [[i, j] for i in range(4) for j in range(i)]].reshape(-1, 2)
for pair in np.unique(np.sort(pairs, axis=1), axis=0):
    axes.plot(*at[pair].T, color="tab:blue", linewidth=0.5, alpha=0.6)
others = np.setdiff1d(np.arange(len(at)), stable)
axes.scatter(*at[others].T, s=4, color="0.6")
axes.scatter(*at[stable].T, s=24, color="tab:red", depthshade=False)
for name, corner in zip(elements, place, strict=True):
    axes.text(*(corner + 0.12 * (corner - place.mean(axis=0))), name, fontsize=12, ha="center")
axes.set_axis_off()
axes.set_box_aspect((1, 0.9, 0.85), zoom=1.25)
axes.view_init(18, -38)
_ = axes.set_title("Stable phases and their neighbors")
beside = figure.add_subplot(1, 2, 2)
beside.scatter(oxygen[others], above[others], s=8, color="0.5", label="candidate")
beside.scatter(oxygen[stable], above[stable], s=24, color="tab:red", label="stable")
beside.axhline(0.05, color="0.7", linestyle="--", linewidth=0.8)
beside.legend()
_ = beside.set(xlabel="share of oxygen", ylabel="eV per atom above the hull", title="Stability")
