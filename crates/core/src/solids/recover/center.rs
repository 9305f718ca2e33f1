//! The point that is farthest from planes around it: a linear program in four unknowns.
//!
//! The simplex method on the dual: four planes determine a point at one distance from all of them,
//! and the plane that it violates most replaces one of them.

use delone_predicates::Point3;

/// A plane: a unit normal that points inward, and the distance of the origin behind it.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// The normal.
    pub normal: Point3,
    /// Points x with normal . x > offset are inside.
    pub offset: f64,
}

/// The most exchanges.
const MOST: usize = 400;

/// The center of the largest ball in front of all planes, and its radius, which may be negative.
/// The planes must bound a region of size about 1 around the origin.
pub fn center(planes: &[Plane]) -> Option<(Point3, f64)> {
    const FAR: f64 = 8.0;
    let root = 1.0 / 3.0_f64.sqrt();
    let outer = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-root, -root, -root],
    ];
    let mut all: Vec<Plane> = outer
        .iter()
        .map(|&normal| Plane {
            normal,
            offset: -FAR,
        })
        .collect();
    all.extend_from_slice(planes);
    let mut base = [0, 1, 2, 3];
    let mut best = None;
    for _ in 0..MOST {
        let row = |i: usize| {
            let n = all[base[i]].normal;
            [n[0], n[1], n[2], -1.0, all[base[i]].offset]
        };
        // The ball that touches the four planes of the base: n . x - r = offset for them.
        let [x, y, z, r] = solve([row(0), row(1), row(2), row(3)])?;
        best = Some(([x, y, z], r));
        let slack = |p: &Plane| p.normal[0] * x + p.normal[1] * y + p.normal[2] * z - p.offset - r;
        // The plane that cuts it most enters the base.
        let worst = (0..all.len()).min_by(|&i, &j| slack(&all[i]).total_cmp(&slack(&all[j])))?;
        if slack(&all[worst]) > -1e-13 || base.contains(&worst) {
            break;
        }
        // Weights with which the base sums to zero, and weights with which it sums to the new
        // plane.
        let column = |target: [f64; 4]| {
            let row = |k: usize| {
                let at = |i: usize| match k {
                    3 => 1.0,
                    _ => all[base[i]].normal[k],
                };
                [at(0), at(1), at(2), at(3), target[k]]
            };
            solve([row(0), row(1), row(2), row(3)])
        };
        let n = all[worst].normal;
        let weights = column([0.0, 0.0, 0.0, 1.0])?;
        let change = column([n[0], n[1], n[2], 1.0])?;
        // The plane whose weight reaches zero first leaves the base.
        let ratio = |i: usize| weights[i].max(0.0) / change[i];
        let out = (0..4)
            .filter(|&i| change[i] > 1e-14)
            .min_by(|&i, &j| ratio(i).total_cmp(&ratio(j)))?;
        base[out] = worst;
    }
    best
}

/// Four linear equations in four unknowns, by elimination with pivots.
fn solve(mut m: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    for k in 0..4 {
        let pivot = (k..4).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs()))?;
        m.swap(k, pivot);
        if m[k][k] == 0.0 || !m[k][k].is_finite() {
            return None;
        }
        for i in k + 1..4 {
            let factor = m[i][k] / m[k][k];
            let pivot = m[k];
            for (x, p) in m[i].iter_mut().zip(pivot).skip(k) {
                *x -= factor * p;
            }
        }
    }
    let mut x = [0.0; 4];
    for k in (0..4).rev() {
        let known: f64 = (k + 1..4).map(|j| m[k][j] * x[j]).sum();
        x[k] = (m[k][4] - known) / m[k][k];
    }
    x.iter().all(|v| v.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_center_of_a_cube() {
        let planes: Vec<Plane> = (0..6)
            .map(|k| {
                let mut normal = [0.0; 3];
                normal[k / 2] = if k % 2 == 0 { 1.0 } else { -1.0 };
                let offset = if k == 0 { 0.0 } else { -1.0 };
                Plane { normal, offset }
            })
            .collect();
        let (_, r) = center(&planes).unwrap();
        assert!((r - 0.5).abs() < 1e-12);
        let (p, r) = center(&planes[..5]).unwrap();
        assert!((p[0] - 0.5).abs() < 1.0 && r > 0.49);
    }
}
