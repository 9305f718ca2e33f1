//! Shared by exact validators: the kinds of faults, checks of adjacent simplices, which rows must be
//! vertices, and the steps that are the same in 2-D and 3-D.

use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::watch::{Pace, Watch};

/// Simplices between two checks for interruption.
const LOT: usize = 1 << 16;
/// Simplices that are judged between two checks for interruption.
const JUDGED: usize = 1 << 12;

/// Faults by kind, where facets have `D` corners; all are empty if a triangulation is right.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Findings<const D: usize> {
    /// Simplices that are not positively oriented.
    pub orientation: Vec<u32>,
    /// Oriented facets that belong to more than one simplex; in 2-D directed edges. Not sought in more
    /// than three dimensions.
    pub facets: Vec<[u32; D]>,
    /// Simplices whose neighbor across some facet does not share that facet.
    pub neighbors: Vec<u32>,
    /// Facets of the boundary at which it is not convex or not closed.
    pub hull: Vec<[u32; D]>,
    /// Distinct points that are not vertices; with weights, those outside all simplices.
    pub missing: Vec<u32>,
    /// Points with weights that are in no simplex and should be. They, and those with weights that are
    /// missing, are sought only if there is no other fault.
    pub hidden: Vec<u32>,
    /// Vertices that are not the row that represents their coordinates.
    pub repeats: Vec<u32>,
    /// Adjacent simplices one of which has the other's apex in its circumsphere.
    pub delaunay: Vec<[u32; 2]>,
    /// Adjacent simplices on one sphere whose common facet is not a canonical one.
    pub ties: Vec<[u32; 2]>,
    /// The expected number of triangles, 2 n - h - 2, and the actual one, if they differ.
    pub count: Vec<[u32; 2]>,
    /// Simplices of more than three dimensions that have a point that another one, the first, also
    /// covers.
    pub overlaps: Vec<u32>,
}

/// What a local test says about two simplices with a common facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// They are locally Delaunay (with weights, locally regular), ties included.
    Right,
    /// The lifted apex of one lies below the lifted plane of the other.
    Wrong,
    /// Both lie in one lifted plane, but the canonical triangulation has another facet.
    Tie,
}

/// The rows that may be vertices.
#[derive(Debug, Clone, Copy)]
pub struct Expected<'a> {
    /// One row for each distinct point.
    pub rows: &'a [u32],
    /// `[row, row that represents it]` for all other rows.
    pub others: &'a [[u32; 2]],
    /// Whether some of `rows` may be hidden.
    pub may_hide: bool,
}

impl Expected<'_> {
    /// The rows that no simplex uses, in the order of `rows`. Rows that are used although another
    /// one represents them go to `repeats`.
    pub fn unused<const N: usize>(
        &self,
        simplices: &[[i32; N]],
        repeats: &mut Vec<u32>,
        watch: &Watch,
    ) -> Result<Vec<u32>> {
        let mut used = filled(self.rows.len() + self.others.len(), false)?;
        for lot in simplices.chunks(LOT) {
            watch.check()?;
            for &v in lot.as_flattened() {
                used[v as usize] = true;
            }
        }
        for &[row, standing] in self.others {
            if used[row as usize] {
                repeats.push(row);
                used[standing as usize] = true;
            }
        }
        let rows = self.rows.iter().copied();
        Ok(rows.filter(|&row| !used[row as usize]).collect())
    }
}

/// Triangulations whose facets can be compared: what the checks need to know of a dimension.
pub trait Tiling<const D: usize, const N: usize>: Copy {
    /// The facet opposite corner k of simplex t, outward, in a form that is the same for all simplices.
    fn facet(self, t: usize, k: usize) -> [i32; D];

    /// A facet as it is seen from the other side.
    fn turned(facet: [i32; D]) -> [i32; D];

    /// Whether a simplex is positively oriented.
    fn is_positive(self, t: usize) -> bool;

    /// The facets that occur twice.
    fn repeated(self, watch: &Watch) -> Result<Vec<[u32; D]>>;

    /// Checks that outward facets bound a convex body; there are `used` vertices.
    fn check_boundary(self, boundary: Vec<[i32; D]>, used: usize, found: &mut Findings<D>);
}

/// Checks that `given` tiles the convex hull of its vertices, and asks `judge` at each inner facet:
/// about a simplex, one of its corners, and the apex of its neighbor opposite. Returns all faults except
/// `missing`, and the expected rows that no simplex uses.
pub fn examine<'a, const D: usize, const N: usize>(
    given: Given<'a, D, N>,
    expected: Expected,
    judge: impl Fn(usize, usize, i32) -> Verdict,
    watch: &Watch,
) -> Result<(Findings<D>, Vec<u32>)>
where
    Given<'a, D, N>: Tiling<D, N>,
{
    let mut found = Findings {
        facets: given.repeated(watch)?,
        ..Findings::default()
    };
    let unused = expected.unused(given.simplices, &mut found.repeats, watch)?;
    let mut boundary = Vec::new();
    let mut pace = Pace::new(watch, JUDGED);
    for t in 0..given.simplices.len() {
        pace.spend(1)?;
        if !given.is_positive(t) {
            found.orientation.push(t as u32);
        }
        let mut joined = true;
        for k in 0..N {
            let facet = given.facet(t, k);
            let Ok(other) = usize::try_from(given.neighbors[t][k]) else {
                push(&mut boundary, facet)?;
                continue;
            };
            // The corner of the neighbor whose opposite facet is this one, from the other side.
            let turned = Given::<D, N>::turned(facet);
            let mutual = |&j: &usize| {
                given.neighbors[other][j] == t as i32 && given.facet(other, j) == turned
            };
            let Some(j) = (0..N).find(mutual) else {
                joined = false;
                continue;
            };
            if t < other {
                let pair = [t as u32, other as u32];
                match judge(t, k, given.simplices[other][j]) {
                    Verdict::Wrong => found.delaunay.push(pair),
                    Verdict::Tie => found.ties.push(pair),
                    Verdict::Right => {}
                }
            }
        }
        if !joined {
            found.neighbors.push(t as u32);
        }
    }
    watch.check()?;
    let hidden = if expected.may_hide { unused.len() } else { 0 };
    given.check_boundary(boundary, expected.rows.len() - hidden, &mut found);
    Ok((found, unused))
}

/// Checks that `given` is the triangulation of all `rows`; `others` are those that repeat one of them.
pub fn examine_all<'a, const D: usize, const N: usize>(
    given: Given<'a, D, N>,
    rows: &[u32],
    others: &[[u32; 2]],
    judge: impl Fn(usize, usize, i32) -> Verdict,
    watch: &Watch,
) -> Result<Findings<D>>
where
    Given<'a, D, N>: Tiling<D, N>,
{
    let expected = Expected {
        rows,
        others,
        may_hide: false,
    };
    let (mut found, mut unused) = examine(given, expected, judge, watch)?;
    unused.sort_unstable();
    found.missing = unused;
    Ok(found)
}
