"""Reference systems in files: warnings for formats that cannot store one, and CF names."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from delone._base.extras import require
from delone._base.files import path_of
from delone._base.georeference import CRSWarning
from delone.errors import FileFormatError

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

__all__ = ["cf_attributes", "left_out", "warn_if_left_out"]


def left_out(path: str | os.PathLike[str], crs: str | None, known: Sequence[str]) -> str | None:
    """Return a warning that a file will not contain a reference system; None if nothing is lost.

    `known` contains the suffixes of formats that can store one.
    """
    suffix = path_of(path).suffix.lower()
    if crs is None or suffix in known:
        return None
    return (
        f"{path}: {suffix} files cannot store a reference system; "
        f"{crs.partition(chr(10))[0]:.60} is not in the file. Use {', '.join(known)}"
    )


def warn_if_left_out(path: str | os.PathLike[str], crs: str | None, known: Sequence[str]) -> None:
    """Warn that a file will not contain the given reference system; see `left_out`."""
    message = left_out(path, crs, known)
    if message is not None:
        warnings.warn(message, CRSWarning, stacklevel=3)


def cf_attributes(
    crs: str | None,
) -> tuple[dict[str, Any] | None, dict[str, Any], dict[str, Any]]:
    """Return the CF attributes of the grid mapping (None without a system), of x and of y."""
    if crs is None:
        return None, {"axis": "X"}, {"axis": "Y"}
    pyproj = require("pyproj", extra="geo", what="writing a reference system to NetCDF")
    try:
        system = pyproj.CRS.from_user_input(crs)
    except (pyproj.exceptions.CRSError, ValueError) as error:
        raise FileFormatError(f"pyproj does not know the reference system {crs!r:.80}") from error
    axes = {each["axis"]: each for each in system.cs_to_cf()}
    return system.to_cf(), axes.get("X", {"axis": "X"}), axes.get("Y", {"axis": "Y"})
