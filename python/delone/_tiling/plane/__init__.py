"""2-D triangulations: topology, geometry and quality of triangles.

`topology` needs no coordinates, `geometry` computes measures, `quality` assesses shapes, `location`
locates points, and `dimension` is the table of these functions.
"""
