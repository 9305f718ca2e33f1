//! Finds the given points that lie deepest in circumcircles, and reports whether these are all of
//! them.
//!
//! A k-d tree with the bounding box of the points in each node (J. L. Bentley, "Multidimensional
//! binary search trees", 1975) finds candidates by disks rounded outward. Whether a candidate is in
//! conflict with a triangle is decided exactly, with ties broken by coordinates. Which of several
//! candidates are the deepest is decided in doubles: any choice among them is valid, a good one
//! saves rounds.

use delone_predicates::{Point2, Sign, incircle_canonical};

use super::disk::{LEAST, disk};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::watch::Watch;
use crate::locate::{in_unit, unit_of};

/// Points per leaf.
const LEAF: usize = 16;

/// Queries per task.
const TASK: usize = 256;

/// Computed distances to boxes are reduced by this factor before a box is pruned: their rounding
/// error is below 8 units of 2^-53.
const SLACK: f64 = 1.0 - 16.0 * f64::EPSILON;

/// The points found in circles.
#[derive(Debug, Default, PartialEq)]
pub struct Answers {
    /// The rows for circle i are `rows[starts[i]..starts[i + 1]]`, deepest first.
    pub starts: Vec<i64>,
    /// Rows of the points.
    pub rows: Vec<i32>,
    /// Whether these are all points in conflict with circle i.
    pub all: Vec<bool>,
}

#[derive(Debug)]
struct Node {
    extent: Extent,
    start: u32,
    end: u32,
    /// The left child; the right one is the next node. Zero in leaves.
    children: u32,
}

struct Tree<'a> {
    points: &'a [Point2],
    /// Boxes and distances are measured in this unit, so that their squares are doubles.
    unit: f64,
    rows: Vec<u32>,
    nodes: Vec<Node>,
}

impl<'a> Tree<'a> {
    fn of(points: &'a [Point2]) -> Result<Self> {
        let mut rows: Vec<u32> = with_room(points.len())?;
        rows.extend(0..points.len() as u32);
        let unit = unit_of(points);
        let node = |rows: &[u32], start: usize, end: usize| Node {
            extent: Extent::of(
                rows[start..end]
                    .iter()
                    .map(|&row| in_units(points[row as usize], unit)),
            ),
            start: start as u32,
            end: end as u32,
            children: 0,
        };
        let mut nodes = vec![node(&rows, 0, points.len())];
        let mut i = 0;
        while i < nodes.len() {
            let (start, end) = (nodes[i].start as usize, nodes[i].end as usize);
            let sides = [0, 1].map(|k| nodes[i].extent.max[k] - nodes[i].extent.min[k]);
            // Equal points stay together. A side may overflow; then infinity is the wider one.
            if end - start > LEAF && sides.iter().any(|&side| side > 0.0) {
                let axis = usize::from(sides[1] > sides[0]);
                let middle = (end - start) / 2;
                rows[start..end].select_nth_unstable_by(middle, |&p, &q| {
                    points[p as usize][axis].total_cmp(&points[q as usize][axis])
                });
                nodes[i].children = nodes.len() as u32;
                nodes.push(node(&rows, start, start + middle));
                nodes.push(node(&rows, start + middle, end));
            }
            i += 1;
        }
        Ok(Self {
            points,
            unit,
            rows,
            nodes,
        })
    }

    /// The rows of up to `most` points in conflict with a triangle, deepest first; and whether
    /// these are all. The search looks for one point more than requested: if it finds none, they
    /// are all.
    fn query(&self, corners: [Point2; 3], most: usize, found: &mut Vec<(f64, u32)>) -> bool {
        let wanted = most.saturating_add(1);
        let [x, y, radius] = disk(corners);
        let ([x, y], radius) = (in_units([x, y], self.unit), radius / self.unit + LEAST);
        let reach = radius * radius;
        found.clear();
        let mut open = vec![(0.0, 0u32)];
        while let Some((distance, i)) = open.pop() {
            // No point of the box is in the disk, or none is deeper than those found.
            if distance > reach {
                continue;
            }
            if found.len() == wanted {
                if radius.is_infinite() {
                    // The disk covers everything and no box is known to be deeper: stop.
                    break;
                }
                if -distance * SLACK <= found[most].0 {
                    continue;
                }
            }
            let node = &self.nodes[i as usize];
            if node.children == 0 {
                for &row in &self.rows[node.start as usize..node.end as usize] {
                    self.meet(row, corners, [x, y], wanted, found);
                }
                continue;
            }
            let mut pair = [node.children, node.children + 1].map(|child| {
                let extent = &self.nodes[child as usize].extent;
                let off = |k: usize, at: f64| (extent.min[k] - at).max(at - extent.max[k]).max(0.0);
                let [dx, dy] = [off(0, x), off(1, y)];
                ((dx * dx + dy * dy) * SLACK, child)
            });
            if pair[0].0 < pair[1].0 {
                pair.swap(0, 1);
            }
            open.extend(pair);
        }
        let all = found.len() <= most;
        found.truncate(most);
        all
    }

