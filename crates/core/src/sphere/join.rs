//! Joins two triangulations, of the directions on both sides of a plane, into one of the whole
//! sphere.
//!
//! Each is convex on the sphere, with a ring of ghosts. Between the rings is a ring of triangles:
//! each has an edge of one ring and its apex on the other, because an arc between two vertices of
//! one ring would pass through the inside of that ring. A bridge from ring to ring goes around
//! once, each time to the next vertex of one ring or the other. If both triangles are possible, it
//! is the one whose circle does not contain the other apex. Then flips make all edges Delaunay (C.
//! L. Lawson, 1977): an edge that is not Delaunay can be flipped, as the fourth vertex is inside a
//! circle smaller than a hemisphere, and each flip raises the surface of flat triangles, so that
//! the flips end. With ties broken by the perturbation the result is the canonical triangulation.
//!
//! Every triangle has a positive determinant, so the closed surface covers each direction equally
//! often: once, as the axis lies inside the first half and in no triangle of the ring. If one of
//! these conditions does not hold, or if there are so many flips that insertion is faster, there is
//! no answer, and the caller starts again with all directions.
//!
//! Each loop has a bound that does not depend on the geometry: a ring has no more sides than there
//! are records, the bridge makes one step for each side, and flips have a budget.

use delone_predicates::Sign;

use super::arrange::Halves;
use super::directions::{Directions, turn};
use super::fill::{Filled, fill};
use crate::base::error::{Error, Result};
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::watch::{Pace, Watch};
use crate::mesh::plane::{Code, Mesh2, Patch, half_edge, next, prev, triangle};

/// Flips between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;
/// The number of vertices of the first ring from which a bridge is tried.
const TRIES: usize = 64;
/// Flips per triangle before the join is given up; few triangles next to the seam need any.
const FLIPS: usize = 16;

/// An edge of a ring, from `tail` to the next one.
#[derive(Clone, Copy)]
struct Side {
    tail: u32,
    head: u32,
    /// The edge in the triangle inside.
    inner: Code,
    /// The record of its ghost.
    ghost: u32,
}

/// The triangulations of both sides of a plane, joined to one of the whole sphere; `None` if that
/// is not possible.
pub fn in_halves(
    mesh: &mut Mesh2,
    directions: &Directions,
    halves: Halves,
    workers: usize,
    watch: &Watch,
) -> Result<Option<Filled>> {
    let (middle, end) = (halves.first, directions.count());
    let (first, second) = mesh.patch().split_at(middle as usize);
    let tasks = vec![(first, 0..middle), (second, middle..end)];
    let filled = parallel::map_watched(workers, tasks, watch, |(patch, block)| {
        fill(patch, directions, block, watch)
    })?;
    let filled: Option<Vec<Filled>> = filled.into_iter().collect();
    match filled.map(<[Filled; 2]>::try_from) {
        Some(Ok(filled)) => join_halves(mesh, directions, halves.axis, filled, watch),
        _ => Ok(None),
    }
}

/// The mesh of both halves, of which the first is above a plane at a right angle to `axis`, in the
/// first records; `None` if the rings cannot be joined.
fn join_halves(
    mesh: &mut Mesh2,
    directions: &Directions,
    axis: usize,
    [first, second]: [Filled; 2],
    watch: &Watch,
) -> Result<Option<Filled>> {
    let (Some(one), Some(other)) = (first.ghost, second.ghost) else {
        return Ok(None);
    };
    let mut patch = mesh.resume(second.taken.end);
    // Seen from outside the first ring turns left and the second one right: both go the same way.
    let rings = [
        ring(&patch, one, first.taken.len(), |patch, g| patch.after(g))?,
        ring(&patch, other, second.taken.len(), |patch, g| {
            patch.before(g)
        })?,
    ];
    // The first half contains the axis, so that no triangle between the rings may.
    let around = Around { directions, axis };
    let is_inside = rings[0]
        .iter()
        .all(|s| around.turn(s.tail, s.head) == Sign::Positive);
    let Some(start) = bridge(directions, &rings).filter(|_| is_inside) else {
        return Ok(None);
    };
    let mut pace = Pace::new(watch, WATCH_EVERY);
    let Some(stack) = zip(&mut patch, &around, &rings, start, &mut pace)? else {
        return Ok(None);
    };
    let count = first.taken.len() + second.taken.len();
    if !flip(&mut patch, directions, stack, FLIPS * count, &mut pace)? {
        return Ok(None);
    }
    // The records between the halves are free: the last ones move there.
    let mut end = second.taken.end;
    for hole in first.taken.end..second.taken.start {
        if end <= second.taken.start {
            break;
        }
        end -= 1;
        patch.relocate(end, hole);
    }
    let mut repeats = first.repeats;
    repeats.extend(second.repeats);
    Ok(Some(Filled {
        ghost: None,
        taken: 0..count as u32,
        repeats,
    }))
}

