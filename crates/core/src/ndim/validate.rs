//! Exact proof that arrays are the canonical Delaunay triangulation of their points.
//!
//! Simplices that are positively oriented, with mutual neighbors, and a ghost at each facet of the
//! boundary are a closed surface of simplices once points are lifted. If it is convex at each ridge, by
//! the rule of ties, and one vertical line meets it once from below, it is the boundary of the convex
//! hull of the lifted points (K. Mehlhorn et al., "Checking geometric programs or verification of
//! geometric structures", 1999). Convexity at the facets of simplices is the Delaunay property, and at
//! the ridges of the boundary convexity of the hull. The line is that through the center of a simplex.

use num_bigint::BigInt;

use super::cell::Mesh;
use super::flat::sorted_in_flat;
use super::frame::Frame;
use super::simplex;
use super::sites::{Rest, Sites};
use super::triangulate::{Sorted, sorted, weighted};
use crate::base::arrays::{Given, Side};
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::{Pace, Watch};
use delone_predicates::Sign;

/// Simplices between two checks for interruption: one with integers takes up to a millisecond.
const PACE: usize = 1 << 8;

pub use crate::base::proof::Findings;

/// Checks every property of the canonical Delaunay triangulation of the points. Where simplices are
/// not positively oriented or neighbors are not mutual, the rest is not checked.
pub fn validate<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    watch: &Watch,
) -> Result<Findings<D>> {
    validated(given, sorted::<D, P>(given.points)?, watch)
}

/// The same of points in a flat; `given` has their coordinates along its axes.
pub fn validate_in_flat<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    rest: &[Rest],
    watch: &Watch,
) -> Result<Findings<D>> {
    validated(given, sorted_in_flat::<D, P>(given.points, rest)?, watch)
}

fn validated<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    (sites, rows, duplicates): Sorted<D, P>,
    watch: &Watch,
) -> Result<Findings<D>> {
    let mut stands_for = filled(given.points.len(), 0)?;
    for (row, own) in (0..).zip(&mut stands_for) {
        *own = row;
    }
    for [row, first] in duplicates {
        stands_for[row as usize] = first as i32;
    }
    checked(given, sites, &rows, &stands_for, watch)
}

/// The same of a regular triangulation; also, for each row, the one that represents it.
pub fn validate_regular<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    weights: &[f64],
    watch: &Watch,
) -> Result<(Findings<D>, Vec<i32>)> {
    let (sites, rows, _, stands_for) = weighted::<D, P>(given.points, weights)?;
    let found = checked(given, sites, &rows, &stands_for, watch)?;
    Ok((found, stands_for))
}

/// Checks the triangulation of sites, each of which one of the rows represents.
fn checked<const D: usize, const V: usize, const P: usize>(
    given: Given<D, V>,
    sites: Sites<D, P>,
    rows: &[u32],
    stands_for: &[i32],
    watch: &Watch,
) -> Result<Findings<D>> {
    let mut pace = Pace::new(watch, PACE);
    let mut found = Findings::default();
    // The number of each row in lexicographic order; those with the same coordinates share it.
    let mut rank = filled(given.points.len(), 0u32)?;
    for (number, &row) in (0u32..).zip(rows) {
        rank[row as usize] = number;
    }
    let mut used = filled(given.points.len(), false)?;
    for &v in given.simplices.as_flattened() {
        used[v as usize] = true;
    }
    for (row, &own) in stands_for.iter().enumerate() {
        let own = own as usize;
        rank[row] = rank[own];
        if used[row] && own != row {
            push(&mut found.repeats, row as u32)?;
            used[own] = true;
        }
    }
    let mut unused = Vec::new();
    for &row in rows.iter().filter(|&&row| !used[row as usize]) {
        push(&mut unused, row)?;
    }
    unused.sort_unstable();
    for t in 0..given.simplices.len() {
        pace.spend(1)?;
        if simplex::orientation::<D, V, P>(&given.corners(t)) != Sign::Positive {
            push(&mut found.orientation, t as u32)?;
        }
        if !is_mutual(&given, t, &rank) {
            push(&mut found.neighbors, t as u32)?;
        }
    }
    let is_weighted = !sites.weights.is_empty();
    if !is_weighted {
        found.missing = std::mem::take(&mut unused);
    }
    if !found.orientation.is_empty() || !found.neighbors.is_empty() || given.simplices.is_empty() {
        return Ok(found);
    }
    let mut mesh = Mesh::<D, V, P>::given(sites, &given, &rank)?;
    judged(&given, &mut mesh, &mut found, &mut pace)?;
    // Walks end in a regular triangulation.
    if found == Findings::default() {
        for row in unused {
            let p = rank[row as usize];
            match covering(&mut mesh, p, &mut pace)? {
                None => push(&mut found.missing, row)?,
                Some(t) if mesh.conflict(t, p)? => push(&mut found.hidden, row)?,
                Some(_) => {}
            }
        }
    }
    Ok(found)
}

