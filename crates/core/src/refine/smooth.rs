//! Smoothing: free vertices move by Lloyd's method, its Delaunay dual, or to the mean of their
//! neighbors.
//!
//! All free vertices move at once, provided that no triangle is inverted: then the triangles still
//! tile the domain, and flips make them constrained Delaunay again. Vertices of triangles that are
//! inverted, or that have become worse than the bound, move back, first by half of the step,
//! finally all the way. Each time, the step of some vertex becomes shorter, so the round ends, if
//! need be without any movement.
//!
//! After the first attempt of a round only a few vertices change, so the triangles of the previous
//! attempt are kept: only changed ones are tested, and flips begin there. If one of them is
//! inverted, the round starts again from the triangles that it began with.
//!
//! S. P. Lloyd (1982), "Least squares quantization in PCM"; L. Chen and M. Holst (2011), "Efficient mesh
//! optimization schemes based on optimal Delaunay triangulations".

use std::collections::HashSet;

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, with_room};
use crate::base::target::Target;
use crate::base::watch::{Pace, Watch};
use crate::measure;

/// Triangles, or flips, between two checks for interruption.
const LOT: usize = 1 << 14;

/// The smallest fraction of a step that a vertex takes, after three halvings.
const LEAST: f64 = 1.0 / 8.0;

/// Triangles of a domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Domain {
    /// Coordinates, finite.
    pub points: Vec<Point2>,
    /// Rows of the points, counterclockwise.
    pub simplices: Vec<[i32; 3]>,
    /// The triangle opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; 3]>,
    /// The line under the edge opposite each corner, or -1. Such edges stay.
    pub sides: Vec<[i32; 3]>,
}

/// What smoothing must keep, and how it is done.
#[derive(Debug, Clone, Copy)]
pub struct Rules<'a> {
    /// The vertices that may move: none on a fixed edge, or on one without a neighbor.
    pub free: &'a [bool],
    /// The squared cosine of the bound: vertices of triangles with a smaller angle stay, and no
    /// such triangles are created.
    pub cos2: f64,
    /// Where vertices move to.
    pub target: Target,
    /// The number of rounds.
    pub rounds: usize,
    /// The number of threads.
    pub workers: usize,
}

/// Moves free vertices for the given number of rounds, or until none moves. Triangles stay in their
/// regions: a flip joins two triangles without a line between them, and both keep their numbers.
pub fn smooth(mut mesh: Domain, rules: &Rules<'_>, watch: &Watch) -> Result<Domain> {
    let mut pace = Pace::new(watch, LOT);
    require_fit(&mesh, rules.free, &mut pace)?;
    for _ in 0..rules.rounds {
        match Round::of(&mesh, rules, watch)?.run(rules, &mut pace)? {
            Some(changed) => mesh = changed,
            None => break,
        }
    }
    Ok(mesh)
}

/// Rejects neighbors that do not name each other with the same edge and the same line, and free
/// vertices on fixed edges.
fn require_fit(mesh: &Domain, free: &[bool], pace: &mut Pace<'_>) -> Result<()> {
    for (t, sides) in mesh.neighbors.iter().enumerate() {
        pace.spend(1)?;
        for k in 0..3 {
            let [u, v] = mesh.edge(t, k);
            let stays = sides[k] < 0 || mesh.sides[t][k] >= 0;
            if stays && (free[u as usize] || free[v as usize]) {
                return Err(Error::Shape(format!(
                    "a free vertex lies on the edge {u} -> {v}, which stays"
                )));
            }
            let fits = sides[k] < 0
                || back(mesh, t, k).is_some_and(|(n, j)| {
                    mesh.edge(n, j) == [v, u] && mesh.sides[t][k] == mesh.sides[n][j]
                });
            if !fits {
                return Err(Error::Shape(format!(
                    "neighbors[{t}] = {sides:?} does not fit the triangles"
                )));
            }
        }
    }
    Ok(())
}

