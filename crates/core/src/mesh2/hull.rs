//! The ring of ghosts round a mesh. A ghost is held by the code of its infinite corner; its finite
//! edge runs clockwise on the hull, from `head` to `tail`: the hull edge runs `tail` to `head`.

use super::{Code, Patch, next, prev};

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

    /// Takes the triangle behind the hull edge of ghost `g` out of the mesh: two ghosts take the
    /// place of it and `g`. Ghost `g` keeps its head; the other, returned, has its tail.
    pub fn peel(&mut self, g: Code) -> Code {
        //        inf                  inf
        //      /  g  \              / | \           The edge tail head goes, the edges
        //   tail --- head   ->  tail  |  head       tail x and x head are hull edges now.
        //      \     /              \ | /
        //         x                   x
        let inside = self.opposite(g);
        let (head, tail, x) = (self.head(g), self.tail(g), self.vertex(inside));
        debug_assert!(self.vertex(prev(inside)) == head && self.vertex(next(inside)) == tail);
        let (beyond_head, beyond_tail) = (self.opposite(next(inside)), self.opposite(prev(inside)));
        let before = self.opposite(next(g));
        let other = inside;
        let infinite = self.infinite();
        self.set_vertex(other, infinite);
        self.set_vertex(next(other), x);
        self.set_vertex(prev(other), tail);
        self.set_vertex(prev(g), x);
        self.link(g, beyond_head);
        self.link(other, beyond_tail);
        // In a merge the ghost before may have become a triangle, which no longer points here.
        if self.opposite(before) == next(g) {
            self.link(next(other), before);
        }
        self.link(prev(other), next(g));
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
        let (head, tail) = (patch.head(g), patch.tail(g));
        let other = patch.peel(g);
        patch.check(4).unwrap();
        assert_eq!((patch.head(g), patch.tail(other)), (head, tail));
        assert_eq!(patch.after(other), g);
        let ring: Vec<_> = (0..4)
            .scan(g, |at, _| Some(std::mem::replace(at, patch.after(*at))))
            .collect();
        assert_eq!(patch.after(ring[3]), g);
        assert!(ring.iter().all(|&g| patch.vertex(g) == 3));
    }
}
