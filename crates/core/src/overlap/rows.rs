//! The areas that cells between meridians and parallels share with each other: widths times
//! differences of sines, where all comparisons are exact.

use delone_predicates::{Point2, Sign};

use crate::base::error::{Error, Result};

use super::bands::{Block, angle, turn2};

/// Columns of two blocks that overlap, and the width of what they share.
pub fn columns(p: &Block, q: &Block) -> Result<Vec<(usize, usize, f64)>> {
    let mut found = Vec::new();
    // The meridian itself counts as east of it.
    let beyond = |v: Point2| move |m: Point2| turn2(m, v) == Sign::Positive || same(m, v);
    for c in 0..p.columns() {
        let (mut west, mut at) = (p.dir[c], q.column_of(p.lon[c], beyond(p.lon[c]))?);
        let end = p.after(c);
        loop {
            let next = q.after(at);
            // Both ends are within a narrow column, so that the sign of the angle is their order.
            let order = turn2(q.lon[next], p.lon[end]);
            let east = if order == Sign::Positive {
                q.dir[next]
            } else {
                p.dir[end]
            };
            found.push((c, at, angle(&west, &east)));
            if order != Sign::Positive {
                break;
            }
            (west, at) = (east, next);
            if found.len() > 4 * (p.columns() + q.columns()) {
                return Err(Error::Internal("columns do not end".into()));
            }
        }
    }
    Ok(found)
}

/// Whether two directions are the same.
fn same(a: Point2, b: Point2) -> bool {
    turn2(a, b) == Sign::Zero && a[0] * b[0] + a[1] * b[1] > 0.0
}

/// Rows of two blocks that overlap, and the difference of the sines of what they share.
pub fn rows(p: &Block, q: &Block) -> Vec<(usize, usize, f64)> {
    let (mut found, mut i, mut j) = (Vec::new(), 0, 0);
    while i < p.rows() && j < q.rows() {
        let (p_low, q_low) = (p.tan[i], q.tan[j]);
        let (p_high, q_high) = (p.tan[i + 1], q.tan[j + 1]);
        let low = if p_low > q_low { p.lat[i] } else { q.lat[j] };
        let high = if p_high < q_high {
            p.lat[i + 1]
        } else {
            q.lat[j + 1]
        };
        if p_low.max(q_low) < p_high.min(q_high) {
            found.push((i, j, (high[1] - low[1]).hi));
        }
        if p_high <= q_high {
            i += 1;
        }
        if q_high <= p_high {
            j += 1;
        }
    }
    found
}
