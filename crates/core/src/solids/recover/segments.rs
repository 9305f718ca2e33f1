//! Edges of faces: split where tetrahedra cross them.
//!
//! The tetrahedra around a crossed face or a crossed edge form a region that is joined to a point
//! of the segment inside it. Each new point leaves fewer open tetrahedra on the rest of the
//! segment.

use delone_predicates::Sign;
use num_bigint::BigInt;

use super::coordinates::Wide;
use super::mesh::{internal, pair};
use super::work::{Dyadic, Origin, Work};
use crate::base::error::{Error, Result};
use crate::base::wide::{determinant, ratio};

/// What a segment leaves the star of its end through.
#[derive(Debug, Clone, Copy)]
pub enum Step {
    /// The face opposite a corner of a tetrahedron.
    Face(u32, usize),
    /// An edge of a tetrahedron.
    Edge(u32, u32, u32),
}

/// A fraction with a positive denominator.
#[derive(Debug, Clone)]
struct Fraction(BigInt, BigInt);

impl Fraction {
    /// Whether this is below another one.
    fn is_below(&self, other: &Self) -> bool {
        &self.0 * &other.1 < &other.0 * &self.1
    }
}

impl Work<'_> {
    /// Splits the segments that are missing; if `flips`, only until the rest of one can be recovered by these.
    pub fn split_segments(&mut self, missing: &[u32], flips: bool) -> Result<()> {
        for &s in missing {
            self.pace.spend(16)?;
            let [a, b] = self.segments[s as usize];
            let mut now = (a, Dyadic::zero());
            let mut chain = Vec::new();
            // From the last point on: flips if they suffice, otherwise a point within sight of it.
            while self.mesh.with_edge(now.0, b).is_none() {
                self.pace.spend(8)?;
                if flips && self.flip_segment([now.0, b], super::DEPTH)? {
                    break;
                }
                let cells = self.crossed_first(now.0, b)?;
                let (v, place) = self.split(s, &cells, &now)?;
                self.locked_edges.insert(pair(now.0, v), s);
                chain.push(v);
                now = (v, place);
            }
            self.locked_edges.insert(pair(now.0, b), s);
            if !chain.is_empty() {
                self.chains.insert(s, chain);
            }
        }
        Ok(())
    }

    /// How a segment from a vertex to another one leaves the star of the first.
    pub fn step(&mut self, a: u32, b: u32) -> Result<Step> {
        for t in self.mesh.star(a, usize::MAX) {
            let Some(k) = self.mesh.corner(t, a) else {
                continue;
            };
            let [u, v, w] = self.mesh.face(t, k);
            // It leaves through the face opposite a if b is on no outer side of the others.
            let signs = [
                self.orient(a, v, u, b),
                self.orient(a, w, v, b),
                self.orient(a, u, w, b),
            ];
            if signs.contains(&Sign::Negative) {
                continue;
            }
            let edges = [(u, v), (v, w), (w, u)];
            let mut on = edges.iter().zip(signs).filter(|(_, s)| s.is_zero());
            return match (on.next(), on.next()) {
                (None, _) => Ok(Step::Face(t, k)),
                (Some((&(p, q), _)), None) => Ok(Step::Edge(t, p, q)),
                _ => Err(Error::Shape("an edge contains a vertex".into())),
            };
        }
        Err(internal("a segment leaves no tetrahedron"))
    }

    /// The tetrahedra around the first crossed face or edge.
    fn crossed_first(&mut self, a: u32, b: u32) -> Result<Vec<u32>> {
        match self.step(a, b)? {
            Step::Face(t, k) => Ok(vec![t, self.mesh.across[t as usize][k]]),
            Step::Edge(t, p, q) => {
                let ring = self.mesh.ring(t, p, q);
                let ring = ring.ok_or_else(|| internal("a segment meets the far hull"))?;
                Ok(ring.tetrahedra)
            }
        }
    }

    /// Joins cells to a new point on the rest of a segment.
    fn split(&mut self, s: u32, cells: &[u32], now: &(u32, Dyadic)) -> Result<(u32, Dyadic)> {
        let faces = self.mesh.outer_faces(cells);
        let [a, b] = self.segments[s as usize];
        let bounds = self.kernel(&faces, a, b, now)?;
        let place = simplest(&bounds)?;
        let (ends, low) = self.mesh.points.integers(&[a, b]);
        let at = [0, 1, 2]
            .map(|k| (&ends[0][k] << place.bits) + &place.numerator * (&ends[1][k] - &ends[0][k]));
        let exponent = low - place.bits as i64;
        let v = self.add(Wide { at, exponent }, Origin::Segment(s))?;
        if !self.sees(&faces, v) {
            return Err(internal("a point of a segment does not see its region"));
        }
        self.mesh.fan(cells, &faces, v)?;
        self.counts.segment_points += 1;
        Ok((v, place))
    }

    /// The part of a segment that sees all faces, as an open interval of its parameter.
    fn kernel(
        &self,
        faces: &[[u32; 3]],
        a: u32,
        b: u32,
        now: &(u32, Dyadic),
    ) -> Result<[Fraction; 2]> {
        let mut vertices: Vec<u32> = faces.as_flattened().to_vec();
        vertices.extend([a, b]);
        let (p, _) = self.mesh.points.integers(&vertices);
        let (start, end) = (&p[p.len() - 2], &p[p.len() - 1]);
        let one = BigInt::from(1);
        let unit = one.clone() << now.1.bits;
        let mut low = Fraction(now.1.numerator.clone(), unit);
        let mut high = Fraction(one.clone(), one);
        for face in p[..p.len() - 2].chunks_exact(3) {
            // Along the segment, the side of a face is linear: it bounds the interval from below or above.
            let from = |q: &[BigInt; 3]| [0, 1, 2].map(|k| &q[k] - &face[0][k]);
            let (u, v) = (from(&face[1]), from(&face[2]));
            let first = determinant([&u, &v, &from(start)]);
            let slope = determinant([&u, &v, &from(end)]) - &first;
            let zero = BigInt::ZERO;
            if slope > zero {
                let bound = Fraction(-first, slope);
                if low.is_below(&bound) {
                    low = bound;
                }
            } else if slope < zero {
                let bound = Fraction(first, -slope);
                if bound.is_below(&high) {
                    high = bound;
                }
            } else if first <= zero {
                return Err(internal("a region has no kernel"));
            }
        }
        if !low.is_below(&high) {
            return Err(internal("a region has an empty kernel"));
        }
        Ok([low, high])
    }
}

