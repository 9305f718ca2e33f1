//! Points in a flat: an affine subspace with fewer dimensions than the points have coordinates.
//!
//! The axes of a flat are coordinates that determine the others, so the projection to them is
//! injective, and simplices, hulls and barycentric coordinates are those of the projections. Lengths are
//! not. But heights may be lifted by all coordinates: |p|^2 is the square of the projection plus that of
//! the rest, which counts as a negative weight. So the Delaunay triangulation in a flat is the regular
//! triangulation of the projections with these weights, which `sites` computes in each stage, exactly in
//! the last one. If the axes are the first coordinates that determine the others, the projections have
//! the lexicographic order of the points, and ties are broken as everywhere.

use super::hull::{Hull, hull_of};
use super::sites::{Rest, Sites};
use super::triangulate::{Simplices, Sorted, distinct, made};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::points;
use crate::base::watch::Watch;

/// The canonical Delaunay triangulation of points in a flat, given by their coordinates along its axes,
/// the first that determine the others, and the `rest` of their coordinates.
pub fn triangulate_in_flat<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
    watch: &Watch,
) -> Result<Simplices<V>> {
    let (sites, rows, duplicates) = sorted_in_flat::<D, P>(points, rest)?;
    made(sites, &rows, duplicates, watch)
}

/// The convex hull in the flat; its facets have the Delaunay simplices of their planes.
pub fn hull_in_flat<const D: usize, const V: usize, const P: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
    watch: &Watch,
) -> Result<Hull<D>> {
    let (sites, rows, duplicates) = sorted_in_flat::<D, P>(points, rest)?;
    hull_of::<D, V, P>(sites, rows, duplicates, watch)
}

/// Finite points of a flat in lexicographic order.
pub fn sorted_in_flat<const D: usize, const P: usize>(
    points: &[[f64; D]],
    rest: &[Rest],
) -> Result<Sorted<D, P>> {
    points::scan(rest)?;
    let (distinct, rows, duplicates) = distinct(points)?;
    let mut kept = with_room(rows.len())?;
    kept.extend(rows.iter().map(|&row| rest[row as usize]));
    Ok((Sites::in_flat(distinct, kept)?, rows, duplicates))
}
