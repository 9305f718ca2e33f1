"""Simplification: errors against fractions, the order against a search, lines and outlines."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from delone import DegenerateInputError, InputError
from delone.interpolate import Grid
from delone.io import LeftOutWarning
from delone.terrain import TIN


def distance(point, corners):
    """The exact vertical distance of a point from a triangle; None outside it."""
    p = [Fraction(v) for v in point]
    a, b, c = ([Fraction(v) for v in corner] for corner in corners)

    def area(u, v, w):
        return (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0])

    parts = [area(p, b, c), area(a, p, c), area(a, b, p)]
    if min(parts) < 0:
        return None
    z = sum(part * corner[2] for part, corner in zip(parts, (a, b, c), strict=True)) / sum(parts)
    return abs(z - p[2])


def distances(points, tin):
    """The exact distance of each point from a surface; fails if one is outside."""
    corners = tin.xyz[tin.simplices].tolist()
    found = []
    for point in points.tolist():
        own = (distance(point, each) for each in corners)
        found.append(next(each for each in own if each is not None))
    return found


def lattice(seed=0, side=9, high=6):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(side), np.arange(side))
    return np.column_stack((x.ravel(), y.ravel(), rng.integers(0, high, side**2))).astype(float)


def scattered(seed=1, count=60):
    rng = np.random.default_rng(seed)
    xy = rng.random((count, 2)) * 10
    return np.column_stack((xy, np.sin(xy[:, 0]) * np.cos(xy[:, 1] / 2)))


def cliff():
    xyz = lattice(2, high=1)
    xyz[:, 2] = np.where(xyz[:, 0] + xyz[:, 1] > 7, 10.0, 0.0)
    return xyz


def survey():
    """Decimal coordinates far from the origin."""
    xyz = lattice(3, high=40)
    return np.round(xyz * [0.37, 0.41, 0.1] + [512_000.13, 5_400_000.27, 80.0], 2)


SURFACES = {
    "lattice": lattice(),
    "scattered": scattered(),
    "cliff": cliff(),
    "plateau": lattice(4, high=2),
    "survey": survey(),
    "needles": scattered(5) * [1, 1e-9, 1],
    "large": scattered(6) * [1e150, 1e150, 1e140],
    "small": scattered(7) * [1e-150, 1e-150, 1e-200],
}


@pytest.mark.parametrize("name", SURFACES)
def test_each_level_keeps_its_error(name):
    xyz = SURFACES[name]
    tin = TIN.from_points(xyz, planar=True)
    levels = tin.simplification(max_error=0)
    assert levels.errors[-1] == 0
    assert len(levels.fixed) + len(levels.order) <= tin.npoints
    for k in range(0, len(levels), 11):
        error = float(levels.errors[k])
        rows = np.concatenate((levels.fixed, levels.order[:k]))
        surface = TIN.from_points(tin.xyz[rows], planar=True)
        exact = max(distances(tin.xyz, surface))
        assert exact <= Fraction(error)
        assert float(exact) >= error * (1 - 1e-12)
        assert surface.nsimplex == levels.triangles[k]
        assert levels.validate(max_error=error)
        below = levels.errors[: k + 1].min()
        assert levels.surface(max_error=error).npoints <= len(rows) or below > error


@pytest.mark.parametrize("name", ["lattice", "cliff", "plateau"])
def test_the_order_is_that_of_a_search(name):
    tin = TIN.from_points(SURFACES[name])
    levels = tin.simplification(max_triangles=30)
    rows = levels.fixed.tolist()
    for k, row in enumerate(levels.order.tolist()):
        surface = TIN.from_points(tin.xyz[rows])
        exact = distances(tin.xyz, surface)
        worst = max(exact)
        # Rounded upwards, and only where the exact error is no double.
        error = Fraction(float(levels.errors[k]))
        assert worst == error if worst.denominator == 1 else worst <= error
        ties = [tuple(tin.points[i]) for i in range(tin.npoints) if exact[i] == worst]
        assert tuple(tin.points[row]) == min(ties)
        rows.append(row)


@pytest.mark.parametrize("name", SURFACES)
def test_the_order_of_rows_changes_nothing(name):
    xyz = SURFACES[name]
    first = TIN.from_points(xyz, planar=True).simplification(max_error=0)
    for seed in range(3):
        mixed = np.random.default_rng(seed).permutation(xyz)
        other = TIN.from_points(mixed, planar=True).simplification(max_error=0)
        assert (other.errors == first.errors).all()
        assert (other.points[other.order] == first.points[first.order]).all()


def lined(**options):
    xyz = lattice(8, side=13)
    dike = [(1, 1, 9), (11, 4, 9), (6, 11, 9)]
    track = [(2, 10, 3), (3, 3, 0)]
    hole = [(7, 5), (9, 5), (9, 7), (7, 7)]
    return TIN.from_points(
        xyz,
        breaklines=[dike],
        soft_breaklines=[track],
        holes=[hole],
        duplicates="max",
        crossing="max",
        **options,
    )


def edges(tin, rows):
    return {frozenset(map(tuple, tin.xyz[edge].tolist())) for edge in rows}


@pytest.mark.parametrize("keep", ["breaklines", "hard", "boundary"])
def test_lines_and_outlines_stay(keep):
    tin = lined()
    assert tin.simplification(max_error=0.5, keep=keep).validate(max_error=0.5)
    for error in (5, 2, 0.5):
        small = tin.simplify(max_error=error, keep=keep)
        assert small.validate()
        inside = tin.xyz[np.unique(tin.simplices)]
        assert max(distances(inside, small)) <= error
        assert small.areas.sum() == pytest.approx(tin.areas.sum(), rel=1e-12)
        kept = edges(small, small.breaklines)
        if keep == "breaklines":
            assert kept == edges(tin, tin.breaklines)
            hard = edges(small, small.breaklines[small.soft])
            assert hard == edges(tin, tin.breaklines[tin.soft])
        elif keep == "hard":
            assert edges(tin, tin.breaklines[~tin.soft]) <= kept
            assert not edges(tin, tin.breaklines[tin.soft]) & kept
        else:
            assert kept < edges(tin, tin.breaklines)
            assert len(kept) >= 8
    coarse = [tin.simplify(max_error=20, keep=each) for each in ("breaklines", "hard", "boundary")]
    assert coarse[0].nsimplex > coarse[1].nsimplex >= coarse[2].nsimplex


def test_an_outline_without_lines_stays():
    xyz = scattered(9, 300)
    xyz = xyz[np.hypot(xyz[:, 0] - 5, xyz[:, 1] - 5) > 2]
    tin = TIN.from_points(xyz, max_edge=1.5, voids=True)
    assert len(tin._left_out())
    assert tin.simplification(max_error=0.3).validate(max_error=0.3)
    small = tin.simplify(max_error=0.3)
    assert small.npoints < tin.npoints
    assert small.validate()
    assert small.areas.sum() == pytest.approx(tin.areas.sum(), rel=1e-12)
    assert max(distances(tin.xyz[np.unique(tin.simplices)], small)) <= 0.3


def test_levels_by_triangles_have_the_least_error():
    levels = TIN.from_points(scattered()).simplification(max_error=0)
    for most in (20, 50, 80):
        small = levels.surface(max_triangles=most)
        assert small.nsimplex <= most
        possible = levels.errors[levels.triangles <= most].min()
        exact = max(distances(levels.points, small))
        assert exact <= Fraction(float(possible))
    assert TIN.from_points(scattered()).simplify(max_triangles=50).nsimplex <= 50


def bumps():
    x, y = np.arange(40.0), np.arange(30.0)
    values = np.hypot(x - 20, (y - 10)[:, None])
    values[3, 4] = values[29, 39] = np.nan
    return Grid(values, x, y)


def rows(tin):
    return sorted(map(tuple, tin.xyz.tolist()))


def test_rasters_need_no_full_triangulation():
    full = TIN.from_raster(bumps())
    for goal in ({"max_error": 0.3}, {"max_triangles": 60}):
        found = TIN.from_raster(bumps(), crs="EPSG:28992", units="m", **goal)
        assert rows(found) == rows(full.simplify(**goal))
        assert found.validate() and (found.crs, found.units) == ("EPSG:28992", "m")
    fine = [(5, 5, 40), (30, 20, 40)]
    lined = {"breaklines": [fine], "crossing": "max", "duplicates": "max"}
    found = TIN.from_raster(bumps(), max_error=0.3, **lined)
    assert rows(found) == rows(TIN.from_raster(bumps(), **lined).simplify(max_error=0.3))


@pytest.mark.parametrize("step", [1.0, 0.37])
def test_rasters_with_missing_nodes_are_simplified_as_their_points(step):
    """Rows from north to south, missing corners, and steps that are decimals."""
    rng = np.random.default_rng(3)
    heights = rng.integers(0, 9, (17, 23)).astype(float)
    heights[rng.random(heights.shape) < 0.2] = np.nan
    heights[:4, :5] = heights[-1, -6:] = np.nan
    x, y = np.arange(23) * step + 512_000, np.arange(17)[::-1] * step + 5_400_000
    nodes = np.column_stack([each.ravel() for each in (*np.meshgrid(x, y), heights)])
    nodes = nodes[~np.isnan(nodes[:, 2])]
    whole = TIN.from_points(rng.permutation(nodes), planar=True)
    for error in (4, 1.5, 0):
        found = TIN.from_raster(Grid(heights[::-1], x, y[::-1]), max_error=error, planar=True)
        other = whole.simplify(max_error=error)
        order = [np.lexsort(tin.xyz.T) for tin in (found, other)]
        assert np.array_equal(found.xyz[order[0]], other.xyz[order[1]])
        assert max(distances(nodes, found)) <= error


def test_surfaces_of_corners_alone_stay():
    corners = [(0, 0, 1), (2, 0, 2), (2, 2, 5)]
    for points in (corners, [*corners, (0, 2, 3)]):
        tin = TIN.from_points(points)
        assert rows(tin.simplify(max_error=0)) == rows(tin)
    square = Grid(np.arange(4.0).reshape(2, 2), np.arange(2.0), np.arange(2.0))
    assert TIN.from_raster(square, max_error=1).npoints == 4


@pytest.mark.parametrize("goal", [{}, {"max_error": 1}, {"max_triangles": 9}])
def test_nodes_on_one_line_are_all_named(goal):
    raster = Grid(np.zeros((5, 4)), np.arange(4.0), np.arange(5.0))
    for bounds, count in (((1, 1, 1, 3), 3), ((0, 2, 3, 2), 4)):
        with pytest.raises(DegenerateInputError, match=f"all {count} distinct points") as caught:
            TIN.from_raster(raster, bounds=bounds, planar=True, **goal)
        assert caught.value.chain.tolist() == list(range(count))


def test_files_of_rasters(tmp_path):
    path = tmp_path / "dem.asc"
    head = "ncols 3\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 2\nNODATA_value -9999\n"
    path.write_text(head + "1 2 3\n4 -9999 6\n")
    with pytest.warns(LeftOutWarning, match="1 cell"):
        tin = TIN.from_raster(path)
    assert rows(tin) == [(11, 21, 4), (11, 23, 1), (13, 23, 2), (15, 21, 6), (15, 23, 3)]
    with pytest.warns(LeftOutWarning):
        assert TIN.from_raster(str(path), max_error=0.5).npoints == 4
    with pytest.warns(LeftOutWarning), pytest.raises(InputError, match="give one of"):
        TIN.from_raster(path, max_error=1, max_triangles=2)
    with pytest.raises(InputError, match="band and step are for files"):
        TIN.from_raster(bumps(), step=2)


def test_units_and_systems_are_kept():
    tin = TIN.from_points(lattice(), crs="EPSG:28992", units="m")
    small = tin.simplify(max_error=1)
    assert (small.crs, small.units) == (tin.crs, "m")


def test_validation_finds_a_point_above_the_limit():
    levels = TIN.from_points(lattice()).simplification(max_error=1)
    coarse = levels.validate(max_triangles=2)
    assert coarse
    left = np.setdiff1d(np.arange(81), np.append(levels.fixed, levels.order))[0]
    levels.points.flags.writeable = True
    levels.points[left, 2] += 100
    found = levels.validate(max_error=1)
    assert not found
    assert (np.append(levels.fixed, levels._ground.free)[found.above] == left).all()
    assert "1 above 1" in repr(found)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "give one of max_error and max_triangles"),
        ({"max_error": 1, "max_triangles": 9}, "give one of max_error and max_triangles"),
        ({"max_error": -1}, "at least 0 and finite, got -1"),
        ({"max_error": np.nan}, "at least 0 and finite, got nan"),
        ({"max_error": np.inf}, "at least 0 and finite, got inf"),
        ({"max_triangles": 0}, "max_triangles must be an integer of at least 1"),
        (
            {"max_triangles": 1},
            "max_triangles=1 is below the 2 triangles of lines",
        ),
        ({"max_error": 1, "keep": "lines"}, "keep"),
    ],
)
def test_bad_goals_are_refused(options, message):
    tin = TIN.from_points(lattice())
    with pytest.raises(InputError, match=message):
        tin.simplify(**options)


def test_levels_that_do_not_exist_are_refused():
    levels = TIN.from_points(lattice()).simplification(max_error=1)
    with pytest.raises(InputError, match="below the error of the finest level"):
        levels.surface(max_error=0.1)
    with pytest.raises(InputError, match="below the 2 triangles"):
        levels.surface(max_triangles=1)


def test_errors_are_rounded_upwards():
    third = TIN.from_points([(0, 0, 0), (3, 0, 0), (0, 3, 1), (1, 1, 0)])
    error = float(third.simplification(max_error=1).errors[0])
    assert Fraction(error) > Fraction(1, 3) > Fraction(np.nextafter(error, 0).item())


@pytest.mark.parametrize("steps", [0, 1, 2, 3])
def test_errors_as_small_as_the_least_double(steps):
    """Bounds are rounded up, but not above the error that was asked for."""
    random = np.random.default_rng(5)
    least = np.finfo(float).smallest_subnormal
    points = np.column_stack((random.random((200, 2)), random.integers(0, 4, 200) * least))
    tin = TIN.from_points(points)
    error = float(steps * least)
    simple = tin.simplify(max_error=error)
    assert max(distances(points, simple)) <= Fraction(error)
    assert simple.npoints < 150 or steps == 0
    levels = tin.simplification(max_error=error)
    assert levels.errors.min() <= error and levels.validate(max_error=error)


@pytest.mark.filterwarnings("error")
def test_errors_beyond_the_doubles():
    points = np.array([(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1), (1, 2, -1), (3, 2, -1.0)])
    points[:, 2] *= 1.7e308
    levels = TIN.from_points(points).simplification(max_error=0)
    assert levels.errors[0] == np.inf and levels.errors[-1] == 0
