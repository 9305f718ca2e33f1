//! Regular triangulations by incremental insertion of cavities; sites may become hidden.
//!
//! A new site removes all triangles whose lifted planes it lies below, and is joined to the edges
//! of the cavity; a site inside the cavity is hidden from then on. A site above the plane of the
//! triangle that contains it is hidden at once (A. Bowyer; D. F. Watson, both 1981; H. Edelsbrunner
//! and N. R. Shah, "Incremental topological flipping works for regular triangulations", 1996).
//! Predicates are exact and ties broken as if no four lifted sites were coplanar: the triangles to
//! be removed are connected, their cavity is star-shaped, and the result is independent of the
//! order of insertion.
//!
//! Outside the hull, ghosts take the place of triangles: (b, a, GHOST) for each hull edge from a to
//! b.

use delone_predicates::Sign;

use super::records::{GHOST, NONE, Records};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::filled;
use crate::base::proof::Verdict;
use crate::base::watch::Watch;

/// Sites inserted between two checks for interruption.
const WATCH_EVERY: u32 = 1 << 10;

/// Distinct sites, by number, and the predicates that an insertion needs.
pub trait Sites {
    /// The orientation of three sites.
    fn turn(&self, sites: [u32; 3]) -> Sign;
    /// Whether the fourth site lies below the lifted plane of the other three, which are
    /// counterclockwise.
    fn height(&self, sites: [u32; 4]) -> Sign;
    /// For three collinear sites, whether the third lies below the line through the lifted other
    /// two.
    fn height_in_line(&self, sites: [u32; 3]) -> Sign;
    /// Whether a precedes b in lexicographic order.
    fn smaller(&self, a: u32, b: u32) -> bool;

    /// [`Sites::height`] with ties broken, see `power`.
    fn is_below(&self, sites: [u32; 4]) -> bool {
        match self.height(sites) {
            Sign::Zero => self.tie(sites) == Sign::Positive,
            sign => sign == Sign::Positive,
        }
    }

    /// Whether triangle p, u, v and its neighbor across the edge from u to v, with apex q, are
    /// locally regular.
    fn verdict(&self, [p, u, v, q]: [u32; 4]) -> Verdict {
        match self.height([p, u, v, q]) {
            Sign::Positive => Verdict::Wrong,
            Sign::Zero if self.tie([p, u, v, q]) == Sign::Positive => Verdict::Tie,
            _ => Verdict::Right,
        }
    }

    /// [`Sites::height_in_line`] with ties broken.
    fn is_below_in_line(&self, [a, b, p]: [u32; 3]) -> bool {
        match self.height_in_line([a, b, p]) {
            Sign::Zero => self.smaller(a, p) == self.smaller(b, p),
            sign => sign == Sign::Positive,
        }
    }

    /// The sign of a tie of four sites whose lifts are coplanar.
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
        Sign::Zero // All four are collinear: there is no triangle among them.
    }
}

/// Triangles with ghosts.
struct Insertion<'a, S> {
    sites: &'a S,
    mesh: Records<3>,
    /// For each vertex, the new triangle whose outer edge begins there.
    begins: Vec<u32>,
}

/// Triangulates sites 0 to n - 1, inserted in this order. If all are collinear, `Err` has the sites
/// that are not hidden, in order.
pub fn insert_all<S: Sites>(
    sites: &S,
    n: usize,
    watch: &Watch,
) -> Result<std::result::Result<Arrays<3>, Vec<u32>>> {
    let third = (2..n as u32).find(|&c| sites.turn([0, 1, c]) != Sign::Zero);
    let Some(third) = third else {
        return Ok(Err(chain(sites, n)));
    };
    let mut insertion = Insertion::of(sites, n, third)?;
    for p in (2..n as u32).filter(|&p| p != third) {
        if p.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        insertion.insert(p)?;
    }
    insertion.mesh.export().map(Ok)
}

