"""Draws the picture of the README into docs/_static: ``python docs/figures.py``.

The picture is committed, so that it shows where the README is read; it is drawn again when what it
shows changes. All other pictures of these pages are drawn when the pages are built.
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from delone import Delaunay
from delone.datasets import ahn3

PICTURE = Path(__file__).parent / "_static" / "ahn3.png"
CENTRE = np.array([33.0, 47.5])
CLOSE = 3.0
BEYOND = 2.0
COLOURS = 128


def main() -> None:
    """Draw the tile as a whole, and a few metres of it close by."""
    survey = ahn3()
    points = survey.points - survey.points.min(axis=0)
    near = (np.abs(points - CENTRE) < CLOSE + BEYOND).all(axis=1)
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.9), layout="constrained")
    Delaunay(points).plot(left, z=survey.z, hull=False, colorbar=False)
    detail = Delaunay(points[near])
    detail.plot(right, z=survey.z[near], hull=False, colorbar=False, vertices=False, shade=True)
    right.triplot(*detail.points.T, detail.simplices, color="black", linewidth=0.4, alpha=0.8)
    left.set(xticks=[], yticks=[], xlim=(0, 100), ylim=(0, 100))
    low, high = CENTRE - CLOSE, CENTRE + CLOSE
    right.set(xticks=[], yticks=[], xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    left.indicate_inset_zoom(right, edgecolor="black", alpha=1)
    left.set_xlabel(f"{len(points):,} lidar points, 100 m x 100 m")
    right.set_xlabel(f"{2 * CLOSE:.0f} m x {2 * CLOSE:.0f} m of it")
    figure.canvas.draw()
    image = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    PICTURE.parent.mkdir(exist_ok=True)
    image.quantize(COLOURS, dither=Image.Dither.NONE).save(PICTURE, optimize=True)
    print(f"{PICTURE}: {PICTURE.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main()
