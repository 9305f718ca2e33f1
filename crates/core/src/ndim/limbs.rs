//! The elimination of `frame` for integers of several limbs, on the stack.
//!
//! Integers are in two's complement, and products and sums wrap: they hold modulo 2^(64 M), where M is the
//! number of limbs. That is enough for the division without remainder of Bareiss. If the previous pivot
//! is q = 2^t odd, the result x of (p a - f b) / q is known as x 2^t = (p a - f b) / odd modulo 2^(64 M), a
//! product with the inverse of the odd number. If x 2^t is below 2^(64 M - 1), it is known itself
//! (T. Jebelean, "An algorithm for exact division", 1993). So no product is longer than the results, and
//! each step takes as many limbs as its minors need. Pivots are those with the fewest zeros at the end.
//!
//! The inverse is computed in place: once column k of A is eliminated, its place has column k of I.
//!
//! Entries after step k are minors of [A | b] of order m = k + 2, or less, and at most D. By the bounds of
//! `frame`, they are below 9 m (m - 1)^((m - 1) / 2) 2^((m + 1) bits), which up to m = 9 is below
//! 2^((m + 1) bits + 2 m + 2).

use num_bigint::BigInt;

/// The most coordinates.
pub const MOST: usize = 8;

/// The most limbs: differences of 61 bits in 8-D take 9, and 10 with the lifted point. The rest is for
/// zeros at the end of pivots.
const LIMBS: usize = 12;

/// An integer, of which a step uses the first limbs.
type Number = [u64; LIMBS];

/// The rows of [A | b].
type Matrix = [[Number; MOST + 1]; MOST];

/// What elimination leaves, with the signs of a positive determinant.
pub struct Limbs {
    /// The determinant, the entries of det A^-1 b, and those of det A^-1 row by row.
    numbers: Vec<u64>,
    /// The number of limbs of each.
    length: usize,
    /// The number of limbs of scalar products.
    wide: usize,
    dimension: usize,
    /// Whether the determinant was positive.
    pub positive: bool,
}

/// What comes of an elimination.
pub enum Eliminated {
    Done(Limbs),
    /// A is singular.
    Flat,
    /// The pivots have too many zeros at the end.
    TooLong,
}

/// A bound on the bits of minors of [A | b] of an order, with their sign.
fn bits_of(order: usize, bits: u32) -> usize {
    (order + 1) * bits as usize + 2 * order + 3
}

/// [A | b] -> [det A^-1 | det A^-1 b] for differences below 2^bits, where `at` has the entries of A, and b
/// the squares of its rows less what `weight` has.
pub fn eliminate(
    d: usize,
    bits: u32,
    at: impl Fn(usize, usize) -> i64,
    weight: impl Fn(usize) -> i128,
) -> Eliminated {
    let mut rows: Matrix = [[[0; LIMBS]; MOST + 1]; MOST];
    for (i, row) in rows.iter_mut().enumerate().take(d) {
        let mut square = -weight(i);
        for k in 0..d {
            let x = at(i, k);
            square += i128::from(x) * i128::from(x);
            row[k] = number(x.into());
        }
        row[d] = number(square);
    }
    let (mut previous, mut positive) = (number(1), true);
    // The limbs that have values, and the columns of the inverse.
    let (mut valid, mut columns) = (LIMBS, [0, 1, 2, 3, 4, 5, 6, 7]);
    for k in 0..d {
        let zeros_of = |r: &usize| zeros(&rows[*r][k][..valid]);
        let pivot = (k..d).min_by_key(zeros_of).unwrap_or(k);
        if zeros_of(&pivot) == u32::MAX {
            return Eliminated::Flat;
        }
        if pivot != k {
            rows.swap(k, pivot);
            columns.swap(k, pivot);
            positive = !positive;
        }
        let shift = zeros(&previous);
        let limbs = (bits_of((k + 2).min(d), bits) + shift as usize).div_ceil(64);
        if limbs > LIMBS {
            return Eliminated::TooLong;
        }
        // All entries fit, but those computed by the last step may have fewer limbs.
        if limbs > valid {
            for number in rows[..d].iter_mut().flat_map(|row| &mut row[..=d]) {
                extend(number, valid);
            }
        }
        valid = limbs;
        let next = rows[k][k];
        dispatch(limbs, &mut rows, d, k, &previous, shift);
        rows[k][k] = previous;
        previous = next;
        extend(&mut previous, valid);
    }
    let negative = previous[LIMBS - 1] >> 63 == 1;
    let mut numbers = Vec::with_capacity(valid * (d + 1) * (d + 1));
    let mut add = |mut number: Number| {
        if negative {
            negate(&mut number);
        }
        numbers.extend_from_slice(&number[..valid]);
    };
    add(previous);
    for row in &rows[..d] {
        add(row[d]);
    }
    let mut place = [0; MOST];
    for (k, &column) in columns[..d].iter().enumerate() {
        place[column] = k;
    }
    for row in &rows[..d] {
        for k in 0..d {
            add(row[place[k]]);
        }
    }
    Eliminated::Done(Limbs {
        numbers,
        length: valid,
        wide: bits_of(d + 1, bits).div_ceil(64),
        dimension: d,
        positive: positive ^ negative,
    })
}

