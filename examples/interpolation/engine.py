"""
Interpolate an engine map: a table with four columns, even with missing entries
===============================================================================

The torque of an engine is tabulated by speed, load, mixture and spark advance, with uneven steps. A complete table is
interpolated without a triangulation; a table with missing entries is triangulated, exactly as in 2-D.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.interpolate import Linear


def torque(speed, load, mixture, spark):
    """Return torque in newton meters: a smooth surface with one best spark advance."""
    best = 12 + speed / 250 - 14 * load + 8 * np.abs(mixture - 0.98)
    level = 210 * load * np.exp(-(((speed - 3200) / 3000) ** 2))
    return level * (1 - 0.6 * (mixture - 0.98) ** 2 - ((spark - best) / 55) ** 2)


axes = (
    np.array([800, 1200, 2000, 3000, 4000, 5000, 6000.0]),
    np.array([0.1, 0.2, 0.4, 0.6, 0.8, 1.0]),
    np.array([0.85, 0.95, 1.05, 1.2]),
    np.array([0, 10, 20, 30, 40.0]),
)
nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 4)
values = torque(*nodes.T)

# %%
# All nodes are present, in any order, so no triangulation is needed. Each query sorts its four fractions within a cell.

table = Linear(nodes, values)
print(table)
queries = np.random.default_rng(0).uniform([a[0] for a in axes], [a[-1] for a in axes], (20_000, 4))
error = table(queries) - torque(*queries.T)
print(f"error: {np.sqrt((error**2).mean()):.2f} Nm rms of {values.max():.0f} Nm")

# %%
# On a test bed, some points cannot be run, such as full load with late spark. The remaining points are not a grid, so
# they are triangulated. Columns with different units must be scaled first, here to steps of the table, since
# distances decide which points are joined. Every entry that was measured is still reproduced.

missing = np.random.default_rng(1).random(len(nodes)) < 0.2
missing |= (nodes[:, 1] > 0.7) & (nodes[:, 3] < 5)
steps = np.column_stack([np.searchsorted(axis, nodes[:, k]) for k, axis in enumerate(axes)]).astype(
    float
)
rest = Linear(steps, np.where(missing, np.nan, values), nan="drop")
print(f"{missing.sum()} of {len(nodes)} entries are missing")
print(rest)
assert np.array_equal(rest(steps[~missing]), values[~missing])
filled = rest(steps[missing])
known = np.isfinite(filled)
print(f"{known.sum()} of them are inside the hull of the others")
print(f"largest error there: {np.abs(filled - values[missing])[known].max():.1f} Nm")

# %%
# A common mistake is to expect values outside the table: they are NaN. With ``extrapolate="raise"``, such queries
# raise an error.

assert np.isnan(table([7000, 0.5, 1.0, 20]))

# %%
# Sections at a mixture of 1 and a spark advance of 25 degrees, and the derivative with respect to the spark advance:
# where it is zero, the spark advance is optimal.

speed, load = np.meshgrid(np.linspace(800, 6000, 160), np.linspace(0.1, 1, 120))
section = np.stack((speed, load, np.ones_like(speed), np.full_like(speed, 25)), axis=-1)
figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.8), layout="constrained", sharey=True)
drawn = left.pcolormesh(speed, load, table(section), rasterized=True)
figure.colorbar(drawn, label="torque in Nm")
slope = table.gradient(section)[..., 3]
drawn = right.pcolormesh(speed, load, slope, cmap="RdBu", vmin=-4, vmax=4, rasterized=True)
figure.colorbar(drawn, label="Nm per degree of spark advance")
_ = left.set(xlabel="speed in 1/min", ylabel="load", title="Torque")
_ = right.set(xlabel="speed in 1/min", title="More (blue) or less (red) spark advance")
