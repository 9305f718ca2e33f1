//! The areas that a polygon shares with cells between meridians and parallels.
//!
//! Each side is followed from cell to cell. The columns of its ends tell which meridians it
//! crosses; the row in which it crosses one follows from the corners of that meridian, on either
//! side of its circle. Between two meridians the latitude of a side rises or falls, or has one
//! extremum, whose column and row follow from signs, too. So a side is tested at its own rows and
//! columns only, and no two crossings are ever compared.
//!
//! A corner of the grid is in the polygon if sides cross its meridian an odd number of times
//! between it and the pole that is outside. Seen from a pole the area form along a meridian is zero, so
//! that the area in a cell is a sum over pieces of sides and of parallels. Each piece of a side, from
//! one event to the next, is in one cell, and each place where a side crosses is computed once.

use delone_predicates::Point3;
use delone_predicates::arithmetic::Pair;

use crate::base::error::{Error, Result};
use crate::base::watch::Pace;

use super::bands::{Block, angle};
use super::cell::Cell;
use super::pairs::{
    ONE, Pair3, Turn, dot, factor, leveled, negated, pair, quotient, raised, root, sliver, spot_of,
};
use super::signs::{Side, above, corner, east, eastward, falling, reaches, rise};

/// Something that a side does.
#[derive(Clone, Copy)]
enum Event {
    /// It ends in a cell.
    End { row: usize, column: usize },
    /// It crosses a meridian.
    Meridian {
        m: usize,
        row: usize,
        eastward: bool,
    },
    /// It crosses a parallel.
    Parallel { l: usize, column: usize, up: bool },
}

/// Where a part of a parallel begins or ends.
struct Place {
    l: usize,
    ends: bool,
    /// From a direction in the column, where the order matters.
    angle: f64,
    x: Pair3,
}

/// A vector and its length.
type Long = (Pair3, Pair);

/// Buffers.
#[derive(Default)]
pub struct Work {
    /// The row and the column of each corner.
    at: Vec<(i64, usize)>,
    events: Vec<(u32, Event)>,
    /// The positions of the events.
    spots: Vec<Long>,
    /// Meridians and rows where sides cross them.
    crossings: Vec<(u32, i64)>,
    /// Rows of cells that sides touch, by cell, and the events there.
    touched: Vec<(u64, u32)>,
    places: Vec<Place>,
}

/// Latitudes between which a polygon is, rounded outward.
pub fn latitudes(p: &Cell) -> [f64; 2] {
    let middle = p.center[2].clamp(-1.0, 1.0).asin();
    let reach = 2.0 * (p.radius / 2.0).min(1.0).asin() + 1e-9;
    [middle - reach, middle + reach]
}

/// Calls `give` with cells and areas that a polygon shares with them, for some cells more than
/// once.
pub fn shared(
    p: &Cell,
    block: &Block,
    work: &mut Work,
    pace: &mut Pace,
    give: &mut impl FnMut(i32, f64) -> Result<()>,
) -> Result<()> {
    work.at.clear();
    work.events.clear();
    work.crossings.clear();
    for c in &p.corners {
        let row = block.row_of(c.v);
        let column = block.column_of([c.v[0], c.v[1]], |m| east(m, c.v))?;
        work.at.push((row, column));
    }
    for k in 0..p.corners.len() {
        let before = work.events.len();
        follow(p, k, block, work)?;
        pace.spend(work.events.len() - before + 1)?;
    }
    let at = std::mem::take(&mut work.at);
    let walked = Walked {
        p,
        block,
        north: p.center[2] >= 0.0,
        at: &at,
    };
    let done = walked.give(work, pace, give);
    work.at = at;
    done
}

/// Follows a side.
fn follow(p: &Cell, k: usize, block: &Block, work: &mut Work) -> Result<()> {
    let (e, next) = (p.side(k), p.corners[k].next as usize);
    let ((mut row, mut column), (last_row, last)) = (work.at[k], work.at[next]);
    let count = block.columns();
    let east = eastward(e);
    let steps = if east {
        (last + count - column) % count
    } else {
        (column + count - last) % count
    };
    // 1 if there is a northernmost place on the side, -1 if there is a southernmost one.
    let mut extremum = match (rise(e, false), rise(e, true)) {
        (1, -1) => 1,
        (-1, 1) => -1,
        _ => 0,
    };
    let (side, events) = (k as u32, &mut work.events);
    for _ in 0..steps {
        let m = if east { block.after(column) } else { column };
        // Whether the extremum is before this meridian.
        let here = extremum != 0 && falling(block.lon[m], e) == extremum;
        let crossed = row_at(block, m, e, east, row);
        in_column(
            block,
            (side, e),
            column,
            [row, crossed],
            if here { extremum } else { 0 },
            events,
        );
        if here {
            extremum = 0;
        }
        if (0..block.rows() as i64).contains(&crossed) {
            let event = Event::Meridian {
                m,
                row: crossed as usize,
                eastward: east,
            };
            events.push((side, event));
        }
        work.crossings.push((m as u32, crossed));
        row = crossed;
        column = if east { m } else { block.before(m) };
    }
    if column != last {
        return Err(Error::Internal("a side ends in another column".into()));
    }
    in_column(block, (side, e), column, [row, last_row], extremum, events);
    if (0..block.rows() as i64).contains(&last_row) {
        events.push((
            side,
            Event::End {
                row: last_row as usize,
                column,
            },
        ));
    }
    Ok(())
}

