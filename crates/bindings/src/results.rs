//! Results that Python can also construct: from a file, from a pickle, or from arrays.

use delone_core::base::error::{Error, Result};
use numpy::{Element, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Column, Table};
use crate::given::unequal;

/// `tuple[NDArray[np.generic], ...]`
pub type Arrays<'py> = Bound<'py, PyTuple>;

/// `tuple[tuple[str, float], ...]`: stages with their seconds.
pub type Stages = Py<PyTuple>;

/// `Callable[[int, float], object]`: called with the number of vertices added and the smallest angle.
pub type Progress = Py<PyAny>;

/// `Callable[[int], object]`: called with the number of points added.
pub type Added = Py<PyAny>;

/// `Callable[[int, int], object]`: called with the pass and the number of poor tetrahedra.
pub type Passes = Py<PyAny>;

/// Gives a class that consists of arrays a constructor, which checks them, and pickling.
macro_rules! made_of_arrays {
    ($name:ident { $($field:ident: $kind:ty),+ $(,)? }) => {
        #[pymethods]
        impl $name {
            #[new]
            #[expect(clippy::too_many_arguments, reason = "one array each")]
            fn new(py: Python<'_>, $($field: $kind),+) -> crate::errors::Outcome<Self> {
                let made = Self { $($field),+ };
                made.check(py)?;
                Ok(made)
            }

            /// All arrays, in the order of the arguments of the constructor.
            fn arrays<'py>(&self, py: Python<'py>) -> crate::errors::Outcome<crate::results::Arrays<'py>> {
                Ok(pyo3::types::PyTuple::new(py, [$(self.$field.clone_ref(py).into_any()),+])?)
            }

            /// The arguments for unpickling.
            fn __getnewargs__<'py>(
                &self,
                py: Python<'py>,
            ) -> crate::errors::Outcome<crate::results::Arrays<'py>> {
                self.arrays(py)
            }
        }
    };
}
pub(crate) use made_of_arrays;

/// Checks that a table has `columns` columns; returns the number of its rows.
pub fn rows_of<T: Element>(
    py: Python<'_>,
    table: &Table<T>,
    columns: usize,
    name: &str,
) -> Result<usize> {
    let shape = table.bind(py).shape();
    if shape[1] == columns {
        return Ok(shape[0]);
    }
    let width = shape[1];
    Err(Error::Shape(format!(
        "{name} has {width} columns, not {columns}"
    )))
}

/// The number of entries of a column.
pub fn len_of<T: Element>(py: Python<'_>, column: &Column<T>) -> usize {
    column.bind(py).len()
}

/// Checks that pairs of lengths are equal.
pub fn require_equal(pairs: &[(usize, usize)]) -> Result<()> {
    if pairs.iter().all(|(a, b)| a == b) {
        return Ok(());
    }
    Err(unequal())
}
