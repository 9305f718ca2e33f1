//! Laplace weights in space: the area of the face that the cell of the query would have in common with
//! that of a neighbour, over their distance (N. H. Christ, R. Friedberg and T. D. Lee, "Weights of links and
//! plaquettes in a random lattice", 1982; V. V. Belikov et al., 1997).
//!
//! The corners of those faces are the centres of the spheres through the query and each face of the rim of
//! its cavity. A rim edge from v to w lies between two of these faces, and the segment between their
//! centres is an edge of the cell's faces towards v and towards w. So each rim edge adds to both
//! a triangle with the middle of the way to the neighbour, counted with its sign. The areas, each in the
//! direction of its neighbour, sum to zero around the cell: the query is the mean of its neighbours.
//!
//! # On the hull
//!
//! Let the query come near a face of the hull, to a height z above its plane. Outside, at depth t / z, its
//! cell is cut by x . v <= |v|^2 / 2 - t, for each neighbour v of that plane as seen from the query: the
//! cell in the plane, whose walls move inwards as t grows. The wall towards v has, in all depths together, an
//! area that goes to infinity as the integral of its length over t. A place x beyond the wall, in what was
//! the cell of v, is met at t = |v|^2 / 2 - x . v, which is |v| times its distance from the wall: so that
//! integral, over |v|, is the area that the query takes from v in the plane. Hence the limit on the
//! hull are Sibson's weights in the plane (see `interpolate::weights` for their formula), and on an
//! edge between two planes the interpolant is linear.

use delone_predicates::arithmetic::Pair;
use delone_predicates::{Point3, Sign, orient3d};

use super::cavity::{Cavity, Face};
use crate::error::Result;
use crate::interpolate::{Part, Rows};
use crate::locate::Output;
use crate::locate3::{Batch, Located, Place, Side, Tetrahedra, barycentric};

/// Magnitude of the products over volume above which plain floating point does not do: it leaves
/// about 1e-14.
const THIN: f64 = 32.0;

/// What a thread computes with.
#[derive(Debug, Default)]
struct Room {
    cavity: Cavity,
    /// The neighbours as seen from the query, in the unit.
    seen: Vec<Point3>,
    /// The centre of each face of the rim, likewise.
    centers: Vec<Point3>,
    /// Rim edges: both ends, the smaller first; the face; whether it has the edge that way round.
    edges: Vec<(u32, u32, u32, bool)>,
    weights: Vec<f64>,
}

