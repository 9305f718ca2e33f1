//! Clough-Tocher interpolation: cubics on triangles split in three, with a continuous gradient.
//!
//! The scheme of R. W. Clough and J. L. Tocher (1965) in the reduced form that SciPy has: values
//! and gradients at the vertices are given, and across each edge the derivative in one direction is
//! linear. That direction is the line between the centroids of the two triangles, as P. Alfeld ("A
//! trivariate Clough-Tocher scheme for tetrahedral data", 1984) and G. Farin ("A modified
//! Clough-Tocher interpolant", 1985) propose: it is the same from both sides, and affine maps
//! preserve it. At the boundary it is the median.
//!
//! A cubic is represented by its Bezier ordinates. With the corners i, j, k and the centroid c,
//! `iij` is the ordinate a third of the way from i to j.

use delone_predicates::Point2;

use super::Order;
use super::cavity::{Barrier, is_closed};
use super::field::Field;
use super::number::{Jet, Number};
use crate::base::arrays::{Side, Triangles};
use crate::base::error::Result;
use crate::locate::{Batch, Located, Output, Place, barycentric, cross, next, prev, seen_from};

/// The part of a triangle's cubics that is independent of values and gradients.
#[derive(Debug, Clone, Copy)]
struct Frame {
    /// For each corner the vectors to the next and to the previous one.
    edges: [[Point2; 2]; 3],
    /// For the edge opposite each corner k, the direction across: this multiple of the vector from
    /// j to i, plus the vector from the middle of the edge to the centroid.
    across: [f64; 3],
}

/// The largest multiple of the edge in a direction across. If an edge is far shorter than the
/// triangles beside it, the rounding of the values at its ends would be amplified as many times;
/// and the cubic along it differs from its chord only by a multiple of its length cubed.
const OBLIQUE: f64 = 1e5;

impl Frame {
    fn of(given: &Triangles, barrier: Barrier, triangle: usize) -> Self {
        let corners = given.corners(triangle);
        let way = |from: usize, to: usize| [0, 1].map(|k| corners[to][k] - corners[from][k]);
        let across = |k| {
            let side = Side {
                simplex: triangle,
                corner: k,
            };
            let beyond = given.beyond(side).filter(|_| !is_closed(barrier, side));
            // The opposite apex in coordinates of this triangle; at the boundary the edge's
            // midpoint.
            let [xi, xj, xk] = match beyond {
                Some(there) => {
                    let x = coordinates(corners, given.at(there));
                    [x[next(k)], x[prev(k)], x[k]]
                }
                None => [0.5, 0.5, 0.0],
            };
            // The vector from corner k to it is three times that between the centroids.
            let share = (xi - xj) / (6.0 * (xk - 1.0));
            share.clamp(-OBLIQUE, OBLIQUE)
        };
        Self {
            edges: std::array::from_fn(|k| [way(k, next(k)), way(k, prev(k))]),
            across: std::array::from_fn(across),
        }
    }
}

/// Barycentric coordinates of any point, inside or outside.
fn coordinates(corners: [Point2; 3], x: Point2) -> [f64; 3] {
    let (seen, unit) = seen_from(x, corners);
    let areas: [f64; 3] = std::array::from_fn(|k| {
        let (i, j) = (next(k), prev(k));
        if unit == 1.0 {
            cross(x, corners[i], corners[j], seen[i], seen[j])
        } else {
            cross([0.0; 2], seen[i], seen[j], seen[i], seen[j])
        }
    });
    let sum = areas[0] + areas[1] + areas[2];
    let found = areas.map(|a| a / sum);
    if found.iter().all(|x| x.is_finite()) {
        found
    } else {
        [0.5, 0.5, 0.0]
    }
}

/// The ordinates of the three cubics on a triangle, by corner.
#[derive(Debug, Clone, Copy)]
struct Ordinates {
    /// iii
    at: [f64; 3],
    /// iij with j the next corner, and with the previous one.
    along: [[f64; 2]; 3],
    /// iic
    inner: [f64; 3],
    /// ijc, by the corner opposite.
    middle: [f64; 3],
    /// icc
    deep: [f64; 3],
    /// ccc
    center: f64,
}

