//! The loop of the refinement: encroached subsegments first, then the bad triangle with the shortest
//! edge. A vertex that is to mend a triangle but lies beyond a subsegment or in the lens of one is
//! not inserted; the subsegment is split instead.
//!
//! With angles up to about 26 degrees, and no sharp corner, each new edge is as long as a fixed part
//! of what is there already, so it ends; with sharp corners the circles about them and the rule for
//! triangles that span them do the same. Beyond that, up to some 34 degrees, it ends in practice, and
//! a limit on vertices ends it in any case.

use std::collections::HashMap;
use std::iter::once;

use delone_predicates::{Point2, Sign, orient2d};

use super::corners::{self, SHARP};
use super::insert::{Cavity, Walk, walk};
use super::needles::Needles;
use super::place::{Bend, Places};
use super::queue::{Bad, Queue};
use super::shape::{Reason, Seen, Shape, angle, dot, minus};
use super::task::{Counts, Task, Tell};
use crate::constrained::conforming::cut;
use crate::constrained::marked::{Marked, turn};
use crate::error::Result;
use crate::memory::{copied, make_room, push, with_room};
use crate::mesh2::{Code, next, prev, triangle};
use crate::watch::Watch;

/// Vertices between two looks at the watch.
const WATCH_EVERY: usize = 1 << 12;

/// Radii about a corner are one if they differ by less.
const SAME_SHELL: f64 = 1e-3;

/// A vertex that mends two triangles is farther from all others than the root of this times the
/// shortest edge of the first: above 1, so that edges do not become shorter and shorter.
const APART: f64 = 1.3;

fn distance(a: Point2, b: Point2) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A subsegment as it was when it was put aside.
#[derive(Debug, Clone, Copy)]
struct Waiting {
    edge: Code,
    ends: [u32; 2],
}

/// What stands where a vertex is to go.
#[derive(Debug)]
enum Dug {
    /// Nothing: the cavity is ready.
    Free,
    /// Subsegments that hide it, or upon which it encroaches.
    Walled(Vec<Code>),
    /// A vertex; or there is no such place.
    Lost,
}

/// How a vertex splits a subsegment.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// On the edge, as far as its two triangles can tell.
    On,
    /// In the triangle of this side: it is rounded, and the one beyond is too thin to reach it.
    Beside(Code),
}

/// The points next to `x` in the grid of doubles.
fn neighbours(x: Point2) -> impl Iterator<Item = Point2> {
    let [xs, ys] = x.map(|c| [c, c.next_down(), c.next_up()]);
    let all = xs.into_iter().flat_map(move |x| ys.map(|y| [x, y]));
    all.skip(1)
}

/// The state.
pub struct Work<'a> {
    pub marked: Marked,
    /// Twice the largest area of each triangle.
    caps: Vec<f64>,
    /// For each vertex the line that it was put on, or -1.
    pub on: Vec<i32>,
    pub counts: Counts,
    pub(super) task: Task<'a>,
    /// The lines as vertices, and behind them the fences.
    pub(super) ends: Vec<[u32; 2]>,
    /// The line between two vertices of the input.
    between: HashMap<[u32; 2], i32>,
    pub(super) sharp: Vec<bool>,
    pub(super) shape: Shape,
    pub needles: Needles,
    places: Places,
    queue: Queue,
    encroached: Vec<Waiting>,
    cavity: Cavity,
    /// Vertices of the input.
    pub(super) own: usize,
}

