//! The convex hull in space by insertion with conflicts.
//!
//! K. L. Clarkson and P. W. Shor, "Applications of random sampling in computational geometry, II"
//! (1989): points come in random order, and each that is outside of the hull so far keeps one facet
//! that it *sees*, being strictly beyond its plane. When p comes, the facets that it sees go, and a
//! cone of new ones comes, from p to their rim. To begin with, a few dozen extreme points come alone,
//! so that what is inside of a box within their hull need not be looked at.
//!
//! # Points in the planes of facets
//!
//! No point is moved. The facets that p sees are the union of whole sides of the polytope, and so a
//! disc, whose rim is one cycle. A new triangle is never flat: were p in line with an edge of the rim,
//! then in the planes of both facets there, and would see neither. New triangles may be coplanar with
//! old ones, and vertices may come to lie in the middle of a side or an edge; `faces` takes them out.
//!
//! # Conflicts
//!
//! The points x that kept what goes get a facet of the cone, if they see one:
//!
//! - If x is outside of the new hull, it does. The facets that x sees are connected. If all that it
//!   saw goes, what it sees now is new. If not, it saw the facets g and h on either side of an edge of
//!   the rim, p seeing g alone; the plane of the new facet on that edge is a combination of those of g
//!   and h, that of h with a positive factor and that of g with one that is not negative: x is beyond.
//! - Then it sees the one in whose wedge it lies, of the wedges round the line from an inner point o
//!   to p that the edges at p bound: within its wedge, a facet's plane bounds the cone. A binary search
//!   finds the wedge. Where rounding left o on the outside, all facets of the cone are asked.
//!
//! # Bound
//!
//! O(n log n) changes of facets expected, each by a search in the logarithm of the degree of p.

use delone_predicates::{Point3, Sign, orient2d, orient3d};

use crate::error::{Error, Result};
use crate::memory::filled;
use crate::order::order_of;
use crate::watch::Watch;

/// Insertions between two looks at the watch.
const WATCH_EVERY: usize = 1024;
/// Directions along which extreme points are taken first, on a spiral over the sphere.
const DIRECTIONS: usize = 40;
/// No point, no facet.
const NONE: u32 = u32::MAX;

/// A closed surface of triangles around all points.
#[derive(Debug)]
pub struct Surface {
    /// Counter-clockwise seen from outside; none is flat.
    pub facets: Vec<Facet>,
    /// Four points that are not in one plane.
    pub first: [Point3; 4],
}

/// A triangle of the surface.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// Its vertices.
    pub corners: [u32; 3],
    /// The facet across the edge opposite each.
    pub beyond: [u32; 3],
    /// Whether it is still there.
    pub alive: bool,
}

/// The surface around finite points; nothing where they span no volume.
pub fn surface(points: &[Point3], watch: &Watch) -> Result<Option<Surface>> {
    let extreme = extreme_points(points);
    let Some(first) = first_tetrahedron(points, &extreme) else {
        return Ok(None);
    };
    let mut hull = Hull::start(points, first)?;
    for &x in &extreme {
        hull.enter(x);
    }
    for p in extreme {
        if hull.kept[p as usize] != NONE {
            hull.insert(p)?;
        }
    }
    let rest = outside_of_box(points, &hull);
    watch.check()?;
    hull.enter_all(&rest, watch)?;
    for (done, p) in rounds(points, rest)?.into_iter().enumerate() {
        if hull.kept[p as usize] != NONE {
            hull.insert(p)?;
        }
        if done % WATCH_EVERY == 0 {
            watch.check()?;
        }
    }
    Ok(Some(Surface {
        facets: living(&hull.facets),
        first: first.map(|v| points[v as usize]),
    }))
}

/// The facets that are there, numbered anew.
fn living(facets: &[Facet]) -> Vec<Facet> {
    let mut number = Vec::with_capacity(facets.len());
    let mut count = 0;
    for facet in facets {
        number.push(count);
        count += u32::from(facet.alive);
    }
    let alive = facets.iter().filter(|f| f.alive);
    let renumbered = |f: &Facet| Facet {
        beyond: f.beyond.map(|i| number[i as usize]),
        ..*f
    };
    alive.map(renumbered).collect()
}

