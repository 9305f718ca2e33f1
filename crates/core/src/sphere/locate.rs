//! Location on a triangulation in arrays: the triangle that contains a direction, and the nearest
//! vertex.
//!
//! Both are exact and independent of the other queries; the answer is -1 where a query has no
//! direction. A walk by exact signs (see `walk`) leads from query to query along a curve. On the
//! boundary of triangles the one with the smallest number counts.
//!
//! The nearest vertex maximizes a linear function over the directions. From a vertex, the walk goes
//! to the best of its neighbors as long as that is better, as the simplex method does. It ends at
//! the maximum over the convex hull of the directions and the center. If the hull of the directions
//! alone does not contain the center, the center may be the maximum, and then the vertices of the
//! boundary are compared, too. If the maximum with the center is zero, some vertex of the boundary
//! is the nearest: were it another one, all facets at it would be triangles, whose normals have
//! positive products with it; so would a combination of these, such as the query.

use delone_predicates::sphere::{Unit, nearer_of, orient_of};
use delone_predicates::{Point3, Sign};

use super::directions::{check, units};
use super::kernel::{cross, dot, turn_bound};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::order::{order_of, sort_by};

/// Units of work between two checks for interruption; a step of a walk counts as one.
const WATCH_EVERY: usize = 1 << 12;
/// The number of steps of a walk after which edges are tried in random order.
const TURNS: usize = 1 << 10;
/// A bound on the total error of two rounded products of rounded directions, each of 5 units of
/// rounding.
const MARGIN: f64 = 1e-14;

/// Vectors with their directions.
struct Rays {
    vectors: Vec<Point3>,
    heads: Vec<Point3>,
    tails: Vec<Point3>,
}

impl Rays {
    fn of(vectors: Vec<Point3>, workers: usize, watch: &Watch) -> Result<Self> {
        let (heads, tails) = units(&vectors, workers, watch)?;
        Ok(Self {
            vectors,
            heads,
            tails,
        })
    }

    #[inline]
    fn at(&self, i: usize) -> (Point3, Unit) {
        let unit = Unit {
            hi: self.heads[i],
            lo: self.tails[i],
        };
        (self.vectors[i], unit)
    }
}

/// A triangulation of directions, kept for queries.
pub struct Index {
    rays: Rays,
    arrays: Arrays<3>,
    /// The vertices of the boundary, ascending.
    rim: Vec<At>,
}

/// A vertex, and a triangle with it as a corner.
#[derive(Clone, Copy)]
struct At {
    vertex: u32,
    triangle: usize,
}

impl Index {
    /// The index of a Delaunay triangulation, whose arrays must agree with each other.
    pub fn new(
        vectors: Vec<Point3>,
        arrays: Arrays<3>,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        check(&vectors)?;
        let rays = Rays::of(vectors, workers, watch)?;
        let mut rim = Vec::new();
        for (triangle, beside) in arrays.neighbors.iter().enumerate() {
            for k in (0..3).filter(|&k| beside[k] < 0) {
                let vertex = arrays.simplices[triangle][(k + 1) % 3] as u32;
                push(&mut rim, At { vertex, triangle })?;
            }
        }
        sort_by(&mut rim, watch, |a, b| a.vertex.cmp(&b.vertex))?;
        Ok(Self { rays, arrays, rim })
    }

    /// The triangles.
    pub fn arrays(&self) -> &Arrays<3> {
        &self.arrays
    }

    /// The vector of a vertex, and its direction.
    #[inline]
    pub fn ray(&self, vertex: u32) -> (Point3, Unit) {
        self.rays.at(vertex as usize)
    }

    /// For each query the first triangle that contains it, or -1.
    pub fn find(&self, queries: Vec<Point3>, workers: usize, watch: &Watch) -> Result<Vec<i32>> {
        self.each(queries, workers, watch, |queries, i, start, pace| {
            let (t, inside) = self.walk(queries.at(i), start, pace)?;
            let first = if inside {
                self.first(queries.at(i), t, pace)? as i32
            } else {
                -1
            };
            Ok((first, t))
        })
    }

    /// For each query the nearest vertex; of several the one with the smallest row.
    pub fn nearest(&self, queries: Vec<Point3>, workers: usize, watch: &Watch) -> Result<Vec<i32>> {
        self.each(queries, workers, watch, |queries, i, start, pace| {
            let q = queries.at(i);
            let (t, inside) = self.walk(q, start, pace)?;
            let mut best = self.climb(q, self.corner(t, 0), pace)?;
            if !inside && self.product(&q.1, best.vertex) < MARGIN {
                best = self.along_rim(q, best, pace)?;
                best = self.climb(q, best, pace)?;
            }
            Ok((self.smallest(q, best, pace)? as i32, t))
        })
    }

