//! 3-D Laplace weights: the area of the face between the cells of the query and a neighbor, over
//! their distance.
//!
//! N. H. Christ, R. Friedberg and T. D. Lee, "Weights of links and plaquettes in a random lattice",
//! 1982; V. V. Belikov et al., 1997.
//!
//! The corners of those faces are the centers of the spheres through the query and each face of the
//! rim of its cavity. A rim edge from v to w lies between two of these faces, and the segment
//! between their centers is an edge of the cell's faces toward v and toward w. So each rim edge
//! adds to both a triangle with the midpoint of the segment to the neighbor, counted with its sign.
//! The areas, each in the direction of its neighbor, sum to zero around the cell: the query is the
//! weighted mean of its neighbors.
//!
//! # On the hull
//!
//! Let the query approach a face of the hull, at a height z above its plane. Outside, at depth t /
//! z, its cell is cut by x . v <= |v|^2 / 2 - t, for each neighbor v in that plane relative to the
//! query: the cell in the plane, whose walls move inward as t grows. The total area of the wall
//! toward v, over all depths, diverges like the integral of its length over t. A location x beyond
//! the wall, in what was the cell of v, is reached at t = |v|^2 / 2 - x . v, which is |v| times its
//! distance from the wall: so that integral, over |v|, is the area that the query takes from v in
//! the plane. Hence the limits on the hull are Sibson's weights in the plane (see
//! `interpolate::weights` for their formula), and on an edge between two planes the interpolant is
//! linear.
//!
//! # Loss by rounding
//!
//! Near a plane of the hull, centers are far away. A single one does not matter: areas are equally
//! large. For two adjacent ones, the cross product grows with the product of their distances, and
//! cancels. So the size of the terms is summed along with each sum, and if that is too large, by
//! distances and then by coordinates, integers give the weights (see `exact`).

use delone_predicates::{Point3, Sign, orient3d};

use super::cavity::{Cavity, Face};
use super::center::{Center, cross, dot, minus, plus, sizes, terms};
use super::exact;
use crate::base::arrays::{Side, Tetrahedra};
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::interpolate::{Part, Rows};
use crate::locate::Output;
use crate::locate::space::{Batch, Located, Place, barycentric};

/// Ratio of the size of all terms to their sum above which too many digits are lost: about 1e-13 is
/// left. It is 10 to 200 among scattered points.
const LOST: f64 = 4096.0;
/// The square of an area below which it may have lost digits to underflow.
const LEAST: f64 = 1e-250;

/// Tetrahedra and faces of cavities between two checks for interruption, besides those before each
/// lot of queries: a query may have very many neighbors.
const WATCH_EVERY: usize = 1 << 14;

/// Buffers of a thread.
#[derive(Debug, Default)]
struct Room {
    cavity: Cavity,
    /// The neighbors.
    sites: Vec<Point3>,
    /// The neighbors relative to the query, in the unit.
    seen: Vec<Point3>,
    /// The unit of length.
    unit: f64,
    /// The center for each face of the rim, likewise.
    centers: Vec<Center>,
    /// Rim edges: both ends, the smaller first; the face; whether the face has the edge in that
    /// direction.
    edges: Vec<(u32, u32, u32, bool)>,
    /// The faces of the cell of the query.
    walls: Vec<Wall>,
    weights: Vec<f64>,
    /// The sum of the sizes of all terms.
    size: f64,
}

/// The face of the cell toward a neighbor.
#[derive(Debug, Clone, Copy, Default)]
struct Wall {
    /// Twice its area, as a vector.
    area: Point3,
    /// The size of its terms.
    size: f64,
}

