//! Joins the meshes of blocks into one set of arrays, in place.
//!
//! The records of the blocks are renumbered where they are. Tetrahedra of the seam, and then
//! tetrahedra from the end, fill the holes that ghosts and loose tetrahedra leave. No copy is made,
//! and no new page is touched.

use super::seam::{Block, Joint, SOUND, Seam};
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::watch::Watch;
use crate::mesh::space::{Code, Records, corner, tetrahedron};

/// Records that one task renumbers.
const SHARE: usize = 1 << 14;

/// No tetrahedron.
const NONE: u32 = u32::MAX;

/// A seam, the part of it that belongs to the result, and its joints with the blocks.
pub struct Fitted {
    /// The seam.
    pub seam: Seam,
    /// For each of its tetrahedra, whether it belongs to the result.
    pub belongs: Vec<bool>,
    /// The facets where it meets the blocks.
    pub joints: Vec<Joint>,
}

/// The new places of the tetrahedra.
struct Plan {
    total: usize,
    /// Records below `total` that are to be filled, ascending: first by those `added`, then by
    /// those that move.
    holes: Vec<u32>,
    /// Tetrahedra of the seam that belong to the result, ascending.
    added: Vec<u32>,
    /// The new numbers of records from `total` on.
    moved: Vec<u32>,
    /// The numbers of the tetrahedra of the seam.
    placed: Vec<u32>,
    /// Records that move, ascending.
    movers: Vec<u32>,
}

impl Plan {
    #[inline]
    fn number(&self, record: usize) -> u32 {
        match record.checked_sub(self.total) {
            None => record as u32,
            Some(beyond) => self.moved[beyond],
        }
    }

    /// Tetrahedron t of the seam in the numbers of the result. If its neighbor is not in the
    /// result, there is a joint or the outside.
    #[inline]
    fn addition(&self, t: usize, blocks: &[Block], fitted: &Fitted) -> ([i32; 4], [i32; 4]) {
        let Seam { vertices, arrays } = &fitted.seam;
        let row = |v: i32| {
            let [block, v] = vertices[v as usize];
            blocks[block as usize].rows[v as usize] as i32
        };
        let number = |t: i32| match usize::try_from(t) {
            Ok(t) => self.placed[t] as i32,
            Err(_) => -1,
        };
        let (corners, neighbors) = (arrays.simplices[t], arrays.neighbors[t]);
        let [a, b, c, d] = corners;
        let [e, f, g, h] = neighbors;
        (
            [row(a), row(b), row(c), row(d)],
            [number(e), number(f), number(g), number(h)],
        )
    }
}

