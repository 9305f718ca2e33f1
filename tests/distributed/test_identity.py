"""The union of the tiles is the triangulation in memory, triangle for triangle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets, distributed
from delone.datasets import ahn3, baja
from delone.errors import DegenerateInputError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

GENERATORS = {
    name: getattr(datasets, name)
    for name in (
        "uniform",
        "gaussian_clusters",
        "kuzmin",
        "grid",
        "tilted_grid",
        "circle",
        "spiral",
        "near_collinear",
        "duplicates",
        "collinear_lines",
        "utm_millimeters",
        "pythagorean_circle",
        "integer_lattice",
        "mixed_exponents",
    )
}


@pytest.mark.parametrize("tiles", [1, 2, 5, 16, 64])
@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.deep("*-16", "*-64", "mixed_exponents-*")
@pytest.mark.sampled(12)
def test_tiles_agree_with_memory(
    name: str, tiles: int, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    points = GENERATORS[name](640)
    size = max(3, -(-len(points) // tiles))
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=size)
    right = Delaunay(points)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))
    assert tin.manifest["duplicates"] == len(right.coplanar)
    assert tin.npoints == len(points)
    if tiles in (1, 5):
        assert tin.validate(), str(tin.validate())


@pytest.mark.parametrize("survey", [ahn3, baja])
def test_surveys_agree_with_memory(
    survey: Any, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    sample = survey()
    points = np.column_stack([sample.points, sample.z])
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=15_000)
    assert tin.ntiles > 1
    right = Delaunay(sample.points)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))
    heights = np.concatenate([t.attributes["z"][t.owned] for t in tin.tiles()])
    ids = np.concatenate([t.ids[t.owned] for t in tin.tiles()])
    assert np.array_equal(sample.z[ids], heights)


@pytest.mark.parametrize("exponent", [-1040, -600, 600, 1020])
def test_a_power_of_two_asks_no_more(
    exponent: int, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    # Below 2^-1022 doubles have fewer digits: 20 are enough for these.
    points = np.round(datasets.uniform(3000) * 2**20)
    one = distributed.triangulate(points, tmp_path / "one", tile_points=300)
    two = distributed.triangulate(
        np.ldexp(points, exponent - 20), tmp_path / "two", tile_points=300
    )
    assert np.array_equal(canonical(one.read_simplices()), canonical(two.read_simplices()))
    assert [one.manifest[name] for name in ("rounds", "given")] == [
        two.manifest[name] for name in ("rounds", "given")
    ]


def test_nobody_is_asked_about_corners_of_the_hull(tmp_path: Path) -> None:
    points = datasets.circle(3000)
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=300)
    assert tin.manifest["hull"] == len(points)
    assert tin.manifest["rounds"] == 0
    assert tin.validate()


def test_the_order_of_rows_changes_nothing(tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    points = datasets.grid(400)
    order = np.random.default_rng(1).permutation(len(points))
    one = distributed.triangulate(points, tmp_path / "one", tile_points=90)
    two = distributed.triangulate(points[order], tmp_path / "two", tile_points=70)
    assert np.array_equal(canonical(one.read_simplices()), canonical(order[two.read_simplices()]))


@pytest.mark.parametrize(
    "points",
    [
        [(0, 0), (1, 0), (0, 1)],
        [(0, 0), (1, 0), (0, 1), (0, 0), (1, 0)],
        [(0, 0), (9, 0), (9, 9), (0, 9)],
        [(x, y) for x in range(4) for y in range(4)] * 3,
        [(1e-200 * x, 1e-200 * y) for x in range(6) for y in range(6)],
        [(1e200 * x, 1e200 * y) for x in range(6) for y in range(6)],
        [(x, 0) for x in range(40)] + [(20.5, 1e-9)],
        [(x, y) for x in (-0.0, 0.0, 1.0) for y in (0.0, -0.0, 2.0)],
    ],
)
@pytest.mark.sampled(3)
def test_few_points(points: Any, tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    tin = distributed.triangulate(np.array(points, float), tmp_path / "tin", tile_points=3)
    right = Delaunay(np.array(points, float))
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))
    assert tin.validate(), str(tin.validate())


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("size", [5, 40])
@pytest.mark.deep("*-5")
@pytest.mark.sampled(19)
def test_the_corpus_in_tiles(
    corpus_case: Any, size: int, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    # The proof of doubts that reach every tile takes its time; a part is as hard as the whole.
    points = corpus_case.points[:200]
    try:
        right = Delaunay(points)
    except DegenerateInputError:
        pytest.skip("its first points span no area")
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=size)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(right.simplices))
    assert tin.validate(), str(tin.validate())
    inside = np.abs(points).max(axis=1) < 1e300
    assert (tin.find_simplex(points[inside]) >= 0).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("size", [3, 17])
def test_the_whole_range_of_doubles(
    size: int, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    """Strips and sides of tiles are beyond the range, without a word of it."""
    dice = np.random.default_rng(1)
    points = (dice.random((60, 2)) * 2 - 1) * 1.7e308
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=size)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(points).simplices))
    assert tin.validate(), str(tin.validate())
    assert (tin.find_simplex(points) >= 0).all()
