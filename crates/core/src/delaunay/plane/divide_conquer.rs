//! Divide and conquer: split the points in two, triangulate both parts, merge.
//!
//! L. Guibas and J. Stolfi (1985; see `merge`); alternating cut directions as in R. A. Dwyer, "A
//! faster divide-and-conquer algorithm for constructing Delaunay triangulations", Algorithmica 2
//! (1987).
//!
//! Points are sorted along the Hilbert curve, whose cells are squares and halves of squares. Each
//! bit of the keys, from the first on in which the points of a part differ, splits it in two along
//! one axis, and no point needs to be moved. From [`FEW`] points down, splits are at medians, so
//! that leaves have three or four points. Cells halve boxes, not numbers of points; a part deeper
//! than 8 log n cells is therefore split at medians from there on, which are found in linear time.
//! Merges are linear, so both kinds of splits take O(n log n) in the worst case.

use std::ops::Range;

use delone_predicates::{Point2, lexicographic};

use super::leaf;
use super::merge::{Bounds, Free, join};
use super::part::Part;
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch};
use crate::order::blocks::Axis;
use crate::order::curve;

/// Parts of at least this many vertices check for interruption when they are merged.
const WATCHED: usize = 1 << 12;

/// The most vertices that are split at medians by comparing all with all.
const FEW: usize = 8;

/// Fills `mesh` with the triangulation of the vertices `block`, at least two, and returns a ghost.
/// `points` end with NaN for infinity.
pub fn build(points: &[Point2], block: Range<u32>, mesh: Patch, watch: &Watch) -> Result<Code> {
    let mut keys: Vec<u32> = with_room(block.len())?;
    keys.extend(curve::keys(
        &points[block.start as usize..block.end as usize],
        true,
    ));
    let mut builder = Builder {
        points,
        mesh,
        watch,
        block: block.start,
    };
    let depth = 8 * block.len().ilog2();
    let part = if keys.is_sorted() {
        builder.along_curve(&mut keys, 0, depth)?
    } else {
        // Blocks that were too small alone are combined into one without an order.
        builder.uncurved(0, block.len())?
    };
    Ok(part.ghost())
}

struct Builder<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    watch: &'a Watch<'a>,
    /// The first vertex of the block.
    block: u32,
}

/// Part of the block: its first place and its number of places. Each place has two records.
type Places = (u32, usize);

