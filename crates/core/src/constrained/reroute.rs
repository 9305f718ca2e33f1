//! A few crossing segments: only they are reinserted, and the others stay where they are.
//!
//! Segments blocked by a marked edge wait until all others are inserted. The marked edges that each
//! crosses give the rows that it crosses; with the pairs among those that wait these are all pairs,
//! since of two segments that cross, one was inserted first or neither was. The rows of these pairs
//! are removed, their crossings inserted, and the rows are inserted again through their crossings,
//! as `split` would do it.
//!
//! Some cases are not handled here, and `split` starts from the beginning: a rounded crossing lies
//! on another segment; a segment passes through the pixel of a crossing of others; a crossing
//! segment passes through the pixel of any vertex that is neither on it nor one of its crossings;
//! or a piece still crosses another. In all other cases the pieces are the same as there, and so
//! are the triangles, since one set of pieces has one triangulation.

use std::collections::BTreeSet;

use delone_predicates::{Point2, orient2d};

use super::edges::{Edges, edge};
use super::inserted::Inserted;
use super::marked::{Marked, turn};
use super::near::{Seen, is_near, passes};
use super::segment::{Cavity, Step};
use super::split::route;
use super::{Crossings, Work, pairs};
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::Watch;
use crate::mesh::plane::{next, prev};

/// How many segments may wait: this many, or one in `ONE_IN`.
const FEW: usize = 16;
const ONE_IN: usize = 32;
/// One crossing per this many points, plus a few: inserted one by one they cost more than all
/// points at once.
const POINTS: usize = 4;

