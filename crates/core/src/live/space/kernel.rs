//! The operations of a live triangulation that are specific to 3-D.

use delone_predicates::{Point3, Sign, nearer3, orient3d};

use super::build;
use super::mesh::{INFINITE, Mesh};
use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::memory::make_room;
use crate::base::points::{LIMIT3, collinear};
use crate::base::watch::{Pace, Watch};
use crate::live::kernel::{Built, Kernel};
use crate::live::store::{Place, Removed};
use crate::locate::space::{self, barycentric};
use crate::mesh::space::{Code, FACETS, tetrahedron};

impl Kernel<3, 4> for Mesh {
    type Segments = ();

    const LIMIT: usize = LIMIT3;
    const RECORDS: usize = 7;
    /// A rebuild takes 2 us per vertex: a point is inserted in 8, removed in 17, and moved in 12 to 26.
    const SHARES: [usize; 3] = [4, 10, 10];

    fn built(
        points: &[Point3],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<Built<Self>> {
        build::built(points, rows, total, workers, watch)
    }

    #[inline]
    fn record_of(code: Code) -> u32 {
        tetrahedron(code)
    }

    fn record_at(near: u32) -> u32 {
        near
    }

    /// Ascending, or with the last two exchanged.
    fn arrange(rows: &mut [i64; 4]) {
        let mut odd = false;
        for i in 1..4 {
            for j in (1..=i).rev() {
                if rows[j - 1] > rows[j] {
                    rows.swap(j - 1, j);
                    odd = !odd;
                }
            }
        }
        if odd {
            rows.swap(2, 3);
        }
    }

    #[inline]
    fn nearer(q: Point3, a: Point3, b: Point3) -> Sign {
        nearer3(q, a, b)
    }

    fn weights(corners: [Point3; 4], q: Point3) -> [f64; 4] {
        let on = FACETS.map(|facet| {
            let [a, b, c] = facet.map(|k| corners[k]);
            orient3d(a, b, c, q).is_zero()
        });
        let given = Given {
            points: &corners,
            simplices: &[[0, 1, 2, 3]],
            neighbors: &[],
        };
        barycentric(&given, &space::Place { simplex: 0, on }, q)
    }

    fn spans(&self, flat: &[u32], p: Point3) -> bool {
        let at = |v: u32| self.at(v);
        let [a, ref middle @ .., b] = *flat else {
            return false;
        };
        let third = middle.iter().find(|&&v| !collinear(at(a), at(b), at(v)));
        third.is_some_and(|&c| !orient3d(at(a), at(b), at(c), p).is_zero())
    }

    fn find(&mut self, q: Point3, watch: &Watch) -> Result<u32> {
        self.find(q, watch)
    }

    fn place(&mut self, q: Point3, watch: &Watch) -> Result<Place> {
        self.place(q, watch)
    }

    fn insert(&mut self, v: u32, seed: u32, pace: &mut Pace) -> Result<()> {
        self.insert(v, seed, pace)
    }

    fn unlink(&mut self, v: u32, always: bool, pace: &mut Pace) -> Result<Removed> {
        self.unlink(v, always, pace)
    }

    fn shift(&mut self, v: u32, p: Point3) -> Result<bool> {
        self.shift(v, p)
    }

    fn rename(&mut self, v: u32) -> Result<()> {
        self.rename(v)
    }

    fn set_head(&mut self, v: u32, head: u32) {
        self.sites.get_mut(v as usize).head = head;
    }

    fn around(&mut self, v: u32, list: &mut Vec<u32>, pace: &mut Pace) -> Result<()> {
        self.gather(v)?;
        pace.spend(self.patch.rim.len())?;
        list.clear();
        for &e in &self.patch.rim {
            make_room(list, 3)?;
            list.extend(self.facet(e));
        }
        list.retain(|&w| w != INFINITE);
        list.sort_unstable();
        list.dedup();
        Ok(())
    }

    fn check(&self) -> std::result::Result<(), String> {
        self.check()
    }
}
