//! Nodes: the points where levels cross edges, numbered and rounded.
//!
//! A *place* is a vertex or a node: vertices have the numbers below `n`, nodes those from `n` on,
//! ascending along each edge. Places that were found to be at the same position are united; `find`
//! returns the representative.

use crate::base::arrays::Triangles;
use crate::base::error::{Densest, Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::sets::Sets;
use crate::base::watch::Watch;
use delone_predicates::Point2;

/// Triangles between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;

/// A triangle that levels cross, with its corners in the order of their ranks.
#[derive(Clone, Copy)]
pub struct Crossed {
    /// The corners with the lowest, middle and highest rank.
    pub corners: [usize; 3],
    /// Their ranks.
    pub ranks: [u32; 3],
    /// Whether the corners in this order are counterclockwise.
    pub even: bool,
}

/// The nodes of all levels.
pub struct Nodes<'a> {
    given: Triangles<'a>,
    /// The number of levels that each vertex is above.
    ranks: Vec<u32>,
    /// The first node of the edge opposite each corner.
    first: Vec<[u32; 3]>,
    /// The positions of vertices and nodes.
    places: Vec<Point2>,
    /// Vertices and nodes at the same position.
    sets: Sets,
    pub(super) levels: usize,
}

impl<'a> Nodes<'a> {
    /// Numbers the nodes of ascending `levels` and computes their positions. On the edges of triangles
    /// in `collapsed`, which may be empty, nodes lie at the lower ends: contours pass such a triangle
    /// at its corners, whatever its shape.
    pub fn new(
        given: Triangles<'a>,
        heights: &[f64],
        (levels, collapsed): (&[f64], &[bool]),
        limit: usize,
        watch: &Watch,
    ) -> Result<Self> {
        let mut ranks = with_room(heights.len())?;
        ranks.extend(
            heights
                .iter()
                .map(|&z| levels.partition_point(|&level| level <= z) as u32),
        );
        let mut nodes = Self {
            given,
            ranks,
            first: filled(given.simplices.len(), [0; 3])?,
            places: Vec::new(),
            sets: Sets::default(),
            levels: levels.len(),
        };
        let count = nodes.number(watch)?;
        if count > limit {
            return Err(Error::Budget {
                what: "points of contours",
                limit,
                found: count,
                densest: Densest::default(),
            });
        }
        nodes.place(heights, (levels, collapsed), count, watch)?;
        Ok(nodes)
    }

    /// Gives each edge its first number, and returns the number of nodes.
    fn number(&mut self, watch: &Watch) -> Result<usize> {
        let vertices = self.ranks.len();
        let mut count = 0;
        for t in 0..self.given.simplices.len() {
            if t.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            for k in 0..3 {
                match self.twin(t, k) {
                    Some((u, j)) if u < t => self.first[t][k] = self.first[u][j],
                    _ => {
                        // Numbers beyond the limit of u32 are never used: the count is refused.
                        self.first[t][k] = (vertices + count) as u32;
                        let [a, b] = self.ends(t, k).map(|v| self.ranks[v as usize]);
                        count += a.abs_diff(b) as usize;
                    }
                }
            }
        }
        if vertices + count > i32::MAX as usize {
            return Err(Error::Budget {
                what: "points of contours",
                limit: i32::MAX as usize - vertices,
                found: count,
                densest: Densest::default(),
            });
        }
        Ok(count)
    }

    /// Computes the positions of all places.
    fn place(
        &mut self,
        heights: &[f64],
        (levels, collapsed): (&[f64], &[bool]),
        count: usize,
        watch: &Watch,
    ) -> Result<()> {
        let vertices = self.ranks.len();
        self.places = with_room(vertices + count)?;
        self.places.extend_from_slice(self.given.points);
        self.places.resize(vertices + count, [0.0; 2]);
        self.sets = Sets::of(vertices + count)?;
        for t in 0..self.given.simplices.len() {
            if t.is_multiple_of(WATCH_EVERY) {
                watch.check()?;
            }
            for k in 0..3 {
                let twin = self.twin(t, k);
                if twin.is_some_and(|(u, _)| u < t) {
                    continue;
                }
                let is_collapsed = |t: usize| collapsed.get(t).copied().unwrap_or(false);
                let collapses = is_collapsed(t) || twin.is_some_and(|(u, _)| is_collapsed(u));
                let [low, high] = self.rising(t, k);
                let from = self.ranks[low as usize];
                for rank in from..self.ranks[high as usize] {
                    let node = self.first[t][k] + rank - from;
                    let level = levels[rank as usize];
                    if level == heights[high as usize] {
                        self.sets.join(node, high);
                        self.places[node as usize] = self.given.points[high as usize];
                    } else if collapses {
                        self.sets.join(node, low);
                        self.places[node as usize] = self.given.points[low as usize];
                    } else {
                        let [a, b] = [low, high].map(|v| v as usize);
                        let share = share(level, heights[a], heights[b]);
                        let [p, q] = [a, b].map(|v| self.given.points[v]);
                        self.places[node as usize] =
                            [between(p[0], q[0], share), between(p[1], q[1], share)];
                    }
                }
            }
        }
        Ok(())
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.given.simplices.len()
    }

