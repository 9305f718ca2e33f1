//! The simplex that contains a query: proposed by the linear program, proven, and found by exact
//! steps if nothing is proposed.

use std::ops::Range;
use std::sync::OnceLock;

use num_bigint::Sign;

use super::super::triangulate::independent;
use super::program::{End, Program};
use super::proven::Proven;
use super::sites::{Around, Sites};
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, filled, push, with_room};
use crate::base::watch::{Pace, Watch};

/// When fast steps, which are not proven to terminate, give way to steps that terminate.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Proposals before exact steps.
    pub proposals: usize,
    /// Pivots by the largest conflict before those by the smallest number, which never cycle.
    pub largest: usize,
}

impl Limits {
    /// Far more than are needed: queries of random points take one to three proposals, and a few
    /// tens of exact pivots.
    pub const USUAL: Self = Self {
        proposals: 60,
        largest: 200,
    };
}

/// Units of work between two checks for interruption; a site that is tested is one.
const PACE: usize = 1 << 16;

/// A query that is inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Inside {
    /// The corners of the simplex, as numbers of sites.
    pub corners: Vec<u32>,
    /// The barycentric coordinates of the query.
    pub weights: Vec<f64>,
}

/// Points whose triangulation is never computed.
pub struct Search {
    pub sites: Sites,
    /// A simplex of the triangulation, where exact walks start.
    first: OnceLock<Vec<u32>>,
    /// Affinely independent sites.
    spanning: Vec<u32>,
    limits: Limits,
}

/// How many queries were answered in each way.
#[derive(Default, Clone, Copy, Debug, PartialEq)]
pub struct Counts {
    /// By the simplex of the previous query.
    pub again: u64,
    /// By a proposal.
    pub proposed: u64,
    /// By exact pivots from a proposal.
    pub pivots: u64,
    /// Outside by a plane.
    pub apart: u64,
    /// By exact steps.
    pub walks: u64,
}

/// What one thread keeps from query to query.
#[derive(Default)]
pub struct Worker {
    pub counts: Counts,
    last: Option<Proven>,
}

impl Search {
    /// From finite points, row by row, that span the space.
    pub fn new(points: &[f64], d: usize, limits: Limits, watch: &Watch) -> Result<Self> {
        let sites = Sites::new(points, d)?;
        let mut search = Self {
            sites,
            first: OnceLock::new(),
            spanning: Vec::new(),
            limits,
        };
        let mut pace = Pace::new(watch, PACE);
        let count = search.sites.len();
        let mut order = with_room(count)?;
        order.extend(0..count as u32);
        if count > 0 {
            let origin = filled(d, 0.0)?;
            let around = Around::new(&search.sites, &origin)?;
            search.spanning = independent(&around, &order, &mut pace)?;
        }
        if search.spanning.len() <= d {
            let mut rows = with_room(search.spanning.len())?;
            rows.extend(
                search
                    .spanning
                    .iter()
                    .map(|&p| search.sites.rows[p as usize]),
            );
            rows.sort_unstable();
            return Err(Error::Flat {
                dimension: d,
                distinct: count,
                rows,
            });
        }
        Ok(search)
    }

    /// The simplex of the canonical triangulation that contains a finite query; `None` outside.
    pub fn find(
        &self,
        query: &[f64],
        worker: &mut Worker,
        watch: &Watch,
    ) -> Result<Option<Inside>> {
        let pace = &mut Pace::new(watch, PACE);
        if !self.is_in_box(query) {
            worker.counts.apart += 1;
            return Ok(None);
        }
        let at = &Around::new(&self.sites, query)?;
        // A query that is strictly inside a simplex is in no other one, so the answer does not
        // depend on the queries before.
        if let Some(last) = &mut worker.last
            && let (signs, _) = last.for_another_query().sides(at)?
            && signs.iter().all(|&s| s > 0)
        {
            worker.counts.again += 1;
            return finished(last, at, &signs).map(Some);
        }
        let found = match self.proposed(at, pace)? {
            Proposal::Simplex(found) => {
                worker.counts.proposed += 1;
                Some(found)
            }
            Proposal::Pivots(start) => {
                worker.counts.pivots += 1;
                Some(self.pivoted(at, start, pace)?)
            }
            Proposal::Outside => {
                worker.counts.apart += 1;
                return Ok(None);
            }
            Proposal::Start(start) => {
                worker.counts.walks += 1;
                let start = match start {
                    Some(start) => start,
                    None => self.start(at, pace)?,
                };
                self.walk(at, start, pace)?
            }
        };
        let Some(mut simplex) = found else {
            return Ok(None);
        };
        let (signs, _) = simplex.sides(at)?;
        let inside = finished(&mut simplex, at, &signs)?;
        worker.last = Some(simplex);
        Ok(Some(inside))
    }

