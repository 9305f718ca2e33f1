//! Common parts of pairs of triangles, within the tolerance: vertices on edges and faces, and
//! points where edges cross edges and faces.

use delone_predicates::{Point3, lexicographic};

use super::near::{EDGES, Spot, apart, crossing, inside_edge, piercing, spot, square};
use super::work::{Edges, LOT, Work, around, tree_of};
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::order::{sort, sort_by};
use crate::solids::surface::meeting::meeting;
use crate::solids::surface::{NONE, Triangle};

/// What a point is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum On {
    /// Inside an edge.
    Edge(u32),
    /// In the interior of a face.
    Face(u32),
}

/// A point that is not yet a vertex, and one thing that it is on.
#[derive(Debug, Clone, Copy)]
pub struct Met {
    /// The point.
    pub at: Point3,
    /// What it is on.
    pub on: On,
}

/// All events.
#[derive(Debug, Default)]
pub struct Events {
    /// Which vertices are on what, ascending.
    pub on: Vec<(On, u32)>,
    /// Points that are not yet vertices.
    met: Vec<Met>,
    /// The pairs of faces with events, ascending.
    pub pairs: Vec<[u32; 2]>,
}

impl Events {
    /// The events of all pairs of triangles, and of each with itself.
    pub fn of(
        work: &mut Work,
        edges: &Edges,
        tolerance: f64,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        let mut ids = with_room(work.faces.len())?;
        ids.extend(work.faces.iter().map(|f| f.ids));
        let kept: Vec<u32> = (0..ids.len() as u32).collect();
        let parts = meeting(
            &work.at,
            &ids,
            &kept,
            tolerance,
            workers,
            watch,
            |rows, [a, b], found: &mut Self| {
                let count = found.on.len() + found.met.len();
                found.add(rows, [a, b], edges, tolerance)?;
                if found.on.len() + found.met.len() > count {
                    push(
                        &mut found.pairs,
                        [rows[0].min(rows[1]), rows[0].max(rows[1])],
                    )?;
                }
                Ok(())
            },
        )?;
        let mut all = Self::default();
        for part in parts {
            all.on.extend(part.on);
            all.met.extend(part.met);
            all.pairs.extend(part.pairs);
        }
        all.add_thin(work, edges, tolerance)?;
        all.name(work, edges, tolerance, watch)?;
        sort(&mut all.pairs, watch)?;
        all.pairs.dedup();
        Ok(all)
    }

