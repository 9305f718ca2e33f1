//! Exact natural neighbor weights in integers, for queries where doubles are not certain.
//!
//! All coordinates are multiples of a power of two; in that unit the query has a distance of at
//! least 1 from every site. Each term is a quotient of integers, computed in fixed point with
//! `DIGITS` binary places. Terms cancel, but their sum does not vanish: the cell of the query
//! contains the circle of half the least distance, so eight times its area is at least 6. The
//! Laplace weights sum to at least about 1/2, as the nearest wall, or those that cut it short, have
//! that length relative to their distances. So nearly all of the digits are left, for any sites.

use delone_predicates::Point2;
use delone_predicates::arithmetic::decode_odd;
use num_bigint::{BigInt, Sign};

use super::cavity::Cavity;
use super::kind::Kind;
use super::number::Number;
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::base::wide::{lowest, ratio, scaled};

/// Binary places of a term.
const DIGITS: usize = 160;

/// Triangles of a cavity whose search takes about as long as one term here: at least 4 us.
const TERM: usize = 40;

/// An integer that depends on the position of the query, followed by its derivatives x, y, xx, xy
/// and yy if they are requested.
#[derive(Debug, Clone)]
struct Jets(Vec<BigInt>);

/// For each second derivative, the first derivatives it is made of, as indices of parts.
const SECOND: [(usize, usize); 3] = [(1, 1), (1, 2), (2, 2)];

impl Jets {
    fn constant(value: BigInt, parts: usize) -> Self {
        let mut all = vec![BigInt::ZERO; parts];
        all[0] = value;
        Self(all)
    }

    /// A coordinate of a site relative to the query.
    fn relative(value: BigInt, axis: usize, parts: usize) -> Self {
        let mut all = Self::constant(value, parts);
        if parts > 1 {
            all.0[1 + axis] = BigInt::from(-1);
        }
        all
    }

    fn value(&self) -> &BigInt {
        &self.0[0]
    }

    fn plus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a + b).collect())
    }

    fn minus(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a - b).collect())
    }

    fn times(&self, other: &Self) -> Self {
        let (a, b) = (&self.0, &other.0);
        let mut all = vec![&a[0] * &b[0]];
        if a.len() > 1 {
            all.extend([1, 2].map(|k| &a[0] * &b[k] + &a[k] * &b[0]));
            all.extend([3, 4, 5].map(|i| {
                let (k, l) = SECOND[i - 3];
                &a[0] * &b[i] + &a[i] * &b[0] + &a[k] * &b[l] + &a[l] * &b[k]
            }));
        }
        Self(all)
    }

    /// The parts of a quotient, each as numerator and denominator.
    fn over(&self, other: &Self) -> Vec<(BigInt, BigInt)> {
        let (n, d) = (&self.0, &other.0);
        let mut all = vec![(n[0].clone(), d[0].clone())];
        if n.len() > 1 {
            let square = &d[0] * &d[0];
            let first = [1, 2].map(|k| &n[k] * &d[0] - &n[0] * &d[k]);
            for i in 3..6 {
                let (k, l) = SECOND[i - 3];
                let straight = (&n[i] * &d[0] - &n[0] * &d[i]) * &d[0];
                let bent = &first[k - 1] * &d[l] + &first[l - 1] * &d[k];
                all.push((straight - bent, &square * &d[0]));
            }
            all.splice(1..1, first.map(|x| (x, square.clone())));
        }
        all
    }

    /// A quotient in fixed point.
    fn quotient(&self, other: &Self) -> Self {
        let parts = self.over(other).into_iter();
        Self(parts.map(|(n, d)| (n << DIGITS) / d).collect())
    }
}

/// The quantities of which the terms are made.
struct Terms {
    /// Sites relative to the query.
    relative: Vec<[Jets; 2]>,
    /// The area of the degenerate triangle, by which everything is multiplied.
    scale: Option<Jets>,
    /// The sums, by slot.
    sums: Vec<Jets>,
}

