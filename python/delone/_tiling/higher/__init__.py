"""Triangulations in four to eight dimensions.

`dimension` contains the table of functions for each dimension. Simplices have d + 1 corners.
Features that need angles, edges of triangles or the surface of a solid are not available here.
"""
