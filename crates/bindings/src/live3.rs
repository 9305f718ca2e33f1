//! Live 3-D triangulations: edited by one thread at a time, from any number of threads.

use std::sync::Mutex;
use std::sync::atomic::{AtomicI64, Ordering};

use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::live::space::{Space, State};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, number_rows, rows, table};
use crate::errors::Outcome;
use crate::live::{Weights, checked_handles, locked};
use crate::signals::watched;

type Points<'py> = PyReadonlyArray2<'py, f64>;
type Handles<'py> = PyReadonlyArray1<'py, i64>;

/// A 3-D Delaunay triangulation that is edited.
#[pyclass(frozen, module = "delone._core")]
pub struct Live3 {
    live: Mutex<Space>,
    /// How many edits are complete; changed with the lock.
    edits: AtomicI64,
}

/// A state of a `Live3`, which never changes.
#[pyclass(frozen, module = "delone._core")]
pub struct LiveState3(State);

/// The present triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct LiveArrays3 {
    /// The handles of the points, ascending, (n,).
    pub handles: Column<i64>,
    /// The points, (n, 3).
    pub points: Table<f64>,
    /// Tetrahedra as rows of these, (m, 4).
    pub simplices: Table<i32>,
    /// The tetrahedron opposite each vertex, -1 outside, (m, 4).
    pub neighbors: Table<i32>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
}

impl Live3 {
    fn of(space: Space) -> Self {
        Self {
            live: Mutex::new(space),
            edits: AtomicI64::new(0),
        }
    }

    fn with<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Space, &Watch) -> delone_core::base::error::Result<T> + Send,
    ) -> Outcome<T> {
        locked(&self.live, py, count, work)
    }

    /// The same for an edit.
    fn edit<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Space, &Watch) -> delone_core::base::error::Result<T> + Send,
    ) -> Outcome<T> {
        self.with(py, count, |space, watch| {
            let made = work(space, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(made)
        })
    }
}

#[pymethods]
impl Live3 {
    /// The triangulation of points with these handles, ascending, before the handle `total`.
    #[new]
    fn new(
        py: Python<'_>,
        points: Points<'_>,
        handles: Option<Handles<'_>>,
        total: usize,
        workers: usize,
    ) -> Outcome<Self> {
        let points = rows(&points, "points")?;
        let given = handles.as_ref().map(|h| flat(h, "handles")).transpose();
        let given = given?;
        let given = given.map(|given| checked_handles(given, points.len(), total));
        let given = given.transpose()?;
        let space = watched(py, |watch| match given {
            Some(own) => Space::of(points, &own, total, workers, watch),
            None => Space::new(points, workers, watch),
        })?;
        Ok(Self::of(space))
    }

    /// Numbers: points, vertices, tetrahedra, and the next handle.
    fn counts(&self, py: Python<'_>) -> Outcome<[usize; 4]> {
        self.with(py, 0, |space, _| {
            Ok([
                space.len(),
                space.vertices(),
                space.simplices(),
                space.total(),
            ])
        })
    }

    /// How many edits are complete.
    #[getter]
    fn edits(&self) -> i64 {
        self.edits.load(Ordering::Relaxed)
    }

    /// Inserts points and returns their handles.
    fn insert(&self, py: Python<'_>, points: Points<'_>, workers: usize) -> Outcome<Column<i64>> {
        let points = rows(&points, "points")?;
        let made = self.edit(py, points.len(), |space, watch| {
            space.insert(points, workers, watch)
        })?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes points.
    fn remove(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        self.edit(py, handles.len(), |space, watch| {
            space.remove(handles, workers, watch)
        })
    }

    /// Moves points.
    fn relocate(
        &self,
        py: Python<'_>,
        handles: Handles<'_>,
        points: Points<'_>,
        workers: usize,
    ) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        let points = rows(&points, "points")?;
        self.edit(py, handles.len(), |space, watch| {
            space.relocate(handles, points, workers, watch)
        })
    }

