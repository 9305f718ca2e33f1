//! A simplex with what is proven about it: conflicts and barycentric coordinates, exactly.
//!
//! The stages and their bounds are those of `ndim::filter`, `ndim::fine` and `ndim::frame`, with a
//! number of coordinates that is not a constant. Integers follow double-double at once: residues
//! would save little where there is one simplex for each query.

use delone_predicates::arithmetic::Pair;
use num_bigint::BigInt;

use super::super::filter::{LEAST_RESIDUAL, LEAST_VALUE, ROUNDED, U};
use super::super::frame::{Frame, Integers};
use super::super::residues::FEW_BITS;
use super::sites::Around;
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, with_room};
use crate::base::wide::ratio;

/// Rounded solutions and bounds, row by row.
struct Rounded {
    /// The differences of the corners from the first one.
    a: Vec<f64>,
    /// An approximate inverse of them.
    b: Vec<f64>,
    /// A bound of the norm of the inverse, infinite if nothing is proven.
    norm: f64,
    /// A bound of |I - A B|.
    defect: f64,
    /// Twice the center, from the first corner.
    x: Vec<f64>,
    /// The value of a point at the distance r is certain above q0 + q1 r^2 in magnitude.
    q0: f64,
    q1: f64,
}

/// Twice the center in pairs.
struct Fine {
    a: Vec<Pair>,
    x: Vec<Pair>,
    size: f64,
    error: f64,
}

/// A simplex that is not flat.
pub struct Proven {
    /// Its corners.
    pub corners: Vec<u32>,
    rounded: Rounded,
    fine: Option<Fine>,
    frame: Option<Frame>,
}

/// The scalar product, in four parts, which compile to vector instructions.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut parts = [0.0; 4];
    let (mut left, mut right) = (a.chunks_exact(4), b.chunks_exact(4));
    for (x, y) in left.by_ref().zip(right.by_ref()) {
        for k in 0..4 {
            parts[k] += x[k] * y[k];
        }
    }
    let rest = left.remainder().iter().zip(right.remainder());
    for (x, y) in rest {
        parts[0] += x * y;
    }
    (parts[0] + parts[1]) + (parts[2] + parts[3])
}

/// Inverts a square matrix of `w` rows by Gauss-Jordan elimination with pivots from the columns.
pub fn invert(a: &[f64], w: usize) -> Result<Vec<f64>> {
    let mut m = copied(a)?;
    let mut b = filled(w * w, 0.0)?;
    for k in 0..w {
        b[k * w + k] = 1.0;
    }
    for k in 0..w {
        let mut pivot = k;
        for i in k + 1..w {
            if m[i * w + k].abs() > m[pivot * w + k].abs() {
                pivot = i;
            }
        }
        if pivot != k {
            for j in 0..w {
                m.swap(k * w + j, pivot * w + j);
                b.swap(k * w + j, pivot * w + j);
            }
        }
        let f = 1.0 / m[k * w + k];
        for rows in [&mut m, &mut b] {
            for x in &mut rows[k * w..][..w] {
                *x *= f;
            }
        }
        for i in 0..w {
            let g = m[i * w + k];
            if i != k && g != 0.0 {
                reduce(&mut m, w, i, k, g);
                reduce(&mut b, w, i, k, g);
            }
        }
    }
    Ok(b)
}

/// Subtracts `g` times row `k` from row `i`.
pub fn reduce(rows: &mut [f64], w: usize, i: usize, k: usize, g: f64) {
    let (of, from) = if i < k {
        let (head, tail) = rows.split_at_mut(k * w);
        (&mut head[i * w..][..w], &tail[..w])
    } else {
        let (head, tail) = rows.split_at_mut(i * w);
        (&mut tail[..w], &head[k * w..][..w])
    };
    for (x, y) in of.iter_mut().zip(from) {
        *x -= g * y;
    }
}

