//! Cuts triangles at the vertices on them and at the lines that they share with others.
//!
//! A triangle becomes the constrained Delaunay triangulation, in a projection along an axis, of what is
//! on it. Its border is the chain of vertices on its edges, which all triangles at these edges share.
//! Where triangles overlap in one plane, both contain the same vertices and lines, and hence, as that
//! triangulation is canonical, the same triangles.

use delone_predicates::{Point2, Point3};

use super::events::{Events, Met, On};
use super::near::{EDGES, between, nearest, square};
use super::work::{Edges, LOT, Work};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::vector::{cross, dot, minus};
use crate::base::watch::{Pace, Watch};
use crate::constrained::{Options, constrain};
use crate::delaunay::plane::Method;
use crate::order::sort;

/// Triangles per task.
const SHARE: usize = 1 << 8;

/// A line between two vertices on a triangle, and what it belongs to.
type Line = ([u32; 2], On);

/// The triangles of a face, in the order of its orientation, or points where lines on it cross.
enum Cut {
    Parts(Vec<[u32; 3]>),
    Crossing(Vec<Met>),
    /// Its border crosses itself.
    Narrow,
}

/// The result of a round.
pub struct Parts {
    /// The triangles, each with its source.
    pub faces: Vec<([u32; 3], u32)>,
    /// Sources of faces that could not be cut, ascending.
    pub narrow: Vec<u32>,
}

/// What is on the edges and faces.
struct Net<'a> {
    work: &'a Work,
    edges: &'a Edges,
    /// The vertices inside each edge, in the order from the smaller end on: ranges of `on_edges`.
    starts: Vec<u32>,
    on_edges: Vec<u32>,
    /// `(face, vertex)`: vertices in the interior, ascending.
    on_faces: Vec<(u32, u32)>,
    tolerance: f64,
}

/// The triangles cut; points where lines cross are added to the events until `last`.
pub fn cut(
    work: &Work,
    edges: &Edges,
    events: &Events,
    tolerance: f64,
    last: bool,
    workers: usize,
    watch: &Watch,
) -> Result<std::result::Result<Parts, Vec<Met>>> {
    let net = Net::of(work, edges, events, tolerance, watch)?;
    let lines = net.lines(events, watch)?;
    // Faces in lots, each with the lines on them.
    let mut tasks = Vec::new();
    let mut rest = &lines[..];
    for first in (0..work.faces.len()).step_by(SHARE) {
        let end = (first + SHARE).min(work.faces.len());
        let (own, after) = rest.split_at(rest.partition_point(|line| (line.0 as usize) < end));
        push(&mut tasks, (first..end, own))?;
        rest = after;
    }
    let lots = parallel::map_watched(workers, tasks, watch, |(faces, mut lines)| {
        let mut made = Vec::new();
        for face in faces {
            let (own, after) =
                lines.split_at(lines.partition_point(|line| line.0 as usize == face));
            lines = after;
            let own: Vec<Line> = own.iter().map(|&(_, ends, on)| (ends, on)).collect();
            push(&mut made, net.cut(face, own, last, watch)?)?;
        }
        Ok(made)
    })?;
    let mut met = Vec::new();
    let mut parts = Parts {
        faces: with_room(work.faces.len())?,
        narrow: Vec::new(),
    };
    for (face, cut) in work.faces.iter().zip(lots.into_iter().flatten()) {
        match cut {
            Cut::Parts(all) => {
                for ids in all {
                    push(&mut parts.faces, (ids, face.source))?;
                }
            }
            Cut::Crossing(found) => met.extend(found),
            Cut::Narrow => {
                push(&mut parts.narrow, face.source)?;
                push(&mut parts.faces, (face.oriented(), face.source))?;
            }
        }
    }
    parts.narrow.dedup();
    Ok(if met.is_empty() { Ok(parts) } else { Err(met) })
}

