//! A convex polyhedron clipped by planes, in floating point.
//!
//! A new corner is interpolated on its edge, unless the caller provides it: on an edge between
//! nearly parallel planes, the interpolated corner would satisfy the planes, but be far from the
//! true point.
//!
//! Corners are kept or removed by the sign of a rounded number, and everything else follows from
//! that: each edge with one end kept gets one new corner, at which the new edge enters one of its
//! two faces and leaves the other. So the new edges form closed cycles, and the surface stays
//! closed, whatever the signs are.

use delone_predicates::Point3;

use super::measure::{Units, by_power, dot, exponent, length, seen};

/// Corners, and faces counterclockwise from outside.
#[derive(Clone, Debug, Default)]
pub(super) struct Polyhedron {
    pub points: Vec<Point3>,
    /// The corners of face f are `corners[starts[f]..starts[f + 1]]`.
    pub starts: Vec<u32>,
    pub corners: Vec<u32>,
    pub labels: Vec<i32>,
    spare: Spare,
}

/// Buffers reused from clip to clip.
#[derive(Clone, Debug, Default)]
struct Spare {
    values: Vec<f64>,
    number: Vec<u32>,
    points: Vec<Point3>,
    starts: Vec<u32>,
    corners: Vec<u32>,
    labels: Vec<i32>,
    cuts: Vec<Cut>,
    /// For each new corner, the next one in the new face.
    links: Vec<(u32, u32)>,
}

/// An edge with one end kept.
#[derive(Clone, Copy, Debug)]
struct Cut {
    kept: u32,
    other: u32,
    /// The new corner.
    new: u32,
    /// The label of the face that was visited first.
    beside: i32,
}

const NONE: u32 = u32::MAX;
impl Polyhedron {
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    pub fn face(&self, f: usize) -> &[u32] {
        &self.corners[self.starts[f] as usize..self.starts[f + 1] as usize]
    }

    /// Removes the part where `value`, a linear function, is positive. New faces get the label. If
    /// faces of three labels meet in a new corner, `meet` may provide it.
    pub fn cut(
        &mut self,
        label: i32,
        value: impl Fn(Point3) -> f64,
        meet: impl Fn([i32; 3]) -> Option<Point3>,
    ) {
        let mut spare = std::mem::take(&mut self.spare);
        spare.values.clear();
        spare.values.extend(self.points.iter().map(|&p| value(p)));
        if spare.values.iter().any(|&v| v > 0.0) {
            if spare.values.iter().any(|&v| v < 0.0) {
                self.part(label, &mut spare, &meet);
            } else {
                self.points.clear();
                self.corners.clear();
                self.labels.clear();
                self.starts.truncate(1);
            }
        }
        self.spare = spare;
    }

    fn part(&mut self, label: i32, spare: &mut Spare, meet: &impl Fn([i32; 3]) -> Option<Point3>) {
        spare.points.clear();
        spare.number.clear();
        for (&p, &v) in self.points.iter().zip(&spare.values) {
            spare.number.push(if v > 0.0 {
                NONE
            } else {
                spare.points.push(p);
                spare.points.len() as u32 - 1
            });
        }
        spare.cuts.clear();
        spare.links.clear();
        spare.corners.clear();
        spare.labels.clear();
        spare.starts.clear();
        spare.starts.push(0);
        for f in 0..self.labels.len() {
            self.part_face(f, spare, &|beside, also| meet([beside, also, label]));
        }
        close(label, spare);
        std::mem::swap(&mut self.points, &mut spare.points);
        std::mem::swap(&mut self.starts, &mut spare.starts);
        std::mem::swap(&mut self.corners, &mut spare.corners);
        std::mem::swap(&mut self.labels, &mut spare.labels);
    }

    fn part_face(&self, f: usize, spare: &mut Spare, meet: &impl Fn(i32, i32) -> Option<Point3>) {
        let face = self.face(f);
        let begin = spare.corners.len();
        let (mut leave, mut enter) = (NONE, NONE);
        let mut p = face[face.len() - 1];
        for &q in face {
            let (keeps_p, keeps_q) = (
                spare.number[p as usize] != NONE,
                spare.number[q as usize] != NONE,
            );
            if keeps_p != keeps_q {
                let (kept, other) = if keeps_p { (p, q) } else { (q, p) };
                let new = self.on_edge((kept, other), self.labels[f], spare, meet);
                spare.corners.push(new);
                if keeps_p {
                    leave = new;
                } else if leave == NONE {
                    enter = new;
                } else {
                    spare.links.push((new, leave));
                    leave = NONE;
                }
            }
            if keeps_q {
                spare.corners.push(spare.number[q as usize]);
            }
            p = q;
        }
        if enter != NONE {
            spare.links.push((enter, leave));
        }
        if spare.corners.len() > begin {
            spare.labels.push(self.labels[f]);
            spare.starts.push(spare.corners.len() as u32);
        }
    }

