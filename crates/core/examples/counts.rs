//! Runs one job on fixed input, to count its instructions: `counts JOB`; without a job, the names
//! of all. `benchmarks/counts.py` runs it under callgrind, which collects inside [`counted`].
//!
//! Inputs are made by arithmetic alone, without a mathematical library: they are the same bits on
//! every system. One thread does all the work.

use std::error::Error;
use std::hint::black_box;

use delone_core::base::arrays::Given;
use delone_core::base::watch::{IDLE, Watch};
use delone_core::constrained::{Options, constrain};
use delone_core::delaunay::plane::{Method, triangulate};
use delone_core::delaunay::space as delaunay3;
use delone_core::hull::hull3;
use delone_core::interpolate::{Field, Kind, Order, natural_values};
use delone_core::live::plane::Plane;
use delone_core::locate::{Batch, Kept, Locator, find};
use delone_core::overlap::{Grid, Polygons, overlaps};
use delone_core::regular::regular;
use delone_core::solids::improve;
use delone_core::solids::recover::{Task, recover};
use delone_core::terrain::contour;
use delone_core::terrain::volume::{Other, Surface, volumes};
use delone_core::{Point2, Point3};
use delone_core::{alpha, graphs, ndim, refine, sphere};

type Outcome = Result<(), Box<dyn Error>>;
type Job = fn() -> Outcome;

/// A job with its name; its points are few, as callgrind takes fifty times as long.
const JOBS: [(&str, Job); 22] = [
    ("uniform", || planar(&uniform(20_000))),
    ("lattice", || planar(&lattice(100))),
    ("clusters", || planar(&clusters(10_000))),
    ("constrained", constrained),
    ("find", finding),
    ("space", || spatial(&uniform(3_000))),
    ("voxels", || spatial(&voxels(12))),
    ("sphere", spherical),
    ("edits", edits),
    ("tree", spanning),
    ("neighbors", nearest),
    ("alpha", shapes),
    ("contours", contours),
    ("recover", surface),
    ("volumes", overlaid),
    ("hull", rounded),
    ("power", weighted),
    ("natural", interpolated),
    ("refine", refined),
    ("improve", improved),
    ("higher", higher),
    ("overlaps", shared),
];

fn main() -> Outcome {
    let Some(name) = std::env::args().nth(1) else {
        JOBS.iter().for_each(|(name, _)| println!("{name}"));
        return Ok(());
    };
    let found = JOBS.iter().find(|(job, _)| *job == name);
    let (_, job) = found.ok_or_else(|| format!("no job {name}"))?;
    job()
}

/// What callgrind counts.
#[inline(never)]
fn counted<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    black_box(work())
}

fn planar(points: &[Point2]) -> Outcome {
    counted(|| triangulate(points, Method::Auto, 1, &Watch::idle()))?;
    Ok(())
}

fn spatial(points: &[Point3]) -> Outcome {
    counted(|| delaunay3::triangulate(points, 1, &Watch::idle()))?;
    Ok(())
}

/// A closed line through points of a circle of rational coordinates, and points around it.
fn constrained() -> Outcome {
    let corners = 1_000u32;
    let corner = |i: u32| {
        // Half of the circle by its rational parametrization, then its mirror image.
        let t = f64::from(i % (corners / 2)) / f64::from(corners / 4) - 1.0;
        let side = if i < corners / 2 { 0.3 } else { -0.3 };
        let square = 1.0 + t * t;
        [
            0.5 + side * 2.0 * t / square,
            0.5 + side * (1.0 - t * t) / square,
        ]
    };
    let mut points: Vec<Point2> = (0..corners).map(corner).collect();
    points.extend(uniform::<2>(4_000));
    let segments: Vec<[u32; 2]> = (0..corners).map(|i| [i, (i + 1) % corners]).collect();
    let options = Options {
        split: true,
        conforming: false,
        max_vertices: 100_000,
        method: Method::Auto,
        workers: 1,
    };
    counted(|| constrain(&points, &segments, options, &Watch::idle()))?;
    Ok(())
}

