//! The greedy insertion, with a heap of the worst points of the triangles.

use delone_predicates::{Point2, orient2d};

use super::heap::{Heap, Worst};
use super::plane::{NONE, below};
use super::points::{Points, Star, Wedge};
use super::task::{Simplified, Task};
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::marked::{Marked, turn};
use crate::mesh::plane::{Code, Patch, half_edge, half_edges, next, prev};

/// Points between two checks for interruption.
const LOT: usize = 1 << 16;

/// The worst point of a triangle.
#[derive(Debug, Clone, Copy)]
struct Cell {
    error: f64,
    worst: u32,
}

const EMPTY: Cell = Cell {
    error: 0.0,
    worst: NONE,
};

/// A surface that gets points.
#[derive(Debug)]
pub struct Work<'a, P> {
    task: Task<'a>,
    marked: Marked,
    /// The heights of the vertices.
    heights: Vec<f64>,
    points: P,
    /// For each triangle.
    cells: Vec<Cell>,
    heap: Heap,
    /// How many triangles have a point that is not good enough.
    live: usize,
    /// The star of the last vertex.
    star: Star,
    /// The result.
    pub found: Simplified,
}

impl<'a, P: Points> Work<'a, P> {
    /// The coarse surface, with all points in its triangles; `exact` if offsets are computed without
    /// rounding.
    pub fn start(
        task: Task<'a>,
        marked: Marked,
        points: P,
        exact: bool,
        watch: &Watch,
    ) -> Result<Self> {
        let mut heights = with_room(task.heights.len())?;
        heights.extend_from_slice(task.heights);
        let mut work = Self {
            task,
            marked,
            heights,
            points,
            cells: filled(task.coarse.simplices.len(), EMPTY)?,
            heap: Heap::default(),
            live: 0,
            star: Star {
                exact,
                ..Star::default()
            },
            found: Simplified::default(),
        };
        let mut pace = Pace::new(watch, LOT);
        for t in 0..work.cells.len() as u32 {
            pace.spend(1)?;
            let mut wedge = work.wedge(half_edge(t, 0));
            work.points.judge(&mut wedge, &mut pace)?;
            work.settle(&wedge)?;
        }
        Ok(work)
    }

    /// Inserts points until the error is small enough, or there are enough triangles.
    pub fn run(&mut self, watch: &Watch) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        let mut triangles = self.task.triangles;
        // Each round inserts a point or ends.
        loop {
            let top = self.top();
            let error = top.map_or_else(|| self.rest(), |top| top.error);
            push(&mut self.found.errors, error)?;
            push(&mut self.found.triangles, triangles as i32)?;
            let Some(Worst {
                point, triangle, ..
            }) = top
            else {
                return Ok(());
            };
            let (raised, row) = (self.points.raised(point), self.points.row(point));
            let on = self.edge_at(triangle, below(raised));
            self.star.closed = !on.is_some_and(|e| self.is_hull(e));
            let more = if self.star.closed { 2 } else { 1 };
            if triangles + more > self.task.max_triangles {
                return Ok(());
            }
            triangles += more;
            push(&mut self.found.order, row as i32)?;
            let corner = self.marked.star_at(below(raised), triangle, on)?;
            push(&mut self.heights, raised[2])?;
            self.take_star(corner)?;
            self.spread(point, &mut pace)?;
            let cells = &self.cells;
            self.heap
                .tidy(self.live, |worst| is_live(cells, worst), &self.points);
        }
    }

    /// The worst of all points that are not good enough.
    fn top(&mut self) -> Option<Worst> {
        let cells = &self.cells;
        self.heap.first(|worst| is_live(cells, worst), &self.points)
    }

    /// The greatest error of points that are good enough.
    fn rest(&self) -> f64 {
        self.cells
            .iter()
            .fold(0.0, |most, cell| most.max(cell.error))
    }

    /// The edge of a triangle on which a point lies.
    fn edge_at(&mut self, t: u32, p: Point2) -> Option<Code> {
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        half_edges(t).find(|&e| {
            let [u, v] = [next(e), prev(e)].map(|c| self.marked.points[mesh.vertex(c) as usize]);
            orient2d(u, v, p).is_zero()
        })
    }

    /// Whether an edge is on the hull.
    fn is_hull(&mut self, e: Code) -> bool {
        let mesh = self.marked.patch();
        mesh.vertex(mesh.opposite(e)) == mesh.infinite()
    }

    /// The triangles around the newest vertex, from one of its corners on.
    fn take_star(&mut self, first: Code) -> Result<()> {
        self.star.wedges.clear();
        let mut corner = first;
        if !self.star.closed {
            // On the hull there are two ghosts, after which the star begins.
            let mesh = self.marked.patch();
            let mut before = is_ghost(&mesh, corner);
            loop {
                corner = turn(&mesh, corner);
                let ghost = is_ghost(&mesh, corner);
                if before && !ghost {
                    break;
                }
                before = ghost;
            }
        }
        let start = corner;
        loop {
            let wedge = self.wedge(corner);
            push(&mut self.star.wedges, wedge)?;
            let mesh = self.marked.patch();
            corner = turn(&mesh, corner);
            if corner == start || is_ghost(&mesh, corner) {
                return Ok(());
            }
        }
    }

    /// Divides points among the triangles of the new vertex, which was `inserted`.
    fn spread(&mut self, inserted: u32, pace: &mut Pace) -> Result<()> {
        let more = self.marked.triangles() as usize - self.cells.len();
        make_room(&mut self.cells, more)?;
        self.cells.resize(self.cells.len() + more, EMPTY);
        for wedge in &self.star.wedges {
            let cell = std::mem::replace(&mut self.cells[wedge.triangle as usize], EMPTY);
            self.live -= usize::from(cell.error > self.task.max_error);
        }
        let mut star = std::mem::take(&mut self.star);
        self.points.spread(inserted, &mut star, pace)?;
        for wedge in &star.wedges {
            self.settle(wedge)?;
        }
        self.star = star;
        Ok(())
    }

    /// The triangle of a corner, seen from there.
    fn wedge(&mut self, corner: Code) -> Wedge {
        Wedge::of(corner, &mut self.marked, &self.heights, self.star.exact)
    }

    /// Stores the worst point of a triangle.
    fn settle(&mut self, wedge: &Wedge) -> Result<()> {
        let &Wedge {
            triangle, worst, ..
        } = wedge;
        if worst == NONE {
            return Ok(());
        }
        let error = wedge.plane.distance(wedge.offset);
        self.cells[triangle as usize] = Cell { error, worst };
        if error > self.task.max_error {
            self.live += 1;
            let entry = Worst {
                error,
                point: worst,
                triangle,
            };
            self.heap.add(entry, &self.points)?;
        }
        Ok(())
    }
}

/// Whether an entry is still that of its triangle.
fn is_live(cells: &[Cell], entry: &Worst) -> bool {
    let cell = &cells[entry.triangle as usize];
    cell.worst == entry.point && cell.error == entry.error
}

/// Whether a corner is in a triangle outside the hull.
fn is_ghost(mesh: &Patch, corner: Code) -> bool {
    let inf = mesh.infinite();
    mesh.vertex(next(corner)) == inf || mesh.vertex(prev(corner)) == inf
}