    /// The new corner on an edge, starting at a corner that is kept, for both adjacent faces.
    fn on_edge(
        &self,
        (kept, other): (u32, u32),
        face: i32,
        spare: &mut Spare,
        meet: &impl Fn(i32, i32) -> Option<Point3>,
    ) -> u32 {
        let known = spare
            .cuts
            .iter()
            .find(|c| (c.kept, c.other) == (kept, other));
        if let Some(&Cut { new, beside, .. }) = known {
            if let Some(at) = meet(beside, face) {
                spare.points[new as usize] = at;
            }
            return new;
        }
        let (v, w) = (spare.values[kept as usize], spare.values[other as usize]);
        let (p, q) = (self.points[kept as usize], self.points[other as usize]);
        let share = v / (v - w);
        let at = [0, 1, 2].map(|k| p[k] + (q[k] - p[k]) * share);
        spare.points.push(at);
        let new = spare.points.len() as u32 - 1;
        spare.cuts.push(Cut {
            kept,
            other,
            new,
            beside: face,
        });
        new
    }

    /// Gives equal corners one number, and drops faces with fewer than three corners. If the
    /// surface would then not be closed, because a face touches itself, nothing changes, and equal
    /// corners stay separate.
    pub fn weld(&mut self) {
        let mut first: Vec<u32> = Vec::with_capacity(self.points.len());
        for i in 0..self.points.len() {
            let same = (0..i).find(|&j| self.points[j] == self.points[i]);
            first.push(same.unwrap_or(i) as u32);
        }
        if first.iter().zip(0..).all(|(&j, i)| i == j) {
            return;
        }
        let mut number = vec![NONE; self.points.len()];
        let (mut points, mut starts, mut corners, mut labels) = (vec![], vec![0], vec![], vec![]);
        for f in 0..self.labels.len() {
            let mut face: Vec<u32> = self.face(f).iter().map(|&v| first[v as usize]).collect();
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
            if face.len() < 3 {
                continue;
            }
            for v in face {
                let slot = &mut number[v as usize];
                if *slot == NONE {
                    *slot = points.len() as u32;
                    points.push(self.points[v as usize]);
                }
                corners.push(*slot);
            }
            starts.push(corners.len() as u32);
            labels.push(self.labels[f]);
        }
        if is_closed(points.len(), &starts, &corners) {
            (self.points, self.starts) = (points, starts);
            (self.corners, self.labels) = (corners, labels);
        }
    }

    /// The area of a face: infinite on overflow, nonzero on underflow.
    pub fn area(&self, f: usize) -> f64 {
        let face = self.face(f);
        let o = self.points[face[0] as usize];
        let units = Units::of(face.iter().map(|&v| seen(self.points[v as usize], o)));
        let (mut sum, mut last) = ([0.0; 3], [0.0; 3]);
        for &v in &face[1..] {
            let here = units.scaled(seen(self.points[v as usize], o));
            for (k, s) in sum.iter_mut().enumerate() {
                let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                *s += (last[x] * here[y] - last[y] * here[x]) / 2.0;
            }
            last = here;
        }
        // Each component of the vector area has its own power of two.
        let [x, y, z] = units.powers;
        let powers = [y + z, z + x, x + y];
        let there = (0..3).filter(|&k| sum[k] != 0.0);
        let most = there.map(|k| powers[k] + exponent(sum[k])).max();
        let most = most.unwrap_or(0);
        by_power(
            length([0, 1, 2].map(|k| by_power(sum[k], powers[k] - most))),
            most,
        )
    }

    /// The volume and the centroid.
    pub fn body(&self) -> (f64, Point3) {
        let Some(&o) = self.points.first() else {
            return (0.0, [f64::NAN; 3]);
        };
        let units = Units::of(self.points.iter().map(|&p| seen(p, o)));
        let (mut volume, mut moment) = (0.0, [0.0; 3]);
        for f in 0..self.labels.len() {
            let face = self.face(f);
            let seen = |v: u32| units.scaled(seen(self.points[v as usize], o));
            let a = seen(face[0]);
            for w in face[1..].windows(2) {
                let (b, c) = (seen(w[0]), seen(w[1]));
                let cross = [0, 1, 2].map(|k| {
                    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                    b[x] * c[y] - b[y] * c[x]
                });
                let part = dot(a, cross);
                volume += part;
                for k in 0..3 {
                    moment[k] += part * (a[k] + b[k] + c[k]);
                }
            }
        }
        if volume > 0.0 {
            let center = [0, 1, 2].map(|k| o[k] + units.back(k, moment[k] / volume / 4.0));
            let power = units.powers.iter().sum();
            return (by_power(volume / 6.0, power), center);
        }
        (0.0, o)
    }
}

