//! Areas that pairs of cells in the plane share, with rings of lattices, against rational numbers:
//! which rings are accepted, their areas, and what they share in either order.

#![no_main]

use delone_core::Point2;
use delone_core::base::watch::Watch;
use delone_core::overlap::{Checked, Fault, Polygons, check_plane, overlaps_plane};
use libfuzzer_sys::arbitrary::{Result, Unstructured};

const MOST: usize = 9;
/// The largest coordinate of a lattice.
const SIDE: i64 = 6;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    if let (Ok(p), Ok(q)) = (whole(&mut bytes), whole(&mut bytes)) {
        compare_exactly(&p, &q);
    }
});

/// Rings, each of which may be a hole.
struct Cell {
    rings: Vec<(bool, Vec<Point2>)>,
}

/// A cell as arrays.
struct Flat {
    points: Vec<Point2>,
    rings: Vec<i64>,
    cells: Vec<i64>,
    holes: Vec<bool>,
}

impl Flat {
    fn of(cells: &[&Cell]) -> Self {
        let mut flat = Self {
            points: Vec::new(),
            rings: vec![0],
            cells: vec![0],
            holes: Vec::new(),
        };
        for cell in cells {
            for (hole, ring) in &cell.rings {
                flat.points.extend(ring);
                flat.rings.push(flat.points.len() as i64);
                flat.holes.push(*hole);
            }
            flat.cells.push(flat.holes.len() as i64);
        }
        flat
    }

    fn polygons(&self) -> Polygons<'_, 2> {
        Polygons {
            vectors: &self.points,
            rings: &self.rings,
            cells: &self.cells,
            holes: &self.holes,
        }
    }

    fn checked(&self) -> Checked {
        check_plane(&self.polygons(), true, 1, &Watch::idle()).expect("finite points")
    }
}

/// The sum of the areas that cells share.
fn shared(p: &[&Cell], q: &[&Cell]) -> f64 {
    let (p, q) = (Flat::of(p), Flat::of(q));
    let found = overlaps_plane(&p.polygons(), &q.polygons(), 1, &Watch::idle());
    found.expect("finite points").areas.iter().sum()
}

/// Up to two rings of a small lattice.
fn whole(bytes: &mut Unstructured) -> Result<Cell> {
    let mut rings = Vec::new();
    for k in 0..bytes.int_in_range(1..=2)? {
        let side = bytes.int_in_range(1..=SIDE)?;
        let mut ring = Vec::new();
        for _ in 0..bytes.int_in_range(3..=MOST)? {
            let mut place = || bytes.int_in_range(-side..=side).map(|x| x as f64);
            ring.push([place()?, place()?]);
        }
        rings.push((k > 0, ring));
    }
    Ok(Cell { rings })
}

/// A rational number, in lowest terms.
#[derive(Clone, Copy)]
struct Ratio(i128, i128);

impl Ratio {
    fn of(n: i128, d: i128) -> Self {
        let (mut a, mut b) = (n.abs(), d.abs());
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let sign = if d < 0 { -1 } else { 1 };
        Self(sign * n / a.max(1), sign * d / a.max(1))
    }

    fn plus(self, o: Self) -> Self {
        Self::of(self.0 * o.1 + o.0 * self.1, self.1 * o.1)
    }

    fn minus(self, o: Self) -> Self {
        self.plus(Self(-o.0, o.1))
    }

    fn times(self, o: Self) -> Self {
        Self::of(self.0 * o.0, self.1 * o.1)
    }

    fn over(self, o: Self) -> Self {
        Self::of(self.0 * o.1, self.1 * o.0)
    }
}

type Place = [Ratio; 2];

fn exact(v: Point2) -> Place {
    v.map(|x| Ratio(x as i128, 1))
}

/// Twice the area of a triangle, positive if it is counterclockwise.
fn turn(a: Place, b: Place, c: Place) -> Ratio {
    let [u, v] = [b, c].map(|p| [0, 1].map(|k| p[k].minus(a[k])));
    u[0].times(v[1]).minus(u[1].times(v[0]))
}

