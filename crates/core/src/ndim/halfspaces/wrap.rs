//! The hull of dual points: facets, the points outside each of them, and the insertion of points.

use std::cmp::Ordering;

use super::normal::Normal;
use super::rounded::{Plane, Shares};
use super::sites::Sites;
use crate::base::error::{Error, Result};
use crate::base::memory::{self, filled, push};
use crate::base::watch::Pace;

/// No facet, or no point.
pub const NONE: u32 = u32::MAX;

/// Facets that one hull can hold: corners are numbered by `16 c + k` in 32 bits.
const LIMIT: usize = 1 << 28;

/// A facet.
#[derive(Clone, Copy)]
pub struct Facet<const D: usize> {
    /// Decides most tests.
    pub plane: Plane<D>,
    pub vertices: [u32; D],
    /// The facet opposite each vertex.
    pub neighbors: [u32; D],
    /// The insertion that has visited it: twice its number, and 1 more if the point is not outside.
    mark: u32,
    /// Whether the determinant of its vectors and one outside is negative.
    pub odd: bool,
    pub alive: bool,
    /// Points outside, as a list, and the farthest of them.
    head: u32,
    farthest: (f64, u32),
}

/// The exact data that decides where rounded values do not.
struct Exact<const D: usize, const V: usize, const P: usize> {
    normal: Normal<V>,
    /// For ties.
    shares: Option<Shares<D, P>>,
}

/// A ridge that only one new facet has so far: its hash, `16 c + k`, and the insertion.
type Ridge = (u64, u32, u32);

/// A hull under construction.
pub struct Hull<'a, const D: usize, const V: usize, const P: usize> {
    pub sites: Sites<'a, D, V, P>,
    pub facets: Vec<Facet<D>>,
    /// Exact data of facets for which rounded values did not decide.
    normals: Vec<Option<Box<Exact<D, V, P>>>>,
    free: Vec<u32>,
    /// The point after each in the list of its facet.
    next: Vec<u32>,
    stamp: u32,
    hole: Vec<u32>,
    rim: Vec<(u32, usize, u32)>,
    born: Vec<u32>,
    ridges: Vec<Ridge>,
}

