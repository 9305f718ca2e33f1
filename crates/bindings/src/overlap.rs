//! Grids of cells on the sphere and in the plane, and the areas that two of them share.

use delone_core::base::error::Result;
use delone_core::overlap::{
    Checked, Grid, Polygons, Rows, Shared, check, check_plane, overlaps, overlaps_plane,
};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{Column, column, flat, rows};
use crate::errors::Outcome;
use crate::signals::watched;

/// The arrays of a grid.
enum Given {
    Polygons {
        vectors: Py<PyArray2<f64>>,
        rings: Py<PyArray1<i64>>,
        cells: Py<PyArray1<i64>>,
        holes: Py<PyArray1<bool>>,
    },
    Rows {
        tangents: Py<PyArray2<f64>>,
        starts: Py<PyArray1<i64>>,
        meridians: Py<PyArray2<f64>>,
        numbers: Py<PyArray1<i32>>,
        count: usize,
    },
}

/// The same, lent for a call.
enum Lent<'py> {
    Polygons {
        vectors: PyReadonlyArray2<'py, f64>,
        rings: PyReadonlyArray1<'py, i64>,
        cells: PyReadonlyArray1<'py, i64>,
        holes: PyReadonlyArray1<'py, bool>,
    },
    Rows {
        tangents: PyReadonlyArray2<'py, f64>,
        starts: PyReadonlyArray1<'py, i64>,
        meridians: PyReadonlyArray2<'py, f64>,
        numbers: PyReadonlyArray1<'py, i32>,
        count: usize,
    },
}

impl Given {
    fn lent<'py>(&self, py: Python<'py>) -> Outcome<Lent<'py>> {
        use numpy::PyArrayMethods;
        Ok(match self {
            Given::Polygons {
                vectors,
                rings,
                cells,
                holes,
            } => Lent::Polygons {
                vectors: vectors.bind(py).try_readonly()?,
                rings: rings.bind(py).try_readonly()?,
                cells: cells.bind(py).try_readonly()?,
                holes: holes.bind(py).try_readonly()?,
            },
            Given::Rows {
                tangents,
                starts,
                meridians,
                numbers,
                count,
            } => Lent::Rows {
                tangents: tangents.bind(py).try_readonly()?,
                starts: starts.bind(py).try_readonly()?,
                meridians: meridians.bind(py).try_readonly()?,
                numbers: numbers.bind(py).try_readonly()?,
                count: *count,
            },
        })
    }
}

impl Lent<'_> {
    fn grid(&self) -> Result<Grid<'_>> {
        Ok(match self {
            Lent::Polygons {
                vectors,
                rings,
                cells,
                holes,
            } => Grid::Polygons(Polygons {
                vectors: rows(vectors, "vectors")?,
                rings: flat(rings, "rings")?,
                cells: flat(cells, "cells")?,
                holes: flat(holes, "holes")?,
            }),
            Lent::Rows {
                tangents,
                starts,
                meridians,
                numbers,
                count,
            } => Grid::Rows(Rows {
                tangents: rows(tangents, "tangents")?,
                starts: flat(starts, "starts")?,
                meridians: rows(meridians, "meridians")?,
                numbers: flat(numbers, "numbers")?,
                count: *count,
            }),
        })
    }
}

/// What is known about each cell of a grid.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct CheckedCells {
    /// Areas, on the sphere in steradians, 0 of cells that have none, (n,).
    pub areas: Column<f64>,
    /// 0, 1 for empty cells, 2 for opposite ends of a side, 3 for cells beyond a hemisphere, 4 for
    /// sides that cross, (n,).
    pub faults: Column<u8>,
    /// Whether outer rings were clockwise, (n,).
    pub turned: Column<bool>,
    /// Whether cells are concave, or have several rings, (n,).
    pub concave: Column<bool>,
    /// How many corners repeat the one before.
    pub repeated: usize,
}

impl CheckedCells {
    fn of(py: Python<'_>, found: Checked) -> Self {
        Self {
            areas: column(py, found.areas),
            faults: column(py, found.faults),
            turned: column(py, found.turned),
            concave: column(py, found.concave),
            repeated: found.repeated,
        }
    }
}

/// The areas that cells of two grids share, as compressed rows.
#[pyclass(frozen, get_all, module = "delone._core")]
pub struct SharedCells {
    /// Where the entries of each cell of the first grid start, and their number, (n + 1,).
    pub indptr: Column<i64>,
    /// Cells of the second grid, (k,).
    pub indices: Column<i32>,
    /// Areas, on the sphere in steradians, (k,).
    pub areas: Column<f64>,
    /// Sums over the cells of the first grid, (n,).
    pub first: Column<f64>,
    /// Sums over the cells of the second grid, (m,).
    pub second: Column<f64>,
}

impl SharedCells {
    fn of(py: Python<'_>, found: Shared) -> Self {
        Self {
            indptr: column(py, found.starts),
            indices: column(py, found.cells),
            areas: column(py, found.areas),
            first: column(py, found.first),
            second: column(py, found.second),
        }
    }
}

