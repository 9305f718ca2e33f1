//! Edits of batches of points: all or nothing.

use std::ops::Range;

use delone_predicates::lexicographic;

use super::Live;
use super::kernel::{Constraints, Kernel, Move};
use super::rows::NONE;
use super::store::{Place, Removed};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, make_room, push, with_room};
use crate::base::points;
use crate::base::watch::{IDLE, Pace, Watch};
use crate::order::{order_of, sort, sort_by};

/// A batch of at most this many points is never a rebuild.
const FEW: usize = 64;

/// A batch of more than this share of the vertices needs no tree of starting points.
const DENSE: usize = 64;

/// Points between two checks for interruption.
const LOT: usize = 1 << 10;

/// Records that an edit may visit on average, for each doubling of the number of points; a batch
/// that needs more, such as one on lines that nearly coincide, is a rebuild.
const BUDGET: usize = 16;

/// How a batch that has not failed ends.
enum Outcome {
    /// It is done.
    Done,
    /// A rebuild is cheaper, or needed because there is no simplex.
    Rebuild,
}

impl<K: Kernel<D, N>, const D: usize, const N: usize> Live<K, D, N> {
    /// Inserts points and returns their rows. On any error nothing has changed.
    pub fn insert(
        &mut self,
        input: &[[f64; D]],
        workers: usize,
        watch: &Watch,
    ) -> Result<Range<usize>> {
        points::scan(input)?;
        let found = self.mesh.sites.len() + input.len();
        if found > K::LIMIT {
            let limit = K::LIMIT;
            return Err(Error::TooMany { found, limit });
        }
        let first = self.rows.total();
        self.rows.reserve(input.len())?;
        if let Some(made) = K::insert_among(self, input, workers, watch)? {
            return Ok(made);
        }
        if let [p] = *input {
            return self.insert_one(p.map(|x| x + 0.0), watch);
        }
        if input.is_empty() {
            return Ok(first..first);
        }
        if self.is_incremental(input.len(), K::SHARES[0]) {
            let mut targets = filled(input.len(), NONE)?;
            let mut made = with_room(input.len())?;
            // Along the curve, the last simplex is near.
            self.mesh.prepare(input.len() > self.vertices() / DENSE);
            let done = self.insert_along(input, &mut targets, &mut made, watch);
            self.mesh.prepare(false);
            let done = match done {
                Ok(Outcome::Rebuild) => self.rebuild_with(input, workers, watch),
                Ok(Outcome::Done) => {
                    self.attach_all(&targets)?;
                    return Ok(first..first + input.len());
                }
                Err(error) => Err(error),
            };
            if done.is_err() {
                for &v in made.iter().rev() {
                    self.mesh.unlink(v, true, &mut Pace::new(&IDLE, LOT))?;
                    self.mesh.free_site(v);
                }
            }
            done?;
        } else {
            self.rebuild_with(input, workers, watch)?;
        }
        Ok(first..first + input.len())
    }

    /// Whether a batch is edited point by point.
    pub(super) fn is_incremental(&self, count: usize, share: usize) -> bool {
        !self.mesh.is_flat() && (count <= FEW || count <= self.vertices() / share)
    }

    /// Inserts one point.
    fn insert_one(&mut self, p: [f64; D], watch: &Watch) -> Result<Range<usize>> {
        let row = self.rows.total();
        if self.mesh.is_flat() && !self.insert_flat(p)? {
            self.rebuild_with(&[p], 1, watch)?;
        } else if !self.mesh.is_flat() {
            let target = match self.mesh.place(p, watch)? {
                Place::At(v) => v,
                Place::In(t) => self.create(p, t, &mut Pace::new(watch, LOT))?,
            };
            self.attach_all(&[target])?;
        }
        Ok(row..row + 1)
    }

    /// Inserts a vertex at `p`, which is in simplex or ghost `t`.
    pub(super) fn create(&mut self, p: [f64; D], t: u32, pace: &mut Pace) -> Result<u32> {
        let v = self.mesh.take_site(p)?;
        if let Err(error) = self.mesh.insert(v, t, pace) {
            self.mesh.free_site(v);
            return Err(error);
        }
        Ok(v)
    }

    /// Inserts a point where there is no simplex; `false` if there will be one.
    fn insert_flat(&mut self, p: [f64; D]) -> Result<bool> {
        if self.mesh.spans(&self.flat, p) {
            return Ok(false);
        }
        let mesh = &self.mesh;
        let order = |&v: &u32| lexicographic(mesh.at(v), p);
        let target = match self.flat.binary_search_by(order) {
            Ok(i) => self.flat[i],
            Err(i) => {
                make_room(&mut self.flat, 1)?;
                let v = self.mesh.take_site(p)?;
                self.flat.insert(i, v);
                self.mesh.counts.vertices += 1;
                v
            }
        };
        self.attach_all(&[target])?;
        Ok(true)
    }

