//! Checks of arrays that callers give.

use crate::{Error, Result};

/// Rows that are checked at once.
const LOT: usize = 1 << 10;

/// An integer of 32 bits: as an unsigned one, a negative number is larger than any row.
pub trait Number {
    fn bits(&self) -> u32;
}

impl Number for i32 {
    fn bits(&self) -> u32 {
        *self as u32
    }
}

impl Number for u32 {
    fn bits(&self) -> u32 {
        *self
    }
}

/// Checks that every entry of `table` lies in `from..to`.
pub fn in_range<T: Number, const K: usize>(
    table: &[[T; K]],
    from: i32,
    to: usize,
    name: &str,
) -> Result<()> {
    let span = u32::try_from(to as i64 - i64::from(from)).unwrap_or(u32::MAX);
    let inside = |v: &T| v.bits().wrapping_sub(from as u32) < span;
    let wrong = |row: &[T; K]| !row.iter().all(inside);
    match first(table, |row| row.iter().fold(true, |all, v| all & inside(v))) {
        None => Ok(()),
        Some(lot) => {
            let row = lot + table[lot..].iter().position(wrong).unwrap_or(0);
            let text = format!("{name}: row {row} has an entry outside {from}..{to}");
            Err(Error::Shape(text))
        }
    }
}

/// The start of the first lot of rows that are not all `right`. Rows are read without branches, so
/// that a check takes little more than the time to load them.
fn first<T>(rows: &[T], right: impl Fn(&T) -> bool) -> Option<usize> {
    let whole = |lot: &[T]| lot.iter().fold(true, |all, row| all & right(row));
    let lots = rows.chunks(LOT);
    Some(LOT * lots.map(whole).position(|whole| !whole)?)
}

/// Checks that there are `count` entries.
pub fn has_length<T>(values: &[T], count: usize, name: &str) -> Result<()> {
    let found = values.len();
    if found == count {
        return Ok(());
    }
    let text = format!("{name} has {found} entries, not {count}");
    Err(Error::Shape(text))
}

/// Checks that `starts` ascends, within `count` entries.
pub fn ascends(starts: &[usize], count: usize) -> Result<()> {
    if starts.is_sorted() && starts.last().is_none_or(|end| *end <= count) {
        return Ok(());
    }
    let text = format!("starts must ascend, from 0 to at most {count}");
    Err(Error::Shape(text))
}

/// Refuses points that are not finite.
pub fn finite<const D: usize>(points: &[[f64; D]]) -> Result<()> {
    let good = |q: &[f64; D]| q.iter().fold(true, |all, x| all & x.is_finite());
    let Some(lot) = first(points, good) else {
        return Ok(());
    };
    let mut rows = (lot..points.len()).filter(|&row| !good(&points[row]));
    let few: Vec<usize> = rows.by_ref().take(10).collect();
    Err(Error::NonFinite {
        count: few.len() + rows.count(),
        rows: few,
    })
}
