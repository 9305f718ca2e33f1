//! Blocks become one triangulation along their seam.
//!
//! Let the points P be parted into blocks whose convex hulls do not meet, and T(B) the canonical
//! triangulation of block B. In T(P) there are
//!
//! - tetrahedra of four vertices of one block B. No point of B disturbs them, so they are in T(B). A
//!   tetrahedron of T(B) is *sound* when it is certain that no point of another block is in conflict with it,
//!   for want of nearness to them; what is sound is in T(P).
//! - all others. A vertex of such a tetrahedron has another record of its block around it that is not sound, as
//!   its star in T(B) is not its star in T(P). So all vertices are in the *seam* S, the vertices of records,
//!   ghosts included, that are not sound. A tetrahedron of T(P) with its vertices in S is in T(S), where
//!   fewer points could disturb it.
//!
//! So T(P) = the sound ones + some of T(S). Which? Sound tetrahedra tile a region K, and the rest of the hull is tiled by
//! the others, all of which are in T(S). The facets between K and the rest are known: those of sound tetrahedra
//! whose neighbour in T(B) is not sound. Each of them is a facet of T(S), with the right tetrahedron on the
//! far side. All facets of T(P) connect, so from these the rest is reached, across facets that are no border. Where there is
//! no sound tetrahedron, T(S) is T(P).
//!
//! Ties change nothing, as heights hang on the coordinates alone: T(B), T(S) and T(P) are lower hulls of the
//! same lifted points.

use delone_predicates::{Point3, Sign, orient3d};

use super::sphere::{Sphere, reach};
use crate::error::{Error, Result};
use crate::memory::{filled, push, with_room, zeroed};
use crate::mesh3::{Code, Mesh3, tetrahedron};
use crate::order::space::Extent3;

/// What a record is: nothing of the result, as ghosts and free ones;
const NOTHING: u8 = 0;
/// a tetrahedron that is in the result;
pub const SOUND: u8 = 1;
/// a tetrahedron or a ghost that another block may disturb.
const LOOSE: u8 = 2;

/// What a block must know of the others: its own cell, and their boxes.
pub struct Surroundings {
    /// The cell of the block; the points of others are outside or on its border.
    pub cell: Extent3,
    /// The boxes of the points of the others.
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
        // NaN is within nothing and far from nothing.
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

/// A triangulated block, beside its records.
pub struct Block {
    /// For each vertex, its row in the input.
    pub rows: Vec<u32>,
    /// For each record what it is.
    pub kinds: Vec<u8>,
    /// The number of sound tetrahedra.
    pub sound: usize,
    /// Vertices in the seam, ascending, and their points.
    pub seam: Vec<(u32, Point3)>,
    /// Facets of sound tetrahedra towards what is not, with their corners.
    border: Vec<([u32; 3], Code)>,
}

impl Block {
    /// Finds what is sound in a triangulated block; everything is where there are no others.
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
        let (mut sound, mut loose) = (0, Vec::new());
        for (t, (kind, &sphere)) in (0u32..).zip(kinds.iter_mut().zip(spheres)) {
            if *kind == NOTHING {
                continue;
            }
            // Ghosts have no sphere.
            let ghost = if sphere[3].is_nan() {
                mesh.infinite_corner(t)
            } else {
                None
            };
            let disturbed = match ghost {
                None => around.may_reach(sphere),
                Some(k) => {
                    let [a, b, c] = mesh.facet(4 * t + k as u32);
                    around.may_see(points[a as usize], points[b as usize], points[c as usize])
                }
            };
            if disturbed {
                *kind = LOOSE;
                push(&mut loose, t)?;
            } else if ghost.is_some() {
                *kind = NOTHING;
            } else {
                sound += 1;
            }
        }
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
            sound,
            seam,
            border,
        })
    }
}

/// The triangulation of a seam.
pub struct Seam<'a> {
    /// For each of its vertices, the block and the vertex there.
    pub vertices: Vec<[u32; 2]>,
    /// Its mesh.
    pub mesh: Mesh3<'a>,
}

