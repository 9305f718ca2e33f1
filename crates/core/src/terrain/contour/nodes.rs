//! Nodes: the points where levels cross edges, numbered and rounded.
//!
//! A *place* is a vertex or a node: vertices have the numbers below `n`, nodes those from `n` on,
//! ascending along each edge. An edge belongs to the first of its triangles, and nodes are in the order
//! of these triangles. Places that were found to be at the same position are united; `find` returns the
//! representative.

use std::ops::Range;

use crate::base::arrays::Triangles;
use crate::base::error::{Densest, Error, Result};
use crate::base::memory::zeroed;
use crate::base::parallel::map_watched;
use crate::base::sets::Sets;
use crate::base::watch::Watch;
use delone_predicates::Point2;

/// Triangles, or vertices, in a task of a thread, and between two checks for interruption.
pub const SHARE: usize = 1 << 14;

/// A triangle that levels cross, with its corners in the order of their ranks.
#[derive(Clone, Copy)]
pub struct Crossed {
    /// The corners with the lowest, middle and highest rank.
    pub corners: [usize; 3],
    /// Their ranks.
    pub ranks: [u32; 3],
    /// Whether the corners in this order are counterclockwise.
    pub even: bool,
    /// The first node on the edge opposite each corner.
    nodes: [u32; 3],
}

impl Crossed {
    /// Both ends of the contour of a level: on the edge from the lowest to the highest corner, and
    /// on one of the others.
    pub fn chord(&self, level: u32) -> [u32; 2] {
        let [low, mid, high] = self.corners;
        let [least, middle, _] = self.ranks;
        let longest = self.nodes[mid] + level - least;
        if level < middle {
            [longest, self.nodes[high] + level - least]
        } else {
            [longest, self.nodes[low] + level - middle]
        }
    }
}

/// Triangles, and the number of levels that each vertex is above.
struct Ranked<'a> {
    given: Triangles<'a>,
    ranks: Vec<u32>,
}

impl Ranked<'_> {
    /// The other side of an edge: triangle and corner.
    fn twin(&self, t: usize, k: usize) -> Option<(usize, usize)> {
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
    fn ends(&self, t: usize, k: usize) -> [u32; 2] {
        let simplex = self.given.simplices[t];
        [simplex[(k + 1) % 3] as u32, simplex[(k + 2) % 3] as u32]
    }

    /// The ends of the edge, the one of lower rank first.
    fn rising(&self, t: usize, k: usize) -> [u32; 2] {
        let [a, b] = self.ends(t, k);
        if self.ranks[a as usize] <= self.ranks[b as usize] {
            [a, b]
        } else {
            [b, a]
        }
    }

    /// The ranks of the corners of a triangle.
    fn corners(&self, t: usize) -> [u32; 3] {
        self.given.simplices[t].map(|v| self.ranks[v as usize])
    }

    /// The number of nodes on the edge opposite corner `k` if it belongs to the triangle, otherwise 0.
    fn own(&self, t: usize, k: usize) -> u32 {
        let [a, b] = self.ends(t, k).map(|v| self.ranks[v as usize]);
        // Most edges have no nodes, and need no look at the triangle beyond.
        if a == b || self.twin(t, k).is_some_and(|(u, _)| u < t) {
            0
        } else {
            a.abs_diff(b)
        }
    }
}

