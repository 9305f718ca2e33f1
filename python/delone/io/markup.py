"""Safe XML: without a document type there are no entities, internal or external."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.parsers import expat

from delone.errors import FileFormatError

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["refuse_document_type"]

_BLOCK = 1 << 16


class _RootError(Exception):
    """The root element has begun; a document type could only precede it."""


def refuse_document_type(path: Path) -> None:
    """Reject XML with a document type; errors in the XML are left to its reader."""

    def document_type(*_: object) -> None:
        raise FileFormatError(
            f"{path} has a document type (DOCTYPE), which may define entities that refer to "
            "other files; such files are not read; remove it"
        )

    def root(*_: object) -> None:
        raise _RootError

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = document_type
    parser.StartElementHandler = root
    try:
        with path.open("rb") as file:
            while block := file.read(_BLOCK):
                parser.Parse(block)
    except (_RootError, expat.ExpatError):
        pass
