//! Whether a determinant of integers is zero, given a proven bound on its magnitude.
//!
//! It is zero if it vanishes modulo primes whose product exceeds the bound: the product divides it
//! then. H. Brönnimann, I. Z. Emiris, V. Y. Pan, S. Pion, "Sign determination in residue number
//! systems" (1999).

use std::sync::OnceLock;

/// Each prime exceeds 2^61.
const BITS: u32 = 61;

/// The most primes that are tried: integers are faster than more.
const MOST: usize = 40;

/// Differences of at most this many bits go to integers at once: they are machine integers, and
/// faster than residues.
pub const FEW_BITS: u32 = 24;

/// The most rows of a determinant: those of a simplex in 8-D and a point.
pub const ROWS: usize = 9;

/// A prime between 2^61 and 2^62, and what Montgomery's multiplication needs.
#[derive(Clone, Copy)]
pub struct Prime {
    p: u64,
    /// Minus the inverse of p modulo 2^64.
    inverse: u64,
    /// 2^128 modulo p.
    square: u64,
}

impl Prime {
    fn new(p: u64) -> Self {
        let mut inverse = 1u64;
        // Newton's method doubles the right bits: 1, 2, 4, ..., 64.
        for _ in 0..6 {
            inverse = inverse.wrapping_mul(2u64.wrapping_sub(p.wrapping_mul(inverse)));
        }
        let r = (1u128 << 64) % u128::from(p);
        Self {
            p,
            inverse: inverse.wrapping_neg(),
            square: (r * r % u128::from(p)) as u64,
        }
    }

    /// `a b / 2^64` modulo p.
    #[inline(always)]
    fn mul(self, a: u64, b: u64) -> u64 {
        let t = u128::from(a) * u128::from(b);
        let m = (t as u64).wrapping_mul(self.inverse);
        // Both products are below 2^126: no overflow.
        let r = ((t + u128::from(m) * u128::from(self.p)) >> 64) as u64;
        if r >= self.p { r - self.p } else { r }
    }

    #[inline(always)]
    fn sub(self, a: u64, b: u64) -> u64 {
        if a >= b { a - b } else { a + self.p - b }
    }

    #[inline(always)]
    fn add(self, a: u64, b: u64) -> u64 {
        let s = a + b;
        if s >= self.p { s - self.p } else { s }
    }

    /// `x 2^64` modulo p.
    fn integer(self, x: i64) -> u64 {
        let m = self.mul(x.unsigned_abs() % self.p, self.square);
        self.sub(0, m) * u64::from(x < 0) + m * u64::from(x >= 0)
    }

    /// `2^64 2^shift` modulo p.
    fn power(self, shift: u32) -> u64 {
        let (mut base, mut power) = (self.integer(2), self.integer(1));
        let mut left = shift;
        while left > 0 {
            if left & 1 == 1 {
                power = self.mul(power, base);
            }
            base = self.mul(base, base);
            left >>= 1;
        }
        power
    }
}

/// An integer: odd part with its sign, and power of two.
pub type Coordinate = (i64, u32);

/// A matrix of points in rows as integers from any origin; the first is subtracted from the others.
pub struct Points {
    /// The coordinates of each, and in a flat those that its axes leave out.
    pub rows: [[Coordinate; ROWS - 1]; ROWS + 1],
    /// Their weights, in squared units.
    pub weights: [Coordinate; ROWS + 1],
    /// The number of points.
    pub count: usize,
    /// The number of coordinates.
    pub dimension: usize,
    /// The number of those that count for lengths.
    pub squares: usize,
}

/// Whether the determinant of the points from the first is zero, if its magnitude is below 2^bits;
/// with `lifted`, of the points with the squares of their lengths from the first, less their weights. `None` if that
/// takes too many primes, or if it is not zero.
pub fn is_zero(points: &Points, lifted: bool, bits: i64) -> Option<()> {
    let count = usize::try_from(bits.max(0) / i64::from(BITS) + 1).ok()?;
    let primes = primes().get(..count)?;
    primes
        .iter()
        .all(|&prime| vanishes(points, lifted, prime))
        .then_some(())
}

