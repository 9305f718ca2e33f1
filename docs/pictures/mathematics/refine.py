"""Pictures of refinement, one for each of its steps."""

import matplotlib.pyplot as plt
import numpy as np
from drawing import (
    BLUE,
    GRAY,
    INK,
    ORANGE,
    Points,
    circle,
    circumcircle,
    dots,
    edges,
    fill,
    label,
    lines,
    panels,
)
from matplotlib.axes import Axes

import delone
from delone import Delaunay

ANGLE = 25.0
# An outline with a notch, and a short edge inside.
OUTLINE = np.array(
    [(0, 0), (10, 0), (10, 6), (6.2, 6), (5.6, 3.4), (5, 6), (0, 6), (2.6, 2.2), (2.9, 2.3)]
)
SIDES = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 0)]


def _angle(a: Points, b: Points, c: Points) -> float:
    """The smallest angle of a triangle, in degrees."""
    corners = np.array((a, b, c))
    out = [(corners[k - 2] - corners[k], corners[k - 1] - corners[k]) for k in range(3)]
    return min(np.degrees(np.arctan2(abs(u[0] * v[1] - u[1] * v[0]), u @ v)) for u, v in out)


def _mesh(ax: Axes, mesh: delone.Mesh, bound: float = ANGLE) -> None:
    bad = [_angle(*mesh.points[t]) < bound - 1e-9 for t in mesh.simplices]
    edges(ax, mesh.points, mesh.simplices)
    fill(ax, mesh.points[mesh.simplices[bad]], ORANGE, 0.4)
    lines(ax, mesh.points[mesh.segments], INK, linewidth=1.6)


def center() -> None:
    """A bad triangle, its empty circle, and the vertex at the center."""
    points = np.array(
        [
            (0, 0),
            (1, -0.05),
            (0.8, 2.6),
            (-1.9, 1.2),
            (3.3, 0.9),
            (-1.2, -1.3),
            (2.2, -1.4),
            (-0.6, 3.3),
            (2.9, 3),
        ]
    )
    before = Delaunay(points)
    middle, radius = circumcircle(*points[:3])
    after = Delaunay(np.vstack((points, middle)))
    left, right = panels(
        "a bad triangle; its circumcircle is empty", "all new edges are $r$ or longer", width=4
    )
    fill(left, [points[:3]], ORANGE, 0.4)
    lines(left, [points[:2]], ORANGE, linewidth=3)
    label(left, points[:2].mean(axis=0), r"$\ell$", (0, -10))
    label(left, (middle + points[1]) / 2, "$r$", (9, 0))
    lines(left, [(middle, points[1])], INK, linestyle=":")
    star = after.simplices[(after.simplices == len(points)).any(axis=1)]
    fill(right, after.points[star], BLUE, 0.15)
    for ax, mesh in ((left, before), (right, after)):
        edges(ax, mesh.points, mesh.simplices)
        circle(ax, middle, radius)
        dots(ax, points)
        dots(ax, middle, ORANGE, 45)


def _cap(ax: Axes, height: float, ends: Points) -> None:
    """The arcs on both sides of a subsegment that bound its lens."""
    half = (ends[1] - ends[0])[0] / 2
    radius = (half**2 + height**2) / (2 * height)
    turn = np.linspace(-1, 1, 80) * np.arcsin(half / radius)
    x, y = ends.mean(axis=0)
    for side in (1, -1):
        rise = radius * np.cos(turn) - (radius - height)
        ax.plot(x + radius * np.sin(turn), y + side * rise, color=BLUE, linewidth=1.4)


def encroached() -> None:
    """A subsegment with its diametral circle and its lens; a center in it; the split."""
    ends = np.array([(-1.0, 0), (1, 0)])
    turn = np.radians((100, 122, 10))
    triangle = np.column_stack((0.02 + np.cos(turn), 0.2 + np.sin(turn)))
    middle, radius = circumcircle(*triangle)
    row = panels(
        "the center of the circle lies in the lens",
        "instead, the subsegment is split",
        width=4.2,
        height=3.2,
    )
    for ax in row:
        fill(ax, [triangle], ORANGE, 0.4)
        lines(ax, [ends], INK, linewidth=2.4)
        dots(ax, triangle)
        dots(ax, ends, size=30)
        ax.set(xlim=(-1.25, 1.25), ylim=(-1.05, 1.3))
    circle(row[0], middle, radius)
    dots(row[0], middle, ORANGE, 45)
    circle(row[0], (0, 0), 1, GRAY, linestyle=(0, (4, 3)))
    _cap(row[0], float(np.tan(np.radians(ANGLE))), ends)
    dots(row[1], (0, 0), BLUE, 50)
    for x in (-0.5, 0.5):
        circle(row[1], (x, 0), 0.5, GRAY, linestyle=(0, (4, 3)))