/// The simplex that covers a site, by a visibility walk; `None` if it is outside.
fn covering<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    p: u32,
    pace: &mut Pace,
) -> Result<Option<u32>> {
    let mut here = 0;
    'walk: loop {
        for i in 0..V {
            pace.spend(1)?;
            if mesh.side(here, i, p)? < 0 {
                here = mesh.cells[here as usize].neighbors[i];
                if mesh.cells[here as usize].is_ghost() {
                    return Ok(None);
                }
                continue 'walk;
            }
        }
        return Ok(Some(here));
    }
}

/// Whether the neighbors of a simplex have it as theirs across the same facet.
fn is_mutual<const D: usize, const V: usize>(given: &Given<D, V>, t: usize, rank: &[u32]) -> bool {
    let at = |t: usize, k: usize| rank[given.simplices[t][k] as usize];
    (0..V).all(|corner| {
        let side = Side { simplex: t, corner };
        let Some(there) = given.beyond(side) else {
            return true;
        };
        let (s, j) = (there.simplex, there.corner);
        let back = given.neighbors[s]
            .iter()
            .filter(|&&n| n == t as i32)
            .count();
        let is_there = |v: u32| (0..V).any(|i| i != j && at(s, i) == v);
        back == 1
            && given.neighbors[s][j] == t as i32
            && (0..V).filter(|&i| i != corner).all(|i| is_there(at(t, i)))
            && at(s, j) != at(t, corner)
    })
}

/// Checks the facets of simplices, the ridges of the boundary, and one line.
fn judged<const D: usize, const V: usize, const P: usize>(
    given: &Given<D, V>,
    mesh: &mut Mesh<D, V, P>,
    found: &mut Findings<D>,
    pace: &mut Pace,
) -> Result<()> {
    for t in 0..given.simplices.len() {
        pace.spend(1)?;
        for corner in 0..V {
            let side = Side { simplex: t, corner };
            match given.beyond(side) {
                Some(there) if there.simplex > t => {
                    let apex = mesh.cells[there.simplex].vertices[there.corner];
                    if mesh.conflict(t as u32, apex)? {
                        let pair = [t, there.simplex].map(|t| t as u32);
                        let is_tie = mesh.power(t as u32, apex)? == 0;
                        push(
                            if is_tie {
                                &mut found.ties
                            } else {
                                &mut found.delaunay
                            },
                            pair,
                        )?;
                    }
                }
                Some(_) => {}
                None => {
                    let ghost = mesh.cells[t].neighbors[corner];
                    if !is_convex(given, mesh, ghost, side, pace)? {
                        let others = (0..V).filter(|&k| k != corner);
                        let facet: Vec<u32> =
                            others.map(|k| given.simplices[t][k] as u32).collect();
                        push(&mut found.hull, std::array::from_fn(|k| facet[k]))?;
                    }
                }
            }
        }
    }
    // One of the simplices covers the center of the first one; no other may.
    let sites = &mesh.sites;
    let first = mesh.cells[0].vertices;
    for t in 1..given.simplices.len() {
        pace.spend(1)?;
        if is_over(sites, &mesh.cells[t].vertices, &first) {
            push(&mut found.overlaps, t as u32)?;
        }
    }
    Ok(())
}

