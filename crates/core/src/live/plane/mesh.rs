//! The mesh of a live triangulation: records with ghosts as in `mesh::plane`, vertices, and lists of free
//! ones, all in arrays with snapshots.
//!
//! The vertex at infinity is vertex 0, so that its number does not depend on how many others there are.

use delone_predicates::{Point2, Sign, incircle_canonical, lexicographic, orient2d};

use crate::base::error::Result;
use crate::live::chunks::Chunks;
use crate::live::rows::NONE;
use crate::locate::Start;
use crate::mesh::plane::{Code, next, prev, triangle};

/// The vertex at infinity; its coordinates are NaN.
pub const INFINITE: u32 = 0;

/// Three vertices counter-clockwise, [`FREE`] or 0, three opposite codes, marks of the edges.
pub type Record = [u32; 8];

/// Marks a record that is not a triangle; its first word is the next one.
pub const FREE: u32 = u32::MAX;

/// A vertex.
#[derive(Debug, Clone, Copy)]
pub struct Site {
    /// Its coordinates.
    pub at: Point2,
    /// One of its corners; [`NONE`] if it is in no triangle.
    pub near: Code,
    /// Its smallest row; of a free site, the next one.
    pub head: u32,
}

/// What a mesh counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Vertices, without the one at infinity.
    pub vertices: u32,
    /// Ghosts; 0 if there is no triangle.
    pub ghosts: u32,
    /// The first free record, or [`NONE`].
    pub record: u32,
    /// The first free site, or [`NONE`].
    pub site: u32,
}

/// The mesh.
#[derive(Debug)]
pub struct Mesh {
    /// Triangles and ghosts.
    pub records: Chunks<Record>,
    /// Vertices.
    pub sites: Chunks<Site>,
    /// Numbers of them, and where free ones begin.
    pub counts: Counts,
    /// The triangle where the next walk starts; always one if there is any.
    pub last: u32,
    /// Whether there are segments, so that edges may be marked (see `marks`).
    pub has_segments: bool,
    /// Triangles visited so far.
    pub work: usize,
    /// A tree of starting points for walks, and the work when it is out of date.
    pub jump: Option<(Start<2>, usize)>,
    /// Steps of long walks since there is no tree; far below zero where there shall be none.
    pub strolled: isize,
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

impl Mesh {
    /// A mesh of these records and sites.
    pub fn of(records: Chunks<Record>, sites: Chunks<Site>, counts: Counts, last: u32) -> Self {
        Self {
            records,
            sites,
            counts,
            last,
            has_segments: false,
            work: 0,
            jump: None,
            strolled: 0,
            rim: Vec::new(),
            stack: Vec::new(),
            dead: Vec::new(),
            before: (counts, last, false),
        }
    }

    /// Starts an edit that [`Self::take_back`] may end.
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

    /// Ends an edit that stays.
    pub fn commit(&mut self) {
        self.records.commit();
        self.sites.commit();
    }

    /// Ends an edit, all changes of which are taken back. Returns whether none was missed.
    pub fn take_back(&mut self) -> bool {
        (self.counts, self.last, self.has_segments) = self.before;
        let sites = self.sites.len();
        let is_whole = self.records.take_back() & self.sites.take_back();
        if self.sites.len() < sites {
            self.jump = None;
        }
        is_whole
    }

    /// Whether there is no triangle: all points are on one line.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.counts.ghosts == 0
    }

    /// The coordinates of a vertex.
    #[inline]
    pub fn at(&self, v: u32) -> Point2 {
        self.sites[v as usize].at
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

    /// Whether a record is a triangle or a ghost.
    #[inline]
    pub fn is_live(&self, t: u32) -> bool {
        self.records[t as usize][3] != FREE
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
        let t = self.counts.record;
        let used = 2 * self.counts.vertices as usize;
        let free = self.records.len().saturating_sub(used);
        if t == NONE || !self.records.is_to_be_used(t as usize, free) {
            self.records.push([0; 8])?;
            return Ok(self.records.len() as u32 - 1);
        }
        self.counts.record = self.records[t as usize][0];
        Ok(t)
    }

    /// Gives a record back.
    pub fn free_record(&mut self, t: u32) {
        *self.records.get_mut(t as usize) = [self.counts.record, 0, 0, FREE, 0, 0, 0, 0];
        self.counts.record = t;
    }

    /// Takes a free site, or appends one, for a vertex at `p` without rows.
    pub fn take_site(&mut self, p: Point2) -> Result<u32> {
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
            for e in 8 * t..8 * t + 3 {
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
        let Counts { vertices, .. } = self.counts;
        if ghosts != self.counts.ghosts || (ghosts > 0 && used != 2 * vertices - 2) {
            return Err(format!(
                "{used} records, {ghosts} ghosts, {:?}",
                self.counts
            ));
        }
        if ghosts > 0 && !self.is_live(self.last) {
            return Err("the walk starts at a free record".into());
        }
        for (v, site) in (0u32..).zip(self.sites.items()) {
            if ghosts > 0 && site.near != NONE && self.vertex(site.near) != v {
                return Err(format!("vertex {v} is not at its corner {}", site.near));
            }
        }
        let free = |first: u32, after: &dyn Fn(u32) -> u32| {
            let used = |i: u32| (i != NONE).then_some(i);
            std::iter::successors(used(first), |&i| used(after(i)))
                .take(self.records.len() + self.sites.len() + 1)
                .count()
        };
        let records = free(self.counts.record, &|t| self.records[t as usize][0]);
        let sites = free(self.counts.site, &|v| self.sites[v as usize].head);
        if records + used as usize != self.records.len()
            || sites + 1 + vertices as usize != self.sites.len()
        {
            return Err(format!("{records} free records, {sites} free sites"));
        }
        Ok(())
    }
}
