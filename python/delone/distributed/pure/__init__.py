"""Tiles, certain triangles and updates by answers, as pure functions: no files, no tasks."""
