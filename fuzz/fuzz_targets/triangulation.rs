//! 2-D triangulations: every method gives the same triangles, and they are checked exactly.

#![no_main]

use std::collections::BTreeSet;

use delone_core::Point2;
use delone_core::base::arrays::Given;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::delaunay::plane::validate::{Findings, validate};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_fuzz::Coordinates;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few points are harder.
const MOST: usize = 60;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(points) = read(&mut Unstructured::new(bytes)) {
        let answers: Vec<_> = Method::NAMES
            .iter()
            .map(|&(_, m)| triangles(&points, m))
            .collect();
        assert!(
            answers.windows(2).all(|w| w[0] == w[1]),
            "methods disagree on {points:?}"
        );
    }
});

fn read(bytes: &mut Unstructured) -> Result<Vec<Point2>> {
    let mut coordinates = Coordinates::new(bytes)?;
    let mut points = Vec::new();
    while !bytes.is_empty() && points.len() < MOST {
        points.push(coordinates.point(bytes)?);
    }
    Ok(points)
}

/// The valid triangles, each from its smallest row on; `None` if the points are in line.
fn triangles(points: &[Point2], method: Method) -> BTreeSet<[i32; 3]> {
    match triangulate(points, method, 1, &Watch::idle()) {
        Ok(made) => {
            let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
            let given = Given {
                points,
                simplices,
                neighbors,
            };
            let found = validate(given, &Watch::idle()).expect("a report");
            assert_eq!(found, Findings::default(), "{method:?} of {points:?}");
            simplices
                .iter()
                .map(|&[a, b, c]| {
                    [[a, b, c], [b, c, a], [c, a, b]]
                        .into_iter()
                        .min()
                        .expect("three")
                })
                .collect()
        }
        Err(Error::TooFew { .. } | Error::Collinear { .. }) => BTreeSet::new(),
        Err(other) => panic!("{other} for {points:?}"),
    }
}
