"""Meshes as in-memory objects of other libraries.

Every function takes `Parts`: plain arrays and their values. No class of delone is known here; the
classes describe themselves by a method ``_parts``. The libraries are imported on use.
"""