impl<'a> Work<'a> {
    pub fn new(
        marked: Marked,
        caps: Vec<f64>,
        on: Vec<i32>,
        [pieces, ends]: [&'a [[u32; 2]]; 2],
        task: Task<'a>,
    ) -> Result<Self> {
        let own = marked.count;
        let key = |&[u, v]: &[u32; 2]| [u.min(v), u.max(v)];
        let line = |i: usize| task.lines.map_or(i as i32, |lines| lines.of[i]);
        Ok(Self {
            caps,
            on,
            counts: Counts::default(),
            task,
            needles: Needles::of(ends.len()),
            ends: copied(ends)?,
            between: (pieces.iter().enumerate())
                .map(|(i, e)| (key(e), line(i)))
                .collect(),
            sharp: corners::sharp(&marked.points, pieces, own, SHARP)?,
            shape: Shape::new(task.min_angle, task.circles),
            places: Places::new(task.min_angle),
            queue: Queue::default(),
            encroached: with_room(64)?,
            cavity: Cavity::default(),
            own,
            marked,
        })
    }

    /// Works until nothing is bad, first outside of needles, then in those that the budget allows;
    /// false where the limit on vertices came first.
    pub fn run(&mut self, watch: &Watch, tell: Tell) -> Result<bool> {
        self.fence()?;
        let mut done = self.refine(watch, tell)?;
        if done && self.open_allowed()? {
            done = self.refine(watch, tell)?;
        }
        self.open_all()?;
        Ok(done)
    }

    /// Works until nothing is bad outside of needles.
    fn refine(&mut self, watch: &Watch, tell: Tell) -> Result<bool> {
        for t in 0..self.marked.triangles() {
            self.judge(t)?;
            for e in 8 * t..8 * t + 3 {
                self.look(e)?;
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
            if self.marked.count - self.own >= self.task.max_vertices {
                return Ok(false);
            }
            if let Some(waiting) = self.encroached.pop() {
                if self.stands(&waiting) && self.is_encroached(waiting.edge) {
                    self.count(triangle(waiting.edge));
                    let o = self.marked.patch().opposite(waiting.edge);
                    self.count(triangle(o));
                    self.split(waiting.edge)?;
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

    /// The line that an edge between two vertices is a part of, or -1.
    pub fn segment_of(&self, [u, v]: [u32; 2]) -> i32 {
        if let Some(fence) = self.needles.fence([u, v]) {
            return fence;
        }
        // One that was put on a segment is on no other.
        let on = self.on[u as usize].max(self.on[v as usize]);
        if on >= 0 {
            return on;
        }
        let key = [u.min(v), u.max(v)];
        self.between.get(&key).copied().unwrap_or(-1)
    }

    /// Puts a triangle in the queue if it is bad.
    fn judge(&mut self, t: u32) -> Result<()> {
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

    /// Puts the edge `e` aside if it is a subsegment upon which its apex encroaches.
    fn look(&mut self, e: Code) -> Result<()> {
        let mesh = self.marked.patch();
        if mesh.is_marked(e) && self.encroaches(e) {
            let mesh = self.marked.patch();
            let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
            push(&mut self.encroached, Waiting { edge: e, ends })?;
        }
        Ok(())
    }

    /// Room for a vertex more.
    fn grow(&mut self) -> Result<()> {
        self.marked.grow()?;
        make_room(&mut self.marked.near, 1)?;
        make_room(&mut self.on, 1)?;
        make_room(&mut self.caps, 2)
    }

    /// Whether the apex of `e`, in a triangle inside, lies in the lens of e.
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

    /// Whether an edge is still what it was.
    fn stands(&mut self, waiting: &Waiting) -> bool {
        let (mesh, e) = (self.marked.patch(), waiting.edge);
        mesh.is_marked(e) && [next(e), prev(e)].map(|c| mesh.vertex(c)) == waiting.ends
    }

    /// Splits the subsegment `e`; false where it may not or cannot be.
    fn split(&mut self, e: Code) -> Result<bool> {
        let mesh = self.marked.patch();
        let [u, v] = [next(e), prev(e)].map(|c| mesh.vertex(c));
        let segment = self.segment_of([u, v]);
        let fence = self.needles.is_fence(segment);
        if segment >= 0 && !fence && self.task.frozen[segment as usize] {
            return Ok(false);
        }
        let x = self.cut_of(u, v);
        let around = once(x).chain(neighbours(x));
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
            Place::On => self.part(e, w),
            Place::Beside(e) => self.part_beside(e, w),
        }
        self.marked.near[w as usize] = self.marked.stack[0];
        self.on.push(segment);
        self.settle()?;
        if fence {
            self.needles.part([u, v], w);
            self.counts.angle += 1;
        } else {
            self.counts.segment += 1;
        }
        self.greet(w)?;
        Ok(true)
    }

    /// Where `x`, which may be rounded, can split the subsegment `e`.
    fn place(&mut self, e: Code, x: Point2) -> Option<Place> {
        let mesh = self.marked.patch();
        let o = mesh.opposite(e);
        let inf = mesh.infinite();
        let [u, v, p, q] = [next(e), prev(e), e, o].map(|c| mesh.vertex(c));
        let [a, b] = [u, v].map(|v| self.at(v));
        if x == a || x == b {
            return None;
        }
        let left = |a, b, c| orient2d(a, b, c) == Sign::Positive;
        let holds = |apex: u32, [a, b]: [Point2; 2]| {
            let at = self.at(apex);
            apex == inf || left(a, x, at) && left(x, b, at)
        };
        if holds(p, [a, b]) && holds(q, [b, a]) {
            return Some(Place::On);
        }
        let inside = |apex: u32, [a, b]: [Point2; 2]| {
            let at = self.at(apex);
            apex != inf && left(a, b, x) && left(b, at, x) && left(at, a, x)
        };
        let beside = [(e, p, [a, b], q), (o, q, [b, a], p)].into_iter();
        let mut beside = beside.filter(|&(.., beyond)| beyond != inf);
        let found = beside.find(|&(_, apex, ends, _)| inside(apex, ends));
        found.map(|(e, ..)| Place::Beside(e))
    }

    /// Puts the vertex `w` on the subsegment `e`. What to flip is on the stack: also the edges of
    /// `w` itself, since a place that is rounded may lie outside of the circle of a needle.
    fn part(&mut self, e: Code, w: u32) {
        let mut mesh = self.marked.patch();
        let o = mesh.opposite(e);
        let star = mesh.split_marked_edge(e, w);
        self.marked.count += 1;
        self.marked.near.push(0);
        let spokes = star.map(next);
        let [_, r, _, s] = star.map(triangle);
        self.caps.resize(self.marked.triangles() as usize, 0.0);
        self.caps[r as usize] = self.caps[triangle(e) as usize];
        self.caps[s as usize] = self.caps[triangle(o) as usize];
        self.marked.stack.clear();
        self.marked.stack.extend(star);
        self.marked.stack.extend(spokes);
    }

    /// Leads the subsegment `e` over the vertex `w` in its triangle. The thin triangle that is cut
    /// off belongs to the other side.
    fn part_beside(&mut self, e: Code, w: u32) {
        let mut mesh = self.marked.patch();
        let beyond = triangle(mesh.opposite(e));
        let label = mesh.label(beyond);
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

    fn cut_of(&self, u: u32, v: u32) -> Point2 {
        let corner = |v: u32| (v as usize) < self.own && self.sharp[v as usize];
        let [u, v] = if corner(u) { [u, v] } else { [v, u] };
        cut(self.at(u), self.at(v), corner(u) && !corner(v))
    }

    /// Flips edges until all are Delaunay again, from those on the stack on.
    fn settle(&mut self) -> Result<()> {
        self.marked.legalise()
    }

    /// Looks at all triangles of a new vertex.
    fn greet(&mut self, w: u32) -> Result<()> {
        let start = self.marked.near[w as usize];
        let mut corner = start;
        loop {
            self.judge(triangle(corner))?;
            for e in [corner, next(corner)] {
                self.look(e)?;
                let o = self.marked.patch().opposite(e);
                self.look(o)?;
            }
            corner = turn(&self.marked.patch(), corner);
            if corner == start {
                return Ok(());
            }
        }
    }

    /// Mends a bad triangle, or splits what keeps it from being mended.
    fn improve(&mut self, t: u32) -> Result<()> {
        let points = self.points_of(t);
        let cap = self.caps[t as usize];
        let seen = self.shape.see(points);
        let Some(reason) = self.shape.fault(&seen, cap) else {
            return Ok(());
        };
        let p = if reason == Reason::Size {
            self.places.cure(points, &seen, cap)
        } else if self.is_at_rest(t) || self.is_forced(t, &seen) {
            // One whose angle cannot be mended may still be too large.
            if seen.area2 <= cap {
                return Ok(());
            }
            Places::centre(points, &seen)
        } else {
            // Where edges have their size already, what is apart would be too far.
            let short = APART * seen.shortest < Places::longest2(cap);
            if short
                && let Some(p) = self.above(t, points, &seen)
                && self.fits(t, p, seen.shortest)
            {
                return self.insert(p, reason);
            }
            self.places.cure(points, &seen, cap)
        };
        match self.dig(t, p) {
            Dug::Free => self.insert(p, reason),
            Dug::Walled(walls) => {
                if self.yield_to(t, &walls)? || seen.area2 <= cap || self.task.sizes_yield {
                    return Ok(());
                }
                // No wall gives way: a size is kept all the same.
                let third = |k: usize| points.iter().map(|p| p[k] / 3.0).sum();
                self.insert_beside_walls(t, [third(0), third(1)])
            }
            Dug::Lost => Ok(()),
        }
    }

    /// Inserts a vertex in triangle `t` whether or not it encroaches.
    fn insert_beside_walls(&mut self, t: u32, p: Point2) -> Result<()> {
        match walk(&mut self.marked, t, p) {
            Walk::Home(home) if self.cavity.dig(&mut self.marked, home, p).is_none() => {
                self.insert(p, Reason::Size)
            }
            _ => Ok(()),
        }
    }

    /// A place that mends thin triangle `t` and a thin neighbour with the same apex, whose shortest
    /// edges follow each other, at once; of two the one farther away.
    fn above(&mut self, t: u32, points: [Point2; 3], seen: &Seen) -> Option<Point2> {
        let apex = seen.apex;
        let mut best: Option<(Point2, f64)> = None;
        for (ahead, e) in [(true, (apex + 1) % 3), (false, (apex + 2) % 3)] {
            let (end, middle) = (points[e], points[3 - apex - e]);
            let mesh = self.marked.patch();
            let e = 8 * t + e as u32;
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

    /// Whether a vertex at `p` is free of walls and not near to any other; its cavity is dug.
    fn fits(&mut self, t: u32, p: Point2, shortest: f64) -> bool {
        if !matches!(self.dig(t, p), Dug::Free) {
            return false;
        }
        let triangles = self.marked.triangles();
        let (mesh, points) = (self.marked.mesh.resume(triangles), &self.marked.points);
        self.cavity.rim.iter().all(|&e| {
            let w = minus(p, points[mesh.vertex(next(e)) as usize]);
            dot(w, w) > APART * shortest
        })
    }

    /// Digs the cavity of a vertex at `p`, which triangle `t` is near.
    fn dig(&mut self, t: u32, p: Point2) -> Dug {
        if !(p[0].is_finite() && p[1].is_finite()) {
            return Dug::Lost;
        }
        let home = match walk(&mut self.marked, t, p) {
            Walk::Home(home) => home,
            Walk::Blocked(e) => return Dug::Walled(vec![e]),
            Walk::Lost => return Dug::Lost,
        };
        if let Some(e) = self.cavity.dig(&mut self.marked, home, p) {
            return Dug::Walled(vec![e]);
        }
        let triangles = self.marked.triangles();
        let (mesh, points) = (self.marked.mesh.resume(triangles), &self.marked.points);
        let encroached = |e: &Code| {
            mesh.is_marked(*e) && {
                let [u, v] = [next(*e), prev(*e)].map(|c| points[mesh.vertex(c) as usize]);
                self.shape.in_lens(u, v, p)
            }
        };
        let rim = self.cavity.rim.iter().copied();
        let walls: Vec<Code> = rim.filter(encroached).collect();
        if walls.is_empty() {
            Dug::Free
        } else {
            Dug::Walled(walls)
        }
    }

    /// Fills the cavity that was dug.
    fn insert(&mut self, p: Point2, reason: Reason) -> Result<()> {
        self.grow()?;
        self.cavity.fill(&mut self.marked, p, &mut self.caps);
        self.marked.near.push(8 * self.cavity.triangles[0]);
        self.on.push(-1);
        match reason {
            Reason::Angle => self.counts.angle += 1,
            Reason::Size => self.counts.size += 1,
        }
        for i in 0..self.cavity.triangles.len() {
            self.judge(self.cavity.triangles[i])?;
        }
        Ok(())
    }

    /// Splits subsegments that keep a vertex from mending triangle `t`, which is judged again; false
    /// where none of them can be split.
    fn yield_to(&mut self, t: u32, walls: &[Code]) -> Result<bool> {
        let corners = self.marked.patch().corners(t);
        let mesh = self.marked.patch();
        let waiting: Vec<Waiting> = walls
            .iter()
            .filter(|&&edge| mesh.is_marked(edge))
            .map(|&edge| Waiting {
                edge,
                ends: [next(edge), prev(edge)].map(|c| mesh.vertex(c)),
            })
            .collect();
        let mut parted = false;
        for w in waiting {
            // A split before may have flipped triangles round, but it moves no other subsegment
            // unless it encroaches upon it.
            if self.stands(&w) {
                parted |= self.split(w.edge)?;
            }
        }
        if parted && self.marked.patch().corners(t) == corners {
            self.judge(t)?;
        }
        Ok(parted)
    }

    fn is_at_rest(&mut self, t: u32) -> bool {
        let label = self.marked.patch().label(t);
        self.needles.rest(label)
    }

    /// Whether the smallest angle of a triangle is forced by the input: it lies between two
    /// subsegments, or its shortest edge joins two that meet in a corner of less than 60 degrees, on
    /// one circle about it.
    pub(super) fn is_forced(&mut self, t: u32, seen: &Seen) -> bool {
        let mesh = self.marked.patch();
        let apex = 8 * t + seen.apex as u32;
        if mesh.is_marked(next(apex)) && mesh.is_marked(prev(apex)) {
            return true;
        }
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
        // From 60 degrees on, the edge between the two is as long as their pieces, and cutting these
        // for its sake comes to an end.
        let sharp = distance(self.at(u), self.at(v)) < d.min(e);
        sharp && (d - e).abs() <= SAME_SHELL * d.max(e)
    }
}
