//! The 3-D Bowyer-Watson kernel: a point is inserted by emptying its cavity and filling it with a
//! star.
//!
//! A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional
//! Delaunay tessellation", both The Computer Journal 24 (1981); the perturbation is that of O. Devillers
//! and M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations" (2011).
//!
//! # Why this is right on ties
//!
//! The mesh is the projection of the lower hull of the points so far at the heights |p|^2 - eps(p);
//! see `delone_predicates` on ties. Five lifted points of which four are affinely independent are
//! never in one hyperplane, so each facet of that hull is one tetrahedron, and none is flat, since
//! a facet of a lower hull is not vertical.
//!
//! A finite tetrahedron is removed if the lifted new point p lies below its hyperplane:
//! `insphere_canonical`. A hull facet abc stops being one, and its ghost is removed, if p lies
//! beyond its plane, or in its plane and, among the lifted points over that plane, below a, b, c.
//! The lower hull over the plane of a hull facet is, by the same heights, the canonical
//! triangulation of its points in 2-D (|p|^2 differs from the squared length in the plane by an
//! affine function), so coplanar hull facets are triangulated canonically. No 2-D predicate is
//! needed: for the finite neighbor abcd of the ghost, the perturbed determinant of a, b, c, d, p is
//! orient3d(a, b, c, d) times the height of p above the affine function of a, b, c, d; as p is an
//! affine combination of a, b, c only, the height of d does not matter, and the answer for abcd is
//! that for abc in its plane. So **a ghost with p in its plane is in conflict exactly when its
//! finite neighbor is**.
//!
//! By these tests the tetrahedra in conflict are those that p removes from the hull, ghosts for
//! vertical facets included. The new ones join p to the boundary of the cavity. Each of them is on
//! the new lower hull, so none is flat. The cavity is connected, since the star of p in the new
//! triangulation of the sphere is a ball and its complement, too. No vertex is inside it, as all
//! lifted points are extreme.
//!
//! # Why it terminates
//!
//! A walk crosses facets that have p strictly beyond them; the power of p falls at each step (H.
//! Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990, for every lower
//! hull), so no tetrahedron is visited twice. A cavity is part of the mesh. An insertion makes 2
//! v - 4 records, where v is the number of its new neighbors, so all insertions make at most n^2, and
//! none is removed more than once: the work is bounded by the largest size of a 3-D triangulation.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use super::heights::Heights;
use super::lattice;
use super::sphere::{
    Facets, LANES, RANGE, Ray, Rays, SLACK, Sphere, UNKNOWN, power, sphere, spheres,
};
use crate::base::error::{Error, Result};
use crate::base::memory::{boxed, filled, push, with_room};
use crate::mesh::space::{Code, FACETS, Mesh3, corner, tetrahedron};

/// The most vertices of a star that is linked by a table, and facets of such a star: 2 v - 4,
/// rounded up.
const STAR: usize = 64;
const RIM: usize = 2 * STAR;

/// No record.
const NONE: u32 = u32::MAX;

/// Marks: nothing is known;
const OPEN: u8 = 0;
/// in the cavity;
const TAKEN: u8 = 1;
/// predicates have decided that it is not.
const SPARED: u8 = 2;

/// Arrays that grow with the mesh. To be allocated by the thread that starts the others, see
/// [`crate::order::space::Room3`].
#[derive(Debug)]
pub struct Room {
    /// What is known of each record during an insertion: [`OPEN`] before and after. Separate from
    /// the spheres: a store to part of one would stall the next load of the whole.
    mark: Vec<u8>,
    /// The index of each vertex in the star of the vertex inserted last, if it is in it.
    place: Vec<u8>,
}

impl Room {
    /// Room for this many records and vertices, which touches no page.
    pub fn of(records: usize, vertices: usize) -> Result<Self> {
        Ok(Self {
            mark: with_room(records)?,
            place: with_room(vertices + 1)?,
        })
    }
}

/// A mesh into which points are inserted one at a time.
pub struct Kernel<'a> {
    points: &'a [Point3],
    mesh: Mesh3<'a>,
    spheres: Vec<Sphere>,
    mark: Vec<u8>,
    /// Whether a record is marked [`SPARED`].
    any_spared: bool,
    place: Vec<u8>,
    /// Added to each radius: NaN if the coordinates are out of the range of spheres, else 0.
    doubt: f64,
    /// Whether the points lie on a small lattice.
    small: bool,
    /// Heights of the points above a sphere that is near all of them.
    heights: Option<Heights>,
    /// The records in conflict, each by the facet through which it was reached.
    cavity: Vec<Code>,
    /// The boundary facets of the cavity, seen from inside.
    rim: Vec<Code>,
    star: Box<[Star; 1]>,
    work: usize,
}

