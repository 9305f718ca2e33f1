//! Whether a point is in conflict with a cell: the stages, and the rule of ties.

use super::cell::{INFINITE, Mesh};
use super::filter::{Test, barycentric, invert, minus};
use super::fine::Fine;
use super::frame::Frame;
use super::residues::{FEW_BITS, is_zero};
use super::simplex::fine_barycentric;
use crate::base::error::{Error, Result};

impl<const D: usize, const V: usize, const P: usize> Mesh<D, V, P> {
    /// Whether a point is in conflict with a cell.
    #[inline(always)]
    pub fn conflict(&mut self, c: u32, p: u32) -> Result<bool> {
        let (value, bound) = self.value(c, p);
        // A comparison that NaN fails.
        if value.abs() > bound {
            Ok(value < 0.0)
        } else {
            self.uncertain(c, p)
        }
    }

    #[cold]
    #[inline(never)]
    fn uncertain(&mut self, c: u32, p: u32) -> Result<bool> {
        if self.cells[c as usize].is_ghost() && self.hull.is_some() {
            return self.beyond(c, p);
        }
        if self.cells[c as usize].is_ghost() {
            let (behind, far) = self.behind(c);
            return match self.side(behind, far, p)? {
                0 => self.conflict(behind, p),
                side => Ok(side < 0),
            };
        }
        match self.power(c, p)? {
            0 => {
                self.counts.ties += 1;
                self.tie(c, p)
            }
            power => Ok(power < 0),
        }
    }

    /// Whether a point is outside a facet of a hull. On its plane, with the site inside in the
    /// place of the infinite vertex, the rule of ties decides alone: a point that the corners
    /// enclose is never the smallest, so it is not outside, and extreme points only become
    /// vertices. Otherwise the sphere through these corners decides first.
    fn beyond(&mut self, c: u32, p: u32) -> Result<bool> {
        let mut v = self.cells[c as usize].vertices;
        let Some(inside) = &self.hull else {
            return Err(lost());
        };
        let is_delaunay = inside.is_delaunay;
        v[D] = inside.far[c as usize];
        if v[D] == p || v[..D].contains(&p) {
            return Ok(false);
        }
        // Frames are those of the simplex with that site.
        self.cells[c as usize].vertices = v;
        let decided = self.decided(c, p, is_delaunay);
        self.cells[c as usize].vertices[D] = INFINITE;
        decided
    }

    /// Whether a point is on the plane of a facet of a hull.
    pub fn is_level(&mut self, c: u32, p: u32) -> Result<bool> {
        let (value, bound) = self.value(c, p);
        if value.abs() > bound {
            return Ok(false);
        }
        let Some(inside) = &self.hull else {
            return Err(lost());
        };
        self.cells[c as usize].vertices[D] = inside.far[c as usize];
        let side = self.side(c, D, p);
        self.cells[c as usize].vertices[D] = INFINITE;
        Ok(side? == 0)
    }

    fn decided(&mut self, c: u32, p: u32, is_delaunay: bool) -> Result<bool> {
        match self.side(c, D, p)? {
            0 => {}
            side => return Ok(side < 0),
        }
        self.counts.ties += 1;
        if is_delaunay {
            let v = self.cells[c as usize].vertices;
            let test = if self.sites.filtered {
                let weights = self.sites.is_lifted.then(|| self.lifts(&v));
                Test::lifted(&self.differences(&v), weights)
            } else {
                Test::UNKNOWN
            };
            let at = |u: u32| &self.sites.scaled[u as usize];
            let rounded = test.value(&minus(at(p), at(v[0])), false);
            let rounded = self.less_weight(rounded, p, v[0]);
            match self.power_after(c, p, rounded)? {
                0 => {}
                power => return Ok(power < 0),
            }
        }
        self.tie(c, p)
    }

    /// The smallest of the point and of the corners that span it affinely decides.
    fn tie(&mut self, c: u32, p: u32) -> Result<bool> {
        let v = self.cells[c as usize].vertices;
        let mut order: [usize; V] = std::array::from_fn(|i| i);
        order.sort_unstable_by_key(|&i| v[i]);
        for i in order {
            if v[i] > p {
                break;
            }
            let side = self.side(c, i, p)?;
            if side != 0 {
                return Ok(side < 0);
            }
        }
        Ok(true)
    }

    /// The sign of the power of a point with respect to the sphere of a simplex: negative inside.
    pub fn power(&mut self, c: u32, p: u32) -> Result<i32> {
        let rounded = self.value(c, p);
        self.power_after(c, p, rounded)
    }

