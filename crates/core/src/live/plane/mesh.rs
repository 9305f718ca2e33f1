//! The mesh of a live triangulation in 2-D: triangles and ghosts with codes as in `mesh::plane`.

use std::ops::{Deref, DerefMut};

use delone_predicates::{Point2, Sign, incircle_canonical, lexicographic, orient2d};

use crate::base::error::Result;
use crate::live::rows::NONE;
pub use crate::live::store::INFINITE;
use crate::live::store::{Counts, Store};
use crate::mesh::plane::{Code, half_edges, next, prev, triangle};

/// The mesh. The first three words of a record are the vertices counter-clockwise, the last one has the
/// marks of the edges. The place of a vertex is one of its corners.
#[derive(Debug)]
pub struct Mesh {
    store: Store<2>,
    /// Whether there are segments, so that edges may be marked (see `marks`).
    pub has_segments: bool,
    /// Edges of a cavity or of a hole, each by the code beyond it and the vertex where it starts.
    pub rim: Vec<(Code, u32)>,
    /// Edges to be tested.
    pub stack: Vec<(Code, u32)>,
    /// Triangles to be replaced.
    pub dead: Vec<u32>,
    /// At the start of an edit: what the mesh counted, the triangle where the next walk started, and
    /// whether there were segments.
    before: (Counts, u32, bool),
}

// What a mesh has in common with that of 3-D is read and written as if it were here.
impl Deref for Mesh {
    type Target = Store<2>;

    #[inline]
    fn deref(&self) -> &Store<2> {
        &self.store
    }
}

impl DerefMut for Mesh {
    #[inline]
    fn deref_mut(&mut self) -> &mut Store<2> {
        &mut self.store
    }
}

impl Mesh {
    /// A mesh of these records and sites.
    pub fn of(store: Store<2>) -> Self {
        Self {
            has_segments: false,
            rim: Vec::new(),
            stack: Vec::new(),
            dead: Vec::new(),
            before: (store.counts, store.last, false),
            store,
        }
    }

    /// Starts an edit that [`Self::take_back`] may undo.
    pub fn begin(&mut self) -> Result<()> {
        self.before = (self.counts, self.last, self.has_segments);
        self.records.begin()?;
        self.sites.begin()
    }

    /// Makes room for a step of such an edit that changes `n` records and vertices, and a few more.
    #[inline]
    pub fn room(&mut self, n: usize) -> Result<()> {
        self.records.room(n)?;
        self.sites.room(n)
    }

    /// Ends an edit and keeps its changes.
    pub fn commit(&mut self) {
        self.records.commit();
        self.sites.commit();
    }

    /// Ends an edit and undoes all of its changes. Returns whether none was missed.
    pub fn take_back(&mut self) -> bool {
        (self.store.counts, self.store.last, self.has_segments) = self.before;
        let sites = self.sites.len();
        let is_whole = self.records.take_back() & self.sites.take_back();
        if self.sites.len() < sites {
            self.jump = None;
        }
        is_whole
    }

    /// The vertex opposite the half-edge `e` in its triangle.
    #[inline]
    pub fn vertex(&self, e: Code) -> u32 {
        self.records[triangle(e) as usize][(e & 3) as usize]
    }

    /// The half-edge on the other side of `e`.
    #[inline]
    pub fn opposite(&self, e: Code) -> Code {
        self.records[triangle(e) as usize][4 + (e & 3) as usize]
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, t: u32) -> [u32; 3] {
        let [a, b, c, ..] = self.records[t as usize];
        [a, b, c]
    }

    /// Makes `e` and `f` the two sides of one edge.
    #[inline]
    pub fn link(&mut self, e: Code, f: Code) {
        self.set_opposite(e, f);
        self.set_opposite(f, e);
    }

    #[inline]
    pub fn set_opposite(&mut self, e: Code, f: Code) {
        self.records.get_mut(triangle(e) as usize)[4 + (e & 3) as usize] = f;
    }

    /// Records that a vertex is found by the corner `e`.
    #[inline]
    pub fn touch(&mut self, v: u32, e: Code) {
        self.sites.get_mut(v as usize).near = e;
    }

    /// Makes sure that the next two calls of [`Self::take_record`] do not fail.
    pub fn reserve_two(&mut self) -> Result<()> {
        let first = self.counts.record;
        if first == NONE || self.records[first as usize][0] == NONE {
            self.records.reserve(2)?;
        }
        Ok(())
    }

    /// Takes a free record, or appends one.
    pub fn take_record(&mut self) -> Result<u32> {
        let used = 2 * self.counts.vertices as usize;
        self.store.take_record(used)
    }

    /// Sets the head of a vertex. As its triangles are named by heads, a new one marks them.
    pub fn set_head(&mut self, v: u32, head: u32) {
        let site = self.sites.get_mut(v as usize);
        let old = std::mem::replace(&mut site.head, head);
        let near = site.near;
        if [head, NONE].contains(&old) || [near, head].contains(&NONE) {
            return;
        }
        let mut corner = near;
        loop {
            self.records.mark(triangle(corner) as usize);
            corner = self.turn(corner);
            if corner == near {
                return;
            }
        }
    }

    /// The next corner of the same vertex, counter-clockwise.
    #[inline]
    pub fn turn(&self, corner: Code) -> Code {
        next(self.opposite(next(corner)))
    }

    /// Whether triangle or ghost `t` has `p`, which is not a vertex, in its perturbed circumcircle.
    #[inline]
    pub fn conflicts(&self, t: u32, p: Point2) -> bool {
        let [u, v, w] = self.corners(t);
        let edge = if u == INFINITE {
            [v, w]
        } else if v == INFINITE {
            [w, u]
        } else if w == INFINITE {
            [u, v]
        } else {
            let [a, b, c] = [self.at(u), self.at(v), self.at(w)];
            return incircle_canonical(a, b, c, p) == Sign::Positive;
        };
        let [a, b] = [self.at(edge[0]), self.at(edge[1])];
        // The outside is on the left of the hull edge of a ghost.
        match orient2d(a, b, p) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => lexicographic(a, p) == lexicographic(p, b),
        }
    }

    /// Checks every link, list and count; for tests.
    pub fn check(&self) -> std::result::Result<(), String> {
        let mut ghosts = 0;
        let mut used = 0;
        for t in (0..self.records.len() as u32).filter(|&t| self.is_live(t)) {
            used += 1;
            ghosts += u32::from(self.corners(t).contains(&INFINITE));
            for e in half_edges(t) {
                let o = self.opposite(e);
                let ends = [self.vertex(next(e)), self.vertex(prev(e))];
                let other = [self.vertex(prev(o)), self.vertex(next(o))];
                if !self.is_live(triangle(o)) || self.opposite(o) != e || ends != other {
                    return Err(format!("edges {e} and {o} disagree"));
                }
                if self.mark(e) != self.mark(o) || (self.mark(e) != 0 && !self.has_segments) {
                    return Err(format!("the marks of {e} and {o} disagree"));
                }
            }
        }
        let Counts {
            vertices,
            simplices,
            ..
        } = self.counts;
        if used != simplices + ghosts || (used > 0 && used != 2 * vertices - 2) {
            let counts = self.counts;
            return Err(format!("{used} records, {ghosts} ghosts, {counts:?}"));
        }
        for (v, site) in (0u32..).zip(self.sites.items()) {
            if ghosts > 0 && site.near != NONE && self.vertex(site.near) != v {
                return Err(format!("vertex {v} is not at its corner {}", site.near));
            }
        }
        self.store.check(used as usize)
    }
}
