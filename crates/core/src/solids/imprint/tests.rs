//! Surfaces cut where they cross themselves: conforming, the same for every order, close to their
//! sources.

use super::*;
use crate::solids::surface::check;

type Surface = (Vec<Point3>, Vec<[i32; 3]>);

/// The sides of a box.
fn cuboid(low: Point3, high: Point3) -> Surface {
    let points = (0..8)
        .map(|i| std::array::from_fn(|k| if i >> k & 1 == 0 { low[k] } else { high[k] }))
        .collect();
    let sides = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    (points, sides.to_vec())
}

fn joined(parts: &[Surface]) -> Surface {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for (own, sides) in parts {
        let first = points.len() as i32;
        points.extend(own);
        faces.extend(sides.iter().map(|f| f.map(|v| v + first)));
    }
    (points, faces)
}

fn cut_of((points, faces): &Surface, workers: usize) -> Imprinted {
    let options = Options {
        tolerance: 0.0,
        workers,
    };
    imprint(points, faces, options, &Watch::idle()).unwrap()
}

/// Checks that parts meet only in vertices and edges; the number of enclosed regions.
fn regions((points, _): &Surface, made: &Imprinted) -> u32 {
    assert!(made.crossing.is_empty());
    let all: Vec<Point3> = points.iter().chain(&made.added).copied().collect();
    let faces: Vec<_> = made.faces.iter().map(|f| f.map(|v| v as i32)).collect();
    let limits = Limits {
        limit: 10,
        workers: 1,
    };
    let found = check(&all, &faces, limits, &Watch::idle()).unwrap();
    assert_eq!(found.pairs.counts, [0; 6]);
    assert!(found.edges.boundary.is_empty() && found.edges.unbalanced.is_empty());
    found.regions.unwrap()
}

/// Points rotated, so that nothing is exactly in a plane any more.
fn rotated((points, faces): &Surface) -> Surface {
    let (a, b) = (0.7_f64, 0.4_f64);
    let turn = |[x, y, z]: Point3| {
        let [x, y] = [x * a.cos() - y * a.sin(), x * a.sin() + y * a.cos()];
        [x, y * b.cos() - z * b.sin(), y * b.sin() + z * b.cos()]
    };
    (points.iter().map(|&p| turn(p)).collect(), faces.clone())
}

#[test]
fn boxes_that_overlap_have_a_common_region() {
    let both = joined(&[cuboid([0.0; 3], [2.0; 3]), cuboid([1.0; 3], [3.0; 3])]);
    for surface in [both.clone(), rotated(&both)] {
        let made = cut_of(&surface, 1);
        assert_eq!((made.rounds, regions(&surface, &made)), (1, 3));
        // Six edges pierce faces, or cross edges on diagonals.
        assert!(made.added.len() >= 6 && made.distance < 1e-15);
    }
}

#[test]
fn bodies_in_contact_share_faces() {
    let bodies = [
        cuboid([0.0, 0.0, 0.0], [2.0, 2.0, 2.0]),
        cuboid([0.25, 0.5, 2.0], [1.0, 1.5, 3.0]),
        cuboid([1.0, 0.0, 2.0], [3.0, 3.0, 2.5]),
    ];
    let all = joined(&bodies);
    for surface in [all.clone(), rotated(&all)] {
        let made = cut_of(&surface, 1);
        assert_eq!(regions(&surface, &made), 3);
        let mut common: Vec<[u32; 3]> = made.faces.iter().map(|f| sorted(*f)).collect();
        common.sort_unstable();
        let count = common.len();
        common.dedup();
        assert!(count > common.len());
    }
}

fn sorted(mut ids: [u32; 3]) -> [u32; 3] {
    ids.sort_unstable();
    ids
}

/// The parts by their sources, as coordinates.
fn parts((points, _): &Surface, made: &Imprinted, source: &[u32]) -> Vec<(u32, [[u64; 3]; 3])> {
    let at = |v: u32| {
        let p = points.get(v as usize).copied();
        p.unwrap_or_else(|| made.added[v as usize - points.len()])
            .map(f64::to_bits)
    };
    let of = |(f, s): (&[u32; 3], &u32)| {
        let mut corners = f.map(at);
        corners.sort_unstable();
        (source[*s as usize], corners)
    };
    let mut all: Vec<_> = made.faces.iter().zip(&made.source).map(of).collect();
    all.sort_unstable();
    all
}

