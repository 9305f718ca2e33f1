//! Cells: simplices and ghosts, and the mesh that holds them.

use super::filter::{Matrix, Test, U, minus};
use super::fine::Fine;
use super::frame::Frame;
use super::lanes::{self, LANES};
use super::sites::Sites;
use crate::base::arrays::Given;
use crate::base::error::{Error, Result};
use crate::base::memory::{self, filled, is_plausible, with_room};

/// The vertex at infinity. It is the last one of a ghost.
pub const INFINITE: u32 = u32::MAX;

/// Cells that one mesh can hold: corners are numbered by `16 c + k` in 32 bits.
pub const LIMIT: usize = 1 << 28;

/// In `Cell::slow`: no slow data.
const NONE: u32 = (1 << 31) - 1;

/// In `Cell::slow`: whether the corners are negatively oriented.
const ODD: u32 = 1 << 31;

/// From this many bytes on, more cells are made only if the system seems to have the memory.
const PLAUSIBLE_FROM: usize = 1 << 26;

/// A simplex, or a ghost outside a facet of the hull.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Cell<const D: usize, const V: usize> {
    /// Decides most conflicts; from vertex 0.
    pub test: Test<D>,
    /// The newest vertex first, [`INFINITE`] last.
    pub vertices: [u32; V],
    /// The cell opposite each vertex.
    pub neighbors: [u32; V],
    /// The insertion that has visited it: twice its number, and 1 more if it is in no conflict.
    pub mark: u32,
    /// The row of its slow data, and its orientation.
    slow: u32,
}

/// What only uncertain tests need.
#[derive(Default)]
pub struct Slow<const D: usize> {
    /// The sphere in double-double.
    pub fine: Option<Fine<D>>,
    /// Integers.
    pub frame: Option<Frame>,
}

/// How many decisions each stage has made.
#[derive(Default, Clone, Copy, Debug)]
pub struct Counts {
    /// Decided by double-double.
    pub fine: u64,
    /// Zero by residues.
    pub zeros: u64,
    /// Decided by integers.
    pub exact: u64,
    /// Decided by the rule of ties.
    pub ties: u64,
    /// Walks that visit cells by exact signs.
    pub walks: u64,
}

/// Simplices and neighbors.
pub type Exported<const V: usize> = (Vec<[u32; V]>, Vec<[i32; V]>);

/// The cells of a triangulation under construction.
pub struct Mesh<const D: usize, const V: usize, const P: usize> {
    pub sites: Sites<D, P>,
    pub cells: Vec<Cell<D, V>>,
    pub slow: Vec<Slow<D>>,
    /// Unused rows of `slow`, and unused cells.
    free_slow: Vec<u32>,
    free: Vec<u32>,
    pub counts: Counts,
    /// The cell made last, where walks start.
    pub last: u32,
    /// What ghosts are measured by if there are no simplices.
    pub hull: Option<Inside>,
}

/// What a convex hull has in place of the simplices behind its facets.
pub struct Inside {
    /// Sites that are not all on one plane: none of them is outside a facet.
    pub sites: Vec<u32>,
    /// For each facet, one of them that is not on its plane.
    pub far: Vec<u32>,
    /// Whether points on the plane of a facet are decided by its sphere.
    pub is_delaunay: bool,
}

impl<const D: usize, const V: usize> Cell<D, V> {
    /// Whether it is a ghost.
    #[inline(always)]
    pub fn is_ghost(&self) -> bool {
        self.vertices[D] == INFINITE
    }

    /// Whether its corners are positively oriented; those of a ghost with a point far outside as the
    /// last one.
    pub fn is_positive(&self) -> bool {
        self.slow & ODD == 0
    }
}

