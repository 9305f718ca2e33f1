"""Checks of reference systems whose text would make a library open a file or a URL.

PROJ accepts ``+init=/some/file:1`` and grids by path, and GDAL accepts paths and URLs. A file must
not lead to another one, so such text is rejected before any library sees it.
"""

from __future__ import annotations

import json
import re
from typing import Any

from delone.errors import FileFormatError

__all__ = ["check_system", "names_a_source", "plain_system"]

_WKT = re.compile(r"\s*[A-Za-z]\w*\s*[\[(]")
# The WKT nodes for PROJ parameters and grid files, with their values.
_FILES = re.compile(
    r'(?:EXTENSION|PARAMETERFILE)\s*[\[(]\s*(?:"(?:[^"]|"")*"\s*,\s*"((?:[^"]|"")*)")?',
    re.IGNORECASE,
)
_INIT = re.compile(r"init\s*=\s*[\"']?(?!epsg:|esri:)", re.IGNORECASE)
_SEPARATORS = re.compile(r"[/\\~]")
# Identifiers that look like URLs; libraries parse them without a request.
_IDENTIFIER = re.compile(
    r"https?://(?:www\.)?opengis\.net/(?:def/crs|gml/srs)/[\w/.#-]*", re.IGNORECASE
)
_PATH = re.compile(r"\s*(?:file:|[/\\~.]|[a-z]:[/\\])", re.IGNORECASE)
_CODE = re.compile(r"\s*(?:[A-Za-z]\w*:[\w.-]+|urn:[\w:.,-]+)\s*")
_PARAMETERS = {"init", "proj", "grids", "nadgrids", "geoidgrids", "file"}


def check_system(system: Any, source: str) -> None:
    """Reject a reference system, as text or PROJJSON, that names a file or a URL."""
    if system is not None and names_a_source(system):
        raise FileFormatError(
            f"{source}: its reference system {str(system)!r:.100} names a file or a URL, "
            "which is not opened: give an authority and a code (EPSG:28992), or WKT without files"
        )


def names_a_source(system: Any) -> bool:
    """Return whether a library would open a file or a URL for a reference system.

    Also True for text that is not a reference system and might be read as a path.
    """
    if not isinstance(system, str) or system.lstrip().startswith("{"):
        return _is_suspect_json(system)
    if _WKT.match(system):
        return any(found[1] is None or _leads_away(found[1]) for found in _FILES.finditer(system))
    if "=" in system:
        return _leads_away(system)
    if "://" in system:
        return not _IDENTIFIER.fullmatch(system.strip())
    return bool(_PATH.match(system))


def _leads_away(parameters: str) -> bool:
    return bool(_SEPARATORS.search(parameters) or _INIT.search(parameters))


def _is_suspect_json(system: Any) -> bool:
    try:
        return _in_json(json.loads(system) if isinstance(system, str) else system)
    except (ValueError, RecursionError):
        return True


def _in_json(value: Any) -> bool:
    """Search PROJJSON for PROJ parameters and for values that are paths."""
    if isinstance(value, dict):
        return any(
            key in _PARAMETERS
            or (key == "value" and isinstance(item, str) and bool(_SEPARATORS.search(item)))
            or _in_json(item)
            for key, item in value.items()
        )
    return isinstance(value, list) and any(map(_in_json, value))


def plain_system(system: Any, source: str) -> Any:
    """Return a reference system unchanged if GDAL cannot mistake it for a file name, else raise.

    Objects of other libraries are returned unchanged.
    """
    if not isinstance(system, str) or not system:
        return system
    check_system(system, source)
    form = system.lstrip()
    if _CODE.fullmatch(form) or _WKT.match(form) or form.startswith(("{", "+")):
        return system
    raise FileFormatError(
        f"{source} cannot store the reference system {system!r:.100}: give an authority and a code "
        "(EPSG:28992), or WKT"
    )
