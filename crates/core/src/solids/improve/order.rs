//! Import and export: sorts vertices and tetrahedra by coordinates, and maps the result back to
//! rows.

use delone_predicates::{Point3, Sign, lexicographic, orient3d};

use super::store::{Corners, NONE, Store};
use super::task::{Improved, Task};
use super::work::Work;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};

/// Tetrahedra sorted by coordinates.
pub struct Imported {
    /// The tetrahedra.
    pub store: Store,
    /// The row of each vertex.
    pub rows: Vec<u32>,
    /// The factor by which coordinates were multiplied.
    pub scale: f64,
}

/// The power of two that scales coordinates to near 1, where products of their differences neither
/// overflow nor underflow; 1 if it would round some of them. Results for `tiny` coordinates may be
/// rounded when they are scaled back.
fn scale(points: &[Point3], tiny: bool) -> f64 {
    let all = points.as_flattened();
    let largest = all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let least = if tiny { f64::MIN_POSITIVE } else { 1e-270 };
    if (1e-20..1e20).contains(&largest) || largest < least {
        return 1.0;
    }
    let scale = 2_f64.powi(-(largest.log2() as i32));
    let exact = |x: &f64| x * scale / scale == *x;
    if all.iter().all(exact) { scale } else { 1.0 }
}

/// The even permutation of corners with the smallest vertex first and the next one second.
pub fn rotated(v: Corners) -> Corners {
    const EVEN: [[usize; 4]; 12] = [
        [0, 1, 2, 3],
        [0, 2, 3, 1],
        [0, 3, 1, 2],
        [1, 0, 3, 2],
        [1, 3, 2, 0],
        [1, 2, 0, 3],
        [2, 0, 1, 3],
        [2, 1, 3, 0],
        [2, 3, 0, 1],
        [3, 0, 2, 1],
        [3, 2, 1, 0],
        [3, 1, 0, 2],
    ];
    let all = EVEN.map(|p| p.map(|k| v[k]));
    all.into_iter().fold(v, |least, other| least.min(other))
}

/// Sorts and checks everything; `tiny` coordinates are scaled as well.
pub fn import(task: Task, tiny: bool) -> Result<Imported> {
    let mut used = filled(task.points.len(), false)?;
    for v in task.simplices.as_flattened() {
        used[*v as usize] = true;
    }
    let mut rows: Vec<u32> = with_room(used.len())?;
    rows.extend((0..).zip(&used).filter(|(_, used)| **used).map(|(v, _)| v));
    let at = |row: &u32| task.points[*row as usize];
    rows.sort_unstable_by(|a, b| lexicographic(at(a), at(b)).then(a.cmp(b)));
    if let Some(same) = rows.windows(2).find(|w| at(&w[0]) == at(&w[1])) {
        return Err(Error::Shape(format!(
            "rows {} and {} are the same point, but both are vertices",
            same[0], same[1]
        )));
    }
    let scale = scale(task.points, tiny);
    let mut points = with_room(rows.len())?;
    points.extend(rows.iter().map(|row| at(row).map(|x| x * scale)));
    let mut place = filled(task.points.len(), NONE)?;
    for (v, &row) in (0..).zip(&rows) {
        place[row as usize] = v;
    }
    let mut order: Vec<(Corners, i32)> = with_room(task.simplices.len())?;
    for (t, simplex) in task.simplices.iter().enumerate() {
        let v = simplex.map(|row| place[row as usize]);
        let [a, b, c, d] = v.map(|v| points[v as usize]);
        if orient3d(a, b, c, d) != Sign::Positive {
            return Err(Error::Shape(format!(
                "tetrahedron {t} is flat or negatively oriented"
            )));
        }
        order.push((rotated(v), task.labels.get(t).copied().unwrap_or(0)));
    }
    order.sort_unstable();
    let mut corners = with_room(order.len())?;
    let mut label = with_room(order.len())?;
    corners.extend(order.iter().map(|(v, _)| *v));
    label.extend(order.iter().map(|(_, l)| *l));
    let mut store = Store::new(points, corners, label, &rows)?;
    for (fixed, &row) in store.fixed.iter_mut().zip(&rows) {
        *fixed |= task.fixed.get(row as usize).copied().unwrap_or(false);
    }
    whole_stars(&mut store, task, &rows)?;
    Ok(Imported { store, rows, scale })
}

