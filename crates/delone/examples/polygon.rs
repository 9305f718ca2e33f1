//! The inside of a polygon with a hole: `cargo run -p delone --example polygon`

use std::error::Error;

use delone::Constrained;

/// Prints the result and checks it.
pub fn main() -> Result<(), Box<dyn Error>> {
    let lake = vec![
        [0.0, 0.0],
        [8.0, -1.0],
        [10.0, 5.0],
        [6.0, 9.0],
        [-1.0, 6.0],
    ];
    let island = vec![[3.0, 2.0], [6.0, 3.0], [4.0, 6.0]];
    let water = Constrained::polygon(&[lake, island])?;
    for (triangle, on_shore) in water.simplices().zip(water.is_constrained()) {
        let shores = on_shore.iter().filter(|shore| **shore).count();
        println!("{triangle:?}, {shores} edges on the shore");
    }
    let area: f64 = water.sizes()?.iter().sum();
    println!(
        "{area} of water, {} edges of shore",
        water.boundary()?.len()
    );
    if water.locate(&[[4.0, 4.0]])?[0].simplex().is_some() {
        return Err("the island is no water".into());
    }
    Ok(())
}
