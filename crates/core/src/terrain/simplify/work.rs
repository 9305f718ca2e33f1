//! The greedy insertion: points in lists by triangle, and a heap of the worst ones.

use delone_predicates::{Point2, Sign, lexicographic, orient2d};

use super::heap::{Heap, Worst};
use super::plane::{NONE, Place, Plane, below, is_exact};
use super::task::{Simplified, Task};
use crate::base::arrays::Triangles;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::constrained::marked::{Marked, turn};
use crate::mesh::plane::{Code, Patch, half_edge, half_edges, import, next, prev, triangle};
use crate::order;

/// Points between two checks for interruption.
const LOT: usize = 1 << 16;

/// The points of a triangle.
#[derive(Debug, Clone, Copy)]
struct Cell {
    /// The error of the worst one, and its number.
    error: f64,
    worst: u32,
    /// The first one of the list.
    first: u32,
}

const EMPTY: Cell = Cell {
    error: 0.0,
    worst: NONE,
    first: NONE,
};

/// A triangle that collects its points.
#[derive(Debug)]
struct Wedge {
    triangle: u32,
    /// The corner after the new vertex, and the way there.
    start: Point2,
    ray: Point2,
    plane: Plane,
    /// The greatest offset so far, below 0 before the first point; and the point that has it.
    offset: f64,
    worst: u32,
    first: u32,
}

/// A surface that gets points.
#[derive(Debug)]
pub struct Work<'a> {
    task: Task<'a>,
    marked: Marked,
    /// The heights of the vertices.
    heights: Vec<f64>,
    /// The points along a curve, so that those of a triangle are close in memory.
    places: Vec<Place>,
    exact: bool,
    /// For each triangle.
    cells: Vec<Cell>,
    heap: Heap,
    /// How many triangles have a point that is not good enough.
    live: usize,
    /// The star of the last vertex, counterclockwise, and whether it goes all around.
    star: Vec<Wedge>,
    closed: bool,
    /// The result.
    pub found: Simplified,
}

impl<'a> Work<'a> {
    /// The coarse surface, with all points in its triangles.
    pub fn start(task: Task<'a>, watch: &Watch) -> Result<Self> {
        let Triangles {
            points: corners,
            simplices,
            neighbors,
        } = task.coarse;
        let mut vertices = with_room(corners.len() + 1)?;
        vertices.extend_from_slice(corners);
        vertices.push([f64::NAN; 2]);
        let (mesh, _) = import::mesh(simplices, Some(neighbors), corners.len(), watch)?;
        let mut marked = Marked::new(mesh, vertices, watch)?;
        for &[u, v] in task.segments {
            let e = marked.edge(u, v)?;
            marked.patch().mark(e, true);
        }
        let mut heights = with_room(corners.len())?;
        heights.extend_from_slice(task.heights);
        let raised = |p: &Point2, z: &f64| [p[0], p[1], *z];
        let mut places = with_room(task.points.len())?;
        for row in order::order_of(task.points, task.workers, watch)?.concat() {
            places.push(Place {
                raised: raised(&task.points[row as usize], &task.z[row as usize]),
                next: NONE,
                row,
            });
        }
        let fixed = corners.iter().zip(task.heights).map(|(p, z)| raised(p, z));
        let exact = is_exact(fixed.chain(places.iter().map(|place| place.raised)));
        let mut work = Self {
            task,
            marked,
            heights,
            places,
            exact,
            cells: filled(simplices.len(), EMPTY)?,
            heap: Heap::default(),
            live: 0,
            star: Vec::new(),
            closed: true,
            found: Simplified::default(),
        };
        work.fill(watch)?;
        Ok(work)
    }