fn dispatch(limbs: usize, rows: &mut Matrix, d: usize, k: usize, previous: &Number, shift: u32) {
    match limbs {
        1 => step::<1>(rows, d, k, previous, shift),
        2 => step::<2>(rows, d, k, previous, shift),
        3 => step::<3>(rows, d, k, previous, shift),
        4 => step::<4>(rows, d, k, previous, shift),
        5 => step::<5>(rows, d, k, previous, shift),
        6 => step::<6>(rows, d, k, previous, shift),
        7 => step::<7>(rows, d, k, previous, shift),
        8 => step::<8>(rows, d, k, previous, shift),
        9 => step::<9>(rows, d, k, previous, shift),
        10 => step::<10>(rows, d, k, previous, shift),
        11 => step::<11>(rows, d, k, previous, shift),
        _ => step::<LIMBS>(rows, d, k, previous, shift),
    }
}

/// Eliminates column `k` with the pivot in row `k`; `previous` is the last pivot, which ends with `shift`
/// zeros. The entry of the pivot remains to be replaced.
fn step<const M: usize>(rows: &mut Matrix, d: usize, k: usize, previous: &Number, shift: u32) {
    let of_pivot = rows[k];
    let inverse = inverse::<M>(&shifted::<M>(&first(previous), shift));
    let pivot = product::<M>(&first(&of_pivot[k]), &inverse);
    for (_, row) in rows[..d].iter_mut().enumerate().filter(|(i, _)| *i != k) {
        let entry = first::<M>(&row[k]);
        let minus = opposite(&entry);
        let factor = product(&minus, &inverse);
        for j in (0..=d).filter(|&j| j != k) {
            let own = product(&pivot, &first(&row[j]));
            let sum = plus_product(own, &factor, &first(&of_pivot[j]));
            row[j][..M].copy_from_slice(&shifted(&sum, shift));
        }
        // det I has the previous pivot in row k, and zero here.
        row[k][..M].copy_from_slice(&minus);
    }
}

/// The first limbs.
#[inline(always)]
fn first<const M: usize>(x: &Number) -> [u64; M] {
    std::array::from_fn(|i| x[i])
}

#[inline(always)]
fn product<const M: usize>(a: &[u64; M], b: &[u64; M]) -> [u64; M] {
    plus_product([0; M], a, b)
}

/// The sum of a number and a product.
#[inline(always)]
fn plus_product<const M: usize>(mut sum: [u64; M], a: &[u64; M], b: &[u64; M]) -> [u64; M] {
    for i in 0..M {
        let mut carry = 0;
        for j in 0..M - i {
            // At most (2^64 - 1)^2 + 2 (2^64 - 1), which is below 2^128.
            let t = u128::from(a[i]) * u128::from(b[j]) + u128::from(sum[i + j]) + carry;
            sum[i + j] = t as u64;
            carry = t >> 64;
        }
    }
    sum
}

fn opposite<const M: usize>(x: &[u64; M]) -> [u64; M] {
    let mut result = *x;
    negate(&mut result);
    result
}

fn negate(x: &mut [u64]) {
    let mut carry = true;
    for limb in x {
        (*limb, carry) = (!*limb).overflowing_add(carry.into());
    }
}

/// `x / 2^shift`, rounded down.
#[inline(always)]
fn shifted<const M: usize>(x: &[u64; M], shift: u32) -> [u64; M] {
    if shift == 0 {
        return *x;
    }
    let (limbs, bits) = (shift as usize / 64, shift % 64);
    let fill = fill_of(x);
    let at = |i: usize| if i < M { x[i] } else { fill };
    std::array::from_fn(|i| {
        let (low, high) = (at(i + limbs), at(i + limbs + 1));
        // Twice, as a shift by 64 bits is none.
        (low >> bits) | (high << 1 << (63 - bits))
    })
}

/// The inverse of an odd number by Newton's method, which doubles the right bits.
#[inline(always)]
fn inverse<const M: usize>(odd: &[u64; M]) -> [u64; M] {
    let mut low = 1u64;
    for _ in 0..6 {
        low = low.wrapping_mul(2u64.wrapping_sub(odd[0].wrapping_mul(low)));
    }
    let mut result = [0; M];
    result[0] = low;
    let mut right = 1;
    while right < M {
        let once = product(odd, &result);
        // x (2 - odd x), where odd x ends with the limb 1.
        let mut factor = once;
        negate(&mut factor[1..]);
        result = product(&result, &factor);
        right *= 2;
    }
    result
}

