//! Triangulates rows of 3-D coordinates: scan, sort, build in blocks, join, export.
//!
//! A large set is split into blocks, which threads triangulate in parallel and `seam` joins. The
//! blocks depend on the points only, so the arrays are the same for any number of threads.

use std::sync::Mutex;

use delone_predicates::Point3;

use super::cavity::Room;
use super::insertion;
use super::join::{Fitted, join};
use super::seam::{Block, Seam, Surroundings, belonging, joints};
use super::sphere::Sphere;
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{is_plausible, with_room};
use crate::base::watch::Watch;
use crate::base::{parallel, points};
use crate::delaunay::{Clock, Triangulated};
use crate::mesh::space::{LIMIT, Mesh3, Records};
use crate::order::space::{Arranged3, Extent3, Room3, arrange, arrange_rows};
use crate::order::space_blocks::{Cuts3, split};

/// Sizes of blocks.
#[derive(Debug, Clone, Copy)]
struct Sizes {
    /// From this many points on there are two blocks.
    two: usize,
    /// The most points that a block should hold.
    block: usize,
    /// The fewest points of the seam of two blocks that a block should hold.
    slab: usize,
    /// The same for the seam of more blocks.
    shells: usize,
    /// Points per block in the sample that tells whether blocks pay.
    sample: usize,
    /// Of this many points at most one is in the sample, as it must cost little.
    sparse: usize,
}

/// The seam of two halves of a million uniform points has 5 % of them, which are triangulated
/// twice; that of two halves of 2^17 points has 10 %; smaller blocks have more.
///
/// The seam of two halves is a slab, and split across it has 8 % of its points in a seam of its
/// own. The seam of more blocks consists of shells around cells, and most of its points are near
/// its own medians: of four million points in 32 blocks a seventh is in the seam. Of these, 85 %
/// are in a seam of their own if it is split in 32, too, 29 % for four blocks, and 15 % for two.
/// Not splitting a seam at all is then faster, even with two threads.
const SIZES: Sizes = Sizes {
    two: 1 << 17,
    block: 1 << 19,
    slab: 1 << 13,
    shells: 1 << 18,
    sample: 1 << 12,
    sparse: 64,
};

/// Tetrahedra in the rows of the input.
pub type Triangulation3 = Triangulated<4>;

/// The canonical Delaunay triangulation of `input`; the same arrays for any number of workers.
pub fn triangulate(input: &[Point3], workers: usize, watch: &Watch) -> Result<Triangulation3> {
    in_blocks(input, SIZES, workers, watch)
}

fn in_blocks(
    input: &[Point3],
    sizes: Sizes,
    workers: usize,
    watch: &Watch,
) -> Result<Triangulation3> {
    let mut clock = Clock::start();
    points::scan(input)?;
    clock.lap("scan");
    let task = Task {
        sizes,
        workers,
        watch,
    };
    if input.len() >= sizes.two {
        let blocks = input.len().div_ceil(sizes.block).next_power_of_two().max(2);
        let cuts = Cuts3::of(input, blocks)?;
        let pays = task.pays(input, &cuts)?;
        clock.lap("sample");
        if pays && let Some((arrays, duplicates)) = task.joined(input, &cuts, &mut clock)? {
            return Ok(Triangulation3 {
                arrays,
                duplicates,
                stages: clock.stages,
            });
        }
    }
    match task.single(input, 1, &mut clock)? {
        Ok((arrays, duplicates)) => Ok(Triangulation3 {
            arrays,
            duplicates,
            stages: clock.stages,
        }),
        Err(Arranged3 { points, rows, .. }) => Err(points::degenerate_in_space(&points, &rows)),
    }
}

/// Tetrahedra, and rows of duplicate points.
type Made = (Arrays<4>, Vec<[u32; 2]>);

/// Records of all blocks, the room of each, and the sound tetrahedra in it.
type Built = (Records, Vec<usize>, Vec<Block>);