/// The row in which a side crosses a meridian.
fn row_at(block: &Block, m: usize, e: Side, east: bool, near: i64) -> i64 {
    // Whether the corner on a parallel is north of the side.
    let north = |l: i64| {
        let t = block.tan[l as usize];
        if t.is_infinite() {
            return t > 0.0;
        }
        (corner(block.lon[m], block.len[m], t, e) > 0) == east
    };
    let mut row = near;
    while row >= 0 && north(row) {
        row -= 1;
    }
    while row + 1 < block.tan.len() as i64 && !north(row + 1) {
        row += 1;
    }
    row
}

/// The parallels that a side crosses between two places of one column.
fn in_column(
    block: &Block,
    (side, e): (u32, Side),
    column: usize,
    [from, to]: [i64; 2],
    extremum: i32,
    events: &mut Vec<(u32, Event)>,
) {
    let tan = &block.tan;
    // The northernmost place is north of parallels up to the equator, the southernmost one south of
    // the others.
    let beyond = |l: i64| {
        let t = tan[l as usize] * f64::from(extremum);
        t <= 0.0 || (t.is_finite() && reaches(t, e))
    };
    let mut turn = match extremum {
        1 => from.max(to),
        -1 => from.min(to),
        _ => to,
    };
    if extremum == 1 {
        while turn + 1 < tan.len() as i64 && beyond(turn + 1) {
            turn += 1;
        }
    } else if extremum == -1 {
        while turn >= 0 && beyond(turn) {
            turn -= 1;
        }
    }
    for [a, b] in [[from, turn], [turn, to]] {
        let mut cross = |l: i64, up: bool| {
            events.push((
                side,
                Event::Parallel {
                    l: l as usize,
                    column,
                    up,
                },
            ));
        };
        for l in a + 1..=b {
            cross(l, true);
        }
        for l in (b + 1..=a).rev() {
            cross(l, false);
        }
    }
}

struct Walked<'a> {
    p: &'a Cell,
    block: &'a Block,
    /// Whether the south pole is outside the polygon; else the north pole is.
    north: bool,
    /// The row and the column of each corner.
    at: &'a [(i64, usize)],
}