impl Dyadic {
    /// Zero.
    pub fn zero() -> Self {
        Self {
            numerator: BigInt::ZERO,
            bits: 0,
        }
    }
}

/// The dyadic number of fewest bits in the middle half of an interval.
fn simplest([low, high]: &[Fraction; 2]) -> Result<Dyadic> {
    // Both over one denominator, times four.
    let unit: BigInt = (&low.1 * &high.1) << 2_u32;
    let (l, h) = (&low.0 * &high.1, &high.0 * &low.1);
    let (from, to) = (&l * 3 + &h, &l + &h * 3);
    let width: BigInt = &to - &from;
    // A dyadic number with fewer bits than the width is not certain to lie inside.
    let most = unit.bits().saturating_sub(width.bits()) + 2;
    for bits in 0..=most {
        let scaled: BigInt = &from << bits;
        // Rounded up; the interval is positive.
        let numerator = (scaled + &unit - 1_u32) / &unit;
        if &numerator * &unit <= (&to << bits) {
            return Ok(Dyadic { numerator, bits });
        }
    }
    Err(internal("an interval without a dyadic number"))
}

/// A fraction of integers as a double, for filters.
pub fn quotient(n: &BigInt, d: &BigInt) -> f64 {
    ratio(n, d, 0).unwrap_or(f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(low: (i32, i32), high: (i32, i32)) -> (BigInt, u64) {
        let fraction = |(n, d)| Fraction(BigInt::from(n), BigInt::from(d));
        let found = simplest(&[fraction(low), fraction(high)]).unwrap();
        (found.numerator, found.bits)
    }

    #[test]
    fn the_simplest_number_is_in_the_middle_half() {
        assert_eq!(of((0, 1), (1, 1)), (BigInt::from(1), 1));
        assert_eq!(of((1, 3), (2, 3)), (BigInt::from(1), 1));
        assert_eq!(of((1, 2), (1, 1)), (BigInt::from(3), 2));
        // From 4/10 to 6/10 of 1/1000: .0004 to .0006, 1/2048 = .000488.
        assert_eq!(of((0, 1), (1, 1000)), (BigInt::from(1), 11));
    }
}
