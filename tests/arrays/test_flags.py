"""Truth values of the public interface are True and False, and nothing that counts as one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import (
    ConstrainedDelaunay,
    Delaunay,
    DtypeError,
    Voronoi,
    datasets,
    from_geometry,
    interpolate,
    io,
    lawson,
    mesh,
)
from delone.plot import plot, plot_raster
from delone.testing import assert_constrained_delaunay, assert_delaunay

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

POINTS, SPACE = datasets.uniform(12), datasets.uniform(12, ndim=3)
FLAT, SOLID = Delaunay(POINTS), Delaunay(SPACE)
SEGMENTED = ConstrainedDelaunay(POINTS, [])
SQUARE = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
RAMP = interpolate.grid(POINTS, POINTS[:, 0], shape=(4, 4))


def drawn(**options: Any) -> Any:
    return plot(FLAT, z=POINTS[:, 0], **options)


def relief(**options: Any) -> Any:
    return plot_raster(RAMP.values, RAMP.x, RAMP.y, **options)


TAKEN: list[tuple[str, Callable[..., Any]]] = [
    ("conforming", lambda **flag: ConstrainedDelaunay(POINTS, [(0, 1)], **flag)),
    ("conforming", lambda **flag: from_geometry(SQUARE, **flag)),
    ("conforming", lambda **flag: mesh(SQUARE, **flag)),
    ("delaunay", lambda **flag: mesh(SQUARE, **flag)),
    ("record", lambda **flag: lawson(POINTS, FLAT.simplices, **flag)),
    ("fix", lambda **flag: Voronoi(POINTS, **flag)),
    ("fix", lambda **flag: Voronoi(SPACE, **flag)),
    ("respect_constraints", lambda **flag: interpolate.Linear(SEGMENTED, **flag)),
    ("respect_constraints", lambda **flag: interpolate.NaturalNeighbor(POINTS, **flag)),
    ("canonical", lambda **flag: assert_delaunay(POINTS, FLAT.simplices, **flag)),
    ("complete", lambda **flag: assert_constrained_delaunay(SEGMENTED, [], **flag)),
    ("split", lambda **flag: assert_constrained_delaunay(SEGMENTED, [], **flag)),
    ("canonical", lambda **flag: assert_constrained_delaunay(SEGMENTED, [], **flag)),
]
PICTURES: list[tuple[str, Callable[..., Any]]] = [
    ("hull", drawn),
    ("circumcircles", drawn),
    ("segments", drawn),
    ("colorbar", drawn),
    ("colorbar", lambda **flag: Voronoi(POINTS).plot(**flag)),
    ("colorbar", relief),
]
OPEN: list[tuple[str, Callable[..., Any]]] = [
    ("vertices", drawn),
    ("shade", drawn),
    ("shade", relief),
    ("points", lambda **flag: Voronoi(POINTS).plot(**flag)),
]


@pytest.mark.parametrize("bad", ["a", "", None, 1, 0.0, [], np.ones(2, dtype=bool)])
@pytest.mark.parametrize(("name", "call"), TAKEN)
def test_nothing_else_is_true_or_false(name: str, call: Callable[..., Any], bad: Any) -> None:
    with pytest.raises(DtypeError, match=f"{name} must be True or False"):
        call(**{name: bad})


@pytest.mark.parametrize(("name", "call"), PICTURES)
def test_of_pictures_either(name: str, call: Callable[..., Any]) -> None:
    pytest.importorskip("matplotlib")
    for bad in ("a", None, 1):
        with pytest.raises(DtypeError, match=f"{name} must be True or False"):
            call(**{name: bad})


@pytest.mark.parametrize(("name", "call"), OPEN)
def test_what_may_be_left_open(name: str, call: Callable[..., Any]) -> None:
    pytest.importorskip("matplotlib")
    for bad in ("a", 1):
        with pytest.raises(DtypeError, match=f"{name} must be True, False or None"):
            call(**{name: bad})


def test_files(tmp_path: Path) -> None:
    for bad in ("a", None, 1):
        with pytest.raises(DtypeError, match="edges must be True or False"):
            io.write_mesh(tmp_path / "a.npz", FLAT, edges=bad)
    assert not list(tmp_path.iterdir())


def test_plots_in_3d() -> None:
    pytest.importorskip("pyvista")
    for name in ("points", "colorbar"):
        with pytest.raises(DtypeError, match=f"{name} must be True or False"):
            plot(SOLID, **{name: "a"})
    with pytest.raises(DtypeError, match="off_screen must be True, False or None"):
        plot(SOLID, off_screen="a")  # type: ignore[arg-type]


def test_cross_validation() -> None:
    with pytest.raises(DtypeError, match="leave_one_out must be True, False or None"):
        interpolate.cross_validate(POINTS, POINTS[:, 0], leave_one_out="a")  # type: ignore[arg-type]


def test_numpy_has_truth_values_too() -> None:
    segments = [(0, 1), (2, 3)]
    added = [
        ConstrainedDelaunay(POINTS, segments, crossing="split", conforming=flag).nadded
        for flag in (False, True, np.bool_(True), np.bool_(False))
    ]
    assert added[0] == added[3] < added[1] == added[2]
