//! Snapshots of a live triangulation, and what has changed since the last look.

use delone_predicates::lexicographic;

use super::Plane;
use super::mesh::{Counts, FREE, INFINITE, Record, Site};
use super::segments::SegmentsImage;
use crate::base::error::Result;
use crate::base::memory::{filled, push, with_room};
use crate::base::watch::{Pace, Watch};
use crate::live::chunks::Image;
use crate::live::rows::{NONE, RowsImage};
use crate::order::{sort, sort_by};

/// Records between two checks for interruption.
const LOT: usize = 1 << 16;

/// A snapshot. It never changes, and shares memory with others and with the triangulation.
#[derive(Debug, Clone)]
pub struct State {
    records: Image<Record>,
    sites: Image<Site>,
    rows: RowsImage,
    segments: SegmentsImage,
    counts: Counts,
}

/// Triangles, as rows, that were removed and added. Each begins with its smallest row; lists are ascending.
#[derive(Debug, Default)]
pub struct Changes {
    /// Triangles that are not there anymore.
    pub gone: Vec<[i64; 3]>,
    /// Triangles that were not there.
    pub new: Vec<[i64; 3]>,
}

impl State {
    /// Bytes that are not shared with `other`.
    pub fn own_bytes(&self, other: &Self) -> usize {
        self.records.own_bytes(&other.records)
            + self.sites.own_bytes(&other.sites)
            + self.rows.own_bytes(&other.rows)
            + self.segments.own_bytes(&other.segments)
    }
}

impl Plane {
    /// The present state: the cost is that of what has changed since the last snapshot.
    pub fn state(&mut self, watch: &Watch) -> Result<State> {
        Ok(State {
            records: self.mesh.records.image(watch)?,
            sites: self.mesh.sites.image(watch)?,
            rows: self.rows.image(watch)?,
            segments: self.segments.image(watch)?,
            counts: self.mesh.counts,
        })
    }

    /// Restores a state, of this triangulation or of any other. Rows and segments that were inserted
    /// since are gone, and their numbers are not used again.
    pub fn restore(&mut self, state: &State, watch: &Watch) -> Result<()> {
        let (total, segments) = (self.rows.total(), self.segments.total());
        let mut line = Vec::new();
        if state.counts.ghosts == 0 {
            let sites = state.sites.to_vec()?;
            line = with_room(sites.len())?;
            let used = |v: &u32| sites[*v as usize].at[0].is_finite();
            line.extend((1..sites.len() as u32).filter(used));
            let mut free = state.counts.site;
            let mut gone = with_room(sites.len())?;
            while free != NONE {
                gone.push(free);
                free = sites[free as usize].head;
            }
            gone.sort_unstable();
            line.retain(|v| gone.binary_search(v).is_err());
            let at = |v: u32| sites[v as usize].at;
            sort_by(&mut line, watch, |&u, &v| lexicographic(at(u), at(v)))?;
        }
        self.segments.make_room(&state.segments, segments)?;
        self.mesh.records.make_room(&state.records)?;
        self.mesh.sites.make_room(&state.sites)?;
        self.rows.make_room(&state.rows)?;
        self.rows.reserve(total.saturating_sub(self.rows.total()))?;
        self.mesh.records.restore(&state.records)?;
        self.mesh.sites.restore(&state.sites)?;
        self.rows.restore(&state.rows)?;
        for _ in self.rows.total()..total {
            self.rows.push()?;
        }
        self.segments.restore(&state.segments, segments)?;
        self.mesh.has_segments = self.segments.live() > 0;
        self.mesh.counts = state.counts;
        self.line = line;
        self.mesh.jump = None;
        let near = self.mesh.sites[INFINITE as usize].near;
        self.mesh.last = if near == NONE { 0 } else { near >> 3 };
        Ok(())
    }

    /// The triangles that were removed and added since the last call; in the first call all are new.
    pub fn changes(&mut self, watch: &Watch) -> Result<Changes> {
        let state = self.state(watch)?;
        let found = match &self.seen {
            Some(seen) => self.since(seen, watch)?,
            None => Changes {
                gone: Vec::new(),
                new: self.named(watch)?,
            },
        };
        self.seen = Some(state);
        Ok(found)
    }

    /// All triangles as rows.
    fn named(&self, watch: &Watch) -> Result<Vec<[i64; 3]>> {
        let mut all = with_room(self.triangles())?;
        let mut pace = Pace::new(watch, LOT);
        for &record in self.mesh.records.items() {
            pace.spend(1)?;
            all.extend(named(record, |v| self.mesh.sites[v as usize].head));
        }
        sort(&mut all, watch)?;
        Ok(all)
    }

    /// One bit for each site: whether its row is not that of a state.
    fn renamed(&self, seen: &State, watch: &Watch) -> Result<Vec<u64>> {
        let sites = self.mesh.sites.items();
        let mut renamed = filled(sites.len() / 64 + 1, 0u64)?;
        let mut pace = Pace::new(watch, LOT);
        for i in self.mesh.sites.changed(&seen.sites).flatten() {
            pace.spend(1)?;
            let before = seen.sites.get(i).map(|site| site.head);
            if sites.get(i).is_some_and(|site| Some(site.head) != before) {
                renamed[i / 64] |= 1 << (i % 64);
            }
        }
        Ok(renamed)
    }

    /// What has changed since a state.
    fn since(&self, seen: &State, watch: &Watch) -> Result<Changes> {
        let (mut old, mut new) = (Vec::new(), Vec::new());
        let mut pace = Pace::new(watch, LOT);
        let renamed = self.renamed(seen, watch)?;
        let is_renamed = |v: &u32| renamed[*v as usize / 64] >> (v % 64) & 1 == 1;
        for i in self.mesh.records.changed(&seen.records).flatten() {
            pace.spend(1)?;
            let before = seen.records.get(i);
            let now = self.mesh.records.items().get(i).copied();
            // Most records of a chunk have not changed, and names need corners far away.
            if before == now && now.is_none_or(|r| r[3] == FREE || !r[..3].iter().any(is_renamed)) {
                continue;
            }
            let head = |v: u32| seen.sites.get(v as usize).map_or(NONE, |site| site.head);
            if let Some(t) = before.and_then(|record| named(record, head)) {
                push(&mut old, t)?;
            }
            if let Some(t) = now.and_then(|r| named(r, |v| self.mesh.sites[v as usize].head)) {
                push(&mut new, t)?;
            }
        }
        sort(&mut old, watch)?;
        sort(&mut new, watch)?;
        Ok(Changes {
            gone: without(&old, &new)?,
            new: without(&new, &old)?,
        })
    }
}

/// A triangle by the rows of its vertices, the smallest first; `None` for ghosts and free records.
fn named(record: Record, head: impl Fn(u32) -> u32) -> Option<[i64; 3]> {
    let [a, b, c, mark, ..] = record;
    if mark == FREE || [a, b, c].contains(&INFINITE) {
        return None;
    }
    let mut rows = [a, b, c].map(|v| i64::from(head(v)));
    while rows[0] > rows[1] || rows[0] > rows[2] {
        rows.rotate_left(1);
    }
    Some(rows)
}

/// The items of one sorted list that are not in another one.
fn without(list: &[[i64; 3]], other: &[[i64; 3]]) -> Result<Vec<[i64; 3]>> {
    let mut left = Vec::new();
    let mut at = 0;
    for item in list {
        while other.get(at).is_some_and(|o| o < item) {
            at += 1;
        }
        if other.get(at) != Some(item) {
            push(&mut left, *item)?;
        }
    }
    Ok(left)
}