impl Rounded {
    fn new(at: &Around, corners: &[u32]) -> Result<Self> {
        let d = at.sites.d;
        let (mut a, mut squares) = (with_room(d * d)?, with_room(d)?);
        let o = at.at(corners[0]);
        for &p in &corners[1..] {
            a.extend(at.at(p).iter().zip(o).map(|(x, o)| x - o));
        }
        squares.extend(a.chunks_exact(d).map(|row| dot(row, row)));
        let b = invert(&a, d)?;
        let (norm, defect) = bounds(&a, &b, d);
        let mut x = with_room(d)?;
        x.extend(b.chunks_exact(d).map(|row| dot(row, &squares)));
        let mut found = Self {
            a,
            b,
            norm,
            defect,
            x,
            q0: f64::INFINITY,
            q1: 0.0,
        };
        if at.filtered {
            found.measure(&squares);
        } else {
            (found.norm, found.defect) = (f64::INFINITY, f64::INFINITY);
        }
        Ok(found)
    }

    /// The bound of values of the sphere: `Test::sphere` of the filter.
    fn measure(&mut self, squares: &[f64]) {
        let d = self.x.len();
        let size = dot(&self.x, &self.x).sqrt();
        let mut residuals = 0.0;
        for (row, square) in self.a.chunks_exact(d).zip(squares) {
            let (mut sum, mut sizes) = (0.0, 0.0);
            for (a, x) in row.iter().zip(&self.x) {
                sum += a * x;
                sizes += (a * x).abs();
            }
            let rounding = (2 * d + 8) as f64 * U * (sizes + square.abs());
            let residual = (sum - square).abs() + rounding + LEAST_RESIDUAL;
            residuals += residual * residual;
        }
        let error = ROUNDED * self.norm * residuals.sqrt();
        let c = (d + 5) as f64 * U;
        let slope = ROUNDED * (error + c * size);
        let (q0, q1) = (
            slope * size / 2.0 + LEAST_VALUE,
            slope / (2.0 * size) + ROUNDED * c,
        );
        if q0.is_finite() && q1.is_finite() {
            (self.q0, self.q1) = (q0, q1);
        }
    }
}

/// Bounds of |A^-1| and of |I - A B|: `proven` of the filter.
fn bounds(a: &[f64], b: &[f64], d: usize) -> (f64, f64) {
    let mut e = 0.0;
    let mut row = vec![0.0; d];
    for (i, of_a) in a.chunks_exact(d).enumerate() {
        row.fill(0.0);
        row[i] = -1.0;
        for (f, of_b) in of_a.iter().zip(b.chunks_exact(d)) {
            for (x, y) in row.iter_mut().zip(of_b) {
                *x += f * y;
            }
        }
        e += dot(&row, &row);
    }
    let (e, na, nb) = (e.sqrt(), dot(a, a).sqrt(), dot(b, b).sqrt());
    let defect = ROUNDED * (e + (2 * d + 16) as f64 * U * (na * nb + d as f64));
    // A comparison that NaN fails.
    if defect < 0.5 {
        (ROUNDED * nb / (1.0 - defect), defect)
    } else {
        (f64::INFINITY, f64::INFINITY)
    }
}

impl Fine {
    /// As `ndim::fine` does.
    fn new(at: &Around, corners: &[u32], rounded: &Rounded) -> Result<Self> {
        let d = at.sites.d;
        let mut a = with_room(d * d)?;
        for &p in &corners[1..] {
            a.extend(differences(at, p, corners[0]));
        }
        let mut squares = with_room(d)?;
        let square = |row: &[Pair]| row.iter().fold(ZERO, |sum, x| sum + x.square());
        squares.extend(a.chunks_exact(d).map(square));
        let mut fine = Self {
            a,
            x: filled(d, ZERO)?,
            size: 0.0,
            error: f64::INFINITY,
        };
        let mut residual = filled(d, 0.0)?;
        for step in 0..STEPS {
            let mut lengths = 0.0;
            for ((row, square), out) in fine.a.chunks_exact(d).zip(&squares).zip(&mut residual) {
                let (mut sum, mut size) = (*square, square.hi);
                for (a, x) in row.iter().zip(&fine.x) {
                    let product = *a * *x;
                    size += product.hi.abs();
                    sum = sum - product;
                }
                *out = sum.hi;
                let rounding = (8 * d + 16) as f64 * U * U * size;
                let bound = ROUNDED * sum.hi.abs() + rounding + LEAST_RESIDUAL;
                lengths += bound * bound;
            }
            fine.error = ROUNDED * rounded.norm * lengths.sqrt();
            if step + 1 < STEPS {
                for (x, row) in fine.x.iter_mut().zip(rounded.b.chunks_exact(d)) {
                    *x = *x + Pair::from_double(dot(row, &residual));
                }
            }
        }
        let squares: f64 = fine.x.iter().map(|x| x.hi * x.hi).sum();
        fine.size = ROUNDED * squares.sqrt();
        Ok(fine)
    }

