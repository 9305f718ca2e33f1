//! Finds needles, isolates them by edges that act as lines (fences), and opens them again; see the head of `needles`.

use std::collections::{BTreeSet, HashMap};

use delone_predicates::Point2;

use super::corners;
use super::gap::Base;
use super::needles::{Fence, key};
use super::shape::{cross, dot, minus};
use super::work::Work;
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::constrained::marked::turn;
use crate::mesh::plane::{Code, half_edge, half_edges, next, prev, triangle};

/// Needles of at least this price are postponed; cheaper ones take little time.
const EXPENSIVE: f64 = 1000.0;

/// The inverse of the fraction of the budget that all needles together may use.
const SHARE: f64 = 64.0;

/// Vertices that a gap needs per degree of the bound, over a length equal to its width: measured as
/// 0.5 at 25 degrees.
const RATE: f64 = 0.02;

/// Steps of work granted to a needle whose sides were split alike at first and may be again: this
/// number, plus more for each of its triangles.
const STEPS: u32 = 64;
const MORE_STEPS: u32 = 4;

/// Angles below this between fences or lines are corners, which are split on circles: from 60
/// degrees on, refinement terminates without that.
const SHARP: f64 = std::f64::consts::FRAC_PI_3;

/// The line number of a fence that is examined before it has a number.
const FENCE: i32 = -1;

/// The result of the search for needles.
#[derive(Debug, Default)]
struct Found {
    triangles: BTreeSet<u32>,
    /// A triangle, the two lines between which it lies, and their price.
    pairs: Vec<(u32, [i32; 2], f64)>,
}

impl Work {
    /// Finds the needles and fences them off.
    pub fn isolate_needles(&mut self) -> Result<()> {
        let kept: BTreeSet<u32> = self.needles.kept.iter().copied().collect();
        let found = self.find()?;
        if found.triangles.is_empty() {
            return Ok(());
        }
        self.needles.first = 1 + self.labels().max().unwrap_or(0);
        let mut needle_of = HashMap::new();
        for &t in &found.triangles {
            if !needle_of.contains_key(&t) {
                let needle = self.needles.labels.len() as u32;
                self.enclose(t, needle, &found.triangles, &mut needle_of)?;
            }
        }
        let kept = kept.iter().map(|t| needle_of[t]).collect();
        self.choose(found.pairs, &needle_of, &kept);
        self.needles.settled = self.settled()?;
        let pieces = self.pieces()?;
        // Most fences end at about a right angle, which must not count as a corner.
        let more = corners::sharp(&self.marked.points, &pieces, self.own, SHARP)?;
        for (sharp, more) in self.sharp.iter_mut().zip(more) {
            *sharp |= more;
        }
        Ok(())
    }

    fn labels(&mut self) -> impl Iterator<Item = u32> {
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        (0..triangles).map(move |t| mesh.label(t))
    }

    /// Marks the triangles connected to triangle `t` as a needle.
    fn enclose(
        &mut self,
        t: u32,
        needle: u32,
        all: &BTreeSet<u32>,
        needle_of: &mut HashMap<u32, u32>,
    ) -> Result<()> {
        let label = self.marked.patch().label(t);
        push(&mut self.needles.labels, label)?;
        let mut stack = vec![t];
        needle_of.insert(t, needle);
        while let Some(t) = stack.pop() {
            let mut mesh = self.marked.patch();
            mesh.set_label(t, self.needles.first + needle);
            for e in half_edges(t) {
                let beyond = triangle(mesh.opposite(e));
                if mesh.is_marked(e) || needle_of.contains_key(&beyond) {
                    continue;
                }
                if all.contains(&beyond) {
                    needle_of.insert(beyond, needle);
                    stack.push(beyond);
                    continue;
                }
                let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
                mesh.mark(e, true);
                let line = self.ends.len() as i32;
                push(&mut self.ends, ends)?;
                self.needles
                    .fences
                    .insert(key(ends), Fence { line, needle });
            }
        }
        Ok(())
    }

    /// Decides which needles the budget allows to be opened: the cheapest ones; needles of equal
    /// price are opened together or not at all. Those with triangles that were not opened in an
    /// earlier round stay closed.
    fn choose(
        &mut self,
        mut pairs: Vec<(u32, [i32; 2], f64)>,
        needle_of: &HashMap<u32, u32>,
        kept: &BTreeSet<u32>,
    ) {
        for pair in &mut pairs {
            pair.0 = needle_of.get(&pair.0).copied().unwrap_or(u32::MAX);
        }
        pairs.sort_by(|p, q| (p.0, p.1).cmp(&(q.0, q.1)).then(q.2.total_cmp(&p.2)));
        pairs.dedup_by_key(|p| (p.0, p.1));
        pairs.sort_by(|p, q| p.0.cmp(&q.0).then(p.2.total_cmp(&q.2)));
        let mut prices = vec![0.0; self.needles.labels.len()];
        for &(needle, _, price) in &pairs {
            if let Some(sum) = prices.get_mut(needle as usize) {
                *sum += price;
            }
        }
        for &needle in kept {
            prices[needle as usize] = f64::INFINITY;
        }
        let mut order: Vec<usize> = (0..prices.len()).collect();
        order.sort_by(|&i, &j| prices[i].total_cmp(&prices[j]));
        let most = self.rules.max_vertices as f64 / SHARE;
        let mut spent = 0.0;
        self.needles.allowed = vec![false; prices.len()];
        for equal in order.chunk_by(|&i, &j| prices[i] == prices[j]) {
            spent += prices[equal[0]] * equal.len() as f64;
            for &needle in equal {
                self.needles.allowed[needle] = spent <= most;
            }
        }
    }

