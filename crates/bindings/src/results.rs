//! Results that Python can also construct: from a file, from a pickle, or from arrays.

use delone_core::base::error::Result;
use numpy::ndarray::Dimension;
use numpy::{Element, PyArray, PyArrayMethods, PyReadonlyArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::arrays::{Column, Table, require_width};
use crate::errors::Outcome;
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

/// Gives a class that consists of arrays a constructor, which checks them, and pickling; with a name at
/// the end, also a struct of that name, which has the arrays borrowed for one call, and `lend`.
macro_rules! made_of_arrays {
    ($name:ident { $($field:ident: $kind:ty),+ $(,)? } lent as $lent:ident) => {
        made_of_arrays!($name { $($field: $kind),+ });

        #[allow(dead_code, reason = "some arrays are not read")]
        struct $lent<'py> {
            $($field: <$kind as crate::results::Borrowed>::Lent<'py>),+
        }

        impl $name {
            fn lend<'py>(&self, py: Python<'py>) -> crate::errors::Outcome<$lent<'py>> {
                use crate::results::Borrowed;
                Ok($lent { $($field: self.$field.lend(py)?),+ })
            }
        }
    };
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

/// An array that can be borrowed for one call.
pub trait Borrowed {
    /// What is borrowed.
    type Lent<'py>;

    /// Borrows it.
    fn lend<'py>(&self, py: Python<'py>) -> Outcome<Self::Lent<'py>>;
}

impl<T: Element, D: Dimension> Borrowed for Py<PyArray<T, D>> {
    type Lent<'py> = PyReadonlyArray<'py, T, D>;

    fn lend<'py>(&self, py: Python<'py>) -> Outcome<Self::Lent<'py>> {
        Ok(self.bind(py).try_readonly()?)
    }
}

/// Checks that a table has `columns` columns; returns the number of its rows.
pub fn rows_of<T: Element>(
    py: Python<'_>,
    table: &Table<T>,
    columns: usize,
    name: &str,
) -> Result<usize> {
    let table = table.bind(py);
    require_width(table.shape()[1], columns, name)?;
    Ok(table.shape()[0])
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
