"""2-D triangulations: topology, geometry and quality of triangles.

`topology` needs no coordinates, `geometry` measures, `quality` judges, and `triangulation` is the
base of all classes that put them to use. `measures` is the base of qualities, in space as well.
"""
