//! The triangulation in any dimension is that of the plane and of space where there is one.

use delone_core::base::error::Error;
use delone_core::base::watch::IDLE;
use delone_core::delaunay::plane::{Method, triangulate as plane};
use delone_core::delaunay::space::triangulate as space;
use delone_core::hull::hull3 as solid;
use delone_core::ndim::{hull, triangulate};

/// Numbers with few or with many bits: ties, duplicates and general position.
fn points<const D: usize>(n: usize, seed: u64) -> Vec<[f64; D]> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let bits = x >> 11;
        match seed % 3 {
            0 => (bits % 5) as f64,
            1 => (bits % 4) as f64 / 3.0,
            _ => bits as f64 / (1u64 << 53) as f64,
        }
    };
    (0..n).map(|_| [0; D].map(|_| next())).collect()
}

/// Rows of corners, each ascending and with the parity of the order, ascending.
fn oriented<const V: usize>(simplices: &[[i32; V]]) -> Vec<([i32; V], bool)> {
    let mut all: Vec<_> = simplices
        .iter()
        .map(|&v| {
            let mut ascending = v;
            ascending.sort_unstable();
            let before = |i: usize| (i..V).filter(|&j| v[j] < v[i]).count();
            (ascending, (0..V).map(before).sum::<usize>() % 2 == 0)
        })
        .collect();
    all.sort_unstable();
    all
}

fn signed<const V: usize>(simplices: &[[u32; V]]) -> Vec<[i32; V]> {
    simplices.iter().map(|v| v.map(|i| i as i32)).collect()
}

#[test]
fn the_plane_and_space_have_the_same_simplices() {
    for seed in 0..60 {
        let at = points::<2>(40, seed);
        let here = triangulate::<2, 3, 4>(&at, &IDLE).unwrap();
        let there = plane(&at, Method::Auto, 1, &IDLE).unwrap();
        assert_eq!(here.duplicates, there.duplicates);
        assert_eq!(
            oriented(&signed(&here.simplices)),
            oriented(&there.arrays.simplices)
        );
        let at = points::<3>(50, seed);
        let here = triangulate::<3, 4, 4>(&at, &IDLE).unwrap();
        let there = space(&at, 1, &IDLE).unwrap();
        assert_eq!(here.duplicates, there.duplicates);
        assert_eq!(
            oriented(&signed(&here.simplices)),
            oriented(&there.arrays.simplices)
        );
    }
}

#[test]
fn the_hull_in_space_has_the_same_facets() {
    for seed in 0..60 {
        let at = points::<3>(40, seed);
        let here = hull::<3, 4, 4>(&at, &IDLE).unwrap();
        let Some(there) = solid(&at, &IDLE).unwrap() else {
            panic!("no hull");
        };
        assert_eq!(
            oriented(&signed(&here.simplices)),
            oriented(&signed(&there.simplices)),
            "{seed}"
        );
    }
}

#[test]
fn flats_are_named_with_rows_that_span_them() {
    let mut at = points::<5>(30, 2);
    for p in &mut at {
        p[4] = p[0] + p[1];
        (p[2], p[3]) = (p[0] * 2.0, 7.0);
    }
    at[3] = [0.0, 0.0, 0.0, 7.0, 0.0];
    let refused = triangulate::<5, 6, 8>(&at, &IDLE).unwrap_err();
    assert_eq!(refused.class(), "DegenerateInputError");
    assert!(
        refused
            .to_string()
            .starts_with("all 30 distinct points lie in a flat of dimension 3,")
    );
    let Error::Flat {
        distinct: 30,
        dimension: 5,
        rows,
    } = refused
    else {
        panic!("{refused}");
    };
    // p[0] + p[1] is rounded.
    assert_eq!(rows.len(), 4);
}