    /// Inserts points along the curve: the vertex of each goes to `targets`, new ones to `made`.
    fn insert_along(
        &mut self,
        input: &[[f64; D]],
        targets: &mut [u32],
        made: &mut Vec<u32>,
        watch: &Watch,
    ) -> Result<Outcome> {
        self.mesh.sites.reserve(input.len())?;
        self.mesh.records.reserve(K::RECORDS * input.len())?;
        let mut pace = Pace::new(watch, LOT);
        let mut budget = self.budget(input.len());
        for part in order_of(input, 1, watch)? {
            // Gathered first: one by one, each insertion would wait for its point.
            let mut points = with_room(part.len())?;
            points.extend(part.iter().map(|&i| input[i as usize].map(|x| x + 0.0)));
            for (i, p) in part.into_iter().zip(points) {
                pace.spend(1)?;
                targets[i as usize] = match self.mesh.place(p, watch)? {
                    Place::At(v) => v,
                    Place::In(t) => {
                        let v = self.create(p, t, &mut pace)?;
                        made.push(v);
                        v
                    }
                };
                if self.is_exceeded(&mut budget) {
                    return Ok(Outcome::Rebuild);
                }
            }
        }
        Ok(Outcome::Done)
    }

    /// The work for a batch, and the work so far.
    fn budget(&self, count: usize) -> (usize, usize) {
        let share = BUDGET * (self.vertices() + count).ilog2() as usize;
        (share * (count / 8 + LOT), self.mesh.work)
    }

    /// Whether the budget, which grows with each point, is exceeded.
    fn is_exceeded(&self, (budget, before): &mut (usize, usize)) -> bool {
        *budget += BUDGET * self.vertices().max(2).ilog2() as usize;
        self.mesh.work - *before > *budget
    }

    /// Appends rows at these vertices; room is reserved.
    pub(super) fn attach_all(&mut self, targets: &[u32]) -> Result<()> {
        for &v in targets {
            self.room()?;
            let row = self.rows.push()?;
            self.attach(row, v);
        }
        Ok(())
    }

    pub(super) fn attach(&mut self, row: u32, v: u32) {
        let head = self.rows.attach(row, v, self.mesh.sites[v as usize].head);
        self.mesh.set_head(v, head);
    }

    pub(super) fn detach(&mut self, row: u32, v: u32) {
        let head = self.rows.detach(row, self.mesh.sites[v as usize].head);
        self.mesh.set_head(v, head);
    }

    /// Makes room for another step of an edit that may be taken back.
    pub(super) fn room(&mut self) -> Result<()> {
        self.mesh.records.room(0)?;
        self.mesh.sites.room(0)?;
        self.rows.room()?;
        self.segments.room()
    }

    /// Replaces the triangulation by that of its points and of these.
    fn rebuild_with(&mut self, more: &[[f64; D]], workers: usize, watch: &Watch) -> Result<()> {
        let total = self.rows.total();
        let mut rows = with_room(self.len() + more.len())?;
        let mut points = with_room(self.len() + more.len())?;
        for (row, v) in self.rows.iter() {
            rows.push(row);
            points.push(self.mesh.at(v));
        }
        rows.extend(total as u32..(total + more.len()) as u32);
        points.extend_from_slice(more);
        self.rebuild(&points, &rows, total + more.len(), workers, watch)
    }

    /// Replaces the triangulation by that of `points` at `rows`.
    fn rebuild(
        &mut self,
        points: &[[f64; D]],
        rows: &[u32],
        total: usize,
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let made = K::built(points, rows, total, workers, watch)?;
        (self.mesh, self.rows, self.flat) = made;
        Ok(())
    }

    /// The vertices of `rows`, each with its row, in the order of the vertices, which is that of
    /// the curve if most of them were built at once. A row that is not present, or is named twice,
    /// is an error.
    pub(super) fn by_vertex(&self, rows: &[i64], watch: &Watch) -> Result<Vec<(u32, u32)>> {
        let mut pairs = with_room(rows.len())?;
        for &row in rows {
            match self.rows.vertex(row) {
                Some(v) => pairs.push((v, row as u32)),
                None => return Err(Error::Shape(format!("row {row} is not there"))),
            }
        }
        sort(&mut pairs, watch)?;
        match pairs.windows(2).find(|w| w[0] == w[1]) {
            Some(w) => Err(Error::Shape(format!("row {} is named twice", w[0].1))),
            None => Ok(pairs),
        }
    }

