//! Proximity graphs as arrays of edges.

use delone_core::base::error::{Error, Result};
use delone_core::graphs::{self, Neighbors, Region, Rule, Skeleton, Tree};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, are_starts, column, columns, each_in_range, flat, in_dimension, in_range,
    number_rows, rows, table,
};
use crate::errors::Outcome;
use crate::given::{not_beside, simplices_of};
use crate::signals::watched;

/// `(edges, duplicates)`.
type Found = (Table<i32>, Table<i32>);

/// The Delaunay graph of points, as Python has it.
#[derive(FromPyObject)]
pub struct Adjacency<'py>(
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, i32>,
);

impl Adjacency<'_> {
    /// The checked arrays.
    fn skeleton<const D: usize>(&self) -> Result<Skeleton<'_, D>> {
        let points: &[[f64; D]] = rows(&self.0, "points")?;
        let edges = rows(&self.1, "edges")?;
        let (starts, neighbors) = (flat(&self.2, "starts")?, flat(&self.3, "neighbors")?);
        in_range(edges, 0, points.len(), "edges")?;
        each_in_range(neighbors, 0, points.len(), "neighbors")?;
        are_starts(starts, neighbors.len())?;
        if starts.len() != points.len() + 1 {
            return Err(Error::Shape(
                "starts must have one entry more than there are points".into(),
            ));
        }
        Ok(Skeleton {
            points,
            edges,
            starts,
            neighbors,
        })
    }
}

/// The region of this name.
fn region(name: &str, beta: f64) -> Result<Region> {
    let within = beta > 1.0 && beta <= 2.0;
    match name {
        "ball" => Ok(Region::Ball),
        "lune" if within => Ok(Region::Lune(beta)),
        "circle" if within => Ok(Region::Arcs(beta)),
        _ => Err(Error::Shape(format!(
            "the region must be ball, or lune or circle with beta above 1 and at most 2; got {name} with beta {beta}"
        ))),
    }
}

/// The Delaunay edges whose region is empty.
#[pyfunction]
pub fn proximity(
    py: Python<'_>,
    graph: Adjacency<'_>,
    name: &str,
    beta: f64,
    closed: bool,
    workers: usize,
) -> Outcome<Table<i32>> {
    in_dimension!(columns(&graph.0), D, N => {
        let (skeleton, region) = (graph.skeleton::<D>()?, region(name, beta)?);
        let found = watched(py, |watch| {
            let tree = match region {
                Region::Lune(_) => Some(Tree::of(skeleton.points, workers, watch)?),
                _ => None,
            };
            graphs::filter(&skeleton, region, closed, tree.as_ref(), workers, watch)
        })?;
        table(py, found)
    })
}

/// The pairs with an empty open diametral ball that are not Delaunay edges.
#[pyfunction]
#[pyo3(signature = (graph, simplices, neighbors, workers))]
pub fn antipodes(
    py: Python<'_>,
    graph: Adjacency<'_>,
    simplices: Option<PyReadonlyArray2<'_, i32>>,
    neighbors: Option<PyReadonlyArray2<'_, i32>>,
    workers: usize,
) -> Outcome<Table<i32>> {
    in_dimension!(columns(&graph.0), D, N => {
        let (skeleton, tiling) = (|| -> Result<_> {
            let skeleton = graph.skeleton::<D>()?;
            let (Some(simplices), Some(neighbors)) = (&simplices, &neighbors) else {
                return Ok((skeleton, None));
            };
            let simplices: &[[i32; N]] = simplices_of(simplices, skeleton.points.len())?;
            let neighbors: &[[i32; N]] = rows(neighbors, "neighbors")?;
            in_range(neighbors, -1, simplices.len(), "neighbors")?;
            if neighbors.len() != simplices.len() {
                return Err(not_beside());
            }
            Ok((skeleton, Some((simplices, neighbors))))
        })()?;
        let found = watched(py, |watch| {
            let tree = Tree::of(skeleton.points, workers, watch)?;
            graphs::antipodes(&skeleton, &tree, tiling, workers, watch)
        })?;
        table(py, found)
    })
}

/// The edges of the minimum spanning tree.
#[pyfunction]
pub fn spanning(py: Python<'_>, graph: Adjacency<'_>, workers: usize) -> Outcome<Table<i32>> {
    in_dimension!(columns(&graph.0), D, N => {
        let skeleton = graph.skeleton::<D>()?;
        let found = watched(py, |watch| graphs::spanning_tree(&skeleton, workers, watch))?;
        table(py, found)
    })
}

