//! Natural neighbor weights from a cavity: Sibson's areas, Laplace's lengths, and their smooth
//! variants.
//!
//! Sibson weights are the area that the cell of the query would take from each neighbor (R. Sibson,
//! "A vector identity for the Dirichlet tessellation", 1980). Laplace weights are the length of the
//! wall between them over their distance (N. H. Christ, R. Friedberg and T. D. Lee, 1982; V. V.
//! Belikov et al., 1997). Sibson (1981) and Farin (1990) combine the former with gradients into
//! smooth interpolants.
//!
//! # Areas without centers
//!
//! The part of a cell that lies in a triangle, counted with its sign, has at corner a the area
//! (|ab|^2 cot c + |ac|^2 cot b) / 8. The area taken from a neighbor is the sum of these over the
//! triangles of the cavity minus the sum over the triangles from the query to the ring. So neither
//! circumcenters nor intersections of circles are needed (compare L. Liang and D. Hale, "A stable
//! and fast implementation of natural neighbor interpolation", 2010), and each cotangent is a dot
//! product over a cross product, whose relative accuracy `locate::cross` guarantees. All areas are
//! at least of the order of the largest circle times the distance to the nearest site, and so are
//! the terms at most, besides a factor of edge over distance that cancels at a site.
//!
//! # Near the hull
//!
//! Beside a hull edge one new triangle is flat: its terms are unbounded, and on the edge they are
//! infinite. Weights do not change if all areas are multiplied by the area of that triangle; then
//! its own terms are dot products, and on the edge, where all others vanish, they are linear
//! between its ends. So the limit is part of the formula, and derivatives are one-sided, from
//! inside.

use delone_predicates::Point2;

use super::cavity::Cavity;
use super::exact;
use super::kind::Kind;
use super::number::Number;
use crate::base::error::Result;
use crate::base::vector::dot;
use crate::base::watch::Pace;
use crate::locate::{certain, in_unit, plain, seen_from};

/// Squared sine of the angle below which a new triangle counts as flat.
const FLAT: f64 = 1e-6;

/// Ratio of the size of all terms to their sum above which more than nine bits are lost: about
/// 1e-13 is left. The ratio is 20 for scattered points, and some hundreds for points on lines.
const LOST: f64 = 512.0;

/// Cross products below this may have lost digits to underflow.
const LEAST: f64 = 1e-250;

/// Areas above this have squares far above the underflow range.
const SMALL: f64 = 1e-120;

/// Weights of the slots of a cavity.
#[derive(Debug)]
pub struct Weights<T> {
    /// For each slot the weight of its value.
    pub values: Vec<T>,
    /// For each slot the weights of its gradient; empty for kinds without.
    pub slopes: Vec<[T; 2]>,
    /// The vertices relative to the query, in the unit.
    relative: Vec<[T; 2]>,
    /// The triangles between the query and the ring.
    fans: Vec<Fan<T>>,
    /// The sum of the sizes of all terms; NaN if one is uncertain.
    size: f64,
}

impl<T> Default for Weights<T> {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            slopes: Vec::new(),
            relative: Vec::new(),
            fans: Vec::new(),
            size: 0.0,
        }
    }
}

/// The triangle of the query and an edge of the ring, from slot u to slot v.
#[derive(Debug, Clone, Copy)]
struct Fan<T> {
    u: usize,
    v: usize,
    /// The squared length of the edge.
    wall: f64,
    /// Twice its area.
    cross: T,
    /// Cosines times lengths at the query, at u and at v.
    at: [T; 3],
}

