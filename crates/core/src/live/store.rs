//! What the meshes of live triangulations share in 2-D and 3-D: records with ghosts, vertices, and
//! lists of free ones, in arrays with snapshots.
//!
//! A record has its corners from its first word on, and from its fifth the code opposite each corner. The
//! vertex at infinity is vertex 0, so that its number does not depend on how many others there are.

use super::chunks::Chunks;
use super::rows::NONE;
use crate::base::error::{Error, Result};
use crate::base::watch::Watch;
use crate::locate::Start;

/// The vertex at infinity; its coordinates are NaN.
pub const INFINITE: u32 = 0;

/// The fourth word of a record that is not a simplex; its first word is the next one.
pub const FREE: u32 = u32::MAX;

/// Up to four corners, the codes opposite them, and what else a mesh keeps of a simplex.
pub type Record = [u32; 8];

/// The corners of a record.
#[inline]
pub fn corners<const N: usize>(record: &Record) -> [u32; N] {
    std::array::from_fn(|k| record[k])
}

/// The codes opposite the corners of a record.
#[inline]
pub fn opposites<const N: usize>(record: &Record) -> [u32; N] {
    std::array::from_fn(|k| record[4 + k])
}

/// A vertex.
#[derive(Debug, Clone, Copy)]
pub struct Site<const D: usize> {
    /// Its coordinates.
    pub at: [f64; D],
    /// A place in a record of which it is a corner; [`NONE`] if there is none.
    pub near: u32,
    /// Its smallest row; of a free site, the next one.
    pub head: u32,
}

impl<const D: usize> Site<D> {
    /// The vertex at infinity.
    pub const AT_INFINITY: Self = Self::at([f64::NAN; D]);

    /// A vertex without rows that is in no record.
    pub const fn at(p: [f64; D]) -> Self {
        Self {
            at: p,
            near: NONE,
            head: NONE,
        }
    }
}

/// What a mesh counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Vertices, without the one at infinity.
    pub vertices: u32,
    /// Simplices, without ghosts; 0 if all points are in one line or plane.
    pub simplices: u32,
    /// The first free record, or [`NONE`].
    pub record: u32,
    /// The first free site, or [`NONE`].
    pub site: u32,
}

impl Counts {
    /// Without free records and sites.
    pub fn of(vertices: usize, simplices: usize) -> Self {
        Self {
            vertices: vertices as u32,
            simplices: simplices as u32,
            record: NONE,
            site: NONE,
        }
    }
}

/// Where a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// At a vertex.
    At(u32),
    /// In a simplex or on its boundary, or strictly outside the hull facet of a ghost.
    In(u32),
}

/// What a removal did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Removed {
    /// The vertex is removed.
    Done,
    /// Nothing: without the vertex, all points are in one line or plane.
    Flat,
    /// Nothing: a rebuild is cheaper.
    Hub,
}

/// Records and vertices, and where walks start.
#[derive(Debug)]
pub struct Store<const D: usize> {
    /// Simplices and ghosts.
    pub records: Chunks<Record>,
    /// Vertices.
    pub sites: Chunks<Site<D>>,
    /// Numbers of them, and where free ones begin.
    pub counts: Counts,
    /// The record where the next walk starts; always a simplex or ghost if there is any.
    pub last: u32,
    /// Records visited so far.
    pub work: usize,
    /// A tree of starting points for walks, and the work after which it is out of date.
    pub jump: Option<(Start<D>, usize)>,
    /// Steps of long walks since there is no tree; far below zero where there should be none.
    pub strolled: isize,
}

impl<const D: usize> Store<D> {
    /// These records and sites.
    pub fn of(records: Vec<Record>, sites: Vec<Site<D>>, counts: Counts) -> Result<Self> {
        Ok(Self {
            records: Chunks::of(records)?,
            sites: Chunks::of(sites)?,
            counts,
            last: 0,
            work: 0,
            jump: None,
            strolled: 0,
        })
    }

