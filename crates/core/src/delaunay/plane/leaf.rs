//! Triangulations of two, three and four points, by table and without branches.
//!
//! Half of all merges would join parts of that size, and their branches are unpredictable.

use delone_predicates::{Point2, Sign, incircle_canonical};

use super::merge::Bounds;
use super::part::{Corner, Part};
use crate::base::vector::{cross2 as cross, minus};
use crate::mesh::plane::{OPPOSITE, Patch, RECORD, half_edge};

/// Half the distance from 1.0 to the next double.
const U: f64 = f64::EPSILON / 2.0;

// With the frame of the head of `merge`, and a cross product and a squared length of differences each
// at most 2 W^2 and off by 8 u W^2: the sum of three cross products errs by 24 u W^2, and its two
// additions by 4 u W^2 and 6 u W^2. In the in-circle determinant three terms err by 36 u W^4 each,
// its two additions by 8 u W^4 and 12 u W^4: 128 u W^4. The rest is room for terms of second order.

/// Bound of twice the area of a triangle for points in a box of side 1.
const TURN: f64 = 40.0 * U;
/// Bound of the in-circle determinant for points in a box of side 1.
const CIRCLE: f64 = 160.0 * U;

/// Two points as a chain, in records `t` and the next.
#[inline]
pub fn pair(mesh: &mut Patch, points: &[Point2], [a, b]: [u32; 2], t: u32) -> Part {
    let inf = mesh.infinite();
    mesh.set(t, [inf, b, a]);
    mesh.set(t + 1, [inf, a, b]);
    let [lower, upper] = [half_edge(t, 0), half_edge(t + 1, 0)];
    mesh.link(lower, upper);
    mesh.link(lower + 1, upper + 2);
    mesh.link(lower + 2, upper + 1);
    Part::with_corners(points, [Corner::new(b, t), Corner::new(a, t + 1)])
}

/// Three points as a triangle, in four records from `t` on; `None` if their orientation is
/// uncertain.
#[inline]
pub fn triple(
    mesh: &mut Patch,
    points: &[Point2],
    [a, b, c]: [u32; 3],
    t: u32,
    bounds: Bounds,
) -> Option<Part> {
    let at = |v: u32| points[v as usize];
    let turn = cross(minus(at(b), at(a)), minus(at(c), at(a)));
    if !(bounds.hold && turn.abs() > TURN * bounds.square) {
        return None;
    }
    let left = usize::from(turn > 0.0);
    let (a, b) = ([b, a][left], [a, b][left]);
    write(mesh, &TRIANGLE, [a, b, c, mesh.infinite(), 0], t);
    let corners = [
        Corner::new(a, t + 2),
        Corner::new(b, t + 3),
        Corner::new(c, t + 1),
    ];
    Some(Part::with_corners(points, corners))
}

/// Four points, in six records from `t` on; `None` if an orientation is uncertain.
#[inline]
pub fn quad(
    mesh: &mut Patch,
    points: &[Point2],
    vertices: [u32; 4],
    t: u32,
    bounds: Bounds,
) -> Option<Part> {
    let [p, q, r, s] = vertices.map(|v| points[v as usize]);
    let [a, b, c] = [p, q, r].map(|x| minus(x, s));
    // Twice the areas of the triangles that omit one of the points.
    let (bc, ac, ab) = (cross(b, c), cross(a, c), cross(a, b));
    let areas = [bc, ac, ab, bc - ac + ab];
    let lift = |x: Point2| x[0] * x[0] + x[1] * x[1];
    let circle = lift(a) * bc - lift(b) * ac + lift(c) * ab;
    let bit = |k: usize, x: f64| usize::from(x > 0.0) << k;
    let mut case = bit(4, circle);
    let mut certain = bounds.hold;
    for (k, x) in areas.into_iter().enumerate() {
        case |= bit(k, x);
        certain &= x.abs() > TURN * bounds.square;
    }
    if !certain {
        return None;
    }
    if circle.abs() <= CIRCLE * (bounds.square * bounds.square) {
        // Ties are broken as in the whole mesh.
        let inside = incircle_canonical(p, q, r, s) == Sign::Positive;
        case = case & 15 | usize::from(inside) << 4;
    }
    let Case {
        kind,
        order,
        ghosts,
    } = CASES[case];
    let ordered = order.map(|k| vertices[usize::from(k & 3)]);
    let [v0, v1, v2, v3] = ordered;
    write(
        mesh,
        &QUADS[usize::from(kind & 1)],
        [v0, v1, v2, v3, mesh.infinite()],
        t,
    );
    let corner = |k: usize| Corner::new(vertices[k], t + u32::from(ghosts[k]));
    Some(Part::with_corners(points, [0, 1, 2, 3].map(corner)))
}

