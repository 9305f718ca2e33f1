//! Areas that pairs of cells in the plane share, against rational numbers: which rings are accepted,
//! their areas, and what they share in either order, for rings of lattices and for any doubles.

#![no_main]

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::overlap::{Checked, Fault, Polygons, check_plane, overlaps_plane};
use delone_fuzz::Coordinates;
use delone_predicates::arithmetic::decode_odd;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use num_bigint::{BigInt, Sign};
use num_traits::{Signed, ToPrimitive, Zero};

const MOST: usize = 9;
/// Rings of any doubles have fewer corners, as their rational numbers are long.
const FEW: usize = 6;
/// Squares of larger numbers, and of smaller extents, are out of range.
const RANGE: [f64; 2] = [1e-120, 1e120];
/// The largest coordinate of a lattice.
const SIDE: i64 = 6;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    if bytes.ratio(1, 2) == Ok(true) {
        if let (Ok(p), Ok(q)) = (whole(&mut bytes), whole(&mut bytes)) {
            compare_lattices(&p, &q);
        }
    } else if let Ok(mut coordinates) = Coordinates::new(&mut bytes)
        && let (Ok(p), Ok(q)) = (
            any(&mut bytes, &mut coordinates),
            any(&mut bytes, &mut coordinates),
        )
    {
        compare_any(&p, &q);
    }
});

/// Rings, each of which may be a hole.
struct Cell {
    rings: Vec<(bool, Vec<Point2>)>,
}

/// A cell as arrays.
struct Flat {
    points: Vec<Point2>,
    rings: Vec<i64>,
    cells: Vec<i64>,
    holes: Vec<bool>,
}

impl Flat {
    fn of(cells: &[&Cell]) -> Self {
        let mut flat = Self {
            points: Vec::new(),
            rings: vec![0],
            cells: vec![0],
            holes: Vec::new(),
        };
        for cell in cells {
            for (hole, ring) in &cell.rings {
                flat.points.extend(ring);
                flat.rings.push(flat.points.len() as i64);
                flat.holes.push(*hole);
            }
            flat.cells.push(flat.holes.len() as i64);
        }
        flat
    }

    fn polygons(&self) -> Polygons<'_, 2> {
        Polygons {
            vectors: &self.points,
            rings: &self.rings,
            cells: &self.cells,
            holes: &self.holes,
        }
    }

    fn checked(&self) -> Checked {
        check_plane(&self.polygons(), true, 1, &Watch::idle()).expect("finite points")
    }
}

/// The sum of the areas that cells share.
fn shared(p: &[&Cell], q: &[&Cell]) -> f64 {
    let (p, q) = (Flat::of(p), Flat::of(q));
    let found = overlaps_plane(&p.polygons(), &q.polygons(), 1, &Watch::idle());
    found.expect("finite points").areas.iter().sum()
}

/// Up to two rings of a small lattice.
fn whole(bytes: &mut Unstructured) -> Result<Cell> {
    let mut rings = Vec::new();
    for k in 0..bytes.int_in_range(1..=2)? {
        let side = bytes.int_in_range(1..=SIDE)?;
        let mut ring = Vec::new();
        for _ in 0..bytes.int_in_range(3..=MOST)? {
            let mut place = || bytes.int_in_range(-side..=side).map(|x| x as f64);
            ring.push([place()?, place()?]);
        }
        rings.push((k > 0, ring));
    }
    Ok(Cell { rings })
}

/// A ring of any doubles.
fn any(bytes: &mut Unstructured, coordinates: &mut Coordinates) -> Result<Cell> {
    let mut ring: Vec<Point2> = Vec::new();
    for _ in 0..bytes.int_in_range(3..=FEW)? {
        let next: Point2 = coordinates.point(bytes)?;
        // Moved from an earlier corner, or not.
        let near = match ring.is_empty() || bytes.ratio(1, 2)? {
            true => [0.0; 2],
            false => *bytes.choose(&ring)?,
        };
        ring.push([0, 1].map(|k| (near[k] + next[k]).clamp(-RANGE[1], RANGE[1])));
    }
    Ok(Cell {
        rings: vec![(false, ring)],
    })
}

/// A place of the plane: x, y and a positive divisor of both.
type Place = [BigInt; 3];

