//! Concave hulls: simplices are removed from the outside, the longest edge first.
//!
//! In 2-D a triangle is removed across an edge of the boundary that is longer than a limit, unless
//! its corner opposite is on the boundary already. So the boundary stays a simple polygon, as
//! proposed by M. Duckham, L. Kulik, M. Worboys and A. Galton, "Efficient generation of simple
//! polygons for characterizing the shape of a set of points in the plane", Pattern Recognition 41
//! (2008). In 3-D a tetrahedron is removed unless it is the last one of a point. Lengths are
//! compared exactly, and equal ones by the coordinates of their ends, so that the order of rows
//! does not matter.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use delone_predicates::proximity::shorter;
use delone_predicates::{Point2, Sign};

use crate::base::arrays::Given;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// Steps between two checks for interruption.
const LOT: usize = 1 << 14;

/// The longest edge that the boundary may keep.
#[derive(Clone, Copy)]
pub enum Limit {
    /// This length.
    Length(f64),
    /// As far between the shortest and the longest edge of all simplices; 1 keeps all.
    Ratio(f64),
}

/// An edge, its smaller end first.
#[derive(Clone, Copy)]
struct Edge<const D: usize>([[f64; D]; 2]);

fn lexicographic<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Ordering {
    a.partial_cmp(b).unwrap_or(Ordering::Equal)
}

impl<const D: usize> Edge<D> {
    fn new(a: [f64; D], b: [f64; D]) -> Self {
        match lexicographic(&a, &b) {
            Ordering::Greater => Self([b, a]),
            _ => Self([a, b]),
        }
    }

    /// The order of lengths, and of the ends of equally long edges.
    fn order(&self, other: &Self) -> Ordering {
        let ([a, b], [c, d]) = (self.0, other.0);
        match shorter(a, b, c, d) {
            Sign::Positive => Ordering::Less,
            Sign::Negative => Ordering::Greater,
            Sign::Zero => lexicographic(&a, &c).then_with(|| lexicographic(&b, &d)),
        }
    }

    fn is_longer(&self, limit: f64) -> bool {
        let mut end = [0.0; D];
        end[0] = limit;
        limit.is_finite() && shorter([0.0; D], end, self.0[0], self.0[1]) == Sign::Positive
    }

    /// The length, rounded.
    fn length(&self) -> f64 {
        let [a, b] = self.0;
        (0..D).fold(0.0_f64, |sum, k| sum.hypot(b[k] - a[k]))
    }
}

/// A facet at the boundary: its longest edge, what tells it from others with that, and where it is.
struct Facet<const D: usize> {
    edge: Edge<D>,
    tip: [f64; D],
    at: (u32, u32),
}

impl<const D: usize> Ord for Facet<D> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.edge
            .order(&other.edge)
            .then_with(|| lexicographic(&self.tip, &other.tip))
    }
}

impl<const D: usize> PartialOrd for Facet<D> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const D: usize> PartialEq for Facet<D> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<const D: usize> Eq for Facet<D> {}

/// A heap that reports refused memory.
struct Queue<T>(BinaryHeap<T>);

impl<T: Ord> Queue<T> {
    fn push(&mut self, item: T) -> Result<()> {
        if self.0.len() == self.0.capacity() {
            let bytes = (2 * self.0.len() + 64).saturating_mul(size_of::<T>());
            self.0
                .try_reserve(self.0.len() + 64)
                .map_err(|_| Error::Memory { bytes })?;
        }
        self.0.push(item);
        Ok(())
    }
}

/// The limit as a length.
fn length<const D: usize, const N: usize>(
    limit: Limit,
    points: &[[f64; D]],
    simplices: &[[i32; N]],
    pace: &mut Pace<'_>,
) -> Result<f64> {
    let ratio = match limit {
        Limit::Length(length) => return Ok(length),
        Limit::Ratio(ratio) if ratio <= 0.0 => return Ok(0.0),
        Limit::Ratio(ratio) if ratio >= 1.0 => return Ok(f64::INFINITY),
        Limit::Ratio(ratio) => ratio,
    };
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for corners in simplices {
        pace.spend(1)?;
        for i in 0..N {
            for j in 0..i {
                let [a, b] = [i, j].map(|k| points[corners[k] as usize]);
                let found = Edge::new(a, b).length();
                (least, most) = (least.min(found), most.max(found));
            }
        }
    }
    Ok(least + ratio * (most - least))
}

/// Triangles from which a concave hull is dug.
struct Erosion<'a> {
    points: &'a [Point2],
    simplices: &'a [[i32; 3]],
    neighbors: &'a [[i32; 3]],
    limit: f64,
    is_kept: Vec<bool>,
    /// Whether a point is on the boundary.
    is_bare: Vec<bool>,
    queue: Queue<Facet<2>>,
}

/// Which triangles remain: one polygon, with holes if requested.
pub fn erode2(given: Given<2, 3>, limit: Limit, holes: bool, watch: &Watch) -> Result<Vec<bool>> {
    let Given {
        points,
        simplices,
        neighbors,
    } = given;
    let mut pace = Pace::new(watch, LOT);
    let mut erosion = Erosion {
        points,
        simplices,
        neighbors,
        limit: length(limit, points, simplices, &mut pace)?,
        is_kept: filled(simplices.len(), true)?,
        is_bare: filled(points.len(), false)?,
        queue: Queue(BinaryHeap::new()),
    };
    for (t, beyond) in neighbors.iter().enumerate() {
        pace.spend(1)?;
        for k in (0..3).filter(|&k| beyond[k] < 0) {
            erosion.bare(t, k)?;
        }
    }
    erosion.run(&mut pace)?;
    if holes {
        for t in erosion.seeds(&mut pace)? {
            pace.spend(1)?;
            if erosion.is_kept[t] && !simplices[t].iter().any(|&v| erosion.is_bare[v as usize]) {
                erosion.remove(t)?;
                erosion.run(&mut pace)?;
            }
        }
    }
    Ok(erosion.is_kept)
}

