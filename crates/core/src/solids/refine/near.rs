//! Facets that are flat up to a distance: parts in one plane whose vertices are all near the plane of
//! the largest part.

use std::cmp::Reverse;

use super::judge::{Vector, cross, distance, dot, minus};
use super::mesh::{Mesh, Side};
use super::repeated;
use crate::base::error::Result;
use crate::base::memory::{push, with_room};
use crate::base::sets::Sets;

/// A wall at an edge: the edge, the wall's number, its third vertex, and a side of it.
pub type AtEdge = ([u32; 2], u32, u32, Side);

/// Walls are joined with a plane if the cosine of the angle between them is above this.
const LEVEL: f64 = 0.85;

/// Two walls at an edge that has no other wall.
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    pub walls: [u32; 2],
    /// Whether they are in one facet without a tolerance.
    pub exact: bool,
    /// Whether they are on opposite sides of the edge.
    pub opposite: bool,
    /// Whether both pass the edge in the same direction, as they are oriented here.
    pub turned: bool,
}

/// What is known of a wall.
#[derive(Debug, Clone, Copy, Default)]
struct Wall {
    corners: [u32; 3],
    /// The normal, as long as twice the area.
    normal: Vector,
    area: f64,
    /// Whether it is a cap: lower than the distance between two planes at the tolerance, with longer
    /// edges. Its direction means nothing.
    cap: bool,
}

/// The search for facets.
struct Search<'a> {
    mesh: &'a Mesh,
    tolerance: f64,
    walls: Vec<Wall>,
    /// The exact facet of each wall, and the walls of each, in a row.
    facet: Vec<u32>,
    rows: Vec<(u32, u32)>,
    /// Pairs by either wall: the wall, the other one, whether the facet may go on there, and `exact`
    /// and `turned`.
    beside: Vec<(u32, u32, bool, bool, bool)>,
    /// 1 or -1: the direction of a wall as seen from the seed; 0 until it is reached.
    sign: Vec<i8>,
}

/// The plane of the largest wall of a facet.
struct Plane<'a> {
    origin: &'a [f64; 3],
    normal: Vector,
}

/// Joins exact facets that are neighbors, the largest first: a facet joins that of another if all of
/// its vertices are within the tolerance of the other's plane, and all of its walls but caps face the
/// same direction, as the surface goes on there. So all vertices of a joined facet are within the
/// tolerance of one plane, however many parts it has, and it is not folded: the two sides of a sheet
/// that is thinner than the tolerance are not joined around its rim.
pub fn join(
    mesh: &Mesh,
    at: &[AtEdge],
    pairs: &[Pair],
    sets: &mut Sets,
    tolerance: f64,
) -> Result<()> {
    let mut search = Search::new(mesh, at, pairs, sets, tolerance)?;
    let mut taken = repeated(mesh.facet.len(), false)?;
    for seed in search.order(sets)? {
        if taken[seed as usize] {
            continue;
        }
        taken[seed as usize] = true;
        let largest = search.rows_of(seed).iter().map(|row| row.1).reduce(|a, b| {
            let area = |w: u32| search.walls[w as usize].area;
            if area(b) > area(a) { b } else { a }
        });
        let Some(largest) = largest else { continue };
        let wall = search.walls[largest as usize];
        if wall.area <= 0.0 {
            continue;
        }
        let plane = Plane {
            origin: &mesh.points[wall.corners[0] as usize],
            normal: wall.normal.map(|x| x / wall.area),
        };
        // All walls that are reached, with their directions; facets are taken as a whole.
        let mut reached: Vec<u32> = Vec::new();
        search.spread(largest, 1, &plane, &mut reached)?;
        let mut next = 0;
        while let Some(&w) = reached.get(next) {
            next += 1;
            let first = search.beside.partition_point(|b| b.0 < w);
            let mut i = first;
            while let Some(&(_, u, open, _, turned)) = search.beside.get(i).filter(|b| b.0 == w) {
                i += 1;
                let other = search.facet[u as usize];
                if !open || taken[other as usize] || !search.is_near(other, &plane) {
                    continue;
                }
                let sign = if turned {
                    -search.sign[w as usize]
                } else {
                    search.sign[w as usize]
                };
                if search.spread(u, sign, &plane, &mut reached)? {
                    taken[other as usize] = true;
                    sets.join(seed, other);
                }
            }
        }
    }
    Ok(())
}

