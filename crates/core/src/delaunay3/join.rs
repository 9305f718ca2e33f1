//! Meshes as arrays, where they lie: the records of the blocks are renumbered in place, what the seam
//! adds fills the holes that ghosts and loose tetrahedra leave, and so do tetrahedra from the end. No copy is
//! made, and no page is touched anew.

use super::seam::{Block, Joint, SOUND, Seam};
use crate::error::{Error, Result};
use crate::memory::filled;
use crate::mesh3::{Code, Records, tetrahedron};
use crate::parallel;

/// Records that one task renumbers.
const SHARE: usize = 1 << 14;

/// No tetrahedron.
const NONE: u32 = u32::MAX;

/// The finite tetrahedra of a triangulation.
#[derive(Debug, Default)]
pub struct Arrays {
    /// Four vertices a tetrahedron, positively oriented.
    pub simplices: Vec<[i32; 4]>,
    /// The tetrahedron opposite each vertex, -1 outside.
    pub neighbors: Vec<[i32; 4]>,
}

/// A seam with what of it belongs to the whole, and its joints with the blocks.
pub struct Fitted<'a> {
    /// The seam.
    pub seam: Seam<'a>,
    /// For each of its records whether it belongs.
    pub belongs: Vec<bool>,
    /// Where it meets the blocks.
    pub joints: Vec<Joint>,
}

/// Where the tetrahedra go.
struct Plan {
    total: usize,
    /// For records from `total` on, their new number.
    moved: Vec<u32>,
    /// For records of the seam, their number.
    placed: Vec<u32>,
}

impl Plan {
    #[inline]
    fn number(&self, record: usize) -> u32 {
        match record.checked_sub(self.total) {
            None => record as u32,
            Some(beyond) => self.moved[beyond],
        }
    }
}

/// Makes arrays of `records`, of which the i-th block has `rooms[i]`, and of what the seam adds.
pub fn join(
    mut records: Records,
    rooms: &[usize],
    blocks: &[Block],
    fitted: Option<&Fitted>,
    workers: usize,
) -> Result<Arrays> {
    let starts: Vec<usize> = rooms
        .iter()
        .scan(0, |end, room| Some(std::mem::replace(end, *end + room)))
        .collect();
    let plan = plan(&starts, rooms, blocks, fitted)?;
    for array in [&mut records.corners, &mut records.opposite] {
        let more = plan.total.saturating_sub(array.len());
        let bytes = more * size_of::<[i32; 4]>();
        array
            .try_reserve(more)
            .map_err(|_| Error::Memory { bytes })?;
        array.resize(array.len() + more, [0; 4]);
    }
    renumber(&mut records, &starts, rooms, blocks, &plan, workers);
    for (&start, block) in starts.iter().zip(blocks) {
        for (t, _) in (start..)
            .zip(&block.kinds)
            .filter(|&(_, &kind)| kind == SOUND)
        {
            if t >= plan.total {
                let to = plan.number(t) as usize;
                records.corners[to] = records.corners[t];
                records.opposite[to] = records.opposite[t];
            }
        }
    }
    if let Some(fitted) = fitted {
        place(&mut records, &starts, blocks, fitted, &plan);
    }
    records.corners.truncate(plan.total);
    records.opposite.truncate(plan.total);
    Ok(Arrays {
        simplices: records.corners,
        neighbors: records.opposite,
    })
}

