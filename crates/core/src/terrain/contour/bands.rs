//! The bands between levels as polygons with holes.
//!
//! Band b consists of what is above level b - 1 and not above level b, so that b is the rank of the
//! vertices in it. Its boundary consists of contours and of pieces of the outline. A *piece* is the
//! part of a triangle in one band; pieces that share a part of an edge with a length, or have only a
//! collapsed piece of another band between them, belong together. Together they have one ring around them, and each further ring is a hole of that one:
//! no search for the polygon of a hole is needed.

use delone_predicates::lexicographic;

use super::edges::{Edges, Local};
use super::lines::each_chord;
use super::link::{Edge, is_counterclockwise, link, rotate};
use super::nodes::{Nodes, SHARE};
use super::untangle::untangle;
use crate::base::arrays::Triangles;
use crate::base::error::Result;
use crate::base::memory::{make_room, push, with_room};
use crate::base::parallel::map_watched;
use crate::base::sets::Sets;
use crate::base::watch::Watch;
use delone_predicates::Point2;

/// Polygons as runs of rings, which are runs of coordinates.
#[derive(Debug, Default)]
pub struct Bands {
    /// Triangles in which contours would cross; if there are any, there is nothing else.
    pub tangled: Vec<i32>,
    /// Coordinates of all rings. Each ends with its first point.
    pub points: Vec<Point2>,
    /// The start of each ring in `points`, and the end of the last.
    pub rings: Vec<i64>,
    /// The start of each polygon in the rings: counterclockwise, then its holes.
    pub polygons: Vec<i64>,
    /// The band of each polygon, ascending: 0 is below all levels.
    pub bands: Vec<i32>,
}

/// A ring in the list of places of a band.
struct Ring {
    piece: u32,
    hole: bool,
    start: usize,
    end: usize,
}

/// The bands of ascending `levels`. For `collapsed` see `Nodes::new`, for `far` see `untangle`.
pub fn bands(
    given: Triangles,
    heights: &[f64],
    (levels, collapsed): (&[f64], &[bool]),
    far: bool,
    limit: usize,
    (workers, watch): (usize, &Watch),
) -> Result<Bands> {
    let threads = (workers, watch);
    let mut nodes = Nodes::new(given, heights, (levels, collapsed), limit, threads)?;
    let tangled = untangle(&mut nodes, far, threads)?;
    if !tangled.is_empty() {
        return Ok(Bands {
            tangled,
            ..Bands::default()
        });
    }
    let mut pieces = Pieces::new(&nodes, watch)?;
    let count = levels.len() as u32 + 1;
    let edges = Edges::collect(&nodes, count as usize, threads, |t, side| {
        each_side(&nodes, &pieces, t, side);
    })?;
    let linked = map_watched(workers, (0..count).collect(), watch, |band| {
        Linked::of(&nodes, edges.group(band)?)
    })?;
    drop(edges);
    let mut found = Bands::default();
    push(&mut found.rings, 0)?;
    push(&mut found.polygons, 0)?;
    for (band, mut linked) in linked.into_iter().enumerate() {
        watch.check()?;
        for [a, b] in linked.joined {
            pieces.sets.join(a, b);
        }
        for ring in &mut linked.rings {
            ring.piece = pieces.sets.root(ring.piece);
        }
        found.add(&nodes, &linked.places, linked.rings, band as i32)?;
    }
    Ok(found)
}

/// The rings of a band, and the owners of edges that were dropped.
struct Linked {
    places: Vec<u32>,
    rings: Vec<Ring>,
    joined: Vec<[u32; 2]>,
}

impl Linked {
    fn of(nodes: &Nodes, mut edges: Vec<Edge>) -> Result<Self> {
        let Local { places, at } = Local::of(nodes, &mut edges)?;
        let (mut rings, mut numbers) = (Vec::new(), Vec::new());
        let joined = link(&at, &edges, |line, piece| {
            // What bounds a region is closed.
            if line.first() != line.last() {
                return Ok(());
            }
            let start = numbers.len();
            make_room(&mut numbers, line.len())?;
            numbers.extend_from_slice(line);
            rotate(&at, &mut numbers[start..]);
            let ring = Ring {
                piece,
                hole: !is_counterclockwise(&at, &numbers[start..]),
                start,
                end: numbers.len(),
            };
            push(&mut rings, ring)
        })?;
        numbers
            .iter_mut()
            .for_each(|number| *number = places[*number as usize]);
        Ok(Self {
            places: numbers,
            rings,
            joined,
        })
    }
}