/// The same edge seen from the other side.
fn back(mesh: &Domain, t: usize, k: usize) -> Option<(usize, usize)> {
    let n = usize::try_from(mesh.neighbors[t][k]).ok()?;
    let j = (0..3).find(|&j| mesh.neighbors[n][j] == t as i32)?;
    Some((n, j))
}

impl Domain {
    /// The ends of the edge opposite a corner, counterclockwise.
    fn edge(&self, t: usize, k: usize) -> [i32; 2] {
        [
            self.simplices[t][(k + 1) % 3],
            self.simplices[t][(k + 2) % 3],
        ]
    }

    fn at(&self, v: i32) -> Point2 {
        self.points[v as usize]
    }

    fn is_turned(&self, t: usize) -> bool {
        let [a, b, c] = self.simplices[t].map(|v| self.at(v));
        orient2d(a, b, c) != Sign::Positive
    }

    fn is_below(&self, t: usize, cos2: f64) -> bool {
        measure::is_below(self.simplices[t].map(|v| self.at(v)), cos2)
    }

    fn copy(&self) -> Result<Self> {
        Ok(Self {
            points: copied(&self.points)?,
            simplices: copied(&self.simplices)?,
            neighbors: copied(&self.neighbors)?,
            sides: copied(&self.sides)?,
        })
    }

    /// Whether the edge must be flipped.
    fn must_flip(&self, t: usize, k: usize) -> Option<(usize, usize)> {
        if self.sides[t][k] >= 0 {
            return None;
        }
        let (n, j) = back(self, t, k)?;
        let [u, v] = self.edge(t, k).map(|v| self.at(v));
        let [p, q] = [self.simplices[t][k], self.simplices[n][j]].map(|v| self.at(v));
        (incircle_canonical(u, v, p, q) == Sign::Positive).then_some((n, j))
    }

    /// Replaces the edge between two triangles by the other diagonal:
    ///
    /// ```text
    ///        p                   p
    ///      / t \               / | \
    ///     u --- v     =>      u t|n v
    ///      \ n /               \ | /
    ///        q                   q
    /// ```
    fn flip(&mut self, (t, k): (usize, usize), (n, j): (usize, usize)) {
        let (p, [u, v]) = (self.simplices[t][k], self.edge(t, k));
        let q = self.simplices[n][j];
        let of = |mesh: &Self, t: usize, k: usize| (mesh.neighbors[t][k % 3], mesh.sides[t][k % 3]);
        let (v_to_p, p_to_u) = (of(self, t, k + 1), of(self, t, k + 2));
        let (u_to_q, q_to_v) = (of(self, n, j + 1), of(self, n, j + 2));
        self.simplices[t] = [p, u, q];
        self.neighbors[t] = [u_to_q.0, n as i32, p_to_u.0];
        self.sides[t] = [u_to_q.1, -1, p_to_u.1];
        self.simplices[n] = [q, v, p];
        self.neighbors[n] = [v_to_p.0, t as i32, q_to_v.0];
        self.sides[n] = [v_to_p.1, -1, q_to_v.1];
        // Two outer triangles have another neighbor now. The one at the edge from u to q linked to n.
        for (outer, was, is) in [(u_to_q.0, n, t), (v_to_p.0, t, n)] {
            if let Ok(outer) = usize::try_from(outer) {
                for link in &mut self.neighbors[outer] {
                    if *link == was as i32 {
                        *link = is as i32;
                        break;
                    }
                }
            }
        }
    }
}

/// One round: the mesh before it, and the present attempt.
struct Round<'a> {
    before: &'a Domain,
    /// The corners of triangles below the bound before the round, each in ascending order.
    known: HashSet<[i32; 3]>,
    target: Vec<Point2>,
    step: Vec<f64>,
    now: Domain,
    stack: Vec<(u32, u8)>,
    waiting: Vec<[bool; 3]>,
    /// Triangles that changed since they were last judged.
    touched: Vec<bool>,
}

