"""Reading a finished output: tiles, validation, tables and rasters."""
