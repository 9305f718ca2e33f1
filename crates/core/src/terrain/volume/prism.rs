//! Volumes between two linear functions over a convex polygon.

use super::clip::{MOST, Polygon};
use delone_predicates::Point2;

/// A linear function over a triangle, relative to an origin.
pub struct Linear {
    at: Point2,
    value: f64,
    gradient: Point2,
    /// The least and the greatest value: gradients of thin triangles are inaccurate.
    range: [f64; 2],
}

impl Linear {
    /// The function with given values at the corners of a triangle.
    pub fn over(corners: [Point2; 3], values: [f64; 3], origin: Point2) -> Self {
        let [a, b, c] = corners;
        let (p, q) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (s, t) = (values[1] - values[0], values[2] - values[0]);
        let twice = p[0] * q[1] - p[1] * q[0];
        let gradient = if twice == 0.0 {
            [0.0; 2]
        } else {
            [(s * q[1] - t * p[1]) / twice, (t * p[0] - s * q[0]) / twice]
        };
        Self {
            at: [a[0] - origin[0], a[1] - origin[1]],
            value: values[0],
            gradient,
            range: [
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
        }
    }

    /// The plane c + a x + b y.
    pub fn plane([a, b, c]: [f64; 3], origin: Point2) -> Self {
        Self {
            at: [0.0; 2],
            value: c + a * origin[0] + b * origin[1],
            gradient: [a, b],
            range: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    fn value(&self, p: Point2) -> f64 {
        let [x, y] = [p[0] - self.at[0], p[1] - self.at[1]];
        let value = self.value + (self.gradient[0] * x + self.gradient[1] * y);
        value.max(self.range[0]).min(self.range[1])
    }
}

/// Sums of volumes and areas.
#[derive(Default)]
pub struct Sums {
    /// Below the first surface and above the second: what has to be cut off to reach the second.
    cut: f64,
    /// Above the first surface and below the second.
    fill: f64,
    cut_area: f64,
    fill_area: f64,
    area: f64,
}

impl Sums {
    /// The columns of a row.
    pub fn row(&self) -> [f64; 5] {
        [
            self.cut,
            self.fill,
            self.cut_area,
            self.fill_area,
            self.area,
        ]
    }

    /// Adds what is between two surfaces over a polygon.
    pub fn add(&mut self, over: &Polygon, first: &Linear, second: &Linear) {
        let corners = over.corners();
        let apex = corners[0];
        let mut differences = [0.0; MOST];
        let mut signs = [false; 2];
        for (difference, &p) in differences.iter_mut().zip(corners) {
            *difference = second.value(p) - first.value(p);
            signs[0] |= *difference < 0.0;
            signs[1] |= *difference > 0.0;
        }
        for k in 1..corners.len() - 1 {
            let [b, c] = [corners[k], corners[k + 1]];
            let twice = (b[0] - apex[0]) * (c[1] - apex[1]) - (b[1] - apex[1]) * (c[0] - apex[0]);
            // Rounding may reverse the orientation of a polygon that is nearly flat.
            let area = twice.max(0.0) / 2.0;
            let values = [differences[0], differences[k], differences[k + 1]];
            self.area += area;
            if signs == [true, true] {
                self.split(area, values);
                continue;
            }
            let volume = area * (values[0] + values[1] + values[2]) / 3.0;
            if signs[1] {
                self.fill += volume;
                self.fill_area += area;
            } else if signs[0] {
                self.cut -= volume;
                self.cut_area += area;
            }
        }
    }

    /// Adds a triangle in which the surfaces may cross.
    fn split(&mut self, area: f64, values: [f64; 3]) {
        let (volume, share) = positive(values);
        self.fill += area * volume;
        self.fill_area += area * share;
        let (volume, share) = positive(values.map(|value| -value));
        self.cut += area * volume;
        self.cut_area += area * share;
    }
}

/// For a linear function with these values at the corners: the mean of its positive part, and the
/// share of the area where it is positive.
fn positive(mut values: [f64; 3]) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let [low, mid, high] = values;
    let mean = (low + mid + high) / 3.0;
    if high <= 0.0 {
        (0.0, 0.0)
    } else if low >= 0.0 {
        (mean, 1.0)
    } else if mid <= 0.0 {
        let share = high / (high - mid) * (high / (high - low));
        (share * high / 3.0, share)
    } else {
        // The missing part is a corner below zero.
        let share = low / (low - mid) * (low / (low - high));
        (mean - share * low / 3.0, 1.0 - share)
    }
}
