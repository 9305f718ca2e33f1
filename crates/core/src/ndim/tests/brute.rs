//! The triangulation by its definition: all sets of D + 1 points whose perturbed sphere is empty, by
//! determinants of integers and the cofactors of the infinitesimals.

use std::collections::BTreeSet;

use num_bigint::BigInt;

use crate::base::wide::{lowest, scaled};

/// Points as integers.
pub fn integers<const D: usize>(points: &[[f64; D]]) -> Vec<Vec<BigInt>> {
    let low = lowest(points, &[]);
    points
        .iter()
        .map(|p| p.iter().map(|&x| scaled(x, low)).collect())
        .collect()
}

/// Distinct points as integers, in lexicographic order.
pub fn distinct<const D: usize>(points: &[[f64; D]]) -> Vec<Vec<BigInt>> {
    let all: BTreeSet<_> = integers(points).into_iter().collect();
    all.into_iter().collect()
}

/// The sign of a determinant (Bareiss).
fn sign(mut m: Vec<Vec<BigInt>>) -> i32 {
    let (n, zero) = (m.len(), BigInt::ZERO);
    let (mut previous, mut odd) = (BigInt::from(1), false);
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&i| m[i][k] != zero) else {
            return 0;
        };
        if pivot != k {
            m.swap(k, pivot);
            odd = !odd;
        }
        for i in k + 1..n {
            for j in k + 1..n {
                m[i][j] = (&m[k][k] * &m[i][j] - &m[i][k] * &m[k][j]) / &previous;
            }
        }
        previous = m[k][k].clone();
    }
    let sign = previous.cmp(&zero) as i32;
    if odd { -sign } else { sign }
}

/// The sign of the determinant of the rows (1, p).
fn with_ones<'a>(points: impl Iterator<Item = &'a Vec<BigInt>>) -> i32 {
    let one = BigInt::from(1);
    sign(
        points
            .map(|p| [std::slice::from_ref(&one), p].concat())
            .collect(),
    )
}

/// The orientation of a simplex: positive if the differences from its first point have a positive
/// determinant.
pub fn orientation(at: &[Vec<BigInt>], v: &[u32]) -> i32 {
    with_ones(v.iter().map(|&i| &at[i as usize]))
}

/// The dimension of the flat that points span.
pub fn rank<const D: usize>(points: &[[f64; D]]) -> usize {
    let at = integers(points);
    let mut rows: Vec<(usize, Vec<BigInt>)> = Vec::new();
    for p in &at {
        let mut row: Vec<BigInt> = p.iter().zip(&at[0]).map(|(x, o)| x - o).collect();
        for (pivot, other) in &rows {
            let factor = row[*pivot].clone();
            for k in 0..D {
                row[k] = &row[k] * &other[*pivot] - &factor * &other[k];
            }
        }
        if let Some(pivot) = row.iter().position(|x| *x != BigInt::ZERO) {
            rows.push((pivot, row));
        }
    }
    rows.len()
}

/// The simplices as ascending numbers of the distinct points in lexicographic order.
pub fn canonical<const D: usize, const V: usize>(points: &[[f64; D]]) -> BTreeSet<[u32; V]> {
    let at = distinct(points);
    let weights = vec![BigInt::ZERO; at.len()];
    regular(&at, &weights)
}

/// The simplices of the regular triangulation of distinct points in lexicographic order, with weights.
pub fn regular<const V: usize>(at: &[Vec<BigInt>], weights: &[BigInt]) -> BTreeSet<[u32; V]> {
    let n = at.len() as u32;
    let mut found = BTreeSet::new();
    let mut subset: [u32; V] = std::array::from_fn(|i| i as u32);
    if (n as usize) < V {
        return found;
    }
    loop {
        let positive = orientation(at, &subset);
        let empty = |q: u32| subset.contains(&q) || is_above(at, weights, &subset, positive, q);
        if positive != 0 && (0..n).all(empty) {
            found.insert(subset);
        }
        // The next subset.
        let Some(i) = (0..V).rev().find(|&i| subset[i] + ((V - i) as u32) < n) else {
            return found;
        };
        subset[i] += 1;
        for j in i + 1..V {
            subset[j] = subset[j - 1] + 1;
        }
    }
}

/// Whether the perturbed height of a point is above the plane through those of a simplex.
fn is_above(
    at: &[Vec<BigInt>],
    weights: &[BigInt],
    simplex: &[u32],
    positive: i32,
    q: u32,
) -> bool {
    let all = [simplex, &[q]].concat();
    let lifted = |i: &u32| {
        let p = &at[*i as usize];
        let square: BigInt = p.iter().map(|x| x * x).sum();
        let height = square - &weights[*i as usize];
        [&[BigInt::from(1)], &p[..], &[height]].concat()
    };
    // As a function of the height of q, the determinant has the slope `positive`.
    let mut value = sign(all.iter().map(lifted).collect()) * positive;
    // On a tie the largest infinitesimal with a cofactor decides; heights are lower by it.
    let mut by_size = all.clone();
    by_size.sort_unstable();
    for i in by_size {
        if value != 0 {
            break;
        }
        let row = all.iter().position(|&j| j == i).unwrap_or(0);
        let others = all.iter().filter(|&&j| j != i).map(|&j| &at[j as usize]);
        let cofactor = with_ones(others)
            * if (row + all.len() - 1) % 2 == 0 {
                1
            } else {
                -1
            };
        value = -cofactor * positive;
    }
    value > 0
}