impl<'a> Net<'a> {
    fn of(
        work: &'a Work,
        edges: &'a Edges,
        events: &Events,
        tolerance: f64,
        watch: &Watch,
    ) -> Result<Self> {
        let mut inside = Vec::new();
        let mut on_faces = Vec::new();
        for &(on, v) in &events.on {
            match on {
                On::Edge(e) => push(&mut inside, (e, v))?,
                On::Face(f) => push(&mut on_faces, (f, v))?,
            }
        }
        let mut starts = filled(edges.ends.len() + 1, 0_u32)?;
        let mut on_edges = with_room(inside.len())?;
        let mut pace = Pace::new(watch, LOT);
        let mut chain: Vec<(f64, u32)> = Vec::new();
        for same in inside.chunk_by(|a, b| a.0 == b.0) {
            pace.spend(same.len())?;
            let edge = same[0].0 as usize;
            let [p, q] = edges.ends[edge].map(|v| work.at[v as usize]);
            let along = minus(q, p);
            chain.clear();
            chain.extend(
                same.iter()
                    .map(|&(_, v)| (dot(minus(work.at[v as usize], p), along), v)),
            );
            chain.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            on_edges.extend(chain.iter().map(|c| c.1));
            starts[edge + 1] = same.len() as u32;
        }
        for edge in 0..edges.ends.len() {
            starts[edge + 1] += starts[edge];
        }
        Ok(Self {
            work,
            edges,
            starts,
            on_edges,
            on_faces,
            tolerance,
        })
    }

    fn at(&self, v: u32) -> Point3 {
        self.work.at[v as usize]
    }

