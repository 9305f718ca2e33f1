"""Safe XML in any common encoding: without a document type there are no entities.

The parsers read UTF-8, UTF-16 and single-byte encodings. UTF-32 and those that are common in
East Asia are decoded here, so that every parser sees the same characters.
"""

from __future__ import annotations

import codecs
import re
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any
from xml.parsers import expat

from delone.errors import DeloneError, FileFormatError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["decoded", "refuse_document_type"]

_BLOCK = 1 << 16
_DECLARED = re.compile(rb"<\?xml[^>]*?encoding\s*=\s*[\"']([A-Za-z0-9._:-]{1,40})[\"']")
# Multi-byte encodings, by Python's names. Files that declare the first of a family may also contain
# characters of the last one: Windows programs write these.
_SEVERAL_BYTES = {
    **dict.fromkeys(("gb2312", "gbk", "gb18030"), "gb18030"),
    **dict.fromkeys(("shift_jis", "cp932"), "cp932"),
    **dict.fromkeys(("euc_kr", "cp949"), "cp949"),
    **dict.fromkeys(("big5", "cp950"), "cp950"),
    **{"big5hkscs": "big5hkscs", "euc_jp": "euc_jp", "iso2022_jp": "iso2022_jp"},
}
# How files in UTF-32 begin, with a byte order mark or without one. The UTF-16 mark is a part of it.
_FOUR_BYTES = {
    "utf_32": (codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE),
    "utf_32_le": ("<".encode("utf_32_le"),),
    "utf_32_be": ("<".encode("utf_32_be"),),
}


class _Redeclared:
    """A file in UTF-8 whose declaration says so, whatever it said before.

    Some versions of libxml2 follow the declaration even where the caller names the encoding.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        self._begun = False

    def read(self, size: int = -1) -> bytes:
        """Read about as many bytes; the first block contains the declaration."""
        if self._begun:
            return self._file.read(size)
        self._begun = True
        first = self._file.read(size if size < 0 else max(size, 1 << 10))
        found = _DECLARED.search(first)
        return (
            first if found is None else first[: found.start(1)] + b"UTF-8" + first[found.end(1) :]
        )


class _RootError(Exception):
    """The root element has begun; a document type could only precede it."""


@contextmanager
def decoded(path: Path) -> Iterator[tuple[IO[bytes], str | None]]:
    """Open an XML file; also return the encoding that is used if it is not the declared one."""
    with path.open("rb") as file:
        codec = _codec(file.read(1 << 8), path)
        file.seek(0)
        if codec is None:
            yield file, None
            return
        try:
            # Decoded text is passed on as UTF-8, and declared as such.
            recoded: Any = _Redeclared(codecs.EncodedFile(file, "utf-8", codec))
            yield recoded, "utf-8"
        except UnicodeDecodeError as error:
            raise FileFormatError(
                f"{path} is not in the encoding that it declares, {codec}: {error.reason} "
                f"({error.object[error.start : error.end].hex()})"
            ) from error


def _codec(head: bytes, path: Path) -> str | None:
    """Return the codec for an encoding that parsers do not read, and None for all others."""
    for codec, beginnings in _FOUR_BYTES.items():
        if head.startswith(beginnings):
            return codec
    found = _DECLARED.match(head.lstrip())
    if found is None:
        return None
    name = found[1].decode("ascii")
    try:
        return _SEVERAL_BYTES.get(codecs.lookup(name).name)
    except LookupError as error:
        raise FileFormatError(
            f"{path} declares the encoding {name!r:.80}, which is unknown: convert it to UTF-8"
        ) from error


def refuse_document_type(path: Path) -> None:
    """Reject XML with a document type; errors in the XML are left to its reader."""

    def document_type(*_: object) -> None:
        raise FileFormatError(
            f"{path} has a document type (DOCTYPE), which may define entities that refer to "
            "other files; such files are not read; remove it"
        )

    def root(*_: object) -> None:
        raise _RootError

    with decoded(path) as (file, encoding):
        parser: Any = expat.ParserCreate(encoding)
        parser.StartDoctypeDeclHandler = document_type
        parser.StartElementHandler = root
        try:
            while block := file.read(_BLOCK):
                parser.Parse(block)
        except (_RootError, expat.ExpatError):
            pass
        except (DeloneError, UnicodeDecodeError):
            raise
        except (LookupError, ValueError) as error:
            # The declaration names an encoding that the parser does not support.
            raise FileFormatError(
                f"{path} is in an encoding that is not read ({error}): convert it to UTF-8"
            ) from error