impl<const D: usize, const V: usize, const P: usize> Mesh<D, V, P> {
    /// A simplex with its ghosts.
    pub fn new(sites: Sites<D, P>, corners: [u32; V]) -> Result<Self> {
        let Some(frame) = Frame::new(&sites, &corners) else {
            return Err(Error::Internal("the first simplex is flat".into()));
        };
        let mut mesh = Self::empty(sites);
        let simplex = mesh.make(corners, frame.positive)?;
        for i in 0..V {
            let ghost = mesh.outside(&corners, i, frame.positive, 1)?;
            mesh.cells[ghost as usize].neighbors[D] = simplex;
            mesh.cells[simplex as usize].neighbors[i] = ghost;
        }
        mesh.measure_simplex(simplex);
        for ghost in 1..=V as u32 {
            mesh.measure_ghost(ghost);
        }
        Ok(mesh)
    }

    /// The facets of a simplex, without it.
    pub fn facets(sites: Sites<D, P>, corners: [u32; V], inside: Inside) -> Result<Self> {
        let Some(frame) = Frame::new(&sites, &corners) else {
            return Err(Error::Internal("the first simplex is flat".into()));
        };
        let mut mesh = Self::empty(sites);
        mesh.hull = Some(inside);
        for i in 0..V {
            let facet = mesh.outside(&corners, i, frame.positive, 0)?;
            mesh.cells[facet as usize].neighbors[D] = facet;
        }
        for facet in 0..V as u32 {
            mesh.measure_ghost(facet);
        }
        Ok(mesh)
    }

    /// Ghost i of a simplex, opposite corner i, whose neighbor opposite the infinite vertex is not set;
    /// the number of ghost 0 is `first`.
    fn outside(&mut self, corners: &[u32; V], i: usize, positive: bool, first: u32) -> Result<u32> {
        // It has the corners but i in their order. With the infinite vertex in place i it would have the
        // other orientation than the simplex; moving that to the end takes D - i exchanges.
        let mut vertices = [INFINITE; V];
        let mut neighbors = [INFINITE; V];
        for (j, k) in (0..V).filter(|&k| k != i).enumerate() {
            vertices[j] = corners[k];
            neighbors[j] = first + k as u32;
        }
        let ghost = self.make(vertices, positive ^ (D - i).is_multiple_of(2))?;
        self.cells[ghost as usize].neighbors = neighbors;
        Ok(ghost)
    }

    /// The cells that are in use.
    pub fn alive(&self) -> Result<Vec<u32>> {
        let mut used = filled(self.cells.len(), true)?;
        for &c in &self.free {
            used[c as usize] = false;
        }
        let mut found = with_room(self.cells.len() - self.free.len())?;
        found.extend(
            (0u32..)
                .zip(&used)
                .filter(|(_, used)| **used)
                .map(|(c, _)| c),
        );
        Ok(found)
    }

    /// A mesh without cells.
    fn empty(sites: Sites<D, P>) -> Self {
        Self {
            sites,
            cells: Vec::new(),
            slow: Vec::new(),
            free_slow: Vec::new(),
            free: Vec::new(),
            counts: Counts::default(),
            last: 0,
            hull: None,
        }
    }

    /// A mesh of given simplices, positively oriented and with mutual neighbors, and a ghost at each
    /// facet of their boundary; ghosts are not neighbors of each other. `rank` has the sites of rows.
    pub fn given(sites: Sites<D, P>, given: &Given<D, V>, rank: &[u32]) -> Result<Self> {
        let mut mesh = Self::empty(sites);
        for v in given.simplices {
            mesh.make(v.map(|row| rank[row as usize]), true)?;
        }
        for (t, beyond) in given.neighbors.iter().enumerate() {
            for k in 0..V {
                if let Ok(other) = u32::try_from(beyond[k]) {
                    mesh.cells[t].neighbors[k] = other;
                    continue;
                }
                let mut vertices = [INFINITE; V];
                for (j, i) in (0..V).filter(|&i| i != k).enumerate() {
                    vertices[j] = mesh.cells[t].vertices[i];
                }
                let ghost = mesh.make(vertices, true)?;
                mesh.cells[ghost as usize].neighbors[D] = t as u32;
                mesh.cells[t].neighbors[k] = ghost;
            }
        }
        for c in 0..mesh.cells.len() {
            if c < given.simplices.len() {
                mesh.measure_simplex(c as u32);
            } else {
                mesh.measure_ghost(c as u32);
            }
        }
        Ok(mesh)
    }

