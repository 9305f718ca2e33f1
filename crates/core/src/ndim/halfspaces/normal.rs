//! The normals of facets in integers, and what they decide.
//!
//! Cofactors of the D vectors of a facet come from the fraction-free elimination of E. H. Bareiss
//! (1968), whose entries are minors. If the input is below 2^bits, they are at most D^(D / 2) 2^(D bits).

use std::ops::{Div, Mul, Sub};

use num_bigint::BigInt;

use super::sites::Sites;

/// A vector that is zero on the vectors of a facet and positive outside.
pub enum Normal<const V: usize> {
    /// Below 2^126 with room for a scalar product.
    Small([i128; V]),
    /// Of any size.
    Wide([BigInt; V]),
}

/// Numbers that elimination can use.
pub trait Number: Clone + From<i64> + PartialOrd
where
    for<'a> &'a Self:
        Mul<&'a Self, Output = Self> + Sub<&'a Self, Output = Self> + Div<&'a Self, Output = Self>,
{
}

impl Number for i64 {}
impl Number for i128 {}
impl Number for BigInt {}

/// Bits of minors of D rows whose entries are below 2^bits.
fn minor_bits(d: u32, bits: u32) -> u32 {
    let log = u32::BITS - d.leading_zeros();
    d * bits + (d * log).div_ceil(2)
}

impl<const V: usize> Normal<V> {
    /// The normal of a facet; `odd` if the determinant of its vectors and one outside is negative.
    /// `None` if the vectors are not independent.
    pub fn new<const D: usize, const P: usize>(
        sites: &Sites<'_, D, V, P>,
        vertices: &[u32; D],
        odd: bool,
    ) -> Option<Self> {
        if let Some(small) = machine(sites, i64::BITS) {
            let rows = vertices.map(|v| small[v as usize]);
            return Some(Self::Small(across(rows, odd)?.map(i128::from)));
        }
        if let Some(small) = machine(sites, i128::BITS) {
            let rows = vertices.map(|v| small[v as usize].map(i128::from));
            return Some(Self::Small(across(rows, odd)?));
        }
        let rows = vertices.map(|v| sites.integers(v));
        Some(Self::Wide(across(rows, odd)?))
    }

    /// The side of a vector: positive outside.
    pub fn side<const D: usize, const P: usize>(&self, sites: &Sites<'_, D, V, P>, w: u32) -> i32 {
        match (self, &sites.small) {
            (Self::Small(y), Some(small)) => {
                let w = &small[w as usize];
                let sum: i128 = (0..V).map(|k| y[k] * i128::from(w[k])).sum();
                sum.signum() as i32
            }
            _ => {
                let (y, w) = (self.wide(), sites.integers(w));
                let sum: BigInt = (0..V).map(|k| &y[k] * &w[k]).sum();
                sum.cmp(&BigInt::ZERO) as i32
            }
        }
    }

    /// Its components.
    pub fn wide(&self) -> [BigInt; V] {
        match self {
            Self::Small(y) => y.map(BigInt::from),
            Self::Wide(y) => y.clone(),
        }
    }

    /// The sign of coefficient `i` of a vector in the span of the vectors of the facet, by Cramer's rule:
    /// the determinant with the vector in place `i`, divided by the determinant. Both leave out one
    /// coordinate, for which the normal, whose components are such determinants, is not zero.
    pub fn share<const D: usize, const P: usize>(
        &self,
        sites: &Sites<'_, D, V, P>,
        vertices: &[u32; D],
        odd: bool,
        i: usize,
        w: u32,
    ) -> i32 {
        let signs: [i32; V] = match self {
            Self::Small(y) => y.map(|x| x.signum() as i32),
            Self::Wide(y) => std::array::from_fn(|k| y[k].cmp(&BigInt::ZERO) as i32),
        };
        let skip = signs.iter().position(|sign| *sign != 0).unwrap_or(0);
        let turned = odd != ((D + skip) % 2 == 1);
        let whole = if turned { -signs[skip] } else { signs[skip] };
        let mut with = *vertices;
        with[i] = w;
        let columns: [usize; D] = std::array::from_fn(|j| j + usize::from(j >= skip));
        if let Some(small) = machine(sites, i64::BITS) {
            return whole * turn(with.map(|v| columns.map(|j| small[v as usize][j])));
        }
        if let Some(small) = machine(sites, i128::BITS) {
            let at = |v: u32, j: usize| i128::from(small[v as usize][j]);
            return whole * turn(with.map(|v| columns.map(|j| at(v, j))));
        }
        let rows = with.map(|v| sites.integers(v));
        whole * turn(rows.map(|row| columns.map(|j| row[j].clone())))
    }
}