impl Bands {
    /// Adds the polygons of a band in the order of their first points.
    fn add(
        &mut self,
        nodes: &Nodes,
        places: &[u32],
        mut rings: Vec<Ring>,
        band: i32,
    ) -> Result<()> {
        let at = |ring: &Ring| [ring.start, ring.start + 1].map(|k| nodes.at(places[k]));
        rings.sort_by(|a, b| {
            let ([p, q], [r, s]) = (at(a), at(b));
            lexicographic(p, r).then_with(|| lexicographic(q, s))
        });
        // The outer ring of each set of pieces comes first; stable, so that holes keep their order.
        let mut rank: Vec<(u32, u32)> = with_room(rings.len())?;
        rank.extend(
            rings
                .iter()
                .enumerate()
                .filter(|(_, ring)| !ring.hole)
                .map(|(k, ring)| (ring.piece, k as u32)),
        );
        rank.sort_unstable();
        rings.sort_by_cached_key(|ring| {
            let found = rank.binary_search_by_key(&ring.piece, |each| each.0);
            (found.map_or(u32::MAX, |k| rank[k].1), ring.hole)
        });
        make_room(&mut self.points, places.len())?;
        for (k, ring) in rings.iter().enumerate() {
            if !ring.hole && k > 0 {
                push(&mut self.polygons, self.rings.len() as i64 - 1)?;
            }
            if !ring.hole {
                push(&mut self.bands, band)?;
            }
            let run = &places[ring.start..ring.end];
            self.points.extend(run.iter().map(|&place| nodes.at(place)));
            push(&mut self.rings, self.points.len() as i64)?;
        }
        if !rings.is_empty() {
            push(&mut self.polygons, self.rings.len() as i64 - 1)?;
        }
        Ok(())
    }
}

/// The pieces of triangles in bands, and which belong together.
struct Pieces {
    /// The first piece of each triangle: one for each rank from the lowest to the highest.
    first: Vec<u32>,
    sets: Sets,
}

impl Pieces {
    fn new(nodes: &Nodes, watch: &Watch) -> Result<Self> {
        let mut first = with_room(nodes.triangles())?;
        let mut count = 0;
        for t in 0..nodes.triangles() {
            let [lowest, highest] = nodes.span(t);
            first.push(count);
            count += highest - lowest + 1;
        }
        let sets = Sets::of(count as usize)?;
        let mut pieces = Self { first, sets };
        for t in 0..nodes.triangles() {
            if t.is_multiple_of(SHARE) {
                watch.check()?;
            }
            for k in 0..3 {
                if let Some((u, _)) = nodes.twin(t, k).filter(|&(u, _)| u < t) {
                    along(nodes, t, k, |band, from, to| {
                        if from != to {
                            let [a, b] = [t, u].map(|t| pieces.of(nodes, t, band));
                            pieces.sets.join(a, b);
                        }
                    });
                }
            }
        }
        Ok(pieces)
    }

    /// The piece of a triangle in a band.
    fn of(&self, nodes: &Nodes, t: usize, band: u32) -> u32 {
        self.first[t] + band - nodes.span(t)[0]
    }
}

/// Calls `part` with the part of an edge in each band, from end to end with the triangle to its
/// left: the band and both representatives, which may be the same.
fn along(nodes: &Nodes, t: usize, k: usize, mut part: impl FnMut(u32, u32, u32)) {
    let [a, b] = nodes.ends(t, k);
    let [from, to] = [a, b].map(|v| nodes.rank(v));
    let mut last = a;
    if from <= to {
        for band in from..to {
            let node = nodes.find(nodes.node(t, k, band));
            part(band, last, node);
            last = node;
        }
    } else {
        for band in (to..from).rev() {
            let node = nodes.find(nodes.node(t, k, band));
            part(band + 1, last, node);
            last = node;
        }
    }
    part(to, last, b);
}

/// Calls `side` with each edge in a triangle that has a length and its band to the left: both directions
/// of each contour, once for the band above it and once for the band below, and parts of the outline.
fn each_side(nodes: &Nodes, pieces: &Pieces, t: usize, side: &mut dyn FnMut(u32, Edge)) {
    let (first, [lowest, _]) = (pieces.first[t], nodes.span(t));
    if let Some(crossed) = nodes.crossed(t) {
        each_chord(nodes, &crossed, |level, from, to| {
            let owner = first + level - lowest;
            let above = Edge {
                from,
                to,
                owner: owner + 1,
            };
            side(level + 1, above);
            let below = Edge {
                from: to,
                to: from,
                owner,
            };
            side(level, below);
        });
    }
    for k in 0..3 {
        if nodes.twin(t, k).is_none() {
            along(nodes, t, k, |band, from, to| {
                if from != to {
                    let owner = first + band - lowest;
                    side(band, Edge { from, to, owner });
                }
            });
        }
    }
}
