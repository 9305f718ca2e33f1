//! Triangulations and hulls in four to eight dimensions: proven by integers, and the same for every order
//! of the rows.
//!
//! Simplices are judged by the validator of the core, which decides each facet exactly; hulls by the
//! triangulation of their vertices, of which they must be the boundary; single queries without a
//! triangulation by that triangulation; and weights by the validator again.

#![no_main]

use std::collections::BTreeSet;

use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::locate::{Batch, Cache, Locator};
use delone_core::ndim::{
    Findings, Hyper, Lazy, Weighed, hull, regular, triangulate, validate, validate_regular, within,
};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower, more so in many dimensions; ties among few are harder.
const MOST: [usize; 5] = [14, 14, 12, 11, 11];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    match bytes.int_in_range(4..=8) {
        Ok(4) => read(&mut bytes).map_or((), |points| check::<4, 5, 4>(&points)),
        Ok(5) => read(&mut bytes).map_or((), |points| check::<5, 6, 8>(&points)),
        Ok(6) => read(&mut bytes).map_or((), |points| check::<6, 7, 8>(&points)),
        Ok(7) => read(&mut bytes).map_or((), |points| check::<7, 8, 8>(&points)),
        Ok(_) => read(&mut bytes).map_or((), |points| check::<8, 9, 8>(&points)),
        Err(_) => {}
    }
});

/// Points of a lattice, of a sphere in a lattice, or with any coordinates.
fn read<const D: usize>(bytes: &mut Unstructured) -> Result<Vec<[f64; D]>> {
    let shape = bytes.int_in_range(0..=2)?;
    let count = bytes.int_in_range(1..=MOST[D - 4])?;
    let side = bytes.int_in_range(1..=3_i32)?;
    let mut coordinates = Coordinates::new(bytes)?;
    let mut points = Vec::new();
    for _ in 0..count {
        let mut point = [0.0; D];
        match shape {
            0 => point = coordinates.point(bytes)?,
            1 => {
                for x in &mut point {
                    *x = f64::from(bytes.int_in_range(-side..=side)?);
                }
            }
            _ => {
                // Two coordinates of equal magnitude: all at one distance from the origin.
                for _ in 0..2 {
                    let k = bytes.choose_index(D)?;
                    point[k] = if bytes.arbitrary()? { 1.0 } else { -1.0 };
                }
            }
        }
        points.push(point);
    }
    Ok(points)
}

/// The corners of simplices by coordinates, so that rows do not matter.
fn shapes<const D: usize, const V: usize>(
    points: &[[f64; D]],
    rows: &[[u32; V]],
) -> BTreeSet<Vec<[u64; D]>> {
    let bits = |row: u32| points[row as usize].map(|x| (x + 0.0).to_bits());
    rows.iter()
        .map(|row| {
            let mut corners: Vec<_> = row.iter().map(|&v| bits(v)).collect();
            corners.sort_unstable();
            corners
        })
        .collect()
}

fn check<const D: usize, const V: usize, const P: usize>(points: &[[f64; D]])
where
    Hyper<D>: Weighed<D, V>,
{
    let watch = Watch::idle();
    let made = match triangulate::<D, V, P>(points, &watch) {
        Ok(made) => made,
        Err(Error::Flat { .. }) => {
            assert!(matches!(
                hull::<D, V, P>(points, &watch),
                Err(Error::Flat { .. })
            ));
            return;
        }
        Err(other) => panic!("{other}: {points:?}"),
    };
    let simplices: Vec<[i32; V]> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
    let given = Given {
        points,
        simplices: &simplices,
        neighbors: &made.neighbors,
    };
    let found = validate::<D, V, P>(given, &watch).unwrap();
    assert_eq!(found, Findings::default(), "{points:?}");
    // Rows in the other order.
    let reversed: Vec<[f64; D]> = points.iter().rev().copied().collect();
    let again = triangulate::<D, V, P>(&reversed, &watch).unwrap();
    assert_eq!(
        shapes(points, &made.simplices),
        shapes(&reversed, &again.simplices),
        "{points:?}"
    );
    locate::<D, V>(given, &watch);
    alone::<D, V>(given, &watch);
    weighted::<D, V, P>(points, &watch);
    // The hull is the boundary of the triangulation of its vertices.
    let hull = hull::<D, V, P>(points, &watch).unwrap();
    let vertices: BTreeSet<u32> = hull.simplices.iter().flatten().copied().collect();
    let corners: Vec<[f64; D]> = vertices.iter().map(|&v| points[v as usize]).collect();
    let inner = triangulate::<D, V, P>(&corners, &watch).unwrap();
    let mut boundary: Vec<[u32; D]> = Vec::new();
    for (v, n) in inner.simplices.iter().zip(&inner.neighbors) {
        for k in (0..V).filter(|&k| n[k] < 0) {
            boundary.push(std::array::from_fn(|i| v[i + usize::from(i >= k)]));
        }
    }
    assert_eq!(
        shapes(points, &hull.simplices),
        shapes(&corners, &boundary),
        "{points:?}"
    );
}

