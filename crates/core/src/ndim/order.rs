//! The order of insertion: the Hilbert curve in D dimensions, in rounds of growing density.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::order::hilbert_n::key;

/// Every 64th point of the curve, then every 8th of the others, then the rest: early points spread
/// over the set, so that cavities stay small, and each round follows the curve, so that walks stay
/// short.
const STRIDES: [usize; 3] = [64, 8, 1];

/// Numbers of the points in the order of insertion.
pub fn arranged<const D: usize, const P: usize>(points: &[[f64; P]]) -> Result<Vec<u32>> {
    let n = points.len();
    let mut curve = with_room(n)?;
    curve.extend(keys::<D, P>(points)?.into_iter().zip(0u32..));
    curve.sort_unstable();
    let mut order = with_room(n)?;
    let mut used = filled(n, false)?;
    for stride in STRIDES {
        for i in (0..n).step_by(stride) {
            if !used[i] {
                used[i] = true;
                order.push(curve[i].1);
            }
        }
    }
    Ok(order)
}

/// Keys on the curve, of up to 16 bits for each coordinate. They only define an order, so roundings
/// are harmless.
fn keys<const D: usize, const P: usize>(points: &[[f64; P]]) -> Result<Vec<u64>> {
    let bits = (64 / D).min(16);
    let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    for p in points {
        for k in 0..D {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
    }
    let side = (0..D).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let cells = ((1u64 << bits) - 1) as f64;
    let mut keys = with_room(points.len())?;
    keys.extend(points.iter().map(|p| {
        // A conversion of NaN is 0.
        let cell: [u32; D] = std::array::from_fn(|k| ((p[k] - low[k]) / side * cells) as u32);
        key(cell, bits as u32)
    }));
    Ok(keys)
}