    /// The vertices of an edge from the smaller end on.
    fn chain(&self, edge: u32) -> impl DoubleEndedIterator<Item = u32> + '_ {
        let [first, last] = self.edges.ends[edge as usize];
        let inside = self.starts[edge as usize] as usize..self.starts[edge as usize + 1] as usize;
        [first]
            .into_iter()
            .chain(self.on_edges[inside].iter().copied())
            .chain([last])
    }

    /// All vertices on a face, ascending.
    fn vertices(&self, face: u32) -> Vec<u32> {
        let first = self.on_faces.partition_point(|&(f, _)| f < face);
        let inside = self.on_faces[first..]
            .iter()
            .take_while(|&&(f, _)| f == face);
        let mut all: Vec<u32> = inside.map(|&(_, v)| v).collect();
        for edge in self.edges.of[face as usize] {
            all.extend(self.chain(edge));
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The lines on faces, ascending.
    fn lines(&self, events: &Events, watch: &Watch) -> Result<Vec<(u32, [u32; 2], On)>> {
        let mut made = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for &[f, g] in &events.pairs {
            let (of_f, of_g) = (self.vertices(f), self.vertices(g));
            pace.spend(of_f.len() + of_g.len())?;
            // Edges of one on the other.
            for (own, other, of_other) in [(f, g, &of_g), (g, f, &of_f)] {
                for edge in self.edges.of[own as usize] {
                    let chain: Vec<u32> = self.chain(edge).collect();
                    for pair in chain.windows(2) {
                        if pair.iter().all(|v| of_other.binary_search(v).is_ok()) {
                            push(
                                &mut made,
                                (other, ascending(pair[0], pair[1]), On::Edge(edge)),
                            )?;
                        }
                    }
                }
            }
            // The line along which both meet, where all common vertices are on one.
            let common = of_f.iter().filter(|v| of_g.binary_search(v).is_ok());
            let along = self.along_a_line(common.copied().collect());
            for pair in along.windows(2) {
                let ends = ascending(pair[0], pair[1]);
                push(&mut made, (f, ends, On::Face(g)))?;
                push(&mut made, (g, ends, On::Face(f)))?;
            }
        }
        sort(&mut made, watch)?;
        made.dedup();
        Ok(made)
    }

    /// The vertices in their order along a line; none if they are not on one.
    fn along_a_line(&self, mut all: Vec<u32>) -> Vec<u32> {
        if all.len() < 2 {
            return Vec::new();
        }
        let farthest = |from: u32| {
            let distance = |v: &u32| square(self.at(*v), self.at(from));
            let by = |u: &&u32, v: &&u32| distance(u).total_cmp(&distance(v)).then(v.cmp(u));
            all.iter().max_by(by).copied().unwrap_or(from)
        };
        let first = farthest(all[0]);
        let last = farthest(first);
        let (p, along) = (self.at(first), minus(self.at(last), self.at(first)));
        let length = dot(along, along);
        let share = |v: u32| dot(minus(self.at(v), p), along) / length;
        let far = |&v: &u32| {
            let foot = between(p, self.at(last), share(v));
            square(foot, self.at(v)) > (2.0 * self.tolerance).powi(2)
        };
        if all.iter().any(far) {
            return Vec::new();
        }
        all.sort_by(|&u, &v| share(u).total_cmp(&share(v)).then(u.cmp(&v)));
        all
    }

    /// Cuts a face.
    fn cut(&self, face: usize, lines: Vec<Line>, last: bool, watch: &Watch) -> Result<Cut> {
        let whole = self.work.faces[face].oriented();
        let ids = self.vertices(face as u32);
        let border = self.border(face);
        // A triangle with a corner on the opposite edge has no area.
        if border.is_empty() {
            return Ok(Cut::Parts(Vec::new()));
        }
        if ids.len() == 3 {
            return Ok(Cut::Parts(vec![whole]));
        }
        let own = border
            .iter()
            .map(|&(ends, edge)| (ascending(ends[0], ends[1]), On::Edge(edge)));
        let count = border.len();
        let mut all: Vec<Line> = own.collect();
        all.extend(lines);
        let flat = Flat::of(self.work.corners(face), &ids, |v| self.at(v));
        match flat.triangulated(&all, watch)? {
            Ok(made) => return Ok(Cut::Parts(flat.inside(&made, &border))),
            Err(pairs) if !last => return Ok(Cut::Crossing(self.met(face, &all, &pairs))),
            Err(_) => {}
        }
        // What still crosses is left to the next round.
        Ok(match flat.triangulated(&all[..count], watch)? {
            Ok(made) => Cut::Parts(flat.inside(&made, &border)),
            Err(_) => Cut::Narrow,
        })
    }

    /// The border of a face in the direction of its orientation, with its edges; what is passed in
    /// both directions is left out.
    fn border(&self, face: usize) -> Vec<([u32; 2], u32)> {
        let oriented = self.work.faces[face].oriented();
        let mut all: Vec<([u32; 2], u32)> = Vec::new();
        for (k, edge) in self.edges.of[face].into_iter().enumerate() {
            let (i, j) = EDGES[k];
            let ids = self.work.faces[face].ids;
            let at = oriented.iter().position(|&v| v == ids[i]).unwrap_or(0);
            let chain: Vec<u32> = self.chain(edge).collect();
            // The orientation leads from one end of the edge to the other.
            let forward = oriented[(at + 1) % 3] == ids[j];
            let from_smaller = forward == (ids[i] < ids[j]);
            all.extend(chain.windows(2).map(|pair| {
                let ends = if from_smaller {
                    [pair[0], pair[1]]
                } else {
                    [pair[1], pair[0]]
                };
                (ends, edge)
            }));
        }
        let mut sorted: Vec<[u32; 2]> = all.iter().map(|one| one.0).collect();
        sorted.sort_unstable();
        all.retain(|&([u, v], _)| sorted.binary_search(&[v, u]).is_err());
        all
    }

    /// The points where lines cross.
    fn met(&self, face: usize, lines: &[Line], pairs: &[[u32; 2]]) -> Vec<Met> {
        let mut made = Vec::new();
        for &[i, j] in pairs {
            let (first, second) = (lines[i as usize], lines[j as usize]);
            let ends = |line: Line| line.0.map(|v| self.at(v));
            let mut both = [ends(first), ends(second)];
            if first.0 > second.0 {
                both.reverse();
            }
            if let Some((x, y)) = nearest(both[0], both[1]) {
                let at = between(x, y, 0.5);
                for on in [first.1, second.1, On::Face(face as u32)] {
                    made.push(Met { at, on });
                }
            }
        }
        made
    }
}

/// A face projected along an axis.
struct Flat<'a> {
    ids: &'a [u32],
    at: Vec<Point2>,
}