/// Parameters of all parts of one triangulation.
#[derive(Clone, Copy)]
struct Task<'a> {
    sizes: Sizes,
    workers: usize,
    watch: &'a Watch<'a>,
}

impl Task<'_> {
    /// The triangulation in one block with room for `times` as many records as usual; if the points
    /// are degenerate, the points in order.
    fn single(
        self,
        input: &[Point3],
        times: usize,
        clock: &mut Clock,
    ) -> Result<std::result::Result<Made, Arranged3>> {
        let mut arranged = arrange(input, self.watch)?;
        clock.lap("order");
        // The vertex at infinity.
        arranged.points.push([f64::NAN; 3]);
        let parts = std::slice::from_ref(&arranged);
        let Some((records, rooms, blocks)) = self.built(parts, None, times)? else {
            arranged.points.pop();
            return Ok(Err(arranged));
        };
        clock.lap("build");
        drop(std::mem::take(&mut arranged.points));
        let arrays = join(records, &rooms, &blocks, None, self.workers, self.watch)?;
        clock.lap("join");
        Ok(Ok((arrays, arranged.duplicates)))
    }

    /// Whether blocks pay: not if most points would be in the seam, as for points on a sphere,
    /// whose tetrahedra all have that circumsphere.
    fn pays(self, input: &[Point3], cuts: &Cuts3) -> Result<bool> {
        let step = input.len() / (self.sizes.sample * cuts.blocks());
        // Odd, since rows of a grid are periodic.
        let step = step.max(self.sizes.sparse) | 1;
        let mut sample = with_room(input.len() / step + 1)?;
        sample.extend(input.iter().step_by(step));
        let parts = self.parts(&sample, cuts)?;
        let Some((_, _, blocks)) = self.built(&parts, Some(cuts), 1)? else {
            return Ok(false);
        };
        let in_seam = blocks.iter().map(|b| b.seam.len()).sum::<usize>();
        Ok(4 * in_seam <= 3 * sample.len())
    }

    /// The triangulation by blocks; `None` if a block or the seam is degenerate.
    fn joined(self, input: &[Point3], cuts: &Cuts3, clock: &mut Clock) -> Result<Option<Made>> {
        let mut parts = self.parts(input, cuts)?;
        clock.lap("order");
        let Some((records, rooms, blocks)) = self.built(&parts, Some(cuts), 1)? else {
            return Ok(None);
        };
        clock.lap("build");
        let mut duplicates = Vec::new();
        for part in &mut parts {
            duplicates.append(&mut part.duplicates);
        }
        duplicates.sort_unstable();
        drop(parts);
        let Some(fitted) = self.fitted(input.len(), &blocks)? else {
            return Ok(None);
        };
        clock.lap("seam");
        let arrays = join(
            records,
            &rooms,
            &blocks,
            Some(&fitted),
            self.workers,
            self.watch,
        )?;
        clock.lap("join");
        Ok(Some((arrays, duplicates)))
    }

    /// The points of each block along the curve, and one of NaN.
    fn parts(self, input: &[Point3], cuts: &Cuts3) -> Result<Vec<Arranged3>> {
        let blocks = split(input, cuts, self.workers, self.watch)?;
        let mut tasks = Vec::with_capacity(cuts.blocks());
        for (points, rows) in blocks.each() {
            tasks.push((points, rows, Room3::of(points.len())?));
        }
        parallel::map_watched(self.workers, tasks, self.watch, |(points, rows, room)| {
            let mut arranged = arrange_rows(points, Some(rows), room, self.watch)?;
            arranged.points.push([f64::NAN; 3]);
            Ok(arranged)
        })
    }

    /// Triangulates each block and finds its sound tetrahedra; `None` if one is degenerate. If the
    /// room for records does not suffice, which happens only for sets that are far from scattered,
    /// it starts again with twice as much: all attempts together cost less than twice the last.
    fn built(
        self,
        parts: &[Arranged3],
        cuts: Option<&Cuts3>,
        mut times: usize,
    ) -> Result<Option<Built>> {
        let mut first = true;
        loop {
            match self.attempt(parts, cuts, times, first) {
                Err(Error::TooManyTetrahedra { limit }) if limit < LIMIT => times *= 2,
                outcome => return outcome,
            }
            first = false;
        }
    }

    fn attempt(
        self,
        parts: &[Arranged3],
        cuts: Option<&Cuts3>,
        times: usize,
        first: bool,
    ) -> Result<Option<Built>> {
        let vertices = |part: &Arranged3| part.points.len() - 1;
        // Divide the room for records among the blocks.
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
        if !first {
            check_memory(room)?;
        }
        let mut records = Records::with_room(room)?;
        let meshes = records.meshes(&rooms);
        // One array of spheres for each thread, used for one block after another: the first touch of
        // its memory takes as long as a tenth of the insertions.
        let most = rooms.iter().map(|&(room, _)| room).max().unwrap_or(0);
        let idle = (0..self.workers.clamp(1, parts.len())).map(|_| with_room(most));
        let idle = Mutex::new(idle.collect::<Result<Vec<Vec<Sphere>>>>()?);
        // Each task gets its own slices of the records, so blocks share no mutable state.
        let mut tasks = Vec::with_capacity(parts.len());
        for (((i, part), mesh), &(room, vertices)) in
            parts.iter().enumerate().zip(meshes).zip(&rooms)
        {
            tasks.push((i, part, mesh, Room::of(room, vertices)?));
        }
        let made = parallel::map_watched(
            self.workers,
            tasks,
            self.watch,
            |(i, part, mesh, room): (usize, &Arranged3, Mesh3, Room)| {
                let around = Surroundings {
                    cell: cuts.map_or(Extent3::EVERYWHERE, |cuts| cuts.cell(i)),
                    others: [&boxes[..i], &boxes[i + 1..]].concat(),
                };
                let spheres = idle.lock().ok().and_then(|mut idle| idle.pop());
                let spheres = spheres.unwrap_or_default();
                let (points, watch) = (&part.points[..], self.watch);
                let Some((mesh, made)) = insertion::build(points, mesh, room, spheres, watch)?
                else {
                    return Ok(None);
                };
                let block = Block::sift(points, part.rows.clone(), &mesh, &made, &around)?;
                if let Ok(mut idle) = idle.lock() {
                    idle.push(made);
                }
                Ok(Some(block))
            },
        )?;
        let blocks: Option<Vec<Block>> = made.into_iter().collect();
        let rooms = rooms.into_iter().map(|(room, _)| room).collect();
        Ok(blocks.map(|blocks| (records, rooms, blocks)))
    }

    /// Triangulates the seam of the blocks of `whole` points and finds where it meets them; `None`
    /// if it is degenerate.
    fn fitted(self, whole: usize, blocks: &[Block]) -> Result<Option<Fitted>> {
        let (vertices, points) = Seam::gather(blocks)?;
        let Some(arrays) = self.seam(&points, whole, blocks.len())? else {
            return Ok(None);
        };
        let seam = Seam { vertices, arrays };
        self.watch.check()?;
        let joints = joints(blocks, &seam, self.workers)?;
        self.watch.check()?;
        let belongs = belonging(&seam, &joints)?;
        Ok(Some(Fitted {
            seam,
            belongs,
            joints,
        }))
    }

    /// The tetrahedra of a seam. It is split into at most as many blocks as made it, if it is large
    /// enough for them and has at most half of the points, so that the recursion terminates.
    fn seam(self, points: &[Point3], whole: usize, blocks: usize) -> Result<Option<Arrays<4>>> {
        let mut clock = Clock::start();
        let least = match blocks {
            2 => self.sizes.slab,
            _ => self.sizes.shells,
        };
        let blocks = blocks.min(1 << (points.len() / least).max(1).ilog2());
        if blocks > 1 && points.len() <= whole / 2 {
            let cuts = Cuts3::of(points, blocks)?;
            if let Some((arrays, _)) = self.joined(points, &cuts, &mut clock)? {
                return Ok(Some(arrays));
            }
        }
        // Twice the room, as the points are far from uniform.
        Ok(self
            .single(points, 2, &mut clock)?
            .ok()
            .map(|(arrays, _)| arrays))
    }
}

