//! Areas that pairs of rings share: whichever is first, however they are written, and the sums over
//! parts of the sphere: the eight octants, and cells of meridians and parallels.

#![no_main]

use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::overlap::{Checked, Grid, Polygons, Rows, check, overlaps};
use delone_fuzz::Coordinates;
use delone_fuzz::oracle::points::power_of_two;
use libfuzzer_sys::arbitrary::{Result, Unstructured};

const MOST: usize = 9;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    if let (Ok(p), Ok(q)) = (read(&mut bytes), read(&mut bytes)) {
        compare(&p, &q);
    }
});

/// What areas of slivers of any width may be wrong by, in steradians.
const SLIVER: f64 = 1e-24;

/// A ring, in ways that are hard.
fn read(bytes: &mut Unstructured) -> Result<Vec<Point3>> {
    let shape = bytes.int_in_range(0..=5)?;
    let count = bytes.int_in_range(3..=MOST)?;
    let side = bytes.int_in_range(1..=4_i32)?;
    let mut coordinates = Coordinates::new(bytes)?;
    let mut ring: Vec<Point3> = Vec::new();
    for _ in 0..count {
        let mut whole = || bytes.int_in_range(-side..=side).map(f64::from);
        let [x, y, z] = [whole()?, whole()?, whole()?];
        ring.push(match shape {
            0 => coordinates.point(bytes)?,
            1 => [x, y, z],
            2 => [x, y, f64::from(side)],
            3 => [f64::from(side), x * 1e-8, y * 1e-8],
            4 => [x, y, z * 1e-15],
            // Directions that are close to each other, and to axes and planes of coordinates.
            _ => {
                let mut small = |x: f64| {
                    let power = *bytes.choose(&[0, 0, 0, -26, -60, -180, -530, -1000])?;
                    Ok(x * power_of_two(power))
                };
                [small(x)?, small(y)?, small(z)?]
            }
        });
    }
    // Repeated corners.
    if bytes.ratio(1, 4)? {
        ring.push(ring[ring.len() - 1]);
    }
    Ok(ring)
}

struct Flat {
    vectors: Vec<Point3>,
    rings: Vec<i64>,
    cells: Vec<i64>,
    holes: Vec<bool>,
}

impl Flat {
    fn of(rings: &[&[Point3]]) -> Self {
        let mut starts = vec![0];
        for ring in rings {
            starts.push(starts[starts.len() - 1] + ring.len() as i64);
        }
        Self {
            vectors: rings.concat(),
            rings: starts,
            cells: (0..=rings.len() as i64).collect(),
            holes: vec![false; rings.len()],
        }
    }

    fn grid(&self) -> Grid<'_> {
        Grid::Polygons(Polygons {
            vectors: &self.vectors,
            rings: &self.rings,
            cells: &self.cells,
            holes: &self.holes,
        })
    }

    fn checked(&self) -> Option<Checked> {
        check(&self.grid(), true, 1, &Watch::idle()).ok()
    }
}

fn compare(p: &[Point3], q: &[Point3]) {
    let (first, second) = (Flat::of(&[p]), Flat::of(&[q]));
    let (Some(a), Some(b)) = (first.checked(), second.checked()) else {
        return;
    };
    // Rings that cross or run along themselves are found.
    if a.faults[0] != 0 || b.faults[0] != 0 {
        return;
    }
    let (whole, other) = (a.areas[0], b.areas[0]);
    let sum = |x: &Grid, y: &Grid| {
        let found = overlaps(x, y, 1, &Watch::idle()).expect("valid cells");
        found.areas.iter().sum::<f64>()
    };
    let least = whole.min(other);
    let (one, two) = (
        sum(&first.grid(), &second.grid()),
        sum(&second.grid(), &first.grid()),
    );
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-14 * least + SLIVER;
    assert!(close(one, two) && one <= least * (1.0 + 1e-14) + SLIVER);
    let mut turned = p.to_vec();
    turned.rotate_left(1);
    turned.reverse();
    assert_eq!(one, sum(&Flat::of(&[&turned]).grid(), &second.grid()));
    assert!((sum(&first.grid(), &first.grid()) - whole).abs() <= 1e-14 * whole + SLIVER);
    let octants: Vec<[Point3; 3]> = (0..8)
        .map(|k| {
            let s = |bit: i32| if k & bit == 0 { 1.0 } else { -1.0 };
            [[s(1), 0.0, 0.0], [0.0, s(2), 0.0], [0.0, 0.0, s(4)]]
        })
        .collect();
    let parts: Vec<&[Point3]> = octants.iter().map(|o| &o[..]).collect();
    let all = sum(&first.grid(), &Flat::of(&parts).grid());
    assert!((all - whole).abs() <= 1e-14 * whole + SLIVER);
    // Cells around the axis, with lattice points on their sides.
    let tangents = [
        [f64::NEG_INFINITY, -0.5],
        [-0.5, 0.0],
        [0.0, 1.0],
        [1.0, f64::INFINITY],
    ];
    let meridians = [
        [1.0, 0.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [1.0, 0.0],
    ];
    let numbers: Vec<i32> = (0..24).map(|k| (k % 6 * 4 + k / 6).min(19)).collect();
    let rows = Rows {
        tangents: &tangents,
        starts: &[0, 6, 12, 18, 24],
        meridians: &meridians.repeat(4),
        numbers: &numbers,
        count: 20,
    };
    let all = sum(&first.grid(), &Grid::Rows(rows));
    assert!((all - whole).abs() <= 1e-13 * whole + SLIVER);
}
