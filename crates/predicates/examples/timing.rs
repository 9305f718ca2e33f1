//! Nanoseconds a call, for each predicate, on inputs that end in different stages.
//!
//! `cargo run --release -p delone-predicates --example timing`
//!
//! Each line gives the predicate as a caller sees it, and the stages one by one with the share of
//! the inputs that they answer. Medians of 15 runs over 4096 inputs; one call after the other, with
//! outcomes that the branch predictor cannot learn.

use std::hint::black_box;
use std::time::Instant;

use delone_predicates::{Point2, Point3, Sign, incircle, insphere, orient2d, orient3d, stages};

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn any(&mut self, octaves: f64) -> f64 {
        (self.unit() - 0.5) * 2.0_f64.powf(octaves * (self.unit() - 0.5))
    }

    fn below(&mut self, n: u64) -> f64 {
        (self.bits() % n) as f64
    }

    /// A point of the unit sphere, rounded.
    fn on_sphere<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let p: [f64; D] = std::array::from_fn(|_| 2.0 * self.unit() - 1.0);
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..1.0).contains(&length) {
                return p.map(|x| x / length);
            }
        }
    }
}

const COUNT: usize = 4096;

fn inputs<const D: usize, const N: usize>(
    mut make: impl FnMut() -> [[f64; D]; N],
) -> Vec<[[f64; D]; N]> {
    (0..COUNT).map(|_| make()).collect()
}

