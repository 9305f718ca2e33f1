//! spade's triangulations that change: `live FILE N M`, where the file has N points to start from and
//! M more. Prints the name of each edit, its seconds, and how many points it edits.

use std::env;
use std::time::Instant;

use delone_peers::{Failure, points};
use spade::handles::FixedVertexHandle;
use spade::{DelaunayTriangulation, HierarchyHintGenerator, Point2, Triangulation};

type Mesh = DelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

/// Runs some work on one thread, and prints what it took.
fn timed<T>(name: &str, count: usize, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let made = work();
    println!("{name}\t{:.9}\t{count}", start.elapsed().as_secs_f64());
    made
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().collect();
    let [file, n, m] = &arguments[1..] else {
        return Err("usage: live FILE N M".into());
    };
    let (n, m): (usize, usize) = (n.parse()?, m.parse()?);
    let all: Vec<_> = points(file)?
        .iter()
        .map(|&[x, y]| Point2::new(x, y))
        .collect();
    let first = all[..n].to_vec();
    let mut mesh = timed("build", n, || Mesh::bulk_load_stable(first))?;
    timed("insert a batch", m, || {
        all[n..n + m]
            .iter()
            .try_for_each(|&p| mesh.insert(p).map(|_| ()))
    })?;
    let spacing = (n as f64).sqrt().recip();
    let there = all[n..n + m / 10]
        .iter()
        .map(|p| Point2::new(p.x + 0.3 * spacing, p.y));
    timed("insert one by one, anywhere", m / 10, || {
        there.clone().try_for_each(|p| mesh.insert(p).map(|_| ()))
    })?;
    // The last vertex takes the place of a removed one: from the back, the others stay.
    let gone = (0..m)
        .rev()
        .map(|i| FixedVertexHandle::from_index(i * (n / m)));
    timed("remove a batch", m, || {
        for v in gone {
            mesh.remove(v);
        }
    });
    Ok(())
}