    /// Puts all points into the coarse triangles.
    fn fill(&mut self, watch: &Watch) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        for i in (0..self.places.len()).rev() {
            pace.spend(1)?;
            let Place { raised, row, .. } = self.places[i];
            let home = u32::try_from(self.task.homes[row as usize]).map_err(|_| outside())?;
            let t = self.side_of_edge(home, below(raised)) as usize;
            self.places[i].next = self.cells[t].first;
            self.cells[t].first = i as u32;
        }
        for t in 0..self.cells.len() as u32 {
            pace.spend(1)?;
            let mut wedge = self.wedge(half_edge(t, 0));
            let mut i = self.cells[t as usize].first;
            while i != NONE {
                pace.spend(1)?;
                wedge.judge(i, &self.places);
                i = self.places[i as usize].next;
            }
            wedge.first = self.cells[t as usize].first;
            self.settle(&wedge)?;
        }
        Ok(())
    }

    /// For a point on an edge between two triangles, the one on the left of the edge from its smaller
    /// end on; else the triangle in which it lies.
    fn side_of_edge(&mut self, t: u32, p: Point2) -> u32 {
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        for e in half_edges(t) {
            let [u, v] = [next(e), prev(e)].map(|c| self.marked.points[mesh.vertex(c) as usize]);
            let o = mesh.opposite(e);
            let open = mesh.vertex(o) != mesh.infinite() && !mesh.is_marked(e);
            if open && lexicographic(v, u).is_lt() && orient2d(u, v, p).is_zero() {
                return triangle(o);
            }
        }
        t
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
            let Place { raised, row, .. } = self.places[point as usize];
            let on = self.edge_at(triangle, below(raised));
            self.closed = !on.is_some_and(|e| self.is_hull(e));
            let more = if self.closed { 2 } else { 1 };
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
                .tidy(self.live, |worst| is_live(cells, worst), &self.places);
        }
    }

    /// The worst of all points that are not good enough.
    fn top(&mut self) -> Option<Worst> {
        while let Some(top) = self.heap.first() {
            if is_live(&self.cells, &top) {
                return Some(top);
            }
            self.heap.remove_first(&self.places);
        }
        None
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
        self.star.clear();
        let mut corner = first;
        if !self.closed {
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
            push(&mut self.star, wedge)?;
            let mesh = self.marked.patch();
            corner = turn(&mesh, corner);
            if corner == start || is_ghost(&mesh, corner) {
                return Ok(());
            }
        }
    }

    /// Moves points to the triangles of the new vertex, which was `inserted`.
    fn spread(&mut self, inserted: u32, pace: &mut Pace) -> Result<()> {
        let more = self.marked.triangles() as usize - self.cells.len();
        make_room(&mut self.cells, more)?;
        self.cells.resize(self.cells.len() + more, EMPTY);
        let center = below(self.places[inserted as usize].raised);
        let mut at = 0;
        for k in 0..self.star.len() {
            let t = self.star[k].triangle as usize;
            let cell = std::mem::replace(&mut self.cells[t], EMPTY);
            self.live -= usize::from(cell.error > self.task.max_error);
            let mut i = cell.first;
            while i != NONE {
                pace.spend(1)?;
                let Place { raised, next, .. } = self.places[i as usize];
                if i != inserted {
                    at = self.wedge_of(at, center, below(raised));
                    let wedge = &mut self.star[at];
                    wedge.judge(i, &self.places);
                    self.places[i as usize].next = std::mem::replace(&mut wedge.first, i);
                }
                i = next;
            }
        }
        let star = std::mem::take(&mut self.star);
        for wedge in &star {
            self.settle(wedge)?;
        }
        self.star = star;
        Ok(())
    }

    /// The triangle of a corner, seen from there, without points.
    fn wedge(&mut self, corner: Code) -> Wedge {
        let triangles = self.marked.triangles();
        let mesh = self.marked.mesh.resume(triangles);
        let corners = [corner, next(corner), prev(corner)].map(|c| {
            let v = mesh.vertex(c) as usize;
            let [x, y] = self.marked.points[v];
            [x, y, self.heights.get(v).copied().unwrap_or(f64::NAN)]
        });
        let [center, start, _] = corners.map(below);
        Wedge {
            triangle: triangle(corner),
            start,
            ray: [start[0] - center[0], start[1] - center[1]],
            plane: Plane::of(corners, self.exact),
            offset: -1.0,
            worst: NONE,
            first: NONE,
        }
    }

    /// Whether a point is on the ray at which a wedge starts, or to its left.
    #[inline]
    fn is_left(&self, k: usize, center: Point2, p: Point2) -> bool {
        let wedge = &self.star[k];
        if self.exact {
            let [dx, dy] = [p[0] - center[0], p[1] - center[1]];
            return wedge.ray[0] * dy - wedge.ray[1] * dx >= 0.0;
        }
        orient2d(center, wedge.start, p) != Sign::Negative
    }

    /// The wedge in which a point lies, by a search from `k` on: a point on a ray is in the wedge to its
    /// left. Wedges are less than half a turn, so a point to the left of a ray is met counterclockwise
    /// before one to its right would be; each step turns by a wedge, at most once around.
    #[inline]
    fn wedge_of(&self, mut k: usize, center: Point2, p: Point2) -> usize {
        let last = self.star.len() - 1;
        if self.is_left(k, center, p) {
            for _ in 0..last {
                let after = if k == last { 0 } else { k + 1 };
                if (after == 0 && !self.closed) || !self.is_left(after, center, p) {
                    break;
                }
                k = after;
            }
            return k;
        }
        for _ in 0..last {
            if k == 0 && !self.closed {
                break;
            }
            k = if k == 0 { last } else { k - 1 };
            if self.is_left(k, center, p) {
                break;
            }
        }
        k
    }

    /// Stores the points of a triangle and its worst one.
    fn settle(&mut self, wedge: &Wedge) -> Result<()> {
        let &Wedge {
            triangle,
            worst,
            first,
            ..
        } = wedge;
        if worst == NONE {
            return Ok(());
        }
        let error = wedge.plane.distance(wedge.offset);
        self.cells[triangle as usize] = Cell {
            error,
            worst,
            first,
        };
        if error > self.task.max_error {
            self.live += 1;
            let entry = Worst {
                error,
                point: worst,
                triangle,
            };
            self.heap.add(entry, &self.places)?;
        }
        Ok(())
    }
}

impl Wedge {
    /// Compares a point with the worst one so far; of equal ones the smaller counts.
    #[inline]
    fn judge(&mut self, i: u32, places: &[Place]) {
        let point = places[i as usize].raised;
        let mut offset = self.plane.offset(point);
        if offset < self.offset {
            return;
        }
        if offset.is_nan() {
            offset = f64::INFINITY;
        }
        let first =
            |other: u32| lexicographic(below(point), below(places[other as usize].raised)).is_lt();
        if offset > self.offset || (offset == self.offset && first(self.worst)) {
            (self.offset, self.worst) = (offset, i);
        }
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

/// A point has no triangle.
fn outside() -> Error {
    Error::Internal("a point is outside of the coarse surface".into())
}
