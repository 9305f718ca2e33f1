//! Voronoi cells: around each site the vertices and ridges of its cell, counterclockwise.

use super::given::Given;
use super::ridges::{OWNED, SHARED};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room, zeroed};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Cells per task.
const SHARE: usize = 1 << 12;

/// Cells, in the order in which their sites first occur in the triangles.
#[derive(Debug, Default)]
pub struct Regions {
    /// The cell of each point, -1 if it has none.
    pub of_point: Vec<i32>,
    /// The point of each cell.
    pub site: Vec<i32>,
    /// The entries of cell r are `starts[r]..starts[r + 1]`.
    pub starts: Vec<i32>,
    /// Entry: a vertex, counterclockwise, -1 for an end that is a ray.
    pub vertices: Vec<i32>,
    /// Entry: the ridge that follows the vertex.
    pub ridges: Vec<i32>,
}

/// The input of a walk around sites.
pub(super) struct Walk<'a> {
    pub given: Given<'a, 2, 3>,
    pub masks: &'a [u8],
    pub vertex: &'a [i32],
    pub first_ridge: &'a [u32],
}

/// The output slots of some cells.
struct Part<'a> {
    vertices: &'a mut [i32],
    ridges: &'a mut [i32],
    used: usize,
}

impl Part<'_> {
    fn push(&mut self, vertex: i32, ridge: i32) -> Result<()> {
        let slot = self
            .vertices
            .get_mut(self.used)
            .zip(self.ridges.get_mut(self.used));
        let (v, r) =
            slot.ok_or_else(|| Error::Shape("the triangles around a site form two fans".into()))?;
        (*v, *r) = (vertex, ridge);
        self.used += 1;
        Ok(())
    }
}

/// For each cell where its entries begin: it has as many as ridges have its site.
fn starts(sites: &[[i32; 2]], of_point: &[i32], cells: usize) -> Result<Vec<i32>> {
    let mut starts = filled(cells + 1, 0)?;
    for &v in sites.as_flattened() {
        starts[of_point[v as usize] as usize + 1] += 1;
    }
    for i in 0..cells {
        starts[i + 1] += starts[i];
    }
    Ok(starts)
}

/// The cell of each point; for each cell its point, and its first corner as 4 t + k.
fn first_corners(given: Given<2, 3>) -> Result<(Vec<i32>, Vec<i32>, Vec<u32>)> {
    let mut of_point = filled(given.points.len(), -1)?;
    let mut site = with_room(given.points.len())?;
    let mut codes = with_room(given.points.len())?;
    for (t, corners) in (0_u32..).zip(given.simplices) {
        for (k, &v) in (0_u32..).zip(corners) {
            if of_point[v as usize] < 0 {
                of_point[v as usize] = site.len() as i32;
                site.push(v);
                codes.push(4 * t + k);
            }
        }
    }
    Ok((of_point, site, codes))
}

impl Walk<'_> {
    /// The cells of all points that are corners of triangles; `sites` are those of all ridges.
    pub(super) fn regions(
        &self,
        sites: &[[i32; 2]],
        workers: usize,
        watch: &Watch,
    ) -> Result<Regions> {
        let (of_point, site, codes) = first_corners(self.given)?;
        let starts = starts(sites, &of_point, site.len())?;
        let total = 2 * sites.len();
        let (mut vertices, mut ridges) = (zeroed::<i32>(total)?, zeroed::<i32>(total)?);
        let (mut rest_v, mut rest_r) = (&mut vertices[..], &mut ridges[..]);
        let mut tasks = Vec::with_capacity(codes.len() / SHARE + 1);
        for (i, codes) in codes.chunks(SHARE).enumerate() {
            let room = starts[i * SHARE + codes.len()] - starts[i * SHARE];
            let (v, w) = rest_v.split_at_mut(room as usize);
            let (r, s) = rest_r.split_at_mut(room as usize);
            let used = 0;
            tasks.push((
                codes,
                Part {
                    vertices: v,
                    ridges: r,
                    used,
                },
            ));
            (rest_v, rest_r) = (w, s);
        }
        let done = parallel::map(workers, tasks, |(codes, mut part)| {
            watch.check()?;
            codes
                .iter()
                .try_for_each(|&code| self.cell(code, &mut part))
        });
        done.into_iter().collect::<Result<()>>()?;
        Ok(Regions {
            of_point,
            site,
            starts,
            vertices,
            ridges,
        })
    }

    fn cell(&self, code: u32, part: &mut Part) -> Result<()> {
        let (t, k) = (code as usize / 4, code as usize % 4);
        let start = part.used;
        if !self.around(t, k, part)? {
            part.used = start;
            self.open(t, k, part)?;
        }
        Ok(())
    }

    /// Walks counterclockwise around corner k of triangle t; returns whether the turn was complete.
    #[inline]
    fn around(&self, t: usize, k: usize, part: &mut Part) -> Result<bool> {
        let (mut now, mut corner) = (t, k);
        // A turn visits each triangle once, so there are no more steps than triangles.
        for _ in 0..=self.masks.len() {
            let edge = (corner + 1) % 3;
            let next = self.given.neighbors[now][edge];
            let back = if next < 0 {
                0
            } else {
                self.given.back(now, next as usize)?
            };
            if self.masks[now] & SHARED & (1 << edge) == 0 {
                part.push(self.vertex[now].max(-1), self.ridge(now, edge, next, back))?;
            }
            if next < 0 {
                return Ok(false);
            }
            (now, corner) = (next as usize, (back + 1) % 3);
            if now == t {
                return Ok(true);
            }
        }
        Err(Error::Shape(format!(
            "the walk around one corner of triangle {t} does not terminate"
        )))
    }

    /// Adds the cell of a corner at the boundary: from the incoming ray to the outgoing one.
    fn open(&self, t: usize, k: usize, part: &mut Part) -> Result<()> {
        let (mut now, mut corner) = (t, k);
        for _ in 0..=self.masks.len() {
            let edge = (corner + 2) % 3;
            let before = self.given.neighbors[now][edge];
            if before < 0 {
                part.push(-1, self.ridge(now, edge, before, 0))?;
                self.around(now, corner, part)?;
                return Ok(());
            }
            let back = self.given.back(now, before as usize)?;
            (now, corner) = (before as usize, (back + 2) % 3);
        }
        Err(Error::Shape(format!(
            "the walk around one corner of triangle {t} does not terminate"
        )))
    }

    /// The number of the ridge of edge k of triangle t; for `other`, across it, it is edge `back`.
    #[inline]
    fn ridge(&self, t: usize, k: usize, other: i32, back: usize) -> i32 {
        let owned = self.masks[t] >> (OWNED + k as u32) & 1 == 1;
        // Two selections, since a branch would be unpredictable.
        let (t, k) = (
            if owned { t } else { other as usize },
            if owned { k } else { back },
        );
        let owned = u32::from(self.masks[t] >> OWNED);
        let before = (owned & ((1 << k) - 1)).count_ones();
        (self.first_ridge[t] + before) as i32
    }
}