    /// A cell without neighbors and test.
    #[inline(always)]
    pub fn make(&mut self, vertices: [u32; V], positive: bool) -> Result<u32> {
        let cell = Cell {
            test: Test::UNKNOWN,
            vertices,
            neighbors: [INFINITE; V],
            mark: 0,
            slow: NONE | if positive { 0 } else { ODD },
        };
        if let Some(c) = self.free.pop() {
            self.cells[c as usize] = cell;
            return Ok(c);
        }
        let made = self.cells.len();
        if made == LIMIT {
            return Err(Error::TooManySimplices { limit: LIMIT });
        }
        if made == self.cells.capacity() {
            // Growing moves all cells: the old array and one that is twice as long.
            let bytes = 2 * made * size_of::<Cell<D, V>>();
            if bytes > PLAUSIBLE_FROM && !is_plausible(bytes) {
                return Err(Error::Memory { bytes });
            }
        }
        memory::push(&mut self.cells, cell)?;
        Ok(made as u32)
    }

    /// Removes a cell.
    pub fn discard(&mut self, c: u32) -> Result<()> {
        let cell = &mut self.cells[c as usize];
        let row = cell.slow & NONE;
        // Unused cells look like ghosts.
        cell.vertices[D] = INFINITE;
        cell.slow |= NONE;
        if row != NONE {
            self.slow[row as usize] = Slow::default();
            memory::push(&mut self.free_slow, row)?;
        }
        memory::push(&mut self.free, c)
    }

    /// The row of slow data of a cell.
    pub fn slow_row(&mut self, c: u32) -> Result<usize> {
        let row = self.cells[c as usize].slow & NONE;
        if row != NONE {
            return Ok(row as usize);
        }
        let new = match self.free_slow.pop() {
            Some(row) => row,
            None => {
                memory::push(&mut self.slow, Slow::default())?;
                self.slow.len() as u32 - 1
            }
        };
        let cell = &mut self.cells[c as usize];
        cell.slow = (cell.slow & ODD) | new;
        Ok(new as usize)
    }

    /// The rounded differences of corners from the first one.
    #[inline(always)]
    pub fn differences(&self, v: &[u32; V]) -> Matrix<D, P> {
        self.sites.differences(v)
    }

    /// Prepares the test of a simplex.
    #[inline(always)]
    pub fn measure_simplex(&mut self, c: u32) {
        if self.sites.filtered {
            let a = self.differences(&self.cells[c as usize].vertices);
            let v = &self.cells[c as usize].vertices;
            let weights = self.sites.is_lifted.then(|| self.lifts(v));
            self.cells[c as usize].test = Test::lifted(&a, weights);
        }
    }

    /// Prepares the tests of simplices that have the first vertex in common.
    #[inline(always)]
    pub fn measure_simplices(&mut self, simplices: &[u32]) {
        if !self.sites.filtered {
            return;
        }
        for some in simplices.chunks(LANES) {
            let (mut a, mut weights) = ([[[0.0; LANES]; D]; D], [[0.0; LANES]; D]);
            for l in 0..LANES {
                // Lanes without a simplex repeat the first one.
                let c = some.get(l).unwrap_or(&some[0]);
                let v = &self.cells[*c as usize].vertices;
                let o = &self.sites.scaled[v[0] as usize];
                for i in 0..D {
                    let difference = minus(&self.sites.scaled[v[i + 1] as usize], o);
                    for k in 0..D {
                        a[i][k][l] = difference[k];
                    }
                }
                if self.sites.is_lifted {
                    for (to, weight) in weights.iter_mut().zip(self.lifts(v)) {
                        to[l] = weight;
                    }
                }
            }
            let tests = lanes::lifted(&a, self.sites.is_lifted.then_some(&weights));
            for (&c, test) in some.iter().zip(tests) {
                match test {
                    Some(test) => self.cells[c as usize].test = test,
                    None => self.measure_simplex(c),
                }
            }
        }
    }

