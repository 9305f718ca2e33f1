//! The quality of a tetrahedron: the sines of its dihedral angles, with bounds on their rounding
//! errors.
//!
//! With the face vectors N (twice their areas, inward) and the determinant D, six times the volume,
//! the angle at the edge of length e between two faces has the sine D e / (|N| |N'|) and the cosine
//! -N N' / (|N| |N'|). The *quality* is the smallest sine, where those of obtuse angles are
//! multiplied by [`OBTUSE`]. The smallest angle of a tetrahedron is at most acos(1/3), about 70.53
//! degrees, so its sine is the smallest one of acute angles: the *acute* measure.
//!
//! # Rounding
//!
//! With L the longest edge and u = 2^-53: a difference of coordinates errs by u, relatively, a
//! component of N by 4 u of the sum of the magnitudes of its two products, so N by less than 7 u
//! L^2; D errs by less than 8 u of its six monomials, together below 3 sqrt(3) L^3, so by 42 u L^3.
//! If D is below [`FLAT`] L^3 it is recomputed in double-double arithmetic, and errs by less than
//! 30 u^2 times as much, 2^-98 L^3. A sine errs by the relative error of D, twice that of the
//! smallest N, 14 u L^2 / |N|, and some ten further roundings: [`SLACK`] (1 + L^2 / |N|) with 64 u
//! leaves room for terms of second order. If D is lost in its error, the angle is at most what the
//! largest possible D would give, and that is known as long as the vectors N are known.

use delone_predicates::arithmetic::{Pair, is_safe};
use delone_predicates::{Point3, Sign, orient3d};

pub use crate::base::vector::{cross, dot, minus};

/// The factor of the sine of an obtuse angle. With 1, the largest angles are treated first, and
/// improving them is often refused for the sake of small ones. Of 1, 1.5, 2, 2.5 and 100, on 5000
/// uniform points, 2 and 2.5 left the fewest small angles, and a much larger factor leaves large
/// ones.
pub const OBTUSE: f64 = 2.0;

/// 64 u.
const SLACK: f64 = 32.0 * f64::EPSILON;
/// Determinants below this share of L^3 are recomputed: they have lost half of their digits.
const FLAT: f64 = 1e-8;
/// The error of the recomputed determinant as a share of L^3: 2^-98.
const PRECISE: f64 = 1.0 / ((1_u128 << 98) as f64);

/// A vector.
pub type Vector = [f64; 3];

/// The sum of a vector and a multiple of another.
#[inline(always)]
pub fn plus(a: Vector, s: f64, b: Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// The numbers from which all measures are computed.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// Six times the volume, and a bound of its error.
    pub volume: f64,
    pub error: f64,
    /// Squared lengths of the edges 01, 02, 03, 12, 13, 23.
    pub edges: [f64; 6],
    /// Squared lengths of the face vectors opposite each corner.
    pub faces: [f64; 4],
    /// Cosines at the edges times the lengths of both face vectors.
    pub cosines: [f64; 6],
}

/// The two faces at each edge, by their opposite corners.
const AT_EDGE: [[usize; 2]; 6] = [[2, 3], [1, 3], [1, 2], [0, 3], [0, 2], [0, 1]];

/// The shape of a tetrahedron.
#[inline]
pub fn shape([a, b, c, d]: [Point3; 4]) -> Shape {
    let (ab, ac, ad) = (minus(b, a), minus(c, a), minus(d, a));
    let (bc, bd, cd) = (minus(c, b), minus(d, b), minus(d, c));
    let n = [cross(bd, bc), cross(ac, ad), cross(ad, ab), cross(ab, ac)];
    let cosines = AT_EDGE.map(|[i, j]| -dot(n[i], n[j]));
    let edges = [ab, ac, ad, bc, bd, cd].map(|e| dot(e, e));
    let squared = edges.iter().fold(0.0_f64, |m, &e| m.max(e));
    let cube = squared * squared.sqrt();
    let mut volume = dot(n[3], ad);
    let mut error = SLACK * cube;
    if volume.abs() < FLAT * cube && is_safe(&[a, b, c, d]) {
        volume = precise([a, b, c, d]);
        error = PRECISE * cube;
    }
    Shape {
        volume,
        error,
        edges,
        faces: n.map(|n| dot(n, n)),
        cosines,
    }
}

