"""Safe opening of files with GDAL: only the given file, only with the driver of its suffix.

GDAL chooses a driver by the contents of a file. Some drivers read virtual datasets, pipelines and
service descriptions, which open other files and send requests, and pyogrio has no option to
restrict the drivers. Therefore a binary file must begin as its suffix says, in a way that no other
driver accepts, and JSON is opened with a prefix that leaves GDAL one driver. References that
GeoJSON, GeoPackage and SQLite files can contain are checked before GDAL opens the file.
"""

from __future__ import annotations

import mmap
import os
import re
import sqlite3
import tempfile
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from delone._base.bounded import largest
from delone._base.extras import require
from delone._base.files import loaded
from delone.errors import FileFormatError
from delone.io.companions import require_companions
from delone.io.compressed import SUFFIXES, Bounded, corrupt_is_an_error, opened
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["DRIVERS", "admitted", "check_driver", "local_name"]

# GDAL's names of the only drivers that may read files with these suffixes.
DRIVERS = {
    ".geojson": "GeoJSON",
    ".json": "GeoJSON",
    ".gpkg": "GPKG",
    ".sqlite": "SQLite",
    ".shp": "ESRI Shapefile",
    ".fgb": "FlatGeobuf",
}
_SHAPEFILE, _SQLITE = b"\x00\x00\x27\x0a", b"SQLite format 3\x00"
# "Application ids" of GeoPackage 1.0, 1.1 and later, at byte 68.
_GEOPACKAGES = (b"GP10", b"GP11", b"GPKG")
_DATABASES = ("GPKG", "SQLite")
# GDAL treats longer headers of FlatGeobuf as corrupt. Shorter ones have a zero byte in their size,
# which ends the search of other drivers for their keywords.
_LONGEST_HEADER = 10 << 20

# The key "crs" in any spelling of JSON, and what usually follows if it is harmless.
_KEY = re.compile(
    rb"[\"'](?:[cC]|\\u00[46]3)(?:[rR]|\\u00[57]2)(?:[sS]|\\u00[57]3)[\"']", re.DOTALL
)
_USUAL = re.compile(
    rb'\s*(?:[,}\]]|:\s*(?:null|"[^"\\]*"|-?[\d.]+|\{\s*"type"\s*:\s*"name"\s*,\s*"properties"'
    rb'\s*:\s*\{\s*"name"\s*:\s*"(?P<name>[^"\\]*)"\s*\}\s*\}))'
)
_KINDS = ("name", "epsg", "ogc")
# Files with the same name in the same folder that GDAL and SQLite read.
_COMPANIONS = {
    **dict.fromkeys(_DATABASES, ("-wal", "-shm", "-journal")),
    "ESRI Shapefile": (
        *(".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx", ".idm", ".ind"),
        *(".SHX", ".DBF", ".PRJ", ".CPG", ".QIX", ".SBN", ".SBX", ".IDM", ".IND"),
    ),
}
# The action of SQLite's authorizer for a function call, which sqlite3 names from Python 3.12 on.
_FUNCTION = 31
_UNSTEADY = {
    *("random", "randomblob", "changes", "total_changes", "last_insert_rowid", "sqlite_version"),
    *("sqlite_source_id", "sqlite_compileoption_get", "sqlite_compileoption_used"),
}
# Steps of SQLite's virtual machine between two checks of their number: about 10 microseconds.
_STEPS = 1 << 10
# LIKE takes time proportional to the product of the lengths of pattern and text.
_LONGEST_PATTERN = 1 << 10


