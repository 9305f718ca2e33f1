//! A position from which all surrounding faces are visible: near the center of the kernel, in
//! doubles if any fit.

use std::collections::BTreeSet;

use delone_predicates::Point3;

use super::center::{Plane, center};
use super::coordinates::{LIFT, POWER, SHORT, Step, Wide, cross};
use super::suppress::unit;
use super::work::{Origin, Work};
use crate::base::error::Result;

/// The most halvings of a step.
const HALVINGS: i32 = 1100;

/// After a wide point is found, this many more halvings look for a double, in each direction.
const FURTHER: i32 = 12;

/// How many doubles are tried for a point on the way to the center of its kernel.
#[derive(Debug, Clone, Copy)]
pub enum Near {
    /// The nearest one at a few places.
    One,
    /// Those next to it as well, at more places.
    Many,
}

impl Near {
    /// The parts of the way from the point.
    fn parts(self) -> &'static [f64] {
        match self {
            Self::One => &[1.0, 0.5, 0.25, 0.125, 0.0],
            Self::Many => &[
                1.0, 0.9375, 0.875, 0.8125, 0.75, 0.6875, 0.625, 0.5625, 0.5, 0.4375, 0.375,
                0.3125, 0.25, 0.1875, 0.125, 0.0625, 0.0,
            ],
        }
    }

    /// The number of doubles at each place.
    fn count(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Many => 27,
        }
    }
}

/// A double, the next one up, or the next one down.
fn next(x: f64, step: u8) -> f64 {
    match step {
        0 => x,
        1 => x.next_up(),
        _ => x.next_down(),
    }
}

impl Work<'_> {
    /// A new free point that sees all faces, looked for from the point `s`, which sees those that do
    /// not contain it in their planes.
    pub fn point_in(
        &mut self,
        s: u32,
        faces: &[[u32; 3]],
        directions: [Point3; 2],
    ) -> Result<Option<u32>> {
        let start = self.mesh.points.exact(s);
        let v = self.add(start.clone(), Origin::Free)?;
        let (size, lift, vertices) = self.size(s, faces);
        if let Some(step) = self.step_to_center(s, faces, &vertices, size, lift)
            && self.try_at(v, s, faces, step)
        {
            return Ok(Some(v));
        }
        let [inward, along] = directions;
        let back = along.map(|x| -x);
        let mut wide = None;
        let mut most = HALVINGS;
        for direction in [inward, along, back].map(unit) {
            if direction == [0.0; 3] {
                continue;
            }
            let mut tried = 0;
            let (mut length, mut lift) = (size, lift);
            // Halve the step until a double sees all faces. Remember the first wide point that does.
            while tried < most {
                tried += 1;
                length /= 2.0;
                if length < SHORT {
                    (length, lift) = (length * POWER, lift + LIFT);
                }
                let at = direction.map(|x| x * length);
                let step = Step { at, lift };
                if self.try_double(v, s, faces, step) {
                    return Ok(Some(v));
                }
                if wide.is_none() && self.try_wide(v, &start, faces, step) {
                    wide = Some(step);
                    most = most.min(tried + FURTHER);
                }
            }
        }
        if let Some(step) = wide {
            // Half as far is farther from the ends of the interval that sees.
            let half = Step {
                at: step.at.map(|x| x / 2.0),
                ..step
            };
            if self.try_wide(v, &start, faces, half) || self.try_wide(v, &start, faces, step) {
                return Ok(Some(v));
            }
        }
        self.drop_last();
        Ok(None)
    }

    /// Moves a free point to the center of its kernel, in doubles. False if it stays.
    pub fn center_free(&mut self, v: u32, near: Near) -> bool {
        let star = self.mesh.star(v, usize::MAX);
        let faces = self.mesh.outer_faces(&star);
        let (size, lift, vertices) = self.size(v, &faces);
        let old = self.mesh.points.exact(v);
        let start = self.mesh.points.near(v);
        if let Some(whole) = self.step_to_center(v, &faces, &vertices, size, lift) {
            for &part in near.parts() {
                let step = Step {
                    at: whole.at.map(|x| x * part),
                    ..whole
                };
                let p = step.from(start);
                for k in 0..near.count() {
                    let moved = [next(p[0], k % 3), next(p[1], k / 3 % 3), next(p[2], k / 9)];
                    if moved.iter().all(|x| x.is_finite())
                        && self.mesh.points.place(v, Wide::of(moved))
                        && self.sees(&faces, v)
                    {
                        return true;
                    }
                }
            }
        }
        self.mesh.points.place(v, old);
        false
    }

    /// The largest difference from a vertex to those of faces, its lift, and these.
    fn size(&self, s: u32, faces: &[[u32; 3]]) -> (f64, i64, BTreeSet<u32>) {
        let vertices: BTreeSet<u32> = faces.as_flattened().iter().copied().collect();
        let points = &self.mesh.points;
        let lift = points.lift(s, vertices.iter().copied());
        let far = vertices.iter().flat_map(|&w| points.difference(s, w, lift));
        (far.fold(0.0, |m, x| m.max(x.abs())), lift, vertices)
    }

    /// The step from a point to the center of the kernel of faces.
    fn step_to_center(
        &self,
        s: u32,
        faces: &[[u32; 3]],
        vertices: &BTreeSet<u32>,
        size: f64,
        lift: i64,
    ) -> Option<Step> {
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let at: std::collections::BTreeMap<u32, Point3> = vertices
            .iter()
            .map(|&w| (w, self.mesh.points.difference(s, w, lift).map(|x| x / size)))
            .collect();
        let mut planes = Vec::with_capacity(faces.len());
        for [a, b, c] in faces {
            let (p, q, r) = (at.get(a)?, at.get(b)?, at.get(c)?);
            let from = |x: &Point3| [x[0] - p[0], x[1] - p[1], x[2] - p[2]];
            let normal = unit(cross(from(q), from(r)));
            if normal == [0.0; 3] {
                return None;
            }
            let offset = normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2];
            planes.push(Plane { normal, offset });
        }
        let (x, _) = center(&planes)?;
        let at = x.map(|x| x * size);
        Some(Step { at, lift })
    }

    /// Tries a step in doubles, then exactly.
    fn try_at(&mut self, v: u32, s: u32, faces: &[[u32; 3]], step: Step) -> bool {
        self.try_double(v, s, faces, step) || {
            let start = self.mesh.points.exact(s);
            self.try_wide(v, &start, faces, step)
        }
    }

    /// Places `v` at the double nearest to a step from `s`, if that sees all faces.
    fn try_double(&mut self, v: u32, s: u32, faces: &[[u32; 3]], step: Step) -> bool {
        let p = step.from(self.mesh.points.near(s));
        p.iter().all(|x| x.is_finite())
            && self.mesh.points.place(v, Wide::of(p))
            && self.sees(faces, v)
    }

    /// The same without rounding.
    fn try_wide(&mut self, v: u32, start: &Wide, faces: &[[u32; 3]], step: Step) -> bool {
        step.at.iter().all(|x| x.is_finite())
            && self.mesh.points.place(v, start.plus(step))
            && self.sees(faces, v)
    }
}
