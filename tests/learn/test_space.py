"""The figures of tetrahedra: their numbers are those of Python, and they turn and step back."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import live_space
import numpy as np
import pytest

import delone

if TYPE_CHECKING:
    from browser import Page

ONE = "window.deloneFigures.sliver"
BALL = "window.deloneFigures.slivers"


def numbers(text: str) -> list[float]:
    return [float(word) for word in re.findall(r"\d+(?:\.\d+)?", text)]


def test_angles_ratio_and_volume_of_each_height(page: Page) -> None:
    said = page.run(f"{ONE}.states.map((state) => state.say)")
    labels = page.run(
        f"{ONE}.states.map((state) => state.layers[0].filter((layer) => layer.kind === 'labels')"
        ".map((layer) => layer.texts[0]))"
    )
    assert len(said) == len(live_space.HEIGHTS)
    for height, text, shown in zip(live_space.HEIGHTS, said, labels, strict=True):
        corners = np.array(live_space.corners(height), dtype=float)
        mesh = delone.Delaunay(corners)
        quality = mesh.quality()
        least, most = quality.smallest_dihedral[0], quality.largest_dihedral[0]
        lengths = np.linalg.norm(corners[mesh.edges[:, 0]] - corners[mesh.edges[:, 1]], axis=1)
        radius = np.linalg.norm(corners[0])
        regular = (radius * np.sqrt(8 / 3)) ** 3 / (6 * np.sqrt(2))
        found = numbers(text)
        assert found[:3] == pytest.approx([least, most, radius / lengths.min()], abs=0.051)
        assert found[2] == pytest.approx(radius / lengths.min(), abs=0.00051)
        assert found[3] == pytest.approx(100 * mesh.volumes[0] / regular, abs=0.051)
        # The drawing computes the angles at its edges by itself.
        assert sorted(numbers(" ".join(shown))) == pytest.approx([least, most], abs=0.051)
    assert page.complaints() == []


def test_the_ball_is_that_of_python(page: Page) -> None:
    ball = delone.Delaunay(live_space.ball())
    meshes = [ball, delone.improve(ball, smooth=False), delone.improve(ball)]
    states = page.run(f"{BALL}.states.map(({{ say, low }}) => [say, low])")
    assert len(states) == 3
    for mesh, (text, low) in zip(meshes, states, strict=True):
        angles = mesh.quality().smallest_dihedral
        assert low == (angles < 10).sum()
        assert f" {mesh.nsimplex} tetrahedra, {low or 'none'} with" in text
        assert f"smallest angle is {round(angles.min(), 1):g}°" in text
    assert "No vertex has moved" in states[1][0]
    assert "2 vertices (orange) have moved" in states[2][0]
    assert [low for _, low in states] == [18, 0, 0]


def test_the_ball_of_the_core_is_the_stored_one(page: Page) -> None:
    if not page.run(f"{BALL}.core.live"):
        return
    found = page.run(f"Array.from({BALL}.core.tetrahedra({BALL}.points).tetrahedra)")
    stored = page.run(f"{BALL}.stored.meshes[0].tetrahedra")
    rows = [np.sort(np.reshape(each, (-1, 4)), axis=1).tolist() for each in (found, stored)]
    assert sorted(rows[0]) == sorted(rows[1])


def test_the_bound_fills_what_is_below_it(page: Page) -> None:
    angles = np.array(live_space.slivers()["meshes"][0]["angles"])
    for bound in (1, 5, 20, 40):
        page.run(f"{BALL}.change((f) => {{ f.options = {{ ...f.options, below: {bound} }}; }})")
        low, corners = page.run(
            f"[{BALL}.states[0].low, {BALL}.states[0].layers[0].find("
            "(layer) => layer.kind === 'fill').corners.length]"
        )
        assert low == (angles < bound).sum()
        assert corners == 24 * low  # four faces with three corners of two coordinates
    page.run(f"{BALL}.reset()")


def test_bars_are_the_histogram(page: Page) -> None:
    tops = page.run(
        f"{BALL}.states.map((state) => state.layers[1].filter((layer) => layer.fill)"
        ".map((layer) => layer.xy[5]))"
    )
    meshes = live_space.slivers()["meshes"]
    counts = [np.histogram(mesh["angles"], np.arange(0, 76, 5))[0] for mesh in meshes]
    scale = 70 / np.max(counts)
    assert np.concatenate(tops) == pytest.approx(scale * np.concatenate(counts))


@pytest.mark.parametrize("figure", [ONE, BALL])
def test_arrow_keys_turn_there_and_back(page: Page, figure: str) -> None:
    image = page.run(f"{figure}.canvas.toDataURL()")
    page.run(f"{figure}.canvas.focus()")
    for there, back in (("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown")):
        page.key(there)
        assert page.run(f"{figure}.canvas.toDataURL()") != image
        page.key(back)
        assert page.run(f"{figure}.canvas.toDataURL()") == image
    for _ in range(60):
        page.key("ArrowRight")
    assert page.run(f"{figure}.canvas.toDataURL()") == image  # a full turn
    assert page.complaints() == []
