//! The nearest point of a surface of triangles: boxes around boxes around triangles, the nearer one
//! first (N. Beckmann et al., "The R*-tree", 1990, for such trees in general).
//!
//! Distances are rounded; of triangles that are equally near the one with the smallest number is the answer.

use delone_predicates::Point3;

use crate::error::Result;
use crate::memory::with_room;
use crate::parallel;

/// Triangles that a box holds before it is halved.
const FEW: usize = 4;
/// Queries that one task does.
const SHARE: usize = 1 << 10;

/// A box with the triangles `order[begin..end]`, and the first of its two halves, 0 for none.
struct Node {
    low: Point3,
    high: Point3,
    begin: usize,
    end: usize,
    halves: usize,
}

/// Triangles in boxes.
struct Tree<'a> {
    points: &'a [Point3],
    faces: &'a [[i32; 3]],
    order: Vec<u32>,
    nodes: Vec<Node>,
}

/// For each query the nearest face, and how its corners share in the nearest point of that.
pub fn nearest_on_faces(
    points: &[Point3],
    faces: &[[i32; 3]],
    queries: &[Point3],
    workers: usize,
) -> Result<Vec<(i32, [f64; 3])>> {
    let tree = Tree::of(points, faces)?;
    let tasks = queries.chunks(SHARE).collect();
    let parts = parallel::map(workers, tasks, |part: &[Point3]| {
        let mut stack = Vec::new();
        let near = |&q: &Point3| tree.nearest(q, &mut stack);
        part.iter().map(near).collect::<Vec<_>>()
    });
    let mut out = with_room(queries.len())?;
    parts.into_iter().for_each(|part| out.extend(part));
    Ok(out)
}

impl<'a> Tree<'a> {
    fn of(points: &'a [Point3], faces: &'a [[i32; 3]]) -> Result<Self> {
        let mut tree = Self {
            points,
            faces,
            order: with_room(faces.len())?,
            nodes: Vec::new(),
        };
        tree.order.extend(0..faces.len() as u32);
        let root = tree.node(0, faces.len());
        tree.nodes.push(root);
        // Each half has fewer triangles than the whole.
        let mut next = 0;
        while next < tree.nodes.len() {
            tree.halve(next);
            next += 1;
        }
        Ok(tree)
    }

    fn corners(&self, face: u32) -> [Point3; 3] {
        self.faces[face as usize].map(|v| self.points[v as usize])
    }

    fn node(&self, begin: usize, end: usize) -> Node {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &face in &self.order[begin..end] {
            for p in self.corners(face) {
                low = [0, 1, 2].map(|k| low[k].min(p[k]));
                high = [0, 1, 2].map(|k| high[k].max(p[k]));
            }
        }
        Node {
            low,
            high,
            begin,
            end,
            halves: 0,
        }
    }

    /// Halves a box at the middle one of its triangles, across its longest side.
    fn halve(&mut self, number: usize) {
        let Node {
            low,
            high,
            begin,
            end,
            ..
        } = self.nodes[number];
        if end - begin <= FEW {
            return;
        }
        let long = |k: usize| high[k] / 2.0 - low[k] / 2.0;
        let axis = (1..3).fold(0, |axis, k| if long(k) > long(axis) { k } else { axis });
        let mut order = std::mem::take(&mut self.order);
        let middle = |face: &u32| {
            self.corners(*face)
                .iter()
                .map(|p| p[axis] / 3.0)
                .sum::<f64>()
        };
        let half = (end - begin) / 2;
        order[begin..end]
            .select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.order = order;
        self.nodes[number].halves = self.nodes.len();
        let (left, right) = (self.node(begin, begin + half), self.node(begin + half, end));
        self.nodes.extend([left, right]);
    }

    fn nearest(&self, q: Point3, stack: &mut Vec<(f64, usize)>) -> (i32, [f64; 3]) {
        let mut best = (f64::INFINITY, -1, [f64::NAN; 3]);
        if self.faces.is_empty() || q.iter().any(|x| !x.is_finite()) {
            return (best.1, best.2);
        }
        stack.clear();
        stack.push((0.0, 0));
        while let Some((least, number)) = stack.pop() {
            if least > best.0 {
                continue;
            }
            let node = &self.nodes[number];
            if node.halves > 0 {
                let [one, two] = [node.halves, node.halves + 1].map(|i| (self.apart(q, i), i));
                // The nearer one on top.
                stack.extend(if one.0 < two.0 {
                    [two, one]
                } else {
                    [one, two]
                });
                continue;
            }
            for &face in &self.order[node.begin..node.end] {
                let (distance, shares) = on_triangle(self.corners(face), q);
                let found = (distance, face as i32, shares);
                if best.1 < 0 || (found.0, found.1) < (best.0, best.1) {
                    best = found;
                }
            }
        }
        (best.1, best.2)
    }

