//! The mesh of a live triangulation in 3-D: tetrahedra and ghosts with codes as in `mesh::space`.

use std::ops::{Deref, DerefMut};

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use super::patch::Patch;
use crate::base::error::Result;
use crate::base::memory::{make_room, push, zeroed};
use crate::live::rows::NONE;
pub use crate::live::store::INFINITE;
use crate::live::store::Store;
use crate::mesh::space::{Code, FACETS, corner, tetrahedron};

/// The mesh. The first four words of a record are the vertices, positively oriented. The place of a vertex
/// is the number of a record.
#[derive(Debug)]
pub struct Mesh {
    pub(super) store: Store<3>,
    /// Walks that started at a sampled vertex: the seed of the next sample.
    pub(super) samples: u32,
    /// The current edit.
    pub patch: Patch,
    /// For each record, the number of the search that met it last, plus one if it is inside.
    marks: Vec<u32>,
    search: u32,
}

// What a mesh has in common with that of 2-D is read and written as if it were here.
impl Deref for Mesh {
    type Target = Store<3>;

    #[inline]
    fn deref(&self) -> &Store<3> {
        &self.store
    }
}

impl DerefMut for Mesh {
    #[inline]
    fn deref_mut(&mut self) -> &mut Store<3> {
        &mut self.store
    }
}

impl Mesh {
    /// A mesh without marks, which the next search adds.
    pub fn of(store: Store<3>) -> Self {
        Self {
            store,
            samples: 0,
            patch: Patch::default(),
            marks: Vec::new(),
            search: 0,
        }
    }

    /// The same with marks, and with room for more.
    pub fn with_marks(store: Store<3>, room: usize) -> Result<Self> {
        let mut marks: Vec<u32> = zeroed(room)?;
        marks.truncate(store.records.len());
        Ok(Self {
            marks,
            ..Self::of(store)
        })
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
            self.store.records.get_mut(t as usize);
        }
        Ok(())
    }

    /// Takes a free record, or appends one, for which there is room.
    pub fn take_record(&mut self) -> Result<u32> {
        let used = self.counts.simplices as usize;
        self.store.take_record(used)
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
        if tetrahedra != self.counts.simplices {
            return Err(format!("{tetrahedra} tetrahedra, not {:?}", self.counts));
        }
        self.store.check(used)
    }
}