    /// Adds a point to the deepest `wanted` ones if it is in conflict and deep enough.
    fn meet(
        &self,
        row: u32,
        corners: [Point2; 3],
        center: [f64; 2],
        wanted: usize,
        found: &mut Vec<(f64, u32)>,
    ) {
        let p = self.points[row as usize];
        let [a, b, c] = corners;
        if corners.contains(&p) || incircle_canonical(a, b, c, p) != Sign::Positive {
            return;
        }
        let [x, y] = in_units(p, self.unit);
        let (dx, dy) = (x - center[0], y - center[1]);
        let depth = -(dx * dx + dy * dy);
        let at = found.partition_point(|&(other, _)| other >= depth);
        found.insert(at, (depth, row));
        found.truncate(wanted);
    }
}

/// A point in multiples of a unit of length.
#[inline]
fn in_units(p: Point2, unit: f64) -> Point2 {
    in_unit([0.0; 2], p, unit)
}

/// For each counterclockwise triangle, up to `most` of the `points` in conflict with it: inside its
/// circumcircle, or on it if the tie is broken that way. Its own corners do not count.
pub fn deepest(
    points: &[Point2],
    triangles: &[[Point2; 3]],
    most: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Answers> {
    let tree = Tree::of(points)?;
    let parts = parallel::map(workers, triangles.chunks(TASK).collect(), |some| {
        watch.check()?;
        let mut answers = Answers::default();
        let mut found = Vec::new();
        for &corners in some {
            answers.all.push(tree.query(corners, most, &mut found));
            answers.starts.push(found.len() as i64);
            answers
                .rows
                .extend(found.iter().map(|&(_, row)| row as i32));
        }
        Ok(answers)
    });
    let mut whole = Answers {
        starts: vec![0],
        ..Answers::default()
    };
    let mut end = 0;
    for part in parts {
        let part = part?;
        for count in part.starts {
            end += count;
            whole.starts.push(end);
        }
        whole.rows.extend(part.rows);
        whole.all.extend(part.all);
    }
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_points(n: usize, scale: f64) -> Vec<Point2> {
        let mut state = 3u64;
        let mut random = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            // A lattice, so that many points are cocircular.
            ((state >> 40) % 64) as f64 * scale
        };
        (0..n).map(|_| [random(), random()]).collect()
    }

    fn triangles(points: &[Point2]) -> Vec<[Point2; 3]> {
        points
            .chunks_exact(3)
            .filter_map(|c| {
                let turn = delone_predicates::orient2d(c[0], c[1], c[2]);
                match turn {
                    Sign::Positive => Some([c[0], c[1], c[2]]),
                    Sign::Negative => Some([c[0], c[2], c[1]]),
                    Sign::Zero => None,
                }
            })
            .collect()
    }

    #[test]
    fn all_points_in_conflict_are_found_at_every_scale() {
        for scale in [1.0, 1e-320, 1e-160, 1e306] {
            let points = random_points(700, scale);
            let asked = triangles(&random_points(300, scale));
            let found = deepest(&points, &asked, points.len(), 2, &Watch::idle()).unwrap();
            assert!(found.all.iter().all(|&all| all));
            for (i, &[a, b, c]) in asked.iter().enumerate() {
                let (from, to) = (found.starts[i] as usize, found.starts[i + 1] as usize);
                let mut rows = found.rows[from..to].to_vec();
                rows.sort_unstable();
                let right = |&row: &i32| {
                    let p = points[row as usize];
                    ![a, b, c].contains(&p) && incircle_canonical(a, b, c, p) == Sign::Positive
                };
                let all: Vec<i32> = (0..700).filter(right).collect();
                assert_eq!(rows, all);
            }
        }
    }

    #[test]
    fn the_deepest_are_first_and_more_are_announced() {
        let points: Vec<Point2> = (0..100).map(|i| [f64::from(i) / 100.0, 0.25]).collect();
        let circle = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5]];
        let found = deepest(&points, &[circle], 3, 1, &Watch::idle()).unwrap();
        assert_eq!(found.starts, [0, 3]);
        assert_eq!(found.rows[0], 50);
        assert!(found.rows.iter().all(|row| (49..=51).contains(row)));
        assert_eq!(found.all, [false]);
    }

    #[test]
    fn an_empty_answer_is_complete() {
        let circle = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5]];
        let found = deepest(&[[5.0, 5.0], [1.0, 0.0]], &[circle], 3, 1, &Watch::idle()).unwrap();
        assert_eq!((found.starts, found.all), (vec![0, 0], vec![true]));
        let found = deepest(&[], &[circle], 3, 1, &Watch::idle()).unwrap();
        assert_eq!((found.starts, found.all), (vec![0, 0], vec![true]));
    }

    #[test]
    fn trees_of_equal_points_end() {
        let points = vec![[1.0, 1.0]; 100];
        let circle = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let found = deepest(&points, &[circle], 2, 1, &Watch::idle()).unwrap();
        assert_eq!((found.rows.len(), found.all[0]), (2, false));
    }
}