impl Work<'_> {
    /// How many segments may wait.
    pub(super) fn few(&self) -> usize {
        FEW + self.ends.len() / ONE_IN
    }

    /// Inserts the segments that wait and those that they cross, `inserted` being all others. `None` if
    /// that does not suffice; then the triangulation must be discarded.
    pub(super) fn reroute(
        &mut self,
        input: &[Point2],
        mut inserted: Inserted,
        waiting: &[u32],
        watch: &Watch,
    ) -> Result<Option<Inserted>> {
        let most = FEW + input.len() / POINTS;
        // Find all crossing pairs and their crossings.
        let Some(pairs) = self.pairs_of(input, &inserted, waiting, most, watch)? else {
            return Ok(None);
        };
        let found = self.meetings(input, pairs, watch)?;
        let mut rows = found.pairs.concat();
        rows.sort_unstable();
        rows.dedup();
        // A segment that waits but crosses nothing is a case for `split`.
        if !waiting.iter().all(|row| rows.binary_search(row).is_ok()) {
            return Ok(None);
        }
        // Remove the crossing rows and insert their crossings as vertices.
        self.remove_rows(&mut inserted, &rows)?;
        let before = self.marked.count;
        let Some(meets) = self.insert(input.len(), &found)? else {
            return Ok(None);
        };
        // Give up if another inserted segment passes through a new pixel.
        for w in before..self.marked.count {
            if self.is_passed(w as u32)? {
                return Ok(None);
            }
        }
        for (&[s, t], &w) in found.pairs.iter().zip(&meets) {
            push(&mut inserted.crossings, [s, t, w])?;
        }
        // The crossings of each row, as pairs of row and vertex.
        let mut own = with_room(2 * meets.len())?;
        for &[s, t, w] in &inserted.crossings {
            own.extend([[s, w], [t, w]]);
        }
        own.sort_unstable();
        // Compute all stops first, so that they are independent of the order of the rows.
        let mut routes = with_room(rows.len())?;
        let mut seen = Seen::default();
        for meets in own.chunk_by(|a, b| a[0] == b[0]) {
            watch.check()?;
            let row = meets[0][0];
            let ends = self.ends[row as usize];
            let own: Vec<_> = meets.iter().map(|m| m[1]).collect();
            let through = &mut inserted.through;
            let rounded = |w: u32| w as usize >= before;
            let meets = own.clone();
            let stops = route(
                &mut self.marked,
                ends,
                row,
                meets,
                rounded,
                through,
                &mut seen,
            )?;
            if !self.is_clear(ends, &stops, &own) {
                return Ok(None);
            }
            routes.push((row, stops));
        }
        // All routes are clear: insert the rows again along them.
        let mut cavity = Cavity::default();
        for (row, stops) in routes {
            watch.check()?;
            if !self.insert_again(row, &stops, &mut inserted, &mut cavity)? {
                return Ok(None);
            }
        }
        (inserted.sorted, inserted.repeated) = (false, true);
        Ok(Some(inserted))
    }

    /// All pairs that cross, ascending; `waiting` are all rows that are not inserted. `None` if
    /// there are more than `most`.
    fn pairs_of(
        &mut self,
        input: &[Point2],
        inserted: &Inserted,
        waiting: &[u32],
        most: usize,
        watch: &Watch,
    ) -> Result<Option<Vec<[u32; 2]>>> {
        // The marked edges that each waiting segment crosses.
        let mut met = Vec::new();
        for &row in waiting {
            watch.check()?;
            let [a, b] = self.ends[row as usize];
            self.marked.cross(a, b, |mesh, e| {
                if mesh.is_marked(e) {
                    let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
                    met.push((edge(ends), row));
                }
            })?;
            if met.len() > most {
                return Ok(None);
            }
        }
        met.sort_unstable();
        let edges = Edges::of(met.iter().map(|m| m.0).collect(), self.marked.count)?;
        // The pairs among the waiting segments.
        let own: Vec<_> = waiting.iter().map(|&r| self.segments[r as usize]).collect();
        let mut pairs = pairs::crossing_pairs_above(input, &own, most, watch)?;
        for pair in &mut pairs {
            *pair = pair.map(|i| waiting[i as usize]);
        }
        // The pairs of a waiting segment and an inserted row that covers a crossed edge.
        for &(ends, row) in &inserted.pieces {
            let Some(place) = edges.place(ends) else {
                continue;
            };
            let first = met.partition_point(|m| m.0 < edges.all[place]);
            let here = met[first..].iter().take_while(|m| m.0 == edges.all[place]);
            pairs.extend(here.map(|m| [m.1.min(row), m.1.max(row)]));
            if pairs.len() > most {
                return Ok(None);
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        Ok((pairs.len() <= most).then_some(pairs))
    }

    /// Removes the inserted pieces of the `rows`, which are ascending.
    fn remove_rows(&mut self, inserted: &mut Inserted, rows: &[u32]) -> Result<()> {
        let mut goes = filled(self.ends.len(), false)?;
        for &row in rows {
            goes[row as usize] = true;
        }
        let mut gone = Vec::new();
        inserted.pieces.retain(|&(ends, row)| {
            if goes[row as usize] {
                gone.push(edge(ends));
            }
            !goes[row as usize]
        });
        inserted.through.retain(|t| !goes[t[0] as usize]);
        let mut free = Edges::of(gone, self.marked.count)?;
        if inserted.repeated {
            let mut kept: Vec<_> = (inserted.pieces.iter())
                .filter_map(|p| free.place(p.0))
                .collect();
            kept.sort_unstable();
            kept.dedup();
            for place in kept.into_iter().rev() {
                free.all.remove(place);
            }
        }
        self.marked.stack.clear();
        for [u, v] in free.all {
            let e = self.marked.edge(u, v)?;
            self.marked.patch().mark(e, false);
            self.marked.stack.push(e);
        }
        self.marked.legalize()
    }

    /// Inserts the crossings as vertices after the `n` rows of the input. `None` if one lies on a
    /// segment or there are too many.
    fn insert(&mut self, n: usize, found: &Crossings) -> Result<Option<Vec<u32>>> {
        let mut meets = with_room(found.points.len())?;
        for (&[s, t], &x) in found.pairs.iter().zip(&found.points) {
            let ends = [s, t].map(|row| self.ends[row as usize]);
            let far = |&v: &u32| {
                let p = self.marked.at(v);
                (0.5 * p[0] - 0.5 * x[0]).abs() + (0.5 * p[1] - 0.5 * x[1]).abs()
            };
            let ends = ends.into_iter().flatten();
            let near = ends.min_by(|v, w| far(v).total_cmp(&far(w)));
            let from = self.marked.near[near.unwrap_or(0) as usize];
            let before = self.marked.count;
            let (w, parted) = self.marked.vertex_at(x, from)?;
            if self.marked.count > before {
                let row = (n + self.met.len()) as u32;
                push(&mut self.rows, row)?;
                push(&mut self.met, x)?;
            }
            if parted.is_some() || self.met.len() > self.options.max_vertices {
                return Ok(None);
            }
            meets.push(w);
        }
        Ok(Some(meets))
    }

    /// Whether an inserted segment passes through the pixel of vertex `w`. It suffices to search
    /// from w across edges that are as near as a pixel.
    fn is_passed(&mut self, w: u32) -> Result<bool> {
        let start = self.marked.near[w as usize];
        let p = self.marked.at(w);
        let triangles = self.marked.triangles();
        let Marked { points, mesh, .. } = &mut self.marked;
        let mesh = &mesh.resume(triangles);
        let mut stack = vec![start];
        let mut corner = turn(mesh, start);
        while corner != start {
            push(&mut stack, corner)?;
            corner = turn(mesh, corner);
        }
        let mut seen = BTreeSet::new();
        while let Some(e) = stack.pop() {
            let ends = [next(e), prev(e)].map(|c| mesh.vertex(c));
            if ends.contains(&mesh.infinite()) || !seen.insert(e) {
                continue;
            }
            let [r, s] = ends.map(|v| points[v as usize]);
            if mesh.is_marked(e) {
                if passes(r, s, p) {
                    return Ok(true);
                }
            } else if is_near(r, s, p) {
                let o = mesh.opposite(e);
                push(&mut stack, next(o))?;
                push(&mut stack, prev(o))?;
            }
        }
        Ok(false)
    }

    /// Whether a segment passes through no pixel but those of vertices on it and of its crossings
    /// `meets`, which are ascending.
    fn is_clear(&self, [a, b]: [u32; 2], stops: &[u32], meets: &[u32]) -> bool {
        let [p, q] = [a, b].map(|v| self.marked.at(v));
        stops
            .iter()
            .all(|v| meets.binary_search(v).is_ok() || orient2d(p, q, self.marked.at(*v)).is_zero())
    }

    /// Inserts a segment through its `stops`; returns whether nothing blocked it.
    fn insert_again(
        &mut self,
        row: u32,
        stops: &[u32],
        inserted: &mut Inserted,
        cavity: &mut Cavity,
    ) -> Result<bool> {
        for pair in stops.windows(2) {
            let [mut a, mut b] = [pair[0], pair[1]];
            while a != b {
                let Step::Joined { from, to, .. } = self.marked.join(a, b, cavity)? else {
                    return Ok(false);
                };
                let ends = if from == a { [a, to] } else { [to, b] };
                push(&mut inserted.pieces, (ends, row))?;
                (a, b) = if from == a { (to, b) } else { (a, to) };
            }
        }
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Options;
    use super::super::split::Splitter;
    use super::*;
    use crate::constrained::inserted::insert_all;
    use crate::delaunay::Clock;
    use crate::delaunay::plane::Method;

    type Bits = [u64; 2];

    /// The resulting triangulation by coordinates: its triangles, the pieces with their rows, and
    /// the vertices on segments and at crossings.
    #[derive(Debug, PartialEq)]
    struct Outcome {
        triangles: BTreeSet<[Bits; 3]>,
        pieces: BTreeSet<(Bits, Bits, u32)>,
        through: BTreeSet<(u32, Bits)>,
        crossings: BTreeSet<(u32, u32, Bits)>,
        added: Vec<Bits>,
    }

    fn outcome(work: &mut Work, inserted: &Inserted, n: usize) -> Outcome {
        let bits = |p: Point2| p.map(|x| (x + 0.0).to_bits());
        let points = work.marked.points.clone();
        let at = |v: u32| bits(points[v as usize]);
        let triangles = work.marked.triangles();
        let mesh = work.marked.patch();
        let real = (0..triangles).filter(|&t| !mesh.corners(t).contains(&mesh.infinite()));
        let turned = |t: u32| {
            let mut corners = mesh.corners(t).map(at);
            while corners.iter().min() != Some(&corners[0]) {
                corners.rotate_left(1);
            }
            corners
        };
        let triangles = real.map(turned).collect();
        let pieces = inserted.pieces.iter();
        Outcome {
            triangles,
            pieces: pieces.map(|&([u, v], row)| (at(u), at(v), row)).collect(),
            through: inserted.through.iter().map(|t| (t[0], at(t[1]))).collect(),
            crossings: (inserted.crossings.iter())
                .map(|c| (c[0], c[1], at(c[2])))
                .collect(),
            added: work.added(n).into_iter().map(bits).collect(),
        }
    }

    /// Inserting crossing segments in place, or all of them again, gives the same result.
    fn check(points: &[Point2], segments: &[[u32; 2]]) -> std::result::Result<bool, TestCaseError> {
        let options = Options {
            split: true,
            conforming: false,
            max_vertices: 10_000,
            method: Method::Auto,
            workers: 1,
        };
        let watch = Watch::idle();
        let start = || Work::start(points, segments, options, &watch, &mut Clock::start());
        let Ok(mut work) = start() else {
            return Ok(false);
        };
        let (inserted, waiting) = insert_all(&mut work.marked, &work.ends, usize::MAX, &watch)
            .unwrap()
            .unwrap();
        if waiting.is_empty() {
            return Ok(false);
        }
        let Some(inserted) = work.reroute(points, inserted, &waiting, &watch).unwrap() else {
            return Ok(false);
        };
        let found = outcome(&mut work, &inserted, points.len());
        let mut work = start().unwrap();
        let crossings = work.crossings(points, &watch).unwrap();
        let meets = work.start_again(points, &crossings, &watch).unwrap();
        let mut splitter = Splitter::new(&mut work.marked, &work.ends, 10_000, &watch).unwrap();
        let rows = &work.rows;
        let is_rounded = |w: u32| {
            rows.get(w as usize)
                .is_none_or(|&r| r as usize >= points.len())
        };
        splitter.run(&crossings.pairs, &meets, is_rounded).unwrap();
        let inserted = splitter.finish().unwrap();
        prop_assert_eq!(
            found,
            outcome(&mut work, &inserted, points.len()),
            "{:?} {:?}",
            points,
            segments
        );
        Ok(true)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        #[test]
        fn in_place_and_all_again_agree(
            points in prop::collection::vec((0..9, 0..9), 3..24),
            segments in prop::collection::vec((any::<u32>(), any::<u32>()), 2..16),
            offset in prop::sample::select(vec![0.0, 1e3, 2f64.powi(40), 2f64.powi(51)]),
        ) {
            let n = points.len() as u32;
            let points: Vec<_> = (points.iter())
                .map(|&(x, y)| [f64::from(x) + offset, f64::from(y)])
                .collect();
            let segments: Vec<_> = segments.iter().map(|&(a, b)| [a % n, b % n]).collect();
            check(&points, &segments)?;
        }
    }

    #[test]
    fn two_diagonals_are_inserted_in_place() {
        let square = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];
        let twice = [[0, 2], [1, 3], [2, 0]];
        assert!(check(&square, &twice).unwrap());
    }

    #[test]
    fn a_segment_through_the_pixel_of_a_crossing_behind_another_edge() {
        let x = 2f64.powi(51);
        let points = [
            [7.0, 4.0],
            [3.0, 0.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [5.0, 3.0],
            [4.0, 1.0],
        ];
        let points = points.map(|p| [p[0] + x, p[1]]);
        assert!(!check(&points, &[[1, 0], [1, 4], [5, 2]]).unwrap());
    }
}
