//! Joins triangulated blocks into one triangulation along their seam.
//!
//! Let the points P be divided into blocks whose convex hulls do not meet, and let T(B) be the
//! canonical triangulation of block B. T(P) consists of
//!
//! - tetrahedra of four vertices of one block B. No point of B is in conflict with them, so they are in
//!   T(B). A tetrahedron of T(B) is *sound* if it is certain that no point of another block is in conflict
//!   with it, because none is near enough; sound tetrahedra are in T(P).
//! - all others. A vertex of such a tetrahedron has a record of its block around it that is not sound, as
//!   its star in T(B) is not its star in T(P). So all its vertices are in the *seam* S, the vertices of
//!   records, ghosts included, that are not sound. A tetrahedron of T(P) with its vertices in S is in
//!   T(S), where fewer points could be in conflict with it.
//!
//! So T(P) = the sound tetrahedra + some of T(S). Which? Sound tetrahedra tile a region K, and the
//! rest of the hull is tiled by the others, all of which are in T(S). The facets between K and the
//! rest are known: those of sound tetrahedra whose neighbor in T(B) is not sound. Each of them is a
//! facet of T(S), with the right tetrahedron on the far side. T(P) is connected across facets, so
//! from these the rest is reached, across facets that are not on the border of K. If there is no
//! sound tetrahedron, T(S) is T(P).
//!
//! Ties change nothing, as heights depend on the coordinates only: T(B), T(S) and T(P) are lower
//! hulls of the same lifted points.

use delone_predicates::{Point3, Sign, orient3d};

use super::sphere::{Sphere, reach};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::mesh::space::{Code, FACETS, Mesh3, corner, tetrahedron};
use crate::order::space::Extent3;

/// Kinds of records: not in the result, such as ghosts and free records;
const NOTHING: u8 = 0;
/// a tetrahedron that is in the result;
pub const SOUND: u8 = 1;
/// a tetrahedron or a ghost that may be in conflict with another block.
const LOOSE: u8 = 2;

/// What a block must know of the others: its own cell, and their boxes.
pub struct Surroundings {
    /// The cell of the block; the points of other blocks are outside or on its border.
    pub cell: Extent3,
    /// The boxes of the points of the other blocks.
    pub others: Vec<Extent3>,
}

impl Surroundings {
    /// Whether a point of another block may be in a sphere.
    #[inline]
    fn may_reach(&self, [x, y, z, square]: Sphere) -> bool {
        let (center, reach) = ([x, y, z], reach(square));
        let Extent3 { min, max } = &self.cell;
        let within = (0..3).all(|k| {
            let (low, high) = (center[k] - min[k], max[k] - center[k]);
            low > 0.0 && high > 0.0 && low * low > reach && high * high > reach
        });
        // NaN compares false: not within, and not far.
        !within
            && self
                .others
                .iter()
                .any(|other| !is_far(other, center, reach))
    }

    /// Whether a point of another block may lie beyond a hull facet, or in its plane.
    fn may_see(&self, a: Point3, b: Point3, c: Point3) -> bool {
        self.others.iter().any(|Extent3 { min, max }| {
            (0..8).any(|i| {
                let corner = |k: usize| if i >> k & 1 == 0 { min[k] } else { max[k] };
                orient3d(a, b, c, [corner(0), corner(1), corner(2)]) != Sign::Negative
            })
        })
    }
}

fn is_far(other: &Extent3, center: Point3, reach: f64) -> bool {
    let apart = |k: usize| {
        let apart = (other.min[k] - center[k]).max(center[k] - other.max[k]);
        if apart > 0.0 { apart * apart } else { 0.0 }
    };
    apart(0) + apart(1) + apart(2) > reach
}

/// A triangulated block, without its records.
pub struct Block {
    /// For each vertex, its row in the input.
    pub rows: Vec<u32>,
    /// What each record is.
    pub kinds: Vec<u8>,
    /// The records that are not sound, ascending.
    pub holes: Vec<u32>,
    /// Vertices in the seam, ascending, and their points.
    pub seam: Vec<(u32, Point3)>,
    /// Facets between sound tetrahedra and the others, with their corners.
    border: Vec<([u32; 3], Code)>,
}

