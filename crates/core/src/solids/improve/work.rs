//! The passes: removals for each tetrahedron below the bound, worst first; then moves of vertices;
//! and, when these gain little, removed and new vertices.

use delone_predicates::Point3;

use super::edge::{self, Plan, Ring};
use super::insert::{Insertion, Search};
use super::measure::{Bounds, are_positive, bounds, quality};
use super::slide::Slide;
use super::smooth::Star;
use super::store::{FACES, NONE, Store};
use super::task::{Counts, Task, Tell};
use super::{contract, exude, face};
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::Watch;

/// Tetrahedra or vertices between two checks for interruption.
const WATCH_EVERY: usize = 1 << 10;
/// A removal must gain more than this factor.
const GAIN: f64 = 1.0 + 1e-9;
/// A pass that removes a smaller share of the total shortfall from the bound counts as stalled. For
/// flat point sets, such as terrain surveys, half of the tetrahedra stay below the bound, and every
/// pass takes as long as the one before: with a value of 0.01, half of the time went into the last
/// twentieth of the gain.
const STALLED: f64 = 3e-2;
/// This many stalled passes in a row end the work; with new vertices, a single one.
const PATIENCE: usize = 2;
/// The levels below which vertices are inserted, one after the other, as fractions of the bound.
/// With the bound as the only level, on 12 public surfaces of machine parts, most vertices improved
/// tetrahedra just below it, and the median of the smallest angles was 3.9 degrees instead of 6.4.
const LEVELS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
/// There is at most one search for the place of a vertex per this many tetrahedra, but in small
/// meshes up to [`FEWEST`]. Thin parts have no end of bad tetrahedra: without a limit, surfaces of
/// machine parts with 3,000 to 9,000 triangles took minutes, for angles two degrees larger.
const SHARE: usize = 16;
const FEWEST: usize = 1000;
/// A new vertex must gain this factor, or reach the level, because it stays in the mesh.
const WORTH: f64 = 1.3;
/// If an insertion reaches this multiple of the level, the search for a better one ends.
const ENOUGH: f64 = 1.2;
/// The edges of a tetrahedron.
const EDGES: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// The state of an improvement.
pub struct Work<'a> {
    pub store: Store,
    pub counts: Counts,
    /// The weight of each vertex.
    pub weights: Vec<f64>,
    /// For each vertex, how far boundary faces at it may be from the original boundary (see `peel`).
    pub depth: Vec<f64>,
    pub(super) task: Task<'a>,
    /// Whether each vertex may be removed, and whether any may.
    removable: Vec<bool>,
    removes: bool,
    /// The quality below which a tetrahedron is improved.
    pub(super) bound: f64,
    ring: Ring,
    star: Star,
    search: Search,
    /// How many more places for vertices may be searched for.
    searches: usize,
    made: Vec<u32>,
    /// The tetrahedra around a vertex.
    pub(super) around: Vec<u32>,
    /// The number of the latest attempt: what has not changed since its last attempt is not tried
    /// again.
    pub(super) clock: u64,
    /// For each vertex, when a tetrahedron at it last changed, and when a move was last tried.
    pub(super) touched: Vec<u64>,
    moved: Vec<u64>,
    /// For each vertex, when its removal was last tried.
    contracted: Vec<u64>,
    /// For each tetrahedron, when its removal and an insertion were last tried.
    tried: Vec<u64>,
    entered: Vec<u64>,
}

/// The measure of progress: how many are below the bound, and by how much in total.
type Standing = (usize, f64);

impl<'a> Work<'a> {
    /// Measures all tetrahedra; `rows` has the row of each vertex.
    pub fn new(mut store: Store, task: Task<'a>, rows: &[u32]) -> Result<Self> {
        for t in 0..store.corners.len() {
            store.quality[t] = quality(store.places_of(store.corners[t]));
        }
        let (n, m) = (store.points.len(), store.corners.len());
        let mut removable = filled(n, false)?;
        for (may, &row) in removable.iter_mut().zip(rows) {
            *may = task.removable.get(row as usize).copied().unwrap_or(false);
        }
        Ok(Self {
            removes: removable.contains(&true),
            removable,
            contracted: filled(n, 0)?,
            clock: 1,
            weights: filled(n, 0.0)?,
            depth: filled(if task.tolerance > 0.0 { n } else { 0 }, 0.0)?,
            touched: filled(n, 1)?,
            moved: filled(n, 0)?,
            tried: filled(m, 0)?,
            entered: filled(m, 0)?,
            store,
            counts: Counts::default(),
            bound: task.min_angle.to_radians().sin(),
            task,
            ring: Ring::default(),
            star: Star::default(),
            search: Search::default(),
            searches: (m / SHARE).max(FEWEST),
            made: Vec::new(),
            around: Vec::new(),
        })
    }

