//! The kernel: one point goes into the mesh by carving its cavity and filling it with a star.
//!
//! A. Bowyer, "Computing Dirichlet tessellations", and D. F. Watson, "Computing the n-dimensional
//! Delaunay tessellation", both The Computer Journal 24 (1981); the perturbation is that of O. Devillers
//! and M. Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations" (2011).
//!
//! # Why this is right on ties, too
//!
//! The mesh is the lower hull of the points so far at the heights |p|^2 - eps(p), projected; see
//! `delone_predicates` on ties. Five lifted points of which four span space are never in one
//! hyperplane, so each facet of that hull is one tetrahedron, and none is flat: a facet of a lower hull is not
//! vertical.
//!
//! A finite tetrahedron goes when the lifted new point p lies below its hyperplane: `insphere_canonical`.
//! A hull facet abc stops being one, and its ghost goes, when p lies beyond its plane, or in its plane and, among
//! the lifted points over that plane, below a, b, c. The lower hull over the plane of a hull facet is, by
//! the same heights, the canonical triangulation of its points in two dimensions (|p|^2 differs from the squared
//! length in the plane by an affine function), so coplanar hull facets come out canonical. No predicate
//! of the plane is needed: for the finite neighbour abcd of the ghost, the perturbed determinant of a,
//! b, c, d, p is orient3d(a, b, c, d) times the height of p above the affine function of a, b, c, d; as p is an
//! affine combination of a, b, c alone, the height of d does not count, and the answer for abcd is
//! that for abc in its plane. So **a ghost with p in its plane is in conflict when its finite neighbour is**.
//!
//! With these answers the tetrahedra in conflict are those that p takes from the hull, ghosts for vertical
//! facets included. The new ones are p joined to the border of what goes, each of them on the new
//! lower hull, so none is flat; what goes is one piece, as the star of p in the new triangulation of the sphere
//! is a ball and its complement, too. No vertex is inside it, as all points are extreme in the lift.
//!
//! # Why it ends
//!
//! A walk crosses facets that have p strictly beyond them; the power of p falls at each step (H. Edelsbrunner,
//! "An acyclicity theorem for cell complexes in d dimensions", 1990, for every lower hull), so no
//! tetrahedron comes twice. A cavity is part of the mesh. An insertion makes 2 v - 4 records where v is the number of
//! its new neighbours, so all make at most n^2, and none is removed more than once: the work is
//! bounded by the size that a triangulation in space may have.

use delone_predicates::{Point3, Sign, insphere_canonical, orient3d};

use super::sphere::{RANGE, Ray, Sphere, UNKNOWN, inside, sphere};
use crate::error::{Error, Result};
use crate::memory::{push, with_room, zeroed};
use crate::mesh3::{Code, FACETS, Mesh3, tetrahedron};

/// Stars of more vertices link by sorting their edges.
const TABLE: usize = 64;

/// No vertex.
const NONE: u32 = u32::MAX;

/// A facet of the hole: its corners, from inside, and what lies across.
#[derive(Clone, Copy)]
struct Rim {
    corners: [u32; 3],
    across: Code,
}

/// A mesh that grows by one point at a time.
pub struct Kernel<'a> {
    points: &'a [Point3],
    mesh: Mesh3,
    spheres: Vec<Sphere>,
    /// The vertex whose insertion has last found the record in conflict.
    mark: Vec<u32>,
    /// Where each vertex stands in `star`, if it does.
    place: Vec<u32>,
    certain: bool,
    cavity: Vec<u32>,
    rim: Vec<Rim>,
    star: Vec<u32>,
    rays: Vec<Ray>,
    table: Vec<Code>,
    edges: Vec<(u64, Code)>,
    work: usize,
}