/// The rows that are not in a box within the hull: as large as fits of those similar to the box of all.
fn outside_of_box(points: &[Point3], hull: &Hull) -> Vec<u32> {
    let rows = (0u32..).zip(points);
    let facets = || hull.facets.iter().filter(|f| f.alive);
    let holds = |p: Point3| {
        facets().all(|f| {
            let [a, b, c] = f.corners.map(|v| points[v as usize]);
            orient3d(a, b, c, p) != Sign::Positive
        })
    };
    let mut ends = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for v in facets().flat_map(|f| f.corners) {
        for k in 0..3 {
            ends[0][k] = ends[0][k].min(points[v as usize][k]);
            ends[1][k] = ends[1][k].max(points[v as usize][k]);
        }
    }
    // From the middle outwards; halves, so that no difference overflows.
    let at = |share: f64| {
        [-share, share].map(|t| {
            [0, 1, 2].map(|k| {
                let (low, high) = (ends[0][k] / 2.0, ends[1][k] / 2.0);
                (low + high) + t * (high - low)
            })
        })
    };
    let fits = |[low, high]: &[Point3; 2]| {
        (0..8).all(|i| holds([0, 1, 2].map(|k| if i >> k & 1 == 0 { low[k] } else { high[k] })))
    };
    let steps = (1..20).rev().map(|i| at(f64::from(i) / 20.0));
    let Some([low, high]) = steps.into_iter().find(fits) else {
        return rows.map(|(row, _)| row).collect();
    };
    let inside = |p: &Point3| (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]);
    rows.filter(|(_, p)| !inside(p))
        .map(|(row, _)| row)
        .collect()
}

/// Rows in random rounds, each twice as large as the one before and along a curve (N. Amenta, S.
/// Choi and G. Rote, "Incremental constructions con BRIO", 2003).
fn rounds(points: &[Point3], rows: Vec<u32>) -> Result<Vec<u32>> {
    let at: Vec<Point3> = rows.iter().map(|&row| points[row as usize]).collect();
    let order = order_of(&at, 1)?.concat();
    let mut rows: Vec<u32> = order.into_iter().map(|i| rows[i as usize]).collect();
    // Trailing zeros of a random number: 0 for one half, the last round, 1 for a quarter, ...
    rows.sort_by_key(|&row| std::cmp::Reverse(random(row).trailing_zeros()));
    Ok(rows)
}

