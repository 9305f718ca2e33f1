//! Faces of 3-D Voronoi cells: the duals of Delaunay edges, in the bisecting planes of their two
//! sites.
//!
//! With weights, they lie in the radical plane of the sites.
//!
//! The tetrahedra around an edge, in order, have the vertices of the face as centers. A vertex
//! shared by several tetrahedra counts once. An edge that is a diagonal of a polytope of
//! cospherical sites, or of one of its faces, has no face: around it there are one or two
//! polytopes, whereas around an edge of polytopes, each with less than half of the turn, there are
//! at least three. On the hull one suffices, unless the edge is a diagonal of one of its facets:
//! then the two triangles of the hull are coplanar.

use std::collections::HashMap;

use delone_predicates::{Point3, orient3d};

use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::measure::sphere::normal;
use crate::voronoi::Given;

/// Tetrahedra per task.
const SHARE: usize = 1 << 14;

/// The edges of a tetrahedron: two corners, and the other two so that all four are positively
/// oriented.
const EDGES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];
/// The number of the edge between two corners.
const NUMBER: [[u8; 4]; 4] = [[9, 0, 1, 2], [0, 9, 3, 4], [1, 3, 9, 5], [2, 4, 5, 9]];

/// Faces of cells. Seen from the second site, with the first one behind, a face is
/// counterclockwise.
#[derive(Debug, Default)]
pub struct Ridges {
    /// The two sites of each ridge.
    pub sites: Vec<[i32; 2]>,
    /// The entries of ridge r are `starts[r]..starts[r + 1]`.
    pub starts: Vec<i32>,
    /// Entry: a vertex, or !i for ray i. An unbounded ridge begins and ends with a ray.
    pub entries: Vec<i32>,
    /// The unit direction of each ray.
    pub rays: Vec<Point3>,
}

/// The output of one task.
#[derive(Default)]
struct Part {
    sites: Vec<[i32; 2]>,
    ends: Vec<u32>,
    entries: Vec<i32>,
}

/// The input of a walk around edges.
struct Walk<'a> {
    given: Given<'a, 3, 4>,
    vertex: &'a [i32],
    /// The ray of each face of the hull, by 4 t + k.
    ray: HashMap<u32, i32>,
}

/// The walk around one edge.
#[derive(Default)]
struct Turn {
    ring: Vec<u32>,
    /// For the tetrahedra in `ring`, the corners where the edge begins and ends.
    at: Vec<(u8, u8)>,
    /// The corners opposite the last face and the first one, if the turn is open: faces of the
    /// hull.
    last: usize,
    first: usize,
    open: bool,
}

/// Ridges in the order of the first tetrahedra around their edges. `far` are the directions of
/// out-of-range vertices, which become the first rays.
pub(super) fn ridges(
    given: Given<3, 4>,
    vertex: &[i32],
    far: Vec<Point3>,
    workers: usize,
    watch: &Watch,
) -> Result<Ridges> {
    let mut rays = far;
    let mut ray = HashMap::new();
    for (t, row) in given.neighbors.iter().enumerate() {
        for k in (0..4).filter(|&k| row[k] < 0) {
            ray.insert(4 * t as u32 + k as u32, rays.len() as i32);
            rays.push(outward(given, t, k));
        }
    }
    let walk = Walk { given, vertex, ray };
    let shares = (0..given.simplices.len()).step_by(SHARE).collect();
    let parts = parallel::map(workers, shares, |from| {
        watch.check()?;
        walk.share(from)
    });
    let parts = parts.into_iter().collect::<Result<Vec<_>>>()?;
    let count = parts.iter().map(|p| p.sites.len()).sum::<usize>();
    let entries = parts.iter().map(|p| p.entries.len()).sum::<usize>();
    if i32::try_from(entries).is_err() {
        return Err(Error::Memory { bytes: 4 * entries });
    }
    let mut out = Ridges {
        sites: with_room(count)?,
        starts: with_room(count + 1)?,
        entries: with_room(entries)?,
        rays,
    };
    out.starts.push(0);
    for part in parts {
        let base = out.entries.len() as i32;
        out.sites.extend_from_slice(&part.sites);
        out.starts
            .extend(part.ends.iter().map(|&e| base + e as i32));
        out.entries.extend_from_slice(&part.entries);
    }
    Ok(out)
}

/// The outward direction of the face opposite corner k of tetrahedron t.
fn outward(given: Given<3, 4>, t: usize, k: usize) -> Point3 {
    let s = given.simplices[t];
    // Counterclockwise seen from outside: (0, 2, 1) for k = 3, and so on by swaps.
    let [a, b, c] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]][k].map(|i| given.point(s[i]));
    normal(a, b, c)
}

