//! Heights between scattered measurements: triangulate the points of a survey, then interpolate
//! linearly in the triangles. `cargo run -p delone --example lidar`

use std::error::Error;

use delone::{Location, Point2, Triangulation};

/// A terrain, and points on it as a scanner leaves them: rows of points, and a few of them twice.
fn survey(count: u32) -> (Vec<Point2>, Vec<f64>) {
    let along = |i: u32| (f64::from(i) * 0.618_034).fract() * 100.0;
    let across = |i: u32| f64::from(i) / f64::from(count) * 100.0;
    let points: Vec<Point2> = (0..count)
        .chain(0..9)
        .map(|i| [along(i), across(i)])
        .collect();
    let heights = points.iter().map(|&p| height(p)).collect();
    (points, heights)
}

fn height([x, y]: Point2) -> f64 {
    3.0 * (x / 20.0).sin() + 2.0 * (y / 15.0).cos()
}

/// Prints the result and checks it.
pub fn main() -> Result<(), Box<dyn Error>> {
    let (points, heights) = survey(20_000);
    let ground = Triangulation::new(&points)?;
    let triangles: Vec<_> = ground.simplices().collect();
    println!(
        "{} points, {} duplicates",
        points.len(),
        ground.duplicates().len()
    );
    println!("{} triangles", triangles.len());

    let queries: Vec<Point2> = (1..20).map(|i| [5.0 * f64::from(i), 50.0]).collect();
    for (query, place) in queries.iter().zip(ground.locate(&queries)?) {
        match place {
            Location::Inside { simplex, weights } => {
                let corners = triangles[simplex].into_iter().zip(weights);
                let z: f64 = corners.map(|(v, w)| w * heights[v]).sum();
                println!("{query:?}: {z:.2} (exact {:.2})", height(*query));
                if (z - height(*query)).abs() > 0.05 {
                    return Err("the terrain is smoother than that".into());
                }
            }
            Location::Outside { .. } => println!("{query:?}: outside of the survey"),
        }
    }
    Ok(())
}
