"""A picture for each of the five methods, drawn from what delone itself computes."""

import itertools

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from numpy.typing import NDArray

import delone
from delone import Delaunay, predicates

BLUE, ORANGE, GRAY, PALE, INK = "#2f6f9f", "#d9742b", "#9a9a9a", "#dcdcdc", "#303030"
# Degrees from which the paraboloid is looked at.
ELEVATION, AZIMUTH = 16, -62

Points = NDArray[np.float64]
Rows = NDArray[np.int32]


def _spread(n: int, seed: int) -> Points:
    """Draw points of the unit square that keep apart: each is the best of twenty, by distance."""
    random = np.random.default_rng(seed)
    points = [random.random(2)]
    while len(points) < n:
        candidates = random.random((20, 2))
        apart = np.hypot(*(candidates[:, None] - np.array(points)).T).min(axis=0)
        points.append(candidates[apart.argmax()])
    return np.array(points)


def _axes(rows: int, columns: int, width: float) -> list[Axes]:
    size = (width * columns, (width + 0.35) * rows)
    _, grid = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    for ax in grid.flat:
        ax.set(aspect="equal", xlim=(-0.05, 1.05), ylim=(-0.05, 1.05))
        ax.set_axis_off()
    return list(grid.flat)


def _edges(ax: Axes, points: Points, simplices: Rows, color: str = GRAY) -> None:
    ax.triplot(*points.T, simplices, color=color, linewidth=1)


def _fill(ax: Axes, points: Points, simplices: Rows, color: str, alpha: float = 0.25) -> None:
    for triangle in simplices:
        ax.fill(*points[triangle].T, color=color, alpha=alpha, linewidth=0)


def _lines(ax: Axes, points: Points, pairs: Rows, **style: object) -> None:
    ax.add_collection(LineCollection(list(points[pairs]), **style))


def _dots(ax: Axes, points: Points, color: str = INK, size: float = 12) -> None:
    ax.scatter(*points.T, s=size, color=color, zorder=3)


def _rim(simplices: Rows) -> Rows:
    """The edges that only one of the triangles has."""
    pairs = simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    inner = {(v, u) for u, v in pairs.tolist()}
    return np.array([pair for pair in pairs.tolist() if tuple(pair) not in inner], np.int32)


def cavity() -> None:
    """Bowyer-Watson: the circles that hold the new point, the hole, the star."""
    points = _spread(34, 38)
    new = np.array([0.59, 0.45])
    before, after = Delaunay(points), Delaunay(np.vstack((points, new)))
    corners = [points[before.simplices[:, k]] for k in range(3)]
    conflict = predicates.incircle(*corners, new) > 0
    left, middle, right = _axes(1, 3, 3.3)
    _edges(left, points, before.simplices)
    _fill(left, points, before.simplices[conflict], ORANGE)
    for center, corner in zip(before.circumcenters[conflict], corners[0][conflict], strict=True):
        radius = np.hypot(*(center - corner))
        left.add_patch(plt.Circle(center, radius, fill=False, color=ORANGE, linewidth=1))
    _edges(middle, points, before.simplices[~conflict])
    _lines(middle, points, _rim(before.simplices[conflict]), color=ORANGE, linewidth=2)
    star = (after.simplices == len(points)).any(axis=1)
    _edges(right, after.points, after.simplices)
    _fill(right, after.points, after.simplices[star], BLUE)
    _edges(right, after.points, after.simplices[star], BLUE)
    titles = "the circles that hold the point", "the cavity", "the star that fills it"
    for ax, title in zip((left, middle, right), titles, strict=True):
        _dots(ax, points)
        _dots(ax, new[None], ORANGE, 40)
        ax.set_title(title)


