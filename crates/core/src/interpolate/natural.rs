//! Natural neighbor interpolation of batches: weights as rows of a sparse matrix, or values.

use delone_predicates::Point2;

use super::Order;
use super::cavity::{Barrier, Cavity};
use super::field::Field;
use super::kind::Kind;
use super::number::{Jet, Number};
use super::rows::{Part, Rows};
use super::weights::Weights;
use crate::base::arrays::{Side, Triangles};
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::locate::{Batch, Located, Output, Place, barycentric};

/// Triangles of cavities between two checks for interruption, besides those before each lot of
/// queries: a query may have very many neighbors.
const WATCH_EVERY: usize = 1 << 14;

fn pace<'a>(batch: &Batch<'a>) -> Pace<'a> {
    Pace::new(batch.watch, WATCH_EVERY)
}

/// Buffers of a thread.
#[derive(Default)]
struct Room<T> {
    cavity: Cavity,
    weights: Weights<T>,
}

impl<T: Number> Room<T> {
    /// The weights of `q`, which is not at a vertex.
    #[inline]
    fn compute(
        &mut self,
        kind: Kind,
        given: &Triangles,
        barrier: Barrier,
        place: &Place,
        q: Point2,
        pace: &mut Pace,
    ) -> Result<()> {
        let edge = place.edge();
        self.cavity
            .find(given, barrier, place.simplex, edge, q, pace)?;
        if !self.weights.compute(kind, &self.cavity, q, pace)? {
            let corners = barycentric(given, place, q);
            let slots = self.cavity.points.len();
            self.weights.fall_back(kind, corners, slots);
        }
        Ok(())
    }
}

/// The weights of each query: sparse rows, empty outside.
pub fn natural(batch: &Batch, kind: Kind, barrier: Barrier) -> Result<(Rows, Vec<i32>)> {
    let given = &batch.locator.given;
    let triangles = Output::filled(batch.queries.len(), -1, batch.watch)?;
    let state = || {
        let part = Part::with_slopes(kind.is_smooth());
        (Room::<f64>::default(), part, pace(batch))
    };
    let parts = batch.each(state, |state, row, q, at| {
        let (room, part, pace) = state;
        let Located::Inside(place) = at else {
            return Ok(());
        };
        triangles.set(row, place.simplex as i32);
        if let Some(corner) = place.site() {
            let simplex = place.simplex;
            part.entry(given.vertex(Side { simplex, corner }), 1.0, [0.0; 2]);
        } else {
            room.compute(kind, given, barrier, &place, q, pace)?;
            for (slot, &vertex) in room.cavity.vertices.iter().enumerate() {
                let slope = room.weights.slopes.get(slot).copied().unwrap_or_default();
                part.entry(vertex, room.weights.values[slot], slope);
            }
        }
        part.close(row);
        Ok(())
    })?;
    let parts: Vec<Part> = parts.into_iter().map(|(_, part, _)| part).collect();
    let count = batch.queries.len();
    let rows = Rows::of_parts(count, &parts, kind.is_smooth(), batch.workers, batch.watch)?;
    Ok((rows, triangles.into_vec()))
}

/// Values, gradients or Hessians at the queries, one row each; NaN outside.
pub fn natural_values(
    batch: &Batch,
    kind: Kind,
    field: Field,
    barrier: Barrier,
    order: Order,
) -> Result<Vec<f64>> {
    let width = field.columns * order.components();
    let out = Output::filled(batch.queries.len() * width, f64::NAN, batch.watch)?;
    if order == Order::Value {
        sums(batch, kind, &field, barrier, &out)?;
    } else {
        slopes(batch, kind, &field, barrier, order, &out)?;
    }
    Ok(out.into_vec())
}

fn sums(
    batch: &Batch,
    kind: Kind,
    field: &Field,
    barrier: Barrier,
    out: &Output<f64>,
) -> Result<()> {
    let given = &batch.locator.given;
    let width = field.columns;
    let state = || (Room::<f64>::default(), pace(batch));
    batch.each(state, |(room, pace), row, q, at| {
        let Located::Inside(place) = at else {
            return Ok(());
        };
        if let Some(corner) = place.site() {
            let vertex = given.simplices[place.simplex][corner];
            out.set_all(row * width, field.row(vertex));
            return Ok(());
        }
        room.compute(kind, given, barrier, &place, q, pace)?;
        for column in 0..width {
            out.set(row * width + column, value(room, field, column));
        }
        Ok(())
    })?;
    Ok(())
}

fn slopes(
    batch: &Batch,
    kind: Kind,
    field: &Field,
    barrier: Barrier,
    order: Order,
    out: &Output<f64>,
) -> Result<()> {
    let given = &batch.locator.given;
    let components = order.components();
    let start = |row, column| components * (row * field.columns + column);
    let state = || (Room::<Jet>::default(), pace(batch));
    batch.each(state, |(room, pace), row, q, at| {
        let Located::Inside(place) = at else {
            return Ok(());
        };
        if let Some(corner) = place.site() {
            if order == Order::Gradient && kind.is_smooth() {
                let vertex = given.simplices[place.simplex][corner];
                for column in 0..field.columns {
                    out.set_all(start(row, column), &field.gradient(vertex, column));
                }
            }
            return Ok(());
        }
        room.compute(kind, given, barrier, &place, q, pace)?;
        for column in 0..field.columns {
            let sum = derivatives(room, field, column);
            match order {
                Order::Hessian => out.set_all(start(row, column), &sum.hessian),
                _ => out.set_all(start(row, column), &sum.gradient),
            }
        }
        Ok(())
    })?;
    Ok(())
}

/// The sum of weights times values and gradients.
#[inline]
fn value(room: &Room<f64>, field: &Field, column: usize) -> f64 {
    let Room { cavity, weights } = room;
    let mut sum = 0.0;
    for (&vertex, &w) in cavity.vertices.iter().zip(&weights.values) {
        if w != 0.0 {
            sum += w * field.value(vertex, column);
        }
    }
    for (&vertex, s) in cavity.vertices.iter().zip(&weights.slopes) {
        if *s != [0.0; 2] {
            let g = field.gradient(vertex, column);
            sum += s[0] * g[0] + s[1] * g[1];
        }
    }
    sum
}

/// The same with derivatives. Values are taken relative to the first, as the derivatives of the
/// weights sum to zero.
fn derivatives(room: &Room<Jet>, field: &Field, column: usize) -> Jet {
    let Room { cavity, weights } = room;
    let base = field.value(cavity.vertices[0], column);
    let mut sum = Jet::constant(0.0);
    for (slot, (&vertex, &w)) in cavity.vertices.iter().zip(&weights.values).enumerate() {
        sum = sum + w * Jet::constant(field.value(vertex, column) - base);
        if let Some(s) = weights.slopes.get(slot) {
            let g = field.gradient(vertex, column);
            sum = sum + s[0] * Jet::constant(g[0]) + s[1] * Jet::constant(g[1]);
        }
    }
    sum
}
