"""Lloyd's method: energy falls, sites come to rest at centroids, densities draw them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone.datasets import uniform
from delone.errors import InputError
from delone.voronoi import Voronoi, centroidal, lloyd

BOX = (0, 0, 1, 1)


def test_energy_falls_with_each_step() -> None:
    steps: list[tuple[int, float, float]] = []
    result = lloyd(
        uniform(100, seed=1), BOX, max_iter=30, progress=lambda *step: steps.append(step)
    )
    assert result.iterations == 30 and not result.converged
    assert (np.diff(result.energies) < 0).all()
    assert [step[0] for step in steps] == list(range(1, 31))
    assert [step[1] for step in steps] == result.displacements.tolist()
    assert [step[2] for step in steps] == result.energies[1:].tolist()


def test_sites_come_to_rest_at_the_centroids_of_their_cells() -> None:
    result = lloyd(uniform(20, seed=2), BOX, max_iter=2000, tol=1e-9)
    assert result.converged
    assert result.displacements[-1] <= 1e-9 < result.displacements[-2]
    assert np.allclose(result.points, result.diagram.cell_centroids, atol=1e-8)


def test_the_energy_is_that_of_known_cells() -> None:
    # Four quarters of a square, sites at their centres: 4 * (h^4 / 6) with h = 1 / 2.
    points = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)]
    result = lloyd(points, BOX, max_iter=1, tol=0.0)
    assert result.energies.tolist() == pytest.approx([4 * 0.5**4 / 6] * 2)
    assert result.converged and result.displacements[0] < 1e-15


def test_a_density_draws_sites_where_it_is_large() -> None:
    flat = lloyd(uniform(200, seed=3), BOX, max_iter=60)
    steep = lloyd(uniform(200, seed=3), BOX, max_iter=60, density=lambda p: np.exp(4 * p[:, 0]))
    assert steep.points[:, 0].mean() > flat.points[:, 0].mean() + 0.05
    one = lloyd([(0.1, 0.4)], BOX, max_iter=1, density=lambda p: p[:, 0])
    # The centroid of the unit square under the density x.
    assert one.points.tolist() == [pytest.approx([2 / 3, 1 / 2])]


def test_outlines_with_holes_and_notches() -> None:
    shapely = pytest.importorskip("shapely")
    outline = shapely.box(0, 0, 4, 4) - shapely.box(1, 1, 2, 2) - shapely.box(3, 3, 5, 5)
    one = lloyd([(0.5, 0.5)], outline, max_iter=1)
    assert np.allclose(one.points, shapely.get_coordinates(outline.centroid))
    result = lloyd(uniform(60, seed=4) * 4, outline, max_iter=25)
    assert (np.diff(result.energies) < 0).all()
    # Who starts in the hole or the notch may have no cell, and stays.
    assert not shapely.contains_xy(outline, result.points[result.empty]).any()
    assert (result.diagram.cell_areas > 0).sum() == 60 - len(result.empty) >= 55


def test_a_site_without_a_cell_stays_where_it_is() -> None:
    result = lloyd([(0.5, 0.5), (9, 9), (9, 9)], BOX, max_iter=3)
    assert result.points.tolist() == [[0.5, 0.5], [9.0, 9.0], [9.0, 9.0]]
    assert result.empty.tolist() == [1, 2]


@pytest.mark.parametrize("method", ["lloyd", "l-bfgs"])
@pytest.mark.parametrize("scale", [2.0**-600, 2.0**600])
def test_domains_of_any_size(scale: float, method: str) -> None:
    sites, told = uniform(30, seed=8), []
    plain = lloyd(sites, BOX, max_iter=5, method=method, density=lambda p: 1 + p[:, 0])
    with np.errstate(all="raise"):
        scaled = lloyd(
            sites * scale,
            (0, 0, scale, scale),
            max_iter=5,
            method=method,
            density=lambda p: 1 + p[:, 0] / scale,
            progress=lambda *step: told.append(step),
        )
    assert scaled.points == pytest.approx(plain.points * scale, rel=1e-12)
    assert scaled.displacements == pytest.approx(plain.displacements * scale, rel=1e-9)
    assert scaled.diagram.clip == (0.0, 0.0, scale, scale)
    assert len(told) == 5 and len(scaled.empty) == 0
    assert all(type(energy) is float for _, _, energy in told)


def test_the_box_of_the_sites_stays_that_of_the_first_ones() -> None:
    result = lloyd([(0, 0), (1, 1), (0.3, 0.6)], "box", max_iter=5)
    assert result.diagram.clip == (0.0, 0.0, 1.0, 1.0)


def test_quasi_newton_steps_come_to_rest_sooner() -> None:
    sites = uniform(150, seed=5)
    slow = lloyd(sites, BOX, max_iter=3000, tol=1e-6)
    fast = lloyd(sites, BOX, max_iter=3000, tol=1e-6, method="l-bfgs")
    assert slow.converged and fast.converged
    assert fast.evaluations < slow.evaluations / 2
    assert slow.evaluations == slow.iterations + 1 <= 3001
    assert (np.diff(fast.energies) <= 1e-13 * fast.energies[0]).all()
    assert np.allclose(fast.points, fast.diagram.cell_centroids, atol=1e-6)
    assert fast.energies[-1] == pytest.approx(slow.energies[-1], rel=0.02)


def test_the_gradient_is_that_of_the_energy() -> None:
    sites, step = uniform(12, seed=6), 1e-6
    for density in (None, lambda p: 1 + p[:, 0]):
        state = centroidal._state(Voronoi(sites, clip=BOX), density)
        for row, k in [(0, 0), (5, 1), (11, 0)]:
            moved = [sites.copy(), sites.copy()]
            moved[0][row, k] -= step
            moved[1][row, k] += step
            low, high = (centroidal._state(Voronoi(m, clip=BOX), density).energy for m in moved)
            assert (high - low) / (2 * step) == pytest.approx(state.gradient[row, k], rel=1e-4)


def test_quasi_newton_steps_with_densities_outlines_and_doubled_sites() -> None:
    shapely = pytest.importorskip("shapely")
    outline = shapely.box(0, 0, 4, 4) - shapely.box(1, 1, 2, 2) - shapely.box(3, 3, 5, 5)
    sites = np.vstack((uniform(60, seed=7) * 4, [(9.0, 9.0), (0.5, 0.5), (0.5, 0.5)]))
    result = lloyd(sites, outline, max_iter=40, method="l-bfgs", density=lambda p: np.exp(-p[:, 0]))
    assert (np.diff(result.energies) <= 1e-13 * result.energies[0]).all()
    assert result.points[-1].tolist() == result.points[-2].tolist()
    assert 60 in result.empty and result.points[60].tolist() == [9.0, 9.0]
    one = lloyd([(0.1, 0.5)], BOX, method="l-bfgs", tol=1e-12)
    assert one.converged and one.points.tolist() == [pytest.approx([0.5, 0.5])]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"clip": None}, "needs a clip"),
        ({"max_iter": -1}, "max_iter"),
        ({"tol": -1.0}, "tol"),
        ({"method": "newton"}, "'lloyd', 'l-bfgs'"),
        ({"tol": float("nan")}, "tol"),
        ({"density": lambda p: p}, "shape"),
        ({"density": lambda p: -p[:, 0]}, "not negative"),
        ({"density": lambda p: 0 * p[:, 0]}, "returned only zeros"),
        ({"density": lambda p: ["a"] * len(p)}, "the result of density must hold real numbers"),
        ({"density": 5}, "density must be a function"),
        ({"progress": 5}, "progress must be a function"),
        ({"max_iter": None}, "max_iter must be an integer"),
        ({"max_iter": 1.5}, "max_iter must be an integer"),
        ({"max_iter": True}, "max_iter must be an integer"),
        ({"tol": "a"}, "tol must be a real number"),
        ({"tol": True}, "tol must be a real number"),
        ({"clip": {}}, "clip {} is not a geometry: it has no type"),
        ({"clip": {"type": 5}}, "is not a geometry: its type is 5"),
    ],
)
def test_bad_options_are_refused(options: dict[str, Any], message: str) -> None:
    arguments = {"clip": BOX} | options
    with pytest.raises(InputError, match=message):
        lloyd([(0.5, 0.5), (0.25, 0.125)], arguments.pop("clip"), **arguments)
