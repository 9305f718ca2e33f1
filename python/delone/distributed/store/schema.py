"""Schema of the manifest and the notes of a run, field by field.

Valid JSON may still say anything: it may have been edited, or written by another program.
Everything that is read from it is checked here, once, before it is used. `TiledDelaunay.validate`
compares it with the files of the tiles.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from delone.distributed.store.output import tile_names
from delone.errors import FileFormatError
from delone.io.systems import names_a_source

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["FORMAT", "TIES", "check_manifest", "check_settings", "check_summary"]

FORMAT = "delone tiles 1"
TIES = "cocircular points are fanned from the lexicographically smallest"

# Rejects a value, with the name of its field.
Check: TypeAlias = Callable[[Any, str], None]

# Rows have signed 64-bit numbers, vertices and triangles of a tile 32-bit numbers.
_ROWS, _PLACES = (1 << 63) - 1, (1 << 31) - 1


class _WrongFieldError(Exception):
    """A field has an invalid value."""


def _refuse(value: Any, field: str, wanted: str) -> None:
    raise _WrongFieldError(f"{field} is {value!r:.40}, not {wanted}")


def _whole(most: int = _ROWS, *, least: int = 0) -> Check:
    def check(value: Any, field: str) -> None:
        if type(value) is not int or not least <= value <= most:
            _refuse(value, field, f"an integer from {least} to {most}")

    return check


def _number(value: Any, field: str) -> None:
    # Doubles, and integers that a double can represent.
    largest = sys.float_info.max if type(value) is float else 1 << 53
    if type(value) not in (int, float) or not -largest <= value <= largest:
        _refuse(value, field, "a finite number")


def _box(value: Any, field: str) -> None:
    _listed(_number, 4)(value, field)
    if value[0] > value[2] or value[1] > value[3]:
        _refuse(value, field, "left, bottom, right and top")


def _text(value: Any, field: str) -> None:
    if not isinstance(value, str):
        _refuse(value, field, "a string")


def _system(value: Any, field: str) -> None:
    _text(value, field)
    if names_a_source(value):
        _refuse(value, field, "a reference system that names no file and no URL")


def _hash(value: Any, field: str) -> None:
    if not isinstance(value, str) or len(value) != 64 or set(value) - set("0123456789abcdef"):
        _refuse(value, field, "a SHA-256 in 64 hexadecimal digits")


def _truth(value: Any, field: str) -> None:
    if not isinstance(value, bool):
        _refuse(value, field, "true or false")


def _one_of(*choices: Any) -> Check:
    def check(value: Any, field: str) -> None:
        if not any(type(value) is type(choice) and value == choice for choice in choices):
            _refuse(value, field, " or ".join(map(repr, choices)))

    return check


def _anything(value: Any, field: str) -> None:
    pass


def _or_null(check: Check) -> Check:
    def either(value: Any, field: str) -> None:
        if value is not None:
            check(value, field)

    return either


def _both(one: Check, other: Check) -> Check:
    def both(value: Any, field: str) -> None:
        one(value, field)
        other(value, field)

    return both


def _name_or_place(value: Any, field: str) -> None:
    if not isinstance(value, str):
        _whole()(value, field)


def _listed(check: Check, length: int | None = None) -> Check:
    def each(value: Any, field: str) -> None:
        if not isinstance(value, list) or length not in (None, len(value)):
            _refuse(value, field, "a list" if length is None else f"a list of {length}")
        for i, item in enumerate(value):
            check(item, f"{field}[{i}]")

    return each


def _record(fields: Mapping[str, Check]) -> Check:
    """An object with these fields; later versions may add others."""

    def each(value: Any, field: str) -> None:
        if not isinstance(value, dict):
            _refuse(value, field or "the root", "an object of fields")
        for name, check in fields.items():
            inner = f"{field}.{name}" if field else name
            if name not in value:
                raise _WrongFieldError(f"the field {inner} is missing")
            check(value[name], inner)

    return each


_SETTINGS = _record(
    {
        "format": _one_of(FORMAT),
        "source": _record({}),
        "tile_points": _whole(least=1),
        "columns": _or_null(_listed(_name_or_place)),
        "classes": _or_null(_listed(_whole())),
        "attributes": _listed(_text),
        "nan": _one_of("raise", "drop"),
    }
)
_TILE: dict[str, Check] = {
    "points": _whole(_PLACES, least=1),
    "foreign": _whole(_PLACES),
    "triangles": _whole(_PLACES),
    "box": _box,
    "extent": _or_null(_box),
    "vertices_sha256": _hash,
    "triangles_sha256": _hash,
}


def _tile(value: Any, field: str) -> None:
    """The entry of a tile; if it has no triangles, their box is null."""
    _record(_TILE)(value, field)
    if (value["extent"] is None) != (value["triangles"] == 0):
        _refuse(value["extent"], f"{field}.extent".lstrip("."), "the box of its triangles")


_MANIFEST = _record(
    {
        "format": _one_of(FORMAT),
        "delone": _text,
        "ties": _one_of(TIES),
        "crs": _or_null(_system),
        "bounds": _box,
        **dict.fromkeys(("triangles", "rows", "points", "dropped", "duplicates"), _whole()),
        **dict.fromkeys(("rounds", "given", "hull", "memory"), _whole()),
        "heights": _truth,
        "attributes": _listed(_text),
        "tree": _record({"axis": _anything, "cut": _anything, "children": _anything}),
        "run": _SETTINGS,
        "tiles": _listed(_both(_tile, _record({"tile": _whole(), "files": _record({})}))),
    }
)


def check_manifest(found: Any, path: Path) -> None:
    """Reject an invalid manifest; the message names the file and the first invalid field."""
    try:
        # In another format, everything may be different.
        if not isinstance(found, dict) or found.get("format") != FORMAT:
            raise _WrongFieldError(f"it is not {FORMAT!r:.80}")
        _MANIFEST(found, "")
        _check_tiles(found["tiles"])
        _check_tree(found["tree"], len(found["tiles"]))
    except _WrongFieldError as error:
        raise FileFormatError(f"{path}: {error}") from None


def _check_tiles(tiles: Sequence[Mapping[str, Any]]) -> None:
    """Check that numbers and file names of tiles correspond to their positions."""
    if not tiles:
        raise _WrongFieldError("tiles is empty")
    for number, tile in enumerate(tiles):
        names = dict(zip(("vertices", "triangles"), tile_names(number), strict=True))
        _one_of(number)(tile["tile"], f"tiles[{number}].tile")
        _one_of(names)(tile["files"], f"tiles[{number}].files")


def _check_tree(tree: Mapping[str, Any], tiles: int) -> None:
    """Check that cuts form a tree: children follow their parents, each node and tile once."""
    nodes = tiles - 1
    _listed(_one_of(0, 1), nodes)(tree["axis"], "tree.axis")
    _listed(_number, nodes)(tree["cut"], "tree.cut")
    _listed(_listed(_whole(nodes - 1, least=-tiles), 2), nodes)(tree["children"], "tree.children")
    seen = set()
    for node, pair in enumerate(tree["children"]):
        for child in pair:
            if 0 <= child <= node or child in seen:
                _refuse(child, f"tree.children[{node}]", "a later node, or a tile, once")
            seen.add(child)


def check_settings(found: Any, path: Path) -> None:
    """Reject invalid settings of a run, like `check_manifest`."""
    _checked(_SETTINGS, found, path)


def check_summary(stage: str, found: Any, tiles: int, path: Path) -> None:
    """Reject an invalid note of a task of a stage (without the number of its round).

    `tiles` may be any number until it is known.
    """
    tile, place = _whole(tiles - 1), _whole(_PLACES)

    def run(value: Any, field: str) -> None:
        _listed(place, 3)(value, field)
        tile(value[0], f"{field}[0]")

    asked = {"foreign": _whole(), "asked": _listed(tile)}

    def runs(value: Any, field: str) -> None:
        _record({"own": _listed(run), "halo": _listed(run)})(value, field)
        _record({"boxes": _listed(_or_null(_box), len(value["own"]))})(value, field)

    fields: dict[str, Check] = {
        "look": _record({"rows": place, "bad": _listed(_whole()), "bad_count": place}),
        "deal": runs,
        "begin": _record({"twins": place, **asked}),
        "answer": _record({"told": _whole()}),
        "proceed": _record(asked),
        "finish": _tile,
    }
    _checked(_both(fields[stage], _record({"memory": _whole()})), found, path)


def _checked(check: Check, found: Any, path: Path) -> None:
    try:
        check(found, "")
    except _WrongFieldError as error:
        raise FileFormatError(f"{path}: {error}") from None
