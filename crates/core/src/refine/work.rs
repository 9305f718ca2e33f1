//! The refinement loop: splits encroached subsegments first, then improves the bad triangle with
//! the shortest edge.
//!
//! Words: a triangle is *bad* if its smallest angle is below the bound (it is *skinny*, for the
//! reason `Angle`) or its area above its *cap* (`Size`). A point *encroaches* upon a subsegment if
//! it lies in its *lens*, where it sees both ends at more than a fixed angle, or with `circles` in
//! its diametral circle. A vertex is *free* if it is on no line. The *apex* of a triangle is the
//! corner opposite its shortest edge. A triangle is *final* in a needle that is postponed until
//! everything else is done.
//!
//! A vertex for a bad triangle is not inserted if it lies beyond a subsegment or in the lens of
//! one; the subsegment is split instead.
//!
//! A limit on vertices ends refinement in any case; in practice it ends before up to about 33
//! degrees. Proofs exist for its close relatives: with diametral circles (`circles`) up to 20.7
//! degrees, each new edge is at least as long as a fixed share of existing lengths; with lenses up to
//! 26.6, if free vertices in the circle of a subsegment are removed before it is split, which is not
//! done here. With sharp corners the circles around them and the rule for triangles that span them
//! keep edges from shrinking.

use std::collections::HashMap;
use std::iter::once;

use delone_predicates::{Point2, Sign, orient2d};

use super::corners::{self, SHARP};
use super::insert::{Cavity, Walk, walk};
use super::needles::Needles;
use super::place::{Bend, Places};
use super::queue::{Bad, Queue};
use super::shape::{Reason, Seen, Shape, angle, dot, minus};
use super::task::{Counts, Rules, Tell};
use crate::base::error::Result;
use crate::base::memory::{copied, make_room, push, with_room};
use crate::base::watch::Watch;
use crate::constrained::conforming::cut;
use crate::constrained::marked::{Marked, turn};
use crate::mesh::plane::{Code, half_edge, half_edges, next, prev, triangle};

/// Vertices between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;

/// Radii around a corner with a smaller relative difference are equal.
const SAME_SHELL: f64 = 1e-3;

/// A vertex that improves two triangles must be farther from all others than the square root of
/// this times the shortest edge of the first: above 1, so that edges do not keep getting shorter.
const APART: f64 = 1.3;

fn distance(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A subsegment at the time when it was queued.
#[derive(Debug, Clone, Copy)]
struct Queued {
    edge: Code,
    ends: [u32; 2],
}

/// The result of looking for a cavity.
#[derive(Debug)]
enum Site {
    /// Nothing is in the way: the cavity is ready.
    Free,
    /// Subsegments that hide the vertex, or upon which it encroaches.
    Blocked(Vec<Code>),
    /// A vertex is there, or the position is not in the domain.
    Lost,
}

/// Where a vertex lies that splits a subsegment.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// On the edge, as far as its two triangles can tell.
    On,
    /// In the triangle on this side: it is rounded, and the one on the other side is too thin to
    /// contain it.
    Beside(Code),
}

/// The points next to `x` in the grid of doubles.
fn neighbors(x: Point2) -> impl Iterator<Item = Point2> {
    let [xs, ys] = x.map(|c| [c, c.next_down(), c.next_up()]);
    let all = xs.into_iter().flat_map(move |x| ys.map(|y| [x, y]));
    all.skip(1)
}

/// The state of a refinement.
#[derive(Debug)]
pub struct Work {
    pub marked: Marked,
    /// The limit on twice the area of each triangle.
    pub caps: Vec<f64>,
    /// For each vertex the line on which it was placed, or -1.
    pub on: Vec<i32>,
    pub counts: Counts,
    pub(super) rules: Rules,
    /// The lines as pairs of vertices, followed by the fences.
    pub(super) ends: Vec<[u32; 2]>,
    /// The line between two vertices of the input.
    between: HashMap<[u32; 2], i32>,
    pub(super) sharp: Vec<bool>,
    pub(super) shape: Shape,
    pub needles: Needles,
    places: Places,
    queue: Queue,
    encroached: Vec<Queued>,
    cavity: Cavity,
    /// The number of vertices of the input.
    pub(super) own: usize,
}