    /// The power of a point, where `o` is the first corner, and the bound of its error.
    fn power(&self, at: &Around, p: u32, o: u32) -> (f64, f64) {
        let d = self.x.len();
        let (mut sum, mut square) = (ZERO, 0.0);
        for (y, x) in differences(at, p, o).zip(&self.x) {
            square += y.hi * y.hi;
            sum = sum + y * (y - *x);
        }
        let length = ROUNDED * square.sqrt();
        let rounding = (4 * d + 16) as f64 * U * U * (length + self.size);
        let bound = ROUNDED * length * (self.error + rounding) + U * sum.hi.abs() + LEAST_VALUE;
        (sum.hi, bound)
    }

    /// Barycentric coordinates of a point with one bound of their errors, as in `ndim::simplex`.
    fn barycentric(
        &self,
        at: &Around,
        p: u32,
        o: u32,
        rounded: &Rounded,
    ) -> Result<(Vec<f64>, f64)> {
        let d = self.x.len();
        let mut to_p = with_room(d)?;
        to_p.extend(differences(at, p, o));
        let (mut l, mut error) = (filled(d, ZERO)?, f64::INFINITY);
        let (mut residual, mut sums, mut sizes) =
            (filled(d, 0.0)?, filled(d, ZERO)?, filled(d, 0.0)?);
        for step in 0..STEPS {
            for k in 0..d {
                (sums[k], sizes[k]) = (to_p[k], to_p[k].hi.abs());
            }
            for (row, l) in self.a.chunks_exact(d).zip(&l) {
                for k in 0..d {
                    let product = *l * row[k];
                    sizes[k] += product.hi.abs();
                    sums[k] = sums[k] - product;
                }
            }
            let mut lengths = 0.0;
            for k in 0..d {
                residual[k] = sums[k].hi;
                let rounding = (8 * d + 16) as f64 * U * U * sizes[k];
                let bound = ROUNDED * sums[k].hi.abs() + rounding + LEAST_RESIDUAL;
                lengths += bound * bound;
            }
            error = ROUNDED * rounded.norm * lengths.sqrt();
            if step + 1 < STEPS {
                for (r, row) in residual.iter().zip(rounded.b.chunks_exact(d)) {
                    for (l, b) in l.iter_mut().zip(row) {
                        *l = *l + Pair::from_double(r * b);
                    }
                }
            }
        }
        let (mut rest, mut size) = (Pair::from_double(1.0), 1.0);
        for x in &l {
            rest = rest - *x;
            size += x.hi.abs();
        }
        let bound = ROUNDED * (d as f64 * error + (4 * d + 8) as f64 * U * U * size);
        let mut found = with_room(d + 1)?;
        found.push(rest.hi);
        found.extend(l.iter().map(|x| x.hi));
        Ok((found, bound))
    }
}

const ZERO: Pair = Pair { hi: 0.0, lo: 0.0 };

/// Passes of refinement: the first is the solution itself, the last measures only.
const STEPS: usize = 5;

/// The components of `p - o`, exactly.
fn differences<'a>(at: &'a Around, p: u32, o: u32) -> impl Iterator<Item = Pair> + 'a {
    let (p, o) = (at.at(p), at.at(o));
    p.iter().zip(o).map(|(&p, &o)| Pair::difference(p, o))
}