    /// Answers queries along a curve; each answer comes with the triangle to start from for the
    /// next.
    fn each(
        &self,
        queries: Vec<Point3>,
        workers: usize,
        watch: &Watch,
        answer: impl Fn(&Rays, usize, usize, &mut Pace) -> Result<(i32, usize)> + Sync,
    ) -> Result<Vec<i32>> {
        let queries = Rays::of(queries, workers, watch)?;
        let parts = order_of(&queries.heads, workers, watch)?;
        let answers = parallel::map_watched(workers, parts, watch, |part| {
            let mut pace = Pace::new(watch, WATCH_EVERY);
            let mut found = with_room(part.len())?;
            let mut start = part.first().map_or(0, |&i| self.start(&queries, i));
            for i in part {
                let (one, next) = answer(&queries, i as usize, start, &mut pace)?;
                found.push((i, one));
                start = next;
            }
            Ok(found)
        })?;
        let mut all = filled(queries.vectors.len(), -1)?;
        for (i, one) in answers.into_iter().flatten() {
            all[i as usize] = one;
        }
        Ok(all)
    }

    /// A triangle near a query: the nearest of a few.
    fn start(&self, queries: &Rays, i: u32) -> usize {
        let q = queries.heads[i as usize];
        let count = self.arrays.simplices.len();
        let step = (count as f64).powf(2.0 / 3.0) as usize + 1;
        let product = |t: usize| {
            let v = self.rays.heads[self.arrays.simplices[t][0] as usize];
            v[0] * q[0] + v[1] * q[1] + v[2] * q[2]
        };
        (0..count)
            .step_by(step)
            .max_by(|&s, &t| product(s).total_cmp(&product(t)))
            .unwrap_or(0)
    }

    /// On which side of the edge opposite a corner of a triangle the query lies; positive inside.
    #[inline]
    fn side(&self, (q, unit): &(Point3, Unit), t: usize, k: usize) -> Sign {
        let corners = self.arrays.simplices[t];
        let (a, b) = (
            self.rays.at(corners[(k + 1) % 3] as usize),
            self.rays.at(corners[(k + 2) % 3] as usize),
        );
        orient_of([a.0, b.0, *q], [&a.1, &b.1, unit])
    }

    /// The same for all three edges, where the rounded directions prove it; see `kernel` for the
    /// bound.
    #[inline]
    fn sides(&self, query: &Unit, t: usize) -> [Option<Sign>; 3] {
        let q = query.hi;
        let [a, b, c] = self.arrays.simplices[t].map(|v| {
            let p = self.rays.heads[v as usize];
            let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            (d, d[0].abs() + d[1].abs() + d[2].abs())
        });
        [[b, c], [c, a], [a, b]].map(|[(p, s), (r, w)]| {
            let turn = dot(cross(p, r), q);
            (turn.abs() > turn_bound(s, w)).then(|| Sign::of(turn))
        })
    }

    /// The triangle that contains a query, or the one from which the walk left the hull.
    ///
    /// In a Delaunay triangulation no triangle is met twice. Around constrained edges a walk may
    /// cycle: a long one tries edges in random order, which ends (O. Devillers, S. Pion and M.
    /// Teillaud, "Walking in a triangulation", 2002), and one that is much too long gives way to a
    /// search.
    fn walk(&self, q: (Point3, Unit), from: usize, pace: &mut Pace) -> Result<(usize, bool)> {
        let (mut t, mut dice) = (from, 1_u32);
        let count = self.arrays.simplices.len();
        for step in 0..count + TURNS {
            pace.spend(1)?;
            if step > TURNS {
                dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            }
            let first = (dice >> 16) as usize;
            let sides = self.sides(&q.1, t);
            let is_beyond = |k: usize| {
                let sign = sides[k].unwrap_or_else(|| self.side(&q, t, k));
                sign == Sign::Negative
            };
            let mut corners = (first..first + 3).map(|k| k % 3);
            let Some(k) = corners.find(|&k| is_beyond(k)) else {
                return Ok((t, true));
            };
            match usize::try_from(self.arrays.neighbors[t][k]) {
                Ok(beside) => t = beside,
                Err(_) => return Ok((t, false)),
            }
        }
        for t in 0..count {
            pace.spend(1)?;
            if (0..3).all(|k| self.side(&q, t, k) != Sign::Negative) {
                return Ok((t, true));
            }
        }
        // The hull is convex: where the query is in no triangle, each walk leaves it.
        Err(Error::Internal("a walk on the sphere does not end".into()))
    }

