//! Generators of points: seeded, near-degenerate, and over the whole range of doubles.

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// An integer from `low` to `high`.
    pub fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// Whether an event of probability 1 / n happens.
    pub fn one_in(&mut self, n: i64) -> bool {
        self.integer(1, n) == 1
    }

    /// A double in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A finite double, sign, exponent and fraction uniform; the binary exponent within bounds.
    pub fn any(&mut self, low: i64, high: i64) -> f64 {
        let exponent = self.integer(low, high);
        let x = power_of_two(exponent) * (1.0 + self.unit());
        if self.one_in(2) { x } else { -x }
    }

    /// A double with few fraction bits and a binary exponent within bounds, or zero.
    pub fn sparse(&mut self, low: i64, high: i64) -> f64 {
        let exponent = self.integer(low, high);
        (self.integer(-3, 3) as f64 * power_of_two(exponent)).clamp(f64::MIN, f64::MAX)
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[(self.bits() % from.len() as u64) as usize]
    }
}

/// 2^exponent, rounded where subnormal cannot hold it (below -1074: zero).
pub fn power_of_two(exponent: i64) -> f64 {
    2.0_f64.powi((exponent / 2) as i32) * 2.0_f64.powi((exponent - exponent / 2) as i32)
}

/// `x` moved by `steps` doubles; stays finite.
pub fn ulps(x: f64, steps: i64) -> f64 {
    let size = x.abs().to_bits() as i64;
    let largest = f64::MAX.to_bits() as i64;
    let line = (if x < 0.0 { -size } else { size } + steps).clamp(-largest, largest);
    if line < 0 {
        -f64::from_bits(-line as u64)
    } else {
        f64::from_bits(line as u64)
    }
}

/// Each coordinate moved by up to `most` doubles.
pub fn shaken<const D: usize>(p: [f64; D], most: i64, random: &mut Random) -> [f64; D] {
    p.map(|x| ulps(x, random.integer(-most, most)))
}

/// Points with integer coordinates at one distance from the origin: 5^2 13^2 17^2 = 1105^2 has
/// 108 in the plane.
pub fn circle_of_integers(radius: i64) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for x in -radius..=radius {
        let square = radius * radius - x * x;
        let y = (square as f64).sqrt().round() as i64;
        if y * y == square {
            points.push([x as f64, y as f64]);
            if y != 0 {
                points.push([x as f64, -y as f64]);
            }
        }
    }
    points
}

/// Points with integer coordinates at the squared distance `square` from the origin.
pub fn sphere_of_integers(square: i64) -> Vec<[f64; 3]> {
    let most = (square as f64).sqrt() as i64;
    let mut points = Vec::new();
    for x in -most..=most {
        for y in -most..=most {
            let rest = square - x * x - y * y;
            let z = (rest.max(0) as f64).sqrt().round() as i64;
            if z * z == rest {
                points.push([x as f64, y as f64, z as f64]);
                if z != 0 {
                    points.push([x as f64, y as f64, -z as f64]);
                }
            }
        }
    }
    points
}