impl Work {
    pub fn new(
        marked: Marked,
        caps: Vec<f64>,
        on: Vec<i32>,
        [pieces, ends]: [&[[u32; 2]]; 2],
        of: Option<&[i32]>,
        rules: Rules,
    ) -> Result<Self> {
        let own = marked.count;
        let key = |&[u, v]: &[u32; 2]| [u.min(v), u.max(v)];
        let line = |i: usize| of.map_or(i as i32, |of| of[i]);
        Ok(Self {
            caps,
            on,
            counts: Counts::default(),
            needles: Needles::of(ends.len()),
            ends: copied(ends)?,
            between: (pieces.iter().enumerate())
                .map(|(i, e)| (key(e), line(i)))
                .collect(),
            sharp: corners::sharp(&marked.points, pieces, own, SHARP)?,
            shape: Shape::new(rules.min_angle, rules.circles),
            places: Places::new(rules.min_angle),
            rules,
            queue: Queue::default(),
            encroached: with_room(64)?,
            cavity: Cavity::default(),
            own,
            marked,
        })
    }

    /// Starts again with all present vertices, as if all had been given.
    pub fn begin_again(&mut self, max_vertices: usize) -> Result<()> {
        self.own = self.marked.count;
        self.rules.max_vertices = max_vertices;
        self.ends.truncate(self.needles.lines);
        self.needles = Needles {
            kept: std::mem::take(&mut self.needles.kept),
            ..Needles::of(self.ends.len())
        };
        let pieces = self.pieces()?;
        self.sharp = corners::sharp(&self.marked.points, &pieces, self.own, SHARP)?;
        Ok(())
    }

    /// The subsegments, each once.
    pub(super) fn pieces(&mut self) -> Result<Vec<[u32; 2]>> {
        let mut pieces = Vec::new();
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        for e in (0..triangles).flat_map(half_edges) {
            let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
            if ends[0] < ends[1] && mesh.is_marked(e) {
                push(&mut pieces, ends)?;
            }
        }
        Ok(pieces)
    }

    /// Refines until nothing is bad, first outside needles, then in those that the budget
    /// allows; returns false if the limit on vertices was reached.
    pub fn run(&mut self, watch: &Watch, tell: Tell) -> Result<bool> {
        self.isolate_needles()?;
        let mut done = self.refine(watch, tell)?;
        if done && self.open_allowed()? {
            done = self.refine(watch, tell)?;
        }
        self.open_all()?;
        Ok(done)
    }

    /// Refines until nothing is bad outside needles.
    fn refine(&mut self, watch: &Watch, tell: Tell) -> Result<bool> {
        // Everything is looked at once; afterward only what a new vertex has changed.
        for t in 0..self.marked.triangles() {
            self.enqueue_if_bad(t)?;
            for e in half_edges(t) {
                self.enqueue_if_encroached(e)?;
            }
        }
        let mut until_watch = 1;
        loop {
            until_watch -= 1;
            if until_watch == 0 {
                watch.check()?;
                let added = self.marked.count - self.own;
                tell(added, &mut || self.smallest())?;
                until_watch = WATCH_EVERY;
            }
            if self.marked.count - self.own >= self.rules.max_vertices {
                return Ok(false);
            }
            // Subsegments first: a vertex for a triangle may be inserted only if it encroaches on none.
            // What was queued may be gone, or be right by now.
            if let Some(queued) = self.encroached.pop() {
                if self.still_exists(&queued) && self.is_encroached(queued.edge) {
                    // Work in a needle is counted, on both sides of the edge.
                    self.count(triangle(queued.edge));
                    let o = self.marked.patch().opposite(queued.edge);
                    self.count(triangle(o));
                    self.split(queued.edge)?;
                }
            } else if let Some(bad) = self.queue.pop() {
                if self.marked.patch().corners(bad.triangle) == bad.corners {
                    self.count(bad.triangle);
                    self.improve(bad.triangle)?;
                }
            } else {
                return Ok(true);
            }
        }
    }

    /// The smallest angle of the domain, in degrees.
    fn smallest(&mut self) -> f64 {
        let mut least: f64 = 180.0;
        for t in 0..self.marked.triangles() {
            if self.marked.patch().label(t) != 0 {
                least = least.min(angle(self.points_of(t)));
            }
        }
        least
    }

    pub(super) fn at(&self, v: u32) -> Point2 {
        self.marked.points[v as usize]
    }

    pub(super) fn points_of(&mut self, t: u32) -> [Point2; 3] {
        let corners = self.marked.patch().corners(t);
        corners.map(|v| self.marked.points[v as usize])
    }

