//! How two triangles in 3-D cross or touch, exactly.
//!
//! Two triangles may share vertices and edges; everything else that they have in common is a
//! contact. What they have in common is convex: a point, a segment or, in one plane, a polygon. Its
//! corners are vertices of one triangle on the other, or points where an edge crosses the other
//! triangle or one of its edges. Hence a contact is a set of such events, each decided by
//! `orient3d`, or by `orient2d` in a projection along an axis, which keeps what lies in one plane
//! in order.

use delone_predicates::stages;
use delone_predicates::{Point2, Point3, Sign, orient2d, orient3d, orient3d_exact};

/// The kinds of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    /// The interiors of the triangles cross.
    Crossing,
    /// Two edges cross at a point that is a vertex of neither.
    EdgeOnEdge,
    /// A vertex of one is in the interior of the other.
    VertexInFace,
    /// A vertex of one is inside an edge of the other.
    VertexOnEdge,
    /// They overlap in one plane.
    Overlap,
    /// They share an edge, and overlap because both are on the same side of it.
    Folded,
}

/// The number of kinds.
pub const KINDS: usize = 6;

/// Where a vertex of one triangle is on the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Not on it.
    Off,
    /// At a corner.
    Corner,
    /// Inside the edge from this corner to the next.
    Edge(usize),
    /// In the interior.
    Inside,
}

/// A triangle that is not degenerate.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    /// Its vertices: equal coordinates have equal numbers.
    pub ids: [u32; 3],
    /// Their coordinates.
    pub at: [Point3; 3],
}

/// What two triangles have in common beyond shared vertices and edges.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// The kind.
    pub kind: Kind,
    /// Whether they meet at a point that is a vertex of neither, or their interiors cross: then
    /// subdividing at vertices does not make them conforming.
    pub crossing: bool,
    /// Where the vertices of the first are on the second.
    pub first: [Place; 3],
    /// Where the vertices of the second are on the first.
    pub second: [Place; 3],
}

/// The events of a contact.
#[derive(Debug, Clone, Copy, Default)]
struct Events {
    pierced: bool,
    /// The number of crossings of two edges.
    edges: usize,
    inside: bool,
    on_edge: bool,
}

impl Events {
    fn note(&mut self, place: Place) {
        match place {
            Place::Inside => self.inside = true,
            Place::Edge(_) => self.on_edge = true,
            Place::Off | Place::Corner => {}
        }
    }

    /// The kind, unless there are no events.
    fn kind(self) -> Option<Kind> {
        let kinds = [
            (self.pierced, Kind::Crossing),
            (self.edges > 0, Kind::EdgeOnEdge),
            (self.inside, Kind::VertexInFace),
            (self.on_edge, Kind::VertexOnEdge),
        ];
        kinds
            .iter()
            .find(|(event, _)| *event)
            .map(|&(_, kind)| kind)
    }
}

/// A projection that keeps a plane in order: the axes that remain, and the orientation of a
/// triangle in that plane.
#[derive(Debug, Clone, Copy)]
pub struct Projection {
    axes: (usize, usize),
    /// The orientation of the projected triangle.
    pub turn: Sign,
}

impl Projection {
    /// The first projection along an axis in which the triangle is not flat: the same for all
    /// triangles of one plane. `None` if the corners are collinear.
    pub fn of([a, b, c]: [Point3; 3]) -> Option<Self> {
        PROJECTIONS.into_iter().find_map(|(j, k)| {
            let turn = orient2d([a[j], a[k]], [b[j], b[k]], [c[j], c[k]]);
            (!turn.is_zero()).then_some(Self { axes: (j, k), turn })
        })
    }

    /// A point, projected.
    #[inline]
    pub fn of_point(&self, p: Point3) -> Point2 {
        [p[self.axes.0], p[self.axes.1]]
    }

    fn of_triangle(&self, t: &Triangle) -> [Point2; 3] {
        t.at.map(|p| self.of_point(p))
    }
}

/// The axes of the projections along an axis.
const PROJECTIONS: [(usize, usize); 3] = [(0, 1), (2, 0), (1, 2)];

/// The corners of each edge.
const EDGES: [(usize, usize); 3] = [(0, 1), (1, 2), (2, 0)];

