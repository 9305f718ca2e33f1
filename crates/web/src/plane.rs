//! 2-D triangulations: triangles, cells, circles, location.

use delone_core::base::arrays::Given;
use delone_core::delaunay::plane::{self, Method, Triangulation};
use delone_core::base::error::{Error, Result};
use delone_core::locate::{self, Batch, Kept, Locator};
use delone_core::base::points::scan;
use delone_core::base::watch::Watch;
use delone_core::{hull, measure, voronoi};
use delone_predicates::Point2;
use wasm_bindgen::prelude::*;

use crate::answer::{Answer, Failure, Outcome, answer, pairs, repeats, rows, signed};

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
        let duplicates = repeats(&made.duplicates);
        let (triangles, neighbors) = (made.arrays.simplices, made.arrays.neighbors);
        let arrays = [triangles.into_flattened(), neighbors.into_flattened()];
        Ok(([&arrays[..], &[hull, duplicates]].concat(), vec![]))
    })
}

/// Integers: the rows of the convex hull.
#[wasm_bindgen]
pub fn convex_hull(xy: &[f64]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        scan(points)?;
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

fn delaunay(points: &[Point2], method: &str) -> Outcome<Triangulation> {
    let names: Vec<String> = Method::NAMES
        .iter()
        .map(|(n, _)| format!("'{n}'"))
        .collect();
    let text = || format!("method must be one of {}, got '{method}'", names.join(", "));
    let method = Method::named(method).ok_or_else(|| Failure::Input(text(), None))?;
    Ok(plane::triangulate(points, method, 1, &Watch::idle())?)
}

/// Checked triangles.
fn triangles<'a>(points: &[Point2], flat: &'a [i32]) -> Result<&'a [[i32; 3]]> {
    scan(points)?;
    let triangles = rows::<3>(flat);
    require_range(triangles, 0, points.len(), "simplices")?;
    Ok(triangles)
}

/// Checks that every entry lies in `from..to`.
fn require_range(table: &[[i32; 3]], from: i32, to: usize, name: &str) -> Result<()> {
    let outside = |v: &i32| *v < from || i64::from(*v) >= to as i64;
    match table.iter().position(|row| row.iter().any(outside)) {
        None => Ok(()),
        Some(row) => {
            let text = format!("{name}: row {row} has an entry outside {from}..{to}");
            Err(Error::Shape(text))
        }
    }
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
        let (low, high) = ([left, bottom], [right, top]);
        let valid = |k: usize| low[k].is_finite() && high[k].is_finite() && low[k] < high[k];
        if !(valid(0) && valid(1)) {
            let text = format!("the box from {low:?} to {high:?} has no finite positive area");
            return Err(Failure::Input(text, None));
        }
        let watch = Watch::idle();
        let dual = voronoi::Given {
            points,
            weights: &[],
            simplices: &made.arrays.simplices,
            neighbors: &made.arrays.neighbors,
        };
        let diagram = voronoi::diagram(dual, 1, &watch)?;
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
        let given = Given {
            points,
            simplices: triangles(points, corners)?,
            neighbors: rows(neighbors),
        };
        if given.neighbors.len() != given.simplices.len() {
            return Err(Error::Shape("neighbors and simplices differ in length".into()).into());
        }
        require_range(given.neighbors, -1, given.simplices.len(), "neighbors")?;
        let found = located(given, queries, locate::coordinates)?;
        let nearest = nearest(points, queries)?;
        Ok((vec![found.triangle, nearest], vec![found.weights]))
    })
}

/// What `locate` finds for queries.
pub fn located<T>(
    given: Given<2, 3>,
    queries: &[Point2],
    locate: impl Fn(&Batch) -> Result<T>,
) -> Result<T> {
    scan(queries)?;
    let watch = Watch::idle();
    let index = Kept::of(&given, &watch)?;
    locate(&Batch {
        locator: Locator::new(given, &index, &watch),
        queries,
        workers: 1,
        watch: &watch,
    })
}

/// The nearest of all points, in their own Delaunay triangulation.
fn nearest(points: &[Point2], queries: &[Point2]) -> Outcome<Vec<i32>> {
    let made = delaunay(points, "auto")?;
    let given = Given {
        points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    Ok(located(given, queries, locate::nearest)?)
}

/// Flips from the given triangles to the Delaunay triangulation. Integers: triangles, and for each
/// flip `[u, v, p, q]`: the edge u v became p q.
#[wasm_bindgen]
pub fn flips(xy: &[f64], corners: &[i32]) -> Answer {
    answer(|| {
        let points = pairs(xy);
        let triangles = triangles(points, corners)?;
        let watch = Watch::idle();
        let made = delone_core::delaunay::plane::lawson::lawson(points, triangles, true, &watch)?;
        let arrays = [
            made.arrays.simplices.into_flattened(),
            made.sequence.into_flattened(),
        ];
        Ok((arrays.into(), vec![]))
    })
}
