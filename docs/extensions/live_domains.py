"""What the figures of segments and of refinement start with."""

from __future__ import annotations

from typing import Any

import numpy as np
from live_answers import Points, flat, key, picture, plain

import delone

SHORE: Points = [
    [90, 90], [330, 60], [610, 80], [890, 110], [930, 350], [760, 520], [480, 550], [180, 530],
    [60, 320], [230, 290], [420, 330], [560, 220], [700, 360], [820, 180], [300, 420],
]  # fmt: skip
SEGMENTS = [[8, 2], [10, 4], [7, 12], [2, 4], [7, 5]]

PLATE: Points = [
    [60, 60], [930, 50], [940, 400], [720, 430], [700, 480], [680, 430], [420, 540], [70, 500],
    [180, 170], [230, 160], [210, 215], [520, 230], [640, 180], [660, 300], [540, 320],
]  # fmt: skip
SIDES = [[i, (i + 1) % 8] for i in range(8)]
SIDES += [[8, 9], [9, 10], [10, 8], [11, 12], [12, 13], [13, 14], [14, 11]]
RINGS = [[8, 9, 10], [11, 12, 13, 14]]  # those of holes
BOUNDS = (0, 10, 15, 20, 25, 28, 30, 33)


def constrained() -> dict[str, Any]:
    """Return the figure of segments, with the triangles after each of them."""
    figure = plain(SHORE)
    for count in range(len(SEGMENTS) + 1):
        some = SEGMENTS[:count]
        mesh = delone.ConstrainedDelaunay(SHORE, np.reshape(some, (-1, 2)).astype(int))
        answer = {"triangles": flat(mesh.simplices.tolist())}
        figure["answers"][key("constrain", flat(SHORE), flat(some))] = answer
    return figure | {"segments": flat(SEGMENTS)}


def refined() -> dict[str, Any]:
    """Return the figure of a bound on angles, with the mesh for each bound."""
    holes = [np.floor(np.mean([PLATE[row] for row in ring], axis=0)).tolist() for ring in RINGS]
    answers = {}
    for bound in BOUNDS:
        mesh = delone.mesh((PLATE, SIDES), holes=holes, min_angle=bound)
        answers[key("refine", flat(PLATE), flat(SIDES), flat(holes), [bound])] = {
            "points": flat(mesh.points.tolist()),
            "triangles": flat(mesh.simplices.tolist()),
            "subsegments": flat(mesh.segments.tolist()),
        }
    shown = answers[key("refine", flat(PLATE), flat(SIDES), flat(holes), [20])]
    points = [shown["points"][i : i + 2] for i in range(0, len(shown["points"]), 2)]
    return {
        "points": PLATE,
        "segments": flat(SIDES),
        "rings": RINGS,
        "bounds": list(BOUNDS),
        "answers": answers,
        "picture": picture(points, shown["triangles"]),
    }
