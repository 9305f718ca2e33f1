"""
All products of a survey with one command
=========================================

``delone terrain`` reads and triangulates a survey once. It writes contours, rasters and profiles into a folder, and a page
that shows them.

Install: ``pip install "delone[cli,plot,geo,raster]"``.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import geopandas
import matplotlib.pyplot as plt
import numpy as np
import rasterio
import shapely

from delone.datasets import ahn3

survey = ahn3()
ground = survey.attributes["classification"] == 2
corner = survey.points.min(axis=0)

# %%
# Write the survey and the axis of a road to files. Both declare their reference system, so none has to be assumed.

folder = Path(tempfile.mkdtemp())
xyz = np.column_stack((survey.points, survey.z))[ground][::4]
places = geopandas.GeoDataFrame(geometry=geopandas.points_from_xy(*xyz.T), crs=survey.crs)
places.to_parquet(folder / "survey.parquet")
road = shapely.LineString(corner + np.array([(75, 5), (77, 50), (70, 95)]))
geopandas.GeoDataFrame(geometry=[road], crs=survey.crs).to_file(folder / "road.gpkg")

# %%
# Run the command. In a terminal::
#
#   delone terrain survey.parquet --max-edge 6 --contours 0.25 --smooth 2 --min-length 8 \
#       --dem 0.5 --hillshade --slope --profile road.gpkg --volume 1.5 --units m -o site

options = "--max-edge 6 --contours 0.25 --smooth 2 --min-length 8 --dem 0.5 --hillshade --slope"
options += " --profile road.gpkg --volume 1.5 --units m -o site"
command = [sys.executable, "-m", "delone", "terrain", "survey.parquet", *options.split()]
done = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
print(done.stdout)
for path in sorted((folder / "site").iterdir()):
    print(f"{path.name:20s} {path.stat().st_size / 1024:7.0f} KiB")

# %%
# ``index.html`` contains the pictures and numbers in one file, which can be sent by e-mail. A common mistake is to run a
# separate command for each product with slightly different options: contours and rasters then show different surfaces.
#
# Other libraries can draw the files.

figure, axes = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
with rasterio.open(folder / "site" / "hillshade.tif") as file:
    left, bottom, right, top = file.bounds
    axes[0].imshow(file.read(1), cmap="gray", vmin=0, vmax=1, extent=(left, right, bottom, top))
contours = geopandas.read_file(folder / "site" / "contours.gpkg")
contours.plot(ax=axes[0], column="level", linewidth=0.6)
geopandas.GeoSeries([road]).plot(ax=axes[0], color="firebrick")
axes[0].set(title="Contours, hillshade and road", xticks=[], yticks=[])
table = np.genfromtxt(folder / "site" / "profile-road.csv", delimiter=",", names=True)
axes[1].plot(table["distance"], table["z"])
axes[1].set(title="Profile of the road", xlabel="distance in m", ylabel="height in m")
plt.show()
