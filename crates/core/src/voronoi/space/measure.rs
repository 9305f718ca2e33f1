//! Volumes, centroids and surface areas of cells, and areas of ridges.
//!
//! A cell is the sum of the pyramids from its site to its faces, whose heights are known before any
//! vertex is rounded: half the distance of the two sites (plus a share due to weights).

use delone_predicates::Point3;

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
pub(super) use crate::base::vector::dot;
use crate::base::watch::Watch;
use crate::voronoi::Given;

/// Ridges or cells per task.
const SHARE: usize = 1 << 12;

/// The cells of a diagram as arrays, with the points and weights of its triangulation.
#[derive(Clone, Copy)]
pub struct Cells<'a> {
    /// Coordinates.
    pub points: &'a [Point3],
    /// Weights; empty for none.
    pub weights: &'a [f64],
    /// Vertices of the diagram.
    pub vertices: &'a [Point3],
    /// The two sites of each ridge.
    pub sites: &'a [[i32; 2]],
    /// Where the entries of each ridge begin, plus the end.
    pub starts: &'a [i32],
    /// Vertices of ridges, negative for rays.
    pub entries: &'a [i32],
    /// The point of each cell.
    pub site: &'a [i32],
    /// Where the ridges of each cell begin, plus the end.
    pub ridge_starts: &'a [i32],
    /// The ridges of cells.
    pub ridges: &'a [i32],
}

/// The measures of cells and ridges: infinite if they are unbounded, with NaN for centroids.
#[derive(Debug)]
pub struct Measures {
    /// Area of each ridge.
    pub ridge_areas: Vec<f64>,
    /// Volume of each cell.
    pub volumes: Vec<f64>,
    /// Area of the surface of each cell.
    pub areas: Vec<f64>,
    /// The centroid of each cell.
    pub centroids: Vec<Point3>,
}

impl<'a> Cells<'a> {
    pub(super) fn given(&self) -> Given<'a, 3, 4> {
        Given {
            points: self.points,
            weights: self.weights,
            simplices: &[],
            neighbors: &[],
        }
    }

    /// The entries of a ridge.
    pub(super) fn entries_of(&self, ridge: usize) -> &'a [i32] {
        &self.entries[self.starts[ridge] as usize..self.starts[ridge + 1] as usize]
    }

    /// The ridges of a cell.
    pub(super) fn ridges_of(&self, cell: usize) -> &'a [i32] {
        &self.ridges[self.ridge_starts[cell] as usize..self.ridge_starts[cell + 1] as usize]
    }

    /// The plane of a ridge relative to one of its sites: a vector d toward the other site, and h,
    /// so that the cell of the first has (x - p) . d <= h. The largest component of d is 1 to 2, so
    /// its squares neither overflow nor underflow.
    pub(super) fn plane(&self, ridge: usize, site: i32) -> (Point3, f64) {
        let [a, b] = self.sites[ridge];
        let other = if a == site { b } else { a };
        let given = self.given();
        let (p, q) = (given.point(site), given.point(other));
        let way = [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let unit = power_below(way.iter().fold(0.0, |most, x| most.max(x.abs())));
        let d = way.map(|x| x / unit);
        let lift = (given.weight(site) - given.weight(other)) / unit;
        (d, (dot(d, d) * unit + lift) / 2.0)
    }
}

/// The largest power of two not above a number; 1 for zero and infinity.
fn power_below(x: f64) -> f64 {
    let bits = x.to_bits();
    if x == 0.0 || !x.is_finite() {
        1.0
    } else if x.is_normal() {
        f64::from_bits(bits & !((1 << 52) - 1))
    } else {
        f64::from_bits(1 << bits.ilog2())
    }
}

/// The length of a vector with any exponents.
pub(super) fn length(v: Point3) -> f64 {
    let most = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if most == 0.0 || !most.is_finite() {
        return most;
    }
    let scaled = v.map(|x| x / most);
    most * dot(scaled, scaled).sqrt()
}

