"""
Moving particles: update fields from what changes
=================================================

Nine hundred particles repel their neighbors while a flow stirs them, for a thousand steps. Their
triangulation is updated in place (:class:`~delone.Dynamic`), and the number of neighbors of each particle is updated
from the triangles that were removed and added, without processing the others.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Dynamic

rng = np.random.default_rng(7)
particles = rng.random((900, 2))
live = Dynamic(particles)
around = np.zeros(len(particles), dtype=int)
_ = live.changes()
np.add.at(around, live.simplices, 1)  # no handle is ever removed, so handles are rows


# %%
# Two vortices rotate in opposite directions, and particles that are too close for their density repel each other.
# Neighbors are particles that share an edge of the current triangulation.

REACH = 1.1 / np.sqrt(len(particles))


def stirred(p: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the positions of the particles after one step."""
    x, y = p.T
    flow = np.column_stack(
        (-np.sin(2 * np.pi * x) * np.cos(np.pi * y), 2 * np.cos(2 * np.pi * x) * np.sin(np.pi * y))
    )
    push = np.zeros_like(p)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        away = p[triangles[:, a]] - p[triangles[:, b]]
        length = np.hypot(*away.T)[:, None]
        np.add.at(push, triangles[:, a], away / length * (REACH - length).clip(0))
    return (p + 0.001 * flow + 0.2 * push).clip(0.001, 0.999)


handles = live.handles
defects, replaced = [], []
for _ in range(1000):
    live.move(handles, stirred(live.points, live.simplices))
    changes = live.changes()
    np.subtract.at(around, changes.gone, 1)
    np.add.at(around, changes.new, 1)
    inside = (live.points > 0.03).all(axis=1) & (live.points < 0.97).all(axis=1)
    defects.append(np.mean(around[inside] != 6))
    replaced.append(len(changes.new))

print(f"{np.mean(replaced):.0f} of {live.nsimplex} triangles change in a step")

# %%
# The field that was updated from the changes equals a new count. A common mistake is to expect that ``changes`` lists
# *all* triangles whose corners moved: it lists only those that connect different particles. Values that depend on
# coordinates, such as areas, change wherever particles move.

fresh = np.zeros(len(particles), dtype=int)
np.add.at(fresh, live.freeze().simplices, 1)
assert np.array_equal(around, fresh)

figure, (ax, curve) = plt.subplots(
    ncols=2, figsize=(9, 4.2), layout="constrained", width_ratios=(1, 1.1)
)
colors = plt.get_cmap("coolwarm", 5)
ax.triplot(*live.points.T, live.simplices, color="0.8", linewidth=0.5)
dots = ax.scatter(*live.points.T, c=around.clip(4, 8), cmap=colors, vmin=3.5, vmax=8.5, s=14)
figure.colorbar(dots, ax=ax, label="neighbors", ticks=[4, 5, 6, 7, 8], shrink=0.85)
ax.set(title="Particles after 1,000 steps", aspect="equal", xticks=[], yticks=[])
curve.plot(100 * np.array(defects), color="tab:blue")
curve.set(
    title="Particles without six neighbors", xlabel="step", ylabel="percent, inside", ylim=(0, 80)
)
plt.show()
