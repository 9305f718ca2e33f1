"""Draws the pictures of the README and the start page into docs/_static: ``docs/figures.py``.

The pictures are committed, so that they show where the README is read; run this again when what
they show changes. All other pictures of these pages are drawn when the pages are built. With names
of pictures, it draws only those: ``python docs/figures.py mesh globe``.
"""

import io
import json
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import delone
from delone import Delaunay, datasets, sphere
from delone.terrain import TIN

sys.path.insert(0, str(Path(__file__).parent))

from pictures.tetrahedra import flange

STATIC = Path(__file__).parent / "_static"
DATA = Path(__file__).parents[1] / "examples" / "data"
CENTER = np.array([33.0, 47.5])
CLOSE = 3.0
BEYOND = 2.0
COLORS = 128
# The small pictures, and the largest file of one, in bytes.
SMALL = {"figsize": (3.6, 3.6), "dpi": 90, "layout": "constrained"}
LARGEST = 60_000


def ahn3() -> None:
    """Draw the tile as a whole, and a few meters of it close up."""
    survey = datasets.ahn3()
    points = survey.points - survey.points.min(axis=0)
    near = (np.abs(points - CENTER) < CLOSE + BEYOND).all(axis=1)
    _, (left, right) = plt.subplots(1, 2, figsize=(10, 4.9), layout="constrained")
    Delaunay(points).plot(left, z=survey.z, hull=False, colorbar=False)
    detail = Delaunay(points[near])
    detail.plot(right, z=survey.z[near], hull=False, colorbar=False, vertices=False, shade=True)
    right.triplot(*detail.points.T, detail.simplices, color="black", linewidth=0.4, alpha=0.8)
    left.set(xticks=[], yticks=[], xlim=(0, 100), ylim=(0, 100))
    low, high = CENTER - CLOSE, CENTER + CLOSE
    right.set(xticks=[], yticks=[], xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    left.indicate_inset_zoom(right, edgecolor="black", alpha=1)
    left.set_xlabel(f"{len(points):,} lidar points, 100 m x 100 m")
    right.set_xlabel(f"{2 * CLOSE:.0f} m x {2 * CLOSE:.0f} m of it")


def terrain() -> None:
    """Draw the ground of the tile: hillshade, and contours every half a meter."""
    survey = datasets.ahn3()
    ground = survey.attributes["classification"] == 2
    points = survey.points - survey.points.min(axis=0)
    tin = TIN.from_points(np.column_stack((points, survey.z))[ground])
    _, ax = plt.subplots(**SMALL)
    Delaunay(points[ground]).plot(ax, z=survey.z[ground], hull=False, colorbar=False)
    contours = tin.contours(interval=0.5, min_length=8, smooth=2)
    contours.plot(ax)
    ax.set(xticks=[], yticks=[], xlim=(0, 100), ylim=(0, 100), xlabel="", ylabel="")


def mesh() -> None:
    """Draw a quality mesh of Gotland, finest in the middle of the island."""
    coast = json.loads((DATA / "gotland.geojson").read_text(encoding="utf-8"))
    ring = np.array(coast["geometry"]["coordinates"][0])
    center = ring.mean(axis=0)
    kilometers = (ring - center) * 111.2 * (np.cos(np.radians(center[1])), 1)
    island = {"type": "Polygon", "coordinates": [kilometers.tolist()]}
    fine = delone.mesh(island, size=lambda xy: 1.5 + 0.12 * np.abs(xy[:, 1]))
    _, ax = plt.subplots(**SMALL)
    fine.plot(ax, vertices=False)
    ax.set_axis_off()


def globe() -> None:
    """Draw cells on the globe, clipped to the land."""
    sites = np.random.default_rng(6).normal(size=(300, 3))
    cells = sphere.Voronoi(xyz=sites, clip=datasets.land())
    colors = np.random.default_rng(6).permutation(300) % 10
    _, ax = plt.subplots(**SMALL)
    cells.plot(ax, values=colors, view=(20, 20), cmap="tab10", colorbar=False, points=False)
    ax.set_axis_off()


def solid() -> None:
    """Draw a machine part filled with tetrahedra, cut open."""
    part = delone.tetrahedralize(*flange())
    _, ax = plt.subplots(**SMALL)
    low, high = np.percentile(part.volumes, (5, 95))
    picture = delone.plot.image(
        part, values=np.clip(part.volumes, low, high), cut="y", shrink=0.85, colorbar=False
    )
    rows, columns = np.nonzero((picture[..., :3] < 250).any(axis=-1))
    ax.imshow(picture[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1])
    ax.set_axis_off()


PICTURES: dict[str, Callable[[], None]] = {
    function.__name__: function for function in (ahn3, terrain, mesh, globe, solid)
}


def main() -> None:
    """Draw the pictures whose names are given, or all."""
    for name in sys.argv[1:] or PICTURES:
        PICTURES[name]()
        figure = plt.gcf()
        figure.canvas.draw()
        image = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
        plt.close(figure)
        path = STATIC / f"{name}.png"
        written = io.BytesIO()
        image.quantize(COLORS, dither=Image.Dither.NONE).save(written, "PNG", optimize=True)
        if name != "ahn3" and written.tell() > LARGEST:
            raise SystemExit(f"{path.name} is larger than {LARGEST:,} bytes: {written.tell():,}")
        path.write_bytes(written.getvalue())
        print(f"{path}: {written.tell() / 1024:.0f} KiB")


if __name__ == "__main__":
    main()