impl Walked<'_> {
    fn give(
        &self,
        work: &mut Work,
        pace: &mut Pace,
        give: &mut impl FnMut(i32, f64) -> Result<()>,
    ) -> Result<()> {
        let (block, p) = (self.block, self.p);
        work.crossings.sort_unstable();
        work.touched.clear();
        let count = block.columns() as u64;
        for (k, (_, event)) in work.events.iter().enumerate() {
            let [before, after] = self.cells(event);
            // The piece that follows a meridian is found from the event at its end.
            let after = after.filter(|_| matches!(event, Event::Parallel { .. }));
            for (row, column) in before.into_iter().chain(after) {
                if block.number(row, column) >= 0 {
                    work.touched
                        .push((row as u64 * count + column as u64, k as u32));
                }
            }
        }
        work.touched.sort_unstable();
        let uncrossed = |e: &(u32, Event)| matches!(e.1, Event::End { .. });
        if work.crossings.is_empty() && work.events.iter().all(uncrossed) {
            if let Some((_, Event::End { row, column })) = work.events.first() {
                let number = block.number(*row, *column);
                if number >= 0 {
                    give(number, p.area)?;
                }
            }
            return Ok(());
        }
        work.spots.clear();
        work.spots
            .extend(work.events.iter().map(|(k, event)| self.spot(*k, event)));
        pace.spend(work.events.len())?;
        for run in work.touched.chunk_by(|a, b| a.0 == b.0) {
            pace.spend(run.len())?;
            let (row, column) = ((run[0].0 / count) as usize, (run[0].0 % count) as usize);
            let events = (&work.events[..], &work.spots[..]);
            let area = self.sum(
                (row, column),
                run,
                events,
                &work.crossings,
                &mut work.places,
            );
            give(block.number(row, column), area)?;
        }
        self.covered(work, pace, give)
    }

    /// The cells before and after an event.
    fn cells(&self, event: &Event) -> [Option<(usize, usize)>; 2] {
        match *event {
            Event::End { row, column } => [Some((row, column)), None],
            Event::Meridian { m, row, eastward } => {
                let (west, east) = ((row, self.block.before(m)), (row, m));
                if eastward {
                    [Some(west), Some(east)]
                } else {
                    [Some(east), Some(west)]
                }
            }
            Event::Parallel { l, column, up } => {
                let south = l.checked_sub(1).map(|row| (row, column));
                let north = (l < self.block.rows()).then_some((l, column));
                if up { [south, north] } else { [north, south] }
            }
        }
    }

    /// Where an event is.
    fn spot(&self, k: u32, event: &Event) -> Long {
        match *event {
            Event::End { .. } => {
                let end = self.p.corners[k as usize].next as usize;
                (self.p.corners[end].unit, ONE)
            }
            Event::Meridian { m, row, eastward } => self.at_meridian(m, row, k as usize, eastward),
            Event::Parallel { l, column, up } => (self.at_parallel(l, column, k as usize, up), ONE),
        }
    }

    /// Whether the corner of a meridian and a parallel is in the polygon.
    fn holds(&self, m: usize, l: usize, crossings: &[(u32, i64)]) -> bool {
        let m = m as u32;
        let at = crossings.partition_point(|&x| x < (m, l as i64));
        let between = if self.north {
            at - crossings.partition_point(|x| x.0 < m)
        } else {
            crossings.partition_point(|x| x.0 <= m) - at
        };
        between % 2 == 1
    }

    /// The area in a cell that sides touch.
    fn sum(
        &self,
        (row, column): (usize, usize),
        run: &[(u64, u32)],
        (events, spots): (&[(u32, Event)], &[Long]),
        crossings: &[(u32, i64)],
        places: &mut Vec<Place>,
    ) -> f64 {
        let block = self.block;
        let axis = block.axis(row);
        places.clear();
        let mut turn = Turn::new();
        let mut place = |l: usize, ends: bool, x: Pair3| {
            let angle = 0.0;
            places.push(Place { l, ends, angle, x });
        };
        for &(_, k) in run {
            let k = k as usize;
            let (side, event) = &events[k];
            let (to, length) = &spots[k];
            let enters = match *event {
                Event::Parallel { l, up, .. } => {
                    let enters = (l == row) == up;
                    place(l, enters, *to);
                    enters
                }
                _ => false,
            };
            if !enters {
                // From the event before, or from the start of the side.
                let start = (self.p.corners[*side as usize].unit, ONE);
                let before = k.checked_sub(1).filter(|&j| events[j].0 == *side);
                let (from, above) = before.map_or(&start, |j| &spots[j]);
                let piece = factor(&spot_of(axis, from, *above), &spot_of(axis, to, *length));
                turn.mul(piece, false);
            }
        }
        // Corners inside: a part of the southern side begins in the west and ends in the east, and
        // one of the northern side the other way round.
        for (m, l, ends) in [
            (column, row, false),
            (block.after(column), row, true),
            (block.after(column), row + 1, false),
            (column, row + 1, true),
        ] {
            if block.tan[l].is_finite() && self.holds(m, l, crossings) {
                place(l, ends, block.corner(m, l));
            }
        }
        self.along(&mut turn, places, axis, column);
        turn.area()
    }

    /// Adds the parts of parallels. As many begin as end; each is summed by itself, so that short
    /// ones have small errors. Any assignment of ends to beginnings gives the same sum.
    fn along(&self, turn: &mut Turn, places: &mut [Place], axis: usize, column: usize) {
        places.sort_by_key(|p| (p.l, p.ends));
        let same = |p: &[Place]| (p[0].l, p[0].ends) == (p[1].l, p[1].ends);
        if places.windows(2).any(same) {
            let start = self.reference(column);
            for p in places.iter_mut() {
                p.angle = angle(&start, &[p.x[0], p.x[1]]);
            }
            places.sort_by(|p, q| {
                let order = (p.l, p.ends).cmp(&(q.l, q.ends));
                order.then(p.angle.total_cmp(&q.angle))
            });
        }
        for part in places.chunk_by(|p, q| p.l == q.l) {
            let half = part.len() / 2;
            debug_assert_eq!(part.iter().filter(|x| x.ends).count(), part.len() - half);
            for (p, q) in part[..half].iter().zip(&part[half..]) {
                let [from, to] = [p, q].map(|place| spot_of(axis, &place.x, ONE));
                turn.mul(factor(&from, &to), false);
                let w = angle(&[p.x[0], p.x[1]], &[q.x[0], q.x[1]]);
                let [k, s] = self.block.lat[p.l].map(|x| x.hi);
                // Seen from the south pole sines change sign, and so do longitudes.
                turn.extra += if axis == 1 {
                    sliver(-s, k * k, -w)
                } else {
                    sliver(s, k * k, w)
                };
            }
        }
    }

    /// The direction in a column from which angles are measured: that of the polygon, or the nearer
    /// meridian.
    fn reference(&self, column: usize) -> [Pair; 2] {
        let (a, b) = (
            self.block.dir[column],
            self.block.dir[self.block.after(column)],
        );
        let [x, y, _] = self.p.center;
        let cross = |p: [Pair; 2]| p[0].hi * y - p[1].hi * x;
        let toward = |p: [Pair; 2]| p[0].hi * x + p[1].hi * y;
        if cross(a) > 0.0 && cross(b) < 0.0 {
            let inverse = quotient(ONE, root(Pair::product(x, x) + Pair::product(y, y)));
            return [pair(x) * inverse, pair(y) * inverse];
        }
        if toward(a) > toward(b) { a } else { b }
    }

    /// Where a side crosses a meridian.
    ///
    /// An error of the normal moves the place along the meridian. Where the side is on it but for
    /// roundings, any place of both in that row serves.
    fn at_meridian(&self, m: usize, row: usize, k: usize, eastward: bool) -> Long {
        let (block, corner) = (self.block, &self.p.corners[k]);
        let (n, [c, s]) = (&corner.n, block.dir[m]);
        let x = [c * n[2], s * n[2], negated(n[0] * c + n[1] * s)];
        let top = |v: &Pair3| v.iter().fold(0.0, |top: f64, x| top.max(x.hi.abs()));
        if top(&x) > 1e-24 * top(n) {
            let x = leveled(&x);
            let length = root(dot(&x, &x));
            return (if eastward { x } else { x.map(negated) }, length);
        }
        let here = |v: &Point3| {
            let below = above(block.tan[row], *v) && !above(block.tan[row + 1], *v);
            below && v[0] * c.hi + v[1] * s.hi >= 0.0
        };
        let end = &self.p.corners[corner.next as usize];
        let x = if here(&corner.v) {
            corner.unit
        } else if here(&end.v) {
            end.unit
        } else {
            block.corner(m, row)
        };
        (x, ONE)
    }

    /// Where the circle of a side crosses a parallel, going up or down.
    ///
    /// A side on the equator but for roundings crosses it somewhere: any place of both in that
    /// column serves.
    fn at_parallel(&self, l: usize, column: usize, k: usize, up: bool) -> Pair3 {
        let (corner, t) = (&self.p.corners[k], pair(self.block.tan[l]));
        let n = &raised(&corner.n);
        let m = n[0] * n[0] + n[1] * n[1];
        if m.hi <= 1e-48 * n[2].hi * n[2].hi {
            let next = corner.next as usize;
            return if self.at[k].1 == column {
                corner.unit
            } else if self.at[next].1 == column {
                self.p.corners[next].unit
            } else {
                self.block.corner(column, l)
            };
        }
        let u = negated(n[2] * t);
        let v = root(m - u * u);
        let v = if up { v } else { negated(v) };
        let [x, z] = self.block.lat[l];
        let scale = quotient(x, m);
        [
            (u * n[0] - v * n[1]) * scale,
            (u * n[1] + v * n[0]) * scale,
            z,
        ]
    }

    /// Cells that are inside the polygon and that no side touches: between crossings of the
    /// meridian to their west.
    fn covered(
        &self,
        work: &Work,
        pace: &mut Pace,
        give: &mut impl FnMut(i32, f64) -> Result<()>,
    ) -> Result<()> {
        let (block, rows) = (self.block, self.block.rows() as i64);
        let count = block.columns() as u64;
        for own in work.crossings.chunk_by(|a, b| a.0 == b.0) {
            let column = own[0].0 as usize;
            // From the pole that is outside.
            let from = if self.north {
                own[0].1 + 1
            } else {
                own[own.len() - 1].1 - 1
            };
            let (step, mut row) = (if self.north { 1 } else { -1 }, from);
            while if self.north { row < rows } else { row >= 0 } {
                pace.spend(1)?;
                // Crossings between that pole and this row.
                let passed = if self.north {
                    own.partition_point(|x| x.1 < row)
                } else {
                    own.len() - own.partition_point(|x| x.1 <= row)
                };
                if passed == own.len() && passed % 2 == 0 {
                    break;
                }
                if passed % 2 == 1 && (0..rows).contains(&row) {
                    let key = row as u64 * count + column as u64;
                    let number = block.number(row as usize, column);
                    let touched = work.touched.binary_search_by(|x| x.0.cmp(&key)).is_ok();
                    if number >= 0 && !touched {
                        give(number, block.area(row as usize, column))?;
                    }
                }
                row += step;
            }
        }
        Ok(())
    }
}
