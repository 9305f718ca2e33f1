//! Insertion of a segment: its cavity is emptied and triangulated again on both sides.
//!
//! M. V. Anglada, "An improved incremental algorithm for constructing restricted Delaunay
//! triangulations", Computers & Graphics 21 (1997), for the cavity; its two halves are then filled
//! as below. If the segment is an edge, finding it costs a turn around one of its ends, whichever
//! is shorter.
//!
//! ```text
//!       x-----x                x-----x
//!      /|\   /|\              /  ...  \       The triangles that a b crosses are removed. Each half
//!     a-|-\-/-|-b    ->      a---------b      of the cavity is a polygon whose vertices all see
//!      \|  x  |/              \ \ | / /       the segment along the crossed edges.
//!       x-----x                x--x--x
//! ```
//!
//! Such a polygon is triangulated by a scan like Graham's in linear time (G. T. Toussaint and D.
//! Avis, "On a convex hull algorithm for polygons and its application to triangulation problems",
//! Pattern Recognition 15, 1982), even if an edge dangles into it and a vertex occurs twice.
//! Lawson's flips then make it Delaunay: O(k^2) for k crossed edges in the worst case, and about k
//! log k for points that are not adversarial. Triangles outside the cavity do not change, since
//! the constrained Delaunay triangulation is unique and only a segment blocks visibility.

use delone_predicates::Sign;

use super::marked::{Marked, turn};
use super::sites::Sites;
use crate::base::error::{Error, Result};
use crate::mesh::plane::{Code, Patch, half_edge, next, prev, triangle};

/// How far the insertion of a segment came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// `from`, one of its ends, is joined to `to`, the next vertex on the segment; the edge may
    /// have been marked before.
    Joined {
        /// The end.
        from: u32,
        /// The vertex.
        to: u32,
        /// Whether another segment covers the edge, too.
        again: bool,
    },
    /// A marked edge blocks the segment, the first one from that end on; nothing has changed.
    Crossed(Code),
}

/// An edge of the cavity's boundary.
#[derive(Debug, Clone, Copy)]
struct Rim {
    /// Its end vertex, on the way from a to b.
    end: u32,
    /// The edge in the triangle that is removed.
    inner: Code,
    /// The edge in the new triangle.
    new: Code,
    /// Its other side.
    across: Code,
    marked: bool,
    /// The index of the rim that is its other side, for a dangling edge.
    twin: Option<u32>,
}

/// Buffers for one cavity, reused for the next.
#[derive(Debug, Default)]
pub struct Cavity {
    triangles: Vec<u32>,
    left: Vec<Rim>,
    right: Vec<Rim>,
    scan: Vec<(u32, Side)>,
}

impl Cavity {
    /// How many triangles the last segment crossed.
    pub fn size(&self) -> usize {
        self.triangles.len()
    }
}

/// An edge of the part of a polygon that is not yet triangulated.
#[derive(Debug, Clone, Copy)]
enum Side {
    /// Of the cavity's boundary, by place.
    Rim(usize),
    /// Of a new triangle.
    Inner(Code),
}

/// The vertex beyond edge `e`, which the segment from `a` to `b` crosses, and the next edge that
/// the segment crosses; `None` if it meets the vertex.
#[inline]
fn behind<S: Sites>(
    mesh: &Patch,
    points: &S,
    e: Code,
    a: u32,
    b: u32,
) -> Result<(u32, Option<Code>)> {
    let o = mesh.opposite(e);
    let x = mesh.vertex(o);
    if x == mesh.infinite() {
        let message = format!("the segment {a} {b} leaves the hull");
        return Err(Error::Internal(message));
    }
    Ok(match points.orient([a, b, x]) {
        Sign::Positive => (x, Some(next(o))),
        Sign::Negative => (x, Some(prev(o))),
        Sign::Zero => (x, None),
    })
}

impl<S: Sites> Marked<S> {
    /// Joins the distinct vertices `a` and `b` as far as the first vertex or marked edge on the
    /// segment, from one of its ends.
    pub fn join(&mut self, a: u32, b: u32, cavity: &mut Cavity) -> Result<Step> {
        let from = match self.search(a, b) {
            Found::Edge(e) => {
                let mut mesh = self.patch();
                let again = mesh.is_marked(e);
                mesh.mark(e, true);
                return Ok(Step::Joined {
                    from: a,
                    to: b,
                    again,
                });
            }
            Found::None(from) => from,
        };
        let to = a ^ b ^ from;
        match self.leave(from, to)? {
            Leave::Along(e, w) => {
                let mut mesh = self.patch();
                let again = mesh.is_marked(e);
                mesh.mark(e, true);
                Ok(Step::Joined { from, to: w, again })
            }
            Leave::Across(e) => self.cut(from, to, e, cavity),
        }
    }

    /// Calls `visit` for each edge that the segment from `a` to `b` crosses, except those that it
    /// only touches. Terminates as `gather` does.
    pub fn cross(&mut self, a: u32, b: u32, mut visit: impl FnMut(&Patch, Code)) -> Result<()> {
        self.trace(a, b, |mesh, met| {
            if let Met::Across(e) = met {
                visit(mesh, e);
            }
        })
    }

