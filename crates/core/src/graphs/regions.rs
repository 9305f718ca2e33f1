//! Edges whose region contains no other point: Gabriel graphs, relative neighborhood graphs and
//! beta skeletons.
//!
//! K. R. Gabriel and R. R. Sokal, "A new statistical approach to geographic variation analysis"
//! (1969); G. T. Toussaint, in Pattern Recognition 12 (1980); D. G.
//! Kirkpatrick and J. D. Radke, "A framework for computational morphology" (1985).
//!
//! Why the neighbors of one end decide the diametral ball: a point b has an empty ball with a if and
//! only if (p - a) . (b - p) <= 0 for all p, that is, if it lies in the Voronoi cell of a, enlarged
//! about a to twice its size. The sides of a cell belong to Delaunay neighbors, so these suffice,
//! in any triangulation, and in a plane or line, too. For a neighbor b the sign is 0 only where the
//! closed ball is not empty. A circle-based region is decided by the apexes of an edge, which are
//! neighbors: no other point on their side sees it under a larger angle.
//!
//! Lunes reach beyond: after the neighbors, a tree of boxes is searched for a point in both balls of
//! radius |ab| around the ends, which contain all lunes.

use delone_predicates::proximity::{angle, arcs, lune};
use delone_predicates::{Point2, Sign};

use super::edges::Skeleton;
use super::tree::{Tree, certainly_above, squared, squared_gap};
use crate::base::error::Result;
use crate::base::watch::Watch;

/// The region of an edge that must be empty.
#[derive(Clone, Copy)]
pub enum Region {
    /// The ball whose diameter the edge is.
    Ball,
    /// The intersection of two balls, for a parameter above 1, up to 2.
    Lune(f64),
    /// The union of two disks, for a parameter above 1, up to 2; in 2-D only.
    Arcs(f64),
}

/// The edges whose region is empty, `closed` or open; a lune needs a tree of the points.
pub fn filter<const D: usize>(
    skeleton: &Skeleton<D>,
    region: Region,
    closed: bool,
    tree: Option<&Tree<D>>,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    skeleton.map(workers, watch, |edge| {
        let [i, j] = skeleton.by_degree(edge);
        let (a, b) = (skeleton.at(i), skeleton.at(j));
        let holds = |p: [f64; D]| match region {
            Region::Ball => blocks(-angle(a, p, b), closed),
            Region::Lune(beta) => {
                blocks(lune(a, b, p, beta), closed) && blocks(lune(b, a, p, beta), closed)
            }
            Region::Arcs(beta) => {
                let [a, b, p] = [a, b, p].map(flat);
                blocks(arcs(a, b, p, beta), closed)
            }
        };
        if skeleton
            .around(i)
            .iter()
            .any(|&v| v != j && holds(skeleton.at(v)))
        {
            return None;
        }
        let clear = match (region, tree) {
            (Region::Lune(_), Some(tree)) => is_clear(tree, a, b, holds),
            _ => true,
        };
        clear.then_some(edge)
    })
}

/// Whether a point with this sign is in an open or closed region.
#[inline]
pub(super) fn blocks(sign: Sign, closed: bool) -> bool {
    sign == Sign::Positive || closed && sign == Sign::Zero
}

/// The first two coordinates.
#[inline]
fn flat<const D: usize>(p: [f64; D]) -> Point2 {
    [p[0], p[1]]
}

/// Whether no point but `a` and `b` is in a region inside both balls around them.
fn is_clear<const D: usize>(
    tree: &Tree<D>,
    a: [f64; D],
    b: [f64; D],
    holds: impl Fn([f64; D]) -> bool,
) -> bool {
    let within = squared(a, b);
    tree.boxes.each(
        &mut Vec::with_capacity(64),
        |extent, _, _| {
            let beyond = |q| certainly_above(squared_gap(extent, q), within);
            !beyond(a) && !beyond(b)
        },
        |place| {
            let p = tree.points[place];
            p == a || p == b || !holds(p)
        },
    )
}
