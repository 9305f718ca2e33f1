//! The mesh as arrays, in an order that hangs on the triangles alone and not on their history:
//! by smallest vertex, then by the vertex that follows it; each triangle begins with its smallest.

use super::{Code, Mesh2, next, prev, triangle};
use crate::error::Result;
use crate::memory::{filled, with_room};

/// How many triangles ahead records are prefetched: some ten records are on their way at a time.
const AHEAD: usize = 16;

/// The finite triangles of a mesh.
#[derive(Debug, Default)]
pub struct Arrays {
    /// Three vertices a triangle, counter-clockwise.
    pub simplices: Vec<[i32; 3]>,
    /// The triangle opposite each vertex, -1 outside.
    pub neighbors: Vec<[i32; 3]>,
}

/// Exports `mesh`; vertex v becomes `rows[v]`.
pub fn arrays(mesh: &Mesh2, rows: &[u32]) -> Result<Arrays> {
    let order = canonical_order(mesh)?;
    let mut place = filled(mesh.len(), -1i32)?;
    for (i, corner) in (0i32..).zip(&order) {
        place[triangle(corner.code()) as usize] = i;
    }
    let mut out = Arrays {
        simplices: with_room(order.len())?,
        neighbors: with_room(order.len())?,
    };
    for (i, corner) in order.iter().enumerate() {
        if let Some(ahead) = order.get(i + AHEAD) {
            mesh.prefetch(triangle(ahead.code()));
        }
        let e = corner.code();
        let codes = [e, next(e), prev(e)];
        out.simplices
            .push(codes.map(|c| rows[mesh.vertex(c) as usize] as i32));
        out.neighbors
            .push(codes.map(|c| place[triangle(mesh.opposite(c)) as usize]));
    }
    Ok(out)
}

/// The half-edge of the smallest vertex of a triangle, below the vertex that follows: ordering
/// these orders the triangles of one smallest vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Corner(u64);

impl Corner {
    fn code(self) -> Code {
        self.0 as Code
    }
}

/// The finite triangles in canonical order.
fn canonical_order(mesh: &Mesh2) -> Result<Vec<Corner>> {
    // A counting sort by smallest vertex; the few triangles of one vertex are sorted in place.
    let vertices = mesh.infinite() as usize;
    let mut start = filled(vertices + 1, 0u32)?;
    let mut finite = 0;
    for (smallest, _) in smallest_corners(mesh) {
        start[smallest as usize + 1] += 1;
        finite += 1;
    }
    for v in 0..vertices {
        start[v + 1] += start[v];
    }
    let mut order = filled(finite, Corner(0))?;
    for (smallest, corner) in smallest_corners(mesh) {
        let at = &mut start[smallest as usize];
        order[*at as usize] = corner;
        *at += 1;
    }
    let mut from = 0;
    for &to in &start[..vertices] {
        insertion_sort(&mut order[from..to as usize]);
        from = to as usize;
    }
    Ok(order)
}

/// For fans of two or three; long ones (a hub of many points) go to the library.
fn insertion_sort(fan: &mut [Corner]) {
    if fan.len() > 16 {
        return fan.sort_unstable();
    }
    for i in 1..fan.len() {
        let corner = fan[i];
        let mut j = i;
        while j > 0 && fan[j - 1] > corner {
            fan[j] = fan[j - 1];
            j -= 1;
        }
        fan[j] = corner;
    }
}

/// The smallest vertex of each finite triangle and its corner.
fn smallest_corners(mesh: &Mesh2) -> impl Iterator<Item = (u32, Corner)> + '_ {
    (0..mesh.len() as u32).filter_map(|t| {
        let [a, b, c] = mesh.corners(t);
        let smallest = a.min(b).min(c);
        let (k, after) = if smallest == a {
            (0, b)
        } else if smallest == b {
            (1, c)
        } else {
            (2, a)
        };
        let corner = Corner(u64::from(after) << 32 | u64::from(8 * t + k));
        (a.max(b).max(c) != mesh.infinite()).then_some((smallest, corner))
    })
}
