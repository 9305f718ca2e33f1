//! Closed surfaces: unions of boxes whose edges are flipped and whose vertices are moved at random.
//!
//! The pairs of faces that cross or touch are compared with all pairs by exact orientations. Where
//! none cross, the inside is filled: positive tetrahedra that conform, with each face as a wall, and the
//! same ones for every order of the rows, with flips and without. They are refined, with the faces kept and
//! divided.

#![no_main]

use std::collections::{BTreeMap, BTreeSet};

use delone_core::Point3;
use delone_core::base::arrays::FACETS;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::solids::recover::{Recovered, Task, recover};
use delone_core::solids::refine::{Given, Rounds};
use delone_core::solids::surface::{Checked, Options, check};
use delone_fuzz::Coordinates;
use delone_predicates::{Point2, Sign, orient2d, orient3d};
use libfuzzer_sys::arbitrary::{Arbitrary, Result, Unstructured};

/// Cells along an axis.
const CELLS: usize = 3;

/// Edges flipped and vertices moved at most.
const CHANGES: usize = 12;

/// Coordinates from here on leave no room around them, and are refused.
const LARGEST: f64 = 1e306;

/// Points that may be added.
const MOST_ADDED: usize = 2_000;

/// Points that a refinement may add.
const MOST_REFINED: usize = 300;

type Face = [i32; 3];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok((points, faces)) = read(&mut Unstructured::new(bytes)) {
        let options = Options {
            limit: usize::MAX,
            workers: 1,
        };
        let found = check(&points, &faces, options, &Watch::idle()).expect("a report");
        compare_pairs(&points, &found);
        let small = points.as_flattened().iter().all(|x| x.abs() < LARGEST);
        if found.pairs.crossing == 0 && small {
            fill(&points, &found);
        }
    }
});

fn read(bytes: &mut Unstructured) -> Result<(Vec<Point3>, Vec<Face>)> {
    let mut coordinates = Coordinates::new(bytes)?;
    let mut axes: [Vec<f64>; 3] = Default::default();
    for axis in &mut axes {
        for _ in 0..=CELLS {
            axis.push(coordinates.next(bytes)? + 0.0);
        }
        axis.sort_unstable_by(f64::total_cmp);
        axis.dedup();
    }
    let (mut points, mut faces) = boxes(bytes, &axes)?;
    for _ in 0..bytes.int_in_range(0..=CHANGES)? {
        if faces.is_empty() {
            break;
        }
        if bytes.arbitrary()? {
            let f = bytes.choose_index(faces.len())?;
            flip(&mut faces, f);
        } else {
            let v = bytes.choose_index(points.len())?;
            points[v][bytes.choose_index(3)?] = coordinates.next(bytes)?;
        }
    }
    Ok((points, faces))
}

/// The squares between chosen cells and the others, each with a chosen diagonal.
fn boxes(bytes: &mut Unstructured, axes: &[Vec<f64>; 3]) -> Result<(Vec<Point3>, Vec<Face>)> {
    let chosen = u32::arbitrary(bytes)?;
    let size = [0, 1, 2].map(|k| axes[k].len() - 1);
    let within = |c: [usize; 3]| (0..3).all(|k| c[k] < size[k]);
    let is_chosen =
        |c: [usize; 3]| within(c) && chosen >> (c[0] + CELLS * (c[1] + CELLS * c[2])) & 1 == 1;
    let mut numbers: BTreeMap<[usize; 3], i32> = BTreeMap::new();
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for cell in (0..CELLS.pow(3)).map(|c| [c % CELLS, c / CELLS % CELLS, c / CELLS / CELLS]) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beyond = cell;
            beyond[axis] = beyond[axis].wrapping_add(2 * side).wrapping_sub(1);
            if !is_chosen(cell) || is_chosen(beyond) {
                continue;
            }
            let mut corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| {
                let mut corner = cell;
                corner[axis] += side;
                corner[(axis + 1) % 3] += u;
                corner[(axis + 2) % 3] += v;
                *numbers.entry(corner).or_insert_with(|| {
                    points.push([0, 1, 2].map(|k| axes[k][corner[k]]));
                    points.len() as i32 - 1
                })
            });
            if side == 0 {
                corners.reverse();
            }
            let [a, b, c, d] = corners;
            faces.extend(match bytes.arbitrary()? {
                true => [[a, b, c], [a, c, d]],
                false => [[a, b, d], [b, c, d]],
            });
        }
    }
    Ok((points, faces))
}

