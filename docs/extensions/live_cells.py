"""What the figures of Voronoi cells and of the lift start with."""

from __future__ import annotations

from typing import Any

from live_answers import WIDE, Points, flat, key, plain

from delone import Voronoi

SITES: Points = [
    [150, 110], [390, 70], [610, 150], [860, 90], [900, 330], [700, 310], [500, 260],
    [280, 250], [90, 330], [190, 500], [400, 450], [590, 520], [810, 520],
]  # fmt: skip
SQUARE = (0, 0, 600, 630)
LIFTED: Points = [
    [320, 340], [130, 220], [430, 140], [60, 350], [190, 530], [460, 490], [560, 270], [290, 50],
]  # fmt: skip


def voronoi() -> dict[str, Any]:
    """Return the figure of cells, cut to its view."""
    figure = plain(SITES)
    diagram = Voronoi(SITES, clip=WIDE)
    rings = [diagram.cell(row).parts[0][0].tolist() for row in range(len(SITES))]
    starts = [sum(map(len, rings[:row])) for row in range(len(SITES) + 1)]
    figure["answers"][key("voronoi", flat(SITES), WIDE)] = {
        "starts": starts,
        "corners": flat(flat(rings)),
    }
    return figure


def lift() -> dict[str, Any]:
    """Return the figure of the paraboloid."""
    return plain(LIFTED, SQUARE)
