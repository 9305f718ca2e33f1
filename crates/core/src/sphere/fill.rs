//! Inserts the directions of a block, one after another.
//!
//! The order is that of `delaunay::plane::bowyer_watson`. Here, no other method takes over if
//! cavities are large. Each insertion terminates, so the build terminates for any input, but it may
//! take quadratic time.

use std::ops::Range;

use delone_predicates::Sign;

use super::directions::Directions;
use super::kernel::Kernel;
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, triangle};
use crate::order::Rounds;

/// Strides of the rounds, as in 2-D.
const STRIDES: [u32; 3] = [64, 8, 1];
/// Directions between two checks for interruption in the search for the first triangle.
const LOT: u32 = 1 << 12;

/// A patch with the triangulation of a block.
pub struct Filled {
    /// The infinite corner of a ghost; `None` if the sphere is covered.
    pub ghost: Option<Code>,
    /// The number of records in use.
    pub taken: Range<u32>,
    /// Directions that are the same as a vertex, with that vertex.
    pub repeats: Vec<[u32; 2]>,
}

/// Fills `patch` with the directions of a block; `None` if they are all on one great circle.
pub fn fill(
    patch: Patch,
    directions: &Directions,
    block: Range<u32>,
    watch: &Watch,
) -> Result<Option<Filled>> {
    let Some(first) = first_triangle(directions, &block, watch)? else {
        return Ok(None);
    };
    let mut kernel = Kernel::start(directions, patch, first, watch);
    let mut order = rounds(&block).filter(|v| !first.contains(v));
    let mut near = kernel.ghost().map_or(0, triangle);
    let mut next = order.next();
    while let Some(p) = next {
        next = order.next();
        near = kernel.insert(p, near, next.unwrap_or(p))?;
    }
    Ok(Some(Filled {
        ghost: kernel.ghost(),
        taken: kernel.taken(),
        repeats: std::mem::take(&mut kernel.repeats),
    }))
}

/// The directions of a block in the order of their insertion.
fn rounds(block: &Range<u32>) -> impl Iterator<Item = u32> + use<> {
    let start = block.start;
    Rounds::over(block.len() as u32, STRIDES).map(move |i| start + i)
}

/// Three directions of a block that are not on one great circle, counterclockwise; `None` if all
/// are on one.
fn first_triangle(
    directions: &Directions,
    block: &Range<u32>,
    watch: &Watch,
) -> Result<Option<[u32; 3]>> {
    let order = || rounds(block);
    let Some(a) = order().next() else {
        return Ok(None);
    };
    let mut second = None;
    for c in order() {
        if c.is_multiple_of(LOT) {
            watch.check()?;
        }
        let Some(b) = second else {
            second = (!directions.parallel(a, c)).then_some(c);
            continue;
        };
        match directions.orient([a, b, c]) {
            Sign::Positive => return Ok(Some([a, b, c])),
            Sign::Negative => return Ok(Some([b, a, c])),
            Sign::Zero => {}
        }
    }
    Ok(None)
}