/// Location of points in a triangulation of others.
fn finding() -> Outcome {
    let watch = &Watch::idle();
    let points = uniform(5_000);
    let queries: Vec<Point2> = uniform(15_000).split_off(5_000);
    let made = triangulate(&points, Method::Auto, 1, watch)?;
    let given = Given {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let kept = Kept::of(&given, watch)?;
    let batch = Batch {
        locator: Locator::new(given, &kept, &IDLE),
        queries: &queries,
        workers: 1,
        watch,
    };
    counted(|| find(&batch))?;
    Ok(())
}

/// Directions to points of a cube around the center.
fn spherical() -> Outcome {
    let vectors: Vec<Point3> = uniform(3_000)
        .into_iter()
        .map(|p: Point3| p.map(|x| x - 0.5))
        .collect();
    counted(|| sphere::triangulate(&vectors, 1, &Watch::idle()))?;
    Ok(())
}

/// A batch of insertions, one of small moves, and single removals in a live triangulation.
fn edits() -> Outcome {
    let watch = &Watch::idle();
    let points: Vec<Point2> = uniform(3_000);
    let more: Vec<Point2> = uniform(4_000).split_off(3_000);
    let rows: Vec<i64> = (0..3_000).step_by(60).collect();
    let near: Vec<Point2> = rows
        .iter()
        .map(|&row| points[row as usize].map(|x| x + 0.001))
        .collect();
    let mut live = Plane::new(&points, 1, watch)?;
    counted(|| {
        live.insert(&more, 1, watch)?;
        live.relocate(&rows, &near, 1, watch)?;
        rows.iter()
            .try_for_each(|&row| live.remove(&[row], 1, watch))
    })?;
    Ok(())
}

/// The minimum spanning tree of points.
fn spanning() -> Outcome {
    let watch = &Watch::idle();
    let points: Vec<Point2> = uniform(5_000);
    let made = triangulate(&points, Method::Auto, 1, watch)?.arrays;
    counted(|| {
        graphs::spanning_tree_of_triangles(&points, &made.simplices, &made.neighbors, 1, watch)
    })?;
    Ok(())
}

/// The nearest neighbors of points, from the tree on.
fn nearest() -> Outcome {
    let watch = &Watch::idle();
    let points: Vec<Point3> = uniform(3_000);
    counted(|| {
        let tree = graphs::Tree::of(&points, 1, watch)?;
        graphs::nearest(&tree, 6, graphs::Neighbors::Either, points.len(), 1, watch)
    })?;
    Ok(())
}

/// The values of simplices of alpha complexes in 2-D and 3-D.
fn shapes() -> Outcome {
    let watch = &Watch::idle();
    let (flat, solid): (Vec<Point2>, Vec<Point3>) = (uniform(3_000), uniform(1_000));
    let plane = triangulate(&flat, Method::Auto, 1, watch)?.arrays;
    let space = delaunay3::triangulate(&solid, 1, watch)?;
    let weights = &[];
    counted(|| {
        let sites = alpha::Sites {
            points: &flat,
            weights,
        };
        alpha::flat(sites, &plane.simplices, &plane.neighbors, 1, watch)?;
        let sites = alpha::Sites {
            points: &solid,
            weights,
        };
        alpha::solid(
            sites,
            &space.arrays.simplices,
            &space.arrays.neighbors,
            1,
            watch,
        )
    })?;
    Ok(())
}

/// A triangulated surface with a height for each point.
struct Sheet {
    points: Vec<Point2>,
    simplices: Vec<[i32; 3]>,
    neighbors: Vec<[i32; 3]>,
    heights: Vec<f64>,
}

impl Sheet {
    fn of(points: Vec<Point2>, height: fn(Point2) -> f64) -> Result<Self, Box<dyn Error>> {
        let made = triangulate(&points, Method::Auto, 1, &Watch::idle())?.arrays;
        Ok(Self {
            heights: points.iter().map(|&p| height(p)).collect(),
            points,
            simplices: made.simplices,
            neighbors: made.neighbors,
        })
    }

    fn surface(&self) -> Surface<'_> {
        Surface {
            given: Given {
                points: &self.points,
                simplices: &self.simplices,
                neighbors: &self.neighbors,
            },
            heights: &self.heights,
        }
    }
}

/// Contour lines of a saddle.
fn contours() -> Outcome {
    let sheet = Sheet::of(uniform(3_000), |[x, y]| (x - 0.5) * (y - 0.3))?;
    let levels: Vec<f64> = (-20..20).map(|k| f64::from(k) / 128.0).collect();
    let Surface { given, heights } = sheet.surface();
    let watch = &Watch::idle();
    counted(|| {
        contour::lines(
            given,
            heights,
            (&levels, &[]),
            false,
            usize::MAX,
            (1, watch),
        )
    })?;
    Ok(())
}

