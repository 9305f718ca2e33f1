//! The simplex method in doubles, which proposes the simplex that contains a query.
//!
//! The simplex of the Delaunay triangulation that contains q is the basis of the optimum of the linear
//! program min sum m_p |p - q|^2 over m_p >= 0 with sum m_p p = q and sum m_p = 1. The program has few
//! rows and many columns: it is solved for some of the sites, and others enter where they are missing
//! (G. B. Dantzig, P. Wolfe, "Decomposition principle for linear programs", 1960). Nothing here is
//! proven, and nothing needs to be.

use super::proven::{dot, invert, reduce};
use super::sites::Around;
use crate::base::error::Result;
use crate::base::memory::{filled, make_room, with_room};

/// In the basis: not a site.
const ARTIFICIAL: u32 = u32::MAX;

/// Pivots between two inversions of the basis.
const FRESH: usize = 64;

/// How a run ends.
#[derive(Debug, PartialEq)]
pub enum End {
    /// The basis consists of sites, and no candidate improves it.
    Optimal,
    /// The candidates do not enclose the query.
    Open,
    /// Too many pivots, or no pivot where there should be one.
    Lost,
}

/// A linear program whose columns are candidates.
pub struct Program<'a> {
    at: &'a Around<'a>,
    /// The number of rows: d + 1.
    w: usize,
    /// Lengths are multiplied by this.
    scale: f64,
    /// The sites of the columns.
    sites: Vec<u32>,
    /// (p - q, 1) of each.
    columns: Vec<f64>,
    /// |p - q|^2 of each.
    costs: Vec<f64>,
    /// The columns that are in the basis.
    used: Vec<bool>,
    /// The column of each row.
    basis: Vec<u32>,
    /// The inverse of the basis, row by row.
    inverse: Vec<f64>,
    /// Prices of the rows, the result of the last call of `price`.
    prices: Vec<f64>,
    /// Scratch: the entering column in terms of the basis.
    direction: Vec<f64>,
    pivots: usize,
}

impl<'a> Program<'a> {
    /// With artificial points that enclose the query, and the nearest sites as candidates.
    pub fn new(at: &'a Around<'a>, near: &[u32]) -> Result<Self> {
        let (d, w) = (at.sites.d, at.sites.d + 1);
        let square = |p: u32| -> f64 {
            at.at(p)
                .iter()
                .zip(&at.q)
                .map(|(a, b)| (a - b).powi(2))
                .sum()
        };
        let farthest = near.iter().map(|&p| square(p)).fold(0.0, f64::max);
        let scale = if farthest > 0.0 {
            1.0 / farthest.sqrt()
        } else {
            1.0
        };
        // The unit vectors and minus their sum: the query is their mean. The inverse is known.
        let share = 1.0 / w as f64;
        let mut inverse = filled(w * w, -share)?;
        for i in 0..d {
            inverse[i * w + i] += 1.0;
        }
        for i in 0..w {
            inverse[i * w + d] = share;
        }
        let mut program = Self {
            at,
            w,
            scale: if scale.is_finite() { scale } else { 1.0 },
            sites: Vec::new(),
            columns: Vec::new(),
            costs: Vec::new(),
            used: Vec::new(),
            basis: filled(w, ARTIFICIAL)?,
            inverse,
            prices: filled(w, 0.0)?,
            direction: filled(w, 0.0)?,
            pivots: 0,
        };
        for &p in near {
            program.add(p)?;
        }
        Ok(program)
    }

    /// Adds a candidate; whether it is a new one.
    pub fn add(&mut self, p: u32) -> Result<bool> {
        if self.sites.contains(&p) {
            return Ok(false);
        }
        make_room(&mut self.sites, 1)?;
        make_room(&mut self.costs, 1)?;
        make_room(&mut self.used, 1)?;
        make_room(&mut self.columns, self.w)?;
        let first = self.columns.len();
        let scaled = self.at.at(p).iter().zip(&self.at.q);
        self.columns
            .extend(scaled.map(|(a, b)| (a - b) * self.scale));
        self.costs
            .push(dot(&self.columns[first..], &self.columns[first..]));
        self.columns.push(1.0);
        self.sites.push(p);
        self.used.push(false);
        Ok(true)
    }

    /// The sites of the basis, if there are no others.
    pub fn corners(&self) -> Result<Option<Vec<u32>>> {
        let mut found = with_room(self.w)?;
        for &column in &self.basis {
            match self.sites.get(column as usize) {
                Some(&site) => found.push(site),
                None => return Ok(None),
            }
        }
        Ok(Some(found))
    }

    /// Pivots until no candidate improves the basis.
    pub fn run(&mut self) -> Result<End> {
        let most = self.pivots + 200 + 20 * self.w;
        loop {
            let opening = self.is_open();
            self.price(opening);
            let (mut best, mut enter) = (-1e-11, None);
            for column in 0..self.sites.len() {
                if !self.used[column] {
                    let cost = if opening { 0.0 } else { self.costs[column] };
                    let reduced = cost - dot(self.column(column), &self.prices);
                    if reduced < best {
                        (best, enter) = (reduced, Some(column));
                    }
                }
            }
            match enter {
                Some(column) => {
                    if self.pivots >= most || !self.enter(column, opening)? {
                        return Ok(End::Lost);
                    }
                }
                None if opening => return Ok(End::Open),
                // Artificial points without a share leave for any independent site.
                None => match self.replaced()? {
                    Some(true) => {}
                    Some(false) => return Ok(End::Optimal),
                    None => return Ok(End::Open),
                },
            }
        }
    }

