//! The triangles along a segment between any two points.

use delone_predicates::{Point2, Sign, orient2d};

use super::straight::Trace;
use super::{Located, Locator, Place, Plane, is_finite};
use crate::base::arrays::Side;
use crate::base::error::{Error, Result};

/// The triangles that the segment from `a` to `b` meets in more than a point, in order; if `a`
/// equals `b`, the one that contains it. Of the two triangles beside an edge on the segment the
/// left one is reported, at the boundary the only one. Parts outside the convex hull are skipped.
pub fn along(locator: &Locator<Plane, 2, 3>, a: Point2, b: Point2) -> Result<Vec<i32>> {
    if !is_finite(&a) || !is_finite(&b) {
        return Err(Error::Shape(
            "the ends of the segment must be finite".into(),
        ));
    }
    if locator.given.simplices.is_empty() {
        return Ok(Vec::new());
    }
    if !locator.boundary()?.convex {
        return Err(Error::Shape(
            "a walk along a segment needs triangles that fill the convex hull".into(),
        ));
    }
    let given = &locator.given;
    let mut met = Vec::new();
    let place = |p| match locator.locate(p)? {
        Some(Located::Inside(place)) => Ok(Some(place)),
        _ => Ok(None),
    };
    let inside = |Place { simplex, on }, a, b| Trace::from_inside(given, simplex, on, a, b);
    match (place(a)?, place(b)?) {
        (Some(start), Some(_)) if a == b => met.push(start.simplex as i32),
        (Some(start), _) => {
            inside(start, a, b).run(|t| met.push(t as i32))?;
        }
        (None, Some(end)) => {
            inside(end, b, a)
                .right_handed()
                .run(|t| met.push(t as i32))?;
            met.reverse();
        }
        (None, None) => {
            if let Some(side) = entry(locator, a, b)? {
                Trace::from_outside(given, side, a, b).run(|t| met.push(t as i32))?;
            }
        }
    }
    Ok(met)
}

/// The boundary edge through which, or through an end of which, the segment between two points
/// outside enters the hull.
fn entry(locator: &Locator<Plane, 2, 3>, a: Point2, b: Point2) -> Result<Option<Side>> {
    let given = &locator.given;
    let enters = |side: &&Side| {
        let [u, v] = given.ends(**side).map(|end| given.at(end));
        // a is strictly outside the edge and b strictly inside; u is left of the line.
        orient2d(u, v, a) == Sign::Negative
            && orient2d(u, v, b) == Sign::Positive
            && orient2d(a, b, u) != Sign::Negative
            && orient2d(a, b, v) != Sign::Positive
    };
    Ok(locator.boundary()?.sides.iter().find(enters).copied())
}
