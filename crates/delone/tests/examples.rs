//! The examples run to their ends: each checks what it prints.

use std::error::Error;

#[allow(dead_code)]
#[path = "../examples/lidar.rs"]
mod lidar;
#[allow(dead_code)]
#[path = "../examples/mesh.rs"]
mod mesh;
#[allow(dead_code)]
#[path = "../examples/polygon.rs"]
mod polygon;
#[allow(dead_code)]
#[path = "../examples/voronoi.rs"]
mod voronoi;

#[test]
fn each_example_runs() -> Result<(), Box<dyn Error>> {
    lidar::main()?;
    mesh::main()?;
    polygon::main()?;
    voronoi::main()
}