/// The edges to the k nearest neighbors, and the duplicates.
#[pyfunction]
pub fn knn(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    k: usize,
    directed: bool,
    workers: usize,
) -> Outcome<Found> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let list = if directed {
            Neighbors::Directed
        } else {
            Neighbors::Either
        };
        let (edges, duplicates) = watched(py, |watch| {
            let tree = Tree::of(points, workers, watch)?;
            let edges = graphs::nearest(&tree, k, list, points.len(), workers, watch)?;
            Ok::<_, Error>((edges, tree.duplicates))
        })?;
        Ok((table(py, edges)?, number_rows(py, &duplicates)?))
    })
}

/// The edges that are not longer than the one between two points.
#[pyfunction]
pub fn not_longer(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    edges: PyReadonlyArray2<'_, i32>,
    ends: PyReadonlyArray2<'_, f64>,
    workers: usize,
) -> Outcome<Table<i32>> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let edges: &[[i32; 2]] = rows(&edges, "edges")?;
        in_range(edges, 0, points.len(), "edges")?;
        let ends: &[[f64; D]; 2] = rows(&ends, "ends")?
            .try_into()
            .map_err(|_| Error::Shape("ends must have two rows: the ends of the segment".into()))?;
        let ends = *ends;
        let found = watched(py, |watch| {
            graphs::not_longer(points, edges, ends, workers, watch)
        })?;
        table(py, found)
    })
}

/// The edges of the sphere of influence graph, and the duplicates.
#[pyfunction]
pub fn influence(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    closed: bool,
    workers: usize,
) -> Outcome<Found> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let (edges, duplicates) = watched(py, |watch| {
            let tree = Tree::of(points, workers, watch)?;
            let edges = graphs::influence(&tree, closed, points.len(), workers, watch)?;
            Ok::<_, Error>((edges, tree.duplicates))
        })?;
        Ok((table(py, edges)?, number_rows(py, &duplicates)?))
    })
}

/// Points, triangles and their neighbors, as Python has them.
#[derive(FromPyObject)]
pub struct Tiling<'py>(
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray2<'py, i32>,
);

/// The checked arrays.
type Triangles<'a> = (&'a [[f64; 2]], &'a [[i32; 3]], &'a [[i32; 3]]);

impl Tiling<'_> {
    fn triangles(&self) -> Result<Triangles<'_>> {
        let points: &[[f64; 2]] = rows(&self.0, "points")?;
        let simplices: &[[i32; 3]] = simplices_of(&self.1, points.len())?;
        let neighbors = rows(&self.2, "neighbors")?;
        in_range(neighbors, -1, simplices.len(), "neighbors")?;
        if neighbors.len() != simplices.len() {
            return Err(not_beside());
        }
        Ok((points, simplices, neighbors))
    }
}

/// The edges of triangles that no opposite corner removes, by the name of a rule.
#[pyfunction]
pub fn of_triangles2(
    py: Python<'_>,
    tiling: Tiling<'_>,
    name: &str,
    beta: f64,
    closed: bool,
    workers: usize,
) -> Outcome<Table<i32>> {
    let ((points, simplices, neighbors), rule) = {
        let rule = match (name, beta > 1.0 && beta <= 2.0) {
            ("longest", _) => Rule::Longest,
            ("ball", _) => Rule::Ball { closed },
            ("circle", true) => Rule::Arcs { beta, closed },
            _ => return Err(Error::Shape(format!(
                "the rule must be longest, ball, or circle with beta above 1 and at most 2; got {name} with beta {beta}"
            )).into()),
        };
        (tiling.triangles()?, rule)
    };
    let found = watched(py, |watch| {
        graphs::of_triangles(points, simplices, neighbors, rule, workers, watch)
    })?;
    table(py, found)
}

/// The edges of the minimum spanning tree of triangulated 2-D points.
#[pyfunction]
pub fn spanning_triangles2(
    py: Python<'_>,
    tiling: Tiling<'_>,
    workers: usize,
) -> Outcome<Table<i32>> {
    let (points, simplices, neighbors) = tiling.triangles()?;
    let found = watched(py, |watch| {
        graphs::spanning_tree_of_triangles(points, simplices, neighbors, workers, watch)
    })?;
    table(py, found)
}

/// The number of the connected component of each row.
#[pyfunction]
pub fn graph_components(
    py: Python<'_>,
    edges: PyReadonlyArray2<'_, i32>,
    npoints: usize,
) -> Outcome<Column<i32>> {
    let edges = rows(&edges, "edges")?;
    in_range(edges, 0, npoints, "edges")?;
    let found = watched(py, |watch| graphs::components(edges, npoints, watch))?;
    Ok(column(py, found))
}