/// Flips the first edge of a face, if one other face has it.
fn flip(faces: &mut [Face], f: usize) {
    let [a, b, c] = faces[f];
    let across = |face: &Face| (0..3).find(|&k| (face[k], face[(k + 1) % 3]) == (b, a));
    let mut others = (0..faces.len()).filter_map(|g| Some((g, across(&faces[g])?)));
    if let (Some((g, k)), None) = (others.next(), others.next()) {
        let d = faces[g][(k + 2) % 3];
        if d != c {
            faces[f] = [a, d, c];
            faces[g] = [d, b, c];
        }
    }
}

/// Compares the pairs with those found by testing each.
fn compare_pairs(points: &[Point3], found: &Checked) {
    let reported: BTreeSet<[u32; 2]> = found.pairs.first.iter().map(|p| p.faces).collect();
    let kept = &found.clean.kept;
    for (i, &f) in kept.iter().enumerate() {
        for &g in &kept[i + 1..] {
            let [a, b] = [f, g].map(|row| found.clean.faces[row as usize]);
            let meet = boxes_meet(points, a, b) && meet(points, a, b);
            assert_eq!(
                reported.contains(&[f, g]),
                meet,
                "{f} {g} {points:?} {:?}",
                found.clean.faces
            );
        }
    }
}

fn boxes_meet(points: &[Point3], a: [u32; 3], b: [u32; 3]) -> bool {
    let range = |face: [u32; 3], k: usize| {
        let x = face.map(|v| points[v as usize][k]);
        (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]))
    };
    (0..3).all(|k| {
        let ((low, high), (least, most)) = (range(a, k), range(b, k));
        low <= most && least <= high
    })
}

/// Whether two faces have more in common than shared vertices and edges: faces that share a vertex have a
/// point of the opposite edge of one in common then, those that share an edge overlap.
fn meet(points: &[Point3], a: [u32; 3], b: [u32; 3]) -> bool {
    let at = |v: u32| points[v as usize];
    let lone = |face: [u32; 3], other: [u32; 3]| face.into_iter().find(|v| !other.contains(v));
    let shared: Vec<u32> = a.into_iter().filter(|v| b.contains(v)).collect();
    match shared[..] {
        [] => {
            edges(a).any(|e| on(e.map(at), b.map(at))) || edges(b).any(|e| on(e.map(at), a.map(at)))
        }
        [v] => {
            let opposite = |face| edges(face).find(|e| !e.contains(&v)).expect("an edge");
            on(opposite(a).map(at), b.map(at)) || on(opposite(b).map(at), a.map(at))
        }
        [u, v] => {
            let [x, y] = [lone(a, b), lone(b, a)].map(|w| at(w.expect("a third vertex")));
            let [p, q] = [at(u), at(v)];
            orient3d(p, q, x, y).is_zero() && flat(p, q, x) == flat(p, q, y)
        }
        _ => unreachable!("faces with the same vertices are left out"),
    }
}

fn edges([a, b, c]: [u32; 3]) -> impl Iterator<Item = [u32; 2]> {
    [[a, b], [b, c], [c, a]].into_iter()
}

/// The orientations of the three projections along an axis.
fn flat(a: Point3, b: Point3, c: Point3) -> [Sign; 3] {
    [(0, 1), (1, 2), (2, 0)].map(|(j, k)| {
        let [a, b, c] = [a, b, c].map(|p| [p[j], p[k]]);
        orient2d(a, b, c)
    })
}