/// The weights of each query, as sparse rows, empty outside; and the tetrahedron that contains it,
/// or -1.
pub fn natural(batch: &Batch) -> Result<(Rows, Vec<i32>)> {
    let given = &batch.locator.given;
    let simplices = Output::filled(batch.queries.len(), -1, batch.watch)?;
    let state = || {
        let pace = Pace::new(batch.watch, WATCH_EVERY);
        (Room::default(), Part::with_slopes(false), pace)
    };
    let parts = batch.each(state, |(room, part, pace), row, q, at| {
        let Located::Inside(place) = at else {
            return Ok(());
        };
        simplices.set(row, place.simplex as i32);
        let simplex = place.simplex;
        let vertex = |corner| given.vertex(Side { simplex, corner });
        if let Some(corner) = place.site() {
            part.entry(vertex(corner), 1.0, [0.0; 2]);
        } else if room.compute(given, &place, q, pace)? {
            for (&v, &weight) in room.cavity.vertices.keys().iter().zip(&room.weights) {
                part.entry(v, weight, [0.0; 2]);
            }
        } else {
            for (corner, weight) in barycentric(given, &place, q).into_iter().enumerate() {
                part.entry(vertex(corner), weight, [0.0; 2]);
            }
        }
        part.close(row);
        Ok(())
    })?;
    let parts: Vec<Part> = parts.into_iter().map(|(_, part, _)| part).collect();
    let rows = Rows::of_parts(
        batch.queries.len(),
        &parts,
        false,
        batch.workers,
        batch.watch,
    )?;
    Ok((rows, simplices.into_vec()))
}

impl Room {
    /// Computes the weights of `q`, which is not at a vertex; false if the caller must use those of
    /// its tetrahedron.
    fn compute(
        &mut self,
        given: &Tetrahedra,
        place: &Place,
        q: Point3,
        pace: &mut Pace,
    ) -> Result<bool> {
        let on = place.on.contains(&true);
        self.cavity.find(given, place.simplex, on, q, pace)?;
        pace.spend(self.cavity.rim.len())?;
        self.set_sites(given, q);
        self.size = 0.0;
        if self.cavity.rim.iter().any(|face| face.flat) {
            if !self.is_in_one_plane() {
                return Ok(false);
            }
            self.on_hull();
            return Ok(self.normalize() || self.exactly_on_hull(q, pace)?);
        }
        if self.inside(q) {
            if self.normalize() {
                return Ok(true);
            }
            self.resize();
            if self.normalize() {
                return Ok(true);
            }
        }
        self.exactly_inside(q, pace)
    }

    /// Neighbors relative to `q`, in a unit in which the farthest coordinate is 1 to 2.
    fn set_sites(&mut self, given: &Tetrahedra, q: Point3) {
        let keys = self.cavity.vertices.keys();
        self.sites.clear();
        self.sites.extend(keys.iter().map(|&v| given.point(v)));
        self.seen.clear();
        self.seen.extend(self.sites.iter().map(|&p| minus(p, q)));
        let far = |most: f64, x: &f64| most.max(x.abs());
        let most = self.seen.as_flattened().iter().fold(0.0, far);
        // A power of two, so that nothing is rounded; `None` if it is not a double.
        let unit = f64::from_bits(most.to_bits() & !((1 << 52) - 1));
        self.unit = 1.0;
        if unit.is_normal() && (1.0 / unit).is_normal() {
            self.unit = unit;
            for x in self.seen.as_flattened_mut() {
                *x /= unit;
            }
        }
    }

    /// The weights inside; false if some center is unknown.
    fn inside(&mut self, q: Point3) -> bool {
        self.weights.clear();
        self.centers.clear();
        for face in &self.cavity.rim {
            let center = Center::plain(face.corners.map(|i| self.seen[i as usize])).or_else(|| {
                let corners = face.corners.map(|i| self.sites[i as usize]);
                Center::paired(corners, q, self.unit)
            });
            let Some(center) = center else { return false };
            self.centers.push(center);
        }
        self.add_walls();
        for (wall, &v) in self.walls.iter().zip(&self.seen) {
            let square = dot(v, v);
            self.weights.push(dot(wall.area, v) / square);
            self.size += wall.size / square.sqrt();
        }
        true
    }

