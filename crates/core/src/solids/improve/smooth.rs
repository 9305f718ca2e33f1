//! Smoothing: moves a vertex to where the worst tetrahedron around it is best.
//!
//! Maximizes the minimum of many smooth functions along the shortest vector in the convex hull of
//! the gradients of the smallest ones: L. A. Freitag and C. Ollivier-Gooch, "Tetrahedral mesh
//! improvement using swapping and smoothing", International Journal for Numerical Methods in
//! Engineering 40 (1997). That vector is found by the distance algorithm of E. G. Gilbert, D. W.
//! Johnson and S. S. Keerthi (1988). The step length is where, to first order, another function
//! becomes the smallest. It ends after at most [`STEPS`] steps, each of which gains.

use std::cmp::Ordering;

use delone_predicates::Point3;

use super::measure::{OBTUSE, Vector, cross, dot, minus, plus};
use super::slide::Slide;

/// The most steps of one ascent; more are rarely needed, and the vertex is tried again in the next
/// pass.
const STEPS: usize = 8;
/// How often a step is halved.
const HALVINGS: usize = 5;
/// A step with a smaller relative gain ends the ascent.
const GAIN: f64 = 1e-3;
/// Functions within this share of the smallest count as smallest.
const ACTIVE: f64 = 0.03;
/// Functions more than this many times as large as the smallest are ignored in a step.
const FAR: f64 = 4.0;
/// Iterations of the search for the shortest vector, far more than it needs.
const TURNS: usize = 24;

/// A tetrahedron relative to its moving vertex: the opposite face, with the vertex on its positive
/// side.
#[derive(Debug, Clone, Copy)]
struct Cone {
    /// The corners of the face.
    corners: [Point3; 3],
    /// The face vector, toward the vertex.
    base: Vector,
    /// Its length.
    area: f64,
    /// The lengths of the edges opposite each corner.
    lengths: [f64; 3],
}

/// A sine and its gradient.
#[derive(Debug, Clone, Copy)]
struct Slope {
    value: f64,
    gradient: Vector,
}

/// The tetrahedra around a vertex.
#[derive(Debug, Default)]
pub struct Star {
    cones: Vec<Cone>,
    slopes: Vec<Slope>,
    active: Vec<Vector>,
}

impl Cone {
    fn new(corners: [Point3; 3]) -> Self {
        let [p, q, r] = corners;
        let base = cross(minus(q, p), minus(r, p));
        let length = |a: Point3, b| {
            let e = minus(a, b);
            dot(e, e).sqrt()
        };
        Self {
            corners,
            base,
            area: dot(base, base).sqrt(),
            lengths: [length(r, q), length(p, r), length(q, p)],
        }
    }

    /// Edges to the corners, six times the volume, and the face vectors opposite each corner,
    /// toward it.
    #[inline(always)]
    fn around(&self, x: Point3) -> ([Vector; 3], f64, [Vector; 3]) {
        let [p, q, r] = self.corners.map(|c| minus(c, x));
        (
            [p, q, r],
            -dot(self.base, p),
            // The faces of x and two corners, with the third on the positive side.
            [cross(r, q), cross(p, r), cross(q, p)],
        )
    }

    /// The quality with the vertex at `x`.
    #[inline]
    fn quality(&self, x: Point3) -> f64 {
        let (to, volume, sides) = self.around(x);
        if volume <= 0.0 {
            return 0.0;
        }
        let squares = sides.map(|n| dot(n, n));
        let base = self.area * self.area;
        let mut least = f64::INFINITY;
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let upper = dot(to[k], to[k]) / (squares[i] * squares[j]);
            let obtuse = dot(sides[i], sides[j]) > 0.0;
            least = least.min(if obtuse {
                OBTUSE * OBTUSE * upper
            } else {
                upper
            });
            let lower = self.lengths[k] * self.lengths[k] / (base * squares[k]);
            let obtuse = dot(self.base, sides[k]) > 0.0;
            least = least.min(if obtuse {
                OBTUSE * OBTUSE * lower
            } else {
                lower
            });
        }
        volume * least.sqrt()
    }

    /// All sines below a bound, with their gradients.
    fn slopes(&self, x: Point3, bound: f64, out: &mut Vec<Slope>) {
        let (to, volume, sides) = self.around(x);
        let lengths = sides.map(|n| dot(n, n).sqrt());
        // The gradient of the logarithm of a side vector's length is across its edge on the base.
        let growth: [Vector; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let edge = minus(self.corners[j], self.corners[i]);
            let along = cross(edge, sides[k]);
            along.map(|c| c / (lengths[k] * lengths[k]))
        });
        let rise = self.base.map(|c| c / volume);
        let weight = |obtuse| if obtuse { OBTUSE } else { 1.0 };
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let squared = dot(to[k], to[k]);
            let upper = volume * squared.sqrt() / (lengths[i] * lengths[j])
                * weight(dot(sides[i], sides[j]) > 0.0);
            if upper < bound {
                let slope = plus(rise, -1.0 / squared, to[k]);
                let slope = plus(plus(slope, -1.0, growth[i]), -1.0, growth[j]);
                out.push(Slope::new(upper, slope));
            }
            let lower = volume * self.lengths[k] / (self.area * lengths[k])
                * weight(dot(self.base, sides[k]) > 0.0);
            if lower < bound {
                out.push(Slope::new(lower, plus(rise, -1.0, growth[k])));
            }
        }
    }
}

