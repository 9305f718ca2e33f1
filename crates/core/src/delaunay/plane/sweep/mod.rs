//! Fortune's sweep line algorithm: a vertical line moves over the points from left to right.
//!
//! S. Fortune, "A sweepline algorithm for Voronoi diagrams", Algorithmica 2 (1987), for the dual:
//! where a Voronoi vertex is found, a triangle is made. O(n log n) in the worst case: n points and
//! at most 2 n triangles, each with a search in a splay tree and a few heap operations.
//!
//! # The front
//!
//! A location left of the line is *settled* if it is nearer to some point than to the line. The
//! settled region is bounded by the beach line, arcs of parabolas. Each arc belongs to the point
//! that is nearest to all locations on it. From bottom to top the arcs name a sequence of points,
//! the *front*. Two consecutive points of the front have an empty circle that touches the line
//! between them: their edge is Delaunay. The front is the right boundary of the region triangulated so
//! far; an edge without a triangle is traversed twice.
//!
//! ```text
//!        c                 c            The line reaches q at the height of b's arc: b, q, b.
//!        |                 |            The line reaches the right end of the circle a b c, whose
//!        b     q    ->     b----q       arc b has shrunk to nothing: b is removed, and the
//!       /                 /             triangle a c b is made.
//!      a                 a
//! ```
//!
//! # Order and ties
//!
//! Points are processed lexicographically; ends of circles are compared exactly, square root
//! included (see `delone_predicates::sweep`), so each event happens in the state that the paper
//! proves right. Simultaneous events may be processed in any order:
//!
//! - Points with equal abscissas are processed from bottom to top. The leftmost points are
//!   consecutive in the front from the start: their arcs are rays. For any later one the arc at its
//!   height is found as for others, since a point on the line has its ray there, below.
//! - Circles that end together: an arc that has shrunk to nothing at the end of the circle a b c
//!   has a, b, c on an empty circle through that location. Removing b changes the front only in
//!   arcs of zero length; a further point of that circle, d, still ends with a, c at the same
//!   abscissa, as three points of a circle turn strictly. So the order picks one triangulation of
//!   the polygon of cocircular points, and all are Delaunay.
//! - A circle that ends on the abscissa of a point is processed first. If the point is its right
//!   end, it meets two arcs at once, and splits either: the arc of zero length between it and the
//!   other is the circle's again, and its end, the present abscissa, is the next event.
//!
//! `ties` makes the result canonical.
//!
//! # Termination
//!
//! Each point is processed once, and each circle removes one of the arcs that points have made, two
//! per point.

mod beach;
mod events;

use std::ops::Range;

use delone_predicates::{Point2, lexicographic, orient2d};

use self::beach::{Beach, NONE, Site};
use self::events::Events;
use super::ties;
use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, half_edge};

/// Events between two checks for interruption.
const WATCH_EVERY: usize = 4096;

/// Fills `mesh` with the triangulation of vertices `block` and returns a ghost; `None` if the block
/// is collinear. `points` end with NaN for infinity.
pub fn build(
    points: &[Point2],
    block: Range<u32>,
    mut mesh: Patch,
    watch: &Watch,
) -> Result<Option<Code>> {
    let own = &points[block.start as usize..block.end as usize];
    let straight = |w: &[Point2]| orient2d(own[0], own[1], w[0]).is_zero();
    if own.windows(1).skip(2).all(straight) {
        return Ok(None);
    }
    let mut sites: Vec<Site> = with_room(own.len())?;
    sites.extend(own.iter().copied().zip(block.clone()));
    sites.sort_unstable_by(|p, q| lexicographic(p.0, q.0));
    watch.check()?;
    let mut sweep = Sweep::start(&sites, mesh.reborrow(), watch)?;
    for &site in &sites[sweep.column..] {
        while sweep.circle(Some(site.0))? {}
        sweep.site(site)?;
    }
    while sweep.circle(None)? {}
    let ghost = sweep.close()?;
    let triangles = 2 * block.len() - 2;
    ties::fan(&mut mesh, points, triangles, watch)?;
    Ok(Some(ghost))
}

/// The state of the sweep.
struct Sweep<'a> {
    mesh: Patch<'a>,
    watch: &'a Watch<'a>,
    stops: usize,
    /// Records left for triangles and ghosts.
    room: usize,
    beach: Beach,
    events: Events,
    /// How many points have the smallest abscissa.
    column: usize,
    /// The ghosts to the left of them, from bottom to top.
    left: Vec<Code>,
}