    /// The distance of a query from a box.
    fn apart(&self, q: Point3, number: usize) -> f64 {
        let node = &self.nodes[number];
        let beyond = [0, 1, 2].map(|k| (node.low[k] - q[k]).max(q[k] - node.high[k]).max(0.0));
        // A little less, so that no rounding leaves a triangle out.
        length(beyond) * (1.0 - 4.0 * f64::EPSILON)
    }
}

fn dot(p: Point3, q: Point3) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

/// The length of a vector, whatever its exponents.
fn length(v: Point3) -> f64 {
    let most = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if most == 0.0 {
        return 0.0;
    }
    let scaled = v.map(|x| x / most);
    most * dot(scaled, scaled).sqrt()
}

/// The distance of `q` from a triangle, and the shares of its corners in the nearest point.
fn on_triangle(corners: [Point3; 3], q: Point3) -> (f64, [f64; 3]) {
    let seen = corners.map(|p| [0, 1, 2].map(|k| p[k] - q[k]));
    let most = seen
        .as_flattened()
        .iter()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    if most == 0.0 {
        return (0.0, [1.0, 0.0, 0.0]);
    }
    // In a unit of its own, so that nothing over- or underflows.
    let seen = seen.map(|p| p.map(|x| x / most));
    let distance =
        |shares: [f64; 3]| length([0, 1, 2].map(|k| (0..3).map(|i| shares[i] * seen[i][k]).sum()));
    let mut best = inside(seen).map(|shares| (distance(shares), shares));
    if best.is_none() {
        for i in 0..3 {
            let shares = on_edge(seen, i, (i + 1) % 3);
            let found = (distance(shares), shares);
            if best.is_none_or(|b| found.0 < b.0) {
                best = Some(found);
            }
        }
    }
    best.map_or((f64::INFINITY, [f64::NAN; 3]), |(d, s)| (d * most, s))
}

/// The shares of the corners in the point of their plane nearest to the origin; nothing where it is
/// not inside.
fn inside([a, b, c]: [Point3; 3]) -> Option<[f64; 3]> {
    let minus = |p: Point3, q: Point3| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let cross = |p: Point3, q: Point3| {
        [
            p[1] * q[2] - p[2] * q[1],
            p[2] * q[0] - p[0] * q[2],
            p[0] * q[1] - p[1] * q[0],
        ]
    };
    let n = cross(minus(b, a), minus(c, a));
    let parts = [
        dot(cross(b, c), n),
        dot(cross(c, a), n),
        dot(cross(a, b), n),
    ];
    let sum: f64 = parts.iter().sum();
    // Written so that NaN is no inside.
    (sum > 0.0 && parts.iter().all(|&x| x >= 0.0)).then(|| parts.map(|x| x / sum))
}

/// The shares of two corners in the point between them nearest to the origin.
fn on_edge(seen: [Point3; 3], i: usize, j: usize) -> [f64; 3] {
    let (a, b) = (seen[i], seen[j]);
    let way = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let square = dot(way, way);
    let share = if square > 0.0 {
        (-dot(a, way) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mut shares = [0.0; 3];
    (shares[i], shares[j]) = (1.0 - share, share);
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [Point3; 4] = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [9.0, 9.0, 9.0],
    ];

    #[test]
    fn above_beside_and_at_a_corner() {
        let faces = [[0, 1, 2], [1, 3, 2]];
        let queries = [[1.0, 1.0, -3.0], [1.0, -5.0, 0.0], [-1.0, -1.0, -1.0]];
        let found = nearest_on_faces(&POINTS, &faces, &queries, 1).unwrap();
        assert_eq!(found[0], (0, [0.5, 0.25, 0.25]));
        assert_eq!(found[1], (0, [0.75, 0.25, 0.0]));
        assert_eq!(found[2], (0, [1.0, 0.0, 0.0]));
        let nowhere = nearest_on_faces(&POINTS, &faces, &[[f64::NAN; 3]], 1).unwrap();
        assert_eq!(nowhere[0].0, -1);
    }
}