/// How two triangles that do not have all vertices in common cross or touch; `None` if they have
/// nothing in common but shared vertices or a shared edge.
pub fn contact(a: &Triangle, b: &Triangle) -> Option<Contact> {
    let shared_a = shared(a, b);
    let rough = rough_sides(a, shared_a, b);
    if rough.contains(&None) && (is_beside(a, b) || is_beside(b, a)) {
        return None;
    }
    let of_a = sides(a, rough, b);
    if apart(of_a, shared_a) {
        return None;
    }
    if of_a == [Sign::Zero; 3] {
        return in_one_plane(a, b);
    }
    let shared_b = shared(b, a);
    let of_b = sides(b, rough_sides(b, shared_b, a), a);
    if apart(of_b, shared_b) {
        return None;
    }
    in_two_planes(a, b, of_a, of_b)
}

/// Which vertices of `a` are also vertices of `b`.
#[inline]
fn shared(a: &Triangle, b: &Triangle) -> [bool; 3] {
    let [p, q, r] = b.ids;
    let [x, y, z] = a.ids;
    let is = |v: u32| v == p || v == q || v == r;
    [is(x), is(y), is(z)]
}

/// The sides of the plane of `b` on which the vertices of `a` are, where a filter decides. Exact
/// answers for coplanar points take a hundred times as long.
fn rough_sides(a: &Triangle, shared: [bool; 3], b: &Triangle) -> [Option<Sign>; 3] {
    let [p, q, r] = b.at;
    let mut found = [Some(Sign::Zero); 3];
    for i in 0..3 {
        if !shared[i] {
            found[i] = stages::orient3d::filter(p, q, r, a.at[i]);
        }
    }
    found
}

/// Whether filters prove, in a projection along an axis, that the line along an edge of `a`
/// separates `b` from it: all vertices of `b` are strictly beyond, except for common ends of the
/// edge. Then `b` has only these, and what is between them, above the line.
fn is_beside(a: &Triangle, b: &Triangle) -> bool {
    PROJECTIONS.into_iter().any(|(j, k)| {
        let flat_a = a.at.map(|p| [p[j], p[k]]);
        let [p, q, r] = flat_a;
        let Some(turn) = stages::orient2d::filter(p, q, r) else {
            return false;
        };
        EDGES.iter().any(|&(x, y)| {
            (0..3).all(|i| match a.ids.iter().position(|&v| v == b.ids[i]) {
                Some(at) => at == x || at == y,
                None => {
                    let point = [b.at[i][j], b.at[i][k]];
                    stages::orient2d::filter(flat_a[x], flat_a[y], point) == Some(-turn)
                }
            })
        })
    })
}

/// All of them, exactly.
fn sides(a: &Triangle, rough: [Option<Sign>; 3], b: &Triangle) -> [Sign; 3] {
    let [p, q, r] = b.at;
    let exact = |i: usize| rough[i].unwrap_or_else(|| orient3d_exact(p, q, r, a.at[i]));
    [exact(0), exact(1), exact(2)]
}

/// Whether all vertices that are not shared are strictly on one side.
fn apart(of: [Sign; 3], shared: [bool; 3]) -> bool {
    let all = |side: Sign| (0..3).all(|i| shared[i] || of[i] == side);
    all(Sign::Positive) || all(Sign::Negative)
}

/// The contact of triangles in one plane.
fn in_one_plane(a: &Triangle, b: &Triangle) -> Option<Contact> {
    let plane = Projection::of(b.at)?;
    let (flat_a, flat_b) = (plane.of_triangle(a), plane.of_triangle(b));
    let [p, q, r] = flat_a;
    let turn_a = orient2d(p, q, r);
    let overlap = !separated(flat_a, turn_a, flat_b) && !separated(flat_b, plane.turn, flat_a);
    let first = places(a, flat_a, b, flat_b, plane.turn, [true; 3]);
    let second = places(b, flat_b, a, flat_a, turn_a, [true; 3]);
    let mut events = Events::default();
    first.iter().chain(&second).for_each(|&p| events.note(p));
    let mut crossed = EDGES.iter().flat_map(|e| EDGES.map(|f| (e, f)));
    let crosses = overlap
        && crossed.any(|(e, f)| cross([flat_a[e.0], flat_a[e.1]], [flat_b[f.0], flat_b[f.1]]));
    events.edges = usize::from(crosses);
    let shared = first.iter().filter(|p| **p == Place::Corner).count();
    let kind = match (overlap, shared) {
        (true, 2) => Kind::Folded,
        (true, _) => Kind::Overlap,
        (false, _) => events.kind()?,
    };
    Some(Contact {
        kind,
        crossing: crosses,
        first,
        second,
    })
}