/// Whether an edge meets a triangle.
fn on([p, q]: [Point3; 2], [a, b, c]: [Point3; 3]) -> bool {
    let [above, below] = [p, q].map(|x| orient3d(a, b, c, x));
    if above.is_zero() && below.is_zero() {
        let k = (0..3)
            .find(|&k| !flat(a, b, c)[k].is_zero())
            .expect("an area");
        let [p, q, a, b, c] = [p, q, a, b, c].map(|x| [x[k], x[(k + 1) % 3]]);
        let sides = [[a, b], [b, c], [c, a]];
        return inside(p, [a, b, c]) || sides.into_iter().any(|side| cross([p, q], side));
    }
    // Also for an end in the plane: the line meets the plane in one point.
    let turns = [(a, b), (b, c), (c, a)].map(|(x, y)| orient3d(p, q, x, y));
    above != below
        && (turns.iter().all(|&t| t != Sign::Negative)
            || turns.iter().all(|&t| t != Sign::Positive))
}

fn inside(p: Point2, [a, b, c]: [Point2; 3]) -> bool {
    let turns = [(a, b), (b, c), (c, a)].map(|(x, y)| orient2d(x, y, p));
    turns.iter().all(|&t| t != Sign::Negative) || turns.iter().all(|&t| t != Sign::Positive)
}

/// Whether two segments meet.
fn cross([p, q]: [Point2; 2], [a, b]: [Point2; 2]) -> bool {
    let sides = [
        orient2d(p, q, a),
        orient2d(p, q, b),
        orient2d(a, b, p),
        orient2d(a, b, q),
    ];
    if sides.iter().all(|s| s.is_zero()) {
        let meet = |k: usize| p[k].min(q[k]) <= a[k].max(b[k]) && a[k].min(b[k]) <= p[k].max(q[k]);
        return meet(0) && meet(1);
    }
    sides[0] != sides[1] && sides[2] != sides[3]
}

/// Fills the surface in two orders of its rows and in two ways.
fn fill(points: &[Point3], found: &Checked) {
    let mut used: Vec<u32> = found.resolved.faces.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    if used.is_empty() {
        return;
    }
    let mut corners: Vec<Point3> = used.iter().map(|&v| points[v as usize]).collect();
    let row = |v: &u32| used.binary_search(v).expect("a row") as i32;
    let parts = &found.resolved;
    let mut faces: Vec<Face> = parts
        .faces
        .iter()
        .map(|face| [0, 1, 2].map(|k| row(&face[k])))
        .collect();
    let needed: Vec<bool> = parts
        .source
        .iter()
        .map(|row| !found.dangling.contains(row))
        .collect();
    let made = filled(&corners, &faces, &needed, true);
    filled(&corners, &faces, &needed, false);
    corners.reverse();
    for face in &mut faces {
        *face = face.map(|v| corners.len() as i32 - 1 - v);
        face.rotate_left(1);
    }
    let half = faces.len() / 2;
    faces.rotate_left(half);
    assert_eq!(made, filled(&corners, &faces, &[], true), "{points:?}");
}

/// The tetrahedra by their coordinates, checked; `None` if there is no room for a double.
fn filled(
    points: &[Point3],
    faces: &[Face],
    needed: &[bool],
    flips: bool,
) -> Option<BTreeSet<[[u64; 3]; 4]>> {
    let task = Task {
        points,
        faces,
        max_points: MOST_ADDED,
        flips,
        workers: 1,
    };
    let made = match recover(task, &Watch::idle()) {
        Ok(made) if made.crowded.is_empty() => made,
        Ok(_) | Err(Error::Budget { .. }) => return None,
        Err(e) => panic!("{e}: {points:?} {faces:?}"),
    };
    verify(&made, points, faces, needed);
    if flips && !needed.is_empty() {
        refined(&made, faces.len(), false);
        refined(&made, faces.len(), true);
    }
    let corners = |t: &[i32; 4]| {
        let mut corners = t.map(|v| made.points[v as usize].map(|x| (x + 0.0).to_bits()));
        corners.sort_unstable();
        corners
    };
    Some(made.tetrahedra.iter().map(corners).collect())
}

