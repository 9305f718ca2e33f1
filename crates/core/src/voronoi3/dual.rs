//! From tetrahedra to vertices: centres, and which neighbouring tetrahedra share theirs.

use delone_predicates::{Point3, insphere};

use super::center::{Center, Corners};
use super::regions::{Regions, regions};
use super::ridges::{Ridges, ridges};
use crate::error::{Error, Result};
use crate::memory::filled;
use crate::parallel;
use crate::regular3::power_sign;
use crate::watch::Watch;

/// Tetrahedra that one task does.
const SHARE: usize = 1 << 14;
/// Two roundings of one number, each within 4 units in the last place, differ by less than this
/// share of it.
const NEAR: f64 = 16.0 * f64::EPSILON;

/// A triangulation as arrays: vertices are rows of points, neighbours tetrahedra or -1. With weights,
/// one for each point, it is the regular triangulation.
#[derive(Clone, Copy)]
pub struct Given<'a> {
    /// Coordinates, finite.
    pub points: &'a [Point3],
    /// Weights, finite; empty for none.
    pub weights: &'a [f64],
    /// Four rows a tetrahedron, positively oriented.
    pub simplices: &'a [[i32; 4]],
    /// The tetrahedron opposite each corner, -1 outside.
    pub neighbors: &'a [[i32; 4]],
}

impl Given<'_> {
    pub(super) fn weight(&self, v: i32) -> f64 {
        self.weights.get(v as usize).copied().unwrap_or(0.0)
    }

    pub(super) fn point(&self, v: i32) -> Point3 {
        self.points[v as usize]
    }

    fn corners(&self, t: usize) -> Corners {
        let s = self.simplices[t];
        Corners::new(s.map(|v| self.point(v)), s.map(|v| self.weight(v)))
    }

    /// The corner of `other` across which `t` lies.
    #[inline]
    pub(super) fn back(&self, t: usize, other: usize) -> Result<usize> {
        let back = self.neighbors[other].iter().position(|&x| x == t as i32);
        back.ok_or_else(|| Error::Shape(format!("tetrahedron {other} is no neighbour of {t}")))
    }
}

/// What is the dual of the tetrahedra, edges and points of a triangulation.
#[derive(Debug)]
pub struct Diagram {
    /// The vertices within the range of doubles, in the order of their first tetrahedra.
    pub vertices: Vec<Point3>,
    /// The vertex of each tetrahedron, or -1.
    pub simplex_vertex: Vec<i32>,
    /// Faces of cells.
    pub ridges: Ridges,
    /// Cells.
    pub regions: Regions,
}

/// A tetrahedron whose centre is beyond the range of doubles, and the direction of that.
type Far = (usize, Point3);

/// The diagram of a triangulation.
pub fn diagram(given: Given, workers: usize, watch: &Watch) -> Result<Diagram> {
    let (mut vertices, beyond) = centers(given, workers)?;
    watch.check()?;
    let shared = shared(given, &vertices, workers)?;
    watch.check()?;
    let (mut simplex_vertex, far) = number(given, &shared, &mut vertices, &beyond)?;
    watch.check()?;
    let ridges = ridges(given, &simplex_vertex, far, workers, watch)?;
    watch.check()?;
    let regions = regions(given, &simplex_vertex, &ridges, workers, watch)?;
    simplex_vertex.iter_mut().for_each(|v| *v = (*v).max(-1));
    Ok(Diagram {
        vertices,
        simplex_vertex,
        ridges,
        regions,
    })
}

/// The centre of each tetrahedron, NaN for those beyond the range, which are listed.
fn centers(given: Given, workers: usize) -> Result<(Vec<Point3>, Vec<Far>)> {
    let mut centers = filled(given.simplices.len(), [0.0; 3])?;
    let tasks = centers.chunks_mut(SHARE).enumerate().collect();
    let found = parallel::map(workers, tasks, |(i, part): (usize, &mut [Point3])| {
        let mut beyond = Vec::new();
        for (t, slot) in (i * SHARE..).zip(part) {
            *slot = match given.corners(t).center() {
                Center::At(at) => at,
                Center::Beyond(direction) => {
                    beyond.push((t, direction));
                    [f64::NAN; 3]
                }
            };
        }
        beyond
    });
    Ok((centers, found.into_iter().flatten().collect()))
}