/// The nodes of all levels.
pub struct Nodes<'a> {
    edges: Ranked<'a>,
    /// The first node on the edges that belong to each triangle.
    first: Vec<u32>,
    /// The positions of the nodes.
    places: Vec<Point2>,
    /// Vertices and nodes at the same position.
    sets: Sets,
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
        (workers, watch): (usize, &Watch),
    ) -> Result<Self> {
        let mut ranks = zeroed(heights.len())?;
        let tasks = ranks.chunks_mut(SHARE).zip(heights.chunks(SHARE)).collect();
        map_watched(workers, tasks, watch, |(ranks, heights)| {
            for (rank, &z) in ranks.iter_mut().zip(heights) {
                *rank = levels.partition_point(|&level| level <= z) as u32;
            }
            Ok(())
        })?;
        let edges = Ranked { given, ranks };
        let mut first = zeroed(given.simplices.len())?;
        let starts = number(&edges, &mut first, (workers, watch))?;
        let (vertices, count) = (heights.len(), starts.last().copied().unwrap_or(0));
        let most = (i32::MAX as usize).saturating_sub(vertices);
        if count > most || count > limit {
            return Err(Error::Budget {
                what: "points of contours",
                limit: if count > most { most } else { limit },
                found: count,
                densest: Densest::default(),
            });
        }
        let mut places = zeroed(count)?;
        let mut parents = zeroed(vertices + count)?;
        let (own, nodes) = parents.split_at_mut(vertices);
        own.iter_mut().zip(0..).for_each(|(parent, v)| *parent = v);
        let mut tasks = Vec::new();
        let (mut places_left, mut parents_left) = (&mut places[..], nodes);
        for (share, (first, range)) in first.chunks_mut(SHARE).zip(starts.windows(2)).enumerate() {
            let (places, after) = places_left.split_at_mut(range[1] - range[0]);
            let (parents, later) = parents_left.split_at_mut(range[1] - range[0]);
            (places_left, parents_left) = (after, later);
            let task = Task {
                from: share * SHARE,
                start: (vertices + range[0]) as u32,
                first,
                places,
                parents,
            };
            tasks.push(task);
        }
        map_watched(workers, tasks, watch, |task| {
            task.place(&edges, heights, (levels, collapsed));
            Ok(())
        })?;
        Ok(Self {
            edges,
            first,
            places,
            sets: Sets::with_parents(parents),
        })
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.edges.given.simplices.len()
    }

    /// The triangles in shares of some number.
    pub fn shares(&self, size: usize) -> Vec<Range<usize>> {
        let count = self.triangles();
        (0..count)
            .step_by(size)
            .map(|from| from..count.min(from + size))
            .collect()
    }

    /// Number of vertices: places below it never move.
    pub fn vertices(&self) -> u32 {
        self.edges.ranks.len() as u32
    }

    /// Number of places.
    pub fn len(&self) -> usize {
        self.edges.ranks.len() + self.places.len()
    }

    /// The other side of an edge: triangle and corner.
    pub fn twin(&self, t: usize, k: usize) -> Option<(usize, usize)> {
        self.edges.twin(t, k)
    }

    /// The ends of the edge opposite corner `k`, with the triangle to its left.
    pub fn ends(&self, t: usize, k: usize) -> [u32; 2] {
        self.edges.ends(t, k)
    }

    /// The number of levels that a vertex is above.
    pub fn rank(&self, v: u32) -> u32 {
        self.edges.ranks[v as usize]
    }

    /// The vertex at a corner.
    pub fn corner(&self, t: usize, k: usize) -> u32 {
        self.edges.given.simplices[t][k] as u32
    }

    /// The lowest and the highest rank in a triangle.
    pub fn span(&self, t: usize) -> [u32; 2] {
        let [a, b, c] = self.edges.corners(t);
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// The triangle by the ranks of its corners; none if it is between two levels.
    pub fn crossed(&self, t: usize) -> Option<Crossed> {
        let ranks = self.edges.corners(t);
        if ranks[0] == ranks[1] && ranks[1] == ranks[2] {
            return None;
        }
        let mut corners = [0, 1, 2];
        corners.sort_by_key(|&k| ranks[k]);
        Some(Crossed {
            corners,
            ranks: corners.map(|k| ranks[k]),
            even: (corners[0] + 1) % 3 == corners[1],
            nodes: [0, 1, 2].map(|k| {
                let crosses = ranks[(k + 1) % 3] != ranks[(k + 2) % 3];
                if crosses { self.first(t, k) } else { 0 }
            }),
        })
    }

    /// The first node on the edge opposite corner `k`.
    fn first(&self, t: usize, k: usize) -> u32 {
        let (t, k) = match self.twin(t, k) {
            Some((u, j)) if u < t => (u, j),
            _ => (t, k),
        };
        self.first[t] + (0..k).map(|j| self.edges.own(t, j)).sum::<u32>()
    }

    /// The node of a level on the edge opposite corner `k`.
    pub fn node(&self, t: usize, k: usize, level: u32) -> u32 {
        let [low, _] = self.edges.rising(t, k);
        self.first(t, k) + level - self.rank(low)
    }

    /// The triangles on both sides of the edge of a node.
    pub fn beside(&self, node: u32) -> [Option<usize>; 2] {
        // The last triangle whose nodes do not begin after this one: those without nodes have none left.
        let t = self.first.partition_point(|&first| first <= node) - 1;
        let mut left = node - self.first[t];
        let k = (0..3).find(|&k| {
            let count = self.edges.own(t, k);
            let found = left < count;
            left -= if found { 0 } else { count };
            found
        });
        let other = k.and_then(|k| self.twin(t, k)).map(|(u, _)| u);
        [Some(t), other]
    }

    /// The representative of a place.
    pub fn find(&self, place: u32) -> u32 {
        self.sets.root_of(place)
    }

    /// The position of a representative.
    pub fn at(&self, place: u32) -> Point2 {
        let vertices = self.edges.ranks.len();
        let place = place as usize;
        if place < vertices {
            self.edges.given.points[place]
        } else {
            self.places[place - vertices]
        }
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

/// Gives each triangle the number of nodes before its own in its share, and returns the first node of
/// each share, and the number of all.
fn number(
    edges: &Ranked,
    first: &mut [u32],
    (workers, watch): (usize, &Watch),
) -> Result<Vec<usize>> {
    let tasks = first.chunks_mut(SHARE).enumerate().collect();
    let counts = map_watched(workers, tasks, watch, |(share, first)| {
        let mut count = 0;
        for (t, first) in (share * SHARE..).zip(first) {
            // Numbers beyond the limit of u32 are never used: the count is refused.
            *first = count as u32;
            count += (0..3).map(|k| edges.own(t, k) as usize).sum::<usize>();
        }
        Ok(count)
    })?;
    let mut starts = vec![0];
    starts.extend(counts.iter().scan(0_usize, |sum, &count| {
        *sum = sum.saturating_add(count);
        Some(*sum)
    }));
    Ok(starts)
}

/// The nodes of a share of the triangles.
struct Task<'a> {
    /// The first triangle.
    from: usize,
    /// The first node.
    start: u32,
    first: &'a mut [u32],
    places: &'a mut [Point2],
    parents: &'a mut [u32],
}

impl Task<'_> {
    /// Computes the positions, and unites nodes with vertices.
    fn place(self, edges: &Ranked, heights: &[f64], (levels, collapsed): (&[f64], &[bool])) {
        let is_collapsed = |t: usize| collapsed.get(t).copied().unwrap_or(false);
        let mut node = 0;
        for (t, first) in (self.from..).zip(self.first) {
            *first += self.start;
            for (k, own) in (0..3).map(|k| (k, edges.own(t, k) as usize)) {
                if own == 0 {
                    continue;
                }
                let twin = edges.twin(t, k);
                let collapses = is_collapsed(t) || twin.is_some_and(|(u, _)| is_collapsed(u));
                let [low, high] = edges.rising(t, k);
                let [a, b] = [low, high].map(|v| v as usize);
                let [p, q] = [a, b].map(|v| edges.given.points[v]);
                let from = edges.ranks[a] as usize;
                for &level in &levels[from..from + own] {
                    let (parent, place) = if level == heights[b] {
                        (high, q)
                    } else if collapses {
                        (low, p)
                    } else {
                        let share = share(level, heights[a], heights[b]);
                        let place = [between(p[0], q[0], share), between(p[1], q[1], share)];
                        (self.start + node as u32, place)
                    };
                    self.parents[node] = parent;
                    self.places[node] = place;
                    node += 1;
                }
            }
        }
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