/// The lower hull of lifted sites in one vertical plane (A. M. Andrew's monotone chain, 1979).
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
        let [a, b, c] = match sites.turn([0, 1, third]) {
            Sign::Negative => [1, 0, third],
            _ => [0, 1, third],
        };
        let mut mesh = Records::with_room(2 * n)?;
        mesh.push([a, b, c], [1, 2, 3]);
        mesh.push([c, b, GHOST], [3, 2, 0]);
        mesh.push([a, c, GHOST], [1, 3, 0]);
        mesh.push([b, a, GHOST], [2, 1, 0]);
        Ok(Self {
            sites,
            mesh,
            begins: filled(n + 1, NONE)?,
        })
    }

    /// Inserts a site; nothing changes if it is hidden.
    fn insert(&mut self, p: u32) -> Result<()> {
        let sites = self.sites;
        let start = self.mesh.locate(p, |corners, k| {
            let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            sites.turn([u, v, p]) == Sign::Negative
        })?;
        let conflicts = |mesh: &Records<3>, t: u32| conflicts(sites, mesh.vertices[t as usize], p);
        match self.mesh.hole(start, conflicts) {
            Some((hole, rim)) => self.fill(p, &rim, &hole),
            None => Ok(()),
        }
    }

    /// Joins a site to the boundary of the cavity; each boundary edge u -> v, seen from inside:
    ///
    /// ```text
    ///      u <--- v                 u <--- v
    ///    (outside above)    =>       \    /
    ///     the cavity below            \  /
    ///                                  p
    /// ```
    fn fill(&mut self, p: u32, rim: &[(u32, usize)], hole: &[u32]) -> Result<()> {
        let slot = |v: u32, n: usize| if v == GHOST { n } else { v as usize };
        let n = self.begins.len() - 1;
        let mut made = Vec::with_capacity(rim.len());
        for &(t, k) in rim {
            let corners = self.mesh.vertices[t as usize];
            let (u, v) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            made.push(([p, u, v], self.mesh.neighbors[t as usize][k]));
        }
        self.mesh.release(hole);
        let mut numbers = Vec::with_capacity(made.len());
        for &(corners, outside) in &made {
            let number = self.mesh.take();
            numbers.push(number);
            self.begins[slot(corners[1], n)] = number;
            // The neighbor still links to the removed triangle, and other triangles of the boundary
            // may have reused its number, so each link is found by its corners.
            let back = (0..3).find(|&j| {
                let o = self.mesh.vertices[outside as usize];
                (o[(j + 1) % 3], o[(j + 2) % 3]) == (corners[2], corners[1])
            });
            let back = back.ok_or_else(|| {
                Error::Internal("the boundary of a cavity does not match its neighbors".into())
            })?;
            self.mesh.neighbors[outside as usize][back] = number;
        }
        for (&(corners, outside), &number) in made.iter().zip(&numbers) {
            // Across the edge from v to p is the triangle whose outer edge begins at v.
            let next = self.begins[slot(corners[2], n)];
            self.mesh.vertices[number as usize] = corners;
            self.mesh.neighbors[number as usize][0] = outside;
            self.mesh.neighbors[number as usize][1] = next;
            self.mesh.neighbors[next as usize][2] = number;
            if !corners.contains(&GHOST) {
                self.mesh.last = number;
            }
        }
        self.mesh.empty(hole);
        Ok(())
    }
}

/// Whether a triangle is in conflict with a site.
fn conflicts<S: Sites>(sites: &S, [a, b, c]: [u32; 3], p: u32) -> bool {
    let ghost = |u: u32, v: u32| match sites.turn([u, v, p]) {
        Sign::Zero => sites.is_below_in_line([u, v, p]),
        turn => turn == Sign::Positive,
    };
    match GHOST {
        g if g == a => ghost(b, c),
        g if g == b => ghost(c, a),
        g if g == c => ghost(a, b),
        _ => sites.is_below([a, b, c, p]),
    }
}