    /// Whether a query is in the bounding box of the points.
    fn is_in_box(&self, query: &[f64]) -> bool {
        let (low, high) = self.sites.extent();
        (0..self.sites.d).all(|k| query[k] >= low[k] && query[k] <= high[k])
    }

    /// A simplex that the linear program proposes, after proof.
    fn proposed(&self, at: &Around, pace: &mut Pace) -> Result<Proposal> {
        let d = self.sites.d;
        let near = self.sites.nearest(&at.q, 6 * d + 30)?;
        let mut program = Program::new(at, &near)?;
        for _ in 0..self.limits.proposals {
            pace.spend(near.len() * d)?;
            match program.run()? {
                End::Lost => break,
                End::Open => {
                    let normal = copied(program.normal())?;
                    let far = self.beyond(at, &normal, 2 * (d + 1), pace)?;
                    if far.certain {
                        return Ok(Proposal::Outside);
                    }
                    if !added(&mut program, &far.sites)? {
                        break;
                    }
                }
                End::Optimal => {
                    let Some(corners) = program.corners()? else {
                        break;
                    };
                    let Some(mut simplex) = Proven::new(at, corners)? else {
                        break;
                    };
                    let worst = self.conflicts(at, &mut simplex, 2 * (d + 1), pace)?;
                    if !worst.is_empty() && added(&mut program, &worst)? {
                        continue;
                    }
                    // Roundings hide the remaining conflicts from the program.
                    let (signs, _) = simplex.sides(at)?;
                    let contains = signs.iter().all(|&s| s >= 0);
                    return Ok(match (contains, worst.is_empty()) {
                        (true, true) => Proposal::Simplex(simplex),
                        (true, false) => Proposal::Pivots(simplex),
                        (false, true) => Proposal::Start(Some(simplex)),
                        (false, false) => Proposal::Start(None),
                    });
                }
            }
        }
        Ok(Proposal::Start(None))
    }

    /// Sites in conflict with a simplex: up to `most`, those with the least powers, or all that there
    /// are if there are none of less power.
    fn conflicts(
        &self,
        at: &Around,
        simplex: &mut Proven,
        most: usize,
        pace: &mut Pace,
    ) -> Result<Vec<u32>> {
        let o = copied(at.at(simplex.corners[0]))?;
        // Sites that the filter does not put outside.
        let mut near: Vec<(f64, bool, u32)> = Vec::new();
        let filtered = at.filtered;
        self.sites.tree.visit(
            |low, high| !(filtered && simplex.misses(low, high, &o)),
            |range: Range<u32>| {
                pace.spend(range.len())?;
                for p in range {
                    let (value, bound) = if filtered {
                        simplex.value(self.sites.at(p), &o)
                    } else {
                        (0.0, f64::INFINITY)
                    };
                    // A comparison that NaN fails.
                    let outside = value > bound;
                    if !outside {
                        push(&mut near, (value, value < -bound, p))?;
                    }
                }
                Ok(true)
            },
        )?;
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        let mut found = Vec::new();
        for (_, certain, p) in near {
            if found.len() == most {
                break;
            }
            pace.spend(64)?;
            if certain || simplex.conflict(at, p)? {
                push(&mut found, p)?;
            }
        }
        Ok(found)
    }