/// The weights of the slots of a cavity for `q`, with derivatives per length in `unit`; false if
/// there are none: then the triangles are not Delaunay.
#[cold]
#[inline(never)]
pub fn weights<T: Number>(
    kind: Kind,
    cavity: &Cavity,
    q: Point2,
    unit: f64,
    values: &mut Vec<T>,
    pace: &mut Pace,
) -> Result<bool> {
    let mut all = cavity.points.clone();
    all.push(q);
    let low = lowest(&all, &[]);
    let relative = |p: &Point2| {
        [0, 1].map(|k| Jets::relative(scaled(p[k], low) - scaled(q[k], low), k, T::PARTS))
    };
    let mut terms = Terms {
        relative: cavity.points.iter().map(relative).collect(),
        scale: None,
        sums: vec![Jets::constant(BigInt::ZERO, T::PARTS); cavity.points.len()],
    };
    if !terms.add_fans(kind, cavity, pace)? {
        return Ok(false);
    }
    if kind != Kind::Laplace {
        for slots in &cavity.triangles {
            pace.spend(3 * TERM)?;
            if !terms.add_triangle(slots.map(|s| s as usize)) {
                return Ok(false);
            }
        }
    }
    let zero = Jets::constant(BigInt::ZERO, T::PARTS);
    let sum = terms.sums.iter().fold(zero, |sum, x| sum.plus(x));
    if sum.value().sign() != Sign::Plus {
        return Ok(false);
    }
    let step = i64::from(decode_odd(unit).1) - low;
    values.clear();
    for part in &terms.sums {
        pace.spend(TERM)?;
        let parts = part.over(&sum).into_iter().zip([0, 1, 1, 2, 2, 2]);
        let parts = parts.map(|((n, d), order)| ratio(&n, &d, order * step));
        let parts: Vec<f64> = parts.map(|x| x.unwrap_or(f64::INFINITY)).collect();
        values.push(T::of_parts(&parts));
    }
    Ok(true)
}

fn dot(a: &[Jets; 2], b: &[Jets; 2]) -> Jets {
    a[0].times(&b[0]).plus(&a[1].times(&b[1]))
}

fn cross(a: &[Jets; 2], b: &[Jets; 2]) -> Jets {
    a[0].times(&b[1]).minus(&a[1].times(&b[0]))
}

impl Terms {
    /// The vector from one slot to another, which is independent of the query.
    fn vector(&self, from: usize, to: usize) -> [Jets; 2] {
        [0, 1].map(|k| self.relative[to][k].minus(&self.relative[from][k]))
    }

    /// Adds the triangles between the query and the ring.
    fn add_fans(&mut self, kind: Kind, cavity: &Cavity, pace: &mut Pace) -> Result<bool> {
        let ring = &cavity.ring;
        let ends = |i: usize| (ring[i] as usize, ring[(i + 1) % ring.len()] as usize);
        let crosses: Vec<Jets> = (0..ring.len())
            .map(|i| {
                let (u, v) = ends(i);
                cross(&self.relative[u], &self.vector(u, v))
            })
            .collect();
        let is_flat = |x: &Jets| x.value().sign() == Sign::NoSign;
        let flat = crosses.iter().position(is_flat);
        if crosses.iter().filter(|x| is_flat(x)).count() > 1 {
            return Ok(false);
        }
        self.scale = flat.map(|i| crosses[i].clone());
        for (i, area) in crosses.iter().enumerate() {
            pace.spend(2 * TERM)?;
            let (u, v) = ends(i);
            let (a, b, edge) = (&self.relative[u], &self.relative[v], self.vector(u, v));
            let (mut at_u, mut at_v) = (dot(&edge, b), dot(&self.vector(v, u), a));
            if kind != Kind::Laplace {
                let wall = dot(&edge, &edge).times(&dot(a, b));
                let zero = wall.minus(&wall);
                at_u = zero.minus(&wall.plus(&dot(a, a).times(&at_u)));
                at_v = zero.minus(&wall.plus(&dot(b, b).times(&at_v)));
            }
            let own = flat == Some(i);
            self.add(u, &at_u, if own { None } else { Some(area) });
            self.add(v, &at_v, if own { None } else { Some(area) });
        }
        Ok(true)
    }

    /// Adds the parts of the corners' cells in a triangle of the cavity.
    fn add_triangle(&mut self, slots: [usize; 3]) -> bool {
        let ways: [_; 3] =
            std::array::from_fn(|k| self.vector(slots[(k + 1) % 3], slots[(k + 2) % 3]));
        let area = cross(&ways[2], &ways[0]);
        if area.value().sign() != Sign::Plus {
            return false;
        }
        let at: [_; 3] = std::array::from_fn(|k| {
            let cosine = dot(&ways[(k + 1) % 3], &ways[(k + 2) % 3]);
            let zero = cosine.minus(&cosine);
            dot(&ways[k], &ways[k]).times(&zero.minus(&cosine))
        });
        for k in 0..3 {
            self.add(
                slots[k],
                &at[(k + 1) % 3].plus(&at[(k + 2) % 3]),
                Some(&area),
            );
        }
        true
    }

    /// Adds to a slot a term over `area`, or over that of the degenerate triangle, which then
    /// cancels.
    fn add(&mut self, slot: usize, part: &Jets, area: Option<&Jets>) {
        let one = Jets::constant(BigInt::from(1), part.0.len());
        let term = match (area, &self.scale) {
            (None, _) => part.quotient(&one),
            (Some(area), None) => part.quotient(area),
            (Some(area), Some(scale)) => part.times(scale).quotient(area),
        };
        self.sums[slot] = self.sums[slot].plus(&term);
    }
}