    /// Whether there is no simplex: all points are in one line or plane.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.counts.simplices == 0
    }

    /// The coordinates of a vertex.
    #[inline]
    pub fn at(&self, v: u32) -> [f64; D] {
        self.sites[v as usize].at
    }

    /// Whether a record is a simplex or a ghost.
    #[inline]
    pub fn is_live(&self, t: u32) -> bool {
        self.records[t as usize][3] != FREE
    }

    /// The vertex near `q` by a tree of starting points, less one; `None` without a tree. A tree
    /// that is due is built, and lasts for a given amount of work per vertex.
    pub fn near(
        &mut self,
        q: [f64; D],
        is_due: bool,
        lasting: usize,
        watch: &Watch,
    ) -> Result<Option<usize>> {
        if self.jump.as_ref().is_some_and(|jump| self.work > jump.1) {
            self.jump = None;
        }
        if self.jump.is_none() && is_due {
            // Not the vertex at infinity.
            let sites = &self.sites.items()[1..];
            let start = match Start::of(sites.len(), |i| sites[i].at, watch) {
                // A walk works without a tree, also if memory for an edit that is being undone was
                // refused.
                Err(Error::Memory { .. }) => {
                    self.strolled = 0;
                    return Ok(None);
                }
                start => start?,
            };
            // Most of its vertices are still there after that much work.
            self.jump = Some((start, self.work + lasting * sites.len()));
            self.strolled = 0;
        }
        Ok(self.jump.as_ref().map(|(start, _)| start.near(q)))
    }

    /// Takes a free record, or appends one, where at least `used` are in use.
    pub fn take_record(&mut self, used: usize) -> Result<u32> {
        let t = self.counts.record;
        let free = self.records.len().saturating_sub(used);
        if t == NONE || !self.records.is_to_be_used(t as usize, free) {
            self.records.push([0; 8])?;
            return Ok(self.records.len() as u32 - 1);
        }
        self.counts.record = self.records[t as usize][0];
        Ok(t)
    }

    /// Frees a record.
    pub fn free_record(&mut self, t: u32) {
        *self.records.get_mut(t as usize) = [self.counts.record, 0, 0, FREE, 0, 0, 0, 0];
        self.counts.record = t;
    }

    /// Takes a free site, or appends one, for a vertex at `p` without rows.
    pub fn take_site(&mut self, p: [f64; D]) -> Result<u32> {
        let v = self.counts.site;
        let free = self.sites.len() - 1 - self.counts.vertices as usize;
        if v == NONE || !self.sites.is_to_be_used(v as usize, free) {
            self.sites.push(Site::at(p))?;
            return Ok(self.sites.len() as u32 - 1);
        }
        self.counts.site = self.sites[v as usize].head;
        *self.sites.get_mut(v as usize) = Site::at(p);
        Ok(v)
    }

    /// Frees a site.
    pub fn free_site(&mut self, v: u32) {
        let head = self.counts.site;
        let site = self.sites.get_mut(v as usize);
        (site.near, site.head) = (NONE, head);
        self.counts.site = v;
    }

    /// Checks the start of walks and the lists of free records and sites, where `used` records are not
    /// free; for tests.
    pub fn check(&self, used: usize) -> std::result::Result<(), String> {
        if used > 0 && !self.is_live(self.last) {
            return Err("the walk starts at a free record".into());
        }
        let free = |first: u32, after: &dyn Fn(u32) -> u32| {
            let listed = |i: u32| (i != NONE).then_some(i);
            std::iter::successors(listed(first), |&i| listed(after(i)))
                .take(self.records.len() + self.sites.len() + 1)
                .count()
        };
        let records = free(self.counts.record, &|t| self.records[t as usize][0]);
        let sites = free(self.counts.site, &|v| self.sites[v as usize].head);
        if records + used != self.records.len()
            || sites + 1 + self.counts.vertices as usize != self.sites.len()
        {
            return Err(format!("{records} free records, {sites} free sites"));
        }
        Ok(())
    }
}
