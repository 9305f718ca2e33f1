//! Times of edits of a live 3-D triangulation: `live3 [points] [edits]`.

use std::time::Instant;

use delone_core::Point3;
use delone_core::base::watch::Watch;
use delone_core::delaunay::space::triangulate;
use delone_core::live::space::Space;

fn scattered(n: usize, seed: u64) -> Vec<Point3> {
    let mut x = seed;
    let mut next = || {
        x = x
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (x >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next(), next()]).collect()
}

/// The result of a call and its seconds.
fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let made = call();
    (made, start.elapsed().as_secs_f64())
}

fn main() {
    let mut given = std::env::args()
        .skip(1)
        .filter_map(|a| a.parse::<usize>().ok());
    let n = given.next().unwrap_or(1_000_000).max(100);
    // Three batches share no row.
    let m = given.next().unwrap_or(1000).clamp(1, n / 3);
    let watch = Watch::idle();
    let points = scattered(n, 1);
    let (_, build) = timed(|| triangulate(&points, 1, &watch).expect("a triangulation"));
    println!("build            {build:8.3} s");
    let (mut live, new) = timed(|| Space::new(&points, 1, &watch).expect("a triangulation"));
    println!("live build       {new:8.3} s");
    let report = |name: &str, seconds: f64| {
        let (each, share) = (1e6 * seconds / m as f64, 100.0 * seconds / build);
        println!("{name:16} {each:8.1} us each, {share:6.2} % of a build");
    };
    let step = (n / m.max(1)).max(3) as i64;
    let spread = |from: i64| -> Vec<i64> { (0..m as i64).map(|i| i * step + from).collect() };
    let more = scattered(m, 2);
    let insert = |live: &mut Space, points: &[Point3]| {
        live.insert(points, 1, &watch).expect("insertion");
    };
    let (_, first) = timed(|| insert(&mut live, &more[..1]));
    println!("first insertion  {first:8.6} s");
    report("insert, batch", timed(|| insert(&mut live, &more)).1);
    let singles = scattered(m, 3);
    report(
        "insert, single",
        timed(|| singles.chunks(1).for_each(|p| insert(&mut live, p))).1,
    );
    let rows = spread(0);
    let remove = |live: &mut Space, rows: &[i64]| live.remove(rows, 1, &watch).expect("removal");
    report("remove, batch", timed(|| remove(&mut live, &rows)).1);
    let rows = spread(1);
    report(
        "remove, single",
        timed(|| rows.chunks(1).for_each(|r| remove(&mut live, r))).1,
    );
    let near = spread(2);
    let step = 0.02 / (n as f64).cbrt();
    for (name, step) in [("move, a little", step), ("move, an edge", 50.0 * step)] {
        let moved = |row: &i64, d: Point3| {
            let p = points[*row as usize];
            [0, 1, 2].map(|k| p[k] + step * (d[k] - 0.5))
        };
        let to: Vec<Point3> = near
            .iter()
            .zip(scattered(m, 4))
            .map(|(r, d)| moved(r, d))
            .collect();
        let go = timed(|| live.relocate(&near, &to, 1, &watch).expect("a move"));
        report(name, go.1);
    }
    println!("state, first     {:8.3} s", timed(|| live.state(&watch)).1);
    insert(&mut live, &scattered(m, 5));
    println!("state, later     {:8.3} s", timed(|| live.state(&watch)).1);
    live.check().expect("a sound mesh");
}