/// Whether the boundary is convex at the ridges of a facet: the corner of the next facet that is not on
/// the ridge is not beyond it, by the rule of ties.
fn is_convex<const D: usize, const V: usize, const P: usize>(
    given: &Given<D, V>,
    mesh: &mut Mesh<D, V, P>,
    ghost: u32,
    side: Side,
    pace: &mut Pace,
) -> Result<bool> {
    for ridge in (0..V).filter(|&k| k != side.corner) {
        // Around the ridge, from simplex to simplex: across the facet opposite `out`, while `kept` is
        // the other corner that is not on the ridge.
        let (mut t, mut out, mut kept) = (side.simplex, ridge, side.corner);
        let mut left = given.simplices.len();
        let apex = loop {
            pace.spend(1)?;
            let here = Side {
                simplex: t,
                corner: out,
            };
            let Some(there) = given.beyond(here) else {
                break mesh.cells[t].vertices[kept];
            };
            if left == 0 {
                return Ok(false);
            }
            left -= 1;
            let pivot = mesh.cells[t].vertices[kept];
            let next = &mesh.cells[there.simplex].vertices;
            out = next.iter().position(|&v| v == pivot).unwrap_or(0);
            (t, kept) = (there.simplex, there.corner);
        };
        if mesh.conflict(ghost, apex)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether a simplex covers the center of gravity of another one, boundary included.
fn is_over<const D: usize, const V: usize, const P: usize>(
    sites: &Sites<D, P>,
    corners: &[u32; V],
    of: &[u32; V],
) -> bool {
    // By boxes first, each a little larger; then rounded; then by integers. A coordinate of the center
    // is the mean of those of its corners: a sum of V quotients is off by less than 2 V u of the largest.
    let (here, there) = (sites.corners(corners), sites.corners(of));
    let (mut center, mut size) = ([0.0; D], 0.0f64);
    for k in 0..D {
        let (mut low, mut high, mut most) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
        for p in &here {
            (low, high) = (low.min(p[k]), high.max(p[k]));
        }
        for p in &there {
            center[k] += p[k] / V as f64;
            most = most.max(p[k].abs());
        }
        let slack = 1e-14 * most + f64::MIN_POSITIVE;
        if center[k] < low - slack || center[k] > high + slack {
            return false;
        }
        size = size.max(slack);
    }
    if simplex::is_outside::<D, V, P>(&here, &center, size) {
        return false;
    }
    let Some(frame) = Frame::new(sites, corners) else {
        return false;
    };
    (0..V).all(|i| {
        let shares = of.iter().map(|&p| frame.share(sites, corners[0], i, p));
        shares.sum::<BigInt>() >= BigInt::ZERO
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::watch::IDLE;
    use crate::ndim::triangulate;

    /// A triangulation as arrays of signed numbers.
    fn made(points: &[[f64; 4]]) -> (Vec<[i32; 5]>, Vec<[i32; 5]>) {
        let made = triangulate::<4, 5, 4>(points, &IDLE).unwrap();
        let signed = |rows: &[[u32; 5]]| rows.iter().map(|v| v.map(|i| i as i32)).collect();
        (signed(&made.simplices), made.neighbors)
    }

    fn found(points: &[[f64; 4]], simplices: &[[i32; 5]], neighbors: &[[i32; 5]]) -> Findings<4> {
        let given = Given {
            points,
            simplices,
            neighbors,
        };
        validate::<4, 5, 4>(given, &IDLE).unwrap()
    }

    /// Corners of a lattice and points anywhere: ties, flat parts of the hull, duplicates.
    fn points(seed: u64) -> Vec<[f64; 4]> {
        let mut x = seed;
        let mut next = || {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (x >> 33) as f64
        };
        (0..40)
            .map(|i| {
                [0; 4].map(|_| {
                    if i < 25 {
                        next() % 3.0
                    } else {
                        next() % 1024.0 / 512.0
                    }
                })
            })
            .collect()
    }

    #[test]
    fn what_the_kernel_makes_is_right() {
        for seed in 0..8 {
            let at = points(seed);
            let (simplices, neighbors) = made(&at);
            assert_eq!(found(&at, &simplices, &neighbors), Findings::default());
        }
    }

    #[test]
    fn each_fault_is_named() {
        let at = points(1);
        let (simplices, neighbors) = made(&at);
        let mut odd = simplices.clone();
        odd[7].swap(0, 1);
        assert_eq!(found(&at, &odd, &neighbors).orientation, [7]);
        let mut cut = neighbors.clone();
        let k = cut[5].iter().position(|&n| n >= 0).unwrap();
        let other = cut[5][k] as u32;
        cut[5][k] = -1;
        assert_eq!(found(&at, &simplices, &cut).neighbors, [other]);
        // The triangulation of other points, with one more.
        let mut more = at.clone();
        more.push([1.25, 0.75, 1.125, 0.5]);
        let wrong = found(&more, &simplices, &neighbors);
        assert_eq!(wrong.missing, [40]);
        // A point of the hull moved inward, and one inside moved outward.
        let mut moved = at.clone();
        let hull = (0..simplices.len())
            .find(|&t| neighbors[t].contains(&-1))
            .unwrap();
        let k = neighbors[hull].iter().position(|&n| n < 0).unwrap();
        let v = simplices[hull][(k + 1) % 5] as usize;
        moved[v] = moved[v].map(|x| x + (1.0 - x) * 1e-9);
        let wrong = found(&moved, &simplices, &neighbors);
        assert_ne!(wrong, Findings::default());
    }

    #[test]
    fn two_covers_overlap() {
        let at = points(2);
        let (mut simplices, mut neighbors) = made(&at);
        let m = simplices.len();
        simplices.extend_from_within(..);
        let shifted = |n: i32| if n < 0 { -1 } else { n + m as i32 };
        for t in 0..m {
            let row = neighbors[t].map(shifted);
            neighbors.push(row);
        }
        assert_eq!(found(&at, &simplices, &neighbors).overlaps, [m as u32]);
    }

    #[test]
    fn another_choice_among_ties_is_not_canonical() {
        // The reflection of a lattice in the order of its points has other diagonals.
        let grid: Vec<[f64; 4]> = (0..16)
            .map(|i| [0, 1, 2, 3].map(|k| f64::from(i >> k & 1)))
            .collect();
        let reflected: Vec<[f64; 4]> = grid
            .iter()
            .map(|p| [1.0 - p[0], p[1], p[2], p[3]])
            .collect();
        let (mut simplices, mut neighbors) = made(&reflected);
        for (v, n) in simplices.iter_mut().zip(&mut neighbors) {
            v.swap(0, 1);
            n.swap(0, 1);
        }
        let wrong = found(&grid, &simplices, &neighbors);
        assert!(wrong.delaunay.is_empty() && wrong.orientation.is_empty());
        assert!(!wrong.ties.is_empty() || !wrong.hull.is_empty());
    }
}
