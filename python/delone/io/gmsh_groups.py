"""The physical groups of MSH files: their names and, in version 4, which entities are in them.

In version 2, elements have the numbers of their groups; in version 4, each block of elements is
part of an entity, which lists its groups. meshio cannot read files where only some have one.
"""

from __future__ import annotations

import mmap
import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.io.cells import POLYGONS, SOLIDS
from delone.io.gmsh import Bytes, Checked, Words, spans
from delone.io.numbered import as_markers

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["group_name", "numbers", "physical_groups"]

# A line of names: dimension, number, and the name in quotes.
_NAMED = re.compile(rb'\s*(\d{1,9})\s+(-?\d{1,9})\s+"([^"]*)"\s*')
# The names that delone writes, and the numbers in them.
_OWN = re.compile(r"(?:marker|region) (-?\d{1,10})")
# Numbers of a bounding box, for entities of each dimension: points have three in 4.1.
_BOXES = {"4.0": (6, 6, 6, 6), "4.1": (3, 6, 6, 6)}


class Groups(NamedTuple):
    """The names of groups by dimension and number, and the first group of each version-4 entity."""

    names: Mapping[tuple[int, int], str]
    entities: Mapping[tuple[int, int], int] | None  # None in version 2


def group_name(kind: str, value: int) -> str:
    """Return the name of a group for a marker or region, which `numbers` can parse."""
    return f"{kind} {value}"


def physical_groups(path: Path) -> Groups:
    """Read names and entities of a file; what these declare is compared with its bytes."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        bodies = {name: (body, stop) for name, _, body, stop, _ in spans(content, path)}

        def of(name: str) -> bytes:
            return content[slice(*bodies[name])] if name in bodies else b""

        checked = Checked(path, of("MeshFormat"))
        names = _names(of("PhysicalNames"))
        if checked.version.startswith("2"):
            return Groups(names, None)
        body = of("Entities")
        return Groups(names, _entities(checked, body) if body.strip() else {})


def _names(body: bytes) -> dict[tuple[int, int], str]:
    """Return names by dimension and number; other lines are skipped."""
    found = map(_NAMED.fullmatch, body.splitlines())
    return {
        (int(line[1]), int(line[2])): line[3].decode("utf-8", errors="replace")
        for line in found
        if line
    }


def _entities(checked: Checked, body: bytes) -> dict[tuple[int, int], int]:
    """Return the first group of each entity that is in one, by dimension and number."""
    items: Words | Bytes = (Bytes if checked.binary else Words)(checked, body)
    boxes = _BOXES.get(checked.version, _BOXES["4.1"])
    found = {}
    for dimension, count in enumerate(items.counts(4)):
        for _ in range(count):  # each takes some of the bytes, or is an error
            (entity,) = items.integers(1)
            items.reals(boxes[dimension])
            (groups,) = items.counts(1)
            own = items.integers(groups) if groups else []
            if own:
                found[dimension, entity] = own[0]
            if dimension:
                (sides,) = items.counts(1)
                if sides:
                    items.integers(sides)
    return found


def numbers(mesh: Any, path: Path) -> tuple[NDArray[np.int32] | None, NDArray[np.int32] | None]:
    """Return numbers for the polygons and for the tetrahedra of a meshio mesh: their groups.

    0 stands for no group. A name that delone writes, such as "marker 7", gives the number in it.
    None if there are no groups.
    """
    groups = physical_groups(path)
    tags = mesh.cell_data.get("gmsh:physical" if groups.entities is None else "gmsh:geometrical")
    if tags is None or (groups.entities is not None and not groups.entities):
        return None, None
    return (
        as_markers(_of_kinds(mesh, tags, groups, POLYGONS, 2), path).ravel(),
        as_markers(_of_kinds(mesh, tags, groups, SOLIDS, 3), path, "region").ravel(),
    )


def _of_kinds(
    mesh: Any, tags: list[NDArray[Any]], groups: Groups, kinds: tuple[str, ...], dimension: int
) -> Floats:
    """Return the numbers of the groups of cells of some kinds, (n, 1)."""
    meaning = {
        tag: _OWN.fullmatch(name) for (ndim, tag), name in groups.names.items() if ndim == dimension
    }
    rows = [np.empty((0, 1))]
    for block, own in zip(mesh.cells, tags, strict=True):
        if block.type not in kinds:
            continue
        values, place = np.unique(np.asarray(own, dtype=np.int64), return_inverse=True)
        known = []
        for value in values.tolist():
            tag = value if groups.entities is None else groups.entities.get((dimension, value), 0)
            word = meaning.get(tag)
            known.append(int(word[1]) if word else tag)
        rows.append(np.array(known, dtype=np.float64)[place].reshape(-1, 1))
    return np.concatenate(rows)