/// Records over few vertices: corners by number, and neighbor codes as if from record 0.
struct Plan<const R: usize> {
    corners: [[u8; 3]; R],
    across: [[u32; 3]; R],
}

/// A triangle and the ghosts across its edges; number 3 is the infinite vertex.
static TRIANGLE: Plan<4> = linked([[0, 1, 2], [3, 2, 1], [3, 0, 2], [3, 1, 0]]);

/// Vertex 3 inside 0 1 2, and the quadrilateral 0 1 2 3 with the diagonal 0 2; number 4 is
/// infinite.
static QUADS: [Plan<6>; 2] = [
    linked([
        [0, 1, 3],
        [1, 2, 3],
        [2, 0, 3],
        [4, 1, 0],
        [4, 2, 1],
        [4, 0, 2],
    ]),
    linked([
        [0, 1, 2],
        [0, 2, 3],
        [4, 1, 0],
        [4, 2, 1],
        [4, 3, 2],
        [4, 0, 3],
    ]),
];

/// The plan of `corners`.
const fn linked<const R: usize>(corners: [[u8; 3]; R]) -> Plan<R> {
    let mut across = [[0; 3]; R];
    let mut e = 0;
    while e < 3 * R {
        let mut f = 0;
        while f < 3 * R {
            let ([a, b], [c, d]) = (ends(corners[e / 3], e % 3), ends(corners[f / 3], f % 3));
            if a == d && b == c {
                across[e / 3][e % 3] = (8 * (f / 3) + f % 3) as u32;
            }
            f += 1;
        }
        e += 1;
    }
    Plan { corners, across }
}

/// The ends of the edge opposite corner `k`.
const fn ends(corners: [u8; 3], k: usize) -> [u8; 2] {
    [corners[(k + 1) % 3], corners[(k + 2) % 3]]
}

/// Writes a plan over `vertices` to the records from `t` on.
#[inline]
fn write<const R: usize>(mesh: &mut Patch, plan: &Plan<R>, vertices: [u32; 5], t: u32) {
    // Eight entries, so that a 3-bit index needs no bounds check.
    let [a, b, c, d, e] = vertices;
    let vertices = [a, b, c, d, e, 0, 0, 0];
    for (i, record) in mesh.records_mut(t, R).iter_mut().enumerate() {
        for k in 0..3 {
            record[k] = vertices[usize::from(plan.corners[i][k] & 7)];
            record[OPPOSITE + k] = plan.across[i][k] + RECORD as u32 * t;
        }
    }
}

/// How to triangulate four points.
#[derive(Clone, Copy)]
struct Case {
    /// The plan.
    kind: u8,
    /// The points in the order of the plan.
    order: [u8; 4],
    /// For each point of the hull, the record of the ghost that ends there.
    ghosts: [u8; 4],
}

/// Indexed by the signs of the four areas, from the one without the first point on, and of the
/// determinant.
static CASES: [Case; 32] = cases();

const fn cases() -> [Case; 32] {
    let none = Case {
        kind: 0,
        order: [0; 4],
        ghosts: [0; 4],
    };
    let mut cases = [none; 32];
    let mut signs = 0;
    while signs < 32 {
        // Signs that four points cannot have match no order, and the entry stays unused.
        let mut i = 0;
        while i < 256 {
            let order = [i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6];
            let kind = kind(signs, order);
            if kind < 2 {
                cases[signs] = case(kind, order);
                break;
            }
            i += 1;
        }
        signs += 1;
    }
    cases
}

/// The plan that fits the points in this order, 2 if none does.
const fn kind(signs: usize, [a, b, c, d]: [usize; 4]) -> usize {
    if 1 << a | 1 << b | 1 << c | 1 << d != 15 || !left(signs, [a, b, c]) || !left(signs, [b, c, d])
    {
        2
    } else if left(signs, [a, b, d]) && left(signs, [c, a, d]) {
        0
    } else if left(signs, [c, d, a]) && left(signs, [d, a, b]) {
        // The diagonal is right if the last point is not in the circumcircle of the others.
        let odd = ((a > b) as u8 + (a > c) as u8 + (a > d) as u8)
            + ((b > c) as u8 + (b > d) as u8 + (c > d) as u8);
        if (signs >> 4 & 1 == 1) != (odd % 2 == 1) {
            2
        } else {
            1
        }
    } else {
        2
    }
}

