//! Shared code of the fuzz targets: coordinates from bytes, and the oracle of the predicates.

#[path = "../../crates/predicates/tests/suite/oracle/mod.rs"]
pub mod oracle;

use libfuzzer_sys::arbitrary::{Result, Unstructured};
use oracle::points::{power_of_two, ulps};
use oracle::{Answers, Predicate};

/// Coordinates from bytes, in ways that are hard for predicates: any bit pattern, a lattice chosen
/// by the fuzzer, or an earlier coordinate as it is, negated, or moved by a few doubles. All are
/// finite.
pub struct Coordinates {
    unit: f64,
    offset: f64,
    earlier: Vec<f64>,
}

impl Coordinates {
    /// Takes the unit and the offset of the lattice from the bytes.
    pub fn new(bytes: &mut Unstructured) -> Result<Self> {
        let unit = power_of_two(bytes.int_in_range(-1074..=1000)?);
        let offset = match bytes.arbitrary()? {
            true => unit * f64::from(bytes.arbitrary::<i32>()?),
            false => 0.0,
        };
        Ok(Self {
            unit,
            offset: finite(offset),
            earlier: vec![0.0],
        })
    }

    /// The next coordinate.
    pub fn next(&mut self, bytes: &mut Unstructured) -> Result<f64> {
        let earlier = *bytes.choose(&self.earlier)?;
        let x = match bytes.int_in_range(0..=7)? {
            0 => f64::from_bits(bytes.arbitrary()?),
            1 => self.unit * f64::from(bytes.arbitrary::<i8>()?) + self.offset,
            2 => self.unit * f64::from(bytes.arbitrary::<i32>()?) + self.offset,
            3 => earlier,
            4 => -earlier,
            5 => ulps(earlier, i64::from(bytes.arbitrary::<i8>()?)),
            6 => earlier + earlier,
            _ => earlier * power_of_two(bytes.int_in_range(-1074..=1000)?),
        };
        self.earlier.push(finite(x));
        Ok(finite(x))
    }

    /// The next point.
    pub fn point<const D: usize>(&mut self, bytes: &mut Unstructured) -> Result<[f64; D]> {
        let mut point = [0.0; D];
        for x in &mut point {
            *x = self.next(bytes)?;
        }
        Ok(point)
    }
}

fn finite(x: f64) -> f64 {
    if x.is_nan() {
        0.0
    } else {
        x.clamp(f64::MIN, f64::MAX)
    }
}

/// `N` points from bytes.
pub fn points<const D: usize, const N: usize>(bytes: &[u8]) -> Result<[[f64; D]; N]> {
    let mut bytes = Unstructured::new(bytes);
    let mut coordinates = Coordinates::new(&mut bytes)?;
    let mut points = [[0.0; D]; N];
    for point in &mut points {
        *point = coordinates.point(&mut bytes)?;
    }
    Ok(points)
}

/// Compares all stages of a predicate with the oracle. For a canonical variant, also checks that
/// swapping the first two points negates the sign, and that it decides ties only.
pub fn check<const D: usize, const N: usize>(
    predicate: &Predicate<D, N>,
    canonical: Option<oracle::Whole<D, N>>,
    bytes: &[u8],
) {
    let Ok(points) = points(bytes) else { return };
    let sign = predicate.check(points, &mut Answers::default());
    if let Some(canonical) = canonical {
        let perturbed = canonical(points);
        assert!(sign.is_zero() || perturbed == sign, "{points:?}");
        let mut swapped = points;
        swapped.swap(0, 1);
        assert_eq!(canonical(swapped), -perturbed, "{points:?}");
    }
}
