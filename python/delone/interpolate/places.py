"""The coordinates of xarray objects: which two they are, what they mean, and in which unit.

Coordinates are found by names, standard names and units. If two pairs qualify, the attributes of
the targets decide; without attributes, the caller must choose. Angles are recognized by their
units, standard names or names. A unit that differs from that of the targets is converted if both
are known; otherwise, the caller must give it.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.counting import agreed, counted
from delone._base.extras import require
from delone._base.georeference import may_be_degrees, names_degrees
from delone._base.units import METERS, as_units
from delone.errors import InputError, NonFiniteError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from delone._base.types import Floats, Rows

__all__ = ["MISSING", "Places", "places_of", "source_rows", "target_points"]

MISSING = ("raise", "drop")

# Units of longitudes and latitudes, of the CF conventions and of models.
_DEGREES = tuple(
    {
        word + letter
        for word in ("degrees_", "degree_", "degrees", "degree")
        for letter in (*letters, *(name.casefold() for name in names))
    }
    for letters, names in (("e", ("east",)), ("n", ("north",)))
)
_RADIANS = {"rad", "radian", "radians"}
# Of angles that need not be longitudes or latitudes.
_ANY_DEGREES = {"degree", "degrees", "deg"}
_PLANAR = (("x", "y"), ("easting", "northing"))
_ANGULAR = (("lon", "lat"), ("longitude", "latitude"))
_WORDS = ("longitude", "latitude")


class Places(NamedTuple):
    """Two coordinates of an xarray object."""

    # Unchanged, and broadcast against each other.
    parts: tuple[Any, Any]
    across: Any
    up: Any
    # What shows that they are longitudes and latitudes; None if nothing does.
    by: str | None

    @property
    def dims(self) -> tuple[Any, ...]:
        """The dimensions of the points."""
        found: tuple[Any, ...] = self.across.dims
        return found

    @property
    def names(self) -> tuple[Any, Any]:
        """The names of the coordinates."""
        return self.parts[0].name, self.parts[1].name

    @property
    def in_radians(self) -> bool:
        """Whether both are in radians."""
        return all(unit_of(part, k) == "radians" for k, part in enumerate(self.parts))

    @property
    def points(self) -> Floats:
        """All places, also those that are missing, (n, 2); degrees if the two units differ."""
        found = np.column_stack(
            [np.ravel(np.asarray(part, dtype=np.float64)) for part in (self.across, self.up)]
        )
        if self.by is not None and not self.in_radians:
            for axis, part in enumerate(self.parts):
                if unit_of(part, axis) == "radians":
                    found[:, axis] = np.degrees(found[:, axis])
        return found

    def may_be_angles(self, points: Floats) -> bool:
        """Return whether values are in the range of angles, in the unit of the coordinates."""
        return may_be_degrees(np.degrees(points) if self.in_radians else points)


def places_of(data: Any, coords: Sequence[str] | None, targets: Sequence[Any] = ()) -> Places:
    """Return the coordinates of an array or a dataset; `targets` decide between two pairs.

    Raises InputError if there are none, or several and nothing decides.
    """
    if coords is None:
        pair = _found(data, targets)
    else:
        names = tuple(coords)
        if len(names) != 2 or not all(name in _variables(data) for name in names):
            raise _not_found(" and ".join(map(str, names)))
        pair = tuple(_variables(data)[name] for name in names)
    # Rows, columns: as values are stored.
    across, up = require("xarray", extra="xarray", what="coordinates").broadcast(*pair)
    return Places((pair[0], pair[1]), across, up, _shown(pair))


def _not_found(wanted: str) -> InputError:
    return InputError(f"found no coordinates {wanted}; name two with coords=")


def _variables(data: Any) -> dict[Any, Any]:
    """All variables that may be coordinates, even if the dataset does not declare them as such."""
    found = dict(data.coords.items())
    if hasattr(data, "data_vars"):
        found |= {name: part for name, part in data.data_vars.items() if name not in found}
    return found


def _found(data: Any, targets: Sequence[Any]) -> tuple[Any, Any]:
    known = _variables(data)
    planar = next(_pairs(known, _PLANAR), None)
    angular = next(_pairs(known, _ANGULAR), None) or _by_attributes(data, known)
    if planar is not None and _shown(planar):
        planar, angular = None, planar
    if planar is None or angular is None:
        pair = planar or angular
        if pair is None:
            wanted = ", or ".join(" and ".join(pair) for pair in chain(_PLANAR, _ANGULAR))
            raise _not_found(wanted)
        return pair
    said = _said_by(targets)
    if said is None:
        listed = ", and ".join(f"{pair[0].name} and {pair[1].name}" for pair in (planar, angular))
        first = [str(part.name) for part in angular]
        raise InputError(f"found the coordinates {listed}: name two, such as coords={first}")
    return angular if said else planar


def _pairs(known: dict[Any, Any], names: Iterable[tuple[str, str]]) -> Iterator[tuple[Any, Any]]:
    return ((known[a], known[b]) for a, b in names if a in known and b in known)


def _by_attributes(data: Any, known: dict[Any, Any]) -> tuple[Any, Any] | None:
    """The one longitude and the one latitude by their attributes, bounds of cells left out."""
    bounds = bounds_of(data, known.values())
    found = [
        [part for name, part in known.items() if name not in bounds and is_angle(part, axis)]
        for axis in (0, 1)
    ]
    if not all(found):
        return None
    if max(map(len, found)) > 1:
        listed = ", ".join(str(part.name) for part in chain(*found))
        raise InputError(f"found several longitudes or latitudes: {listed}; name two with coords=")
    return found[0][0], found[1][0]


def _said_by(targets: Sequence[Any]) -> bool | None:
    """Whether the attributes of targets make them angles; None if they do not tell."""
    if not targets:
        return None
    names = tuple(str(getattr(part, "name", None)) for part in targets)
    kinds = [unit_of(part, axis) for axis, part in enumerate(targets)]
    if any(is_angle(part, axis) for axis, part in enumerate(targets)) or names_degrees(names):
        return True
    if all(kind in ("degrees", "radians") for kind in kinds):
        return True
    if names in _PLANAR or all(kind is not None for kind in kinds):
        return False
    return None


def is_angle(part: Any, axis: int) -> bool:
    """Return whether attributes say longitude (axis 0) or latitude (1)."""
    attrs = getattr(part, "attrs", {})
    name = str(attrs.get("standard_name", "")).casefold()
    return name == _WORDS[axis] or _unit_text(part) in _DEGREES[axis]


def _unit_text(part: Any) -> str:
    return str(getattr(part, "attrs", {}).get("units", "")).strip().casefold()


def unit_of(part: Any, axis: int) -> str | None:
    """Return "degrees", "radians", or what else the attribute ``units`` says; None without."""
    unit = _unit_text(part)
    if unit in _DEGREES[axis] or unit in _ANY_DEGREES:
        return "degrees"
    return "radians" if unit in _RADIANS else unit or None


def _shown(pair: Sequence[Any]) -> str | None:
    """What shows that coordinates are longitudes and latitudes, or None."""
    kinds = [unit_of(part, axis) for axis, part in enumerate(pair)]
    if any(kind not in (None, "degrees", "radians") for kind in kinds):
        return None
    if all(is_angle(part, axis) for axis, part in enumerate(pair)):
        found = [part.attrs.get("units") or part.attrs["standard_name"] for part in pair]
        return f"units {', '.join(map(str, found))}"
    names = [str(part.name) for part in pair]
    return f"coordinates {', '.join(names)}" if names_degrees(names) else None


def bounds_of(data: Any, parts: Iterable[Any]) -> set[Any]:
    """Return the variables that are bounds of cells of coordinates: by attribute, or by name."""
    found = set()
    for part in parts:
        for source in (part.attrs, part.encoding):
            found.add(source.get("bounds"))
        found |= {f"{part.name}{ending}" for ending in ("_bnds", "_bounds", "_vertices")}
    return found & set(_variables(data))


def source_rows(points: Floats, missing: str) -> Rows | None:
    """Return the places that are kept, None for all; raise if some have no coordinate."""
    if missing not in MISSING:
        raise InputError(f"missing must be 'raise' or 'drop', got {missing!r:.60}")
    known = np.isfinite(points).all(axis=1)
    if known.all():
        return None
    rows = np.flatnonzero(~known)
    if missing == "raise":
        count = len(rows)
        raise NonFiniteError(
            f"coordinates: {count} of {counted(len(points), 'place')} "
            f"{agreed(count, 'has', 'have')} NaN or infinity: first {rows[0]}; missing='drop' "
            "leaves them out, with their values",
            rows=rows[:10],
            count=count,
        )
    return np.flatnonzero(known)


def target_points(
    places: Places, targets: Sequence[Any], plain: bool | None, *, planar: bool
) -> tuple[Floats, bool]:
    """Return targets, (..., 2), and whether they are degrees; else they are in the sources' unit.

    `plain` is the unit of targets without one: degrees or not, if the caller has said it.
    """
    arrays = [np.asarray(part, dtype=np.float64) for part in targets]
    kinds = [unit_of(part, axis) for axis, part in enumerate(targets)]
    if places.by is None or planar:
        own = [unit_of(part, axis) for axis, part in enumerate(places.parts)]
        arrays = [
            array * _ratio(kind, mine, f"{part.name}")
            for array, kind, mine, part in zip(arrays, kinds, own, places.parts, strict=True)
        ]
        return np.stack(arrays, axis=-1), False
    units = [kind or angles_unit(places, plain, "the targets") for kind in kinds]
    for kind, part in zip(units, places.parts, strict=True):
        if kind not in ("degrees", "radians"):
            raise InputError(
                f"the targets have units {kind!r:.60}, and the coordinate {part.name} of the "
                f"points is an angle ({places.by}): name other coordinates with coords="
            )
    if units[0] != units[1]:
        arrays = [
            np.degrees(array) if kind == "radians" else array
            for array, kind in zip(arrays, units, strict=True)
        ]
    return np.stack(arrays, axis=-1), "degrees" in units


def angles_unit(places: Places, plain: bool | None, what: str) -> str:
    """Return the unit of angles without one: the caller's, or degrees if the points do."""
    if plain is not None:
        return "degrees" if plain else "radians"
    if not places.in_radians:
        return "degrees"
    names = " and ".join(map(str, places.names))
    raise InputError(
        f"{what} have no units, and the coordinates {names} of the points are in radians: give "
        "degrees=True or degrees=False, or targets with an attribute units"
    )


def _ratio(target: str | None, source: str | None, name: str) -> float:
    """The factor that converts targets to the unit of the points; 1 if either unit is not known."""
    if target is None or source is None or target == source:
        return 1.0
    if {target, source} == {"degrees", "radians"}:
        return float(np.radians(1.0) if target == "degrees" else np.degrees(1.0))
    try:
        known = [as_units(unit) for unit in (target, source)]
    except InputError:
        raise InputError(
            f"the targets have units {target!r:.40}, and the coordinate {name} of the points has "
            f"units {source!r:.40}: convert one of them, or name other coordinates with coords="
        ) from None
    return METERS[str(known[0])] / METERS[str(known[1])]