/// Twice the integral of the winding number of a ring over a counterclockwise triangle: the ring is
/// cut along each of its sides.
fn within(ring: &[Place], triangle: [Place; 3]) -> f64 {
    let mut ring = ring.to_vec();
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        let mut cut = Vec::new();
        for (i, &q) in ring.iter().enumerate() {
            let p = ring[(i + ring.len() - 1) % ring.len()];
            let (s, t) = (turn(a, b, p), turn(a, b, q));
            if (s.0 < 0 && t.0 > 0) || (s.0 > 0 && t.0 < 0) {
                let share = s.over(s.minus(t));
                cut.push([0, 1].map(|k| p[k].plus(q[k].minus(p[k]).times(share))));
            }
            if t.0 >= 0 {
                cut.push(q);
            }
        }
        ring = cut;
    }
    let terms = (0..ring.len()).map(|k| {
        let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
        let term = p[0].times(q[1]).minus(p[1].times(q[0]));
        term.0 as f64 / term.1 as f64
    });
    terms.sum()
}

/// The rings of a cell with what is inside to their left: their winding numbers are its own.
fn directed(cell: &Cell) -> Vec<Vec<Place>> {
    let origin = exact([0.0; 2]);
    let rings = cell.rings.iter().map(|(hole, ring)| {
        let mut ring: Vec<Place> = ring.iter().map(|&v| exact(v)).collect();
        let doubled = (0..ring.len()).fold(Ratio(0, 1), |sum, k| {
            sum.plus(turn(origin, ring[k], ring[(k + 1) % ring.len()]))
        });
        if (doubled.0 < 0) != *hole {
            ring.reverse();
        }
        ring
    });
    rings.collect()
}

/// The integral of the product of the winding numbers of two cells: of fans of triangles in the
/// second one.
fn product(p: &[Vec<Place>], q: &[Vec<Place>]) -> f64 {
    let mut sum = 0.0;
    for other in q {
        for pair in other[1..].windows(2) {
            let sign = turn(other[0], pair[0], pair[1]).0.signum();
            let triangle = match sign {
                1 => [other[0], pair[0], pair[1]],
                -1 => [other[0], pair[1], pair[0]],
                _ => continue,
            };
            let parts = p.iter().map(|ring| within(ring, triangle));
            sum += sign as f64 * parts.sum::<f64>();
        }
    }
    sum / 2.0
}

/// The winding numbers of rings around places that are on no side, in integers: the least and the
/// greatest.
fn windings(rings: &[&[Place]]) -> [i64; 2] {
    let mut range = [0, 0];
    for i in -2 * SIDE..2 * SIDE {
        for j in -2 * SIDE..2 * SIDE {
            let [x, y] = [(i << 19) + 137, (j << 19) + 9973];
            let mut number = 0;
            for ring in rings {
                for k in 0..ring.len() {
                    let [a, b] =
                        [k, (k + 1) % ring.len()].map(|k| ring[k].map(|x| (x.0 as i64) << 20));
                    let left = (b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1]) > 0;
                    number += i64::from(a[1] <= y && y < b[1] && left);
                    number -= i64::from(b[1] <= y && y < a[1] && !left);
                }
            }
            range = [range[0].min(number), range[1].max(number)];
        }
    }
    range
}

/// Rings of lattices: what is accepted, and what they share.
fn compare_exactly(p: &Cell, q: &Cell) {
    let known = Flat::of(&[p, q]).checked();
    let both = [p, q].map(directed);
    for (k, rings) in both.iter().enumerate() {
        if known.faults[k] == Fault::Crossing as u8 {
            return;
        }
        for ring in rings {
            let [low, high] = windings(&[ring]);
            assert!(high - low <= 1, "a ring that crosses itself");
        }
        if known.faults[k] != 0 {
            return;
        }
        let area = product(rings, &directed(&square()));
        assert!((known.areas[k] - area).abs() <= 1e-13 * area);
    }
    // How rings nest is decided elsewhere.
    let nested = |rings: &[Vec<Place>]| {
        let all: Vec<&[Place]> = rings.iter().map(|ring| &ring[..]).collect();
        windings(&all) == [0, 1]
    };
    if both.iter().all(|rings| nested(rings)) {
        let expected = product(&both[0], &both[1]);
        for found in [shared(&[p], &[q]), shared(&[q], &[p])] {
            assert!((found - expected).abs() <= 1e-11, "{found} {expected}");
        }
    }
}

/// All of the lattice.
fn square() -> Cell {
    let s = SIDE as f64;
    Cell {
        rings: vec![(false, vec![[-s, -s], [s, -s], [s, s], [-s, s]])],
    }
}