/// Whether three of the points are counterclockwise.
const fn left(signs: usize, [a, b, c]: [usize; 3]) -> bool {
    let odd = ((a > b) as u8 + (a > c) as u8 + (b > c) as u8) % 2 == 1;
    let without = 6 - a - b - c;
    (signs >> without & 1 == 1) != odd
}

const fn case(kind: usize, order: [usize; 4]) -> Case {
    let mut case = Case {
        kind: kind as u8,
        order: [0; 4],
        ghosts: [0; 4],
    };
    let mut k = 0;
    while k < 4 {
        case.order[k] = order[k] as u8;
        let mut t = 0;
        while t < 6 {
            let corners = QUADS[kind].corners[t];
            if corners[0] == 4 && corners[1] as usize == k {
                case.ghosts[order[k]] = t as u8;
            }
            t += 1;
        }
        k += 1;
    }
    case
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::plane::Mesh2;
    use crate::order::blocks::Axis;
    use delone_predicates::{incircle, orient2d};

    const BOUNDS: Bounds = Bounds {
        square: 16.0,
        hold: true,
    };

    /// All triangles are counterclockwise, all circumcircles are empty, and the ends of the part
    /// are right.
    fn check(mesh: &Patch, points: &[Point2], part: &Part, records: u32) {
        mesh.check(records as usize).unwrap();
        let inf = mesh.infinite();
        let at = |v: u32| points[v as usize];
        for t in 0..records {
            let corners = mesh.corners(t);
            if corners[0] == inf {
                continue;
            }
            let [a, b, c] = corners.map(at);
            assert_eq!(orient2d(a, b, c), Sign::Positive);
            for &d in &points[..inf as usize] {
                assert_ne!(incircle(a, b, c, d), Sign::Positive);
            }
        }
        for axis in [Axis::X, Axis::Y] {
            let mut order: Vec<u32> = (0..inf).collect();
            order.sort_by(|&u, &v| axis.before(at(v), at(u)).cmp(&axis.before(at(u), at(v))));
            let ends = [part.first(axis), part.last(axis)];
            assert_eq!(ends.map(Corner::vertex), [order[0], order[order.len() - 1]]);
            for end in ends {
                assert_eq!(mesh.corners(end.ghost())[..2], [inf, end.vertex()]);
            }
        }
    }

    #[test]
    fn each_order_of_few_points_has_its_plan() {
        let shapes: [[Point2; 4]; 5] = [
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0], [1.0, 1.0]],
            [[0.0, 0.0], [3.0, 0.0], [3.5, 2.0], [0.0, 3.0]],
            [[0.0, 1.0], [3.0, 0.0], [4.0, 1.0], [3.0, 2.0]],
            [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.5]],
        ];
        for shape in shapes {
            for i in 0..256 {
                let order = [i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6];
                if order.iter().fold(0, |seen, k| seen | 1 << k) != 15 {
                    continue;
                }
                let mut points: Vec<Point2> = order.iter().map(|&k| shape[k]).collect();
                let mut mesh = Mesh2::with_vertices(4).unwrap();
                let part = quad(&mut mesh.patch(), &points, [0, 1, 2, 3], 0, BOUNDS).unwrap();
                check(&mesh.patch(), &points, &part, 6);
                // On a tie the diagonal ends at the smallest point.
                let least = (0..4).find(|&v| points[v as usize] == [0.0; 2]);
                let of_least = |t: &u32| mesh.patch().corners(*t)[..].contains(&least.unwrap_or(4));
                if shape[2] == [1.0, 1.0] {
                    assert_eq!((0..2).filter(of_least).count(), 2);
                }
                points.pop();
                let mut mesh = Mesh2::with_vertices(3).unwrap();
                let part = triple(&mut mesh.patch(), &points, [0, 1, 2], 0, BOUNDS).unwrap();
                check(&mesh.patch(), &points, &part, 4);
                points.pop();
                let mut mesh = Mesh2::with_vertices(2).unwrap();
                let part = pair(&mut mesh.patch(), &points, [0, 1], 0);
                check(&mesh.patch(), &points, &part, 2);
            }
        }
    }

    #[test]
    fn uncertain_signs_are_left_to_the_caller() {
        let mut mesh = Mesh2::with_vertices(4).unwrap();
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 1.0]];
        assert!(quad(&mut mesh.patch(), &line, [0, 1, 2, 3], 0, BOUNDS).is_none());
        assert!(triple(&mut mesh.patch(), &line, [0, 1, 2], 0, BOUNDS).is_none());
        let bounds = Bounds::within(1e300);
        assert!(triple(&mut mesh.patch(), &line, [0, 1, 3], 0, bounds).is_none());
    }
}