    /// Runs passes until all are above the bound (true), nothing more is gained (true), or the
    /// limit is reached (false).
    pub fn run(&mut self, watch: &Watch, tell: Tell) -> Result<bool> {
        if self.task.exude {
            self.weigh_all(watch)?;
        }
        // The number of vertices does not change at first, as long as that improves the mesh. Then
        // vertices are removed and added at the worst tetrahedra, and finally at less bad ones.
        let mut ended = self.run_passes(None, watch, tell)?;
        ended = self.peel_passes(ended, watch, tell)?;
        for level in LEVELS {
            if ended && (self.removes || self.counts.added < self.task.most) {
                ended = self.run_passes(Some(level * self.bound), watch, tell)?;
                ended = self.peel_passes(ended, watch, tell)?;
            }
        }
        Ok(ended)
    }

    /// Removes tetrahedra at the boundary, within the tolerance, and runs passes, until none is left to
    /// remove. When the limit on passes is reached, each round has fewer tetrahedra.
    fn peel_passes(&mut self, mut ended: bool, watch: &Watch, tell: Tell) -> Result<bool> {
        while self.task.tolerance > 0.0 && self.peel_all(watch)? > 0 {
            ended = self.run_passes(None, watch, tell)?;
        }
        Ok(ended)
    }

    /// Runs passes until all are above the level, by default the bound (true), nothing more is
    /// gained (true), or the limit is reached (false). With a level, vertices are removed and inserted
    /// at tetrahedra below it.
    fn run_passes(&mut self, level: Option<f64>, watch: &Watch, tell: Tell) -> Result<bool> {
        let goal = level.unwrap_or(self.bound);
        let patience = if level.is_some() { 1 } else { PATIENCE };
        let mut standing = self.standing(goal);
        let mut stalled = 0;
        while standing.0 > 0 {
            if self.counts.passes == self.task.passes {
                return Ok(false);
            }
            // One pass: vertices, then flips, which need no new positions, then moves.
            let changes = self.changes();
            if let Some(level) = level {
                if self.removes {
                    self.contract_all(level, watch)?;
                }
                self.insert_all(level, watch)?;
            }
            if self.task.flips {
                self.remove_all(watch)?;
            }
            if self.task.smooth {
                self.move_all(watch)?;
            }
            self.counts.passes += 1;
            let now = self.standing(goal);
            tell(self.counts.passes, self.standing(self.bound).0)?;
            // Stop after enough passes that gain little, or one that changes nothing.
            let gained = standing.1 - now.1 > STALLED * standing.1;
            stalled = if gained { 0 } else { stalled + 1 };
            if self.changes() == changes || stalled == patience {
                break;
            }
            standing = now;
        }
        Ok(true)
    }

    /// Whether a tetrahedron has a quality below a level.
    pub(super) fn is_below(&self, t: u32, level: f64) -> bool {
        self.store.is_there(t) && self.store.quality[t as usize] < level
    }

    /// Whether no corner of a tetrahedron has changed since an attempt, which would fail again.
    fn would_fail(&self, t: u32, tried: u64) -> bool {
        let corners = self.store.corners[t as usize];
        corners.iter().all(|&v| self.touched[v as usize] < tried)
    }

    fn changes(&self) -> usize {
        let counts = &self.counts;
        counts.edges + counts.faces + counts.moves + counts.added + counts.removed
    }

    fn standing(&self, goal: f64) -> Standing {
        let all = (0..self.store.places()).filter(|&t| self.store.is_there(t));
        let missing = all.map(|t| goal - self.store.quality[t as usize]);
        missing
            .filter(|&m| m > 0.0)
            .fold((0, 0.0), |(count, sum), m| (count + 1, sum + m))
    }