    /// The outward normal of a plane that may have all sites on its inner side, after [`End::Open`].
    pub fn normal(&mut self) -> &[f64] {
        self.price(true);
        &self.prices[..self.w - 1]
    }

    /// Whether an artificial point has a share of the query.
    fn is_open(&self) -> bool {
        let d = self.w - 1;
        let share = |i: usize| self.inverse[i * self.w + d];
        (0..self.w).any(|i| self.basis[i] == ARTIFICIAL && share(i) > 1e-11)
    }

    fn column(&self, column: usize) -> &[f64] {
        &self.columns[column * self.w..][..self.w]
    }

    /// The prices of the rows: for the shares of artificial points alone, or for the candidates.
    fn price(&mut self, opening: bool) {
        self.prices.fill(0.0);
        for (i, &column) in self.basis.iter().enumerate() {
            let cost = match (column == ARTIFICIAL, opening) {
                (true, true) => 1.0,
                (false, false) => self.costs[column as usize],
                _ => continue,
            };
            let row = &self.inverse[i * self.w..][..self.w];
            for (price, x) in self.prices.iter_mut().zip(row) {
                *price += cost * x;
            }
        }
    }

    /// The entering column in terms of the basis.
    fn direct(&mut self, column: usize) {
        let y = &self.columns[column * self.w..][..self.w];
        for (out, row) in self
            .direction
            .iter_mut()
            .zip(self.inverse.chunks_exact(self.w))
        {
            *out = dot(row, y);
        }
    }

    /// Exchanges a column of the basis for another by the least ratio; whether there is one.
    fn enter(&mut self, column: usize, opening: bool) -> Result<bool> {
        self.direct(column);
        let d = self.w - 1;
        let (mut least, mut leave) = (f64::INFINITY, None);
        for i in 0..self.w {
            let a = self.direction[i];
            // Artificial points without a share leave at any pivot.
            if self.basis[i] == ARTIFICIAL && !opening && a.abs() > 1e-9 {
                leave = Some(i);
                break;
            }
            if a > 1e-10 {
                let ratio = self.inverse[i * self.w + d].max(0.0) / a;
                let larger = leave.is_some_and(|row: usize| a > self.direction[row]);
                if ratio < least || (ratio == least && larger) {
                    (least, leave) = (ratio, Some(i));
                }
            }
        }
        match leave {
            Some(row) => self.pivot(row, column).map(|()| true),
            None => Ok(false),
        }
    }

    /// Puts an independent site in the place of an artificial point without a share. `Some(false)` if
    /// there is no artificial point, `None` if no candidate is independent of the others.
    fn replaced(&mut self) -> Result<Option<bool>> {
        let Some(row) = (0..self.w).find(|&i| self.basis[i] == ARTIFICIAL) else {
            return Ok(Some(false));
        };
        let of_row = &self.inverse[row * self.w..][..self.w];
        let (mut best, mut enter) = (1e-9, None);
        for column in 0..self.sites.len() {
            let size = dot(of_row, self.column(column)).abs();
            if !self.used[column] && size > best {
                (best, enter) = (size, Some(column));
            }
        }
        let Some(column) = enter else {
            return Ok(None);
        };
        self.direct(column);
        self.pivot(row, column)?;
        Ok(Some(true))
    }

    /// Puts a column in the place of that of a row.
    fn pivot(&mut self, row: usize, column: usize) -> Result<()> {
        if let Some(used) = self.used.get_mut(self.basis[row] as usize) {
            *used = false;
        }
        self.basis[row] = column as u32;
        self.used[column] = true;
        self.pivots += 1;
        if self.pivots.is_multiple_of(FRESH) {
            return self.refresh();
        }
        let w = self.w;
        let f = 1.0 / self.direction[row];
        for x in &mut self.inverse[row * w..][..w] {
            *x *= f;
        }
        for i in 0..w {
            let g = self.direction[i];
            if i != row && g != 0.0 {
                reduce(&mut self.inverse, w, i, row, g);
            }
        }
        Ok(())
    }

    /// Inverts the basis again.
    pub fn refresh(&mut self) -> Result<()> {
        let (w, d) = (self.w, self.w - 1);
        let mut m = filled(w * w, 0.0)?;
        for (i, &column) in self.basis.iter().enumerate() {
            for j in 0..w {
                m[j * w + i] = match self.columns.get(column as usize * w + j) {
                    Some(&x) if column != ARTIFICIAL => x,
                    _ if j == d => 1.0,
                    _ if i == d => -1.0,
                    _ => f64::from(i == j),
                };
            }
        }
        self.inverse = invert(&m, w)?;
        Ok(())
    }
}
