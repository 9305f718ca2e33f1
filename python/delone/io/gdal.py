"""What GDAL is given to read: one file, by the one driver that its suffix stands for.

GDAL chooses a driver by what a file holds. Some drivers read virtual datasets, pipelines and
descriptions of services, which open other files and send requests; pyogrio has no option for the
drivers that are allowed. So a binary file must begin as its suffix says, in a way that no other
driver accepts, and JSON is opened under a prefix that leaves GDAL one driver. References that
GeoJSON and GeoPackage themselves can hold are looked for before GDAL opens the file.
"""

from __future__ import annotations

import json
import mmap
import os
import re
import sqlite3
import tempfile
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from delone.errors import FileFormatError
from delone.extras import require
from delone.io.compressed import SUFFIXES, Bounded, opened, torn_is_an_error
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["DRIVERS", "admitted", "check_driver", "local_name"]

# GDAL's names of the only drivers that may read what has these suffixes.
DRIVERS = {
    ".geojson": "GeoJSON",
    ".json": "GeoJSON",
    ".gpkg": "GPKG",
    ".shp": "ESRI Shapefile",
    ".fgb": "FlatGeobuf",
}
_SHAPEFILE, _SQLITE = b"\x00\x00\x27\x0a", b"SQLite format 3\x00"
# "Application ids" of GeoPackage 1.0, 1.1 and later, at byte 68.
_GEOPACKAGES = (b"GP10", b"GP11", b"GPKG")
# GDAL takes longer headers of FlatGeobuf for damaged. Shorter ones have a zero byte in their size,
# at which the search of other drivers for their words ends.
_LONGEST_HEADER = 10 << 20

# The key "crs" in any way that JSON can spell it; what usually follows, where it is harmless.
_KEY = re.compile(
    rb"[\"'](?:[cC]|\\u00[46]3)(?:[rR]|\\u00[57]2)(?:[sS]|\\u00[57]3)[\"']", re.DOTALL
)
_USUAL = re.compile(
    rb'\s*(?:[,}\]]|:\s*(?:null|"[^"\\]*"|-?[\d.]+|\{\s*"type"\s*:\s*"name"\s*,\s*"properties"'
    rb'\s*:\s*\{\s*"name"\s*:\s*"(?P<name>[^"\\]*)"\s*\}\s*\}))'
)
_KINDS = ("name", "epsg", "ogc")


@contextmanager
def admitted(path: Path) -> Iterator[str]:
    """Give the name by which GDAL may read a file.

    Parameters
    ----------
    path : Path
        A file that is there; GeoJSON also compressed.

    Yields
    ------
    str
        An absolute path, with a prefix where that leaves one driver.

    Raises
    ------
    FileFormatError
        The file is not what its suffix says, or refers to something else.
    """
    if path.suffix.lower() in SUFFIXES:
        with tempfile.TemporaryDirectory(prefix="delone-") as folder:
            plain = Path(folder) / "decompressed.geojson"
            with (
                torn_is_an_error(str(path)),
                Bounded(opened(path), path) as file,
                plain.open("wb") as copy,
            ):
                while block := file.read(1 << 20):
                    copy.write(block)
            yield _json_name(plain, str(path))
        return
    driver = DRIVERS[path.suffix.lower()]
    if driver == "GeoJSON":
        yield _json_name(path, str(path))
        return
    _check_beginning(path)
    if driver == "GPKG":
        _check_tables(path)
    notes = path.with_name(path.name + ".aux.xml")
    if driver != "GPKG" or not os.path.lexists(notes):
        yield local_name(path)
        return
    # GDAL follows what its own notes beside a file name; it does not find them in another folder.
    with tempfile.TemporaryDirectory(prefix="delone-") as folder:
        alias = Path(folder) / f"alias{path.suffix}"
        try:
            alias.symlink_to(path.resolve())
        except OSError as error:
            raise FileFormatError(f"{path}: remove {notes.name}, which GDAL follows") from error
        yield local_name(alias)


def check_driver(path: Path, driver: str) -> None:
    """Refuse a file that another driver has taken.

    Parameters
    ----------
    path : Path
        The file.
    driver : str
        GDAL's name of the driver that has opened it.

    Raises
    ------
    FileFormatError
        It is not the one of the suffix.
    """
    wanted = DRIVERS.get(path.suffix.lower(), "GeoJSON")
    if driver != wanted:
        raise FileFormatError(f"{path} is no {path.suffix.lower()} file: GDAL reads it as {driver}")