impl<'a> Search<'a> {
    fn new(
        mesh: &'a Mesh,
        at: &[AtEdge],
        pairs: &[Pair],
        sets: &mut Sets,
        tolerance: f64,
    ) -> Result<Self> {
        let count = mesh.facet.len();
        let mut walls = repeated(count, Wall::default())?;
        let mut rows = with_room(at.len() / 3)?;
        for &(ends, wall, third, side) in at {
            // Each wall has three edges, and comes once.
            if third < ends[1] {
                continue;
            }
            rows.push((sets.root(wall), wall));
            let corners = mesh.face(side);
            let [a, b, c] = mesh.places_of(corners);
            let sides = [distance(a, b), distance(b, c), distance(c, a)];
            let longest = sides.into_iter().fold(0.0, f64::max);
            let shortest = sides.into_iter().fold(f64::INFINITY, f64::min);
            let normal = cross(minus(b, a), minus(c, a));
            let area = dot(normal, normal).sqrt();
            let cap = area <= 2.0 * tolerance * longest && shortest > 2.0 * tolerance;
            walls[wall as usize] = Wall {
                corners,
                normal,
                area,
                cap,
            };
        }
        rows.sort_unstable();
        let mut beside = with_room(2 * pairs.len())?;
        for pair in pairs {
            let [i, j] = pair.walls;
            let caps = walls[i as usize].cap || walls[j as usize].cap;
            let open = pair.exact || pair.opposite || caps;
            beside.push((i, j, open, pair.exact, pair.turned));
            beside.push((j, i, open, pair.exact, pair.turned));
        }
        beside.sort_unstable();
        let mut facet = with_room(count)?;
        facet.extend((0..count as u32).map(|row| sets.root(row)));
        let sign = repeated(count, 0)?;
        Ok(Self {
            mesh,
            tolerance,
            walls,
            facet,
            rows,
            beside,
            sign,
        })
    }

    /// The walls of an exact facet, with its number.
    fn rows_of(&self, facet: u32) -> &[(u32, u32)] {
        let first = self.rows.partition_point(|row| row.0 < facet);
        let last = self.rows.partition_point(|row| row.0 <= facet);
        &self.rows[first..last]
    }

    /// The exact facets by descending area.
    fn order(&self, sets: &mut Sets) -> Result<Vec<u32>> {
        let mut area = repeated(self.walls.len(), 0.0)?;
        let mut order: Vec<u32> = with_room(self.rows.len())?;
        for &(facet, wall) in &self.rows {
            area[facet as usize] += self.walls[wall as usize].area;
            debug_assert_eq!(sets.root(wall), facet);
            order.push(facet);
        }
        order.dedup();
        order.sort_by(|&a, &b| {
            let of = |f: u32| (area[f as usize], Reverse(f));
            of(b).partial_cmp(&of(a)).unwrap_or(a.cmp(&b))
        });
        Ok(order)
    }

    /// Whether all vertices of an exact facet are within the tolerance of a plane.
    fn is_near(&self, facet: u32, plane: &Plane) -> bool {
        self.rows_of(facet).iter().all(|&(_, wall)| {
            let places = self.mesh.places_of(self.walls[wall as usize].corners);
            let off = places.map(|p| dot(plane.normal, minus(p, *plane.origin)).abs());
            off.into_iter().all(|x| x <= self.tolerance)
        })
    }

    /// Gives directions to all walls of an exact facet, from one of them on; false, without a
    /// change, if a wall would face away from the plane.
    fn spread(
        &mut self,
        wall: u32,
        sign: i8,
        plane: &Plane,
        reached: &mut Vec<u32>,
    ) -> Result<bool> {
        let before = reached.len();
        self.sign[wall as usize] = sign;
        push(reached, wall)?;
        let mut next = before;
        let mut faces = true;
        while let Some(&w) = reached.get(next) {
            next += 1;
            let Wall {
                normal, area, cap, ..
            } = self.walls[w as usize];
            let along = f64::from(self.sign[w as usize]) * dot(normal, plane.normal);
            faces &= cap || along > LEVEL * area;
            let first = self.beside.partition_point(|b| b.0 < w);
            let rest = self.beside[first..].iter().take_while(|b| b.0 == w);
            for &(_, u, _, exact, turned) in rest {
                if exact && self.sign[u as usize] == 0 {
                    let own = self.sign[w as usize];
                    self.sign[u as usize] = if turned { -own } else { own };
                    push(reached, u)?;
                }
            }
        }
        if !faces {
            for w in reached.drain(before..) {
                self.sign[w as usize] = 0;
            }
        }
        Ok(faces)
    }
}