/// Places in units of a power of two, and its exponent, such that all are integers.
fn unit_of(cells: [&Cell; 2]) -> i64 {
    let rings = cells.iter().flat_map(|cell| &cell.rings);
    let all = rings.flat_map(|(_, ring)| ring.iter().flatten());
    let used = all.map(|&x| decode_odd(x)).filter(|x| x.0 != 0);
    used.map(|x| i64::from(x.1)).min().unwrap_or(0)
}

fn exact(v: Point2, unit: i64) -> Place {
    let integer = |x: f64| {
        let (magnitude, exponent) = decode_odd(x);
        if magnitude == 0 {
            return BigInt::ZERO;
        }
        let digits = BigInt::from(magnitude) << (i64::from(exponent) - unit) as usize;
        if x < 0.0 { -digits } else { digits }
    };
    [integer(v[0]), integer(v[1]), BigInt::from(1)]
}

/// The line through two places, as coefficients: positive to its left.
fn line(a: &Place, b: &Place) -> Place {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn at(line: &Place, p: &Place) -> BigInt {
    &line[0] * &p[0] + &line[1] * &p[1] + &line[2] * &p[2]
}

/// Twice the integral of the winding number of a ring over a counterclockwise triangle, times two to
/// the power of [`DIGITS`]: the ring is cut along each of its sides.
fn within(ring: &[Place], triangle: [&Place; 3]) -> BigInt {
    let mut ring = ring.to_vec();
    for k in 0..3 {
        let side = line(triangle[k], triangle[(k + 1) % 3]);
        let mut cut = Vec::new();
        for (i, q) in ring.iter().enumerate() {
            let p = &ring[(i + ring.len() - 1) % ring.len()];
            let (s, t) = (at(&side, p), at(&side, q));
            if (s.is_negative() && t.is_positive()) || (s.is_positive() && t.is_negative()) {
                let (s, t) = (s.abs(), t.abs());
                cut.push([0, 1, 2].map(|k| &p[k] * &t + &q[k] * &s));
            }
            if !t.is_negative() {
                cut.push(q.clone());
            }
        }
        ring = cut;
    }
    let terms = (0..ring.len()).map(|k| {
        let (p, q) = (&ring[k], &ring[(k + 1) % ring.len()]);
        ((&p[0] * &q[1] - &p[1] * &q[0]) << DIGITS) / (&p[2] * &q[2])
    });
    terms.sum()
}

/// Digits of areas behind the point.
const DIGITS: usize = 200;

/// The rings of a cell with what is inside to their left: their winding numbers are its own.
fn directed(cell: &Cell, unit: i64) -> Vec<Vec<Place>> {
    let rings = cell.rings.iter().map(|(hole, ring)| {
        let mut ring: Vec<Place> = ring.iter().map(|&v| exact(v, unit)).collect();
        let sides = (0..ring.len()).map(|k| line(&ring[k], &ring[(k + 1) % ring.len()]));
        let doubled: BigInt = sides.map(|[_, _, area]| area).sum();
        if doubled.is_negative() != *hole {
            ring.reverse();
        }
        ring
    });
    rings.collect()
}

/// The integral of the product of the winding numbers of two cells, in units: of fans of triangles in
/// the second one.
fn product(p: &[Vec<Place>], q: &[Vec<Place>]) -> BigInt {
    let mut sum = BigInt::ZERO;
    for other in q {
        for pair in other[1..].windows(2) {
            let turn = at(&line(&other[0], &pair[0]), &pair[1]);
            let triangle = match turn.sign() {
                Sign::Plus => [&other[0], &pair[0], &pair[1]],
                Sign::Minus => [&other[0], &pair[1], &pair[0]],
                Sign::NoSign => continue,
            };
            for ring in p {
                sum += turn.signum() * within(ring, triangle);
            }
        }
    }
    sum
}

/// The double next to an area.
fn rounded(doubled: &BigInt, unit: i64) -> f64 {
    let beyond = doubled.bits().saturating_sub(100);
    let head = (doubled >> beyond).to_f64().expect("a hundred bits");
    let power = beyond as i64 - DIGITS as i64 - 1 + 2 * unit;
    head * 2.0_f64.powi((power / 2) as i32) * 2.0_f64.powi((power - power / 2) as i32)
}

/// The winding numbers of rings around places that are on no side, in integers: the least and the
/// greatest.
fn windings(rings: &[&[Point2]]) -> [i64; 2] {
    let mut range = [0, 0];
    for i in -2 * SIDE..2 * SIDE {
        for j in -2 * SIDE..2 * SIDE {
            let [x, y] = [(i << 19) + 137, (j << 19) + 9973];
            let mut number = 0;
            for ring in rings {
                for k in 0..ring.len() {
                    let [a, b] =
                        [k, (k + 1) % ring.len()].map(|k| ring[k].map(|x| (x as i64) << 20));
                    let left = (b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1]) > 0;
                    number += i64::from(a[1] <= y && y < b[1] && left);
                    number -= i64::from(b[1] <= y && y < a[1] && !left);
                }
            }
            range = [range[0].min(number), range[1].max(number)];
        }
    }
    range
}

