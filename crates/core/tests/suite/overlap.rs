//! Areas that cells share: sums, invariants that hold bit for bit, interruption.

use delone_core::Point3;
use delone_core::base::error::Error;
use delone_core::base::watch::Watch;
use delone_core::overlap::{
    Fault, Grid, Polygons, Rows, Shared, check, check_plane, overlaps, overlaps_plane,
};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

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
        vec![
            [0.0, 0.0, -1.0],
            [0.0, 0.0, -2.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, 1.0],
        ],
    ];
    let flat = Flat::of(&cells);
    let known = check(&flat.grid(), true, 1, &Watch::idle()).expect("finite vectors");
    assert_eq!(known.faults[5], Fault::Opposite as u8);
    let faults = [Fault::Empty, Fault::Opposite, Fault::Large, Fault::Crossing];
    assert_eq!(
        known.faults[..5],
        [&faults.map(|f| f as u8)[..], &[0]].concat()
    );
}

#[test]
fn an_interruption_ends_it() {
    let (p, bands) = (Flat::of(&cube(20)), Bands::of(20, 40));
    for target in [p.grid(), bands.grid()] {
        let stopped = overlaps(&p.grid(), &target, 2, &Watch::new(&|| true));
        assert_eq!(stopped.err(), Some(Error::Interrupted));
    }
}

/// Calls with a watch that stops at its 40th check: more than any stage needs but the one that lasts.
fn stops(call: impl Fn(&Watch) -> Option<Error>) -> bool {
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) == 40;
    call(&Watch::new(&stop)) == Some(Error::Interrupted)
}

/// Teeth along the first axis, or along the second one: side by side in any order, their boxes meet if
/// `slanted`.
fn comb(teeth: usize, across: bool, slanted: bool) -> Vec<[f64; 2]> {
    let mut ring = vec![[1.0, -1.0], [-1.0, -1.0]];
    for k in 0..teeth {
        let at = |part: f64| ((k as f64 + part) / teeth as f64) * 1.8 - 0.9;
        ring.extend([
            [-1.0, at(0.1)],
            [0.95, at(0.4)],
            [0.95, at(0.6)],
            [-1.0, at(0.9)],
        ]);
    }
    ring.push([1.0, 1.0]);
    let turned = |[x, y]: [f64; 2]| match (across, slanted) {
        (false, false) => [x, y],
        (true, false) => [y, x],
        (_, true) => [x - y, x + y],
    };
    ring.into_iter().map(turned).collect()
}

/// The ring on the plane z = 2.
fn raised(ring: &[[f64; 2]]) -> Vec<Point3> {
    ring.iter().map(|&[x, y]| [x, y, 2.0]).collect()
}

/// A ring around the origin with random radii.
fn star(count: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut state = seed;
    (0..count)
        .map(|k| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            let radius = 0.8 + 0.2 * (state >> 40) as f64 / (1 << 24) as f64;
            let (s, c) = (k as f64 / count as f64 * 2.0 * PI).sin_cos();
            [radius * c, radius * s]
        })
        .collect()
}

/// The arrays of polygons: vectors, rings, cells and holes.
type Planar = (Vec<[f64; 2]>, Vec<i64>, Vec<i64>, Vec<bool>);

/// Cells of one ring in the plane.
fn flat(cells: &[Vec<[f64; 2]>]) -> Planar {
    let lengths = cells.iter().map(|ring| ring.len() as i64);
    let starts = lengths.scan(0, |sum, n| {
        *sum += n;
        Some(*sum)
    });
    let rings = std::iter::once(0).chain(starts).collect();
    let each = (0..=cells.len() as i64).collect();
    (cells.concat(), rings, each, vec![false; cells.len()])
}

fn in_plane((vectors, rings, cells, holes): &Planar) -> Polygons<'_, 2> {
    Polygons {
        vectors,
        rings,
        cells,
        holes,
    }
}

#[test]
fn an_interruption_ends_what_takes_long_in_one_cell_or_one_pair() {
    let (slanted, teeth, others) = (
        comb(4000, false, true),
        comb(1500, false, false),
        comb(1500, true, false),
    );
    let plane = [slanted.clone(), teeth.clone(), others.clone()].map(|ring| flat(&[ring]));
    let sphere = [slanted, teeth, others].map(|ring| Flat::of(&[raised(&ring)]));
    assert!(stops(|watch| check_plane(
        &in_plane(&plane[0]),
        true,
        1,
        watch
    )
    .err()));
    assert!(stops(|watch| check(&sphere[0].grid(), true, 1, watch).err()));
    let [p, q] = [1, 2].map(|k| in_plane(&plane[k]));
    assert!(stops(|watch| overlaps_plane(&p, &q, 1, watch).err()));
    let [p, q] = [1, 2].map(|k| sphere[k].grid());
    assert!(stops(|watch| overlaps(&p, &q, 1, watch).err()));
    let bands = Bands::of(1800, 3600);
    assert!(stops(|watch| overlaps(&p, &bands.grid(), 1, watch).err()));
}