    /// The same after a rounded value with its bound.
    fn power_after(&mut self, c: u32, p: u32, (value, bound): (f64, f64)) -> Result<i32> {
        let v = self.cells[c as usize].vertices;
        if value.abs() > bound {
            return Ok(sign(value));
        }
        if self.sites.filtered && self.sites.bits > FEW_BITS {
            let (value, bound) = self.fine_power(c, p)?;
            if value.abs() > bound {
                self.counts.fine += 1;
                return Ok(sign(value));
            }
            // The determinant of the lifted points is that of the corners times the power. It is an
            // integer in units to the power D + 2, and the power is at most twice the bound.
            if bound.is_finite() {
                let log = self.sites.log_determinant(&v) + (2.0 * bound).log2();
                let points = self.sites.integers(v.iter().copied().chain([p]));
                let degree = D as i64 + 2;
                if is_zero(&points, true, ceil(log) - degree * self.sites.unit).is_some() {
                    self.counts.zeros += 1;
                    return Ok(0);
                }
            }
        }
        let row = self.framed(c)?;
        let Some(frame) = &self.slow[row].frame else {
            return Err(lost());
        };
        Ok(frame.power(&self.sites, v[0], p))
    }

    /// The power in double-double.
    fn fine_power(&mut self, c: u32, p: u32) -> Result<(f64, f64)> {
        let row = self.slow_row(c)?;
        let v = self.cells[c as usize].vertices;
        let at = |u: u32| &self.sites.scaled[u as usize];
        let fine = match self.slow[row].fine {
            Some(fine) => fine,
            None => {
                let weights = std::array::from_fn(|i| self.sites.weight_pair(v[i + 1], v[0]));
                let fine = Fine::lifted(&v.map(at), weights);
                self.slow[row].fine = Some(fine);
                fine
            }
        };
        Ok(fine.power(at(p), at(v[0]), self.sites.weight_pair(p, v[0])))
    }

    /// The sign of the barycentric coordinate of corner `i` of a simplex at a point.
    pub fn side(&mut self, c: u32, i: usize, p: u32) -> Result<i32> {
        let v = self.cells[c as usize].vertices;
        if self.sites.filtered {
            let a = self.differences(&v);
            let at = |u: u32| &self.sites.scaled[u as usize];
            let d = minus(at(p), at(v[0]));
            let inverse = invert(&a);
            let (l, bound) = barycentric::<D, V, P>(&inverse, &d);
            if l[i].abs() > bound {
                return Ok(sign(l[i]));
            }
            if self.sites.bits > FEW_BITS {
                let (l, bound) = fine_barycentric(&v.map(at), at(p), &inverse);
                if l[i].abs() > bound {
                    self.counts.fine += 1;
                    return Ok(sign(l[i]));
                }
                // The determinant with the point in place of the corner is that of the corners times
                // the coordinate, which is at most twice the bound.
                if bound.is_finite() {
                    let log = self.sites.log_determinant(&v) + (2.0 * bound).log2();
                    let mut with = v;
                    with[i] = p;
                    let points = self.sites.integers(with.into_iter());
                    if is_zero(&points, false, ceil(log) - D as i64 * self.sites.unit).is_some() {
                        self.counts.zeros += 1;
                        return Ok(0);
                    }
                }
            }
        }
        let row = self.framed(c)?;
        let Some(frame) = &self.slow[row].frame else {
            return Err(lost());
        };
        Ok(frame.coordinate(&self.sites, v[0], i, p))
    }

    /// Makes the integers of a simplex; returns the row of slow data that has them.
    fn framed(&mut self, c: u32) -> Result<usize> {
        self.counts.exact += 1;
        let row = self.slow_row(c)?;
        if self.slow[row].frame.is_none() {
            let frame = Frame::new(&self.sites, &self.cells[c as usize].vertices);
            self.slow[row].frame = Some(frame.ok_or_else(flat)?);
        }
        Ok(row)
    }
}

fn sign(x: f64) -> i32 {
    if x < 0.0 { -1 } else { 1 }
}

/// An integer above a logarithm that is rounded.
fn ceil(log: f64) -> i64 {
    log.ceil() as i64 + 1
}

fn lost() -> Error {
    Error::Internal("a simplex has lost its integers".into())
}

fn flat() -> Error {
    Error::Internal("a simplex is flat".into())
}
