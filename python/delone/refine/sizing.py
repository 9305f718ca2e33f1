"""How large triangles may be: numbers, regions, functions, backgrounds and rasters become areas.

A size is the length of an edge; the cap is the area of the equilateral triangle with that edge. A
size that varies is asked at the centres of triangles, round by round: no triangle is told to become
smaller than a quarter of itself at once, so that a small size at one place does not spread over a
large triangle. What lies between the centres of the first, large triangles is found by a lattice of
samples over the domain, which also tells beforehand about how many triangles there will be.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._arrays import as_number, as_workers
from delone.errors import BudgetExceededError, DtypeError, InputError, LimitError
from delone.plane import geometry
from delone.triangulation import Triangulation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.refine.domains import Domain

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["EQUILATERAL", "Sizing"]

EQUILATERAL = math.sqrt(3) / 4
# Samples along the longer side of the box of the domain.
_LATTICE = 128
# In one round a triangle is made smaller by this factor at most.
_STEP = 4.0
# Triangles have about this share of the cap on average.
_SHARE = 0.77


class Sizing:
    """The largest area that a triangle may have, by its place and its region.

    Parameters
    ----------
    max_area : float, mapping or None
        Areas; a mapping has them by region.
    size : float, mapping, callable, tuple, DataArray or None
        Lengths of edges; see `delone.mesh`.
    regions : ndarray of int32
        The regions that there are.
    unit : float, optional
        The power of two by which the coordinates of domains are divided; areas and places are in
        this unit, what callers give and are asked for is not.

    Raises
    ------
    LimitError
        A size is so small that its square is no double in that unit, or so large without one.
    InputError
        A number is NaN, zero or negative, or `size` is nothing of the kind.
    """

    def __init__(self, max_area: Any, size: Any, regions: Indices, unit: float = 1.0) -> None:
        self._by_region = np.full(len(regions), math.inf)
        self._evaluate: Callable[[Floats], Floats] | None = None
        self._unit = unit
        self._set(max_area, regions, "max_area", lambda area: area / unit / unit)
        if isinstance(size, Mapping) or size is None or _is_number(size):
            self._set(size, regions, "size", lambda length: _equilateral(length / unit))
        else:
            self._evaluate = _evaluator(size)

    def _set(self, given: Any, regions: Indices, name: str, area: Callable[[float], float]) -> None:
        if given is None:
            return
        if not isinstance(given, Mapping):
            self._by_region = np.minimum(self._by_region, self._cap(given, name, area))
            return
        unknown = sorted(set(given) - set(regions.tolist()))
        if unknown:
            known = ", ".join(map(str, regions[:10].tolist()))
            raise InputError(f"{name}: there is no region {unknown[0]!r}; there are {known}")
        for region, value in given.items():
            at = np.flatnonzero(regions == region)
            cap = self._cap(value, f"{name} of region {region}", area)
            self._by_region[at] = np.minimum(self._by_region[at], cap)

    def _cap(self, value: Any, name: str, area: Callable[[float], float]) -> float:
        number = _positive(value, name)
        cap = area(number)
        if cap == 0 or (self._unit == 1 and math.isinf(cap) and math.isfinite(number)):
            raise LimitError(_out_of_range(f"{name} {value!r}"))
        return cap

    @property
    def varies(self) -> bool:
        """Whether it differs from place to place within a region."""
        return self._evaluate is not None

    def _at(self, places: Floats, labels: Indices) -> Floats:
        """Areas allowed at places in parts of the domain."""
        caps = self._by_region[labels]
        if self._evaluate is None or not len(places):
            return caps
        asked = places * self._unit
        sizes = _checked(self._evaluate(asked), asked)
        with np.errstate(over="ignore", under="ignore"):
            areas = _equilateral(sizes / self._unit)
        # In a unit of their own all areas are below any that is infinite.
        large = np.isinf(areas) & np.isfinite(sizes) & (self._unit == 1)
        lost = np.flatnonzero((areas == 0) | large)
        if lost.size:
            raise LimitError(_out_of_range(f"size {sizes[lost[0]]} at {_place(asked[lost[0]])}"))
        found: Floats = np.minimum(caps, areas)
        return found

    def caps(self, domain: Domain, samples: Samples | None = None) -> tuple[Floats, bool]:
        """Return what each triangle of a domain may become in the next round.

        Parameters
        ----------
        domain : Domain
            The triangles.
        samples : Samples, optional
            Where else to look than at the centres of triangles.

        Returns
        -------
        caps : ndarray of float64, shape (m,)
            Areas; infinite outside.
        done : bool
            Whether no triangle is too large.
        """
        inside = np.flatnonzero(domain.labels >= 0)
        labels = domain.labels[inside]
        caps = np.full(len(domain.labels), math.inf)
        if not self.varies:
            caps[inside] = self._by_region[labels]
            return caps, False
        areas = geometry.areas(domain.points, domain.simplices[inside])
        wanted = self._at(_centres(domain, inside), labels)
        if samples is not None:
            wanted = np.minimum(wanted, samples.least(domain)[inside])
        large = areas > wanted
        caps[inside[large]] = np.maximum(wanted, areas / _STEP)[large]
        return caps, not large.any()

    def samples(self, domain: Domain, workers: int | None) -> Samples | None:
        """Ask for sizes on a lattice over a domain; None where sizes do not vary."""
        return Samples(self, domain, workers) if self.varies else None

    def estimate(self, domain: Domain, samples: Samples | None) -> float:
        """Return about how many triangles the sizes ask for, without those for angles.

        Parameters
        ----------
        domain : Domain
            The triangles as they are.
        samples : Samples, optional
            Where else to look than at the centres of triangles.

        Returns
        -------
        float
            A number of triangles.
        """
        inside = np.flatnonzero(domain.labels >= 0)
        areas = geometry.areas(domain.points, domain.simplices[inside])
        caps = self._at(_centres(domain, inside), domain.labels[inside])
        if not np.isfinite(areas[np.isfinite(caps)]).all():
            raise LimitError(_out_of_range("the area of the domain"))
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            inverse = 1 / caps
            if samples is not None:
                inverse = samples.mean_inverse(domain, inside, inverse)
            # An area without a cap counts nothing, be it infinite.
            return float(np.where(inverse > 0, areas * inverse, 0).sum()) / _SHARE

    def require_within(self, domain: Domain, samples: Samples | None, max_points: int) -> None:
        """Refuse sizes that no mesh with so few points can have.

        Parameters
        ----------
        domain : Domain
            The triangles as they are.
        samples : Samples or None
            Further places.
        max_points : int
            How many points may be added.

        Raises
        ------
        BudgetExceededError
            Even if each triangle were as large as it may be, there would be too many.
        """
        triangles = self.estimate(domain, samples)
        least = triangles * _SHARE / 2 - len(domain.points)
        if least > max_points:
            about = max(triangles / 2 - len(domain.points), 0)
            raise BudgetExceededError(
                f"the sizes ask for about {_rounded(triangles)} triangles, so for about "
                f"{_rounded(about)} points to be added, more than the {max_points:,} of max_points",
                limit=max_points,
                found=int(min(least, 2**62)),
            )


class Samples:
    """Areas allowed at places of a lattice over a domain.

    Parameters
    ----------
    sizing : Sizing
        What is asked.
    domain : Domain
        Where.
    workers : int or None
        Threads.
    """

    def __init__(self, sizing: Sizing, domain: Domain, workers: int | None) -> None:
        self._workers = as_workers(workers)
        inside = domain.points[np.unique(domain.simplices[domain.labels >= 0])]
        low, high = inside.min(axis=0), inside.max(axis=0)
        step = float((high - low).max()) / _LATTICE
        axes = [
            a + (np.arange(max(1, math.ceil((b - a) / step))) + 0.5) * step
            for a, b in zip(low.tolist(), high.tolist(), strict=True)
        ]
        x, y = (grid.ravel() for grid in np.meshgrid(*axes))
        self._places = np.column_stack((x, y))
        triangle = self._triangles(domain)
        kept = (triangle >= 0) & (domain.labels[triangle] >= 0)
        self._places = np.ascontiguousarray(self._places[kept])
        self._areas = sizing._at(self._places, domain.labels[triangle[kept]])

    def _triangles(self, domain: Domain) -> Indices:
        return _core.find_simplex2(
            domain.points, domain.simplices, domain.neighbors, self._places, self._workers
        )

    def least(self, domain: Domain) -> Floats:
        """Return the least area allowed in each triangle, infinite where there is no sample."""
        found = np.full(len(domain.simplices), math.inf)
        if len(self._places):
            np.minimum.at(found, self._triangles(domain), self._areas)
        return found

    def mean_inverse(self, domain: Domain, inside: NDArray[np.intp], own: Floats) -> Floats:
        """Return the mean of the inverse areas in triangles, their own among them."""
        total, count = np.zeros(len(domain.simplices)), np.zeros(len(domain.simplices))
        if len(self._places):
            triangle = self._triangles(domain)
            np.add.at(total, triangle, 1 / self._areas)
            np.add.at(count, triangle, 1)
        mean: Floats = (total[inside] + own) / (count[inside] + 1)
        return mean


def _centres(domain: Domain, inside: NDArray[np.intp]) -> Floats:
    corners = domain.points[domain.simplices[inside]]
    return np.ascontiguousarray((corners / 3).sum(axis=1))


def _equilateral(length: Any) -> Any:
    return EQUILATERAL * length * length


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float | np.integer | np.floating)


def _positive(value: Any, name: str) -> float:
    number = as_number(value, name=name)
    if not number > 0:
        raise InputError(f"{name} must be above 0, got {value!r}")
    return number


def _out_of_range(what: str) -> str:
    return f"{what}: its square leaves the range of doubles; scale the coordinates"


def _place(place: Floats) -> str:
    x, y = place.tolist()
    return f"({x!r}, {y!r})"


def _checked(sizes: Any, places: Floats) -> Floats:
    given = np.asarray(sizes)
    if given.dtype.kind not in "iuf":
        raise DtypeError(f"size must return real numbers, got dtype {given.dtype}")
    found = given.astype(np.float64)
    if found.ndim == 0:
        found = np.full(len(places), float(found))
    if found.shape != (len(places),):
        raise InputError(
            f"size must return one length for each of {len(places)} places, got shape {found.shape}"
        )
    wrong = np.flatnonzero(~(found > 0))
    if wrong.size:
        raise InputError(
            f"size is {found[wrong[0]]} at {_place(places[wrong[0]])}, it must be above 0; so are "
            f"{len(wrong)} of {len(places)} places asked for"
        )
    return found


def _evaluator(size: Any) -> Callable[[Floats], Floats]:
    """Return what gives the lengths at places."""
    if hasattr(size, "dims") and hasattr(size, "coords"):
        return _of_raster(size)
    if isinstance(size, tuple) and len(size) == 2 and isinstance(size[0], Triangulation):
        return _of_background(*size)
    if callable(size):
        function: Callable[[Floats], Floats] = size
        return function
    raise InputError(
        "size must be a number, a mapping of regions, a function of places, a pair of a "
        f"triangulation and its values, or a DataArray, got {size!r:.60}"
    )


def _of_background(mesh: Triangulation, values: Any) -> Callable[[Floats], Floats]:
    """Linear between the vertices of a triangulation; outside as at the nearest point of it."""
    lengths = np.array(values, dtype=np.float64)
    if lengths.shape != (mesh.npoints,):
        raise InputError(
            f"size has values of shape {lengths.shape} for {mesh.npoints} points of its mesh"
        )
    if not mesh.nsimplex:
        raise InputError("size is on a triangulation without a triangle")
    _checked(lengths, mesh.points)

    def at(places: Floats) -> Floats:
        place = mesh.locate(places)
        corners = mesh.simplices[place.simplex]
        found: Floats = (lengths[corners] * place.barycentric).sum(axis=-1)
        outside = np.flatnonzero(place.simplex < 0)
        if outside.size:
            a, b = place.facet[outside].T
            share = place.weights[outside, 1]
            found[outside] = lengths[a] * (1 - share) + lengths[b] * share
        return found

    return at


def _of_raster(raster: Any) -> Callable[[Floats], Floats]:
    """Linear between the centres of cells; outside as at the nearest cell."""
    if len(raster.dims) != 2:
        raise InputError(f"size must have the dimensions y and x, got {raster.dims}")
    axes = [np.asarray(raster[name].values, dtype=np.float64) for name in raster.dims]
    values = np.asarray(raster.values, dtype=np.float64)
    for axis in (0, 1):
        if len(axes[axis]) > 1 and axes[axis][0] > axes[axis][-1]:
            axes[axis], values = axes[axis][::-1], np.flip(values, axis)
        if not (np.diff(axes[axis]) > 0).all():
            raise InputError(f"the coordinates {raster.dims[axis]} of size are not in order")

    def at(places: Floats) -> Floats:
        # The last dimension is x, as rasters have it.
        (i, s), (j, t) = (_between(axes[k], places[:, 1 - k]) for k in (0, 1))
        k, m = np.minimum(i + 1, len(axes[0]) - 1), np.minimum(j + 1, len(axes[1]) - 1)
        upper = values[i, j] * (1 - t) + values[i, m] * t
        lower = values[k, j] * (1 - t) + values[k, m] * t
        found: Floats = upper * (1 - s) + lower * s
        gap = np.flatnonzero(np.isnan(found))
        if gap.size:
            # Beside a cell without value the nearest one counts.
            found[gap] = values[np.where(s < 0.5, i, k), np.where(t < 0.5, j, m)][gap]
        return found

    return at


def _between(axis: Floats, at: Floats) -> tuple[NDArray[np.intp], Floats]:
    """Return the coordinate below, and the share of the way to the next."""
    if len(axis) == 1:
        return np.zeros(len(at), dtype=np.intp), np.zeros(len(at))
    i = np.clip(np.searchsorted(axis, at, side="right") - 1, 0, len(axis) - 2)
    share: Floats = np.clip((at - axis[i]) / (axis[i + 1] - axis[i]), 0, 1)
    return i, share


def _rounded(number: float) -> str:
    """Two digits of a large number: more would claim what an estimate does not know."""
    if number < 1000:
        return f"{number:.0f}"
    scale = 10 ** (int(math.log10(number)) - 1) if number < 1e15 else 1
    return f"{round(number / scale) * scale:,}" if number < 1e15 else f"{number:.1e}"