/// The weights of each query, as sparse rows, empty outside; and the tetrahedron that holds it, or -1.
pub fn natural(batch: &Batch) -> Result<(Rows, Vec<i32>)> {
    let given = &batch.locator.given;
    let simplices = Output::filled(batch.queries.len(), -1)?;
    let state = || (Room::default(), Part::with_slopes(false));
    let parts = batch.each(state, |(room, part), row, q, at| {
        let Located::Inside(place) = at else {
            return Ok(());
        };
        simplices.set(row, place.simplex as i32);
        let simplex = place.simplex;
        let vertex = |corner| given.vertex(Side { simplex, corner });
        if let Some(corner) = place.site() {
            part.entry(vertex(corner), 1.0, [0.0; 2]);
        } else if room.compute(given, &place, q)? {
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
    let parts: Vec<Part> = parts.into_iter().map(|(_, part)| part).collect();
    let rows = Rows::of_parts(batch.queries.len(), &parts, false, batch.workers)?;
    Ok((rows, simplices.into_vec()))
}

impl Room {
    /// Computes the weights of `q`, which is at no vertex; false where they are those of its
    /// tetrahedron.
    fn compute(&mut self, given: &Tetrahedra, place: &Place, q: Point3) -> Result<bool> {
        let on = place.on.contains(&true);
        self.cavity.find(given, place.simplex, on, q)?;
        self.weights.clear();
        self.weights.resize(self.cavity.vertices.keys().len(), 0.0);
        self.look(given, q);
        let there = if self.cavity.rim.iter().any(|face| face.flat) {
            self.in_plane(given)
        } else {
            self.in_space(given, q)
        };
        Ok(there && self.normalise())
    }

    /// Neighbours as seen from `q`, in a unit in which the farthest coordinate is 1 to 2.
    fn look(&mut self, given: &Tetrahedra, q: Point3) {
        let seen = |&v: &i32| {
            let p = given.point(v);
            [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
        };
        self.seen.clear();
        self.seen
            .extend(self.cavity.vertices.keys().iter().map(seen));
        let far = |most: f64, x: &f64| most.max(x.abs());
        let most = self.seen.as_flattened().iter().fold(0.0, far);
        // A power of two, so that nothing is rounded; none where that is no double.
        let unit = f64::from_bits(most.to_bits() & !((1 << 52) - 1));
        if unit.is_normal() && (1.0 / unit).is_normal() {
            for x in self.seen.as_flattened_mut() {
                *x /= unit;
            }
        }
    }

    fn in_space(&mut self, given: &Tetrahedra, q: Point3) -> bool {
        self.centers.clear();
        for face in &self.cavity.rim {
            let corners = face.corners.map(|i| self.seen[i as usize]);
            let center = plain(corners).or_else(|| {
                let keys = self.cavity.vertices.keys();
                let points = face.corners.map(|i| given.point(keys[i as usize]));
                let size = corners[0].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                let most = (0..3).fold(0.0, |m: f64, k| m.max((points[0][k] - q[k]).abs()));
                paired(points, q, size / most)
            });
            let Some(center) = center else { return false };
            self.centers.push(center);
        }
        self.pair_edges(|_| true);
        for pair in self.edges.chunks_exact(2) {
            let &[(v, w, one, forward), (.., other, _)] = pair else {
                continue;
            };
            // Seen from outside, the face that has v -> w lies left of it.
            let (left, right) = if forward { (one, other) } else { (other, one) };
            let (l, r) = (self.centers[left as usize], self.centers[right as usize]);
            self.weights[v as usize] += share(r, l, self.seen[v as usize]);
            self.weights[w as usize] += share(l, r, self.seen[w as usize]);
        }
        true
    }

    /// Lists the edges of some faces, those of two faces side by side.
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

    /// The weights on a plane of the hull; false on an edge between two.
    fn in_plane(&mut self, given: &Tetrahedra) -> bool {
        let keys = self.cavity.vertices.keys();
        let at = |i: u32| given.point(keys[i as usize]);
        let mut flat = self.cavity.rim.iter().filter(|face| face.flat);
        let Some(first) = flat.next() else {
            return false;
        };
        let [a, b, c] = first.corners.map(at);
        let in_its_plane =
            |face: &Face| (face.corners.iter()).all(|&i| orient3d(a, b, c, at(i)) == Sign::Zero);
        if !flat.all(in_its_plane) {
            return false;
        }
        for face in self.cavity.rim.iter().filter(|face| face.flat) {
            let corners = face.corners.map(|i| self.seen[i as usize]);
            for (&i, area) in face.corners.iter().zip(parts(corners)) {
                self.weights[i as usize] += area;
            }
        }
        self.pair_edges(|face| face.flat);
        for i in 0..self.edges.len() {
            let (u, v, ..) = self.edges[i];
            let same = |j: usize| {
                let edge = self.edges.get(j);
                edge.is_some_and(|e| (e.0, e.1) == (u, v))
            };
            // An edge of two triangles lies inside of the cavity.
            if same(i + 1) || (i > 0 && same(i - 1)) {
                continue;
            }
            let (p, r) = (self.seen[u as usize], self.seen[v as usize]);
            let [_, at_u, at_v] = parts([[0.0; 3], p, r]);
            self.weights[u as usize] -= at_u;
            self.weights[v as usize] -= at_v;
        }
        true
    }

    /// Makes the sum 1; false where arithmetic gives none.
    fn normalise(&mut self) -> bool {
        // Below zero is rounding alone.
        self.weights.iter_mut().for_each(|w| *w = w.max(0.0));
        let sum: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|w| *w /= sum);
        sum > 0.0 && sum.is_finite()
    }
}

/// Twice the area that the segment from one centre to another adds to the face towards the neighbour
/// `v`, over its distance.
fn share(from: Point3, to: Point3, v: Point3) -> f64 {
    let middle = v.map(|x| x / 2.0);
    dot(cross(minus(from, middle), minus(to, middle)), v) / dot(v, v)
}

fn dot(p: Point3, q: Point3) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

fn minus(p: Point3, q: Point3) -> Point3 {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

fn cross(p: Point3, q: Point3) -> Point3 {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}

/// The area of a triangle that lies nearest to each corner, counted with its sign, times 8.
fn parts(corners: [Point3; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let sides = [minus(c, b), minus(a, c), minus(b, a)];
    let turn = cross(sides[0], sides[1]);
    let size = dot(turn, turn).sqrt();
    let cotangent = |k: usize| -dot(sides[(k + 1) % 3], sides[(k + 2) % 3]) / size;
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        dot(sides[i], sides[i]) * cotangent(i) + dot(sides[j], sides[j]) * cotangent(j)
    })
}

/// The centre of the sphere through the origin and three points; nothing where the four are too nearly
/// in one plane.
#[inline]
fn plain([a, b, c]: [Point3; 3]) -> Option<Point3> {
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let det = dot(a, bc);
    let size = |k: usize| {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        a[k].abs() * ((b[x] * c[y]).abs() + (b[y] * c[x]).abs())
    };
    if det.is_nan() || det <= 0.0 || det * THIN < size(0) + size(1) + size(2) {
        return None;
    }
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    let center = |k: usize| (aa * bc[k] + bb * ca[k] + cc * ab[k]) / (2.0 * det);
    Some([0, 1, 2].map(center))
}

/// The same of three points as seen from `q`, in pairs of doubles, times `scale`.
#[cold]
#[inline(never)]
fn paired(corners: [Point3; 3], q: Point3, scale: f64) -> Option<Point3> {
    let [a, b, c] = corners.map(|p| [0, 1, 2].map(|k| Pair::difference(p[k], q[k])));
    let cross = |p: [Pair; 3], q: [Pair; 3]| {
        [0, 1, 2].map(|k| {
            let (x, y) = ((k + 1) % 3, (k + 2) % 3);
            p[x] * q[y] - p[y] * q[x]
        })
    };
    let dot = |p: [Pair; 3], q: [Pair; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let det = dot(a, bc).hi;
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    let center = |k: usize| (aa * bc[k] + bb * ca[k] + cc * ab[k]).hi / (2.0 * det) * scale;
    let found = [0, 1, 2].map(center);
    (det > 0.0 && found.iter().all(|x| x.is_finite())).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_triangle_are_all_of_it() {
        let found = parts([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
        assert_eq!(found, [16.0, 8.0, 8.0]);
        let obtuse = parts([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [-1.0, 1.0, 0.0]]);
        assert!((obtuse.iter().sum::<f64>() - 16.0).abs() < 1e-14);
    }

    #[test]
    fn the_center_is_as_far_from_all() {
        let corners = [[2.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 6.0]];
        assert_eq!(plain(corners), Some([1.0, 2.0, 3.0]));
        assert_eq!(paired(corners, [0.0; 3], 1.0), Some([1.0, 2.0, 3.0]));
        let flat = [[1.0, 1.0, 1.0], [1.0, 2.0, 3.0], [2.0, 3.0, 4.0 + 1e-9]];
        assert_eq!(plain(flat), None);
    }
}