impl Block {
    /// The number of sound tetrahedra.
    pub fn sound(&self) -> usize {
        self.kinds.len() - self.holes.len()
    }

    /// Finds the sound records in a triangulated block; without other blocks all are.
    pub fn sift(
        points: &[Point3],
        rows: Vec<u32>,
        mesh: &Mesh3,
        spheres: &[Sphere],
        around: &Surroundings,
    ) -> Result<Self> {
        let mut kinds = filled(mesh.records(), SOUND)?;
        for &t in mesh.free() {
            kinds[t as usize] = NOTHING;
        }
        let (mut holes, mut loose) = (Vec::new(), Vec::new());
        // Classify each record: a hole, loose, or sound.
        for (t, (kind, &sphere)) in (0u32..).zip(kinds.iter_mut().zip(spheres)) {
            if *kind == NOTHING {
                push(&mut holes, t)?;
                continue;
            }
            // Ghosts have no sphere.
            let ghost = if sphere[3].is_nan() {
                mesh.infinite_corner(t)
            } else {
                None
            };
            let in_conflict = match ghost {
                None => around.may_reach(sphere),
                Some(k) => {
                    let [a, b, c] = mesh.facet(4 * t + k as u32);
                    around.may_see(points[a as usize], points[b as usize], points[c as usize])
                }
            };
            if in_conflict {
                *kind = LOOSE;
                push(&mut loose, t)?;
                push(&mut holes, t)?;
            } else if ghost.is_some() {
                *kind = NOTHING;
                push(&mut holes, t)?;
            }
        }
        // The seam has the vertices of loose records, the border their facets to sound ones.
        let mut seam = Vec::new();
        let mut border = Vec::new();
        for t in loose {
            for v in mesh.corners(t) {
                push(&mut seam, v)?;
            }
            for e in mesh.opposites(t) {
                if kinds[tetrahedron(e) as usize] == SOUND {
                    push(&mut border, (mesh.facet(e), e))?;
                }
            }
        }
        seam.sort_unstable();
        seam.dedup();
        seam.retain(|&v| v != mesh.infinite());
        let seam = seam.into_iter().map(|v| (v, points[v as usize])).collect();
        Ok(Self {
            rows,
            kinds,
            holes,
            seam,
            border,
        })
    }
}

/// The triangulation of a seam.
pub struct Seam {
    /// For each of its vertices, the block and the vertex there.
    pub vertices: Vec<[u32; 2]>,
    /// Its tetrahedra.
    pub arrays: Arrays<4>,
}

impl Seam {
    /// The vertices of the seam of all blocks, and their points.
    pub fn gather(blocks: &[Block]) -> Result<(Vec<[u32; 2]>, Vec<Point3>)> {
        let count = blocks.iter().map(|b| b.seam.len()).sum();
        let (mut vertices, mut points) = (with_room(count)?, with_room(count)?);
        for (block, i) in blocks.iter().zip(0u32..) {
            vertices.extend(block.seam.iter().map(|&(v, _)| [i, v]));
            points.extend(block.seam.iter().map(|&(_, p)| p));
        }
        Ok((vertices, points))
    }
}

/// A facet between the sound region and the rest.
pub struct Joint {
    /// The block of the sound side.
    pub block: u32,
    /// The facet there.
    pub inner: Code,
    /// The facet in the seam.
    pub outer: Code,
}

/// Border facets of all blocks by the smallest of their corners, as vertices of the seam.
struct Borders {
    /// Where the facets of each vertex begin.
    first: Vec<u32>,
    /// The other two corners as seen from the seam, the block, and the facet there.
    facets: Vec<([u32; 2], u32, Code)>,
}

