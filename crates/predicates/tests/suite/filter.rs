//! The stages that certify: whenever they answer they are right, with exponents chosen so that
//! products, minors and lengths underflow, one by one. The integer stage, which other tests hold
//! against the oracle, judges here, as it is fast enough for many cases.

use crate::oracle::points::{Random, power_of_two, ulps};
use crate::oracle::{INCIRCLE, INSPHERE, ORIENT2D, ORIENT3D, Predicate};

/// Exponents around which products of two to five factors cross the smallest double.
const EDGES: [i64; 14] = [
    -1074, -1022, -900, -716, -537, -430, -358, -269, -215, -161, 0, 170, 215, 300,
];

fn draw(random: &mut Random, exponents: &[i64]) -> f64 {
    let exponent = random.pick(exponents) + random.integer(-3, 3);
    let x = match random.bits() % 4 {
        0 => random.integer(0, 3) as f64,
        1 => 1.0,
        2 => ulps(1.0, random.integer(-3, 3)),
        _ => random.unit(),
    };
    let x = x * power_of_two(exponent.max(-1074));
    if random.one_in(2) { x } else { -x }
}

/// Each case draws from a few exponents, copies coordinates between points, and moves some of
/// those by single doubles: near-degenerate more often than not.
fn soundness<const D: usize, const N: usize>(predicate: &Predicate<D, N>, cases: usize) {
    let mut random = Random(41);
    let (mut certified, mut zeros) = ([0; 4], 0);
    for _ in 0..cases {
        let exponents = [(); 3].map(|()| random.pick(&EDGES));
        let exponents = &exponents[..random.integer(1, 3) as usize];
        let mut points = [(); N].map(|()| [(); D].map(|()| draw(&mut random, exponents)));
        for _ in 0..random.integer(0, 2 * N as i64) {
            let [from, to, k] = [N, N, D].map(|n| (random.bits() % n as u64) as usize);
            points[to][k] = ulps(points[from][k], random.pick(&[0, 0, 1, -1, 3]));
        }
        let right = (predicate.integer)(points);
        zeros += usize::from(right.is_zero());
        for (count, (name, stage)) in certified.iter_mut().zip(predicate.partial) {
            if let Some(sign) = stage(points) {
                assert_eq!(sign, right, "{name}: {points:?}");
                *count += 1;
            }
        }
    }
    println!("{certified:?} of {cases}, {zeros} zeros");
    assert!(zeros > 0 && zeros < cases);
    assert!(certified.iter().all(|&count| count > 0 && count < cases));
}

#[test]
fn orient2d_is_sound() {
    soundness(&ORIENT2D, 300_000);
}

#[test]
fn incircle_is_sound() {
    soundness(&INCIRCLE, 200_000);
}

#[test]
fn orient3d_is_sound() {
    soundness(&ORIENT3D, 200_000);
}

#[test]
fn insphere_is_sound() {
    soundness(&INSPHERE, 60_000);
}

/// Rounded points of a line, circle, plane or sphere: determinants as small as rounding makes them,
/// so that a relative bound that is too small is found out.
fn tightness<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    cases: usize,
    degenerate: impl Fn(&mut Random) -> [[f64; D]; N],
) {
    let mut random = Random(42);
    let mut certified = [0; 4];
    for _ in 0..cases {
        let points = degenerate(&mut random);
        let right = (predicate.integer)(points);
        for (count, (name, stage)) in certified.iter_mut().zip(predicate.partial) {
            if let Some(sign) = stage(points) {
                assert_eq!(sign, right, "{name}: {points:?}");
                *count += 1;
            }
        }
    }
    println!("{certified:?} of {cases}");
    assert!(
        certified[0] < cases / 2,
        "the filter must be in doubt here: {certified:?}"
    );
}

/// A point of the unit sphere, rounded.
fn direction<const D: usize>(random: &mut Random) -> [f64; D] {
    let p = [(); D].map(|()| random.unit() - 0.5);
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / length)
}

#[test]
fn orient2d_on_rounded_lines() {
    tightness(&ORIENT2D, 500_000, |random| {
        let [u, v] = direction(random);
        [(); 3]
            .map(|()| random.unit() + 0.01)
            .map(|t| [t * u, t * v])
    });
}

/// Points of one line, exactly, but for a few doubles by which the first may have moved: their
/// differences have 80 to 110 bits, so that two doubles hold them, but not their products.
#[test]
fn orient2d_on_lines_wider_than_expansions() {
    tightness(&ORIENT2D, 200_000, |random| {
        let [u, v] = [(); 2].map(|()| random.integer(1, 1 << 26) as f64);
        let mut on = |scale: f64| {
            let t = scale * random.integer(-1 << 26, 1 << 26) as f64;
            [t * u, t * v]
        };
        let [a, b, c] = [on(power_of_two(-55)), on(1.0), on(1.0)];
        [a.map(|x| ulps(x, random.integer(-1, 1))), b, c]
    });
}

#[test]
fn incircle_on_rounded_circles() {
    tightness(&INCIRCLE, 300_000, |random| {
        [(); 4].map(|()| direction(random))
    });
}

#[test]
fn orient3d_on_rounded_planes() {
    tightness(&ORIENT3D, 300_000, |random| {
        let [p, q]: [[f64; 3]; 2] = [direction(random), direction(random)];
        [(); 4].map(|()| {
            let [s, t] = [(); 2].map(|()| random.unit());
            std::array::from_fn(|k| s * p[k] + t * q[k])
        })
    });
}

#[test]
fn insphere_on_rounded_spheres() {
    tightness(&INSPHERE, 200_000, |random| {
        [(); 5].map(|()| direction(random))
    });
}
