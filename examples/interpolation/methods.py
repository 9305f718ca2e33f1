"""
Compare interpolation methods: linear, natural neighbor, Clough-Tocher, nearest
===============================================================================

Four methods interpolate 200 values of a known function, so their errors can be drawn. Smooth methods are more
accurate where the function is smooth between the sites; no method recovers features between them.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import uniform
from delone.interpolate import interpolator


def truth(x, y):
    """Return two hills, a pit and a slope."""
    hills = np.exp(-12 * ((x - 0.3) ** 2 + (y - 0.7) ** 2)) + 0.8 * np.exp(
        -30 * ((x - 0.72) ** 2 + (y - 0.6) ** 2)
    )
    return hills - 0.7 * np.exp(-20 * ((x - 0.5) ** 2 + (y - 0.25) ** 2)) + 0.2 * x


sites = uniform(200, seed=3)
values = truth(*sites.T)
x, y = np.meshgrid(np.linspace(0, 1, 201), np.linspace(0, 1, 201))
nodes = np.stack((x, y), axis=-1)

# %%
# :func:`delone.interpolate.interpolator` makes each of them from its name. Outside the convex hull of the sites, only
# "nearest" has a value, so only nodes inside are compared.

names = ("nearest", "linear", "sibson", "farin", "clough-tocher")
fields = {name: interpolator(sites, values, name)(nodes) for name in names}
inside = np.isfinite(fields["linear"])
for name in names:
    error = (fields[name] - truth(x, y))[inside]
    print(f"{name:14} rmse {np.sqrt((error**2).mean()):.4f}   largest {np.abs(error).max():.3f}")

# %%
# A common mistake is to compare at the sites. All methods reproduce the values there, bit for bit, so their errors
# are zero. Compare elsewhere, or leave sites out: :func:`delone.interpolate.cross_validate`.

for name in names:
    assert np.array_equal(interpolator(sites, values, name)(sites), values)

# %%
# The fields are on top, the errors below. "sibson" and "farin" are two kinds of natural neighbor interpolation; the
# second one also uses gradients, which are estimated from the values.

shown = ("nearest", "linear", "sibson", "clough-tocher")
titles = ("Nearest", "Linear", "Natural neighbor", "Clough-Tocher")
figure, axes = plt.subplots(
    2, 4, figsize=(10.4, 4.7), layout="constrained", sharex=True, sharey=True
)
for column, name, title in zip(axes.T, shown, titles, strict=True):
    error = np.where(inside, fields[name] - truth(x, y), np.nan)
    field = column[0].pcolormesh(x, y, fields[name], vmin=-0.7, vmax=1.2, rasterized=True)
    wrong = column[1].pcolormesh(x, y, error, cmap="RdBu_r", vmin=-0.15, vmax=0.15, rasterized=True)
    column[1].plot(*sites.T, ".", color="black", ms=1.5)
    column[0].set(title=title)
    for ax in column:
        ax.set(aspect="equal", xticks=[], yticks=[])
figure.colorbar(field, ax=axes[0], label="interpolated")
figure.colorbar(wrong, ax=axes[1], label="error", extend="both")
plt.show()
