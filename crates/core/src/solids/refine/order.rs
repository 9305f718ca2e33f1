//! Import and export: sorts vertices and tetrahedra by coordinates, and maps the result back to
//! rows.

use std::collections::HashSet;

use delone_predicates::Point3;

use super::judge::{cross, dot, minus};
use super::mesh::{Corners, FACES, Mesh, NONE};
use super::work::Work;
use super::{Counts, facet, is_wall, repeated};
use crate::base::error::{Error, Result};
use crate::base::memory::{push, with_room};
use crate::solids::improve::{self, Imported, rotated};

/// A mesh to refine, and how.
#[derive(Debug, Clone, Copy)]
pub struct Given<'a> {
    /// Rows of coordinates, finite.
    pub points: &'a [Point3],
    /// Positively oriented tetrahedra that do not overlap.
    pub simplices: &'a [[i32; 4]],
    /// A label of each. Empty if all have the same.
    pub labels: &'a [i32],
    /// The faces that stay: all of the boundary and between labels, and others.
    pub faces: &'a [[i32; 3]],
    /// The face of which each of these is a part; faces with one source are one facet.
    pub sources: &'a [i32],
    /// A marker of each: faces in one plane are one facet if these are equal.
    pub markers: &'a [i32],
    /// Whether points may be put on faces.
    pub split: bool,
    /// If points may be: faces within this distance of one plane are one facet.
    pub tolerance: f64,
    /// The largest ratio of the circumradius to the shortest edge; infinite for none.
    pub radius_edge: f64,
}

/// A refined mesh.
#[derive(Debug)]
pub struct Refined {
    /// The given rows, then the added points.
    pub points: Vec<Point3>,
    /// Tetrahedra in rows.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
    /// The label of each.
    pub labels: Vec<i32>,
    /// The size that was asked for at each.
    pub sizes: Vec<f64>,
    /// The faces that stayed, oriented as given.
    pub faces: Vec<[i32; 3]>,
    /// The row of the given face that each of these is, or lies in the facet of.
    pub face_rows: Vec<i32>,
    /// Numbers of added points.
    pub counts: Counts,
}

/// What is needed to map results back to rows.
#[derive(Debug)]
pub struct Order {
    /// The points as given.
    given: Vec<Point3>,
    faces: Vec<[i32; 3]>,
    /// The row of each vertex of the input.
    rows: Vec<u32>,
    /// The factor by which coordinates are multiplied.
    pub scale: f64,
}

fn ascending(mut v: [u32; 3]) -> [u32; 3] {
    v.sort_unstable();
    v
}

/// Sorts and checks everything.
pub fn import(given: &Given) -> Result<(Mesh, Order)> {
    let count = given.faces.len();
    if given.sources.len() != count || given.markers.len() != count {
        return Err(Error::Shape("faces need a source and a marker each".into()));
    }
    let Imported { store, rows, scale } = improve::import(
        improve::Task {
            points: given.points,
            simplices: given.simplices,
            labels: given.labels,
            fixed: &[],
            removable: &[],
            min_angle: 0.0,
            flips: false,
            smooth: false,
            exude: false,
            turn: false,
            tolerance: 0.0,
            passes: 0,
            most: 0,
        },
        false,
    )?;
    let mut place = repeated(given.points.len(), NONE)?;
    for (v, &row) in (0..).zip(&rows) {
        place[row as usize] = v;
    }
    let m = store.corners.len();
    let mut facets: Vec<u32> = with_room(count)?;
    facets.extend(0..count as u32);
    let mut mesh = Mesh {
        given: store.points.len(),
        points: store.points,
        wall: repeated(m, [NONE; 4])?,
        size: repeated(m, f64::INFINITY)?,
        known: repeated(m, false)?,
        corners: store.corners,
        across: store.across,
        label: store.label,
        facet: facets,
        segments: HashSet::new(),
        pinched: HashSet::new(),
        free: Vec::new(),
    };
    set_walls(&mut mesh, given, &place)?;
    if given.split {
        facet::collect(
            &mut mesh,
            given.sources,
            given.markers,
            given.tolerance * scale,
        )?;
    }
    let order = Order {
        given: crate::base::memory::copied(given.points)?,
        faces: crate::base::memory::copied(given.faces)?,
        rows,
        scale,
    };
    Ok((mesh, order))
}