    /// The line of which an edge between two vertices is a part, or -1.
    pub fn segment_of(&self, [u, v]: [u32; 2]) -> i32 {
        if let Some(fence) = self.needles.fence([u, v]) {
            return fence;
        }
        // A vertex that was placed on a segment is on no other.
        let on = self.on[u as usize].max(self.on[v as usize]);
        if on >= 0 {
            return on;
        }
        let key = [u.min(v), u.max(v)];
        self.between.get(&key).copied().unwrap_or(-1)
    }

    /// Queues a triangle if it is bad.
    fn enqueue_if_bad(&mut self, t: u32) -> Result<()> {
        let mesh = self.marked.patch();
        let label = mesh.label(t);
        if label == 0 {
            return Ok(());
        }
        let corners = mesh.corners(t);
        let seen = self.shape.see(corners.map(|v| self.at(v)));
        let (fault, cap) = (
            self.shape.fault(&seen, self.caps[t as usize]),
            self.caps[t as usize],
        );
        if fault.is_some() && (!self.needles.rest(label) || seen.area2 > cap) {
            let bad = Bad {
                triangle: t,
                corners,
            };
            self.queue.push(bad, seen.shortest)?;
        }
        Ok(())
    }

    /// Queues the edge `e` if it is a subsegment encroached by its apex.
    fn enqueue_if_encroached(&mut self, e: Code) -> Result<()> {
        let mesh = self.marked.patch();
        if mesh.is_marked(e) && self.encroaches(e) {
            let mesh = self.marked.patch();
            let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
            push(&mut self.encroached, Queued { edge: e, ends })?;
        }
        Ok(())
    }

    /// Makes room for one more vertex.
    fn grow(&mut self) -> Result<()> {
        self.marked.grow()?;
        make_room(&mut self.marked.near, 1)?;
        make_room(&mut self.on, 1)?;
        make_room(&mut self.caps, 2)
    }

    /// Whether the apex of `e`, in a triangle of the domain, lies in the lens of e.
    fn encroaches(&mut self, e: Code) -> bool {
        let mesh = self.marked.patch();
        let label = mesh.label(triangle(e));
        if label == 0 || self.needles.rest(label) {
            return false;
        }
        let [p, q, r] = [next(e), prev(e), e].map(|c| mesh.vertex(c));
        self.shape.in_lens(self.at(p), self.at(q), self.at(r))
    }

    fn is_encroached(&mut self, e: Code) -> bool {
        let o = self.marked.patch().opposite(e);
        self.encroaches(e) || self.encroaches(o)
    }

    /// Whether a queued subsegment still exists.
    fn still_exists(&mut self, queued: &Queued) -> bool {
        let (mesh, e) = (self.marked.patch(), queued.edge);
        mesh.is_marked(e) && [next(e), prev(e)].map(|c| mesh.vertex(c)) == queued.ends
    }

    /// Splits the subsegment `e`; false if that is forbidden or impossible.
    fn split(&mut self, e: Code) -> Result<bool> {
        let mesh = self.marked.patch();
        let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
        let segment = self.segment_of([u, v]);
        let fence = self.needles.is_fence(segment);
        if segment >= 0 && !fence && self.rules.frozen[segment as usize] {
            return Ok(false);
        }
        // The rounded point may be off the line: it must leave the triangles beside it positive, or
        // lie inside one of them; its neighboring doubles are tried, too.
        let x = self.split_point(u, v);
        let around = once(x).chain(neighbors(x));
        let Some((x, place)) = around
            .into_iter()
            .find_map(|x| Some((x, self.place(e, x)?)))
        else {
            return Ok(false);
        };
        self.grow()?;
        let w = self.marked.count as u32;
        self.marked.points[w as usize] = x;
        match place {
            Place::On => self.split_at(e, w),
            Place::Beside(e) => self.split_beside(e, w),
        }
        // The vertex is on the line of the subsegment, and flips make its triangles Delaunay.
        self.marked.near[w as usize] = self.marked.stack[0];
        self.on.push(segment);
        self.legalize()?;
        if fence {
            self.needles.split_at([u, v], w);
            self.counts.angle += 1;
        } else {
            self.counts.segment += 1;
        }
        self.enqueue_around(w)?;
        Ok(true)
    }

