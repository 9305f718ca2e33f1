//! The facets of the convex hull that the center does not see from inside: those across the void of
//! a hull on the sphere.
//!
//! Their vertices are those of the boundary: at a facet with outer normal n all directions x have n
//! x <= h <= 0, and a direction inside the hull is a positive combination of others whose
//! coefficients have a sum above 1, so that its product is below h. The boundary is a convex
//! polygon, which random insertion triangulates in expected linear time (L. P. Chew, "Building
//! Voronoi diagrams for convex polygons in linear expected time", 1990): vertices are removed in
//! random order and inserted again in reverse order.
//!
//! In-circle tests of directions hold for facets on either side of the center. If four directions
//! are on one great circle, no perturbation along the rays separates them; then the smallest is cut
//! off, as from circles slightly beyond.

use delone_predicates::sphere::{Unit, compare, incircle_of, tie};
use delone_predicates::{Point3, Sign};

use super::directions::units;
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// No half-edge.
const NONE: u32 = u32::MAX;
/// Units of work between two checks for interruption; an in-circle test counts as 16.
const WATCH_EVERY: usize = 1 << 12;
const TEST: usize = 16;

/// The triangles of a hull on the sphere, followed by those of its void; no edge is left open.
pub fn complete(
    vectors: &[Point3],
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    watch: &Watch,
) -> Result<Arrays<3>> {
    let mut arrays = Arrays {
        simplices: copied(simplices)?,
        neighbors: copied(neighbors)?,
    };
    let (rows, hull) = cycle(vectors.len(), simplices, neighbors)?;
    if rows.is_empty() {
        return Ok(arrays);
    }
    let mut own: Vec<Point3> = with_room(rows.len())?;
    own.extend(rows.iter().map(|&row| vectors[row as usize]));
    let (heads, tails) = units(&own, 1, watch)?;
    let mut unit: Vec<Unit> = with_room(rows.len())?;
    unit.extend(heads.into_iter().zip(tails).map(|(hi, lo)| Unit { hi, lo }));
    let mut polygon = Polygon::new(&own, &unit, watch)?;
    polygon.triangulate()?;
    let first = simplices.len() as i32;
    for (t, corners) in polygon.corners.iter().enumerate() {
        push(&mut arrays.simplices, corners.map(|v| rows[v as usize]))?;
        let beside = [0, 1, 2].map(|k| polygon.links[4 * t + k]);
        push(
            &mut arrays.neighbors,
            beside.map(|e| {
                if e == NONE {
                    -1
                } else {
                    first + (e / 4) as i32
                }
            }),
        )?;
    }
    for (v, &code) in polygon.rim.iter().enumerate() {
        let (inside, k) = (hull[v] / 4, hull[v] % 4);
        let (t, j) = (code / 4, code % 4);
        arrays.neighbors[inside as usize][k as usize] = first + t as i32;
        arrays.neighbors[first as usize + t as usize][j as usize] = inside as i32;
    }
    Ok(arrays)
}

/// The rows of the boundary, counterclockwise around the void, and the half-edge 4 t + k of the
/// hull between each and the next.
fn cycle(
    count: usize,
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
) -> Result<(Vec<i32>, Vec<u32>)> {
    let broken = || Error::Shape("the boundary of the triangles is not one cycle".into());
    let mut after = filled(count, NONE)?;
    let (mut edges, mut start) = (0, 0);
    for (t, (corners, beside)) in (0_u32..).zip(simplices.iter().zip(neighbors)) {
        for k in (0..3).filter(|&k| beside[k] < 0) {
            start = corners[(k + 2) % 3];
            let slot = &mut after[start as usize];
            if *slot != NONE {
                return Err(broken());
            }
            *slot = 4 * t + k as u32;
            edges += 1;
        }
    }
    let (mut rows, mut hull) = (with_room(edges)?, with_room(edges)?);
    let mut row = start;
    for _ in 0..edges {
        let code = after[row as usize];
        if code == NONE {
            return Err(broken());
        }
        rows.push(row);
        hull.push(code);
        row = simplices[(code / 4) as usize][(code as usize % 4 + 1) % 3];
    }
    if edges > 0 && (row != start || edges < 3) {
        return Err(broken());
    }
    Ok((rows, hull))
}

/// A convex polygon with numbered vertices, counterclockwise, and its triangles.
struct Polygon<'a> {
    vectors: &'a [Point3],
    units: &'a [Unit],
    corners: Vec<[u32; 3]>,
    /// Half-edge 4 t + k is opposite corner k of triangle t; its twin, or `NONE` on the polygon.
    links: Vec<u32>,
    /// The half-edge from each vertex along the polygon.
    rim: Vec<u32>,
    pace: Pace<'a>,
}

