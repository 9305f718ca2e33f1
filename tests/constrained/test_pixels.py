"""A segment that passes through the pixel of a rounded crossing has the crossing on its way."""

from __future__ import annotations

import json
from itertools import permutations
from pathlib import Path

import numpy as np

from delone import ConstrainedDelaunay

CASE = Path(__file__).parents[1] / "corpus" / "pixel-of-a-crossing-behind-an-edge.json"


def test_a_pixel_behind_another_edge() -> None:
    case = json.loads(CASE.read_text(encoding="utf-8"))
    points = np.array(case["points"], dtype=float)
    for order in permutations(case["segments"]):
        mesh = ConstrainedDelaunay(points, list(order), crossing="split")
        assert mesh.nadded == 1
        found = {tuple(sorted(ends)) for ends in mesh.segments.tolist()}
        assert found == {(0, 6), (1, 5), (1, 6), (2, 6), (4, 6), (5, 6)}