/// Buffers for one star.
struct Star {
    vertices: [u32; 256],
    rays: Rays,
    facets: Facets,
    /// For each boundary facet: its corners, their indices, the code across, and the new record.
    corners: [[u32; 3]; RIM],
    places: [[u8; 3]; RIM],
    across: [Code; RIM],
    records: [u32; RIM],
    /// For the indices of a directed edge, the facet of the star that has it.
    table: [Code; STAR * STAR],
}

impl<'a> Kernel<'a> {
    /// A kernel in the empty `mesh` over `points`, which end with NaN for infinity. It starts from
    /// the positively oriented tetrahedron `first`, and uses the memory of `spheres`.
    pub fn start(
        points: &'a [Point3],
        mut mesh: Mesh3<'a>,
        room: Room,
        mut spheres: Vec<Sphere>,
        first: [u32; 4],
    ) -> Result<Self> {
        mesh.first(first)?;
        let bound = 2f64.powi(RANGE);
        let coordinates = points[..points.len() - 1].as_flattened();
        let certain = coordinates.iter().all(|x| x.abs() < bound);
        let finite = &points[..points.len() - 1];
        let small = certain && lattice::is_small(finite);
        let heights = if certain && !small {
            Heights::of(finite)?
        } else {
            None
        };
        let Room {
            mut mark,
            mut place,
        } = room;
        spheres.clear();
        spheres.resize(mesh.records(), UNKNOWN);
        mark.resize(mesh.records(), OPEN);
        place.resize(points.len(), 0);
        Ok(Self {
            points,
            mesh,
            spheres,
            mark,
            any_spared: false,
            place,
            doubt: if certain { 0.0 } else { f64::NAN },
            small,
            heights,
            cavity: filled(RIM, 0)?,
            rim: filled(RIM, 0)?,
            star: boxed(Star {
                vertices: [NONE; 256],
                rays: Rays::default(),
                facets: Facets::default(),
                corners: [[0; 3]; RIM],
                places: [[0; 3]; RIM],
                across: [0; RIM],
                records: [0; RIM],
                table: [0; STAR * STAR],
            })?,
            work: 0,
        })
    }

    /// Records visited so far, in walks and cavities.
    pub fn work(&self) -> usize {
        self.work
    }

    /// The mesh, and the sphere of each record; the rest is dropped.
    pub fn finish(self) -> (Mesh3<'a>, Vec<Sphere>) {
        (self.mesh, self.spheres)
    }

    #[inline]
    fn at(&self, v: u32) -> Point3 {
        self.points[v as usize]
    }

    /// Inserts vertex `p`, which is not in the mesh yet; the search starts at `near`. Returns the
    /// new tetrahedron whose circumsphere contains `aim` deepest.
    #[inline(always)]
    pub fn insert(&mut self, p: u32, near: u32, aim: Point3) -> Result<u32> {
        let seed = self.seed(p, near)?;
        let (gone, rims) = self.carve(p, seed)?;
        if rims <= RIM && self.number(p, gone, rims) {
            self.fill(p, gone, rims, aim)
        } else {
            self.fill_large(p, gone, rims)
        }
    }

    /// A tetrahedron in conflict with p: walks from `near` to the neighbor of least power, by exact
    /// steps where that is uncertain.
    #[inline(always)]
    fn seed(&mut self, p: u32, near: u32) -> Result<u32> {
        let q = self.at(p);
        let mut t = near;
        let mut own = power(self.spheres[t as usize], q);
        loop {
            self.work += 1;
            let square = self.spheres[t as usize][3];
            if own < -SLACK * (own + 2.0 * square) {
                return Ok(t);
            }
            // A decrease smaller than the rounding error could make the walk cycle.
            let mut least = own - SLACK * (own + 2.0 * square);
            let mut next = t;
            for e in self.mesh.opposites(t) {
                let power = power(self.spheres[tetrahedron(e) as usize], q);
                if power < least {
                    (least, next) = (power, tetrahedron(e));
                }
            }
            if next == t {
                return self.seed_exactly(p, t);
            }
            (t, own) = (next, least);
        }
    }