/// Of a polygon with many corners, only sides near the other cell are asked for; cut into triangles
/// around its center, all are.
#[test]
fn a_polygon_with_many_corners_shares_what_its_triangles_do() {
    let (p, q) = (star(700, 1), star(900, 2));
    let fan: Vec<Vec<[f64; 2]>> = (0..p.len())
        .map(|k| vec![[0.0, 0.0], p[k], p[(k + 1) % p.len()]])
        .collect();
    let [whole, parts, other] = [
        flat(std::slice::from_ref(&p)),
        flat(&fan),
        flat(std::slice::from_ref(&q)),
    ];
    let sums = |p: &_, q: &_| {
        let found = overlaps_plane(&in_plane(p), &in_plane(q), 1, &Watch::idle());
        found.expect("valid cells").areas.iter().sum::<f64>()
    };
    let all = sums(&parts, &other);
    for one in [
        sums(&whole, &other),
        sums(&other, &whole),
        sums(&other, &parts),
    ] {
        assert!((one / all - 1.0).abs() < 1e-14);
    }
    let lifted = |cells: &[Vec<[f64; 2]>]| {
        let cells: Vec<_> = cells.iter().map(|ring| raised(ring)).collect();
        Flat::of(&cells)
    };
    let [whole, parts, other] = [lifted(&[p]), lifted(&fan), lifted(&[q])];
    let sums = |p: &Flat, q: &Flat| shared(&p.grid(), &q.grid()).areas.iter().sum::<f64>();
    let all = sums(&parts, &other);
    for one in [
        sums(&whole, &other),
        sums(&other, &whole),
        sums(&other, &parts),
    ] {
        assert!((one / all - 1.0).abs() < 1e-14);
    }
}

/// Rings that touch nothing of the other cell are inside or outside as wholes: islands in holes.
#[test]
fn rings_inside_each_other_share_rings() {
    let ring = |r: f64, count: usize| -> Vec<[f64; 2]> {
        (0..count)
            .map(|k| {
                let (s, c) = (k as f64 / count as f64 * 2.0 * PI).sin_cos();
                [r * c, r * s]
            })
            .collect()
    };
    let area = |r: f64| r * r * 300.0 * (PI / 300.0).sin() * (PI / 300.0).cos();
    // Between radii 6 and 5, and within 3, beside what is between 4 and 2.
    let p = [ring(6.0, 300), ring(5.0, 300), ring(3.0, 300)].concat();
    let q = [ring(4.0, 300), ring(2.0, 300)].concat();
    let p = (
        p,
        vec![0, 300, 600, 900],
        vec![0, 3],
        vec![false, true, false],
    );
    let q = (q, vec![0, 300, 600], vec![0, 2], vec![false, true]);
    for (p, q) in [(&p, &q), (&q, &p)] {
        let found =
            overlaps_plane(&in_plane(p), &in_plane(q), 1, &Watch::idle()).expect("valid cells");
        let right = area(3.0) - area(2.0);
        assert!((found.areas[0] / right - 1.0).abs() < 1e-14);
    }
    let lifted = |(v, rings, cells, holes): &Planar| Flat {
        vectors: v.iter().map(|&[x, y]| [x, y, 10.0]).collect(),
        rings: rings.clone(),
        cells: cells.clone(),
        holes: holes.clone(),
    };
    let [p, q] = [lifted(&p), lifted(&q)];
    let cap = |r: f64| {
        let ring = ring(r, 300)
            .into_iter()
            .map(|[x, y]| [x, y, 10.0])
            .collect();
        check(&Flat::of(&[ring]).grid(), true, 1, &Watch::idle())
            .expect("a ring")
            .areas[0]
    };
    let found = shared(&p.grid(), &q.grid());
    assert!((found.areas[0] / (cap(3.0) - cap(2.0)) - 1.0).abs() < 1e-14);
}

/// A ring that repeats itself from many starts takes no longer than another one.
#[test]
fn a_ring_that_runs_around_often_starts_anywhere() {
    let once = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let ring: Vec<[f64; 2]> = once.into_iter().cycle().take(400_000).collect();
    let known = check_plane(&in_plane(&flat(&[ring])), false, 1, &Watch::idle()).expect("finite");
    assert_eq!(known.areas, [400_000.0]);
}

