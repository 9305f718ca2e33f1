//! Scattered points: each triangle has the list of the points in it.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::plane::{NONE, Raised, below};
use super::points::{Points, Star, Wedge};
use super::task::Task;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::marked::Marked;
use crate::locate::{Batch, Kept, Locator, find};
use crate::mesh::plane::{half_edges, next, prev, triangle};
use crate::order;

/// A point in the list of its triangle.
#[derive(Debug, Clone, Copy)]
struct Place {
    raised: Raised,
    /// The next point of the list, or none.
    next: u32,
    row: u32,
}

/// The points of each triangle.
#[derive(Debug)]
pub struct Lists {
    /// The points along a curve, so that those of a triangle are close in memory.
    places: Vec<Place>,
    /// The first point of each triangle, or none.
    heads: Vec<u32>,
    /// The first points of the triangles of a star, so far.
    fresh: Vec<u32>,
}

impl Lists {
    /// The points in the triangles of the coarse surface.
    pub fn of(task: &Task, marked: &mut Marked, watch: &Watch) -> Result<Self> {
        let mut places = with_room(task.points.len())?;
        for row in order::order_of(task.points, task.workers, watch)?.concat() {
            let ([x, y], z) = (task.points[row as usize], task.z[row as usize]);
            places.push(Place {
                raised: [x, y, z],
                next: NONE,
                row,
            });
        }
        let kept = Kept::of(&task.coarse, watch)?;
        let homes = find(&Batch {
            locator: Locator::new(task.coarse, &kept, watch),
            queries: task.points,
            workers: task.workers,
            watch,
        })?;
        let mut heads = filled(task.coarse.simplices.len(), NONE)?;
        for i in (0..places.len()).rev() {
            let Place { raised, row, .. } = places[i];
            let home = u32::try_from(homes[row as usize]).map_err(|_| outside())?;
            let t = side_of_edge(marked, home, below(raised)) as usize;
            places[i].next = std::mem::replace(&mut heads[t], i as u32);
        }
        Ok(Self {
            places,
            heads,
            fresh: Vec::new(),
        })
    }
}

impl Points for Lists {
    fn raised(&self, i: u32) -> Raised {
        self.places[i as usize].raised
    }

    fn row(&self, i: u32) -> u32 {
        self.places[i as usize].row
    }

    fn is_smaller(&self, i: u32, j: u32) -> bool {
        lexicographic(below(self.raised(i)), below(self.raised(j))).is_lt()
    }

    fn judge(&self, wedge: &mut Wedge, pace: &mut Pace) -> Result<()> {
        let mut i = self.heads[wedge.triangle as usize];
        while i != NONE {
            pace.spend(1)?;
            wedge.meet(i, |i| self.raised(i));
            i = self.places[i as usize].next;
        }
        Ok(())
    }

    /// Moves the points from list to list.
    fn spread(&mut self, became: u32, star: &mut Star, pace: &mut Pace) -> Result<()> {
        self.fresh.clear();
        make_room(&mut self.fresh, star.wedges.len())?;
        self.fresh.resize(star.wedges.len(), NONE);
        let last = star.wedges.iter().fold(0, |most, w| most.max(w.triangle)) as usize;
        if last >= self.heads.len() {
            let more = last + 1 - self.heads.len();
            make_room(&mut self.heads, more)?;
            self.heads.resize(last + 1, NONE);
        }
        let mut at = 0;
        for k in 0..star.wedges.len() {
            let t = star.wedges[k].triangle as usize;
            let mut i = std::mem::replace(&mut self.heads[t], NONE);
            while i != NONE {
                pace.spend(1)?;
                let Place { raised, next, .. } = self.places[i as usize];
                if i != became {
                    // Points of a list are close together, so most are in the wedge of the one before.
                    at = star.wedge_of(at, below(raised));
                    star.wedges[at].meet(i, |i| self.places[i as usize].raised);
                    self.places[i as usize].next = std::mem::replace(&mut self.fresh[at], i);
                }
                i = next;
            }
        }
        for (wedge, &first) in star.wedges.iter().zip(&self.fresh) {
            self.heads[wedge.triangle as usize] = first;
        }
        Ok(())
    }
}

impl Star {
    /// Whether a point is on the ray at which a wedge starts, or to its left.
    #[inline]
    fn is_left(&self, k: usize, p: Point2) -> bool {
        let [center, start, _] = self.wedges[k].corners;
        if self.exact {
            let [dx, dy] = [p[0] - center[0], p[1] - center[1]];
            return (start[0] - center[0]) * dy - (start[1] - center[1]) * dx >= 0.0;
        }
        orient2d(center, start, p) != Sign::Negative
    }

    /// The wedge in which a point lies, by a search from `k` on: a point on a ray is in the wedge to its
    /// left. Wedges are less than half a turn, so a point to the left of a ray is met counterclockwise
    /// before one to its right would be; each step turns by a wedge, at most once around.
    #[inline]
    fn wedge_of(&self, mut k: usize, p: Point2) -> usize {
        let last = self.wedges.len() - 1;
        if self.is_left(k, p) {
            for _ in 0..last {
                let after = if k == last { 0 } else { k + 1 };
                if (after == 0 && !self.closed) || !self.is_left(after, p) {
                    break;
                }
                k = after;
            }
            return k;
        }
        for _ in 0..last {
            if k == 0 && !self.closed {
                break;
            }
            k = if k == 0 { last } else { k - 1 };
            if self.is_left(k, p) {
                break;
            }
        }
        k
    }
}

/// For a point on an edge between two triangles, the one on the left of the edge from its smaller
/// end on; else the triangle in which it lies.
fn side_of_edge(marked: &mut Marked, t: u32, p: Point2) -> u32 {
    let triangles = marked.triangles();
    let mesh = marked.mesh.resume(triangles);
    for e in half_edges(t) {
        let [u, v] = [next(e), prev(e)].map(|c| marked.points[mesh.vertex(c) as usize]);
        let o = mesh.opposite(e);
        let open = mesh.vertex(o) != mesh.infinite() && !mesh.is_marked(e);
        if open && lexicographic(v, u).is_lt() && orient2d(u, v, p).is_zero() {
            return triangle(o);
        }
    }
    t
}

/// A point has no triangle.
fn outside() -> Error {
    Error::Internal("a point is outside of the coarse surface".into())
}
