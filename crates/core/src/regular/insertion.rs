//! Regular triangulations by insertion: cavities, in which sites may disappear.
//!
//! A new site takes away all triangles whose planes it lies below, and is joined to the edges of
//! the hole; a site inside the hole is hidden from then on. A site above the plane of the triangle
//! that holds it is hidden at once (A. Bowyer; D. F. Watson, both 1981; H. Edelsbrunner and N. R.
//! Shah, "Incremental topological flipping works for regular triangulations", 1996). Predicates are
//! exact and ties broken, as if no four lifted sites lay on one plane: the triangles to go are
//! connected, their hole is star-shaped, and the result hangs on no order.
//!
//! Outside the hull ghosts take the part of triangles: (b, a, GHOST) for each hull edge from a to b.

use delone_predicates::Sign;

use crate::arrays::Arrays;
use crate::error::{Error, Result};
use crate::memory::{filled, with_room};
use crate::watch::Watch;

/// The vertex at infinity.
pub const GHOST: u32 = u32::MAX;
const NONE: u32 = u32::MAX;
/// Sites between two looks at the watch.
const WATCH_EVERY: u32 = 1 << 10;

/// Distinct sites, known by numbers, and what an insertion asks of them.
pub trait Sites {
    /// The turn from a by b to c.
    fn turn(&self, sites: [u32; 3]) -> Sign;
    /// Whether the fourth site lies below the plane of the other three, for counter-clockwise ones.
    fn height(&self, sites: [u32; 4]) -> Sign;
    /// Whether the third of three sites in line lies below the line through the lifted other two.
    fn height_in_line(&self, sites: [u32; 3]) -> Sign;
    /// Whether a comes before b in lexicographic order.
    fn smaller(&self, a: u32, b: u32) -> bool;

    /// [`Sites::height`] with ties broken, see `power`.
    fn is_below(&self, sites: [u32; 4]) -> bool {
        match self.height(sites) {
            Sign::Zero => self.tie(sites) == Sign::Positive,
            sign => sign == Sign::Positive,
        }
    }

    /// [`Sites::height_in_line`] with ties broken.
    fn is_below_in_line(&self, [a, b, p]: [u32; 3]) -> bool {
        match self.height_in_line([a, b, p]) {
            Sign::Zero => self.smaller(a, p) == self.smaller(b, p),
            sign => sign == Sign::Positive,
        }
    }

    /// The sign that infinitesimals give to four sites on one plane.
    fn tie(&self, mut sites: [u32; 4]) -> Sign {
        let mut odd = false;
        for i in 1..4 {
            for j in (1..=i).rev() {
                if self.smaller(sites[j], sites[j - 1]) {
                    sites.swap(j - 1, j);
                    odd = !odd;
                }
            }
        }
        let [o, p, q, r] = sites;
        for (k, others) in [[p, q, r], [o, q, r], [o, p, r], [o, p, q]]
            .into_iter()
            .enumerate()
        {
            let turn = self.turn(others);
            if turn != Sign::Zero {
                return turn.flip_if((k % 2 == 0) != odd);
            }
        }
        Sign::Zero // All four are in line: no triangle is among them.
    }
}

/// Triangles with ghosts.
pub struct Insertion<'a, S> {
    sites: &'a S,
    vertices: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
    free: Vec<u32>,
    /// The insertion in which a triangle was last looked at, and whether it has to go.
    seen: Vec<(u32, bool)>,
    /// For each vertex the new triangle whose outer edge begins there.
    begins: Vec<u32>,
    last: u32,
    stamp: u32,
}

/// Triangulates sites 0 to n - 1, inserted in this order; `Err` holds those of sites all in line that
/// are not hidden, in their order.
pub fn insert_all<S: Sites>(
    sites: &S,
    n: usize,
    watch: &Watch,
) -> Result<std::result::Result<Arrays<3>, Vec<u32>>> {
    let third = (2..n as u32).find(|&c| sites.turn([0, 1, c]) != Sign::Zero);
    let Some(third) = third else {
        return Ok(Err(chain(sites, n)));
    };
    let mut mesh = Insertion::of(sites, n, third)?;
    for p in (2..n as u32).filter(|&p| p != third) {
        if p.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        mesh.insert(p)?;
    }
    mesh.export().map(Ok)
}

/// The lower side of lifted sites in one vertical plane (A. M. Andrew's monotone chain, 1979).
fn chain<S: Sites>(sites: &S, n: usize) -> Vec<u32> {
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_unstable_by(|&a, &b| {
        if sites.smaller(a, b) {
            std::cmp::Ordering::Less
        } else {
            std::cmp::Ordering::Greater
        }
    });
    let mut kept: Vec<u32> = Vec::new();
    for c in order {
        while let [.., a, b] = kept[..] {
            if sites.is_below_in_line([a, c, b]) {
                break;
            }
            kept.pop();
        }
        kept.push(c);
    }
    kept
}

impl<'a, S: Sites> Insertion<'a, S> {
    fn of(sites: &'a S, n: usize, third: u32) -> Result<Self> {
        let mut mesh = Self {
            sites,
            vertices: with_room(2 * n)?,
            neighbors: with_room(2 * n)?,
            free: Vec::new(),
            seen: with_room(2 * n)?,
            begins: filled(n + 1, NONE)?,
            last: 0,
            stamp: 0,
        };
        let [a, b, c] = match sites.turn([0, 1, third]) {
            Sign::Negative => [1, 0, third],
            _ => [0, 1, third],
        };
        mesh.vertices = vec![[a, b, c], [c, b, GHOST], [a, c, GHOST], [b, a, GHOST]];
        mesh.neighbors = vec![[1, 2, 3], [3, 2, 0], [1, 3, 0], [2, 1, 0]];
        mesh.seen = vec![(0, false); 4];
        Ok(mesh)
    }

