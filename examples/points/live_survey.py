"""
A survey in progress: edit points and breaklines, and undo
==========================================================

A survey is triangulated while it is measured: points arrive in batches, a curb is drawn as a breakline, and a wrong
point is removed with the line that ends there. Each group of changes is one edit, which other readers see as a whole
(:class:`~delone.Dynamic`). Heights are stored by handle, so they stay correct whatever is inserted or removed.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Dynamic

rng = np.random.default_rng(11)


def ground(p: np.ndarray) -> np.ndarray:
    """Return the true height: a slope, and a road that lies 1.2 m lower."""
    x, y = p.T
    road = np.abs(y - 30 - 0.2 * x) < 5
    return 20 + 0.08 * x + 0.5 * np.sin(x / 12) * np.cos(y / 15) - 1.2 * road


shots = rng.uniform(0, 80, (350, 2))
live = Dynamic(shots, crossing="split")
heights = ground(shots)
first = live.arrays(heights)

# %%
# The crew measures both curbs of the road, top and bottom. Points and lines are one edit: if anything in the block
# fails, nothing changes, and until it ends, ``live`` keeps the old state. Height ``h`` of handle ``h`` is
# ``heights[h]``; new handles extend the array.

along = np.linspace(2, 78, 20)
with live.edits() as draft:
    curbs = []
    for offset, drop in ((5.05, 0.0), (4.95, 1.2), (-4.95, 1.2), (-5.05, 0.0)):
        line = np.column_stack((along, 30 + 0.2 * along + offset))
        handles = draft.insert(line)
        draft.insert_segments(np.column_stack((handles[:-1], handles[1:])))
        smooth = 20 + 0.08 * along + 0.5 * np.sin(along / 12) * np.cos(line[:, 1] / 15)
        heights = np.append(heights, smooth - drop)
        curbs.append(handles)
print(f"{len(live)} points, {len(live.segment_handles)} lines, {live.nsimplex} triangles")

# %%
# One point was wrong. It is removed with the lines that end there. A snapshot is taken first, so that the removal can
# be undone. A common mistake is to index heights with rows of ``points``, which change when points are removed;
# handles do not change.

before = live.snapshot()
wrong = curbs[0][10]
lines = live.remove([wrong], segments="remove")
assert len(lines) == 2
assert wrong not in live
assert np.array_equal(live.arrays(heights).values, heights[live.handles])
live.restore(before)
assert wrong in live

# %%
# With the curbs as breaklines, the edges of the road are sharp.

last = live.arrays(heights)
figure, axes = plt.subplots(ncols=2, figsize=(9, 4.4), layout="constrained", sharey=True)
for ax, state, title in zip(axes, (first, last), ("Shots alone", "With curbs"), strict=True):
    shown = ax.tripcolor(
        *state.points.T, state.simplices, state.values, shading="gouraud", cmap="terrain"
    )
    ax.triplot(*state.points.T, state.simplices, color="0.2", linewidth=0.25)
    ax.set(title=title, aspect="equal", xlabel="m", xlim=(0, 80), ylim=(0, 80))
for a, b in live.segments:
    axes[1].plot(*live.points[[a, b]].T, color="tab:red", linewidth=0.8)
axes[0].set_ylabel("m")
figure.colorbar(shown, ax=axes, label="height, m", shrink=0.8)
plt.show()
