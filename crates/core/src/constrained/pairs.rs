//! All pairs of segments that cross, by joining trees of bounding boxes.
//!
//! Segments are divided into classes by the size of their boxes, and each class has a tree: eight
//! segments that are consecutive along the Hilbert curve of their midpoints form a node, eight such
//! nodes form a node of the next level, and so on. The trees are then joined with themselves and
//! with each other, from the roots down, as far as boxes overlap; a single segment, which may be
//! long and slanted, also as far as its line meets the box. The remaining pairs of segments are
//! decided by predicates.
//!
//! For n segments this takes O(n log n) for the trees, plus time proportional to the number of
//! boxes that overlap: linear for map data, where few do. It is quadratic if all boxes overlap, for
//! example for long slanted parallel lines. Memory is linear, plus the pairs.
//!
//! Sources: T. Brinkhoff, H.-P. Kriegel and B. Seeger, "Efficient processing of spatial joins using
//! R-trees", SIGMOD 1993, for the join; I. Kamel and C. Faloutsos, "On packing R-trees", CIKM 1993,
//! for trees packed along the curve.

use delone_predicates::{Point2, Sign, stages};

use super::intersection::crosses;
use crate::base::boxes::Levels;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::order::curve::{Scratch, along_curve};
use crate::order::sort;

/// Children of a node.
const FAN: usize = 8;
/// Binary orders of magnitude per size class.
const CLASS: u32 = 3;
/// Size classes; the last has everything smaller.
const CLASSES: usize = 8;
/// Joins of two nodes between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;
/// Segments that are put in place between two checks for interruption.
const LOT: usize = 1 << 16;

/// All pairs of segments that cross in a single point in the interior of both, as `[smaller row,
/// larger row]`, ascending.
///
/// Segments that touch at an end of either, overlap along a line or have no length do not cross.
/// Exact for all finite doubles.
pub fn crossing_pairs(
    points: &[Point2],
    segments: &[[u32; 2]],
    watch: &Watch,
) -> Result<Vec<[u32; 2]>> {
    crossing_pairs_above(points, segments, usize::MAX, watch)
}

/// Like [`crossing_pairs`], but stops and returns the pairs as soon as there are more than `limit`.
pub fn crossing_pairs_above(
    points: &[Point2],
    segments: &[[u32; 2]],
    limit: usize,
    watch: &Watch,
) -> Result<Vec<[u32; 2]>> {
    let forest = Forest::grow(points, segments, watch)?;
    let mut join = Join {
        forest: &forest,
        watch,
        limit,
        steps: 0,
        found: Vec::new(),
    };
    join.all()?;
    let mut found = join.found;
    sort(&mut found, watch)?;
    Ok(found)
}

/// A segment: its ends, and their rows.
#[derive(Debug, Clone, Copy)]
struct Item {
    ends: [Point2; 2],
    rows: [u32; 2],
    row: u32,
}

impl Item {
    fn extent(&self) -> Extent {
        Extent::of(self.ends)
    }

    /// Whether the line may meet the box: the corners are not all proved to lie on one side.
    #[inline]
    fn may_meet(&self, e: &Extent) -> bool {
        let [a, b] = self.ends;
        // The corners farthest to the left and right of the direction of the segment.
        let (x, y) = (usize::from(b[1] < a[1]), usize::from(b[0] < a[0]));
        let corners = [e.min, e.max];
        let left = [corners[x][0], corners[1 - y][1]];
        let right = [corners[1 - x][0], corners[y][1]];
        stages::orient2d::filter(a, b, left) != Some(Sign::Negative)
            && stages::orient2d::filter(a, b, right) != Some(Sign::Positive)
    }

    #[inline]
    fn crosses(&self, other: &Self) -> bool {
        // Segments with a common end have no other point in common, or overlap.
        let [[a, b], [c, d]] = [self.rows, other.rows];
        if a == c || a == d || b == c || b == d {
            return false;
        }
        let ([a, b], [c, d]) = (self.ends, other.ends);
        crosses(a, b, c, d)
    }
}

