//! Facets by rounded dual points, with proven bounds.
//!
//! Let c be a point inside the hull, g*_i = q_i - c the true vectors of the vertices, G* the matrix with
//! these rows, and g_i the rounded vectors: |g_i - g*_i| <= 6 u |g_i| + s, as `sites` describes. The plane
//! of the facet is y* g* = 1, where G* y* = (1, ..., 1), and w is outside if y* g*_w > 1, because c is
//! inside.
//!
//! As in the proof of `ndim::filter`, let B be an approximate inverse, |I - G B| <= defect, where the
//! bound also covers its rounding errors, and n >= |B|. Then |I - G* B| <= e = defect + |G - G*| n, and if e < 1/2,
//! |G*^-1| <= n / (1 - e). For any vector y, |y - y*| is at most |G*^-1| times the length of
//! 1 - G* y; a component of that, computed with g_i, errs by at most (D + 3) u (sum |g_ik y_k| + 1)
//! and (6 u |g_i| + s) |y|.
//!
//! Coefficients of w with G* are l* = g*_w G*^-1, and l = g_w B differs from them by at most
//! |G*^-1| (6 u |g_w| + s) for g_w, by |g_w| |G*^-1| e for B, and by (D + 2) u |B| |g_w| for rounding,
//! where |B| < 2 |G*^-1|.
//!
//! The value y g_w - 1 errs by |y - y*| |g*_w| + |y| (6 u |g_w| + s) because y and g_w are not exact, and
//! by (D + 2) u |y| |g_w| + u because of rounding: at most q0 + q1 |g_w| with
//! q1 = |y - y*| + (D + 10) u |y| and q0 = s (|y| + |y - y*|) + 2 u.

use super::sites::Sites;
use crate::ndim::filter::{LEAST_RESIDUAL, LEAST_VALUE, Matrix, ROUNDED, U, dot, invert_small};

/// The vertices of a facet as seen from c, and an approximate inverse.
struct Seen<const D: usize, const P: usize> {
    g: Matrix<D, P>,
    b: Matrix<D, P>,
    /// Bounds on |I - G* B| and |G*^-1|.
    defect: f64,
    norm: f64,
}

impl<const D: usize, const P: usize> Seen<D, P> {
    /// `None` if no bound can be proven.
    #[inline(always)]
    fn new<const V: usize>(sites: &Sites<'_, D, V, P>, vertices: &[u32; D]) -> Option<Self> {
        let g: Matrix<D, P> = vertices.map(|v| sites.seen[v as usize]);
        let all: f64 = vertices.iter().map(|&v| sites.reach[v as usize]).sum();
        let inverse = invert_small(&g);
        let apart = ROUNDED * (6.0 * U * all + D as f64 * sites.slack);
        let defect = ROUNDED * (inverse.defect + apart * inverse.norm);
        // A comparison that NaN fails.
        (defect < 0.5).then(|| Self {
            g,
            b: inverse.b,
            defect,
            norm: ROUNDED * inverse.norm / (1.0 - defect),
        })
    }
}

/// Coefficients of points with respect to the vertices of a facet.
pub struct Shares<const D: usize, const P: usize> {
    b: Matrix<D, P>,
    q0: f64,
    q1: f64,
}

impl<const D: usize, const P: usize> Shares<D, P> {
    pub fn new<const V: usize>(sites: &Sites<'_, D, V, P>, vertices: &[u32; D]) -> Option<Self> {
        let Seen {
            b, defect, norm, ..
        } = Seen::new(sites, vertices)?;
        let q1 = ROUNDED * norm * (defect + (2 * D + 16) as f64 * U);
        let q0 = ROUNDED * norm * sites.slack + LEAST_VALUE;
        Some(Self { b, q0, q1 })
    }

    /// A coefficient, and the bound on its error.
    pub fn value<const V: usize>(
        &self,
        sites: &Sites<'_, D, V, P>,
        i: usize,
        w: u32,
    ) -> (f64, f64) {
        let g = &sites.seen[w as usize];
        let sum = (0..D).map(|k| g[k] * self.b[k][i]).sum();
        (sum, self.q0 + self.q1 * sites.reach[w as usize])
    }
}

/// The rounded test of points: outside if y g > 1, with certainty if the difference is greater than
/// q0 + q1 |g|.
#[derive(Clone, Copy)]
pub struct Plane<const D: usize> {
    pub y: [f64; D],
    pub q0: f64,
    pub q1: f64,
}

impl<const D: usize> Plane<D> {
    /// A plane that decides nothing.
    pub const UNKNOWN: Self = Self {
        y: [0.0; D],
        q0: f64::INFINITY,
        q1: 0.0,
    };

    /// The plane through sites.
    #[inline(always)]
    pub fn new<const V: usize, const P: usize>(
        sites: &Sites<'_, D, V, P>,
        vertices: &[u32; D],
    ) -> Self {
        let Some(Seen { g, b, norm, .. }) = Seen::new(sites, vertices) else {
            return Self::UNKNOWN;
        };
        let reach = vertices.map(|v| sites.reach[v as usize]);
        let mut y = [0.0; P];
        for k in 0..D {
            y[k] = b[k][..D].iter().sum();
        }
        // One step of refinement, because inverses by cofactors are less accurate.
        let r: [f64; D] = std::array::from_fn(|i| 1.0 - dot(&g[i], &y));
        for k in 0..D {
            y[k] += (0..D).map(|i| b[k][i] * r[i]).sum::<f64>();
        }
        let size = ROUNDED * dot(&y, &y).sqrt();
        let mut squares = 0.0;
        for i in 0..D {
            let (mut sum, mut magnitude) = (1.0, 1.0);
            for k in 0..D {
                let product = g[i][k] * y[k];
                sum -= product;
                magnitude += product.abs();
            }
            let rounding =
                (D + 4) as f64 * U * magnitude + (6.0 * U * reach[i] + sites.slack) * size;
            let residual: f64 = sum.abs() + ROUNDED * rounding + LEAST_RESIDUAL;
            squares += residual * residual;
        }
        let error = ROUNDED * norm * squares.sqrt();
        let q1 = ROUNDED * (error + (D + 10) as f64 * U * size);
        let q0 = ROUNDED * sites.slack * (size + error) + 3.0 * U + LEAST_VALUE;
        if q0.is_finite() && q1.is_finite() {
            Self {
                y: std::array::from_fn(|k| y[k]),
                q0,
                q1,
            }
        } else {
            Self::UNKNOWN
        }
    }

    /// The value of a site, positive outside, and the bound on its error.
    #[inline(always)]
    pub fn value<const V: usize, const P: usize>(
        &self,
        sites: &Sites<'_, D, V, P>,
        w: u32,
    ) -> (f64, f64) {
        let g = &sites.seen[w as usize];
        let mut sum = -1.0;
        for k in 0..D {
            sum += self.y[k] * g[k];
        }
        (sum, self.q0 + self.q1 * sites.reach[w as usize])
    }
}
