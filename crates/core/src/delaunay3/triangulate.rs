//! From rows of coordinates to arrays of tetrahedra: scan, order, build, export.
//!
//! A large set is cut into blocks, which threads triangulate side by side and `seam` joins. The
//! blocks hang on the points alone, so the arrays are the same for any number of threads.

use std::time::{Duration, Instant};

use delone_predicates::Point3;

use super::insertion;
use super::join::{Arrays, Fitted, join};
use super::seam::{Block, Seam, Surroundings, joints, rest};
use crate::error::{Error, Result};
use crate::memory::{is_plausible, with_room};
use crate::mesh3::{LIMIT, Mesh3, Records};
use crate::order::space::{Arranged3, Extent3, arrange, arrange_rows};
use crate::order::space_blocks::Cuts3;
use crate::watch::Watch;
use crate::{parallel, points};

/// Most points that a block should hold. The seam of two halves of a million uniform points has 5 % of
/// them, which are triangulated twice; smaller blocks have more.
const BLOCK: usize = 1 << 19;

/// Points of which one stands for so many, where it is tried whether blocks are worth it.
const SAMPLE: usize = 64;

/// A part of the work and the time it took.
pub type Stage = (&'static str, Duration);

/// Tetrahedra in the rows of the input.
#[derive(Debug)]
pub struct Triangulation3 {
    /// Tetrahedra and their neighbours.
    pub arrays: Arrays,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
    /// Where the time went.
    pub stages: Vec<Stage>,
}

/// The canonical Delaunay triangulation of `input`; the same arrays for any number of workers.
pub fn triangulate(input: &[Point3], workers: usize, watch: &Watch) -> Result<Triangulation3> {
    in_blocks(input, BLOCK, workers, watch)
}

fn in_blocks(
    input: &[Point3],
    block: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Triangulation3> {
    let mut clock = Clock::start();
    points::scan(input)?;
    clock.lap("scan");
    if input.len() > block {
        let cuts = Cuts3::of(input, block);
        if pays(input, &cuts, workers, watch)? {
            clock.lap("sample");
            if let Some(made) = joined(input, &cuts, workers, watch, &mut clock)? {
                return Ok(made);
            }
        }
    }
    let mut arranged = arrange(input, watch)?;
    clock.lap("order");
    // The vertex at infinity.
    arranged.points.push([f64::NAN; 3]);
    let Some((records, rooms, blocks)) = built(std::slice::from_ref(&arranged), None, 1, watch)?
    else {
        arranged.points.pop();
        let Arranged3 { points, rows, .. } = arranged;
        return Err(points::degenerate_in_space(&points, &rows));
    };
    clock.lap("build");
    drop(std::mem::take(&mut arranged.points));
    let arrays = join(records, &rooms, &blocks, None, workers)?;
    clock.lap("join");
    Ok(Triangulation3 {
        arrays,
        duplicates: arranged.duplicates,
        stages: clock.stages,
    })
}

/// Whether blocks are worth it: not where most points would be in the seam, as for points on a
/// sphere, whose tetrahedra all have the one sphere.
fn pays(input: &[Point3], cuts: &Cuts3, workers: usize, watch: &Watch) -> Result<bool> {
    let mut sample = with_room(input.len() / SAMPLE + 1)?;
    sample.extend(input.iter().copied().step_by(SAMPLE));
    let parts = parts(&sample, cuts, workers, watch)?;
    let Some((_, _, blocks)) = built(&parts, Some(cuts), workers, watch)? else {
        return Ok(false);
    };
    let in_seam = blocks.iter().map(|b| b.seam.len()).sum::<usize>();
    Ok(4 * in_seam <= 3 * sample.len())
}

/// The triangulation by blocks; nothing where a block or the seam is degenerate.
fn joined(
    input: &[Point3],
    cuts: &Cuts3,
    workers: usize,
    watch: &Watch,
    clock: &mut Clock,
) -> Result<Option<Triangulation3>> {
    let mut parts = parts(input, cuts, workers, watch)?;
    clock.lap("order");
    let Some((records, rooms, blocks)) = built(&parts, Some(cuts), workers, watch)? else {
        return Ok(None);
    };
    clock.lap("build");
    let mut duplicates = Vec::new();
    for part in &mut parts {
        duplicates.append(&mut part.duplicates);
    }
    duplicates.sort_unstable();
    drop(parts);
    let arrays = sewn(records, &rooms, &blocks, workers, watch, clock)?;
    Ok(arrays.map(|arrays| Triangulation3 {
        arrays,
        duplicates,
        stages: std::mem::take(&mut clock.stages),
    }))
}

/// The points of each block along the curve, and one of NaN.
fn parts(input: &[Point3], cuts: &Cuts3, workers: usize, watch: &Watch) -> Result<Vec<Arranged3>> {
    let parts = parallel::map(workers, cuts.split(input)?, |(points, rows)| {
        let mut arranged = arrange_rows(&points, Some(&rows), watch)?;
        arranged.points.push([f64::NAN; 3]);
        Ok(arranged)
    });
    parts.into_iter().collect()
}

/// Records of all blocks, the room of each, and what is sound in it.
type Built = (Records, Vec<usize>, Vec<Block>);

/// Triangulates each block and finds what is sound in it; nothing where one is degenerate. Where the
/// room for records does not suffice, which is for sets that are far from scattered, it begins again with
/// twice as much: all attempts together cost less than twice the last.
fn built(
    parts: &[Arranged3],
    cuts: Option<&Cuts3>,
    workers: usize,
    watch: &Watch,
) -> Result<Option<Built>> {
    let mut times = 1;
    loop {
        match attempt(parts, cuts, times, workers, watch) {
            Err(Error::TooManyTetrahedra { limit }) if limit < LIMIT => times *= 2,
            outcome => return outcome,
        }
    }
}

fn attempt(
    parts: &[Arranged3],
    cuts: Option<&Cuts3>,
    times: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Option<Built>> {
    let vertices = |part: &Arranged3| part.points.len() - 1;
    let rooms: Vec<(usize, usize)> = parts
        .iter()
        .map(|part| {
            let room = times.saturating_mul(Records::room(vertices(part)));
            (room.min(LIMIT / parts.len()), vertices(part))
        })
        .collect();
    let boxes: Vec<Extent3> = parts
        .iter()
        .map(|part| Extent3::of(part.points[..vertices(part)].iter().copied()))
        .collect();
    let room = rooms.iter().map(|&(room, _)| room).sum();
    check_memory(times, room)?;
    let mut records = Records::with_room(room)?;
    let meshes = records.meshes(&rooms);
    let tasks = parts.iter().zip(meshes).enumerate().collect();
    let made = parallel::map(
        workers,
        tasks,
        |(i, (part, mesh)): (usize, (&Arranged3, Mesh3))| {
            let around = Surroundings {
                cell: cuts.map_or(Extent3::EVERYWHERE, |cuts| cuts.cell(i)),
                others: [&boxes[..i], &boxes[i + 1..]].concat(),
            };
            let Some((mesh, spheres)) = insertion::build(&part.points, mesh, watch)? else {
                return Ok(None);
            };
            Block::sift(&part.points, part.rows.clone(), &mesh, &spheres, &around).map(Some)
        },
    );
    let blocks: Result<Option<Vec<Block>>> = made.into_iter().collect();
    let rooms = rooms.into_iter().map(|(room, _)| room).collect();
    Ok(blocks?.map(|blocks| (records, rooms, blocks)))
}

/// Refuses a further attempt that would want more memory than there is. (A quadratic triangulation would
/// else grow until the system ends the process.)
fn check_memory(times: usize, room: usize) -> Result<()> {
    /// Corners, facets, sphere and mark of a record.
    const RECORD: usize = 16 + 16 + 32 + 4;
    let bytes = room * RECORD;
    if times > 1 && !is_plausible(bytes) {
        return Err(Error::Memory { bytes });
    }
    Ok(())
}

/// Triangulates the seam and makes arrays of all; nothing where the seam is degenerate.
fn sewn(
    records: Records,
    rooms: &[usize],
    blocks: &[Block],
    workers: usize,
    watch: &Watch,
    clock: &mut Clock,
) -> Result<Option<Arrays>> {
    let count = blocks.iter().map(|b| b.seam.len()).sum();
    let mut points: Vec<Point3> = with_room(count)?;
    let mut names = with_room(count)?;
    for (block, i) in blocks.iter().zip(0u32..) {
        points.extend(block.seam.iter().map(|&(_, p)| p));
        names.extend(block.seam.iter().map(|&(v, _)| [i, v]));
    }
    let mut arranged = arrange(&points, watch)?;
    arranged.points.push([f64::NAN; 3]);
    let mut times = 2;
    let room = |times: usize| (times * Records::room(count)).min(LIMIT);
    let mut own = Records::with_room(room(times))?;
    let mesh = loop {
        let mesh = own.meshes(&[(room(times), arranged.rows.len())]).remove(0);
        match insertion::build(&arranged.points, mesh, watch) {
            Err(Error::TooManyTetrahedra { limit }) if limit < LIMIT => times *= 2,
            Ok(None) => return Ok(None),
            Ok(Some((mesh, _))) => break mesh,
            Err(other) => return Err(other),
        }
        check_memory(times, room(times))?;
        own = Records::with_room(room(times))?;
    };
    let vertices = arranged.rows.iter().map(|&i| names[i as usize]).collect();
    let seam = Seam { vertices, mesh };
    let joints = joints(blocks, &seam)?;
    let belongs = rest(&seam, &joints)?;
    clock.lap("seam");
    let fitted = Fitted {
        seam,
        belongs,
        joints,
    };
    let arrays = join(records, rooms, blocks, Some(&fitted), workers)?;
    clock.lap("join");
    Ok(Some(arrays))
}

/// Times the stages one after the other.
struct Clock {
    last: Instant,
    stages: Vec<Stage>,
}

impl Clock {
    fn start() -> Self {
        Self {
            last: Instant::now(),
            stages: Vec::with_capacity(8),
        }
    }

    fn lap(&mut self, name: &'static str) {
        let now = Instant::now();
        self.stages
            .push((name, now - std::mem::replace(&mut self.last, now)));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::delaunay3::validate::{Findings3, Given3, validate};

    /// The tetrahedra in blocks of some sizes, valid and all the same.
    fn same_in_blocks(points: &[Point3]) {
        let sets = [usize::MAX, points.len() / 2 + 1, points.len() / 7 + 1].map(|block| {
            let made = in_blocks(points, block, 2, &Watch::idle()).unwrap();
            let given = Given3 {
                points,
                simplices: &made.arrays.simplices,
                neighbors: &made.arrays.neighbors,
            };
            let found = validate(given, &Watch::idle()).unwrap();
            assert_eq!(found, Findings3::default());
            let one = in_blocks(points, block, 1, &Watch::idle()).unwrap();
            assert_eq!(one.arrays.simplices, made.arrays.simplices);
            assert_eq!(one.arrays.neighbors, made.arrays.neighbors);
            let sorted = |t: &[i32; 4]| {
                let mut t = *t;
                t.sort_unstable();
                t
            };
            let set: BTreeSet<[i32; 4]> = made.arrays.simplices.iter().map(sorted).collect();
            (set, made.duplicates)
        });
        assert!(sets.windows(2).all(|w| w[0] == w[1]));
    }

    fn random(n: usize) -> Vec<Point3> {
        let mut x = 7u64;
        let mut next = || {
            x = x
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (x >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..n).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn blocks_make_the_same_tetrahedra() {
        same_in_blocks(&random(30_000));
    }

    #[test]
    fn blocks_of_lattices_make_the_same_tetrahedra() {
        let rounded = |side: f64| {
            let points = random(20_000).into_iter();
            points
                .map(|p| p.map(|x| (x * side).floor()))
                .collect::<Vec<_>>()
        };
        same_in_blocks(&rounded(30.0));
        same_in_blocks(&rounded(8.0));
        let flat = random(20_000)
            .into_iter()
            .map(|[x, y, z]| [x, y, (z * 3.0).floor()]);
        same_in_blocks(&flat.collect::<Vec<_>>());
    }

    #[test]
    fn blocks_that_do_not_pay_make_the_same_tetrahedra() {
        let sphere = random(5000).into_iter().map(|p| {
            let q = p.map(|x| x - 0.5);
            let r = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| x / r)
        });
        same_in_blocks(&sphere.collect::<Vec<_>>());
        let mut far = random(2000);
        far.extend(random(2000).into_iter().map(|p| p.map(|x| 1e9 + x)));
        same_in_blocks(&far);
    }
}
