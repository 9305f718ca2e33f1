//! Triangulations of directions, with arcs: checked by integers, and the same for every order of the rows
//! and any lengths.

#![no_main]

use std::cmp::Ordering;
use std::collections::BTreeSet;

use delone_core::Point3;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::sphere::{Constrained, constrain, triangulate};
use delone_fuzz::Coordinates;
use delone_fuzz::oracle::directions::{true_incircle, true_orient, whole};
use delone_fuzz::oracle::points::{power_of_two, ulps};
use delone_predicates::Sign;
use libfuzzer_sys::arbitrary::{Result, Unstructured};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};

/// More rows make a run slower; ties among few are harder.
const MOST: usize = 24;
const MOST_ARCS: usize = 8;

type Arcs = Vec<[u32; 2]>;
type Shapes = BTreeSet<[u32; 3]>;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Ok((vectors, arcs)) = read(&mut Unstructured::new(bytes)) {
        let rows = Rows::of(&vectors);
        let plain = rows.check(&vectors, &[]);
        rows.check_other_order(&vectors, &[], &plain);
        if !arcs.is_empty() {
            let with_arcs = rows.check(&vectors, &arcs);
            rows.check_other_order(&vectors, &arcs, &with_arcs);
        }
    }
});

/// Vectors, in ways that are hard, and pairs of their rows.
fn read(bytes: &mut Unstructured) -> Result<(Vec<Point3>, Arcs)> {
    let shape = bytes.int_in_range(0..=6)?;
    let count = bytes.int_in_range(3..=if shape == 0 { MOST / 2 } else { MOST })?;
    let side = bytes.int_in_range(1..=5_i32)?;
    let mut coordinates = Coordinates::new(bytes)?;
    let mut vectors: Vec<Point3> = Vec::new();
    for _ in 0..count {
        let [x, y, z] = [
            f64::from(bytes.int_in_range(-side..=side)?),
            f64::from(bytes.int_in_range(-side..=side)?),
            f64::from(bytes.int_in_range(-side..=side)?),
        ];
        let v = match shape {
            0 => coordinates.point(bytes)?,
            1 => [x, y, z],
            // In a hemisphere with its boundary, in a cap, and most of them on one circle.
            2 => [x, y, z.abs()],
            3 => [x, y, f64::from(side)],
            4 => [x, y, if bytes.ratio(1, 8)? { z } else { -x - y }],
            // Neighboring doubles, also of opposite directions.
            5 => [
                ulps(1.0, x as i64),
                ulps(2.0, y as i64),
                ulps(0.5, z as i64),
            ],
            _ => {
                let unit = power_of_two(bytes.int_in_range(-60..=-1)?);
                [x + unit, y - unit * z, z]
            }
        };
        let length = match bytes.int_in_range(0..=3)? {
            0 => power_of_two(bytes.int_in_range(-30..=30)?),
            1 if shape < 5 && shape > 0 => *bytes.choose(&[3.0, 5.0, 1_000_003.0])?,
            2 if shape == 5 => -1.0,
            _ => 1.0,
        };
        let longer = v.map(|x| x * length);
        let v = if longer.iter().all(|x| x.is_finite()) {
            longer
        } else {
            v
        };
        if v != [0.0; 3] {
            vectors.push(v);
        }
    }
    if vectors.is_empty() {
        vectors.push([1.0, 0.0, 0.0]);
    }
    let mut arcs = Vec::new();
    while !bytes.is_empty() && arcs.len() < MOST_ARCS {
        let last = vectors.len() as u32 - 1;
        arcs.push([bytes.int_in_range(0..=last)?, bytes.int_in_range(0..=last)?]);
    }
    Ok((vectors, arcs))
}

fn cross(a: &[BigInt], b: &[BigInt]) -> Vec<BigInt> {
    (0..3)
        .map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            &a[i] * &b[j] - &a[j] * &b[i]
        })
        .collect()
}