    /// The tetrahedra below a level, worst first.
    pub(super) fn below(&self, level: f64) -> Result<Vec<u32>> {
        let store = &self.store;
        let all = (0..store.places()).filter(|&t| self.is_below(t, level));
        let mut found: Vec<u32> = with_room(all.clone().count())?;
        found.extend(all);
        found.sort_by(|&t, &u| {
            let [t, u] = [t, u].map(|t| store.quality[t as usize]);
            t.total_cmp(&u)
        });
        Ok(found)
    }

    /// Tries to remove an edge or faces of each tetrahedron below the bound, and of the new ones.
    fn remove_all(&mut self, watch: &Watch) -> Result<()> {
        let mut waiting = self.below(self.bound)?;
        waiting.reverse();
        let mut steps = 0;
        while let Some(t) = waiting.pop() {
            steps += 1;
            if steps % WATCH_EVERY == 0 {
                watch.check()?;
            }
            if !self.is_below(t, self.bound) {
                continue;
            }
            self.clock += 1;
            let tried = std::mem::replace(&mut self.tried[t as usize], self.clock);
            if self.would_fail(t, tried) {
                continue;
            }
            // Its replacements may be below the bound, too.
            if self.remove_at(t)? {
                for &t in self.made.iter().filter(|&&t| self.is_below(t, self.bound)) {
                    push(&mut waiting, t)?;
                }
            }
        }
        Ok(())
    }

    /// Makes the best removal at a tetrahedron, if there is one.
    fn remove_at(&mut self, t: u32) -> Result<bool> {
        let own = self.store.quality[t as usize];
        let mut best = Plan {
            least: own * GAIN,
            ..Plan::default()
        };
        let mut kind = None;
        for (i, j) in EDGES {
            let found = edge::remove(
                &self.store,
                &mut self.ring,
                (t, i, j),
                best.least,
                self.task.turn,
            );
            if let Some(plan) = found {
                (best, kind) = (plan, Some(true));
            }
        }
        for k in 0..4 {
            if let Some(plan) = face::remove(&self.store, (t, k), best.least)
                && plan.least > best.least
            {
                (best, kind) = (plan, Some(false));
            }
        }
        let Some(is_edge) = kind else {
            return Ok(false);
        };
        if !self.carry_out(&best, Bounds::surely_better)? {
            self.counts.refused += 1;
            return Ok(false);
        }
        if is_edge {
            self.counts.edges += 1;
            self.counts.boundary += usize::from(best.turning);
        } else {
            self.counts.faces += 1;
        }
        Ok(true)
    }

    /// Replaces tetrahedra if the new ones are positive, and `good` accepts their bounds, given those of
    /// the old ones.
    pub(super) fn carry_out(
        &mut self,
        plan: &Plan,
        good: impl Fn(Bounds, Bounds) -> bool,
    ) -> Result<bool> {
        let store = &mut self.store;
        let new = || plan.new.iter().map(|&v| store.places_of(v));
        let old = plan.old.iter().map(|&t| store.corners[t as usize]);
        let now = bounds(old.map(|v| store.places_of(v)));
        if !good(bounds(new()), now) || !are_positive(new()) {
            return Ok(false);
        }
        if plan.turning && !self.depth.is_empty() {
            // A corner that old and new walls do not share may be the one with the depth.
            deepen(&mut self.depth, plan.new.as_flattened());
        }
        store.replace(&plan.old, &plan.new, plan.turning, &mut self.made)?;
        self.tried.resize(store.corners.len(), 0);
        self.entered.resize(store.corners.len(), 0);
        for &t in &self.made {
            let t = t as usize;
            store.quality[t] = quality(store.places_of(store.corners[t]));
            (self.tried[t], self.entered[t]) = (0, 0);
            for v in store.corners[t] {
                self.touched[v as usize] = self.clock;
            }
        }
        Ok(true)
    }

    /// Whether a vertex still exists and may be removed.
    pub(super) fn may_vanish(&self, v: u32) -> bool {
        let fixed = self.store.fixed[v as usize];
        self.removable[v as usize] && !fixed && self.store.is_used(v)
    }

    /// Counts a vertex that has been removed.
    pub(super) fn vanished(&mut self, v: u32) {
        self.store.at[v as usize] = NONE;
        self.counts.removed += 1;
    }