impl<'a> Round<'a> {
    fn of(before: &'a Domain, rules: &Rules<'_>, watch: &Watch) -> Result<Self> {
        let mut free = copied(rules.free)?;
        let mut known = HashSet::new();
        let (points, simplices) = (&before.points, &before.simplices);
        let below = measure::below(points, simplices, rules.cos2, rules.workers, watch)?;
        for (corners, _) in simplices
            .iter()
            .zip(&below)
            .filter(|(_, below)| **below != 0)
        {
            known.insert(ascending(*corners));
            for &v in corners {
                free[v as usize] = false;
            }
        }
        let mut target = targets(before, rules, watch)?;
        for ((to, from), free) in target.iter_mut().zip(points).zip(&free) {
            if !free || !(0..2).all(|k| (to[k] - from[k]).is_finite()) {
                *to = *from;
            }
        }
        Ok(Self {
            before,
            known,
            target,
            step: filled(points.len(), 1.0)?,
            now: before.copy()?,
            stack: Vec::new(),
            waiting: filled(simplices.len(), [false; 3])?,
            touched: filled(simplices.len(), false)?,
        })
    }

    /// The mesh after the round; `None` if no vertex moves.
    fn run(mut self, rules: &Rules<'_>, pace: &mut Pace<'_>) -> Result<Option<Domain>> {
        let count = self.step.len();
        let mut changed = filled(count, true)?;
        let mut back = filled(count, false)?;
        // Triangles that are worse, until they are judged again.
        let mut worse: Vec<usize> = Vec::new();
        loop {
            for v in (0..count).filter(|&v| changed[v]) {
                self.now.points[v] = self.place(v);
            }
            if self.now.points == self.before.points {
                return Ok(None);
            }
            back.fill(false);
            if self.is_valid(&changed, pace)? {
                self.flips(pace)?;
                worse.iter().for_each(|&t| self.touched[t] = true);
                worse.clear();
                for t in 0..self.touched.len() {
                    if std::mem::replace(&mut self.touched[t], false) {
                        pace.spend(1)?;
                        if self.now.is_below(t, rules.cos2)
                            && !self.known.contains(&ascending(self.now.simplices[t]))
                        {
                            worse.push(t);
                        }
                    }
                }
                if worse.is_empty() {
                    return Ok(Some(self.now));
                }
                for corners in worse.iter().map(|&t| self.now.simplices[t]) {
                    corners.iter().for_each(|&v| back[v as usize] = true);
                }
                if !self.any_moves(&back) {
                    // No vertex of a worse triangle moved, but some of their neighbors did.
                    let near = copied(&back)?;
                    for corners in &self.before.simplices {
                        if corners.iter().any(|&v| near[v as usize]) {
                            corners.iter().for_each(|&v| back[v as usize] = true);
                        }
                    }
                }
            } else {
                // Start again from the triangles before the round; those that are inverted now show
                // which vertices have moved too far.
                self.begin_again()?;
                worse.clear();
                for t in 0..self.before.simplices.len() {
                    pace.spend(1)?;
                    if self.now.is_turned(t) {
                        for &v in &self.now.simplices[t] {
                            back[v as usize] = true;
                        }
                    }
                }
                // If there are none, only the flips caused the problem, so all triangles are judged
                // again.
                if !back.contains(&true) {
                    changed.fill(true);
                    continue;
                }
                changed.fill(true);
            }
            if !self.any_moves(&back) {
                return Ok(None);
            }
            let all = worse.is_empty();
            for v in 0..count {
                let moves = back[v] && self.moves(v);
                if moves {
                    let half = self.step[v] / 2.0;
                    self.step[v] = if half < LEAST { 0.0 } else { half };
                }
                changed[v] = moves || all;
            }
        }
    }

    /// Where a vertex is after its present step.
    fn place(&self, v: usize) -> Point2 {
        let (from, to, step) = (self.before.points[v], self.target[v], self.step[v]);
        [0, 1].map(|k| from[k] + step * (to[k] - from[k]))
    }