    /// Calls `visit` for all that the segment from `a` to `b` meets, except its ends.
    pub fn trace(&mut self, a: u32, b: u32, mut visit: impl FnMut(&Patch, Met)) -> Result<()> {
        let used = self.triangles();
        let mut from = a;
        while from != b {
            from = match self.leave(from, b)? {
                Leave::Along(e, w) => {
                    visit(&self.mesh.resume(used), Met::Along(e));
                    w
                }
                Leave::Across(first) => {
                    let mut e = first;
                    let mesh = self.mesh.resume(used);
                    loop {
                        visit(&mesh, Met::Across(e));
                        let (x, beyond) = behind(&mesh, &self.points, e, a, b)?;
                        let Some(f) = beyond else { break x };
                        e = f;
                    }
                }
            };
            if from != b {
                visit(&self.mesh.resume(used), Met::Vertex(from));
            }
        }
        Ok(())
    }

    /// Looks for the edge from `a` to `b` around both at once, as one of them may have a very high
    /// degree.
    fn search(&mut self, a: u32, b: u32) -> Found {
        let starts = [self.near[a as usize], self.near[b as usize]];
        let mesh = self.patch();
        let mut corners = starts;
        loop {
            for (k, other) in [(0, b), (1, a)] {
                if mesh.vertex(next(corners[k])) == other {
                    return Found::Edge(prev(corners[k]));
                }
                corners[k] = turn(&mesh, corners[k]);
                if corners[k] == starts[k] {
                    return Found::None([a, b][k]);
                }
            }
        }
    }

    /// How the segment from `a` to `b`, which is not an edge, leaves a.
    fn leave(&mut self, a: u32, b: u32) -> Result<Leave> {
        let start = self.near[a as usize];
        let used = self.triangles();
        let mesh = self.mesh.resume(used);
        let inf = mesh.infinite();
        let side = |v: u32| self.points.orient([a, b, v]);
        let mut corner = start;
        let mut right = None;
        // One step more than there are triangles: each edge is seen from both sides.
        let mut met = false;
        loop {
            let u = mesh.vertex(next(corner));
            let here = (u != inf).then(|| side(u));
            if here == Some(Sign::Zero) && self.points.ahead(a, b, u) {
                return Ok(Leave::Along(prev(corner), u));
            }
            if let (Some(before), Some(Sign::Positive)) = (right, here) {
                return Ok(Leave::Across(before));
            }
            // The triangle from here on: is its first vertex on the right?
            right = (here == Some(Sign::Negative)).then_some(corner);
            if met {
                let message = format!("the segment from {a} to {b} does not leave its end");
                return Err(Error::Internal(message));
            }
            corner = turn(&mesh, corner);
            met = corner == start;
        }
    }

    /// Inserts the segment from `a` to the first vertex on the way to `b`, across the edge `e`
    /// opposite a.
    fn cut(&mut self, a: u32, b: u32, e: Code, cavity: &mut Cavity) -> Result<Step> {
        let end = match self.gather(a, b, e, cavity)? {
            Step::Joined { to, .. } => to,
            crossed => return Ok(crossed),
        };
        if let [_, _] = cavity.triangles[..] {
            let mut mesh = self.patch();
            let other = mesh.flip_marked(e);
            mesh.mark(next(e), true);
            self.touch(triangle(e));
            self.touch(triangle(other));
        } else {
            self.fill(a, end, cavity)?;
        }
        Ok(Step::Joined {
            from: a,
            to: end,
            again: false,
        })
    }

    /// Collects the crossed triangles and the rims. Terminates: the crossed edges follow each other
    /// along a b.
    fn gather(&mut self, a: u32, b: u32, first: Code, cavity: &mut Cavity) -> Result<Step> {
        let used = self.triangles();
        let mesh = self.mesh.resume(used);
        let rim = |end: u32, inner: Code| Rim {
            end,
            inner,
            new: inner,
            across: mesh.opposite(inner),
            marked: mesh.is_marked(inner),
            twin: None,
        };
        let mut e = first;
        //        w             The edge e runs from u, on the right of a b, to w, on the left.
        //      / |
        //   a - -|- -> b
        //      \ |
        //        u
        cavity.triangles.clear();
        cavity.triangles.push(triangle(e));
        cavity.left.clear();
        cavity.left.push(rim(mesh.vertex(prev(e)), next(e)));
        cavity.right.clear();
        cavity.right.push(rim(mesh.vertex(next(e)), prev(e)));
        loop {
            if mesh.is_marked(e) {
                return Ok(Step::Crossed(e));
            }
            let o = mesh.opposite(e);
            let x = mesh.vertex(o);
            if x == mesh.infinite() {
                return Err(Error::Internal(format!(
                    "the segment {a} {b} leaves the hull"
                )));
            }
            cavity.triangles.push(triangle(o));
            let side = if x == b {
                Sign::Zero
            } else {
                self.points.orient([a, b, x])
            };
            match side {
                Sign::Positive => {
                    cavity.left.push(rim(x, prev(o)));
                    e = next(o);
                }
                Sign::Negative => {
                    cavity.right.push(rim(x, next(o)));
                    e = prev(o);
                }
                Sign::Zero => {
                    cavity.left.push(rim(x, prev(o)));
                    cavity.right.push(rim(x, next(o)));
                    return Ok(Step::Joined {
                        from: a,
                        to: x,
                        again: false,
                    });
                }
            }
        }
    }