/// Directions as seen along an axis.
struct Around<'a> {
    directions: &'a Directions,
    axis: usize,
}

impl Around<'_> {
    /// The sign of the determinant of two of them and the axis.
    fn turn(&self, a: u32, b: u32) -> Sign {
        let [a, b] = [a, b].map(|v| self.directions.vector(v));
        turn(a, b, [(self.axis + 1) % 3, (self.axis + 2) % 3])
    }

    /// Whether the counterclockwise triangle `a b c` does not contain the axis, nor has it on its
    /// edges.
    fn is_clear(&self, [a, b, c]: [u32; 3]) -> bool {
        [(a, b), (b, c), (c, a)]
            .iter()
            .any(|&(a, b)| self.turn(a, b) == Sign::Negative)
    }
}

/// The sides of a ring, each beginning where the one before ends in the direction of `step`; an
/// error if there are more than `most`, the records of its half, as then the steps never come back
/// to the start.
fn ring(
    patch: &Patch,
    start: Code,
    most: usize,
    step: impl Fn(&Patch, Code) -> Code,
) -> Result<Vec<Side>> {
    let mut sides = with_room(64)?;
    let mut g = start;
    for _ in 0..most {
        push(
            &mut sides,
            Side {
                tail: patch.tail(g),
                head: patch.head(g),
                inner: patch.opposite(g),
                ghost: triangle(g),
            },
        )?;
        g = step(patch, g);
        if g == start {
            return Ok(sides);
        }
    }
    Err(Error::Internal("a ring of ghosts does not close".into()))
}

/// A side of each ring, where the arc between the first ends of both is outside the rings: it
/// leaves both at once, and they are convex.
fn bridge(directions: &Directions, [above, below]: &[Vec<Side>; 2]) -> Option<[usize; 2]> {
    let right = |a: u32, b: u32, p: u32| directions.orient([a, b, p]) == Sign::Negative;
    let step = (above.len() / TRIES).max(1);
    (0..above.len()).step_by(step).find_map(|i| {
        let before = above[(i + above.len() - 1) % above.len()];
        // From a vertex above to the one below that is nearest to it: mostly a bridge.
        let a = above[i].tail;
        let head = directions.heads[a as usize];
        let product = |side: &Side| {
            let b = directions.heads[side.head as usize];
            head[0] * b[0] + head[1] * b[1] + head[2] * b[2]
        };
        let j =
            (0..below.len()).max_by(|&i, &j| product(&below[i]).total_cmp(&product(&below[j])))?;
        let (after, b) = (below[j], below[j].head);
        let last = below[(j + below.len() - 1) % below.len()];
        // What lies right of one of the two sides at the vertex is outside the convex ring.
        let leaves = right(before.tail, a, b) || right(a, above[i].head, b);
        let meets = right(after.tail, b, a) || right(b, last.head, a);
        (leaves && meets).then_some([i, j])
    })
}

