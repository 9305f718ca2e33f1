//! Facets that are flat up to a distance: parts in one plane whose vertices are all near the plane of
//! the largest part.

use std::cmp::Reverse;

use super::judge::{Vector, cross, distance, dot, minus};
use super::mesh::{Mesh, Side};
use super::repeated;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::sets::Sets;

/// A wall at an edge: the edge, the wall's number, its third vertex, and a side of it.
pub type AtEdge = ([u32; 2], u32, u32, Side);

/// Walls are joined with a plane if the cosine of the angle between them is above this, unless they
/// are so thin that their direction means nothing.
const LEVEL: f64 = 0.5;

/// Joins exact facets that are neighbors, the largest first: a facet joins that of another if all of
/// its vertices are within the tolerance of the other's plane. So all vertices of a joined facet are
/// within the tolerance of one plane, however many parts it has. `bent` has pairs of walls at an edge,
/// and whether they are on opposite sides of it; others are joined only if one is thin.
pub fn join(
    mesh: &Mesh,
    walls: &[AtEdge],
    bent: &[(u32, u32, bool)],
    sets: &mut Sets,
    tolerance: f64,
) -> Result<()> {
    let count = mesh.facet.len();
    // The walls of each exact facet, once each: a wall has three edges.
    let mut of_facet: Vec<(u32, u32, [u32; 3])> = with_room(walls.len() / 3)?;
    for &(ends, wall, third, _) in walls {
        if third > ends[1] {
            of_facet.push((sets.root(wall), wall, [ends[0], ends[1], third]));
        }
    }
    of_facet.sort_unstable();
    let range = |facet: u32| {
        let first = of_facet.partition_point(|w| w.0 < facet);
        let last = of_facet.partition_point(|w| w.0 <= facet);
        &of_facet[first..last]
    };
    let normal = |corners: [u32; 3]| -> Vector {
        let [a, b, c] = mesh.places_of(corners);
        cross(minus(b, a), minus(c, a))
    };
    // The largest wall of each facet, with its area; facets by descending area.
    let mut area: Vec<f64> = repeated(count, 0.0)?;
    let mut largest: Vec<(f64, [u32; 3])> = repeated(count, (-1.0, [0; 3]))?;
    for &(facet, _, corners) in &of_facet {
        let n = normal(corners);
        let own = dot(n, n).sqrt();
        area[facet as usize] += own;
        if own > largest[facet as usize].0 {
            largest[facet as usize] = (own, corners);
        }
    }
    let mut order: Vec<u32> = of_facet.iter().map(|w| w.0).collect();
    order.dedup();
    order.sort_by(|&a, &b| {
        let of = |f: u32| (area[f as usize], Reverse(f));
        of(b).partial_cmp(&of(a)).unwrap_or(a.cmp(&b))
    });
    // Which walls are thinner than what lies between two parallel planes at the tolerance.
    let mut thin = repeated(count, false)?;
    for &(_, wall, corners) in &of_facet {
        let [a, b, c] = mesh.places_of(corners);
        let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
        let n = normal(corners);
        thin[wall as usize] = dot(n, n).sqrt() <= 2.0 * tolerance * longest;
    }
    // Facets that are neighbors, both ways.
    let mut beside: Vec<[u32; 2]> = with_room(2 * bent.len())?;
    for &(i, j, opposite) in bent {
        if opposite || thin[i as usize] || thin[j as usize] {
            let (f, g) = (sets.root(i), sets.root(j));
            beside.extend([[f, g], [g, f]]);
        }
    }
    beside.sort_unstable();
    beside.dedup();

    let mut taken = repeated(count, false)?;
    let mut reached: Vec<u32> = Vec::new();
    for &seed in &order {
        if taken[seed as usize] {
            continue;
        }
        taken[seed as usize] = true;
        let (length, corners) = largest[seed as usize];
        if length <= 0.0 {
            continue;
        }
        let n = normal(corners).map(|x| x / length);
        let [origin, ..] = mesh.places_of(corners);
        let is_near = |facet: u32| {
            range(facet).iter().all(|&(_, wall, corners)| {
                let own = normal(corners);
                let level = thin[wall as usize] || dot(own, n).abs() > LEVEL * dot(own, own).sqrt();
                let places = mesh.places_of(corners);
                level
                    && places
                        .iter()
                        .all(|&p| dot(n, minus(p, origin)).abs() <= tolerance)
            })
        };
        // Through neighbors that are near the plane. Each facet is taken once.
        reached.clear();
        push(&mut reached, seed)?;
        let mut next = 0;
        while let Some(&facet) = reached.get(next) {
            next += 1;
            let first = beside.partition_point(|b| b[0] < facet);
            for &[_, other] in beside[first..].iter().take_while(|b| b[0] == facet) {
                if !taken[other as usize] && is_near(other) {
                    taken[other as usize] = true;
                    push(&mut reached, other)?;
                }
            }
        }
        for &facet in &reached[1..] {
            sets.join(seed, facet);
        }
    }
    Ok(())
}