    /// Fills a cavity from `a` to `b` of at least three triangles, and marks the edge between them.
    fn fill(&mut self, a: u32, b: u32, cavity: &mut Cavity) -> Result<()> {
        let Cavity {
            triangles,
            left,
            right,
            scan,
        } = cavity;
        let halves = left.len();
        let rims = left;
        rims.append(right);
        self.pair(rims);
        let mut free = triangles.clone();
        self.stack.clear();
        // The left half lies left of a b, the right half left of b a, so its rims run backward.
        let ahead = (0..halves).map(|i| (i, i));
        let upper = self.scan([a, b], ahead, rims, &mut free, scan)?;
        let back = (halves..rims.len()).rev().map(|i| (i.wrapping_sub(1), i));
        let lower = self.scan([b, a], back, rims, &mut free, scan)?;
        self.stitch(rims);
        let mut mesh = self.patch();
        mesh.link(upper, lower);
        mesh.mark(upper, true);
        self.legalize()?;
        for &t in triangles.iter() {
            self.patch().release(t);
            self.touch(t);
        }
        Ok(())
    }

    /// Finds the pairs of rims that are two sides of one edge, which dangles into the cavity.
    fn pair(&mut self, rims: &mut [Rim]) {
        let mut mesh = self.patch();
        for (i, r) in (0..).zip(rims.iter()) {
            mesh.set_opposite(r.inner, i);
        }
        for i in 0..rims.len() {
            let across = rims[i].across;
            // Outside the cavity this is a code that leads to no such rim.
            let twin = mesh.opposite(across);
            let is_rim = rims.get(twin as usize).is_some_and(|r| r.inner == across);
            rims[i].twin = is_rim.then_some(twin);
        }
    }

    /// Triangulates the polygon on the left of the edge from `start` to `end`. Its other edges are
    /// the rims given second in `chain`, on the way from start to end; each leads to the vertex of
    /// the rim given first, and the last one to `end`. Returns the new side of that edge.
    fn scan(
        &mut self,
        [start, end]: [u32; 2],
        chain: impl ExactSizeIterator<Item = (usize, usize)>,
        rims: &mut [Rim],
        free: &mut Vec<u32>,
        scan: &mut Vec<(u32, Side)>,
    ) -> Result<Code> {
        let broken = || Error::Internal("a cavity is not a polygon".into());
        let last = chain.len();
        scan.clear();
        scan.push((start, Side::Rim(usize::MAX)));
        for (i, (to, place)) in (1..).zip(chain) {
            let v = if i == last { end } else { rims[to].end };
            let mut side = Side::Rim(place);
            //        top
            //       /   \         An ear: the chain turns right at top, so the triangle lies in the
            //  below --- v        polygon, and v takes the place of top.
            while let [.., (below, _), (top, top_side)] = scan[..] {
                if self.points.orient([below, v, top]) != Sign::Positive {
                    break;
                }
                let t = free.pop().ok_or_else(broken)?;
                let used = self.triangles();
                let mut mesh = self.mesh.resume(used);
                mesh.set(t, [below, v, top]);
                mesh.clear(t);
                for (old, new) in [(side, half_edge(t, 0)), (top_side, half_edge(t, 1))] {
                    match old {
                        Side::Rim(i) => rims.get_mut(i).ok_or_else(broken)?.new = new,
                        Side::Inner(e) => {
                            mesh.link(e, new);
                            self.stack.push(new);
                        }
                    }
                }
                side = Side::Inner(half_edge(t, 2));
                scan.pop();
            }
            scan.push((v, side));
        }
        match scan[..] {
            [_, (_, Side::Inner(e))] => Ok(e),
            _ => Err(broken()),
        }
    }

    /// Links the new triangles to the codes across their rims, and updates those.
    fn stitch(&mut self, rims: &[Rim]) {
        let mut mesh = self.patch();
        for r in rims {
            let twin = r.twin.and_then(|i| rims.get(i as usize));
            mesh.link(r.new, twin.map_or(r.across, |twin| twin.new));
        }
        for r in rims {
            if r.marked {
                mesh.mark(r.new, true);
            }
            mesh.fix(r.new);
        }
    }
}

/// What a segment meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Met {
    /// An edge that it crosses.
    Across(Code),
    /// An edge that it runs along.
    Along(Code),
    /// A vertex between its ends.
    Vertex(u32),
}

/// Whether two vertices are joined.
enum Found {
    Edge(Code),
    /// They are not; the search around this one was shorter.
    None(u32),
}

/// How a segment leaves its end.
enum Leave {
    /// Along an edge to a vertex.
    Along(Code, u32),
    /// Across the edge opposite its end.
    Across(Code),
}