/// Median nanoseconds a call and the share of calls that answer.
fn time<I>(inputs: &[I], call: impl Fn(&I) -> Option<Sign>) -> (f64, f64) {
    let mut answered = 0;
    let mut times: Vec<f64> = (0..15)
        .map(|_| {
            let start = Instant::now();
            answered = inputs
                .iter()
                .filter(|i| black_box(call(black_box(i))).is_some())
                .count();
            start.elapsed().as_secs_f64() * 1e9 / inputs.len() as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (times[7], answered as f64 / inputs.len() as f64)
}

macro_rules! report {
    ($name:ident, $what:expr, $inputs:expr, [$($p:ident),+]) => {{
        let inputs = $inputs;
        let (whole, _) = time(&inputs, |&[$($p),+]| Some($name($($p),+)));
        print!("{:9} {:28} {whole:7.1} ", stringify!($name), $what);
        report!(@stage inputs, $name, filter, [$($p),+]);
        report!(@stage inputs, $name, lattice, [$($p),+]);
        report!(@stage inputs, $name, expansion, [$($p),+]);
        report!(@stage inputs, $name, scaled, [$($p),+]);
        let (all, _) = time(&inputs, |&[$($p),+]| Some(stages::$name::integer($($p),+)));
        println!(" {all:8.1}");
    }};
    (@stage $inputs:ident, $name:ident, $stage:ident, [$($p:ident),+]) => {
        let (ns, share) = time(&$inputs, |&[$($p),+]| stages::$name::$stage($($p),+));
        print!(" {ns:6.1} {:4.0}%", 100.0 * share);
    };
}

fn main() {
    let mut r = Random(1);
    println!(
        "predicate input                            whole       filter      lattice    expansion       scaled  integer"
    );
    let mm = |x: f64| (x * 1000.0).round() / 1000.0;
    let utm: Point2 = [512_345.0, 5_403_210.0];
    let utm3: Point3 = [512_345.0, 5_403_210.0, 312.0];

    report!(
        orient2d,
        "uniform",
        inputs(|| [(); 3].map(|()| [r.unit(), r.unit()])),
        [a, b, c]
    );
    report!(
        orient2d,
        "grid 16",
        inputs(|| [(); 3].map(|()| [r.below(16), r.below(16)])),
        [a, b, c]
    );
    report!(
        orient2d,
        "on a line, rounded",
        inputs(|| [(); 3].map(|()| {
            let t = r.unit();
            [t, t / 3.0 + 0.1]
        })),
        [a, b, c]
    );
    report!(
        orient2d,
        "UTM line, mm",
        inputs(|| [(); 3].map(|()| {
            let t = 1000.0 * r.unit();
            [mm(utm[0] + t), mm(utm[1] + 0.5 * t)]
        })),
        [a, b, c]
    );
    report!(
        orient2d,
        "exponents of 600 octaves",
        inputs(|| [(); 3].map(|()| [r.any(600.0), r.any(600.0)])),
        [a, b, c]
    );
    report!(
        orient2d,
        "exponents of 2000 octaves",
        inputs(|| [(); 3].map(|()| [r.any(2000.0), r.any(2000.0)])),
        [a, b, c]
    );

    report!(
        incircle,
        "uniform",
        inputs(|| [(); 4].map(|()| [r.unit(), r.unit()])),
        [a, b, c, d]
    );
    report!(
        incircle,
        "grid, neighbours",
        inputs(|| {
            let o = [r.below(1000), r.below(1000)];
            [(); 4].map(|()| [o[0] + r.below(2), o[1] + r.below(2)])
        }),
        [a, b, c, d]
    );
    report!(
        incircle,
        "circle, rounded",
        inputs(|| [(); 4].map(|()| r.on_sphere::<2>())),
        [a, b, c, d]
    );
    report!(
        incircle,
        "UTM circle, mm",
        inputs(|| [(); 4].map(|()| {
            let p = r.on_sphere::<2>();
            [mm(utm[0] + 3.0 * p[0]), mm(utm[1] + 3.0 * p[1])]
        })),
        [a, b, c, d]
    );
    report!(
        incircle,
        "UTM grid, mm",
        inputs(|| [(); 4].map(|()| [mm(utm[0] + 0.1 * r.below(4)), mm(utm[1] + 0.1 * r.below(4))])),
        [a, b, c, d]
    );
    report!(
        incircle,
        "tiny circle, ties",
        inputs(|| {
            let p = r.on_sphere::<2>();
            let [x, y] = [p[0] * r.unit() / 1e6, p[1]];
            [[x, y], [-x, y], [-x, -y], [x, -y]]
        }),
        [a, b, c, d]
    );
    report!(
        incircle,
        "exponents of 600 octaves",
        inputs(|| [(); 4].map(|()| [r.any(600.0), r.any(600.0)])),
        [a, b, c, d]
    );
    report!(
        incircle,
        "exponents of 2000 octaves",
        inputs(|| [(); 4].map(|()| [r.any(2000.0), r.any(2000.0)])),
        [a, b, c, d]
    );

    report!(
        orient3d,
        "uniform",
        inputs(|| [(); 4].map(|()| [(); 3].map(|()| r.unit()))),
        [a, b, c, d]
    );
    report!(
        orient3d,
        "grid 4",
        inputs(|| [(); 4].map(|()| [(); 3].map(|()| r.below(4)))),
        [a, b, c, d]
    );
    report!(
        orient3d,
        "on a plane, rounded",
        inputs(|| [(); 4].map(|()| {
            let [s, t] = [r.unit(), r.unit()];
            [s, t, (s + t) / 3.0]
        })),
        [a, b, c, d]
    );
    report!(
        orient3d,
        "exponents of 2000 octaves",
        inputs(|| [(); 4].map(|()| [(); 3].map(|()| r.any(2000.0)))),
        [a, b, c, d]
    );

    report!(
        insphere,
        "uniform",
        inputs(|| [(); 5].map(|()| [(); 3].map(|()| r.unit()))),
        [a, b, c, d, e]
    );
    report!(
        insphere,
        "grid, neighbours",
        inputs(|| [(); 5].map(|()| [(); 3].map(|()| r.below(2)))),
        [a, b, c, d, e]
    );
    report!(
        insphere,
        "sphere, rounded",
        inputs(|| [(); 5].map(|()| r.on_sphere::<3>())),
        [a, b, c, d, e]
    );
    report!(
        insphere,
        "UTM grid, mm",
        inputs(|| [(); 5].map(|()| std::array::from_fn(|k| mm(utm3[k] + 0.1 * r.below(2))))),
        [a, b, c, d, e]
    );
    report!(
        insphere,
        "UTM sphere, mm",
        inputs(|| [(); 5].map(|()| {
            let p = r.on_sphere::<3>();
            std::array::from_fn(|k| mm(utm3[k] + 3.0 * p[k]))
        })),
        [a, b, c, d, e]
    );
    report!(
        insphere,
        "exponents of 2000 octaves",
        inputs(|| [(); 5].map(|()| [(); 3].map(|()| r.any(2000.0)))),
        [a, b, c, d, e]
    );
}