    /// Tries to remove vertices of each tetrahedron below a level, worst first.
    fn contract_all(&mut self, level: f64, watch: &Watch) -> Result<()> {
        let mut steps = 0;
        for t in self.below(level)? {
            for k in 0..4 {
                // If the slot was reused, its corners differ.
                if !self.is_below(t, level) {
                    break;
                }
                let v = self.store.corners[t as usize][k];
                if !self.may_vanish(v) || self.touched[v as usize] < self.contracted[v as usize] {
                    continue;
                }
                steps += 1;
                if steps % WATCH_EVERY == 0 {
                    watch.check()?;
                }
                self.clock += 1;
                self.contracted[v as usize] = self.clock;
                self.contract_one(v)?;
            }
        }
        Ok(())
    }

    /// Removes a vertex if the tetrahedra without it are certainly better.
    fn contract_one(&mut self, v: u32) -> Result<()> {
        self.store.star(v, &mut self.around)?;
        let qualities = self.around.iter().map(|&t| self.store.quality[t as usize]);
        let above = GAIN * qualities.fold(f64::INFINITY, f64::min);
        if let Some(plan) = contract::remove(&self.store, v, &self.around, above) {
            if self.carry_out(&plan, Bounds::surely_better)? {
                self.vanished(v);
            } else {
                self.counts.refused += 1;
            }
        }
        Ok(())
    }

