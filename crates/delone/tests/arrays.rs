//! Plain arrays in and out: the same as the iterators give, and refused if they do not fit.

use delone::arrays::{Diagram2, Diagram3, Domain, Lines, Rule};
use delone::{Constrained, Error, Options, Point2, Tiling, Triangulation, Voronoi};

const SQUARE: [Point2; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

fn shape<T>(result: Result<T, Error>) -> String {
    match result {
        Err(Error::Shape(text)) => text,
        Err(other) => panic!("{other:?}"),
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn a_tiling_from_its_own_arrays_is_the_same() {
    let points: Vec<Point2> = (0..200)
        .map(|i| [f64::from(i % 17), f64::from(i * 7 % 23)])
        .collect();
    let t = Triangulation::new(&points).unwrap();
    let edges = t.edges().unwrap();
    let nearest = t.nearest(&[[3.2, 4.4]]).unwrap();
    assert!(!t.stages().is_empty());
    let (simplices, neighbors) = Tiling::from(t).into_arrays();
    let given = Tiling::from_arrays(&points, &simplices, &neighbors).unwrap();
    assert_eq!(given.edges().unwrap(), edges);
    assert_eq!(given.simplices().len(), simplices.len());
    assert!(given.added().is_empty());
    let t = Triangulation::trusted(given);
    assert_eq!(t.nearest(&[[3.2, 4.4]]).unwrap(), nearest);
    let voronoi = Voronoi::new(&t).unwrap();
    let vertices = voronoi.vertices().to_vec();
    let diagram = Diagram2::from(voronoi);
    assert_eq!(diagram.vertices, vertices);
    assert_eq!(diagram.triangle_vertex.len(), simplices.len());
    assert_eq!(Tiling::from(t).into_arrays(), (simplices, neighbors));
}

#[test]
fn diagrams_in_3d_are_arrays_too() {
    let corners = [0, 1, 2, 3].map(|k| [0, 1, 2].map(|i| f64::from(u8::from(i + 1 == k))));
    let t = Triangulation::new(&corners).unwrap();
    let diagram = Diagram3::from(Voronoi::new(&t).unwrap());
    assert_eq!(diagram.vertices, [[0.5; 3]]);
    assert_eq!(diagram.ridges.sites.len(), 6);
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let (triangles, beside) = ([[0, 1, 2], [2, 3, 0]], [[-1, 1, -1], [-1, 0, -1]]);
    assert!(Tiling::from_arrays(&SQUARE, &triangles, &beside).is_ok());
    assert_eq!(
        shape(Tiling::from_arrays(&SQUARE, &triangles, &beside[..1])),
        "neighbors has 1 entries, not 2"
    );
    assert_eq!(
        shape(Tiling::from_arrays(&SQUARE[..3], &triangles, &beside)),
        "simplices: row 1 has an entry outside 0..3"
    );
    assert_eq!(
        shape(Tiling::from_arrays(&SQUARE, &triangles, &[[-1; 3], [2; 3]])),
        "neighbors: row 1 has an entry outside -1..2"
    );
    let mut points = SQUARE;
    points[2][1] = f64::NAN;
    assert!(matches!(
        Tiling::from_arrays(&points, &triangles, &beside),
        Err(Error::NonFinite { rows, .. }) if rows == [2]
    ));
}

#[test]
fn segments_tell_what_they_have_become() {
    let mut points = SQUARE.to_vec();
    points.push([1.0, 0.0]);
    // Both diagonals cross, the bottom passes through row 4 and is covered twice, the last is a point.
    let segments = [[0, 2], [1, 3], [0, 1], [1, 4], [3, 3]];
    let options = Options::new().split_crossings(true);
    let made = options.constrain(&points, &segments.map(|s| s.map(|v: i32| v)));
    let (tiling, sides, segments) = made.unwrap().into_parts();
    assert_eq!(tiling.added(), [[1.0, 1.0]]);
    assert_eq!(sides.len(), tiling.simplices().len());
    assert_eq!(segments.zero, [4]);
    assert_eq!(segments.through, [[2, 4]]);
    assert_eq!(segments.crossings, [[0, 1, 5]]);
    let row = |ends| segments.ends.iter().position(|e| *e == ends).unwrap();
    let shared = row([4, 1]);
    let range = segments.starts[shared] as usize..segments.starts[shared + 1] as usize;
    assert_eq!(segments.sources[range.clone()], [2, 3]);
    assert_eq!(segments.forward[range], [true, false]);
    let negative = Options::new().constrain(&points, &[[0, -1]]);
    assert!(matches!(
        negative,
        Err(Error::NoSuchPoint { segment: 0, .. })
    ));
}

#[test]
fn rings_are_filled_by_either_rule() {
    let inner = SQUARE.map(|p| p.map(|x| 0.5 * x + 0.5));
    let points = [SQUARE, inner].concat();
    let area = |rule| {
        let filled = Options::new().fill(&points, &[0, 4, 8], rule).unwrap();
        assert!(filled.added.is_empty());
        let double = |s: &[i32; 3]| {
            let [a, b, c] = s.map(|v| points[v as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        filled.simplices.iter().map(double).sum::<f64>() / 2.0
    };
    assert_eq!((area(Rule::EvenOdd), area(Rule::NonZero)), (3.0, 4.0));
    let rings = Constrained::polygon(&[SQUARE, inner]).unwrap();
    assert_eq!(rings.sizes().unwrap().iter().sum::<f64>(), 3.0);
    let wrong = Options::new().fill(&points, &[0, 9], Rule::EvenOdd);
    assert_eq!(shape(wrong), "starts must ascend, from 0 to at most 8");
}

#[test]
fn regions_are_refined_with_areas_of_their_own() {
    let c = Constrained::new(&SQUARE, &[[0, 2]]).unwrap();
    let simplices: Vec<_> = c.simplices().map(|s| s.map(|v| v as i32)).collect();
    let upper = |s: &[i32; 3]| i32::from(s.contains(&3));
    let labels: Vec<_> = simplices.iter().map(upper).collect();
    let areas: Vec<_> = labels.iter().map(|l| [0.5, 0.01][*l as usize]).collect();
    let domain = Domain {
        points: &SQUARE,
        simplices: &simplices,
        labels: &labels,
        areas: &areas,
        segments: &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]],
        frozen: &[false; 5],
        ..Domain::default()
    };
    let refined = Options::new().min_angle(20.0).refine(domain).unwrap();
    assert!(!refined.exhausted);
    let count = |label| refined.labels.iter().filter(|l| **l == label).count();
    assert!(count(1) >= 200 && (4..100).contains(&count(0)));
    let short = Domain {
        areas: &areas[..1],
        ..domain
    };
    assert_eq!(
        shape(Options::new().refine(short)),
        "areas has 1 entries, not 2"
    );
    let lines = Lines {
        of: &[0, 0, 0, 0, 5],
        ends: &[[0, 2]],
        on: &[-1; 4],
    };
    let off = Domain {
        lines: Some(lines),
        frozen: &[false],
        ..domain
    };
    assert_eq!(
        shape(Options::new().refine(off)),
        "of: row 4 has an entry outside 0..1"
    );
    assert!(matches!(
        Options::new().min_angle(60.0).refine(domain),
        Err(Error::Option(_))
    ));
}
