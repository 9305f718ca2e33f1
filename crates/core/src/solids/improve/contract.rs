//! Edge contraction: a vertex is removed by moving it onto a neighbor.
//!
//! ```text
//!        a-------b              a-------b
//!       / \     / \            / \     / \      The tetrahedra at both ends of the edge v u
//!      /   \   /   \          /   \   /   \     vanish; the other ones of v are joined to u.
//!     c-----v-------u   ->   c-----\-/-----u
//!      \   / \     /          \  -  |  -  /
//!       \ /   \   /            \ /  |   \/
//!        d-----e                d---e---
//! ```
//!
//! The tetrahedra at v fill a ball, since v is not on a wall. The new ones join u, which is on the
//! boundary of the ball, to the faces of the ball that do not contain u. So as chains, old and new
//! tetrahedra have the same boundary; if all new ones are positive, they cover the ball once (the argument
//! is that of `insert`). No condition on the links of u and v is required: an edge or face that occurred
//! twice would lie both inside and outside the ball.

use super::edge::Plan;
use super::measure::quality;
use super::store::{Corners, Store};

/// The best contraction of a vertex with the tetrahedra `star`, if its worst new tetrahedron is better
/// than `above`. Among equally good ones, the contraction to the smallest vertex.
pub fn remove(store: &Store, v: u32, star: &[u32], above: f64) -> Option<Plan> {
    let corners = star.iter().flat_map(|&t| store.corners[t as usize]);
    let mut neighbors: Vec<u32> = corners.filter(|&u| u != v).collect();
    neighbors.sort_unstable();
    neighbors.dedup();
    let (mut value, mut onto) = (above, None);
    for u in neighbors {
        let mut least = f64::INFINITY;
        for corners in moved(store, v, u, star) {
            least = least.min(quality(store.places_of(corners)));
            if least <= value {
                break;
            }
        }
        // If there are no new tetrahedra, u is not on the boundary of the ball.
        if least > value && least < f64::INFINITY {
            (value, onto) = (least, Some(u));
        }
    }
    let u = onto?;
    Some(Plan {
        old: star.to_vec(),
        new: moved(store, v, u, star).collect(),
        least: value,
        turning: false,
    })
}

/// The tetrahedra of a star with its vertex replaced by another one; those that contain both vanish.
fn moved(store: &Store, v: u32, u: u32, star: &[u32]) -> impl Iterator<Item = Corners> {
    star.iter()
        .map(|&t| store.corners[t as usize])
        .filter(move |corners| !corners.contains(&u))
        .map(move |corners| corners.map(|w| if w == v { u } else { w }))
}