/// The finaliser of G. Steele, D. Lea and C. Flood's "SplitMix" (2014).
fn random(v: u32) -> u64 {
    let x = (u64::from(v) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

/// The points farthest along directions all around, as far as rounding tells; any will do.
fn extreme_points(points: &[Point3]) -> Vec<u32> {
    if points.is_empty() {
        return Vec::new();
    }
    let largest = points
        .as_flattened()
        .iter()
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let golden = (3.0 - 5f64.sqrt()) * std::f64::consts::PI;
    let directions: Vec<Point3> = (0..DIRECTIONS)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / DIRECTIONS as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            [r * cos, r * sin, z]
        })
        .chain([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        .chain([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
        .collect();
    let few = (points.len() >> 6).clamp(12, directions.len());
    let directions = &directions[directions.len() - few..];
    let mut most = vec![(f64::NEG_INFINITY, 0u32); few];
    for (row, p) in (0u32..).zip(points) {
        // Products of doubles near the largest must not overflow, all of them to one infinity.
        let p = if largest > 1e300 {
            p.map(|x| x / 8.0)
        } else {
            *p
        };
        for (d, best) in directions.iter().zip(&mut most) {
            let along = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
            if along > best.0 {
                *best = (along, row);
            }
        }
    }
    let mut rows: Vec<u32> = most.into_iter().map(|(_, row)| row).collect();
    rows.sort_unstable();
    rows.dedup();
    rows
}

/// Four points that are not in one plane, positively oriented; of the extreme ones where those do.
fn first_tetrahedron(points: &[Point3], extreme: &[u32]) -> Option<[u32; 4]> {
    let rows = || {
        let all = (0u32..).zip(points).map(|(i, _)| i);
        extreme.iter().copied().chain(all)
    };
    let at = |v: u32| points[v as usize];
    let a = rows().next()?;
    let b = rows().find(|&b| at(b) != at(a))?;
    let c = rows().find(|&c| !in_line(at(a), at(b), at(c)))?;
    let side = |d: u32| orient3d(at(a), at(b), at(c), at(d));
    let d = rows().find(|&d| side(d) != Sign::Zero)?;
    Some(match side(d) {
        Sign::Positive => [a, b, c, d],
        _ => [a, c, b, d],
    })
}

/// Whether three points lie on one line: all projections do.
pub fn in_line(a: Point3, b: Point3, c: Point3) -> bool {
    [(0, 1), (1, 2), (2, 0)]
        .iter()
        .all(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]) == Sign::Zero)
}

/// The hull so far, and where the other points see it.
struct Hull<'a> {
    points: &'a [Point3],
    facets: Vec<Facet>,
    /// For each point a facet that it sees, or none, and the next point that keeps the same.
    kept: Vec<u32>,
    next: Vec<u32>,
    /// For each facet the first point that keeps it.
    kept_by: Vec<u32>,
    /// Facets that may be used again.
    free: Vec<u32>,
    /// For each vertex of the rim the new facet whose edge begins there.
    spoke: Vec<u32>,
    /// An inner point, unless rounding left it outside.
    inner: Option<Point3>,
    seen: Vec<u32>,
    rim: Vec<(u32, u32, u32)>,
    cone: Vec<(u32, u32)>,
    moved: Vec<u32>,
}

impl<'a> Hull<'a> {
    fn start(points: &'a [Point3], [a, b, c, d]: [u32; 4]) -> Result<Self> {
        let n = points.len();
        let at = |v: u32| points[v as usize];
        // Opposite a, b, c and d, counter-clockwise seen from outside.
        let corners = [[b, c, d], [a, d, c], [a, b, d], [a, c, b]];
        let beyond = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        let facets = [0, 1, 2, 3].map(|i| Facet {
            corners: corners[i],
            beyond: beyond[i],
            alive: true,
        });
        let inner = [0, 1, 2].map(|k| [a, b, c, d].iter().map(|&v| at(v)[k] / 4.0).sum());
        let is_inner = corners
            .iter()
            .all(|&[u, v, w]| orient3d(at(u), at(v), at(w), inner) == Sign::Negative);
        Ok(Self {
            points,
            facets: facets.to_vec(),
            kept: filled(n, NONE)?,
            next: filled(n, NONE)?,
            kept_by: vec![NONE; 4],
            free: Vec::new(),
            spoke: filled(n, NONE)?,
            inner: is_inner.then_some(inner),
            seen: Vec::new(),
            rim: Vec::new(),
            cone: Vec::new(),
            moved: Vec::new(),
        })
    }

    /// Gives a point a facet that it sees, if there is one, of all.
    fn enter(&mut self, x: u32) {
        let facets = 0..self.facets.len() as u32;
        let seen = facets
            .into_iter()
            .find(|&f| self.facets[f as usize].alive && self.sees(x, f));
        if let Some(facet) = seen {
            self.keep(x, facet);
        }
    }

    /// The same for many points.
    fn enter_all(&mut self, rows: &[u32], watch: &Watch) -> Result<()> {
        for (i, &x) in rows.iter().enumerate() {
            if i % (1 << 16) == 0 {
                watch.check()?;
            }
            self.enter(x);
        }
        Ok(())
    }

    fn at(&self, v: u32) -> Point3 {
        self.points[v as usize]
    }

    /// Whether `p` is strictly beyond the plane of a facet.
    #[inline]
    fn sees(&self, p: u32, facet: u32) -> bool {
        let [a, b, c] = self.facets[facet as usize].corners.map(|v| self.at(v));
        orient3d(a, b, c, self.at(p)) == Sign::Positive
    }

    fn keep(&mut self, x: u32, facet: u32) {
        self.kept[x as usize] = facet;
        let list = &mut self.kept_by[facet as usize];
        self.next[x as usize] = std::mem::replace(list, x);
    }

    /// Puts `p`, which is outside, into the hull.
    fn insert(&mut self, p: u32) -> Result<()> {
        self.look(p);
        self.moved.clear();
        for i in 0..self.seen.len() {
            let list = &mut self.kept_by[self.seen[i] as usize];
            let mut x = std::mem::replace(list, NONE);
            while x != NONE {
                if x != p {
                    self.moved.push(x);
                }
                x = self.next[x as usize];
            }
        }
        self.kept[p as usize] = NONE;
        self.raise_cone(p)?;
        self.redistribute(p);
        Ok(())
    }

    /// Finds the facets that `p` sees, which go, and the edges of their rim with what is beyond.
    fn look(&mut self, p: u32) {
        self.seen.clear();
        self.rim.clear();
        let seed = self.kept[p as usize];
        self.facets[seed as usize].alive = false;
        self.seen.push(seed);
        let mut i = 0;
        while i < self.seen.len() {
            let Facet {
                corners, beyond, ..
            } = self.facets[self.seen[i] as usize];
            for k in 0..3 {
                let facet = beyond[k];
                if !self.facets[facet as usize].alive {
                    continue;
                }
                if self.sees(p, facet) {
                    self.facets[facet as usize].alive = false;
                    self.seen.push(facet);
                } else {
                    self.rim
                        .push((corners[(k + 1) % 3], corners[(k + 2) % 3], facet));
                }
            }
            i += 1;
        }
    }

    /// Joins `p` to the rim.
    fn raise_cone(&mut self, p: u32) -> Result<()> {
        self.free.append(&mut self.seen);
        self.cone.clear();
        for i in 0..self.rim.len() {
            let (u, v, beyond) = self.rim[i];
            let facet = self.fresh();
            self.facets[facet as usize] = Facet {
                corners: [p, u, v],
                beyond: [beyond, NONE, NONE],
                alive: true,
            };
            let there = &mut self.facets[beyond as usize];
            let k = there.corners.iter().position(|&c| c != u && c != v);
            there.beyond[k.unwrap_or(0)] = facet;
            self.spoke[u as usize] = facet;
        }
        // Once round, from edge to edge.
        let (start, ..) = self.rim[0];
        let mut u = start;
        loop {
            let facet = self.spoke[u as usize];
            self.cone.push((u, facet));
            let v = self.facets[facet as usize].corners[2];
            let after = self.spoke[v as usize];
            if self.cone.len() > self.rim.len() || after == NONE {
                return Err(Error::Internal("the rim of a cone is no cycle".into()));
            }
            self.facets[facet as usize].beyond[1] = after;
            self.facets[after as usize].beyond[2] = facet;
            u = v;
            if u == start {
                break;
            }
        }
        if self.cone.len() != self.rim.len() {
            return Err(Error::Internal("the rim of a cone is no cycle".into()));
        }
        Ok(())
    }

    fn fresh(&mut self) -> u32 {
        if let Some(facet) = self.free.pop() {
            return facet;
        }
        let dead = Facet {
            corners: [NONE; 3],
            beyond: [NONE; 3],
            alive: false,
        };
        self.facets.push(dead);
        self.kept_by.push(NONE);
        self.facets.len() as u32 - 1
    }

    /// Gives each moved point a facet of the cone that it sees, if there is one.
    fn redistribute(&mut self, p: u32) {
        let moved = std::mem::take(&mut self.moved);
        let cone = std::mem::take(&mut self.cone);
        let wedges = self.inner.map(|o| Wedges::round(self.points, o, p, &cone));
        for &x in &moved {
            let facet = match &wedges {
                Some(wedges) => {
                    let (_, facet) = cone[wedges.of(self.at(x))];
                    self.sees(x, facet).then_some(facet)
                }
                None => cone.iter().map(|s| s.1).find(|&f| self.sees(x, f)),
            };
            match facet {
                Some(facet) => self.keep(x, facet),
                None => self.kept[x as usize] = NONE,
            }
        }
        (self.cone, self.moved) = (cone, moved);
    }
}

/// The wedges round the line from an inner point to the apex of a cone.
struct Wedges<'a> {
    points: &'a [Point3],
    o: Point3,
    p: Point3,
    cone: &'a [(u32, u32)],
    /// The first spoke that is a half turn or more from the first one.
    half: usize,
}