/// A facet between what is sound and the rest.
pub struct Joint {
    /// The block of the sound side.
    pub block: u32,
    /// The facet there.
    pub inner: Code,
    /// The facet in the seam.
    pub outer: Code,
}

/// Finds each border facet of the blocks in the seam, with the rest of the triangulation beyond.
pub fn joints(blocks: &[Block], seam: &Seam) -> Result<Vec<Joint>> {
    // Vertices of blocks to those of the seam.
    let mut numbers = Vec::with_capacity(blocks.len());
    for block in blocks {
        numbers.push(zeroed::<u32>(block.rows.len())?);
    }
    for (&[block, v], s) in seam.vertices.iter().zip(0..) {
        numbers[block as usize][v as usize] = s;
    }
    // Border facets by their smallest vertex, each from its own side.
    let facets = || {
        blocks
            .iter()
            .zip(&numbers)
            .zip(0..)
            .flat_map(|((b, n), i)| {
                b.border.iter().map(move |&(corners, e)| {
                    let corners = corners.map(|v| n[v as usize]);
                    (smallest_first(corners), i, e)
                })
            })
    };
    let mut first = filled(seam.vertices.len() + 2, 0u32)?;
    for ([a, ..], ..) in facets() {
        first[a as usize + 2] += 1;
    }
    for v in 2..first.len() {
        first[v] += first[v - 1];
    }
    let mut sorted = filled(facets().count(), ([0u32; 2], 0u32, 0 as Code))?;
    for ([a, b, c], block, e) in facets() {
        let at = &mut first[a as usize + 1];
        // The other side has it the other way round.
        sorted[*at as usize] = ([c, b], block, e);
        *at += 1;
    }
    let mut joints = with_room(sorted.len())?;
    for t in 0..seam.mesh.records() as u32 {
        for k in 0..4 {
            let e = 4 * t + k;
            let corners = seam.mesh.facet(e);
            if corners.contains(&seam.mesh.infinite()) {
                continue;
            }
            let [a, b, c] = smallest_first(corners);
            let bucket = first[a as usize] as usize..first[a as usize + 1] as usize;
            for &(ends, block, inner) in &sorted[bucket] {
                if ends == [b, c] && !seam.mesh.free().contains(&t) {
                    joints.push(Joint {
                        block,
                        inner,
                        outer: e,
                    });
                }
            }
        }
    }
    if joints.len() == sorted.len() {
        Ok(joints)
    } else {
        let (found, all) = (joints.len(), sorted.len());
        Err(Error::Internal(format!(
            "{found} of {all} facets of blocks are in the seam"
        )))
    }
}

fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// For each record of the seam whether it belongs to the whole.
pub fn rest(seam: &Seam, joints: &[Joint]) -> Result<Vec<bool>> {
    let mesh = &seam.mesh;
    let mut belongs = filled(mesh.records(), false)?;
    let mut closed = filled(mesh.records(), 0u8)?;
    let mut stack = Vec::new();
    for joint in joints {
        let t = tetrahedron(joint.outer);
        closed[t as usize] |= 1 << (joint.outer & 3);
        push(&mut stack, t)?;
    }
    if joints.is_empty() {
        // Nothing is sound: from any tetrahedron on.
        let finite = |t: &u32| mesh.infinite_corner(*t).is_none() && !mesh.free().contains(t);
        stack.extend((0..mesh.records() as u32).find(finite));
    }
    while let Some(t) = stack.pop() {
        if belongs[t as usize] || mesh.infinite_corner(t).is_some() {
            continue;
        }
        belongs[t as usize] = true;
        for (k, e) in mesh.opposites(t).into_iter().enumerate() {
            if closed[t as usize] >> k & 1 == 0 {
                push(&mut stack, tetrahedron(e))?;
            }
        }
    }
    Ok(belongs)
}