/// The cells of a grid on the sphere.
#[pyclass(frozen, module = "delone._core")]
pub struct CellGrid(Given);

#[pymethods]
impl CellGrid {
    /// Cells with arcs of great circles as sides: corners, where their rings start, where the rings
    /// of cells start, and whether rings are holes.
    #[staticmethod]
    fn polygons(
        vectors: Py<PyArray2<f64>>,
        rings: Py<PyArray1<i64>>,
        cells: Py<PyArray1<i64>>,
        holes: Py<PyArray1<bool>>,
    ) -> Self {
        Self(Given::Polygons {
            vectors,
            rings,
            cells,
            holes,
        })
    }

    /// Cells between meridians and parallels, by rows: tangents of latitudes, where the meridians
    /// of rows start, their directions, the number of the cell east of each or -1, and the number
    /// of cells.
    #[staticmethod]
    fn rows(
        tangents: Py<PyArray2<f64>>,
        starts: Py<PyArray1<i64>>,
        meridians: Py<PyArray2<f64>>,
        numbers: Py<PyArray1<i32>>,
        count: usize,
    ) -> Self {
        Self(Given::Rows {
            tangents,
            starts,
            meridians,
            numbers,
            count,
        })
    }

    /// Areas and faults; sides that cross are only searched for if `crossing`.
    fn check(&self, py: Python<'_>, crossing: bool, workers: usize) -> Outcome<CheckedCells> {
        let lent = self.0.lent(py)?;
        let grid = lent.grid()?;
        let found = watched(py, |watch| check(&grid, crossing, workers, watch))?;
        Ok(CheckedCells::of(py, found))
    }

    /// What the cells share with those of another grid; cells with faults share nothing.
    fn overlaps(&self, py: Python<'_>, other: &Self, workers: usize) -> Outcome<SharedCells> {
        let (lent, beside) = (self.0.lent(py)?, other.0.lent(py)?);
        let grid = lent.grid()?;
        let target = beside.grid()?;
        let found = watched(py, |watch| overlaps(&grid, &target, workers, watch))?;
        Ok(SharedCells::of(py, found))
    }
}

/// The cells of a grid in the plane.
#[pyclass(frozen, module = "delone._core")]
pub struct PlaneCells {
    points: Py<PyArray2<f64>>,
    rings: Py<PyArray1<i64>>,
    cells: Py<PyArray1<i64>>,
    holes: Py<PyArray1<bool>>,
}

/// The arrays of [`PlaneCells`], lent for a call.
struct LentPlane<'py> {
    points: PyReadonlyArray2<'py, f64>,
    rings: PyReadonlyArray1<'py, i64>,
    cells: PyReadonlyArray1<'py, i64>,
    holes: PyReadonlyArray1<'py, bool>,
}

impl LentPlane<'_> {
    fn cells(&self) -> Result<Polygons<'_, 2>> {
        Ok(Polygons {
            vectors: rows(&self.points, "points")?,
            rings: flat(&self.rings, "rings")?,
            cells: flat(&self.cells, "cells")?,
            holes: flat(&self.holes, "holes")?,
        })
    }
}

impl PlaneCells {
    fn lent<'py>(&self, py: Python<'py>) -> Outcome<LentPlane<'py>> {
        use numpy::PyArrayMethods;
        Ok(LentPlane {
            points: self.points.bind(py).try_readonly()?,
            rings: self.rings.bind(py).try_readonly()?,
            cells: self.cells.bind(py).try_readonly()?,
            holes: self.holes.bind(py).try_readonly()?,
        })
    }
}

#[pymethods]
impl PlaneCells {
    /// Cells of corners, where their rings start, where the rings of cells start, and whether rings
    /// are holes.
    #[new]
    fn new(
        points: Py<PyArray2<f64>>,
        rings: Py<PyArray1<i64>>,
        cells: Py<PyArray1<i64>>,
        holes: Py<PyArray1<bool>>,
    ) -> Self {
        Self {
            points,
            rings,
            cells,
            holes,
        }
    }

    /// Areas and faults; sides that cross are only searched for if `crossing`.
    fn check(&self, py: Python<'_>, crossing: bool, workers: usize) -> Outcome<CheckedCells> {
        let lent = self.lent(py)?;
        let cells = lent.cells()?;
        let found = watched(py, |watch| check_plane(&cells, crossing, workers, watch))?;
        Ok(CheckedCells::of(py, found))
    }

    /// What the cells share with those of another grid; cells with faults share nothing.
    fn overlaps(&self, py: Python<'_>, other: &Self, workers: usize) -> Outcome<SharedCells> {
        let (lent, beside) = (self.lent(py)?, other.lent(py)?);
        let cells = lent.cells()?;
        let others = beside.cells()?;
        let found = watched(py, |watch| overlaps_plane(&cells, &others, workers, watch))?;
        Ok(SharedCells::of(py, found))
    }
}
