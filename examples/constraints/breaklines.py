"""
Breaklines: keep the crest of a dike sharp
==========================================

Scattered heights do not show where a slope breaks. The triangles between them cut corners, so the crest of a
dike becomes jagged. Surveyed lines along the breaks, kept as edges, solve this.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

import delone

# %%
# A dike bends through 300 m by 150 m of flat land. It is 5 m high, its crest is 4 m wide, and its slopes are 1 to 3. A
# survey has 1,500 heights.


def axis(x):
    """Return the y-coordinate of the centerline of the dike."""
    return 75 + 30 * np.sin(x / 60)


def height(points):
    """Return the height of the ground, in meters."""
    x, y = np.asarray(points).T
    across = np.abs(y - axis(x)) / np.hypot(1, 0.5 * np.cos(x / 60))
    return np.clip(5 - (across - 2) / 3, 0, 5)


survey = np.random.default_rng(3).uniform((0, 0), (300, 150), (1500, 2))

# %%
# The four breaklines, two along the crest and two at the feet, have a vertex every 5 m. Their points come after those
# of the survey, and also have heights.

x = np.linspace(0, 300, 61)
lines = []
for offset in (-17, -2, 2, 17):
    lines.append(np.column_stack((x, axis(x) + offset * np.hypot(1, 0.5 * np.cos(x / 60)))))
points = np.vstack((survey, *lines))
first = len(survey) + 61 * np.arange(4)[:, None] + np.arange(60)
segments = np.column_stack((first.ravel(), first.ravel() + 1))

without = delone.interpolate.Linear(survey, height(survey))
mesh = delone.ConstrainedDelaunay(points, segments)
with_lines = delone.interpolate.Linear(mesh, height(points))
assert mesh.validate()

# %%
# Points alone do not keep an edge. The points of the breaklines without their segments help, but triangles still
# cross the crest where survey points are close to it.

alone = delone.Delaunay(points)
edges = {tuple(edge) for edge in np.sort(alone.edges, axis=1).tolist()}
lost = sum(tuple(edge) not in edges for edge in np.sort(segments, axis=1).tolist())
print(f"{lost} of {len(segments)} segments are not edges of the unconstrained triangulation")

grid = np.stack(np.meshgrid(np.arange(5, 296, 0.5), np.arange(5, 146, 0.5)), axis=-1)
truth = height(grid.reshape(-1, 2)).reshape(grid.shape[:2])
surfaces = {"without breaklines": without(grid), "with breaklines": with_lines(grid)}
for name, surface in surfaces.items():
    error = surface - truth
    print(f"{name}: rms {np.sqrt(np.nanmean(error**2)):.3f} m, worst {np.nanmax(abs(error)):.2f} m")

# %%
# A common mistake is to forget the vertices that ``crossing="split"`` adds where breaklines cross. They have no height
# yet, and ``values`` needs one for each row of ``mesh.points``.

track = np.array([(152.0, 20.0), (157.0, 140.0)])
ends = [(len(points), len(points) + 1)]
crossed = delone.ConstrainedDelaunay(
    np.vstack((points, track)), np.vstack((segments, ends)), crossing="split"
)
try:
    delone.interpolate.Linear(crossed, height(np.vstack((points, track))))
except delone.DeloneError as error:
    print(f"{type(error).__name__}: {error}")

# %%
# Hill shading shows the jagged crest.

figure, axes = plt.subplots(2, 1, figsize=(7, 7.4), layout="constrained", sharex=True)
for ax, (name, surface) in zip(axes, surfaces.items(), strict=True):
    shade = LightSource(315, 40).hillshade(np.nan_to_num(surface), vert_exag=4, dx=0.5, dy=0.5)
    ax.imshow(shade, cmap="gray", origin="lower", extent=(5, 296, 5, 146))
    ax.set(title=f"A dike {name}", ylabel="m")
ax.plot(*np.stack(lines).transpose(2, 1, 0), color="crimson", linewidth=0.8)
ax.set(xlabel="m", xlim=(5, 296), ylim=(5, 146))
plt.show()
