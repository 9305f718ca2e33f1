//! A tree of boxes over points with any number of coordinates (J. L. Bentley, "Multidimensional
//! binary search trees used for associative searching", 1975), with the points of each node side by
//! side.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::{make_room, push, with_room};

/// The most points of a leaf.
const LEAF: usize = 24;

/// Points `start..end`; the left half is the next node, and the right half has a number.
struct Node {
    start: u32,
    end: u32,
    /// 0 for a leaf.
    right: u32,
}

/// Boxes of points, which have the order of the leaves.
pub struct Tree {
    d: usize,
    nodes: Vec<Node>,
    /// The lowest, then the highest coordinates of each node.
    boxes: Vec<f64>,
}

/// A distance, ordered; it is never NaN.
#[derive(PartialEq)]
struct Distance(f64);

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Tree {
    /// Arranges the numbers of points, which become those of the leaves.
    pub fn new(points: &[f64], d: usize, order: &mut [u32]) -> Result<Self> {
        let mut tree = Self {
            d,
            nodes: Vec::new(),
            boxes: Vec::new(),
        };
        // Nodes that wait, with the node whose right half they are.
        let mut stack = vec![(0..order.len(), None)];
        while let Some((range, parent)) = stack.pop() {
            let number = tree.nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: usize = parent;
                tree.nodes[parent].right = number;
            }
            let axis = tree.enclose(points, &order[range.clone()])?;
            push(
                &mut tree.nodes,
                Node {
                    start: range.start as u32,
                    end: range.end as u32,
                    right: 0,
                },
            )?;
            if range.len() > LEAF {
                let part = &mut order[range.clone()];
                let half = part.len() / 2;
                let at = |i: u32| points[i as usize * d + axis];
                part.select_nth_unstable_by(half, |&i, &j| at(i).total_cmp(&at(j)).then(i.cmp(&j)));
                let middle = range.start + half;
                stack.push((middle..range.end, Some(number as usize)));
                stack.push((range.start..middle, None));
            }
        }
        Ok(tree)
    }

    /// Appends the box of points; returns its longest side.
    fn enclose(&mut self, points: &[f64], part: &[u32]) -> Result<usize> {
        let d = self.d;
        make_room(&mut self.boxes, 2 * d)?;
        let first = self.boxes.len();
        self.boxes.extend((0..d).map(|_| f64::INFINITY));
        self.boxes.extend((0..d).map(|_| f64::NEG_INFINITY));
        let (low, high) = self.boxes[first..].split_at_mut(d);
        for &i in part {
            let p = &points[i as usize * d..][..d];
            for k in 0..d {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let side = |k: &usize| high[*k] - low[*k];
        let longest = (0..d).max_by(|a, b| side(a).total_cmp(&side(b)));
        Ok(longest.unwrap_or(0))
    }

    /// The lowest and the highest coordinates of a node.
    #[inline(always)]
    fn sides(&self, node: usize) -> (&[f64], &[f64]) {
        self.boxes[2 * node * self.d..][..2 * self.d].split_at(self.d)
    }

    /// Calls `leaf` with the points of each leaf whose boxes all pass `enter`; ends early if it
    /// answers `false`.
    pub fn visit(
        &self,
        mut enter: impl FnMut(&[f64], &[f64]) -> bool,
        mut leaf: impl FnMut(Range<u32>) -> Result<bool>,
    ) -> Result<()> {
        let mut stack = vec![0];
        while let Some(number) = stack.pop() {
            let (low, high) = self.sides(number);
            if !enter(low, high) {
                continue;
            }
            let node = &self.nodes[number];
            if node.right == 0 {
                if !leaf(node.start..node.end)? {
                    break;
                }
            } else {
                stack.push(node.right as usize);
                stack.push(number + 1);
            }
        }
        Ok(())
    }

    /// The `count` nearest points to `q`, up to roundings; `points` are in the order of the leaves.
    pub fn nearest(&self, points: &[f64], q: &[f64], count: usize) -> Result<Vec<u32>> {
        let d = self.d;
        let to_box = |node: usize| -> f64 {
            let (low, high) = self.sides(node);
            let gaps = (0..d).map(|k| (low[k] - q[k]).max(q[k] - high[k]).max(0.0));
            gaps.map(|gap| gap * gap).sum()
        };
        // The nearest box first; the farthest of the points that are kept last.
        let mut boxes = BinaryHeap::from([(Reverse(Distance(to_box(0))), 0)]);
        let mut kept = BinaryHeap::new();
        while let Some((Reverse(Distance(gap)), number)) = boxes.pop() {
            let farthest = kept.peek().map_or(f64::INFINITY, |(Distance(x), _)| *x);
            if kept.len() >= count && gap >= farthest {
                break;
            }
            let node = &self.nodes[number];
            if node.right != 0 {
                for half in [number + 1, node.right as usize] {
                    boxes.push((Reverse(Distance(to_box(half))), half));
                }
                continue;
            }
            for i in node.start..node.end {
                let p = &points[i as usize * d..][..d];
                let square = p.iter().zip(q).map(|(a, b)| (a - b) * (a - b)).sum();
                kept.push((Distance(square), i));
                if kept.len() > count {
                    kept.pop();
                }
            }
        }
        let mut found = with_room(kept.len())?;
        found.extend(kept.into_sorted_vec().into_iter().map(|(_, i)| i));
        Ok(found)
    }
}
