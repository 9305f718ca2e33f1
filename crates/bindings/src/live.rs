//! Live triangulations: edited by one thread at a time, from any number of threads.

use std::sync::{Mutex, TryLockError};

use delone::{Error, Result};
use delone_core::live::plane::{Plane, State};
use delone_core::watch::Watch;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, number_rows, rows, table};
use crate::errors::raise;
use crate::signals::{watched, watched_attached};

/// Up to this number of points a call keeps the GIL: it is over before another thread could run.
const FEW: usize = 16;

type Points<'py> = PyReadonlyArray2<'py, f64>;
type Handles<'py> = PyReadonlyArray1<'py, i64>;

/// A 2-D Delaunay triangulation that is edited.
#[pyclass(frozen, module = "delone._core")]
pub struct Live2(Mutex<Plane>);

/// A state of a `Live2`, which never changes.
#[pyclass(frozen, module = "delone._core")]
pub struct LiveState2(State);

/// The present triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct LiveArrays2 {
    /// The handles of the points, ascending, (n,).
    pub handles: Column<i64>,
    /// The points, (n, 2).
    pub points: Table<f64>,
    /// Triangles as rows of these, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
}

impl Live2 {
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Plane, &Watch) -> delone_core::error::Result<T> + Send,
    ) -> PyResult<T> {
        locked(&self.0, py, count, work)
    }
}

/// Runs `work` on a triangulation, without the GIL unless there are few items and no other thread
/// is at work. A thread that waits never holds the GIL, which the other one may need.
pub fn locked<L: Send, T: Send>(
    live: &Mutex<L>,
    py: Python<'_>,
    count: usize,
    work: impl FnOnce(&mut L, &Watch) -> delone_core::error::Result<T> + Send,
) -> PyResult<T> {
    if count <= FEW {
        match live.try_lock() {
            Ok(mut live) => return watched_attached(py, move |watch| work(&mut live, watch)),
            Err(TryLockError::Poisoned(_)) => return Err(raise(py, &broken())),
            Err(TryLockError::WouldBlock) => {}
        }
    }
    watched(py, |watch| -> Result<T> {
        let mut live = live.lock().map_err(|_| broken())?;
        Ok(work(&mut live, watch)?)
    })
}

/// Handles that ascend, one for each of `count` points, before the handle `total`.
pub fn checked_handles(given: &[i64], count: usize, total: usize) -> Result<Vec<u32>> {
    let right = given.len() == count
        && given.is_sorted_by(|a, b| a < b)
        && given.first().is_none_or(|&h| h >= 0)
        && given.last().is_none_or(|&h| (h as usize) < total);
    if !right || total >= u32::MAX as usize {
        let message = "handles must ascend from 0 to the next one, one for each point";
        return Err(Error::Shape(message.into()));
    }
    Ok(given.iter().map(|&h| h as u32).collect())
}

/// The error of a triangulation in which a panic left something behind.
fn broken() -> Error {
    Error::Internal("an edit did not end".into())
}

#[pymethods]
impl Live2 {
    /// The triangulation of points with these handles, ascending, before the handle `total`.
    #[new]
    fn new(
        py: Python<'_>,
        points: Points<'_>,
        handles: Option<Handles<'_>>,
        total: usize,
        workers: usize,
    ) -> PyResult<Self> {
        let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
        let given = handles.as_ref().map(|h| flat(h, "handles")).transpose();
        let given = given.map_err(|e| raise(py, &e))?;
        let given = given.map(|given| checked_handles(given, points.len(), total));
        let given = given.transpose().map_err(|e| raise(py, &e))?;
        let plane = watched(py, |watch| match given {
            Some(own) => Plane::of(points, &own, total, workers, watch),
            None => Plane::new(points, workers, watch),
        })?;
        Ok(Self(Mutex::new(plane)))
    }

    /// Numbers: points, vertices, triangles, and the next handle.
    fn counts(&self, py: Python<'_>) -> PyResult<[usize; 4]> {
        self.with(py, 0, |plane, _| {
            Ok([
                plane.len(),
                plane.vertices(),
                plane.triangles(),
                plane.total(),
            ])
        })
    }

