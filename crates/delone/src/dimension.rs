//! What differs between triangles in 2-D and tetrahedra in 3-D: one table of functions each.

use std::fmt::Debug;
use std::sync::OnceLock;

use delone_core::arrays::{Arrays, Given, OUTWARD};
use delone_core::delaunay2::{self, Stage};
use delone_core::error::Result as CoreResult;
use delone_core::watch::Watch;
use delone_core::{delaunay3, locate, locate3, measure, voronoi, voronoi3};

use crate::Options;

/// Points in the dimension of simplices with `N` corners: [`Point2`](crate::Point2) and 3, or
/// [`Point3`](crate::Point3) and 4. It is sealed: there are no others.
pub trait Dimension<const N: usize>: Kernel<N> {}

impl Dimension<3> for [f64; 2] {}
impl Dimension<4> for [f64; 3] {}

/// A triangulation, and what was met on the way.
pub struct Made<const N: usize> {
    pub arrays: Arrays<N>,
    pub duplicates: Vec<[u32; 2]>,
    pub stages: Vec<Stage>,
}

/// Points and simplices, and what queries keep of them.
pub struct Scene<'a, P, const N: usize> {
    pub points: &'a [P],
    pub simplices: &'a [[i32; N]],
    pub neighbors: &'a [[i32; N]],
    pub kept: &'a Kept,
    pub workers: usize,
}

/// What queries share, made by the first of them; of the two, the one of the dimension is used.
#[derive(Debug, Default)]
pub struct Kept {
    plane: OnceLock<locate::Kept>,
    space: OnceLock<locate3::Kept>,
}

/// Locations of queries; rows of queries on the other side of the boundary have -1 and NaN.
pub struct Located {
    pub simplex: Vec<i32>,
    pub weights: Vec<f64>,
    pub beside: Vec<i32>,
    pub facet: Vec<i32>,
    /// The weights of the corners of the facet.
    pub shares: Vec<f64>,
}

/// The functions of the core for one dimension.
pub trait Kernel<const N: usize>: Sized + Send + Sync {
    type Diagram: Debug;

    /// The corners of the facet opposite each corner, counter-clockwise seen from outside.
    const FACETS: [&'static [usize]; N];

    fn triangulate(points: &[Self], options: &Options, watch: &Watch) -> CoreResult<Made<N>>;
    fn edges(scene: Scene<Self, N>, watch: &Watch) -> CoreResult<Vec<[i32; 2]>>;
    fn sizes(scene: Scene<Self, N>, watch: &Watch) -> CoreResult<Vec<f64>>;
    fn locate(scene: Scene<Self, N>, queries: &[Self], watch: &Watch) -> CoreResult<Located>;
    fn nearest(scene: Scene<Self, N>, queries: &[Self], watch: &Watch) -> CoreResult<Vec<i32>>;
    fn voronoi(scene: Scene<Self, N>, watch: &Watch) -> CoreResult<Self::Diagram>;
    fn vertices(diagram: &Self::Diagram) -> &[Self];
}

impl<'a, const D: usize, const N: usize> Scene<'a, [f64; D], N> {
    fn given(&self) -> Given<'a, D, N> {
        Given {
            points: self.points,
            simplices: self.simplices,
            neighbors: self.neighbors,
        }
    }

    fn dual(&self) -> voronoi::Given<'a, D, N> {
        voronoi::Given {
            points: self.points,
            weights: &[],
            simplices: self.simplices,
            neighbors: self.neighbors,
        }
    }
}

