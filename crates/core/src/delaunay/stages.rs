//! What a triangulation returns, and the times of its stages.

use std::time::{Duration, Instant};

use crate::base::arrays::Arrays;
use crate::base::watch::now;

/// The name of a stage and the time it took.
pub type Stage = (&'static str, Duration);

/// Simplices in the rows of the input.
#[derive(Debug)]
pub struct Triangulated<const N: usize> {
    /// Simplices and their neighbors.
    pub arrays: Arrays<N>,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// The times of the stages.
    pub stages: Vec<Stage>,
}

/// Times the stages one after the other.
#[derive(Debug)]
pub struct Clock {
    /// None where the platform has no clock.
    last: Option<Instant>,
    /// The stages so far.
    pub stages: Vec<Stage>,
}

impl Clock {
    /// A clock that starts now.
    pub fn start() -> Self {
        Self {
            last: now(),
            stages: Vec::with_capacity(8),
        }
    }

    /// Ends the stage `name`.
    pub fn lap(&mut self, name: &'static str) {
        let now = now();
        let before = std::mem::replace(&mut self.last, now);
        let took = now.zip(before).map_or(Duration::ZERO, |(n, b)| n - b);
        self.stages.push((name, took));
    }
}
