"""What triangulations and diagrams on the sphere have in common: directions, and plots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.immutable import kept, sealed
from delone._tiling.complex import Stored
from delone.sphere.coordinates import lonlat_of, units_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats

__all__ = ["OnGlobe"]


class OnGlobe(Stored):
    """Directions, and arrays on the sphere that are drawn on a globe."""

    __slots__ = ()

    _vectors: Floats
    _workers: int | None

    @property
    def vectors(self) -> Floats:
        """The vectors whose directions are the points or sites, (n, 3)."""
        return self._vectors

    @property
    @kept
    def points(self) -> Floats:
        """The unit vectors of the points or sites, rounded, (n, 3)."""
        return sealed(units_of(self._vectors, self._workers))

    @property
    @kept
    def lonlat(self) -> Floats:
        """Longitudes, -180 to 180, and latitudes in degrees, rounded, (n, 2)."""
        return sealed(lonlat_of(self._vectors))

    @property
    def npoints(self) -> int:
        """Number of rows, duplicates included."""
        return len(self._vectors)

    def _draw(self, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
        """Draw with the options of `plot`."""
        raise NotImplementedError

    def plot(
        self,
        ax: Any = None,
        *,
        values: ArrayLike | None = None,
        view: tuple[float, float] | None = None,
        cmap: Any = "viridis",
        colorbar: bool = True,
        coast: Any = None,
        points: bool | None = None,
        linewidth: float | None = None,
        title: str | None = None,
    ) -> Any:
        """Draw the front half of the globe with matplotlib (extra ``plot``), orthographically.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new ones.
        values : array_like, shape (k,), optional
            A number for each triangle or each cell, which colors it.
        view : tuple of two floats, optional
            Longitude and latitude of the center, in degrees; by default the mean direction.
        cmap : str or matplotlib Colormap, optional
            The colors of values.
        colorbar : bool, optional
            Whether to add the color bar of values.
        coast : mapping, optional
            Land whose coasts are drawn: a GeoJSON multipolygon, such as that of
            `delone.datasets.land`.
        points : bool, optional
            Whether to draw the points or sites; by default up to 2000.
        linewidth : float, optional
            Width of the arcs.
        title : str, optional
            Title of the axes.

        Returns
        -------
        matplotlib Axes
            Where it is drawn. The globe is the unit circle.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            `view` is not a longitude and a latitude, or `values` has the wrong shape.

        Examples
        --------
        >>> import matplotlib
        >>> matplotlib.use("Agg")
        >>> from delone import sphere
        >>> ax = sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90), (45, 45)]).plot(view=(30, 30))
        >>> ax.get_aspect()
        1.0
        """
        options = {
            "values": values,
            "view": view,
            "cmap": cmap,
            "colorbar": colorbar,
            "coast": coast,
            "linewidth": linewidth,
            "title": title,
        }
        return self._draw(ax, points, options)
