//! Marks on edges, and edits like those of `flip` that preserve them.
//!
//! A mark is a bit in the fourth word of each of the two records at its edge; builders set none.
//!
//! Triangles may have a label, which the parts of a split triangle inherit; a flip must join
//! triangles with the same label.
//!
//! In addition, each side of an edge can be *fixed*, which the other side does not see.

use super::{Code, Patch, next, prev, triangle};

const WORD: u32 = 3;
/// The last word of a record, which is free for a label.
const LABEL: u32 = 7;
/// The bits of both kinds for the first corner.
const BOTH: u32 = 0b1_0001;
const FIXED: u32 = 0b1_0000;

impl Patch<'_> {
    #[inline]
    fn bits(&self, t: u32) -> u32 {
        self.vertex(8 * t + WORD)
    }

    #[inline]
    fn set_bits(&mut self, t: u32, bits: u32) {
        self.set_vertex(8 * t + WORD, bits);
    }

    /// The bits of this side of `e`, as for the first corner.
    #[inline]
    fn side(&self, e: Code) -> u32 {
        self.bits(triangle(e)) >> (e & 3) & BOTH
    }

    #[inline]
    fn set_side(&mut self, e: Code, side: u32) {
        let t = triangle(e);
        self.set_bits(t, self.bits(t) & !(BOTH << (e & 3)) | side << (e & 3));
    }

    /// The label of triangle `t`; 0 for triangles from a builder.
    #[inline]
    pub fn label(&self, t: u32) -> u32 {
        self.vertex(8 * t + LABEL)
    }

    /// Labels triangle `t`.
    #[inline]
    pub fn set_label(&mut self, t: u32, label: u32) {
        self.set_vertex(8 * t + LABEL, label);
    }

    /// Whether the edge `e` is marked.
    #[inline]
    pub fn is_marked(&self, e: Code) -> bool {
        self.side(e) & 1 != 0
    }

    /// Marks or unmarks the edge `e`.
    #[inline]
    pub fn mark(&mut self, e: Code, marked: bool) {
        for side in [e, self.opposite(e)] {
            self.set_side(side, self.side(side) & FIXED | u32::from(marked));
        }
    }

    /// Whether this side of `e` is marked or fixed.
    #[inline]
    pub fn is_bound(&self, e: Code) -> bool {
        self.side(e) != 0
    }

    /// Fixes this side of `e`.
    pub fn fix(&mut self, e: Code) {
        self.set_side(e, self.side(e) | FIXED);
    }

    /// Releases the sides of triangle `t` that were fixed.
    pub fn release(&mut self, t: u32) {
        self.set_bits(t, self.bits(t) & 0b111);
    }

    /// The marks of the edges of triangle `t`, by corner.
    #[inline]
    pub fn marks(&self, t: u32) -> [bool; 3] {
        [1, 2, 4].map(|bit| self.bits(t) & bit != 0)
    }

    /// Marks this side of the edges of triangle `t`, a bit for each corner.
    #[inline]
    pub fn set_marks(&mut self, t: u32, marks: u32) {
        self.set_bits(t, marks);
    }

    /// Clears all marks on this side of the edges of triangle `t`.
    pub fn clear(&mut self, t: u32) {
        self.set_bits(t, 0);
    }

    /// [`Patch::flip`] of an edge that is not marked; the other edges keep their marks.
    pub fn flip_marked(&mut self, e: Code) -> Code {
        let o = self.opposite(e);
        let (uq, vp) = (self.side(next(o)), self.side(next(e)));
        let other = self.flip(e);
        for (side, bits) in [(e, uq), (next(e), 0), (o, vp), (next(o), 0)] {
            self.set_side(side, bits);
        }
        other
    }

    /// [`Patch::split_triangle`]; its edges keep their marks.
    pub fn split_marked_triangle(&mut self, t: u32, p: u32) -> [Code; 3] {
        let sides = [0, 1, 2].map(|k| self.side(8 * t + k));
        self.clear(t);
        let star = self.split_triangle(t, p);
        let label = self.label(t);
        for (e, side) in star.into_iter().zip(sides) {
            self.set_side(e, side);
            self.set_label(triangle(e), label);
        }
        star
    }

    /// [`Patch::split_edge`]; both halves have the mark of the edge.
    pub fn split_marked_edge(&mut self, e: Code, p: u32) -> [Code; 4] {
        let o = self.opposite(e);
        let marked = self.is_marked(e);
        let (vx, yv) = (self.side(next(e)), self.side(prev(o)));
        let star = self.split_edge(e, p);
        // The star: x u in the old triangle of e, v x and y v in the new ones, u y in that of o.
        let [_, new_vx, _, new_yv] = star;
        self.set_side(new_vx, vx);
        self.set_side(new_yv, yv);
        for (new, old) in [(new_vx, e), (new_yv, o)] {
            self.set_label(triangle(new), self.label(triangle(old)));
        }
        for inner in [next(e), prev(o)] {
            self.set_side(inner, 0);
        }
        for half in [e, prev(new_vx)] {
            self.mark(half, marked);
        }
        star
    }
}