impl<'a> Flat<'a> {
    /// The projection is along the first axis that is clearly not in the plane: almost always the same
    /// for all faces of one plane.
    fn of([a, b, c]: [Point3; 3], ids: &'a [u32], place: impl Fn(u32) -> Point3) -> Self {
        let normal = cross(minus(b, a), minus(c, a)).map(f64::abs);
        let most = normal.into_iter().fold(0.0, f64::max);
        let (j, k) = match normal {
            [_, _, z] if 2.0 * z >= most => (0, 1),
            [_, y, _] if 2.0 * y >= most => (2, 0),
            _ => (1, 2),
        };
        let at = ids
            .iter()
            .map(|&v| place(v))
            .map(|p| [p[j], p[k]])
            .collect();
        Self { ids, at }
    }

    /// The constrained triangulation, or pairs of lines that cross.
    fn triangulated(
        &self,
        lines: &[Line],
        watch: &Watch,
    ) -> Result<std::result::Result<Made, Vec<[u32; 2]>>> {
        let place = |v: u32| self.ids.partition_point(|&u| u < v) as u32;
        let segments: Vec<[u32; 2]> = lines.iter().map(|line| line.0.map(place)).collect();
        let options = Options {
            split: false,
            conforming: false,
            max_vertices: 0,
            method: Method::Auto,
            workers: 1,
        };
        match constrain(&self.at, &segments, options, watch) {
            Ok(made) => Ok(Ok(Made {
                triangles: made.arrays.simplices,
                neighbors: made.arrays.neighbors,
                same: made.duplicates,
            })),
            Err(Error::Crossing { pairs, .. }) => Ok(Err(pairs)),
            // Without area in the projection, it has no parts.
            Err(Error::Collinear { .. } | Error::TooFew { .. }) => Ok(Ok(Made::default())),
            Err(other) => Err(other),
        }
    }

    /// The triangles inside the border, in the direction of the border: those around which it winds.
    fn inside(&self, made: &Made, border: &[([u32; 2], u32)]) -> Vec<[u32; 3]> {
        let place = |v: u32| {
            let own = self.ids.partition_point(|&u| u < v) as i32;
            let of = made.same.iter().find(|same| same[0] as i32 == own);
            of.map_or(own, |same| same[1] as i32)
        };
        let mut directed: Vec<[i32; 2]> = border.iter().map(|one| one.0.map(place)).collect();
        directed.sort_unstable();
        let passes = |ends: [i32; 2]| {
            let from = directed.partition_point(|d| *d < ends);
            directed[from..].iter().take_while(|d| **d == ends).count() as i32
        };
        // From the outside in: across an edge of the border, the winding number changes.
        let mut winding: Vec<Option<i32>> = vec![None; made.triangles.len()];
        let mut open = Vec::new();
        for (t, beside) in made.neighbors.iter().enumerate() {
            let outer = (0..3).filter(|&k| beside[k] < 0);
            open.extend(outer.map(|k| (t, k, 0)));
        }
        while let Some((t, k, before)) = open.pop() {
            if winding[t].is_some() {
                continue;
            }
            let corner = made.triangles[t];
            let [u, v] = [corner[(k + 1) % 3], corner[(k + 2) % 3]];
            let own = before + passes([u, v]) - passes([v, u]);
            winding[t] = Some(own);
            for l in 0..3 {
                let next = made.neighbors[t][l];
                if next >= 0 && winding[next as usize].is_none() {
                    let back = made.neighbors[next as usize]
                        .iter()
                        .position(|&n| n == t as i32);
                    if let Some(back) = back {
                        open.push((next as usize, back, own));
                    }
                }
            }
        }
        let all = made.triangles.iter().zip(winding);
        all.filter_map(|(t, winding)| {
            let [a, b, c] = t.map(|v| self.ids[v as usize]);
            match winding.unwrap_or(0) {
                0 => None,
                1.. => Some([a, b, c]),
                _ => Some([a, c, b]),
            }
        })
        .collect()
    }
}

/// A triangulation of what is on a face.
#[derive(Default)]
struct Made {
    triangles: Vec<[i32; 3]>,
    neighbors: Vec<[i32; 3]>,
    /// `[row, first row of the same point]`.
    same: Vec<[u32; 2]>,
}

/// Both, the smaller first.
fn ascending(u: u32, v: u32) -> [u32; 2] {
    [u.min(v), u.max(v)]
}
