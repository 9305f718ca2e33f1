"""
Small tetrahedra near chosen faces
==================================

The space between a ball and a box around it, as for the flow around a body, is filled with tetrahedra. They are small at the
ball, and grow with the distance from it.

Install: ``pip install "delone[pyvista]"``.
"""

import numpy as np

import delone

# %%
# The surfaces: a box, and a ball from a hull of points on a sphere. The ball has marker 2, so that a solver finds it.

step = np.arange(400) + 0.5
height, turn = 1 - 2 * step / 400, np.pi * (1 + np.sqrt(5)) * step
radius = np.sqrt(1 - height**2)
ball = delone.ConvexHull(np.column_stack((radius * np.cos(turn), radius * np.sin(turn), height)))
box = delone.ConvexHull([(x, y, z) for x in (-4, 8) for y in (-4, 4) for z in (-4, 4)])
points = np.concatenate((box.points, ball.points))
faces = np.concatenate((box.simplices, ball.simplices + len(box.points)))
markers = np.repeat((1, 2), (len(box.simplices), len(ball.simplices)))

# %%
# Edges of about 0.15 at the ball, growing by a quarter of the distance, up to 1.5. With ``inside="parity"``, the ball is empty.

size = delone.SizeByDistance(points, faces[markers == 2], near=0.15, growth=0.25, far=1.5)
mesh = delone.tetrahedralize(
    points, faces, face_markers=markers, inside="parity", boundary="surface", size=size
)
print(mesh.report)
lengths = np.cbrt(6 * np.sqrt(2) * mesh.volumes)
away = size.distance(mesh.points[mesh.simplices].mean(axis=1))
for low, high in ((0, 0.25), (0.25, 1), (1, 2), (2, 4), (4, 8)):
    part = lengths[(away >= low) & (away < high)]
    print(
        f"{low} to {high} from the ball: {len(part):,} tetrahedra, median edge {np.median(part):.2f}"
    )

# %%
# One half of the mesh, colored by the size that was asked for.

plotter = mesh.plot(values=size(mesh.points[mesh.simplices].mean(axis=1)), cut="y")
plotter.show()