    /// Inserts points and returns their handles.
    fn insert(&self, py: Python<'_>, points: Points<'_>, workers: usize) -> PyResult<Column<i64>> {
        let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
        let made = self.with(py, points.len(), |plane, watch| {
            plane.insert(points, workers, watch)
        })?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes points.
    fn remove(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> PyResult<()> {
        let handles = flat(&handles, "handles").map_err(|e| raise(py, &e))?;
        self.with(py, handles.len(), |plane, watch| {
            plane.remove(handles, workers, watch)
        })
    }

    /// Moves points.
    fn relocate(
        &self,
        py: Python<'_>,
        handles: Handles<'_>,
        points: Points<'_>,
        workers: usize,
    ) -> PyResult<()> {
        let handles = flat(&handles, "handles").map_err(|e| raise(py, &e))?;
        let points = rows(&points, "points").map_err(|e| raise(py, &e))?;
        self.with(py, handles.len(), |plane, watch| {
            plane.relocate(handles, points, workers, watch)
        })
    }

    /// Which of these handles are not there, or are named earlier.
    fn faults(&self, py: Python<'_>, handles: Handles<'_>) -> PyResult<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles").map_err(|e| raise(py, &e))?;
        let [gone, twice] = self.with(py, handles.len(), |plane, _| {
            let gone = handles.iter().copied().filter(|&h| !plane.has(h)).collect();
            let mut sorted = handles.to_vec();
            sorted.sort_unstable();
            let pairs = sorted.windows(2).filter(|w| w[0] == w[1]);
            Ok([gone, pairs.map(|w| w[0]).collect()])
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// The handles, ascending, and their points.
    fn points(&self, py: Python<'_>) -> PyResult<(Column<i64>, Table<f64>)> {
        let (handles, points) = self.with(py, usize::MAX, |plane, watch| plane.points(watch))?;
        Ok((column(py, handles), table(py, points)?))
    }

    /// The present triangulation; no triangles if all points are on one line.
    fn arrays(&self, py: Python<'_>) -> PyResult<LiveArrays2> {
        let made = self.with(py, usize::MAX, |plane, watch| plane.export(watch))?;
        Ok(LiveArrays2 {
            handles: column(py, made.rows),
            points: table(py, made.points)?,
            simplices: table(py, made.arrays.simplices)?,
            neighbors: table(py, made.arrays.neighbors)?,
            duplicates: number_rows(py, &made.duplicates)?,
        })
    }

    /// The handles of the corners of a triangle that contains each query, -1 outside, and weights.
    fn corners(&self, py: Python<'_>, xi: Points<'_>) -> PyResult<(Table<i64>, Table<f64>)> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let found = self.with(py, queries.len(), |plane, watch| {
            plane.corners(queries, watch)
        })?;
        Ok((table(py, found.rows)?, table(py, found.weights)?))
    }

    /// The handle of the nearest point to each query, -1 if there is none.
    fn nearest(&self, py: Python<'_>, xi: Points<'_>) -> PyResult<Column<i64>> {
        let queries = rows(&xi, "xi").map_err(|e| raise(py, &e))?;
        let found = self.with(py, queries.len(), |plane, watch| {
            plane.nearest(queries, watch)
        })?;
        Ok(column(py, found))
    }

    /// The triangles that went and came since the last call, as handles.
    fn changes(&self, py: Python<'_>) -> PyResult<(Table<i64>, Table<i64>)> {
        let found = self.with(py, usize::MAX, |plane, watch| plane.changes(watch))?;
        Ok((table(py, found.gone)?, table(py, found.new)?))
    }

    /// The present state.
    fn state(&self, py: Python<'_>) -> PyResult<LiveState2> {
        self.with(py, usize::MAX, |plane, watch| plane.state(watch))
            .map(LiveState2)
    }

    /// Restores a state.
    fn restore(&self, py: Python<'_>, state: &LiveState2) -> PyResult<()> {
        let state = &state.0;
        self.with(py, usize::MAX, |plane, watch| plane.restore(state, watch))
    }
}

#[pymethods]
impl LiveState2 {
    /// A triangulation of its own in this state.
    fn open(&self, py: Python<'_>) -> PyResult<Live2> {
        let plane = watched(py, |watch| {
            let mut plane = Plane::new(&[], 1, watch)?;
            plane.restore(&self.0, watch)?;
            Ok::<_, Error>(plane)
        })?;
        Ok(Live2(Mutex::new(plane)))
    }

    /// Bytes that are not shared with another state.
    fn own_bytes(&self, other: &Self) -> usize {
        self.0.own_bytes(&other.0)
    }
}