impl<'a> Kernel<'a> {
    /// A kernel over `points`, which end with NaN for infinity, that starts from the positively
    /// oriented tetrahedron `first`.
    pub fn start(points: &'a [Point3], first: [u32; 4]) -> Result<Self> {
        let mut mesh = Mesh3::with_vertices(points.len() - 1)?;
        mesh.first(first)?;
        let bound = 2f64.powi(RANGE);
        let coordinates = points[..points.len() - 1].as_flattened();
        let room = 7 * points.len() + 64;
        let mut kernel = Self {
            points,
            mesh,
            spheres: with_room(room)?,
            mark: with_room(room)?,
            place: zeroed(points.len())?,
            certain: coordinates.iter().all(|x| x.abs() < bound),
            cavity: Vec::new(),
            rim: Vec::new(),
            star: Vec::new(),
            rays: Vec::new(),
            table: vec![0; TABLE * TABLE],
            edges: Vec::new(),
            work: 0,
        };
        kernel.extend()?;
        Ok(kernel)
    }

    /// Records met so far, on the way and in cavities.
    pub fn work(&self) -> usize {
        self.work
    }

    /// The mesh.
    pub fn into_mesh(self) -> Mesh3 {
        self.mesh
    }

    fn at(&self, v: u32) -> Point3 {
        self.points[v as usize]
    }

    /// Gives each record a sphere and a mark.
    fn extend(&mut self) -> Result<()> {
        while self.spheres.len() < self.mesh.records() {
            push(&mut self.spheres, UNKNOWN)?;
            push(&mut self.mark, NONE)?;
        }
        Ok(())
    }

    /// Inserts vertex `p`, which is none yet, and looks for its place from `near` on. Returns the new
    /// tetrahedron whose sphere holds `aim` deepest.
    pub fn insert(&mut self, p: u32, near: u32, aim: Point3) -> Result<u32> {
        let seed = self.seed(p, near)?;
        self.carve(p, seed)?;
        self.gather(p)?;
        self.fill(p, aim)
    }

