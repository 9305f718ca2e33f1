//! The first simplex of dual points: far apart by rounded numbers, independent by integers.

use num_bigint::BigInt;

use super::normal::turn;
use super::sites::Sites;
use crate::base::error::Result;
use crate::base::memory::copied;
use crate::base::watch::Pace;

/// D + 1 half-spaces with independent vectors and the sign of their determinant, or fewer that
/// span the vectors of all.
pub type First<const V: usize> = std::result::Result<([u32; V], i32), Vec<u32>>;

/// Chooses the first simplex of scaled dual points.
pub fn first<const D: usize, const V: usize, const P: usize>(
    sites: &Sites<'_, D, V, P>,
    scaled: &[[f64; D]],
    pace: &mut Pace,
) -> Result<First<V>> {
    let chosen: [u32; V] = spread::<D, V>(scaled, pace)?;
    let sign = turn(chosen.map(|v| sites.integers(v)));
    if sign != 0 {
        return Ok(Ok((chosen, sign)));
    }
    let found = independent(sites, pace)?;
    Ok(match <[u32; V]>::try_from(found.as_slice()) {
        Ok(chosen) => Ok((chosen, turn(chosen.map(|v| sites.integers(v))))),
        Err(_) => Err(found),
    })
}

/// The center of the first simplex, rounded.
pub fn middle<const D: usize, const V: usize>(scaled: &[[f64; D]], corners: &[u32; V]) -> [f64; D] {
    std::array::from_fn(|k| {
        corners
            .iter()
            .map(|&v| scaled[v as usize][k] / V as f64)
            .sum()
    })
}

/// Points, each far from the flat that the previous ones span; some are equal if all are in a flat.
fn spread<const D: usize, const V: usize>(
    scaled: &[[f64; D]],
    pace: &mut Pace,
) -> Result<[u32; V]> {
    let mut rest = copied(scaled)?;
    let square = |p: &[f64; D]| p.iter().map(|x| x * x).sum::<f64>();
    let mut chosen = [0; V];
    for i in 0..V {
        pace.spend(scaled.len())?;
        let (mut most, mut far) = (-1.0, 0);
        for (row, p) in (0u32..).zip(&rest) {
            let size = square(p);
            if size > most {
                (most, far) = (size, row);
            }
        }
        chosen[i] = far;
        let pivot = rest[far as usize];
        // The first point becomes the origin; from then on, directions are projected out.
        let unit = if i == 0 { 0.0 } else { 1.0 / most };
        for p in &mut rest {
            let along = if i == 0 {
                1.0
            } else {
                unit * (0..D).map(|k| p[k] * pivot[k]).sum::<f64>()
            };
            for k in 0..D {
                p[k] -= along * pivot[k];
            }
        }
    }
    Ok(chosen)
}

/// The first half-spaces whose vectors are independent, up to D + 1, by fraction-free elimination.
fn independent<const D: usize, const V: usize, const P: usize>(
    sites: &Sites<'_, D, V, P>,
    pace: &mut Pace,
) -> Result<Vec<u32>> {
    let (mut kept, mut rows) = (Vec::new(), Vec::<(usize, [BigInt; V])>::new());
    for w in 0..sites.len() {
        pace.spend(16)?;
        let mut row = sites.integers(w);
        let mut previous = BigInt::from(1);
        for (pivot, of_pivot) in &rows {
            let factor = row[*pivot].clone();
            for k in 0..V {
                // The division has no remainder: the result is a minor.
                row[k] = (&of_pivot[*pivot] * &row[k] - &factor * &of_pivot[k]) / &previous;
            }
            previous = of_pivot[*pivot].clone();
        }
        if let Some(pivot) = row.iter().position(|x| *x != BigInt::ZERO) {
            rows.push((pivot, row));
            kept.push(w);
            if kept.len() == V {
                break;
            }
        }
    }
    Ok(kept)
}
