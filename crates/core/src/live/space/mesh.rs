//! The mesh of a live 3-D triangulation: records with ghosts as in `mesh::space`, vertices, and lists of
//! free ones, in arrays with snapshots.
//!
//! The vertex at infinity is vertex 0, so that its number does not depend on how many others there
//! are.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

pub use super::patch::INFINITE;
use super::patch::Patch;
use crate::base::error::Result;
use crate::base::memory::{make_room, push, zeroed};
use crate::live::chunks::Chunks;
use crate::live::rows::NONE;
use crate::locate::Start;
use crate::mesh::space::{Code, FACETS, corner, tetrahedron};

/// Four vertices, positively oriented, then the codes of the facets as seen from the other sides.
pub type Record = [u32; 8];

/// The fourth word of a record that is not a tetrahedron; its first word is the next one.
pub const FREE: u32 = u32::MAX;

/// A vertex.
#[derive(Debug, Clone, Copy)]
pub struct Site {
    /// Its coordinates.
    pub at: Point3,
    /// A tetrahedron or ghost of which it is a corner; [`NONE`] if there is none.
    pub near: u32,
    /// Its smallest row; of a free site, the next one.
    pub head: u32,
}

/// What a mesh counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Vertices, without the one at infinity.
    pub vertices: u32,
    /// Tetrahedra, without ghosts; 0 if all points are in one plane.
    pub tetrahedra: u32,
    /// The first free record, or [`NONE`].
    pub record: u32,
    /// The first free site, or [`NONE`].
    pub site: u32,
}

/// The mesh.
#[derive(Debug)]
pub struct Mesh {
    /// Tetrahedra and ghosts.
    pub records: Chunks<Record>,
    /// Vertices.
    pub sites: Chunks<Site>,
    /// Numbers of them, and where free ones begin.
    pub counts: Counts,
    /// The tetrahedron or ghost where the next walk starts; always one if there is any.
    pub last: u32,
    /// Tetrahedra visited so far.
    pub work: usize,
    /// Walks that started at a sampled vertex: the seed of the next sample.
    pub samples: u32,
    /// Steps of long walks since there is no tree.
    pub strolled: usize,
    /// A tree of starting points for walks, and the work when it is out of date.
    pub jump: Option<(Start<3>, usize)>,
    /// The edit at hand.
    pub patch: Patch,
    /// For each record, the number of the search that met it last, plus one if it is inside.
    marks: Vec<u32>,
    search: u32,
}

impl Mesh {
    /// A mesh of these records and sites.
    pub fn of(records: Vec<Record>, sites: Vec<Site>, counts: Counts) -> Result<Self> {
        let mut marks: Vec<u32> = zeroed(records.capacity())?;
        marks.truncate(records.len());
        let (records, sites) = (Chunks::of(records)?, Chunks::of(sites)?);
        Ok(Self {
            records,
            sites,
            counts,
            last: 0,
            work: 0,
            samples: 0,
            strolled: 0,
            jump: None,
            patch: Patch::default(),
            marks,
            search: 0,
        })
    }