def bounds() -> None:
    """How far a center in a diametral circle or a lens is from the nearer end, at most."""
    ends = np.array([(-1.0, 0), (1, 0)])
    tall = float(np.tan(np.radians(26.565)))
    titles = (
        r"circle: $r \leq \sqrt{2}\,\varrho$",
        r"lens: $r \leq \varrho\,/\cos\alpha$",
    )
    row = panels(*titles, width=4, height=2.6)
    for ax, height in zip(row, (1.0, tall), strict=True):
        lines(ax, [ends], INK, linewidth=2.4)
        lines(ax, [((0, height), (1, 0))], ORANGE, linewidth=1.6)
        dots(ax, ends, size=30)
        dots(ax, (0, 0), BLUE, 40)
        dots(ax, (0, height), ORANGE, 40)
        label(ax, (0.5, height / 2), "$r$", (-5, -8), ORANGE)
        label(ax, (0.5, 0), r"$\varrho$", (0, -10))
        ax.set(xlim=(-1.1, 1.1), ylim=(-0.56, 1.1))
    turn = np.linspace(0, np.pi, 100)
    row[0].plot(np.cos(turn), np.sin(turn), color=GRAY, linestyle=(0, (4, 3)))
    _cap(row[1], tall, ends)


def order() -> None:
    """One mesh after more and more vertices."""
    whole = delone.mesh((OUTLINE, SIDES), min_angle=ANGLE)
    added = len(whole.points) - len(OUTLINE)
    steps = (1, 2, 3, 5, 7, added)
    titles = [f"{n} vertices added" if n > 1 else "1 vertex added" for n in steps]
    row = panels(*titles, width=3.6, height=2.5, rows=2)
    for ax, n in zip(row, steps, strict=True):
        mesh = delone.mesh((OUTLINE, SIDES), min_angle=ANGLE, max_points=n)
        _mesh(ax, mesh)
        dots(ax, mesh.points[len(OUTLINE) :], BLUE, 16)
        dots(ax, OUTLINE, size=12)


def off_center() -> None:
    """The circumcenter of a thin triangle, and the off-center."""
    thin = np.array([(0, 0), (1.0, 0), (0.55, 7)])
    middle, _ = circumcircle(*thin)
    height = 0.95 * 0.5 * (1 + np.cos(np.radians(ANGLE))) / np.sin(np.radians(ANGLE))
    off = np.array((0.5, height))
    row = panels(
        "circumcenter: still too thin", "off-center: just good enough", width=3.2, height=3.6
    )
    for ax, place, color in zip(row, (middle, off), (ORANGE, BLUE), strict=True):
        lines(ax, thin[[(0, 1), (1, 2), (2, 0)]], GRAY, linewidth=1.2)
        fill(ax, [(thin[0], thin[1], place)], color, 0.35)
        circle(ax, *circumcircle(*thin), GRAY, linestyle=":")
        dots(ax, thin)
        dots(ax, place, color, 45)
        angle = _angle(thin[0], thin[1], place)
        label(ax, place, f"{angle:.0f}°", (0, 12), color)


def corners() -> None:
    """A sharp corner in a finished mesh, and the two triangles that it explains."""
    points = np.array([(0, 0), (6, 0), (5.4, 1.25), (6, 4), (0, 4)])
    rows = [(0, 1), (0, 2), (1, 3), (3, 4), (4, 0)]
    mesh = delone.mesh((points, rows), min_angle=ANGLE)
    (ax,) = panels("", width=5, height=3.4)
    _mesh(ax, mesh)
    far = np.sort(np.hypot(*mesh.points[len(points) :].T)).round(6)
    radius = far[:-1][np.diff(far) == 0][0]
    turn = np.linspace(-0.02, 0.32, 30)
    ax.plot(radius * np.cos(turn), radius * np.sin(turn), color=BLUE, linewidth=2)
    dots(ax, mesh.points)


def needles() -> None:
    """A needle, and the number of points that lower and lower ones take."""
    sides = [(0, 1), (1, 2), (2, 0)]

    def needle(height: float, bound: float) -> delone.Mesh:
        return delone.mesh(([(0, 0), (1, 0), (0.3, height)], sides), min_angle=bound)

    _, (top, plot) = plt.subplots(
        2, 1, figsize=(6.4, 4.6), layout="constrained", height_ratios=(1, 2.2)
    )
    mesh = needle(0.05, ANGLE)
    _mesh(top, mesh)
    top.set_aspect("equal")
    top.set_axis_off()
    top.set_title(f"height 0.05: {len(mesh.points)} points at {ANGLE:.0f} degrees", fontsize=10)
    heights = np.geomspace(0.1, 0.0003, 9)
    for bound, color in ((ANGLE, ORANGE), (5.0, BLUE)):
        points = [len(needle(h, bound).points) for h in heights]
        plot.loglog(heights, points, "o-", color=color, label=f"{bound:.0f} degrees")
    plot.invert_xaxis()
    plot.set(xlabel="height of the triangle, with a base of 1", ylabel="points")
    plot.legend(frameon=False)


def front() -> None:
    """A bound on areas, met from the boundary inward."""
    turn = np.arange(40) * 2 * np.pi / 40
    ring = np.column_stack((np.cos(turn), np.sin(turn)))
    disk = {"type": "Polygon", "coordinates": [ring.tolist()]}
    mesh = delone.mesh(disk, max_area=0.012)
    left, right = panels("a bound on areas", "areas, as shares of the bound", width=3.8)
    _mesh(left, mesh, 30)
    right.set_axis_on()
    right.set_aspect("auto")
    right.hist(mesh.areas / 0.012, bins=np.linspace(0, 1, 26), color=BLUE, edgecolor="white")
    right.set(xlabel="area / bound", ylabel="triangles")
