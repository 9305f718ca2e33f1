//! Lawson's flips: turn any triangulation of a point set into the canonical Delaunay triangulation.
//!
//! C. L. Lawson, "Software for C1 surface interpolation", in Mathematical Software III (1977).
//!
//! An edge uv between the triangles u v p and v u q is flipped if q lies in the circumcircle of u v
//! p, with ties as in the whole mesh (see `delone_predicates`). Then the quadrilateral is strictly
//! convex: the part of the closed circle beyond uv, except u and v, lies strictly within the angle
//! at p.
//!
//! # Why it terminates, and with what
//!
//! Lift each point to its perturbed height and each triangle with it: a surface over the hull. On
//! the convex quadrilateral of a flip the surfaces before and after are the upper and the lower
//! half of a tetrahedron, so the surface becomes lower inside the quadrilateral and rises nowhere.
//! Before the flip it contained the lifted edge uv; afterward it is strictly below it at the
//! crossing with pq, and stays below: an edge that was flipped away never returns. So there are at
//! most n (n - 1) / 2 flips, one for each pair of points. If no edge needs a flip, the surface is
//! convex at each edge, hence convex: it is the lower hull, which is the canonical triangulation and
//! no other.

use delone_predicates::{Point2, Sign, incircle_canonical, orient2d};

use super::validate::{Findings, validate};
use crate::base::arrays::{Arrays, Triangles};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::points;
use crate::base::watch::Watch;
use crate::mesh::plane::{Code, Patch, export, half_edges, import, next, prev, triangle};
use crate::order::arrange;

/// Triangles between two checks for interruption in cheap loops.
const LOT: usize = 1 << 16;

/// Edges between two checks for interruption.
const WATCH_EVERY: usize = 1 << 14;

/// The result of the flips.
#[derive(Debug)]
pub struct Flipped {
    /// Triangles, each in the place of one of the given triangles.
    pub arrays: Arrays<3>,
    /// How many edges were flipped.
    pub flips: usize,
    /// `[u, v, p, q]` for each flip, if recorded: the edge u v, with p on its left and q on its
    /// right, became p q.
    pub sequence: Vec<[i32; 4]>,
}

/// Flips edges of `simplices`, which must tile the hull of `points` and have each distinct point as
/// a vertex, until the canonical Delaunay triangulation is reached. Vertices must be rows of
/// `points`. If the triangles do not tile the hull, [`Error::Shape`] names one that is wrong.
pub fn lawson(
    points: &[Point2],
    simplices: &[[i32; 3]],
    record: bool,
    watch: &Watch,
) -> Result<Flipped> {
    points::scan(points)?;
    let at = |v: i32| points[v as usize];
    let right = |&[a, b, c]: &[i32; 3]| orient2d(at(a), at(b), at(c)) != Sign::Positive;
    if let Some(t) = simplices.iter().position(right) {
        let s = simplices[t];
        return Err(Error::Shape(format!(
            "simplices[{t}] = {s:?} is not counter-clockwise"
        )));
    }
    let neighbors = import::adjacency(simplices, points.len(), watch)?;
    let given = Triangles {
        points,
        simplices,
        neighbors: &neighbors,
    };
    if simplices.is_empty() {
        return Err(no_simplices(points, watch));
    }
    if let Some(fault) = fault(&validate(given, watch)?) {
        return Err(Error::Shape(fault));
    }
    drop(neighbors);
    let (rows, own) = compact(points, simplices, watch)?;
    let mut at = with_room(rows.len())?;
    at.extend(rows.iter().map(|&row| points[row as usize]));
    let (mut mesh, ghost) = import::mesh(&own, None, rows.len(), watch)?;
    let mut flips = Flips::over(&at, mesh.patch(), own.len(), record, watch)?;
    flips.run(watch)?;
    let (flips, mut sequence) = (flips.count, flips.sequence);
    for flip in &mut sequence {
        *flip = flip.map(|v| rows[v as usize] as i32);
    }
    let arrays = export::arrays(mesh, ghost, &rows, 1, watch)?;
    Ok(Flipped {
        arrays,
        flips,
        sequence,
    })
}

/// Why an empty list of triangles is wrong: either there can be none, or points are left over.
fn no_simplices(points: &[Point2], watch: &Watch) -> Error {
    let arranged = match arrange(points, 1, watch) {
        Ok(arranged) => arranged,
        Err(error) => return error,
    };
    let in_line = |w: &[Point2]| orient2d(arranged.points[0], w[0], w[1]).is_zero();
    if arranged.points.len() < 3 || arranged.points[1..].windows(2).all(in_line) {
        return points::degenerate(&arranged.points, &arranged.rows);
    }
    Error::Shape("no simplices are given, but the points are not collinear".into())
}

