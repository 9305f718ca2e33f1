//! What the programs of this crate share: the files that `benchmarks/` exchanges with them, and the
//! turns that the peers take.

use std::error::Error;
use std::fs;
use std::io::Result as Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

pub type Points = Vec<[f64; 2]>;
pub type Failure = Box<dyn Error>;

/// The time of the call, and the triangles by their coordinates, taken out after it.
pub struct Outcome {
    pub time: Duration,
    pub triangles: Vec<[[f64; 2]; 3]>,
}

/// A file's little-endian doubles, x and y in turn.
pub fn points(file: &str) -> Read<Points> {
    let number = |b: &[u8]| f64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7]]);
    let row = |row: &[u8]| [number(&row[..8]), number(&row[8..])];
    Ok(fs::read(file)?.chunks_exact(16).map(row).collect())
}

/// A file's little-endian pairs of 32-bit rows.
pub fn segments(file: &str) -> Read<Vec<[u32; 2]>> {
    let number = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    let row = |row: &[u8]| [number(&row[..4]), number(&row[4..])];
    Ok(fs::read(file)?.chunks_exact(8).map(row).collect())
}

fn write(file: &str, triangles: &[[[f64; 2]; 3]]) -> Read<()> {
    let numbers = triangles.as_flattened().as_flattened();
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(file, bytes)
}

/// A peer's name, and its call on an input.
pub type Peer<Input> = (&'static str, fn(&Input) -> Result<Outcome, Failure>);

/// Lets the peers take turns on one input: prints a line for each run (peer, seconds, triangles) and
/// puts the corners of each peer's first triangles beside `file`. A peer that fails goes on failing.
pub fn compete<Input>(
    peers: &[Peer<Input>],
    input: &Input,
    runs: usize,
    file: &str,
) -> Result<(), Failure> {
    for run in 0..runs {
        for (name, call) in peers {
            let outcome = catch_unwind(AssertUnwindSafe(|| call(input)));
            match outcome.unwrap_or_else(|_| Err("panics".into())) {
                Ok(Outcome { time, triangles }) => {
                    println!("{name}\t{}\t{}", time.as_secs_f64(), triangles.len());
                    if run == 0 {
                        write(&format!("{file}.{name}"), &triangles)?;
                    }
                }
                Err(error) => println!("{name}\tfailed\t{error}"),
            }
        }
    }
    Ok(())
}
