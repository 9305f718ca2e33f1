//! Locates queries with barycentric coordinates; outside, with the nearest point of the boundary.

use super::{Batch, Located, Output, barycentric};
use crate::base::error::Result;

/// The locations of queries, row by row.
#[derive(Debug)]
pub struct Coordinates {
    /// The first triangle that contains the query, or -1.
    pub triangle: Vec<i32>,
    /// The weights of its corners, three per row; NaN outside.
    pub weights: Vec<f64>,
    /// For a query outside: the triangle at the nearest boundary edge; else -1.
    pub beside: Vec<i32>,
    /// The ends of that edge, two per row, with the triangle on its left; else -1.
    pub edge: Vec<i32>,
    /// How far along that edge the nearest point is, from 0 to 1; else NaN.
    pub along: Vec<f64>,
}

/// Locates queries; those that are not finite have no location.
pub fn coordinates(batch: &Batch) -> Result<Coordinates> {
    let n = batch.queries.len();
    let locator = &batch.locator;
    let given = &locator.given;
    let triangle = Output::filled(n, -1, batch.watch)?;
    let weights = Output::filled(3 * n, f64::NAN, batch.watch)?;
    let beside = Output::filled(n, -1, batch.watch)?;
    let edge = Output::filled(2 * n, -1, batch.watch)?;
    let along = Output::filled(n, f64::NAN, batch.watch)?;
    batch.each(
        || (),
        |(), row, q, at| {
            if let Located::Inside(place) = at {
                triangle.set(row, place.simplex as i32);
                weights.set_all(3 * row, &barycentric(given, &place, q));
            } else if let Located::Outside(Some(from)) = at {
                let (side, t) = locator.boundary()?.nearest(given, from, q);
                beside.set(row, side.simplex as i32);
                edge.set_all(2 * row, &given.ends(side).map(|end| given.vertex(end)));
                along.set(row, t);
            }
            Ok(())
        },
    )?;
    Ok(Coordinates {
        triangle: triangle.into_vec(),
        weights: weights.into_vec(),
        beside: beside.into_vec(),
        edge: edge.into_vec(),
        along: along.into_vec(),
    })
}