/// A point relative to another.
#[inline]
pub(super) fn seen(p: Point3, o: Point3) -> Point3 {
    [p[0] - o[0], p[1] - o[1], p[2] - o[2]]
}

/// The exponent of a number; 0 for zero and infinity.
#[inline]
pub(super) fn exponent(x: f64) -> i32 {
    if x.is_normal() {
        (x.to_bits() >> 52 & 0x7ff) as i32 - 1023
    } else if x == 0.0 || !x.is_finite() {
        0
    } else {
        x.abs().to_bits().ilog2() as i32 - 1074
    }
}

/// A number times a power of two: infinite on overflow, and on underflow nonzero, unless the number
/// is zero.
#[inline]
pub(super) fn by_power(x: f64, power: i32) -> f64 {
    let of = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
    let (mut y, mut rest) = (x, power);
    // Powers are sums of a few exponents: this ends after a few steps.
    while rest.abs() > 1000 {
        let step = rest.clamp(-1000, 1000);
        y *= of(step);
        rest -= step;
    }
    y *= of(rest);
    if y == 0.0 && x != 0.0 {
        f64::from_bits(1).copysign(x)
    } else {
        y
    }
}

/// A unit for each axis, in which the largest of some coordinates is 1 to 2, and its exponents.
/// Boxes may have any shape, so a common unit would lose the short axis of some.
#[derive(Clone, Copy)]
pub(super) struct Units {
    of: Point3,
    pub powers: [i32; 3],
}

impl Units {
    /// The units of vectors.
    #[inline]
    pub fn of(vectors: impl Iterator<Item = Point3>) -> Self {
        let most = vectors.fold([0.0; 3], |most: Point3, v| {
            [0, 1, 2].map(|k| most[k].max(v[k].abs()))
        });
        Self {
            of: most.map(power_below),
            powers: most.map(exponent),
        }
    }

    /// A vector in these units.
    #[inline]
    pub fn scaled(&self, v: Point3) -> Point3 {
        [v[0] / self.of[0], v[1] / self.of[1], v[2] / self.of[2]]
    }

    /// Converts a coordinate back from these units.
    #[inline]
    pub fn back(&self, k: usize, x: f64) -> f64 {
        x * self.of[k]
    }
}

/// The measures of a ridge, with its area multiplied by a power of two.
#[derive(Clone, Copy)]
struct Face {
    area: f64,
    power: i32,
    center: Point3,
}

/// Measures a convex polygon, counterclockwise about the unit vector `n`, by its projection along
/// the largest component of `n`.
fn polygon(corners: &[Point3], n: Point3) -> Face {
    let o = corners[0];
    let units = Units::of(corners.iter().map(|&p| seen(p, o)));
    let k = (1..3).fold(0, |k, i| if n[i].abs() > n[k].abs() { i } else { k });
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    // Twice the projected area, and the sum of its doubled triangles times three centroids.
    let (mut twice, mut moment) = (0.0, [0.0; 3]);
    let mut last = [0.0; 3];
    for &p in &corners[1..] {
        let here = units.scaled(seen(p, o));
        let part = (last[i] * here[j] - last[j] * here[i]) / n[k];
        twice += part;
        for (axis, sum) in moment.iter_mut().enumerate() {
            *sum += part * (last[axis] + here[axis]);
        }
        last = here;
    }
    if twice > 0.0 {
        return Face {
            area: twice / 2.0,
            power: units.powers[i] + units.powers[j],
            center: [0, 1, 2].map(|k| o[k] + units.back(k, moment[k] / twice / 3.0)),
        };
    }
    // As thin as rounding allows: use the mean of the corners.
    let share = 1.0 / corners.len() as f64;
    let mean = |k: usize| o[k] + corners.iter().map(|p| (p[k] - o[k]) * share).sum::<f64>();
    Face {
        area: 0.0,
        power: 0,
        center: [0, 1, 2].map(mean),
    }
}