    /// The segment between the centers of two faces adds to the cell's faces toward both ends of
    /// their edge.
    fn add_walls(&mut self) {
        self.pair_edges(|_| true);
        self.walls.clear();
        self.walls.resize(self.seen.len(), Wall::default());
        for pair in self.edges.chunks_exact(2) {
            let &[(v, w, one, forward), (.., other, _)] = pair else {
                continue;
            };
            // Seen from outside, the face with the edge v -> w is on its left.
            let (left, right) = if forward { (one, other) } else { (other, one) };
            let (l, r) = (&self.centers[left as usize], &self.centers[right as usize]);
            let area = cross(r.at, l.at);
            let size = l.radius * r.radius * (l.doubt + r.doubt);
            let wall = &mut self.walls[v as usize];
            wall.area = plus(wall.area, area);
            wall.size += size;
            let wall = &mut self.walls[w as usize];
            wall.area = minus(wall.area, area);
            wall.size += size;
        }
    }

    /// Recomputes the size of all terms by axes, so that sheets and boxes do not look worse than
    /// they are.
    #[cold]
    #[inline(never)]
    fn resize(&mut self) {
        let doubts = |(face, center): (&Face, &Center)| {
            let corners = face.corners.map(|i| self.seen[i as usize]);
            center.doubts(corners)
        };
        let rim = self.cavity.rim.iter();
        let doubts: Vec<Point3> = rim.zip(&self.centers).map(doubts).collect();
        let mut sizes_of = vec![[0.0; 3]; self.seen.len()];
        for pair in self.edges.chunks_exact(2) {
            let [l, r] = [pair[0].2 as usize, pair[1].2 as usize];
            let (at_l, at_r) = (self.centers[l].at, self.centers[r].at);
            let size = plus(terms(at_l, doubts[r]), terms(doubts[l], at_r));
            for end in [pair[0].0, pair[0].1] {
                let sum = &mut sizes_of[end as usize];
                *sum = plus(*sum, size);
            }
        }
        let size = |(size, &v): (&Point3, &Point3)| dot(*size, sizes(v)) / dot(v, v);
        self.size = sizes_of.iter().zip(&self.seen).map(size).sum();
    }

    /// Lists the edges of some faces, with those of adjacent faces next to each other.
    fn pair_edges(&mut self, which: impl Fn(&Face) -> bool) {
        self.edges.clear();
        for (j, face) in (0..).zip(&self.cavity.rim).filter(|(_, face)| which(face)) {
            let [a, b, c] = face.corners;
            for (u, v) in [(a, b), (b, c), (c, a)] {
                self.edges.push((u.min(v), u.max(v), j, u < v));
            }
        }
        self.edges.sort_unstable();
    }

    /// Whether all faces whose plane contains the query are in one plane; if not, it is on an edge.
    fn is_in_one_plane(&self) -> bool {
        let at = |i: u32| self.sites[i as usize];
        let mut flat = self.cavity.rim.iter().filter(|face| face.flat);
        let Some(first) = flat.next() else {
            return false;
        };
        let [a, b, c] = first.corners.map(at);
        flat.all(|face| (face.corners.iter()).all(|&i| orient3d(a, b, c, at(i)) == Sign::Zero))
    }

    /// The weights on a plane of the hull.
    fn on_hull(&mut self) {
        self.weights.clear();
        self.weights.resize(self.seen.len(), 0.0);
        let way = |i: u32, j: u32| {
            let way = minus(self.sites[j as usize], self.sites[i as usize]);
            way.map(|x| x / self.unit)
        };
        for face in self.cavity.rim.iter().filter(|face| face.flat) {
            let [a, b, c] = face.corners;
            let (areas, size) = parts([way(b, c), way(c, a), way(a, b)]);
            for (&i, area) in face.corners.iter().zip(areas) {
                self.weights[i as usize] += area;
            }
            self.size += size;
        }
        self.pair_edges(|face| face.flat);
        for [u, v] in outer(&self.edges) {
            let (p, r) = (self.seen[u as usize], self.seen[v as usize]);
            let way = minus(self.sites[v as usize], self.sites[u as usize]);
            let sides = [way.map(|x| x / self.unit), r.map(|x| -x), p];
            let ([_, at_u, at_v], size) = parts(sides);
            self.weights[u as usize] -= at_u;
            self.weights[v as usize] -= at_v;
            self.size += size;
        }
    }

