//! Walks: the tetrahedron that contains a point, or the wall that hides it, seen from another
//! position.

use delone_predicates::{Point3, Sign, orient3d};

use super::judge::{Vector, cross, dot, minus, plus};
use super::mesh::{Mesh, NONE, Side};

/// A walk ends after this many steps: the place is too far.
const STEPS: usize = 1 << 10;

/// Where a walk ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// In a tetrahedron.
    Inside(u32),
    /// At a wall, from the inside.
    Wall(Side),
    /// The walk was abandoned.
    Nothing,
}

/// The middle of some points.
pub fn middle<const N: usize>(points: [Point3; N]) -> Point3 {
    let share = 1.0 / N as f64;
    points.iter().fold([0.0; 3], |sum, &p| plus(sum, share, p))
}

/// Walks from the middle of a tetrahedron straight to a point.
pub fn walk(mesh: &Mesh, t: u32, p: Point3) -> Found {
    let from = middle(mesh.places_of(mesh.corners[t as usize]));
    let mut t = t;
    for _ in 0..STEPS {
        // Of the faces that separate it from the point, leave through the one that the line
        // crosses first.
        let mut exit = None;
        for k in 0..4 {
            let [a, b, c] = mesh.places_of(mesh.face((t, k)));
            if orient3d(a, b, c, p) != Sign::Negative {
                continue;
            }
            let normal = cross(minus(b, a), minus(c, a));
            let (here, there) = (dot(normal, minus(from, a)), dot(normal, minus(p, a)));
            let share = here / (here - there);
            if exit.is_none_or(|(least, _)| share < least) {
                exit = Some((share, k));
            }
        }
        let Some((_, k)) = exit else {
            return Found::Inside(t);
        };
        if mesh.wall[t as usize][k] != NONE {
            return Found::Wall((t, k));
        }
        t = mesh.across[t as usize][k];
    }
    Found::Nothing
}

/// Where a walk in a facet ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OnFacet {
    /// In a wall, at a place near the one asked for and as near its plane as doubles allow.
    Wall(Side, Point3),
    /// At a segment, which is an edge of this wall.
    Segment(Side, [u32; 2]),
    /// The walk was abandoned.
    Nothing,
}

/// Walks in a facet from a wall to a point in its plane.
pub fn walk_on_facet(mesh: &Mesh, side: Side, p: Point3) -> OnFacet {
    let mut side = side;
    for _ in 0..STEPS {
        let face = mesh.face(side);
        let [a, b, c] = mesh.places_of(face);
        // The point is beyond the edge with the smallest share; if none is negative, it is here.
        let shares = barycentric([a, b, c], p);
        let (least, k) = (0..3).fold((0.0, 3), |best: (f64, usize), k| {
            if shares[k] < best.0 {
                (shares[k], k)
            } else {
                best
            }
        });
        if k == 3 {
            let place = plus(plus(a, shares[1], minus(b, a)), shares[2], minus(c, a));
            return OnFacet::Wall(side, place);
        }
        if !least.is_finite() {
            return OnFacet::Nothing;
        }
        // A segment ends the walk, and so does another facet.
        let ends = [face[(k + 1) % 3], face[(k + 2) % 3]];
        if mesh.is_segment(ends[0], ends[1]) {
            return OnFacet::Segment(side, ends);
        }
        match mesh.next_wall(side, ends) {
            Some(next) if mesh.facet_of(next) == mesh.facet_of(side) => side = next,
            _ => return OnFacet::Nothing,
        }
    }
    OnFacet::Nothing
}

/// The barycentric coordinates of a point in the plane of a triangle.
fn barycentric([a, b, c]: [Point3; 3], p: Point3) -> Vector {
    let normal = cross(minus(b, a), minus(c, a));
    let over = 1.0 / dot(normal, normal);
    let share = |x: Point3, y: Point3| dot(cross(minus(x, p), minus(y, p)), normal) * over;
    [share(b, c), share(c, a), share(a, b)]
}
