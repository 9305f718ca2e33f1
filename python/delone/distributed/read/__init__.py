"""A finished output: one tile, the whole, its proof, tables and rasters of it."""
