//! Clusters: merges of a spanning tree, condensed trees, and clusters of one density.

use delone_core::base::error::Error;
use delone_core::graphs::Tree;
use delone_core::graphs::cluster::{self, Condensed, cores, hierarchy, reach_tree};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, columns, in_dimension, in_range, rows, table};
use crate::errors::Outcome;
use crate::signals::watched;

/// `(clusters, levels, parents, births, deaths, sizes, stabilities, heights, (below, up to))`.
type Tower = (
    Column<i32>,
    Column<i32>,
    Column<i32>,
    Column<i32>,
    Column<i32>,
    Column<i32>,
    Column<f64>,
    Column<f64>,
    (usize, usize),
);

/// The merges of single linkage, from the edges of the spanning tree and duplicates.
#[pyfunction]
pub fn linkage(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    edges: PyReadonlyArray2<'_, i32>,
    duplicates: PyReadonlyArray2<'_, i32>,
    workers: usize,
) -> Outcome<Table<f64>> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        let edges: &[[i32; 2]] = rows(&edges, "edges")?;
        let duplicates: &[[i32; 2]] = rows(&duplicates, "duplicates")?;
        in_range(edges, 0, points.len(), "edges")?;
        in_range(duplicates, 0, points.len(), "duplicates")?;
        if edges.len() + duplicates.len() + 1 != points.len() {
            return Err(Error::Shape("the edges must be those of a tree: with the duplicates, one fewer than the points".into()).into());
        }
        let found = watched(py, |watch| {
            let links = cluster::single_links(points, edges, duplicates, watch)?;
            let merges = hierarchy(points, links, workers, watch)?;
            cluster::linkage(&merges, points.len(), watch)
        })?;
        table(py, found)
    })
}

/// The condensed tree by mutual reachability, and the levels below and up to a number;
/// of at least two points, with `k` rows at most as many.
#[pyfunction]
pub fn condensed(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    k: usize,
    least: usize,
    number: f64,
    workers: usize,
) -> Outcome<Tower> {
    in_dimension!(columns(&points), D, N => {
        let points: &[[f64; D]] = rows(&points, "points")?;
        if points.len() < 2 || k < 1 || k > points.len() || number.is_nan() || number < 0.0 {
            return Err(Error::Shape("a condensed tree needs at least two points, k from 1 to their number, and number of at least 0".into()).into());
        }
        let (found, heights, [below, up_to]) = watched(py, |watch| {
            let tree = Tree::of(points, workers, watch)?;
            let distances = cores(&tree, k, points.len(), workers, watch)?;
            let links = reach_tree(&tree, &distances, workers, watch)?;
            let merges = hierarchy(points, links, workers, watch)?;
            let found = cluster::condense(&merges, points.len(), least, watch)?;
            let counts = merges.levels_below(number, points);
            Ok::<_, Error>((found, merges.heights, counts))
        })?;
        let Condensed {
            clusters,
            levels,
            parents,
            births,
            deaths,
            sizes,
            stabilities,
        } = found;
        Ok((
            column(py, clusters),
            column(py, levels),
            column(py, parents),
            column(py, births),
            column(py, deaths),
            column(py, sizes),
            column(py, stabilities),
            column(py, heights),
            (below, up_to),
        ))
    })
}

/// For each row, the first row of its cluster or -1, and whether it is a core point.
#[pyfunction]
pub fn density(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    eps: f64,
    k: usize,
    workers: usize,
) -> Outcome<(Column<i32>, Column<bool>)> {
    in_dimension!(columns(&points), D, N => {
        if eps.is_nan() || eps < 0.0 || k < 1 {
            return Err(Error::Shape("density needs eps of at least 0 and k of at least 1".into()).into());
        }
        let points: &[[f64; D]] = rows(&points, "points")?;
        let found = watched(py, |watch| {
            let tree = Tree::of(points, workers, watch)?;
            cluster::density(&tree, points.len(), eps, k, workers, watch)
        })?;
        Ok((column(py, found.clusters), column(py, found.is_core)))
    })
}