    /// Finds the triangles that are too expensive.
    fn find(&mut self) -> Result<Found> {
        let mut found = Found::default();
        let mut stack = Vec::new();
        // Start from the flat triangles at the lines of the domain.
        for e in (0..self.marked.triangles()).flat_map(half_edges) {
            let mesh = self.marked.patch();
            if mesh.label(triangle(e)) == 0 || !mesh.is_marked(e) {
                continue;
            }
            let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
            let line = self.segment_of(ends);
            if self.may_be_expensive(e, line) {
                push(&mut stack, (e, line))?;
            }
        }
        for t in std::mem::take(&mut self.needles.kept) {
            found.triangles.insert(t);
            let mesh = self.marked.patch();
            for e in half_edges(t).filter(|&e| !mesh.is_marked(e)) {
                push(&mut stack, (mesh.opposite(e), FENCE))?;
            }
        }
        if stack.is_empty() {
            return Ok(found);
        }
        let at = self.lines_at()?;
        // Check each candidate's price; an expensive one makes its neighbors candidates.
        while let Some((e, line)) = stack.pop() {
            let points = self.points_of(triangle(e));
            if !self.may_be_expensive(e, line) || !self.shape.see(points).skinny {
                continue;
            }
            let pairs = self.prices(e, line, &at);
            if pairs.iter().map(|p| p.1).sum::<f64>() < EXPENSIVE {
                continue;
            }
            let t = triangle(e);
            if line != FENCE {
                let pairs = pairs.into_iter();
                let ordered = |(r, price)| (t, [line.min(r), line.max(r)], price);
                found.pairs.extend(pairs.map(ordered));
            }
            if found.triangles.insert(t) {
                let mesh = self.marked.patch();
                for e in half_edges(t) {
                    let o = mesh.opposite(e);
                    if !mesh.is_marked(e) && !found.triangles.contains(&triangle(o)) {
                        push(&mut stack, (o, FENCE))?;
                    }
                }
            }
        }
        Ok(found)
    }

    /// The ends of a line, or of the edge `e` if that is a fence.
    fn base(&mut self, e: Code, line: i32) -> [Point2; 2] {
        let mesh = self.marked.patch();
        let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
        let ends = self.ends.get(line as usize).copied().unwrap_or(ends);
        ends.map(|v| self.at(v))
    }

    /// Whether the triangle of the edge `e` is so flat compared with its line that it may be
    /// expensive. Most are not.
    fn may_be_expensive(&mut self, e: Code, line: i32) -> bool {
        let [p, q, r] = self.points_of(triangle(e));
        let area2 = cross(minus(q, p), minus(r, p));
        let [a, b] = self.base(e, line);
        let (step, edge) = (minus(b, a), self.base(e, FENCE));
        let edge = minus(edge[1], edge[0]);
        // The lines on both sides of a corner face the base, and a few others may.
        let least = EXPENSIVE / (RATE * self.rules.min_angle) / 8.0;
        let (length, height) = (dot(step, step).sqrt(), area2 / dot(edge, edge).sqrt());
        height * least < length
    }

    /// Whether triangle `t` would be refined if it were in no needle.
    fn needs_work(&mut self, t: u32) -> bool {
        let points = self.points_of(t);
        let seen = self.shape.see(points);
        if !seen.skinny {
            return false;
        }
        let flat = |k: usize| {
            let [u, v] = [points[(k + 1) % 3], points[(k + 2) % 3]];
            self.shape.is_flat(u, v, points[k])
        };
        let mesh = self.marked.patch();
        if (0..3).any(|k| mesh.is_marked(half_edge(t, k as u32)) && flat(k)) {
            return true;
        }
        !self.is_forced(t, &seen)
    }

    /// The lines at each vertex that is an end of one.
    fn lines_at(&self) -> Result<Vec<(u32, i32)>> {
        let mut at = Vec::new();
        for (i, ends) in (0..).zip(&self.ends[..self.needles.lines]) {
            for &v in ends {
                push(&mut at, (v, i))?;
            }
        }
        at.sort_unstable();
        Ok(at)
    }