/// Whether each edge occurs once in each direction, and the Euler characteristic is that of a
/// sphere.
fn is_closed(points: usize, starts: &[u32], corners: &[u32]) -> bool {
    let mut edges = Vec::with_capacity(corners.len());
    for bounds in starts.windows(2) {
        let face = &corners[bounds[0] as usize..bounds[1] as usize];
        let next = face.iter().skip(1).chain(face.first());
        edges.extend(face.iter().zip(next).map(|(&p, &q)| (p, q)));
    }
    edges.sort_unstable();
    let once = edges.windows(2).all(|pair| pair[0] != pair[1]);
    let back = |&(p, q): &(u32, u32)| edges.binary_search(&(q, p)).is_ok();
    let faces = starts.len() - 1;
    once && edges.iter().all(back) && points + faces == edges.len() / 2 + 2
}

/// Adds the new faces: the cycles of the links.
fn close(label: i32, spare: &mut Spare) {
    while let Some((start, mut now)) = spare.links.pop() {
        spare.corners.push(start);
        // Each step removes a link.
        while now != start {
            spare.corners.push(now);
            let Some(i) = spare.links.iter().position(|l| l.0 == now) else {
                break;
            };
            now = spare.links.swap_remove(i).1;
        }
        spare.labels.push(label);
        spare.starts.push(spare.corners.len() as u32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The faces of a cube whose corners have x, y and z in the bits of their numbers.
    const CUBE: [u32; 24] = [
        0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6,
    ];

    /// The cube of all |x| <= size, with faces -1 to -6.
    fn cube(size: f64) -> Polyhedron {
        let bit = |i: u32, k: u32| if i >> k & 1 == 1 { size } else { -size };
        Polyhedron {
            points: (0..8).map(|i| [0, 1, 2].map(|k| bit(i, k))).collect(),
            starts: (0..7).map(|f| 4 * f).collect(),
            corners: CUBE.to_vec(),
            labels: (0..6).map(|f| !f).collect(),
            spare: Spare::default(),
        }
    }

    /// Provides no corners.
    fn none(_: [i32; 3]) -> Option<Point3> {
        None
    }

    #[test]
    fn a_corner_is_removed() {
        let mut body = cube(0.5);
        let (volume, center) = body.body();
        assert!((volume - 1.0).abs() < 1e-15 && center.iter().all(|x| x.abs() < 1e-15));
        body.cut(7, |p| p[0] + p[1] + p[2] - 0.5, none);
        body.weld();
        assert!((body.body().0 - 5.0 / 6.0).abs() < 1e-15);
        let f = body.labels.iter().position(|&l| l == 7).unwrap();
        assert_eq!(body.face(f).len(), 3);
        assert!((body.area(f) - 0.75_f64.sqrt()).abs() < 1e-15);
        body.cut(8, |p| p[0] - 2.0, none);
        assert_eq!(body.labels.len(), 7);
        body.cut(9, |p| p[0] + 1.0, none);
        assert!(body.is_empty());
        assert_eq!(body.body().0, 0.0);
    }

    #[test]
    fn a_plane_through_corners_leaves_half() {
        let mut body = cube(0.5);
        body.cut(3, |p| p[0] - p[1], none);
        body.weld();
        assert!((body.body().0 - 0.5).abs() < 1e-15);
        assert_eq!((body.points.len(), body.labels.len()), (6, 5));
        assert!((0..5).all(|f| body.area(f) > 0.0));
    }

    #[test]
    fn corners_may_be_provided() {
        let mut body = cube(0.5);
        let told = |labels: [i32; 3]| {
            (labels.contains(&-1) && labels.contains(&-3)).then_some([-0.5, -0.5, 0.125])
        };
        body.cut(7, |p| p[2] - 0.1, told);
        let at = |p: &&Point3| p[0] == -0.5 && p[1] == -0.5;
        let heights: Vec<f64> = body.points.iter().filter(at).map(|p| p[2]).collect();
        assert_eq!(heights, [-0.5, 0.125]);
    }

    #[test]
    fn corners_whose_welding_would_pinch_stay_separate() {
        // Two opposite corners of the cube.
        let mut body = cube(0.5);
        body.points[1] = body.points[6];
        let corners = body.corners.clone();
        body.weld();
        assert_eq!((body.points.len(), body.corners), (8, corners));
    }
}
