//! Conversion between NumPy arrays and slices of small arrays, without copying.

use numpy::ndarray::{Dimension, IntoDimension};
use numpy::{
    Element, PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use delone_core::base::error::{Error, Result};

use crate::errors::Outcome;

/// A 1-D NumPy array.
pub type Column<T> = Py<PyArray1<T>>;
/// A 2-D NumPy array.
pub type Table<T> = Py<PyArray2<T>>;

/// The rows of a C-contiguous array of width `D`.
pub fn rows<'a, T: Element, const D: usize>(
    array: &'a PyReadonlyArray2<'_, T>,
    name: &str,
) -> Result<&'a [[T; D]]> {
    Ok(flattened(array, D, name)?.as_chunks().0)
}

/// All numbers of an array with `width` columns, row by row.
pub fn flattened<'a, T: Element>(
    array: &'a PyReadonlyArray2<'_, T>,
    width: usize,
    name: &str,
) -> Result<&'a [T]> {
    let items = flat(array, name)?;
    require_width(array.shape()[1], width, name)?;
    Ok(items)
}

/// Checks a number of columns.
pub fn require_width(found: usize, width: usize, name: &str) -> Result<()> {
    if found == width {
        return Ok(());
    }
    let message = format!("{name} has {found} columns, not {width}");
    Err(Error::Shape(message))
}

/// The number of columns of an array: of points, their coordinates.
pub fn columns<T: Element>(array: &PyReadonlyArray2<'_, T>) -> usize {
    array.shape()[1]
}

/// The result of `$work` in dimension `$d`, 2 or 3: in it `$D` and `$N` are constants, the number of
/// coordinates and that of the corners of a simplex.
macro_rules! in_dimension {
    ($d:expr, $D:ident, $N:ident => $work:expr) => {
        match $d {
            2 => {
                #[allow(dead_code)]
                const $D: usize = 2;
                #[allow(dead_code)]
                const $N: usize = 3;
                $work
            }
            3 => {
                #[allow(dead_code)]
                const $D: usize = 3;
                #[allow(dead_code)]
                const $N: usize = 4;
                $work
            }
            other => Err(crate::arrays::no_dimension(other).into()),
        }
    };
}
pub(crate) use in_dimension;

/// The result of `$work` in dimension `$d`, 4 to 8: in it `$D`, `$N` and `$P` are constants, the number
/// of coordinates, that of the corners of a simplex, and the length of padded rows.
macro_rules! in_many {
    (@ $D:ident, $N:ident, $P:ident, $d:literal, $p:literal => $work:expr) => {{
        #[allow(dead_code)]
        const $D: usize = $d;
        #[allow(dead_code)]
        const $N: usize = $d + 1;
        #[allow(dead_code)]
        const $P: usize = $p;
        $work
    }};
    ($d:expr, $D:ident, $N:ident, $P:ident => $work:expr) => {
        match $d {
            4 => crate::arrays::in_many!(@ $D, $N, $P, 4, 4 => $work),
            5 => crate::arrays::in_many!(@ $D, $N, $P, 5, 8 => $work),
            6 => crate::arrays::in_many!(@ $D, $N, $P, 6, 8 => $work),
            7 => crate::arrays::in_many!(@ $D, $N, $P, 7, 8 => $work),
            8 => crate::arrays::in_many!(@ $D, $N, $P, 8, 8 => $work),
            other => Err(crate::arrays::not_many(other).into()),
        }
    };
}
pub(crate) use in_many;

/// The same for the dimension of a flat, 2 to 7.
macro_rules! in_flats {
    ($d:expr, $D:ident, $N:ident, $P:ident => $work:expr) => {
        match $d {
            2 => crate::arrays::in_many!(@ $D, $N, $P, 2, 4 => $work),
            3 => crate::arrays::in_many!(@ $D, $N, $P, 3, 4 => $work),
            many => crate::arrays::in_many!(many, $D, $N, $P => $work),
        }
    };
}
pub(crate) use in_flats;

/// The error for points with a number of coordinates that is not from 4 to 8.
pub fn not_many(columns: usize) -> Error {
    Error::Shape(format!("points have {columns} coordinates, not 4 to 8"))
}

/// The error for points with a number of coordinates that is neither 2 nor 3.
pub fn no_dimension(columns: usize) -> Error {
    Error::Shape(format!("points have {columns} coordinates, not 2 or 3"))
}

/// Rows that are checked together.
const CHECKED: usize = 1 << 10;