def local_name(path: Path) -> str:
    """Return the absolute path of a file, where pyogrio and GDAL take it for one.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    str
        Its absolute path.

    Raises
    ------
    FileFormatError
        They would take it for an archive, an address or another file.

    Examples
    --------
    >>> from pathlib import Path
    >>> from delone.io.gdal import local_name
    >>> local_name(Path("wells.gpkg")).endswith("wells.gpkg")
    True
    """
    name = _absolute(path)
    taken = require("pyogrio.util", extra="geo", what=f"reading {path.suffix}").vsi_path(name)
    if taken != name:
        raise FileFormatError(
            f"{path}: GDAL takes this name for {taken}; rename the file or its folder, "
            "without !, ? and ;"
        )
    return name


def _absolute(path: Path) -> str:
    name = os.path.abspath(path)
    if os.sep == "/":
        # Two slashes may begin a path, and begin a host in an address.
        name = "/" + name.lstrip("/")
    if name.startswith("/vsi"):
        raise FileFormatError(f"{path}: names that begin with /vsi are GDAL's; move the file")
    return name


def _check_beginning(path: Path) -> None:
    """Refuse a file that does not begin as its suffix says."""
    with path.open("rb") as file:
        head = file.read(100)
    suffix = path.suffix.lower()
    if suffix == ".shp":
        right = head.startswith(_SHAPEFILE)
    elif suffix == ".fgb":
        size = int.from_bytes(head[8:12], "little")
        right = head[:4] == b"fgb\x03" and head[4:7] == b"fgb" and 4 <= size <= _LONGEST_HEADER
    else:
        right = head.startswith(_SQLITE) and head[68:72] in _GEOPACKAGES
    if not right:
        raise FileFormatError(f"{path} is no {suffix} file: it does not begin like one")


def _check_tables(path: Path) -> None:
    """Refuse a GeoPackage with tables and views that SQLite alone could not read.

    GDAL brings functions and virtual tables that open files. SQLite here has none of them: what it
    can prepare needs none.
    """
    name = ""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as base:
            query = "SELECT name, sql FROM sqlite_master WHERE type IN ('table', 'view')"
            for name, sql in base.execute(query).fetchall():
                # An index of places is SQLite's own, but not built into every SQLite.
                if not re.search(r"\bUSING\s+[\"']?rtree\b", str(sql), re.IGNORECASE):
                    quoted = str(name).replace('"', '""')
                    base.execute(f'EXPLAIN SELECT * FROM "{quoted}"').close()
    except sqlite3.Error as error:
        what = f"its table or view {name!r} is refused" if name else "it cannot be read"
        raise FileFormatError(
            f"{path}: {what}: {error}. Tables and views that need more than SQLite itself are not "
            "opened; copy the rows into a plain table"
        ) from error


def _json_name(path: Path, source: str) -> str:
    """Return the name that leaves GDAL the driver of GeoJSON alone."""
    with path.open("rb") as file:
        if os.fstat(file.fileno()).st_size:
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                _check_systems(content, source)
    return f"GeoJSON:{_absolute(path)}"


def _check_systems(content: mmap.mmap, source: str) -> None:
    """Refuse GeoJSON with reference systems that are links, addresses or files.

    Only what is not spelled as usual makes it necessary to parse the file here, too.
    """
    for key in _KEY.finditer(content):
        usual = _USUAL.match(content, key.end())
        if usual is None:
            _parse(content[:], source)
            return
        if usual["name"] is not None:
            check_system(usual["name"].decode("utf-8", errors="replace"), source)


class _Members(list[tuple[str, Any]]):
    """An object of JSON, with names that are there twice: GDAL may take either."""


def _parse(content: bytes, source: str) -> None:
    """Look at all members ``crs``, however they are spelled and wherever they stand."""

    def look(members: list[tuple[str, Any]]) -> _Members:
        for key, value in members:
            if key.casefold() == "crs" and isinstance(value, _Members):
                _check_member(value, source)
        return _Members(members)

    try:
        json.loads(content.removeprefix(b"\xef\xbb\xbf"), object_pairs_hook=look)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"{source} is no JSON: {error}") from error


def _check_member(system: _Members, source: str) -> None:
    """Refuse a member ``crs`` that is a link, or names a file in some way."""
    for key, value in system:
        if key.casefold() == "type" and not str(value).casefold().startswith(_KINDS):
            raise FileFormatError(
                f"{source}: its reference system is a {str(value)!r:.40}, which is not followed: "
                'remove the member "crs", or give it a name'
            )
    for text in _texts(system):
        check_system(text, source)


def _texts(value: Any) -> list[str]:
    if isinstance(value, _Members):
        value = [item for _, item in value]
    if isinstance(value, list):
        return [text for item in value for text in _texts(item)]
    return [value] if isinstance(value, str) else []