impl Slope {
    /// Builds it from the gradient of the logarithm.
    fn new(value: f64, relative: Vector) -> Self {
        Self {
            value,
            gradient: relative.map(|c| c * value),
        }
    }
}

impl Star {
    /// Removes all tetrahedra.
    pub fn clear(&mut self) {
        self.cones.clear();
    }

    /// Adds the tetrahedron of the vertex and a face that has the vertex on its positive side.
    pub fn push(&mut self, face: [Point3; 3]) {
        self.cones.push(Cone::new(face));
    }

    /// The worst quality with the vertex at `x`; not meaningful below `above`.
    pub fn worst(&mut self, x: Point3, above: f64) -> f64 {
        let mut worst = f64::INFINITY;
        for i in 0..self.cones.len() {
            worst = worst.min(self.cones[i].quality(x));
            if worst <= above {
                // The cone that stopped this step is likely to stop the next one.
                self.cones.swap(0, i);
                break;
            }
        }
        worst
    }

    /// Ascends from `x`, along a facet or an edge if given; if that gains, returns the new position and its
    /// worst quality.
    pub fn climb(&mut self, x: Point3, slide: Option<&Slide>) -> Option<(Point3, f64)> {
        self.ascend(x, STEPS, slide)
    }

    /// As `climb`, with another limit on the number of steps.
    pub fn ascend(
        &mut self,
        mut x: Point3,
        steps: usize,
        slide: Option<&Slide>,
    ) -> Option<(Point3, f64)> {
        let mut value = self.worst(x, 0.0);
        let start = value;
        // So flat that its gradients are noise: left to edge and face removal.
        if start <= 0.0 {
            return None;
        }
        for _ in 0..steps {
            let Some((next, better)) = self.step(x, value, slide) else {
                break;
            };
            let gained = better > value * (1.0 + GAIN);
            (x, value) = (next, better);
            if !gained {
                break;
            }
        }
        (value > start).then_some((x, value))
    }

    /// One step with a gain.
    fn step(&mut self, x: Point3, value: f64, slide: Option<&Slide>) -> Option<(Point3, f64)> {
        self.slopes.clear();
        for cone in &self.cones {
            cone.slopes(x, FAR * value, &mut self.slopes);
        }
        let least = self
            .slopes
            .iter()
            .fold(f64::INFINITY, |m, s| m.min(s.value));
        let limit = least * (1.0 + ACTIVE);
        let active = self.slopes.iter().filter(|s| s.value <= limit);
        self.active.clear();
        let along = |v: Vector| slide.map_or(v, |slide| slide.along(v));
        self.active.extend(active.map(|s| along(s.gradient)));
        let direction = shortest(&self.active)?;
        let squared = dot(direction, direction);
        // Far enough to double the worst, unless another becomes the worst before.
        let mut length = least / squared;
        for slope in self.slopes.iter().filter(|s| s.value > limit) {
            let slower = squared - dot(slope.gradient, direction);
            if slower > 0.0 {
                length = length.min((slope.value - least) / slower);
            }
        }
        for _ in 0..HALVINGS {
            let next = plus(x, length, direction);
            let worst = self.worst(next, value);
            if worst > value {
                return Some((next, worst));
            }
            length *= 0.5;
        }
        None
    }
}

/// The vector with the least component along `direction`.
fn least_along(vectors: &[Vector], direction: Vector) -> Option<Vector> {
    let mut all = vectors.iter().map(|&v| (dot(v, direction), v));
    let first = all.next()?;
    let least = all.fold(first, |least, v| if v.0 < least.0 { v } else { least });
    Some(least.1)
}

/// The shortest vector of the convex hull of vectors; `None` if it is zero, or none is given.
fn shortest(vectors: &[Vector]) -> Option<Vector> {
    let largest = vectors.iter().fold(0.0_f64, |m, &v| m.max(dot(v, v)));
    let mut found = Simplex::of(*vectors.first()?);
    // Each iteration shortens the vector.
    for _ in 0..TURNS {
        let v = found.vector;
        let squared = dot(v, v);
        if squared.partial_cmp(&(1e-12 * largest)) != Some(Ordering::Greater) {
            return None;
        }
        let next = least_along(vectors, v)?;
        if dot(next, v) >= squared * (1.0 - 1e-3) {
            break;
        }
        let nearer = found.with(next);
        if dot(nearer.vector, nearer.vector) >= squared {
            break;
        }
        found = nearer;
    }
    Some(found.vector)
}

