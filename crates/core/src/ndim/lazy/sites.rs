//! Points with any number of coordinates: distinct, scaled, sorted into a tree.
//!
//! They are scaled as in `ndim::sites`. A query is scaled with them and may need a finer unit, so
//! whether the filters hold is decided for each query.

use delone_predicates::arithmetic::bit_span;
use num_bigint::BigInt;

use super::super::frame::Integers;
use super::super::sites::{SMALL, WIDEST, factor};
use super::tree::Tree;
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, push, with_room};
use crate::base::points::{LIMIT3, finite};
use crate::base::wide;

/// The exponents of the lowest and, plus 1, of the highest bit of numbers.
#[derive(Clone, Copy)]
struct Bits {
    low: i32,
    high: i32,
}

impl Bits {
    fn of(numbers: &[f64]) -> Self {
        let mut bits = Self {
            low: i32::MAX,
            high: i32::MIN,
        };
        for &x in numbers {
            // A width of zero: the number is zero.
            if let Some((low, width @ 1..)) = bit_span(&[[x]]) {
                bits.low = bits.low.min(low);
                bits.high = bits.high.max(low + width as i32);
            }
        }
        bits
    }
}

/// Distinct points, numbered as the tree has them.
pub struct Sites {
    /// The number of coordinates.
    pub d: usize,
    /// The coordinates as they were given.
    given: Vec<f64>,
    /// The coordinates times 2^-high.
    scaled: Vec<f64>,
    /// The place of each site in lexicographic order: ties are decided by it.
    pub place: Vec<u32>,
    /// The first row of each site.
    pub rows: Vec<u32>,
    /// Rows that repeat earlier rows, ascending, and the first of these.
    pub duplicates: Vec<[u32; 2]>,
    /// Boxes of sites, in the scaled coordinates.
    pub tree: Tree,
    /// The lowest, then the highest coordinates, as they were given.
    extent: Vec<f64>,
    /// Exponents of the bits of all coordinates.
    low: i32,
    high: i32,
}

impl Sites {
    /// From finite points, row by row.
    pub fn new(points: &[f64], d: usize) -> Result<Self> {
        let n = points.len() / d;
        if n > LIMIT3 {
            return Err(Error::TooMany {
                found: n,
                limit: LIMIT3,
            });
        }
        finite(points, d)?;
        // Lexicographic order, and of equal points the first row.
        let at = |row: u32| &points[row as usize * d..][..d];
        let mut sorted = with_room(n)?;
        sorted.extend(0..n as u32);
        sorted.sort_unstable_by(|&i, &j| {
            let order = at(i).partial_cmp(at(j));
            order.unwrap_or(std::cmp::Ordering::Equal).then(i.cmp(&j))
        });
        let mut duplicates = Vec::new();
        let mut distinct = with_room(n)?;
        for row in sorted {
            match distinct.last() {
                Some(&first) if at(first) == at(row) => push(&mut duplicates, [row, first])?,
                _ => distinct.push(row),
            }
        }
        duplicates.sort_unstable();
        let sorted = distinct;
        let Bits { mut low, mut high } = Bits::of(points);
        if low > high {
            (low, high) = (0, 1);
        }
        let mut flat = with_room(sorted.len() * d)?;
        for &row in &sorted {
            flat.extend(at(row).iter().map(|&x| scaled(x, high)));
        }
        let mut place = with_room(sorted.len())?;
        place.extend(0..sorted.len() as u32);
        let tree = Tree::new(&flat, d, &mut place)?;
        let (mut given, mut shrunk) = (with_room(flat.len())?, with_room(flat.len())?);
        let mut rows = with_room(place.len())?;
        for &i in &place {
            rows.push(sorted[i as usize]);
            given.extend_from_slice(at(sorted[i as usize]));
            shrunk.extend_from_slice(&flat[i as usize * d..][..d]);
        }
        let mut extent = filled(2 * d, f64::INFINITY)?;
        extent[d..].fill(f64::NEG_INFINITY);
        for p in points.chunks_exact(d) {
            for k in 0..d {
                extent[k] = extent[k].min(p[k]);
                extent[d + k] = extent[d + k].max(p[k]);
            }
        }
        Ok(Self {
            d,
            given,
            scaled: shrunk,
            place,
            rows,
            duplicates,
            tree,
            extent,
            low,
            high,
        })
    }

    /// The number of sites.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The scaled coordinates of a site.
    #[inline(always)]
    pub fn at(&self, p: u32) -> &[f64] {
        &self.scaled[p as usize * self.d..][..self.d]
    }

    /// The lowest and the highest coordinates, as they were given.
    pub fn extent(&self) -> (&[f64], &[f64]) {
        self.extent.split_at(self.d)
    }