impl<T: Number> Weights<T> {
    /// Computes the weights of `q`; false if arithmetic gives none. Integer arithmetic counts as
    /// work.
    pub fn compute(
        &mut self,
        kind: Kind,
        cavity: &Cavity,
        q: Point2,
        pace: &mut Pace,
    ) -> Result<bool> {
        let unit = self.set_vertices(cavity, q);
        self.fan(cavity, q, unit);
        let flat = self.flattest();
        self.values.clear();
        self.values.resize(cavity.points.len(), T::constant(0.0));
        if kind == Kind::Laplace {
            self.lengths(flat);
        } else {
            self.areas(cavity, flat, unit);
        }
        self.slopes.clear();
        if !self.normalize() && !exact::weights(kind, cavity, q, unit, &mut self.values, pace)? {
            return Ok(false);
        }
        match kind {
            Kind::Sibson1 => self.blend(unit),
            Kind::Farin => self.cubic(unit),
            Kind::Sibson | Kind::Laplace => {}
        }
        if kind.is_smooth() && !self.is_finite() {
            // The tangent planes are out of range, but the values are not.
            let there = self.compute(Kind::Sibson, cavity, q, pace)?;
            self.slopes.resize(self.values.len(), [T::constant(0.0); 2]);
            return Ok(there);
        }
        if unit != 1.0 {
            self.in_units(unit);
        }
        Ok(true)
    }

    fn is_finite(&self) -> bool {
        let all = self.values.iter().chain(self.slopes.as_flattened());
        all.into_iter().all(|x| x.value().is_finite())
    }

    /// The vertices relative to the query, and the unit of length.
    fn set_vertices(&mut self, cavity: &Cavity, q: Point2) -> f64 {
        // One unit for all, that of the first triangle; the others are of similar size or larger.
        let (_, unit) = seen_from(q, [cavity.points[0], cavity.points[1], cavity.points[2]]);
        self.relative.clear();
        self.relative.extend(cavity.points.iter().map(|&p| {
            let relative = in_unit(q, p, unit);
            [
                T::linear(relative[0], [-1.0, 0.0]),
                T::linear(relative[1], [0.0, -1.0]),
            ]
        }));
        unit
    }

    /// The triangles between the query and the ring.
    fn fan(&mut self, cavity: &Cavity, q: Point2, unit: f64) {
        self.fans.clear();
        let ring = &cavity.ring;
        for (i, &u) in ring.iter().enumerate() {
            let after = if i + 1 < ring.len() { i + 1 } else { 0 };
            let (u, v) = (u as usize, ring[after] as usize);
            let (a, b) = (self.relative[u], self.relative[v]);
            let (p, r) = (cavity.points[u], cavity.points[v]);
            let edge = in_unit(p, r, unit);
            let area = if cavity.flat == Some(u as u32) {
                0.0
            } else {
                area(p, r, q, edge, values(a).map(|x| -x), unit)
            };
            let wall = edge[0] * edge[0] + edge[1] * edge[1];
            let edge = edge.map(T::constant);
            self.fans.push(Fan {
                u,
                v,
                wall,
                cross: (a[0] * edge[1] - a[1] * edge[0]).with_value(area),
                at: [dot(a, b), -dot(edge, a), dot(edge, b)],
            });
        }
    }

    /// The fan with the least angle at the query, if it is flat.
    fn flattest(&self) -> Option<usize> {
        let mut found = None;
        let mut least = FLAT;
        for (i, fan) in self.fans.iter().enumerate() {
            let (a, b) = (values(self.relative[fan.u]), values(self.relative[fan.v]));
            let lengths = (a[0] * a[0] + a[1] * a[1]) * (b[0] * b[0] + b[1] * b[1]);
            let cross = fan.cross.value();
            // A short wall has a small angle at the query, too; a fan is flat if the query is
            // between its ends.
            if cross * cross < least * lengths && fan.at[0].value() < 0.0 {
                least = cross * cross / lengths;
                found = Some(i);
            }
        }
        found
    }

    /// Laplace weights, times two.
    fn lengths(&mut self, flat: Option<usize>) {
        let scale = flat.map(|i| self.fans[i].cross);
        self.size = 0.0;
        for (i, fan) in self.fans.iter().enumerate() {
            let factor = factor(fan.cross, scale, flat == Some(i));
            self.values[fan.u] = self.values[fan.u] + fan.at[2] * factor;
            self.values[fan.v] = self.values[fan.v] + fan.at[1] * factor;
            let [_, u, v] = fan.at.map(|x| x.value().abs());
            self.size += (u + v + 2.0 * fan.cross.value()) * factor.value();
        }
    }