impl Builder<'_> {
    /// Triangulates the vertices from place `at` on, which have these `keys`, ascending.
    fn along_curve(&mut self, keys: &mut [u32], at: u32, depth: u32) -> Result<Part> {
        let n = keys.len();
        let start = self.block + at;
        if n <= FEW {
            let mut vertices = [0; FEW];
            for (v, i) in vertices.iter_mut().zip(start..) {
                *v = i;
            }
            return Ok(self.few(&mut vertices[..n], at));
        }
        if n >= WATCHED {
            self.watch.check()?;
        }
        if keys[0] == keys[n - 1] {
            // The points of a crowded cell are sorted by keys of their own.
            let own = curve::keys(&self.points[start as usize..][..n], false);
            keys.iter_mut().zip(own).for_each(|(key, own)| *key = own);
            if !keys.is_sorted() {
                return self.uncurved(at, n);
            }
        }
        let (low, high) = (keys[0], keys[n - 1]);
        if depth == 0 || low == high {
            return self.uncurved(at, n);
        }
        let bit = (low ^ high).ilog2();
        let cut = high >> bit << bit;
        let middle = keys.partition_point(|&key| key < cut);
        let (first, second) = keys.split_at_mut(middle);
        let first = self.along_curve(first, at, depth - 1)?;
        let second = self.along_curve(second, at + middle as u32, depth - 1)?;
        let (sides, axis) = self.side_by_side([&first, &second]);
        let bounds = Bounds::within(Part::side(self.points, sides));
        Ok(self.join(sides, axis, bounds, (at, n), middle))
    }

    /// The same, by medians only.
    fn uncurved(&mut self, at: u32, n: usize) -> Result<Part> {
        let mut vertices = with_room(n)?;
        vertices.extend((self.block + at..).take(n));
        self.at_medians(&mut vertices, at, Axis::X)
    }

    /// Two halves of a square in their order along the axis that separates them.
    #[inline]
    fn side_by_side<'p>(&self, [a, b]: [&'p Part; 2]) -> ([&'p Part; 2], Axis) {
        let at = |v: u32| self.points[v as usize];
        let before = |a: &Part, b: &Part, axis: Axis| {
            axis.before(at(a.last(axis).vertex()), at(b.first(axis).vertex()))
        };
        let (ab, ba) = (before(a, b, Axis::X), before(b, a, Axis::X));
        let axis = if ab | ba { Axis::X } else { Axis::Y };
        let first = if axis == Axis::X {
            ab
        } else {
            before(a, b, Axis::Y)
        };
        (if first { [a, b] } else { [b, a] }, axis)
    }

    /// Triangulates any vertices by splits at medians, the first along `axis`, then alternating.
    fn at_medians(&mut self, vertices: &mut [u32], at: u32, axis: Axis) -> Result<Part> {
        let n = vertices.len();
        if n <= FEW {
            return Ok(self.few(vertices, at));
        }
        if n >= WATCHED {
            self.watch.check()?;
        }
        let turned = |v: u32| axis.turned(self.points[v as usize]);
        let middle = n / 2;
        vertices.select_nth_unstable_by(middle, |&u, &v| lexicographic(turned(u), turned(v)));
        let (first, second) = vertices.split_at_mut(middle);
        let other = if axis == Axis::X { Axis::Y } else { Axis::X };
        let first = self.at_medians(first, at, other)?;
        let second = self.at_medians(second, at + middle as u32, other)?;
        let bounds = Bounds::within(Part::side(self.points, [&first, &second]));
        Ok(self.join([&first, &second], axis, bounds, (at, n), middle))
    }

    /// Merges the part of the first `middle` places and that of the others.
    #[inline]
    fn join(
        &mut self,
        sides: [&Part; 2],
        axis: Axis,
        bounds: Bounds,
        (at, n): Places,
        middle: usize,
    ) -> Part {
        // A mesh of k vertices leaves two of its 2 k records free.
        let end = |k: usize| self.record(at + k as u32);
        let free = Free {
            bottom: end(middle) - 2,
            top: end(middle) - 1,
            idle: end(n) - 1,
        };
        join(&mut self.mesh, self.points, sides, axis, bounds, free)
    }

    #[inline]
    fn record(&self, at: u32) -> u32 {
        self.mesh.first() + 2 * at
    }

    /// Triangulates at most [`FEW`] vertices.
    fn few(&mut self, vertices: &mut [u32], at: u32) -> Part {
        if let [v] = *vertices {
            return Part::single(v);
        }
        let extent = Extent::of(vertices.iter().map(|&v| self.points[v as usize]));
        self.halves(vertices, at, Bounds::within(extent.side()))
    }

    /// Splits few vertices in two until leaves are left.
    fn halves(&mut self, vertices: &mut [u32], at: u32, bounds: Bounds) -> Part {
        let n = vertices.len();
        let (t, points) = (self.record(at), self.points);
        let leaf = match *vertices {
            [a] => return Part::single(a),
            [a, b] => return leaf::pair(&mut self.mesh, points, [a, b], t),
            [a, b, c] => leaf::triple(&mut self.mesh, points, [a, b, c], t, bounds),
            [a, b, c, d] => leaf::quad(&mut self.mesh, points, [a, b, c, d], t, bounds),
            _ => None,
        };
        if let Some(part) = leaf {
            return part;
        }
        let axis = sort(self.points, self.mesh.infinite(), vertices);
        // Use as few leaves as possible, of three or four vertices; two and two, or two and one, if
        // such a leaf is degenerate.
        let leaves = n.div_ceil(4).max(2);
        let middle = (n * (leaves / 2)).div_ceil(leaves);
        let (first, second) = vertices.split_at_mut(middle);
        let first = self.halves(first, at, bounds);
        let second = self.halves(second, at + middle as u32, bounds);
        self.join([&first, &second], axis, bounds, (at, n), middle)
    }
}

/// Sorts at most [`FEW`] vertices along the longer side of their box, by counting for each those
/// before it: no branch depends on the points. `infinite` is a vertex of NaN.
#[inline]
fn sort(points: &[Point2], infinite: u32, vertices: &mut [u32]) -> Axis {
    let n = vertices.len();
    let mut padded = [infinite; FEW];
    padded[..n].copy_from_slice(vertices);
    let points = padded.map(|v| points[v as usize]);
    // Comparisons with NaN are false: the padding is not in the box.
    let extent = Extent::of(points);
    let side = |k: usize| extent.max[k] - extent.min[k];
    let axis = if side(0) >= side(1) { Axis::X } else { Axis::Y };
    let turned = points.map(|p| axis.turned(p));
    // Infinite coordinates sort the padding after all others.
    let first = turned.map(|p| {
        if p[0] < f64::INFINITY {
            p[0]
        } else {
            f64::INFINITY
        }
    });
    let mut ranks = [0u64; FEW];
    for (rank, &x) in ranks.iter_mut().zip(&first) {
        *rank = first.iter().map(|&y| u64::from(y < x)).sum();
    }
    // Points whose first coordinates are equal share one rank, so the sum is too small.
    let all: u64 = ranks[..n].iter().sum();
    if all != (n * (n - 1) / 2) as u64 {
        for (rank, p) in ranks.iter_mut().zip(&turned) {
            let ties = turned
                .iter()
                .map(|q| u64::from((q[0] == p[0]) & (q[1] < p[1])));
            *rank += ties.sum::<u64>();
        }
    }
    let mut sorted = [0; 2 * FEW];
    for (&rank, &v) in ranks.iter().zip(&padded) {
        sorted[rank as usize % (2 * FEW)] = v;
    }
    vertices.copy_from_slice(&sorted[..n]);
    axis
}
