"""Meshes as in-memory objects of other libraries.

Every function takes `Parts`: plain arrays and their values. delone's classes are not known here;
they describe themselves by a method ``_parts``. The libraries are imported on use.
"""
