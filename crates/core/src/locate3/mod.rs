//! Which tetrahedron holds a point: exact, boundary included, for any tiling in exported arrays.
//!
//! The rooms are those of `locate`: `Locator` keeps a tree of starts, `batch` takes queries along a
//! curve and walks from each to the next, `star` finds the first of several that hold a point.

mod barycentric;
mod batch;
mod boundary;
mod nearest;
mod star;
mod tiling;
mod walk;

use std::sync::OnceLock;

use delone_predicates::Point3;

pub use barycentric::barycentric;
pub use batch::Batch;
pub use nearest::nearest;
pub use star::{Place, Star};
pub use tiling::{FACES, Side, Tetrahedra};

use crate::error::Result;
use crate::locate::{Output, Start};
use walk::{Found, scan, walk};

/// What is kept between calls for one triangulation.
#[derive(Debug)]
pub struct Kept {
    start: Start<3>,
    convex: OnceLock<bool>,
}

impl Kept {
    /// A tree of starts for many calls; the rest is found out when it is needed.
    pub fn of(given: &Tetrahedra) -> Result<Self> {
        let first = |t: usize| given.point(given.simplices[t][0]);
        Ok(Self {
            start: Start::of(given.simplices.len(), first)?,
            convex: OnceLock::new(),
        })
    }
}

/// A triangulation and what is kept for it.
#[derive(Clone, Copy)]
pub struct Locator<'a> {
    /// The arrays.
    pub given: Tetrahedra<'a>,
    kept: &'a Kept,
}

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Located {
    /// In a tetrahedron.
    Inside(Place),
    /// Outside of all, strictly beyond this boundary face where the boundary is convex.
    Outside(Side),
}

impl<'a> Locator<'a> {
    /// A locator of what was kept for the same arrays.
    pub fn new(given: Tetrahedra<'a>, kept: &'a Kept) -> Self {
        Self { given, kept }
    }

    /// A tetrahedron near `q`.
    #[inline]
    pub fn near(&self, q: Point3) -> usize {
        self.kept.start.near(q)
    }

    /// Where `q` is, on the way from tetrahedron `from`.
    #[inline]
    pub fn locate_from(&self, from: usize, q: Point3, star: &mut Star) -> Located {
        match walk(&self.given, from, q) {
            Some(Found::Inside(place)) => {
                let first = star.first(&self.given, place);
                if first.open && !self.is_convex() {
                    return Located::Inside(scan(&self.given, q).unwrap_or(first.place));
                }
                Located::Inside(first.place)
            }
            Some(Found::Beyond(side)) if self.is_convex() => Located::Outside(side),
            Some(Found::Beyond(side)) => {
                scan(&self.given, q).map_or(Located::Outside(side), Located::Inside)
            }
            None => match scan(&self.given, q) {
                Some(place) => Located::Inside(place),
                None => Located::Outside(self.given.beyond_which(q)),
            },
        }
    }

    /// Where `q` is; nothing for what is not finite, or where there is no tetrahedron.
    pub fn locate(&self, q: Point3) -> Option<Located> {
        if !is_finite(q) || self.given.simplices.is_empty() {
            return None;
        }
        Some(self.locate_from(self.near(q), q, &mut Star::default()))
    }

    /// Whether no more tetrahedra lie beyond the boundary.
    fn is_convex(&self) -> bool {
        *self
            .kept
            .convex
            .get_or_init(|| boundary::is_convex(&self.given))
    }
}

fn is_finite(q: Point3) -> bool {
    q.iter().all(|x| x.is_finite())
}

/// For each query the first tetrahedron that holds it, boundary included, or -1: outside, or not
/// finite.
pub fn find(batch: &Batch) -> Result<Vec<i32>> {
    let found = Output::<i32>::filled(batch.queries.len(), -1)?;
    batch.each(
        || (),
        |(), row, _, at| {
            if let Located::Inside(place) = at {
                found.set(row, place.simplex as i32);
            }
            Ok(())
        },
    )?;
    Ok(found.into_vec())
}

/// Where queries are, row by row.
#[derive(Debug)]
pub struct Coordinates {
    /// The first tetrahedron that holds the query, or -1.
    pub simplex: Vec<i32>,
    /// The weights of its corners, four a row; NaN outside.
    pub weights: Vec<f64>,
    /// Outside: a boundary tetrahedron and the corner opposite a face that the query is beyond;
    /// else -1.
    pub beyond: Vec<i32>,
}

/// Locates queries; those that are not finite are nowhere.
pub fn coordinates(batch: &Batch) -> Result<Coordinates> {
    let n = batch.queries.len();
    let simplex = Output::filled(n, -1)?;
    let weights = Output::filled(4 * n, f64::NAN)?;
    let beyond = Output::filled(2 * n, -1)?;
    batch.each(
        || (),
        |(), row, q, at| {
            match at {
                Located::Inside(place) => {
                    simplex.set(row, place.simplex as i32);
                    weights.set_all(4 * row, &barycentric(&batch.locator.given, &place, q));
                }
                Located::Outside(side) => {
                    beyond.set_all(2 * row, &[side.simplex as i32, side.corner as i32]);
                }
            }
            Ok(())
        },
    )?;
    Ok(Coordinates {
        simplex: simplex.into_vec(),
        weights: weights.into_vec(),
        beyond: beyond.into_vec(),
    })
}
