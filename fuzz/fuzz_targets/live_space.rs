//! Live triangulations in 3-D: after each edit the tetrahedra are those of a fresh build.

#![no_main]

use std::collections::{BTreeMap, BTreeSet};

use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::triangulate;
use delone_core::live::space::{Space, State};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few points are harder.
const MOST: usize = 24;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // The bytes end in the middle of an edit.
    let _ = edits(&mut Unstructured::new(bytes));
});

fn edits(bytes: &mut Unstructured) -> Result<()> {
    let mut coordinates = Coordinates::new(bytes)?;
    let watch = Watch::idle();
    let mut live = Space::new(&[], 1, &watch).expect("no points");
    let mut points: BTreeMap<i64, Point3> = BTreeMap::new();
    let mut kept: Vec<(State, BTreeMap<i64, Point3>)> = Vec::new();
    while !bytes.is_empty() {
        let rows: Vec<i64> = points.keys().copied().collect();
        match bytes.int_in_range(0..=5)? {
            0 | 1 if points.len() < MOST => {
                let count = bytes.int_in_range(1..=4)?;
                let new: Vec<Point3> = (0..count)
                    .map(|_| coordinates.point(bytes))
                    .collect::<Result<_>>()?;
                let made = live.insert(&new, 1, &watch).expect("finite points");
                points.extend(made.map(|row| row as i64).zip(new));
            }
            2 if !rows.is_empty() => {
                let row = *bytes.choose(&rows)?;
                live.remove(&[row], 1, &watch).expect("a row");
                points.remove(&row);
            }
            3 if !rows.is_empty() => {
                let row = *bytes.choose(&rows)?;
                let p = coordinates.point(bytes)?;
                live.relocate(&[row], &[p], 1, &watch).expect("a row");
                points.insert(row, p);
            }
            4 => kept.push((live.state(&watch).expect("a state"), points.clone())),
            5 if !kept.is_empty() => {
                let (state, old) = &kept[bytes.choose_index(kept.len())?];
                live.restore(state, &watch).expect("a state");
                points = old.clone();
            }
            _ => continue,
        }
        live.check().expect("a mesh");
        let made = live.export(&watch).expect("arrays");
        let expected: Vec<Point3> = points.values().copied().collect();
        assert!(made.points == expected);
        let fresh = triangulate(&expected, 1, &watch);
        let fresh = fresh.map_or_else(|_| Vec::new(), |made| made.arrays.simplices);
        assert_eq!(sets(&made.arrays.simplices), sets(&fresh), "{expected:?}");
    }
    Ok(())
}

/// Tetrahedra by their corners, ascending.
fn sets(simplices: &[[i32; 4]]) -> BTreeSet<[i32; 4]> {
    let sorted = |simplex: &[i32; 4]| {
        let mut corners = *simplex;
        corners.sort_unstable();
        corners
    };
    simplices.iter().map(sorted).collect()
}
