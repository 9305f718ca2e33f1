//! What differs between live triangulations in 2-D and in 3-D: the mesh of a dimension, which inserts,
//! removes, moves and finds, and its list of segments.

use std::fmt::Debug;
use std::ops::{DerefMut, Range};

use delone_predicates::Sign;

use super::Live;
use super::rows::Rows;
use super::store::{Place, Removed, Store};
use crate::base::error::Result;
use crate::base::watch::{Pace, Watch};

/// A mesh, its rows, and if there is no simplex, the vertices in lexicographic order.
pub type Built<K> = (K, Rows, Vec<u32>);

/// A row, its vertex, and its point, in the order in which they are edited.
pub type Move<const D: usize> = (u32, u32, [f64; D]);

/// The mesh of a dimension: triangles or tetrahedra with `N` corners of `D` coordinates, in a store.
pub trait Kernel<const D: usize, const N: usize>:
    Debug + Sized + DerefMut<Target = Store<D>>
{
    /// The segments among the points; none in 3-D.
    type Segments: Constraints;

    /// The most points.
    const LIMIT: usize;
    /// Records that the insertion of a point adds on average.
    const RECORDS: usize;
    /// Batches of insertions, of removals, and of movements of more than this share of the vertices are
    /// rebuilds.
    const SHARES: [usize; 3];

    /// The mesh of `points`, which are at `rows`, ascending, among `total` rows, by the method for points
    /// that do not change.
    fn built(
        points: &[[f64; D]],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Built<Self>>;

    /// The record that a code belongs to.
    fn record_of(code: u32) -> u32;

    /// The record at the place of a vertex.
    fn record_at(near: u32) -> u32;

    /// Of the orders of corners with the same orientation, takes the first one.
    fn arrange(rows: &mut [i64; N]);

    /// Whether `a` is nearer to `q` than `b`: positive, or as near: zero.
    fn nearer(q: [f64; D], a: [f64; D], b: [f64; D]) -> Sign;

    /// The weights of the corners of a simplex that contains `q`.
    fn weights(corners: [[f64; D]; N], q: [f64; D]) -> [f64; N];

    /// Whether `p` spans a simplex with vertices in one line or plane.
    fn spans(&self, flat: &[u32], p: [f64; D]) -> bool;

    /// The simplex that contains `q`, or a ghost with `q` strictly outside its hull facet.
    fn find(&mut self, q: [f64; D], watch: &Watch) -> Result<u32>;

    /// Where `q` is.
    fn place(&mut self, q: [f64; D], watch: &Watch) -> Result<Place>;

    /// Inserts vertex `v`, whose place is in simplex or ghost `seed`. On an error nothing has changed.
    fn insert(&mut self, v: u32, seed: u32, pace: &mut Pace) -> Result<()>;

    /// Removes vertex `v` from the mesh; its site stays. On an error nothing has changed. With `always`,
    /// high degrees are not a reason to refuse.
    fn unlink(&mut self, v: u32, always: bool, pace: &mut Pace) -> Result<Removed>;

    /// Moves vertex `v`, which is in the mesh, to `p` if little changes by that; otherwise nothing does.
    fn shift(&mut self, v: u32, p: [f64; D]) -> Result<bool>;

    /// Before the head of a vertex may change: marks its simplices, which are named by heads, as changed,
    /// unless [`Self::set_head`] does.
    fn rename(&mut self, v: u32) -> Result<()>;

    /// Sets the head of a vertex.
    fn set_head(&mut self, v: u32, head: u32);

    /// Lists the neighbors of a vertex but the one at infinity.
    fn around(&mut self, v: u32, list: &mut Vec<u32>, pace: &mut Pace) -> Result<()>;

    /// Whether vertex `v` is nearer to `q` than `best`, or as near with a smaller row.
    fn is_better(&self, q: [f64; D], v: u32, best: u32) -> bool {
        match Self::nearer(q, self.at(v), self.at(best)) {
            Sign::Positive => true,
            Sign::Zero => self.sites[v as usize].head < self.sites[best as usize].head,
            Sign::Negative => false,
        }
    }

    /// Checks every link, list and count; for tests.
    fn check(&self) -> std::result::Result<(), String>;

    /// A batch of points begins, which are dense if they are many, or ends.
    fn prepare(&mut self, _is_dense: bool) {}

    /// The row of the nearest vertex to `q`, which is in `t`, where segments may
    /// separate it from its neighbors.
    fn nearest_among(&self, _t: u32, _q: [f64; D], _pace: &mut Pace) -> Result<Option<i64>> {
        Ok(None)
    }

    /// For each simplex and corner, whether the facet opposite is constrained; empty if none is.
    fn constrained(&self, _watch: &Watch) -> Result<Vec<[bool; N]>> {
        Ok(Vec::new())
    }

    /// Follows a change of the list of segments.
    fn follow(&mut self, _segments: &Self::Segments) {}

    /// Inserts points among segments, and returns their rows; `None` if there is no segment.
    fn insert_among(
        _live: &mut Live<Self, D, N>,
        _points: &[[f64; D]],
        _workers: usize,
        _watch: &Watch,
    ) -> Result<Option<Range<usize>>> {
        Ok(None)
    }

    /// Removes rows, each with its vertex, in the same way.
    fn remove_among(
        _live: &mut Live<Self, D, N>,
        _pairs: &[(u32, u32)],
        _workers: usize,
        _watch: &Watch,
    ) -> Result<Option<()>> {
        Ok(None)
    }

    /// Moves rows in the same way.
    fn relocate_among(
        _live: &mut Live<Self, D, N>,
        _moves: &[Move<D>],
        _workers: usize,
        _watch: &Watch,
    ) -> Result<Option<()>> {
        Ok(None)
    }
}

/// The list of segments of a live triangulation.
pub trait Constraints: Debug + Sized {
    /// A snapshot.
    type Image: Debug + Clone;

    /// No segments.
    fn none() -> Result<Self>;

    /// The number of the next segment.
    fn total(&self) -> usize;

    /// Makes room for another step of an edit that may be taken back.
    fn room(&mut self) -> Result<()>;

    /// A snapshot.
    fn image(&mut self, watch: &Watch) -> Result<Self::Image>;

    /// Reserves the memory for [`Self::restore`], with `total` numbers.
    fn make_room(&mut self, image: &Self::Image, total: usize) -> Result<()>;

    /// Restores a snapshot. Numbers below `total` are not used again.
    fn restore(&mut self, image: &Self::Image, total: usize) -> Result<()>;

    /// Bytes of a snapshot that are not shared with another one.
    fn own_bytes(image: &Self::Image, other: &Self::Image) -> usize;
}

/// In 3-D there are no segments.
impl Constraints for () {
    type Image = ();

    fn none() -> Result<Self> {
        Ok(())
    }

    fn total(&self) -> usize {
        0
    }

    fn room(&mut self) -> Result<()> {
        Ok(())
    }

    fn image(&mut self, _watch: &Watch) -> Result<()> {
        Ok(())
    }

    fn make_room(&mut self, (): &(), _total: usize) -> Result<()> {
        Ok(())
    }

    fn restore(&mut self, (): &(), _total: usize) -> Result<()> {
        Ok(())
    }

    fn own_bytes((): &(), (): &()) -> usize {
        0
    }
}