    /// Areas taken, times eight.
    fn areas(&mut self, cavity: &Cavity, flat: Option<usize>, unit: f64) {
        let scale = flat.map(|i| self.fans[i].cross);
        self.size = 0.0;
        for (i, fan) in self.fans.iter().enumerate() {
            let (a, b) = (self.relative[fan.u], self.relative[fan.v]);
            let (aa, bb) = (dot(a, a), dot(b, b));
            let factor = factor(fan.cross, scale, flat == Some(i));
            let (before, after) = around(fan.cross.value(), factor, T::constant(1.0));
            let [at_q, at_v, at_u] = fan.at.map(|x| x * before);
            let wall = T::constant(fan.wall) * at_q;
            let (at_u, at_v) = (aa * at_u, bb * at_v);
            self.values[fan.u] = self.values[fan.u] - (wall + at_u) * after;
            self.values[fan.v] = self.values[fan.v] - (wall + at_v) * after;
            // A cotangent errs by a rounding of 1 + its size.
            let squares = 2.0 * fan.wall + aa.value() + bb.value();
            let [wall, u, v] = [wall, at_u, at_v].map(|x| x.value().abs());
            self.size += (2.0 * wall + u + v) * after.value()
                + squares * (fan.cross.value() * factor.value());
        }
        let scaled = scale.map_or(1.0, T::value);
        for slots in &cavity.triangles {
            let (parts, size) = corner_areas(slots.map(|s| cavity.points[s as usize]), unit);
            for (&slot, part) in slots.iter().zip(parts) {
                let value = &mut self.values[slot as usize];
                *value = match scale {
                    None => *value + T::constant(part),
                    Some(scale) => *value + scale * T::constant(part),
                };
            }
            self.size += size * scaled;
        }
    }

    /// The fallback if arithmetic gave no weights: those of the first three slots.
    pub fn fall_back(&mut self, kind: Kind, corners: [f64; 3], slots: usize) {
        let zero = T::constant(0.0);
        self.values.clear();
        self.values.extend(corners.map(T::constant));
        self.values.resize(slots, zero);
        self.slopes.clear();
        if kind.is_smooth() {
            self.slopes.resize(slots, [zero; 2]);
        }
    }

    /// Divides by the sum; what is negative because of rounding becomes zero. False if the sum is
    /// uncertain or NaN.
    fn normalize(&mut self) -> bool {
        let mut sum = T::constant(0.0);
        for value in &mut self.values {
            if value.value() < 0.0 {
                *value = value.with_value(0.0);
            }
            sum = sum + *value;
        }
        let sure = sum.value() * LOST >= self.size;
        if !(sure && sum.value() > 0.0 && sum.value().is_finite()) {
            return false;
        }
        for value in &mut self.values {
            *value = *value / sum;
        }
        true
    }

    /// Sibson's C1 blend: the neighbors' tangent planes, weighted by distances, and the values,
    /// such that x^2 + y^2 is reproduced ("A brief description of natural neighbour interpolation",
    /// 1981).
    fn blend(&mut self, unit: f64) {
        let zero = T::constant(0.0);
        let distance = |p: &[T; 2]| dot(*p, *p).sqrt();
        if let Some(here) = self
            .relative
            .iter()
            .position(|p| distance(p).value() == 0.0)
        {
            // This near to a site, only its own plane counts.
            self.values.fill(zero);
            self.values[here] = T::constant(1.0);
            self.slopes.resize(self.values.len(), [zero; 2]);
            return;
        }
        let (mut over, mut times, mut squares) = (zero, zero, zero);
        for (w, p) in self.values.iter().zip(&self.relative) {
            let r = distance(p);
            over = over + *w / r;
            times = times + *w * r;
            squares = squares + *w * r * r;
        }
        let alpha = times / over;
        let sum = alpha + squares;
        for (w, p) in self.values.iter_mut().zip(&self.relative) {
            let planes = squares / sum * (*w / distance(p) / over);
            *w = alpha / sum * *w + planes;
            let factor = -planes * T::constant(unit);
            self.slopes.push([factor * p[0], factor * p[1]]);
        }
    }