/// The rows as machine integers, if all that elimination computes fits into integers of this width.
fn machine<'a, const D: usize, const V: usize, const P: usize>(
    sites: &'a Sites<'_, D, V, P>,
    width: u32,
) -> Option<&'a Vec<[i64; V]>> {
    // A step computes the difference of two products of minors.
    let fits = 2 * minor_bits(D as u32, sites.bits) + 2 < width;
    sites.small.as_ref().filter(|_| fits)
}

/// The sign of a determinant.
pub fn turn<T: Number, const N: usize>(mut m: [[T; N]; N]) -> i32
where
    for<'a> &'a T: Mul<&'a T, Output = T> + Sub<&'a T, Output = T> + Div<&'a T, Output = T>,
{
    let zero = T::from(0);
    let (mut previous, mut sign) = (T::from(1), 1);
    for k in 0..N {
        let Some(pivot) = (k..N).find(|&r| m[r][k] != zero) else {
            return 0;
        };
        if pivot != k {
            m.swap(k, pivot);
            sign = -sign;
        }
        let of_pivot = m[k].clone();
        for row in &mut m[k + 1..] {
            reduce(row, &of_pivot, k, &previous);
        }
        previous = of_pivot[k].clone();
    }
    if previous < zero { -sign } else { sign }
}

/// One row of a fraction-free step: divisions leave no remainder, because the result is a minor.
fn reduce<T: Number, const N: usize>(row: &mut [T; N], of_pivot: &[T; N], k: usize, previous: &T)
where
    for<'a> &'a T: Mul<&'a T, Output = T> + Sub<&'a T, Output = T> + Div<&'a T, Output = T>,
{
    let factor = row[k].clone();
    for j in 0..N {
        let cross = &(&of_pivot[k] * &row[j]) - &(&factor * &of_pivot[j]);
        row[j] = &cross / previous;
    }
}

/// The vector whose scalar product with w is the determinant of the rows and w, or minus that if
/// `odd`. `None` if the rows are not independent.
fn across<T: Number, const D: usize, const V: usize>(
    mut m: [[T; V]; D],
    odd: bool,
) -> Option<[T; V]>
where
    for<'a> &'a T: Mul<&'a T, Output = T> + Sub<&'a T, Output = T> + Div<&'a T, Output = T>,
{
    let zero = T::from(0);
    let (mut previous, mut negative, mut free) = (T::from(1), odd, D);
    // Each column but one has a pivot; rows are exchanged so that these are in order.
    let mut k = 0;
    for column in 0..V {
        if k == D {
            break;
        }
        let Some(pivot) = (k..D).find(|&r| m[r][column] != zero) else {
            if free != D {
                return None;
            }
            free = column;
            continue;
        };
        if pivot != k {
            m.swap(k, pivot);
            negative = !negative;
        }
        let of_pivot = m[k].clone();
        for (r, row) in m.iter_mut().enumerate() {
            if r != k {
                reduce(row, &of_pivot, column, &previous);
            }
        }
        previous = of_pivot[column].clone();
        k += 1;
    }
    if k < D {
        return None;
    }
    // Up to exchanges of rows, the minor without the free column is `previous`; its cofactor has the
    // sign of its place in the last of V rows.
    negative ^= (D + free) % 2 == 1;
    let signed = |x: &T, minus: bool| if minus { &zero - x } else { x.clone() };
    Some(std::array::from_fn(|column| match column.cmp(&free) {
        std::cmp::Ordering::Equal => signed(&previous, negative),
        std::cmp::Ordering::Less => signed(&m[column][free], !negative),
        std::cmp::Ordering::Greater => signed(&m[column - 1][free], !negative),
    }))
}