    /// The smallest of the triangles that contain a query, of which one is given.
    fn first(&self, q: (Point3, Unit), t: usize, pace: &mut Pace) -> Result<usize> {
        let sides = self.sides(&q.1, t);
        if sides.iter().all(Option::is_some) {
            return Ok(t);
        }
        let on: Vec<usize> = (0..3).filter(|&k| self.side(&q, t, k).is_zero()).collect();
        match on[..] {
            [] => Ok(t),
            [k] => {
                Ok(usize::try_from(self.arrays.neighbors[t][k]).map_or(t, |beside| beside.min(t)))
            }
            // On two edges: the query is the corner that is opposite neither.
            [i, j, ..] => {
                let mut first = t;
                self.around(self.corner(t, 3 - i - j), pace, |at, _| {
                    first = first.min(at);
                })?;
                Ok(first)
            }
        }
    }

    fn corner(&self, triangle: usize, k: usize) -> At {
        At {
            vertex: self.arrays.simplices[triangle][k] as u32,
            triangle,
        }
    }

    /// Visits the triangles at a vertex, each with the next vertex counterclockwise, and at the
    /// boundary the last vertex as well.
    fn around(&self, at: At, pace: &mut Pace, mut visit: impl FnMut(usize, u32)) -> Result<()> {
        let place = |t: usize| {
            let corners = self.arrays.simplices[t];
            corners
                .iter()
                .position(|&v| v as u32 == at.vertex)
                .unwrap_or(0)
        };
        // Clockwise to the boundary, or once around.
        let mut t = at.triangle;
        loop {
            pace.spend(1)?;
            match usize::try_from(self.arrays.neighbors[t][(place(t) + 2) % 3]) {
                Ok(beside) if beside != at.triangle => t = beside,
                _ => break,
            }
        }
        let first = t;
        loop {
            pace.spend(1)?;
            let k = place(t);
            visit(t, self.arrays.simplices[t][(k + 1) % 3] as u32);
            match usize::try_from(self.arrays.neighbors[t][(k + 1) % 3]) {
                Ok(beside) if beside != first => t = beside,
                Ok(_) => return Ok(()),
                Err(_) => {
                    visit(t, self.arrays.simplices[t][(k + 2) % 3] as u32);
                    return Ok(());
                }
            }
        }
    }

    #[inline]
    fn nearer(&self, q: (Point3, Unit), a: u32, b: u32) -> Sign {
        let (a, b) = (self.rays.at(a as usize), self.rays.at(b as usize));
        nearer_of([q.0, a.0, b.0], [&q.1, &a.1, &b.1])
    }

    /// The cosine of the angle to a vertex, rounded.
    #[inline]
    fn product(&self, q: &Unit, v: u32) -> f64 {
        let v = self.rays.heads[v as usize];
        v[0] * q.hi[0] + v[1] * q.hi[1] + v[2] * q.hi[2]
    }

    /// The nearest of a vertex and those of the boundary; of several the smallest.
    fn along_rim(&self, q: (Point3, Unit), from: At, pace: &mut Pace) -> Result<At> {
        let mut best = from;
        let mut most = self.product(&q.1, from.vertex);
        for &at in &self.rim {
            pace.spend(1)?;
            let product = self.product(&q.1, at.vertex);
            if product < most - MARGIN {
                continue;
            }
            let order = self.nearer(q, at.vertex, best.vertex);
            if order == Sign::Positive || order == Sign::Zero && at.vertex < best.vertex {
                (best, most) = (at, product);
            }
        }
        Ok(best)
    }

    /// Goes to better neighbors while there are any; each is closer than the previous one.
    fn climb(&self, q: (Point3, Unit), from: At, pace: &mut Pace) -> Result<At> {
        let mut best = from;
        loop {
            let here = best;
            self.around(here, pace, |triangle, vertex| {
                if self.nearer(q, vertex, best.vertex) == Sign::Positive {
                    best = At { vertex, triangle };
                }
            })?;
            if best.vertex == here.vertex {
                return Ok(best);
            }
        }
    }

    /// The smallest of the vertices that are as near as the nearest one: these are connected, as
    /// they are the corners of a facet.
    fn smallest(&self, q: (Point3, Unit), best: At, pace: &mut Pace) -> Result<u32> {
        let mut equal: Vec<At> = vec![best];
        let mut next = 0;
        while let Some(&here) = equal.get(next) {
            next += 1;
            let mut found = Vec::new();
            self.around(here, pace, |triangle, vertex| {
                if self.nearer(q, vertex, best.vertex).is_zero() {
                    found.push(At { vertex, triangle });
                }
            })?;
            for at in found {
                if equal.iter().all(|other| other.vertex != at.vertex) {
                    push(&mut equal, at)?;
                }
            }
        }
        Ok(equal
            .iter()
            .map(|at| at.vertex)
            .min()
            .unwrap_or(best.vertex))
    }
}
