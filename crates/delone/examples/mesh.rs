//! A mesh for finite elements: a plate with a hole, bounded angles and areas.
//! `cargo run -p delone --example mesh`

use std::error::Error;
use std::f64::consts::TAU;

use delone::{Constrained, Options};

/// Prints the result and checks it.
pub fn main() -> Result<(), Box<dyn Error>> {
    let plate = vec![[-4.0, -2.0], [4.0, -2.0], [4.0, 2.0], [-4.0, 2.0]];
    let angle = |i: u32| TAU * f64::from(i) / 32.0;
    let hole = (0..32).map(|i| [angle(i).cos(), angle(i).sin()]).collect();
    let domain = Constrained::polygon(&[plate, hole])?;
    let mesh = Options::new()
        .min_angle(28.0)
        .max_area(0.05)
        .mesh(&domain)?;
    let smallest = mesh.min_angles()?.into_iter().fold(60.0, f64::min);
    println!(
        "{} vertices, {} of them added",
        mesh.points().len(),
        mesh.added().len()
    );
    println!(
        "{} triangles, smallest angle {smallest:.1} degrees",
        mesh.simplices().len()
    );
    if !mesh.is_complete() || smallest < 28.0 {
        return Err("the mesh does not meet its bounds".into());
    }
    Ok(())
}