    /// Where `x`, which may be rounded, splits the subsegment `e`.
    fn place(&mut self, e: Code, x: Point2) -> Option<Place> {
        let mesh = self.marked.patch();
        let o = mesh.opposite(e);
        let inf = mesh.infinite();
        let [u, v, p, q] = [next(e), prev(e), e, o].map(|c| mesh.vertex(c));
        let [a, b] = [u, v].map(|v| self.at(v));
        if x == a || x == b {
            return None;
        }
        // On the edge: the two parts of the triangle on each side stay positive.
        let left = |a, b, c| orient2d(a, b, c) == Sign::Positive;
        let holds = |apex: u32, [a, b]: [Point2; 2]| {
            let at = self.at(apex);
            apex == inf || left(a, x, at) && left(x, b, at)
        };
        if holds(p, [a, b]) && holds(q, [b, a]) {
            return Some(Place::On);
        }
        // Otherwise inside one of the two triangles, if there is one on the other side, too.
        let inside = |apex: u32, [a, b]: [Point2; 2]| {
            let at = self.at(apex);
            apex != inf && left(a, b, x) && left(b, at, x) && left(at, a, x)
        };
        let beside = [(e, p, [a, b], q), (o, q, [b, a], p)].into_iter();
        let mut beside = beside.filter(|&(.., beyond)| beyond != inf);
        let found = beside.find(|&(_, apex, ends, _)| inside(apex, ends));
        found.map(|(e, ..)| Place::Beside(e))
    }

    /// Inserts the vertex `w` on the subsegment `e`. Edges to flip are on the stack, including
    /// those of `w` itself, since a rounded point may be outside the circumcircle of a thin
    /// triangle.
    fn split_at(&mut self, e: Code, w: u32) {
        let mut mesh = self.marked.patch();
        let o = mesh.opposite(e);
        let star = mesh.split_marked_edge(e, w);
        self.marked.count += 1;
        self.marked.near.push(0);
        // The new triangles inherit the caps of those that they are cut from.
        let spokes = star.map(next);
        let [_, r, _, s] = star.map(triangle);
        self.caps.resize(self.marked.triangles() as usize, 0.0);
        self.caps[r as usize] = self.caps[triangle(e) as usize];
        self.caps[s as usize] = self.caps[triangle(o) as usize];
        self.marked.stack.clear();
        self.marked.stack.extend(star);
        self.marked.stack.extend(spokes);
    }

    /// Reroutes the subsegment `e` through the vertex `w` in its triangle. The thin triangle that
    /// is separated belongs to the other side.
    fn split_beside(&mut self, e: Code, w: u32) {
        let mut mesh = self.marked.patch();
        let beyond = triangle(mesh.opposite(e));
        let label = mesh.label(beyond);
        // The two new edges at `w` take the place of `e`, and the triangle between goes beyond them.
        mesh.mark(e, false);
        let star = mesh.split_marked_triangle(triangle(e), w);
        let thin = star[(e & 3) as usize];
        mesh.mark(next(thin), true);
        mesh.mark(prev(thin), true);
        mesh.set_label(triangle(thin), label);
        self.marked.count += 1;
        self.marked.near.push(0);
        let cap = self.caps[triangle(e) as usize];
        self.caps.resize(self.marked.triangles() as usize, cap);
        for side in star {
            self.caps[triangle(side) as usize] = cap;
        }
        self.caps[triangle(thin) as usize] = self.caps[beyond as usize];
        self.marked.stack.clear();
        self.marked.stack.extend(star);
    }

    fn split_point(&self, u: u32, v: u32) -> Point2 {
        let corner = |v: u32| (v as usize) < self.own && self.sharp[v as usize];
        let [u, v] = if corner(u) { [u, v] } else { [v, u] };
        cut(self.at(u), self.at(v), corner(u) && !corner(v))
    }

    /// Legalizes the edges on the stack, until all are Delaunay again.
    fn legalize(&mut self) -> Result<()> {
        self.marked.legalize()
    }

    /// Enqueues the triangles around the new vertex `w` that are bad, and the subsegments it
    /// encroaches upon.
    fn enqueue_around(&mut self, w: u32) -> Result<()> {
        let start = self.marked.near[w as usize];
        let mut corner = start;
        loop {
            self.enqueue_if_bad(triangle(corner))?;
            for e in [corner, next(corner)] {
                self.enqueue_if_encroached(e)?;
                let o = self.marked.patch().opposite(e);
                self.enqueue_if_encroached(o)?;
            }
            corner = turn(&self.marked.patch(), corner);
            if corner == start {
                return Ok(());
            }
        }
    }

