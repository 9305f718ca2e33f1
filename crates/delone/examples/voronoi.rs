//! The area that belongs to each of some stations: Voronoi cells in a box.
//! `cargo run -p delone --example voronoi`

use std::error::Error;

use delone::{Triangulation, Voronoi};

/// Prints the result and checks it.
pub fn main() -> Result<(), Box<dyn Error>> {
    let stations = [[1.0, 1.0], [7.0, 2.0], [4.0, 5.0], [8.0, 8.0], [2.0, 9.0]];
    let triangulation = Triangulation::new(&stations)?;
    let cells = Voronoi::new(&triangulation)?.clip([0.0, 0.0], [10.0, 10.0])?;
    let mut total = 0.0;
    for (row, station) in stations.iter().enumerate() {
        let corners = cells.polygon(row).len();
        println!(
            "{station:?}: area {:.3}, {corners} corners",
            cells.area(row)
        );
        total += cells.area(row);
    }
    println!("together {total}");
    if (total - 100.0).abs() > 1e-9 {
        return Err("the cells fill the box".into());
    }
    Ok(())
}
