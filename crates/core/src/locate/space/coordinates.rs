//! Locates queries in 3-D with barycentric coordinates; outside, on request, with the nearest point
//! of the boundary.

use super::{Batch, Located, barycentric};
use crate::base::error::Result;
use crate::locate::Output;

/// The locations of queries, row by row.
#[derive(Debug)]
pub struct Coordinates {
    /// The first tetrahedron that contains the query, or -1.
    pub simplex: Vec<i32>,
    /// The weights of its corners, four per row; NaN outside.
    pub weights: Vec<f64>,
    /// For a query outside: the tetrahedron at the nearest boundary face; else -1.
    pub beside: Vec<i32>,
    /// The corners of that face, three per row, counterclockwise seen from outside; else -1.
    pub face: Vec<i32>,
    /// Their weights in the nearest point; else NaN.
    pub shares: Vec<f64>,
}

/// The locations of queries that are inside.
#[derive(Debug)]
pub struct Within {
    /// The first tetrahedron that contains the query, or -1.
    pub simplex: Vec<i32>,
    /// The weights of its corners, four per row; NaN outside.
    pub weights: Vec<f64>,
}

/// Locates queries; returns nothing more for those that are outside.
pub fn within(batch: &Batch) -> Result<Within> {
    let n = batch.queries.len();
    let given = &batch.locator.given;
    let simplex = Output::filled(n, -1, batch.watch)?;
    let weights = Output::filled(4 * n, f64::NAN, batch.watch)?;
    batch.each(
        || (),
        |(), row, q, at| {
            if let Located::Inside(place) = at {
                simplex.set(row, place.simplex as i32);
                weights.set_all(4 * row, &barycentric(given, &place, q));
            }
            Ok(())
        },
    )?;
    Ok(Within {
        simplex: simplex.into_vec(),
        weights: weights.into_vec(),
    })
}

/// Locates queries; those that are not finite have no location.
pub fn coordinates(batch: &Batch) -> Result<Coordinates> {
    let n = batch.queries.len();
    let locator = &batch.locator;
    let given = &locator.given;
    let simplex = Output::filled(n, -1, batch.watch)?;
    let weights = Output::filled(4 * n, f64::NAN, batch.watch)?;
    let beside = Output::filled(n, -1, batch.watch)?;
    let face = Output::filled(3 * n, -1, batch.watch)?;
    let shares = Output::filled(3 * n, f64::NAN, batch.watch)?;
    batch.each(
        || None,
        |last, row, q, at| {
            if let Located::Inside(place) = at {
                simplex.set(row, place.simplex as i32);
                weights.set_all(4 * row, &barycentric(given, &place, q));
            } else if let Some((side, share)) =
                locator.boundary()?.nearest(given, q, last, locator.watch)?
            {
                beside.set(row, side.simplex as i32);
                face.set_all(3 * row, &given.face(side));
                shares.set_all(3 * row, &share);
            }
            Ok(())
        },
    )?;
    Ok(Coordinates {
        simplex: simplex.into_vec(),
        weights: weights.into_vec(),
        beside: beside.into_vec(),
        face: face.into_vec(),
        shares: shares.into_vec(),
    })
}
