//! Point location in four to eight dimensions: exact, boundary included, for Delaunay triangulations.
//!
//! Points are located by `locate`; this file has what is specific to these dimensions.
//! Triangulations fill the convex hull of their points, so a walk that leaves them proves a point
//! to be outside.

use delone_predicates::Sign;
use num_bigint::BigInt;

use super::dispatch;
use super::simplex;
use crate::base::arrays::{Given, Side};
use crate::base::error::Result;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::base::wide::{lowest, scaled};
use crate::locate::{self, Batch, Dimension, First, Located, Locator, Output, Place};

/// What is kept of simplices in `D` dimensions.
#[derive(Debug)]
pub struct Hyper<const D: usize> {
    /// The bounding box of all points: there is no simplex outside.
    extent: Extent<D>,
}

/// What differs between dimensions for the compiler: the length of padded rows.
pub trait Weighed<const D: usize, const N: usize>: Dimension<D, N> {
    /// The weights of the corners of a simplex at a point in it.
    fn weights(corners: &[[f64; D]; N], on: [bool; N], q: &[f64; D]) -> [f64; N];
}

macro_rules! dimensions {
    ($(($d:literal, $n:literal, $p:literal)),*) => {$(
        impl Dimension<$d, $n> for Hyper<$d> {
            type Boundary = ();

            /// Each step inverts a matrix.
            const REACH: f64 = 4.0;

            fn of(given: &Given<$d, $n>) -> Self {
                Self {
                    extent: Extent::of(given.points.iter().copied()),
                }
            }

            fn boundary(_: &Given<$d, $n>, _: &Watch) -> Result<()> {
                Ok(())
            }

            fn is_convex(_: &()) -> bool {
                true
            }

            fn sides(corners: [[f64; $d]; $n], q: [f64; $d]) -> [Sign; $n] {
                simplex::sides::<$d, $n, $p>(&corners, &q)
            }

            fn walk(given: &Given<$d, $n>, from: usize, q: [f64; $d]) -> Result<Located<$n>> {
                Ok(dispatch::walk::<$d, $n, $p>(given, from, &q))
            }

            fn first_around(given: &Given<$d, $n>, place: Place<$n>) -> First<$n> {
                locate::first_around(given, place)
            }

            fn is_outside(
                locator: &Locator<Self, $d, $n>,
                _: Option<Side>,
                q: [f64; $d],
            ) -> Result<bool> {
                let Extent { min, max } = locator.kept.own.extent;
                Ok((0..$d).any(|k| q[k] < min[k] || q[k] > max[k]))
            }
        }

        impl Weighed<$d, $n> for Hyper<$d> {
            fn weights(corners: &[[f64; $d]; $n], on: [bool; $n], q: &[f64; $d]) -> [f64; $n] {
                simplex::weights::<$d, $n, $p>(corners, on, q)
            }
        }
    )*};
}

dimensions!((4, 5, 4), (5, 6, 8), (6, 7, 8), (7, 8, 8), (8, 9, 8));

/// The locations of queries that are inside.
#[derive(Debug)]
pub struct Within {
    /// The first simplex that contains the query, or -1.
    pub simplex: Vec<i32>,
    /// The weights of its corners, `D + 1` per row; NaN outside.
    pub weights: Vec<f64>,
}

/// Locates queries with the weights of corners.
pub fn within<const D: usize, const N: usize>(batch: &Batch<Hyper<D>, D, N>) -> Result<Within>
where
    Hyper<D>: Weighed<D, N>,
{
    let n = batch.queries.len();
    let given = &batch.locator.given;
    let simplex = Output::filled(n, -1, batch.watch)?;
    let weights = Output::filled(N * n, f64::NAN, batch.watch)?;
    batch.each(
        || (),
        |(), row, q, at| {
            if let Located::Inside(place) = at {
                simplex.set(row, place.simplex as i32);
                let found = match place.site() {
                    Some(corner) => std::array::from_fn(|k| f64::from(k == corner)),
                    None => Hyper::weights(&given.corners(place.simplex), place.on, &q),
                };
                weights.set_all(N * row, &found);
            }
            Ok(())
        },
    )?;
    Ok(Within {
        simplex: simplex.into_vec(),
        weights: weights.into_vec(),
    })
}

/// For each query the nearest vertex, the first row of several; -1 if the query is not finite.
pub fn nearest<const D: usize, const N: usize>(batch: &Batch<Hyper<D>, D, N>) -> Result<Vec<i32>>
where
    Hyper<D>: Dimension<D, N>,
{
    let sites = batch.locator.sites()?;
    let found = Output::<i32>::filled(batch.queries.len(), -1, batch.watch)?;
    batch.along(
        || None,
        |last, row, q| {
            found.set(row, sites.nearest(q, last, nearer));
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}

/// Whether `a` is nearer to `q` than `b` is: positive if so.
///
/// A square of a rounded difference errs by less than 4 u of itself, and the sum of D such by D u more.
fn nearer<const D: usize>(q: [f64; D], a: [f64; D], b: [f64; D]) -> Sign {
    let square = |p: [f64; D]| -> f64 { (0..D).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum() };
    let (to_a, to_b) = (square(a), square(b));
    let bound = (D + 8) as f64 * f64::EPSILON * (to_a + to_b) + 1e-300;
    // A comparison that NaN fails; an infinite sum is not below its bound.
    if (to_b - to_a).abs() > bound && bound < f64::INFINITY {
        return if to_b > to_a {
            Sign::Positive
        } else {
            Sign::Negative
        };
    }
    let low = lowest(&[q, a, b], &[]);
    let exact = |p: [f64; D]| -> BigInt {
        let difference = |k: usize| scaled(p[k], low) - scaled(q[k], low);
        (0..D).map(|k| difference(k).pow(2)).sum()
    };
    match exact(b).cmp(&exact(a)) {
        std::cmp::Ordering::Greater => Sign::Positive,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Less => Sign::Negative,
    }
}