    /// Improves a bad triangle, or splits the subsegments that block that.
    fn improve(&mut self, t: u32) -> Result<()> {
        let points = self.points_of(t);
        let cap = self.caps[t as usize];
        let seen = self.shape.see(points);
        let Some(reason) = self.shape.fault(&seen, cap) else {
            return Ok(());
        };
        // Where to put a vertex: by the size alone, at the center if the angle must stay, above two
        // triangles at once if that does not shorten edges, else where it improves this one most.
        let p = if reason == Reason::Size {
            self.places.improve(points, &seen, cap)
        } else if self.is_final(t) || self.is_forced(t, &seen) {
            // A triangle whose angle cannot be improved may still be too large.
            if seen.area2 <= cap {
                return Ok(());
            }
            Places::center(points, &seen)
        } else {
            // If edges already have the wanted size, such a vertex would be too far away.
            let short = APART * seen.shortest < Places::longest2(cap);
            if short
                && let Some(p) = self.above(t, points, &seen)
                && self.fits(t, p, seen.shortest)
            {
                return self.insert(p, reason);
            }
            self.places.improve(points, &seen, cap)
        };
        // What is in the way is split instead; the triangle is queued again if it is still there.
        match self.find_cavity(t, p) {
            Site::Free => self.insert(p, reason),
            Site::Blocked(blockers) => {
                if self.split_blockers(t, &blockers)? || seen.area2 <= cap || self.rules.sizes_yield
                {
                    return Ok(());
                }
                // No blocker can be split, but the size must be met all the same.
                let third = |k: usize| points.iter().map(|p| p[k] / 3.0).sum();
                self.insert_in_spite_of_blockers(t, [third(0), third(1)])
            }
            Site::Lost => Ok(()),
        }
    }

    /// Inserts a vertex in triangle `t` even if it encroaches.
    fn insert_in_spite_of_blockers(&mut self, t: u32, p: Point2) -> Result<()> {
        match walk(&mut self.marked, t, p) {
            Walk::Home(home) if self.cavity.find(&mut self.marked, home, p).is_none() => {
                self.insert(p, Reason::Size)
            }
            _ => Ok(()),
        }
    }

    /// A position that improves both skinny triangle `t` and a skinny neighbor with the same apex
    /// whose shortest edge follows its own; of two positions the one farther away.
    fn above(&mut self, t: u32, points: [Point2; 3], seen: &Seen) -> Option<Point2> {
        let apex = seen.apex;
        let mut best: Option<(Point2, f64)> = None;
        for (ahead, e) in [(true, (apex + 1) % 3), (false, (apex + 2) % 3)] {
            // The neighbor across one of the two long edges, unless that is a subsegment or the hull.
            let (end, middle) = (points[e], points[3 - apex - e]);
            let mesh = self.marked.patch();
            let e = half_edge(t, e as u32);
            let (common, o) = (mesh.corners(t)[apex], mesh.opposite(e));
            if mesh.is_marked(e) || mesh.corners(triangle(o)).contains(&mesh.infinite()) {
                continue;
            }
            let (beside, caps) = (triangle(o), &self.caps);
            let cap = caps[t as usize].min(caps[beside as usize]);
            let corners = mesh.corners(beside);
            let points = self.points_of(beside);
            let other = self.shape.see(points);
            if !other.skinny || corners[other.apex] != common {
                continue;
            }
            // Its shortest edge follows ours at `middle`: one vertex may serve both.
            let far = points[(o & 3) as usize];
            let [first, last] = if ahead { [far, end] } else { [end, far] };
            let bend = Bend {
                middle,
                first,
                last,
            };
            let found = self.places.above(bend, cap);
            best = found.filter(|f| best.is_none_or(|b| f.1 > b.1)).or(best);
        }
        best.map(|(p, _)| p)
    }

    /// Whether a vertex at `p` is blocked by nothing and not near any other; if so, its cavity is
    /// ready.
    fn fits(&mut self, t: u32, p: Point2, shortest: f64) -> bool {
        if !matches!(self.find_cavity(t, p), Site::Free) {
            return false;
        }
        let triangles = self.marked.triangles();
        let (mesh, points) = (self.marked.mesh.resume(triangles), &self.marked.points);
        self.cavity.rim.iter().all(|&e| {
            let w = minus(p, points[mesh.vertex(next(e)) as usize]);
            dot(w, w) > APART * shortest
        })
    }

