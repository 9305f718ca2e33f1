//! Triangulates rows of coordinates: scan, sort, a first simplex, insertion, export.

use delone_predicates::lexicographic;
use num_bigint::BigInt;

use super::cell::Mesh;
use super::dispatch;
use super::frame::Integers;
use super::order::arranged;
use super::sites::Sites;
use crate::base::error::{Error, Result};
use crate::base::memory::{self, filled, with_room};
use crate::base::points;
use crate::base::watch::{Pace, Watch};
use crate::regular::{Heaviest, heaviest};

/// Units of work between two checks for interruption: a cell takes a microsecond, and one with
/// integers up to a millisecond.
const PACE: usize = 1 << 10;

/// A triangulation as arrays.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplices<const V: usize> {
    /// Rows of the corners of each simplex, positively oriented.
    pub simplices: Vec<[u32; V]>,
    /// The simplex opposite each corner, -1 outside.
    pub neighbors: Vec<[i32; V]>,
    /// Rows that repeat earlier rows, ascending, and the first of these.
    pub duplicates: Vec<[u32; 2]>,
}

/// The canonical Delaunay triangulation of points.
///
/// `V` is `D + 1`, and `P` is at least `D`: 4 in up to four dimensions, 8 in more, is fast.
pub fn triangulate<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    watch: &Watch,
) -> Result<Simplices<V>> {
    const { assert!(V == D + 1 && P >= D && D >= 2 && D <= 8) };
    let (sites, rows, duplicates) = sorted::<D, P>(points)?;
    made(sites, &rows, duplicates, watch)
}

/// The canonical regular triangulation of points with finite weights, and for each row the row that
/// represents it: the first of the heaviest rows with the same coordinates. Points that are in no
/// simplex are hidden.
pub fn regular<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    weights: &[f64],
    watch: &Watch,
) -> Result<(Simplices<V>, Vec<i32>)> {
    let (sites, rows, duplicates, stands_for) = weighted::<D, P>(points, weights)?;
    Ok((made(sites, &rows, duplicates, watch)?, stands_for))
}

/// The triangulation of sites, which have the given rows.
pub fn made<const D: usize, const V: usize, const P: usize>(
    sites: Sites<D, P>,
    rows: &[u32],
    duplicates: Vec<[u32; 2]>,
    watch: &Watch,
) -> Result<Simplices<V>> {
    let mut pace = Pace::new(watch, PACE);
    let order = arranged::<D, P>(&sites.scaled)?;
    let mesh = inserted::<D, V, P>(sites, rows, &order, &mut pace)?;
    let (mut simplices, neighbors) = mesh.export()?;
    for v in simplices.as_flattened_mut() {
        *v = rows[*v as usize];
    }
    Ok(Simplices {
        simplices,
        neighbors,
        duplicates,
    })
}

/// The sites, the row of each, the pairs of rows that are equal, and for each row the one that
/// represents it.
type Heavy<const D: usize, const P: usize> = (Sites<D, P>, Vec<u32>, Vec<[u32; 2]>, Vec<i32>);

/// Distinct points with weights.
pub fn weighted<const D: usize, const P: usize>(
    points: &[[f64; D]],
    weights: &[f64],
) -> Result<Heavy<D, P>> {
    let (distinct, firsts, duplicates) = distinct(points)?;
    let Heaviest {
        rows,
        weights,
        stands_for,
    } = heaviest(weights, &firsts, &duplicates)?;
    let sites = Sites::weighted(distinct, weights)?;
    Ok((sites, rows, duplicates, stands_for))
}

/// Distinct points, the first row of each, and the pairs of rows that are equal.
pub type Sorted<const D: usize, const P: usize> = (Sites<D, P>, Vec<u32>, Vec<[u32; 2]>);