/// Gives each tetrahedron that must move a hole, in the order of both.
fn plan(
    starts: &[usize],
    rooms: &[usize],
    blocks: &[Block],
    fitted: Option<&Fitted>,
) -> Result<Plan> {
    let belongs = fitted.map_or(&[][..], |fitted| &fitted.belongs);
    let added = belongs.iter().filter(|&&b| b).count();
    let total = blocks.iter().map(|b| b.sound).sum::<usize>() + added;
    let end = starts.last().zip(rooms.last()).map_or(0, |(s, r)| s + r);
    let mut plan = Plan {
        total,
        moved: filled(end.saturating_sub(total), NONE)?,
        placed: filled(belongs.len(), NONE)?,
    };
    let is_hole = |block: &Block, t: usize| block.kinds.get(t).is_none_or(|&k| k != SOUND);
    let inner = starts
        .iter()
        .zip(rooms)
        .zip(blocks)
        .flat_map(|((&s, &room), b)| {
            let holes = (0..room).filter(move |&t| is_hole(b, t));
            holes.map(move |t| (s + t) as u32)
        });
    // Where the blocks use up their room, the seam may add to it.
    let mut holes = inner.chain(end as u32..total as u32);
    for (placed, _) in plan.placed.iter_mut().zip(belongs).filter(|&(_, &b)| b) {
        *placed = holes.next().unwrap_or(NONE);
    }
    for (&start, block) in starts.iter().zip(blocks) {
        for (t, _) in (start..)
            .zip(&block.kinds)
            .filter(|&(_, &kind)| kind == SOUND)
        {
            if t >= total {
                plan.moved[t - total] = holes.next().unwrap_or(NONE);
            }
        }
    }
    Ok(plan)
}

/// Renumbers the records of the blocks; what lies beyond a loose one is left -1.
fn renumber(
    records: &mut Records,
    starts: &[usize],
    rooms: &[usize],
    blocks: &[Block],
    plan: &Plan,
    workers: usize,
) {
    let (mut corners, mut opposite) = (&mut records.corners[..], &mut records.opposite[..]);
    let mut tasks = Vec::new();
    for ((&start, &room), block) in starts.iter().zip(rooms).zip(blocks) {
        let (own_corners, rest_corners) = corners.split_at_mut(room);
        let (own_opposite, rest_opposite) = opposite.split_at_mut(room);
        let chunks = own_corners
            .chunks_mut(SHARE)
            .zip(own_opposite.chunks_mut(SHARE))
            .zip(block.kinds.chunks(SHARE));
        tasks.extend(chunks.map(|chunk| (start, block, chunk)));
        (corners, opposite) = (rest_corners, rest_opposite);
    }
    parallel::map(
        workers,
        tasks,
        |(start, block, ((corners, opposite), kinds))| {
            let row = |v: i32| block.rows[v as usize] as i32;
            let number = |e: i32| {
                let t = tetrahedron(e as Code) as usize;
                if block.kinds[t] == SOUND {
                    plan.number(start + t) as i32
                } else {
                    -1
                }
            };
            for ((c, o), _) in corners
                .iter_mut()
                .zip(opposite)
                .zip(kinds)
                .filter(|&(_, &kind)| kind == SOUND)
            {
                *c = [row(c[0]), row(c[1]), row(c[2]), row(c[3])];
                *o = [number(o[0]), number(o[1]), number(o[2]), number(o[3])];
            }
        },
    );
}

/// Puts the tetrahedra of the seam in their holes and joins them to the blocks.
fn place(records: &mut Records, starts: &[usize], blocks: &[Block], fitted: &Fitted, plan: &Plan) {
    let Fitted { seam, joints, .. } = fitted;
    let row = |v: u32| {
        let [block, v] = seam.vertices[v as usize];
        blocks[block as usize].rows[v as usize] as i32
    };
    for (t, &to) in (0u32..).zip(&plan.placed).filter(|&(_, &to)| to != NONE) {
        records.corners[to as usize] = seam.mesh.corners(t).map(row);
        // Where it is none of the whole, a joint follows or the outside.
        let number = |e: Code| plan.placed[tetrahedron(e) as usize] as i32;
        records.opposite[to as usize] = seam.mesh.opposites(t).map(number);
    }
    for joint in joints {
        let record = starts[joint.block as usize] + tetrahedron(joint.inner) as usize;
        let own = plan.number(record);
        let other = plan.placed[tetrahedron(joint.outer) as usize];
        records.opposite[own as usize][(joint.inner & 3) as usize] = other as i32;
        if other != NONE {
            records.opposite[other as usize][(joint.outer & 3) as usize] = own as i32;
        }
    }
}