/// Positive tetrahedra whose faces are shared by two or are walls; each face that is needed is one.
fn verify(made: &Recovered, points: &[Point3], faces: &[Face], needed: &[bool]) {
    assert_eq!(made.points[..points.len()], *points);
    let mut sides = vec![0; faces.len()];
    for (t, corners) in made.tetrahedra.iter().enumerate() {
        let [a, b, c, d] = corners.map(|v| made.points[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive, "{points:?} {faces:?}");
        for k in 0..4 {
            let mut face: Vec<i32> = corners.to_vec();
            face.remove(k);
            face.sort_unstable();
            let wall = made.walls[t][k];
            if wall >= 0 {
                let mut given = faces[wall as usize].to_vec();
                given.sort_unstable();
                assert_eq!(face, given, "{points:?} {faces:?}");
                sides[wall as usize] += 1;
            }
            match made.neighbors[t][k] {
                -1 => assert!(wall >= 0, "{points:?} {faces:?}"),
                u => {
                    let u = u as usize;
                    let back = made.neighbors[u].iter().position(|&s| s == t as i32);
                    let back = back.expect("a neighbor's neighbor");
                    let mut other = made.tetrahedra[u].to_vec();
                    other.remove(back);
                    other.sort_unstable();
                    assert_eq!(face, other, "{points:?} {faces:?}");
                    assert_eq!(wall, made.walls[u][back]);
                }
            }
        }
    }
    assert!(sides.iter().all(|&n| n <= 2), "{points:?} {faces:?}");
    let mut rows = needed.iter().zip(sides);
    assert!(
        rows.all(|(&needed, n)| n > 0 || !needed),
        "{points:?} {faces:?}"
    );
}

/// Refines the tetrahedra to a part of their extent: positive ones that conform, whose border is what
/// became of the faces. Without `split` these are the same.
fn refined(made: &Recovered, count: usize, split: bool) {
    let mut rows: Vec<Option<Face>> = vec![None; count];
    for (corners, walls) in made.tetrahedra.iter().zip(&made.walls) {
        for (k, facet) in FACETS.iter().enumerate() {
            if let Ok(row) = usize::try_from(walls[k]) {
                rows[row] = Some(facet.map(|i| corners[i]));
            }
        }
    }
    let faces: Vec<Face> = rows.into_iter().flatten().collect();
    let sources: Vec<i32> = (0..faces.len() as i32).collect();
    let markers: Vec<i32> = sources.iter().map(|row| row % 3 / 2).collect();
    let given = Given {
        points: &made.points,
        simplices: &made.tetrahedra,
        labels: &[],
        faces: &faces,
        sources: &sources,
        markers: &markers,
        split,
        tolerance: 0.0,
        radius_edge: 1.0 + count as f64 / 16.0,
    };
    let mut rounds = Rounds::new(&given).expect("a mesh");
    let (corners, _) = rounds.fresh().expect("tetrahedra");
    let all = || corners.iter().flatten().flatten();
    let extent = all().fold(f64::NEG_INFINITY, |m, &x| m.max(x))
        - all().fold(f64::INFINITY, |m, &x| m.min(x));
    let size = extent / (1 + count % 7) as f64;
    rounds
        .comply(&vec![size; corners.len()], count % 2 == 0)
        .expect("sizes");
    rounds
        .refine(MOST_REFINED, &Watch::idle(), &mut |_| Ok(()))
        .expect("a mesh");
    let found = rounds.export().expect("arrays");
    assert_eq!(found.points[..made.points.len()], made.points[..]);
    if !split {
        assert_eq!(found.faces, faces);
    }
    let ascending = |mut face: Face| {
        face.sort_unstable();
        face
    };
    let walls: BTreeSet<Face> = found.faces.iter().map(|&f| ascending(f)).collect();
    let mut sides: BTreeMap<Face, usize> = BTreeMap::new();
    for corners in &found.simplices {
        let [a, b, c, d] = corners.map(|v| found.points[v as usize]);
        assert_eq!(orient3d(a, b, c, d), Sign::Positive, "{:?}", made.points);
        for facet in FACETS {
            *sides
                .entry(ascending(facet.map(|i| corners[i])))
                .or_default() += 1;
        }
    }
    for (face, n) in sides {
        assert!(
            n == 2 || n == 1 && walls.contains(&face),
            "{:?}",
            made.points
        );
    }
}