    /// The weights of corners less that of the first one, rounded.
    #[inline(always)]
    pub fn lifts(&self, v: &[u32; V]) -> [f64; D] {
        std::array::from_fn(|i| self.sites.weight(v[i + 1], v[0]))
    }

    /// Prepares the test of a ghost, whose neighbor behind the facet is known.
    #[inline(always)]
    pub fn measure_ghost(&mut self, c: u32) {
        if self.hull.is_some() {
            self.measure_facet(c);
        } else if self.sites.filtered {
            let mut v = self.cells[c as usize].vertices;
            let (behind, far) = self.behind(c);
            v[D] = self.cells[behind as usize].vertices[far];
            let a = self.differences(&v);
            self.cells[c as usize].test = Test::plane(&a);
        }
    }

    /// Prepares the test of a facet of a hull: by the first of the sites inside that is not on its
    /// plane for certain, or else exactly.
    fn measure_facet(&mut self, c: u32) {
        let Some(mut inside) = self.hull.take() else {
            return;
        };
        let mut v = self.cells[c as usize].vertices;
        let mut found = None;
        for &r in &inside.sites {
            v[D] = r;
            if self.sites.filtered && !v[..D].contains(&r) {
                let test = Test::plane(&self.differences(&v));
                if test.q0 < f64::INFINITY {
                    self.cells[c as usize].test = test;
                    found = Some(r);
                    break;
                }
            }
        }
        let exact = |r: &u32| {
            let mut v = v;
            v[D] = *r;
            !v[..D].contains(r) && Frame::new(&self.sites, &v).is_some()
        };
        // The sites are not on one plane, so there is one.
        let r = found.or_else(|| inside.sites.iter().copied().find(|r| exact(r)));
        if inside.far.len() <= c as usize {
            inside.far.resize(c as usize + 1, INFINITE);
        }
        inside.far[c as usize] = r.unwrap_or(INFINITE);
        self.hull = Some(inside);
    }

    /// The simplex behind the facet of a ghost, and its corner off the facet.
    pub fn behind(&self, ghost: u32) -> (u32, usize) {
        let behind = self.cells[ghost as usize].neighbors[D];
        let back = self.cells[behind as usize].neighbors;
        let far = back.iter().position(|&n| n == ghost).unwrap_or(0);
        (behind, far)
    }

    /// The value of a point in the test of a cell, and its bound.
    #[inline(always)]
    pub fn value(&self, c: u32, p: u32) -> (f64, f64) {
        let cell = &self.cells[c as usize];
        let at = |p: u32| &self.sites.scaled[p as usize];
        let d = minus(at(p), at(cell.vertices[0]));
        let rounded = cell.test.value(&d, cell.is_ghost());
        if !self.sites.is_lifted || cell.is_ghost() {
            return rounded;
        }
        self.less_weight(rounded, p, cell.vertices[0])
    }

    /// A value with its bound, less the weight of a point from the first corner. In a flat, that errs
    /// by 6 u of itself.
    #[inline(always)]
    pub fn less_weight(&self, (value, bound): (f64, f64), p: u32, o: u32) -> (f64, f64) {
        let weight = self.sites.weight(p, o);
        let rounding = 12.0 * U * (value.abs() + weight.abs());
        (value - weight, bound + rounding)
    }

    /// The finite simplices, positively oriented, and their neighbors, -1 outside.
    pub fn export(&self) -> Result<Exported<V>> {
        let mut number = filled(self.cells.len(), -1i32)?;
        let mut count = 0;
        for (n, _) in number
            .iter_mut()
            .zip(&self.cells)
            .filter(|(_, c)| !c.is_ghost())
        {
            *n = count;
            count += 1;
        }
        let mut simplices = with_room(count as usize)?;
        let mut neighbors = with_room(count as usize)?;
        for cell in self.cells.iter().filter(|c| !c.is_ghost()) {
            let (mut v, mut n) = (cell.vertices, cell.neighbors.map(|t| number[t as usize]));
            if !cell.is_positive() {
                v.swap(D - 1, D);
                n.swap(D - 1, D);
            }
            simplices.push(v);
            neighbors.push(n);
        }
        Ok((simplices, neighbors))
    }
}
