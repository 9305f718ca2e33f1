"""Pictures of edits of a live triangulation, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from delone import Dynamic


def _draw(ax: Axes, live: Dynamic, marked: set[tuple[int, ...]], color: str) -> None:
    """Draw triangles, those with the handles in `marked` filled."""
    x, y = live.points.T
    for simplex, handles in zip(live.simplices, live.handles[live.simplices], strict=True):
        if tuple(sorted(handles.tolist())) in marked:
            ax.fill(x[simplex], y[simplex], color=color, alpha=0.45, linewidth=0)
    ax.triplot(x, y, live.simplices, color="0.35", linewidth=0.8)
    ax.plot(x, y, ".", color="0.2", markersize=4)
    ax.set_aspect("equal")
    ax.set_axis_off()


def _sets(triangles: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(sorted(each)) for each in triangles.tolist()}


def edits() -> None:
    """A cavity is dug and filled with a star; a star is removed and its hole filled."""
    rng = np.random.default_rng(4)
    live = Dynamic(rng.random((40, 2)))
    live.changes()
    before = live.snapshot()
    live.insert([(0.52, 0.48)])
    inserted = live.changes()
    after = live.snapshot()
    _, axes = plt.subplots(1, 4, figsize=(12, 3.2), layout="constrained")
    live.restore(before)
    _draw(axes[0], live, _sets(inserted.gone), "tab:red")
    axes[0].plot(0.52, 0.48, "o", color="tab:red", markersize=5)
    live.restore(after)
    _draw(axes[1], live, _sets(inserted.new), "tab:green")
    star = int(live.nearest((0.3, 0.6)))
    live.changes()
    live.remove([star])
    removed = live.changes()
    live.restore(after)
    _draw(axes[2], live, _sets(removed.gone), "tab:red")
    live.remove([star])
    _draw(axes[3], live, _sets(removed.new), "tab:green")
    titles = "the cavity of a new point", "its star", "the star of a point", "the hole, filled"
    for ax, title in zip(axes, titles, strict=True):
        ax.set_title(title, fontsize="medium")