/// Whether a line along an edge of `a`, which has the orientation `turn`, has the interiors of both
/// triangles on different sides. If they are disjoint, an edge of one of them is such a line.
fn separated(a: [Point2; 3], turn: Sign, b: [Point2; 3]) -> bool {
    EDGES.iter().any(|&(i, j)| {
        b.iter()
            .all(|&p| orient2d(a[i], a[j], p) * turn != Sign::Positive)
    })
}

/// Where the vertices of `a` that are in the plane of `b` are on `b`.
fn places(
    a: &Triangle,
    flat_a: [Point2; 3],
    b: &Triangle,
    flat_b: [Point2; 3],
    turn: Sign,
    in_plane: [bool; 3],
) -> [Place; 3] {
    [0, 1, 2].map(|i| {
        if b.ids.contains(&a.ids[i]) {
            Place::Corner
        } else if in_plane[i] {
            place(flat_a[i], flat_b, turn)
        } else {
            Place::Off
        }
    })
}

/// Where a point that is not a corner is on a triangle of the orientation `turn`.
fn place(p: Point2, t: [Point2; 3], turn: Sign) -> Place {
    let mut found = Place::Inside;
    for (k, (i, j)) in EDGES.into_iter().enumerate() {
        match orient2d(t[i], t[j], p) * turn {
            Sign::Negative => return Place::Off,
            Sign::Zero => found = Place::Edge(k),
            Sign::Positive => {}
        }
    }
    found
}

/// Whether two segments cross at a point that is an end of neither.
fn cross([p, q]: [Point2; 2], [r, s]: [Point2; 2]) -> bool {
    orient2d(p, q, r) * orient2d(p, q, s) == Sign::Negative
        && orient2d(r, s, p) * orient2d(r, s, q) == Sign::Negative
}

/// The contact of triangles in different planes, whose vertices are on these sides of the other's.
fn in_two_planes(a: &Triangle, b: &Triangle, of_a: [Sign; 3], of_b: [Sign; 3]) -> Option<Contact> {
    let (mut events, mut others) = (Events::default(), Events::default());
    let first = meet(a, of_a, b, &mut events)?;
    let second = meet(b, of_b, a, &mut others)?;
    // Both have seen the same crossings of edges.
    events.pierced |= others.pierced;
    first.iter().chain(&second).for_each(|&p| events.note(p));
    // The line of both planes passes through both interiors, and a part of it is in both triangles:
    // they cross even if the ends of this part are on edges.
    let straddles = |of: [Sign; 3]| of.contains(&Sign::Positive) && of.contains(&Sign::Negative);
    let on = |p: &&Place| matches!(p, Place::Edge(_) | Place::Inside);
    let corners = first.iter().filter(|p| **p == Place::Corner).count();
    let ends = events.edges + corners + first.iter().chain(&second).filter(on).count();
    events.pierced |= ends >= 2 && straddles(of_a) && straddles(of_b);
    let kind = events.kind()?;
    Some(Contact {
        kind,
        crossing: events.pierced || events.edges > 0,
        first,
        second,
    })
}

/// Where the vertices of `a` are on `b`, which is in another plane. Events of the edges of `a` are
/// noted.
fn meet(a: &Triangle, of: [Sign; 3], b: &Triangle, events: &mut Events) -> Option<[Place; 3]> {
    for (i, j) in EDGES {
        if of[i] * of[j] == Sign::Negative {
            pierce(a.at[i], a.at[j], b, events);
        }
    }
    let in_plane = of.map(Sign::is_zero);
    if in_plane == [false; 3] {
        return Some([Place::Off; 3]);
    }
    let plane = Projection::of(b.at)?;
    let (flat_a, flat_b) = (plane.of_triangle(a), plane.of_triangle(b));
    for (i, j) in EDGES {
        if in_plane[i] && in_plane[j] {
            let crosses =
                |&(k, l): &(usize, usize)| cross([flat_a[i], flat_a[j]], [flat_b[k], flat_b[l]]);
            events.edges += EDGES.iter().filter(|&e| crosses(e)).count();
        }
    }
    Some(places(a, flat_a, b, flat_b, plane.turn, in_plane))
}

