//! Refinement of boxes: exact validity after every round, sizes, shapes, facets, order of rows.

use std::collections::{BTreeMap, BTreeSet};

use delone_predicates::{Point3, Sign, orient3d};

use super::judge::Shape;
use super::*;

/// A box of `n` cubes along x, each of six tetrahedra around a diagonal.
struct Model {
    points: Vec<Point3>,
    simplices: Vec<[i32; 4]>,
    labels: Vec<i32>,
    faces: Vec<[i32; 3]>,
}

fn bar(n: i32, spread: impl Fn(Point3) -> Point3) -> Model {
    let mut points = Vec::new();
    for x in 0..=n {
        for y in 0..2 {
            for z in 0..2 {
                points.push(spread([f64::from(x), f64::from(y), f64::from(z)]));
            }
        }
    }
    let row = |[x, y, z]: [i32; 3]| 4 * x + 2 * y + z;
    let (mut simplices, mut labels) = (Vec::new(), Vec::new());
    for cube in 0..n {
        for [i, j, k] in [
            [0, 1, 2],
            [0, 2, 1],
            [1, 0, 2],
            [1, 2, 0],
            [2, 0, 1],
            [2, 1, 0],
        ] {
            let mut at = [cube, 0, 0];
            let mut corners = [row(at); 4];
            for (c, axis) in (1..).zip([i, j, k]) {
                at[axis] += 1;
                corners[c] = row(at);
            }
            let [a, b, c, d] = corners.map(|v| points[v as usize]);
            if orient3d(a, b, c, d) == Sign::Negative {
                corners.swap(2, 3);
            }
            simplices.push(corners);
            labels.push(cube % 2);
        }
    }
    let faces = borders(&simplices, &labels);
    Model {
        points,
        simplices,
        labels,
        faces,
    }
}

/// The faces of the boundary and between labels, each once.
fn borders(simplices: &[[i32; 4]], labels: &[i32]) -> Vec<[i32; 3]> {
    let mut at: BTreeMap<[i32; 3], Vec<([i32; 3], i32)>> = BTreeMap::new();
    for (v, &label) in simplices.iter().zip(labels) {
        for corners in crate::base::arrays::FACETS {
            let face = corners.map(|i| v[i]);
            let mut key = face;
            key.sort_unstable();
            at.entry(key).or_default().push((face, label));
        }
    }
    let all = at.into_values();
    let walls = all.filter(|sides| sides.len() == 1 || sides[0].1 != sides[1].1);
    walls.map(|sides| sides[0].0).collect()
}

fn given<'a>(
    model: &'a Model,
    zeros: &'a [i32],
    rows: &'a [i32],
    split: bool,
    ratio: f64,
) -> Given<'a> {
    Given {
        points: &model.points,
        simplices: &model.simplices,
        labels: &model.labels,
        faces: &model.faces,
        sources: rows,
        markers: zeros,
        split,
        tolerance: 0.0,
        radius_edge: ratio,
    }
}

/// Refines in rounds by a function of positions.
fn refined(model: &Model, split: bool, ratio: f64, size: impl Fn(Point3) -> f64) -> Refined {
    let zeros = vec![0; model.faces.len()];
    let rows: Vec<i32> = (0..model.faces.len() as i32).collect();
    let mut rounds = Rounds::new(&given(model, &zeros, &rows, split, ratio)).unwrap();
    for round in 0..60 {
        let (fresh, _) = rounds.fresh().unwrap();
        let sizes: Vec<f64> = fresh.iter().map(|p| size(place::middle(*p))).collect();
        if rounds.comply(&sizes, true).unwrap() && round > 0 {
            break;
        }
        let before = rounds.counts().total();
        assert!(
            rounds
                .refine(200_000, &Watch::idle(), &mut |_| Ok(()))
                .unwrap()
        );
        if rounds.counts().total() == before && round > 0 {
            break;
        }
    }
    let made = rounds.export().unwrap();
    assert_valid(model, &made, split);
    made
}

/// Six times the volume.
fn volume(points: &[Point3], v: [i32; 4]) -> f64 {
    let [a, b, c, d] = v.map(|v| points[v as usize]);
    judge::dot(
        judge::cross(judge::minus(b, a), judge::minus(c, a)),
        judge::minus(d, a),
    )
}