    /// The lines that face the line under `e` near its apex, with their prices.
    fn prices(&mut self, e: Code, line: i32, at: &[(u32, i32)]) -> Vec<(i32, f64)> {
        let apex = self.marked.patch().vertex(e);
        let base = Base::of(self.base(e, line), self.at(apex));
        let first = at.partition_point(|a| a.0 < apex);
        let here = at[first..].iter().take_while(|a| a.0 == apex);
        let mut lines: Vec<_> = here.map(|a| (a.1, base.gap)).collect();
        lines.push((self.on[apex as usize], base.gap));
        let mut corner = e;
        loop {
            let mesh = self.marked.patch();
            if corner != e && mesh.label(triangle(corner)) != 0 && mesh.is_marked(corner) {
                let ends = [next(corner), prev(corner)].map(|c| mesh.vertex(c));
                let line = self.segment_of(ends);
                let points = ends.map(|v| self.at(v));
                lines.push((line, base.gap + Base::of(points, self.at(apex)).gap));
            }
            corner = turn(&self.marked.patch(), corner);
            if corner == e {
                break;
            }
        }
        let rate = RATE * self.rules.min_angle;
        let mut pairs = Vec::new();
        for (r, gap) in lines {
            let known = |p: &(i32, f64)| p.0 == r;
            if r >= 0 && r != line && !pairs.iter().any(known) {
                let ends = self.ends[r as usize].map(|v| self.at(v));
                pairs.push((r, rate * base.facing(ends, gap) / gap));
            }
        }
        pairs.sort_by(|p, q| p.1.total_cmp(&q.1));
        pairs
    }

    /// Opens the needles that the budget allows, and grants more work to those that needed none at
    /// first; returns whether there are any.
    pub fn open_allowed(&mut self) -> Result<bool> {
        let allowed = self.needles.allowed.clone();
        let mut steps = filled(allowed.len(), STEPS)?;
        let first = self.needles.first;
        for label in self.labels().filter(|&label| label >= first) {
            steps[(label - first) as usize] += MORE_STEPS;
        }
        for (steps, settled) in steps.iter_mut().zip(&self.needles.settled) {
            *steps *= u32::from(*settled);
        }
        self.needles.steps = steps;
        if allowed.contains(&true) {
            self.open(|needle| allowed[needle as usize])?;
        }
        Ok(!allowed.is_empty())
    }

    /// Counts a step of work in the needle of triangle `t`, if it is in one.
    pub fn count(&mut self, t: u32) {
        let label = self.marked.patch().label(t);
        if label >= self.needles.first {
            let needle = (label - self.needles.first) as usize;
            if let Some(steps) = self.needles.steps.get_mut(needle) {
                *steps = steps.saturating_sub(1);
            }
        }
    }

    /// For each needle, whether all work in it is done.
    fn settled(&mut self) -> Result<Vec<bool>> {
        let mut settled = filled(self.needles.labels.len(), true)?;
        for t in 0..self.marked.triangles() {
            let label = self.marked.patch().label(t);
            if label >= self.needles.first {
                settled[(label - self.needles.first) as usize] &= !self.needs_work(t);
            }
        }
        Ok(settled)
    }

    /// Removes all fences, and records which triangles are left in a needle.
    pub fn open_all(&mut self) -> Result<()> {
        if self.needles.first == u32::MAX {
            return Ok(());
        }
        let first = self.needles.first;
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        for t in (0..triangles).filter(|&t| mesh.label(t) >= first) {
            push(&mut self.needles.kept, t)?;
        }
        let mut left = filled(self.marked.triangles() as usize, -1)?;
        let settled = self.settled()?;
        for (left, label) in left.iter_mut().zip(self.labels()) {
            if label >= first && !settled[(label - first) as usize] {
                *left = (label - first) as i32;
            }
        }
        self.needles.left = left;
        self.open(|_| true)
    }

    fn open(&mut self, which: impl Fn(u32) -> bool) -> Result<()> {
        self.marked.stack.clear();
        for t in 0..self.marked.triangles() {
            let mut mesh = self.marked.patch();
            let label = mesh.label(t);
            if label >= self.needles.first && which(label - self.needles.first) {
                mesh.set_label(
                    t,
                    self.needles.labels[(label - self.needles.first) as usize],
                );
            }
            for e in half_edges(t) {
                let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
                let fence = self.needles.fences.get(&key(ends));
                if mesh.is_marked(e) && fence.is_some_and(|fence| which(fence.needle)) {
                    mesh.mark(e, false);
                    push(&mut self.marked.stack, e)?;
                    mesh = self.marked.patch();
                }
            }
        }
        self.needles.fences.retain(|_, fence| !which(fence.needle));
        let lines = self.needles.lines as i32;
        let kept: BTreeSet<i32> = self.needles.fences.values().map(|f| f.line).collect();
        for on in &mut self.on {
            if *on >= lines && !kept.contains(on) {
                *on = -1;
            }
        }
        self.marked.legalize()
    }
}