/// Refuses a further attempt that would need more memory than is available. (Otherwise a quadratic
/// triangulation would grow until the system ends the process.)
fn check_memory(room: usize) -> Result<()> {
    /// Corners, facets, sphere and mark of a record.
    const RECORD: usize = 16 + 16 + 32 + 1;
    let bytes = room * RECORD;
    if is_plausible(bytes) {
        Ok(())
    } else {
        Err(Error::Memory { bytes })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::base::arrays::Given;
    use crate::base::random::uniform;
    use crate::delaunay::space::validate::{Findings3, validate};

    /// The tetrahedra in blocks of several sizes, all valid and identical.
    fn same_in_blocks(points: &[Point3]) {
        let n = points.len();
        let sets = [usize::MAX, n / 2 + 1, n / 7 + 1, n / 30 + 1].map(|block| {
            let sizes = Sizes {
                two: block,
                block,
                slab: 60,
                shells: 200,
                sample: 500,
                sparse: 1,
            };
            let made = in_blocks(points, sizes, 2, &Watch::idle()).unwrap();
            let given = Given {
                points,
                simplices: &made.arrays.simplices,
                neighbors: &made.arrays.neighbors,
            };
            let found = validate(given, &Watch::idle()).unwrap();
            assert_eq!(found, Findings3::default());
            let one = in_blocks(points, sizes, 1, &Watch::idle()).unwrap();
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
        let mut next = uniform(7);
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

    /// The tetrahedra in blocks, whether that pays or not, and in one, as sets of rows.
    fn same_when_joined(points: &[Point3], blocks: usize) {
        let watch = Watch::idle();
        let task = |seam: usize| Task {
            sizes: Sizes {
                slab: seam,
                shells: seam,
                ..SIZES
            },
            workers: 3,
            watch: &watch,
        };
        let set = |(arrays, duplicates): Made| {
            let sorted = arrays.simplices.into_iter().map(|mut t| {
                t.sort_unstable();
                t
            });
            (sorted.collect::<BTreeSet<[i32; 4]>>(), duplicates)
        };
        let clock = &mut Clock::start();
        let single = set(task(0).single(points, 1, clock).unwrap().unwrap());
        let cuts = Cuts3::of(points, blocks).unwrap();
        for seam in [20, usize::MAX / 4] {
            let joined = task(seam).joined(points, &cuts, clock).unwrap();
            assert_eq!(joined.map(set).as_ref(), Some(&single));
        }
    }

    #[test]
    fn seams_of_seams_make_the_same_tetrahedra() {
        for blocks in [2, 4, 32] {
            same_when_joined(&random(6000), blocks);
            let twice = random(6000)
                .into_iter()
                .map(|p| p.map(|x| (x * 9.0).floor()));
            same_when_joined(&twice.collect::<Vec<_>>(), blocks);
        }
    }

    #[test]
    fn seams_of_spheres_and_of_far_clusters_make_the_same_tetrahedra() {
        let unit = |q: Point3| {
            let r = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            q.map(|x| x / r)
        };
        let sphere = random(3000).into_iter().map(|p| unit(p.map(|x| x - 0.5)));
        let sphere: Vec<Point3> = sphere.collect();
        let mut scales = random(1500);
        scales.extend(random(1500).into_iter().map(|p| p.map(|x| 1e12 + 1e9 * x)));
        scales.extend(random(1500).into_iter().map(|p| p.map(|x| -1e-9 * x)));
        for blocks in [2, 8] {
            same_when_joined(&sphere, blocks);
            same_when_joined(&scales, blocks);
        }
    }
}