    fn moves(&self, v: usize) -> bool {
        self.now.points[v] != self.before.points[v]
    }

    fn any_moves(&self, rows: &[bool]) -> bool {
        (0..rows.len()).any(|v| rows[v] && self.moves(v))
    }

    /// Replaces the triangles of the attempt by those before the round.
    fn begin_again(&mut self) -> Result<()> {
        self.now.simplices = copied(&self.before.simplices)?;
        self.now.neighbors = copied(&self.before.neighbors)?;
        self.now.sides = copied(&self.before.sides)?;
        self.touched.fill(false);
        Ok(())
    }

    /// Marks triangles with changed corners and stacks their edges; false if one is inverted.
    fn is_valid(&mut self, changed: &[bool], pace: &mut Pace<'_>) -> Result<bool> {
        for t in 0..self.touched.len() {
            pace.spend(1)?;
            let corners = self.now.simplices[t];
            if corners.iter().any(|&v| changed[v as usize]) {
                if self.now.is_turned(t) {
                    // Nothing stays on the stack for the next attempt.
                    for (t, k) in self.stack.drain(..) {
                        self.waiting[t as usize][k as usize] = false;
                    }
                    return Ok(false);
                }
                self.touched[t] = true;
                for k in 0..3 {
                    self.push(t, k);
                }
            }
        }
        Ok(true)
    }

    fn push(&mut self, t: usize, k: usize) {
        if self.now.sides[t][k] < 0
            && self.now.neighbors[t][k] >= 0
            && !std::mem::replace(&mut self.waiting[t][k], true)
        {
            self.stack.push((t as u32, k as u8));
        }
    }

    /// Flips edges until all triangles are constrained Delaunay. Each flip lowers the surface of lifted
    /// points, or breaks a tie in the same order, so no edge comes back.
    fn flips(&mut self, pace: &mut Pace<'_>) -> Result<()> {
        while let Some((t, k)) = self.stack.pop() {
            pace.spend(1)?;
            let (t, k) = (t as usize, k as usize);
            self.waiting[t][k] = false;
            let Some((n, j)) = self.now.must_flip(t, k) else {
                continue;
            };
            // The flip moves waiting edges to other records, so all edges of both triangles are
            // enqueued again.
            self.now.flip((t, k), (n, j));
            for t in [t, n] {
                self.touched[t] = true;
                for k in 0..3 {
                    self.push(t, k);
                }
            }
        }
        Ok(())
    }
}

fn ascending(mut corners: [i32; 3]) -> [i32; 3] {
    corners.sort_unstable();
    corners
}