    /// Finds the cavity of a vertex at `p`, which is near triangle `t`.
    fn find_cavity(&mut self, t: u32, p: Point2) -> Site {
        if !(p[0].is_finite() && p[1].is_finite()) {
            return Site::Lost;
        }
        // The triangle that contains p, if no subsegment hides it; then all whose circles contain it.
        let home = match walk(&mut self.marked, t, p) {
            Walk::Home(home) => home,
            Walk::Blocked(e) => return Site::Blocked(vec![e]),
            Walk::Lost => return Site::Lost,
        };
        if let Some(e) = self.cavity.find(&mut self.marked, home, p) {
            return Site::Blocked(vec![e]);
        }
        let triangles = self.marked.triangles();
        let (mesh, points) = (self.marked.mesh.resume(triangles), &self.marked.points);
        let encroached = |e: &Code| {
            mesh.is_marked(*e) && {
                let [u, v] = [next(*e), prev(*e)].map(|c| points[mesh.vertex(c) as usize]);
                self.shape.in_lens(u, v, p)
            }
        };
        // Only subsegments on the rim can be encroached: all others are hidden by these.
        let rim = self.cavity.rim.iter().copied();
        let blockers: Vec<Code> = rim.filter(encroached).collect();
        if blockers.is_empty() {
            Site::Free
        } else {
            Site::Blocked(blockers)
        }
    }

    /// Fills the cavity that was found.
    fn insert(&mut self, p: Point2, reason: Reason) -> Result<()> {
        self.grow()?;
        self.cavity.fill(&mut self.marked, p, &mut self.caps);
        self.marked
            .near
            .push(half_edge(self.cavity.triangles[0], 0));
        self.on.push(-1);
        match reason {
            Reason::Angle => self.counts.angle += 1,
            Reason::Size => self.counts.size += 1,
        }
        for i in 0..self.cavity.triangles.len() {
            self.enqueue_if_bad(self.cavity.triangles[i])?;
        }
        Ok(())
    }

    /// Splits subsegments that block a vertex for triangle `t`, which is then queued again if it is bad; false
    /// if none of them can be split.
    fn split_blockers(&mut self, t: u32, blockers: &[Code]) -> Result<bool> {
        let corners = self.marked.patch().corners(t);
        let mesh = self.marked.patch();
        let queued: Vec<Queued> = blockers
            .iter()
            .filter(|&&edge| mesh.is_marked(edge))
            .map(|&edge| Queued {
                edge,
                ends: [next(edge), prev(edge)].map(|c| mesh.vertex(c)),
            })
            .collect();
        let mut any_split = false;
        for w in queued {
            // An earlier split may have flipped triangles here, but another subsegment changes only
            // if the split encroaches upon it.
            if self.still_exists(&w) {
                any_split |= self.split(w.edge)?;
            }
        }
        if any_split && self.marked.patch().corners(t) == corners {
            self.enqueue_if_bad(t)?;
        }
        Ok(any_split)
    }

    fn is_final(&mut self, t: u32) -> bool {
        let label = self.marked.patch().label(t);
        self.needles.rest(label)
    }

    /// Whether the smallest angle of a triangle is forced by the input: it lies between two
    /// subsegments, or its shortest edge joins two that meet in a corner of less than 60 degrees,
    /// at points on one circle around it.
    pub(super) fn is_forced(&mut self, t: u32, seen: &Seen) -> bool {
        let mesh = self.marked.patch();
        let apex = half_edge(t, seen.apex as u32);
        if mesh.is_marked(next(apex)) && mesh.is_marked(prev(apex)) {
            return true;
        }
        // The shortest edge joins two lines that meet in a corner.
        let [u, v] = [next(apex), prev(apex)].map(|c| mesh.vertex(c));
        let [s, r] = [u, v].map(|v| self.on[v as usize]);
        if s < 0 || r < 0 || s == r {
            return false;
        }
        let [s, r] = [s, r].map(|i| self.ends[i as usize]);
        let Some(corner) = s.into_iter().find(|v| r.contains(v)) else {
            return false;
        };
        let c = self.at(corner);
        let [d, e] = [u, v].map(|v| distance(self.at(v), c));
        // From 60 degrees on, the edge between the two is as long as their pieces, and splitting
        // these because of it terminates.
        let sharp = distance(self.at(u), self.at(v)) < d.min(e);
        sharp && (d - e).abs() <= SAME_SHELL * d.max(e)
    }
}
