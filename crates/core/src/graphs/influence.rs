//! The sphere of influence graph: pairs whose spheres, each through the nearest neighbor of its
//! center, meet.
//!
//! G. T. Toussaint, "A graph-theoretical primal sketch" (1988). The tree of boxes has, for each
//! box, the largest radius in it; a box is skipped if its distance exceeds the sum of that and the
//! radius of the point.

use delone_predicates::Sign;
use delone_predicates::proximity::spheres;

use super::edges::{SHARE, joined, sorted};
use super::nearest::each;
use super::tree::{Tree, squared_gap};
use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};

/// Points between two checks for interruption.
const LOT: usize = 1 << 8;
/// Added to radii, which may be lost to underflow.
const TINY: f64 = 1e-160;

/// The edges between points of a tree of `n` rows whose spheres overlap or, if `closed`, touch.
pub fn influence<const D: usize>(
    tree: &Tree<D>,
    closed: bool,
    n: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<[i32; 2]>> {
    if tree.len() < 2 {
        return Ok(Vec::new());
    }
    let near = each(tree, 1, workers, watch, |_, best, found| {
        push(found, best[0])
    })?;
    // A little larger, so that rounding excludes no box.
    let radius = |&(square, _): &(f64, u32)| square.sqrt() * (1.0 + 1e-14) + TINY;
    let radii: Vec<f64> = near.iter().map(radius).collect();
    let largest = |radii: &[f64]| radii.iter().fold(0.0, |most: f64, &r| most.max(r));
    let reach = tree
        .boxes
        .values(|places| largest(&radii[places]), largest)?;
    let shares = (0..tree.len()).step_by(SHARE).collect();
    let parts = parallel::map_watched(workers, shares, watch, |first| {
        let (mut found, mut open) = (Vec::new(), Vec::with_capacity(64));
        let mut here = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for place in first..tree.len().min(first + SHARE) {
            let (a, c) = (tree.points[place], tree.points[near[place].1 as usize]);
            tree.boxes.each(
                &mut open,
                |extent, level, i| {
                    let most = radii[place] + reach[level][i];
                    let away = squared_gap(extent, a).sqrt() * (1.0 - 1e-14);
                    tree.boxes.items(level, i).end > place + 1
                        && (away <= most || away == f64::INFINITY)
                },
                |other| {
                    if other > place {
                        let (b, d) = (tree.points[other], tree.points[near[other].1 as usize]);
                        let sign = spheres(a, c, b, d);
                        if sign == Sign::Positive || closed && sign == Sign::Zero {
                            here.push(other);
                        }
                    }
                    true
                },
            );
            pace.spend(1)?;
            for other in here.drain(..) {
                let [a, b] = [place, other].map(|at| tree.rows[at] as i32);
                push(&mut found, [a.min(b), a.max(b)])?;
            }
        }
        Ok(found)
    })?;
    sorted(&joined(&parts)?, n, watch)
}