impl Walk<'_> {
    fn share(&self, from: usize) -> Result<Part> {
        let to = self.given.simplices.len().min(from + SHARE);
        let mut seen = vec![0_u8; to - from];
        let (mut part, mut turn) = (Part::default(), Turn::default());
        for t in from..to {
            for (number, &edge) in EDGES.iter().enumerate() {
                if seen[t - from] >> number & 1 == 1 || !self.around(t, edge, &mut turn)? {
                    continue;
                }
                for (&other, &(i, j)) in turn.ring.iter().zip(&turn.at) {
                    if (other as usize) < to {
                        let bit = NUMBER[usize::from(i)][usize::from(j)];
                        seen[other as usize - from] |= 1 << bit;
                    }
                }
                let [i, j, ..] = edge;
                let s = self.given.simplices[t];
                self.add_ridge([s[i], s[j]], &turn, &mut part);
            }
        }
        Ok(part)
    }

    /// Collects the tetrahedra around an edge of `t`, counterclockwise about its direction; false
    /// if one of them precedes `t`.
    fn around(&self, t: usize, [i, j, k, l]: [usize; 4], turn: &mut Turn) -> Result<bool> {
        (turn.open, turn.first, turn.last) = (false, l, k);
        turn.ring.clear();
        turn.at.clear();
        turn.ring.push(t as u32);
        turn.at.push((i as u8, j as u8));
        if !self.go(t, [i, j, k, l], turn)? {
            return Ok(false);
        }
        if !turn.open {
            return Ok(true);
        }
        // The hull was reached: the rest is in the other direction.
        let (last, forward) = (turn.last, turn.ring.len());
        if !self.go(t, [i, j, l, k], turn)? {
            return Ok(false);
        }
        (turn.first, turn.last) = (turn.last, last);
        turn.ring[forward..].reverse();
        turn.at[forward..].reverse();
        turn.ring.rotate_left(forward);
        turn.at.rotate_left(forward);
        Ok(true)
    }

    /// Walks around an edge, leaving each tetrahedron through the face opposite corner k.
    fn go(&self, t: usize, [i, j, k, l]: [usize; 4], turn: &mut Turn) -> Result<bool> {
        let s = self.given.simplices[t];
        let (a, b) = (s[i], s[j]);
        let (mut now, mut out, mut kept) = (t, k, s[l]);
        // A turn visits each tetrahedron once, so there are no more steps than tetrahedra.
        for _ in 0..=self.vertex.len() {
            let next = self.given.neighbors[now][out];
            if next < 0 {
                (turn.open, turn.last) = (true, out);
                return Ok(true);
            }
            let next = next as usize;
            if next == t {
                return Ok(true);
            }
            if next < t {
                return Ok(false);
            }
            let corner = self.given.back(now, next)?;
            let row = self.given.simplices[next];
            let place = |v: i32| row.iter().position(|&x| x == v);
            let (Some(i), Some(j), Some(o)) = (place(a), place(b), place(kept)) else {
                return Err(Error::Shape(format!(
                    "tetrahedra {now} and {next} do not share a face"
                )));
            };
            turn.ring.push(next as u32);
            turn.at.push((i as u8, j as u8));
            (now, out, kept) = (next, o, row[corner]);
        }
        Err(Error::Shape(format!(
            "the walk around an edge of tetrahedron {t} does not terminate"
        )))
    }

    /// Adds the ridge of a turn, if there is one.
    fn add_ridge(&self, sites: [i32; 2], turn: &Turn, part: &mut Part) {
        let begin = part.entries.len();
        let ends = turn.open.then(|| {
            let code = |t: u32, k: usize| 4 * t + k as u32;
            let first = code(turn.ring[0], turn.first);
            let last = code(turn.ring[turn.ring.len() - 1], turn.last);
            [first, last]
        });
        if let Some([first, _]) = ends {
            part.entries.push(!self.ray[&first]);
        }
        for &t in &turn.ring {
            let vertex = self.vertex[t as usize];
            if part.entries.len() == begin || part.entries.last() != Some(&vertex) {
                part.entries.push(vertex);
            }
        }
        let found = &part.entries[begin..];
        let there = match ends {
            Some([first, last]) => {
                part.entries.push(!self.ray[&last]);
                part.entries.len() - begin > 3 || !self.coplanar(sites, first, last)
            }
            None => {
                if found.len() > 1 && found.first() == found.last() {
                    part.entries.pop();
                }
                part.entries.len() - begin > 2
            }
        };
        if there {
            part.sites.push(sites);
            part.ends.push(part.entries.len() as u32);
        } else {
            part.entries.truncate(begin);
        }
    }

    /// Whether the two hull faces at an edge are coplanar.
    fn coplanar(&self, [a, b]: [i32; 2], first: u32, last: u32) -> bool {
        let apex = |code: u32| {
            let (t, k) = (code as usize / 4, code as usize % 4);
            let s = self.given.simplices[t];
            let third = (0..4).find(|&i| i != k && s[i] != a && s[i] != b);
            self.given.point(s[third.unwrap_or(k)])
        };
        let [p, q] = [a, b].map(|v| self.given.point(v));
        orient3d(p, q, apex(first), apex(last)).is_zero()
    }
}
