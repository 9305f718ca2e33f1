//! Live triangulations with segments: after each edit the triangles are those of a fresh build.

#![no_main]

use std::collections::{BTreeMap, BTreeSet};

use delone_core::Point2;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay::plane::Method;
use delone_core::live::plane::{Plane, State};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few points are harder.
const MOST: usize = 40;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // The bytes end in the middle of an edit.
    let _ = edits(&mut Unstructured::new(bytes));
});

fn edits(bytes: &mut Unstructured) -> Result<()> {
    let mut coordinates = Coordinates::new(bytes)?;
    let watch = Watch::idle();
    let mut live = Plane::new(&[], 1, &watch).expect("no points");
    let split = bytes.arbitrary()?;
    live.split_crossings(split);
    let mut given = Given::default();
    let mut kept: Vec<(State, Given)> = Vec::new();
    while !bytes.is_empty() {
        let rows: Vec<i64> = given.points.keys().copied().collect();
        let before = given.clone();
        let ends: BTreeSet<i64> = given.segments.values().flatten().copied().collect();
        let done = match bytes.int_in_range(0..=8)? {
            0 | 1 if rows.len() < MOST => {
                let count = bytes.int_in_range(1..=4)?;
                let new: Vec<Point2> = (0..count)
                    .map(|_| place(&mut coordinates, split, bytes))
                    .collect::<Result<_>>()?;
                let made = live.insert(&new, 1, &watch);
                made.map(|made| given.points.extend(made.map(|row| row as i64).zip(new)))
            }
            2 if !rows.is_empty() => {
                let row = *bytes.choose(&rows)?;
                given.points.remove(&row);
                if ends.contains(&row) {
                    assert!(live.remove(&[row], 1, &watch).is_err());
                    let own = given.take_segments_at(row);
                    let gone = live.remove_with_segments(&[row], 1, &watch);
                    gone.map(|gone| assert_eq!(gone, own))
                } else {
                    live.remove(&[row], 1, &watch)
                }
            }
            3 if !rows.is_empty() => {
                let row = *bytes.choose(&rows)?;
                let p = place(&mut coordinates, split, bytes)?;
                given.points.insert(row, p);
                live.relocate(&[row], &[p], 1, &watch)
            }
            4 | 5 if !rows.is_empty() => {
                let pair = [*bytes.choose(&rows)?, *bytes.choose(&rows)?];
                let made = live.insert_segments(&[pair], 1, &watch);
                made.map(|made| {
                    given.segments.insert(made.start as i64, pair);
                })
            }
            6 if !given.segments.is_empty() => {
                let numbers: Vec<i64> = given.segments.keys().copied().collect();
                let number = *bytes.choose(&numbers)?;
                given.segments.remove(&number);
                live.remove_segments(&[number], 1, &watch)
            }
            7 => {
                kept.push((live.state(&watch).expect("a state"), given.clone()));
                Ok(())
            }
            8 if !kept.is_empty() => {
                let (state, old) = &kept[bytes.choose_index(kept.len())?];
                given = old.clone();
                live.restore(state, &watch)
            }
            _ => continue,
        };
        match done {
            Ok(()) => {}
            Err(Error::Crossing { .. }) if !split => given = before,
            Err(error) => panic!("{error}"),
        }
        live.check().expect("a mesh");
        given.compare(&live, split, &watch);
    }
    Ok(())
}

/// A point. Crossings are split among coordinates of about one size: where pixels differ by hundreds of
/// powers of two, a segment may pass through one that is beside none of the triangles it crosses.
fn place(coordinates: &mut Coordinates, split: bool, bytes: &mut Unstructured) -> Result<Point2> {
    if !split {
        return coordinates.point(bytes);
    }
    Ok([
        1.0 + f64::from(bytes.arbitrary::<i8>()?) * 0.1,
        1.0 + f64::from(bytes.arbitrary::<i8>()?) * 0.1,
    ])
}

/// What a triangulation is made of.
#[derive(Clone, Default)]
struct Given {
    points: BTreeMap<i64, Point2>,
    segments: BTreeMap<i64, [i64; 2]>,
}

impl Given {
    /// Removes the segments that end at a row, and returns their numbers, ascending.
    fn take_segments_at(&mut self, row: i64) -> Vec<i64> {
        let all = std::mem::take(&mut self.segments);
        let (own, others) = all.into_iter().partition(|(_, pair)| pair.contains(&row));
        self.segments = others;
        let own: BTreeMap<i64, [i64; 2]> = own;
        own.into_keys().collect()
    }

    /// Compares a triangulation with a fresh one.
    fn compare(&self, live: &Plane, split: bool, watch: &Watch) {
        let points: Vec<Point2> = self.points.values().copied().collect();
        let rows: Vec<i64> = self.points.keys().copied().collect();
        let place = |row: i64| rows.binary_search(&row).expect("a row") as u32;
        let segments: Vec<[u32; 2]> = self.segments.values().map(|s| s.map(place)).collect();
        let options = Options {
            split,
            conforming: false,
            max_vertices: usize::MAX,
            method: Method::Auto,
            workers: 1,
        };
        let made = live.export(watch).expect("arrays");
        let own: BTreeSet<_> = corners(&made.arrays.simplices, &made.points);
        let fresh = match constrain(&points, &segments, options, watch) {
            Ok(fresh) => fresh,
            Err(_) => return assert!(own.is_empty(), "{points:?}"),
        };
        let all = [points, fresh.added].concat();
        assert_eq!(own, corners(&fresh.arrays.simplices, &all), "{all:?}");
    }
}

/// Triangles by the bits of their corners, each from the smallest on.
fn corners(simplices: &[[i32; 3]], points: &[Point2]) -> BTreeSet<[[u64; 2]; 3]> {
    let bits = |v: i32| points[v as usize].map(|x| (x + 0.0).to_bits());
    let turns = |s: &[i32; 3]| {
        let [a, b, c] = s.map(bits);
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min()
    };
    simplices.iter().filter_map(turns).collect()
}
