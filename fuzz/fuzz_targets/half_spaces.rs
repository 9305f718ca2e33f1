//! Intersections of half-spaces, judged by integers: each corner is in all half-spaces, on the boundaries
//! that are listed for it, and the dual hull is closed.
//!
//! The corners must be the same for every order of the rows, and for rows times powers of two.

#![no_main]

use std::collections::BTreeMap;

use delone_core::base::watch::Watch;
use delone_core::ndim::halfspaces::{Corners, Trouble, intersect};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

/// More rows make a run slower; ties among few are harder.
const MOST: usize = 12;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    let _ = match bytes.int_in_range(0..=2) {
        Ok(0) => read(&mut bytes).map(|(rows, p)| check::<2, 3, 4>(&rows, p)),
        Ok(1) => read(&mut bytes).map(|(rows, p)| check::<3, 4, 4>(&rows, p)),
        _ => read(&mut bytes).map(|(rows, p)| check::<4, 5, 4>(&rows, p)),
    };
});

/// Half-spaces, most of which contain a point: with any coefficients, or with small integers.
fn read<const D: usize, const V: usize>(
    bytes: &mut Unstructured,
) -> Result<(Vec<[f64; V]>, [f64; D])> {
    let side = bytes.int_in_range(0..=3_i32)?;
    let count = bytes.int_in_range(1..=MOST)?;
    let mut coordinates = Coordinates::new(bytes)?;
    let point: [f64; D] = if bytes.arbitrary()? {
        [0.0; D]
    } else if side == 0 {
        coordinates.point(bytes)?
    } else {
        let mut point = [0.0; D];
        for x in &mut point {
            *x = f64::from(bytes.int_in_range(-side..=side)?);
        }
        point
    };
    let mut rows = Vec::new();
    for _ in 0..count {
        let mut row = [0.0; V];
        for x in &mut row {
            *x = if side == 0 {
                coordinates.next(bytes)?
            } else {
                f64::from(bytes.int_in_range(-side..=side)?)
            };
        }
        // The boundary beyond the point, up to rounding; some rows stay as they are.
        if bytes.int_in_range(0..=15)? > 0 {
            let across: f64 = (0..D).map(|k| row[k] * point[k]).sum();
            let beyond = -across - row[D].abs().max(f64::MIN_POSITIVE);
            row[D] = beyond.clamp(f64::MIN, f64::MAX);
        }
        rows.push(row);
    }
    Ok((rows, point))
}

/// Doubles as integers, times one power of two.
fn integers(row: &[f64]) -> Vec<BigInt> {
    let exponent = |x: f64| (x.to_bits() >> 52 & 0x7ff).max(1) as i64;
    let low = row.iter().map(|&x| exponent(x)).min().unwrap_or(1);
    let integer = |x: f64| {
        let implicit = u64::from(x.abs() >= f64::MIN_POSITIVE) << 52;
        let size = BigInt::from(x.to_bits() & ((1 << 52) - 1) | implicit) << (exponent(x) - low);
        if x < 0.0 { -size } else { size }
    };
    row.iter().map(|&x| integer(x)).collect()
}

fn dot(a: &[BigInt], b: &[BigInt]) -> BigInt {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Whether a half-space contains a point strictly.
fn is_inside<const D: usize, const V: usize>(row: &[f64; V], point: &[f64; D]) -> bool {
    let at = integers(&[&point[..], &[1.0]].concat());
    dot(&integers(row), &at).is_negative()
}

/// The columns that have pivots, and the rows by the elimination of Bareiss: the pivots are equal.
fn reduced(mut rows: Vec<Vec<BigInt>>) -> (Vec<usize>, Vec<Vec<BigInt>>) {
    let (mut pivots, mut previous) = (Vec::new(), BigInt::from(1));
    for k in 0..rows.first().map_or(0, Vec::len) {
        let at = pivots.len();
        let Some(i) = (at..rows.len()).find(|&i| !rows[i][k].is_zero()) else {
            continue;
        };
        rows.swap(at, i);
        let pivot = rows[at].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != at) {
            let factor = row[k].clone();
            for (x, y) in row.iter_mut().zip(&pivot) {
                // The division has no remainder: the result is a minor.
                *x = (&*x * &pivot[k] - &factor * y) / &previous;
            }
        }
        previous = pivot[k].clone();
        pivots.push(k);
    }
    (pivots, rows)
}

/// The vector that is perpendicular to D independent rows, but for a factor.
fn normal(rows: Vec<Vec<BigInt>>) -> Vec<BigInt> {
    let count = rows.len();
    let (pivots, rows) = reduced(rows);
    assert_eq!(pivots.len(), count, "a simplex is flat");
    let free = (0..=count).find(|k| !pivots.contains(k)).unwrap();
    let mut found = vec![rows[0][pivots[0]].clone(); count + 1];
    for (&k, row) in pivots.iter().zip(&rows) {
        found[k] = -&row[free];
    }
    found
}