/// The first reason why the triangles do not tile the hull, as a message.
fn fault(found: &Findings) -> Option<String> {
    if let Some(&v) = found.missing.first() {
        return Some(format!("point {v} is a vertex of no simplex"));
    }
    if let Some(&[u, v]) = found.hull.first() {
        return Some(format!(
            "the simplices do not tile the convex hull: their boundary is not a convex cycle at the \
             edge {u} -> {v}"
        ));
    }
    if let Some(&[expected, have]) = found.count.first() {
        return Some(format!(
            "the simplices do not tile the convex hull: there are {have}, and {expected} would"
        ));
    }
    // Orientations are checked; `adjacency` repeats no edge and links correctly.
    let broken = found.orientation.len() + found.facets.len() + found.neighbors.len();
    (broken > 0).then(|| "the simplices do not meet edge to edge".into())
}

/// The rows that are vertices, ascending, and the triangles as indices into them.
pub(crate) fn compact(
    points: &[Point2],
    simplices: &[[i32; 3]],
    watch: &Watch,
) -> Result<(Vec<u32>, Vec<[i32; 3]>)> {
    let mut place = filled(points.len(), -1i32)?;
    for lot in simplices.chunks(LOT) {
        watch.check()?;
        for &v in lot.as_flattened() {
            place[v as usize] = 0;
        }
    }
    let mut rows = with_room(points.len())?;
    for (row, place) in (0u32..).zip(&mut place).filter(|(_, place)| **place == 0) {
        *place = rows.len() as i32;
        rows.push(row);
    }
    let mut own = with_room(simplices.len())?;
    for lot in simplices.chunks(LOT) {
        watch.check()?;
        own.extend(lot.iter().map(|s| s.map(|v| place[v as usize])));
    }
    Ok((rows, own))
}

/// The flips of a mesh.
struct Flips<'a> {
    points: &'a [Point2],
    mesh: Patch<'a>,
    /// Edges to test, by one of their codes: every edge that must be flipped is among them.
    stack: Vec<Code>,
    /// Whether a code is on the stack, so that it is there only once.
    waiting: Vec<bool>,
    count: usize,
    record: bool,
    sequence: Vec<[i32; 4]>,
}

impl<'a> Flips<'a> {
    /// Puts all edges of the first `triangles` records on the stack.
    fn over(
        points: &'a [Point2],
        mesh: Patch<'a>,
        triangles: usize,
        record: bool,
        watch: &Watch,
    ) -> Result<Self> {
        let mut flips = Self {
            points,
            mesh,
            stack: with_room(3 * triangles)?,
            waiting: filled(8 * triangles, false)?,
            count: 0,
            record,
            sequence: Vec::new(),
        };
        for t in (0..triangles as u32).rev() {
            if t.is_multiple_of(LOT as u32) {
                watch.check()?;
            }
            for e in half_edges(t) {
                if triangle(flips.mesh.opposite(e)) > t {
                    flips.push(e);
                }
            }
        }
        Ok(flips)
    }

    fn push(&mut self, e: Code) {
        // No code here belongs to a ghost: flips have triangles on both sides.
        if !std::mem::replace(&mut self.waiting[e as usize], true) {
            self.stack.push(e);
        }
    }

    /// Each step pops an edge from the stack, and only a flip, of which there are at most n (n - 1)
    /// / 2, pushes four.
    fn run(&mut self, watch: &Watch) -> Result<()> {
        let n = self.points.len() as u128;
        let budget = n * (n - 1) / 2;
        let mut until_watch = 1;
        while let Some(e) = self.stack.pop() {
            self.waiting[e as usize] = false;
            until_watch -= 1;
            if until_watch == 0 {
                watch.check()?;
                until_watch = WATCH_EVERY;
            }
            let Some(edge) = self.must_flip(e) else {
                continue;
            };
            if self.count as u128 == budget {
                return Err(Error::Internal("an edge was flipped twice".into()));
            }
            self.count += 1;
            if self.record {
                self.sequence.push(edge.map(|v| v as i32));
            }
            let other = self.mesh.flip(e);
            let o = next(other);
            // The four edges around the new one, by their new codes.
            for outer in [e, prev(e), other, o] {
                self.push(outer);
            }
        }
        Ok(())
    }

