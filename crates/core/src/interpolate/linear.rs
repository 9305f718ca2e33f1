//! Linear interpolation in each triangle.

use delone_predicates::Point2;

use super::Order;
use super::field::Field;
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::locate::{Batch, Located, Output, Place, barycentric, cross, seen_from};

/// Values, or gradients, at the queries, one row each; NaN outside.
pub fn linear(batch: &Batch, field: Field, order: Order) -> Result<Vec<f64>> {
    let given = &batch.locator.given;
    let width = field.columns * order.components();
    let out = Output::filled(batch.queries.len() * width, f64::NAN, batch.watch)?;
    batch.each(
        || (),
        |(), row, q, at| {
            if let Located::Inside(place) = at {
                match order {
                    Order::Value => {
                        value(given, &field, &place, q, |c, z| out.set(row * width + c, z))
                    }
                    Order::Gradient => {
                        for column in 0..field.columns {
                            let g = gradient(given, &field, place.simplex, column);
                            out.set_all(row * width + 2 * column, &g);
                        }
                    }
                    Order::Hessian => out.set_all(row * width, &vec![0.0; width]),
                }
            }
            Ok(())
        },
    )?;
    Ok(out.into_vec())
}

/// Vertices of zero weight are not read, so that a missing value there does not spread.
#[inline]
fn value(
    given: &Triangles,
    field: &Field,
    place: &Place,
    q: Point2,
    mut set: impl FnMut(usize, f64),
) {
    let vertices = given.simplices[place.simplex];
    if let Some(corner) = place.site() {
        for (column, &z) in field.row(vertices[corner]).iter().enumerate() {
            set(column, z);
        }
        return;
    }
    let weights = barycentric(given, place, q);
    let rows = vertices.map(|v| field.row(v));
    for column in 0..field.columns {
        let mut sum = 0.0;
        for (w, row) in weights.iter().zip(rows) {
            if *w != 0.0 {
                sum += w * row[column];
            }
        }
        set(column, sum);
    }
}

/// The slope of the plane over a triangle.
pub fn gradient(given: &Triangles, field: &Field, triangle: usize, column: usize) -> [f64; 2] {
    let [p, q, r] = given.corners(triangle);
    let ([a, b], unit) = seen_from(p, [q, r]);
    let area = if unit == 1.0 {
        cross(p, q, r, a, b)
    } else {
        cross([0.0; 2], a, b, a, b)
    };
    let [z, za, zb] = given.simplices[triangle].map(|v| field.value(v, column));
    let (da, db) = (za - z, zb - z);
    [
        (da * b[1] - db * a[1]) / area / unit,
        (db * a[0] - da * b[0]) / area / unit,
    ]
}
