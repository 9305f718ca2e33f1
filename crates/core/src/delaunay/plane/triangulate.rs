//! Triangulates rows of coordinates: scan, sort, build in blocks, merge, export.

use std::ops::Range;

use delone_predicates::{Point2, incircle};

use super::merge::merge;
use super::{bowyer_watson, divide_conquer, incremental, lifting, sweep};
use crate::base::error::Result;
use crate::base::watch::Watch;
use crate::base::{parallel, points};
use crate::delaunay::{Clock, Triangulated};
use crate::mesh::plane::{Code, Mesh2, Patch, export};
use crate::order::{Arranged, arrange};

/// How a triangulation is built; all methods give the same triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The fastest: cavity insertion along the curve, or divide and conquer if there are many ties.
    Auto,
    /// Cavity insertion along the curve.
    BowyerWatson,
    /// Recursive halves, merged.
    DivideConquer,
    /// Randomized insertion and flips.
    Incremental,
    /// Fortune's sweep line.
    Sweep,
    /// The lower hull of the lifted points.
    Lifting,
}

impl Method {
    /// The names of the methods.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("auto", Self::Auto),
        ("bowyer-watson", Self::BowyerWatson),
        ("divide-and-conquer", Self::DivideConquer),
        ("incremental", Self::Incremental),
        ("sweep", Self::Sweep),
        ("lifting", Self::Lifting),
    ];

    /// The method with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES
            .iter()
            .find(|(n, _)| *n == name)
            .map(|&(_, m)| m)
    }

    /// Whether it works on blocks that are merged; the others take all points at once.
    fn in_blocks(self) -> bool {
        matches!(self, Self::Auto | Self::BowyerWatson | Self::DivideConquer)
    }
}

/// Places at which a block is tested for ties, and how many ties mean that there are many. Of four
/// consecutive points along the curve a third are cocircular on a grid, hardly any among scattered
/// points.
const TRIED: usize = 48;
const MANY: usize = 6;

/// Triangles in the rows of the input.
pub type Triangulation = Triangulated<3>;

/// A triangulation as a mesh.
#[derive(Debug)]
pub struct Built {
    /// The mesh of all distinct points.
    pub mesh: Mesh2,
    /// One of its ghosts.
    pub ghost: Code,
    /// The points as vertices, and one of NaN for infinity.
    pub points: Vec<Point2>,
    /// For each vertex, its first row in the input.
    pub rows: Vec<u32>,
    /// `[row, first row of the same point]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// The canonical Delaunay triangulation of `input`; the same arrays for any number of workers.
pub fn triangulate(
    input: &[Point2],
    method: Method,
    workers: usize,
    watch: &Watch,
) -> Result<Triangulation> {
    let mut clock = Clock::start();
    let Built {
        mesh,
        ghost,
        points,
        rows,
        duplicates,
    } = mesh(input, method, workers, watch, &mut clock)?;
    watch.check()?;
    drop(points);
    let arrays = export::arrays(mesh, ghost, &rows, workers, watch)?;
    clock.lap("export");
    Ok(Triangulation {
        arrays,
        duplicates,
        stages: clock.stages,
    })
}

/// The same as a mesh; the times of the stages go to `clock`.
pub fn mesh(
    input: &[Point2],
    method: Method,
    workers: usize,
    watch: &Watch,
    clock: &mut Clock,
) -> Result<Built> {
    points::scan(input)?;
    clock.lap("scan");
    let mut arranged = arrange(input, workers, watch)?;
    clock.lap("order");
    let n = arranged.rows.len();
    if n < 3 {
        return Err(points::degenerate(&arranged.points, &arranged.rows));
    }
    // The vertex at infinity: its NaN fails every filter, so exact tests decide.
    arranged.points.push([f64::NAN; 2]);
    let mut mesh = Mesh2::with_vertices(n)?;
    let ghost = build(&mut mesh, &arranged, method, workers, watch)?;
    let patch = mesh.patch();
    if patch.vertex(patch.opposite(ghost)) == patch.infinite() {
        // Ghosts on both sides of a hull edge: all points are collinear.
        return Err(points::degenerate(&arranged.points[..n], &arranged.rows));
    }
    clock.lap("build");
    let Arranged {
        points,
        rows,
        duplicates,
        ..
    } = arranged;
    Ok(Built {
        mesh,
        ghost,
        points,
        rows,
        duplicates,
    })
}

/// Meshes with fewer vertices are merged by one thread: starting another takes about as long as all
/// merges of two blocks.
const MERGED_ALONE: usize = 1 << 18;

/// Triangulates each block, then merges pairs of blocks.
fn build(
    mesh: &mut Mesh2,
    arranged: &Arranged,
    method: Method,
    workers: usize,
    watch: &Watch,
) -> Result<Code> {
    let points = &arranged.points[..];
    // A merge needs two vertices per side. Only duplicates make blocks of fewer.
    let few = |w: &[usize]| w[1] - w[0] < 2;
    let whole = [0, mesh.vertices()];
    let one = !method.in_blocks() || arranged.starts.windows(2).any(few);
    let starts = if one { &whole } else { &arranged.starts[..] };
    let tasks = patches(mesh, starts, 1);
    let mut ghosts = parallel::map_watched(workers, tasks, watch, |(i, mesh)| {
        block(
            points,
            starts[i] as u32..starts[i + 1] as u32,
            mesh,
            method,
            watch,
        )
    })?;
    let merging = if points.len() < MERGED_ALONE {
        1
    } else {
        workers
    };
    let mut width = 2;
    while ghosts.len() > 1 {
        watch.check()?;
        let tasks = patches(mesh, starts, width);
        ghosts = parallel::map_watched(merging, tasks, watch, |(i, mut mesh)| {
            let spare = mesh.spare(starts[i * width + width / 2] - starts[i * width]);
            let sides = [ghosts[2 * i], ghosts[2 * i + 1]];
            let axis = arranged.cuts.axis(i, width);
            Ok(merge(&mut mesh, points, sides, axis, spare))
        })?;
        width *= 2;
    }
    Ok(ghosts[0])
}

/// The mesh in patches of `width` blocks.
fn patches<'a>(mesh: &'a mut Mesh2, starts: &[usize], width: usize) -> Vec<(usize, Patch<'a>)> {
    let bounds: Vec<usize> = starts.iter().copied().step_by(width).collect();
    let mut rest = mesh.patch();
    let mut patches = Vec::with_capacity(bounds.len());
    for (i, w) in bounds.windows(2).enumerate() {
        let (patch, after) = rest.split_at(w[1] - w[0]);
        patches.push((i, patch));
        rest = after;
    }
    patches
}