impl<'a> Polygon<'a> {
    fn new(vectors: &'a [Point3], units: &'a [Unit], watch: &'a Watch<'a>) -> Result<Self> {
        let n = vectors.len();
        Ok(Self {
            vectors,
            units,
            corners: with_room(n - 2)?,
            links: with_room(4 * (n - 2))?,
            rim: filled(n, NONE)?,
            pace: Pace::new(watch, WATCH_EVERY),
        })
    }

    fn triangulate(&mut self) -> Result<()> {
        let n = self.vectors.len() as u32;
        let order = shuffled(n)?;
        let (mut before, mut after) = (with_room(n as usize)?, with_room(n as usize)?);
        before.extend((0..n).map(|v| if v == 0 { n - 1 } else { v - 1 }));
        after.extend((0..n).map(|v| if v + 1 == n { 0 } else { v + 1 }));
        for &v in order[3..].iter().rev() {
            let (u, w) = (before[v as usize], after[v as usize]);
            (after[u as usize], before[w as usize]) = (w, u);
        }
        let a = order[0];
        let b = after[a as usize];
        let c = after[b as usize];
        self.add([a, b, c]);
        for (k, v) in [(2, a), (0, b), (1, c)] {
            self.rim[v as usize] = k;
        }
        let (mut stack, mut free) = (Vec::new(), Vec::new());
        for &v in &order[3..] {
            // Its neighbors on the polygon when it was removed.
            let (u, w) = (before[v as usize], after[v as usize]);
            self.insert(v, [u, w], &mut stack, &mut free)?;
        }
        Ok(())
    }

    fn add(&mut self, corners: [u32; 3]) -> u32 {
        let t = self.corners.len() as u32;
        self.corners.push(corners);
        self.links.extend([NONE; 4]);
        t
    }

    /// Inserts `p` between two adjacent vertices of the polygon so far.
    fn insert(
        &mut self,
        p: u32,
        [u, w]: [u32; 2],
        stack: &mut Vec<(u32, u32, u32)>,
        free: &mut Vec<u32>,
    ) -> Result<()> {
        // Edges x y with p to their left, and the half-edges beyond.
        push(stack, (w, u, self.rim[u as usize]))?;
        let mut last = NONE;
        while let Some((x, y, beyond)) = stack.pop() {
            self.pace.spend(TEST)?;
            if beyond != NONE {
                let (t, k) = (beyond / 4, beyond % 4);
                let apex = self.corners[t as usize][k as usize];
                if self.conflicts([y, x, apex, p]) {
                    let side = |j: u32| (4 * t + (k + j) % 3) as usize;
                    // Opposite y, which is the next corner, and opposite x.
                    push(stack, (apex, y, self.links[side(2)]))?;
                    push(stack, (x, apex, self.links[side(1)]))?;
                    push(free, t)?;
                    continue;
                }
            }
            let t = match free.pop() {
                Some(t) => {
                    self.corners[t as usize] = [p, x, y];
                    t
                }
                None => self.add([p, x, y]),
            };
            self.links[4 * t as usize] = beyond;
            if beyond == NONE {
                self.rim[x as usize] = 4 * t;
            } else {
                self.links[beyond as usize] = 4 * t;
            }
            self.links[4 * t as usize + 2] = NONE;
            if last == NONE {
                self.rim[p as usize] = 4 * t + 2;
            } else {
                self.links[4 * t as usize + 2] = 4 * last + 1;
                self.links[4 * last as usize + 1] = 4 * t + 2;
            }
            last = t;
        }
        self.links[4 * last as usize + 1] = NONE;
        self.rim[u as usize] = 4 * last + 1;
        Ok(())
    }

    /// Whether the last of four vertices, which is between the first two, is in the circle of the
    /// others, which are counterclockwise.
    fn conflicts(&self, numbers: [u32; 4]) -> bool {
        let vectors = numbers.map(|v| self.vectors[v as usize]);
        let units = numbers.map(|v| &self.units[v as usize]);
        let sign = match incircle_of(vectors, units) {
            Sign::Zero => tie(vectors),
            sign => sign,
        };
        match sign {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => {
                let [u, v, w, p] = vectors;
                let least = |a, b| if compare(a, b).is_lt() { a } else { b };
                compare(least(u, v), least(w, p)).is_lt()
            }
        }
    }
}

/// The numbers below `n` in an order that does not depend on the input.
fn shuffled(n: u32) -> Result<Vec<u32>> {
    let mut order: Vec<u32> = with_room(n as usize)?;
    order.extend(0..n);
    let mut state = 1_u64;
    for i in (1..n as usize).rev() {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        order.swap(i, ((state >> 33) % (i as u64 + 1)) as usize);
    }
    Ok(order)
}
