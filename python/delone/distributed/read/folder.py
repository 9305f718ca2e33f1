"""A finished output on disk: its manifest in memory, its tiles read one at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_index
from delone.distributed.arguments import as_path
from delone.distributed.pure.tiles import Tiles
from delone.distributed.read.tile import Tile, read_tile
from delone.distributed.store.files import Store
from delone.distributed.store.manifest import manifest_of
from delone.distributed.store.output import tile_names
from delone.errors import FileFormatError, InputError

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator
    from pathlib import Path

    from delone import _core

__all__ = ["TileFolder"]


class TileFolder:
    """The manifest and the tiles of an output; the base of `TiledDelaunay`."""

    def __init__(self, store: Store, manifest: dict[str, Any]) -> None:
        self.store = store
        self.manifest = manifest
        counts = [tile["triangles"] for tile in manifest["tiles"]]
        self.starts = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])

    @classmethod
    def _at(cls, output: str | os.PathLike[str]) -> Self:
        """Open a finished output; see `delone.distributed.open`."""
        # Tiles are read later, when the working directory may be different.
        folder = as_path(output, name="output").absolute()
        store = Store(folder)
        if not folder.is_dir():
            raise FileNotFoundError(f"{output}: no such folder")
        manifest = manifest_of(store)
        for tile in range(len(manifest["tiles"])):
            for name in tile_names(tile):
                if not store.exists(name):
                    raise FileFormatError(f"{output} is missing {name}")
        return cls(store, manifest)

    @property
    def npoints(self) -> int:
        """The number of points, including duplicates."""
        return int(self.manifest["points"])

    @property
    def nsimplex(self) -> int:
        """The number of triangles."""
        return int(self.starts[-1])

    @property
    def ntiles(self) -> int:
        """The number of tiles."""
        return len(self.manifest["tiles"])

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top of the points."""
        left, bottom, right, top = self.manifest["bounds"]
        return left, bottom, right, top

    @property
    def crs(self) -> str | None:
        """Coordinate reference system, None if the source has none."""
        crs: str | None = self.manifest["crs"]
        return crs

    @property
    def path(self) -> Path:
        """The folder."""
        return self.store.root

    def _tree(self) -> Tiles:
        """The cells of the tiles, without their boxes."""
        tree = self.manifest["tree"]
        return Tiles(
            np.array(tree["axis"], dtype=np.int8),
            np.array(tree["cut"], dtype=np.float64),
            np.array(tree["children"], dtype=np.int64).reshape(-1, 2),
            np.empty((self.ntiles, 4)),
        )

    def tile(self, number: int) -> Tile:
        """Read one tile.

        Parameters
        ----------
        number : int
            Number of the tile, from 0 to ``ntiles - 1``.

        Returns
        -------
        Tile
            Vertices and triangles.

        Raises
        ------
        InputError
            There is no such tile.
        FileFormatError
            Its files are missing or truncated, lack a column, or have other contents.

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     tile = tin.tile(0)
        >>> int(tile.owned.sum()), len(tile.points) > 100
        (100, True)
        """
        number = as_index(number, 0, self.ntiles - 1, name="number")
        tile = read_tile(self.store, self.manifest, number)
        known = self.manifest["tiles"][number]
        wanted = known["points"] + known["foreign"], known["triangles"]
        for name, rows, right in zip(
            tile_names(number), (len(tile.points), len(tile.simplices)), wanted, strict=True
        ):
            if rows != right:
                raise FileFormatError(
                    f"{self.store.path(name)} has {rows} rows; the manifest says {right}"
                )
        return tile

    def _locator(self, tile: Tile) -> _core.Locator2:
        """Return the point location index of a tile; raise an error with its file if invalid."""
        try:
            return tile._locator()
        except InputError as error:
            path = self.store.path(tile_names(tile.number)[1])
            raise FileFormatError(f"{path} does not contain a mesh: {error}") from error

    def tiles(self) -> Iterator[Tile]:
        """Read all tiles, one by one.

        Returns
        -------
        iterator of Tile
            The tiles by number; each is read when requested.

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     [int(tile.owned.sum()) for tile in tin.tiles()]
        [100, 100, 100, 100]
        """
        return (self.tile(number) for number in range(self.ntiles))

    def _require(self, value: str) -> None:
        """Reject a value that vertices do not have."""
        has = ["z"] if self.manifest["heights"] else []
        has += self.manifest["attributes"]
        if value not in has:
            raise InputError(
                f"{self.path} has no {value!r:.80}; it has {', '.join(has) or 'no values'}"
            )
