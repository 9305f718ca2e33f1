//! Live triangulations: edited by one thread at a time, from any number of threads.

use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, TryLockError};

use delone_core::Point2;
use delone_core::base::error::{Error, Result};
use delone_core::base::watch::Watch;
use delone_core::live::plane::{Plane, State};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, number_rows, rows, table};
use crate::errors::Outcome;
use crate::signals::{watched, watched_attached};

/// Up to this number of points a call keeps the GIL: it is over before another thread could run.
const FEW: usize = 16;

type Points<'py> = PyReadonlyArray2<'py, f64>;
type Handles<'py> = PyReadonlyArray1<'py, i64>;
/// Corners, weights, the number of edits, and perhaps all handles.
pub type Weights = (Table<i64>, Table<f64>, i64, Option<Column<i64>>);

/// A 2-D Delaunay triangulation that is edited.
#[pyclass(frozen, module = "delone._core")]
pub struct Live2 {
    live: Mutex<Plane>,
    /// How many edits are complete; changed with the lock.
    edits: AtomicI64,
}

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
    /// Whether the edge opposite each vertex is part of a segment; None without segments.
    pub constrained: Option<Table<bool>>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
}

/// The segments of a triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct LiveSegments2 {
    /// The handles of segments, ascending, (s,).
    pub handles: Column<i64>,
    /// The handles of their ends, (s, 2).
    pub ends: Table<i64>,
    /// Two segments, and the handle of the vertex where they cross, (c, 3).
    pub crossings: Table<i64>,
    /// The handles of vertices that only crossings need, (v,).
    pub added: Column<i64>,
    /// The next handle of a segment.
    pub total: usize,
}

impl Live2 {
    fn of(plane: Plane) -> Self {
        Self {
            live: Mutex::new(plane),
            edits: AtomicI64::new(0),
        }
    }

    fn with<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Plane, &Watch) -> Result<T> + Send,
    ) -> Outcome<T> {
        locked(&self.live, py, count, work)
    }

    /// The same for an edit.
    fn edit<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Plane, &Watch) -> Result<T> + Send,
    ) -> Outcome<T> {
        self.with(py, count, |plane, watch| {
            let made = work(plane, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(made)
        })
    }
}

