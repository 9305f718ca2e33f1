//! All pairs of triangles whose bounding boxes meet.
//!
//! A tree of boxes finds the candidates for a few neighboring triangles at a time: linear time, up
//! to a logarithm, for surfaces whose triangles have few others in their boxes. Around a vertex of
//! k triangles, it is k^2.

use delone_predicates::Point3;

use super::contact::Triangle;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::{Pace, Watch};
use crate::locate::Boxes;
use crate::order::order_of;

/// Triangles that look for candidates together.
const GROUP: usize = 8;
/// Groups per task.
const SHARE: usize = 1 << 9;
/// Candidates between two checks for interruption.
const LOT: usize = 1 << 14;

/// Calls `visit` with the rows and triangles of each pair in `kept`, rows of `faces`, whose boxes,
/// grown by `margin` on each side, have a point in common. Returns what it collected, by tasks, which
/// do not depend on the number of workers.
pub fn meeting<R: Default + Send>(
    points: &[Point3],
    faces: &[[u32; 3]],
    kept: &[u32],
    margin: f64,
    workers: usize,
    watch: &Watch,
    visit: impl Fn([u32; 2], [&Triangle; 2], &mut R) -> Result<()> + Sync,
) -> Result<Vec<R>> {
    let along = Along::of(points, faces, kept, margin, workers, watch)?;
    let groups = kept.len().div_ceil(GROUP);
    let tasks = (0..groups).step_by(SHARE).collect();
    parallel::map_watched(workers, tasks, watch, |first: usize| {
        let mut found = R::default();
        let mut near = Vec::new();
        let mut pace = Pace::new(watch, LOT);
        for group in first..(first + SHARE).min(groups) {
            along.pairs_of(group, &visit, &mut near, &mut found, &mut pace)?;
        }
        Ok(found)
    })
}

/// The triangles along the curve, with their boxes.
struct Along<'a> {
    points: &'a [Point3],
    faces: &'a [[u32; 3]],
    rows: Vec<u32>,
    boxes: Vec<Extent<3>>,
    tree: Boxes<3>,
}

impl<'a> Along<'a> {
    fn of(
        points: &'a [Point3],
        faces: &'a [[u32; 3]],
        kept: &[u32],
        margin: f64,
        workers: usize,
        watch: &Watch,
    ) -> Result<Self> {
        let extent = |row: u32| {
            let Extent { min, max } = Extent::of(faces[row as usize].map(|v| points[v as usize]));
            Extent {
                min: min.map(|x| x - margin),
                max: max.map(|x| x + margin),
            }
        };
        let mut middles = with_room(kept.len())?;
        let mut pace = Pace::new(watch, LOT);
        for &row in kept {
            pace.spend(1)?;
            let Extent { min, max } = extent(row);
            middles.push([0, 1, 2].map(|k| min[k] / 2.0 + max[k] / 2.0));
        }
        let mut rows = with_room(kept.len())?;
        for part in order_of(&middles, workers, watch)? {
            rows.extend(part.into_iter().map(|i| kept[i as usize]));
        }
        drop(middles);
        let mut boxes = with_room(rows.len())?;
        for &row in &rows {
            pace.spend(1)?;
            boxes.push(extent(row));
        }
        let mut order = with_room(rows.len())?;
        order.extend(0..rows.len() as u32);
        let tree = Boxes::packed(order, |i| boxes[i], watch)?;
        Ok(Self {
            points,
            faces,
            rows,
            boxes,
            tree,
        })
    }

    fn triangle(&self, place: usize) -> Triangle {
        let ids = self.faces[self.rows[place] as usize];
        let [a, b, c] = ids;
        let at = |v: u32| self.points[v as usize];
        Triangle {
            ids,
            at: [at(a), at(b), at(c)],
        }
    }

    /// Visits the pairs of the triangles of a group with each other and with those before.
    fn pairs_of<R>(
        &self,
        group: usize,
        visit: impl Fn([u32; 2], [&Triangle; 2], &mut R) -> Result<()>,
        near: &mut Vec<u32>,
        found: &mut R,
        pace: &mut Pace,
    ) -> Result<()> {
        let own = group * GROUP..((group + 1) * GROUP).min(self.rows.len());
        let around = Extent::of(self.boxes[own.clone()].iter().flat_map(|e| [e.min, e.max]));
        near.clear();
        let mut room = Ok(());
        self.tree.meeting(&around, |place| {
            if place < own.end && room.is_ok() {
                room = push(near, place as u32);
            }
        });
        room?;
        near.retain(|&place| meet(&around, &self.boxes[place as usize]));
        for place in own {
            pace.spend(near.len())?;
            let (a, box_a) = (self.triangle(place), self.boxes[place]);
            for &other in near.iter() {
                let other = other as usize;
                if other >= place || !meet(&box_a, &self.boxes[other]) {
                    continue;
                }
                let rows = [self.rows[place], self.rows[other]];
                visit(rows, [&a, &self.triangle(other)], found)?;
            }
        }
        Ok(())
    }
}

/// Whether two boxes have a point in common.
#[inline]
fn meet(a: &Extent<3>, b: &Extent<3>) -> bool {
    (0..3).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
}
