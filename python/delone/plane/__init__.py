"""2-D triangulations: topology, geometry and quality of triangles.

`topology` needs no coordinates, `geometry` measures, `quality` judges, `location` locates points,
and `dimension` is the table of these functions.
"""