impl Proven {
    /// The simplex of `d + 1` sites. `None` if it is flat.
    pub fn new(at: &Around, corners: Vec<u32>) -> Result<Option<Self>> {
        let rounded = Rounded::new(at, &corners)?;
        let mut found = Self {
            corners,
            rounded,
            fine: None,
            frame: None,
        };
        if !found.rounded.norm.is_finite() {
            found.frame = Frame::new(at, &found.corners);
            if found.frame.is_none() {
                return Ok(None);
            }
        }
        Ok(Some(found))
    }

    /// Drops the integers, whose unit depends on the query.
    pub fn for_another_query(&mut self) -> &mut Self {
        self.frame = None;
        self
    }

    /// The number of coordinates.
    fn d(&self) -> usize {
        self.corners.len() - 1
    }

    /// The power of scaled coordinates, with the bound of its error.
    #[inline(always)]
    pub fn value(&self, p: &[f64], o: &[f64]) -> (f64, f64) {
        let x = &self.rounded.x;
        let (mut squares, mut across) = ([0.0; 4], [0.0; 4]);
        for k in 0..x.len() {
            let y = p[k] - o[k];
            squares[k % 4] += y * y;
            across[k % 4] += y * x[k];
        }
        let sum = |parts: [f64; 4]| (parts[0] + parts[1]) + (parts[2] + parts[3]);
        let square = sum(squares);
        (
            square - sum(across),
            self.rounded.q0 + self.rounded.q1 * square,
        )
    }

    /// Whether all points of a box are outside the sphere for certain.
    ///
    /// Let P^ be the power with the rounded center. It is a sum over coordinates, each convex, so its
    /// least value in the box is where each is nearest to the center: up to u, as the box is within
    /// the unit cube, and there the sum changes by at most d u^2. The power of any point of the box
    /// differs from its P^, and the computed least value from the true one, by the bound of the point
    /// of the box that is farthest from the first corner.
    #[inline(always)]
    pub fn misses(&self, low: &[f64], high: &[f64], o: &[f64]) -> bool {
        let x = &self.rounded.x;
        let (mut least, mut far) = (0.0, 0.0);
        for k in 0..x.len() {
            let y = (o[k] + 0.5 * x[k]).max(low[k]).min(high[k]) - o[k];
            least += y * (y - x[k]);
            let (left, right) = (low[k] - o[k], high[k] - o[k]);
            far += (left * left).max(right * right);
        }
        let bound = self.rounded.q0 + self.rounded.q1 * far;
        least > ROUNDED * 2.0 * bound + 4.0 * x.len() as f64 * U * U
    }

    /// The sign of the power of a point: negative inside the sphere.
    fn power(&mut self, at: &Around, p: u32) -> Result<i32> {
        if at.holds(p) {
            let (value, bound) = self.value(at.at(p), at.at(self.corners[0]));
            if value.abs() > bound {
                return Ok(sign(value));
            }
            if at.bits() > FEW_BITS && self.rounded.norm.is_finite() {
                let o = self.corners[0];
                let (value, bound) = self.fine(at)?.power(at, p, o);
                if value.abs() > bound {
                    return Ok(sign(value));
                }
            }
        }
        let o = self.corners[0];
        Ok(self.frame(at)?.power(at, o, p))
    }

    /// Rounded barycentric coordinates of a point, with one bound of their errors.
    fn rough(&self, at: &Around, p: u32) -> Result<(Vec<f64>, f64)> {
        let d = self.d();
        let mut l = filled(d + 1, 0.0)?;
        l[0] = 1.0;
        if !at.holds(p) {
            return Ok((l, f64::INFINITY));
        }
        let (p, o) = (at.at(p), at.at(self.corners[0]));
        let mut square = 0.0;
        for (k, row) in self.rounded.b.chunks_exact(d).enumerate() {
            let y = p[k] - o[k];
            square += y * y;
            for (l, b) in l[1..].iter_mut().zip(row) {
                *l += b * y;
            }
        }
        l[0] -= l[1..].iter().sum::<f64>();
        Ok((l, self.error_at(square)))
    }

