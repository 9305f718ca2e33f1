//! Delaunay refinement: adds vertices until no angle is small and no triangle is large, as far as
//! the input allows.
//!
//! J. Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", Journal
//! of Algorithms 18 (1995), with the diametral lenses of L. P. Chew, "Guaranteed-quality mesh
//! generation for curved surfaces" (1993), the off-centers of A. Üngör (2004), and for small angles
//! of the input the rule of G. L. Miller, S. E. Pav and N. J. Walkington, "When and why Delaunay
//! refinement algorithms work", International Journal of Computational Geometry & Applications 15
//! (2005): a skinny triangle is accepted if its shortest edge joins two subsegments that meet in a
//! corner, at points on one circle around it. The rule applies to corners of less than 60 degrees.
//!
//! The order of work depends on the mesh only, so the result is the same every time.

mod corners;
mod gap;
mod insert;
mod isolate;
mod judge;
mod needles;
mod place;
mod queue;
mod rounds;
mod shape;
pub mod smooth;
mod task;
mod work;

use delone_predicates::Point2;

pub use self::judge::{Judged, judge};
pub use self::rounds::{Fresh, Rounds, Samples};
use self::task::Rules;
pub use self::task::{Counts, Lines, Refined, Task, Tell};
use self::work::Work;
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::marked::Marked;
use crate::delaunay::plane::lawson::compact;
use crate::mesh::plane::{half_edge, import, next, prev, triangle};

/// Triangles, or segments, between two checks for interruption.
const LOT: usize = 1 << 16;

/// Refines a triangulation.
pub fn refine(task: Task, watch: &Watch) -> Result<Refined> {
    refine_telling(task, watch, &mut |_, _| Ok(()))
}

/// Refines a triangulation and reports progress.
pub fn refine_telling(task: Task, watch: &Watch, tell: Tell) -> Result<Refined> {
    let scale = scale(task.points);
    if scale == 1.0 {
        return refine_as_is(task, watch, tell);
    }
    let mut made = refine_scaled(task, scale, watch, tell)?;
    let added = made.added.as_flattened_mut();
    if added.iter().any(|x| x / scale * scale != *x) {
        // Rounding among subnormal doubles could invert triangles.
        return refine_as_is(task, watch, tell);
    }
    for x in added {
        *x /= scale;
    }
    Ok(made)
}

/// Refines a triangulation with all coordinates multiplied by a power of two.
fn refine_scaled(task: Task, scale: f64, watch: &Watch, tell: Tell) -> Result<Refined> {
    let scaled = |p: &Point2| p.map(|x| x * scale);
    let mut points = with_room(task.points.len())?;
    points.extend(task.points.iter().map(scaled));
    // Multiply twice, because the square of the scale may be out of range.
    let mut areas = with_room(task.areas.len())?;
    areas.extend(task.areas.iter().map(|a| a * scale * scale));
    let task = Task {
        points: &points,
        areas: &areas,
        ..task
    };
    refine_as_is(task, watch, tell)
}

/// The power of two that scales coordinates so that products of four of their differences neither
/// overflow nor underflow; 1 if they already do not, or if it would round some of them.
fn scale(points: &[Point2]) -> f64 {
    let largest = points
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, x| m.max(x.abs()));
    if (1e-60..1e60).contains(&largest) || largest == 0.0 {
        return 1.0;
    }
    // Both the scale and its inverse are doubles.
    let scale = 2_f64.powi(-(largest.log2() as i32).clamp(-1022, 1022));
    let exact = |x: &f64| x * scale / scale == *x;
    let all = points.as_flattened().iter().all(exact);
    if all { scale } else { 1.0 }
}

fn refine_as_is(task: Task, watch: &Watch, tell: Tell) -> Result<Refined> {
    let (mut work, rows) = begin(task, watch)?;
    for (cap, area) in work.caps.iter_mut().zip(task.areas) {
        *cap = 2.0 * area;
    }
    let exhausted = !work.run(watch, tell)?;
    export(&mut work, &rows, task.points.len(), exhausted, watch)
}