    /// Removes rows, at which no segments end. On any error nothing has changed.
    pub fn remove(&mut self, rows: &[i64], workers: usize, watch: &Watch) -> Result<()> {
        let pairs = self.by_vertex(rows, watch)?;
        match K::remove_among(self, &pairs, workers, watch)? {
            Some(()) => Ok(()),
            None => self.remove_alone(&pairs, workers, watch),
        }
    }

    /// Removes rows where there are no segments, with their vertices.
    pub(super) fn remove_alone(
        &mut self,
        pairs: &[(u32, u32)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let mut lost = with_room(pairs.len())?;
        for group in pairs.chunk_by(|a, b| a.0 == b.0) {
            let v = group[0].0;
            if self
                .rows
                .has_rows(self.mesh.sites[v as usize].head, group.len())
            {
                lost.push(v);
            } else {
                self.mesh.rename(v)?;
            }
        }
        if lost.is_empty() || self.is_incremental(lost.len(), K::SHARES[1]) {
            let mut done = 0;
            let outcome = match self.unlink_all(&lost, &mut done, watch) {
                Ok(Outcome::Done) => {
                    for &(v, row) in pairs {
                        self.detach(row, v);
                    }
                    for &v in &lost {
                        self.mesh.free_site(v);
                    }
                    return Ok(());
                }
                Ok(Outcome::Rebuild) => self.rebuild_without(pairs, workers, watch),
                Err(error) => Err(error),
            };
            if outcome.is_err() {
                for &v in lost[..done].iter().rev() {
                    relink(&mut self.mesh, v)?;
                }
            }
            return outcome;
        }
        self.rebuild_without(pairs, workers, watch)
    }

    /// Removes vertices from the mesh, and counts those that have been removed.
    fn unlink_all(&mut self, lost: &[u32], done: &mut usize, watch: &Watch) -> Result<Outcome> {
        let mut pace = Pace::new(watch, LOT);
        for &v in lost {
            pace.spend(1)?;
            match self.mesh.unlink(v, false, &mut pace)? {
                Removed::Done => *done += 1,
                Removed::Flat | Removed::Hub => return Ok(Outcome::Rebuild),
            }
        }
        Ok(Outcome::Done)
    }

    /// Replaces the triangulation by that of its points without these rows.
    fn rebuild_without(
        &mut self,
        pairs: &[(u32, u32)],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let mut gone = with_room(pairs.len())?;
        gone.extend(pairs.iter().map(|pair| pair.1));
        sort(&mut gone, watch)?;
        let mut gone = gone.into_iter().peekable();
        let mut rows = with_room(self.len())?;
        let mut points = with_room(self.len())?;
        for (row, v) in self.rows.iter() {
            if gone.next_if_eq(&row).is_none() {
                rows.push(row);
                points.push(self.mesh.at(v));
            }
        }
        self.rebuild(&points, &rows, self.rows.total(), workers, watch)
    }

    /// Moves rows to new points. On any error nothing has changed.
    pub fn relocate(
        &mut self,
        rows: &[i64],
        input: &[[f64; D]],
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        points::scan(input)?;
        if rows.len() != input.len() {
            let (rows, points) = (rows.len(), input.len());
            let message = format!("{rows} rows cannot move to {points} points");
            return Err(Error::Shape(message));
        }
        let mut moves: Vec<Move<D>> = with_room(rows.len())?;
        if let ([row], [p]) = (rows, input) {
            let (v, row) = self.by_vertex(&[*row], watch)?[0];
            moves.push((v, row, p.map(|x| x + 0.0)));
        } else {
            let mut order: Vec<(i64, u32)> = with_room(rows.len())?;
            order.extend(rows.iter().copied().zip(0u32..));
            sort(&mut order, watch)?;
            for (v, row) in self.by_vertex(rows, watch)? {
                let i = order.partition_point(|&(other, _)| other < i64::from(row));
                let p = input[order[i].1 as usize];
                moves.push((v, row, p.map(|x| x + 0.0)));
            }
        }
        if K::relocate_among(self, &moves, workers, watch)?.is_some() {
            return Ok(());
        }
        let old = match self.is_incremental(moves.len(), K::SHARES[2]) {
            false => return self.rebuild_moved(moves, workers, watch),
            true => with_room(moves.len())?,
        };
        self.relocate_all(moves, old, workers, watch)
    }

    /// Moves rows one after another; `old` has room for their old points.
    fn relocate_all(
        &mut self,
        moves: Vec<Move<D>>,
        mut old: Vec<(u32, [f64; D])>,
        workers: usize,
        watch: &Watch,
    ) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        let mut budget = self.budget(moves.len());
        let mut outcome = Ok(Outcome::Done);
        for &(_, row, p) in &moves {
            let before = self.point(row);
            outcome = pace
                .spend(1)
                .and_then(|()| self.relocate_one(row, p, false, watch));
            if !matches!(outcome, Ok(Outcome::Done)) {
                break;
            }
            old.push((row, before));
            if self.is_exceeded(&mut budget) {
                outcome = Ok(Outcome::Rebuild);
                break;
            }
        }
        let done = match outcome {
            Ok(Outcome::Done) => return Ok(()),
            Ok(Outcome::Rebuild) => self.rebuild_moved(moves, workers, watch),
            Err(error) => Err(error),
        };
        if done.is_err() {
            // Each state on the way back has existed before: none is flat, and hubs must not stop
            // it.
            for &(row, p) in old.iter().rev() {
                self.relocate_one(row, p, true, &IDLE)?;
            }
        }
        done
    }