impl Ordinates {
    fn of(frame: &Frame, values: [f64; 3], gradients: [[f64; 2]; 3]) -> Self {
        let along: [[f64; 2]; 3] = std::array::from_fn(|i| {
            let [gx, gy] = gradients[i];
            frame.edges[i].map(|way| values[i] + (gx * way[0] + gy * way[1]) / 3.0)
        });
        let inner: [f64; 3] =
            std::array::from_fn(|i| (values[i] + along[i][0] + along[i][1]) / 3.0);
        let middle: [f64; 3] = std::array::from_fn(|k| {
            // The derivative across the edge is a parabola along it; its middle ordinate is set to
            // the mean of the outer two. The share of the edge in it multiplies the difference of
            // the end slopes from the chord, in which only values cancel.
            let (i, j) = (next(k), prev(k));
            let [gx, gy] = [0, 1].map(|l| gradients[i][l] + gradients[j][l]);
            let (from_i, from_j) = (frame.edges[i][1], frame.edges[j][0]);
            let up = gx * (from_i[0] + from_j[0]) + gy * (from_i[1] + from_j[1]);
            let edge = frame.edges[j][1];
            let along_edge = 0.5 * (gx * edge[0] + gy * edge[1]);
            let bend = along_edge - (values[i] - values[j]);
            0.5 * (along[i][0] + along[j][1]) + up / 36.0 + frame.across[k] * bend
        });
        let deep: [f64; 3] =
            std::array::from_fn(|i| (inner[i] + middle[next(i)] + middle[prev(i)]) / 3.0);
        let center = (deep[0] + deep[1] + deep[2]) / 3.0;
        // All others enter the center; finite sums with it may still overflow.
        if !(3.0 * center).is_finite() && values.iter().all(|v| v.is_finite()) {
            return Self::linear(values);
        }
        Self {
            at: values,
            along,
            inner,
            middle,
            deep,
            center,
        }
    }

    /// The plane through the values, if doubles cannot represent a cubic.
    #[cold]
    fn linear(values: [f64; 3]) -> Self {
        let thirds = values.map(|v| v / 3.0);
        let center = thirds[0] + thirds[1] + thirds[2];
        let inner = thirds.map(|v| 2.0 * v + center / 3.0);
        Self {
            at: values,
            along: std::array::from_fn(|i| [next(i), prev(i)].map(|j| 2.0 * thirds[i] + thirds[j])),
            inner,
            middle: std::array::from_fn(|k| thirds[next(k)] + thirds[prev(k)] + center / 3.0),
            deep: thirds.map(|v| v + center / 1.5),
            center,
        }
    }

    /// The value at barycentric coordinates.
    #[inline]
    fn value<T: Number>(&self, b: [T; 3]) -> T {
        // The subtriangle is the one opposite the corner of least weight.
        let mut k = 0;
        for l in 1..3 {
            if b[l].value() < b[k].value() {
                k = l;
            }
        }
        let (i, j) = (next(k), prev(k));
        let three = T::constant(3.0);
        let (bi, bj, bc) = (b[i] - b[k], b[j] - b[k], three * b[k]);
        let by = |x: f64| T::constant(x);
        let edge = by(self.at[i]) * bi * bi * bi
            + three * bi * bj * (by(self.along[i][0]) * bi + by(self.along[j][1]) * bj)
            + by(self.at[j]) * bj * bj * bj;
        let first = by(self.inner[i]) * bi * bi
            + by(2.0 * self.middle[k]) * bi * bj
            + by(self.inner[j]) * bj * bj;
        let second = by(self.deep[i]) * bi + by(self.deep[j]) * bj;
        edge + bc * (three * first + bc * (three * second + by(self.center) * bc))
    }
}

/// The cubics of the last triangle: nearby queries share it.
#[derive(Default)]
struct Last {
    triangle: Option<usize>,
    columns: Vec<Ordinates>,
}

impl Last {
    fn visit(&mut self, given: &Triangles, barrier: Barrier, field: &Field, triangle: usize) {
        if self.triangle == Some(triangle) {
            return;
        }
        let frame = Frame::of(given, barrier, triangle);
        let vertices = given.simplices[triangle];
        self.triangle = Some(triangle);
        self.columns.clear();
        self.columns.extend((0..field.columns).map(|column| {
            let values = vertices.map(|v| field.value(v, column));
            let gradients = vertices.map(|v| field.gradient(v, column));
            Ordinates::of(&frame, values, gradients)
        }));
    }
}

