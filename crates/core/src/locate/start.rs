//! Where walks start: a k-d tree over a sample of the triangles, kept between calls.
//!
//! One triangle in eight to sixteen is a node, by the place of its first corner (J. L. Bentley,
//! "Multidimensional binary search trees used for associative searching", 1975). A query goes down
//! one path and takes the nearest node of it: near enough for a walk of a few steps, wherever the
//! points are dense. The tree is perfect and in the order of its levels, so it needs no links and
//! its top stays in the cache.

use delone_predicates::Point2;

use crate::delaunay2::validate::Given;
use crate::error::Result;
use crate::memory::{filled, with_room};
use crate::points::Extent;

/// Triangles a node, at least.
const SHARE: usize = 8;

/// A node. Its left subtree has nothing beyond it along its axis, its right one nothing before it.
#[derive(Debug, Clone, Copy)]
struct Node {
    at: Point2,
    triangle: u32,
    axis: u32,
}

/// The tree.
#[derive(Debug)]
pub struct Start {
    nodes: Vec<Node>,
}

impl Start {
    /// A tree over evenly spread triangles of `given`.
    pub fn of(given: &Given) -> Result<Self> {
        let m = given.simplices.len();
        // The largest perfect tree of at most m / SHARE nodes, and of one at least.
        let levels = (m / SHARE + 1).ilog2();
        let count = ((1 << levels) - 1).max(1).min(m);
        let mut sample = with_room(count)?;
        sample.extend((0..count).map(|i| {
            let t = (i as u64 * m as u64 / count as u64) as usize;
            (given.point(given.simplices[t][0]), t as u32)
        }));
        let node = Node {
            at: [0.0; 2],
            triangle: 0,
            axis: 0,
        };
        let mut nodes = filled(count, node)?;
        fill(&mut nodes, 0, &mut sample);
        Ok(Self { nodes })
    }

    /// A triangle near `q`.
    #[inline]
    pub fn near(&self, q: Point2) -> usize {
        let (mut best, mut least) = (0, f64::INFINITY);
        let mut i = 0;
        while let Some(node) = self.nodes.get(i) {
            let (x, y) = (node.at[0] - q[0], node.at[1] - q[1]);
            let distance = x * x + y * y;
            if distance < least {
                (best, least) = (node.triangle as usize, distance);
            }
            let right = if node.axis == 0 { x <= 0.0 } else { y <= 0.0 };
            i = 2 * i + 1 + usize::from(right);
        }
        best
    }
}

/// Fills the subtree at `i` with the sample, which has as many items as the subtree has nodes.
fn fill(nodes: &mut [Node], i: usize, sample: &mut [(Point2, u32)]) {
    if sample.is_empty() {
        return;
    }
    let extent = Extent::of(sample.iter().map(|s| s.0));
    let half = |k: usize| extent.max[k] / 2.0 - extent.min[k] / 2.0;
    let axis = usize::from(half(1) > half(0));
    let middle = sample.len() / 2;
    let by_axis = |s: &(Point2, u32), t: &(Point2, u32)| s.0[axis].total_cmp(&t.0[axis]);
    let (left, &mut (at, triangle), right) = sample.select_nth_unstable_by(middle, by_axis);
    nodes[i] = Node {
        at,
        triangle,
        axis: axis as u32,
    };
    fill(nodes, 2 * i + 1, left);
    fill(nodes, 2 * i + 2, right);
}
