//! Small hostile sets, and random numbers that are the same everywhere.

pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d)
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) % n
    }

    /// From 0 to 1, with 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.below(1 << 27) << 26 | self.below(1 << 26)) as f64 / (1u64 << 53) as f64
    }

    /// From `low` to `high`, both included.
    pub fn integer(&mut self, low: i64, high: i64) -> f64 {
        (low + self.below((high - low + 1) as u64) as i64) as f64
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i as u64 + 1) as usize);
        }
    }
}

/// The corners of a cube.
pub fn corners<const D: usize>(side: f64) -> Vec<[f64; D]> {
    (0..1u32 << D)
        .map(|i| std::array::from_fn(|k| if i >> k & 1 == 1 { side } else { 0.0 }))
        .collect()
}

/// Lattice points with squared length 4.
fn cospherical<const D: usize>() -> Vec<[f64; D]> {
    let all = 5usize.pow(D as u32);
    (0..all)
        .map(|i| std::array::from_fn(|k| (i / 5usize.pow(k as u32) % 5) as f64 - 2.0))
        .filter(|p: &[f64; D]| p.iter().map(|x| x * x).sum::<f64>() == 4.0)
        .collect()
}

/// One set of each kind.
pub fn kinds<const D: usize>(r: &mut Random) -> Vec<(&'static str, Vec<[f64; D]>)> {
    let n = [14, 11, 10, 10, 10, 11, 11][D - 2];
    let mut all = Vec::new();
    let mut cube = corners::<D>(1.0);
    r.shuffle(&mut cube);
    cube.truncate(n + 2);
    all.push(("cube", cube.clone()));
    cube.truncate(n);
    cube.push([0.5; D]);
    all.push(("cube and center", cube));
    let cross: Vec<[f64; D]> = (0..2 * D)
        .map(|i| {
            std::array::from_fn(|k| match i {
                _ if i / 2 != k => 0.0,
                _ if i % 2 == 0 => 1.0,
                _ => -1.0,
            })
        })
        .take(12)
        .collect();
    all.push(("cross-polytope", cross.clone()));
    all.push((
        "cross-polytope and center",
        [cross, vec![[0.0; D]]].concat(),
    ));
    let powers = |t: f64| std::array::from_fn(|k| t.powi(k as i32 + 1));
    let half = (n / 2) as i64;
    all.push((
        "cyclic",
        (-half..n as i64 - half).map(|t| powers(t as f64)).collect(),
    ));
    all.push((
        "cyclic, repeated",
        (0..n).map(|_| powers(r.integer(-3, 4))).collect(),
    ));
    let mut on_sphere = cospherical::<D>();
    r.shuffle(&mut on_sphere);
    on_sphere.truncate(n);
    let moved = |by: f64, to: f64| on_sphere.iter().map(|p| p.map(|x| x * by + to)).collect();
    all.push(("cospherical", moved(1.0, 0.0)));
    all.push(("cospherical, scaled", moved(0.1, 0.0)));
    all.push(("cospherical, far away", moved(0.125, 4_500_000.1)));
    let cells = |r: &mut Random, n: usize, low: i64, high: i64| -> Vec<[f64; D]> {
        (0..n)
            .map(|_| std::array::from_fn(|_| r.integer(low, high)))
            .collect()
    };
    all.push(("lattice", cells(r, n, 0, 2)));
    let ball = cells(r, n, -2, 2);
    all.push(("lattice, repeated", [&ball[..], &ball[..3]].concat()));
    let rank = 1 + r.below(D as u64 - 1) as usize;
    let basis = cells(r, rank, -3, 3);
    let combined = |r: &mut Random| {
        basis.iter().fold([0.0; D], |sum, b| {
            let times = r.integer(-2, 2);
            std::array::from_fn(|k| sum[k] + times * b[k])
        })
    };
    all.push(("flat", (0..n).map(|_| combined(r)).collect()));
    let mut facet = cells(r, n, -2, 2);
    for p in &mut facet[2..] {
        p[D - 1] = 0.0;
    }
    all.push(("facet and two points", facet));
    let mut two = cells(r, n, 0, 2);
    for (i, p) in two.iter_mut().enumerate() {
        let empty = if i % 2 == 0 { D / 2..D } else { 0..D / 2 };
        p[empty].fill(0.0);
    }
    all.push(("two flats", two));
    all.push((
        "random",
        (0..n).map(|_| std::array::from_fn(|_| r.unit())).collect(),
    ));
    let noise = |r: &mut Random| r.integer(0, 1) + 1e-16 * r.integer(0, 4);
    all.push((
        "lattice and noise",
        (0..n).map(|_| std::array::from_fn(|_| noise(r))).collect(),
    ));
    all.push((
        "thirds",
        cells(r, n, 0, 3)
            .iter()
            .map(|p| p.map(|x| x / 3.0))
            .collect(),
    ));
    let composition = |r: &mut Random| {
        let mut p = [0.0; D];
        for _ in 0..6 {
            if let Some(x) = p.get_mut(r.below(D as u64 + 1) as usize) {
                *x += 1.0;
            }
        }
        p.map(|x| x / 6.0)
    };
    all.push(("compositions", (0..n).map(|_| composition(r)).collect()));
    let wide = |r: &mut Random| r.integer(-3, 3) * 2f64.powi(r.integer(-40, 39) as i32);
    all.push((
        "wide exponents",
        (0..n).map(|_| std::array::from_fn(|_| wide(r))).collect(),
    ));
    // On a sphere up to rounding, which double-double decides.
    let near = |r: &mut Random| {
        let p: [f64; D] = std::array::from_fn(|_| r.unit() - 0.5);
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    all.push(("near a sphere", (0..n).map(|_| near(r)).collect()));
    all
}