/// Whether two boxes have a point in common.
#[inline]
pub(crate) fn overlap(a: &Extent, b: &Extent) -> bool {
    // Not short-circuited: four comparisons are cheaper than an unpredictable branch.
    (a.min[0] <= b.max[0])
        & (b.min[0] <= a.max[0])
        & (a.min[1] <= b.max[1])
        & (b.min[1] <= a.max[1])
}

/// The boxes of the segments of a class, and above them those of `FAN` each.
type Tree = Levels<2, 1, FAN>;

/// Segments, tree by tree.
struct Forest {
    items: Vec<Item>,
    trees: Vec<Tree>,
    /// The first item of each tree.
    starts: Vec<usize>,
}

/// A node of a tree: its level and the number of its box there; at level 0 a segment.
#[derive(Clone, Copy)]
struct Node {
    tree: usize,
    level: usize,
    place: usize,
}

impl Forest {
    fn grow(points: &[Point2], segments: &[[u32; 2]], watch: &Watch) -> Result<Self> {
        let ends = |row: u32| segments[row as usize].map(|v| points[v as usize]);
        let (mut rows, starts) = classes(segments.len() as u32, ends)?;
        let mut scratch = Scratch::default();
        for w in starts.windows(2) {
            arrange(&mut rows[w[0]..w[1]], ends, &mut scratch, watch)?;
        }
        let mut forest = Self {
            items: with_room(rows.len())?,
            trees: Vec::new(),
            starts: Vec::new(),
        };
        for lot in rows.chunks(LOT) {
            watch.check()?;
            forest.items.extend(lot.iter().map(|&row| Item {
                ends: ends(row),
                rows: segments[row as usize],
                row,
            }));
        }
        for w in starts.windows(2).filter(|w| w[0] < w[1]) {
            let mut boxes = with_room(w[1] - w[0])?;
            for lot in forest.items[w[0]..w[1]].chunks(LOT) {
                watch.check()?;
                boxes.extend(lot.iter().map(Item::extent));
            }
            forest.trees.push(Tree::over(boxes.len(), boxes, watch)?);
            forest.starts.push(w[0]);
        }
        Ok(forest)
    }

    fn root(&self, tree: usize) -> Node {
        Node {
            tree,
            level: self.trees[tree].top(),
            place: 0,
        }
    }

    fn children(&self, node: Node) -> impl Iterator<Item = Node> + use<> {
        let below = self.trees[node.tree].below(node.level, node.place);
        below.map(move |place| Node {
            level: node.level - 1,
            place,
            ..node
        })
    }

    #[inline]
    fn extent(&self, node: Node) -> &Extent {
        &self.trees[node.tree].at(node.level)[node.place]
    }

    /// The segment that is a node of level 0.
    #[inline]
    fn item(&self, node: Node) -> &Item {
        &self.items[self.starts[node.tree] + node.place]
    }
}

/// The rows sorted by class, the largest segments first, and where each class starts, and the end.
/// Segments of zero length, of which any number may coincide, are left out.
fn classes(n: u32, ends: impl Fn(u32) -> [Point2; 2]) -> Result<(Vec<u32>, [usize; CLASSES + 1])> {
    // The exponent of the longer side of the box, halved so that it is finite.
    let size = |row: u32| {
        let [a, b] = ends(row);
        let half = |k: usize| (0.5 * a[k] - 0.5 * b[k]).abs();
        (half(0).max(half(1)).to_bits() >> 52) as u32
    };
    let long = || (0..n).filter(|&row| ends(row)[0] != ends(row)[1]);
    let largest = long().map(size).max().unwrap_or(0);
    let class = |row: u32| (((largest - size(row)) / CLASS) as usize).min(CLASSES - 1);
    let mut starts = [0; CLASSES + 1];
    long().for_each(|row| starts[class(row) + 1] += 1);
    for k in 0..CLASSES {
        starts[k + 1] += starts[k];
    }
    let (mut rows, mut next) = (filled(starts[CLASSES], 0)?, starts);
    for row in long() {
        let place = &mut next[class(row)];
        rows[*place] = row;
        *place += 1;
    }
    Ok((rows, starts))
}

