//! Triangulations and hulls in flats, compared with those of points that span the whole space.
//!
//! A coordinate 4 t with 3 t as another one measures as 5 t does. So the triangulation in the flat must
//! be that of points with 5 t alone: a different code, with the same order of points. Other flats, with
//! copies and multiples of coordinates, are judged by the validator of the core.

#![no_main]

use std::collections::BTreeSet;

use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::ndim::{
    Findings, Rest, hull, hull_in_flat, triangulate, triangulate_in_flat, validate_in_flat,
};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few are harder.
const MOST: usize = 14;

/// Products of this and small integers are finite.
const LARGE: f64 = 1e300;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    let _ = match bytes.int_in_range(0..=3) {
        Ok(0) => check::<2, 3, 4>(&mut bytes),
        Ok(1) => check::<3, 4, 4>(&mut bytes),
        Ok(2) => check::<4, 5, 4>(&mut bytes),
        _ => check::<5, 6, 8>(&mut bytes),
    };
});

/// A coordinate of which 5 times is a double.
fn short(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !7).clamp(-LARGE, LARGE)
}

/// Points of a lattice, or with any coordinates.
fn read<const D: usize>(bytes: &mut Unstructured) -> Result<Vec<[f64; D]>> {
    let count = bytes.int_in_range(1..=MOST)?;
    let side = bytes.int_in_range(0..=3_i32)?;
    let mut coordinates = Coordinates::new(bytes)?;
    let mut points = Vec::new();
    for _ in 0..count {
        let mut point = [0.0; D];
        for x in &mut point {
            *x = if side == 0 {
                short(coordinates.next(bytes)?)
            } else {
                f64::from(bytes.int_in_range(-side..=side)?)
            };
        }
        points.push(point);
    }
    Ok(points)
}

/// Rows as sets, so that neither their order nor that of corners matters.
fn sets<const N: usize>(rows: &[[u32; N]]) -> BTreeSet<[u32; N]> {
    rows.iter()
        .map(|row| {
            let mut row = *row;
            row.sort_unstable();
            row
        })
        .collect()
}

fn check<const D: usize, const V: usize, const P: usize>(bytes: &mut Unstructured) -> Result<()> {
    let points = read::<D>(bytes)?;
    // The coordinates with another one, a bit each.
    let turned: u8 = bytes.arbitrary()?;
    let is_turned = |k: usize| turned >> k & 1 == 1;
    let times = |p: &[f64; D], factor: f64| -> [f64; D] {
        std::array::from_fn(|k| if is_turned(k) { factor * p[k] } else { p[k] })
    };
    let room = size_of::<Rest>() / size_of::<f64>() - D;
    let whole: Vec<[f64; D]> = points.iter().map(|p| times(p, 5.0)).collect();
    let part: Vec<[f64; D]> = points.iter().map(|p| times(p, 4.0)).collect();
    let other = |p: &[f64; D]| -> Rest {
        let mut rest = Rest::default();
        let columns = (0..D).filter(|&k| is_turned(k));
        for (x, k) in rest[..room].iter_mut().zip(columns) {
            *x = 3.0 * p[k];
        }
        rest
    };
    if (0..D).filter(|&k| is_turned(k)).count() <= room {
        let rest: Vec<Rest> = points.iter().map(other).collect();
        compare::<D, V, P>(&whole, &part, &rest);
    }
    let copies: Vec<(usize, f64)> = (0..bytes.int_in_range(1..=room)?)
        .map(|_| {
            let factor = [1.0, -1.0, 2.0, 0.25, 3.0, 0.0][bytes.choose_index(6)?];
            Ok((bytes.choose_index(D)?, factor))
        })
        .collect::<Result<_>>()?;
    let copied = |p: &[f64; D]| -> Rest {
        let mut rest = Rest::default();
        for (x, (k, factor)) in rest.iter_mut().zip(&copies) {
            // A quarter may round below the normal doubles.
            *x = if *factor == 0.25 && p[*k].abs() < 1e-300 {
                0.0
            } else {
                factor * p[*k]
            };
        }
        rest
    };
    let rest: Vec<Rest> = points.iter().map(copied).collect();
    judge::<D, V, P>(&points, &rest);
    Ok(())
}

fn compare<const D: usize, const V: usize, const P: usize>(
    whole: &[[f64; D]],
    part: &[[f64; D]],
    rest: &[Rest],
) {
    let watch = Watch::idle();
    let expected = match triangulate::<D, V, P>(whole, &watch) {
        Ok(expected) => expected,
        Err(Error::Flat { dimension, .. }) => {
            assert_eq!(dimension, D);
            let made = triangulate_in_flat::<D, V, P>(part, rest, &watch);
            assert!(matches!(made, Err(Error::Flat { .. })), "{part:?}");
            let made = hull_in_flat::<D, V, P>(part, rest, &watch);
            assert!(matches!(made, Err(Error::Flat { .. })), "{part:?}");
            return;
        }
        Err(other) => panic!("{other}: {whole:?}"),
    };
    let made = triangulate_in_flat::<D, V, P>(part, rest, &watch).unwrap();
    assert_eq!(
        sets(&made.simplices),
        sets(&expected.simplices),
        "{whole:?}"
    );
    assert_eq!(made.duplicates, expected.duplicates, "{whole:?}");
    let made = hull_in_flat::<D, V, P>(part, rest, &watch).unwrap();
    let expected = hull::<D, V, P>(whole, &watch).unwrap();
    assert_eq!(
        sets(&made.simplices),
        sets(&expected.simplices),
        "{whole:?}"
    );
    judge::<D, V, P>(part, rest);
}

fn judge<const D: usize, const V: usize, const P: usize>(points: &[[f64; D]], rest: &[Rest]) {
    let watch = Watch::idle();
    let made = match triangulate_in_flat::<D, V, P>(points, rest, &watch) {
        Ok(made) => made,
        Err(Error::Flat { .. }) => return,
        Err(other) => panic!("{other}: {points:?} {rest:?}"),
    };
    let simplices: Vec<[i32; V]> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
    let given = Given {
        points,
        simplices: &simplices,
        neighbors: &made.neighbors,
    };
    let found = validate_in_flat::<D, V, P>(given, rest, &watch).unwrap();
    assert_eq!(found, Findings::default(), "{points:?} {rest:?}");
    // Rows in the other order.
    let count = points.len() as u32;
    let reversed: Vec<[f64; D]> = points.iter().rev().copied().collect();
    let others: Vec<Rest> = rest.iter().rev().copied().collect();
    let again = triangulate_in_flat::<D, V, P>(&reversed, &others, &watch).unwrap();
    if made.duplicates.is_empty() {
        let back: Vec<[u32; V]> = again
            .simplices
            .iter()
            .map(|v| v.map(|row| count - 1 - row))
            .collect();
        assert_eq!(sets(&made.simplices), sets(&back), "{points:?} {rest:?}");
    }
}
