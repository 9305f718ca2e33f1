//! Faces of the input: cut where edges cross them, one after another.
//!
//! The tetrahedra around a crossing edge are joined to a point of the face near the crossing. New
//! edges have an end in the plane, so each point removes one crossing and leaves the others
//! unchanged.

use num_bigint::BigInt;

use super::coordinates::Wide;
use super::mesh::{ascending, internal, pair};
use super::segments::quotient;
use super::work::{Origin, Work};
use crate::base::error::Result;
use crate::base::wide::determinant;

/// The most binary digits of a weight that is rounded from doubles.
const DIGITS: u32 = 40;

impl Work<'_> {
    /// Recovers a face, adding points in it where needed, and locks its parts.
    pub fn cut_face(&mut self, f: u32) -> Result<()> {
        let piercings = self.piercings(f)?;
        for [u, v] in piercings {
            self.pierced(f, u, v)?;
        }
        self.lock_parts(f)
    }

    /// Joins the tetrahedra around a crossing edge to a point of the face.
    fn pierced(&mut self, f: u32, u: u32, v: u32) -> Result<()> {
        let ring = self.ring_of(u, v)?;
        let faces = self.mesh.outer_faces(&ring.tetrahedra);
        let place = self.point_near(f, u, v, &faces)?;
        self.mesh.fan(&ring.tetrahedra, &faces, place)?;
        self.counts.face_points += 1;
        Ok(())
    }

    /// A new point of a face near its crossing with an edge that sees the faces around.
    fn point_near(&mut self, f: u32, u: u32, v: u32, around: &[[u32; 3]]) -> Result<u32> {
        let corners = self.faces[f as usize];
        let (p, low) = self.mesh.points.integers(&corners);
        let weights = self.weights(corners, u, v);
        let total: BigInt = &weights[0] + &weights[1] + &weights[2];
        let plain = weights.clone().map(|w| quotient(&w, &total));
        // The crossing sees all faces strictly, so weights with enough digits give a point that
        // sees them.
        for digits in 2_u64.. {
            self.pace.spend(1)?;
            // Weights with so many binary digits: a double has enough for the first of them.
            let rounded = |k: usize| -> BigInt {
                if digits <= u64::from(DIGITS) {
                    BigInt::from((plain[k] * 2_f64.powi(digits as i32)).round() as i64)
                } else {
                    (&weights[k] << digits) / &total
                }
            };
            let (second, third) = (rounded(1), rounded(2));
            let first = (BigInt::from(1) << digits) - &second - &third;
            let all = [first, second, third];
            if all.iter().any(|w| *w <= BigInt::ZERO) {
                continue;
            }
            // The point of these weights is exact, with one exponent for all coordinates.
            let at =
                [0, 1, 2].map(|k| &all[0] * &p[0][k] + &all[1] * &p[1][k] + &all[2] * &p[2][k]);
            let exponent = low - digits as i64;
            let point = self.add(Wide { at, exponent }, Origin::Face)?;
            if self.sees(around, point) {
                return Ok(point);
            }
            self.drop_last();
            if digits > 1 << 14 {
                break;
            }
        }
        Err(internal("no point of a face near a crossing"))
    }

    /// The weights of the corners of a face at its crossing with an edge.
    fn weights(&self, [a, b, c]: [u32; 3], u: u32, v: u32) -> [BigInt; 3] {
        let (p, _) = self.mesh.points.integers(&[a, b, c, u, v]);
        let from = |i: usize| [0, 1, 2].map(|k| &p[i][k] - &p[3][k]);
        let (along, all) = (from(4), [from(0), from(1), from(2)]);
        let weight = |i: usize| {
            let value = determinant([&along, &all[(i + 1) % 3], &all[(i + 2) % 3]]);
            BigInt::from(value.magnitude().clone())
        };
        [0, 1, 2].map(weight)
    }

    /// Locks the faces of the mesh that fill a face.
    fn lock_parts(&mut self, f: u32) -> Result<()> {
        let face = self.faces[f as usize];
        let aside = self.aside(face)?;
        let rim = self.rim(f);
        let step = |i: usize| [rim[i], rim[(i + 1) % rim.len()]];
        let mut open: Vec<[u32; 2]> = (0..rim.len()).map(step).collect();
        while let Some([p, q]) = open.pop() {
            self.pace.spend(1)?;
            let ring = self.ring_of(p, q)?;
            let inner = |&&r: &&u32| {
                self.orient(face[0], face[1], face[2], r).is_zero()
                    && self.turn(aside, [p, q, r]) == delone_predicates::Sign::Positive
            };
            let r = ring.vertices.iter().find(inner);
            let r = *r.ok_or_else(|| internal("a part of a face is missing"))?;
            if self.locked_faces.insert(ascending([p, q, r]), f) {
                continue;
            }
            for [x, y] in [[q, r], [r, p]] {
                if !self.locked_edges.has(pair(x, y)) {
                    // Seen from the other side.
                    open.push([y, x]);
                }
            }
        }
        Ok(())
    }
}
