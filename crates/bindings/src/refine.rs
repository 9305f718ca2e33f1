//! Refined meshes as arrays.

use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use delone_core::base::error::Result;
use delone_core::base::memory::copied;
use delone_core::base::watch::Watch;
use delone_core::refine::smooth;
use delone_core::refine::{Lines, Refined, Rounds, Samples, Task, judge, refine_telling};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, each_in_range, flat, numbers, rows, table};
use crate::errors::Outcome;
use crate::given::{checked, pairs, simplices_of, target_of, unequal};
use crate::live::{broken, locked};
use crate::results::Progress;
use crate::signals::{stoppable, watched};

/// `(of, ends, on)`: the line of each segment, the ends of lines, the line of each point or -1.
type OfLines<'py> = (
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
);

/// `(points, simplices, neighbors, labels, segments, frozen)`.
type OfDomain<'py> = (
    PyReadonlyArray2<'py, f64>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, bool>,
);

/// The arrays of a domain.
struct Given<'py> {
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    segments: PyReadonlyArray2<'py, i32>,
    frozen: PyReadonlyArray1<'py, bool>,
    lines: Option<OfLines<'py>>,
}

/// What a refinement must reach, see `Task`.
#[derive(Clone, Copy)]
struct Bounds {
    min_angle: f64,
    circles: bool,
    sizes_yield: bool,
    max_vertices: usize,
}

/// Pairs of vertices: the segments, and the ends of lines.
type Pairs = (Vec<[u32; 2]>, Option<Vec<[u32; 2]>>);

impl Given<'_> {
    fn pairs(&self) -> Result<Pairs> {
        let n = rows::<f64, 2>(&self.points, "points")?.len();
        let ends = self.lines.as_ref().map(|l| pairs(&l.1, n, "ends"));
        Ok((pairs(&self.segments, n, "segments")?, ends.transpose()?))
    }

    /// The task, after a check of all arrays.
    fn task<'a>(
        &'a self,
        (segments, ends): &'a Pairs,
        areas: &'a [f64],
        bounds: Bounds,
    ) -> Result<Task<'a>> {
        let lines = match (&self.lines, ends) {
            (Some((of, _, on)), Some(ends)) => Some(Lines {
                of: flat(of, "of")?,
                ends,
                on: flat(on, "on")?,
            }),
            _ => None,
        };
        let given = checked(&self.points, &self.simplices, &self.neighbors)?;
        let (labels, frozen) = (flat(&self.labels, "labels")?, flat(&self.frozen, "frozen")?);
        let mut fit = labels.len() == given.simplices.len();
        if let Some(lines) = &lines {
            let count = lines.ends.len();
            each_in_range(lines.of, 0, count, "of")?;
            each_in_range(lines.on, -1, count, "on")?;
            fit &= lines.of.len() == segments.len() && lines.on.len() == given.points.len();
            fit &= frozen.len() == count;
        } else {
            fit &= frozen.len() == segments.len();
        }
        if !fit {
            return Err(unequal());
        }
        Ok(Task {
            points: given.points,
            simplices: given.simplices,
            neighbors: Some(given.neighbors),
            labels,
            areas,
            segments,
            lines,
            frozen,
            min_angle: bounds.min_angle,
            circles: bounds.circles,
            sizes_yield: bounds.sizes_yield,
            max_vertices: bounds.max_vertices,
        })
    }
}

/// Minimum time between two calls of `progress`.
const BETWEEN: Duration = Duration::from_millis(100);

/// A refined triangulation of the hull.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct RefinedMesh {
    /// Added vertices; they follow the input vertices, (a, 2).
    pub added: Table<f64>,
    /// The line that each of these lies on, or -1, (a,).
    pub on: Column<i32>,
    /// Vertices of the triangles, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// The line under the edge opposite each vertex, or -1, (m, 3).
    pub sides: Table<i32>,
    /// The label of each triangle, -1 outside the domain, (m,).
    pub labels: Column<i32>,
    /// The number of the unrefined needle that contains each triangle, or -1, (m,).
    pub needles: Column<i32>,
    /// Number of vertices added on segments.
    pub for_segments: usize,
    /// Number of vertices added inside for angles.
    pub for_angles: usize,
    /// Number of vertices added inside for sizes.
    pub for_sizes: usize,
    /// Whether the limit on vertices was reached.
    pub exhausted: bool,
}

/// Refines a triangulation. `progress` is called with the number of added vertices and the current
/// smallest angle.
#[pyfunction]
#[pyo3(signature = (points, simplices, neighbors, labels, areas, segments, frozen, min_angle, max_vertices,
                    lines=None, circles=false, sizes_yield=false, progress=None))]
