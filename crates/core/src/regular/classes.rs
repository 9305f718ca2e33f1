//! Periodic triangulations: one triangle of each class of translates, and what lies across its
//! edges.
//!
//! First, the points are triangulated without their copies. Their bounding box is at most one
//! period wide, so no copy lies in the larger box that extends from its largest coordinates minus
//! one period to its smallest ones plus one period. A triangle whose circle lies inside this larger
//! box is also a triangle of the periodic set: call it final. If all triangles around a point are
//! final, and it does not lie on the hull, no other triangle has it as a corner. So the triangles
//! that are not final join only the remaining points, and those are triangulated with all their
//! copies (see `periodic`): few, unless there are few points at all.
//!
//! Both triangulations are canonical: ties are broken by an order of the points, so a triangle with
//! an empty circle is also one of each set that is smaller and has its corners. Hence the edges
//! around the final triangles are edges of the second triangulation, and what that has on their
//! other side, up to the next such edge, is the rest.
//!
//! # The bounds of the circles
//!
//! Let u = 2^-53, s the largest difference of two coordinates, W that of two weights, d the
//! determinant of the differences. Numerators of the center, seen from a corner, are at most 4 s
//! (s^2 + W) and err by less than 64 u s (s^2 + W); d errs by less than 16 u s^2. If |d| > 2^-20
//! s^2, the center errs by less than 2^-26 s (s^2 + W) / |d| (the quotient's own roundings
//! included), and 2^-20 in its place is also more than what the radius and the bounds of the box
//! lose, up to their own magnitudes times 2^-48. Nothing depends on how tight this is: a triangle
//! that is not found to be final is made again.

use std::collections::HashMap;

use delone_predicates::Point2;

use super::periodic::{Copies, of_copies};
use super::regular;
use crate::base::arrays::{Arrays, Given, Side};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::points::{self, Extent};
use crate::base::watch::{Pace, Watch};
use crate::delaunay::plane::{Method, triangulate};
use crate::order::arrange;

/// Sets with fewer points take all copies at once.
const FEW: usize = 64;

/// The corners starting with each one, and the position of each corner in that order.
const TURNED: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
const LESS: [[i32; 3]; 3] = [[0, 1, 2], [2, 0, 1], [1, 2, 0]];

/// Steps between two checks for interruption.
const STEPS: usize = 1 << 14;

/// A triangulation of periodic points.
#[derive(Debug, Default)]
pub struct Periodic {
    /// One triangle of each class, as rows of points, counterclockwise; the smallest row first.
    pub simplices: Vec<[i32; 3]>,
    /// By how many periods each corner is translated: x and y of each; 0 for the first one.
    pub offsets: Vec<[i32; 6]>,
    /// What is opposite each corner, as 3 t + k for corner k of triangle t; -1 outside.
    pub partners: Vec<[i32; 3]>,
    /// If there is no triangle, the rows that are not hidden, in order along the line.
    pub chain: Vec<i32>,
}

/// A directed edge: two rows, and by how many periods the second is translated against the first.
type Edge = ([i32; 2], [i32; 2]);

/// Triangulates finite points that lie within one period, excluding its end; a period of 0 means
/// not periodic. With weights, one for each point, the triangulation is the regular one. Of
/// coincident points one row is used: the first of the heaviest. The same for any number of
/// workers.
pub fn periodic(
    points: &[Point2],
    weights: &[f64],
    periods: Point2,
    workers: usize,
    watch: &Watch,
) -> Result<Periodic> {
    points::scan(points)?;
    // Equal weights change nothing, and without weights there are faster ways.
    let weights = match weights {
        [first, rest @ ..] if rest.iter().all(|w| w == first) => &[],
        _ => weights,
    };
    let Alone {
        rows,
        triangles: Arrays {
            simplices,
            neighbors,
        },
    } = Alone::of(points, weights, workers, watch)?;
    let given = Given {
        points,
        simplices: &simplices,
        neighbors: &neighbors,
    };
    let mut pace = Pace::new(watch, STEPS);
    let inner = Inner::of(&given, weights, periods, &mut pace)?;
    let taken = copies(&inner.open_rows(&given, &rows)?, periods)?;
    let copied = of_copies(points, weights, periods, &taken, watch)?;
    let around = Classes::of(copied, &mut pace)?;
    joined(&given, &inner, around, &mut pace)
}

