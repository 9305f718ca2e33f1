"""How the values of sites are treated: points that coincide, missing values, rows of tables.

A table of weights needs only this, without triangles, unless it has gradients.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from delone.errors import InputError
from delone.interpolate.values import require_finite_values

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices, Rows
    from delone.interpolate.values import Field

__all__ = ["Policies"]


@dataclass(frozen=True, eq=False)
class Policies:
    """The policies of an interpolator, and the sites of the rows of its tables.

    There are three kinds of rows: the caller's; sites, which are those that were kept; and rows of
    a table, which are sites, copies of periodic ones, or sites once for each side of a constraint.
    """

    npoints: int  # rows of the caller
    workers: int | None
    duplicates: str
    nan: str
    kept: Rows | None  # the caller's row of each site; None if all were kept
    first: Indices | None  # the first site that coincides with each; None if none do
    count: int  # sites
    copies: int = 1  # of each site
    source: Indices | None = None  # the site of each row of a table; None if they are the same

    @property
    def _policies(self) -> Self:
        """These policies, under the same name as in an interpolator."""
        return self

    def _gradients(self, columns: Floats) -> None:
        """Return None: without triangles there are none."""

    def _settled(self, field: Field) -> Floats:
        """Return values for the rows of a table, after the policies; raise if one rejects them."""
        if self.kept is not None:
            field = field.at(self.kept)
        if self.nan == "raise":
            require_finite_values(field)
        if self.first is not None:
            field = field.merged(self.first, self.duplicates)
        if self.copies > 1:
            return field.at(np.repeat(np.arange(self.count), self.copies)).columns
        columns = field.columns
        return columns if self.source is None else np.ascontiguousarray(columns[self.source])

    def caller_rows(self) -> Indices:
        """Return the caller's row that represents each row of a table.

        For sites that coincide, it is the first, or the last with ``duplicates="last"``.
        """
        sites = np.arange(self.count)
        if self.duplicates == "last" and self.first is not None:
            # Assignments to the same row happen in order, so the last one wins.
            sites[self.first] = sites.copy()
        return self._given(sites[self._sites_of_rows()])

    def mixed_rows(self) -> tuple[Rows, Indices] | None:
        """Return the caller's rows that are averaged in each row of a table, as (indptr, rows).

        None if `caller_rows` is sufficient; InputError if the policy takes the smallest or the
        largest value of points that coincide.
        """
        if self.duplicates not in ("mean", "min", "max") or self.first is None:
            return None
        if self.duplicates != "mean":
            raise InputError(
                f"duplicates={self.duplicates!r:.20} selects one value of points that coincide, "
                "which depends on the values; use apply"
            )
        # The sites of a group are adjacent in `order`; each row of a table lists its whole group.
        order = np.argsort(self.first, kind="stable")
        places = self._sites_of_rows()
        starts = np.searchsorted(self.first[order], self.first)[places]
        counts = np.bincount(self.first)[self.first][places]
        indptr = np.concatenate(([0], np.cumsum(counts)))
        within = np.arange(indptr[-1]) - np.repeat(indptr[:-1] - starts, counts)
        return indptr, self._given(order[within])

    def _sites_of_rows(self) -> NDArray[np.integer]:
        if self.source is not None:
            return self.source
        return np.repeat(np.arange(self.count), self.copies)

    def _given(self, sites: NDArray[np.integer]) -> Indices:
        return (sites if self.kept is None else self.kept[sites]).astype(np.int32)