    fn insert(&mut self, p: u32) -> Result<()> {
        let start = self.locate(p)?;
        self.stamp += 1;
        if !self.must_go(start, p) {
            return Ok(()); // Hidden.
        }
        let mut stack = vec![start];
        let mut hole = Vec::new();
        let mut rim = Vec::new();
        // Each triangle is seen once in an insertion, and pushed then at most.
        while let Some(t) = stack.pop() {
            hole.push(t);
            for k in 0..3 {
                let other = self.neighbors[t as usize][k];
                if self.seen[other as usize].0 == self.stamp {
                    if !self.seen[other as usize].1 {
                        rim.push((t, k));
                    }
                } else if self.must_go(other, p) {
                    stack.push(other);
                } else {
                    rim.push((t, k));
                }
            }
        }
        self.fill(p, &rim, &hole)
    }

    /// The triangle that holds a site, boundary included; a ghost, outside the hull.
    fn locate(&self, p: u32) -> Result<u32> {
        let (mut t, mut from) = (self.last, NONE);
        // No walk in a regular triangulation comes back to a triangle, so it has no more steps.
        for _ in 0..=self.vertices.len() {
            let [a, b, c] = self.vertices[t as usize];
            let step = [(b, c), (c, a), (a, b)]
                .into_iter()
                .enumerate()
                .find(|&(k, (u, v))| {
                    self.neighbors[t as usize][k] != from
                        && self.sites.turn([u, v, p]) == Sign::Negative
                });
            let Some((k, _)) = step else { return Ok(t) };
            (t, from) = (self.neighbors[t as usize][k], t);
            if self.vertices[t as usize].contains(&GHOST) {
                return Ok(t);
            }
        }
        Err(Error::Internal(format!(
            "the walk to site {p} does not end"
        )))
    }

    /// Whether a triangle has to go for a site; remembered for this insertion.
    fn must_go(&mut self, t: u32, p: u32) -> bool {
        let [a, b, c] = self.vertices[t as usize];
        let ghost = |u: u32, v: u32| match self.sites.turn([u, v, p]) {
            Sign::Zero => self.sites.is_below_in_line([u, v, p]),
            turn => turn == Sign::Positive,
        };
        let goes = match GHOST {
            g if g == a => ghost(b, c),
            g if g == b => ghost(c, a),
            g if g == c => ghost(a, b),
            _ => self.sites.is_below([a, b, c, p]),
        };
        self.seen[t as usize] = (self.stamp, goes);
        goes
    }

    /// Joins a site to the rim of the hole; ASCII: each edge u -> v of the rim, seen from inside,
    ///
    /// ```text
    ///      u <--- v                 u <--- v
    ///    (outside above)    =>       \    /
    ///     the hole below              \  /
    ///                                  p
    /// ```
    fn fill(&mut self, p: u32, rim: &[(u32, usize)], hole: &[u32]) -> Result<()> {
        let slot = |v: u32, n: usize| if v == GHOST { n } else { v as usize };
        let n = self.begins.len() - 1;
        let mut made = Vec::with_capacity(rim.len());
        for &(t, k) in rim {
            let corners = self.vertices[t as usize];
            let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            let outside = self.neighbors[t as usize][k];
            made.push(([p, u, v], outside));
        }
        self.free.extend_from_slice(hole);
        let mut numbers = Vec::with_capacity(made.len());
        for &(corners, outside) in &made {
            let number = match self.free.pop() {
                Some(number) => number,
                None => {
                    self.vertices.push([0; 3]);
                    self.neighbors.push([NONE; 3]);
                    self.seen.push((0, false));
                    self.vertices.len() as u32 - 1
                }
            };
            numbers.push(number);
            self.begins[slot(corners[1], n)] = number;
            // The neighbour still names the triangle that went; others of the rim may have taken its
            // number already, so each link is found by its corners.
            let back = (0..3).find(|&j| {
                let o = self.vertices[outside as usize];
                (o[(j + 1) % 3], o[(j + 2) % 3]) == (corners[2], corners[1])
            });
            let back = back.ok_or_else(|| Error::Internal("a rim does not fit".into()))?;
            self.neighbors[outside as usize][back] = number;
        }
        for (&(corners, outside), &number) in made.iter().zip(&numbers) {
            // Across the edge from v to p lies the triangle whose outer edge begins at v.
            let next = self.begins[slot(corners[2], n)];
            self.vertices[number as usize] = corners;
            self.neighbors[number as usize][0] = outside;
            self.neighbors[number as usize][1] = next;
            self.neighbors[next as usize][2] = number;
            self.seen[number as usize] = (0, false);
            if !corners.contains(&GHOST) {
                self.last = number;
            }
        }
        // Triangles that are free hold nothing that could be taken for a triangle.
        for &t in &self.free[self.free.len().saturating_sub(hole.len())..] {
            self.vertices[t as usize] = [GHOST; 3];
        }
        Ok(())
    }

    fn export(self) -> Result<Arrays<3>> {
        let mut number = filled(self.vertices.len(), -1)?;
        let mut count = 0;
        for (corners, number) in self.vertices.iter().zip(&mut number) {
            if !corners.contains(&GHOST) {
                *number = count;
                count += 1;
            }
        }
        let mut out = Arrays {
            simplices: with_room(count as usize)?,
            neighbors: with_room(count as usize)?,
        };
        for (t, corners) in self
            .vertices
            .iter()
            .enumerate()
            .filter(|&(t, _)| number[t] >= 0)
        {
            out.simplices.push(corners.map(|v| v as i32));
            out.neighbors
                .push(self.neighbors[t].map(|other| number[other as usize]));
        }
        Ok(out)
    }
}
