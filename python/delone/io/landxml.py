"""LandXML 1.0 to 1.2: surfaces, survey points and alignments, with lxml (extra ``landxml``).

Coordinates are northing, easting and height, in this order. Document types are rejected, so there
are no entities; nothing else is opened; libxml2's limits on depth and text length apply.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import FileFormatError, InputError
from delone.io.geometryset import GeometrySet
from delone.io.landxml_parts import ORDERS, Draft, Head
from delone.io.landxml_survey import Survey
from delone.io.landxml_writing import write_mesh
from delone.io.markup import decoded, refuse_document_type
from delone.io.pointset import PointSet
from delone.io.surfacefile import SurfaceFile

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["read_geometries", "read_points", "read_surface", "write_mesh"]

# Elements that are processed when they end: all others are small, and belong to one of these.
_LEAVES = ("P", "F", "PntList2D", "PntList3D")
_SHOWN = 20
# What selects survey points and alignments instead of a surface.
_SURVEY, _ALIGNMENTS = "CgPoints", "Alignments"
# Number of points, faces and lines that are dropped at a time.
_AT_ONCE = 256


def read_points(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    attributes: Sequence[str],
    layer: str | None,
    everything: bool = False,
) -> PointSet:
    """Read the points of a surface, or survey points; see `delone.io.read_points`."""
    _refuse_columns(path, columns)
    found = read_surface(path, name=layer, order="nez")
    if found.name != _SURVEY:
        _refuse_attributes(path, attributes)
        found.warn_left_out()
        return found.as_points()
    survey = _survey(path, "nez")
    places, known = survey.points()
    _surveyed(survey, places).warn_left_out()
    _refuse_attributes(path, set(attributes) - set(known))
    return PointSet(
        points=np.ascontiguousarray(places[:, :2]),
        z=None if np.isnan(places[:, 2]).all() else places[:, 2].copy(),
        attributes=known if everything else {name: known[name] for name in attributes},
        crs=survey.head.crs,
        source=str(path),
    )


def read_geometries(
    path: Path,
    *,
    columns: Sequence[str | int] | None,
    layer: str | None,
    attributes: Sequence[str] = (),
    everything: bool = False,
    chord: float | None = None,
) -> GeometrySet:
    """Read the lines of a surface, or alignments; see `delone.io.read_geometries`."""
    _refuse_columns(path, columns)
    survey = _survey(path, "nez")
    if layer == _ALIGNMENTS or (survey.names and _has_no_surface(path, layer)):
        return _aligned(path, survey, layer, None if everything else attributes, chord)
    _refuse_attributes(path, attributes)
    if chord is not None:
        raise InputError(f"{path}: chord is for alignments, and these are the lines of a surface")
    found = read_surface(path, name=layer, order="nez")
    found.warn_left_out()
    return found.as_geometries()


def _has_no_surface(path: Path, name: str | None) -> bool:
    etree = require("lxml.etree", extra="landxml", what="reading LandXML")
    # With a name that no surface has, no content is read.
    names = [draft.name for draft in _drafts(etree, path, Head(str(path), ORDERS["nez"]), "\0")]
    return not names if name is None else name not in names


def _aligned(
    path: Path,
    survey: Survey,
    layer: str | None,
    attributes: Sequence[str] | None,
    chord: float | None,
) -> GeometrySet:
    """Return alignments as lines."""
    shapely = require("shapely", extra="geo", what="geometries")
    name = None if layer in (None, _ALIGNMENTS) else layer
    if name is not None and name not in survey.names:
        shown = ", ".join(map(repr, survey.names[:_SHOWN]))
        raise FileFormatError(
            f"{path} has no surface or alignment {name!r:.80}; its alignments are {shown}"
        )
    found = survey.alignments(chord, name)
    if not found:
        raise FileFormatError(f"{path} contains no alignments")
    lines = np.concatenate([each.line for each in found])
    places = np.column_stack((lines, np.full(len(lines), np.nan)))
    _surveyed(survey, places).warn_left_out()
    known = {
        "name": np.array([each.name for each in found], dtype=object),
        "start": np.array([each.start for each in found]),
    }
    _refuse_attributes(path, set(attributes or ()) - set(known))
    geometries = np.empty(len(found), dtype=object)
    geometries[:] = [shapely.LineString(each.line) for each in found]
    wanted = known if attributes is None else attributes
    return GeometrySet(
        geometries=geometries,
        crs=survey.head.crs,
        source=str(path),
        attributes={each: known[each] for each in wanted},
    )


def _refuse_columns(path: Path, columns: Sequence[str | int] | None) -> None:
    if columns is not None:
        raise FileFormatError(f"{path}: points of LandXML have x, y and z, and no other columns")


def _refuse_attributes(path: Path, attributes: Collection[str]) -> None:
    if attributes:
        raise FileFormatError(
            f"{path} has no column {sorted(attributes)[0]!r:.60}: CgPoints have name, code and "
            "desc, alignments name and start, surfaces none"
        )


def read_surface(path: Path, *, name: str | None, order: str) -> SurfaceFile:
    """Read a surface; see `delone.io.read_surface`."""
    etree = require("lxml.etree", extra="landxml", what="reading LandXML")
    refuse_document_type(path)
    head = Head(str(path), ORDERS[order])
    with _valid(etree, path):
        drafts = list(_drafts(etree, path, head, name))
    if name == _SURVEY or (name is None and not drafts):
        survey = _survey(path, order)
        if survey.has_points:
            found = _surveyed(survey, survey.points()[0])
            found.require_order(order)
            return found
    found = _chosen(drafts, name, str(path)).finished()
    found.require_order(order)
    return found


@contextmanager
def _valid(etree: Any, path: Path) -> Iterator[None]:
    try:
        yield
    except etree.XMLSyntaxError as error:
        raise FileFormatError(f"{path} is not valid XML: {error.msg}") from error


def _surveyed(survey: Survey, places: Floats) -> SurfaceFile:
    """Return survey points with heights as a surface without faces."""
    high = ~np.isnan(places[:, 2])
    left_out = survey.left_out.copy()
    left_out["CgPoint without a height"] += int((~high).sum()) if high.any() else 0
    return SurfaceFile(
        points=places[high],
        faces=np.empty((0, 3), dtype=np.int32),
        units=survey.head.units,
        lengths=survey.head.lengths,
        crs=survey.head.crs,
        name=_SURVEY,
        source=survey.head.source,
        left_out=dict(+left_out),
    )


def _survey(path: Path, order: str) -> Survey:
    """Read survey points and alignments."""
    etree = require("lxml.etree", extra="landxml", what="reading LandXML")
    refuse_document_type(path)
    survey = Survey(str(path), order)
    with _valid(etree, path), decoded(path) as (file, encoding):
        depth = 0
        for event, element in _events(etree, file, encoding):
            if event == "start":
                if depth == 0:
                    _require_root(element, path)
                depth += 1
                survey.begin(_local(element), element)
                continue
            depth -= 1
            survey.end(_local(element), element)
            _drop(element)
    return survey


def _events(etree: Any, file: Any, encoding: str | None) -> Any:
    return etree.iterparse(
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


def _drop(element: Any) -> None:
    """Drop the elements that have been read."""
    element.clear()
    while element.getprevious() is not None:
        del element.getparent()[0]


def _drafts(etree: Any, path: Path, head: Head, wanted: str | None) -> Iterator[Draft]:
    """Yield the surfaces, in the order of the file; those with other names have no content."""
    with decoded(path) as (file, encoding):
        events = _events(etree, file, encoding)
        draft: Draft | None = None
        depth = leaves = 0
        names: dict[str, str] = {}
        for event, element in events:
            # In most files, nearly all elements are points and faces, so each step counts.
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
            # Elements that have been read are dropped, some at a time.
            _drop(element)


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
        raise FileFormatError(f"{source} contains no surface, and no survey points (CgPoints)")
    found = [draft for draft in drafts if name in (None, draft.name)]
    if not found:
        raise FileFormatError(f"{source} has no surface {name!r:.80}; its surfaces are {names}")
    if len(found) > 1:
        what = "several surfaces" if name is None else f"{len(found)} surfaces {name!r}"
        raise FileFormatError(f"{source} has {what}; choose one (--layer): {names}")
    return found[0]