    /// Adds the events of a pair.
    fn add(
        &mut self,
        rows: [u32; 2],
        triangles: [&Triangle; 2],
        edges: &Edges,
        tolerance: f64,
    ) -> Result<()> {
        let shared = [0, 1].map(|own| {
            let (a, b) = (triangles[own], triangles[1 - own]);
            a.ids.map(|v| b.ids.contains(&v))
        });
        if apart(triangles[0].at, triangles[1].at, shared, tolerance) {
            return Ok(());
        }
        let mut spots = [[Spot::default(); 3]; 2];
        for (own, other) in [(0, 1), (1, 0)] {
            let (a, b) = (triangles[own], triangles[other]);
            let row = rows[other];
            for i in 0..3 {
                spots[own][i] = if shared[own][i] {
                    Spot {
                        corner: true,
                        ..Spot::default()
                    }
                } else {
                    spot(a.at[i], b.at, tolerance)
                };
                let found = spots[own][i];
                for k in (0..3).filter(|&k| found.edges[k]) {
                    push(
                        &mut self.on,
                        (On::Edge(edges.of[row as usize][k]), a.ids[i]),
                    )?;
                }
                if found.inside {
                    push(&mut self.on, (On::Face(row), a.ids[i]))?;
                }
            }
        }
        self.add_edges(rows, triangles, spots, edges, tolerance)?;
        for (own, other) in [(0, 1), (1, 0)] {
            let (a, b) = (triangles[own], triangles[other]);
            for (k, (i, j)) in EDGES.into_iter().enumerate() {
                if spots[own][i].is_on() || spots[own][j].is_on() {
                    continue;
                }
                // Near an edge of the triangle, it crosses that edge.
                let (i, j) = (i.min(j), i.max(j));
                let ends = [a.at[i], a.at[j]];
                let by_edge = EDGES
                    .into_iter()
                    .any(|(x, y)| crossing(ends, [b.at[x], b.at[y]], tolerance).is_some());
                if by_edge {
                    continue;
                }
                if let Some(at) = piercing(ends, b.at) {
                    let on = [
                        On::Edge(edges.of[rows[own] as usize][k]),
                        On::Face(rows[other]),
                    ];
                    for on in on {
                        push(&mut self.met, Met { at, on })?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds the points where edges of a pair cross.
    fn add_edges(
        &mut self,
        rows: [u32; 2],
        [a, b]: [&Triangle; 2],
        spots: [[Spot; 3]; 2],
        edges: &Edges,
        tolerance: f64,
    ) -> Result<()> {
        for (k, (i, j)) in EDGES.into_iter().enumerate() {
            for (l, (x, y)) in EDGES.into_iter().enumerate() {
                let [e, f] = [edges.of[rows[0] as usize][k], edges.of[rows[1] as usize][l]];
                // Edges that have a vertex in common, or one of them on the other, do not cross elsewhere.
                let [[p, q], [r, s]] = [edges.ends[e as usize], edges.ends[f as usize]];
                let meets = p == r || p == s || q == r || q == s;
                let touches = spots[0][i].edges[l]
                    || spots[0][j].edges[l]
                    || spots[1][x].edges[k]
                    || spots[1][y].edges[k];
                if meets || touches {
                    continue;
                }
                // The order of the ends, and of the edges, is that of their numbers.
                let mut both = [
                    (e, [a.at[i.min(j)], a.at[i.max(j)]]),
                    (f, [b.at[x.min(y)], b.at[x.max(y)]]),
                ];
                both.sort_unstable_by_key(|one| one.0);
                if let Some(at) = crossing(both[0].1, both[1].1, tolerance) {
                    for on in [On::Edge(e), On::Edge(f)] {
                        push(&mut self.met, Met { at, on })?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds corners that are on the opposite edges of their own triangles.
    fn add_thin(&mut self, work: &Work, edges: &Edges, tolerance: f64) -> Result<()> {
        for (face, of) in work.faces.iter().zip(&edges.of) {
            let at = face.ids.map(|v| work.at[v as usize]);
            for (k, (i, j)) in EDGES.into_iter().enumerate() {
                let opposite = 3 - i - j;
                if inside_edge(at[opposite], at[i], at[j], tolerance).is_some() {
                    push(&mut self.on, (On::Edge(of[k]), face.ids[opposite]))?;
                }
            }
        }
        Ok(())
    }

    /// Adds points that are not yet vertices.
    pub fn extend(&mut self, met: impl IntoIterator<Item = Met>) -> Result<()> {
        for one in met {
            push(&mut self.met, one)?;
        }
        Ok(())
    }

    /// Makes the points vertices: those within the tolerance of a vertex are that vertex, and those
    /// within the tolerance of each other are one new vertex, the first of them.
    pub fn name(
        &mut self,
        work: &mut Work,
        edges: &Edges,
        tolerance: f64,
        watch: &Watch,
    ) -> Result<()> {
        let mut met = std::mem::take(&mut self.met);
        sort_by(&mut met, watch, |a, b| {
            lexicographic(a.at, b.at).then(a.on.cmp(&b.on))
        })?;
        met.dedup_by(|a, b| a.at == b.at && a.on == b.on);
        let mut distinct: Vec<Point3> = with_room(met.len())?;
        let mut of = with_room(met.len())?;
        for one in &met {
            if distinct.last() != Some(&one.at) {
                distinct.push(one.at);
            }
            of.push(distinct.len() as u32 - 1);
        }
        let names = names(work, &distinct, tolerance, watch)?;
        for (one, &place) in met.iter().zip(&of) {
            push(&mut self.on, (one.on, names[place as usize]))?;
        }
        // Ends of edges and corners of faces are not inside them.
        self.on.retain(|&(on, v)| match on {
            On::Edge(e) => !edges.ends[e as usize].contains(&v),
            On::Face(f) => !work.faces[f as usize].ids.contains(&v),
        });
        sort(&mut self.on, watch)?;
        self.on.dedup();
        Ok(())
    }
}

/// The vertex of each of these points, which are distinct and sorted.
fn names(work: &mut Work, distinct: &[Point3], tolerance: f64, watch: &Watch) -> Result<Vec<u32>> {
    let within = tolerance * tolerance;
    let vertices = tree_of(&work.at, watch)?;
    let others = tree_of(distinct, watch)?;
    let mut sets = Sets::of(distinct.len())?;
    let mut near = with_room(distinct.len())?;
    let mut pace = Pace::new(watch, LOT);
    for (i, &p) in distinct.iter().enumerate() {
        pace.spend(1)?;
        let extent = around(p, tolerance);
        // The nearest vertex, the first of several.
        let mut best: Option<(f64, usize)> = None;
        vertices.meeting(&extent, |v| {
            let distance = square(p, work.at[v]);
            if distance <= within && best.is_none_or(|b| (distance, v) < b) {
                best = Some((distance, v));
            }
        });
        near.push(best.map(|(_, v)| v as u32));
        others.meeting(&extent, |j| {
            if j < i && square(p, distinct[j]) <= within {
                sets.join(j as u32, i as u32);
            }
        });
    }
    let mut made = with_room(distinct.len())?;
    let mut vertex_of: Vec<Option<u32>> = near.clone();
    for (i, &vertex) in (0u32..).zip(&near) {
        // A vertex of any of the points that are joined is the vertex of all.
        let root = sets.root(i) as usize;
        vertex_of[root] = vertex_of[root].or(vertex);
    }
    for (i, &vertex) in (0u32..).zip(&near) {
        let root = sets.root(i) as usize;
        let vertex = match vertex.or(vertex_of[root]) {
            Some(v) => v,
            None => {
                let v = work.at.len() as u32;
                push(&mut work.at, distinct[root])?;
                push(&mut work.row, NONE)?;
                vertex_of[root] = Some(v);
                v
            }
        };
        made.push(vertex);
    }
    Ok(made)
}
