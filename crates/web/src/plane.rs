//! 2-D triangulations: triangles, cells, circles, location.

use delone::arrays::Diagram2;
use delone::{Error, Location, Method, Options, Point2, Result, Tiling, Triangulation};
use delone_core::voronoi;
use delone_core::watch::Watch;
use delone_core::{hull, measure};
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, answer, pairs, repeats, rows, signed};

/// Names of the methods.
#[wasm_bindgen]
pub fn methods() -> Vec<String> {
    Method::NAMES
        .iter()
        .map(|(name, _)| (*name).into())
        .collect()
}

/// The version of the core.
#[wasm_bindgen]
pub fn version() -> String {
    option_env!("DELONE_VERSION").unwrap_or("unknown").into()
}

/// Integers: triangles, neighbors, hull, duplicates.
#[wasm_bindgen]
pub fn triangulate(xy: &[f64], method: &str) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let made = delaunay(points, method)?;
        let hull = extreme(points)?;
        let duplicates = repeats(made.duplicates());
        let (triangles, neighbors) = Tiling::from(made).into_arrays();
        let arrays = [triangles.into_flattened(), neighbors.into_flattened()];
        Ok(([&arrays[..], &[hull, duplicates]].concat(), vec![]))
    })
}

/// Integers: the rows of the convex hull.
#[wasm_bindgen]
pub fn convex_hull(xy: &[f64]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        Tiling::<2, 3>::from_arrays(points, &[], &[])?;
        let hull = extreme(points)?;
        if hull.len() < 3 {
            delaunay(points, "auto")?;
        }
        Ok((vec![hull], vec![]))
    })
}

fn extreme(points: &[Point2]) -> Result<Vec<i32>> {
    Ok(signed(hull::hull2(points, &Watch::idle())?.0))
}

fn delaunay<'a>(points: &'a [Point2], method: &str) -> Result<Triangulation<'a>> {
    let names: Vec<String> = Method::NAMES
        .iter()
        .map(|(n, _)| format!("'{n}'"))
        .collect();
    let text = || format!("method must be one of {}, got '{method}'", names.join(", "));
    let method = Method::named(method).ok_or_else(|| Error::Option(text()))?;
    Options::new().threads(1).method(method).triangulate(points)
}

/// Checked triangles without neighbors.
fn triangles<'a>(points: &[Point2], flat: &'a [i32]) -> Result<&'a [[i32; 3]]> {
    let triangles = rows::<3>(flat);
    let alone = vec![[-1; 3]; triangles.len()];
    Tiling::from_arrays(points, triangles, &alone)?;
    Ok(triangles)
}

/// Numbers: centers.
#[wasm_bindgen]
pub fn circumcenters(xy: &[f64], corners: &[i32]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let triangles = triangles(points, corners)?;
        let centers = measure::circumcenters2(points, triangles, 1, &Watch::idle())?;
        Ok((vec![], vec![centers.into_flattened()]))
    })
}

/// Numbers: the smallest angle and the area of each triangle.
#[wasm_bindgen]
pub fn qualities(xy: &[f64], corners: &[i32]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let triangles = triangles(points, corners)?;
        let [angles, ..] = measure::qualities2(points, triangles, 1, &Watch::idle())?;
        let areas = measure::areas(points, triangles, 1, &Watch::idle())?;
        Ok((vec![], vec![angles, areas]))
    })
}

/// Cells cut to a box. Integers: starts, and the point across each edge; numbers: corners, areas.
#[wasm_bindgen]
pub fn cells(xy: &[f64], left: f64, bottom: f64, right: f64, top: f64) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let made = delaunay(points, "auto")?;
        let options = Options::new().threads(1);
        let diagram = Diagram2::from(options.voronoi(&made)?);
        let (low, high) = ([left, bottom], [right, top]);
        // This call checks the box.
        options.voronoi(&made)?.clip(low, high)?;
        let (ridges, regions) = (&diagram.ridges, &diagram.regions);
        let cells = voronoi::Cells {
            points,
            weights: &[],
            vertices: &diagram.vertices,
            sites: &ridges.sites,
            ends: &ridges.ends,
            rays: &ridges.rays,
            beyond: &ridges.beyond,
            site: &regions.site,
            starts: &regions.starts,
            entry_vertices: &regions.vertices,
            entry_ridges: &regions.ridges,
        };
        let watch = Watch::idle();
        let cut = voronoi::clip(cells, low, high, 1, &watch)?;
        let measures = voronoi::measures(&cut.starts, &cut.points, 1, &watch)?;
        let (mut starts, mut across) = (vec![0], vec![]);
        let (mut corners, mut areas) = (vec![], vec![]);
        for row in 0..points.len() {
            // A row that repeats a point has the cell of that point, which is listed once.
            let cell = regions.of_point[row];
            if let Ok(cell) = usize::try_from(cell)
                && regions.site[cell] as usize == row
            {
                let range = cut.starts[cell] as usize..cut.starts[cell + 1] as usize;
                corners.extend_from_slice(cut.points[range.clone()].as_flattened());
                across.extend(cut.ridges[range].iter().map(|&ridge| {
                    let pair = usize::try_from(ridge).ok().map(|r| ridges.sites[r]);
                    pair.map_or(-1, |[a, b]| if a as usize == row { b } else { a })
                }));
                areas.push(measures.areas[cell]);
            } else {
                areas.push(0.0);
            }
            starts.push(across.len() as i32);
        }
        Ok((vec![starts, across], vec![corners, areas]))
    })
}

/// Integers: the triangle of each query or -1, and the nearest vertex; numbers: weights.
#[wasm_bindgen]
pub fn locate(xy: &[f64], corners: &[i32], neighbors: &[i32], queries: &[f64]) -> Answer {
    answer(|| {
        let (points, queries) = (pairs(xy), pairs(queries));
        let tiling = Tiling::from_arrays(points, rows(corners), rows(neighbors))?;
        let (mut triangle, mut weights) = (vec![], vec![]);
        for place in tiling.locate(queries)? {
            match place {
                Location::Inside {
                    simplex,
                    weights: w,
                } => {
                    triangle.push(simplex as i32);
                    weights.extend(w);
                }
                Location::Outside { .. } => {
                    triangle.push(-1);
                    weights.extend([f64::NAN; 3]);
                }
            }
        }
        Ok((vec![triangle, nearest(points, queries)?], vec![weights]))
    })
}

/// The nearest of all points, in their own Delaunay triangulation.
fn nearest(points: &[Point2], queries: &[Point2]) -> Result<Vec<i32>> {
    let made = delaunay(points, "auto")?;
    let found = made.nearest(queries)?;
    Ok(found.into_iter().map(|row| row as i32).collect())
}

/// Flips from the given triangles to the Delaunay triangulation. Integers: triangles, and for each
/// flip `[u, v, p, q]`: the edge u v became p q.
#[wasm_bindgen]
pub fn flips(xy: &[f64], corners: &[i32]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let triangles = triangles(points, corners)?;
        let watch = Watch::idle();
        let made = delone_core::delaunay2::lawson::lawson(points, triangles, true, &watch)?;
        let arrays = [
            made.arrays.simplices.into_flattened(),
            made.sequence.into_flattened(),
        ];
        Ok((arrays.into(), vec![]))
    })
}
