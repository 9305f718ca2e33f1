"""Small contours are left out; small polygons become part of the one around them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from delone import InputError
from delone.terrain import TIN

shapely = pytest.importorskip("shapely")


def bumps(seed: int, **options) -> TIN:
    """A slope with rough ground: closed contours of all sizes, also in each other."""
    rng = np.random.default_rng(seed)
    xy = np.concatenate(([(0, 0), (100, 0), (100, 100), (0, 100)], rng.uniform(0, 100, (2500, 2))))
    x, y = xy.T
    z = x / 20 + 6 * np.sin(x / 7) * np.cos(y / 9) + rng.normal(0, 0.6, len(xy))
    return TIN.from_points(np.column_stack((xy, z)), **options)


@pytest.mark.parametrize("seed", range(3))
def test_closed_lines_around_small_areas_are_left_out(seed):
    tin = bumps(seed)
    every, some = (tin.contours(interval=1, min_area=least) for least in (0, 12.5))
    areas = [
        abs(shapely.Polygon(every.coordinates(k)).area) if every.closed[k] else math.inf
        for k in range(len(every))
    ]
    kept = [k for k, area in enumerate(areas) if area >= 12.5]
    assert 0 < len(kept) < len(every) and some.small == len(every) - len(kept) and some.short == 0
    assert [some.coordinates(row).tolist() for row in range(len(some))] == [
        every.coordinates(k).tolist() for k in kept
    ]
    assert some.index.tolist() == every.index[kept].tolist()
    both = tin.contours(interval=1, min_area=12.5, min_length=30)
    assert (both.small, len(both) + both.short + both.small) == (some.small, len(every))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("least", [0.5, 12.5, 200.0])
def test_polygons_tile_the_surface_as_before(seed, least):
    tin = bumps(seed)
    every, some = tin.bands(interval=1), tin.bands(interval=1, min_area=least)
    before, after = every.to_shapely(), some.to_shapely()
    assert some.small == len(every) - len(some) > 0
    assert shapely.is_valid(after).all() and shapely.coverage_is_valid(after)
    assert shapely.area(after).sum() == pytest.approx(shapely.area(before).sum(), rel=1e-12)
    # No hole is smaller, and what remains is larger or as it was.
    holes = [shapely.Polygon(ring).area for each in after for ring in each.interiors]
    assert min(holes, default=math.inf) >= least
    tree = shapely.STRtree(after)
    for polygon, low in zip(before, every.low, strict=True):
        (row,) = tree.query(polygon.representative_point(), predicate="within")
        assert shapely.relate_pattern(polygon, after[row], "T*F**F***")
        # What has another range is inside a hole that was small.
        if some.low[row] != low:
            assert polygon.area < least


def test_holes_of_the_surface_stay():
    ring = [(48, 48), (52, 48), (52, 52), (48, 52)]
    hill = [(0, 0, 0), (100, 0, 0), (100, 100, 0), (0, 100, 0), (50, 60, 9)]
    square = [(40, 40, 8), (60, 40, 8), (60, 60, 8), (40, 60, 8)]
    tin = TIN.from_points([*hill[:4], *square], holes=[ring])
    found = tin.bands([4], min_area=1e6)
    # The upper part has the hole of the surface in it.
    assert len(found) == 2 and found.small == 0
    assert sum(polygon.area for polygon in found.to_shapely()) == pytest.approx(10_000 - 16)
    whole = TIN.from_points([*hill[:4], *square]).bands([4], min_area=1e6)
    assert len(whole) == 1 and whole.small == 1 and whole.low.tolist() == [0]
    assert whole.to_shapely()[0].area == pytest.approx(10_000)


@pytest.mark.parametrize("what", ["contours", "bands"])
@pytest.mark.parametrize("least", [-1, math.nan, math.inf])
def test_measures_out_of_range(what, least):
    with pytest.raises(InputError, match="min_area must be at least 0 and finite"):
        getattr(bumps(0), what)(interval=1, min_area=least)