    /// Assigns weights to free vertices of tetrahedra below the bound, at most once to each.
    fn weigh_all(&mut self, watch: &Watch) -> Result<()> {
        let mut met = filled(self.store.points.len(), false)?;
        let mut steps = 0;
        for t in self.below(self.bound)? {
            // A slot that was reused now has other corners.
            if !self.is_below(t, self.bound) {
                continue;
            }
            for v in self.store.corners[t as usize] {
                let fixed = self.store.fixed[v as usize];
                if fixed || std::mem::replace(&mut met[v as usize], true) {
                    continue;
                }
                self.weigh_one(v)?;
                steps += 1;
                if steps % WATCH_EVERY == 0 {
                    watch.check()?;
                }
                if !self.is_below(t, self.bound) || self.store.corner(t, v).is_none() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Assigns a vertex a weight if the new tetrahedra are certainly better.
    fn weigh_one(&mut self, v: u32) -> Result<()> {
        self.store.star(v, &mut self.around)?;
        let found = exude::pump(&self.store, &self.weights, v, &self.around, 0.0)?;
        if let Some((plan, weight)) = found {
            if self.carry_out(&plan, Bounds::surely_better)? {
                self.weights[v as usize] = weight;
                self.counts.weights += 1;
            } else {
                self.counts.refused += 1;
            }
        }
        Ok(())
    }

    /// Inserts a vertex near each tetrahedron below a level, worst first, where that gains enough.
    fn insert_all(&mut self, level: f64, watch: &Watch) -> Result<()> {
        for t in self.below(level)? {
            if self.counts.added == self.task.most {
                return Ok(());
            }
            watch.check()?;
            if !self.is_below(t, level) {
                continue;
            }
            self.clock += 1;
            let tried = std::mem::replace(&mut self.entered[t as usize], self.clock);
            if self.would_fail(t, tried) {
                continue;
            }
            let own = self.store.quality[t as usize];
            let above = (WORTH * own).min(level).max(GAIN * own);
            if self.searches == 0 {
                return Ok(());
            }
            self.searches -= 1;
            let insertion = self.search.best(&self.store, t, above, ENOUGH * level)?;
            if let Some(insertion) = insertion {
                self.insert_one(&insertion)?;
            }
        }
        Ok(())
    }

    /// Adds a vertex if the new tetrahedra are certainly better.
    fn insert_one(&mut self, insertion: &Insertion) -> Result<()> {
        self.store.add(insertion.place)?;
        push(&mut self.weights, 0.0)?;
        push(&mut self.touched, self.clock)?;
        push(&mut self.moved, 0)?;
        push(&mut self.contracted, 0)?;
        push(&mut self.removable, false)?;
        if self.carry_out(&insertion.plan, Bounds::surely_better)? {
            self.counts.added += 1;
            return Ok(());
        }
        self.counts.refused += 1;
        self.store.take_back();
        self.weights.pop();
        self.touched.pop();
        self.moved.pop();
        self.contracted.pop();
        self.removable.pop();
        Ok(())
    }

    /// Moves each free vertex of a tetrahedron below the bound, and those that slide.
    fn move_all(&mut self, watch: &Watch) -> Result<()> {
        let mut met = filled(self.store.points.len(), false)?;
        let mut steps = 0;
        for t in self.below(self.bound)? {
            for v in self.store.corners[t as usize] {
                let stays = self.store.fixed[v as usize] && !self.store.slides[v as usize];
                if met[v as usize] || stays {
                    continue;
                }
                met[v as usize] = true;
                if self.touched[v as usize] < self.moved[v as usize] {
                    continue;
                }
                self.clock += 1;
                self.moved[v as usize] = self.clock;
                self.counts.moves += usize::from(self.move_one(v)?);
                steps += 1;
                if steps % WATCH_EVERY == 0 {
                    watch.check()?;
                }
            }
        }
        Ok(())
    }

    /// Moves a vertex if the tetrahedra around it are certainly better afterward.
    fn move_one(&mut self, v: u32) -> Result<bool> {
        let store = &mut self.store;
        let slide = if store.fixed[v as usize] {
            // On both sides of the walls.
            store.whole_star(v, &mut self.around)?;
            let Some(slide) = Slide::of(store, v, &self.around) else {
                return Ok(false);
            };
            Some(slide)
        } else {
            store.star(v, &mut self.around)?;
            None
        };
        self.star.clear();
        for &t in &self.around {
            let corners = store.corners[t as usize];
            let k = (0..4).find(|&k| corners[k] == v).unwrap_or(0);
            let face = FACES[k].map(|i| store.points[corners[i] as usize]);
            self.star.push(face);
        }
        let here = store.points[v as usize];
        let Some((there, _)) = self.star.climb(here, slide.as_ref()) else {
            return Ok(false);
        };
        let there = match &slide {
            Some(slide) => slide.nearest(there),
            None => Some(there),
        };
        let moved = there.is_some_and(|there| self.try_move(v, there, Bounds::surely_better));
        self.counts.refused += usize::from(!moved);
        if moved && slide.is_some() {
            self.counts.slides += 1;
            if !self.depth.is_empty() {
                let corners = self.around.iter().map(|&t| self.store.corners[t as usize]);
                let all: Vec<u32> = corners.flatten().collect();
                deepen(&mut self.depth, &all);
            }
        }
        Ok(moved)
    }

    /// Moves a vertex, whose tetrahedra are `around`, if these stay positive, and `good` accepts their
    /// bounds, given those before.
    pub(super) fn try_move(
        &mut self,
        v: u32,
        there: Point3,
        good: impl Fn(Bounds, Bounds) -> bool,
    ) -> bool {
        let store = &mut self.store;
        let before = star_bounds(store, &self.around);
        let here = std::mem::replace(&mut store.points[v as usize], there);
        let now = star_bounds(store, &self.around);
        let corners = self.around.iter().map(|&t| store.corners[t as usize]);
        if !good(now, before) || !are_positive(corners.map(|v| store.places_of(v))) {
            store.points[v as usize] = here;
            return false;
        }
        for &t in &self.around {
            let t = t as usize;
            store.quality[t] = quality(store.places_of(store.corners[t]));
            for v in store.corners[t] {
                self.touched[v as usize] = self.clock;
            }
        }
        true
    }
}

/// Gives vertices the largest depth among them.
pub(super) fn deepen(depth: &mut [f64], vertices: &[u32]) {
    let of = vertices.iter().filter_map(|&v| depth.get(v as usize));
    let most = of.fold(0.0_f64, |m, &d| m.max(d));
    if most > 0.0 {
        for &v in vertices {
            if let Some(d) = depth.get_mut(v as usize) {
                *d = most;
            }
        }
    }
}

fn star_bounds(store: &Store, star: &[u32]) -> Bounds {
    let all = star.iter().map(|&t| store.corners[t as usize]);
    debug_assert!(all.clone().all(|v| v[0] != NONE));
    bounds(all.map(|v| store.places_of(v)))
}