    /// A tetrahedron in conflict with p.
    fn seed(&mut self, p: u32, near: u32) -> Result<u32> {
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
            let corners = self.mesh.corners(t).map(|v| self.at(v));
            let beyond = (0..4).find(|&k| {
                let [a, b, c] = FACETS[k].map(|i| corners[i]);
                orient3d(a, b, c, self.at(p)) == Sign::Negative
            });
            let Some(k) = beyond else {
                return Err(Error::Internal(format!(
                    "vertex {p} lies in tetrahedron {t}, and not in its sphere"
                )));
            };
            t = tetrahedron(self.mesh.opposites(t)[k]);
        }
    }

    /// Collects the tetrahedra in conflict with p, from `seed` outwards, and their border.
    fn carve(&mut self, p: u32, seed: u32) -> Result<()> {
        self.cavity.clear();
        self.rim.clear();
        self.mark[seed as usize] = p;
        self.cavity.push(seed);
        let mut next = 0;
        while let Some(&t) = self.cavity.get(next) {
            next += 1;
            let corners = self.mesh.corners(t);
            for (k, across) in self.mesh.opposites(t).into_iter().enumerate() {
                let other = tetrahedron(across);
                if self.mark[other as usize] == p {
                    continue;
                }
                if self.conflicts(other, p) {
                    self.mark[other as usize] = p;
                    push(&mut self.cavity, other)?;
                } else {
                    let corners = FACETS[k].map(|i| corners[i]);
                    push(&mut self.rim, Rim { corners, across })?;
                }
            }
        }
        self.work += self.cavity.len();
        Ok(())
    }

    /// Numbers the vertices of the border and looks at them from p.
    fn gather(&mut self, p: u32) -> Result<()> {
        self.star.clear();
        self.rays.clear();
        let origin = self.at(p);
        for rim in &self.rim {
            for v in rim.corners {
                let place = self.place[v as usize] as usize;
                if self.star.get(place) != Some(&v) {
                    self.place[v as usize] = self.star.len() as u32;
                    push(&mut self.star, v)?;
                    push(&mut self.rays, Ray::new(self.points[v as usize], origin))?;
                }
            }
        }
        Ok(())
    }

    /// Fills the hole with the star of p.
    fn fill(&mut self, p: u32, aim: Point3) -> Result<u32> {
        let infinite = self.mesh.infinite();
        let rims = std::mem::take(&mut self.rim);
        let mut best = (f64::INFINITY, NONE);
        for (i, rim) in rims.iter().enumerate() {
            let t = match self.cavity.get(i) {
                Some(&t) => t,
                None => {
                    let t = self.mesh.fresh()?;
                    push(&mut self.cavity, t)?;
                    self.extend()?;
                    t
                }
            };
            let [a, b, c] = rim.corners;
            self.mesh.set(t, [a, b, c, p]);
            self.mesh.link(4 * t + 3, rim.across);
            let [x, y, z] = rim
                .corners
                .map(|v| self.rays[self.place[v as usize] as usize]);
            let ghost = a == infinite || b == infinite || c == infinite;
            self.spheres[t as usize] = if self.certain && !ghost {
                sphere(self.at(p), x, y, z)
            } else {
                UNKNOWN
            };
            let [x, y, z, square] = self.spheres[t as usize];
            let power = Ray::new([x, y, z], aim).lift - square;
            // A NaN is less than nothing: ghosts and flat tetrahedra are for want of others.
            if power < best.0 {
                best = (power, t);
            } else if best.1 == NONE {
                best.1 = t;
            }
        }
        for t in self.cavity.drain(rims.len().min(self.cavity.len())..) {
            self.mesh.release(t);
        }
        if self.star.len() <= TABLE {
            self.link_by_table(&rims);
        } else {
            self.link_by_sorting(&rims)?;
        }
        self.rim = rims;
        Ok(best.1)
    }

    /// Links the star through a table of its directed edges: each is written before its reverse is read,
    /// so nothing is cleared.
    fn link_by_table(&mut self, rims: &[Rim]) {
        for pass in 0..2 {
            for (rim, &t) in rims.iter().zip(&self.cavity) {
                let [a, b, c] = rim.corners.map(|v| self.place[v as usize] as usize);
                for (k, (u, v)) in [(b, c), (c, a), (a, b)].into_iter().enumerate() {
                    let e = 4 * t + k as u32;
                    if pass == 0 {
                        self.table[TABLE * u + v] = e;
                    } else if u < v {
                        self.mesh.link(e, self.table[TABLE * v + u]);
                    }
                }
            }
        }
    }

    /// Links the star by sorting its edges: the two of a pair meet.
    fn link_by_sorting(&mut self, rims: &[Rim]) -> Result<()> {
        self.edges.clear();
        for (rim, &t) in rims.iter().zip(&self.cavity) {
            let [a, b, c] = rim.corners.map(u64::from);
            for (k, (u, v)) in (0..).zip([(b, c), (c, a), (a, b)]) {
                push(&mut self.edges, (u.min(v) << 32 | u.max(v), 4 * t + k))?;
            }
        }
        self.edges.sort_unstable();
        for &[(_, e), (_, f)] in self.edges.as_chunks::<2>().0 {
            self.mesh.link(e, f);
        }
        Ok(())
    }

    /// Whether t is in conflict with p.
    #[inline]
    fn conflicts(&self, t: u32, p: u32) -> bool {
        inside(self.spheres[t as usize], self.at(p)).unwrap_or_else(|| self.conflicts_exactly(t, p))
    }

    #[cold]
    #[inline(never)]
    fn conflicts_exactly(&self, t: u32, p: u32) -> bool {
        let Some(k) = self.mesh.infinite_corner(t) else {
            let [a, b, c, d] = self.mesh.corners(t).map(|v| self.at(v));
            return insphere_canonical(a, b, c, d, self.at(p)) == Sign::Positive;
        };
        let corners = self.mesh.corners(t);
        let [a, b, c] = FACETS[k].map(|i| self.at(corners[i]));
        match orient3d(a, b, c, self.at(p)) {
            Sign::Positive => true,
            Sign::Negative => false,
            // See the head of the file.
            Sign::Zero => self.conflicts(tetrahedron(self.mesh.opposites(t)[k]), p),
        }
    }
}