/// Fills the gap between the rings, in place of their ghosts. Returns the edges to be checked;
/// `None` if somewhere no triangle is possible that is clear of the axis.
fn zip(
    patch: &mut Patch,
    around: &Around,
    [above, below]: &[Vec<Side>; 2],
    start: [usize; 2],
    pace: &mut Pace,
) -> Result<Option<Vec<Code>>> {
    let directions = around.directions;
    let (n, m) = (above.len(), below.len());
    let mut stack = with_room(2 * (n + m))?;
    let (mut i, mut j) = (0, 0);
    let mut last: Option<Code> = None;
    let mut first = 0;
    for _ in 0..n + m {
        pace.spend(1)?;
        //   a ---- a'     The bridge from a, above, to b, below, moves to a' or b'.
        //   |
        //   b ---- b'
        let (up, down) = (above[(start[0] + i) % n], below[(start[1] + j) % m]);
        let (a, ahead) = (up.tail, up.head);
        let (b, beyond) = (down.head, down.tail);
        // Of two triangles that are possible, the one whose circle does not contain the other apex.
        let is_left = |v: u32| directions.orient([a, b, v]) == Sign::Positive;
        let by_above = i < n && is_left(ahead);
        let by_below = j < m && is_left(beyond);
        let above_next = match (by_above, by_below) {
            (false, false) => return Ok(None),
            (true, true) => !directions.in_circle([a, b, ahead, beyond]),
            (one, _) => one,
        };
        let (side, apex) = if above_next {
            (up, ahead)
        } else {
            (down, beyond)
        };
        if !around.is_clear([a, b, apex]) {
            return Ok(None);
        }
        let t = side.ghost;
        // The edge to the ring is opposite the corner on the other one, the bridge opposite the
        // apex.
        let (on_ring, leaving) = if above_next { (1, 0) } else { (0, 1) };
        patch.set(t, [a, b, apex]);
        patch.link(half_edge(t, on_ring), side.inner);
        // The triangle takes the record of the ghost, and joins the one before it across the
        // bridge.
        match last {
            Some(code) => patch.link(code, half_edge(t, 2)),
            None => first = half_edge(t, 2),
        }
        stack.extend([half_edge(t, on_ring), half_edge(t, 2)]);
        last = Some(half_edge(t, leaving));
        if above_next {
            i += 1;
        } else {
            j += 1;
        }
    }
    if (i, j) != (n, m) {
        return Err(Error::Internal(
            "the bridge between the rings does not come back".into(),
        ));
    }
    if let Some(code) = last {
        patch.link(code, first);
    }
    Ok(Some(stack))
}

