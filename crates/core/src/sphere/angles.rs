//! Longitudes and latitudes as directions, by sines and cosines that are the same on every
//! platform.
//!
//! The direction of longitude l and latitude b is that of (cos l, sin l, tan b): vectors of one
//! longitude have equal x and y, so meridians and the poles are exactly on great circles, and
//! opposite latitudes are exact mirror images. Each coordinate is within 0.5001 units in the last
//! place of the true number (sines and cosines) or 1.01 (tangents), from additions, multiplications
//! and divisions only.
//!
//! # The reduction
//!
//! For degrees, `x % 360` is exact, and so is the difference from the nearest multiple of 90. From
//! radians, a multiple of pi / 2 is subtracted, with pi / 2 known to 159 bits, which leaves an
//! error of 2^-150 for a few turns; doubles that are nearest to multiples of pi / 2 count as these.
//! Then r is at most 45 degrees, and the quadrant determines signs and the exchange of sine and
//! cosine exactly.
//!
//! # The bound
//!
//! Let u = 2^-53, and r = k + f with a whole degree k and |f| <= 1/2. Sine and cosine of k are
//! known to u^2 of themselves. With t = f in radians, q = t^2 < 7.7e-5, the series of sin t / t and
//! cos t - 1 end before q^6 / 12!, below 2^-110. Their terms from q^3 on are computed in plain
//! floating point: they are below 2^-53 and 2^-50, so that four roundings of each are below 2^-101
//! together. The others are computed in pairs, with errors of 9 u^2 for a product and 4 u^2 for a
//! sum: sin t errs by 12 u^2, and the rest of cos t - 1, below q / 2, by 2^-112. In
//! sin k + (sin k (cos t - 1) + cos k sin t) the last term is at most half of sin k, or k = 0 and
//! it is the only one: the sum errs by less than 64 u^2 = 2^-100 of itself, cosines even less. For
//! radians t itself is off by 2^-103 more, which is 2^-96 of the sine. The head of the pair is the
//! sum rounded: it errs by half a unit in the last place and less than 2^-42 of a unit more. A
//! quotient of two pairs, corrected once, has a relative error of 2^-95 before it is rounded twice.
//!
//! # The quick way
//!
//! The same sums in doubles, except for the first two terms, sin k and the exact product cos k t.
//! The others are below 2^-14.6 of the result, and 2^-13 in sum: each goes through at most ten
//! roundings, where ignoring the tail of t counts as two, and all err by 2^-13 10 u < 2^-62 of the
//! result. (For k = 0 the sine has the terms of sin t alone, which are smaller.) The quotient errs
//! by twice that and 2^-100. If such an error cannot change the nearest double, that is the result
//! of the long way, too, whose error is far smaller: the quick way only saves time.

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;

use super::sines::SINES;
use crate::base::error::Result;
use crate::base::memory::filled;
use crate::base::parallel;
use crate::base::watch::Watch;

/// Angles converted together.
const SHARE: usize = 1 << 14;

/// A degree in radians.
const DEGREE: Pair = Pair {
    hi: 0.017453292519943295,
    lo: 2.9486522708701687e-19,
};
/// A right angle in radians, as the sum of three doubles.
const RIGHT: [f64; 3] = [
    std::f64::consts::FRAC_PI_2,
    6.123233995736766e-17,
    -1.4973849048591698e-33,
];
/// For degrees this small, the sine is the angle in radians to 400 bits; the products of smaller
/// ones would underflow.
const TINY: f64 = f64::from_bits((1023 - 200) << 52);
/// The factor for tiny degrees, and its inverse.
const UP: [f64; 2] = [
    f64::from_bits((1023 + 600) << 52),
    f64::from_bits((1023 - 600) << 52),
];

/// Bound of the error of `quick`, 2^-62.
const QUICK: f64 = 1.0 / (1_u64 << 62) as f64;

/// The precision that a result needs.
#[derive(Clone, Copy)]
enum Care {
    /// To 2^-62, which nearly always determines the nearest double.
    Quick,
    /// To 2^-100, or 2^-96 for radians.
    Full,
}

/// How angles are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// 360 to a turn.
    Degrees,
    /// 2 pi to a turn.
    Radians,
}

/// An angle as a right angle times `quarters`, and a rest of at most half a right angle.
struct Reduced {
    quarters: i32,
    rest: Rest,
}

/// An angle of at most 45 degrees.
enum Rest {
    Degrees(f64),
    Radians(Pair),
}

fn negated(a: Pair) -> Pair {
    Pair {
        hi: -a.hi,
        lo: -a.lo,
    }
}

fn double(a: f64) -> Pair {
    Pair::from_double(a)
}