/// The inside of a surface that the Delaunay triangulation of its corners lacks in part.
fn surface() -> Outcome {
    let side = 6;
    let (points, faces) = ridges(side);
    let task = Task {
        points: &points,
        faces: &faces,
        max_points: 10_000,
        flips: true,
        workers: 1,
    };
    counted(|| recover(task, &Watch::idle()))?;
    Ok(())
}

/// The volume between two surfaces.
fn overlaid() -> Outcome {
    let one = Sheet::of(uniform(2_000), |[x, y]| x * y)?;
    let other = Sheet::of(uniform(4_000).split_off(2_000), |[x, y]| 1.0 - x * y)?;
    let other = Other::Surface(other.surface());
    counted(|| volumes(one.surface(), other, None, 1, &Watch::idle()))?;
    Ok(())
}

/// The convex hull of points on a paraboloid, up to their rounding.
fn rounded() -> Outcome {
    let bowl: Vec<Point3> = uniform::<2>(4_000)
        .into_iter()
        .map(|[x, y]| [x, y, (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5)])
        .collect();
    counted(|| hull3(&bowl, &Watch::idle()))?;
    Ok(())
}

/// A regular triangulation with weights that hide some sites.
fn weighted() -> Outcome {
    let sites: Vec<[f64; 3]> = uniform(8_000);
    let points: Vec<Point2> = sites.iter().map(|&[x, y, _]| [x, y]).collect();
    let weights: Vec<f64> = sites.iter().map(|&[_, _, w]| w / 4_000.0).collect();
    counted(|| regular(&points, &weights, 1, &Watch::idle()))?;
    Ok(())
}

/// Natural neighbor interpolation.
fn interpolated() -> Outcome {
    let watch = &Watch::idle();
    let points = uniform(2_000);
    let queries: Vec<Point2> = uniform(6_000).split_off(2_000);
    let values: Vec<f64> = points.iter().map(|&[x, y]: &Point2| x * y).collect();
    let made = triangulate(&points, Method::Auto, 1, watch)?;
    let given = Given {
        points: &points,
        simplices: &made.arrays.simplices,
        neighbors: &made.arrays.neighbors,
    };
    let kept = Kept::of(&given, watch)?;
    let batch = Batch {
        locator: Locator::new(given, &kept, &IDLE),
        queries: &queries,
        workers: 1,
        watch,
    };
    let field = Field::new(&given, &values, None, 1)?;
    counted(|| natural_values(&batch, Kind::Sibson, field, &[], Order::Value))?;
    Ok(())
}

/// A mesh of a square around points.
fn refined() -> Outcome {
    let watch = &Watch::idle();
    let mut points: Vec<Point2> = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    points.extend(uniform::<2>(2_000));
    let segments: Vec<[u32; 2]> = vec![[0, 1], [1, 2], [2, 3], [3, 0]];
    let options = Options {
        split: false,
        conforming: false,
        max_vertices: 0,
        method: Method::Auto,
        workers: 1,
    };
    let base = constrain(&points, &segments, options, watch)?;
    let count = base.arrays.simplices.len();
    let task = refine::Task {
        points: &points,
        simplices: &base.arrays.simplices,
        neighbors: Some(&base.arrays.neighbors),
        labels: &vec![0; count],
        areas: &vec![f64::INFINITY; count],
        segments: &segments,
        lines: None,
        frozen: &[false; 4],
        min_angle: 30.0,
        circles: false,
        sizes_yield: false,
        max_vertices: 100_000,
    };
    counted(|| refine::refine(task, watch))?;
    Ok(())
}

/// Tetrahedra with as few slivers as possible.
fn improved() -> Outcome {
    let watch = &Watch::idle();
    let points: Vec<Point3> = uniform(250);
    let made = delaunay3::triangulate(&points, 1, watch)?;
    let task = improve::Task {
        points: &points,
        simplices: &made.arrays.simplices,
        labels: &[],
        fixed: &[],
        removable: &vec![true; points.len()],
        min_angle: 20.0,
        flips: true,
        smooth: true,
        exude: false,
        turn: false,
        tolerance: 0.0,
        passes: 5,
        most: 4,
    };
    counted(|| improve::improve(task, watch, &mut |_, _| Ok(())))?;
    Ok(())
}