/// Flips edges until all those of the `stack` and all beside a flip are Delaunay; false if that
/// takes more than `most` flips.
fn flip(
    patch: &mut Patch,
    directions: &Directions,
    mut stack: Vec<Code>,
    most: usize,
    pace: &mut Pace,
) -> Result<bool> {
    let mut flips = 0;
    while let Some(e) = stack.pop() {
        pace.spend(1)?;
        let o = patch.opposite(e);
        let corners = [next(e), prev(e), e, o].map(|c| patch.vertex(c));
        // An edge that is not Delaunay is flipped, and the four around it are tested again.
        if directions.in_circle(corners) {
            if flips == most {
                return Ok(false);
            }
            flips += 1;
            let other = patch.flip(e);
            for code in [e, prev(e), other, next(other)] {
                push(&mut stack, code)?;
            }
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use delone_predicates::Point3;

    use super::*;
    use crate::sphere::arrange::{Arranged, arrange, arrange_from};

    /// Integers below `most`.
    fn random(seed: u64) -> impl FnMut(u64) -> f64 {
        let mut x = seed;
        move |most| {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            ((x >> 33) % most) as f64
        }
    }

    /// Vectors with whole coordinates up to `most`.
    fn lattice(seed: u64, n: usize, most: u64) -> Vec<Point3> {
        let mut next = random(seed);
        let vector = || [0; 3].map(|_| next(2 * most + 1) - most as f64);
        std::iter::repeat_with(vector)
            .filter(|v| *v != [0.0; 3])
            .take(n)
            .collect()
    }

    /// The triangles of a mesh that covers the sphere, from their smallest corners, sorted. Where
    /// two numbers are the same direction, its first one represents both.
    fn triangles(mesh: &mut Mesh2, arranged: &Arranged, filled: &Filled) -> Vec<[u32; 3]> {
        let directions = &arranged.directions;
        let count = directions.count() as usize - filled.repeats.len();
        assert!(filled.ghost.is_none());
        assert_eq!(filled.taken, 0..2 * count as u32 - 4);
        let patch = mesh.resume(filled.taken.end);
        patch.check(filled.taken.len()).unwrap();
        let mut first: Vec<u32> = (0..directions.count()).collect();
        for &[number, vertex] in &filled.repeats {
            let least = first[vertex as usize].min(number);
            first[vertex as usize] = least;
        }
        let turned = |t: u32| {
            let mut corners = patch.corners(t).map(|v| first[v as usize]);
            let least = (0..3).min_by_key(|&k| corners[k]).unwrap();
            corners.rotate_left(least);
            corners
        };
        let mut all: Vec<_> = filled.taken.clone().map(turned).collect();
        all.sort_unstable();
        all
    }

    /// Whether the halves of `vectors` are joined; then with the triangles that one mesh has.
    fn is_joined(vectors: &[Point3], workers: usize) -> bool {
        let idle = Watch::idle();
        let arranged = arrange_from(vectors, 8, workers, &idle).unwrap();
        let Some(halves) = arranged.halves else {
            return false;
        };
        let n = arranged.directions.count();
        let mut mesh = Mesh2::with_vertices(n as usize).unwrap();
        let Some(joined) =
            in_halves(&mut mesh, &arranged.directions, halves, workers, &idle).unwrap()
        else {
            return false;
        };
        let mut whole = Mesh2::with_vertices(n as usize).unwrap();
        let filled = fill(whole.patch(), &arranged.directions, 0..n, &idle).unwrap();
        let expected = triangles(&mut whole, &arranged, &filled.unwrap());
        assert!(triangles(&mut mesh, &arranged, &joined) == expected);
        true
    }

    #[test]
    fn two_halves_make_the_triangles_of_the_whole() {
        for workers in [1, 2] {
            assert!(is_joined(&lattice(1, 40_000, 1 << 30), workers));
            // Ties in the seam, points on the plane and different vectors of one direction.
            assert!(is_joined(&lattice(2, 20_000, 17), workers));
        }
    }

    #[test]
    fn small_halves_are_joined_or_left() {
        let mut counts = [0; 2];
        for seed in 0..4000 {
            let most = [1, 2, 3, 8, 1 << 30][seed as usize % 5];
            let vectors = lattice(seed, 8 + seed as usize % 60, most);
            counts[usize::from(is_joined(&vectors, 1))] += 1;
        }
        assert!(counts.iter().all(|&count| count > 400), "{counts:?}");
    }

    #[test]
    fn rings_far_from_the_plane_and_on_it() {
        let mut next = random(5);
        for [above, below] in [[1e-9, 0.0], [1e-9, 1e-9], [0.5, 0.0], [4.0, 4.0]] {
            // Half of them around each pole, and a few so near to it that all octants have their
            // share.
            let mut vectors = Vec::new();
            for i in 0..4000 {
                let [x, y] = [0; 2].map(|_| next(1 << 20) - (1 << 19) as f64);
                let far = x.abs() + y.abs();
                let steep = if i % 40 < 8 { 10.0 } else { 0.0 };
                let z = if i % 2 == 0 {
                    above + steep
                } else {
                    -below - steep
                };
                vectors.push([x, y, z * far]);
            }
            assert!(is_joined(&vectors, 2), "{above} {below}");
        }
    }

    #[test]
    fn few_directions_or_those_of_a_cap_are_not_halved() {
        let idle = Watch::idle();
        let halves = |vectors: &[Point3]| arrange(vectors, 1, &idle).unwrap().halves;
        assert_eq!(halves(&lattice(3, 16_000, 1000)), None);
        assert!(halves(&lattice(3, 17_000, 1000)).is_some());
        let mut cap = lattice(3, 17_000, 1000);
        cap.iter_mut().for_each(|v| v[2] = 1000.0);
        assert_eq!(halves(&cap), None);
        // Nearly all on one side of each plane.
        let mut crowded = lattice(3, 20_000, 1000);
        for v in &mut crowded[..18_000] {
            *v = v.map(f64::abs);
        }
        assert_eq!(halves(&crowded), None);
    }
}
