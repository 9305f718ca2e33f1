"""LandXML 1.0 to 1.2: the surfaces of a file, with lxml (extra ``landxml``).

Coordinates are northing, easting and height, in this order. Document types are refused, so there
are no entities; nothing else is opened; limits of libxml2 on depth and length of text hold.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.errors import FileFormatError
from delone.extras import require
from delone.io.landxml_parts import ORDERS, Draft, Head
from delone.io.landxml_writing import require_libraries, write_mesh
from delone.io.markup import decoded, refuse_document_type

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from delone.io.geometryset import GeometrySet
    from delone.io.pointset import PointSet
    from delone.io.surfacefile import SurfaceFile

__all__ = ["read_geometries", "read_points", "read_surface", "require_libraries", "write_mesh"]

# Elements that are done when they end: all others are small, and hold what belongs to these.
_LEAVES = ("P", "F", "PntList2D", "PntList3D")
_SHOWN = 20
# Points, faces and lines that are dropped together.
_AT_ONCE = 256


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str], layer: str | None
) -> PointSet:
    """Read the points of a surface; see `delone.io.read_points`."""
    _refuse_columns(path, columns, attributes)
    found = read_surface(path, name=layer, order="nez")
    found.warn_left_out()
    return found.as_points()


def read_geometries(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
) -> GeometrySet:
    """Read the lines of a surface; see `delone.io.read_geometries`."""
    _refuse_columns(path, columns, attributes)
    found = read_surface(path, name=layer, order="nez")
    found.warn_left_out()
    return found.as_geometries()


def _refuse_columns(
    path: Path, columns: Sequence[str | int] | None, attributes: Sequence[str]
) -> None:
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: points of LandXML have x, y and z, and no other columns")


def read_surface(path: Path, *, name: str | None, order: str) -> SurfaceFile:
    """Read a surface; see `delone.io.read_surface`."""
    etree = require("lxml.etree", extra="landxml", what="reading LandXML")
    refuse_document_type(path)
    head = Head(str(path), ORDERS[order])
    try:
        drafts = list(_drafts(etree, path, head, name))
    except etree.XMLSyntaxError as error:
        raise FileFormatError(f"{path} is not valid XML: {error.msg}") from error
    found = _chosen(drafts, name, str(path)).finished()
    found.require_order(order)
    return found


def _drafts(etree: Any, path: Path, head: Head, wanted: str | None) -> Iterator[Draft]:
    """Yield the surfaces, in the order of the file; those of other names have no content."""
    with decoded(path) as (file, encoding):
        events = etree.iterparse(
            file,
            encoding=encoding,
            events=("start", "end"),
            resolve_entities=False,
            load_dtd=False,
            no_network=True,
            huge_tree=False,
            remove_comments=True,
            remove_pis=True,
        )
        draft: Draft | None = None
        depth = leaves = 0
        names: dict[str, str] = {}
        for event, element in events:
            # Of most files nearly all elements are points and faces: each step counts.
            whole = element.tag
            tag = names.get(whole)
            if tag is None:
                tag = names[whole] = _local(element)
            if event == "start":
                if depth == 0:
                    _require_root(element, path)
                depth += 1
                if tag in _LEAVES:
                    continue
                if tag == "Surface":
                    draft = Draft(head, element.get("name"), element.sourceline)
                elif draft is None:
                    head.begin(tag, element)
                elif wanted in (None, draft.name):
                    draft.begin(tag, element)
                continue
            depth -= 1
            if tag == "Surface" and draft is not None:
                yield draft
                draft = None
            elif draft is not None and tag in _LEAVES and wanted in (None, draft.name):
                draft.end(tag, element)
                leaves += 1
                if leaves % _AT_ONCE:
                    continue
            # What was read is dropped, some elements at a time.
            element.clear()
            while element.getprevious() is not None:
                del element.getparent()[0]


def _local(element: Any) -> str:
    return str(element.tag).rpartition("}")[2]


def _require_root(element: Any, path: Path) -> None:
    if element.getroottree().docinfo.internalDTD is not None:
        raise FileFormatError(f"{path} has a document type (DOCTYPE); such files are not read")
    if _local(element) != "LandXML":
        raise FileFormatError(
            f"{path} is not LandXML: its root is <{_local(element):.60}>, not <LandXML>"
        )


def _chosen(drafts: list[Draft], name: str | None, source: str) -> Draft:
    names = ", ".join(repr(draft.name) for draft in drafts[:_SHOWN])
    names += ", ..." if len(drafts) > _SHOWN else ""
    if not drafts:
        raise FileFormatError(f"{source} contains no surface")
    found = [draft for draft in drafts if name in (None, draft.name)]
    if not found:
        raise FileFormatError(f"{source} has no surface {name!r:.80}; its surfaces are {names}")
    if len(found) > 1:
        what = "several surfaces" if name is None else f"{len(found)} surfaces {name!r}"
        raise FileFormatError(f"{source} has {what}; choose one (--layer): {names}")
    return found[0]
