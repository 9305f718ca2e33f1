//! Exact 3-D Laplace weights in integers, for queries where doubles are not certain.
//!
//! All coordinates are multiples of a power of two; in that unit the query has a distance of at
//! least 1 from every site. Each term is a quotient of integers, computed in fixed point with
//! `DIGITS` binary places. Terms cancel, but their sum does not vanish:
//!
//! - Inside the hull, let r be the distance from the query to the wall of its cell in some direction,
//!   and h that of the plane of the wall, half of the distance to its neighbor. A solid angle there has
//!   the area r^3 / h on the wall, so it adds r^3 / (2 h^2) >= r / 2 to the weights. The circle of half
//!   the least distance is in the cell, so the sum is at least pi; here everything is taken eight times.
//! - In a plane of the hull that circle is part of the area taken, eight times which is at least 6.
//!
//! So nearly all of the digits are left, for any sites.
//!
//! # No square roots
//!
//! The share of a tetrahedron from the query to a, b and c in the face toward a consists of two
//! triangles. One of them lies between the midpoint of the segment to a, the center of the circle
//! through the query, a and b, and the center of the sphere. Its legs are |a| / 2 times the
//! cotangent at b and, with n = a x b, the height of the center m of the sphere over the plane of
//! that circle, m . n / |n|. The cotangent is b . (b - a) / |n|, so the root cancels, and the area
//! over |a| is b . (b - a) m . n / (4 n . n). In a plane of the hull the ratio of all areas to
//! their projections along an axis is the same, and cancels, too.

use delone_predicates::Point3;
use num_bigint::{BigInt, Sign};

use super::cavity::Face;
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::base::wide::{lowest, ratio, scaled};

/// Binary places of a term.
const DIGITS: usize = 160;

/// Tetrahedra of a cavity whose search takes about as long as one face here.
const FACE: usize = 40;

type Vector = [BigInt; 3];

/// Sites relative to a query, in integers.
struct Seen(Vec<Vector>);

/// The weights of a query inside the hull, with its neighbors and the rim of its cavity; `None` if
/// there are none: then the tetrahedra are not Delaunay.
#[cold]
#[inline(never)]
pub fn inside(
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
        // The center of the sphere, times twice the volume.
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

/// The same for a query in the plane of some hull faces: the areas that it would take there. Each
/// of `edges`, around those faces, has them on its left.
#[cold]
#[inline(never)]
pub fn on_hull(
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

/// Eight times the area of a triangle that is nearest to each corner, over the cosine of the angle
/// between its plane and the axis, which is chosen at the first call; `None` if it is not
/// counterclockwise.
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

/// Normalizes the sum to 1.
fn shares(mut sums: Vec<BigInt>) -> Option<Vec<f64>> {
    // A negative sum is the rounding of terms that cancel.
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