/// What is kept, or is made now; if two threads make it, one of two equal values.
fn kept<K>(cell: &OnceLock<K>, make: impl FnOnce() -> CoreResult<K>) -> CoreResult<&K> {
    if let Some(kept) = cell.get() {
        return Ok(kept);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}

/// Calls `work` with queries of triangles as the core takes them.
fn batch2<T>(
    scene: &Scene<[f64; 2], 3>,
    queries: &[[f64; 2]],
    watch: &Watch,
    work: impl FnOnce(&locate::Batch) -> CoreResult<T>,
) -> CoreResult<T> {
    let given = scene.given();
    let kept = kept(&scene.kept.plane, || locate::Kept::of(&given, watch))?;
    work(&locate::Batch {
        locator: locate::Locator::new(given, kept, watch),
        queries,
        workers: scene.workers,
        watch,
    })
}

/// The same of tetrahedra.
fn batch3<T>(
    scene: &Scene<[f64; 3], 4>,
    queries: &[[f64; 3]],
    watch: &Watch,
    work: impl FnOnce(&locate3::Batch) -> CoreResult<T>,
) -> CoreResult<T> {
    let given = scene.given();
    let kept = kept(&scene.kept.space, || locate3::Kept::of(&given, watch))?;
    work(&locate3::Batch {
        locator: locate3::Locator::new(given, kept, watch),
        queries,
        workers: scene.workers,
        watch,
    })
}

impl Kernel<3> for [f64; 2] {
    type Diagram = voronoi::Diagram;

    const FACETS: [&'static [usize]; 3] = [&[1, 2], &[2, 0], &[0, 1]];

    fn triangulate(points: &[Self], options: &Options, watch: &Watch) -> CoreResult<Made<3>> {
        let made = delaunay2::triangulate(points, options.method, options.workers(), watch)?;
        Ok(Made {
            arrays: made.arrays,
            duplicates: made.duplicates,
            stages: made.stages,
        })
    }

    fn edges(scene: Scene<Self, 3>, watch: &Watch) -> CoreResult<Vec<[i32; 2]>> {
        let n = scene.points.len();
        measure::edges2(scene.simplices, scene.neighbors, n, scene.workers, watch)
    }

    fn sizes(scene: Scene<Self, 3>, watch: &Watch) -> CoreResult<Vec<f64>> {
        measure::areas(scene.points, scene.simplices, scene.workers, watch)
    }

    fn locate(scene: Scene<Self, 3>, queries: &[Self], watch: &Watch) -> CoreResult<Located> {
        let found = batch2(&scene, queries, watch, locate::coordinates)?;
        let shares = found.along.iter().flat_map(|t| [1.0 - t, *t]);
        Ok(Located {
            shares: shares.collect(),
            simplex: found.triangle,
            weights: found.weights,
            beside: found.beside,
            facet: found.edge,
        })
    }

    fn nearest(scene: Scene<Self, 3>, queries: &[Self], watch: &Watch) -> CoreResult<Vec<i32>> {
        batch2(&scene, queries, watch, locate::nearest)
    }

    fn voronoi(scene: Scene<Self, 3>, watch: &Watch) -> CoreResult<Self::Diagram> {
        voronoi::diagram(scene.dual(), scene.workers, watch)
    }

    fn vertices(diagram: &Self::Diagram) -> &[Self] {
        &diagram.vertices
    }
}

impl Kernel<4> for [f64; 3] {
    type Diagram = voronoi3::Diagram;

    const FACETS: [&'static [usize]; 4] = [&OUTWARD[0], &OUTWARD[1], &OUTWARD[2], &OUTWARD[3]];

    fn triangulate(points: &[Self], options: &Options, watch: &Watch) -> CoreResult<Made<4>> {
        let made = delaunay3::triangulate(points, options.workers(), watch)?;
        Ok(Made {
            arrays: made.arrays,
            duplicates: made.duplicates,
            stages: made.stages,
        })
    }

    fn edges(scene: Scene<Self, 4>, watch: &Watch) -> CoreResult<Vec<[i32; 2]>> {
        let n = scene.points.len();
        measure::edges3(scene.simplices, n, scene.workers, watch)
    }

    fn sizes(scene: Scene<Self, 4>, watch: &Watch) -> CoreResult<Vec<f64>> {
        measure::volumes(scene.points, scene.simplices, scene.workers, watch)
    }

    fn locate(scene: Scene<Self, 4>, queries: &[Self], watch: &Watch) -> CoreResult<Located> {
        let found = batch3(&scene, queries, watch, locate3::coordinates)?;
        Ok(Located {
            simplex: found.simplex,
            weights: found.weights,
            beside: found.beside,
            facet: found.face,
            shares: found.shares,
        })
    }

    fn nearest(scene: Scene<Self, 4>, queries: &[Self], watch: &Watch) -> CoreResult<Vec<i32>> {
        batch3(&scene, queries, watch, locate3::nearest)
    }

    fn voronoi(scene: Scene<Self, 4>, watch: &Watch) -> CoreResult<Self::Diagram> {
        voronoi3::diagram(scene.dual(), scene.workers, watch)
    }

    fn vertices(diagram: &Self::Diagram) -> &[Self] {
        &diagram.vertices
    }
}