/// Whether the determinant vanishes modulo a prime.
fn vanishes(points: &Points, lifted: bool, f: Prime) -> bool {
    let (n, d) = (points.count - 1, points.dimension);
    let value = |(odd, shift): Coordinate| {
        let integer = f.integer(odd);
        if shift == 0 {
            integer
        } else {
            f.mul(integer, f.power(shift))
        }
    };
    let at = |row: usize, k: usize| value(points.rows[row][k]);
    let every = if lifted { points.squares } else { d };
    let origin: [u64; ROWS - 1] = std::array::from_fn(|k| if k < every { at(0, k) } else { 0 });
    let mut m = [[0u64; ROWS]; ROWS];
    for i in 0..n {
        let mut square = 0;
        for k in 0..every {
            let x = f.sub(at(i + 1, k), origin[k]);
            // What comes after the coordinates counts for lengths only.
            m[i][k] = if k < d { x } else { 0 };
            square = f.add(square, f.mul(x, x));
        }
        if lifted {
            let weight = f.sub(value(points.weights[i + 1]), value(points.weights[0]));
            m[i][d] = f.sub(square, weight);
        }
    }
    // Rows are multiplied instead of divided: whether the determinant is zero stays the same.
    for k in 0..n {
        let Some(pivot) = (k..n).find(|&r| m[r][k] != 0) else {
            return true;
        };
        m.swap(k, pivot);
        for i in k + 1..n {
            let (a, b) = (m[k][k], m[i][k]);
            if b != 0 {
                for j in k..n {
                    m[i][j] = f.sub(f.mul(a, m[i][j]), f.mul(b, m[k][j]));
                }
            }
        }
    }
    false
}

fn primes() -> &'static [Prime] {
    static PRIMES: OnceLock<Vec<Prime>> = OnceLock::new();
    PRIMES.get_or_init(|| {
        let below = (0..).map(|i| (1u64 << 62) - 1 - 2 * i);
        below
            .filter(|&c| is_prime(c))
            .take(MOST)
            .map(Prime::new)
            .collect()
    })
}

/// The test of Miller and Rabin with the first twelve primes, which decides all numbers below 2^64.
fn is_prime(n: u64) -> bool {
    let mul = |a: u64, b: u64| (u128::from(a) * u128::from(b) % u128::from(n)) as u64;
    let power = |mut base: u64, mut exponent: u64| {
        let mut result = 1;
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = mul(result, base);
            }
            base = mul(base, base);
            exponent >>= 1;
        }
        result
    };
    let s = (n - 1).trailing_zeros();
    [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37]
        .iter()
        .all(|&b| {
            if n.is_multiple_of(b) {
                return n == b;
            }
            let mut x = power(b, (n - 1) >> s);
            if x == 1 || x == n - 1 {
                return true;
            }
            (1..s).any(|_| {
                x = mul(x, x);
                x == n - 1
            })
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primes_are_prime_and_products_right() {
        assert_eq!((2..60).filter(|&n| is_prime(n)).count(), 17);
        assert!(!is_prime(3_215_031_751) && !is_prime((1 << 62) - 1));
        assert!(is_prime((1 << 61) - 1));
        assert!(primes().iter().all(|f| f.p > 1 << BITS && f.p < 1 << 62));
        for &f in primes() {
            let (a, b) = (i64::MAX - 4, -123_456_789_012_345);
            let product = (i128::from(a) * i128::from(b)).rem_euclid(i128::from(f.p));
            // Out of Montgomery's form: a product with 1.
            assert_eq!(
                i128::from(f.mul(f.mul(f.integer(a), f.integer(b)), 1)),
                product
            );
            assert_eq!(
                f.mul(f.power(70), 1),
                ((1u128 << 70) % u128::from(f.p)) as u64
            );
        }
    }

    #[test]
    fn enough_primes_are_taken() {
        // The product of the first two primes is zero modulo both of them, but not modulo the third.
        let [p, q] = [0, 1].map(|i| primes()[i].p as i64);
        let mut points = Points {
            rows: [[(0, 0); ROWS - 1]; ROWS + 1],
            weights: [(0, 0); ROWS + 1],
            count: 3,
            dimension: 2,
            squares: 2,
        };
        points.rows[1][0] = (p, 0);
        points.rows[2][1] = (q, 0);
        assert_eq!(is_zero(&points, false, 121), Some(()));
        assert_eq!(is_zero(&points, false, 124), None);
        points.rows[2] = points.rows[1];
        assert_eq!(is_zero(&points, false, 2000), Some(()));
        assert_eq!(is_zero(&points, false, 5000), None);
    }
}
