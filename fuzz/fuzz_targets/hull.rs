//! 3-D hulls compared with exact determinants: no point beyond, every corner extreme, every facet
//! complete.
//!
//! The result must be the same for every order of the rows.

#![no_main]

use std::collections::BTreeSet;

use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::hull::{Hull3, hull3};
use delone_fuzz::Coordinates;
use delone_fuzz::oracle::orientation;
use delone_predicates::Sign;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

/// More points make a run slower; ties among few points are harder.
const MOST: usize = 24;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok(points) = read(&mut Unstructured::new(bytes)) {
        let mut turned: Vec<Point3> = points[points.len() / 3..].to_vec();
        turned.extend(points.iter().rev());
        assert_eq!(facets(&points), facets(&turned), "{points:?}");
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

/// The facets by the coordinates of their corners, checked; `None` if the points span no volume.
fn facets(points: &[Point3]) -> BTreeSet<Vec<[u64; 3]>> {
    let Some(hull) = hull3(points, &Watch::idle()).expect("a hull") else {
        assert!(is_flat(points), "{points:?}");
        return BTreeSet::new();
    };
    let at = |v: u32| points[v as usize];
    for t in &hull.simplices {
        let [a, b, c] = t.map(at);
        let beyond = |&p: &Point3| orientation(&[a, b, c, p]) == Sign::Positive;
        assert!(!points.iter().any(beyond), "{points:?}");
    }
    check_surface(points, &hull);
    let polygons = hull.starts.windows(2);
    let polygons = polygons.map(|w| &hull.polygons[w[0] as usize..w[1] as usize]);
    polygons
        .map(|facet| {
            let n = facet.len();
            for k in 0..n {
                let [p, q, r] = [k, k + 1, k + 2].map(|j| at(facet[j % n]));
                assert!(!in_line(p, q, r), "{points:?}");
            }
            facet
                .iter()
                .map(|&v| at(v).map(|x| (x + 0.0).to_bits()))
                .collect()
        })
        .collect()
}

/// A closed surface of triangles; those of one facet are coplanar, those of two are not.
fn check_surface(points: &[Point3], hull: &Hull3) {
    let at = |v: u32| points[v as usize];
    let vertices: BTreeSet<u32> = hull.simplices.as_flattened().iter().copied().collect();
    assert_eq!(2 * vertices.len(), hull.simplices.len() + 4, "{points:?}");
    for (i, t) in hull.simplices.iter().enumerate() {
        let [a, b, c] = t.map(at);
        assert!(!in_line(a, b, c), "{points:?}");
        for k in 0..3 {
            let other = hull.neighbors[i][k] as usize;
            let there = hull.simplices[other];
            assert!(
                (0..3).all(|l| there.contains(&t[l]) == (l != k)),
                "{points:?}"
            );
            let tied = there
                .iter()
                .all(|&v| orientation(&[a, b, c, at(v)]) == Sign::Zero);
            assert_eq!(tied, hull.facet[i] == hull.facet[other], "{points:?}");
        }
    }
}

fn in_line(a: Point3, b: Point3, c: Point3) -> bool {
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| orientation(&[a, b, c].map(|p| [p[i], p[j]])) == Sign::Zero)
}

fn is_flat(points: &[Point3]) -> bool {
    let mut rest = points.iter().copied();
    let Some(a) = rest.next() else { return true };
    let Some(b) = rest.find(|&b| b != a) else {
        return true;
    };
    let Some(c) = rest.find(|&c| !in_line(a, b, c)) else {
        return true;
    };
    !rest.any(|d| orientation(&[a, b, c, d]) != Sign::Zero)
}