/// Marks the given faces as walls. Rejects faces that no tetrahedron has, and borders that are
/// not given.
fn set_walls(mesh: &mut Mesh, given: &Given, place: &[u32]) -> Result<()> {
    let mut sorted: Vec<([u32; 3], u32)> = with_room(given.faces.len())?;
    for (row, face) in (0..).zip(given.faces) {
        sorted.push((ascending(face.map(|v| place[v as usize])), row));
    }
    sorted.sort_unstable();
    let mut met = repeated(given.faces.len(), false)?;
    for t in 0..mesh.corners.len() {
        for (k, corners) in FACES.iter().enumerate() {
            let face = ascending(corners.map(|i| mesh.corners[t][i]));
            let at = sorted.partition_point(|other| other.0 < face);
            let u = mesh.across[t][k];
            match sorted.get(at) {
                Some(&(found, row)) if found == face => {
                    mesh.wall[t][k] = row;
                    met[row as usize] = true;
                }
                _ if u == NONE || mesh.label[u as usize] != mesh.label[t] => {
                    return Err(Error::Shape(
                        "a face of the boundary or between labels is not among the faces".into(),
                    ));
                }
                _ => {}
            }
        }
    }
    match met.iter().position(|&met| !met) {
        None => Ok(()),
        Some(row) => Err(Error::Shape(format!(
            "face {row} is given twice, or is not a face of a tetrahedron"
        ))),
    }
}

/// Converts everything to rows, with tetrahedra and faces sorted by their vertices.
pub fn export(work: &Work, order: &Order) -> Result<Refined> {
    let mesh = &work.mesh;
    let first = order.given.len() as u32;
    let row = |v: u32| match order.rows.get(v as usize) {
        Some(&row) => row as i32,
        None => (first + v - mesh.given as u32) as i32,
    };
    let added = mesh.points.len() - mesh.given;
    let mut points = with_room(order.given.len() + added)?;
    points.extend_from_slice(&order.given);
    let further = mesh.points[mesh.given..].iter();
    points.extend(further.map(|p| p.map(|x| x / order.scale)));

    let there = (0..mesh.places()).filter(|&t| mesh.is_there(t));
    let mut sorted: Vec<(Corners, u32)> = with_room(mesh.corners.len())?;
    sorted.extend(there.map(|t| (rotated(mesh.corners[t as usize]), t)));
    sorted.sort_unstable();
    let mut number = repeated(mesh.corners.len(), -1)?;
    for (i, (_, t)) in (0..).zip(&sorted) {
        number[*t as usize] = i;
    }
    let mut out = Refined {
        points,
        simplices: with_room(sorted.len())?,
        neighbors: with_room(sorted.len())?,
        labels: with_room(sorted.len())?,
        sizes: with_room(sorted.len())?,
        faces: Vec::new(),
        face_rows: Vec::new(),
        counts: work.counts,
    };
    let mut faces: Vec<(u32, [u32; 3])> = Vec::new();
    for &(v, t) in &sorted {
        let at = t as usize;
        out.simplices.push(v.map(row));
        out.neighbors.push(v.map(|v| {
            let k = mesh.corner(t, v).unwrap_or(0);
            match mesh.across[at][k] {
                NONE => -1,
                u => number[u as usize],
            }
        }));
        out.labels.push(mesh.label[at]);
        out.sizes.push(mesh.size[at] / order.scale);
        for k in 0..4 {
            let seen = mesh.behind((t, k)).is_some_and(|other| other < (t, k));
            if is_wall(mesh, t, k) && !seen {
                push(&mut faces, (mesh.wall[at][k], mesh.face((t, k))))?;
            }
        }
    }
    // Faces in the order of the given ones; those of one row by their vertices.
    faces.sort_unstable_by_key(|&(wall, face)| (wall, ascending(face)));
    out.faces = with_room(faces.len())?;
    out.face_rows = with_room(faces.len())?;
    for &(wall, face) in &faces {
        let given = order.faces[wall as usize];
        out.faces.push(oriented(&out.points, face.map(row), given));
        out.face_rows.push(wall as i32);
    }
    Ok(out)
}

/// A face in the orientation of a given one that is the same or in its facet.
fn oriented(points: &[Point3], face: [i32; 3], given: [i32; 3]) -> [i32; 3] {
    if given.iter().all(|v| face.contains(v)) {
        return given;
    }
    let normal = |f: [i32; 3]| {
        let [a, b, c] = f.map(|v| points[v as usize]);
        cross(minus(b, a), minus(c, a))
    };
    let [a, b, c] = face;
    if dot(normal(face), normal(given)) > 0.0 {
        face
    } else {
        [a, c, b]
    }
}
