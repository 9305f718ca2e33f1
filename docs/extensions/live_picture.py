"""The first picture of a figure, which a page shows until its script runs: a small SVG."""

from __future__ import annotations

from typing import Any

WIDTH, MARGIN = 700.0, 14.0


def svg(stored: dict[str, Any], text: str) -> str:
    """Return the picture of the answers of a figure as an element, described by a text."""
    picture = stored["picture"]
    x0, y0, x1, y1 = picture["view"]
    scale = (WIDTH - 2 * MARGIN) / (x1 - x0)
    height = scale * (y1 - y0) + 2 * MARGIN
    xy = [
        (MARGIN + scale * (x - x0), height - MARGIN - scale * (y - y0))
        for x, y in picture["points"]
    ]
    parts = [
        f'<svg class="live-picture" viewBox="0 0 {WIDTH:.0f} {height:.0f}" role="img" '
        f'aria-label="{text}">'
    ]
    faces = "".join(
        "M" + "L".join(f"{xy[row][0]:.1f} {xy[row][1]:.1f}" for row in triangle) + "Z"
        for triangle in picture["triangles"]
    )
    parts += [f'<path class="live-e" d="{faces}"/>'] if faces else []
    if len(xy) <= 500:
        parts += [f'<circle class="live-p" cx="{x:.1f}" cy="{y:.1f}" r="4"/>' for x, y in xy]
    return "".join([*parts, "</svg>"])
