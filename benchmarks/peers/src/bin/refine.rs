//! spade's refinement: `refine FILE ANGLE AREA OUTPUT`, with the input of `constrained`. Prints the
//! seconds from points and segments to the mesh inside, and writes the corners of its triangles.

use std::collections::HashSet;
use std::env;
use std::fs;
use std::hint::black_box;
use std::time::Instant;

use delone_peers::{Failure, points, segments};
use spade::{AngleLimit, ConstrainedDelaunayTriangulation, RefinementParameters, Triangulation};

/// More than any mesh here needs.
const MOST_ADDED: usize = 20_000_000;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = env::args().collect();
    let [file, angle, area, output] = &arguments[1..] else {
        return Err("usage: refine FILE ANGLE AREA OUTPUT".into());
    };
    let given: Vec<_> = points(file)?
        .iter()
        .map(|&[x, y]| spade::Point2::new(x, y))
        .collect();
    let edges: Vec<_> = segments(&format!("{file}.segments"))?
        .iter()
        .map(|s| s.map(|v| v as usize))
        .collect();
    let parameters = RefinementParameters::<f64>::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(angle.parse()?))
        .with_max_allowed_area(area.parse()?)
        .with_max_additional_vertices(MOST_ADDED);
    let start = Instant::now();
    let mut mesh = ConstrainedDelaunayTriangulation::<spade::Point2<f64>>::bulk_load_cdt(
        black_box(given),
        edges,
    )?;
    let found = mesh.refine(parameters);
    let time = start.elapsed();
    println!("{}", time.as_secs_f64());
    if !found.refinement_complete {
        return Err("not complete".into());
    }
    let outside: HashSet<_> = found.excluded_faces.into_iter().collect();
    let bytes: Vec<u8> = mesh
        .inner_faces()
        .filter(|face| !outside.contains(&face.fix()))
        .flat_map(|face| face.positions())
        .flat_map(|p| [p.x, p.y])
        .flat_map(f64::to_le_bytes)
        .collect();
    Ok(fs::write(output, bytes)?)
}