impl Borders {
    fn of(blocks: &[Block], seam: &Seam) -> Result<Self> {
        // Maps vertices of blocks to those of the seam, which are sorted by block and vertex.
        let mut start = 0;
        let mut all = Vec::new();
        for (block, i) in blocks.iter().zip(0..) {
            let own = &seam.vertices[start..start + block.seam.len()];
            for &(corners, e) in &block.border {
                let place = |v: u32| own.partition_point(|&[_, w]| w < v) + start;
                let [a, b, c] = smallest_first(corners.map(|v| place(v) as u32));
                // Reversed: the other side has the opposite orientation.
                push(&mut all, (a, ([c, b], i, e)))?;
            }
            start += block.seam.len();
        }
        let mut first = filled(seam.vertices.len() + 2, 0u32)?;
        for &(a, _) in &all {
            first[a as usize + 2] += 1;
        }
        for v in 2..first.len() {
            first[v] += first[v - 1];
        }
        let mut facets = filled(all.len(), ([0u32; 2], 0u32, 0 as Code))?;
        for (a, facet) in all {
            let at = &mut first[a as usize + 1];
            facets[*at as usize] = facet;
            *at += 1;
        }
        Ok(Self { first, facets })
    }

    /// The joint at a facet of the seam, if there is one.
    #[inline]
    fn joint(&self, corners: [u32; 3], outer: Code) -> Option<Joint> {
        let [a, b, c] = smallest_first(corners);
        let bucket = self.first[a as usize] as usize..self.first[a as usize + 1] as usize;
        let &(_, block, inner) = self.facets[bucket].iter().find(|f| f.0 == [b, c])?;
        Some(Joint {
            block,
            inner,
            outer,
        })
    }
}

/// Finds each border facet of the blocks in the seam, with the rest of the triangulation beyond. A
/// facet on the hull is not a joint.
pub fn joints(blocks: &[Block], seam: &Seam, workers: usize) -> Result<Vec<Joint>> {
    /// Tetrahedra per task.
    const SHARE: usize = 1 << 14;
    let borders = Borders::of(blocks, seam)?;
    let Arrays {
        simplices,
        neighbors,
    } = &seam.arrays;
    let shares = simplices.chunks(SHARE).zip(neighbors.chunks(SHARE));
    let tasks = (0u32..).step_by(SHARE).zip(shares).collect();
    let found = parallel::map(workers, tasks, |(start, (simplices, neighbors))| {
        let (mut joints, mut outside) = (Vec::new(), 0);
        for (t, (corners, around)) in (start..).zip(simplices.iter().zip(neighbors)) {
            for k in 0..4 {
                let [a, b, c] = FACETS[k];
                let [a, b, c] = [corners[a] as u32, corners[b] as u32, corners[c] as u32];
                let e = 4 * t + k as u32;
                if let Some(joint) = borders.joint([a, b, c], e) {
                    push(&mut joints, joint)?;
                }
                outside += usize::from(around[k] < 0 && borders.joint([a, c, b], e).is_some());
            }
        }
        Ok((joints, outside))
    });
    let (mut joints, mut outside) = (with_room(borders.facets.len())?, 0);
    for share in found {
        let (mut found, more) = share?;
        joints.append(&mut found);
        outside += more;
    }
    let (found, all) = (joints.len() + outside, borders.facets.len());
    if found == all {
        Ok(joints)
    } else {
        Err(Error::Internal(format!(
            "{found} of {all} facets of blocks are in the seam"
        )))
    }
}

#[inline]
fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// For each tetrahedron of the seam, whether it belongs to the result.
pub fn belonging(seam: &Seam, joints: &[Joint]) -> Result<Vec<bool>> {
    let neighbors = &seam.arrays.neighbors;
    let mut belongs = filled(neighbors.len(), false)?;
    // Bits of the facets toward sound tetrahedra.
    let mut closed = filled(neighbors.len(), 0u8)?;
    for joint in joints {
        closed[tetrahedron(joint.outer) as usize] |= 1 << corner(joint.outer);
    }
    // If nothing is sound, start from any tetrahedron.
    let any = joints.is_empty().then_some(0);
    let mut stack = Vec::new();
    for t in joints.iter().map(|j| tetrahedron(j.outer)).chain(any) {
        if std::mem::replace(&mut belongs[t as usize], true) {
            continue;
        }
        push(&mut stack, t)?;
        while let Some(t) = stack.pop() {
            for (k, &next) in neighbors[t as usize].iter().enumerate() {
                if next >= 0
                    && closed[t as usize] >> k & 1 == 0
                    && !std::mem::replace(&mut belongs[next as usize], true)
                {
                    push(&mut stack, next as u32)?;
                }
            }
        }
    }
    Ok(belongs)
}
