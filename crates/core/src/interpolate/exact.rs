//! Natural neighbour weights where doubles do not tell them: the formula of `weights` in integers.
//!
//! All coordinates are multiples of a power of two; in that unit the query has a distance of at
//! least 1 from every site. Each term is a quotient of integers, taken in fixed point with `DIGITS`
//! binary places. Terms cancel, but their sum does not vanish: the cell of the query has the circle
//! of half the least distance inside, so eight times its area is at least 6, and the Laplace weights
//! sum to about 1/2 at least, as the wall that is nearest or those that cut it short have that length over
//! their distances. So nearly all of the digits are left, whatever the sites are.

use delone_predicates::Point2;
use delone_predicates::arithmetic::decode_odd;
use num_bigint::{BigInt, Sign};

use super::cavity::Cavity;
use super::kind::Kind;
use super::number::Number;
use crate::error::Result;
use crate::watch::Pace;
use crate::wide::{lowest, ratio, scaled};

/// Binary places of a term.
const DIGITS: usize = 160;

/// Triangles of a cavity whose search takes about as long as one term here: 4 us and more.
const TERM: usize = 40;

/// An integer that depends on the place of the query; by it the derivatives x, y, xx, xy and yy,
/// where they are asked for.
#[derive(Debug, Clone)]
struct Jets(Vec<BigInt>);

/// For each second derivative the first ones, among the parts of a number.
const SECOND: [(usize, usize); 3] = [(1, 1), (1, 2), (2, 2)];

impl Jets {
    fn constant(value: BigInt, parts: usize) -> Self {
        let mut all = vec![BigInt::ZERO; parts];
        all[0] = value;
        Self(all)
    }

    /// A coordinate of a site as seen from the query.
    fn seen(value: BigInt, axis: usize, parts: usize) -> Self {
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

    /// The parts of the quotient of two, each as numerator and denominator.
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

    /// The quotient of two in fixed point.
    fn quotient(&self, other: &Self) -> Self {
        let parts = self.over(other).into_iter();
        Self(parts.map(|(n, d)| (n << DIGITS) / d).collect())
    }
}

/// What the terms are made of.
struct Terms {
    /// Sites as seen from the query.
    seen: Vec<[Jets; 2]>,
    /// The flat triangle's area, by which all is multiplied.
    scale: Option<Jets>,
    /// Sums, by slot.
    sums: Vec<Jets>,
}

/// The weights of the slots of a cavity for `q`, derivatives by lengths in `unit`; false where there
/// are none: the triangles are no Delaunay triangles then.
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
    let seen =
        |p: &Point2| [0, 1].map(|k| Jets::seen(scaled(p[k], low) - scaled(q[k], low), k, T::PARTS));
    let mut terms = Terms {
        seen: cavity.points.iter().map(seen).collect(),
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
    /// The way from one slot to another, which does not depend on the query.
    fn way(&self, from: usize, to: usize) -> [Jets; 2] {
        [0, 1].map(|k| self.seen[to][k].minus(&self.seen[from][k]))
    }

    /// Adds the triangles from the query to the ring.
    fn add_fans(&mut self, kind: Kind, cavity: &Cavity, pace: &mut Pace) -> Result<bool> {
        let ring = &cavity.ring;
        let ends = |i: usize| (ring[i] as usize, ring[(i + 1) % ring.len()] as usize);
        let crosses: Vec<Jets> = (0..ring.len())
            .map(|i| {
                let (u, v) = ends(i);
                cross(&self.seen[u], &self.way(u, v))
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
            let (a, b, edge) = (&self.seen[u], &self.seen[v], self.way(u, v));
            let (mut at_u, mut at_v) = (dot(&edge, b), dot(&self.way(v, u), a));
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

    /// Adds the parts of the cells of its corners in a triangle of the cavity.
    fn add_triangle(&mut self, slots: [usize; 3]) -> bool {
        let ways: [_; 3] =
            std::array::from_fn(|k| self.way(slots[(k + 1) % 3], slots[(k + 2) % 3]));
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

    /// Adds to a slot what is over `area`, or that of the flat triangle, which cancels then.
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
