//! The insertion order of a 3-D hull: extreme points first, points certainly inside skipped.
//!
//! Points that are extreme in some direction are inserted first; points inside their hull are
//! removed by `Cells` without a walk, and are not visited again. The others are inserted in rounds
//! in which the number of points doubles, each along a curve (N. Amenta, S. Choi and G. Rote,
//! "Incremental constructions con BRIO", 2003): O(n log n) expected, with walks of a few steps.

use delone_predicates::{Point3, Sign, orient3d};

use super::cells::{Cells, Grid};
use super::insertion::{Facet, Hull, in_line};
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::watch::Watch;
use crate::order::{order_of, random};

/// The number of directions whose extreme points are inserted first, on a spiral over the sphere.
const DIRECTIONS: usize = 40;
/// The size of a sample that suffices for them.
const SAMPLE: usize = 1 << 9;
/// From this many points on, cells of directions save more walks than they cost.
const MANY: usize = 1 << 8;
/// Points between two checks for interruption.
const LOT: usize = 1 << 16;
/// No row.
const NONE: u32 = u32::MAX;

/// A closed surface of triangles around all points.
#[derive(Debug)]
pub struct Surface {
    /// Counterclockwise seen from outside; none is degenerate.
    pub facets: Vec<Facet>,
    /// Four points that are not coplanar.
    pub first: [Point3; 4],
    /// The rows that may coincide with a vertex, ascending.
    pub rows: Vec<u32>,
}

/// The surface around finite points; `None` if they span no volume.
pub fn surface(points: &[Point3], watch: &Watch) -> Result<Option<Surface>> {
    let mut rows = with_room(points.len())?;
    rows.extend(0..points.len() as u32);
    let share = (points.len() / SAMPLE).max(1) as u64;
    let is_early = |&row: &u32| random(row).is_multiple_of(share);
    let early: Vec<u32> = rows.iter().copied().filter(is_early).collect();
    let extreme = extreme_points(points, &early);
    let Some(first) = first_tetrahedron(points, &extreme, &rows) else {
        return Ok(None);
    };
    let mut hull = Hull::start(points, first)?;
    hull.insert_all(&extreme, watch)?;
    let mut done = filled(points.len(), false)?;
    let mut note = |rows: &[u32]| rows.iter().for_each(|&row| done[row as usize] = true);
    note(&extreme);
    note(&first);
    if points.len() > MANY
        && let Some(grid) = Grid::of(&hull, points.len())
    {
        let deepest = grid.deepest(points, watch)?;
        note(&deepest);
        hull.insert_all(&rounds(points, deepest, watch)?, watch)?;
        if let Some(cells) = Cells::of(&hull, grid) {
            let mut left = with_room(rows.len())?;
            for lot in rows.chunks(LOT) {
                watch.check()?;
                let out = |&row: &u32| !cells.holds(points[row as usize]);
                left.extend(lot.iter().copied().filter(out));
            }
            rows = left;
        }
        watch.check()?;
    }
    let late = rows.iter().copied().filter(|&row| !done[row as usize]);
    hull.insert_all(&rounds(points, late.collect(), watch)?, watch)?;
    Ok(Some(Surface {
        facets: live_facets(&hull.facets),
        first: first.map(|v| points[v as usize]),
        rows,
    }))
}

/// The live facets, renumbered.
fn live_facets(facets: &[Facet]) -> Vec<Facet> {
    let mut number = Vec::with_capacity(facets.len());
    let mut count = 0;
    for facet in facets {
        number.push(count);
        count += u32::from(facet.alive);
    }
    let alive = facets.iter().filter(|f| f.alive);
    let renumbered = |f: &Facet| Facet {
        beyond: f.beyond.map(|i| number[i as usize]),
        ..*f
    };
    alive.map(renumbered).collect()
}

/// Rows in random rounds, each twice as large as the one before and sorted along a curve.
fn rounds(points: &[Point3], rows: Vec<u32>, watch: &Watch) -> Result<Vec<u32>> {
    let mut at = with_room(rows.len())?;
    at.extend(rows.iter().map(|&row| points[row as usize]));
    let order = order_of::<3>(&at, 1, watch)?.concat();
    let mut rows: Vec<u32> = order.into_iter().map(|i| rows[i as usize]).collect();
    // Leading zeros of a random number: 0 for one half, the last round, 1 for a quarter, ...
    let mut last = with_room(rows.len())?;
    let mut rounds = Vec::new();
    for round in 0..=u64::BITS {
        if rows.is_empty() {
            break;
        }
        watch.check()?;
        let mut own = Vec::new();
        rows.retain(|&row| {
            let here = random(row).leading_zeros() == round;
            if here {
                own.push(row);
            }
            !here
        });
        rounds.push(own);
    }
    rounds.into_iter().rev().for_each(|own| last.extend(own));
    Ok(last)
}

/// The farthest points in directions all around, up to rounding; any points are valid.
fn extreme_points(points: &[Point3], rows: &[u32]) -> Vec<u32> {
    let at = |&row: &u32| points[row as usize];
    let largest = rows
        .iter()
        .flat_map(at)
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let golden = (3.0 - 5f64.sqrt()) * std::f64::consts::PI;
    let directions: Vec<Point3> = (0..DIRECTIONS)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / DIRECTIONS as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            [r * cos, r * sin, z]
        })
        .chain([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        .chain([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
        .collect();
    let few = (rows.len() >> 5).clamp(12, directions.len());
    let directions = &directions[directions.len() - few..];
    let mut most = vec![(f64::NEG_INFINITY, NONE); few];
    for row in rows {
        // Scaled, so that products of very large doubles do not all overflow to one infinity.
        let p = if largest > 1e300 {
            at(row).map(|x| x / 8.0)
        } else {
            at(row)
        };
        for (d, best) in directions.iter().zip(&mut most) {
            let along = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
            if along > best.0 {
                *best = (along, *row);
            }
        }
    }
    let mut found: Vec<u32> = most.into_iter().map(|(_, row)| row).collect();
    found.retain(|&row| row != NONE);
    found.sort_unstable();
    found.dedup();
    found
}

/// Four points that are not coplanar, positively oriented; extreme ones if possible.
fn first_tetrahedron(points: &[Point3], extreme: &[u32], all: &[u32]) -> Option<[u32; 4]> {
    let rows = || extreme.iter().chain(all).copied();
    let at = |v: u32| points[v as usize];
    let a = rows().next()?;
    let b = rows().find(|&b| at(b) != at(a))?;
    let c = rows().find(|&c| !in_line(at(a), at(b), at(c)))?;
    let side = |d: u32| orient3d(at(a), at(b), at(c), at(d));
    let d = rows().find(|&d| side(d) != Sign::Zero)?;
    Some(match side(d) {
        Sign::Positive => [a, b, c, d],
        _ => [a, c, b, d],
    })
}
