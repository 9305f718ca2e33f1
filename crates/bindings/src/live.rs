//! Live triangulations in 2-D and 3-D: edited by one thread at a time, from any number of threads.

use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, TryLockError};

use delone_core::Point2;
use delone_core::base::error::{Error, Result};
use delone_core::base::watch::Watch;
use delone_core::live::plane::{self, Plane};
use delone_core::live::space::{self, Space};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{
    Column, Table, column, columns, flat, flattened, no_dimension, number_rows, rows, table, wide,
};
use crate::errors::Outcome;
use crate::signals::{watched, watched_attached};

/// Up to this number of points a call keeps the GIL: it is over before another thread could run.
const FEW: usize = 16;

type Points<'py> = PyReadonlyArray2<'py, f64>;
type Handles<'py> = PyReadonlyArray1<'py, i64>;
/// Corners, weights, the number of edits, and perhaps all handles.
pub type Weights = (Table<i64>, Table<f64>, i64, Option<Column<i64>>);

/// Something in 2-D or in 3-D.
enum Either<P, S> {
    Plane(P),
    Space(S),
}

impl<P, S> Either<P, S> {
    /// The number of coordinates.
    fn ndim(&self) -> usize {
        match self {
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }
}

/// A triangulation.
type Core = Either<Plane, Space>;

/// The result of `$work` on `$live`, a triangulation of either dimension.
macro_rules! each {
    ($core:expr, $live:ident => $work:expr) => {
        match $core {
            Either::Plane($live) => $work,
            Either::Space($live) => $work,
        }
    };
}

/// A Delaunay triangulation that is edited, in 2-D or in 3-D.
#[pyclass(frozen, module = "delone._core")]
pub struct Live {
    core: Mutex<Core>,
    /// How many edits are complete; changed with the lock.
    edits: AtomicI64,
    /// The number of coordinates.
    width: usize,
}

/// A state of a `Live`, which never changes.
#[pyclass(frozen, module = "delone._core")]
pub struct LiveState(Either<plane::State, space::State>);

/// The current triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct LiveArrays {
    /// The handles of the points, ascending, (n,).
    pub handles: Column<i64>,
    /// The points, (n, d).
    pub points: Table<f64>,
    /// Simplices as rows of these, (m, d + 1).
    pub simplices: Table<i32>,
    /// The simplex opposite each vertex, -1 outside, (m, d + 1).
    pub neighbors: Table<i32>,
    /// Whether the edge opposite each vertex is part of a segment, (m, 3); None without segments.
    pub constrained: Option<Table<bool>>,
    /// Rows that repeat earlier rows, and the first of these, (k, 2).
    pub duplicates: Table<i32>,
}

/// The segments of a triangulation.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct LiveSegments {
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

impl Live {
    fn of(core: Core) -> Self {
        Self {
            width: core.ndim(),
            core: Mutex::new(core),
            edits: AtomicI64::new(0),
        }
    }

    fn with<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Core, &Watch) -> Result<T> + Send,
    ) -> Outcome<T> {
        locked(&self.core, py, count, work)
    }

    /// The same for an edit.
    fn edit<T: Send>(
        &self,
        py: Python<'_>,
        count: usize,
        work: impl FnOnce(&mut Core, &Watch) -> Result<T> + Send,
    ) -> Outcome<T> {
        self.with(py, count, |core, watch| {
            let made = work(core, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(made)
        })
    }
}

/// The triangulation in which there may be segments.
fn plane(core: &mut Core) -> Result<&mut Plane> {
    match core {
        Either::Plane(plane) => Ok(plane),
        Either::Space(_) => Err(Error::Shape("segments need points in 2-D".into())),
    }
}