    /// The point of a present row.
    fn point(&self, row: u32) -> [f64; D] {
        let v = self.rows.vertex(i64::from(row)).unwrap_or_default();
        self.mesh.at(v)
    }

    /// Moves one row to `p`. If a rebuild is needed, or on an error, nothing has changed. Unless
    /// `always`, a rebuild takes the place of removing a vertex of very high degree.
    fn relocate_one(
        &mut self,
        row: u32,
        p: [f64; D],
        always: bool,
        watch: &Watch,
    ) -> Result<Outcome> {
        let v = self.rows.vertex(i64::from(row)).unwrap_or_default();
        let before = self.mesh.at(v);
        if before == p {
            return Ok(Outcome::Done);
        }
        if !self.rows.is_single(row) {
            self.mesh.rename(v)?;
            let target = match self.mesh.place(p, watch)? {
                Place::At(w) => {
                    self.mesh.rename(w)?;
                    w
                }
                Place::In(t) => self.create(p, t, &mut Pace::new(watch, LOT))?,
            };
            self.detach(row, v);
            self.attach(row, target);
            return Ok(Outcome::Done);
        }
        if self.mesh.shift(v, p)? {
            return Ok(Outcome::Done);
        }
        let mut pace = Pace::new(watch, LOT);
        if self.mesh.unlink(v, always, &mut pace)? != Removed::Done {
            return Ok(Outcome::Rebuild);
        }
        let placed = match self.mesh.place(p, watch) {
            Ok(Place::At(w)) => match self.mesh.rename(w) {
                Ok(()) => {
                    self.detach(row, v);
                    self.mesh.free_site(v);
                    self.attach(row, w);
                    return Ok(Outcome::Done);
                }
                Err(error) => Err(error),
            },
            Ok(Place::In(t)) => {
                self.mesh.sites.get_mut(v as usize).at = p;
                self.mesh.insert(v, t, &mut pace)
            }
            Err(error) => Err(error),
        };
        if let Err(error) = placed {
            self.mesh.sites.get_mut(v as usize).at = before;
            relink(&mut self.mesh, v)?;
            return Err(error);
        }
        Ok(Outcome::Done)
    }

    /// Replaces the triangulation by that of its points after these moves.
    fn rebuild_moved(&mut self, moves: Vec<Move<D>>, workers: usize, watch: &Watch) -> Result<()> {
        let mut moved = moves;
        let by_row = |a: &Move<D>, b: &Move<D>| a.1.cmp(&b.1);
        sort_by(&mut moved, watch, by_row)?;
        let mut moved = moved.into_iter().peekable();
        let mut rows = with_room(self.len())?;
        let mut points = with_room(self.len())?;
        for (row, v) in self.rows.iter() {
            push(&mut rows, row)?;
            let own = moved.next_if(|each| each.1 == row);
            points.push(own.map_or_else(|| self.mesh.at(v), |each| each.2));
        }
        self.rebuild(&points, &rows, self.rows.total(), workers, watch)
    }
}

/// Inserts a vertex again that was removed from the mesh, at the coordinates of its site.
fn relink<K: Kernel<D, N>, const D: usize, const N: usize>(mesh: &mut K, v: u32) -> Result<()> {
    match mesh.place(mesh.at(v), &IDLE)? {
        Place::In(t) => mesh.insert(v, t, &mut Pace::new(&IDLE, LOT)),
        Place::At(_) => Err(Error::Internal("a removed vertex is still there".into())),
    }
}
