//! Second neighbors around vertices of high degree, bounded so that the total stays linear.
//!
//! The center of a circle of n points has n neighbors, and if each of them used all of those, the
//! total would be n^2.
//!
//! Of a hub's neighbors a vertex uses those that precede and follow it around the hub, and as many
//! that are spread evenly around, as an arc alone hardly determines a quadric. Directions are
//! compared exactly, so the choice depends on the coordinates only.

use std::cmp::Ordering;
use std::collections::HashMap;

use delone_predicates::{Point2, Sign, orient2d};

use super::adjacency::Adjacency;
use crate::base::error::Result;
use crate::base::watch::{Pace, Watch};

/// The number of neighbors above which a vertex is a hub. Among scattered points none has half as
/// many.
const MANY: usize = 32;
/// Vertices, and neighbors of hubs, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The neighbors of a hub.
struct Ring {
    /// Counterclockwise.
    around: Vec<i32>,
    /// Each with its index in `around`, sorted by vertex.
    places: Vec<(i32, usize)>,
}

/// Vertices with the neighbors of their neighbors.
pub struct Hubs<'a> {
    /// The neighbors.
    pub adjacency: Adjacency<'a>,
    rings: HashMap<i32, Ring>,
}

impl<'a> Hubs<'a> {
    /// Sorts the neighbors of hubs.
    pub fn of(points: &[Point2], adjacency: Adjacency<'a>, watch: &Watch) -> Result<Self> {
        let mut pace = Pace::new(watch, LOT);
        let mut rings = HashMap::new();
        let all = 0..adjacency.vertices();
        for v in all {
            pace.spend(1)?;
            if adjacency.neighbors(v).len() <= MANY {
                continue;
            }
            pace.spend(adjacency.neighbors(v).len())?;
            let mut around = adjacency.neighbors(v).to_vec();
            let at = |u: i32| points[u as usize];
            around.sort_unstable_by(|&a, &b| turn(points[v], at(a), at(b)).then(a.cmp(&b)));
            let places = around.iter().enumerate().map(|(i, &u)| (u, i));
            let mut places: Vec<(i32, usize)> = places.collect();
            places.sort_unstable();
            rings.insert(v as i32, Ring { around, places });
        }
        Ok(Self { adjacency, rings })
    }

    /// Adds the neighbors of `u` that count for `v`, usually its neighbor.
    fn extend(&self, u: i32, v: i32, found: &mut Vec<i32>) {
        let Some(ring) = self.rings.get(&u) else {
            found.extend_from_slice(self.adjacency.neighbors(u as usize));
            return;
        };
        let known = ring.places.binary_search_by_key(&v, |&(vertex, _)| vertex);
        let place = known.map_or(0, |i| ring.places[i].1);
        let n = ring.around.len();
        let (first, part) = (place + n - MANY / 4, MANY / 2);
        found.extend((first..=first + part).map(|i| ring.around[i % n]));
        found.extend((1..part).map(|i| ring.around[(place + i * n / part) % n]));
    }

    /// Extends a ring around `v` by the neighbors of all in it that count for `v`.
    pub fn widen(&self, v: usize, ring: &mut Vec<i32>) {
        for i in 0..ring.len() {
            self.extend(ring[i], v as i32, ring);
        }
        ring.sort_unstable();
        ring.dedup();
        ring.retain(|&u| u as usize != v);
    }
}

/// The order of directions from `o`, counterclockwise from the x-axis.
fn turn(o: Point2, a: Point2, b: Point2) -> Ordering {
    let is_low = |p: Point2| p[1] < o[1] || (p[1] == o[1] && p[0] < o[0]);
    is_low(a)
        .cmp(&is_low(b))
        .then_with(|| match orient2d(o, a, b) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_follow_each_other_around() {
        let ways = [
            [3.0, 0.0],
            [1.0, 1.0],
            [0.0, 2.0],
            [-1.0, 5e-324],
            [-1.0, 0.0],
            [0.0, -1.0],
        ];
        for (i, &a) in ways.iter().enumerate() {
            for (j, &b) in ways.iter().enumerate() {
                assert_eq!(turn([0.0; 2], a, b), i.cmp(&j), "{a:?} {b:?}");
            }
        }
    }
}
