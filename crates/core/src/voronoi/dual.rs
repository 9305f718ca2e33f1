//! From triangles to vertices: centres, and which neighbouring triangles share theirs.

use delone_predicates::{Point2, incircle};

use super::center::{Center, Corners};
use super::regions::{Regions, Walk};
use super::ridges::{Ridges, ridges};

use crate::error::{Error, Result};
use crate::memory::{filled, zeroed};
use crate::parallel;
use crate::regular::power_sign;
use crate::watch::Watch;

/// Triangles that one task does.
const SHARE: usize = 1 << 14;
/// Triangles whose corners are fetched before the first of their centres is computed: loads that do
/// not wait for each other.
const BATCH: usize = 64;
/// Two roundings of one number, each within 4 units in the last place, differ by less than this
/// share of it.
const NEAR: f64 = 16.0 * f64::EPSILON;

/// A triangulation as arrays: vertices are rows of points, neighbours triangles or -1. With weights,
/// one for each point, it is the regular triangulation.
#[derive(Clone, Copy)]
pub struct Given<'a> {
    /// Coordinates, finite.
    pub points: &'a [Point2],
    /// Weights, finite; empty for none.
    pub weights: &'a [f64],
    /// Three rows a triangle, counter-clockwise.
    pub simplices: &'a [[i32; 3]],
    /// The triangle opposite each corner, -1 outside.
    pub neighbors: &'a [[i32; 3]],
}

impl Given<'_> {
    pub(super) fn weight(&self, v: i32) -> f64 {
        self.weights.get(v as usize).copied().unwrap_or(0.0)
    }

    pub(super) fn point(&self, v: i32) -> Point2 {
        self.points[v as usize]
    }

    fn corners(&self, t: usize) -> Corners {
        let s = self.simplices[t];
        Corners::new(s.map(|v| self.point(v)), s.map(|v| self.weight(v)))
    }

    /// The corner of `other` across which `t` lies.
    #[inline]
    pub(super) fn back(&self, t: usize, other: usize) -> Result<usize> {
        let row = self.neighbors[other];
        // Arithmetic in place of a search, whose branches nothing could predict.
        let back = usize::from(row[1] == t as i32) + 2 * usize::from(row[2] == t as i32);
        if back < 3 && row[back] == t as i32 {
            return Ok(back);
        }
        Err(Error::Shape(format!(
            "triangle {other} is no neighbour of {t}"
        )))
    }
}

/// What is the dual of the triangles, edges and points of a triangulation.
#[derive(Debug)]
pub struct Diagram {
    /// The vertices within the range of doubles, in the order of their first triangles.
    pub vertices: Vec<Point2>,
    /// The vertex of each triangle, or -1.
    pub triangle_vertex: Vec<i32>,
    /// Edges of cells.
    pub ridges: Ridges,
    /// Cells.
    pub regions: Regions,
}

/// The mask of a triangle: bit k where it shares its centre across edge k, bit 3 + k where the ridge
/// of edge k is numbered with it.
pub(super) const SHARED: u8 = 0b111;
pub(super) const OWNED: u32 = 3;

/// A triangle whose centre is beyond the range of doubles, and where that is, as in `Center::Beyond`.
type Far = (usize, Point2);

/// The diagram of a triangulation.
pub fn diagram(given: Given, workers: usize, watch: &Watch) -> Result<Diagram> {
    let (mut vertices, beyond) = centers(given, workers)?;
    watch.check()?;
    let masks = masks(given, &vertices, workers)?;
    watch.check()?;
    let (triangle_vertex, far) = number(given, &masks, &mut vertices, &beyond)?;
    watch.check()?;
    let (ridges, first_ridge) = ridges(given, &masks, &triangle_vertex, &far, workers)?;
    watch.check()?;
    let walk = Walk {
        given,
        masks: &masks,
        vertex: &triangle_vertex,
        first_ridge: &first_ridge,
    };
    let regions = walk.regions(&ridges.sites, workers, watch)?;
    let mut triangle_vertex = triangle_vertex;
    if !far.is_empty() {
        triangle_vertex.iter_mut().for_each(|v| *v = (*v).max(-1));
    }
    Ok(Diagram {
        vertices,
        triangle_vertex,
        ridges,
        regions,
    })
}

