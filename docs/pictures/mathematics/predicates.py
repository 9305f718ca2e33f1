"""Pictures of signs: rounded, exact, and where a filter is certain."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from delone.predicates import orient2d

B, C = (12.0, 12.0), (24.0, 24.0)
RIGHT, ZERO, LEFT, UNSURE = "#5a8fbb", "#f2f2f2", "#d9742b", "#8c8c8c"


def _window(every: int) -> tuple[np.ndarray, np.ndarray]:
    steps = 0.5 + np.spacing(0.5) * every * np.arange(128)
    return np.meshgrid(steps, steps)


def _show(ax: Axes, values: np.ndarray, colors: list[str], title: str) -> None:
    last = len(colors) - 1
    ax.imshow(values, origin="lower", cmap=ListedColormap(colors), vmin=0, vmax=last)
    ax.set_title(title, fontsize=10)
    ax.set(xticks=[], yticks=[])


def signs() -> None:
    """The side of a line on which adjacent doubles lie, rounded and exact."""
    x, y = _window(1)
    rounded = np.sign((B[0] - x) * (C[1] - y) - (B[1] - y) * (C[0] - x))
    exact = orient2d(np.stack((x, y), axis=-1), B, C)
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(9.6, 3.7), layout="constrained")
    _show(left, 1 + rounded, [RIGHT, ZERO, LEFT], "rounded")
    _show(middle, 1 + exact, [RIGHT, ZERO, LEFT], "exact")
    wrong = rounded != exact
    _show(right, wrong.astype(int), [ZERO, "#303030"], f"wrong: {wrong.mean():.0%} of the signs")
    names = {"left of the line": LEFT, "on it": ZERO, "right of it": RIGHT}
    keys = [Patch(facecolor=color, edgecolor="gray", label=name) for name, color in names.items()]
    figure.legend(handles=keys, loc="outside lower center", ncols=3, frameon=False)


def certain() -> None:
    """Where the error bound of the filter is below the rounded determinant."""
    _, row = plt.subplots(1, 3, figsize=(9.6, 3.4), layout="constrained")
    for ax, every in zip(row, (1, 8, 64), strict=True):
        x, y = _window(every)
        one, two = (B[0] - x) * (C[1] - y), (B[1] - y) * (C[0] - x)
        sure = abs(one - two) > 4 * 2.0**-53 * (abs(one) + abs(two))
        answer = np.where(sure, 1 + np.sign(one - two), 1).astype(int)
        title = "adjacent doubles" if every == 1 else f"every {every}th double"
        _show(ax, answer, [RIGHT, UNSURE, LEFT], f"{title}: {sure.mean():.0%} certain")