    /// One of them.
    fn rough_one(&self, at: &Around, i: usize, p: u32) -> (f64, f64) {
        if !at.holds(p) {
            return (0.0, f64::INFINITY);
        }
        let d = self.d();
        let (p, o) = (at.at(p), at.at(self.corners[0]));
        let (mut l, mut square) = (f64::from(i == 0), 0.0);
        for (k, row) in self.rounded.b.chunks_exact(d).enumerate() {
            let y = p[k] - o[k];
            square += y * y;
            l += match i {
                0 => -y * row.iter().sum::<f64>(),
                _ => y * row[i - 1],
            };
        }
        (l, self.error_at(square))
    }

    /// A bound of rounded barycentric coordinates of a point at a distance from the first corner:
    /// `barycentric` of the filter.
    fn error_at(&self, square: f64) -> f64 {
        let d = self.d() as f64;
        let size = square.sqrt() * self.rounded.norm;
        let one = size * (self.rounded.defect + (2.0 * d + 8.0) * U);
        let sum = (2.0 * d + 8.0) * U * (1.0 + 2.0 * d * size);
        let bound = ROUNDED * (d * one + sum) + LEAST_VALUE;
        if bound.is_finite() {
            bound
        } else {
            f64::INFINITY
        }
    }

    /// The sign of one barycentric coordinate of a point.
    pub fn side(&mut self, at: &Around, i: usize, p: u32) -> Result<i32> {
        if let Some(k) = self.corners.iter().position(|&v| v == p) {
            return Ok(i32::from(k == i));
        }
        let (l, bound) = self.rough_one(at, i, p);
        if l.abs() > bound {
            return Ok(sign(l));
        }
        if at.holds(p) && at.bits() > FEW_BITS && self.rounded.norm.is_finite() {
            let o = self.corners[0];
            self.fine(at)?;
            let (l, bound) = match &self.fine {
                Some(fine) => fine.barycentric(at, p, o, &self.rounded)?,
                None => return Err(lost()),
            };
            if l[i].abs() > bound {
                return Ok(sign(l[i]));
            }
        }
        let o = self.corners[0];
        Ok(self.frame(at)?.coordinate(at, o, i, p))
    }

    /// The signs of all barycentric coordinates of the query, and the coordinates, rounded.
    pub fn sides(&mut self, at: &Around) -> Result<(Vec<i32>, Vec<f64>)> {
        let q = at.query();
        let mut signs = with_room(self.corners.len())?;
        if let Some(k) = self.corners.iter().position(|&v| at.is_query(v)) {
            signs.extend((0..self.corners.len()).map(|i| i32::from(i == k)));
            let mut weights = with_room(signs.len())?;
            weights.extend(signs.iter().map(|&s| f64::from(s)));
            return Ok((signs, weights));
        }
        let (l, bound) = self.rough(at, q)?;
        let mut weights = l;
        for i in 0..self.corners.len() {
            signs.push(if weights[i].abs() > bound {
                sign(weights[i])
            } else {
                self.side(at, i, q)?
            });
        }
        for (weight, side) in weights.iter_mut().zip(&signs) {
            if *side == 0 {
                *weight = 0.0;
            }
        }
        Ok((signs, weights))
    }

    /// The barycentric coordinates of the query, which is in the simplex: none negative, each with
    /// an error of about a unit in the last place of 1.
    pub fn weights(&mut self, at: &Around, signs: &[i32]) -> Result<Vec<f64>> {
        let q = at.query();
        let (l, bound) = self.rough(at, q)?;
        if bound <= CLOSE {
            return Ok(clean(l, signs));
        }
        if at.holds(q) && self.rounded.norm.is_finite() {
            let o = self.corners[0];
            self.fine(at)?;
            if let Some(fine) = &self.fine {
                let (l, bound) = fine.barycentric(at, q, o, &self.rounded)?;
                if bound <= CLOSE {
                    return Ok(clean(l, signs));
                }
            }
        }
        let o = self.corners[0];
        let count = self.corners.len();
        let frame = self.frame(at)?;
        let determinant = frame.determinant();
        let mut found = with_room(count)?;
        found.extend((0..count).map(|i| {
            let share = frame.share(at, o, i, q);
            ratio(&share, &determinant, 0).unwrap_or(0.0)
        }));
        Ok(found)
    }