    /// Number of vertices: places below it never move.
    pub fn vertices(&self) -> u32 {
        self.ranks.len() as u32
    }

    /// Number of places.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// The other side of an edge: triangle and corner.
    pub fn twin(&self, t: usize, k: usize) -> Option<(usize, usize)> {
        let u = self.given.neighbors[t][k];
        if u < 0 {
            return None;
        }
        // Two triangles may share two edges only if they are degenerate; vertices decide.
        let [a, b] = self.ends(t, k);
        let simplex = self.given.simplices[u as usize];
        (0..3)
            .find(|&j| simplex[(j + 1) % 3] as u32 == b && simplex[(j + 2) % 3] as u32 == a)
            .map(|j| (u as usize, j))
    }

    /// The ends of the edge opposite corner `k`, with the triangle to its left.
    pub fn ends(&self, t: usize, k: usize) -> [u32; 2] {
        let simplex = self.given.simplices[t];
        [simplex[(k + 1) % 3] as u32, simplex[(k + 2) % 3] as u32]
    }

    /// The ends of the edge, the one of lower rank first.
    fn rising(&self, t: usize, k: usize) -> [u32; 2] {
        let [a, b] = self.ends(t, k);
        if self.rank(a) <= self.rank(b) {
            [a, b]
        } else {
            [b, a]
        }
    }

    /// The number of levels that a vertex is above.
    pub fn rank(&self, v: u32) -> u32 {
        self.ranks[v as usize]
    }

    /// The vertex at a corner.
    pub fn corner(&self, t: usize, k: usize) -> u32 {
        self.given.simplices[t][k] as u32
    }

    /// The triangle by the ranks of its corners.
    pub fn crossed(&self, t: usize) -> Crossed {
        let ranks = self.given.simplices[t].map(|v| self.ranks[v as usize]);
        let mut corners = [0, 1, 2];
        corners.sort_by_key(|&k| ranks[k]);
        Crossed {
            corners,
            ranks: corners.map(|k| ranks[k]),
            even: (corners[0] + 1) % 3 == corners[1],
        }
    }

    /// The node of a level on the edge opposite corner `k`.
    pub fn node(&self, t: usize, k: usize, level: u32) -> u32 {
        let [low, _] = self.rising(t, k);
        self.first[t][k] + level - self.rank(low)
    }

    /// Both ends of the contour of a level in a triangle: on the edge from the lowest to the highest
    /// corner, and on one of the others.
    pub fn chord(&self, t: usize, crossed: &Crossed, level: u32) -> [u32; 2] {
        let [low, mid, high] = crossed.corners;
        let other = if level < crossed.ranks[1] { high } else { low };
        [self.node(t, mid, level), self.node(t, other, level)]
    }

    /// The representative of a place.
    pub fn find(&self, place: u32) -> u32 {
        self.sets.root_of(place)
    }

    /// The position of a representative.
    pub fn at(&self, place: u32) -> Point2 {
        self.places[place as usize]
    }

    /// Unites two representatives, which takes the position of the smaller number: a vertex, if one
    /// of them is.
    pub fn unite(&mut self, a: u32, b: u32) {
        self.sets.join(a, b);
    }

    /// Lets each place refer to its representative directly.
    pub fn flatten(&mut self) {
        self.sets.flatten();
    }
}

/// The share of the way from `low` to `high` at which `level` lies; monotonic in `level`.
fn share(level: f64, low: f64, high: f64) -> f64 {
    let whole = high - low;
    if whole.is_finite() {
        (level - low) / whole
    } else {
        (level / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0)
    }
}

/// The coordinate at a share of the way from `a` to `b`; monotonic in `share`, and never outside.
fn between(a: f64, b: f64, share: f64) -> f64 {
    let whole = b - a;
    let found = if whole.is_finite() {
        a + share * whole
    } else {
        2.0 * (a / 2.0 + share * (b / 2.0 - a / 2.0))
    };
    found.clamp(a.min(b), a.max(b))
}
