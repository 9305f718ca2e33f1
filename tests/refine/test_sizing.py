"""Sizes: by number, region, function, background, raster; what is refused."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import delone
from delone import Delaunay, DtypeError, InputError, LimitError

SQUARE = [(0.0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
EQUILATERAL = np.sqrt(3) / 4


def kept(mesh: delone.Mesh, size: Any) -> bool:
    """Whether each triangle has at most the area that the size at its centre allows."""
    centres = mesh.points[mesh.simplices].mean(axis=1)
    return bool((mesh.areas <= EQUILATERAL * size(centres) ** 2 * (1 + 1e-12)).all())


def test_a_number_is_the_length_of_edges() -> None:
    mesh = delone.mesh(SQUARE, size=0.1)
    assert kept(mesh, lambda xy: np.full(len(xy), 0.1))
    lengths = np.hypot(*(mesh.points[mesh.edges[:, 0]] - mesh.points[mesh.edges[:, 1]]).T)
    assert 0.06 < lengths.mean() < 0.11


def test_a_function_of_places() -> None:
    def size(xy: np.ndarray) -> np.ndarray:
        return 0.01 + 0.2 * np.hypot(*(xy - 0.7).T)

    mesh = delone.mesh(SQUARE, size=size)
    assert kept(mesh, size)
    assert mesh.report.ok
    # Not many more triangles than the areas ask for.
    centres = mesh.points[mesh.simplices].mean(axis=1)
    wanted = (mesh.areas / (EQUILATERAL * size(centres) ** 2)).sum()
    assert mesh.nsimplex < 2.2 * wanted


def test_a_small_size_at_a_place_between_centres_is_found() -> None:
    def size(xy: np.ndarray) -> np.ndarray:
        return np.where(np.hypot(*(xy - (0.2, 0.9)).T) < 0.05, 0.004, 0.5)

    mesh = delone.mesh(SQUARE, size=size)
    assert kept(mesh, size)
    assert mesh.areas[mesh.find_simplex((0.2, 0.9))] < 1e-5
    assert mesh.areas.max() > 1e-3


def test_a_background_mesh() -> None:
    background = Delaunay([(-1, -1), (2, -1), (2, 2), (-1, 2), (0.5, 0.5)])
    mesh = delone.mesh(SQUARE, size=(background, [0.4, 0.4, 0.4, 0.4, 0.02]))
    assert mesh.areas[mesh.find_simplex((0.5, 0.5))] < 4e-4
    assert mesh.areas[mesh.find_simplex((0.01, 0.01))] > 1e-3
    small = Delaunay([(0.4, 0.4), (0.6, 0.4), (0.5, 0.6)])
    beyond = delone.mesh(SQUARE, size=(small, [0.05, 0.05, 0.05]))
    assert kept(beyond, lambda xy: np.full(len(xy), 0.05 + 1e-12))
    with pytest.raises(InputError, match="shape"):
        delone.mesh(SQUARE, size=(background, [1, 2]))


def test_a_raster() -> None:
    xarray = pytest.importorskip("xarray")
    x = np.linspace(0, 1, 11)
    values = 0.02 + 0.2 * np.broadcast_to(x, (11, 11))
    for order in (1, -1):
        raster = xarray.DataArray(values, coords={"y": x[::order], "x": x}, dims=("y", "x"))
        mesh = delone.mesh(SQUARE, size=raster)
        assert kept(mesh, lambda xy: 0.02 + 0.2 * xy[:, 0] + 1e-9)
    holed = values.copy()
    holed[3:8, 3:8] = np.nan
    raster = xarray.DataArray(holed, coords={"y": x, "x": x}, dims=("y", "x"))
    with pytest.raises(ValueError, match=r"size is nan at \(0\.\d+, 0\.\d+\)"):
        delone.mesh(SQUARE, size=raster)


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan")])
def test_bad_sizes_name_their_place(bad: float) -> None:
    with pytest.raises(ValueError, match="above 0"):
        delone.mesh(SQUARE, size=bad)
    with pytest.raises(ValueError, match="above 0"):
        delone.mesh(SQUARE, max_area=bad)
    with pytest.raises(ValueError, match=r"at \(0\.[5-9]\d*, 0\.\d+\)"):
        delone.mesh(SQUARE, size=lambda xy: np.where(xy[:, 0] > 0.5, bad, 0.1))
    with pytest.raises(ValueError, match="region 0"):
        delone.mesh(SQUARE, size={0: bad})


def test_what_is_no_size() -> None:
    for wrong in ("fine", object(), (1, 2, 3)):
        with pytest.raises(ValueError, match="size"):
            delone.mesh(SQUARE, size=wrong)
    with pytest.raises(ValueError, match="one length for each"):
        delone.mesh(SQUARE, size=lambda xy: np.ones((len(xy), 2)))


def test_a_size_that_never_ends_is_stopped() -> None:
    calls = 0

    def size(xy: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        return np.full(len(xy), 0.3 / 2**calls)

    mesh = delone.mesh(SQUARE, size=size, max_points=3000)
    assert mesh.report.exhausted
    assert mesh.nadded == 3000


def test_sizes_that_are_no_numbers() -> None:
    for wrong in (lambda xy: xy[:, 0] + 1j, lambda xy: ["a"] * len(xy), lambda _: None):
        with pytest.raises(DtypeError, match="real numbers"):
            delone.mesh(SQUARE, size=wrong)


def test_sizes_whose_squares_leave_the_range_are_refused() -> None:
    """A cap that cannot be compared is never passed over in silence."""
    points, ring = np.array(SQUARE[0], dtype=float), SQUARE[1]
    for scale, options in (
        (1e300, {"max_area": 1.0}),
        (1.0, {"size": 1e-200}),
        (1.0, {"size": {0: 1e-200}}),
        (1e300, {"size": lambda xy: np.full(len(xy), 1e100)}),
        (1.0, {"size": 1e200}),
    ):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(LimitError, match="range of doubles"):
                delone.mesh((points * scale, ring), **options)
    for scale in (1e300, 1e-300):
        mesh = delone.mesh((points * scale, ring), min_angle=33)
        assert mesh.nsimplex == 2


@pytest.mark.parametrize("k", [-1000, -920, -600, -300, 300, 600, 1000])
def test_sizes_of_any_magnitude(k: int) -> None:
    """Areas need not be doubles where lengths are."""
    unit, outline = 2.0**k, (np.array(SQUARE[0], dtype=float) * 2.0**k, SQUARE[1])

    def graded(places: Any) -> Any:
        return 0.1 + places[:, 0] / 4

    for plain, scaled in (
        ({"size": 0.2}, {"size": 0.2 * unit}),
        ({"size": {0: 0.3}}, {"size": {0: 0.3 * unit}}),
        ({"size": graded}, {"size": lambda places: graded(places / unit) * unit}),
    ):
        expected = delone.mesh(SQUARE, **plain)
        found = delone.mesh(outline, **scaled)
        assert expected.nsimplex > 20
        assert np.array_equal(found.points, expected.points * unit)
        assert np.array_equal(found.simplices, expected.simplices)
        again = found.refine(size=scaled["size"])
        assert np.array_equal(again.points, found.points)


@pytest.mark.parametrize(
    "options", [{"max_area": "1"}, {"max_area": True}, {"min_angle": "20"}, {"min_angle": True}]
)
def test_what_is_no_number(options: dict[str, Any]) -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    with pytest.raises(DtypeError, match="must be a real number"):
        delone.mesh(square, **options)


def test_no_domain_and_no_inside() -> None:
    with pytest.raises(DtypeError, match="domain must be a ConstrainedDelaunay"):
        delone.mesh(None)
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    empty = delone.ConstrainedDelaunay(square, [(0, 2)], holes=[(3, 1), (1, 3)])
    with pytest.raises(InputError, match="holes removed all triangles"):
        delone.mesh(empty)
    whole = delone.ConstrainedDelaunay(square, [(0, 2)])
    with pytest.raises(InputError, match="without triangles"):
        delone.mesh(whole, size=(empty, [1, 1, 1, 1]))


def test_a_function_is_asked_about_new_triangles() -> None:
    asked: list[np.ndarray] = []

    def size(xy: np.ndarray) -> np.ndarray:
        asked.append(xy.copy())
        return 0.03 + 0.2 * np.hypot(*(xy - 0.7).T)

    mesh = delone.mesh(SQUARE, size=size)
    # After the lattice and the estimate, each round asks about its new triangles.
    rounds = asked[2:]
    assert kept(mesh, size)
    assert len(rounds) > 3
    together = np.concatenate(rounds)
    # The others are where a triangle came back, or was left with its corners in another order.
    assert len(np.unique(together, axis=0)) > 0.95 * len(together)
    centers = (mesh.points[mesh.simplices] / 3).sum(axis=1)
    assert {tuple(xy) for xy in centers.tolist()} <= {tuple(xy) for xy in together.tolist()}


def test_an_exception_of_a_function_ends_the_rounds() -> None:
    calls = 0

    def size(xy: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        if calls == 5:
            raise ZeroDivisionError
        return np.full(len(xy), 0.05)

    with pytest.raises(ZeroDivisionError):
        delone.mesh(SQUARE, size=size)
    assert calls == 5


@pytest.mark.parametrize("gap", [1e-5, 1e-7])
def test_needles_stay_closed_while_sizes_vary(gap: float) -> None:
    hole = [(0.2, 0.5), (0.8, 0.5), (0.8, 0.5 + 1e-7), (0.2, 0.5 + 2e-7)]
    below = [(0.3, 0.5 - gap), (0.7, 0.5 - gap), (0.5, 0.3)]
    ends = [[(i, (i + 1) % n) for i in range(n)] for n in (4, 4, 3)]
    segments = [(i + k, j + k) for k, ring in zip((0, 4, 8), ends, strict=True) for i, j in ring]
    domain = [*SQUARE[0], *hole, *below], segments
    mesh = delone.mesh(domain, size=lambda xy: 0.07 + 0.1 * xy[:, 0], max_points=200_000)
    # With angles of 20 degrees everywhere in the gap, there would be hundreds of thousands.
    assert mesh.nsimplex < 3000
    assert not mesh.report.exhausted


@pytest.mark.parametrize("max_points", [10, 1000, 24_000])
def test_a_limit_that_the_sizes_exceed_is_an_error_before_the_work(max_points: int) -> None:
    square = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
    with pytest.raises(delone.BudgetExceededError, match="the sizes require about"):
        delone.mesh(square, max_area=2e-5, max_points=max_points)
