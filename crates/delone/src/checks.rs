//! Checks of arrays that callers give.

use crate::{Error, Result};

/// Checks that every entry of `table` lies in `from..to`.
pub fn in_range<T: Copy + TryInto<i64>, const K: usize>(
    table: &[[T; K]],
    from: i64,
    to: usize,
    name: &str,
) -> Result<()> {
    let inside = |v: &T| (*v).try_into().is_ok_and(|v| v >= from && v < to as i64);
    let wrong = |row: &[T; K]| !row.iter().all(inside);
    match table.iter().position(wrong) {
        None => Ok(()),
        Some(row) => Err(Error::Shape(format!(
            "{name}: row {row} has an entry outside {from}..{to}"
        ))),
    }
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
    let bad = |q: &[f64; D]| q.iter().any(|x| !x.is_finite());
    let mut rows = (0..points.len()).filter(|&row| bad(&points[row]));
    let few: Vec<usize> = rows.by_ref().take(10).collect();
    if few.is_empty() {
        return Ok(());
    }
    Err(Error::NonFinite {
        count: few.len() + rows.count(),
        rows: few,
    })
}