    #[cold]
    #[inline(never)]
    fn exactly_inside(&mut self, q: Point3, pace: &mut Pace) -> Result<bool> {
        let found = exact::inside(&self.sites, &self.cavity.rim, q, pace)?;
        Ok(self.take(found))
    }

    #[cold]
    #[inline(never)]
    fn exactly_on_hull(&mut self, q: Point3, pace: &mut Pace) -> Result<bool> {
        let flat = self.cavity.rim.iter().filter(|face| face.flat);
        let faces: Vec<[u32; 3]> = flat.map(|face| face.corners).collect();
        let edges: Vec<[u32; 2]> = outer(&self.edges).collect();
        let found = exact::on_hull(&self.sites, &faces, &edges, q, pace)?;
        Ok(self.take(found))
    }

    fn take(&mut self, found: Option<Vec<f64>>) -> bool {
        let known = found.is_some();
        self.weights = found.unwrap_or_default();
        known
    }

    /// Normalizes the sum to 1; false if it is uncertain.
    fn normalize(&mut self) -> bool {
        // Negative weights are rounding; NaN stays NaN.
        for w in &mut self.weights {
            if *w < 0.0 {
                *w = 0.0;
            }
        }
        let sum: f64 = self.weights.iter().sum();
        if !(sum * LOST >= self.size && sum > 0.0 && sum.is_finite()) {
            return false;
        }
        self.weights.iter_mut().for_each(|w| *w /= sum);
        true
    }
}

/// The edges that belong to only one face, which is on their left.
fn outer(edges: &[(u32, u32, u32, bool)]) -> impl Iterator<Item = [u32; 2]> {
    let same = |i: usize, j: usize| {
        let ends = |e: &(u32, u32, u32, bool)| (e.0, e.1);
        edges.get(j).map(ends) == edges.get(i).map(ends)
    };
    let alone = move |i: &usize| !(same(*i, i + 1) || (*i > 0 && same(*i, i - 1)));
    (0..edges.len()).filter(alone).map(|i| {
        let (u, v, _, forward) = edges[i];
        if forward { [u, v] } else { [v, u] }
    })
}

/// The area of a triangle with these sides that is nearest to the corner opposite each, counted
/// with its sign, times 8; and the size of the terms, NaN if they are uncertain.
fn parts(sides: [Point3; 3]) -> ([f64; 3], f64) {
    let squares = sides.map(|side| dot(side, side));
    let longest = (1..3).fold(0, |i, k| if squares[k] > squares[i] { k } else { i });
    let (i, j) = ((longest + 1) % 3, (longest + 2) % 3);
    let turn = cross(sides[i], sides[j]);
    let area = dot(turn, turn);
    if area.is_nan() || area < LEAST {
        return ([0.0; 3], f64::NAN);
    }
    let one = 1.0 / area.sqrt();
    // Relative to the sine of the largest angle.
    let doubt = (squares[i] * squares[j]).sqrt() * one;
    let terms = [0, 1, 2].map(|k| {
        let cotangent = -dot(sides[(k + 1) % 3], sides[(k + 2) % 3]) * one;
        squares[k] * cotangent
    });
    let [a, b, c] = terms;
    let size = a.abs() + b.abs() + c.abs() + squares.iter().sum::<f64>();
    ([b + c, a + c, a + b], 2.0 * size * doubt)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(a: Point3, b: Point3, c: Point3) -> [f64; 3] {
        parts([minus(c, b), minus(a, c), minus(b, a)]).0
    }

    #[test]
    fn the_parts_of_a_triangle_are_all_of_it() {
        let found = of([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 2.0]);
        assert_eq!(found, [16.0, 8.0, 8.0]);
        let obtuse = of([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [-1.0, 1.0, 0.0]);
        assert!((obtuse.iter().sum::<f64>() - 16.0).abs() < 1e-14);
    }
}
