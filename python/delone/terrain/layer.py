"""The base of results for maps: a table with a geometry in each row."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

__all__ = ["Layer"]


class Layer:
    """Elements with a geometry and columns, in the reference system of a surface."""

    crs: str | None
    # The name of the elements, in the plural.
    _ELEMENTS: ClassVar[str]

    def _geometries(self) -> NDArray[Any]:
        """Return a geometry for each element."""
        raise NotImplementedError

    def _fields(self) -> Mapping[str, Any]:
        """Return the columns of the table."""
        raise NotImplementedError

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Return a GeoDataFrame with one row for each element, as a map layer (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each element. The geometry of a GeoDataFrame is
            replaced, its index is kept.
        crs : optional
            Reference system; by default that of the surface.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each element, in order. The class lists the columns.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row for each element, or has a column with the same name as one
            of the table.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.contours(interval=2).to_geopandas().level.tolist()
        [2.0, 4.0, 6.0, 8.0]
        """
        from delone.exchange.geopandas import beside

        own = self.crs if crs is None else crs
        columns = dict(self._fields())
        return beside(self._geometries(), data, own, columns=columns, of=self._ELEMENTS)