    /// The same across facets that have p beyond them, by exact predicates.
    #[cold]
    #[inline(never)]
    fn seed_exactly(&mut self, p: u32, near: u32) -> Result<u32> {
        let mut t = near;
        if let Some(k) = self.mesh.infinite_corner(t)
            && !self.conflicts(t, p)
        {
            t = tetrahedron(self.mesh.opposites(t)[k]);
        }
        loop {
            self.work += 1;
            if self.conflicts(t, p) {
                return Ok(t);
            }
            let [a, b, c, d] = self.mesh.corners(t);
            let corners = [self.at(a), self.at(b), self.at(c), self.at(d)];
            let beyond = (0..4).find(|&k| {
                let [a, b, c] = FACETS[k];
                let [a, b, c] = [corners[a], corners[b], corners[c]];
                orient3d(a, b, c, self.at(p)) == Sign::Negative
            });
            let Some(k) = beyond else {
                return Err(Error::Internal(format!(
                    "vertex {p} is in tetrahedron {t} but not in its circumsphere"
                )));
            };
            t = tetrahedron(self.mesh.opposites(t)[k]);
        }
    }

    /// Collects the tetrahedra in conflict with p, from `seed` outward, and their boundary facets;
    /// returns the numbers of both.
    ///
    /// Whether a neighbor is in conflict is unpredictable, so no branch depends on it: each is
    /// written to both lists, and the ends of the lists move or not.
    #[inline(always)]
    fn carve(&mut self, p: u32, seed: u32) -> Result<(usize, usize)> {
        let q = self.at(p);
        self.mark[seed as usize] = TAKEN;
        self.cavity[0] = 4 * seed;
        let mut ends = (1, 0);
        let mut next = 0;
        self.visit(p, q, 4 * seed, &mut ends);
        loop {
            let e = self.cavity[next];
            for k in 1..4 {
                self.visit(p, q, e ^ k, &mut ends);
            }
            next += 1;
            // Each record adds at most three facets, and the first one four.
            if ends.0 + 4 > self.cavity.len() || ends.1 + 4 > self.rim.len() {
                grow(&mut self.cavity)?;
                grow(&mut self.rim)?;
            }
            if next == ends.0 {
                break;
            }
        }
        self.work += next;
        for &e in &self.cavity[..next] {
            self.mark[tetrahedron(e) as usize] = OPEN;
        }
        if self.any_spared {
            self.unmark_spared(ends.1);
        }
        Ok(ends)
    }

    /// Records that are spared are across the boundary.
    #[cold]
    #[inline(never)]
    fn unmark_spared(&mut self, rims: usize) {
        for &e in &self.rim[..rims] {
            self.mark[tetrahedron(self.mesh.opposite(e)) as usize] = OPEN;
        }
        self.any_spared = false;
    }

    /// Adds the record across facet `e` to the cavity, or `e` to its boundary.
    #[inline(always)]
    fn visit(&mut self, p: u32, q: Point3, e: Code, (gone, rims): &mut (usize, usize)) {
        let across = self.mesh.opposite(e);
        let other = tetrahedron(across) as usize;
        let [x, y, z, square] = self.spheres[other];
        let (dx, dy, dz) = (q[0] - x, q[1] - y, q[2] - z);
        let distance = dx * dx + dy * dy + dz * dz;
        let power = distance - square;
        let certain = power.abs() > SLACK * (distance + square);
        let mut conflict = power < 0.0;
        // Everything uncertain is behind a call, and the mark is read after it: otherwise the
        // compiler would branch on the conflict, too, which costs 250 ns more per point.
        if !certain {
            conflict = self.uncertain(other as u32, p);
        }
        let mark = self.mark[other];
        self.mark[other] = mark | u8::from(conflict);
        self.cavity[*gone] = across;
        *gone += usize::from(conflict & (mark != TAKEN));
        self.rim[*rims] = e;
        *rims += usize::from(!conflict);
    }

    /// Whether t is in conflict with p, by predicates unless they have decided it before.
    #[cold]
    #[inline(never)]
    fn uncertain(&mut self, t: u32, p: u32) -> bool {
        let mark = self.mark[t as usize];
        if mark != OPEN {
            return mark == TAKEN;
        }
        let conflict = self.view().conflicts_exactly(t, p);
        if !conflict {
            self.mark[t as usize] = SPARED;
            self.any_spared = true;
        }
        conflict
    }