/// Sorts the `rows` of one class, which are ascending, along the curve of their segments'
/// midpoints.
fn arrange(
    rows: &mut [u32],
    ends: impl Fn(u32) -> [Point2; 2],
    scratch: &mut Scratch,
    watch: &Watch,
) -> Result<()> {
    let middle = |&row: &u32| {
        let [a, b] = ends(row);
        [0, 1].map(|k| 0.5 * a[k] + 0.5 * b[k])
    };
    let mut middles = with_room(rows.len())?;
    for lot in rows.chunks(LOT) {
        watch.check()?;
        middles.extend(lot.iter().map(middle));
    }
    let (distinct, others) = along_curve(&mut middles, rows, scratch, watch)?;
    // Those that share another's midpoint follow it along the curve.
    for (row, other) in rows[distinct..].iter_mut().zip(others) {
        *row = other[0];
    }
    Ok(())
}

/// The join of all trees.
struct Join<'a> {
    forest: &'a Forest,
    watch: &'a Watch<'a>,
    limit: usize,
    steps: usize,
    found: Vec<[u32; 2]>,
}

impl Join<'_> {
    fn all(&mut self) -> Result<()> {
        for a in 0..self.forest.trees.len() {
            self.within(self.forest.root(a))?;
            for b in a + 1..self.forest.trees.len() {
                self.between(self.forest.root(a), self.forest.root(b))?;
            }
        }
        Ok(())
    }

    /// Whether enough pairs are found.
    fn done(&self) -> bool {
        self.found.len() > self.limit
    }

    fn step(&mut self) -> Result<()> {
        self.steps += 1;
        if self.steps.is_multiple_of(WATCH_EVERY) {
            self.watch.check()?;
        }
        Ok(())
    }

    /// All pairs below one node.
    fn within(&mut self, node: Node) -> Result<()> {
        if node.level == 0 || self.done() {
            return Ok(());
        }
        self.step()?;
        for child in self.forest.children(node) {
            self.within(child)?;
            for other in self.forest.children(node).filter(|o| o.place > child.place) {
                self.between(child, other)?;
            }
        }
        Ok(())
    }

    /// All pairs of a segment below `a` and one below `b`, another node.
    fn between(&mut self, a: Node, b: Node) -> Result<()> {
        let forest = self.forest;
        let (box_a, box_b) = (forest.extent(a), forest.extent(b));
        if !overlap(box_a, box_b) || self.done() {
            return Ok(());
        }
        if a.level == 0 && b.level == 0 {
            return self.pair(forest.item(a), forest.item(b));
        }
        if a.level == 0 && !forest.item(a).may_meet(box_b)
            || b.level == 0 && !forest.item(b).may_meet(box_a)
        {
            return Ok(());
        }
        self.step()?;
        // Descends into the larger box, so that few small ones wait for one of their size.
        let larger = box_a.side() >= box_b.side();
        if b.level == 0 || a.level > 0 && larger {
            for child in self.forest.children(a) {
                self.between(child, b)?;
            }
        } else {
            for child in self.forest.children(b) {
                self.between(a, child)?;
            }
        }
        Ok(())
    }

    fn pair(&mut self, a: &Item, b: &Item) -> Result<()> {
        if a.crosses(b) {
            let bytes = 2 * size_of_val(&self.found[..]);
            self.found
                .try_reserve(1)
                .map_err(|_| Error::Memory { bytes })?;
            self.found.push([a.row.min(b.row), a.row.max(b.row)]);
        }
        Ok(())
    }
}
