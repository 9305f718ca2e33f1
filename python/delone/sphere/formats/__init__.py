"""Model grids in xarray datasets: the convention that a dataset follows, and its cells.

Each file reads a family of conventions; `reading` recognizes them. Nothing is guessed: units, first
indices and fill values are those that a dataset states or its convention defines.
"""

from __future__ import annotations

from delone.sphere.formats.cells import Cells, Choices
from delone.sphere.formats.described import describing, kept_of_target
from delone.sphere.formats.reading import read_cells
from delone.sphere.formats.variables import variables_of

__all__ = ["Cells", "Choices", "describing", "kept_of_target", "read_cells", "variables_of"]