fn assert_valid(model: &Model, made: &Refined, split: bool) {
    assert_eq!(made.points[..model.points.len()], model.points[..]);
    let mut sides = BTreeSet::new();
    for v in &made.simplices {
        let [a, b, c, d] = v.map(|v| made.points[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
        for corners in crate::base::arrays::FACETS {
            // No face is seen twice from one side.
            let mut face = corners.map(|i| v[i]);
            let least = (0..3).min_by_key(|&i| face[i]).unwrap();
            face.rotate_left(least);
            assert!(sides.insert(face));
        }
    }
    // Neighbors are mutual and share a face.
    for (t, row) in made.neighbors.iter().enumerate() {
        for (k, &u) in row.iter().enumerate() {
            let Ok(u) = usize::try_from(u) else { continue };
            let face: BTreeSet<i32> = (0..4)
                .filter(|&i| i != k)
                .map(|i| made.simplices[t][i])
                .collect();
            let other: BTreeSet<i32> = made.simplices[u].into_iter().collect();
            assert!(face.is_subset(&other) && made.neighbors[u].contains(&(t as i32)));
        }
    }
    // The faces are all borders, and nothing else.
    let sorted = |faces: &[[i32; 3]]| -> BTreeSet<[i32; 3]> {
        faces
            .iter()
            .map(|f| {
                let mut f = *f;
                f.sort_unstable();
                f
            })
            .collect()
    };
    let walls = borders(&made.simplices, &made.labels);
    assert_eq!(sorted(&walls), sorted(&made.faces));
    assert_eq!(walls.len(), made.faces.len());
    if !split {
        assert_eq!(made.faces, model.faces);
    }
    // They are oriented as given.
    let normal = |points: &[Point3], face: [i32; 3]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        judge::cross(judge::minus(b, a), judge::minus(c, a))
    };
    for (&face, &row) in made.faces.iter().zip(&made.face_rows) {
        let given = normal(&model.points, model.faces[row as usize]);
        assert!(judge::dot(normal(&made.points, face), given) > 0.0);
    }
    let sum = |points: &[Point3], all: &[[i32; 4]]| -> f64 {
        all.iter().map(|&v| volume(points, v)).sum()
    };
    let (before, after) = (
        sum(&model.points, &model.simplices),
        sum(&made.points, &made.simplices),
    );
    assert!((before - after).abs() < 1e-12 * before, "{before} {after}");
    // All added points are corners.
    let used: BTreeSet<i32> = made.simplices.iter().flatten().copied().collect();
    assert!((model.points.len()..made.points.len()).all(|v| used.contains(&(v as i32))));
}

fn largest(made: &Refined) -> f64 {
    let all = made.simplices.iter().zip(&made.sizes);
    all.map(|(v, &size)| Shape::of(v.map(|v| made.points[v as usize])).excess(size))
        .fold(0.0, f64::max)
}

fn turned([x, y, z]: Point3) -> Point3 {
    [
        0.8 * x - 0.6 * y + 0.1 * z,
        0.6 * x + 0.8 * y - 0.3 * z,
        0.3 * x - 0.1 * y + z,
    ]
}

#[test]
fn a_size_is_reached_with_facets_that_are_split() {
    for spread in [|p| p, turned] {
        let made = refined(&bar(1, spread), true, 2.0, |_| 0.2);
        assert!(largest(&made) <= 1.0, "{}", largest(&made));
        // A regular tetrahedron of this size has .00094 of the cube.
        assert!(
            (1_000..20_000).contains(&made.simplices.len()),
            "{}",
            made.simplices.len()
        );
        assert!(made.counts.on_segments >= 36 && made.counts.on_facets > 30);
    }
}

#[test]
fn facets_stay_where_they_may_not_be_split() {
    let made = refined(&bar(3, turned), false, 2.0, |_| 0.3);
    assert_eq!(made.counts.on_segments + made.counts.on_facets, 0);
    assert!(made.counts.for_sizes > 3);
}

#[test]
fn labels_and_faces_between_them_are_kept() {
    let model = bar(4, turned);
    let made = refined(&model, true, 1.6, |_| 0.4);
    for label in [0, 1] {
        let part = |points: &[Point3], all: &[[i32; 4]], labels: &[i32]| -> f64 {
            let own = all.iter().zip(labels).filter(|(_, l)| **l == label);
            own.map(|(&v, _)| volume(points, v)).sum()
        };
        let before = part(&model.points, &model.simplices, &model.labels);
        let after = part(&made.points, &made.simplices, &made.labels);
        assert!((before - after).abs() < 1e-12, "{before} {after}");
    }
}

#[test]
fn sizes_that_vary_are_followed() {
    let size = |p: Point3| 0.04 + 0.3 * judge::distance(p, [0.0, 0.0, 0.0]);
    let made = refined(&bar(2, |p| p), true, 2.0, size);
    for v in &made.simplices {
        let corners = v.map(|v| made.points[v as usize]);
        let asked = size(place::middle(corners));
        assert!(Shape::of(corners).excess(asked) <= 1.0);
    }
    let near = made
        .points
        .iter()
        .filter(|p| judge::distance(**p, [0.0; 3]) < 0.2)
        .count();
    assert!(
        near > 30 && made.points.len() < 4_000,
        "{near} {}",
        made.points.len()
    );
}

#[test]
fn the_order_of_rows_does_not_matter() {
    let model = bar(2, turned);
    let made = refined(&model, true, 2.0, |_| 0.3);
    let n = model.points.len();
    let back = |v: i32| n as i32 - 1 - v;
    let mut other = Model {
        points: model.points.iter().rev().copied().collect(),
        simplices: model.simplices.iter().rev().map(|v| v.map(back)).collect(),
        labels: model.labels.iter().rev().copied().collect(),
        faces: model.faces.iter().rev().map(|f| f.map(back)).collect(),
    };
    for v in &mut other.simplices {
        v.rotate_left(2);
        v.swap(0, 1);
        v.swap(2, 3);
        let [a, b, c, d] = v.map(|v| other.points[v as usize]);
        if orient3d(a, b, c, d) == Sign::Negative {
            v.swap(0, 1);
        }
    }
    let again = refined(&other, true, 2.0, |_| 0.3);
    let key = |made: &Refined| -> BTreeSet<Vec<[u64; 3]>> {
        let corner = |v: i32| made.points[v as usize].map(f64::to_bits);
        let all = made.simplices.iter().map(|v| {
            let mut corners: Vec<_> = v.iter().map(|&v| corner(v)).collect();
            corners.sort_unstable();
            corners
        });
        all.collect()
    };
    assert_eq!(key(&made), key(&again));
}

#[test]
fn shapes_are_bounded() {
    // A cube with a point near its middle.
    let mut model = bar(1, |[x, y, z]| [x, y, z]);
    model.points.push([0.5, 0.51, 0.52]);
    let inner = model.points.len() as i32 - 1;
    // Fan the cube from the point.
    model.simplices = model
        .faces
        .iter()
        .map(|f| [f[0], f[1], f[2], inner])
        .collect();
    for v in &mut model.simplices {
        let [a, b, c, d] = v.map(|v| model.points[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive);
    }
    model.labels = vec![0; model.simplices.len()];
    let made = refined(&model, true, 1.2, |_| f64::INFINITY);
    for v in &made.simplices {
        let shape = Shape::of(v.map(|v| made.points[v as usize]));
        assert!(shape.radius <= 1.2 * shape.shortest * (1.0 + 1e-12));
    }
}

#[test]
fn an_edge_at_which_two_parts_touch_is_kept() {
    let mut model = bar(1, |p| p);
    let other = bar(1, |[x, y, z]| [x + 1.0, y + 1.0, z]);
    // The edge from (1, 1, 0) to (1, 1, 1) has rows 6 and 7 there, 0 and 1 in the other cube.
    let row = |v: i32| v + 6;
    model.points.extend(&other.points[2..]);
    model
        .simplices
        .extend(other.simplices.iter().map(|v| v.map(row)));
    model.labels = vec![0; model.simplices.len()];
    model.faces = borders(&model.simplices, &model.labels);
    let made = refined(&model, true, 2.0, |_| 0.4);
    let on = |p: &Point3| p[0] == 1.0 && p[1] == 1.0;
    assert_eq!(made.points.iter().filter(|p| on(p)).count(), 2);
    assert!(made.counts.on_segments > 20);
}

#[test]
fn a_limit_ends_it_and_leaves_a_mesh() {
    let model = bar(2, |p| p);
    let zeros = vec![0; model.faces.len()];
    let rows: Vec<i32> = (0..model.faces.len() as i32).collect();
    let mut rounds = Rounds::new(&given(&model, &zeros, &rows, true, 2.0)).unwrap();
    let count = rounds.fresh().unwrap().0.len();
    assert!(!rounds.comply(&vec![0.05; count], false).unwrap());
    assert!(!rounds.refine(17, &Watch::idle(), &mut |_| Ok(())).unwrap());
    let made = rounds.export().unwrap();
    assert_eq!(made.counts.total(), 17);
    assert_valid(&model, &made, true);
    assert!(matches!(
        rounds.refine(1_000_000, &Watch::new(&|| true), &mut |_| Ok(())),
        Err(Error::Interrupted)
    ));
    // The work done until then is a valid mesh as well.
    assert_valid(&model, &rounds.export().unwrap(), true);
}

#[test]
fn borders_must_be_faces() {
    let mut model = bar(2, |p| p);
    model.faces.pop();
    let zeros = vec![0; model.faces.len()];
    let rows: Vec<i32> = (0..model.faces.len() as i32).collect();
    let outcome = Rounds::new(&given(&model, &zeros, &rows, true, 2.0));
    assert!(matches!(outcome, Err(Error::Shape(_))));
    model.faces.push([0, 1, 0]);
    let zeros = vec![0; model.faces.len()];
    let outcome = Rounds::new(&given(&model, &zeros, &zeros, true, 2.0));
    assert!(matches!(outcome, Err(Error::Shape(_))));
}
