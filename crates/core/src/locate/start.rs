//! Starting simplices for walks: a k-d tree over a sample of the simplices, kept between calls.
//!
//! One simplex in eight to sixteen is a node, by the position of its first corner (J. L. Bentley,
//! "Multidimensional binary search trees used for associative searching", 1975). A query descends
//! one path and uses the nearest node on it: near enough for a walk of a few steps, wherever the
//! points are dense. The tree is perfect and stored level by level, so it needs no links and its
//! top stays in the cache.

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::{Pace, Watch};

/// The fewest simplices per node.
const SHARE: usize = 8;

/// Nodes of samples between two checks for interruption.
const LOT: usize = 1 << 16;

/// A node. Nothing in its left subtree is beyond it along its axis, nothing in its right one before
/// it.
#[derive(Debug, Clone, Copy)]
struct Node<const D: usize> {
    at: [f64; D],
    simplex: u32,
    axis: u32,
}

/// The tree.
#[derive(Debug)]
pub struct Start<const D: usize> {
    nodes: Vec<Node<D>>,
}

impl<const D: usize> Start<D> {
    /// A tree over an evenly spaced sample of `m` simplices; `corner` gives their first corners.
    pub fn of(m: usize, corner: impl Fn(usize) -> [f64; D], watch: &Watch) -> Result<Self> {
        // The largest perfect tree of at most m / SHARE nodes, but at least one.
        let levels = (m / SHARE + 1).ilog2();
        let count = ((1 << levels) - 1).max(1).min(m);
        let mut sample = with_room(count)?;
        let mut pace = Pace::new(watch, LOT);
        for i in 0..count {
            pace.spend(1)?;
            let t = (i as u64 * m as u64 / count as u64) as usize;
            sample.push((corner(t), t as u32));
        }
        let node = Node {
            at: [0.0; D],
            simplex: 0,
            axis: 0,
        };
        let mut nodes = filled(count, node)?;
        fill(&mut nodes, 0, &mut sample, &mut pace)?;
        Ok(Self { nodes })
    }

    /// A simplex near `q`.
    #[inline]
    pub fn near(&self, q: [f64; D]) -> usize {
        let (mut best, mut least) = (0, f64::INFINITY);
        let mut i = 0;
        while let Some(node) = self.nodes.get(i) {
            self.touch(8 * i + 7);
            let seen: [f64; D] = std::array::from_fn(|k| node.at[k] - q[k]);
            let distance = seen.iter().map(|x| x * x).sum();
            if distance < least {
                (best, least) = (node.simplex as usize, distance);
            }
            let right = seen[node.axis as usize] <= 0.0;
            i = 2 * i + 1 + usize::from(right);
        }
        best
    }

    /// Loads the eight nodes from `i` on, three levels down, of which the path visits one: a cold
    /// query waits for memory a third as often.
    #[inline]
    fn touch(&self, i: usize) {
        // One load per cache line.
        if let Some(nodes) = self.nodes.get(i..i + 8) {
            for k in [0, 3, 5, 7] {
                std::hint::black_box(nodes[k].simplex);
            }
        }
    }
}

/// Fills the subtree at `i` with the sample, which has as many items as the subtree has nodes.
fn fill<const D: usize>(
    nodes: &mut [Node<D>],
    i: usize,
    sample: &mut [([f64; D], u32)],
    pace: &mut Pace,
) -> Result<()> {
    if sample.is_empty() {
        return Ok(());
    }
    pace.spend(sample.len())?;
    let axis = longest(sample);
    let middle = sample.len() / 2;
    let by_axis = |s: &([f64; D], u32), t: &([f64; D], u32)| s.0[axis].total_cmp(&t.0[axis]);
    let (left, &mut (at, simplex), right) = sample.select_nth_unstable_by(middle, by_axis);
    nodes[i] = Node {
        at,
        simplex,
        axis: axis as u32,
    };
    fill(nodes, 2 * i + 1, left, pace)?;
    fill(nodes, 2 * i + 2, right, pace)
}

/// The axis along which a sample is longest, the first if there are several.
fn longest<const D: usize>(sample: &[([f64; D], u32)]) -> usize {
    let half = |k: usize| {
        let ends = sample
            .iter()
            .fold((f64::MAX, f64::MIN), |(least, most), s| {
                (least.min(s.0[k]), most.max(s.0[k]))
            });
        // Halved, so that no difference overflows.
        ends.1 / 2.0 - ends.0 / 2.0
    };
    (1..D).fold(0, |best, k| if half(k) > half(best) { k } else { best })
}