/// Runs `work` on a triangulation, without the GIL unless there are few items and no other thread
/// is at work. A thread that waits never holds the GIL, which the other one may need.
pub fn locked<L: Send, T: Send>(
    live: &Mutex<L>,
    py: Python<'_>,
    count: usize,
    work: impl FnOnce(&mut L, &Watch) -> Result<T> + Send,
) -> Outcome<T> {
    if count <= FEW {
        match live.try_lock() {
            Ok(mut live) => return watched_attached(move |watch| work(&mut live, watch)),
            Err(TryLockError::Poisoned(_)) => return Err(broken().into()),
            Err(TryLockError::WouldBlock) => {}
        }
    }
    watched(py, |watch| -> Result<T> {
        let mut live = live.lock().map_err(|_| broken())?;
        work(&mut live, watch)
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

/// Which handles are not there, and which are named twice.
fn faults_of(handles: &[i64], is_there: impl Fn(i64) -> bool) -> [Vec<i64>; 2] {
    let gone = handles.iter().copied().filter(|&h| !is_there(h)).collect();
    let mut sorted = handles.to_vec();
    sorted.sort_unstable();
    let pairs = sorted.windows(2).filter(|w| w[0] == w[1]);
    [gone, pairs.map(|w| w[0]).collect()]
}

/// The error of a triangulation in which a panic left something behind.
pub fn broken() -> Error {
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
    ) -> Outcome<Self> {
        let points = rows(&points, "points")?;
        let given = handles.as_ref().map(|h| flat(h, "handles")).transpose();
        let given = given?;
        let given = given.map(|given| checked_handles(given, points.len(), total));
        let given = given.transpose()?;
        let plane = watched(py, |watch| match given {
            Some(own) => Plane::of(points, &own, total, workers, watch),
            None => Plane::new(points, workers, watch),
        })?;
        Ok(Self::of(plane))
    }

    /// Numbers: points, vertices, triangles, and the next handle.
    fn counts(&self, py: Python<'_>) -> Outcome<[usize; 4]> {
        self.with(py, 0, |plane, _| {
            Ok([
                plane.len(),
                plane.vertices(),
                plane.simplices(),
                plane.total(),
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
        let made = self.edit(py, points.len(), |plane, watch| {
            plane.insert(points, workers, watch)
        })?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes points.
    fn remove(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        self.edit(py, handles.len(), |plane, watch| {
            plane.remove(handles, workers, watch)
        })
    }

    /// Removes points and the segments that end there, and returns the handles of these.
    fn remove_with_segments(
        &self,
        py: Python<'_>,
        handles: Handles<'_>,
        workers: usize,
    ) -> Outcome<Column<i64>> {
        let handles = flat(&handles, "handles")?;
        let gone = self.edit(py, usize::MAX, |plane, watch| {
            plane.remove_with_segments(handles, workers, watch)
        })?;
        Ok(column(py, gone))
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
        self.edit(py, handles.len(), |plane, watch| {
            plane.relocate(handles, points, workers, watch)
        })
    }

    /// Which of these handles are not there, or are named earlier.
    fn faults(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles")?;
        let [gone, twice] = self.with(py, handles.len(), |plane, _| {
            Ok(faults_of(handles, |h| plane.has(h)))
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// The handles, ascending, and their points.
    fn points(&self, py: Python<'_>) -> Outcome<(Column<i64>, Table<f64>)> {
        let (handles, points) = self.with(py, usize::MAX, |plane, watch| plane.points(watch))?;
        Ok((column(py, handles), table(py, points)?))
    }

    /// The present triangulation; no triangles if all points are on one line.
    fn arrays(&self, py: Python<'_>) -> Outcome<LiveArrays2> {
        let made = self.with(py, usize::MAX, |plane, watch| plane.export(watch))?;
        Ok(LiveArrays2 {
            handles: column(py, made.rows),
            points: table(py, made.points)?,
            simplices: table(py, made.arrays.simplices)?,
            neighbors: table(py, made.arrays.neighbors)?,
            constrained: match made.constrained.is_empty() {
                true => None,
                false => Some(table(py, made.constrained)?),
            },
            duplicates: number_rows(py, &made.duplicates)?,
        })
    }

    /// Chooses whether crossings of segments are split.
    fn split_crossings(&self, py: Python<'_>, split: bool) -> Outcome<()> {
        self.with(py, 0, |plane, _| {
            plane.split_crossings(split);
            Ok(())
        })
    }

    /// Whether there are segments, and whether crossings are split.
    fn constraints(&self, py: Python<'_>) -> Outcome<[bool; 2]> {
        self.with(py, 0, |plane, _| {
            Ok([plane.has_segments(), plane.splits_crossings()])
        })
    }

    /// Inserts segments between points and returns their handles.
    fn insert_segments(
        &self,
        py: Python<'_>,
        ends: PyReadonlyArray2<'_, i64>,
        workers: usize,
    ) -> Outcome<Column<i64>> {
        let ends: &[[i64; 2]] = rows(&ends, "ends")?;
        let made = self.edit(py, usize::MAX, |plane, watch| {
            plane.insert_segments(ends, workers, watch)
        })?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes segments.
    fn remove_segments(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        self.edit(py, usize::MAX, |plane, watch| {
            plane.remove_segments(handles, workers, watch)
        })
    }

    /// Inserts segments with known handles, ascending, before the handle `total`; crossings at known
    /// places get their handles again.
    fn adopt_segments(
        &self,
        py: Python<'_>,
        known: (Handles<'_>, PyReadonlyArray2<'_, i64>),
        total: usize,
        crossings: (Handles<'_>, Points<'_>),
        workers: usize,
    ) -> Outcome<()> {
        let ((handles, ends), (added, places)) = (known, crossings);
        let ends: &[[i64; 2]] = rows(&ends, "ends")?;
        let places: &[Point2] = rows(&places, "places")?;
        let given = flat(&handles, "handles")?;
        let added = flat(&added, "added")?;
        let numbers = checked_handles(given, ends.len(), total)?;
        self.edit(py, usize::MAX, |plane, watch| {
            let added = checked_handles(added, places.len(), plane.total());
            let added = added.map_err(|_| Error::Shape("handles of crossings are wrong".into()))?;
            if let Some(&row) = ends.as_flattened().iter().find(|&&row| !plane.has(row)) {
                let message = format!("row {row} is not there");
                return Err(Error::Shape(message));
            }
            let ends = ends.iter().map(|pair| pair.map(|row| row as u32));
            let known: Vec<_> = numbers.into_iter().zip(ends).collect();
            let places: Vec<_> = added.into_iter().zip(places.iter().copied()).collect();
            plane.adopt_segments(&known, total, &places, workers, watch)
        })
    }

    /// The segments and their crossings.
    fn segments(&self, py: Python<'_>) -> Outcome<LiveSegments2> {
        let (handles, ends, crossings, added, total) = self.with(py, usize::MAX, |plane, _| {
            let (handles, ends) = plane.segments()?;
            let crossings = plane.crossings()?.into_iter().map(|c| c.map(i64::from));
            let added = plane.crossing_rows().iter().copied().map(i64::from);
            let crossings: Vec<_> = crossings.collect();
            let added: Vec<_> = added.collect();
            Ok((handles, ends, crossings, added, plane.segments_total()))
        })?;
        Ok(LiveSegments2 {
            handles: column(py, handles),
            ends: table(py, ends)?,
            crossings: table(py, crossings)?,
            added: column(py, added),
            total,
        })
    }

    /// Which of these handles of segments are not there, or are named earlier.
    fn segment_faults(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles")?;
        let [gone, twice] = self.with(py, handles.len(), |plane, _| {
            Ok(faults_of(handles, |h| plane.has_segment(h)))
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// Which of these handles of points are ends of segments, each with one, or crossings, with -1.
    fn held(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<Table<i64>> {
        let handles = flat(&handles, "handles")?;
        let held = self.with(py, handles.len(), |plane, _| {
            let there = handles.iter().filter(|&&h| plane.has(h));
            let held = there.filter_map(|&h| match plane.is_crossing(h as u32) {
                true => Some([h, -1]),
                false => plane
                    .segments_at(h as u32)
                    .next()
                    .map(|s| [h, i64::from(s)]),
            });
            Ok(held.collect::<Vec<_>>())
        })?;
        table(py, held)
    }

    /// The handles of the corners of a triangle that contains each query, -1 outside, and weights.
    fn corners(&self, py: Python<'_>, xi: Points<'_>) -> Outcome<(Table<i64>, Table<f64>)> {
        let queries = rows(&xi, "xi")?;
        let found = self.with(py, queries.len(), |plane, watch| {
            plane.corners(queries, watch)
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
        let (found, edit, own) = self.with(py, count, |plane, watch| {
            let edit = edits();
            let found = plane.corners(queries, watch)?;
            let own = if edit == known {
                None
            } else {
                Some(plane.points(watch)?.0)
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
        let found = self.with(py, queries.len(), |plane, watch| {
            plane.nearest(queries, watch)
        })?;
        Ok(column(py, found))
    }

    /// The triangles that were removed and added since the last call, as handles.
    fn changes(&self, py: Python<'_>) -> Outcome<(Table<i64>, Table<i64>)> {
        let found = self.with(py, usize::MAX, |plane, watch| plane.changes(watch))?;
        Ok((table(py, found.gone)?, table(py, found.new)?))
    }

    /// The present state.
    fn state(&self, py: Python<'_>) -> Outcome<LiveState2> {
        self.with(py, usize::MAX, |plane, watch| plane.state(watch))
            .map(LiveState2)
    }

    /// Restores a state; not if `known` is given and is not the number of edits so far. Whether it was
    /// restored.
    #[pyo3(signature = (state, known=None))]
    fn restore(&self, py: Python<'_>, state: &LiveState2, known: Option<i64>) -> Outcome<bool> {
        let state = &state.0;
        self.with(py, usize::MAX, |plane, watch| {
            if known.is_some_and(|known| known != self.edits.load(Ordering::Relaxed)) {
                return Ok(false);
            }
            plane.restore(state, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(true)
        })
    }
}

#[pymethods]
impl LiveState2 {
    /// A triangulation of its own in this state.
    fn open(&self, py: Python<'_>) -> Outcome<Live2> {
        let plane = watched(py, |watch| {
            let mut plane = Plane::new(&[], 1, watch)?;
            plane.restore(&self.0, watch)?;
            Ok::<_, Error>(plane)
        })?;
        Ok(Live2::of(plane))
    }

    /// Bytes that are not shared with another state.
    fn own_bytes(&self, other: &Self) -> usize {
        self.0.own_bytes(&other.0)
    }
}