/// The triangulation of the points without copies.
struct Alone {
    /// The rows that represent distinct points, ascending.
    rows: Vec<u32>,
    /// None if there are few, or if all are collinear.
    triangles: Arrays<3>,
}

impl Alone {
    fn of(points: &[Point2], weights: &[f64], workers: usize, watch: &Watch) -> Result<Self> {
        if points.len() >= FEW && weights.is_empty() {
            match triangulate(points, Method::Auto, workers, watch) {
                Ok(made) => {
                    let mut repeats = made.duplicates.iter().map(|&[row, _]| row).peekable();
                    let mut rows = with_room(points.len())?;
                    rows.extend(
                        (0..points.len() as u32).filter(|row| repeats.next_if_eq(row).is_none()),
                    );
                    return Ok(Self {
                        rows,
                        triangles: made.arrays,
                    });
                }
                Err(Error::TooFew { .. } | Error::Collinear { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        if !weights.is_empty() {
            let made = regular(points, weights, workers, watch)?;
            let own = (0_u32..).zip(&made.stands_for);
            return Ok(Self {
                rows: own
                    .filter(|&(row, &best)| best == row as i32)
                    .map(|(row, _)| row)
                    .collect(),
                triangles: if points.len() < FEW {
                    Arrays::default()
                } else {
                    made.triangles
                },
            });
        }
        let mut rows = arrange(points, 1, watch)?.rows;
        rows.sort_unstable();
        Ok(Self {
            rows,
            triangles: Arrays::default(),
        })
    }
}

/// The triangles of the points alone that are also triangles of the periodic set.
struct Inner {
    /// Whether each triangle is one of them.
    is_final: Vec<bool>,
    /// How many are.
    count: usize,
}

impl Inner {
    fn of(
        given: &Given<'_, 2, 3>,
        weights: &[f64],
        periods: Point2,
        pace: &mut Pace<'_>,
    ) -> Result<Self> {
        let extent = Extent::of(given.points.iter().copied());
        let heaviest = weights.iter().fold(f64::NEG_INFINITY, |m, &w| m.max(w));
        let mut is_final = with_room(given.simplices.len())?;
        for corners in given.simplices {
            pace.spend(1)?;
            let weight = |v: i32| weights.get(v as usize).copied().unwrap_or(0.0);
            let excess = corners.map(|v| weight(v) - weight(corners[0]));
            let circle = Circle::of(corners.map(|v| given.point(v)), excess);
            let heavier = match weights {
                [] => 0.0,
                _ => heaviest - weight(corners[0]),
            };
            is_final.push(circle.is_some_and(|circle| circle.is_clear(&extent, periods, heavier)));
        }
        let count = is_final.iter().filter(|&&x| x).count();
        Ok(Self { is_final, count })
    }

    /// Whether a triangle is given and final.
    fn has(&self, t: i32) -> bool {
        t >= 0 && self.is_final[t as usize]
    }

    /// The rows that triangles which are not final may have as corners.
    fn open_rows(&self, given: &Given<'_, 2, 3>, rows: &[u32]) -> Result<Vec<u32>> {
        if self.count == 0 {
            return crate::base::memory::copied(rows);
        }
        let mut open = filled(given.points.len(), false)?;
        for (t, corners) in given.simplices.iter().enumerate() {
            for k in 0..3 {
                if !self.is_final[t] {
                    open[corners[k] as usize] = true;
                } else if given.neighbors[t][k] < 0 {
                    // An edge of the hull, beyond which its ends have other triangles.
                    open[corners[(k + 1) % 3] as usize] = true;
                    open[corners[(k + 2) % 3] as usize] = true;
                }
            }
        }
        let mut found = Vec::new();
        found.extend(rows.iter().filter(|&&row| open[row as usize]));
        Ok(found)
    }
}

/// The circle through the corners of a triangle; with weights, the circle orthogonal to theirs.
struct Circle {
    center: Point2,
    /// The square of the distance from the center to the first corner.
    square: f64,
    /// More than the error of the center.
    error: f64,
}

impl Circle {
    /// `excess` has the weights of the corners less that of the first. None if too thin to tell.
    fn of([a, b, c]: [Point2; 3], excess: [f64; 3]) -> Option<Self> {
        let [p, q] = [b, c].map(|v| [v[0] - a[0], v[1] - a[1]]);
        let size = [p, q]
            .as_flattened()
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        let heavy = excess.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let det = p[0] * q[1] - p[1] * q[0];
        let (square, least) = (size * size, f64::MIN_POSITIVE * 2.0_f64.powi(200));
        // Magnitudes far from the ends of the doubles, so that no product underflows.
        if !(det.abs() > 2.0_f64.powi(-20) * square && square > least) {
            return None;
        }
        let [h, k] = [
            p[0] * p[0] + p[1] * p[1] - excess[1],
            q[0] * q[0] + q[1] * q[1] - excess[2],
        ];
        let half = 0.5 / det;
        let away = [(h * q[1] - k * p[1]) * half, (k * p[0] - h * q[0]) * half];
        Some(Self {
            center: [a[0] + away[0], a[1] + away[1]],
            square: away[0] * away[0] + away[1] * away[1],
            error: 2.0_f64.powi(-20) * size * (square + heavy) / det.abs(),
        })
    }

    /// Whether no copy can lie in the circle, or with weights, below the plane of the triangle, if
    /// the heaviest point has `heavier` more weight than the first corner. False if anything is not
    /// finite.
    fn is_clear(&self, extent: &Extent, periods: Point2, heavier: f64) -> bool {
        let reach = (self.square + heavier).sqrt() + self.error;
        (0..2).filter(|&k| periods[k] > 0.0).all(|k| {
            let (low, high) = (extent.min[k], extent.max[k]);
            let most = low.abs().max(high.abs()) + periods[k] + self.center[k].abs() + reach;
            let margin = self.error + 2.0_f64.powi(-48) * most;
            self.center[k] - reach - margin > high - periods[k]
                && self.center[k] + reach + margin < low + periods[k]
        })
    }
}

/// Rows with all their copies one period away: row, and periods in x and y.
fn copies(rows: &[u32], periods: Point2) -> Result<Vec<[i32; 3]>> {
    let steps = periods.map(|length| if length > 0.0 { -1..=1 } else { 0..=0 });
    let mut found = with_room(9 * rows.len())?;
    for &row in rows {
        for x in steps[0].clone() {
            found.extend(steps[1].clone().map(|y| [row as i32, x, y]));
        }
    }
    Ok(found)
}

/// Triangles of copies, one of each class.
struct Classes {
    simplices: Vec<[i32; 3]>,
    offsets: Vec<[i32; 6]>,
    chain: Vec<i32>,
}

impl Classes {
    /// Keeps the triangle of each class whose smallest row comes first and is not translated; if a
    /// row occurs more than once, the one with the smallest translation in lexicographic order.
    fn of(made: Copies, pace: &mut Pace<'_>) -> Result<Self> {
        let Copies {
            triangles,
            chain,
            rows,
            moved,
        } = made;
        let (mut simplices, mut offsets) = (Vec::new(), Vec::new());
        for corners in &triangles.simplices {
            pace.spend(1)?;
            let corner = |k: usize| {
                let copy = corners[k % 3] as usize;
                (rows[copy], moved[copy])
            };
            let first = (0..3).min_by_key(|&k| corner(k)).unwrap_or(0);
            let [a, b, c] = [0, 1, 2].map(|k| corner(first + k));
            if a.1 == [0, 0] {
                crate::base::memory::push(&mut simplices, [a.0, b.0, c.0])?;
                crate::base::memory::push(&mut offsets, [0, 0, b.1[0], b.1[1], c.1[0], c.1[1]])?;
            }
        }
        let own = chain.iter().map(|&copy| copy as usize);
        Ok(Self {
            simplices,
            offsets,
            chain: own
                .filter(|&copy| moved[copy] == [0, 0])
                .map(|copy| rows[copy])
                .collect(),
        })
    }

    /// The edge opposite corner k of a triangle, counterclockwise.
    fn edge(&self, t: usize, k: usize) -> Edge {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (corners, moved) = (self.simplices[t], self.offsets[t]);
        (
            [corners[i], corners[j]],
            [0, 1].map(|axis| moved[2 * j + axis] - moved[2 * i + axis]),
        )
    }

    /// The place of each edge, as 3 t + k.
    fn places(&self, pace: &mut Pace<'_>) -> Result<HashMap<Edge, usize>> {
        let mut places = HashMap::new();
        let count = 3 * self.simplices.len();
        places.try_reserve(count).map_err(|_| Error::Memory {
            bytes: count * size_of::<(Edge, usize)>(),
        })?;
        for code in 0..count {
            pace.spend(1)?;
            if places.insert(self.edge(code / 3, code % 3), code).is_some() {
                return Err(unpaired());
            }
        }
        Ok(places)
    }
}

fn unpaired() -> Error {
    Error::Internal("edges of a periodic triangulation do not pair up".into())
}

/// The same edge in the other direction.
fn reverse(([a, b], [x, y]): Edge) -> Edge {
    ([b, a], [-x, -y])
}

/// Final triangles, and those of `around` that lie outside them.
fn joined(
    given: &Given<'_, 2, 3>,
    inner: &Inner,
    around: Classes,
    pace: &mut Pace<'_>,
) -> Result<Periodic> {
    let places = around.places(pace)?;
    // Edges between final triangles and others: the code in `around` of the other side, and the
    // side.
    let mut walls: HashMap<usize, Side> = HashMap::new();
    for simplex in (0..given.simplices.len()).filter(|&t| inner.is_final[t]) {
        for corner in (0..3).filter(|&k| !inner.has(given.neighbors[simplex][k])) {
            let (tail, head) = ((corner + 1) % 3, (corner + 2) % 3);
            let ends = given.simplices[simplex];
            if let Some(&code) = places.get(&([ends[head], ends[tail]], [0, 0])) {
                walls.insert(code, Side { simplex, corner });
            }
        }
    }
    // Without final triangles, all of `around` is taken.
    let count = around.simplices.len();
    let mut is_taken = filled(count, inner.count == 0)?;
    let mut open: Vec<usize> = walls.keys().map(|code| code / 3).collect();
    while let Some(t) = open.pop() {
        // Each triangle is expanded once.
        if std::mem::replace(&mut is_taken[t], true) {
            continue;
        }
        pace.spend(1)?;
        for k in (0..3).filter(|&k| !walls.contains_key(&(3 * t + k))) {
            if let Some(&code) = places.get(&reverse(around.edge(t, k))) {
                open.push(code / 3);
            }
        }
    }
    let number = |flags: &[bool], mut next: i32| -> Result<Vec<i32>> {
        let mut numbers = with_room(flags.len())?;
        numbers.extend(flags.iter().map(|&flag| {
            next += i32::from(flag);
            if flag { next - 1 } else { -1 }
        }));
        Ok(numbers)
    };
    let (of_inner, of_around) = (
        number(&inner.is_final, 0)?,
        number(&is_taken, inner.count as i32)?,
    );
    let total = inner.count + is_taken.iter().filter(|&&x| x).count();
    let mut made = Periodic {
        simplices: with_room(total)?,
        offsets: with_room(total)?,
        partners: with_room(total)?,
        chain: around.chain.clone(),
    };
    // The smallest row of a final triangle comes first: the number of each, and the corner with it.
    let mut starts = with_room(of_inner.len())?;
    starts.extend(
        of_inner
            .iter()
            .zip(given.simplices)
            .map(|(&number, &[a, b, c])| {
                let first = if a < b && a < c {
                    0
                } else {
                    1 + u32::from(c < b)
                };
                (number, first)
            }),
    );
    let code_of = |side: Side| {
        let (number, first) = starts[side.simplex];
        3 * number + LESS[first as usize][side.corner]
    };
    for simplex in (0..given.simplices.len()).filter(|&t| inner.is_final[t]) {
        pace.spend(1)?;
        let turned = TURNED[starts[simplex].1 as usize];
        made.simplices
            .push(turned.map(|k| given.simplices[simplex][k]));
        made.offsets.push([0; 6]);
        made.partners.push(turned.map(|corner| {
            let beyond = given.beyond(Side { simplex, corner });
            if let Some(side) = beyond.filter(|side| inner.is_final[side.simplex]) {
                return code_of(side);
            }
            let ends = given.simplices[simplex];
            let other = ([ends[(corner + 2) % 3], ends[(corner + 1) % 3]], [0, 0]);
            places
                .get(&other)
                .map_or(-1, |&code| 3 * of_around[code / 3] + (code % 3) as i32)
        }));
    }
    for t in (0..count).filter(|&t| is_taken[t]) {
        pace.spend(1)?;
        made.simplices.push(around.simplices[t]);
        made.offsets.push(around.offsets[t]);
        made.partners.push([0, 1, 2].map(|k| {
            if let Some(&side) = walls.get(&(3 * t + k)) {
                return code_of(side);
            }
            places
                .get(&reverse(around.edge(t, k)))
                .map_or(-1, |&code| 3 * of_around[code / 3] + (code % 3) as i32)
        }));
    }
    Ok(made)
}