/// Sine and cosine of t radians, |t| < 0.0088; the cosine less one.
fn series(t: Pair) -> [Pair; 2] {
    let third = Pair {
        hi: -0.16666666666666666,
        lo: -9.25185853854297e-18,
    };
    let fifth = Pair {
        hi: 0.008333333333333333,
        lo: 1.1564823173178714e-19,
    };
    let fourth = Pair {
        hi: 0.041666666666666664,
        lo: 2.3129646346357427e-18,
    };
    let q = t.square();
    let w = q.hi;
    let rest = [
        w * (-1.0 / 5040.0 + w * (1.0 / 362_880.0 - w / 39_916_800.0)),
        w * (-1.0 / 720.0 + w * (1.0 / 40_320.0 - w / 3_628_800.0)),
    ];
    let sine = t + t * (q * (third + q * (fifth + double(rest[0]))));
    let cosine = q * (double(-0.5) + q * (fourth + double(rest[1])));
    [sine, cosine]
}

/// Sine and cosine of an angle from 0 to 45 degrees.
fn first_octant(rest: &Rest, care: Care) -> [Pair; 2] {
    let table = |k: usize| Pair {
        hi: SINES[k][0],
        lo: SINES[k][1],
    };
    let (k, t) = match *rest {
        Rest::Degrees(r) if r < TINY => {
            // Scaled back, the product is rounded once more at most.
            let t = (Pair::product(r * UP[0], DEGREE.hi) + double(r * UP[0] * DEGREE.lo)).hi;
            return [double(t * UP[1]), double(1.0)];
        }
        Rest::Degrees(r) => {
            let k = (r + 0.5).floor();
            let f = r - k;
            (k, Pair::product(f, DEGREE.hi) + double(f * DEGREE.lo))
        }
        Rest::Radians(r) => {
            let k = (r.hi / DEGREE.hi + 0.5).floor();
            (k, r - double(k) * DEGREE)
        }
    };
    let k = (k as usize).min(45);
    match care {
        Care::Quick => quick(table(k), table(90 - k), t),
        Care::Full if t.hi == 0.0 => [table(k), table(90 - k)],
        Care::Full if k == 0 => {
            let [sine, cosine] = series(t);
            [sine, double(1.0) + cosine]
        }
        Care::Full => {
            let ([sine, cosine], s, c) = (series(t), table(k), table(90 - k));
            [s + (s * cosine + c * sine), c + (c * cosine - s * sine)]
        }
    }
}

/// Sine and cosine of k + t, from those of k, to 2^-62 of themselves: see the top of the file.
fn quick(s: Pair, c: Pair, t: Pair) -> [Pair; 2] {
    let q = t.hi * t.hi;
    let sine = t.lo + t.hi * q * (q * (1.0 / 120.0 - q * (1.0 / 5040.0)) - 1.0 / 6.0);
    let cosine = q * (q * (1.0 / 24.0 - q * (1.0 / 720.0)) - 0.5);
    let (up, down) = (Pair::product(c.hi, t.hi), Pair::product(s.hi, t.hi));
    let rest = [
        s.hi * cosine + (c.hi * sine + (c.lo * t.hi + s.lo)),
        c.hi * cosine - (s.hi * sine + (s.lo * t.hi - c.lo)),
    ];
    let sum = |a: f64, b: f64, rest: f64| {
        let lead = double(a) + double(b);
        double(lead.hi) + double(lead.lo + rest)
    };
    [
        sum(s.hi, up.hi, up.lo + rest[0]),
        sum(c.hi, -down.hi, rest[1] - down.lo),
    ]
}

/// The pair rounded to a double, if an error of `bound` times the pair would not change the result.
fn certain(x: Pair, bound: f64) -> Option<f64> {
    let error = x.hi.abs() * bound;
    (x.hi + (x.lo + error) == x.hi && x.hi + (x.lo - error) == x.hi).then_some(x.hi)
}

/// The angle less the nearest multiple of a right angle.
fn reduced(angle: f64, measure: Measure) -> Reduced {
    match measure {
        Measure::Degrees => {
            let x = angle % 360.0;
            let quarters = (x / 90.0).round();
            Reduced {
                quarters: quarters as i32,
                // Exact: both are multiples of the last place of x, and the rest is smaller.
                rest: Rest::Degrees(x - 90.0 * quarters),
            }
        }
        Measure::Radians => {
            let quarters = (angle / RIGHT[0]).round();
            // A product with -2, -1, 0, 1 or 2 is exact.
            let parts = match quarters.abs() <= 2.0 {
                true => RIGHT.map(|part| double(quarters * part)),
                false => RIGHT.map(|part| Pair::product(quarters, part)),
            };
            let rest = if angle == (parts[0] + parts[1]).hi {
                double(0.0)
            } else {
                // The first difference is exact.
                double(angle - parts[0].hi) - double(parts[0].lo) - parts[1] - parts[2]
            };
            Reduced {
                // Beyond a few turns, there is no guarantee.
                quarters: (quarters % 4.0) as i32,
                rest: Rest::Radians(rest),
            }
        }
    }
}

/// Sine and cosine as pairs.
fn pairs(angle: f64, measure: Measure, care: Care) -> [Pair; 2] {
    let Reduced { quarters, rest } = reduced(angle, measure);
    let (turned, rest) = match rest {
        Rest::Degrees(r) => (r < 0.0, Rest::Degrees(r.abs())),
        Rest::Radians(r) if r.hi < 0.0 => (true, Rest::Radians(negated(r))),
        Rest::Radians(r) => (false, Rest::Radians(r)),
    };
    let [sine, c] = first_octant(&rest, care);
    let s = if turned { negated(sine) } else { sine };
    match quarters.rem_euclid(4) {
        0 => [s, c],
        1 => [c, negated(s)],
        2 => [negated(s), negated(c)],
        _ => [negated(c), s],
    }
}

