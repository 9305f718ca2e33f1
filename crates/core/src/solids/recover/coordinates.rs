//! Coordinates that may be wider than a double: exact, with doubles next to them for filters.
//!
//! # The bound of the filter
//!
//! Let u = 2^-53, M the largest magnitude of a coordinate and D that of a computed difference. Each
//! double errs by u M, so a difference by 2 u M, and by 2 u M for its own rounding: e = 4 u M. Each
//! of six monomials of three factors errs by 3 D^2 e, and by 8 u D^3 for its products and sums, to
//! first order. 8 D^2 (3 e + 8 u D) covers six of these. A bound above 1e-250 is far from
//! underflow, and what overflows decides nothing.

use delone_predicates::{Point3, Sign, orient3d};
use num_bigint::BigInt;

use crate::base::error::Result;
use crate::base::memory::push;
use crate::base::wide::{determinant, lowest, ratio, scaled, sign};

/// Exact coordinates: integers times 2^exponent.
#[derive(Debug, Clone)]
pub struct Wide {
    /// The integers.
    pub at: [BigInt; 3],
    /// The exponent.
    pub exponent: i64,
}

impl Wide {
    /// A point of doubles.
    pub fn of(p: Point3) -> Self {
        let low = lowest(&[p], &[]);
        Self {
            at: p.map(|x| scaled(x, low)),
            exponent: low,
        }
    }

    /// The integers times 2^(exponent - low), for a low exponent.
    fn lowered(&self, low: i64) -> [BigInt; 3] {
        let shift = (self.exponent - low).max(0);
        self.at.clone().map(|x| x << shift)
    }

    /// The nearest doubles; `None` beyond their range.
    fn rounded(&self) -> Option<Point3> {
        let one = BigInt::from(1);
        let [x, y, z] = &self.at;
        Some([
            ratio(x, &one, self.exponent)?,
            ratio(y, &one, self.exponent)?,
            ratio(z, &one, self.exponent)?,
        ])
    }

    /// Whether these are the doubles `p`.
    fn is(&self, p: Point3) -> bool {
        let other = Self::of(p);
        let low = self.exponent.min(other.exponent);
        self.lowered(low) == other.lowered(low)
    }

    /// The point plus a step.
    pub fn plus(&self, step: Step) -> Self {
        let mut other = Self::of(step.at);
        other.exponent -= step.lift;
        let low = self.exponent.min(other.exponent);
        let (p, q) = (self.lowered(low), other.lowered(low));
        Self {
            at: [0, 1, 2].map(|k| &p[k] + &q[k]),
            exponent: low,
        }
    }
}

/// A vector times 2^-lift: doubles alone are coarse among points that are 2^-1000 apart.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// The vector, finite.
    pub at: Point3,
    /// The exponent: a multiple of [`LIFT`].
    pub lift: i64,
}

impl Step {
    /// The nearest doubles, or nearly so where they are subnormal.
    fn rounded(self) -> Point3 {
        let times = self.lift / LIFT;
        self.at.map(|x| (0..times).fold(x, |x, _| x / POWER))
    }

    /// The doubles nearest to a point plus this step.
    pub fn from(self, near: Point3) -> Point3 {
        let step = self.rounded();
        [0, 1, 2].map(|k| near[k] + step[k] + 0.0)
    }
}

/// The exponent by which vectors shorter than [`SHORT`] are lifted.
pub const LIFT: i64 = 1000;

/// 2^LIFT.
pub const POWER: f64 = f64::from_bits((1023 + LIFT as u64) << 52);

/// Lengths below which vectors are lifted: 2^-900.
pub const SHORT: f64 = f64::from_bits((1023 - 900) << 52);

/// The points of a mesh.
#[derive(Debug, Default)]
pub struct Coordinates {
    /// The nearest doubles.
    near: Vec<Point3>,
    /// The exact coordinates where they are not doubles.
    wide: Vec<Option<Box<Wide>>>,
}

impl Coordinates {
    /// Points of doubles.
    pub fn new(points: Vec<Point3>) -> Result<Self> {
        let mut wide = crate::base::memory::with_room(points.len())?;
        wide.resize(points.len(), None);
        Ok(Self { near: points, wide })
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.near.len()
    }

    /// The nearest doubles of a point.
    #[inline]
    pub fn near(&self, v: u32) -> Point3 {
        self.near[v as usize]
    }

    /// Whether the coordinates of a point are doubles.
    #[inline]
    pub fn is_double(&self, v: u32) -> bool {
        self.wide[v as usize].is_none()
    }

    /// Adds a point; false if it is beyond the range of doubles.
    pub fn add(&mut self, p: Wide) -> Result<Option<u32>> {
        let v = self.near.len() as u32;
        push(&mut self.near, [0.0; 3])?;
        push(&mut self.wide, None)?;
        Ok(self.place(v, p).then_some(v))
    }

    /// Removes the point added last.
    pub fn drop_last(&mut self) {
        self.near.pop();
        self.wide.pop();
    }

    /// Moves a point.
    pub fn place(&mut self, v: u32, p: Wide) -> bool {
        let Some(near) = p.rounded() else {
            return false;
        };
        self.near[v as usize] = near;
        self.wide[v as usize] = (!p.is(near)).then(|| Box::new(p));
        true
    }

