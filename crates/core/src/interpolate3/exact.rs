//! Laplace weights in space where doubles do not tell them: their formulas in integers.
//!
//! All coordinates are multiples of a power of two; in that unit the query has a distance of at
//! least 1 from every site. Each term is a quotient of integers, taken in fixed point with `DIGITS`
//! binary places. Terms cancel, but their sum does not vanish:
//!
//! - In space, let r be the distance from the query to the wall of its cell in some direction, and h
//!   that of the plane of the wall, half of the way to its neighbour. A solid angle there has the
//!   area r^3 / h on the wall, so it adds r^3 / (2 h^2) >= r / 2 to the weights. The circle of half
//!   the least distance is in the cell, so the sum is at least pi; here all is taken eight times.
//! - In a plane of the hull that circle is part of the area taken, eight times which is at least 6.
//!
//! So nearly all of the digits are left, whatever the sites are.
//!
//! # No roots
//!
//! The share of a tetrahedron from the query to a, b and c in the face towards a has two triangles.
//! One of them lies between the middle of the way to a, the centre of the circle through the query,
//! a and b, and the centre of the sphere. Its legs are |a| / 2 times the cotangent at b and, with
//! n = a x b, the height of the centre m of the sphere over the plane of that circle, m . n / |n|. The
//! cotangent is b . (b - a) / |n|, so the root cancels, and the area over |a| is
//! b . (b - a) m . n / (4 n . n). In a plane of the hull all areas have a common factor to their
//! shadows along an axis, which cancels, too.

use delone_predicates::Point3;
use num_bigint::{BigInt, Sign};

use super::cavity::Face;
use crate::error::Result;
use crate::watch::Pace;
use crate::wide::{lowest, ratio, scaled};

/// Binary places of a term.
const DIGITS: usize = 160;

/// Tetrahedra of a cavity whose search takes about as long as one face here.
const FACE: usize = 40;

type Vector = [BigInt; 3];

/// Sites as seen from a query, in integers.
struct Seen(Vec<Vector>);

/// The weights of a query inside the hull, with its neighbours and the rim of its cavity; nothing
/// where there are none: the tetrahedra are no Delaunay tetrahedra then.
#[cold]
#[inline(never)]
pub fn in_space(
    points: &[Point3],
    rim: &[Face],
    q: Point3,
    pace: &mut Pace,
) -> Result<Option<Vec<f64>>> {
    let Seen(seen) = &Seen::from(points, q);
    let mut sums = vec![BigInt::ZERO; points.len()];
    for face in rim {
        pace.spend(FACE)?;
        let corners = face.corners.map(|i| i as usize);
        let sites = corners.map(|i| &seen[i]);
        let turns = [0, 1, 2].map(|k| cross(sites[(k + 1) % 3], sites[(k + 2) % 3]));
        let squares = sites.map(|p| dot(p, p));
        let volume = dot(sites[0], &turns[0]);
        if volume.sign() != Sign::Plus {
            return Ok(None);
        }
        // The centre of the sphere, times twice the volume.
        let center = [0, 1, 2].map(|x| (0..3).map(|k| &squares[k] * &turns[k][x]).sum());
        for (k, turn) in turns.iter().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let cosine = dot(sites[i], sites[j]);
            let height = dot(&center, turn);
            let under = dot(turn, turn) * &volume;
            add(
                &mut sums[corners[i]],
                (&squares[j] - &cosine) * &height,
                &under,
            );
            add(
                &mut sums[corners[j]],
                (&squares[i] - &cosine) * &height,
                &under,
            );
        }
    }
    Ok(shares(sums))
}

/// The same of a query in the plane of some hull faces: the areas that it would take there. Each of
/// `edges`, around those faces, has them on its left.
#[cold]
#[inline(never)]
pub fn in_plane(
    points: &[Point3],
    faces: &[[u32; 3]],
    edges: &[[u32; 2]],
    q: Point3,
    pace: &mut Pace,
) -> Result<Option<Vec<f64>>> {
    let Seen(seen) = &Seen::from(points, q);
    let zero = [BigInt::ZERO, BigInt::ZERO, BigInt::ZERO];
    let mut sums = vec![BigInt::ZERO; points.len()];
    let mut axis = None;
    for face in faces {
        pace.spend(FACE)?;
        let corners = face.map(|i| &seen[i as usize]);
        let Some(found) = parts(corners, &mut axis) else {
            return Ok(None);
        };
        for (i, (n, d)) in face.iter().zip(found) {
            add(&mut sums[*i as usize], n, &d);
        }
    }
    for edge in edges {
        pace.spend(FACE)?;
        let [u, v] = edge.map(|i| &seen[i as usize]);
        let Some(found) = parts([u, v, &zero], &mut axis) else {
            return Ok(None);
        };
        for (i, (n, d)) in edge.iter().zip(found) {
            add(&mut sums[*i as usize], -n, &d);
        }
    }
    Ok(shares(sums))
}

/// Eight times the area of a triangle that lies nearest to each corner, over the cosine of its plane and
/// the axis, which is found for the first one; nothing where it is not counter-clockwise.
fn parts(corners: [&Vector; 3], axis: &mut Option<(usize, Sign)>) -> Option<[(BigInt, BigInt); 3]> {
    let [a, b, c] = corners;
    let sides = [minus(c, b), minus(a, c), minus(b, a)];
    let turn = cross(&sides[0], &sides[1]);
    let steep = || (0..3).max_by_key(|&k| turn[k].magnitude().clone());
    let (axis, sign) = match *axis {
        Some(known) => known,
        None => *axis.insert(steep().map(|k| (k, turn[k].sign()))?),
    };
    if turn[axis].sign() != sign || sign == Sign::NoSign {
        return None;
    }
    let area = BigInt::from(turn[axis].magnitude().clone());
    let cotangents = [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        -dot(&sides[i], &sides[j]) * dot(&sides[k], &sides[k])
    });
    Some([0, 1, 2].map(|k| {
        let sum = &cotangents[(k + 1) % 3] + &cotangents[(k + 2) % 3];
        (sum, area.clone())
    }))
}

impl Seen {
    fn from(points: &[Point3], q: Point3) -> Self {
        let low = lowest(&[points, &[q]].concat(), &[]);
        let q = q.map(|x| scaled(x, low));
        let seen = |p: &Point3| [0, 1, 2].map(|k| scaled(p[k], low) - &q[k]);
        Self(points.iter().map(seen).collect())
    }
}

/// Adds a quotient in fixed point.
fn add(sum: &mut BigInt, n: BigInt, d: &BigInt) {
    *sum += (n << DIGITS) / d;
}

/// Makes the sum 1.
fn shares(mut sums: Vec<BigInt>) -> Option<Vec<f64>> {
    // Below zero is the rounding of terms that cancel.
    for part in &mut sums {
        if part.sign() == Sign::Minus {
            *part = BigInt::ZERO;
        }
    }
    let sum: BigInt = sums.iter().sum();
    if sum.sign() != Sign::Plus {
        return None;
    }
    sums.iter().map(|part| ratio(part, &sum, 0)).collect()
}

fn dot(p: &Vector, q: &Vector) -> BigInt {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

fn minus(p: &Vector, q: &Vector) -> Vector {
    [0, 1, 2].map(|k| &p[k] - &q[k])
}

fn cross(p: &Vector, q: &Vector) -> Vector {
    [0, 1, 2].map(|k| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        &p[x] * &q[y] - &p[y] * &q[x]
    })
}