    /// Records the corners of the boundary facets and numbers them; `false` if there are too many.
    #[inline(always)]
    fn number(&mut self, p: u32, gone: usize, rims: usize) -> bool {
        let [star] = &mut *self.star;
        let (mesh, place) = (&self.mesh, &mut self.place[..]);
        let mut vertices = 0;
        // All corners of the cavity are on its boundary. Each record after the first adds at most
        // one.
        for v in mesh.corners(tetrahedron(self.cavity[0])) {
            place[v as usize] = vertices as u8;
            star.vertices[vertices] = v;
            vertices += 1;
        }
        for &e in &self.cavity[1..gone] {
            let v = mesh.apex(e);
            let own = &mut place[v as usize];
            let new = star.vertices[usize::from(*own)] != v || usize::from(*own) >= vertices;
            let here = if new { vertices as u8 } else { *own };
            *own = here;
            star.vertices[usize::from(here)] = v;
            vertices += usize::from(new);
            if vertices > STAR {
                return false;
            }
        }
        let facets = star
            .corners
            .iter_mut()
            .zip(&mut star.places)
            .zip(&mut star.across);
        for (&e, ((corners, places), across)) in self.rim[..rims].iter().zip(facets) {
            *across = mesh.opposite(e);
            *corners = mesh.facet(e);
            // `map` of an array may be a call.
            let [a, b, c] = *corners;
            *places = [place[a as usize], place[b as usize], place[c as usize]];
        }
        let origin = self.points[p as usize];
        for (i, &v) in star.vertices[..vertices].iter().enumerate() {
            star.rays
                .set(i & (STAR - 1), Ray::new(self.points[v as usize], origin));
        }
        true
    }

    /// Fills the cavity with the star of p.
    #[inline(always)]
    fn fill(&mut self, p: u32, gone: usize, rims: usize, aim: Point3) -> Result<u32> {
        let more = self.records(gone, rims)?;
        let [star] = &mut *self.star;
        let place = |place: u8| usize::from(place) & (STAR - 1);
        for (record, &e) in star.records.iter_mut().zip(&self.cavity[..gone + more]) {
            *record = tetrahedron(e);
        }
        let facets = star.places[..rims].iter().zip(&star.records);
        // Each boundary facet is the base of a new tetrahedron; note its three other facets by
        // edge.
        for (&[a, b, c], &t) in facets {
            let (a, b, c) = (place(a), place(b), place(c));
            star.table[STAR * b + c] = 4 * t;
            star.table[STAR * c + a] = 4 * t + 1;
            star.table[STAR * a + b] = 4 * t + 2;
        }
        let (all_corners, all_opposite) = self.mesh.all_mut();
        // Link each new tetrahedron to its neighbors in the star and across its base.
        for i in 0..rims {
            let i = i & (RIM - 1);
            let (t, across) = (star.records[i], star.across[i]);
            let [a, b, c] = star.places[i];
            let (a, b, c) = (place(a), place(b), place(c));
            let [u, v, w] = star.corners[i];
            all_corners[t as usize] = [u as i32, v as i32, w as i32, p as i32];
            all_opposite[t as usize] = [
                star.table[STAR * c + b] as i32,
                star.table[STAR * a + c] as i32,
                star.table[STAR * b + a] as i32,
                across as i32,
            ];
            all_opposite[tetrahedron(across) as usize][corner(across)] = (4 * t + 3) as i32;
        }
        // Compute the spheres of the star, and find the one that contains `aim` deepest.
        star.facets.gather(&star.rays, &star.places[..rims]);
        let all_spheres = &mut self.spheres[..];
        let origin = self.points[p as usize];
        let (mut best, mut least) = (star.records[0], f64::INFINITY);
        for from in (0..rims).step_by(LANES) {
            let lanes = spheres(origin, &star.facets, from, self.doubt, aim);
            for lane in 0..LANES.min(rims - from) {
                let t = star.records[(from + lane) & (RIM - 1)];
                let [x, y, z, square] = &lanes.sphere;
                all_spheres[t as usize] = [x[lane], y[lane], z[lane], square[lane]];
                // Ghosts and flat tetrahedra, whose powers are NaN, never win.
                let better = lanes.power[lane] < least;
                least = if better { lanes.power[lane] } else { least };
                best = if better { t } else { best };
            }
        }
        Ok(best)
    }

    /// Turns the first `rims` records of the cavity's list into records to be filled and frees the
    /// rest; returns how many it added.
    #[inline(always)]
    fn records(&mut self, gone: usize, rims: usize) -> Result<usize> {
        for i in gone..rims {
            let t = self.mesh.fresh()?;
            self.cavity[i] = 4 * t;
        }
        for _ in self.spheres.len()..self.mesh.records() {
            push(&mut self.spheres, UNKNOWN)?;
            push(&mut self.mark, OPEN)?;
        }
        for i in rims..gone {
            self.mesh.release(tetrahedron(self.cavity[i]));
        }
        Ok(rims.saturating_sub(gone))
    }