    /// Farin's C1 cubic in the weights as coordinates ("Surfaces over Dirichlet tessellations",
    /// 1990), its sum over triples reduced to sums over neighbors: with S the sum of squared
    /// weights and M that of squared weights times the neighbors relative to the query, the factor
    /// of a value is w (1 - S + w), that of a gradient -w ((1 - S + w) p + M) / 2.
    fn cubic(&mut self, unit: f64) {
        let zero = T::constant(0.0);
        let (mut s, mut m) = (zero, [zero; 2]);
        for (w, p) in self.values.iter().zip(&self.relative) {
            let square = *w * *w;
            s = s + square;
            m = [m[0] + square * p[0], m[1] + square * p[1]];
        }
        let half = T::constant(-0.5 * unit);
        for (w, p) in self.values.iter_mut().zip(&self.relative) {
            let share = T::constant(1.0) - s + *w;
            let factor = half * *w;
            let slope = [0, 1].map(|k| factor * (share * p[k] + m[k]));
            self.slopes.push(slope);
            *w = *w * share;
        }
    }

    /// Converts derivatives to lengths; they were in the unit.
    fn in_units(&mut self, unit: f64) {
        for value in &mut self.values {
            *value = value.per_length(unit);
        }
        for slope in &mut self.slopes {
            *slope = slope.map(|x| x.per_length(unit));
        }
    }
}

fn values<T: Number>(p: [T; 2]) -> Point2 {
    p.map(T::value)
}

/// One over twice the area of a fan, times that of the flat one if there is one.
#[inline]
fn factor<T: Number>(cross: T, scale: Option<T>, is_flat: bool) -> T {
    match scale {
        None => T::constant(1.0) / cross,
        Some(_) if is_flat => T::constant(1.0),
        Some(scale) => scale / cross,
    }
}

/// The factor of cosines before they are multiplied by squares, and that after: usually the latter,
/// which rounds least on lattices; cotangents first if those products may underflow.
#[inline]
fn around<T>(area: f64, factor: T, one: T) -> (T, T) {
    if area > SMALL {
        (one, factor)
    } else {
        (factor, one)
    }
}

/// The cross product of the edges `op` and `or`; NaN if it is uncertain.
#[inline]
fn area(o: Point2, p: Point2, r: Point2, op: Point2, or: Point2, unit: f64) -> f64 {
    match plain(op, or) {
        Some(area) if area > LEAST => area,
        _ if unit == 1.0 => certain(o, p, r)
            .filter(|&area| area > LEAST)
            .unwrap_or(f64::NAN),
        _ => f64::NAN,
    }
}

/// Eight times the part of each corner's cell in a triangle; and the size of the terms.
#[inline]
fn corner_areas(corners: [Point2; 3], unit: f64) -> ([f64; 3], f64) {
    let [a, b, c] = corners;
    let (ab, ac, bc) = (
        in_unit(a, b, unit),
        in_unit(a, c, unit),
        in_unit(b, c, unit),
    );
    let area = area(a, b, c, ab, ac, unit);
    let (before, after) = around(area, 1.0 / area, 1.0);
    let [at_a, at_b, at_c] = [dot(ab, ac), -dot(ab, bc), dot(ac, bc)].map(|x| x * before);
    let squares = [dot(bc, bc), dot(ac, ac), dot(ab, ab)];
    let (aa, bb, cc) = (squares[0] * at_a, squares[1] * at_b, squares[2] * at_c);
    let parts = [bb + cc, aa + cc, aa + bb].map(|x| x * after);
    let size = (aa.abs() + bb.abs() + cc.abs()) * after + (squares[0] + squares[1] + squares[2]);
    (parts, 2.0 * size)
}