/// The error for states of different dimensions.
fn mixed() -> Error {
    Error::Shape("one state is in 2-D, the other in 3-D".into())
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

/// Which handles do not exist, and which are named twice.
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
impl Live {
    /// The triangulation of points with these handles, ascending, before the handle `total`.
    #[new]
    fn new(
        py: Python<'_>,
        points: Points<'_>,
        handles: Option<Handles<'_>>,
        total: usize,
        workers: usize,
    ) -> Outcome<Self> {
        let width = columns(&points);
        let points = flattened(&points, width, "points")?;
        let own = handles.as_ref().map(|h| flat(h, "handles")).transpose()?;
        let own = own.map(|own| checked_handles(own, points.len() / width.max(1), total));
        let own = own.transpose()?;
        let core = watched(py, |watch| {
            let (plane, space) = (points.as_chunks().0, points.as_chunks().0);
            match (width, own) {
                (2, None) => Plane::new(plane, workers, watch).map(Either::Plane),
                (3, None) => Space::new(space, workers, watch).map(Either::Space),
                (2, Some(own)) => Plane::of(plane, &own, total, workers, watch).map(Either::Plane),
                (3, Some(own)) => Space::of(space, &own, total, workers, watch).map(Either::Space),
                (other, _) => Err(no_dimension(other)),
            }
        })?;
        Ok(Self::of(core))
    }

    /// The number of coordinates, 2 or 3.
    #[getter]
    fn ndim(&self) -> usize {
        self.width
    }

    /// Numbers: points, vertices, simplices, and the next handle.
    fn counts(&self, py: Python<'_>) -> Outcome<[usize; 4]> {
        self.with(py, 0, |core, _| {
            Ok(each!(core, live => {
                [live.len(), live.vertices(), live.simplices(), live.total()]
            }))
        })
    }

    /// How many edits are complete.
    #[getter]
    fn edits(&self) -> i64 {
        self.edits.load(Ordering::Relaxed)
    }

    /// Inserts points and returns their handles.
    fn insert(&self, py: Python<'_>, points: Points<'_>, workers: usize) -> Outcome<Column<i64>> {
        let points = flattened(&points, self.width, "points")?;
        let made = self.edit(
            py,
            points.len() / self.width,
            |core, watch| each!(core, live => live.insert(points.as_chunks().0, workers, watch)),
        )?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes points.
    fn remove(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        self.edit(
            py,
            handles.len(),
            |core, watch| each!(core, live => live.remove(handles, workers, watch)),
        )
    }

    /// Removes points and the segments that end there, and returns the handles of these.
    fn remove_with_segments(
        &self,
        py: Python<'_>,
        handles: Handles<'_>,
        workers: usize,
    ) -> Outcome<Column<i64>> {
        let handles = flat(&handles, "handles")?;
        let gone = self.edit(py, usize::MAX, |core, watch| {
            plane(core)?.remove_with_segments(handles, workers, watch)
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
        let points = flattened(&points, self.width, "points")?;
        self.edit(py, handles.len(), |core, watch| {
            each!(core, live => live.relocate(handles, points.as_chunks().0, workers, watch))
        })
    }

    /// Which of these handles do not exist, or are named earlier.
    fn faults(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles")?;
        let [gone, twice] = self.with(py, handles.len(), |core, _| {
            Ok(each!(core, live => faults_of(handles, |h| live.has(h))))
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// The handles, ascending, and their points.
    fn points(&self, py: Python<'_>) -> Outcome<(Column<i64>, Table<f64>)> {
        let (handles, points) = self.with(py, usize::MAX, |core, watch| {
            each!(core, live => {
                let (handles, points) = live.points(watch)?;
                Ok((handles, points.into_flattened()))
            })
        })?;
        Ok((column(py, handles), wide(py, points, self.width)?))
    }

    /// The current triangulation; no simplices if all points are in one line or plane.
    fn arrays(&self, py: Python<'_>) -> Outcome<LiveArrays> {
        let (handles, points, simplices, neighbors, constrained, duplicates) =
            self.with(py, usize::MAX, |core, watch| {
                each!(core, live => {
                    let made = live.export(watch)?;
                    Ok((
                        made.rows,
                        made.points.into_flattened(),
                        made.arrays.simplices.into_flattened(),
                        made.arrays.neighbors.into_flattened(),
                        made.constrained.into_flattened(),
                        made.duplicates,
                    ))
                })
            })?;
        let corners = self.width + 1;
        Ok(LiveArrays {
            handles: column(py, handles),
            points: wide(py, points, self.width)?,
            simplices: wide(py, simplices, corners)?,
            neighbors: wide(py, neighbors, corners)?,
            constrained: match constrained.is_empty() {
                true => None,
                false => Some(wide(py, constrained, corners)?),
            },
            duplicates: number_rows(py, &duplicates)?,
        })
    }

    /// Chooses whether crossings of segments are split.
    fn split_crossings(&self, py: Python<'_>, split: bool) -> Outcome<()> {
        self.with(py, 0, |core, _| {
            let plane = plane(core)?;
            plane.split_crossings(split);
            Ok(())
        })
    }

    /// Whether there are segments, and whether crossings are split.
    fn constraints(&self, py: Python<'_>) -> Outcome<[bool; 2]> {
        self.with(py, 0, |core, _| {
            let plane = plane(core)?;
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
        let made = self.edit(py, usize::MAX, |core, watch| {
            let plane = plane(core)?;
            plane.insert_segments(ends, workers, watch)
        })?;
        Ok(column(py, (made.start as i64..made.end as i64).collect()))
    }

    /// Removes segments.
    fn remove_segments(&self, py: Python<'_>, handles: Handles<'_>, workers: usize) -> Outcome<()> {
        let handles = flat(&handles, "handles")?;
        self.edit(py, usize::MAX, |core, watch| {
            let plane = plane(core)?;
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
        self.edit(py, usize::MAX, |core, watch| {
            let plane = plane(core)?;
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
    fn segments(&self, py: Python<'_>) -> Outcome<LiveSegments> {
        let (handles, ends, crossings, added, total) = self.with(py, usize::MAX, |core, _| {
            let plane = plane(core)?;
            let (handles, ends) = plane.segments()?;
            let crossings = plane.crossings()?.into_iter().map(|c| c.map(i64::from));
            let added = plane.crossing_rows().iter().copied().map(i64::from);
            let crossings: Vec<_> = crossings.collect();
            let added: Vec<_> = added.collect();
            Ok((handles, ends, crossings, added, plane.segments_total()))
        })?;
        Ok(LiveSegments {
            handles: column(py, handles),
            ends: table(py, ends)?,
            crossings: table(py, crossings)?,
            added: column(py, added),
            total,
        })
    }

    /// Which of these handles of segments do not exist, or are named earlier.
    fn segment_faults(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<[Column<i64>; 2]> {
        let handles = flat(&handles, "handles")?;
        let [gone, twice] = self.with(py, handles.len(), |core, _| {
            let plane = plane(core)?;
            Ok(faults_of(handles, |h| plane.has_segment(h)))
        })?;
        Ok([column(py, gone), column(py, twice)])
    }

    /// Which of these handles of points are ends of segments, each with one, or crossings, with -1.
    fn held(&self, py: Python<'_>, handles: Handles<'_>) -> Outcome<Table<i64>> {
        let handles = flat(&handles, "handles")?;
        let held = self.with(py, handles.len(), |core, _| {
            let plane = plane(core)?;
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

    /// The handles of the corners of a simplex that contains each query, -1 outside, and weights; the
    /// number of edits so far; and if that is not `known`, the handles of all points.
    fn weights(&self, py: Python<'_>, xi: Points<'_>, known: i64) -> Outcome<Weights> {
        let queries = flattened(&xi, self.width, "xi")?;
        let edits = || self.edits.load(Ordering::Relaxed);
        let count = if edits() == known {
            queries.len() / self.width
        } else {
            usize::MAX
        };
        let (rows, weights, edit, own) = self.with(py, count, |core, watch| {
            let edit = edits();
            each!(core, live => {
                let found = live.corners(queries.as_chunks().0, watch)?;
                let (rows, weights) = (found.rows.into_flattened(), found.weights.into_flattened());
                let own = match edit == known {
                    true => None,
                    false => Some(live.points(watch)?.0),
                };
                Ok((rows, weights, edit, own))
            })
        })?;
        let corners = self.width + 1;
        let (rows, weights) = (wide(py, rows, corners)?, wide(py, weights, corners)?);
        Ok((rows, weights, edit, own.map(|own| column(py, own))))
    }

    /// The handles of the corners of a simplex that contains each query, -1 outside, and weights.
    fn corners(&self, py: Python<'_>, xi: Points<'_>) -> Outcome<(Table<i64>, Table<f64>)> {
        let queries = flattened(&xi, self.width, "xi")?;
        let (rows, weights) = self.with(py, queries.len() / self.width, |core, watch| {
            each!(core, live => {
                let found = live.corners(queries.as_chunks().0, watch)?;
                Ok((found.rows.into_flattened(), found.weights.into_flattened()))
            })
        })?;
        let corners = self.width + 1;
        Ok((wide(py, rows, corners)?, wide(py, weights, corners)?))
    }

    /// The handle of the nearest point to each query, -1 if there is none.
    fn nearest(&self, py: Python<'_>, xi: Points<'_>) -> Outcome<Column<i64>> {
        let queries = flattened(&xi, self.width, "xi")?;
        let found = self.with(
            py,
            queries.len() / self.width,
            |core, watch| each!(core, live => live.nearest(queries.as_chunks().0, watch)),
        )?;
        Ok(column(py, found))
    }

    /// The simplices that were removed and added since the last call, as handles.
    fn changes(&self, py: Python<'_>) -> Outcome<(Table<i64>, Table<i64>)> {
        let (gone, new) = self.with(py, usize::MAX, |core, watch| {
            each!(core, live => {
                let found = live.changes(watch)?;
                Ok((found.gone.into_flattened(), found.new.into_flattened()))
            })
        })?;
        let corners = self.width + 1;
        Ok((wide(py, gone, corners)?, wide(py, new, corners)?))
    }

    /// The current state.
    fn state(&self, py: Python<'_>) -> Outcome<LiveState> {
        self.with(py, usize::MAX, |core, watch| {
            Ok(LiveState(match core {
                Either::Plane(live) => Either::Plane(live.state(watch)?),
                Either::Space(live) => Either::Space(live.state(watch)?),
            }))
        })
    }

    /// Restores a state of the same dimension; not if `known` is given and is not the number of
    /// edits so far. Returns whether it was restored.
    #[pyo3(signature = (state, known=None))]
    fn restore(&self, py: Python<'_>, state: &LiveState, known: Option<i64>) -> Outcome<bool> {
        self.with(py, usize::MAX, |core, watch| {
            if known.is_some_and(|known| known != self.edits.load(Ordering::Relaxed)) {
                return Ok(false);
            }
            restored(core, state, watch)?;
            self.edits.fetch_add(1, Ordering::Relaxed);
            Ok(true)
        })
    }
}

/// Restores a state of the same dimension.
fn restored(core: &mut Core, state: &LiveState, watch: &Watch) -> Result<()> {
    match (core, &state.0) {
        (Either::Plane(live), Either::Plane(state)) => live.restore(state, watch),
        (Either::Space(live), Either::Space(state)) => live.restore(state, watch),
        _ => Err(mixed()),
    }
}

#[pymethods]
impl LiveState {
    /// The number of coordinates, 2 or 3.
    #[getter]
    fn ndim(&self) -> usize {
        self.0.ndim()
    }

    /// A separate triangulation in this state.
    fn open(&self, py: Python<'_>) -> Outcome<Live> {
        let core = watched(py, |watch| {
            let mut core = match self.0 {
                Either::Plane(_) => Either::Plane(Plane::new(&[], 1, watch)?),
                Either::Space(_) => Either::Space(Space::new(&[], 1, watch)?),
            };
            restored(&mut core, self, watch)?;
            Ok::<_, Error>(core)
        })?;
        Ok(Live::of(core))
    }

    /// Bytes that are not shared with another state of the same dimension.
    fn own_bytes(&self, other: &Self) -> Outcome<usize> {
        match (&self.0, &other.0) {
            (Either::Plane(own), Either::Plane(other)) => Ok(own.own_bytes(other)),
            (Either::Space(own), Either::Space(other)) => Ok(own.own_bytes(other)),
            _ => Err(mixed().into()),
        }
    }
}