impl<'a> Wedges<'a> {
    fn round(points: &'a [Point3], o: Point3, p: u32, cone: &'a [(u32, u32)]) -> Self {
        let mut wedges = Self {
            points,
            o,
            p: points[p as usize],
            cone,
            half: cone.len(),
        };
        let first = points[cone[0].0 as usize];
        let within =
            |s: &(u32, u32)| orient3d(o, wedges.p, first, points[s.0 as usize]) == Sign::Positive;
        wedges.half = 1 + cone[1..].partition_point(within);
        wedges
    }

    /// Whether `x` is at a spoke or past it, by less than a half turn.
    fn passed(&self, spoke: usize, x: Point3) -> bool {
        let u = self.points[self.cone[spoke].0 as usize];
        orient3d(self.o, self.p, u, x) != Sign::Negative
    }

    /// The last spoke before the half plane of `x`, or in it.
    fn of(&self, x: Point3) -> usize {
        let past = |range: std::ops::Range<usize>| {
            let (mut low, mut high) = (range.start, range.end);
            while low < high {
                let middle = (low + high) / 2;
                if self.passed(middle, x) {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            low
        };
        if self.passed(0, x) {
            past(1..self.half) - 1
        } else {
            past(self.half..self.cone.len()) - 1
        }
    }
}