/// Each point is in a simplex of which it is a corner, and its weights say so.
fn locate<const D: usize, const V: usize>(given: Given<D, V>, watch: &Watch)
where
    Hyper<D>: Weighed<D, V>,
{
    let kept = Cache::<Hyper<D>, D, V>::of(&given, watch).unwrap();
    let batch = Batch {
        locator: Locator::new(given, &kept, watch),
        queries: given.points,
        workers: 1,
        watch,
    };
    let found = within(&batch).unwrap();
    for (row, q) in given.points.iter().enumerate() {
        let t = found.simplex[row] as usize;
        let weights = &found.weights[V * row..V * (row + 1)];
        let k = weights.iter().position(|&w| w == 1.0).unwrap();
        assert_eq!(
            given.point(given.simplices[t][k]).map(|x| x + 0.0),
            q.map(|x| x + 0.0)
        );
    }
}

/// Simplices that are found without the others are among them, and so is the outside.
fn alone<const D: usize, const V: usize>(given: Given<D, V>, watch: &Watch)
where
    Hyper<D>: Weighed<D, V>,
{
    let first = given.points[0];
    let middle = |p: &[f64; D]| std::array::from_fn(|k| 0.5 * first[k] + 0.5 * p[k]);
    let queries: Vec<[f64; D]> = given.points.iter().take(4).map(middle).collect();
    let lazy = Lazy::new(given.points.as_flattened(), D, watch).unwrap();
    let found = lazy.locate(queries.as_flattened(), 1, watch).unwrap();
    let kept = Cache::<Hyper<D>, D, V>::of(&given, watch).unwrap();
    let batch = Batch {
        locator: Locator::new(given, &kept, watch),
        queries: &queries,
        workers: 1,
        watch,
    };
    let expected = within(&batch).unwrap();
    let ascending = |v: &[i32]| {
        let mut v = v.to_vec();
        v.sort_unstable();
        v
    };
    let known: BTreeSet<Vec<i32>> = given.simplices.iter().map(|v| ascending(v)).collect();
    for (rows, simplex) in found.rows.chunks_exact(V).zip(expected.simplex) {
        assert_eq!(rows[0] < 0, simplex < 0, "{:?}", given.points);
        assert!(
            rows[0] < 0 || known.contains(&ascending(rows)),
            "{:?}",
            given.points
        );
    }
}

/// With small weights, which make ties and hide points.
fn weighted<const D: usize, const V: usize, const P: usize>(points: &[[f64; D]], watch: &Watch) {
    let weights: Vec<f64> = (0..points.len()).map(|i| (i * i % 3) as f64).collect();
    let (made, _) = regular::<D, V, P>(points, &weights, watch).unwrap();
    let simplices: Vec<[i32; V]> = made.simplices.iter().map(|v| v.map(|i| i as i32)).collect();
    let given = Given {
        points,
        simplices: &simplices,
        neighbors: &made.neighbors,
    };
    let (found, _) = validate_regular::<D, V, P>(given, &weights, watch).unwrap();
    assert_eq!(found, Findings::default(), "{points:?}");
}