    /// Whether there is no tetrahedron: all points are in one plane.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.counts.tetrahedra == 0
    }

    /// The coordinates of a vertex.
    #[inline]
    pub fn at(&self, v: u32) -> Point3 {
        self.sites[v as usize].at
    }

    /// The corners of a tetrahedron.
    #[inline]
    pub fn corners(&self, t: u32) -> [u32; 4] {
        let [a, b, c, d, ..] = self.records[t as usize];
        [a, b, c, d]
    }

    /// The codes of the facets of a tetrahedron as seen from the other sides.
    #[inline]
    pub fn opposites(&self, t: u32) -> [Code; 4] {
        let [_, _, _, _, e, f, g, h] = self.records[t as usize];
        [e, f, g, h]
    }

    /// The facet `e` as seen from the other side.
    #[inline]
    pub fn opposite(&self, e: Code) -> Code {
        self.records[tetrahedron(e) as usize][4 + corner(e)]
    }

    /// The corners of facet `e`, from the side of its tetrahedron.
    #[inline]
    pub fn facet(&self, e: Code) -> [u32; 3] {
        let corners = self.corners(tetrahedron(e));
        FACETS[corner(e)].map(|k| corners[k])
    }

    /// The corner opposite facet `e`.
    #[inline]
    pub fn apex(&self, e: Code) -> u32 {
        self.records[tetrahedron(e) as usize][corner(e)]
    }

    /// Whether a record is a tetrahedron or a ghost.
    #[inline]
    pub fn is_live(&self, t: u32) -> bool {
        self.records[t as usize][3] != FREE
    }

    /// The corner of `t` at infinity, if it is a ghost.
    #[inline]
    pub fn infinite_corner(&self, t: u32) -> Option<usize> {
        self.corners(t).iter().position(|&v| v == INFINITE)
    }

    /// Whether `t` has `p`, which is not a vertex, below the plane of its lifted corners.
    pub fn conflicts(&self, t: u32, p: Point3) -> bool {
        let corners = self.corners(t);
        let Some(k) = corners.iter().position(|&v| v == INFINITE) else {
            let [a, b, c, d] = corners.map(|v| self.at(v));
            return insphere_canonical(a, b, c, d, p) == Sign::Positive;
        };
        let [a, b, c] = FACETS[k].map(|i| self.at(corners[i]));
        match orient3d(a, b, c, p) {
            Sign::Positive => true,
            Sign::Negative => false,
            // See `delaunay::space::cavity`.
            Sign::Zero => self.conflicts(tetrahedron(self.opposites(t)[k]), p),
        }
    }

    /// Starts a search, which has met no record yet.
    pub fn start_search(&mut self) -> Result<()> {
        let more = self.records.len().saturating_sub(self.marks.len());
        make_room(&mut self.marks, more)?;
        self.marks.resize(self.marks.len() + more, 0);
        self.search = self.search.wrapping_add(2);
        if self.search == 0 {
            self.marks.fill(0);
            self.search = 2;
        }
        Ok(())
    }

    /// Whether the search has found `t` inside what it looks for; `None` if it has not met it.
    #[inline]
    pub fn met(&self, t: u32) -> Option<bool> {
        let mark = self.marks[t as usize].wrapping_sub(self.search);
        (mark < 2).then_some(mark == 1)
    }

    /// Notes that the search has met `t`.
    #[inline]
    pub fn meet(&mut self, t: u32, inside: bool) {
        self.marks[t as usize] = self.search + u32::from(inside);
    }

    /// Lists the tetrahedra and ghosts around `v` in the patch as those to be replaced, and the facets
    /// around them, seen from outside.
    pub fn gather(&mut self, v: u32) -> Result<()> {
        self.patch.clear();
        self.start_search()?;
        let first = self.sites[v as usize].near;
        self.meet(first, true);
        push(&mut self.patch.dead, first)?;
        let mut next = 0;
        while let Some(&t) = self.patch.dead.get(next) {
            next += 1;
            for (&w, e) in self.corners(t).iter().zip(self.opposites(t)) {
                if w == v {
                    push(&mut self.patch.rim, e)?;
                } else if self.met(tetrahedron(e)).is_none() {
                    self.meet(tetrahedron(e), true);
                    push(&mut self.patch.dead, tetrahedron(e))?;
                }
            }
        }
        self.work += next;
        Ok(())
    }

    /// Marks the tetrahedra around `v` as changed, since their name changes with its smallest row.
    pub fn rename(&mut self, v: u32) -> Result<()> {
        if self.sites[v as usize].near == NONE {
            return Ok(());
        }
        self.gather(v)?;
        for &t in &self.patch.dead {
            self.records.get_mut(t as usize);
        }
        Ok(())
    }

    /// Takes a free site, or appends one, for a vertex at `p` without rows.
    pub fn take_site(&mut self, p: Point3) -> Result<u32> {
        let site = Site {
            at: p,
            near: NONE,
            head: NONE,
        };
        let v = self.counts.site;
        let free = self.sites.len() - 1 - self.counts.vertices as usize;
        if v == NONE || !self.sites.is_to_be_used(v as usize, free) {
            self.sites.push(site)?;
            return Ok(self.sites.len() as u32 - 1);
        }
        self.counts.site = self.sites[v as usize].head;
        *self.sites.get_mut(v as usize) = site;
        Ok(v)
    }

    /// Gives a site back.
    pub fn free_site(&mut self, v: u32) {
        let head = self.counts.site;
        let site = self.sites.get_mut(v as usize);
        (site.near, site.head) = (NONE, head);
        self.counts.site = v;
    }

    /// Gives a record back.
    pub fn free_record(&mut self, t: u32) {
        *self.records.get_mut(t as usize) = [self.counts.record, 0, 0, FREE, 0, 0, 0, 0];
        self.counts.record = t;
    }

    /// Takes a free record, or appends one, for which there is room.
    pub fn take_record(&mut self) -> Result<u32> {
        let t = self.counts.record;
        let free = self.records.len() - self.counts.tetrahedra as usize;
        if t == NONE || !self.records.is_to_be_used(t as usize, free) {
            self.records.push([0; 8])?;
            return Ok(self.records.len() as u32 - 1);
        }
        self.counts.record = self.records[t as usize][0];
        Ok(t)
    }

    /// Checks the data structure; for tests.
    pub fn check(&self) -> std::result::Result<(), String> {
        let mut tetrahedra = 0;
        let mut used = 0;
        for t in (0..self.records.len() as u32).filter(|&t| self.is_live(t)) {
            used += 1;
            tetrahedra += u32::from(self.infinite_corner(t).is_none());
            for e in 4 * t..4 * t + 4 {
                let f = self.opposite(e);
                let [a, b, c] = self.facet(e);
                let turned = [[b, a, c], [a, c, b], [c, b, a]];
                let live = self.is_live(tetrahedron(f));
                if !live || self.opposite(f) != e || !turned.contains(&self.facet(f)) {
                    return Err(format!("facet {e} and facet {f} do not agree"));
                }
            }
            for v in self.corners(t) {
                let near = self.sites[v as usize].near;
                if near == NONE || !self.is_live(near) || !self.corners(near).contains(&v) {
                    return Err(format!("vertex {v} is not a corner of {near}"));
                }
            }
        }
        if tetrahedra != self.counts.tetrahedra {
            return Err(format!("{tetrahedra} tetrahedra, not {:?}", self.counts));
        }
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
