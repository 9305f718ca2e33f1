//! The ring of ghosts around a mesh.
//!
//! A ghost is represented by the code of its infinite corner; its finite edge runs clockwise on the
//! hull, from `head` to `tail`: the hull edge runs from `tail` to `head`.

use super::storage::OPPOSITE;
use super::{Code, Patch, next, prev, triangle};

impl Patch<'_> {
    /// Where the hull edge of ghost `g` ends.
    #[inline]
    pub fn head(&self, g: Code) -> u32 {
        self.vertex(next(g))
    }

    /// Where the hull edge of ghost `g` begins.
    #[inline]
    pub fn tail(&self, g: Code) -> u32 {
        self.vertex(prev(g))
    }

    /// The ghost whose hull edge begins where that of `g` ends.
    #[inline]
    pub fn after(&self, g: Code) -> Code {
        prev(self.opposite(prev(g)))
    }

    /// The ghost whose hull edge ends where that of `g` begins.
    #[inline]
    pub fn before(&self, g: Code) -> Code {
        next(self.opposite(next(g)))
    }

    /// Rotates the record of ghost `g` so that its infinite corner is first.
    pub fn turn(&mut self, g: Code) -> Code {
        let turned = [g, next(g), prev(g)];
        let corners = turned.map(|e| self.vertex(e));
        let across = turned.map(|e| self.opposite(e));
        let t = triangle(g);
        self.set(t, corners);
        for (e, o) in (8 * t..).zip(across) {
            self.link(e, o);
        }
        8 * t
    }

    /// Removes the triangle behind the hull edge of ghost `g` from the mesh: two ghosts replace it
    /// and `g`. Ghost `g` keeps its head; the other one, which is returned, gets its tail, and the
    /// caller must link the ghost before it. The infinite corner of both is first.
    #[inline]
    pub fn peel(&mut self, g: u32) -> u32 {
        //        inf                  inf
        //      /  g  \              / | \           The edge tail head is removed; the edges
        //   tail --- head   ->  tail  |  head       tail x and x head are hull edges now.
        //      \     /              \ | /
        //         x                   x
        let &[infinite, _, tail, _, inside, ..] = self.record(g);
        let other = triangle(inside);
        let behind = *self.record(other);
        let k = inside & 3;
        let x = behind[k as usize];
        let beyond = |e: Code| behind[OPPOSITE + (e & 3) as usize];
        let (beyond_head, beyond_tail) = (beyond(next(k)), beyond(prev(k)));
        let r = self.record_mut(g);
        r[2] = x;
        [r[OPPOSITE], r[OPPOSITE + 1]] = [beyond_head, 8 * other + 2];
        let r = self.record_mut(other);
        [r[0], r[1], r[2]] = [infinite, x, tail];
        [r[OPPOSITE], r[OPPOSITE + 2]] = [beyond_tail, 8 * g + 1];
        self.set_opposite(beyond_head, 8 * g);
        self.set_opposite(beyond_tail, 8 * other);
        other
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mesh2;

    #[test]
    fn peeling_a_triangle_leaves_a_chain() {
        let mut mesh = Mesh2::with_vertices(3).unwrap();
        let mut patch = mesh.patch();
        let g = patch.triangle([0, 1, 2]);
        let (head, tail, before) = (patch.head(g), patch.tail(g), patch.opposite(g + 1));
        let other = 8 * patch.peel(g >> 3);
        patch.link(other + 1, before);
        patch.check(4).unwrap();
        assert_eq!((patch.head(g), patch.tail(other)), (head, tail));
        assert_eq!(patch.after(other), g);
        let ring: Vec<_> = (0..4)
            .scan(g, |at, _| Some(std::mem::replace(at, patch.after(*at))))
            .collect();
        assert_eq!(patch.after(ring[3]), g);
        assert!(ring.iter().all(|&g| patch.vertex(g) == 3));
    }

    #[test]
    fn a_turned_ghost_is_linked_as_before() {
        let mut mesh = Mesh2::with_vertices(3).unwrap();
        let mut patch = mesh.patch();
        let g = patch.triangle([0, 1, 2]);
        let (head, tail) = (patch.head(g), patch.tail(g));
        let across = [0, 1, 2].map(|k| patch.opposite(g + k));
        patch.set(g >> 3, [tail, 3, head]);
        for k in 0..3 {
            patch.link(g + (k + 1) % 3, across[k as usize]);
        }
        patch.check(4).unwrap();
        assert_eq!(patch.turn(g + 1), g);
        patch.check(4).unwrap();
        assert_eq!([0, 1, 2].map(|k| patch.opposite(g + k)), across);
        assert_eq!((patch.head(g), patch.tail(g)), (head, tail));
    }
}
