//! Triangulates rows of vectors: check, order, insert, export.
//!
//! The order is that of `delaunay2::bowyer_watson`. Here no other method takes over where cavities are
//! large: any input ends, as each insertion does, but some take quadratic time.

use delone_predicates::{Point3, Sign};

use super::degenerate::degenerate;
use super::directions::{Arranged, Directions, arrange, check};
use super::kernel::Kernel;
use crate::arrays::Arrays;
use crate::error::Result;
use crate::memory::with_room;
use crate::mesh2::{Mesh2, export, triangle};
use crate::order::{Rounds, sort};
use crate::watch::Watch;

/// Strides of the rounds, as in 2-D.
const STRIDES: [u32; 3] = [64, 8, 1];
/// Directions between two checks for interruption in the search for the first triangle.
const LOT: u32 = 1 << 12;

/// Triangles in the rows of the input.
#[derive(Debug)]
pub struct Triangulation {
    /// Triangles, counterclockwise seen from outside, and their neighbors; -1 beyond the hull.
    pub arrays: Arrays<3>,
    /// `[row, first row of the same direction]`, ascending.
    pub duplicates: Vec<[u32; 2]>,
}

/// The canonical Delaunay triangulation of the directions of `vectors`; the same arrays for any number of
/// workers.
pub fn triangulate(vectors: &[Point3], workers: usize, watch: &Watch) -> Result<Triangulation> {
    check(vectors)?;
    let mut arranged = arrange(vectors, workers, watch)?;
    let n = arranged.directions.len();
    let Some(first) = first_triangle(&arranged.directions, watch)? else {
        return Err(degenerate(&arranged, watch)?);
    };
    let mut mesh = Mesh2::with_vertices(n as usize)?;
    let directions = &arranged.directions;
    let mut kernel = Kernel::start(directions, mesh.patch(), first, watch);
    let mut order = Rounds::over(n, STRIDES).filter(|v| !first.contains(v));
    let mut near = kernel.ghost().map_or(0, triangle);
    let mut next = order.next();
    while let Some(p) = next {
        next = order.next();
        near = kernel.insert(p, near, next.unwrap_or(p))?;
    }
    let (ghost, taken) = (kernel.ghost(), kernel.taken());
    let repeats = std::mem::take(&mut kernel.repeats);
    let duplicates = join(&mut arranged, &repeats, watch)?;
    let arrays = export::partial_arrays(mesh, ghost, taken, &arranged.rows, workers, watch)?;
    Ok(Triangulation { arrays, duplicates })
}

/// Three directions that are not on one great circle, counterclockwise; `None` if all are on one.
fn first_triangle(directions: &Directions, watch: &Watch) -> Result<Option<[u32; 3]>> {
    let order = || Rounds::over(directions.len(), STRIDES);
    let Some(a) = order().next() else {
        return Ok(None);
    };
    let mut second = None;
    for c in order() {
        if c.is_multiple_of(LOT) {
            watch.check()?;
        }
        let Some(b) = second else {
            second = (!directions.parallel(a, c)).then_some(c);
            continue;
        };
        match directions.orient([a, b, c]) {
            Sign::Positive => return Ok(Some([a, b, c])),
            Sign::Negative => return Ok(Some([b, a, c])),
            Sign::Zero => {}
        }
    }
    Ok(None)
}

/// All rows of directions that occur before, with the first row of the same direction, which becomes
/// the row of the vertex.
fn join(arranged: &mut Arranged, repeats: &[[u32; 2]], watch: &Watch) -> Result<Vec<[u32; 2]>> {
    let Arranged {
        rows,
        repeats: equal,
        ..
    } = arranged;
    // The vertex of each number.
    let mut vertices: Vec<u32> = with_room(rows.len())?;
    vertices.extend(0..rows.len() as u32);
    for &[number, vertex] in repeats {
        vertices[number as usize] = vertex;
    }
    let mut found: Vec<[u32; 2]> = with_room(equal.len() + repeats.len())?;
    found.extend(
        equal
            .iter()
            .map(|&[row, number]| [row, vertices[number as usize]]),
    );
    found.extend(
        repeats
            .iter()
            .map(|&[number, vertex]| [rows[number as usize], vertex]),
    );
    watch.check()?;
    for [row, vertex] in &mut found {
        let first = &mut rows[*vertex as usize];
        if *row < *first {
            std::mem::swap(row, first);
        }
    }
    for pair in &mut found {
        pair[1] = rows[pair[1] as usize];
    }
    sort(&mut found, watch)?;
    Ok(found)
}