impl Erosion<'_> {
    fn edge(&self, t: usize, k: usize) -> Edge<2> {
        let [a, b] = [1, 2].map(|i| self.points[self.simplices[t][(k + i) % 3] as usize]);
        Edge::new(a, b)
    }

    /// Notes that an edge of a triangle is on the boundary.
    fn bare(&mut self, t: usize, k: usize) -> Result<()> {
        for i in [1, 2] {
            self.is_bare[self.simplices[t][(k + i) % 3] as usize] = true;
        }
        let edge = self.edge(t, k);
        if !edge.is_longer(self.limit) {
            return Ok(());
        }
        self.queue.push(Facet {
            edge,
            tip: edge.0[0],
            at: (t as u32, k as u32),
        })
    }

    /// Removes a triangle, which exposes those around it.
    fn remove(&mut self, t: usize) -> Result<()> {
        self.is_kept[t] = false;
        for k in 0..3 {
            let Ok(n) = usize::try_from(self.neighbors[t][k]) else {
                continue;
            };
            if self.is_kept[n] {
                let back = (0..3).find(|&j| self.neighbors[n][j] == t as i32);
                self.bare(n, back.unwrap_or(0))?;
            }
        }
        Ok(())
    }

    fn run(&mut self, pace: &mut Pace<'_>) -> Result<()> {
        while let Some(facet) = self.queue.0.pop() {
            pace.spend(1)?;
            let (t, k) = (facet.at.0 as usize, facet.at.1 as usize);
            let apex = self.simplices[t][k] as usize;
            // With a second edge on the boundary, the corner opposite this one is there, too.
            if self.is_kept[t] && !self.is_bare[apex] {
                self.remove(t)?;
            }
        }
        Ok(())
    }

    /// Triangles with an edge above the limit, the longest first.
    fn seeds(&self, pace: &mut Pace<'_>) -> Result<Vec<usize>> {
        let mut found: Vec<Facet<2>> = Vec::new();
        for t in 0..self.simplices.len() {
            pace.spend(1)?;
            let edges = [0, 1, 2].map(|k| (self.edge(t, k), k));
            let longest = edges.into_iter().max_by(|a, b| a.0.order(&b.0));
            let Some((edge, k)) = longest.filter(|(edge, _)| edge.is_longer(self.limit)) else {
                continue;
            };
            if self.is_kept[t] {
                // Two triangles may have their longest edge in common.
                let tip = self.points[self.simplices[t][k] as usize];
                let at = (t as u32, k as u32);
                push(&mut found, Facet { edge, tip, at })?;
            }
        }
        found.sort_unstable_by(|a, b| b.cmp(a));
        let mut seeds = with_room(found.len())?;
        seeds.extend(found.iter().map(|facet| facet.at.0 as usize));
        Ok(seeds)
    }
}

/// Which tetrahedra remain; every point keeps one.
pub fn erode3(given: Given<3, 4>, limit: Limit, watch: &Watch) -> Result<Vec<bool>> {
    let Given {
        points,
        simplices,
        neighbors,
    } = given;
    let mut pace = Pace::new(watch, LOT);
    let limit = length(limit, points, simplices, &mut pace)?;
    let mut is_kept = filled(simplices.len(), true)?;
    let mut uses = filled(points.len(), 0_u32)?;
    for corners in simplices {
        pace.spend(1)?;
        corners.iter().for_each(|&v| uses[v as usize] += 1);
    }
    let facet = |t: usize, k: usize| {
        let mut at = [0, 1, 2].map(|i| points[simplices[t][i + usize::from(i >= k)] as usize]);
        at.sort_unstable_by(lexicographic);
        let edges = [(0, 1, 2), (0, 2, 1), (1, 2, 0)];
        let named = edges.map(|(i, j, tip)| (Edge::new(at[i], at[j]), at[tip]));
        let longest = named.into_iter().max_by(|a, b| a.0.order(&b.0));
        let (edge, tip) = longest.unwrap_or((Edge::new(at[0], at[1]), at[2]));
        let at = (t as u32, k as u32);
        edge.is_longer(limit).then_some(Facet { edge, tip, at })
    };
    let mut queue = Queue(BinaryHeap::new());
    for (t, beyond) in neighbors.iter().enumerate() {
        pace.spend(1)?;
        let bare = (0..4).filter(|&k| beyond[k] < 0);
        for found in bare.filter_map(|k| facet(t, k)) {
            queue.push(found)?;
        }
    }
    while let Some(found) = queue.0.pop() {
        pace.spend(1)?;
        let t = found.at.0 as usize;
        let is_last = simplices[t].iter().any(|&v| uses[v as usize] == 1);
        if !is_kept[t] || is_last {
            continue;
        }
        is_kept[t] = false;
        simplices[t].iter().for_each(|&v| uses[v as usize] -= 1);
        for n in neighbors[t].iter().filter_map(|&n| usize::try_from(n).ok()) {
            let back = (0..4).find(|&j| neighbors[n][j] == t as i32).unwrap_or(0);
            if let (true, Some(found)) = (is_kept[n], facet(n, back)) {
                queue.push(found)?;
            }
        }
    }
    Ok(is_kept)
}
