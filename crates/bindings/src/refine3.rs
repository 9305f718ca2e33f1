//! Refinement of tetrahedra in rounds.

use std::sync::Mutex;

use delone_core::base::error::{Error, Result};
use delone_core::solids::refine::{Given, Refined, Rounds};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, rows, table};
use crate::errors::Outcome;
use crate::live::{broken, locked};
use crate::results::Added;
use crate::signals::watched;

/// Refined tetrahedra.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RefinedTetrahedra {
    /// Coordinates: the input points, then the added ones, (n, 3).
    pub points: Table<f64>,
    /// Vertices of the tetrahedra, (m, 4).
    pub simplices: Table<i32>,
    /// The tetrahedron opposite each vertex, -1 outside, (m, 4).
    pub neighbors: Table<i32>,
    /// The label of each tetrahedron, (m,).
    pub labels: Column<i32>,
    /// The size that was requested for each, infinite for none, (m,).
    pub sizes: Column<f64>,
    /// The faces that stayed, oriented as given, (k, 3).
    pub faces: Table<i32>,
    /// The row of the given face that each of these is, or lies in the facet of, (k,).
    pub face_rows: Column<i32>,
    /// Number of points added on segments.
    pub on_segments: usize,
    /// Number of points added on facets.
    pub on_facets: usize,
    /// Number of points added inside for shapes.
    pub for_shapes: usize,
    /// Number of points added inside for sizes.
    pub for_sizes: usize,
}

/// A refinement of tetrahedra in rounds, between which sizes are requested.
#[pyclass(frozen, module = "delone._core")]
pub struct Refinement3(Mutex<Rounds>);

#[pymethods]
impl Refinement3 {
    /// Tetrahedra with labels, and the faces `(faces, sources, markers)` that stay. `split` says whether
    /// points may be put on faces, and within which distance of a plane faces are one facet.
    #[new]
    fn new(
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        simplices: PyReadonlyArray2<'_, i32>,
        labels: PyReadonlyArray1<'_, i32>,
        faces: (
            PyReadonlyArray2<'_, i32>,
            PyReadonlyArray1<'_, i32>,
            PyReadonlyArray1<'_, i32>,
        ),
        split: (bool, f64),
        radius_edge: f64,
    ) -> Outcome<Self> {
        let points = rows(&points, "points")?;
        let simplices = rows(&simplices, "simplices")?;
        let own = rows(&faces.0, "faces")?;
        in_range(simplices, 0, points.len(), "simplices")?;
        in_range(own, 0, points.len(), "faces")?;
        let given = Given {
            points,
            simplices,
            labels: flat(&labels, "labels")?,
            faces: own,
            sources: flat(&faces.1, "sources")?,
            markers: flat(&faces.2, "markers")?,
            split: split.0,
            tolerance: split.1,
            radius_edge,
        };
        let rounds = watched(py, |_| Rounds::new(&given))?;
        Ok(Self(Mutex::new(rounds)))
    }

    /// The corners, (k, 12), and the labels, (k,), of tetrahedra whose sizes are not known.
    fn fresh(&self, py: Python<'_>) -> Outcome<(Table<f64>, Column<i32>)> {
        let (corners, labels) = locked(&self.0, py, usize::MAX, |rounds, _| rounds.fresh())?;
        Ok((table(py, flattened(corners)?)?, column(py, labels)))
    }

    /// Sets the sizes of these; returns whether none is too large. With `gradual`, edges are at most
    /// halved in the next round.
    fn comply(
        &self,
        py: Python<'_>,
        sizes: PyReadonlyArray1<'_, f64>,
        gradual: bool,
    ) -> Outcome<bool> {
        let sizes = flat(&sizes, "sizes")?;
        locked(&self.0, py, usize::MAX, |rounds, _| {
            rounds.comply(sizes, gradual)
        })
    }

    /// One round; returns whether `max_points`, the number of points to add, was enough, and the
    /// number of points added in all rounds.
    fn refine(
        &self,
        py: Python<'_>,
        max_points: usize,
        progress: Option<Added>,
    ) -> Outcome<(bool, usize)> {
        let mut failure = None;
        let mut notify = |added: usize| -> Result<()> {
            let Some(progress) = &progress else {
                return Ok(());
            };
            let result = Python::attach(|py| progress.call1(py, (added,)).map(|_| ()));
            result.map_err(|error| {
                failure = Some(error);
                Error::Interrupted
            })
        };
        let outcome = watched(py, |watch| {
            let mut rounds = self.0.lock().map_err(|_| broken())?;
            let enough = rounds.refine(max_points, watch, &mut notify)?;
            Ok((enough, rounds.counts().total()))
        });
        match failure {
            Some(error) => Err(error.into()),
            None => outcome,
        }
    }

    /// The mesh, with the points of all rounds.
    fn export(&self, py: Python<'_>) -> Outcome<RefinedTetrahedra> {
        let made: Refined = locked(&self.0, py, usize::MAX, |rounds, _| rounds.export())?;
        Ok(RefinedTetrahedra {
            points: table(py, made.points)?,
            simplices: table(py, made.simplices)?,
            neighbors: table(py, made.neighbors)?,
            labels: column(py, made.labels),
            sizes: column(py, made.sizes),
            faces: table(py, made.faces)?,
            face_rows: column(py, made.face_rows),
            on_segments: made.counts.on_segments,
            on_facets: made.counts.on_facets,
            for_shapes: made.counts.for_shapes,
            for_sizes: made.counts.for_sizes,
        })
    }
}

/// The coordinates of four corners in one row.
fn flattened(corners: Vec<[[f64; 3]; 4]>) -> Result<Vec<[f64; 12]>> {
    let mut all = delone_core::base::memory::with_room(corners.len())?;
    for [[a, b, c], [d, e, f], [g, h, i], [j, k, l]] in corners {
        all.push([a, b, c, d, e, f, g, h, i, j, k, l]);
    }
    Ok(all)
}