/// Barycentric coordinates as functions of position.
fn jets(given: &Triangles, triangle: usize, b: [f64; 3]) -> [Jet; 3] {
    let corners = given.corners(triangle);
    let ([u, v], unit) = seen_from(corners[0], [corners[1], corners[2]]);
    let area = if unit == 1.0 {
        cross(corners[0], corners[1], corners[2], u, v)
    } else {
        cross([0.0; 2], u, v, u, v)
    };
    let seen = [[0.0; 2], u, v];
    std::array::from_fn(|k| {
        let (i, j) = (seen[next(k)], seen[prev(k)]);
        let gradient = [(i[1] - j[1]) / area / unit, (j[0] - i[0]) / area / unit];
        Jet::linear(b[k], gradient)
    })
}

/// Values, gradients or Hessians at the queries, one row each; NaN outside.
pub fn clough_tocher(
    batch: &Batch,
    field: Field,
    barrier: Barrier,
    order: Order,
) -> Result<Vec<f64>> {
    let given = &batch.locator.given;
    let width = field.columns * order.components();
    let out = Output::filled(batch.queries.len() * width, f64::NAN, batch.watch)?;
    let state = Last::default;
    batch.each(state, |last, row, q, at| {
        let Located::Inside(place) = at else {
            return Ok(());
        };
        let triangle = place.simplex;
        if order == Order::Value
            && let Some(corner) = place.site()
        {
            let values = field.row(given.simplices[triangle][corner]);
            out.set_all(row * width, values);
            return Ok(());
        }
        last.visit(given, barrier, &field, triangle);
        let b = barycentric(given, &place, q);
        if order == Order::Value {
            for (column, ordinates) in last.columns.iter().enumerate() {
                out.set(row * width + column, ordinates.value(b));
            }
            return Ok(());
        }
        let b = jets(given, triangle, b);
        for (column, ordinates) in last.columns.iter().enumerate() {
            let found = ordinates.value(b);
            match order {
                Order::Hessian => out.set_all(row * width + 3 * column, &found.hessian),
                _ => out.set_all(row * width + 2 * column, &found.gradient),
            }
        }
        Ok(())
    })?;
    Ok(out.into_vec())
}

/// Weights of the values and gradients at the corners of a triangle, row by row.
#[derive(Debug)]
pub struct CornerWeights {
    /// The triangle, or -1.
    pub triangle: Vec<i32>,
    /// Three per row; NaN outside.
    pub weights: Vec<f64>,
    /// Three pairs per row; NaN outside.
    pub slopes: Vec<f64>,
}

/// The weights that [`clough_tocher`] gives to values and gradients.
pub fn clough_tocher_weights(batch: &Batch, barrier: Barrier) -> Result<CornerWeights> {
    let given = &batch.locator.given;
    let n = batch.queries.len();
    let triangle = Output::filled(n, -1, batch.watch)?;
    let weights = Output::filled(3 * n, f64::NAN, batch.watch)?;
    let slopes = Output::filled(6 * n, f64::NAN, batch.watch)?;
    batch.each(
        || None,
        |last, row, q, at| {
            if let Located::Inside(place) = at {
                let (w, s) = basis(given, barrier, last, &place, q);
                triangle.set(row, place.simplex as i32);
                weights.set_all(3 * row, &w);
                slopes.set_all(6 * row, s.as_flattened());
            }
            Ok(())
        },
    )?;
    Ok(CornerWeights {
        triangle: triangle.into_vec(),
        weights: weights.into_vec(),
        slopes: slopes.into_vec(),
    })
}

/// Values of the nine basis functions, each with one value or derivative 1 and all others 0.
fn basis(
    given: &Triangles,
    barrier: Barrier,
    last: &mut Option<(usize, [Ordinates; 9])>,
    place: &Place,
    q: Point2,
) -> ([f64; 3], [[f64; 2]; 3]) {
    if let Some(corner) = place.site() {
        let weights = std::array::from_fn(|k| f64::from(u8::from(k == corner)));
        return (weights, [[0.0; 2]; 3]);
    }
    let functions = match last {
        Some((triangle, functions)) if *triangle == place.simplex => functions,
        _ => {
            let frame = Frame::of(given, barrier, place.simplex);
            let functions = std::array::from_fn(|f| {
                let unit = |g| f64::from(u8::from(f == g));
                let values = std::array::from_fn(&unit);
                let gradients = std::array::from_fn(|k| [unit(3 + 2 * k), unit(4 + 2 * k)]);
                Ordinates::of(&frame, values, gradients)
            });
            &mut last.insert((place.simplex, functions)).1
        }
    };
    let b = barycentric(given, place, q);
    let found = functions.map(|f| f.value(b));
    let slopes = std::array::from_fn(|k| [found[3 + 2 * k], found[4 + 2 * k]]);
    ([found[0], found[1], found[2]], slopes)
}
