"""Which variables of xarray objects are components of vectors, to the east and to the north.

The standard names of the CF conventions identify them: ``eastward_wind`` and ``northward_wind``,
``surface_downward_eastward_stress`` and so on. Names of components along the axes of a grid
(``x_wind``, ``grid_eastward_wind``) are other directions, and standard errors, variances and
products of components are not components.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, NamedTuple

from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    Pair = tuple[Any, Any]

__all__ = ["is_component", "lone_message", "vector_pairs"]

_WORDS = ("eastward", "northward")
# In standard names of other directions, and of what is not linear.
_OTHER = {"x", "y", "grid", "square", "magnitude"}
# Methods of cells whose results are still components.
_LINEAR = {"mean", "point", "sum"}
# How names of variables differ within a pair.
_NAMES = (("eastward", "northward"), ("east", "north"), ("zonal", "meridional"), ("u", "v"))


class _Kind(NamedTuple):
    """What two components of one vector have in common, and which of them one is."""

    axis: int
    pattern: str
    methods: str
    dims: frozenset[Any]


def _kind_of(part: Any) -> _Kind | None:
    """What the attributes of a variable say; None if it is not a component."""
    name = str(part.attrs.get("standard_name", "")).strip().casefold()
    words = name.split("_")
    axes = [axis for axis, word in enumerate(_WORDS) if word in words]
    # What follows a blank is a modifier, such as standard_error.
    if len(axes) != 1 or words.count(_WORDS[axes[0]]) != 1 or re.search(r"\s", name):
        return None
    methods = re.sub(r"\(.*?\)", "", str(part.attrs.get("cell_methods", "")))
    if _OTHER & set(words) or set(re.findall(r":\s+(\w+)", methods)) - _LINEAR:
        return None
    pattern = name.replace(_WORDS[axes[0]], "*")
    return _Kind(axes[0], pattern, " ".join(methods.split()), frozenset(part.dims))


def is_component(part: Any) -> bool:
    """Return whether the attributes of a variable say that it is a component of a vector."""
    return _kind_of(part) is not None


def vector_pairs(
    data: Any, names: Sequence[Any], vectors: Iterable[Any] | None
) -> tuple[list[Pair], list[Any]]:
    """Return the pairs of variables that are vectors, and the unpaired components.

    Parameters
    ----------
    data : xarray.Dataset
        The variables.
    names : sequence
        Those that are interpolated.
    vectors : iterable of pairs of names, or None
        The pairs, in which case no component is unpaired; None to use the attributes.

    Raises
    ------
    InputError
        Pairs are not pairs of these names, or not of one vector; or attributes allow several.
    """
    if vectors is not None:
        return list(_given(data, names, vectors)), []
    groups: dict[_Kind, tuple[list[Any], list[Any]]] = {}
    for name in names:
        kind = _kind_of(data[name])
        if kind is not None:
            groups.setdefault(kind._replace(axis=0), ([], []))[kind.axis].append(name)
    pairs, lone = [], []
    for kind, (east, north) in groups.items():
        if not (east and north):
            lone += east or north
            continue
        found = [(east[0], north[0])] if len(east) == len(north) == 1 else _by_name(east, north)
        if not found:
            listed = ", ".join(map(str, [*east, *north]))
            raise InputError(
                f"several variables are components of {kind.pattern.replace('*', '')!r:.60}: "
                f"{listed:.120}; name the pairs: vectors=[({east[0]!r:.40}, {north[0]!r:.40}), ...]"
            )
        for pair in found:
            _require_one_unit(data, pair)
        pairs += found
    return pairs, lone


def lone_message(names: Iterable[Any], *, alone: bool) -> str:
    """Return the text of the warning about unpaired components."""
    listed = ", ".join(map(str, names))
    cure = (
        "interpolate a Dataset of both components"
        if alone
        else "name the pairs with vectors=[(east, north)], or give vectors=[] if they are none"
    )
    return (
        f"{listed:.160}: components of vectors, interpolated as numbers, which is wrong near the "
        f"poles, where east rotates with the longitude; {cure}"
    )


def _by_name(east: list[Any], north: list[Any]) -> list[Pair]:
    """Pairs by the names of variables, such as u10 and v10; none if that is ambiguous."""
    pairs = []
    for name in east:
        partners = set(_partners(str(name))) & set(map(str, north))
        if len(partners) != 1:
            return []
        pairs.append((name, next(other for other in north if str(other) in partners)))
    complete = len({other for _, other in pairs}) == len(pairs) == len(north)
    return pairs if complete else []


def _partners(name: str) -> Iterator[str]:
    """The names of the component to the north for a name of that to the east."""
    for east, north in _NAMES:
        for a, b in ((east, north), (east.upper(), north.upper()), (east.title(), north.title())):
            for found in re.finditer(a, name):
                yield name[: found.start()] + b + name[found.end() :]


def _given(data: Any, names: Sequence[Any], vectors: Iterable[Any]) -> Iterator[Pair]:
    """The pairs that the caller names, after checks."""
    used: set[Any] = set()
    for pair in vectors:
        if isinstance(pair, str) or not hasattr(pair, "__len__") or len(pair) != 2:
            raise InputError(f"vectors must be pairs of names, (east, north), got {pair!r:.80}")
        for axis, name in enumerate(pair):
            if name not in names:
                listed = ", ".join(map(str, names))
                raise InputError(
                    f"vectors: {name!r:.60} is not one of the interpolated variables: {listed:.120}"
                )
            if name in used:
                raise InputError(f"vectors: {name!r:.60} is in more than one place")
            used.add(name)
            _refuse_other(name, data[name], axis)
        if set(data[pair[0]].dims) != set(data[pair[1]].dims):
            both = " and ".join(str(data[name].dims) for name in pair)
            raise InputError(f"vectors: {pair!r:.80} have different dimensions, {both:.120}")
        _require_one_unit(data, pair)
        yield pair[0], pair[1]


def _refuse_other(name: Any, part: Any, axis: int) -> None:
    """Reject a component whose standard name says another direction."""
    standard = str(part.attrs.get("standard_name", ""))
    words = set(standard.casefold().split("_"))
    if words & {"x", "y", "grid"}:
        raise InputError(
            f"vectors: {name!r:.60} is {standard:.80}, along an axis of a grid: rotate such "
            "components to the east and north first"
        )
    if _WORDS[1 - axis] in words and _WORDS[axis] not in words:
        raise InputError(
            f"vectors: {name!r:.60} is {standard:.80}: pairs are (to the east, to the north)"
        )


def _require_one_unit(data: Any, pair: Pair) -> None:
    units = [data[name].attrs.get("units") for name in pair]
    if None not in units and units[0] != units[1]:
        raise InputError(
            f"{pair[0]} and {pair[1]} are components of one vector with units "
            f"{units[0]!r:.40} and {units[1]!r:.40}: convert one of them"
        )