def flips() -> None:
    """Incremental: a triangle is split at the new point, and edges flip until none is wrong."""
    points = np.vstack((_spread(17, 13), (0.5, 0.5)))
    new = len(points) - 1
    before = Delaunay(points[:new])
    home = int(before.find_simplex(points[new]))
    a, b, c = before.simplices[home]
    split = np.array([(new, a, b), (new, b, c), (new, c, a)], np.int32)
    start = np.vstack((np.delete(before.simplices, home, axis=0), split))
    sequence = delone.lawson(points, start, record=True).sequence
    assert sequence is not None
    axes = _axes(2, 3, 3.1)
    titles = ["the triangle is split; the orange edge\nis wrong, and becomes the dashed one"]
    titles += [f"after flip {k}" for k in range(1, len(sequence))] + ["no edge is wrong any more"]
    triangles = [set(t) for t in start.tolist()]
    for ax, title, flip in itertools.zip_longest(axes, titles, sequence.tolist()):
        now = np.array([sorted(t) for t in triangles], np.int32)
        _edges(ax, points, now)
        at_new = now[(now == new).any(axis=1)]
        _fill(ax, points, at_new, BLUE)
        _dots(ax, points)
        _dots(ax, points[new:], ORANGE, 40)
        ax.set_title(title, fontsize=10)
        if flip is not None:
            u, v, p, q = flip
            ax.plot(*points[[u, v]].T, color=ORANGE, linewidth=2.6)
            ax.plot(*points[[p, q]].T, color=BLUE, linewidth=2, linestyle=(0, (2, 1.5)))
            triangles = [t for t in triangles if t not in ({u, v, p}, {u, v, q})]
            triangles += [{u, p, q}, {v, p, q}]


def seam() -> None:
    """Divide and conquer: two triangulations, what the merge takes away, what it puts between."""
    points = _spread(44, 6)
    is_left = points[:, 0] < np.median(points[:, 0])
    whole = Delaunay(points)
    kept = set(map(tuple, np.sort(whole.edges).tolist()))
    apart, merged = _axes(1, 2, 4.2)
    crossing = whole.edges[is_left[whole.edges].sum(axis=1) == 1]
    sides = is_left[whole.simplices].sum(axis=1)
    between = (sides > 0) & (sides < 3)
    _fill(merged, points, whole.simplices[between], GRAY, 0.3)
    for rows, shift, color in (
        (np.flatnonzero(is_left), np.array([-0.05, 0]), BLUE),
        (np.flatnonzero(~is_left), np.array([0.05, 0]), ORANGE),
    ):
        half = points[rows]
        edges = rows[Delaunay(half).edges].astype(np.int32)
        stays = np.array([tuple(sorted(edge)) in kept for edge in edges.tolist()])
        moved = points + shift
        _lines(apart, moved, edges[stays], color=color, linewidth=1.1)
        _lines(apart, moved, edges[~stays], color=color, linewidth=1.4, linestyle=(0, (2, 2)))
        _lines(merged, points, edges[stays], color=color, linewidth=1.1)
        _dots(apart, half + shift)
    _lines(merged, points, crossing, color=INK, linewidth=1.4)
    _dots(merged, points)
    apart.set(title="two halves; dashed edges will go", xlim=(-0.1, 1.1))
    merged.set(title="merged; the black edges are new", xlim=(-0.1, 1.1))


def beach() -> None:
    """Fortune's sweep: the beach line, the triangles that are final, the circle that ends next."""
    points = _spread(26, 4)
    mesh = Delaunay(points, method="sweep")
    line = 0.66
    behind = points[points[:, 0] < line]
    y = np.linspace(-0.06, 1.06, 2000)
    # x of the places as far from a point as from the line: a parabola a point; the foremost counts.
    room = line - behind[:, :1]
    arcs = (line + behind[:, :1]) / 2 - (y - behind[:, 1:]) ** 2 / (2 * room)
    shore = arcs.max(axis=0)
    radius = np.hypot(*(mesh.circumcenters - points[mesh.simplices[:, 0]]).T)
    ends = mesh.circumcenters[:, 0] + radius
    final = ends < line
    known = (points[mesh.simplices, 0] < line).all(axis=1) & ~final
    coming = np.flatnonzero(known)[ends[known].argmin()]
    (ax,) = _axes(1, 1, 5.6)
    ax.fill_betweenx(y, -0.05, shore, color=ORANGE, alpha=0.09, linewidth=0)
    _edges(ax, points, mesh.simplices, PALE)
    _fill(ax, points, mesh.simplices[final], BLUE)
    _edges(ax, points, mesh.simplices[final], BLUE)
    nearest = arcs.argmax(axis=0)
    for k in np.unique(nearest):
        ax.plot(arcs[k], y, color=ORANGE, linewidth=0.7, alpha=0.45)
    ax.plot(shore, y, color=ORANGE, linewidth=2.4)
    circle = plt.Circle(
        mesh.circumcenters[coming], radius[coming], fill=False, color=INK, linestyle=(0, (3, 2))
    )
    ax.add_patch(circle)
    ax.plot([line, line], [-0.05, 1.05], color=INK, linewidth=1.4)
    ax.annotate(
        "", (line + 0.11, 1.02), (line, 1.02), arrowprops={"arrowstyle": "->", "color": INK}
    )
    _dots(ax, points)
    _dots(ax, np.array([[ends[coming], mesh.circumcenters[coming, 1]]]), ORANGE, 34)
    ax.set_xlim(-0.05, 1.1)