/// Rejects a movable vertex that has tetrahedra outside its connected star: they overlap. On walls, such a
/// vertex does not slide.
fn whole_stars(store: &mut Store, task: Task, rows: &[u32]) -> Result<()> {
    let mut degree = filled(store.points.len(), 0_u32)?;
    for v in store.corners.as_flattened() {
        degree[*v as usize] += 1;
    }
    let mut star = Vec::new();
    for v in (0..store.points.len() as u32).filter(|&v| !store.fixed[v as usize]) {
        if star_size(store, v, &mut star)? != degree[v as usize] {
            let row = rows[v as usize];
            return Err(Error::Shape(format!(
                "the tetrahedra around row {row} do not form one ball: some overlap"
            )));
        }
    }
    if task.turn {
        for v in (0..store.points.len() as u32).filter(|&v| store.rim[v as usize]) {
            let row = rows[v as usize] as usize;
            let held = task.fixed.get(row).copied().unwrap_or(false);
            store.whole_star(v, &mut star)?;
            let whole = star.len() as u32 == degree[v as usize];
            store.pinched[v as usize] = !whole;
            store.slides[v as usize] = whole && !held;
        }
    }
    Ok(())
}

fn star_size(store: &Store, v: u32, star: &mut Vec<u32>) -> Result<u32> {
    store.star(v, star)?;
    Ok(star.len() as u32)
}

/// Whether coordinates can be scaled back without rounding.
pub fn is_exact(points: &[Point3], scale: f64) -> bool {
    let all = points.as_flattened();
    all.iter().all(|x| x / scale * scale == *x)
}

/// Converts everything to rows, with tetrahedra sorted by their vertices.
pub fn export(
    work: Work,
    task: Task,
    mut rows: Vec<u32>,
    scale: f64,
    exhausted: bool,
) -> Result<Improved> {
    let store = work.store;
    // Added vertices get the rows behind the given ones.
    let count = task.points.len() + store.points.len() - rows.len();
    for row in task.points.len()..count {
        push(&mut rows, row as u32)?;
    }
    let mut points = with_room(count)?;
    points.extend_from_slice(task.points);
    points.resize(count, [0.0; 3]);
    for (&row, p) in rows.iter().zip(&store.points) {
        points[row as usize] = p.map(|x| x / scale);
    }
    let mut weights = filled(count, 0.0)?;
    for (&row, w) in rows.iter().zip(&work.weights) {
        // Divided twice, as the square of the scale may be out of range.
        weights[row as usize] = w / scale / scale;
    }
    // The remaining tetrahedra, sorted by their vertices.
    let mut order: Vec<(Corners, u32)> = with_room(store.corners.len())?;
    let there = (0..store.places()).filter(|&t| store.is_there(t));
    order.extend(there.map(|t| (rotated(store.corners[t as usize]), t)));
    order.sort_unstable();
    let mut number = filled(store.corners.len() + 1, -1)?;
    for (i, (_, t)) in (0..).zip(&order) {
        number[*t as usize] = i;
    }
    let mut out = Improved {
        points,
        simplices: with_room(order.len())?,
        neighbors: with_room(order.len())?,
        labels: with_room(order.len())?,
        distance: work.depth.iter().fold(0.0_f64, |m, &d| m.max(d)) / scale,
        weights,
        counts: work.counts,
        exhausted,
    };
    for &(v, t) in &order {
        let t = t as usize;
        out.simplices.push(v.map(|v| rows[v as usize] as i32));
        let across = v.map(|v| {
            let k = store.corners[t].iter().position(|&x| x == v);
            k.map_or(-1, |k| match store.across[t][k] {
                NONE => -1,
                u => number[u as usize],
            })
        });
        out.neighbors.push(across);
        out.labels.push(store.label[t]);
    }
    Ok(out)
}