    /// Like [`Self::fill`], for stars of any size: edges are sorted, so that equal ones are
    /// adjacent.
    #[cold]
    #[inline(never)]
    fn fill_large(&mut self, p: u32, gone: usize, rims: usize) -> Result<u32> {
        let mut facets = with_room(rims)?;
        facets.extend(self.rim[..rims].iter().map(|&e| {
            let corners = self.mesh.corners(tetrahedron(e));
            (
                FACETS[(e & 3) as usize].map(|k| corners[k]),
                self.mesh.opposite(e),
            )
        }));
        while self.cavity.len() < rims {
            grow(&mut self.cavity)?;
        }
        self.records(gone, rims)?;
        let mut edges = with_room(3 * rims)?;
        let origin = self.at(p);
        for (&(corners, across), i) in facets.iter().zip(0..) {
            let t = tetrahedron(self.cavity[i]);
            let [a, b, c] = corners;
            self.mesh.put(t, [a, b, c, p], [0, 0, 0, across]);
            self.mesh.point(across, 4 * t + 3);
            let [x, y, z] = corners.map(|v| Ray::new(self.at(v), origin));
            self.spheres[t as usize] = sphere(origin, x, y, z, self.doubt);
            for (k, (u, v)) in (0..).zip([(b, c), (c, a), (a, b)]) {
                let ends = u64::from(u.min(v)) << 32 | u64::from(u.max(v));
                edges.push((ends, 4 * t + k));
            }
        }
        edges.sort_unstable();
        for &[(_, e), (_, f)] in edges.as_chunks::<2>().0 {
            self.mesh.link(e, f);
        }
        Ok(tetrahedron(self.cavity[0]))
    }

    /// Whether t is in conflict with p.
    fn conflicts(&self, t: u32, p: u32) -> bool {
        self.view().conflicts(t, p)
    }

    #[inline(always)]
    fn view(&self) -> View<'_> {
        View {
            points: self.points,
            mesh: &self.mesh,
            spheres: &self.spheres,
            small: self.small,
            heights: self.heights.as_ref(),
        }
    }
}

/// What a conflict test reads.
#[derive(Clone, Copy)]
struct View<'a> {
    points: &'a [Point3],
    mesh: &'a Mesh3<'a>,
    spheres: &'a [Sphere],
    small: bool,
    heights: Option<&'a Heights>,
}

impl View<'_> {
    fn conflicts(&self, t: u32, p: u32) -> bool {
        let [x, y, z, square] = self.spheres[t as usize];
        let power = power([x, y, z, square], self.points[p as usize]);
        if power.abs() > SLACK * (power + 2.0 * square) {
            power < 0.0
        } else {
            self.conflicts_exactly(t, p)
        }
    }

    #[inline(never)]
    fn conflicts_exactly(&self, t: u32, p: u32) -> bool {
        let at = |v: u32| self.points[v as usize];
        let corners = self.mesh.corners(t);
        let Some(k) = self.mesh.infinite_corner(t) else {
            let [a, b, c, d] = corners;
            let heights = self.heights;
            let by_height = heights.and_then(|h| h.insphere(self.points, [a, b, c, d, p]));
            if let Some(sign) = by_height {
                return sign == Sign::Positive;
            }
            let [a, b, c, d] = [at(a), at(b), at(c), at(d)];
            let sign = if self.small {
                lattice::insphere_canonical([a, b, c, d, at(p)])
            } else {
                insphere_canonical(a, b, c, d, at(p))
            };
            return sign == Sign::Positive;
        };
        let [a, b, c] = FACETS[k];
        let [a, b, c] = [at(corners[a]), at(corners[b]), at(corners[c])];
        match orient3d(a, b, c, at(p)) {
            Sign::Positive => true,
            Sign::Negative => false,
            // See the head of the file.
            Sign::Zero => self.conflicts(tetrahedron(self.mesh.opposites(t)[k]), p),
        }
    }
}

/// Doubles the length of a list that is used as an array.
#[cold]
#[inline(never)]
fn grow(list: &mut Vec<u32>) -> Result<()> {
    let n = list.len();
    let bytes = 8 * n;
    list.try_reserve_exact(n)
        .map_err(|_| Error::Memory { bytes })?;
    list.resize(2 * n, 0);
    Ok(())
}
