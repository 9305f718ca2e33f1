//! The door between Python and the core: arrays in, arrays out, errors as Python exceptions.
//! No algorithm lives here.

mod arrays;
mod errors;
mod lawson;
mod predicates;
mod signals;
mod triangulation;

use pyo3::prelude::*;

/// The compiled core of delone.
#[pymodule(gil_used = false)]
fn _core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add_function(wrap_pyfunction!(predicates::orient2d, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::incircle, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::orient3d, m)?)?;
    m.add_function(wrap_pyfunction!(predicates::insphere, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::methods2, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::triangulate2, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::validate2, m)?)?;
    m.add_function(wrap_pyfunction!(triangulation::find_simplex2, m)?)?;
    m.add_function(wrap_pyfunction!(lawson::lawson2, m)?)?;
    m.add_function(wrap_pyfunction!(lawson::neighbors2, m)?)?;
    Ok(())
}