/// Up to four vectors, and the shortest one of their convex hull.
#[derive(Debug, Clone, Copy)]
struct Simplex {
    corners: [Vector; 4],
    count: usize,
    vector: Vector,
}

impl Simplex {
    fn of(vector: Vector) -> Self {
        Self {
            corners: [vector; 4],
            count: 1,
            vector,
        }
    }

    /// The subset that contains the shortest vector, after adding another one.
    fn with(mut self, next: Vector) -> Self {
        // At most three are kept: a full simplex contains zero, which ended the search.
        let place = self.count.min(3);
        self.corners[place] = next;
        let count = place + 1;
        let mut best = Self::of(next);
        for mask in 1_usize..1 << count {
            let mut part = Self { count: 0, ..self };
            for k in (0..count).filter(|k| mask >> k & 1 == 1) {
                part.corners[part.count] = self.corners[k];
                part.count += 1;
            }
            let Some(vector) = foot(&part.corners[..part.count]) else {
                continue;
            };
            if dot(vector, vector) < dot(best.vector, best.vector) {
                best = Self { vector, ..part };
            }
        }
        best
    }
}

/// The shortest vector of the affine hull of up to four vectors, if it lies in their convex hull.
fn foot(v: &[Vector]) -> Option<Vector> {
    match *v {
        [a] => Some(a),
        [a, b] => {
            let ab = minus(b, a);
            let s = -dot(a, ab) / dot(ab, ab);
            (s > 0.0 && s < 1.0).then(|| plus(a, s, ab))
        }
        [a, b, c] => {
            let (ab, ac) = (minus(b, a), minus(c, a));
            let (bb, bc, cc) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
            let (ba, ca) = (-dot(a, ab), -dot(a, ac));
            let det = bb * cc - bc * bc;
            let (s, t) = ((ba * cc - ca * bc) / det, (ca * bb - ba * bc) / det);
            (s > 0.0 && t > 0.0 && s + t < 1.0).then(|| plus(plus(a, s, ab), t, ac))
        }
        [a, b, c, d] => {
            // Zero is inside a tetrahedron.
            let side = |p: Point3, q, r, s| {
                let n = cross(minus(q, p), minus(r, p));
                (-dot(n, p) > 0.0) == (dot(n, minus(s, p)) > 0.0)
            };
            (side(a, b, c, d) && side(b, c, d, a) && side(c, d, a, b) && side(d, a, b, c))
                .then_some([0.0; 3])
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_vector_of_a_hull() {
        let close = |v: &[Vector], w: Vector| {
            let found = shortest(v).unwrap();
            let off = minus(found, w);
            assert!(dot(off, off) < 1e-6 * dot(w, w), "{found:?} {w:?}");
        };
        close(&[[3.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [2.0, 0.0, 0.0]);
        close(&[[1.0, 1.0, 0.0], [1.0, -1.0, 0.0]], [1.0, 0.0, 0.0]);
        let triangle = [
            [2.0, 1.0, 1.0],
            [2.0, -1.0, 1.0],
            [2.0, 0.0, -2.0],
            [5.0, 0.0, 0.0],
        ];
        close(&triangle, [2.0, 0.0, 0.0]);
        let around = [
            [1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [1.0, -1.0, -1.0],
        ];
        assert!(shortest(&around).is_none());
        assert!(shortest(&[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]).is_none());
        assert!(shortest(&[]).is_none());
    }

    #[test]
    fn gradients_are_those_of_the_sines() {
        let cone = Cone::new([[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 0.9, 0.1]]);
        let x = [0.3, 0.2, 0.7];
        let mut here = Vec::new();
        cone.slopes(x, f64::INFINITY, &mut here);
        assert_eq!(here.len(), 6);
        for axis in 0..3 {
            let step = 1e-6;
            let ends = [-step, step].map(|s| {
                let (mut y, mut out) = (x, Vec::new());
                y[axis] += s;
                cone.slopes(y, f64::INFINITY, &mut out);
                out
            });
            for (k, slope) in here.iter().enumerate() {
                let rise = (ends[1][k].value - ends[0][k].value) / (2.0 * step);
                assert!((rise - slope.gradient[axis]).abs() < 1e-6, "{k} {axis}");
            }
        }
        let least = here.iter().fold(f64::INFINITY, |m, s| m.min(s.value));
        assert!((least - cone.quality(x)).abs() < 1e-12);
    }

    #[test]
    fn a_vertex_climbs_to_the_middle() {
        // An octahedron: with its center all angles are 90 degrees or those of the outside.
        let mut star = Star::default();
        for [x, y, z] in [
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, 1.0],
        ] {
            for z in [z, -z] {
                let (p, q, r) = ([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]);
                let positive = x * y * z < 0.0;
                star.push(if positive { [p, q, r] } else { [p, r, q] });
            }
        }
        let (place, worst) = star.climb([0.4, 0.2, -0.1], None).unwrap();
        assert!(dot(place, place) < 0.02, "{place:?}");
        assert!(worst > 0.75);
    }
}