/// A triangulation in four dimensions.
fn higher() -> Outcome {
    counted(|| ndim::triangulate::<4, 5, 4>(&uniform(250), &IDLE))?;
    Ok(())
}

/// The areas that the cells of two cubed-sphere grids share, one of which is rotated.
fn shared() -> Outcome {
    let cells = |n: u32, turn: bool| {
        let at = |k: u32| f64::from(2 * k) / f64::from(n) - 1.0;
        let mut vectors: Vec<Point3> = Vec::new();
        for (face, i, j) in (0..6 * n * n).map(|k| (k / (n * n), k / n % n, k % n)) {
            for (i, j) in [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)] {
                let (a, b) = (at(i), at(j));
                let [x, y, z] = [
                    [1.0, a, b],
                    [-a, 1.0, b],
                    [-1.0, -a, b],
                    [a, -1.0, b],
                    [-b, a, 1.0],
                    [b, a, -1.0],
                ][face as usize];
                // A rotation by rational numbers.
                let turned = [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z];
                vectors.push(if turn { turned } else { [x, y, z] });
            }
        }
        vectors
    };
    let (one, other) = (cells(7, false), cells(9, true));
    let starts = |n: usize, step: i64| (0..=n as i64).map(|k| k * step).collect::<Vec<i64>>();
    let rings = [starts(one.len() / 4, 4), starts(other.len() / 4, 4)];
    let cells = [starts(one.len() / 4, 1), starts(other.len() / 4, 1)];
    let holes = [vec![false; one.len() / 4], vec![false; other.len() / 4]];
    let grid = |i: usize| {
        Grid::Polygons(Polygons {
            vectors: if i == 0 { &one } else { &other },
            rings: &rings[i],
            cells: &cells[i],
            holes: &holes[i],
        })
    };
    let (p, q) = (grid(0), grid(1));
    counted(|| overlaps(&p, &q, 1, &Watch::idle()))?;
    Ok(())
}

/// A closed surface: a bottom and a top of sharp ridges, whose rows cross at right angles.
fn ridges(side: i32) -> (Vec<Point3>, Vec<[i32; 3]>) {
    let row = side + 1;
    let all = row * row;
    let mut points = Vec::new();
    for top in [false, true] {
        for i in 0..all {
            let (x, y) = (i % row, i / row);
            let along = if top { x } else { y };
            let ridge = if along % 2 == 1 { 0.9 } else { 0.0 };
            points.push([
                f64::from(x),
                f64::from(y),
                if top { 2.0 - ridge } else { ridge },
            ]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..side * side {
        let a = i % side + i / side * row;
        let (b, c, d) = (a + 1, a + row, a + row + 1);
        faces.extend([[a, c, b], [b, c, d]]);
        faces.extend([[a, b, c], [b, d, c]].map(|face| face.map(|v| v + all)));
    }
    for k in 0..side {
        let sides = [[k, k + 1], [(k + 1) * row, k * row]];
        let far = [
            [side * row + k + 1, side * row + k],
            [k * row + side, (k + 1) * row + side],
        ];
        for [a, b] in sides.into_iter().chain(far) {
            faces.extend([[a, b, b + all], [a, b + all, a + all]]);
        }
    }
    (points, faces)
}

fn uniform<const D: usize>(n: usize) -> Vec<[f64; D]> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        // G. Marsaglia's xorshift with a product.
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [(); D].map(|()| random())).collect()
}

fn lattice(side: u32) -> Vec<Point2> {
    (0..side * side)
        .map(|i| [i % side, i / side].map(f64::from))
        .collect()
}

fn voxels(side: u32) -> Vec<Point3> {
    (0..side * side * side)
        .map(|i| [i % side, i / side % side, i / side / side].map(f64::from))
        .collect()
}

/// Ten clusters, each ten times as dense as the one before.
fn clusters(n: usize) -> Vec<Point2> {
    let scale = |i: usize| 0.1f64.powi(i as i32 % 10);
    let points = uniform(n).into_iter().enumerate();
    points
        .map(|(i, p)| p.map(|x| scale(i) * x + (i % 10) as f64))
        .collect()
}