    /// The nearest sites, up to roundings.
    pub fn nearest(&self, q: &[f64], count: usize) -> Result<Vec<u32>> {
        self.tree.nearest(&self.scaled, q, count)
    }

    /// The coordinates of a site as they were given.
    fn given(&self, p: u32) -> &[f64] {
        &self.given[p as usize * self.d..][..self.d]
    }
}

/// `x 2^-high`, in two factors, as one may not be a double.
fn scaled(x: f64, high: i32) -> f64 {
    x * factor(-high / 2) * factor(-high - (-high / 2))
}

/// The sites with a query, which has the number [`Around::query`].
pub struct Around<'a> {
    pub sites: &'a Sites,
    /// The scaled query.
    pub q: Vec<f64>,
    /// Whether the filters hold for the sites, and for the query.
    pub filtered: bool,
    pub filtered_query: bool,
    /// The query as it was given.
    given: Vec<f64>,
    /// Sites whose mean is the query, in place of what was given.
    mean: Vec<u32>,
    low: i64,
    bits: u32,
    /// The factor that makes scaled coordinates integers, if they have few bits.
    units: Option<f64>,
}

impl<'a> Around<'a> {
    /// With a finite query in the box of the sites.
    pub fn new(sites: &'a Sites, query: &[f64]) -> Result<Self> {
        let of_query = Bits::of(query);
        let low = sites.low.min(of_query.low);
        let span = (sites.high - low) as u32;
        let mut q = with_room(sites.d)?;
        q.extend(query.iter().map(|&x| scaled(x, sites.high)));
        let filtered = span <= WIDEST;
        Ok(Self {
            sites,
            q,
            filtered,
            filtered_query: filtered,
            given: copied(query)?,
            mean: Vec::new(),
            low: low.into(),
            bits: span + 1,
            units: (span < SMALL).then(|| factor(span as i32)),
        })
    }

    /// With the mean of `d + 1` sites as the query, which is inside their simplex.
    pub fn mean(sites: &'a Sites, of: &[u32]) -> Result<Self> {
        let count = of.len() as f64;
        let mean = |k: usize| of.iter().map(|&p| sites.at(p)[k]).sum::<f64>() / count;
        let mut q = with_room(sites.d)?;
        q.extend((0..sites.d).map(mean));
        let span = (sites.high - sites.low) as u32;
        Ok(Self {
            sites,
            q,
            filtered: span <= WIDEST,
            filtered_query: false,
            given: Vec::new(),
            mean: copied(of)?,
            low: sites.low.into(),
            // Integers are multiplied by d + 1.
            bits: span + 1 + (sites.d as u32 + 1).ilog2() + 1,
            units: None,
        })
    }

    /// The number of the query.
    pub fn query(&self) -> u32 {
        self.sites.len() as u32
    }

    /// The scaled coordinates of a site or of the query.
    #[inline(always)]
    pub fn at(&self, p: u32) -> &[f64] {
        if p == self.query() {
            &self.q
        } else {
            self.sites.at(p)
        }
    }

    /// Whether the filters hold for the differences of this point from sites.
    pub fn holds(&self, p: u32) -> bool {
        if p == self.query() {
            self.filtered_query
        } else {
            self.filtered
        }
    }

    /// The site with the same coordinates as the query, if it is the one that is given.
    pub fn is_query(&self, p: u32) -> bool {
        self.mean.is_empty() && self.sites.given(p) == self.given
    }

    /// A coordinate in units.
    fn integer(&self, p: u32, k: usize) -> BigInt {
        let of = |p: u32| wide::scaled(self.sites.given(p)[k], self.low);
        if self.mean.is_empty() {
            return if p == self.query() {
                wide::scaled(self.given[k], self.low)
            } else {
                of(p)
            };
        }
        if p == self.query() {
            self.mean.iter().map(|&p| of(p)).sum()
        } else {
            of(p) * self.mean.len()
        }
    }
}

impl Integers for Around<'_> {
    #[inline(always)]
    fn dimension(&self) -> usize {
        self.sites.d
    }

    fn bits(&self) -> u32 {
        self.bits
    }

    fn is_small(&self) -> bool {
        self.units.is_some()
    }

    #[inline]
    fn small(&self, p: u32, o: u32, k: usize) -> Option<i64> {
        let units = self.units?;
        // Below 2^60 units, so these are integers, exactly.
        Some((self.at(p)[k] * units) as i64 - (self.at(o)[k] * units) as i64)
    }

    fn wide(&self, p: u32, o: u32, k: usize) -> BigInt {
        match self.small(p, o, k) {
            Some(difference) => difference.into(),
            None => self.integer(p, k) - self.integer(o, k),
        }
    }
}