/// Small rings all over the sphere, as holes of the cell around one of them: no hemisphere contains
/// it, which thousands of corners must not hide for minutes.
#[test]
fn a_cell_with_holes_everywhere_is_larger_than_a_hemisphere() {
    let (count, mut rings, mut vectors) = (1200, vec![0], Vec::new());
    for k in 0..count {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let (s, c) = (k as f64 * 2.4).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let (across, up) = (
            [-s * 0.01, c * 0.01, 0.0],
            [-z * c * 0.01, -z * s * 0.01, r * 0.01],
        );
        for (i, j) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let v = [r * c, r * s, z];
            vectors.push([0, 1, 2].map(|x| v[x] + i * across[x] + j * up[x]));
        }
        rings.push(vectors.len() as i64);
    }
    let cell = Polygons {
        vectors: &vectors,
        rings: &rings,
        cells: &[0, count as i64],
        holes: &[&[false][..], &vec![true; count - 1]].concat(),
    };
    let known = check(&Grid::Polygons(cell), false, 1, &Watch::idle()).expect("finite vectors");
    assert_eq!(known.faults, [Fault::Large as u8]);
}

/// A hole that crosses the outer ring and is larger leaves less than nothing: the fault is told, and
/// no area.
#[test]
fn a_cell_without_area_whose_sides_cross_has_none() {
    let square = |at: f64, side: f64| {
        [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].map(|[x, y]| [x + at, y + at])
    };
    let ring = [square(0.0, 2.0), square(1.0, 4.0)].concat();
    let cell = (ring, vec![0, 4, 8], vec![0, 2], vec![false, true]);
    let known = check_plane(&in_plane(&cell), true, 1, &Watch::idle()).expect("finite");
    assert_eq!(known.faults, [Fault::Crossing as u8]);
    assert_eq!(known.areas, [0.0]);
    assert_eq!((known.turned[0], known.concave[0]), (false, false));
}

/// The middle of a long side is far from its chord: a small cell there is divided by it.
#[test]
fn a_side_is_also_where_it_rises_above_its_chord() {
    let at = |lon: f64, lat: f64| -> Point3 {
        let (lon, lat) = (lon.to_radians(), lat.to_radians());
        [lon.cos() * lat.cos(), lon.sin() * lat.cos(), lat.sin()]
    };
    let small: Vec<Point3> = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
        .map(|(lon, lat)| at(lon, lat))
        .to_vec();
    // The long side is on the equator. With 20 corners, sides are chosen by their boxes; with more, by
    // a tree.
    for corners in [20, 200] {
        let north =
            (0..corners - 2).map(|k| at(30.0 - 60.0 * k as f64 / f64::from(corners - 3), 25.0));
        let ring = [at(-30.0, 0.0), at(30.0, 0.0)].into_iter().chain(north);
        let large = Flat::of(&[ring.collect::<Vec<_>>()]);
        let one = Flat::of(std::slice::from_ref(&small));
        let whole = check(&one.grid(), true, 1, &Watch::idle())
            .expect("a valid cell")
            .areas[0];
        for found in [
            shared(&large.grid(), &one.grid()),
            shared(&one.grid(), &large.grid()),
        ] {
            assert_eq!(found.areas.len(), 1);
            assert!(
                (found.areas[0] / whole - 0.5).abs() < 1e-12,
                "{:?}",
                found.areas
            );
        }
    }
}

#[test]
fn sides_that_cross_opposite_each_other_do_not() {
    let place = |[lon, lat]: [f64; 2]| -> Point3 {
        let (s, c) = lon.to_radians().sin_cos();
        let (z, r) = lat.to_radians().sin_cos();
        [r * c, r * s, z]
    };
    let cell = |[west, east]: [f64; 2], lat: f64| -> Vec<Point3> {
        let corners = [[west, -lat], [east, -lat], [east, lat], [west, lat]];
        corners.map(place).to_vec()
    };
    // The western sides of the others cross the circles of the long sides where those are on the other
    // side of the sphere.
    let long = Flat::of(&[cell([-80.0, 80.0], 1.0)]);
    let others = Flat::of(&[cell([-115.0, -60.0], 20.0), cell([-85.0, -60.0], 20.0)]);
    let found = shared(&long.grid(), &others.grid());
    assert_eq!(found.cells, [0, 1]);
    assert!((found.areas[0] / found.areas[1] - 1.0).abs() < 1e-14);
}

#[test]
fn a_star_that_turns_left_at_all_corners_is_not_convex() {
    let corner = |k: usize| {
        let (s, c) = (k as f64 * 0.8 * PI + 0.1).sin_cos();
        [1.0, 0.3 * c, 0.3 * s]
    };
    let star = Flat::of(&[(0..5).map(corner).collect()]);
    let found = check(&star.grid(), true, 1, &Watch::idle()).expect("valid grid");
    assert_eq!(found.faults, [Fault::Crossing as u8]);
}