/// Whether two vectors with the same signs have one direction.
fn are_parallel(a: &[BigInt], b: &[BigInt]) -> bool {
    let k = a.iter().position(|x| !x.is_zero()).unwrap();
    a[k].sign() == b[k].sign() && a.iter().zip(b).all(|(x, y)| x * &b[k] == y * &a[k])
}

/// The corners as vectors of homogeneous integers; each is checked.
fn corners<const D: usize, const V: usize>(
    rows: &[[f64; V]],
    found: &Corners<D, V>,
) -> Vec<Vec<BigInt>> {
    let all: Vec<Vec<BigInt>> = rows.iter().map(|row| integers(row)).collect();
    let mut ridges = BTreeMap::new();
    let mut corners: Vec<Option<Vec<BigInt>>> = vec![None; found.starts.len() - 1];
    for (simplex, &corner) in found.simplices.iter().zip(&found.corner) {
        let given = simplex.iter().map(|&v| all[v as usize].clone()).collect();
        let mut y = normal(given);
        if all.iter().any(|v| dot(v, &y).is_positive()) {
            y = y.iter().map(|x| -x).collect();
        }
        for v in &all {
            assert!(!dot(v, &y).is_positive(), "a row is outside: {rows:?}");
        }
        assert!(all.iter().any(|v| dot(v, &y).is_negative()), "{rows:?}");
        let ends = &found.starts[corner as usize..];
        for &v in &found.facets[ends[0] as usize..ends[1] as usize] {
            assert!(dot(&all[v as usize], &y).is_zero(), "{v}: {rows:?}");
        }
        let is_infinite = found.points[corner as usize][0].is_infinite();
        assert_eq!(is_infinite, !y[D].is_positive(), "{rows:?}");
        let known = corners[corner as usize].get_or_insert_with(|| y.clone());
        assert!(are_parallel(known, &y), "simplices of one corner: {rows:?}");
        for k in 0..D {
            let mut ridge = simplex.to_vec();
            ridge.remove(k);
            ridge.sort_unstable();
            *ridges.entry(ridge).or_insert(0) += 1;
        }
    }
    assert!(ridges.values().all(|&count| count == 2), "{rows:?}");
    let corners: Vec<_> = corners.into_iter().map(Option::unwrap).collect();
    for (i, y) in corners.iter().enumerate() {
        let is_new = corners[..i].iter().all(|other| !are_parallel(other, y));
        assert!(is_new, "a corner is there twice: {rows:?}");
    }
    corners
}

fn check<const D: usize, const V: usize, const P: usize>(rows: &[[f64; V]], point: [f64; D]) {
    let watch = Watch::idle();
    let outside = rows.iter().position(|row| !is_inside(row, &point));
    let found = match intersect::<D, V, P>(rows, point, &watch).unwrap() {
        Ok(found) => found,
        Err(Trouble::NotInside(row)) => {
            assert_eq!(outside, Some(row as usize), "{rows:?} {point:?}");
            return;
        }
        // The dual point overflows.
        Err(Trouble::TooClose(_)) => return,
        Err(Trouble::Flat(spanning)) => {
            let all = reduced(rows.iter().map(|row| integers(row)).collect())
                .0
                .len();
            let some = spanning.iter().map(|&v| integers(&rows[v as usize]));
            assert_eq!(reduced(some.collect()).0.len(), spanning.len(), "{rows:?}");
            assert!(all == spanning.len() && all < V, "{rows:?} {point:?}");
            return;
        }
    };
    assert_eq!(outside, None, "{rows:?} {point:?}");
    let expected = corners(rows, &found);
    // Rows in the other order, every other one times a power of two where that is exact.
    let times = |(i, row): (usize, &[f64; V])| {
        let factor = if i % 2 == 0 { 1.0 } else { 0.25 };
        let scaled = row.map(|x| x * factor);
        if scaled.map(|x| x / factor) == *row {
            scaled
        } else {
            *row
        }
    };
    let other: Vec<[f64; V]> = rows.iter().enumerate().rev().map(times).collect();
    if let Ok(again) = intersect::<D, V, P>(&other, point, &watch).unwrap() {
        let again = corners(&other, &again);
        assert_eq!(again.len(), expected.len(), "{rows:?} {point:?}");
        for y in &again {
            let is_known = expected.iter().any(|other| are_parallel(other, y));
            assert!(is_known, "{rows:?} {point:?}");
        }
    }
}