    /// The sites farthest beyond a plane through the query, and whether there are none for certain.
    fn beyond(&self, at: &Around, normal: &[f64], most: usize, pace: &mut Pace) -> Result<Beyond> {
        let d = self.sites.d;
        let size = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        // A scalar product of d terms with rounded differences errs by less than (d + 4) u times
        // the product of the lengths, which are at most the square root of d here.
        let bound = (d + 8) as f64 * f64::EPSILON * size * (d as f64).sqrt() + 1e-290;
        let mut far: Vec<(f64, u32)> = Vec::new();
        let mut all = at.filtered && size.is_finite();
        self.sites.tree.visit(
            |low, high| {
                let reach = |k: usize| {
                    (normal[k] * (low[k] - at.q[k])).max(normal[k] * (high[k] - at.q[k]))
                };
                let behind = (0..d).map(reach).sum::<f64>() < -bound;
                !behind
            },
            |range| {
                pace.spend(range.len())?;
                for p in range {
                    let offset = self.sites.at(p).iter().zip(&at.q).zip(normal);
                    let value: f64 = offset.map(|((p, q), n)| (p - q) * n).sum();
                    let behind = value < -bound;
                    if !behind {
                        all = false;
                        push(&mut far, (value, p))?;
                    }
                }
                Ok(true)
            },
        )?;
        far.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut sites = with_room(most)?;
        sites.extend(far.iter().take(most).map(|(_, p)| *p));
        Ok(Beyond {
            certain: all,
            sites,
        })
    }

    /// The simplex where exact walks start.
    fn start(&self, at: &Around, pace: &mut Pace) -> Result<Proven> {
        let corners = match self.first.get() {
            Some(first) => copied(first)?,
            None => {
                let found = self.made(pace)?;
                copied(self.first.get_or_init(|| found))?
            }
        };
        Proven::new(at, corners)?.ok_or_else(lost)
    }

    /// A simplex of the triangulation, by pivots at the mean of the corners of any one.
    fn made(&self, pace: &mut Pace) -> Result<Vec<u32>> {
        let at = &Around::mean(&self.sites, &self.spanning)?;
        let simplex = Proven::new(at, copied(&self.spanning)?)?.ok_or_else(lost)?;
        Ok(self.pivoted(at, simplex, pace)?.corners)
    }

    /// The simplex of the triangulation that contains the query, by exact pivots from one that does.
    ///
    /// In the end the largest conflict no longer chooses, but the smallest number among the sites in
    /// conflict, and among the corners that can leave (R. G. Bland, "New finite pivoting rules for the
    /// simplex method", 1977): no basis repeats. Heights are perturbed, and that rule holds for
    /// any ordered field.
    fn pivoted(&self, at: &Around, start: Proven, pace: &mut Pace) -> Result<Proven> {
        let mut simplex = start;
        for round in 0.. {
            let most = if round < self.limits.largest {
                1
            } else {
                usize::MAX
            };
            let conflicts = self.conflicts(at, &mut simplex, most, pace)?;
            let Some(&enter) = conflicts.iter().min() else {
                return Ok(simplex);
            };
            let leave = leaving(at, &mut simplex, enter)?;
            let mut corners = simplex.corners;
            corners[leave] = enter;
            simplex = Proven::new(at, corners)?.ok_or_else(lost)?;
        }
        Err(lost())
    }

    /// Walks through the triangulation to the simplex that contains the query; `None` outside.
    ///
    /// Each step crosses a facet that the query is strictly beyond, so that the perturbed height of
    /// the plane of the simplex at the query grows: no simplex repeats.
    fn walk(&self, at: &Around, start: Proven, pace: &mut Pace) -> Result<Option<Proven>> {
        let mut simplex = start;
        loop {
            let (signs, weights) = simplex.sides(at)?;
            let beyond = (0..signs.len()).filter(|&i| signs[i] < 0);
            let Some(facet) = beyond.min_by(|&i, &j| weights[i].total_cmp(&weights[j])) else {
                return Ok(Some(simplex));
            };
            match self.across(at, &mut simplex, facet, pace)? {
                Some(next) => simplex = next,
                None => return Ok(None),
            }
        }
    }