def paraboloid() -> None:
    """Lifting: the lower hull of the lifted points, its shadow, and one circle with its lift."""
    square = _spread(80, 5) * 2 - 1
    points = square[np.hypot(*square.T) < 1]
    mesh = Delaunay(points, method="lifting")
    floor = -1.0
    lifted = np.column_stack((points, (points**2).sum(axis=1)))
    shadow = np.column_stack((points, np.full(len(points), floor)))
    chosen = int(mesh.find_simplex((0.36, -0.5)))
    one, others = mesh.simplices[chosen], np.delete(mesh.simplices, chosen, axis=0)
    turn = np.linspace(0, 2 * np.pi, 200)
    center = mesh.circumcenters[chosen]
    radius = np.hypot(*(center - points[one[0]]))
    ring = center + radius * np.column_stack((np.cos(turn), np.sin(turn)))
    posts = np.stack((shadow, lifted), axis=1)

    figure = plt.figure(figsize=(6.4, 5.6))
    ax = figure.add_axes((0, 0, 1, 1), projection="3d", computed_zorder=False)
    ax.add_collection3d(Poly3DCollection(shadow[others], facecolor="#e4edf4", edgecolor="none"))
    ax.add_collection3d(Line3DCollection(shadow[mesh.edges], color=BLUE, linewidth=0.8))
    ax.add_collection3d(Poly3DCollection(shadow[[one]], facecolor=ORANGE, edgecolor=BLUE))
    ax.plot(*ring.T, floor, color=ORANGE, linewidth=1.8)
    ax.add_collection3d(Line3DCollection(posts[mesh.hull], color=GRAY, linewidth=0.5))
    # The plane of a lifted triangle rises by twice the center of its circle. So this tells which
    # are seen from above and lie behind, and which from below.
    up, round_ = np.radians(ELEVATION), np.radians(AZIMUTH)
    sight = np.cos(up) * np.array([np.cos(round_), np.sin(round_)])
    below = 2 * mesh.circumcenters @ sight > np.sin(up)
    for side, color in ((~below, "#e4edf4"), (below, "#8db2cf")):
        facets = mesh.simplices[side]
        bowl = {"facecolor": color, "edgecolor": "#1d4766", "linewidth": 0.8, "alpha": 0.92}
        ax.add_collection3d(Poly3DCollection(lifted[facets], **bowl))
        ax.scatter(*lifted[np.unique(facets)].T, color=INK, s=6, depthshade=False)
    ax.add_collection3d(Line3DCollection(posts[one], color=ORANGE, linewidth=1.1))
    ax.add_collection3d(Poly3DCollection(lifted[[one]], facecolor=ORANGE, edgecolor=INK))
    ax.plot(*ring.T, (ring**2).sum(axis=1), color=ORANGE, linewidth=1.8)
    ax.set(xlim=(-0.9, 0.9), ylim=(-0.9, 0.9), zlim=(floor, 1))
    ax.set_box_aspect((1, 1, 1), zoom=1.25)
    ax.set_axis_off()
    ax.view_init(elev=ELEVATION, azim=AZIMUTH)