/// Makes arrays of `records`, of which the i-th block has `rooms[i]`, and of the tetrahedra added
/// by the seam.
pub fn join(
    mut records: Records,
    rooms: &[usize],
    blocks: &[Block],
    fitted: Option<&Fitted>,
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<4>> {
    let starts: Vec<usize> = rooms
        .iter()
        .scan(0, |end, room| Some(std::mem::replace(end, *end + room)))
        .collect();
    let plan = plan(&starts, rooms, blocks, fitted)?;
    watch.check()?;
    for array in [&mut records.corners, &mut records.opposite] {
        let more = plan.total.saturating_sub(array.len());
        let bytes = more * size_of::<[i32; 4]>();
        array
            .try_reserve(more)
            .map_err(|_| Error::Memory { bytes })?;
        array.resize(array.len() + more, [0; 4]);
    }
    renumber(&mut records, &starts, rooms, blocks, &plan, workers, watch)?;
    fill(&mut records, blocks, fitted, &plan, workers, watch)?;
    watch.check()?;
    if let Some(fitted) = fitted {
        tie(&mut records, &starts, fitted, &plan);
    }
    records.corners.truncate(plan.total);
    records.opposite.truncate(plan.total);
    Ok(Arrays {
        simplices: records.corners,
        neighbors: records.opposite,
    })
}

/// Assigns a hole to each tetrahedron that is added or must move, in the order of both.
fn plan(
    starts: &[usize],
    rooms: &[usize],
    blocks: &[Block],
    fitted: Option<&Fitted>,
) -> Result<Plan> {
    let belongs = fitted.map_or(&[][..], |fitted| &fitted.belongs);
    let mut added = Vec::new();
    for (t, _) in (0..).zip(belongs).filter(|&(_, &b)| b) {
        push(&mut added, t)?;
    }
    let total = blocks.iter().map(Block::sound).sum::<usize>() + added.len();
    let end = starts.last().zip(rooms.last()).map_or(0, |(s, r)| s + r);
    let mut movers = Vec::new();
    for (&start, block) in starts.iter().zip(blocks) {
        for t in total.max(start)..total.max(start + block.kinds.len()) {
            if block.kinds[t - start] == SOUND {
                push(&mut movers, t as u32)?;
            }
        }
    }
    // The first holes are those below `total`. If the blocks use up their room, the seam may add to
    // it.
    let mut holes = with_room(added.len() + movers.len())?;
    let inner = starts.iter().zip(rooms).zip(blocks);
    let inner = inner.flat_map(|((&s, &room), b)| {
        let own = b.holes.iter().map(move |&t| s + t as usize);
        own.chain(s + b.kinds.len()..s + room)
    });
    let all = inner.chain(end..total).map(|t| t as u32);
    holes.extend(all.take(added.len() + movers.len()));
    let mut plan = Plan {
        total,
        moved: filled(end.saturating_sub(total), NONE)?,
        placed: filled(belongs.len(), NONE)?,
        holes,
        added,
        movers,
    };
    let (for_added, for_movers) = plan.holes.split_at(plan.added.len());
    for (&t, &to) in plan.added.iter().zip(for_added) {
        plan.placed[t as usize] = to;
    }
    for (&t, &to) in plan.movers.iter().zip(for_movers) {
        plan.moved[t as usize - total] = to;
    }
    Ok(plan)
}

/// Renumbers the records of the blocks; neighbors across from loose ones stay -1.
fn renumber(
    records: &mut Records,
    starts: &[usize],
    rooms: &[usize],
    blocks: &[Block],
    plan: &Plan,
    workers: usize,
    watch: &Watch,
) -> Result<()> {
    let (mut corners, mut opposite) = (&mut records.corners[..], &mut records.opposite[..]);
    // Split the records into disjoint slices, one per task.
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
    parallel::map_watched(
        workers,
        tasks,
        watch,
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
            Ok(())
        },
    )?;
    Ok(())
}

/// Fills the holes with the tetrahedra that the seam adds and those that move.
fn fill(
    records: &mut Records,
    blocks: &[Block],
    fitted: Option<&Fitted>,
    plan: &Plan,
    workers: usize,
    watch: &Watch,
) -> Result<()> {
    let (corners, last_corners) = records.corners.split_at_mut(plan.total);
    let (opposite, last_opposite) = records.opposite.split_at_mut(plan.total);
    let (last_corners, last_opposite) = (&*last_corners, &*last_opposite);
    let chunks = corners.chunks_mut(SHARE).zip(opposite.chunks_mut(SHARE));
    let tasks = chunks.zip((0..).step_by(SHARE)).collect();
    parallel::map_watched(
        workers,
        tasks,
        watch,
        |((corners, opposite), start): ((&mut [_], &mut [_]), u32)| {
            let before = |end: usize| plan.holes.partition_point(|&to| (to as usize) < end);
            let here = before(start as usize)..before(start as usize + corners.len());
            for i in here {
                let to = (plan.holes[i] - start) as usize;
                let filling = match (i.checked_sub(plan.added.len()), fitted) {
                    (None, Some(fitted)) => plan.addition(plan.added[i] as usize, blocks, fitted),
                    (Some(i), _) => {
                        let from = plan.movers[i] as usize - plan.total;
                        (last_corners[from], last_opposite[from])
                    }
                    (None, None) => continue, // Without a seam nothing is added.
                };
                (corners[to], opposite[to]) = filling;
            }
            Ok(())
        },
    )?;
    Ok(())
}

/// Links the tetrahedra of the seam to the blocks.
fn tie(records: &mut Records, starts: &[usize], fitted: &Fitted, plan: &Plan) {
    for joint in &fitted.joints {
        let record = starts[joint.block as usize] + tetrahedron(joint.inner) as usize;
        let own = plan.number(record);
        let other = plan.placed[tetrahedron(joint.outer) as usize];
        records.opposite[own as usize][corner(joint.inner)] = other as i32;
        records.opposite[other as usize][corner(joint.outer)] = own as i32;
    }
}
