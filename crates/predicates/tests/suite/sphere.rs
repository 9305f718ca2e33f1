//! The predicates of directions against square roots of integers.

use std::cmp::Ordering;

use crate::oracle::directions::{sign_of_roots, square, true_incircle, true_orient, whole};
use crate::oracle::points::{Random, power_of_two, shaken, ulps};
use delone_predicates::sphere::{
    Unit, compare, incircle, incircle_canonical, incircle_exact, nearer, orient, orient_exact,
    same, stages,
};
use delone_predicates::{Point3, Sign};
use num_bigint::BigInt;
use num_traits::Signed;

/// Compares all stages with the oracle; counts how many decided.
fn check(points: [Point3; 4], counts: &mut [usize; 3]) -> Sign {
    let sign = true_incircle(points);
    let [a, b, c, d] = points;
    assert_eq!(incircle(a, b, c, d), sign, "{points:?}");
    assert_eq!(incircle_exact(points), sign, "{points:?}");
    let units = points.map(Unit::of);
    let units = units.each_ref();
    for (k, stage) in [stages::pairs(units), stages::double_double(units)]
        .into_iter()
        .enumerate()
    {
        if let Some(found) = stage {
            assert_eq!(found, sign, "stage {k}: {points:?}");
            counts[k] += 1;
        }
    }
    counts[2] += usize::from(sign.is_zero());
    let three = [a, b, c];
    let turn = true_orient(three);
    assert_eq!(
        (orient(a, b, c), orient_exact(three)),
        (turn, turn),
        "{points:?}"
    );
    if let Some(found) = stages::orient_pairs([units[0], units[1], units[2]]) {
        assert_eq!(found, turn, "{points:?}");
    }
    // Antisymmetry, and the tie rule: a swap negates, a rotation of three does not.
    let tied = incircle_canonical(a, b, c, d);
    assert_eq!(incircle_canonical(b, a, c, d), -tied);
    assert_eq!(incircle_canonical(d, b, c, a), -tied);
    assert_eq!(incircle_canonical(b, c, a, d), tied);
    if !sign.is_zero() {
        assert_eq!(tied, sign);
    }
    sign
}

fn gauss(random: &mut Random) -> Point3 {
    [(); 3].map(|()| random.unit() + random.unit() + random.unit() - 1.5)
}

fn scaled(v: Point3, factor: f64) -> Point3 {
    v.map(|x| x * factor)
}

#[test]
fn scattered_vectors_of_very_different_lengths() {
    let (mut random, mut counts) = (Random(1), [0; 3]);
    for case in 0..1500 {
        let points = [(); 4].map(|()| {
            let power = random.integer(-1000, 1000);
            let v = gauss(&mut random);
            if case % 2 == 0 {
                v
            } else {
                scaled(v, power_of_two(power))
            }
        });
        check(points, &mut counts);
    }
    assert_eq!(counts, [1500, 1500, 0]);
}

#[test]
fn any_doubles_at_all() {
    let (mut random, mut counts) = (Random(2), [0; 3]);
    for case in 0..60 {
        let points = [(); 4].map(|()| {
            [(); 3].map(|()| match case % 3 {
                0 => random.any(-1074, 1022),
                1 => random.sparse(-1074, 1020),
                _ => random.integer(-5, 5) as f64 * 5e-324,
            })
        });
        if points.iter().all(|v| v.iter().any(|&x| x != 0.0)) {
            check(points, &mut counts);
        }
    }
}

#[test]
fn near_ties_at_small_spacing() {
    // 1 km, 1 m, 1 cm, 1 mm, 1 micrometer on the Earth, and less than one unit of rounding.
    let (mut random, mut late) = (Random(3), [[0; 3]; 6]);
    for (k, step) in [1.6e-4, 1.6e-7, 1.6e-9, 1.6e-10, 1.6e-13, 1e-17]
        .into_iter()
        .enumerate()
    {
        for _ in 0..150 {
            let center = gauss(&mut random);
            let length = 0.5 + 2.0 * random.unit();
            let points = [(); 4].map(|()| {
                let way = gauss(&mut random);
                let v: Point3 = std::array::from_fn(|i| center[i] + step * way[i]);
                scaled(v, length * (1.0 + random.unit()))
            });
            check(points, &mut late[k]);
        }
    }
    // Pairs decide down to a millimeter, nearly; the next stage all there is but ties.
    assert!(
        late[..3].iter().all(|c| c[0] == 150 && c[1] == 150),
        "{late:?}"
    );
}

