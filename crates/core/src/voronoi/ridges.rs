//! Edges of Voronoi cells: the duals of Delaunay edges, on the bisectors of their two sites.
//!
//! With weights, they lie on the radical axis of the sites.

use delone_predicates::Point2;

use super::given::Given;
use crate::base::error::Result;
use crate::base::memory::{push, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// The mask of a triangle: bit k if it shares its center across edge k, bit 3 + k if the ridge of
/// edge k is numbered with it.
pub(super) const SHARED: u8 = 0b111;
pub(super) const OWNED: u32 = 3;

/// Triangles per task.
const SHARE: usize = 1 << 14;

/// Edges of cells. The first site is on the left when going from the first end to the second.
#[derive(Debug, Default)]
pub struct Ridges {
    /// The two sites of each ridge.
    pub sites: Vec<[i32; 2]>,
    /// The two ends: a vertex, or !i for ray i. A ray comes first.
    pub ends: Vec<[i32; 2]>,
    /// The unit direction of each ray, away from the other end of the ridge.
    pub rays: Vec<Point2>,
    /// Ray: the out-of-range vertex to which it leads, with one coordinate or both infinite; NaN if
    /// it is unbounded.
    pub beyond: Vec<Point2>,
}

/// Ridges in the order of the triangles with which they are numbered, and the number of the first
/// ridge of each triangle. `far` are the out-of-range vertices.
pub(super) fn ridges(
    given: Given<2, 3>,
    masks: &[u8],
    vertex: &[i32],
    far: &[Point2],
    workers: usize,
    watch: &Watch,
) -> Result<(Ridges, Vec<u32>)> {
    let (first, starts, count) = count(masks)?;
    let mut sites = zeroed::<[i32; 2]>(count)?;
    let mut ends = zeroed::<[i32; 2]>(count)?;
    let mut tasks = Vec::with_capacity(starts.len());
    let (mut rest_sites, mut rest_ends) = (&mut sites[..], &mut ends[..]);
    for (i, w) in starts.windows(2).enumerate() {
        let (s, t) = rest_sites.split_at_mut(w[1] - w[0]);
        let (e, f) = rest_ends.split_at_mut(w[1] - w[0]);
        tasks.push((i * SHARE, s, e));
        (rest_sites, rest_ends) = (t, f);
    }
    let open = parallel::map_watched(workers, tasks, watch, |(from, sites, ends)| {
        fill(given, masks, vertex, from, sites, ends)
    })?;
    let (mut rays, mut beyond) = (Vec::new(), Vec::new());
    for (open, &start) in open.into_iter().zip(&starts) {
        for row in open.into_iter().map(|row| start + row) {
            for end in ends[row].into_iter().filter(|end| *end < 0) {
                let at = far.get(!end as usize).copied().unwrap_or([f64::NAN; 2]);
                push(&mut beyond, at)?;
            }
            close(given, &mut sites[row], &mut ends[row], &mut rays)?;
        }
    }
    let ridges = Ridges {
        sites,
        ends,
        rays,
        beyond,
    };
    Ok((ridges, first))
}

/// The first ridge of each triangle, the first one of each task, and how many there are.
fn count(masks: &[u8]) -> Result<(Vec<u32>, Vec<usize>, usize)> {
    let mut first = with_room(masks.len())?;
    let mut starts = Vec::with_capacity(masks.len() / SHARE + 2);
    let mut count = 0;
    for share in masks.chunks(SHARE) {
        starts.push(count as usize);
        for mask in share {
            first.push(count);
            count += (mask >> OWNED).count_ones();
        }
    }
    starts.push(count as usize);
    Ok((first, starts, count as usize))
}

/// Computes one task's share of the ridges, and returns which have an end that is not a vertex.
///
/// The direction from the triangle right of an edge (a, b) to the one left of it is b - a turned
/// left, so a lies on its left.
fn fill(
    given: Given<2, 3>,
    masks: &[u8],
    vertex: &[i32],
    from: usize,
    sites: &mut [[i32; 2]],
    ends: &mut [[i32; 2]],
) -> Result<Vec<usize>> {
    let mut open = Vec::new();
    let mut row = 0;
    for (t, mask) in (from..).zip(&masks[from..masks.len().min(from + SHARE)]) {
        for k in (0..3).filter(|k| mask >> (OWNED + *k as u32) & 1 == 1) {
            let s = given.simplices[t];
            let right = given.neighbors[t][k];
            let right = if right < 0 {
                i32::MIN
            } else {
                vertex[right as usize]
            };
            sites[row] = [s[(k + 1) % 3], s[(k + 2) % 3]];
            ends[row] = [right, vertex[t]];
            if right < 0 || vertex[t] < 0 {
                push(&mut open, row)?;
            }
            row += 1;
        }
    }
    Ok(open)
}

/// Adds rays to a ridge for the ends that are not vertices.
fn close(
    given: Given<2, 3>,
    sites: &mut [i32; 2],
    ends: &mut [i32; 2],
    rays: &mut Vec<Point2>,
) -> Result<()> {
    let [a, b] = sites.map(|v| given.point(v));
    let normal = unit([a[1], b[0]], [b[1], a[0]]);
    let back = normal.map(|x| 0.0 - x);
    for (end, outward) in ends.iter_mut().zip([back, normal]) {
        if *end >= 0 {
            continue;
        }
        *end = !(rays.len() as i32);
        push(rays, outward)?;
    }
    if ends[1] < 0 && ends[0] >= 0 {
        ends.swap(0, 1);
        sites.swap(0, 1);
    }
    Ok(())
}

/// The unit vector from `b` to `a`, which differ.
fn unit(a: Point2, b: Point2) -> Point2 {
    let mut v = [a[0] - b[0], a[1] - b[1]];
    if !v.iter().all(|x| x.is_finite()) {
        v = [a[0] / 2.0 - b[0] / 2.0, a[1] / 2.0 - b[1] / 2.0];
    }
    // Scaled by its larger component first, so that no square overflows or underflows.
    let longest = v[0].abs().max(v[1].abs());
    let share = v.map(|x| x / longest);
    let length = share[0].hypot(share[1]);
    // A direction that is not along an axis must not round to one.
    let least = f64::from_bits(1);
    let slanted = |x: f64, from: f64| {
        if x == 0.0 && from != 0.0 {
            least.copysign(from)
        } else {
            x
        }
    };
    [0, 1].map(|k| slanted(share[k] / length, v[k]) + 0.0)
}