/// Sine and cosine of an angle; no result is -0.
pub fn sine_cosine(angle: f64, measure: Measure) -> [f64; 2] {
    if angle.abs() > TINY {
        let [s, c] = pairs(angle, measure, Care::Quick).map(|x| certain(x, QUICK));
        if let (Some(s), Some(c)) = (s, c) {
            return [s + 0.0, c + 0.0];
        }
    }
    pairs(angle, measure, Care::Full).map(|x| x.hi + 0.0)
}

/// The tangent of an angle whose cosine is not zero.
pub fn tangent(angle: f64, measure: Measure) -> f64 {
    if angle.abs() > TINY {
        let [s, c] = pairs(angle, measure, Care::Quick);
        let q = s.hi / c.hi;
        let product = Pair::product(q, c.hi);
        let rest = ((s.hi - product.hi) - product.lo) + (s.lo - q * c.lo);
        if let Some(tangent) = certain(double(q) + double(rest / c.hi), 4.0 * QUICK) {
            return tangent + 0.0;
        }
    }
    let [s, c] = pairs(angle, measure, Care::Full);
    let q = s.hi / c.hi;
    if q.abs() < TINY {
        return q + 0.0;
    }
    let rest = s - double(q) * c;
    q + rest.hi / c.hi + 0.0
}

/// The vector, of any length, of a longitude and a latitude; latitudes at or beyond a pole are the
/// pole.
pub fn direction([longitude, latitude]: [f64; 2], measure: Measure) -> Point3 {
    let pole = match measure {
        Measure::Degrees => 90.0,
        Measure::Radians => RIGHT[0],
    };
    if latitude.abs() >= pole {
        return [0.0, 0.0, latitude.signum()];
    }
    let [s, c] = sine_cosine(longitude, measure);
    [c, s, tangent(latitude, measure)]
}

/// The vectors of rows of longitudes and latitudes.
pub fn directions(
    rows: &[[f64; 2]],
    measure: Measure,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Point3>> {
    let mut vectors = filled(rows.len(), [0.0; 3])?;
    let tasks = rows.chunks(SHARE).zip(vectors.chunks_mut(SHARE)).collect();
    parallel::map_watched(workers, tasks, watch, |(rows, vectors)| {
        for (vector, &row) in vectors.iter_mut().zip(rows) {
            *vector = direction(row, measure);
        }
        Ok(())
    })?;
    Ok(vectors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    /// Angles of a few turns: scattered, near whole and half degrees and right angles, and small.
    fn angles() -> impl Iterator<Item = f64> {
        let mut next = uniform(1);
        (0..200_000).map(move |i| {
            let at = 1440.0 * next() - 720.0;
            match i % 4 {
                0 => at,
                1 => (2.0 * at).round() / 2.0 + (next() - 0.5) * 1e-12,
                2 => (at / 90.0).round() * 90.0 + (next() - 0.5) * 1e-6,
                _ => at * 0.5_f64.powi(i % 150),
            }
        })
    }

    fn each(check: impl Fn(f64, Measure)) {
        for angle in angles() {
            check(angle, Measure::Degrees);
            check(angle * 0.017453292519943295, Measure::Radians);
        }
    }

    #[test]
    fn the_quick_way_is_within_its_bound() {
        let worst = std::cell::Cell::new([0.0_f64; 2]);
        each(|angle, measure| {
            let [quick, full] = [Care::Quick, Care::Full].map(|care| pairs(angle, measure, care));
            for (i, (quick, full)) in quick.into_iter().zip(full).enumerate() {
                let mut most = worst.get();
                if full.hi != 0.0 {
                    most[i] = most[i].max(((quick - full).hi / full.hi).abs());
                }
                worst.set(most);
            }
        });
        for most in worst.get() {
            assert!(most < QUICK && most > QUICK / 32.0, "{}", most / QUICK);
        }
    }

    #[test]
    fn both_ways_have_the_same_results() {
        let (undecided, all) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
        each(|angle, measure| {
            let full = pairs(angle, measure, Care::Full);
            assert_eq!(sine_cosine(angle, measure), full.map(|x| x.hi + 0.0));
            let [s, c] = full;
            if c.hi != 0.0 && s.hi != 0.0 && (s.hi / c.hi).abs() > TINY {
                let q = s.hi / c.hi;
                let rest = s - double(q) * c;
                assert_eq!(tangent(angle, measure), q + rest.hi / c.hi, "{angle:e}");
            }
            let quick = pairs(angle, measure, Care::Quick);
            let left = quick.iter().any(|&x| certain(x, QUICK).is_none());
            undecided.set(undecided.get() + usize::from(left));
            all.set(all.get() + 1);
        });
        let share = undecided.get() as f64 / f64::from(all.get());
        assert!(share > 0.001 && share < 0.02, "{share}");
    }
}