/// Finite points in lexicographic order, so that their numbers compare as they do.
pub fn sorted<const D: usize, const P: usize>(points: &[[f64; D]]) -> Result<Sorted<D, P>> {
    let (distinct, rows, duplicates) = distinct(points)?;
    Ok((Sites::new(distinct)?, rows, duplicates))
}

/// The coordinates, first rows, and pairs of equal rows.
pub type Distinct<const D: usize> = (Vec<[f64; D]>, Vec<u32>, Vec<[u32; 2]>);

pub fn distinct<const D: usize>(points: &[[f64; D]]) -> Result<Distinct<D>> {
    points::scan(points)?;
    let mut all = with_room(points.len())?;
    all.extend((0u32..).zip(points).map(|(row, _)| row));
    let at = |row: u32| points[row as usize];
    all.sort_unstable_by(|&i, &j| lexicographic(at(i), at(j)).then(i.cmp(&j)));
    let (mut rows, mut duplicates) = (with_room(points.len())?, Vec::new());
    for row in all {
        match rows.last() {
            Some(&first) if lexicographic(at(first), at(row)).is_eq() => {
                memory::push(&mut duplicates, [row, first])?;
            }
            _ => rows.push(row),
        }
    }
    duplicates.sort_unstable();
    let mut distinct = with_room(rows.len())?;
    distinct.extend(rows.iter().map(|&row| at(row)));
    Ok((distinct, rows, duplicates))
}

/// A mesh of all sites, inserted in the given order.
pub fn inserted<const D: usize, const V: usize, const P: usize>(
    sites: Sites<D, P>,
    rows: &[u32],
    order: &[u32],
    pace: &mut Pace,
) -> Result<Mesh<D, V, P>> {
    let corners: [u32; V] = simplex_of(&sites, rows, order, pace)?;
    let mut used = filled(sites.len(), false)?;
    for &v in &corners {
        used[v as usize] = true;
    }
    let mut mesh = Mesh::new(sites, corners)?;
    dispatch::insert_all(&mut mesh, order, &used, pace)?;
    Ok(mesh)
}

/// The first points of `order` that are the corners of a simplex; an error if all lie in a flat.
pub fn simplex_of<const D: usize, const V: usize, const P: usize>(
    sites: &Sites<D, P>,
    rows: &[u32],
    order: &[u32],
    pace: &mut Pace,
) -> Result<[u32; V]> {
    let first = independent(sites, order, pace)?;
    <[u32; V]>::try_from(first.as_slice()).map_err(|_| {
        let mut spanning: Vec<u32> = first.iter().map(|&v| rows[v as usize]).collect();
        spanning.sort_unstable();
        Error::Flat {
            dimension: D,
            distinct: sites.len(),
            rows: spanning,
        }
    })
}

/// The first points of `order` that are affinely independent, up to D + 1 of them: exact, by
/// fraction-free elimination of the differences (Bareiss), a row for each point that is kept.
pub fn independent(sites: &impl Integers, order: &[u32], pace: &mut Pace) -> Result<Vec<u32>> {
    let d = sites.dimension();
    let Some((&origin, others)) = order.split_first() else {
        return Ok(Vec::new());
    };
    let (mut kept, mut rows) = (vec![origin], Vec::<(usize, Vec<BigInt>)>::new());
    for &p in others {
        pace.spend(16)?;
        let mut row: Vec<BigInt> = (0..d).map(|k| sites.wide(p, origin, k)).collect();
        let mut previous = BigInt::from(1);
        for (pivot, of_pivot) in &rows {
            let factor = row[*pivot].clone();
            for k in 0..d {
                // The division has no remainder: the result is a minor.
                row[k] = (&of_pivot[*pivot] * &row[k] - &factor * &of_pivot[k]) / &previous;
            }
            previous = of_pivot[*pivot].clone();
        }
        if let Some(pivot) = row.iter().position(|x| *x != BigInt::ZERO) {
            rows.push((pivot, row));
            kept.push(p);
            if kept.len() == d + 1 {
                break;
            }
        }
    }
    Ok(kept)
}