/// Checks that every entry of `table` lies in `from..to`.
pub fn in_range<const D: usize>(
    table: &[[i32; D]],
    from: i32,
    to: usize,
    name: &str,
) -> Result<()> {
    let width = (to as i64 - i64::from(from)).clamp(0, i64::from(u32::MAX)) as u32;
    let outside = |v: &i32| v.wrapping_sub(from) as u32 >= width;
    // Without an early end, the loop over a part compiles to vector instructions.
    let any = |rows: &[[i32; D]]| {
        rows.as_flattened()
            .iter()
            .fold(false, |b, v| b | outside(v))
    };
    let Some(part) = table.chunks(CHECKED).position(any) else {
        return Ok(());
    };
    let first = part * CHECKED;
    let in_part = table[first..]
        .iter()
        .position(|row| row.iter().any(outside));
    let i = first + in_part.unwrap_or(0);
    Err(Error::Shape(format!(
        "{name}[{i}] = {:?} is outside {from}..{to}",
        table[i]
    )))
}

/// Checks that every entry lies in `from..to`.
pub fn each_in_range(values: &[i32], from: i32, to: usize, name: &str) -> Result<()> {
    in_range(values.as_chunks::<1>().0, from, to, name)
}

/// Checks that `starts` partitions `length` entries.
pub fn are_starts(starts: &[i32], length: usize) -> Result<()> {
    let right =
        starts.first() == Some(&0) && starts.last() == Some(&(length as i32)) && starts.is_sorted();
    if right {
        Ok(())
    } else {
        Err(Error::Shape(format!(
            "starts must ascend from 0 to the number of entries, which is {length}"
        )))
    }
}

/// A vector of rows as an `(n, D)` array that owns it.
pub fn table<T: Element, const D: usize>(py: Python<'_>, rows: Vec<[T; D]>) -> Outcome<Table<T>> {
    let shape = [rows.len(), D];
    let array = PyArray1::from_vec(py, rows.into_flattened()).reshape(shape)?;
    Ok(array.unbind())
}

/// A read-only copy of rows: for few rows, cheaper than an array that owns a vector.
pub fn frozen<T: Element + Copy, const D: usize>(
    py: Python<'_>,
    rows: &[[T; D]],
) -> Outcome<Table<T>> {
    let array = PyArray2::<T>::zeros(py, [rows.len(), D], false);
    let mut lent = array.try_readwrite()?;
    lent.as_slice_mut()
        .map_err(PyErr::from)?
        .copy_from_slice(rows.as_flattened());
    lent.make_nonwriteable();
    Ok(array.unbind())
}

/// A vector as a read-only array that cannot be made writeable: the owner of its memory is not an array.
pub fn sealed<T: Element>(py: Python<'_>, values: Vec<T>) -> Outcome<Column<T>> {
    let array = PyArray1::from_vec(py, values);
    array.try_readwrite()?.make_nonwriteable();
    Ok(array.unbind())
}

/// Rows as a read-only `(n, D)` array that cannot be made writeable.
pub fn sealed_rows<T: Element, const D: usize>(
    py: Python<'_>,
    rows: Vec<[T; D]>,
) -> Outcome<Table<T>> {
    let shape = [rows.len(), D];
    let array = sealed(py, rows.into_flattened())?;
    Ok(array.bind(py).reshape(shape)?.unbind())
}

/// Up to this number of items a copy is cheaper than an array that owns a vector.
const FEW: usize = 16;

/// A vector as a one-dimensional array.
pub fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> Column<T> {
    if values.len() <= FEW {
        return PyArray1::from_slice(py, &values).unbind();
    }
    PyArray1::from_vec(py, values).unbind()
}

/// The items of a C-contiguous array of any shape, in row-major order.
pub fn flat<'a, T: Element, D: Dimension>(
    array: &'a PyReadonlyArray<'_, T, D>,
    name: &str,
) -> Result<&'a [T]> {
    array.as_slice().map_err(|_| {
        Error::Shape(format!(
            "{name} must be C-contiguous: pass np.ascontiguousarray({name})"
        ))
    })
}

/// A vector as an array of a shape with the same number of items.
pub fn shaped<T: Element, S: IntoDimension>(
    py: Python<'_>,
    values: Vec<T>,
    shape: S,
) -> Outcome<Py<PyArray<T, S::Dim>>> {
    let array = PyArray1::from_vec(py, values).reshape(shape)?;
    Ok(array.unbind())
}

/// Rows of `width` items, one after the other, as an `(n, width)` array.
pub fn wide<T: Element>(py: Python<'_>, items: Vec<T>, width: usize) -> Outcome<Table<T>> {
    let shape = [items.len() / width, width];
    shaped(py, items, shape)
}

/// A list of numbers as an array.
pub fn numbers(py: Python<'_>, numbers: Vec<u32>) -> Column<i32> {
    column(py, numbers.into_iter().map(|v| v as i32).collect())
}

/// Rows of numbers as an array.
pub fn number_rows<const D: usize>(py: Python<'_>, rows: &[[u32; D]]) -> Outcome<Table<i32>> {
    table(py, signed(rows))
}

/// Rows of numbers with a sign.
pub fn signed<const D: usize>(rows: &[[u32; D]]) -> Vec<[i32; D]> {
    rows.iter().map(|row| row.map(|v| v as i32)).collect()
}