#[expect(clippy::too_many_arguments, reason = "one array each")]
pub fn refine2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    neighbors: PyReadonlyArray2<'py, i32>,
    labels: PyReadonlyArray1<'py, i32>,
    areas: PyReadonlyArray1<'py, f64>,
    segments: PyReadonlyArray2<'py, i32>,
    frozen: PyReadonlyArray1<'py, bool>,
    min_angle: f64,
    max_vertices: usize,
    lines: Option<OfLines<'py>>,
    circles: bool,
    sizes_yield: bool,
    progress: Option<Progress>,
) -> Outcome<RefinedMesh> {
    let given = Given {
        points,
        simplices,
        neighbors,
        labels,
        segments,
        frozen,
        lines,
    };
    let pairs = given.pairs()?;
    let bounds = Bounds {
        min_angle,
        circles,
        sizes_yield,
        max_vertices,
    };
    let task = given.task(&pairs, flat(&areas, "areas")?, bounds)?;
    if task.areas.len() != task.simplices.len() {
        return Err(unequal().into());
    }
    let reporter = progress.map(Reporter::new);
    let outcome = stoppable(py, |stop| {
        let stop = || reporter.as_ref().is_some_and(Reporter::failed) || stop();
        let watch = Watch::new(&stop);
        let mut tell = |added: usize, smallest: &mut dyn FnMut() -> f64| {
            if let Some(reporter) = &reporter {
                reporter.tell(added, smallest);
            }
            watch.check()
        };
        refine_telling(task, &watch, &mut tell)
    });
    if let Some(error) = reporter.and_then(Reporter::exception) {
        return Err(error.into());
    }
    arrays_of(py, outcome?)
}

/// A refinement in rounds, between which areas are sampled.
#[pyclass(frozen, module = "delone._core")]
pub struct Refinement2(Mutex<Rounds>);

#[pymethods]
impl Refinement2 {
    /// A domain `(points, simplices, neighbors, labels, segments, frozen)` with lines; `samples` are positions
    /// in it and the largest areas of triangles there.
    #[new]
    #[pyo3(signature = (domain, lines, samples, min_angle, circles, sizes_yield))]
    fn new(
        py: Python<'_>,
        domain: OfDomain<'_>,
        lines: OfLines<'_>,
        samples: (PyReadonlyArray2<'_, f64>, PyReadonlyArray1<'_, f64>),
        min_angle: f64,
        circles: bool,
        sizes_yield: bool,
    ) -> Outcome<Self> {
        let (points, simplices, neighbors, labels, segments, frozen) = domain;
        let given = Given {
            points,
            simplices,
            neighbors,
            labels,
            segments,
            frozen,
            lines: Some(lines),
        };
        let pairs = given.pairs()?;
        // The areas are those of the samples, and each round has its own limit on vertices.
        let bounds = Bounds {
            min_angle,
            circles,
            sizes_yield,
            max_vertices: usize::MAX,
        };
        let samples = Samples {
            positions: rows(&samples.0, "positions")?,
            areas: flat(&samples.1, "areas")?,
        };
        if samples.areas.len() != samples.positions.len() {
            return Err(unequal().into());
        }
        let task = given.task(&pairs, &[], bounds)?;
        let rounds = watched(py, |watch| Rounds::new(task, samples, watch))?;
        Ok(Self(Mutex::new(rounds)))
    }

    /// The centers, (k, 2), and the labels, (k,), of triangles that are new since the last call.
    fn fresh(&self, py: Python<'_>, workers: usize) -> Outcome<(Table<f64>, Column<i32>)> {
        let found = locked(&self.0, py, usize::MAX, |rounds, watch| {
            rounds.fresh(workers, watch)
        })?;
        Ok((table(py, found.centers)?, column(py, found.labels)))
    }

    /// Sets the areas wanted at these centers; returns whether all triangles comply.
    fn comply(&self, py: Python<'_>, wanted: PyReadonlyArray1<'_, f64>) -> Outcome<bool> {
        let wanted = flat(&wanted, "wanted")?;
        locked(&self.0, py, usize::MAX, |rounds, watch| {
            rounds.comply(wanted, watch)
        })
    }

    /// One round; returns whether `max_vertices`, the number of vertices to add, was enough, and
    /// the number of vertices added in all rounds.
    fn refine(
        &self,
        py: Python<'_>,
        max_vertices: usize,
        progress: Option<Progress>,
    ) -> Outcome<(bool, usize)> {
        let reporter = progress.map(Reporter::new);
        let outcome = stoppable(py, |stop| -> Result<_> {
            let mut tell = |added: usize, smallest: &mut dyn FnMut() -> f64| {
                if let Some(reporter) = &reporter {
                    reporter.tell(added, smallest);
                }
                Ok(())
            };
            let stop = || reporter.as_ref().is_some_and(Reporter::failed) || stop();
            let mut rounds = self.0.lock().map_err(|_| broken())?;
            let done = rounds.refine(max_vertices, &Watch::new(&stop), &mut tell)?;
            Ok((done, rounds.added()))
        });
        match reporter.and_then(Reporter::exception) {
            Some(error) => Err(error.into()),
            None => outcome,
        }
    }

