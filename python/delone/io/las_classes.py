"""LAS and LAZ files with changed classes: everything else in points and header is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.extras import require
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["write_classes"]

# Number of points that are copied at a time.
_BLOCK = 1 << 19


def write_classes(source: Path, target: Path, classes: NDArray[np.uint8], *, packed: bool) -> None:
    """Copy a file that has been read, with these classes; `packed` for LAZ.

    `target` may have a different suffix, as temporary files do.
    """
    laspy = require("laspy", extra="las", what="writing LAS")
    if packed:
        require("lazrs", extra="las", what="writing LAZ")
    end = 0
    with laspy.open(source) as file:
        if len(classes) != file.header.point_count:
            raise FileFormatError(
                f"{source} has {file.header.point_count} points, not {len(classes)}: it has changed"
            )
        with (
            target.open("wb") as stream,
            laspy.open(
                stream, mode="w", header=file.header, do_compress=packed, closefd=False
            ) as copy,
        ):
            for block in file.chunk_iterator(_BLOCK):
                start, end = end, end + len(block)
                block["classification"] = classes[start:end]
                copy.write_points(block)
