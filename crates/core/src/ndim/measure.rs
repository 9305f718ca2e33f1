//! Measures of all simplices of a triangulation: volumes, circumcenters, affine maps, edges; and the
//! first fault of arrays of unknown origin.

use delone_predicates::Sign;

use super::simplex;
use crate::base::arrays::Given;
use crate::base::consistency::{self, Fault};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::measure::each;

/// The volumes, with a relative error below 1e-14; infinite, or subnormal and rounded, if out of range.
pub fn volumes<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; V]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<f64>> {
    let volume = |corners| simplex::volume::<D, V, P>(&corners);
    each(points, simplices, workers, watch, volume)
}

/// The circumcenters, each coordinate within 4 units in the last place; infinite if out of range.
pub fn circumcenters<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; V]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[f64; D]>> {
    let center = |corners| simplex::circumcenter::<D, V, P>(&corners);
    each(points, simplices, workers, watch, center)
}

/// The affine maps to barycentric coordinates. Rows have an error below 1e-13 of their length.
pub fn transforms<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; V]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[[f64; D]; V]>> {
    let transform = |corners| simplex::transform::<D, V, P>(&corners);
    each(points, simplices, workers, watch, transform)
}

/// The orientations of simplices: 1, 0 or -1, exactly.
pub fn orientations<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    simplices: &[[i32; V]],
    workers: usize,
    watch: &Watch,
) -> Result<Vec<i32>> {
    let sign = |corners| match simplex::orientation::<D, V, P>(&corners) {
        Sign::Negative => -1,
        Sign::Zero => 0,
        Sign::Positive => 1,
    };
    each(points, simplices, workers, watch, sign)
}

/// The first fault of simplices: neighbors that are not mutual, or an orientation that is not positive.
pub fn fault<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    workers: usize,
    watch: &Watch,
) -> Result<Option<Fault>> {
    consistency::first(given, workers, watch, |t| -> Sign {
        simplex::orientation::<D, V, P>(&given.corners(t))
    })
}