/// Measures all cells and ridges.
pub fn measures(cells: Cells, workers: usize, watch: &Watch) -> Result<Measures> {
    let shares = |n: usize| (0..n).step_by(SHARE).map(move |i| i..n.min(i + SHARE));
    let tasks = shares(cells.sites.len()).collect();
    let faces = parallel::map_watched(workers, tasks, watch, |range: std::ops::Range<usize>| {
        let mut corners = Vec::new();
        let found = range.map(|r| face(cells, r, &mut corners));
        Ok(found.collect::<Vec<_>>())
    })?;
    let mut all: Vec<Face> = with_room(cells.sites.len())?;
    faces.into_iter().for_each(|part| all.extend(part));
    let n = cells.site.len();
    let tasks = shares(n).collect();
    let bodies = parallel::map_watched(workers, tasks, watch, |range: std::ops::Range<usize>| {
        Ok(range.map(|c| body(cells, c, &all)).collect::<Vec<_>>())
    })?;
    let mut out = Measures {
        ridge_areas: with_room(all.len())?,
        volumes: with_room(n)?,
        areas: with_room(n)?,
        centroids: filled(n, [f64::NAN; 3])?,
    };
    out.ridge_areas
        .extend(all.iter().map(|f| by_power(f.area, f.power)));
    for (slot, (volume, area, centroid)) in
        out.centroids.iter_mut().zip(bodies.into_iter().flatten())
    {
        out.volumes.push(volume);
        out.areas.push(area);
        *slot = centroid;
    }
    Ok(out)
}

/// Measures a ridge; its area is infinite if it is unbounded.
fn face(cells: Cells, ridge: usize, corners: &mut Vec<Point3>) -> Face {
    let entries = cells.entries_of(ridge);
    if entries.iter().any(|&v| v < 0) {
        return Face {
            area: f64::INFINITY,
            power: 0,
            center: [f64::NAN; 3],
        };
    }
    corners.clear();
    corners.extend(entries.iter().map(|&v| cells.vertices[v as usize]));
    let (d, _) = cells.plane(ridge, cells.sites[ridge][0]);
    let size = length(d);
    polygon(corners, d.map(|x| x / size))
}

/// Volume, surface area and centroid of a cell. Sums are kept with a common power of two, so that a
/// cell whose volume or surface area is out of range still has its centroid.
fn body(cells: Cells, cell: usize, faces: &[Face]) -> (f64, f64, Point3) {
    let site = cells.site[cell];
    let p = cells.points[site as usize];
    let mine = || cells.ridges_of(cell).iter().map(|&r| &faces[r as usize]);
    if mine().next().is_none() || mine().any(|face| face.area.is_infinite()) {
        return (f64::INFINITY, f64::INFINITY, [f64::NAN; 3]);
    }
    let height = |ridge: &i32| {
        let (d, h) = cells.plane(*ridge as usize, site);
        h / length(d)
    };
    let heights = || cells.ridges_of(cell).iter().map(height);
    let there = |face: &&Face| face.area > 0.0;
    let wide = mine()
        .filter(there)
        .map(|face| face.power)
        .max()
        .unwrap_or(0);
    let tall = heights().fold(0.0, |most: f64, h| most.max(h.abs()));
    let high = exponent(tall);
    let (mut volume, mut surface, mut moment) = (0.0, 0.0, [0.0; 3]);
    for (face, h) in mine().zip(heights()) {
        let area = by_power(face.area, face.power - wide);
        let part = area * by_power(h, -high) / 3.0;
        volume += part;
        surface += area;
        for (k, sum) in moment.iter_mut().enumerate() {
            *sum += part * (face.center[k] - p[k]) * 0.75;
        }
    }
    let surface = by_power(surface, wide);
    if volume > 0.0 {
        let center = [0, 1, 2].map(|k| p[k] + moment[k] / volume);
        return (by_power(volume, wide + high), surface, center);
    }
    (0.0, surface, p)
}
