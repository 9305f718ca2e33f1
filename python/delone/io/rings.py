"""Find the ring of a GeoJSON file that is not closed, for an error message."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from delone.io.compressed import opened

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["open_ring"]

_JSON = (".geojson", ".json")


def open_ring(path: Path) -> str:
    """Return which feature has a ring that does not end where it begins; empty if none is found."""
    if not any(suffix.lower() in _JSON for suffix in path.suffixes[-2:]):
        return ""
    try:
        with opened(path) as file:
            content = json.loads(file.read())
        features = content.get("features", [content])
        for number, feature in enumerate(features):
            for ring in _rings(feature.get("geometry", feature)):
                if ring and (ring[0] != ring[-1] or len(ring) < 4):
                    return (
                        f"feature {number} has a ring of {len(ring)} positions that begins at "
                        f"{ring[0]!r:.40} and ends at {ring[-1]!r:.40}: a ring needs four or "
                        "more, and ends where it begins"
                    )
    except (ValueError, AttributeError, TypeError, KeyError, RecursionError, OSError):
        pass  # The error of the reader is raised.
    return ""


def _rings(geometry: Any) -> Iterator[Any]:
    """Yield the rings of a geometry, and of those in a collection."""
    kind = (geometry or {}).get("type")
    if kind == "Polygon":
        yield from geometry["coordinates"]
    elif kind == "MultiPolygon":
        for polygon in geometry["coordinates"]:
            yield from polygon
    elif kind == "GeometryCollection":
        for part in geometry["geometries"]:
            yield from _rings(part)