/// A refinement without limits on areas, and the row of each vertex.
fn begin(task: Task, watch: &Watch) -> Result<(Work, Vec<u32>)> {
    let (rows, own) = compact(task.points, task.simplices, watch)?;
    let mut points = with_room(rows.len() + 1)?;
    points.extend(rows.iter().map(|&row| task.points[row as usize]));
    points.push([f64::NAN; 2]);
    let (mesh, _) = import::mesh(&own, task.neighbors, rows.len(), watch)?;
    let mut marked = Marked::new(mesh, points, watch)?;
    let mut place = filled(task.points.len(), u32::MAX)?;
    for (v, &row) in (0..).zip(&rows) {
        place[row as usize] = v;
    }
    let placed = |segments: &[[u32; 2]]| -> Result<Vec<[u32; 2]>> {
        let mut ends = with_room(segments.len())?;
        ends.extend(segments.iter().map(|s| s.map(|row| place[row as usize])));
        Ok(ends)
    };
    let pieces = placed(task.segments)?;
    let lines = task.lines.map(|lines| placed(lines.ends)).transpose()?;
    let lines = lines.as_ref().unwrap_or(&pieces);
    let mut on = filled(rows.len(), -1)?;
    if let Some(given) = task.lines {
        for (on, &row) in on.iter_mut().zip(&rows) {
            *on = given.on[row as usize];
        }
    }
    let caps = filled(marked.triangles() as usize, f64::INFINITY)?;
    let mut pace = Pace::new(watch, LOT);
    for (t, &label) in (0..).zip(task.labels) {
        pace.spend(1)?;
        // 0 is for ghosts and triangles outside the domain.
        marked.patch().set_label(t, (label + 1).max(0) as u32);
    }
    for &[u, v] in &pieces {
        pace.spend(1)?;
        if u.max(v) as usize >= rows.len() {
            return Err(Error::Shape("an end of a segment is not a vertex".into()));
        }
        let e = marked.edge(u, v)?;
        marked.patch().mark(e, true);
    }
    let rules = Rules {
        frozen: copied(task.frozen)?,
        min_angle: task.min_angle,
        circles: task.circles,
        sizes_yield: task.sizes_yield,
        max_vertices: task.max_vertices,
    };
    let of = task.lines.map(|lines| lines.of);
    let work = Work::new(marked, caps, on, [&pieces, lines], of, rules)?;
    Ok((work, rows))
}

/// Converts everything to rows.
fn export(
    work: &mut Work,
    rows: &[u32],
    given: usize,
    exhausted: bool,
    watch: &Watch,
) -> Result<Refined> {
    let mut pace = Pace::new(watch, LOT);
    let count = work.marked.count;
    let mut row_of = with_room(count)?;
    row_of.extend_from_slice(rows);
    row_of.extend((given as u32..).take(count - rows.len()));
    let added = copied(&work.marked.points[rows.len()..count])?;
    let on = copied(&work.on[rows.len()..count])?;
    let triangles = work.marked.triangles();
    let mesh = work.marked.patch();
    // Number the finite triangles.
    let mut number = filled(triangles as usize, -1)?;
    let infinite = mesh.infinite();
    let finite = |t: &u32| !mesh.corners(*t).contains(&infinite);
    let mut all = with_room(triangles as usize)?;
    all.extend((0..triangles).filter(finite));
    for (i, &t) in (0..).zip(&all) {
        number[t as usize] = i;
    }
    let mut out = Refined {
        added,
        on,
        simplices: with_room(all.len())?,
        neighbors: with_room(all.len())?,
        sides: with_room(all.len())?,
        labels: with_room(all.len())?,
        needles: with_room(all.len())?,
        counts: work.counts,
        exhausted,
    };
    for &t in &all {
        pace.spend(1)?;
        let codes = [half_edge(t, 0), half_edge(t, 1), half_edge(t, 2)];
        let corners = mesh.corners(t).map(|v| row_of[v as usize] as i32);
        out.simplices.push(corners);
        let across = codes.map(|e| number[triangle(mesh.opposite(e)) as usize]);
        out.neighbors.push(across);
        out.labels.push(mesh.label(t) as i32 - 1);
        out.needles.push(work.needles.left(t));
    }
    // The line of each side; this needs `work` mutably, hence the second loop.
    for &t in &all {
        pace.spend(1)?;
        let codes = [half_edge(t, 0), half_edge(t, 1), half_edge(t, 2)];
        let mut sides = [-1; 3];
        for (side, e) in sides.iter_mut().zip(codes) {
            let mesh = work.marked.patch();
            if mesh.is_marked(e) {
                let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
                *side = work.segment_of(ends);
            }
        }
        out.sides.push(sides);
    }
    Ok(out)
}
