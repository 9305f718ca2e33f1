//! The circle events in a binary heap, ordered by the right ends of the circles.
//!
//! Each arc has the slot of its circle, so obsolete circles are removed at once and the heap is
//! no longer than the front.

use delone_predicates::sweep::{CircleEnd, circle_end_abscissa, circle_ends};
use delone_predicates::{Point2, Sign, orient2d};

use super::beach::{Beach, NONE};

/// The circle of an arc and its two neighbors.
#[derive(Debug, Clone, Copy)]
struct Event {
    end: CircleEnd,
    arc: u32,
}

/// The heap.
#[derive(Debug, Default)]
pub struct Events {
    heap: Vec<Event>,
}

/// Whether one circle ends before another, exactly.
fn before(beach: &Beach, s: &Event, t: &Event) -> bool {
    let sign = s.end.minus(&t.end).unwrap_or_else(|| {
        match (beach.triple(s.arc), beach.triple(t.arc)) {
            (Some(s), Some(t)) => circle_ends(s, t),
            // Only arcs with two neighbors have circles.
            _ => Sign::Zero,
        }
    });
    sign == Sign::Negative
}

/// Whether three points of the front turn right: then their middle arc shrinks.
fn shrinks([a, b, c]: [Point2; 3]) -> bool {
    orient2d(a, b, c) == Sign::Negative
}

impl Events {
    /// The arc of the first circle, if it ends at `x` or before.
    pub fn first_until(&self, beach: &Beach, x: Option<f64>) -> Option<u32> {
        let first = self.heap.first()?;
        let Some(x) = x else { return Some(first.arc) };
        let sign = first.end.minus_abscissa(x).or_else(|| {
            let triple = beach.triple(first.arc)?;
            Some(circle_end_abscissa(triple, x))
        });
        (sign != Some(Sign::Positive)).then_some(first.arc)
    }

    /// Adds the circle of `arc`, which has none in the heap, if the arc shrinks.
    pub fn renew(&mut self, beach: &mut Beach, arc: u32) {
        let Some(triple) = beach.triple(arc) else {
            return;
        };
        if shrinks(triple) {
            let end = CircleEnd::of(triple);
            self.heap.push(Event { end, arc });
            self.rise(beach, self.heap.len() - 1);
        }
    }

    /// Removes the circle of `arc`, if it has one. The neighbors of the arc must be those with
    /// which it was added.
    pub fn remove(&mut self, beach: &mut Beach, arc: u32) {
        let slot = std::mem::replace(&mut beach.arcs[arc as usize].slot, NONE);
        if slot == NONE {
            return;
        }
        let slot = slot as usize;
        self.heap.swap_remove(slot);
        if slot < self.heap.len() {
            self.rise(beach, slot);
            self.sink(beach, slot);
        }
    }

    /// Moves the event at `slot` up to its place: at most one step per level.
    fn rise(&mut self, beach: &mut Beach, mut slot: usize) {
        let event = self.heap[slot];
        while slot > 0 && before(beach, &event, &self.heap[(slot - 1) / 2]) {
            self.put(beach, slot, self.heap[(slot - 1) / 2]);
            slot = (slot - 1) / 2;
        }
        self.put(beach, slot, event);
    }

    /// Moves the event at `slot` down to its place: at most one step per level.
    fn sink(&mut self, beach: &mut Beach, mut slot: usize) {
        let event = self.heap[slot];
        loop {
            let mut child = 2 * slot + 1;
            if child >= self.heap.len() {
                break;
            }
            if child + 1 < self.heap.len()
                && before(beach, &self.heap[child + 1], &self.heap[child])
            {
                child += 1;
            }
            if !before(beach, &self.heap[child], &event) {
                break;
            }
            self.put(beach, slot, self.heap[child]);
            slot = child;
        }
        self.put(beach, slot, event);
    }

    fn put(&mut self, beach: &mut Beach, slot: usize, event: Event) {
        self.heap[slot] = event;
        beach.arcs[event.arc as usize].slot = slot as u32;
    }
}
