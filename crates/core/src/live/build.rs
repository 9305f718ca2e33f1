//! The vertices of a live triangulation from all of its points.

use delone_predicates::lexicographic;

use super::kernel::Built;
use super::rows::Rows;
use super::store::{Counts, Site, Store};
use crate::base::error::Result;
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::order::sort_by;

/// Vertices as they are numbered, and their rows.
pub struct Sites<'a, const D: usize> {
    points: &'a [[f64; D]],
    rows: &'a [u32],
    /// The vertices, the one at infinity first.
    pub sites: Vec<Site<D>>,
    /// The rows at them.
    pub own: Rows,
}

impl<'a, const D: usize> Sites<'a, D> {
    /// None but the vertex at infinity, with room for `room` vertices.
    pub fn of(points: &'a [[f64; D]], rows: &'a [u32], total: usize, room: usize) -> Result<Self> {
        let mut sites = with_room(room)?;
        sites.push(Site::AT_INFINITY);
        Ok(Self {
            points,
            rows,
            sites,
            own: Rows::gone(total)?,
        })
    }

    /// Numbers point i; there is room.
    pub fn add(&mut self, i: u32) -> u32 {
        let v = self.sites.len() as u32;
        let p = self.points[i as usize].map(|x| x + 0.0);
        self.sites.push(Site::at(p));
        self.attach(i, v);
        v
    }

    /// Puts the row of point i at vertex v.
    pub fn attach(&mut self, i: u32, v: u32) {
        let site = &mut self.sites[v as usize];
        site.head = self.own.attach(self.rows[i as usize], v, site.head);
    }
}

/// The vertices of points in one line or plane, with room for `room`, in lexicographic order.
pub fn flat<K, const D: usize>(
    points: &[[f64; D]],
    rows: &[u32],
    total: usize,
    room: usize,
    mesh: impl FnOnce(Store<D>) -> K,
    watch: &Watch,
) -> Result<Built<K>> {
    let mut order = with_room(points.len())?;
    order.extend(0..points.len() as u32);
    let point = |i: u32| points[i as usize];
    let along = |&i: &u32, &j: &u32| lexicographic(point(i), point(j)).then(i.cmp(&j));
    sort_by(&mut order, watch, along)?;
    let mut sites = Sites::of(points, rows, total, room)?;
    let mut list: Vec<u32> = with_room(points.len())?;
    for i in order {
        match list.last() {
            Some(&v) if sites.sites[v as usize].at == point(i) => sites.attach(i, v),
            _ => list.push(sites.add(i)),
        }
    }
    let counts = Counts::of(list.len(), 0);
    let store = Store::of(Vec::new(), sites.sites, counts)?;
    Ok((mesh(store), sites.own, list))
}
