"""No rounded measure decides what belongs where: comparisons of measures are listed with reasons.

A test cannot know what a comparison decides, but it sees where a length, an area, a distance, a
product or a small number is compared. Such a place is either here, with what makes it harmless, or
it is new and this test fails: decide by predicates, by integers, or by a flood over edges, or add
the reason.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "python" / "delone"
# Pictures and data decide nothing; oracles and their tests are in fractions or for people to read.
LEFT_OUT = ("plot", "datasets", "reference", "testing", "explorer")
MEASURES = (
    "area", "barycentric", "center", "closeness", "cross(", "distance", "dot(", "hypot", "length",
    "mean(", "norm(", "perimeter", "square", "volume", "_EPS", "_WIDTH", "1e-", "2.0 ** (-",
)  # fmt: skip

# What makes a comparison harmless.
EXACT = "integers, fractions or the core's exact answer"
FILTER = "a rounded number that only chooses what is compared exactly"
WANTED = "the caller's limit on a measure, whose result is a value or a report"
CHECK = "a check of arguments, or of what is there"
WARNED = "a warning, which changes no result"
EMPTY = "a cell of which nothing is left, whose measure is exactly 0"
DRAWN = (
    "a figure made of planes and slopes, which is rounded by nature and meets the ground by floods"
)
VALUE = "a step of a numerical method, which changes values and not what is joined to what"

ALLOWED: dict[str, dict[str, str]] = {
    "_tiling/higher/thin.py": {"distance <= _ROUNDINGS * (np.abs(vectors) @ unit)": WARNED},
    # An error, where holes and parts share more than a rounding error.
    "areal/nested.py": {
        "shared.areas >= (1 - _SHARED) * known.areas[hole]": WANTED,
        "shared.areas[chosen] > _SHARED * small": WANTED,
    },
    "areal/shared.py": {"areas > 0": EMPTY},
    "cli/areal.py": {"areas > 0": EMPTY},
    "_tiling/archive/directions.py": {"areas > 0": CHECK},
    "cli/show.py": {"area < 1000000.0": CHECK},
    "compat/interpolate.py": {
        "len(lengths) > 1": CHECK,
        "distance < distance_upper_bound": WANTED,
    },
    "compat/scipy_delaunay.py": {"min(_barycentric(corners, flat[row])) >= -limit": EXACT},
    "compat/scipy_sphere.py": {
        "self._squares.min() <= tolerance ** 2": WANTED,
        "self._squares < (_CLOSE * self.radius) ** 2": WANTED,
    },
    "compat/triangle_input.py": {
        "found.areas > (1 + 1e-12) * _allowed(tri, found, base, switches)": WANTED,
    },
    "constrained/polygons.py": {
        "abs(twice) > 2.0 ** (-50) * len(ring) * (len(ring) + 4)": FILTER,
    },
    "distributed/pure/certify.py": {"np.hypot(*off.T) * (1 - 1e-14) > radius": FILTER},
    "graphs/lengths.py": {
        "lengths < at_rank - slack": FILTER,
        "lengths > at_rank + slack": FILTER,
    },
    "interpolate/beyond.py": {"gap <= 4 * _EPS * size * np.linalg.norm(place)": VALUE},
    "interpolate/accessor.py": {"sites.made.distance(queries) <= sites.limit": WANTED},
    "interpolate/base.py": {"interpolator._distance(queries) <= limit": WANTED},
    "interpolate/repeated.py": {
        "center[:, axis] >= low[axis]": FILTER,
        "center[:, axis] <= high[axis]": FILTER,
        "along > low + length": FILTER,
    },
    "io/las.py": {
        "sum((int(length) for _, length in held)) > size": EXACT,
        "before + 4 * layers + int(sizes.sum(dtype=np.int64)) > length": EXACT,
        "length > 0": EXACT,
    },
    "io/landxml_survey.py": {"np.hypot(*away) <= max(_GAP, _SAME * length)": CHECK},
    "_tiling/location.py": {
        "distance + error <= limit": FILTER,
        "distance - error > limit": FILTER,
        "_squared_distance(_exact(queries[row]), exact) <= Fraction(limit) ** 2": EXACT,
    },
    "periodic.py": {"spread >= Fraction(length)": EXACT, "0 < length < np.inf": CHECK},
    "refine/report.py": {
        "np.hypot(*(points[u] - points[v]).T) < np.minimum(d, e)": WANTED,
    },
    "compat/tetgen_switches.py": {"volume <= 0": CHECK},
    # Where sizes are asked for at further positions.
    "solids/tetmesh/lengths.py": {"np.linalg.norm(ends, axis=2).max(axis=1) > self._large": WANTED},
    "sphere/circle.py": {"x * abs(x) * dot(b, b) > y * abs(y) * dot(a, a)": EXACT},
    "sphere/clipping.py": {
        # Documented: parts narrower than 2e-15 come from rounded vertices.
        "area < _WIDTH / 2 * perimeter": WANTED,
        "total > _WIDTH": WANTED,
        "lengths > _LONGEST": VALUE,
    },
    "sphere/crossings.py": {"value > 2.0 ** (-44)": FILTER},
    # Of two directions on one meridian, whether they are on the same side of the axis: sums of
    # products with one sign.
    "sphere/flat.py": {"np.dot(tail[:2], head[:2]) > 0": EXACT, "each.area > 0": EMPTY},
    # Documented: the report of cells that overlap, of which none is changed.
    "sphere/grid_cells.py": {"found.areas > _SHARED * small": WANTED},
    # Documented: rings around rounding errors are counted apart.
    "sphere/holes.py": {
        "abs(size(row[::-1])) <= ROUNDING * areas[beside].min()": WANTED,
        "abs(area) > NARROW / 2 * around": WANTED,
    },
    "sphere/interpolation.py": {"owner._distance(xi) <= limit": WANTED},
    # Documented: the caller asks for the smaller side, and sides of rings decide within _HALF of
    # half the sphere; else the result is a warning.
    "sphere/land.py": {
        "np.abs(area - 2 * math.pi) < _HALF": WANTED,
        "area > 2 * math.pi": WANTED,
        "area > 2 * math.pi + _HALF": WANTED,
    },
    # Documented: a warning of several cells above half the sphere.
    "sphere/large.py": {
        "part.area > 2 * np.pi + _HALF": WANTED,
        "areas > _BROAD": WANTED,
        "areas > 0": EMPTY,
    },
    "sphere/maps.py": {"areas[1][rows] > 0": EMPTY},
    "sphere/moments.py": {
        "grid.areas > 0": EMPTY,
        "np.abs(new - u) <= 2.0 ** (-52)": VALUE,
    },
    "sphere/nearby.py": {
        "dot(cross(normal, a), query) > 0": EXACT,
        "dot(cross(b, normal), query) > 0": EXACT,
    },
    # Documented: the report of holes counts corners within this limit of a side as on it, and
    # corners within it of each other as one; no cell is changed.
    "sphere/near_sides.py": {
        "gap * reach <= 2 * ROUNDING * area": WANTED,
        "size <= np.maximum(ROUNDING * area, width)": WANTED,
    },
    "sphere/outside.py": {
        "queries @ np.cross(normal, a).T > 0": VALUE,
        "queries @ np.cross(b, normal).T > 0": VALUE,
        "length > 0": VALUE,
    },
    "sphere/second_order.py": {
        # Two expressions of one moment, equal but for roundings.
        "np.abs(covered - source.areas) <= _ROUNDING * source.areas": VALUE,
        "source.areas > 0": EMPTY,
        # Slivers whose centroids are roundings.
        "areas < 1e-09 * whole": VALUE,
    },
    "sphere/vectors.py": {"owner._distance(xi) <= limit": WANTED},
    "sphere/rings.py": {"areas > 0": EMPTY},
    "sphere/validation.py": {
        "dot(cross(normal, a), x) < 0": EXACT,
        "dot(cross(normal, b), x) > 0": EXACT,
    },
    "terrain/building.py": {
        "length > limit": FILTER,
        "np.abs(length - limit) <= limit * 2.0 ** (-48) + 2.0 ** (-1070)": FILTER,
    },
    "terrain/contouring.py": {
        "_lengths(points, starts) >= finish.min_length": WANTED,
        "np.abs(ring_areas(points, starts)) >= finish.min_area": WANTED,
    },
    "terrain/deviations.py": {
        "_distance(part.points[k], part.corners[k]) > Fraction(limit)": EXACT,
    },
    "terrain/filtering.py": {
        "np.hypot(*surface.gradients.T) > limits.tangent": WANTED,
        "seen.away <= limits.distance": WANTED,
        "other.away <= limits.distance": WANTED,
        "length < shortest": WANTED,
        "length > 0": CHECK,
    },
    "terrain/merging.py": {
        "np.hypot(*(places[a] - places[b]).T) < limit": WANTED,
        "distance < limit": WANTED,
    },
    "terrain/overlay.py": {
        "mesh.areas[off].sum() <= closeness(tin.points, pad.points) * length": DRAWN,
        "np.hypot(*normal.T) > limit": DRAWN,
    },
    "terrain/reshaping.py": {"mesh.areas <= closeness(mesh.points) * longest": DRAWN},
    # The last multiple is left out where the end is at the same station.
    "terrain/sections.py": {
        "length - every > _ROUNDING * length": VALUE,
        "length / step < _STATIONS": CHECK,
        "at <= length + slack": CHECK,
        # The ends of a part are among the distances.
        "distances >= at[0]": EXACT,
        "distances <= at[-1]": EXACT,
    },
    "terrain/small.py": {
        "np.abs(ring_areas(given.points, given.rings)) < least": WANTED,
    },
    "terrain/smoothing.py": {"simplex.barycentric < 1e-09": VALUE},
    "terrain/snapping.py": {"way < length - limit": DRAWN},
    "terrain/volumes.py": {"area > 0": EMPTY},
    "_base/units.py": {"abs(length - meters) <= _SAME * length": CHECK},
    "voronoi/dual.py": {"square > _SMALLEST": FILTER, "square < _LARGEST": FILTER},
    "voronoi/outline.py": {"shapely.area(in_units) > 0": CHECK},
    "voronoi/overlay.py": {
        "left - right > 2.0 ** (-50) * (np.abs(left) + np.abs(right))": FILTER,
    },
    # Documented: cells as thin as their rounding are named in a warning, and none is removed.
    "voronoi/space.py": {"areas > 0": EMPTY, "areas < _SMALL": WANTED},
    "_tiling/higher/spheres.py": {
        "np.abs(centers[t] - centers[u]) > size * _APART + _LEAST": FILTER,
    },
    "voronoi/thin.py": {
        "perimeters > 0": EMPTY,
        "areas[rows] > _ROUNDING * largest * perimeters[rows]": FILTER,
        "areas[rows] <= bound": WANTED,
    },
    "voronoi/torus.py": {"lengths > 0": CHECK},
}


def comparisons(path: Path) -> Iterator[tuple[int, str]]:
    """The comparisons of sizes with a measure in them."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Compare):
            continue
        if not all(isinstance(op, ast.Lt | ast.LtE | ast.Gt | ast.GtE) for op in node.ops):
            continue
        text = ast.unparse(node)
        plain = text.replace("len(", "").replace("minlength", "")
        if any(word in plain for word in MEASURES):
            yield node.lineno, text


def modules() -> list[str]:
    found = (path.relative_to(PACKAGE) for path in sorted(PACKAGE.rglob("*.py")))
    return [path.as_posix() for path in found if path.parts[0].removesuffix(".py") not in LEFT_OUT]


@pytest.mark.parametrize("module", modules())
def test_rounded_measures_decide_nothing(module: str) -> None:
    known = ALLOWED.get(module, {})
    found = list(comparisons(PACKAGE / module))
    new = [f"{module}:{line}: {text}" for line, text in found if text not in known]
    assert new == []
    # Nothing is listed that is not there any more.
    assert set(known) - {text for _, text in found} == set()
