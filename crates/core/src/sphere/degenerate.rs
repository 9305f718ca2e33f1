//! The result if directions span no triangle: a few of them, or their order on a great circle.

use std::cmp::Ordering;

use delone_predicates::sphere::{compare, same};
use delone_predicates::{Point3, Sign};

use super::arrange::Arranged;
use super::directions::turn;
use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::Watch;
use crate::order::sort_by;

/// The error of directions that all lie on one great circle, with the first rows of the distinct
/// ones in order around it, from the smallest one counterclockwise seen from the side of the larger
/// normal.
pub fn degenerate(arranged: &Arranged, watch: &Watch) -> Result<Error> {
    let directions = &arranged.directions;
    let mut found: Vec<(Point3, u32)> = with_room(arranged.rows.len())?;
    found
        .extend((0..directions.count()).map(|i| (directions.vector(i), arranged.rows[i as usize])));
    let smallest = found.iter().map(|x| x.0).min_by(|&a, &b| compare(a, b));
    let start = smallest.unwrap_or_default();
    watch.check()?;
    // Seen along an axis that is not on the plane, the circle is an ellipse around the origin.
    let across = found.iter().find_map(|&(v, _)| {
        [[1, 2], [2, 0], [0, 1]]
            .into_iter()
            .find(|&axes| !turn(start, v, axes).is_zero())
    });
    match across {
        Some(axes) => sort_by(&mut found, watch, |x, y| {
            let half = |v: Point3| match turn(start, v, axes) {
                Sign::Positive => 1,
                Sign::Negative => 3,
                Sign::Zero if same(start, v) => 0,
                Sign::Zero => 2,
            };
            let around = match turn(x.0, y.0, axes) {
                Sign::Positive => Ordering::Less,
                Sign::Negative => Ordering::Greater,
                Sign::Zero => Ordering::Equal,
            };
            half(x.0).cmp(&half(y.0)).then(around).then(x.1.cmp(&y.1))
        })?,
        None => sort_by(&mut found, watch, |x, y| {
            compare(x.0, y.0).then(x.1.cmp(&y.1))
        })?,
    }
    found.dedup_by(|next, first| same(next.0, first.0));
    Ok(Error::OneGreatCircle {
        chain: found.into_iter().map(|(_, row)| row).collect(),
    })
}