#[test]
fn the_order_of_rows_and_threads_do_not_matter() {
    let surface = rotated(&joined(&[
        cuboid([0.0; 3], [2.0; 3]),
        cuboid([1.0; 3], [3.0; 3]),
        cuboid([0.5, 0.25, 2.0], [1.5, 1.25, 4.0]),
    ]));
    let made = cut_of(&surface, 1);
    let same: Vec<u32> = (0..surface.1.len() as u32).collect();
    let all = parts(&surface, &made, &same);
    assert_eq!(parts(&surface, &cut_of(&surface, 3), &same), all);
    // Points and faces backward, and corners in another order.
    let last = surface.0.len() as i32 - 1;
    let points: Vec<Point3> = surface.0.iter().rev().copied().collect();
    let mixed = surface
        .1
        .iter()
        .rev()
        .map(|&[a, b, c]| [last - b, last - c, last - a]);
    let other = (points, mixed.collect::<Vec<_>>());
    let back: Vec<u32> = same.iter().rev().copied().collect();
    assert_eq!(parts(&other, &cut_of(&other, 2), &back), all);
    // A power of two scales everything.
    for factor in [2.0_f64.powi(600), 2.0_f64.powi(-700)] {
        let scale = |p: Point3| p.map(|x| x * factor);
        let larger = (
            surface.0.iter().map(|&p| scale(p)).collect(),
            surface.1.clone(),
        );
        let found = cut_of(&larger, 1);
        assert_eq!(found.faces, made.faces);
        let scaled: Vec<Point3> = made.added.iter().map(|&p| scale(p)).collect();
        assert_eq!(found.added, scaled);
        assert_eq!(found.distance, made.distance * factor);
    }
}

#[test]
fn three_faces_through_a_point_have_it_in_common() {
    let sheet = |k: usize| -> Surface {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [0.5, 1.5]];
        let place = |[u, v]: [f64; 2]| {
            let mut p = [0.1, 0.2, 0.3];
            p[(k + 1) % 3] += u;
            p[(k + 2) % 3] += v;
            p
        };
        (corners.map(place).to_vec(), vec![[0, 1, 2]])
    };
    let all = joined(&[sheet(0), sheet(1), sheet(2)]);
    let made = cut_of(&all, 1);
    assert!(made.crossing.is_empty());
    let shared = (0..(all.0.len() + made.added.len()) as u32).find(|&v| {
        (0..3).all(|source| {
            let mut own = made
                .faces
                .iter()
                .zip(&made.source)
                .filter(|one| *one.1 == source);
            own.any(|(f, _)| f.contains(&v))
        })
    });
    let at = made.added[shared.unwrap() as usize - all.0.len()];
    assert!(near::square(at, [0.1, 0.2, 0.3]) < 1e-30);
}

#[test]
fn a_tolerance_joins_what_is_near() {
    let gap = 1e-7;
    let bodies = [
        cuboid([0.0; 3], [1.0; 3]),
        cuboid([0.25 + gap, 0.25, 1.0 + gap], [2.0, 0.75, 2.0]),
    ];
    let all = joined(&bodies);
    let options = |tolerance| Options {
        tolerance,
        workers: 1,
    };
    let apart = imprint(&all.0, &all.1, options(0.0), &Watch::idle()).unwrap();
    assert_eq!(
        (apart.rounds, apart.faces.len(), apart.distance),
        (0, 24, 0.0)
    );
    let made = imprint(&all.0, &all.1, options(1e-6), &Watch::idle()).unwrap();
    assert_eq!(regions(&all, &made), 2);
    assert!(made.faces.len() > 24);
    assert!(made.distance > 0.9 * gap && made.distance < 2.0 * gap);
}

#[test]
fn an_interruption_ends_it() {
    let (points, faces) = joined(&[cuboid([0.0; 3], [2.0; 3]), cuboid([1.0; 3], [3.0; 3])]);
    let options = Options {
        tolerance: 0.0,
        workers: 2,
    };
    let ended = imprint(&points, &faces, options, &Watch::new(&|| true));
    assert_eq!(ended.unwrap_err(), crate::base::error::Error::Interrupted);
}
