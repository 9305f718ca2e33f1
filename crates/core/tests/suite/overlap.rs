//! Areas that cells share: sums, invariants that hold bit for bit, interruption.

use delone_core::Point3;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::overlap::{Fault, Grid, Polygons, Rows, Shared, check, overlaps};
use std::f64::consts::PI;

/// The sides of a cube, each in n x n cells.
fn cube(n: usize) -> Vec<Vec<Point3>> {
    let at = |k: usize| (k as f64 / n as f64 * 2.0 - 1.0) * 1.0;
    let mut cells = Vec::new();
    for face in 0..6 {
        let place = |i: usize, j: usize| -> Point3 {
            let (a, b) = (at(i), at(j));
            match face {
                0 => [1.0, a, b],
                1 => [-a, 1.0, b],
                2 => [-1.0, -a, b],
                3 => [a, -1.0, b],
                4 => [-b, a, 1.0],
                _ => [b, a, -1.0],
            }
        };
        for i in 0..n {
            for j in 0..n {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                cells.push(corners.map(|(i, j)| place(i, j)).to_vec());
            }
        }
    }
    cells
}

/// The arrays of cells of one ring.
struct Flat {
    vectors: Vec<Point3>,
    rings: Vec<i64>,
    cells: Vec<i64>,
    holes: Vec<bool>,
}

impl Flat {
    fn of(cells: &[Vec<Point3>]) -> Self {
        let mut rings = vec![0];
        for cell in cells {
            rings.push(rings[rings.len() - 1] + cell.len() as i64);
        }
        Self {
            vectors: cells.concat(),
            rings,
            cells: (0..=cells.len() as i64).collect(),
            holes: vec![false; cells.len()],
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
}

/// Rows of equal cells all around.
struct Bands {
    tangents: Vec<[f64; 2]>,
    starts: Vec<i64>,
    meridians: Vec<[f64; 2]>,
    numbers: Vec<i32>,
}

impl Bands {
    fn of(rows: usize, columns: usize) -> Self {
        let tangent = |l: usize| match l {
            0 => f64::NEG_INFINITY,
            _ if l == rows => f64::INFINITY,
            _ => ((l as f64 / rows as f64 - 0.5) * PI).tan(),
        };
        let direction = |m: usize| {
            let (s, c) = ((m % columns) as f64 / columns as f64 * 2.0 * PI).sin_cos();
            [c, s]
        };
        let row = |r: usize| (0..=columns).map(move |m| (r * columns + m) as i32);
        Self {
            tangents: (0..rows).map(|r| [tangent(r), tangent(r + 1)]).collect(),
            starts: (0..=rows as i64)
                .map(|r| r * (columns as i64 + 1))
                .collect(),
            meridians: (0..rows)
                .flat_map(|_| (0..=columns).map(direction))
                .collect(),
            numbers: (0..rows)
                .flat_map(row)
                .map(|n| n.min((rows * columns) as i32 - 1))
                .collect(),
        }
    }

    fn grid(&self) -> Grid<'_> {
        Grid::Rows(Rows {
            tangents: &self.tangents,
            starts: &self.starts,
            meridians: &self.meridians,
            numbers: &self.numbers,
            count: self.numbers.len() - self.tangents.len(),
        })
    }
}

fn shared(p: &Grid, q: &Grid) -> Shared {
    overlaps(p, q, 1, &Watch::idle()).expect("valid grids")
}

/// The largest relative error of the sums over the cells of either grid.
fn worst(p: &Grid, q: &Grid) -> f64 {
    let found = shared(p, q);
    let errors = |grid: &Grid, sums: &[f64]| {
        let areas = check(grid, true, 1, &Watch::idle())
            .expect("valid grid")
            .areas;
        let each = areas.into_iter().zip(sums.to_vec());
        each.map(|(area, sum)| (sum / area - 1.0).abs())
            .fold(0.0, f64::max)
    };
    errors(p, &found.first).max(errors(q, &found.second))
}

#[test]
fn nested_grids_share_what_theory_says() {
    let (coarse, fine) = (Flat::of(&cube(4)), Flat::of(&cube(8)));
    assert_eq!(shared(&coarse.grid(), &fine.grid()).areas.len(), 384);
    assert_eq!(shared(&fine.grid(), &fine.grid()).areas.len(), 384);
    assert!(worst(&coarse.grid(), &fine.grid()) < 2e-15);
}

#[test]
fn sums_are_those_of_the_cells() {
    let (cube, bands, other) = (Flat::of(&cube(7)), Bands::of(18, 36), Bands::of(7, 11));
    for [p, q] in [
        [cube.grid(), bands.grid()],
        [bands.grid(), cube.grid()],
        [bands.grid(), other.grid()],
        [other.grid(), bands.grid()],
    ] {
        assert!(worst(&p, &q) < 5e-15);
    }
}

#[test]
fn how_a_ring_is_written_changes_no_bit() {
    let rings = cube(5);
    let other: Vec<Vec<Point3>> = rings
        .iter()
        .enumerate()
        .map(|(k, ring)| {
            let mut ring = ring.clone();
            ring.rotate_left(k % 4);
            if k % 2 == 1 {
                ring.reverse();
            }
            let again = ring[k % 4].map(|x| x * 8.0);
            ring.insert(k % 4, again);
            ring
        })
        .collect();
    let (p, q, bands) = (Flat::of(&rings), Flat::of(&other), Bands::of(9, 20));
    let target = Flat::of(&cube(6));
    for target in [target.grid(), bands.grid()] {
        let (a, b) = (shared(&p.grid(), &target), shared(&q.grid(), &target));
        assert_eq!((a.cells, a.areas), (b.cells, b.areas));
    }
    let known = check(&q.grid(), true, 1, &Watch::idle()).expect("valid grid");
    assert_eq!(known.repeated, rings.len());
    assert_eq!(known.turned.iter().filter(|x| **x).count(), rings.len() / 2);
}

#[test]
fn threads_change_nothing() {
    let (p, q, bands) = (Flat::of(&cube(20)), Flat::of(&cube(9)), Bands::of(20, 40));
    for target in [q.grid(), bands.grid()] {
        let one = shared(&p.grid(), &target);
        let many = overlaps(&p.grid(), &target, 3, &Watch::idle()).expect("valid grids");
        assert_eq!(
            (one.cells, one.areas, one.second),
            (many.cells, many.areas, many.second)
        );
    }
}

#[test]
fn faults_are_found() {
    let cells = [
        vec![[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 1.0]],
        vec![[1.0, 0.0, 0.0], [-0.5, 1.0, 0.0], [-0.5, -1.0, 0.0]],
        vec![
            [1.0, -1.0, -1.0],
            [1.0, 2.0, 1.0],
            [1.0, 1.0, -1.0],
            [1.0, -1.0, 1.0],
        ],
        vec![
            [1.0, -1.0, -1.0],
            [1.0, 1.0, -1.0],
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
        ],
    ];
    let flat = Flat::of(&cells);
    let known = check(&flat.grid(), true, 1, &Watch::idle()).expect("finite vectors");
    let faults = [Fault::Empty, Fault::Opposite, Fault::Large, Fault::Crossing];
    assert_eq!(known.faults, [&faults.map(|f| f as u8)[..], &[0]].concat());
}

#[test]
fn an_interruption_ends_it() {
    let (p, bands) = (Flat::of(&cube(20)), Bands::of(20, 40));
    for target in [p.grid(), bands.grid()] {
        let stopped = overlaps(&p.grid(), &target, 2, &Watch::new(&|| true));
        assert_eq!(stopped.err(), Some(Error::Interrupted));
    }
}