/// The target of each vertex; not finite where it cannot be computed.
fn targets(mesh: &Domain, rules: &Rules<'_>, watch: &Watch) -> Result<Vec<Point2>> {
    let (points, simplices) = (&mesh.points, &mesh.simplices);
    // Weighted sums of places, and weights.
    let mut sums = filled(points.len(), [0.0; 3])?;
    let mut add = |v: i32, place: Point2, weight: f64| {
        let sum = &mut sums[v as usize];
        sum[0] += weight * place[0];
        sum[1] += weight * place[1];
        sum[2] += weight;
    };
    let mut pace = Pace::new(watch, LOT);
    if rules.target == Target::Laplace {
        for corners in simplices {
            pace.spend(1)?;
            // Around a free vertex, each neighbor is the next corner of exactly one triangle.
            for k in 0..3 {
                add(corners[k], mesh.at(corners[(k + 1) % 3]), 1.0);
            }
        }
    } else {
        let centers = measure::circumcenters2(points, simplices, rules.workers, watch)?;
        let areas = measure::areas(points, simplices, rules.workers, watch)?;
        for ((corners, center), area) in simplices.iter().zip(centers).zip(areas) {
            pace.spend(1)?;
            if rules.target == Target::Odt {
                corners.iter().for_each(|&v| add(v, center, area));
                continue;
            }
            // The part of a triangle in the Voronoi cell of a corner is a signed quadrilateral: the
            // corner, two middles of edges and the circumcenter. It is the sum of two triangles with
            // signed areas and centroids.
            for k in 0..3 {
                let a = mesh.at(corners[k]);
                for (other, sign) in [(corners[(k + 1) % 3], 1.0), (corners[(k + 2) % 3], -1.0)] {
                    let b = mesh.at(other);
                    let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
                    let u = [middle[0] - a[0], middle[1] - a[1]];
                    let v = [center[0] - a[0], center[1] - a[1]];
                    let place = [0, 1].map(|i| (a[i] + middle[i] + center[i]) / 3.0);
                    add(corners[k], place, sign * (u[0] * v[1] - u[1] * v[0]));
                }
            }
        }
    }
    let mut found = with_room(points.len())?;
    found.extend(sums.iter().map(|[x, y, weight]| [x / weight, y / weight]));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delaunay::plane::{Method, triangulate};
    use crate::mesh::plane::import::adjacency;

    fn turned(simplices: &[[i32; 3]]) -> Vec<[i32; 3]> {
        let first = |t: &[i32; 3]| (0..3).min_by_key(|&k| t[k]).unwrap();
        let mut all: Vec<_> = simplices
            .iter()
            .map(|t| [0, 1, 2].map(|k| t[(first(t) + k) % 3]))
            .collect();
        all.sort_unstable();
        all
    }

    fn rules(free: &[bool]) -> Rules<'_> {
        Rules {
            free,
            cos2: 1.0,
            target: Target::Laplace,
            rounds: 1,
            workers: 1,
        }
    }

    #[test]
    fn flips_end_in_the_canonical_triangulation() {
        let n = 40;
        let points: Vec<Point2> = (0..n)
            .map(f64::from)
            .map(|x| [x, (x - 17.0) * (x - 17.0)])
            .collect();
        let right = triangulate(&points, Method::Auto, 1, &Watch::idle()).unwrap();
        for hub in 0..n {
            let fan: Vec<_> = (1..n - 1)
                .map(|k| [hub, (hub + k) % n, (hub + k + 1) % n])
                .collect();
            let before = Domain {
                neighbors: adjacency(&fan, points.len(), &Watch::idle()).unwrap(),
                sides: vec![[-1; 3]; fan.len()],
                points: points.clone(),
                simplices: fan,
            };
            let free = vec![false; points.len()];
            let watch = Watch::idle();
            let mut pace = Pace::new(&watch, LOT);
            let mut round = Round::of(&before, &rules(&free), &watch).unwrap();
            assert!(
                round
                    .is_valid(&vec![true; points.len()], &mut pace)
                    .unwrap()
            );
            round.flips(&mut pace).unwrap();
            assert_eq!(
                turned(&round.now.simplices),
                turned(&right.arrays.simplices)
            );
            require_fit(&round.now, &free, &mut pace).unwrap();
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let simplices = vec![[0, 1, 2], [0, 2, 3]];
        let right = Domain {
            neighbors: adjacency(&simplices, 4, &Watch::idle()).unwrap(),
            sides: vec![[-1; 3]; 2],
            points,
            simplices,
        };
        let smoothed =
            |mesh: &Domain, free: [bool; 4]| smooth(mesh.clone(), &rules(&free), &Watch::idle());
        assert_eq!(smoothed(&right, [false; 4]), Ok(right.clone()));
        assert!(smoothed(&right, [true, false, false, false]).is_err());
        for wrong in [
            vec![[-1, 0, -1], [-1, -1, 0]],
            vec![[-1, 1, -1], [0, -1, -1]],
        ] {
            let mesh = Domain {
                neighbors: wrong,
                ..right.clone()
            };
            assert!(smoothed(&mesh, [false; 4]).is_err());
        }
    }
}