/// The limbs after the last one.
fn fill_of(x: &[u64]) -> u64 {
    x.last().map_or(0, |top| ((*top as i64) >> 63) as u64)
}

/// Fills the limbs after the first `valid` ones.
fn extend(x: &mut Number, valid: usize) {
    let fill = fill_of(&x[..valid]);
    x[valid..].fill(fill);
}

fn number(x: i128) -> Number {
    let mut result = [0; LIMBS];
    (result[0], result[1]) = (x as u64, (x >> 64) as u64);
    extend(&mut result, 2);
    result
}

/// The number of zeros at the end; the largest number if there is nothing else.
fn zeros(x: &[u64]) -> u32 {
    let found = x.iter().position(|&limb| limb != 0);
    found.map_or(u32::MAX, |i| 64 * i as u32 + x[i].trailing_zeros())
}

impl Limbs {
    /// The determinant if `i` is 0, then the other numbers.
    fn at(&self, i: usize) -> &[u64] {
        &self.numbers[i * self.length..(i + 1) * self.length]
    }

    /// The place of entry `k, i` of det A^-1.
    fn of_adjoint(&self, k: usize, i: usize) -> usize {
        1 + self.dimension * (k + 1) + i
    }

    /// The determinant, which is positive.
    pub fn determinant(&self) -> BigInt {
        big(self.at(0))
    }

    /// Component `k` of det A^-1 b.
    pub fn lifted(&self, k: usize) -> BigInt {
        big(self.at(1 + k))
    }

    /// Entry `k, i` of det A^-1.
    pub fn adjoint(&self, k: usize, i: usize) -> BigInt {
        big(self.at(self.of_adjoint(k, i)))
    }

    /// The sign of det (|x|^2 - weight) - det A^-1 b . x, where `x` has the coordinates of a point.
    pub fn power(&self, x: impl Fn(usize) -> i64, weight: i128) -> i32 {
        let mut sum = [0; LIMBS];
        let mut height = -weight;
        for k in 0..self.dimension {
            let x = i128::from(x(k));
            height += x * x;
            self.add(&mut sum, 1 + k, -x);
        }
        self.add(&mut sum, 0, height);
        self.sign(&sum)
    }

    /// The sign of det times barycentric coordinate `i` of a point.
    pub fn coordinate(&self, i: usize, x: impl Fn(usize) -> i64) -> i32 {
        let mut sum = [0; LIMBS];
        for k in 0..self.dimension {
            let x = i128::from(x(k));
            if i > 0 {
                self.add(&mut sum, self.of_adjoint(k, i - 1), x);
                continue;
            }
            for c in 0..self.dimension {
                self.add(&mut sum, self.of_adjoint(k, c), -x);
            }
        }
        if i == 0 {
            self.add(&mut sum, 0, 1);
        }
        self.sign(&sum)
    }

    /// Adds a product with number `i`.
    fn add(&self, sum: &mut Number, i: usize, factor: i128) {
        let (x, wide) = (self.at(i), self.wide);
        let fill = fill_of(x);
        let magnitude = factor.unsigned_abs();
        let mut product = [0u64; LIMBS];
        for (shift, limb) in [magnitude as u64, (magnitude >> 64) as u64]
            .into_iter()
            .enumerate()
        {
            let mut carry = 0;
            for j in 0..wide - shift {
                let of_x = x.get(j).copied().unwrap_or(fill);
                let t =
                    u128::from(of_x) * u128::from(limb) + u128::from(product[j + shift]) + carry;
                product[j + shift] = t as u64;
                carry = t >> 64;
            }
        }
        if factor < 0 {
            negate(&mut product[..wide]);
        }
        let mut carry = false;
        for (limb, add) in sum.iter_mut().zip(product).take(wide) {
            let (first, one) = limb.overflowing_add(add);
            let (both, two) = first.overflowing_add(carry.into());
            (*limb, carry) = (both, one | two);
        }
    }

    fn sign(&self, sum: &Number) -> i32 {
        let sum = &sum[..self.wide];
        if fill_of(sum) != 0 {
            return -1;
        }
        i32::from(sum.iter().any(|&limb| limb != 0))
    }
}

fn big(x: &[u64]) -> BigInt {
    let bytes: Vec<u8> = x.iter().flat_map(|limb| limb.to_le_bytes()).collect();
    BigInt::from_signed_bytes_le(&bytes)
}