#[test]
fn cells_of_small_grids_are_near_ties() {
    let (mut random, mut counts) = (Random(4), [0; 3]);
    for step in [1e-2, 1.6e-7, 1.6e-9, 1.6e-10] {
        for _ in 0..100 {
            let [lon, lat] = [3.0 * random.unit(), 1.4 * random.unit()];
            let corner = |i: f64, j: f64| {
                let (l, p) = (lon + i * step, lat + j * step);
                [l.cos() * p.cos(), l.sin() * p.cos(), p.sin()]
            };
            let cell = [
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            check(cell, &mut counts);
        }
    }
    assert!(counts[1] > counts[0] + 50, "{counts:?}");
}

#[test]
fn integer_spheres_tie_exactly() {
    let (mut random, mut counts) = (Random(5), [0; 3]);
    let axis = || (-15..=15).map(f64::from);
    let points: Vec<Point3> = axis()
        .flat_map(|x| axis().flat_map(move |y| axis().map(move |z| [x, y, z])))
        .filter(|p| p.iter().map(|x| x * x).sum::<f64>() == 225.0)
        .collect();
    // A parallel: the points of one height. Lengths do not matter, so each gets one of its own.
    let mut rings = 0;
    for height in 1..15 {
        let height = f64::from(height);
        let ring: Vec<_> = points.iter().filter(|p| p[2] == height).copied().collect();
        if ring.len() < 4 {
            continue;
        }
        rings += 1;
        for _ in 0..60 {
            let quad = [(); 4].map(|()| {
                let v = random.pick(&ring);
                scaled(
                    v,
                    f64::from([1, 3, 5, 7, 1024, 12289][random.integer(0, 5) as usize]),
                )
            });
            let distinct = (0..4).all(|i| (0..i).all(|j| !same(quad[i], quad[j])));
            assert_eq!(check(quad, &mut counts), Sign::Zero);
            let [a, b, c, d] = quad;
            assert_eq!(incircle_canonical(a, b, c, d).is_zero(), !distinct);
            check(quad.map(|p| shaken(p, 1, &mut random)), &mut counts);
        }
    }
    assert!(rings > 4, "{rings}");
}

#[test]
fn small_lattices_with_all_their_ties() {
    // Roots that differ: (1, 1, 0) and (2, 1, 2) have lengths sqrt 2 and 3.
    let (mut random, mut zeros) = (Random(6), [0; 3]);
    let mut draw = || -> Point3 {
        loop {
            let v = [(); 3].map(|()| random.integer(-2, 2) as f64);
            if v != [0.0; 3] {
                return v;
            }
        }
    };
    for _ in 0..6000 {
        check([draw(), draw(), draw(), draw()], &mut zeros);
    }
    assert!(zeros[2] > 400, "{zeros:?}");
}

#[test]
fn a_unit_in_the_last_place_decides() {
    let (mut random, mut counts) = (Random(7), [0; 3]);
    for height in [1.0, 0.125, 3.0] {
        for i in 0..3 {
            for step in [-1, 1] {
                let mut quad = [
                    [1.0, 0.0, height],
                    [0.0, 1.0, height],
                    [-1.0, 0.0, height],
                    [0.0, -1.0, height],
                ];
                assert_eq!(check(quad, &mut counts), Sign::Zero);
                quad[3][2] = ulps(height, step);
                let sign = check(quad, &mut counts);
                // A higher point is nearer to the pole, inside.
                assert_eq!(
                    sign,
                    if step > 0 {
                        Sign::Positive
                    } else {
                        Sign::Negative
                    }
                );
                quad[i] = scaled(quad[i], power_of_two(random.integer(-900, 900)));
                assert_eq!(check(quad, &mut counts), sign);
            }
        }
    }
}

#[test]
fn ties_do_not_depend_on_the_order_and_fan_from_the_smallest() {
    let ring = [
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [-1.0, 0.0, 1.0],
        [0.0, -1.0, 1.0],
    ];
    // The smallest is (-1, 0, 1): it is a corner of both triangles, so its edge to the opposite one stays.
    let [a, b, c, d] = ring;
    assert_eq!(incircle_canonical(c, d, a, b), Sign::Negative);
    assert_eq!(incircle_canonical(d, a, b, c), Sign::Positive);
    assert_eq!(incircle_canonical(a, b, c, scaled(a, 3.0)), Sign::Zero);
}

#[test]
fn the_order_is_total_and_ignores_lengths() {
    let mut all = Vec::new();
    for x in -2..3 {
        for y in -2..3 {
            for z in -2..3 {
                if [x, y, z] != [0; 3] {
                    all.push([x, y, z].map(f64::from));
                }
            }
        }
    }
    all.sort_by(|&a, &b| compare(a, b));
    let sign = |v: Point3| v.map(|x| x.partial_cmp(&0.0).unwrap() as i8);
    let mut classes: Vec<_> = all.iter().map(|&v| sign(v)).collect();
    classes.dedup_by_key(|v| {
        (
            v[0],
            if v[0] == 0 {
                (v[1], if v[1] == 0 { v[2] } else { 0 })
            } else {
                (0, 0)
            },
        )
    });
    let classes = classes
        .iter()
        .map(|v| [v[0], if v[0] == 0 { v[1] } else { 0 }]);
    let expected = [[-1, 0], [0, -1], [0, 0], [0, 0], [0, 1], [1, 0]];
    assert!(classes.eq(expected));
    for (i, &a) in all.iter().enumerate() {
        for (j, &b) in all.iter().enumerate() {
            let equal = {
                let cross = |k: usize, l: usize| a[k] * b[l] - a[l] * b[k];
                let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                cross(0, 1) == 0.0 && cross(1, 2) == 0.0 && cross(2, 0) == 0.0 && dot > 0.0
            };
            let order = compare(a, b);
            assert_eq!(order == Ordering::Equal, equal, "{a:?} {b:?}");
            assert!(equal || order == i.cmp(&j));
            let far = scaled(b, 1e-300);
            assert!(
                !equal || compare(a, far) == order || b.iter().any(|x| x * 1e-300 / 1e-300 != *x)
            );
            assert_eq!(compare(a, scaled(b, power_of_two(-900))), order);
            assert_eq!(compare(a, scaled(b, 3.0)), order);
        }
    }
}

#[test]
fn units_are_right_to_a_hundred_bits() {
    let (mut random, mut worst) = (Random(8), 0.0_f64);
    for case in 0..3000 {
        let mut v = gauss(&mut random);
        if case % 3 == 1 {
            v = scaled(v, power_of_two(random.integer(-1000, 1000)));
        } else if case % 3 == 2 {
            v[case % 2] *= power_of_two(random.integer(-60, 0));
        }
        let unit = Unit::of(v);
        let (rows, n) = (whole(v), square(&whole(v)));
        // In units of 2^-1400: v / |v| = v sqrt n / n.
        let root = (&n << 2800_u32).sqrt();
        for (k, x) in rows.iter().enumerate() {
            let exact = x * &root / &n;
            // The doubles are multiples of 2^-1074.
            let sum = (crate::oracle::units(unit.hi[k]) + crate::oracle::units(unit.lo[k]))
                << (1400 - 1074);
            let error: BigInt = sum - &exact;
            let error = error.abs();
            if exact.bits() > 700 {
                let part: BigInt = (error << 200_u32) / exact.abs();
                worst = worst.max(part.to_string().parse::<f64>().unwrap() / 2f64.powi(200));
            }
        }
        let size: f64 = unit.hi.iter().map(|x| x * x).sum();
        assert!((size - 1.0).abs() < 1e-15);
    }
    // The proven bound is 2^-100.9; this is about what is seen.
    assert!(worst < 2f64.powf(-103.5), "2^{}", worst.log2());
    assert!(
        worst > 2f64.powi(-110),
        "the check sees the error: 2^{}",
        worst.log2()
    );
}

#[test]
fn the_nearer_direction_is_the_one_with_the_larger_cosine() {
    let (mut random, mut ties) = (Random(9), 0);
    for case in 0..4000 {
        let lattice = case % 2 == 0;
        let [q, a, b] = [(); 3].map(|()| {
            loop {
                let v = match lattice {
                    true => [(); 3].map(|()| random.integer(-2, 2) as f64),
                    false => gauss(&mut random),
                };
                if v != [0.0; 3] {
                    return v;
                }
            }
        });
        let b = match case % 4 {
            1 => shaken(a, 1, &mut random),
            3 => scaled(a, power_of_two(random.integer(-900, 900)) * random.unit()),
            2 if case % 8 == 2 => scaled(a, [3.0, 5.0, 7.0][case % 3]),
            _ => b,
        };
        let [qq, aa, bb] = [q, a, b].map(whole);
        let dot = |x: &[BigInt], y: &[BigInt]| x.iter().zip(y).map(|(x, y)| x * y).sum::<BigInt>();
        let sign = sign_of_roots(&[(dot(&qq, &aa), square(&bb)), (-dot(&qq, &bb), square(&aa))]);
        assert_eq!(nearer(q, a, b), sign, "{q:?} {a:?} {b:?}");
        assert_eq!(nearer(q, b, a), -sign);
        ties += usize::from(sign.is_zero());
    }
    assert!(ties > 100, "{ties}");
}