    /// The triangulation, with the vertices of all rounds.
    fn export(&self, py: Python<'_>) -> Outcome<RefinedMesh> {
        let made = locked(&self.0, py, usize::MAX, Rounds::export)?;
        arrays_of(py, made)
    }
}

/// Calls a Python function from time to time, until it raises an exception.
struct Reporter {
    progress: Progress,
    called: Mutex<Instant>,
    failure: OnceLock<PyErr>,
}

impl Reporter {
    fn new(progress: Progress) -> Self {
        Self {
            progress,
            called: Mutex::new(Instant::now()),
            failure: OnceLock::new(),
        }
    }

    fn tell(&self, added: usize, smallest: &mut dyn FnMut() -> f64) {
        let Ok(mut called) = self.called.try_lock() else {
            return;
        };
        if called.elapsed() < BETWEEN {
            return;
        }
        let angle = smallest();
        let result = Python::attach(|py| self.progress.call1(py, (added, angle)).map(|_| ()));
        if let Err(error) = result {
            let _ = self.failure.set(error);
        }
        *called = Instant::now();
    }

    fn failed(&self) -> bool {
        self.failure.get().is_some()
    }

    fn exception(self) -> Option<PyErr> {
        self.failure.into_inner()
    }
}

/// The result as Python arrays.
fn arrays_of(py: Python<'_>, made: Refined) -> Outcome<RefinedMesh> {
    Ok(RefinedMesh {
        added: table(py, made.added)?,
        on: column(py, made.on),
        simplices: table(py, made.simplices)?,
        neighbors: table(py, made.neighbors)?,
        sides: table(py, made.sides)?,
        labels: column(py, made.labels),
        needles: column(py, made.needles),
        for_segments: made.counts.segment,
        for_angles: made.counts.angle,
        for_sizes: made.counts.size,
        exhausted: made.exhausted,
    })
}

/// Triangles with small, extreme or unknown angles.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct JudgedTriangles {
    /// Those with an angle below the bound, (k,).
    pub below: Column<i32>,
    /// Those that include the smallest and the largest angle, (e,).
    pub extremes: Column<i32>,
    /// Those that are beyond the range of doubles, (b,).
    pub beyond: Column<i32>,
}

/// The triangles with an angle below a bound, given by its squared cosine; those that include the
/// smallest and the largest angle; and those beyond the range of doubles.
#[pyfunction]
pub fn judge2<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    simplices: PyReadonlyArray2<'py, i32>,
    cos2: f64,
) -> Outcome<JudgedTriangles> {
    let points = rows(&points, "points")?;
    let simplices = simplices_of(&simplices, points.len())?;
    let found = watched(py, |watch| judge(points, simplices, cos2, watch))?;
    Ok(JudgedTriangles {
        below: numbers(py, found.below),
        extremes: numbers(py, found.extremes),
        beyond: numbers(py, found.beyond),
    })
}

/// A mesh whose free vertices have moved.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct SmoothedMesh {
    /// The coordinates, (n, 2).
    pub points: Table<f64>,
    /// Vertices of the triangles, each in the region that it was in before, (m, 3).
    pub simplices: Table<i32>,
    /// The triangle opposite each vertex, -1 outside, (m, 3).
    pub neighbors: Table<i32>,
    /// The line under the edge opposite each vertex, or -1, (m, 3).
    pub sides: Table<i32>,
}

/// Moves free vertices of a mesh toward better positions; `cos2` is the squared cosine of the bound.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one array each")]
pub fn smooth2(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    simplices: PyReadonlyArray2<'_, i32>,
    neighbors: PyReadonlyArray2<'_, i32>,
    sides: PyReadonlyArray2<'_, i32>,
    free: PyReadonlyArray1<'_, bool>,
    cos2: f64,
    target: &str,
    rounds: usize,
    workers: usize,
) -> Outcome<SmoothedMesh> {
    let given = checked(&points, &simplices, &neighbors)?;
    let (sides, free) = (rows(&sides, "sides")?, flat(&free, "free")?);
    if sides.len() != given.simplices.len() || free.len() != given.points.len() {
        return Err(unequal().into());
    }
    let target = target_of(target)?;
    let mesh = smooth::Domain {
        points: copied(given.points)?,
        simplices: copied(given.simplices)?,
        neighbors: copied(given.neighbors)?,
        sides: copied(sides)?,
    };
    let rules = smooth::Rules {
        free,
        cos2,
        target,
        rounds,
        workers,
    };
    let made = watched(py, |watch| smooth::smooth(mesh, &rules, watch))?;
    Ok(SmoothedMesh {
        points: table(py, made.points)?,
        simplices: table(py, made.simplices)?,
        neighbors: table(py, made.neighbors)?,
        sides: table(py, made.sides)?,
    })
}
