"""Triangulations in four to eight dimensions.

`dimension` has the table of functions of each dimension. Simplices have d + 1 corners; what needs
angles, edges of triangles or the surface of a solid does not exist here.
"""