/// Rings of lattices: what is accepted, and what they share.
fn compare_lattices(p: &Cell, q: &Cell) {
    let known = Flat::of(&[p, q]).checked();
    let both = [p, q].map(|cell| directed(cell, 0));
    for (k, (cell, rings)) in [p, q].into_iter().zip(&both).enumerate() {
        if known.faults[k] == Fault::Crossing as u8 {
            return;
        }
        for (_, ring) in &cell.rings {
            let [low, high] = windings(&[ring]);
            assert!(high - low <= 1, "a ring that crosses itself");
        }
        if known.faults[k] != 0 {
            return;
        }
        let area = rounded(&product(rings, &directed(&square(), 0)), 0);
        assert!((known.areas[k] - area).abs() <= 1e-13 * area);
    }
    // How rings nest is decided elsewhere.
    let nested = |rings: &[Vec<Place>]| {
        let flat = |ring: &Vec<Place>| -> Vec<Point2> {
            let double = |x: &BigInt| x.to_f64().expect("a small integer");
            ring.iter()
                .map(|p| [double(&p[0]), double(&p[1])])
                .collect()
        };
        let all: Vec<Vec<Point2>> = rings.iter().map(flat).collect();
        let all: Vec<&[Point2]> = all.iter().map(|ring| &ring[..]).collect();
        windings(&all) == [0, 1]
    };
    if both.iter().all(|rings| nested(rings)) {
        let expected = rounded(&product(&both[0], &both[1]), 0);
        for found in [shared(&[p], &[q]), shared(&[q], &[p])] {
            assert!((found - expected).abs() <= 1e-11, "{found} {expected}");
        }
    }
}

/// Rings of any doubles: their areas, and what they share.
fn compare_any(p: &Cell, q: &Cell) {
    let [first, second] = [p, q].map(extent);
    let size = first.min(second);
    if size < RANGE[0] {
        return;
    }
    let known = Flat::of(&[p, q]).checked();
    if known.faults != [0, 0] {
        return;
    }
    let unit = unit_of([p, q]);
    let both = [p, q].map(|cell| directed(cell, unit));
    for (k, (rings, side)) in both.iter().zip([first, second]).enumerate() {
        let doubled: BigInt = rings[0]
            .windows(2)
            .map(|s| line(&s[0], &s[1])[2].clone())
            .sum();
        let last = line(&rings[0][rings[0].len() - 1], &rings[0][0]);
        let area = rounded(&((doubled + &last[2]) << DIGITS), unit);
        assert!((known.areas[k] - area).abs() <= 1e-15 * area + 1e-28 * side * side);
    }
    let expected = product(&both[0], &both[1]);
    let expected = if expected.is_zero() {
        0.0
    } else {
        rounded(&expected, unit)
    };
    for found in [shared(&[p], &[q]), shared(&[q], &[p])] {
        // Smaller parts are left out.
        let bound = 1e-15 * expected + 2e-24 * size * size;
        assert!((found - expected).abs() <= bound, "{found} {expected}");
    }
}

/// The longer side of the box of a ring.
fn extent(cell: &Cell) -> f64 {
    let ring = &cell.rings[0].1;
    let side = |k: usize| {
        let all = ring.iter().map(|v| v[k]);
        all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
    };
    side(0).max(side(1))
}

/// All of the lattice.
fn square() -> Cell {
    let s = SIDE as f64;
    Cell {
        rings: vec![(false, vec![[-s, -s], [s, -s], [s, s], [-s, s]])],
    }
}