    /// The exact coordinates of a point.
    pub fn exact(&self, v: u32) -> Wide {
        match &self.wide[v as usize] {
            Some(wide) => (**wide).clone(),
            None => Wide::of(self.near(v)),
        }
    }

    /// Points as integers times one power of two, whose exponent is second.
    pub fn integers(&self, vertices: &[u32]) -> (Vec<[BigInt; 3]>, i64) {
        let all: Vec<Wide> = vertices.iter().map(|&v| self.exact(v)).collect();
        let low = all.iter().map(|p| p.exponent).min().unwrap_or(0);
        (all.iter().map(|p| p.lowered(low)).collect(), low)
    }

    /// The side of the plane through a, b and c on which d is: the sign of det[b-a, c-a, d-a].
    #[inline]
    pub fn orient(&self, a: u32, b: u32, c: u32, d: u32) -> Sign {
        let [p, q, r, s] = [a, b, c, d].map(|v| self.near(v));
        if [a, b, c, d].iter().all(|&v| self.is_double(v)) {
            return orient3d(p, q, r, s);
        }
        filtered([p, q, r, s]).unwrap_or_else(|| self.orient_wide([a, b, c, d]))
    }

    /// Whether the boxes of a segment and a triangle have no point in common. Rounding keeps the
    /// order, so nearest doubles that differ prove it.
    #[inline]
    pub fn are_apart(&self, segment: [u32; 2], triangle: [u32; 3]) -> bool {
        let [a, b] = segment.map(|v| self.near(v));
        let [p, q, r] = triangle.map(|v| self.near(v));
        (0..3).any(|k| {
            let (low, high) = (a[k].min(b[k]), a[k].max(b[k]));
            p[k].min(q[k]).min(r[k]) > high || p[k].max(q[k]).max(r[k]) < low
        })
    }

    /// The same in integers.
    #[cold]
    fn orient_wide(&self, vertices: [u32; 4]) -> Sign {
        let (p, _) = self.integers(&vertices);
        let from = |i: usize| [0, 1, 2].map(|k| &p[i][k] - &p[0][k]);
        sign(&determinant([&from(1), &from(2), &from(3)]))
    }

    /// Whether d is strictly on the positive side.
    #[inline]
    pub fn positive(&self, [a, b, c, d]: [u32; 4]) -> bool {
        self.orient(a, b, c, d) == Sign::Positive
    }

    /// The exponent for vectors from a point to others, 0 or [`LIFT`].
    pub fn lift(&self, from: u32, others: impl Iterator<Item = u32>) -> i64 {
        let short = |v: u32| self.difference(from, v, 0).iter().all(|x| x.abs() < SHORT);
        if others.into_iter().all(short) {
            LIFT
        } else {
            0
        }
    }

    /// The vector from a point to another times 2^lift, 0 or [`LIFT`], each coordinate rounded once.
    pub fn difference(&self, from: u32, to: u32, lift: i64) -> Point3 {
        let (p, q) = (self.near(from), self.near(to));
        let power = if lift == 0 { 1.0 } else { POWER };
        let plain = [0, 1, 2].map(|k| (q[k] - p[k]) * power);
        if self.is_double(from) && self.is_double(to) {
            return plain;
        }
        let (exact, low) = self.integers(&[from, to]);
        let one = BigInt::from(1);
        let difference = |k: usize| ratio(&(&exact[1][k] - &exact[0][k]), &one, low + lift);
        [0, 1, 2].map(|k| difference(k).unwrap_or(plain[k]))
    }
}

/// The sign of the determinant of near doubles, if that is certain.
fn filtered(p: [Point3; 4]) -> Option<Sign> {
    const U: f64 = f64::EPSILON / 2.0;
    let from = |i: usize| [0, 1, 2].map(|k| p[i][k] - p[0][k]);
    let rows = [from(1), from(2), from(3)];
    let largest = |m: f64, x: &f64| m.max(x.abs());
    let far = p.as_flattened().iter().fold(0.0, largest);
    let wide = rows.as_flattened().iter().fold(0.0, largest);
    let bound = 8.0 * wide * wide * (12.0 * U * far + 8.0 * U * wide);
    let value = triple(rows);
    (bound > 1e-250 && value.abs() > bound && value.is_finite()).then(|| Sign::of(value))
}

/// The determinant of three vectors.
pub fn triple([p, q, r]: [Point3; 3]) -> f64 {
    let n = cross(p, q);
    n[0] * r[0] + n[1] * r[1] + n[2] * r[2]
}

/// The cross product.
pub fn cross(p: Point3, q: Point3) -> Point3 {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_of_a_bit_decides() {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut all = Coordinates::new(points).unwrap();
        for (lift, sign) in [(1, Sign::Positive), (0, Sign::Zero), (-1, Sign::Negative)] {
            let p = Wide {
                at: [
                    BigInt::from(1) << 80,
                    BigInt::from(1) << 81,
                    BigInt::from(lift),
                ],
                exponent: -90,
            };
            let v = all.add(p).unwrap().unwrap();
            assert!(all.is_double(v));
            let step = |x: f64| Step {
                at: [x, 0.0, 0.0],
                lift: 0,
            };
            let p = all.exact(v).plus(step(1.0)).plus(step(2_f64.powi(-200)));
            assert!(all.place(v, p));
            assert!(!all.is_double(v));
            assert_eq!(all.orient(0, 1, 2, v), sign);
        }
    }
}