    /// The edge `e` as u, v with its apexes p, q, if it must be flipped.
    fn must_flip(&self, e: Code) -> Option<[u32; 4]> {
        let o = self.mesh.opposite(e);
        let [u, v] = [next(e), prev(e)].map(|c| self.mesh.vertex(c));
        let [p, q] = [e, o].map(|c| self.mesh.vertex(c));
        if q == self.mesh.infinite() {
            return None;
        }
        let [a, b, c, d] = [u, v, p, q].map(|v| self.points[v as usize]);
        (incircle_canonical(a, b, c, d) == Sign::Positive).then_some([u, v, p, q])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;
    use crate::delaunay::plane::{Method, triangulate};

    /// A convex polygon fanned from its vertex `hub`.
    fn fan(n: i32, hub: i32) -> Vec<[i32; 3]> {
        (1..n - 1)
            .map(|k| [hub, (hub + k) % n, (hub + k + 1) % n])
            .collect()
    }

    fn sorted(simplices: &[[i32; 3]]) -> Vec<[i32; 3]> {
        let turned = |t: &[i32; 3]| {
            let k = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
            [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]
        };
        let mut all: Vec<_> = simplices.iter().map(turned).collect();
        all.sort_unstable();
        all
    }

    fn flipped(points: &[Point2], simplices: &[[i32; 3]]) -> Flipped {
        lawson(points, simplices, true, &Watch::idle()).unwrap()
    }

    /// All fans of a convex polygon end in its canonical triangulation.
    fn all_fans_give_one_triangulation(points: &[Point2]) {
        let method = Method::BowyerWatson;
        let right = triangulate(points, method, 1, &Watch::idle()).unwrap();
        let right = sorted(&right.arrays.simplices);
        for hub in 0..points.len() as i32 {
            let made = flipped(points, &fan(points.len() as i32, hub));
            assert_eq!(sorted(&made.arrays.simplices), right);
            assert_eq!(made.sequence.len(), made.flips);
            let again = flipped(points, &made.arrays.simplices);
            assert_eq!(again.flips, 0);
            assert_eq!(again.arrays.simplices, made.arrays.simplices);
            assert_eq!(again.arrays.neighbors, made.arrays.neighbors);
        }
    }

    #[test]
    fn fans_of_convex_polygons() {
        let parabola: Vec<Point2> = (-6..7).map(f64::from).map(|x| [x, x * x]).collect();
        all_fans_give_one_triangulation(&parabola);
        // All of them on one circle: every flip breaks a tie.
        let [a, b, c] = [5.0, 4.0, 3.0];
        let quarter = [[a, 0.0], [b, c], [c, b]];
        let circle: Vec<Point2> = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .iter()
            .flat_map(|r| quarter.map(|[x, y]| [x * r[0] - y * r[1], x * r[1] + y * r[0]]))
            .collect();
        all_fans_give_one_triangulation(&circle);
        all_fans_give_one_triangulation(
            &circle
                .iter()
                .map(|p| p.map(|x| x * 1e-310))
                .collect::<Vec<_>>(),
        );
    }

    #[test]
    fn a_stretched_triangulation_is_restored() {
        // A tiling of the hull stays one when the points are stretched.
        let mut random = uniform(1);
        let points: Vec<Point2> = (0..500).map(|_| [random(), random()]).collect();
        let made = |points: &[Point2]| {
            let made = triangulate(points, Method::BowyerWatson, 1, &Watch::idle()).unwrap();
            made.arrays.simplices
        };
        let right = made(&points);
        for stretch in [2.0, 8.0, 1024.0] {
            let stretched: Vec<Point2> = points.iter().map(|&[x, y]| [stretch * x, y]).collect();
            let back = flipped(&points, &made(&stretched));
            assert_eq!(sorted(&back.arrays.simplices), sorted(&right));
            assert!(back.flips > 100);
            let neighbors = import::adjacency(&back.arrays.simplices, 500, &Watch::idle()).unwrap();
            assert_eq!(back.arrays.neighbors, neighbors);
        }
    }

    #[test]
    fn vertices_are_the_rows_given() {
        // Row 0 is the same point as row 4; the triangles have row 4.
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, -0.0]];
        let made = flipped(&points, &[[4, 1, 3], [1, 2, 3]]);
        assert_eq!(sorted(&made.arrays.simplices), [[1, 2, 4], [2, 3, 4]]);
        assert_eq!((made.flips, &made.sequence[..]), (1, &[[1, 3, 4, 2]][..]));
    }

    #[test]
    fn wrong_tilings_are_named() {
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 0.5]];
        let refused = |simplices: &[[i32; 3]]| {
            lawson(&points, simplices, false, &Watch::idle())
                .unwrap_err()
                .to_string()
        };
        for (simplices, words) in [
            (
                vec![[0, 1, 2], [0, 3, 2]],
                "simplices[1] = [0, 3, 2] is not counter-clockwise",
            ),
            (
                vec![[0, 1, 2], [0, 2, 3]],
                "point 4 is a vertex of no simplex",
            ),
            (vec![[0, 1, 4], [1, 2, 4], [0, 4, 3]], "the edge "),
            (vec![[0, 1, 4], [0, 1, 2], [0, 2, 3]], "0 -> 1 occurs twice"),
            (vec![[0, 1, 2], [0, 2, 3], [4, 2, 3]], "2 -> 3 occurs twice"),
            (vec![[0, 1, 1]], "[0, 1, 1] is not counter"),
            (vec![], "no simplices"),
        ] {
            let message = refused(&simplices);
            assert!(message.contains(words), "{message}");
        }
        let line = [[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]];
        let error = lawson(&line, &[], false, &Watch::idle()).unwrap_err();
        let chain = vec![0, 1, 2];
        assert_eq!(error, Error::Collinear { chain });
    }

    #[test]
    fn an_interruption_ends_the_flips() {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let stop = Watch::new(&|| true);
        let error = lawson(&points, &fan(4, 1), false, &stop).unwrap_err();
        assert_eq!(error, Error::Interrupted);
    }
}