    /// The corner with the least ratio of the query's coordinate to the positive one of a site, if
    /// roundings cannot hide another one. Coordinates of the query are known to be positive.
    pub fn least_ratio(&self, at: &Around, of_query: &[f64], p: u32) -> Result<Option<usize>> {
        let (_, bound_of_query) = self.rough(at, at.query())?;
        let (of_site, bound) = self.rough(at, p)?;
        let (mut best, mut second) = ((f64::INFINITY, None), f64::INFINITY);
        for (i, (q, p)) in of_query.iter().zip(&of_site).enumerate() {
            // A comparison that NaN fails.
            let certain = p.abs() > bound;
            if !certain {
                return Ok(None);
            }
            if *p < 0.0 {
                continue;
            }
            // Quotients of bounds, with room for their roundings.
            let high = (q + bound_of_query) / (p - bound) * ROUNDED;
            let low = (q - bound_of_query).max(0.0) / (p + bound) / ROUNDED;
            if high < best.0 {
                second = second.min(best.1.map_or(f64::INFINITY, |(_, low)| low));
                best = (high, Some((i, low)));
            } else {
                second = second.min(low);
            }
        }
        Ok(best.1.map(|(i, _)| i).filter(|_| best.0 < second))
    }

    /// The integers of the barycentric coordinates of a point, in one unit.
    pub fn shares(&mut self, at: &Around, p: u32) -> Result<Vec<BigInt>> {
        let o = self.corners[0];
        let count = self.corners.len();
        let frame = self.frame(at)?;
        let mut found = with_room(count)?;
        found.extend((0..count).map(|i| frame.share(at, o, i, p)));
        Ok(found)
    }

    /// Whether a site is in conflict with the simplex: the rule of `ndim`.
    pub fn conflict(&mut self, at: &Around, p: u32) -> Result<bool> {
        if self.corners.contains(&p) {
            return Ok(false);
        }
        match self.power(at, p)? {
            0 => {}
            power => return Ok(power < 0),
        }
        // The smallest of the point and of the corners that span it affinely decides.
        let place = |p: u32| at.sites.place[p as usize];
        let mut order = with_room(self.corners.len())?;
        order.extend(0..self.corners.len());
        order.sort_unstable_by_key(|&i| place(self.corners[i]));
        for i in order {
            if place(self.corners[i]) > place(p) {
                break;
            }
            let side = self.side(at, i, p)?;
            if side != 0 {
                return Ok(side < 0);
            }
        }
        Ok(true)
    }

    fn fine(&mut self, at: &Around) -> Result<&Fine> {
        if self.fine.is_none() {
            self.fine = Some(Fine::new(at, &self.corners, &self.rounded)?);
        }
        self.fine.as_ref().ok_or_else(lost)
    }

    fn frame(&mut self, at: &Around) -> Result<&Frame> {
        if self.frame.is_none() {
            self.frame = Frame::new(at, &self.corners);
        }
        self.frame.as_ref().ok_or_else(lost)
    }
}

/// The largest error of weights that are not made of integers.
const CLOSE: f64 = 1e-15;

/// Weights without rounding errors: exact zeros, never negative.
fn clean(mut l: Vec<f64>, signs: &[i32]) -> Vec<f64> {
    for (weight, &side) in l.iter_mut().zip(signs) {
        *weight = if side == 0 { 0.0 } else { weight.max(0.0) };
    }
    l
}

fn sign(x: f64) -> i32 {
    if x < 0.0 { -1 } else { 1 }
}

fn lost() -> Error {
    Error::Internal("a simplex is flat".into())
}