/// The centre of each triangle, NaN for those beyond the range, which are listed.
fn centers(given: Given, workers: usize) -> Result<(Vec<Point2>, Vec<Far>)> {
    let mut centers = zeroed(given.simplices.len())?;
    let tasks = centers.chunks_mut(SHARE).enumerate().collect();
    let found = parallel::map(workers, tasks, |(i, part): (usize, &mut [Point2])| {
        let mut beyond = Vec::new();
        let mut batch = [given.corners(i * SHARE); BATCH];
        for (j, part) in part.chunks_mut(BATCH).enumerate() {
            let from = i * SHARE + j * BATCH;
            for (t, corners) in (from..from + part.len()).zip(&mut batch) {
                *corners = given.corners(t);
            }
            for (t, (slot, corners)) in (from..).zip(part.iter_mut().zip(&batch)) {
                *slot = match corners.center() {
                    Center::At(at) => at,
                    Center::Beyond(at) => {
                        beyond.push((t, at));
                        [f64::NAN; 2]
                    }
                };
            }
        }
        beyond
    });
    Ok((centers, found.into_iter().flatten().collect()))
}

fn masks(given: Given, centers: &[Point2], workers: usize) -> Result<Vec<u8>> {
    let mut masks = filled(given.simplices.len(), 0_u8)?;
    let tasks = masks.chunks_mut(SHARE).enumerate().collect();
    let done = parallel::map(workers, tasks, |(i, part): (usize, &mut [u8])| {
        for (t, mask) in (i * SHARE..).zip(part) {
            for k in 0..3 {
                let other = given.neighbors[t][k];
                let shared = other >= 0 && share_center(given, centers, t, other as usize)?;
                let owned = !shared && other < t as i32;
                *mask |= u8::from(shared) << k | u8::from(owned) << (OWNED + k as u32);
            }
        }
        Ok(())
    });
    done.into_iter().collect::<Result<()>>()?;
    Ok(masks)
}

/// Whether triangle `t` and its neighbour `other` have one centre, exactly.
#[inline]
fn share_center(given: Given, centers: &[Point2], t: usize, other: usize) -> Result<bool> {
    let (here, there) = (centers[t], centers[other]);
    // Written so that NaN is near.
    let apart = |i: usize| {
        (here[i] - there[i]).abs() > NEAR * here[i].abs().max(there[i].abs()) + f64::MIN_POSITIVE
    };
    if apart(0) || apart(1) {
        return Ok(false);
    }
    tied(given, t, other)
}

#[cold]
#[inline(never)]
fn tied(given: Given, t: usize, other: usize) -> Result<bool> {
    let apex = given.simplices[other][given.back(t, other)?];
    let [a, b, c] = given.simplices[t];
    let points = [a, b, c, apex].map(|v| given.point(v));
    let sign = if given.weights.is_empty() {
        let [a, b, c, d] = points;
        incircle(a, b, c, d)
    } else {
        power_sign(points, [a, b, c, apex].map(|v| given.weight(v)))
    };
    Ok(sign.is_zero())
}

/// The vertex of each triangle: its number, or !i for number i of the far ones, whose places are the
/// second result. `centers` becomes the list of vertices.
fn number(
    given: Given,
    masks: &[u8],
    centers: &mut Vec<Point2>,
    beyond: &[Far],
) -> Result<(Vec<i32>, Vec<Point2>)> {
    const NONE: i32 = i32::MIN;
    let mut vertex = filled(masks.len(), NONE)?;
    let mut far = Vec::new();
    let mut stack = Vec::new();
    let mut count = 0;
    for t in 0..masks.len() {
        if vertex[t] != NONE {
            continue;
        }
        let mut at = centers[t];
        let mut place = None;
        if masks[t] & SHARED != 0
            && !at[0].is_nan()
            && let Center::At(rounded) = given.corners(t).rounded()
        {
            // Rounded correctly it is the same whichever of the triangles comes first.
            at = rounded;
        }
        if at[0].is_nan() {
            let found = beyond.binary_search_by_key(&t, |&(t, _)| t);
            place = found.ok().map(|i| beyond[i].1);
        }
        let number = match place {
            Some(place) => {
                far.push(place);
                !(far.len() as i32 - 1)
            }
            None => {
                centers[count] = at;
                count += 1;
                count as i32 - 1
            }
        };
        vertex[t] = number;
        if masks[t] & SHARED == 0 {
            continue;
        }
        stack.push(t);
        // Each triangle is numbered once and pushed then.
        while let Some(t) = stack.pop() {
            for k in (0..3).filter(|k| masks[t] >> k & 1 == 1) {
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
