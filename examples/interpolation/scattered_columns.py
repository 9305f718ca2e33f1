"""
Interpolate scattered data with ten columns, without a triangulation
====================================================================

Three thousand simulations of a wing have ten parameters each. Their triangulation would have billions of simplices,
but a query needs only the simplex that contains it. ``Linear`` finds this simplex by linear programming and proves
that it is correct.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.interpolate import Linear


def weight(x):
    """Return the wing weight in pounds: the function of Forrester, Sobester and Keane (2008)."""
    area, fuel, aspect, sweep, pressure, taper, thick, load, gross, paint = x.T
    sweep = np.radians(sweep)
    wing = 0.036 * area**0.758 * fuel**0.0035 * (aspect / np.cos(sweep) ** 2) ** 0.6
    wing *= pressure**0.006 * taper**0.04 * (100 * thick / np.cos(sweep)) ** -0.3
    return wing * (load * gross) ** 0.49 + area * paint


low = np.array([150, 220, 6, -10, 16, 0.5, 0.08, 2.5, 1700, 0.025])
high = np.array([200, 300, 10, 10, 45, 1.0, 0.18, 6.0, 2500, 0.08])
random = np.random.default_rng(2)
runs = random.random((3000, 10))
values = weight(low + runs * (high - low))

# %%
# The columns are scaled to the unit cube, because the Delaunay triangulation depends on distances. With more than eight
# columns, ``Linear`` never triangulates. With fewer, pass ``method="lazy"`` to avoid the triangulation.

wing = Linear(runs, values)
print(wing)
queries = random.dirichlet(np.full(60, 0.5), 500)
inside = np.stack([q @ runs[random.integers(0, 3000, 60)] for q in queries])
truth = weight(low + inside * (high - low))
linear = wing(inside)
error = np.sqrt(((linear - truth) ** 2).mean())
print(f"error: {error:.1f} lb rms of a standard deviation of {truth.std():.1f} lb")

# %%
# Each query depends on eleven runs. ``weights_at`` returns these runs and their weights. Use it to see which
# simulations a prediction is based on, and how close they are.

table = wing.weights_at(inside)
assert np.allclose(table @ values, linear)
of_query = np.repeat(np.arange(len(table)), np.diff(table.indptr))
reach = np.linalg.norm(runs[table.indices] - inside[of_query], axis=1)
print(f"{np.diff(table.indptr).max()} runs a query, {reach.mean():.2f} away on average")

# %%
# A common mistake is to expect values in the corners of the cube. In 10-D, the hull of 3,000 points fills only a
# small part of the cube. Outside the hull, values are NaN, and ``Linear`` proves that these queries are outside.

corners = random.random((500, 10))
print(f"{np.isnan(wing(corners)).mean():.0%} of uniform queries are outside the hull")

# %%
# Plot sections through the middle of the cube. The gradient of the interpolant is constant in each simplex, so each
# curve is piecewise linear.

along = np.linspace(0.2, 0.8, 400)
figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.8), layout="constrained")
_ = left.plot([truth.min(), truth.max()], [truth.min(), truth.max()], color="0.6")
_ = left.plot(truth, linear, ".", markersize=4)
_ = left.set(xlabel="wing weight in lb", ylabel="interpolated", title="500 queries inside the hull")
for column, name in ((2, "aspect ratio"), (7, "load factor"), (9, "paint weight")):
    section = np.full((len(along), 10), 0.5)
    section[:, column] = along
    _ = right.plot(along, wing(section), label=name)
    _ = right.plot(along, weight(low + section * (high - low)), color="0.6", zorder=0, linewidth=1)
_ = right.set(xlabel="scaled parameter", title="Along three axes; gray: exact")
_ = right.legend()
