//! A triangulated part as a merge sees it: four extreme vertices, each with the ghost whose hull
//! edge ends there.
//!
//! Extremes are by one coordinate, with ties broken by the other as if the plane were rotated
//! slightly. So they are strict corners of the hull, which visits each of them once, even if the
//! part is a chain.

use std::hint::select_unpredictable;

use delone_predicates::Point2;

use crate::mesh::plane::{Code, Patch, half_edge, triangle};
use crate::order::blocks::Axis;

/// A vertex and the record of the ghost that ends there, in one word: choosing between two takes
/// one instruction and no branch.
#[derive(Debug, Clone, Copy)]
pub struct Corner(u64);

impl Corner {
    /// The corner at `vertex`.
    #[inline]
    pub fn new(vertex: u32, ghost: u32) -> Self {
        Self(u64::from(vertex) << 32 | u64::from(ghost))
    }

    /// The vertex.
    #[inline]
    pub fn vertex(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The record of the ghost.
    #[inline]
    pub fn ghost(self) -> u32 {
        self.0 as u32
    }

    /// This corner, with the ghost of `new` if both are at the same vertex.
    #[inline]
    fn renewed(self, new: Self) -> Self {
        Self::choose(self.vertex() == new.vertex(), new, self)
    }

    #[inline]
    fn choose(condition: bool, yes: Self, no: Self) -> Self {
        Self(select_unpredictable(condition, yes.0, no.0))
    }
}

/// A triangulated part. The ghosts on its hull have their infinite corner first.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// First and last along X, first and last along Y.
    ends: [Corner; 4],
    /// Whether it is one vertex, which has no ghost.
    pub single: bool,
}

impl Part {
    /// The part of one vertex.
    pub fn single(vertex: u32) -> Self {
        Self {
            ends: [Corner::new(vertex, 0); 4],
            single: true,
        }
    }

    /// The part whose hull has the `corners`; all extreme vertices must be among them.
    #[inline]
    pub fn with_corners<const N: usize>(points: &[Point2], corners: [Corner; N]) -> Self {
        let ends = |axis: Axis| {
            let (mut first, mut last) = (corners[0], corners[0]);
            for &c in &corners[1..] {
                first = Corner::choose(before(points, axis, c, first), c, first);
                last = Corner::choose(before(points, axis, last, c), c, last);
            }
            [first, last]
        };
        let ([a, b], [c, d]) = (ends(Axis::X), ends(Axis::Y));
        Self {
            ends: [a, b, c, d],
            single: false,
        }
    }

    /// The part bounded by the hull of `ghost`; its ghosts are rotated so that their infinite
    /// corner is first.
    pub fn with_hull(mesh: &mut Patch, points: &[Point2], ghost: Code) -> Self {
        let corner = |mesh: &mut Patch, g: Code| {
            let g = mesh.turn(g);
            Corner::new(mesh.head(g), triangle(g))
        };
        let start = corner(mesh, ghost);
        let mut part = Self::with_corners(points, [start]);
        let mut g = mesh.after(half_edge(start.ghost(), 0));
        while triangle(g) != start.ghost() {
            let other = Self::with_corners(points, [corner(mesh, g)]);
            part = Self::joined(points, [&part, &other]);
            g = mesh.after(g & !7);
        }
        part
    }

    /// The first corner along an axis.
    #[inline]
    pub fn first(&self, axis: Axis) -> Corner {
        self.ends[2 * usize::from(axis == Axis::Y)]
    }

    /// The last corner along an axis.
    #[inline]
    pub fn last(&self, axis: Axis) -> Corner {
        self.ends[2 * usize::from(axis == Axis::Y) + 1]
    }

    /// Some ghost.
    pub fn ghost(&self) -> Code {
        half_edge(self.ends[0].ghost(), 0)
    }

    /// The extremes of two parts together.
    #[inline(always)]
    fn joined(points: &[Point2], [a, b]: [&Self; 2]) -> Self {
        let end = |i: usize, axis: Axis| {
            let (p, q) = (a.ends[i], b.ends[i]);
            // Odd places are the last ends: there the later of the two is chosen.
            let (p, q) = if i % 2 == 1 { (q, p) } else { (p, q) };
            Corner::choose(before(points, axis, p, q), a.ends[i], b.ends[i])
        };
        Self {
            ends: [
                end(0, Axis::X),
                end(1, Axis::X),
                end(2, Axis::Y),
                end(3, Axis::Y),
            ],
            single: false,
        }
    }

    /// The same after a merge, in which one ghost of each part got a new successor.
    #[inline]
    pub fn merged(
        points: &[Point2],
        left: &Self,
        right: &Self,
        upper: Corner,
        lower: Corner,
    ) -> Self {
        let renewed = |part: &Self, new: Corner| Self {
            ends: part.ends.map(|c| c.renewed(new)),
            single: false,
        };
        Self::joined(points, [&renewed(left, upper), &renewed(right, lower)])
    }

    /// The longer side of the box of two parts.
    #[inline]
    pub fn side(points: &[Point2], [a, b]: [&Self; 2]) -> f64 {
        let at = |part: &Self, i: usize| points[part.ends[i].vertex() as usize][i / 2];
        let length = |i: usize| {
            let (p, q) = (at(a, i), at(b, i));
            let least = if p < q { p } else { q };
            let (p, q) = (at(a, i + 1), at(b, i + 1));
            let most = if p > q { p } else { q };
            most - least
        };
        let (x, y) = (length(0), length(2));
        if x > y { x } else { y }
    }
}

#[inline]
fn before(points: &[Point2], axis: Axis, p: Corner, q: Corner) -> bool {
    axis.before(points[p.vertex() as usize], points[q.vertex() as usize])
}