/// Notes where an edge from one side of the plane of `b` to the other crosses `b`. A crossing at a
/// vertex of `b` is noted with that vertex.
fn pierce(p: Point3, q: Point3, b: &Triangle, events: &mut Events) {
    let turns = EDGES.map(|(k, l)| orient3d(p, q, b.at[k], b.at[l]));
    if turns.contains(&Sign::Positive) && turns.contains(&Sign::Negative) {
        return;
    }
    match turns.iter().filter(|s| s.is_zero()).count() {
        0 => events.pierced = true,
        1 => events.edges += 1,
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: [Point3; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn found(ids: [u32; 3], at: [Point3; 3]) -> Option<(Kind, bool)> {
        let a = Triangle {
            ids: [0, 1, 2],
            at: BASE,
        };
        let b = Triangle { ids, at };
        let one = contact(&a, &b).map(|c| (c.kind, c.crossing));
        let other = contact(&b, &a).map(|c| (c.kind, c.crossing));
        assert_eq!(one, other);
        one
    }

    #[test]
    fn each_kind_is_found() {
        let [o, x, y] = BASE;
        let new = [3, 4, 5];
        let kinds = [
            (
                new,
                [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]],
                Kind::Crossing,
                true,
            ),
            (
                new,
                [[2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [2.0, -2.0, 0.0]],
                Kind::EdgeOnEdge,
                true,
            ),
            (
                new,
                [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]],
                Kind::VertexInFace,
                false,
            ),
            (
                new,
                [[2.0, 0.0, 0.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]],
                Kind::VertexOnEdge,
                false,
            ),
            (
                new,
                [[1.0, 1.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0]],
                Kind::Overlap,
                true,
            ),
            (
                new,
                [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]],
                Kind::Overlap,
                false,
            ),
            ([0, 1, 3], [o, x, [4.0, 4.0, 0.0]], Kind::Folded, true),
            ([0, 1, 3], [o, x, [1.0, 1.0, 0.0]], Kind::Folded, false),
            // The interiors cross from a vertex of one to a vertex of the other.
            (
                new,
                [[1.0, 0.0, 0.0], [1.0, 9.0, 1.0], [1.0, 0.0, -1.0]],
                Kind::Crossing,
                true,
            ),
            // A wall on the base.
            (
                new,
                [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 1.0]],
                Kind::VertexInFace,
                false,
            ),
            (
                [0, 3, 4],
                [o, [2.0, 2.0, 0.0], [0.0, 0.0, 1.0]],
                Kind::VertexOnEdge,
                false,
            ),
            (
                [2, 3, 4],
                [y, [3.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
                Kind::Overlap,
                false,
            ),
        ];
        for (ids, at, kind, crossing) in kinds {
            assert_eq!(found(ids, at), Some((kind, crossing)), "{at:?}");
        }
    }

    #[test]
    fn shared_vertices_and_edges_are_not_contacts() {
        let [o, x, _] = BASE;
        assert_eq!(found([0, 1, 3], [o, x, [1.0, -1.0, 0.0]]), None);
        assert_eq!(found([0, 1, 3], [o, x, [1.0, 1.0, 1.0]]), None);
        assert_eq!(
            found([0, 3, 4], [o, [-1.0, 0.0, 1.0], [-1.0, 1.0, -1.0]]),
            None
        );
        assert_eq!(
            found([0, 3, 4], [o, [-1.0, 0.0, 0.0], [-1.0, 1.0, 0.0]]),
            None
        );
        assert_eq!(
            found(
                [3, 4, 5],
                [[0.0, 0.0, 1.0], x, [9.0; 3]].map(|p| [p[0], p[1], p[2] + 1.0])
            ),
            None
        );
    }
}
