//! Refined meshes as arrays.

use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use delone::arrays::{Domain, Lines, Refined, Rounds, Samples};
use delone::{Error, Options, Result};
use delone_core::memory::copied;
use delone_core::refine::judge;
use delone_core::refine::smooth::{self, Target};
use delone_core::watch::Watch;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, Table, column, flat, in_range, numbers, rows, table};
use crate::errors::{attached, raise};
use crate::given::pairs;
use crate::live::{broken, locked};
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

/// Pairs of vertices: the segments, and the ends of lines.
type Pairs = (Vec<[u32; 2]>, Option<Vec<[u32; 2]>>);

impl Given<'_> {
    fn pairs(&self, py: Python<'_>) -> PyResult<Pairs> {
        attached(py, || {
            let n = rows::<f64, 2>(&self.points, "points")?.len();
            let ends = self.lines.as_ref().map(|l| pairs(&l.1, n, "ends"));
            Ok((pairs(&self.segments, n, "segments")?, ends.transpose()?))
        })
    }

    /// The domain, without areas.
    fn domain<'a>(&'a self, (segments, ends): &'a Pairs) -> Result<Domain<'a>> {
        let lines = match (&self.lines, ends) {
            (Some((of, _, on)), Some(ends)) => Some(Lines {
                of: flat(of, "of")?,
                ends,
                on: flat(on, "on")?,
            }),
            _ => None,
        };
        Ok(Domain {
            points: rows(&self.points, "points")?,
            simplices: rows(&self.simplices, "simplices")?,
            neighbors: Some(rows(&self.neighbors, "neighbors")?),
            labels: flat(&self.labels, "labels")?,
            segments,
            lines,
            frozen: flat(&self.frozen, "frozen")?,
            ..Domain::default()
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
    /// The label of each triangle, -1 outside of the domain, (m,).
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
    progress: Option<Py<PyAny>>,
) -> PyResult<RefinedMesh> {
    let given = Given {
        points,
        simplices,
        neighbors,
        labels,
        segments,
        frozen,
        lines,
    };
    let pairs = given.pairs(py)?;
    let domain = attached(py, || {
        Ok(Domain {
            areas: flat(&areas, "areas")?,
            circles,
            sizes_yield,
            ..given.domain(&pairs)?
        })
    })?;
    let reporter = progress.map(Reporter::new);
    let outcome = stoppable(py, |stop| {
        let tell = |added: usize, smallest: &mut dyn FnMut() -> f64| {
            if let Some(reporter) = &reporter {
                reporter.tell(added, smallest);
            }
        };
        let stop = || reporter.as_ref().is_some_and(Reporter::failed) || stop();
        let options = Options::new().interrupt(&stop).progress(&tell);
        let options = options.min_angle(min_angle).max_points(max_vertices);
        options.refine(domain)
    });
    if let Some(error) = reporter.and_then(Reporter::exception) {
        return Err(error);
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
    ) -> PyResult<Self> {
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
        let pairs = given.pairs(py)?;
        let (domain, samples) = attached(py, || {
            let domain = Domain {
                circles,
                sizes_yield,
                ..given.domain(&pairs)?
            };
            let samples = Samples {
                positions: rows(&samples.0, "positions")?,
                areas: flat(&samples.1, "areas")?,
            };
            Ok((domain, samples))
        })?;
        let rounds = stoppable(py, |stop| {
            let options = Options::new().interrupt(stop).min_angle(min_angle);
            options.rounds(domain, samples)
        })?;
        Ok(Self(Mutex::new(rounds)))
    }

    /// The centers, (k, 2), and the labels, (k,), of triangles that are new since the last call.
    fn fresh(&self, py: Python<'_>, workers: usize) -> PyResult<(Table<f64>, Column<i32>)> {
        let found = locked(&self.0, py, usize::MAX, |rounds, watch| {
            rounds.fresh(workers, watch)
        })?;
        Ok((table(py, found.centers)?, column(py, found.labels)))
    }

    /// Sets the areas wanted at these centers; returns whether all triangles comply.
    fn comply(&self, py: Python<'_>, wanted: PyReadonlyArray1<'_, f64>) -> PyResult<bool> {
        let wanted = attached(py, || flat(&wanted, "wanted"))?;
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
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(bool, usize)> {
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
            Some(error) => Err(error),
            None => outcome,
        }
    }

    /// The triangulation, with the vertices of all rounds.
    fn export(&self, py: Python<'_>) -> PyResult<RefinedMesh> {
        let made = locked(&self.0, py, usize::MAX, Rounds::export)?;
        arrays_of(py, made)
    }
}

/// Calls a Python function from time to time, until it raises an exception.
struct Reporter {
    progress: Py<PyAny>,
    called: Mutex<Instant>,
    failure: OnceLock<PyErr>,
}

impl Reporter {
    fn new(progress: Py<PyAny>) -> Self {
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
fn arrays_of(py: Python<'_>, made: Refined) -> PyResult<RefinedMesh> {
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
) -> PyResult<JudgedTriangles> {
    let given = || -> Result<_> {
        let all = rows(&points, "points")?;
        let simplices: &[[i32; 3]] = rows(&simplices, "simplices")?;
        in_range(simplices, 0, all.len(), "simplices")?;
        Ok((all, simplices))
    };
    let (points, simplices) = given().map_err(|e| raise(py, &e))?;
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
) -> PyResult<SmoothedMesh> {
    let (mesh, free, target) = attached(py, || {
        let mesh = smooth::Domain {
            points: copied(rows(&points, "points")?)?,
            simplices: copied(rows(&simplices, "simplices")?)?,
            neighbors: copied(rows(&neighbors, "neighbors")?)?,
            sides: copied(rows(&sides, "sides")?)?,
        };
        let (count, free) = (mesh.simplices.len(), flat(&free, "free")?);
        in_range(&mesh.simplices, 0, mesh.points.len(), "simplices")?;
        in_range(&mesh.neighbors, -1, count, "neighbors")?;
        let whole = mesh.neighbors.len() == count
            && mesh.sides.len() == count
            && free.len() == mesh.points.len();
        let target = Target::named(target);
        match target.filter(|_| whole) {
            Some(target) => Ok((mesh, free, target)),
            None => Err(Error::Shape("the arrays of a mesh differ in length".into())),
        }
    })?;
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