@contextmanager
def admitted(path: Path) -> Iterator[str]:
    """Yield the absolute path of a file for GDAL, with a prefix if that restricts the driver.

    A file that is not what its suffix says, or refers to something else, is rejected.
    """
    if path.suffix.lower() in SUFFIXES:
        with tempfile.TemporaryDirectory(prefix="delone-") as folder:
            plain = Path(folder) / "decompressed.geojson"
            with (
                corrupt_is_an_error(str(path)),
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
    require_companions(path, _COMPANIONS.get(driver, ()))
    if driver in _DATABASES:
        _check_tables(path)
    notes = path.with_name(path.name + ".aux.xml")
    if driver not in _DATABASES or not os.path.lexists(notes):
        yield local_name(path)
        return
    # GDAL follows references in its .aux.xml files; it does not find them in another folder.
    with tempfile.TemporaryDirectory(prefix="delone-") as folder:
        alias = Path(folder) / f"alias{path.suffix}"
        try:
            alias.symlink_to(path.resolve())
        except OSError as error:
            raise FileFormatError(
                f"{path}: remove {notes.name}, whose references GDAL follows"
            ) from error
        yield local_name(alias)


def check_driver(path: Path, driver: str) -> None:
    """Reject a file that was not opened by the driver of its suffix."""
    wanted = DRIVERS.get(path.suffix.lower(), "GeoJSON")
    if driver != wanted:
        raise FileFormatError(
            f"{path} is not a {path.suffix.lower()} file: GDAL reads it as {driver}"
        )


def local_name(path: Path) -> str:
    """Return the absolute path of a file, unless pyogrio or GDAL read it as an archive or a URL."""
    name = _absolute(path)
    taken = require("pyogrio.util", extra="geo", what=f"reading {path.suffix}").vsi_path(name)
    if taken != name:
        raise FileFormatError(
            f"{path}: GDAL reads this name as {taken}; rename the file or its folder, "
            "without !, ? and ;"
        )
    return name


def _absolute(path: Path) -> str:
    name = os.path.abspath(path)
    if os.sep == "/":
        # Two slashes may begin a path, but in a URL they begin a host.
        name = "/" + name.lstrip("/")
    if name.startswith("/vsi"):
        raise FileFormatError(
            f"{path}: names that begin with /vsi are reserved by GDAL; move the file"
        )
    return name


def _check_beginning(path: Path) -> None:
    """Reject a file that does not begin as its suffix says."""
    with path.open("rb") as file:
        head = file.read(100)
    suffix = path.suffix.lower()
    if suffix == ".shp":
        right = head.startswith(_SHAPEFILE)
    elif suffix == ".fgb":
        size = int.from_bytes(head[8:12], "little")
        right = head[:4] == b"fgb\x03" and head[4:7] == b"fgb" and 4 <= size <= _LONGEST_HEADER
    else:
        right = head.startswith(_SQLITE) and (head[68:72] in _GEOPACKAGES) == (suffix == ".gpkg")
    if not right:
        raise FileFormatError(f"{path} is not a {suffix} file: it does not begin like one")


def _check_tables(path: Path) -> None:
    """Reject a database with tables or views that SQLite alone cannot read, or cannot finish.

    GDAL's functions and virtual tables open files; SQLite here has none, so it rejects their use.
    """
    name = ""
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as base:
            query = "SELECT name, type, sql FROM sqlite_master WHERE type IN ('table', 'view')"
            found = base.execute(query).fetchall()
            for name, _, sql in found:
                # The R-tree belongs to SQLite, but not every build of SQLite has it.
                if not re.search(r"\bUSING\s+[\"']?rtree\b", str(sql), re.IGNORECASE):
                    base.execute(f"EXPLAIN SELECT * FROM {_quoted(name)}").close()
            computed = [
                name
                for name, kind, sql in found
                if kind == "view" or re.search(r"\bAS\s*\(", str(sql), re.IGNORECASE)
            ]
            _limit(base, path)
            for name in computed:
                _require_end(base, name, path)
    except (sqlite3.Error, sqlite3.Warning) as error:
        what = f"its table or view {name!r:.60} is rejected" if name else "it cannot be read"
        raise FileFormatError(
            f"{path}: {what}: {error!s:.100}. Tables and views that need more than plain SQLite, "
            "such as those of SpatiaLite, are not opened; copy the rows into a plain table or a "
            "GeoPackage"
        ) from error


def _quoted(name: Any) -> str:
    quoted = str(name).replace('"', '""')
    return f'"{quoted}"'


def _limit(base: sqlite3.Connection, path: Path) -> None:
    """Bound the cost of reading tables and views by the size of the file.

    SQLite stops after a number of steps, and at long values. Functions whose value differs in
    GDAL's SQLite, or from call to call, are rejected: what is tested must be what GDAL will read.
    """
    most, calls = largest(path.stat().st_size, text=True), 0

    def stop() -> int:
        nonlocal calls
        calls += 1
        return int(calls * _STEPS > most)

    def admit(action: int, _: str | None, name: str | None, *__: str | None) -> int:
        denied = action == _FUNCTION and (name or "").casefold() in _UNSTEADY
        return sqlite3.SQLITE_DENY if denied else sqlite3.SQLITE_OK

    base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, most)
    base.setlimit(sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH, _LONGEST_PATTERN)
    base.set_progress_handler(stop, _STEPS)
    base.set_authorizer(admit)


def _require_end(base: sqlite3.Connection, name: str, path: Path) -> None:
    """Read all rows of a table or view; a recursive one may have no last row."""
    most, seen = largest(path.stat().st_size, text=True), 0
    base.text_factory = bytes
    try:
        # Terminates with the rows, or after the steps that the progress handler allows.
        for row in base.execute(f"SELECT * FROM {_quoted(name)}"):
            seen += sum(len(value) if isinstance(value, bytes) else 8 for value in row)
            if seen > most:
                raise FileFormatError(
                    f"{path}: its table or view {name!r:.60} has more than {most:,} bytes, far "
                    "more than the file; copy the rows into a plain table"
                )
    except sqlite3.OperationalError as error:
        if str(error) != "interrupted":
            raise
        raise FileFormatError(
            f"{path}: its table or view {name!r:.60} takes more than {most:,} steps of SQLite, far "
            "more than the size of the file explains; copy the rows into a plain table"
        ) from error


def _json_name(path: Path, source: str) -> str:
    """Return the name with which GDAL uses only its GeoJSON driver."""
    with path.open("rb") as file:
        if os.fstat(file.fileno()).st_size:
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
                _check_systems(content, source)
    return f"GeoJSON:{_absolute(path)}"


def _check_systems(content: mmap.mmap, source: str) -> None:
    """Reject GeoJSON with reference systems that are links, URLs or files.

    The file is parsed here only if one is spelled in an unusual way.
    """
    for key in _KEY.finditer(content):
        usual = _USUAL.match(content, key.end())
        if usual is None:
            _parse(content[:], source)
            return
        if usual["name"] is not None:
            check_system(usual["name"].decode("utf-8", errors="replace"), source)


class _Members(list[tuple[str, Any]]):
    """A JSON object that keeps repeated names: GDAL may use either."""


def _parse(content: bytes, source: str) -> None:
    """Check all members ``crs``, however spelled and wherever they are."""

    def look(members: list[tuple[str, Any]]) -> _Members:
        for key, value in members:
            if key.casefold() == "crs" and isinstance(value, _Members):
                _check_member(value, source)
        return _Members(members)

    loaded(content.removeprefix(b"\xef\xbb\xbf"), source, look)


def _check_member(system: _Members, source: str) -> None:
    """Reject a member ``crs`` that is a link, or refers to a file in any way."""
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