    /// Which of these handles are not there, or are named earlier.
    fn faults(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles")?;
        let [gone, twice] = self.with(py, handles.len(), |space, _| {
            let gone = handles.iter().copied().filter(|&h| !space.has(h)).collect();
            let mut sorted = handles.to_vec();
            sorted.sort_unstable();
            let pairs = sorted.windows(2).filter(|w| w[0] == w[1]);
            Ok([gone, pairs.map(|w| w[0]).collect()])
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// The handles, ascending, and their points.
    fn points(&self, py: Python<'_>) -> Outcome<(Column<i64>, Table<f64>)> {
        let (handles, points) = self.with(py, usize::MAX, |space, watch| space.points(watch))?;
        Ok((column(py, handles), table(py, points)?))
    }

    /// The present triangulation; no tetrahedra if all points are in one plane.
    fn arrays(&self, py: Python<'_>) -> Outcome<LiveArrays3> {
        let made = self.with(py, usize::MAX, |space, watch| space.export(watch))?;
        Ok(LiveArrays3 {
            handles: column(py, made.rows),
            points: table(py, made.points)?,
            simplices: table(py, made.arrays.simplices)?,
            neighbors: table(py, made.arrays.neighbors)?,
            duplicates: number_rows(py, &made.duplicates)?,
        })
    }

    /// The handles of the corners of a tetrahedron that contains each query, -1 outside, and weights.
    fn corners(&self, py: Python<'_>, xi: Points<'_>) -> Outcome<(Table<i64>, Table<f64>)> {
        let queries = rows(&xi, "xi")?;
        let found = self.with(py, queries.len(), |space, watch| {
            space.corners(queries, watch)
        })?;
        Ok((table(py, found.rows)?, table(py, found.weights)?))
    }

    /// The same, and the number of edits so far; and if that is not `known`, the handles of all points.
    fn weights(&self, py: Python<'_>, xi: Points<'_>, known: i64) -> Outcome<Weights> {
        let queries = rows(&xi, "xi")?;
        let edits = || self.edits.load(Ordering::Relaxed);
        let count = if edits() == known {
            queries.len()
        } else {
            usize::MAX
        };
        let (found, edit, own) = self.with(py, count, |space, watch| {
            let edit = edits();
            let found = space.corners(queries, watch)?;
            let own = if edit == known {
                None
            } else {
                Some(space.points(watch)?.0)
            };
            Ok((found, edit, own))
        })?;
        let weights = table(py, found.weights)?;
        let own = own.map(|own| column(py, own));
        Ok((table(py, found.rows)?, weights, edit, own))
    }

    /// The handle of the nearest point to each query, -1 if there is none.
    fn nearest(&self, py: Python<'_>, xi: Points<'_>) -> Outcome<Column<i64>> {
        let queries = rows(&xi, "xi")?;
        let found = self.with(py, queries.len(), |space, watch| {
            space.nearest(queries, watch)
        })?;
        Ok(column(py, found))
    }

    /// The tetrahedra that were removed and added since the last call, as handles.
    fn changes(&self, py: Python<'_>) -> Outcome<(Table<i64>, Table<i64>)> {
        let found = self.with(py, usize::MAX, |space, watch| space.changes(watch))?;
        Ok((table(py, found.gone)?, table(py, found.new)?))
    }

    /// The present state.
    fn state(&self, py: Python<'_>) -> Outcome<LiveState3> {
        self.with(py, usize::MAX, |space, watch| space.state(watch))
            .map(LiveState3)
    }

    /// Restores a state; not if `known` is given and is not the number of edits so far. Whether it was
    /// restored.
    #[pyo3(signature = (state, known=None))]
    fn restore(&self, py: Python<'_>, state: &LiveState3, known: Option<i64>) -> Outcome<bool> {
        let state = &state.0;
        self.with(py, usize::MAX, |space, watch| {
            if known.is_some_and(|known| known != self.edits.load(Ordering::Relaxed)) {
                return Ok(false);
            }
            space.restore(state, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(true)
        })
    }
}

#[pymethods]
impl LiveState3 {
    /// A triangulation of its own in this state.
    fn open(&self, py: Python<'_>) -> Outcome<Live3> {
        let space = watched(py, |watch| {
            let mut space = Space::new(&[], 1, watch)?;
            space.restore(&self.0, watch)?;
            Ok::<_, Error>(space)
        })?;
        Ok(Live3::of(space))
    }

    /// Bytes that are not shared with another state.
    fn own_bytes(&self, other: &Self) -> usize {
        self.0.own_bytes(&other.0)
    }
}