fn dot(a: &[BigInt], b: &[BigInt]) -> BigInt {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn is_same(a: &[BigInt], b: &[BigInt]) -> bool {
    cross(a, b).iter().all(Zero::is_zero) && dot(a, b).is_positive()
}

/// The order of directions that breaks ties.
fn compare(a: &[BigInt], b: &[BigInt]) -> Ordering {
    let axis = |v: &[BigInt]| v.iter().position(|x| !x.is_zero()).expect("a direction");
    // Classes from 0, x < 0, to 5, x > 0.
    let class = |v: &[BigInt]| match (axis(v), v[axis(v)].is_negative()) {
        (k, true) => k,
        (k, false) => 5 - k,
    };
    let k = axis(a);
    class(a).cmp(&class(b)).then_with(|| {
        // The quotients by the magnitude of the coordinate that both have.
        let (p, q) = (a[k].abs(), b[k].abs());
        (k + 1..3)
            .map(|i| (&a[i] * &q).cmp(&(&b[i] * &p)))
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    })
}

/// Whether `d` is inside the circle of the others, with ties.
fn is_inside(four: [Point3; 4]) -> bool {
    let sign = match true_incircle(four) {
        Sign::Zero => {
            let smallest = (0..4)
                .min_by(|&i, &j| compare(&whole(four[i]), &whole(four[j])))
                .expect("four");
            let [a, b, c, d] = four;
            let others = [[b, c, d], [a, c, d], [a, b, d], [a, b, c]][smallest];
            let turn = true_orient(others);
            if smallest % 2 == 1 { turn } else { -turn }
        }
        sign => sign,
    };
    sign == Sign::Positive
}

/// What integers say about the rows.
struct Rows {
    whole: Vec<Vec<BigInt>>,
    /// The first row of the same direction.
    first: Vec<u32>,
}

impl Rows {
    fn of(vectors: &[Point3]) -> Self {
        let whole: Vec<_> = vectors.iter().map(|&v| whole(v)).collect();
        let first = (0..whole.len())
            .map(|i| (0..=i).find(|&j| is_same(&whole[i], &whole[j])).expect("i") as u32)
            .collect();
        Self { whole, first }
    }

    fn at(&self, row: u32) -> &[BigInt] {
        &self.whole[row as usize]
    }

    fn distinct(&self) -> impl Iterator<Item = u32> {
        (0u32..)
            .zip(&self.first)
            .filter(|x| x.0 == *x.1)
            .map(|x| x.0)
    }

    /// Whether `p` is strictly inside the arc from `a` to `b`.
    fn is_on(&self, [a, b]: [u32; 2], p: &[BigInt]) -> bool {
        let (a, b) = (self.at(a), self.at(b));
        let normal = cross(a, b);
        dot(&normal, p).is_zero()
            && dot(&normal, &cross(a, p)).is_positive()
            && dot(&normal, &cross(p, b)).is_positive()
    }

    /// The vertices along an arc, its ends included.
    fn chain(&self, [a, b]: [u32; 2]) -> Vec<u32> {
        let normal = cross(self.at(a), self.at(b));
        let mut chain: Vec<u32> = self
            .distinct()
            .filter(|&p| self.is_on([a, b], self.at(p)))
            .collect();
        chain.sort_by(|&p, &q| {
            let turn = dot(&normal, &cross(self.at(p), self.at(q)));
            BigInt::zero().cmp(&turn)
        });
        chain.insert(0, self.first[a as usize]);
        chain.push(self.first[b as usize]);
        chain
    }

    fn do_cross(&self, s: [u32; 2], t: [u32; 2]) -> bool {
        let normal = |[a, b]: [u32; 2]| cross(self.at(a), self.at(b));
        let meet = cross(&normal(s), &normal(t));
        let opposite: Vec<BigInt> = meet.iter().map(|x| -x).collect();
        [meet, opposite].iter().any(|p| {
            p.iter().any(|x| !x.is_zero())
                && self.is_on(s, p)
                && self.is_on(t, p)
                && !self.whole.iter().any(|v| is_same(v, p))
        })
    }

    /// The triangles by the first rows of their corners, from the smallest on; or the name of an error.
    fn check(&self, vectors: &[Point3], arcs: &[[u32; 2]]) -> std::result::Result<Shapes, &str> {
        let made = match made(vectors, arcs) {
            Ok(made) => made,
            Err(error) => return Err(self.check_error(&error, arcs)),
        };
        assert!(self.refusal(arcs).is_none(), "{arcs:?}");
        let all = (0u32..).zip(&self.first);
        let duplicates = all
            .filter(|x| x.0 != *x.1)
            .map(|(row, &first)| [row, first]);
        assert_eq!(made.duplicates, duplicates.collect::<Vec<_>>());
        self.check_triangles(vectors, &made);
        self.check_arcs(arcs, &made);
        Ok(made
            .arrays
            .simplices
            .iter()
            .map(|t| turned(t.map(|v| v as u32)))
            .collect())
    }

    /// Why there is no answer, if integers say so.
    fn refusal(&self, arcs: &[[u32; 2]]) -> Option<&'static str> {
        let rows: Vec<u32> = self.distinct().collect();
        let off = |v: u32| {
            let plane = |w: u32| cross(self.at(rows[0]), self.at(w));
            let normal = rows
                .iter()
                .map(|&w| plane(w))
                .find(|n| n.iter().any(|x| !x.is_zero()));
            normal.is_some_and(|n| !dot(&n, self.at(v)).is_zero())
        };
        if !rows.iter().any(|&v| off(v)) {
            return Some("circle");
        }
        let is_opposite = |&[a, b]: &[u32; 2]| {
            let back: Vec<BigInt> = self.at(b).iter().map(|x| -x).collect();
            is_same(self.at(a), &back)
        };
        if arcs.iter().any(is_opposite) {
            return Some("opposite");
        }
        (!self.crossing(arcs).is_empty()).then_some("crossing")
    }

    fn crossing(&self, arcs: &[[u32; 2]]) -> Arcs {
        let pairs = (0..arcs.len()).flat_map(|i| (i + 1..arcs.len()).map(move |j| [i, j]));
        pairs
            .filter(|&[i, j]| self.do_cross(arcs[i], arcs[j]))
            .map(|pair| pair.map(|i| i as u32))
            .collect()
    }

    fn check_error(&self, error: &Error, arcs: &[[u32; 2]]) -> &'static str {
        let refusal = self.refusal(arcs).expect("a reason");
        match error {
            Error::OneGreatCircle { chain } => {
                let named: BTreeSet<u32> = chain.iter().copied().collect();
                assert!(refusal == "circle" && self.distinct().eq(named));
            }
            Error::OppositeEnds { .. } => assert_eq!(refusal, "opposite"),
            Error::CrossingArcs { pairs } => {
                assert_eq!(refusal, "crossing");
                assert_eq!(*pairs, self.crossing(arcs));
            }
            other => panic!("{other}"),
        }
        refusal
    }

    /// Positive triangles that meet edge to edge in all directions; edges that are not constrained are
    /// Delaunay, and those of the boundary have no vertex beyond.
    fn check_triangles(&self, vectors: &[Point3], made: &Constrained) {
        let (simplices, neighbors) = (&made.arrays.simplices, &made.arrays.neighbors);
        let at = |v: i32| vectors[v as usize];
        let (mut used, mut rim) = (BTreeSet::new(), 0);
        for (t, corners) in simplices.iter().enumerate() {
            used.extend(corners.map(|v| v as u32));
            assert_eq!(true_orient(corners.map(at)), Sign::Positive);
            for k in 0..3 {
                let [u, v] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let Ok(beside) = usize::try_from(neighbors[t][k]) else {
                    rim += 1;
                    assert!(
                        (0..vectors.len() as i32)
                            .all(|w| true_orient([at(u), at(v), at(w)]) != Sign::Negative)
                    );
                    continue;
                };
                let other = simplices[beside];
                let j = (0..3).find(|&j| [other[(j + 2) % 3], other[(j + 1) % 3]] == [u, v]);
                let j = j.expect("a common edge");
                assert_eq!(neighbors[beside][j], t as i32);
                assert_eq!(made.constrained[beside][j], made.constrained[t][k]);
                let [a, b, c] = corners.map(at);
                assert!(made.constrained[t][k] || !is_inside([a, b, c, at(other[j])]));
            }
        }
        assert!(self.distinct().eq(used.iter().copied()));
        let border = if rim == 0 { 4 } else { rim + 2 };
        assert_eq!(simplices.len(), 2 * used.len() - border);
    }

    /// The constrained edges are those that the arcs consist of.
    fn check_arcs(&self, arcs: &[[u32; 2]], made: &Constrained) {
        let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
        let mut wanted = BTreeSet::new();
        for &arc in arcs {
            if arc.map(|row| self.first[row as usize])[0] != self.first[arc[1] as usize] {
                wanted.extend(
                    self.chain(arc)
                        .windows(2)
                        .map(|pair| edge(pair[0], pair[1])),
                );
            }
        }
        let mut marked = BTreeSet::new();
        for (corners, flags) in made.arrays.simplices.iter().zip(&made.constrained) {
            for k in (0..3).filter(|&k| flags[k]) {
                marked.insert(edge(
                    corners[(k + 1) % 3] as u32,
                    corners[(k + 2) % 3] as u32,
                ));
            }
        }
        assert_eq!(marked, wanted);
        let ends = made.subsegments.ends.iter();
        let listed: Vec<_> = ends.map(|&[a, b]| edge(a as u32, b as u32)).collect();
        assert_eq!(listed.len(), wanted.len());
        assert_eq!(BTreeSet::from_iter(listed), wanted);
    }

    /// The same with all rows reversed, the arcs, too, and other lengths.
    fn check_other_order(
        &self,
        vectors: &[Point3],
        arcs: &[[u32; 2]],
        expected: &std::result::Result<Shapes, &str>,
    ) {
        let last = vectors.len() as u32 - 1;
        let shorter = |v: &Point3| {
            let half = v.map(|x| x / 1024.0);
            if half.map(|x| x * 1024.0) == *v {
                half
            } else {
                *v
            }
        };
        let back: Vec<Point3> = vectors.iter().rev().map(shorter).collect();
        let turned_arcs: Arcs = arcs
            .iter()
            .rev()
            .map(|&[a, b]| [last - b, last - a])
            .collect();
        let found = made(&back, &turned_arcs).map(|made| {
            let name = |v: i32| self.first[(last - v as u32) as usize];
            made.arrays
                .simplices
                .iter()
                .map(|t| turned(t.map(name)))
                .collect::<Shapes>()
        });
        match (expected, found) {
            (Ok(expected), Ok(found)) => assert_eq!(*expected, found),
            (expected, found) => assert!(expected.is_err() && found.is_err()),
        }
    }
}

fn turned(mut corners: [u32; 3]) -> [u32; 3] {
    let smallest = (0..3).min_by_key(|&k| corners[k]).expect("three");
    corners.rotate_left(smallest);
    corners
}

/// The triangulation; without arcs it must be the same from both calls.
fn made(vectors: &[Point3], arcs: &[[u32; 2]]) -> std::result::Result<Constrained, Error> {
    let made = constrain(vectors, arcs, 1, &Watch::idle());
    if arcs.is_empty() {
        match (&made, triangulate(vectors, 1, &Watch::idle())) {
            (Ok(made), Ok(plain)) => {
                assert_eq!(made.arrays.simplices, plain.arrays.simplices);
                assert_eq!(made.arrays.neighbors, plain.arrays.neighbors);
                assert_eq!(made.duplicates, plain.duplicates);
            }
            (made, plain) => assert_eq!(made.as_ref().err(), plain.as_ref().err()),
        }
    }
    made
}
