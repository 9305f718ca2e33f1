//! The three edits of flip algorithms: edge flip, triangle split, edge split.
//!
//! Each keeps all half-edges mutual; the caller, which has the coordinates, must ensure that the new
//! triangles are counterclockwise.
//!
//! Ghosts are ordinary triangles here. No two triangles may share two edges, which holds in every
//! mesh except a chain.

use super::{Code, Patch, next, prev};

impl Patch<'_> {
    /// Flips the edge `e` in the quadrilateral of its two triangles. `e` keeps its apex p and
    /// becomes an edge opposite it; returns the other half-edge opposite p, in the other triangle.
    pub fn flip(&mut self, e: Code) -> Code {
        //        p                 p
        //      / t \             / | \         e was u v in t and is u q; o was v u in s and
        //     u --- v    ->     u  |  v        is v p. The edges p u and q v keep their codes.
        //      \ s /             \ | /
        //        q               t q s
        let o = self.opposite(e);
        let (p, q) = (self.vertex(e), self.vertex(o));
        let (beyond_uq, beyond_vp) = (self.opposite(next(o)), self.opposite(next(e)));
        self.set_vertex(prev(e), q);
        self.set_vertex(prev(o), p);
        self.link(e, beyond_uq);
        self.link(o, beyond_vp);
        self.link(next(e), next(o));
        prev(o)
    }

    /// Inserts the new vertex `p` in triangle `t`. Returns the three half-edges opposite p.
    pub fn split_triangle(&mut self, t: u32, p: u32) -> [Code; 3] {
        //        c                 c
        //       / \               /|\          t keeps b and c; r has c and a, s has a and b.
        //      / t \     ->      /r|t\         p is corner 0 of all three.
        //     /     \           / .p. \
        //    a ----- b         a - s - b
        let [a, b, c] = self.corners(t);
        let [_, beyond_ca, beyond_ab] = self.opposites(t);
        let (r, s) = (self.fresh(), self.fresh());
        self.set(t, [p, b, c]);
        self.set(r, [p, c, a]);
        self.set(s, [p, a, b]);
        let [t, r, s] = [t, r, s].map(|t| 8 * t);
        self.link(r, beyond_ca);
        self.link(s, beyond_ab);
        for (from, to) in [(t, r), (r, s), (s, t)] {
            self.link(from + 1, to + 2);
        }
        [t, r, s]
    }

    /// Inserts the new vertex `p` on the edge `e`. Returns the four half-edges opposite p.
    pub fn split_edge(&mut self, e: Code, p: u32) -> [Code; 4] {
        //        x                 x
        //      / t \             /t|r\         e is u p afterward, its opposite o is p u.
        //     u --- v    ->     u--p--v
        //      \ s /             \s|w/
        //        y                 y
        let o = self.opposite(e);
        let (x, y) = (self.vertex(e), self.vertex(o));
        let v = self.vertex(prev(e));
        let (beyond_vx, beyond_yv) = (self.opposite(next(e)), self.opposite(prev(o)));
        let (r, w) = (self.fresh(), self.fresh());
        self.set_vertex(prev(e), p);
        self.set_vertex(next(o), p);
        self.set(r, [x, p, v]);
        self.set(w, [y, v, p]);
        let [r, w] = [8 * r, 8 * w];
        self.link(r, w);
        self.link(next(e), r + 2);
        self.link(prev(o), w + 1);
        self.link(r + 1, beyond_vx);
        self.link(w + 2, beyond_yv);
        [prev(e), r + 1, next(o), w + 2]
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Code, Mesh2, Patch, next, prev, triangle};

    /// The corners of a triangle from the smallest on.
    fn turned(mesh: &Patch, t: u32) -> [u32; 3] {
        let mut c = mesh.corners(t);
        while c[0] != *c.iter().min().unwrap() {
            c.rotate_left(1);
        }
        c
    }

    fn all(mesh: &Patch, triangles: usize) -> Vec<[u32; 3]> {
        mesh.check(triangles).unwrap();
        let mut all: Vec<_> = (0..triangles as u32).map(|t| turned(mesh, t)).collect();
        all.sort_unstable();
        all
    }

    fn edge(mesh: &Patch, triangles: u32, ends: [u32; 2]) -> Code {
        let of = |e: Code| [mesh.vertex(next(e)), mesh.vertex(prev(e))];
        (0..8 * triangles)
            .filter(|e| e % 8 < 3)
            .find(|&e| of(e) == ends)
            .unwrap()
    }

    #[test]
    fn a_split_triangle_is_a_star() {
        let mut mesh = Mesh2::with_vertices(5).unwrap();
        let mut patch = mesh.patch();
        patch.triangle([0, 1, 2]);
        let star = patch.split_triangle(0, 3);
        assert!(star.iter().all(|&e| patch.vertex(e) == 3));
        let finite = [[0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let ghosts = [[0, 2, 5], [0, 5, 1], [1, 5, 2]];
        let mut expected = [finite, ghosts].concat();
        expected.sort_unstable();
        assert_eq!(all(&patch, 6), expected);
        // A split ghost becomes a triangle outside the hull and two ghosts.
        let outer = triangle(patch.opposite(edge(&patch, 6, [1, 2])));
        let star = patch.split_triangle(outer, 4);
        assert!(star.iter().all(|&e| patch.vertex(e) == 4));
        let after = all(&patch, 8);
        for new in [[1, 4, 2], [1, 5, 4], [2, 4, 5]] {
            assert!(after.contains(&new), "{new:?} in {after:?}");
        }
    }

    #[test]
    fn a_split_edge_has_four_triangles() {
        // An inner edge, and one of the hull.
        for ends in [[0, 3], [0, 1]] {
            let mut mesh = Mesh2::with_vertices(5).unwrap();
            let mut patch = mesh.patch();
            patch.triangle([0, 1, 2]);
            patch.split_triangle(0, 3);
            let e = edge(&patch, 6, ends);
            let apexes = [e, patch.opposite(e)].map(|e| patch.vertex(e));
            let star = patch.split_edge(e, 4);
            assert_eq!(star.map(|e| patch.vertex(e)), [4; 4]);
            let after = all(&patch, 8);
            assert!(!after.iter().any(|t| ends.iter().all(|v| t.contains(v))));
            for (x, end) in apexes.map(|x| ends.map(|end| (x, end))).concat() {
                let has = |t: &&[u32; 3]| [x, end, 4].iter().all(|v| t.contains(v));
                assert_eq!(after.iter().filter(has).count(), 1);
            }
        }
    }

    #[test]
    fn two_flips_reverse_an_edge() {
        let mut mesh = Mesh2::with_vertices(4).unwrap();
        let mut patch = mesh.patch();
        patch.triangle([0, 1, 2]);
        let outer = triangle(patch.opposite(0));
        patch.split_triangle(outer, 3);
        let before = all(&patch, 6);
        let e = edge(&patch, 6, [1, 2]);
        let p = patch.vertex(e);
        let other = patch.flip(e);
        assert_eq!([e, other].map(|e| patch.vertex(e)), [p; 2]);
        assert_eq!(
            all(&patch, 6).iter().filter(|t| **t == [0, 1, 3]).count(),
            1
        );
        let back = edge(&patch, 6, [0, 3]);
        patch.flip(back);
        assert_eq!(all(&patch, 6), before);
    }
}