/// Six times the volume, in double-double arithmetic.
#[cold]
fn precise([a, b, c, d]: [Point3; 4]) -> f64 {
    let [b, c, d] = [b, c, d].map(|p| [0, 1, 2].map(|k| Pair::difference(p[k], a[k])));
    let minor = |i: usize, j: usize| c[i] * d[j] - c[j] * d[i];
    (b[0] * minor(1, 2) + b[1] * minor(2, 0) + b[2] * minor(0, 1)).hi
}

/// A bound of the rounding error of distances between the corners and faces of a tetrahedron.
pub fn rounding(shape: &Shape) -> f64 {
    let squared = shape.edges.iter().fold(0.0_f64, |m, &e| m.max(e));
    let smallest = shape.faces.iter().fold(f64::INFINITY, |m, &n| m.min(n));
    SLACK * (1.0 + squared / smallest.sqrt()) * squared.sqrt()
}

impl Shape {
    /// Squares of the smallest weighted sine of all angles, and of the smallest sine of acute
    /// angles.
    #[inline]
    fn squares(&self) -> [f64; 2] {
        let (mut least, mut acute) = (f64::INFINITY, f64::INFINITY);
        for (e, [i, j]) in AT_EDGE.into_iter().enumerate() {
            let sine = self.edges[e] / (self.faces[i] * self.faces[j]);
            if self.cosines[e] < 0.0 {
                least = least.min(sine * (OBTUSE * OBTUSE));
            } else {
                least = least.min(sine);
                acute = acute.min(sine);
            }
        }
        let volume = self.volume * self.volume;
        [least * volume, acute * volume]
    }

    /// The quality; 0 if the determinant is not positive or nothing is certain.
    #[inline]
    pub fn quality(&self) -> f64 {
        let [square, _] = self.squares();
        if self.volume > 0.0 && square < f64::INFINITY {
            square.sqrt()
        } else {
            0.0
        }
    }

    /// Bounds of the exact quality and acute measure.
    pub fn bounds(&self) -> Bounds {
        let squared = self.edges.iter().fold(0.0_f64, |m, &e| m.max(e));
        let smallest = self.faces.iter().fold(f64::INFINITY, |m, &n| m.min(n));
        let thin = squared / smallest.sqrt();
        // Whether the face vectors are known to a hundredth; false for NaN.
        let known = SLACK * thin < 1e-2;
        let off = SLACK * (1.0 + thin) + self.error / self.volume;
        if known && self.volume > 0.0 && off < 0.01 {
            let [least, acute] = self.squares().map(f64::sqrt);
            return Bounds {
                least: [least * (1.0 - off), least * (1.0 + off)],
                acute: [acute * (1.0 - off), acute * (1.0 + off)],
            };
        }
        let most = Self {
            volume: 1.1 * (self.volume.abs() + self.error),
            ..*self
        };
        if !known || most.volume < f64::MIN_POSITIVE {
            return Bounds {
                least: [0.0, OBTUSE],
                acute: [0.0, 1.0],
            };
        }
        let [least, acute] = most.squares().map(|s| s.sqrt().min(OBTUSE));
        Bounds {
            least: [0.0, least],
            acute: [0.0, acute],
        }
    }
}

/// Lower and upper bounds of the quality and the acute measure.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Bounds of the quality.
    pub least: [f64; 2],
    /// Bounds of the smallest sine of acute angles.
    pub acute: [f64; 2],
}

impl Bounds {
    /// The bounds of an empty set of tetrahedra.
    pub const NONE: Self = Self {
        least: [f64::INFINITY; 2],
        acute: [f64::INFINITY; 2],
    };

    /// The bounds of the worse of two.
    pub fn worse(self, other: Self) -> Self {
        let worse = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].min(b[1])];
        Self {
            least: worse(self.least, other.least),
            acute: worse(self.acute, other.acute),
        }
    }

    /// Whether this is certainly better than `other`, without a smaller smallest angle.
    pub fn surely_better(self, other: Self) -> bool {
        self.least[0] > other.least[1] && self.acute[0] >= other.acute[1]
    }
}

/// The quality of a tetrahedron.
#[inline]
pub fn quality(places: [Point3; 4]) -> f64 {
    shape(places).quality()
}

/// The bounds of the worst of several tetrahedra.
pub fn bounds(all: impl IntoIterator<Item = [Point3; 4]>) -> Bounds {
    all.into_iter().fold(Bounds::NONE, |worst, places| {
        worst.worse(shape(places).bounds())
    })
}

/// Whether tetrahedra are positively oriented, exactly.
pub fn are_positive(all: impl IntoIterator<Item = [Point3; 4]>) -> bool {
    all.into_iter()
        .all(|[a, b, c, d]| orient3d(a, b, c, d) == Sign::Positive)
}