/// The error of a broken invariant. A mesh of n vertices has 2 n - 2 triangles; a bug that makes
/// more ends here.
fn broken() -> Error {
    Error::Internal("the sweep's front is broken".into())
}

impl<'a> Sweep<'a> {
    /// The state when the line has passed the leftmost points.
    fn start(sites: &[Site], mesh: Patch<'a>, watch: &'a Watch<'a>) -> Result<Self> {
        let leftmost = sites[0].0[0];
        let column = sites.partition_point(|s| s.0[0] == leftmost);
        let mut sweep = Self {
            mesh,
            watch,
            stops: 0,
            room: 2 * sites.len() - 2,
            beach: Beach::default(),
            events: Events::default(),
            column,
            left: with_room(column)?,
        };
        let mut below = NONE;
        for &site in &sites[..column] {
            let arc = sweep.beach.insert_after(below, site);
            if below != NONE {
                // The ghost left of the edge from the point below to this one: its hull edge runs
                // down.
                let inf = sweep.mesh.infinite();
                let ghost =
                    sweep.triangle([inf, sweep.beach.arcs[below as usize].vertex, site.1])?;
                sweep.left.push(ghost);
                sweep.beach.arcs[below as usize].across = ghost;
            }
            below = arc;
        }
        Ok(sweep)
    }

    /// A new triangle.
    fn triangle(&mut self, corners: [u32; 3]) -> Result<Code> {
        self.room = self.room.checked_sub(1).ok_or_else(broken)?;
        let t = self.mesh.fresh();
        self.mesh.set(t, corners);
        Ok(half_edge(t, 0))
    }

    /// Counts an event.
    fn count(&mut self) -> Result<()> {
        self.stops += 1;
        if self.stops.is_multiple_of(WATCH_EVERY) {
            self.watch.check()?;
        }
        Ok(())
    }

    /// Point event: the new point splits the arc at its height.
    fn site(&mut self, site: Site) -> Result<()> {
        self.count()?;
        let arc = self.beach.find(site.0).ok_or_else(broken)?;
        self.events.remove(&mut self.beach, arc);
        let split = self.beach.split(arc, site);
        for side in split {
            self.events.renew(&mut self.beach, side);
        }
        Ok(())
    }

    /// Circle event: processes the next circle if it ends before the line meets `site`. Its arc is
    /// removed and its triangle added.
    fn circle(&mut self, site: Option<Point2>) -> Result<bool> {
        let Some(arc) = self.events.first_until(&self.beach, site.map(|p| p[0])) else {
            return Ok(false);
        };
        self.count()?;
        let [below, above] = [
            self.beach.arcs[arc as usize].below,
            self.beach.arcs[arc as usize].above,
        ];
        let corners = [below, above, arc].map(|i| self.beach.arcs[i as usize].vertex);
        let t = self.triangle(corners)?;
        self.settle(arc, t);
        self.settle(below, t + 1);
        for gone in [arc, below, above] {
            self.events.remove(&mut self.beach, gone);
        }
        self.beach.remove(arc);
        let edge = &mut self.beach.arcs[below as usize];
        (edge.across, edge.twin) = (t + 2, NONE);
        for side in [below, above] {
            self.events.renew(&mut self.beach, side);
        }
        Ok(true)
    }

    /// Links the edge above `arc` to the triangle's side `code` on its right.
    fn settle(&mut self, arc: u32, code: Code) {
        let edge = self.beach.arcs[arc as usize];
        if edge.twin == NONE {
            self.mesh.link(edge.across, code);
        } else {
            let twin = &mut self.beach.arcs[edge.twin as usize];
            (twin.across, twin.twin) = (code, NONE);
        }
    }

    /// Ends the sweep: the front is now the right side of the hull. Returns a ghost.
    fn close(mut self) -> Result<Code> {
        let mut ring: Vec<Code> = Vec::new();
        let mut arc = self.beach.lowest();
        loop {
            let edge = self.beach.arcs[arc as usize];
            if edge.above == NONE {
                break;
            }
            if edge.twin != NONE {
                return Err(broken());
            }
            let head = self.beach.arcs[edge.above as usize].vertex;
            let ghost = self.triangle([self.mesh.infinite(), head, edge.vertex])?;
            self.mesh.link(ghost, edge.across);
            ring.push(ghost);
            arc = edge.above;
        }
        ring.extend(self.left.iter().rev());
        if self.room != 0 {
            return Err(broken());
        }
        for (i, &ghost) in ring.iter().enumerate() {
            // Consecutive ghosts share the edge to their common vertex.
            self.mesh.link(ghost + 2, ring[(i + 1) % ring.len()] + 1);
        }
        Ok(ring[0])
    }
}