/// For each tetrahedron the faces, as bits, across which its centre is that of the neighbour.
fn shared(given: Given, centers: &[Point3], workers: usize) -> Result<Vec<u8>> {
    let mut masks = filled(given.simplices.len(), 0_u8)?;
    let tasks = masks.chunks_mut(SHARE).enumerate().collect();
    let done = parallel::map(workers, tasks, |(i, part): (usize, &mut [u8])| {
        for (t, mask) in (i * SHARE..).zip(part) {
            for k in 0..4 {
                let other = given.neighbors[t][k];
                let shared = other >= 0 && share_center(given, centers, t, other as usize)?;
                *mask |= u8::from(shared) << k;
            }
        }
        Ok(())
    });
    done.into_iter().collect::<Result<()>>()?;
    Ok(masks)
}

/// Whether tetrahedron `t` and its neighbour `other` have one centre, exactly.
#[inline]
fn share_center(given: Given, centers: &[Point3], t: usize, other: usize) -> Result<bool> {
    let (here, there) = (centers[t], centers[other]);
    // Written so that NaN is near.
    let apart = |i: usize| {
        (here[i] - there[i]).abs() > NEAR * here[i].abs().max(there[i].abs()) + f64::MIN_POSITIVE
    };
    if (0..3).any(apart) {
        return Ok(false);
    }
    tied(given, t, other)
}

#[cold]
#[inline(never)]
fn tied(given: Given, t: usize, other: usize) -> Result<bool> {
    let apex = given.simplices[other][given.back(t, other)?];
    let [a, b, c, d] = given.simplices[t];
    let sites = [a, b, c, d, apex];
    let points = sites.map(|v| given.point(v));
    let sign = if given.weights.is_empty() {
        let [a, b, c, d, e] = points;
        insphere(a, b, c, d, e)
    } else {
        power_sign(points, sites.map(|v| given.weight(v)))
    };
    Ok(sign.is_zero())
}

/// The vertex of each tetrahedron: its number, or !i for number i of the far ones, whose directions
/// are the second result. `centers` becomes the list of vertices.
fn number(
    given: Given,
    shared: &[u8],
    centers: &mut Vec<Point3>,
    beyond: &[Far],
) -> Result<(Vec<i32>, Vec<Point3>)> {
    const NONE: i32 = i32::MIN;
    let mut vertex = filled(shared.len(), NONE)?;
    let mut far = Vec::new();
    let mut stack = Vec::new();
    let mut count = 0;
    for t in 0..shared.len() {
        if vertex[t] != NONE {
            continue;
        }
        let mut at = centers[t];
        if shared[t] != 0
            && !at[0].is_nan()
            && let Center::At(rounded) = given.corners(t).rounded()
        {
            // Rounded correctly it is the same whichever of the tetrahedra comes first.
            at = rounded;
        }
        let place = beyond.binary_search_by_key(&t, |&(t, _)| t);
        let number = match place {
            Ok(i) => {
                far.push(beyond[i].1);
                !(far.len() as i32 - 1)
            }
            Err(_) => {
                centers[count] = at;
                count += 1;
                count as i32 - 1
            }
        };
        vertex[t] = number;
        stack.push(t);
        // Each tetrahedron is numbered once and pushed then.
        while let Some(t) = stack.pop() {
            for k in (0..4).filter(|k| shared[t] >> k & 1 == 1) {
                let other = given.neighbors[t][k] as usize;
                if vertex[other] == NONE {
                    vertex[other] = number;
                    stack.push(other);
                }
            }
        }
    }
    centers.truncate(count);
    Ok((vertex, far))
}