/// The hash of a vertex (the finalizer of splitmix64); that of a ridge is the sum over its vertices.
#[inline(always)]
fn word(v: u32) -> u64 {
    let x = (u64::from(v) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

impl<'a, const D: usize, const V: usize, const P: usize> Hull<'a, D, V, P> {
    /// The facets of a simplex whose vectors have a determinant with the given sign.
    pub fn new(sites: Sites<'a, D, V, P>, corners: [u32; V], sign: i32) -> Result<Self> {
        let mut hull = Self {
            next: filled(sites.given.len(), NONE)?,
            sites,
            facets: Vec::new(),
            normals: Vec::new(),
            free: Vec::new(),
            stamp: 0,
            hole: Vec::new(),
            rim: Vec::new(),
            born: Vec::new(),
            ridges: Vec::new(),
        };
        for i in 0..V {
            let others = |j: usize| j + usize::from(j >= i);
            // Moving corner i to the end takes D - i exchanges, and it is inside.
            let odd = (sign > 0) != ((D - i) % 2 == 1);
            let vertices = std::array::from_fn(|j| corners[others(j)]);
            let neighbors = std::array::from_fn(|j| others(j) as u32);
            hull.make(vertices, neighbors, odd)?;
        }
        // The point from which dual points are seen is inside if the corner opposite each facet is
        // certainly on the same side. Otherwise, no rounded value is trusted.
        let is_inside = (0..V as u32).zip(corners).all(|(c, corner)| {
            let (value, bound) = hull.value(c, corner);
            value < -bound
        });
        if !is_inside {
            hull.sites.slack = f64::INFINITY;
            for facet in &mut hull.facets {
                facet.plane = Plane::UNKNOWN;
            }
        }
        Ok(hull)
    }

    fn make(&mut self, vertices: [u32; D], neighbors: [u32; D], odd: bool) -> Result<u32> {
        let facet = Facet {
            plane: Plane::new(&self.sites, &vertices),
            vertices,
            neighbors,
            mark: 0,
            odd,
            alive: true,
            head: NONE,
            farthest: (0.0, NONE),
        };
        if let Some(c) = self.free.pop() {
            self.facets[c as usize] = facet;
            return Ok(c);
        }
        if self.facets.len() == LIMIT {
            return Err(Error::TooManySimplices { limit: LIMIT });
        }
        push(&mut self.facets, facet)?;
        push(&mut self.normals, None)?;
        Ok(self.facets.len() as u32 - 1)
    }

    /// The rounded value of a point, positive outside, and its bound.
    #[inline(always)]
    pub fn value(&self, c: u32, w: u32) -> (f64, f64) {
        self.facets[c as usize].plane.value(&self.sites, w)
    }

    /// Whether a point is outside a facet.
    #[inline(always)]
    fn is_outside(&mut self, c: u32, w: u32) -> bool {
        let (value, bound) = self.value(c, w);
        // A comparison that NaN fails.
        if value.abs() > bound {
            value > 0.0
        } else {
            self.uncertain(c, w)
        }
    }

    #[cold]
    #[inline(never)]
    fn uncertain(&mut self, c: u32, w: u32) -> bool {
        if self.facets[c as usize].vertices.contains(&w) {
            return false;
        }
        match self.exact_side(c, w) {
            0 => self.tie(c, w),
            side => side > 0,
        }
    }

    /// The side of a facet that a point is on, exactly: positive outside.
    pub fn side(&mut self, c: u32, w: u32) -> i32 {
        let (value, bound) = self.value(c, w);
        if value.abs() > bound {
            return if value > 0.0 { 1 } else { -1 };
        }
        self.exact_side(c, w)
    }

    pub fn exact_side(&mut self, c: u32, w: u32) -> i32 {
        // The vectors of a facet are independent.
        self.ensure_normal(c);
        let exact = self.normals[c as usize].as_ref();
        exact.map_or(0, |exact| exact.normal.side(&self.sites, w))
    }

    /// The normal of a facet.
    pub fn normal(&mut self, c: u32) -> Option<&Normal<V>> {
        self.ensure_normal(c);
        self.normals[c as usize]
            .as_deref()
            .map(|exact| &exact.normal)
    }

    fn ensure_normal(&mut self, c: u32) {
        if self.normals[c as usize].is_none() {
            let facet = &self.facets[c as usize];
            let normal = Normal::new(&self.sites, &facet.vertices, facet.odd);
            let shares = Shares::new(&self.sites, &facet.vertices);
            let exact = normal.map(|normal| Exact { normal, shares });
            self.normals[c as usize] = exact.map(Box::new);
        }
    }

    /// The rule for ties: the smallest of the point and the vertices that span it decides.
    fn tie(&mut self, c: u32, w: u32) -> bool {
        let Facet { vertices, .. } = self.facets[c as usize];
        let mut order: [usize; D] = std::array::from_fn(|i| i);
        order.sort_by(|&i, &j| self.sites.compare(vertices[i], vertices[j]));
        for i in order {
            let v = vertices[i];
            match self.sites.compare(v, w) {
                // A multiple of the same half-space: the first row counts.
                Ordering::Equal => {
                    let row = self.sites.first[w as usize];
                    let first = &mut self.sites.first[v as usize];
                    *first = row.min(*first);
                    return false;
                }
                Ordering::Greater => break,
                Ordering::Less => {}
            }
            let share = self.share(c, i, w);
            if share != 0 {
                return share < 0;
            }
        }
        true
    }

    /// The sign of the coefficient of vertex `i` at a point on the plane of a facet.
    fn share(&self, c: u32, i: usize, w: u32) -> i32 {
        let Some(Exact { normal, shares }) = self.normals[c as usize].as_deref() else {
            return 0;
        };
        if let Some(shares) = shares {
            let (value, bound) = shares.value(&self.sites, i, w);
            if value.abs() > bound {
                return if value > 0.0 { 1 } else { -1 };
            }
        }
        let Facet { vertices, odd, .. } = &self.facets[c as usize];
        normal.share(&self.sites, vertices, *odd, i, w)
    }

    /// Assigns a point to the first of some facets that it is outside, if there is one.
    #[inline(always)]
    fn place(&mut self, w: u32, among: &[u32], pace: &mut Pace) -> Result<()> {
        for &c in among {
            pace.spend(1)?;
            if self.is_outside(c, w) {
                let (value, _) = self.value(c, w);
                let facet = &mut self.facets[c as usize];
                self.next[w as usize] = facet.head;
                facet.head = w;
                let (most, far) = facet.farthest;
                if far == NONE || value > most {
                    facet.farthest = (value, w);
                }
                return Ok(());
            }
        }
        Ok(())
    }

    /// Inserts all points. Terminates because an inserted point is never outside again.
    pub fn wrap(&mut self, pace: &mut Pace) -> Result<()> {
        let mut work: Vec<u32> = (0..V as u32).collect();
        for w in 0..self.sites.len() {
            self.place(w, &work, pace)?;
        }
        let mut list = Vec::new();
        while let Some(c) = work.pop() {
            // The facet may have been removed, or its number reused for another facet.
            if !self.facets[c as usize].alive || self.facets[c as usize].head == NONE {
                continue;
            }
            let (_, p) = self.facets[c as usize].farthest;
            self.open(p, c, pace)?;
            list.clear();
            for &gone in &self.hole {
                let mut w = self.facets[gone as usize].head;
                while w != NONE {
                    if w != p {
                        push(&mut list, w)?;
                    }
                    w = self.next[w as usize];
                }
            }
            self.fill(p, pace)?;
            let born = std::mem::take(&mut self.born);
            for &w in &list {
                self.place(w, &born, pace)?;
            }
            for &c in &born {
                if self.facets[c as usize].head != NONE {
                    push(&mut work, c)?;
                }
            }
            self.born = born;
        }
        Ok(())
    }

    /// Finds the facets that a point is outside, which are connected, and the ridges around them.
    fn open(&mut self, p: u32, start: u32, pace: &mut Pace) -> Result<()> {
        self.stamp += 2;
        let (seen, other) = (self.stamp, self.stamp + 1);
        self.hole.clear();
        self.rim.clear();
        push(&mut self.hole, start)?;
        self.facets[start as usize].mark = seen;
        let mut next = 0;
        while next < self.hole.len() {
            let c = self.hole[next];
            next += 1;
            pace.spend(1)?;
            for (i, t) in self.facets[c as usize].neighbors.into_iter().enumerate() {
                let mark = self.facets[t as usize].mark;
                if mark == seen {
                    continue;
                }
                if mark != other && self.is_outside(t, p) {
                    self.facets[t as usize].mark = seen;
                    push(&mut self.hole, t)?;
                } else {
                    self.facets[t as usize].mark = other;
                    push(&mut self.rim, (c, i, t))?;
                }
            }
        }
        Ok(())
    }

    /// Replaces the facets in the hole by facets that join the point to the rim.
    fn fill(&mut self, p: u32, pace: &mut Pace) -> Result<()> {
        // Each ridge is in two of the new facets, so the table is at most half full.
        let size = (self.rim.len() * D).next_power_of_two().max(16);
        if self.ridges.len() < size {
            self.ridges = Vec::new();
            self.ridges = filled(size, (0, 0, 0))?;
        }
        memory::clear_with_room(&mut self.born, self.rim.len())?;
        for n in 0..self.rim.len() {
            pace.spend(1)?;
            let (old, i, outside) = self.rim[n];
            let Facet {
                mut vertices, odd, ..
            } = self.facets[old as usize];
            // The point is outside the old facet, and the vertex that it replaces is inside the new one. So
            // exchanging the two, which changes the sign of the determinant, leaves `odd` as it is.
            vertices[i] = p;
            let mut neighbors = [NONE; D];
            neighbors[i] = outside;
            let c = self.make(vertices, neighbors, odd)?;
            let back = &mut self.facets[outside as usize].neighbors;
            if let Some(k) = back.iter().position(|&n| n == old) {
                back[k] = c;
            }
            self.born.push(c);
            self.join(c, i, size);
        }
        for &c in &self.hole {
            self.facets[c as usize].alive = false;
            self.normals[c as usize] = None;
            push(&mut self.free, c)?;
        }
        Ok(())
    }

    /// Joins a new facet, whose vertex `new` is the point, to those others that share a ridge.
    #[inline(always)]
    fn join(&mut self, c: u32, new: usize, size: usize) {
        let v = self.facets[c as usize].vertices;
        let words = v.map(word);
        let sum = (0..D)
            .filter(|&k| k != new)
            .fold(0u64, |sum, k| sum.wrapping_add(words[k]));
        let (mask, shift) = (size - 1, u64::BITS - size.trailing_zeros());
        for k in (0..D).filter(|&k| k != new) {
            let hash = sum.wrapping_sub(words[k]);
            let mut at = (hash >> shift) as usize;
            // The table is not full: the search ends.
            loop {
                let (found, corner, of) = self.ridges[at];
                if of != self.stamp {
                    self.ridges[at] = (hash, c * 16 + k as u32, self.stamp);
                    break;
                }
                let (other, opposite) = (corner / 16, corner as usize % 16);
                if found == hash && self.shares(&v, k, other, opposite) {
                    self.facets[c as usize].neighbors[k] = other;
                    self.facets[other as usize].neighbors[opposite] = c;
                    break;
                }
                at = (at + 1) & mask;
            }
        }
    }

    /// Whether the vertices except `k` are those of another facet except `opposite`.
    #[inline(always)]
    fn shares(&self, v: &[u32; D], k: usize, other: u32, opposite: usize) -> bool {
        let w = &self.facets[other as usize].vertices;
        (0..D)
            .filter(|&j| j != k)
            .all(|j| (0..D).fold(false, |any, l| any | ((l != opposite) & (w[l] == v[j]))))
    }
}
