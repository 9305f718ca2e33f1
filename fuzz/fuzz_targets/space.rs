//! 3-D triangulations: valid by an exact check, and the same for every order of the rows.

#![no_main]

use std::collections::BTreeSet;

use delone_core::Point3;
use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::triangulate;
use delone_core::delaunay::space::validate::{Findings3, validate};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few points are harder.
const MOST: usize = 40;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(points) = read(&mut Unstructured::new(bytes)) {
        let reversed: Vec<Point3> = points.iter().rev().copied().collect();
        let turned: Vec<Point3> = points[points.len() / 3..]
            .iter()
            .chain(&points)
            .copied()
            .collect();
        let answer = tetrahedra(&points);
        assert_eq!(answer, tetrahedra(&reversed), "{points:?}");
        assert_eq!(answer, tetrahedra(&turned), "{points:?}");
    }
});

fn read(bytes: &mut Unstructured) -> Result<Vec<Point3>> {
    let mut coordinates = Coordinates::new(bytes)?;
    let mut points = Vec::new();
    while !bytes.is_empty() && points.len() < MOST {
        points.push(coordinates.point(bytes)?);
    }
    Ok(points)
}

/// The valid tetrahedra by their coordinates; `None` if the points span none.
fn tetrahedra(points: &[Point3]) -> BTreeSet<[[u64; 3]; 4]> {
    match triangulate(points, 1, &Watch::idle()) {
        Ok(made) => {
            let given = Given {
                points,
                simplices: &made.arrays.simplices,
                neighbors: &made.arrays.neighbors,
            };
            let found = validate(given, &Watch::idle()).expect("a report");
            assert_eq!(found, Findings3::default(), "{points:?}");
            let corners = |t: &[i32; 4]| {
                let mut corners = t.map(|v| points[v as usize].map(|x| (x + 0.0).to_bits()));
                corners.sort_unstable();
                corners
            };
            made.arrays.simplices.iter().map(corners).collect()
        }
        Err(Error::TooFewInSpace { .. } | Error::Collinear { .. } | Error::Coplanar { .. }) => {
            BTreeSet::new()
        }
        Err(other) => panic!("{other} for {points:?}"),
    }
}
