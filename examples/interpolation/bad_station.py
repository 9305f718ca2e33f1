"""
Leave-one-out cross-validation: find a bad station
==================================================

Each station is predicted from the others. A station whose value contradicts all of its neighbors has a large
residual. Here one thermometer reads in Fahrenheit, and the columns of two stations are swapped.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import uniform
from delone.interpolate import cross_validate, grid

kilometers = 300 * uniform(150, seed=21)
east, north = kilometers.T
noise = np.random.default_rng(4).normal(0, 0.3, 150)
temperature = 12 - north / 60 + 2 * np.sin(east / 70) + noise
truth = temperature.copy()

temperature[40] = temperature[40] * 9 / 5 + 32
temperature[[90, 7]] = temperature[[7, 90]]

# %%
# One triangulation is enough for all 150 predictions. Corners of the convex hull have no prediction: without them,
# the hull is smaller, and they are outside it.

left_out = cross_validate(kilometers, temperature, "sibson")
print(left_out)

# %%
# A common mistake is to flag everything beyond three standard deviations in one pass. A blunder inflates the standard
# deviation, and spoils the predictions of its neighbors. So use the median absolute deviation, remove the worst
# station, and repeat.

bad = []
observed = temperature.copy()
while True:
    residuals = cross_validate(kilometers, observed, "sibson", nan="drop").residuals
    scale = 1.4826 * np.nanmedian(np.abs(residuals))
    worst = int(np.nanargmax(np.abs(residuals)))
    if abs(residuals[worst]) < 5 * scale:
        break
    print(
        f"station {worst}: {temperature[worst]:.1f} C, off by {residuals[worst]:+.1f} C, {scale:.2f} C is typical"
    )
    bad.append(worst)
    observed[worst] = np.nan
naive = np.flatnonzero(np.abs(left_out.residuals) > 3 * np.nanstd(left_out.residuals))
print(f"removed one by one: {sorted(bad)}; three standard deviations in one pass: {naive.tolist()}")
assert set(bad) == {40, 90, 7}

# %%
# The field with and without the three stations, and the residuals.

figure, axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained", width_ratios=(1, 1, 0.9))
for ax, values, title in zip(
    axes, (temperature, observed), ("All stations", "Without three"), strict=False
):
    made = grid(kilometers, values, shape=(240, 240), method="sibson", nan="drop")
    image = ax.pcolormesh(
        made.x, made.y, made.values, vmin=4, vmax=16, cmap="RdYlBu_r", rasterized=True
    )
    ax.plot(east, north, ".", color="black", ms=2)
    ax.plot(east[bad], north[bad], "o", mfc="none", mec="black", ms=11)
    ax.set(title=title, aspect="equal", xlabel="km")
figure.colorbar(image, ax=axes[:2], label="temperature in C", extend="both")
axes[2].plot(np.abs(left_out.residuals), ".", color="0.4")
axes[2].plot(bad, np.abs(left_out.residuals)[bad], "o", mfc="none", mec="black", ms=11)
axes[2].set(
    title="Leave-one-out residuals", yscale="log", xlabel="station", ylabel="absolute residual in C"
)
plt.show()