/// Triangulates one block by the requested method.
fn block(
    points: &[Point2],
    block: Range<u32>,
    mut mesh: Patch,
    method: Method,
    watch: &Watch,
) -> Result<Code> {
    let own = block.clone();
    let ghost = match method {
        Method::Auto if has_many_ties(&points[block.start as usize..block.end as usize]) => None,
        Method::Auto | Method::BowyerWatson => {
            bowyer_watson::build(points, own, mesh.reborrow(), watch)?
        }
        Method::Incremental => incremental::build(points, own, mesh.reborrow(), watch)?,
        Method::Sweep => sweep::build(points, own, mesh.reborrow(), watch)?,
        Method::Lifting => lifting::build(points, own, mesh.reborrow(), watch)?,
        Method::DivideConquer => None,
    };
    if let Some(ghost) = ghost {
        return Ok(ghost);
    }
    divide_conquer::build(points, block, mesh, watch)
}

/// Whether many consecutive points of a block, which is sorted along the curve, are cocircular.
fn has_many_ties(own: &[Point2]) -> bool {
    let step = (own.len() / TRIED).max(4);
    let ties = own
        .chunks(step)
        .filter_map(|part| part.first_chunk())
        .filter(|&&[a, b, c, d]| incircle(a, b, c, d).is_zero());
    ties.count() >= MANY
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_grids_have_many_ties() {
        let grid = |i: u32| [f64::from(i % 60), f64::from(i / 60)];
        let scattered = |i: u32| grid(i).map(|x| (x + 0.3 * (1.7 * x * f64::from(i)).sin()) * 1e3);
        let abound = |points: Vec<Point2>| {
            let arranged = arrange(&points, 1, &Watch::idle()).unwrap();
            has_many_ties(&arranged.points)
        };
        assert!(abound((0..3600).map(grid).collect()));
        assert!(!abound((0..3600).map(scattered).collect()));
        assert!(!abound(
            (0..3600)
                .map(scattered)
                .map(|p| p.map(f64::round))
                .collect()
        ));
        assert!(!abound((0..3).map(grid).collect()));
    }
}