    /// The simplex across a facet of one; `None` outside the hull.
    ///
    /// The spheres through the facet are in an order, and each site beyond it is on one of them: the
    /// first is sought. A site in conflict with the present one is on an earlier one.
    fn across(
        &self,
        at: &Around,
        simplex: &mut Proven,
        facet: usize,
        pace: &mut Pace,
    ) -> Result<Option<Proven>> {
        let mut beyond = Vec::new();
        for p in 0..self.sites.len() as u32 {
            pace.spend(8)?;
            if simplex.side(at, facet, p)? < 0 {
                push(&mut beyond, p)?;
            }
        }
        let mut found: Option<Proven> = None;
        // The second pass finds what roundings hid in the first: it ends where nothing changes.
        loop {
            let mut changed = false;
            for &p in &beyond {
                pace.spend(8)?;
                let is_first = match &mut found {
                    None => true,
                    Some(best) => best.conflict(at, p)?,
                };
                if is_first {
                    let mut corners = copied(&simplex.corners)?;
                    corners[facet] = p;
                    found = Some(Proven::new(at, corners)?.ok_or_else(lost)?);
                    changed = true;
                }
            }
            if !changed || found.is_none() {
                return Ok(found);
            }
        }
    }
}

/// The corner that a site replaces, so that the simplex still contains the query: that of the least
/// ratio of its share of the query to its share of the site, if that is positive; the smallest number
/// among equal ones.
fn leaving(at: &Around, simplex: &mut Proven, enter: u32) -> Result<usize> {
    let (signs, of_query) = simplex.sides(at)?;
    let number = |simplex: &Proven, i: usize| simplex.corners[i];
    // Ratios of zero.
    let mut leave: Option<usize> = None;
    for i in (0..signs.len()).filter(|&i| signs[i] == 0) {
        let is_less = leave.is_none_or(|j| number(simplex, i) < number(simplex, j));
        if is_less && simplex.side(at, i, enter)? > 0 {
            leave = Some(i);
        }
    }
    if let Some(leave) = leave {
        return Ok(leave);
    }
    if let Some(leave) = simplex.least_ratio(at, &of_query, enter)? {
        return Ok(leave);
    }
    let (of_query, of_site) = (simplex.shares(at, at.query())?, simplex.shares(at, enter)?);
    for i in (0..of_site.len()).filter(|&i| of_site[i].sign() == Sign::Plus) {
        let is_less = leave.is_none_or(|j| {
            let (left, right) = (&of_query[i] * &of_site[j], &of_query[j] * &of_site[i]);
            let numbers = number(simplex, i).cmp(&number(simplex, j));
            left.cmp(&right).then(numbers).is_lt()
        });
        if is_less {
            leave = Some(i);
        }
    }
    leave.ok_or_else(lost)
}

/// What the linear program leads to.
enum Proposal {
    /// The simplex that contains the query.
    Simplex(Proven),
    /// One that contains the query and is not of the triangulation.
    Pivots(Proven),
    /// The query is outside.
    Outside,
    /// Nothing, or a simplex of the triangulation that may be near.
    Start(Option<Proven>),
}

/// Sites beyond a plane.
struct Beyond {
    /// Whether there are none, proven.
    certain: bool,
    /// The farthest ones first.
    sites: Vec<u32>,
}

/// Adds candidates; whether any was new.
fn added(program: &mut Program, sites: &[u32]) -> Result<bool> {
    let mut any = false;
    for &p in sites {
        any |= program.add(p)?;
    }
    Ok(any)
}

/// The corners and weights of the simplex of a query.
fn finished(simplex: &mut Proven, at: &Around, signs: &[i32]) -> Result<Inside> {
    // A query on facets may be in several simplices: nothing depends on the others' corners.
    let weights = match signs.iter().filter(|&&s| s != 0).count() {
        1 => signs.iter().map(|&s| f64::from(s)).collect(),
        _ => simplex.weights(at, signs)?,
    };
    Ok(Inside {
        corners: copied(&simplex.corners)?,
        weights,
    })
}

fn lost() -> Error {
    Error::Internal("a simplex is flat".into())
}
