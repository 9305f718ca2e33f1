//! The segments that need most of the added vertices, for the error when a limit is exceeded.

use delone_predicates::Point2;

use crate::base::error::Densest;

/// The most segments that are named.
const NAMED: usize = 5;

/// The segments that occur most often in `rows`, each with at least half as many entries as the
/// first. `ends` has the vertices of each segment, `at` their points; `last` is where the vertex
/// that exceeds the limit would be.
pub fn densest_segments(
    mut rows: Vec<u32>,
    ends: &[[u32; 2]],
    at: impl Fn(u32) -> Point2,
    last: Option<Point2>,
) -> Densest {
    rows.sort_unstable();
    let mut counts: Vec<(usize, u32)> = rows.chunk_by(u32::eq).map(|r| (r.len(), r[0])).collect();
    counts.sort_unstable_by(|s, t| t.0.cmp(&s.0).then(s.1.cmp(&t.1)));
    let most = counts.first().map_or(0, |first| first.0);
    let many = counts.iter().take_while(|c| 2 * c.0 >= most).take(NAMED);
    let segments: Vec<u32> = many.map(|c| c.1).collect();
    let shared = match segments[..] {
        [s, t, ..] => {
            let [s, t] = [s, t].map(|row| ends[row as usize]);
            s.into_iter().find(|v| t.contains(v))
        }
        _ => None,
    };
    Densest {
        segments,
        place: shared.map(at).or(last),
        corner: shared.is_some(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_segments_with_most_are_named_and_their_corner() {
        let ends = [[0, 1], [1, 2], [3, 4]];
        let at = |v: u32| [f64::from(v), 0.0];
        let found = densest_segments(vec![1, 0, 1, 1, 0, 2], &ends, at, Some([9.0, 9.0]));
        assert_eq!(found.segments, [1, 0]);
        assert_eq!((found.place, found.corner), (Some([1.0, 0.0]), true));
        let found = densest_segments(vec![2, 2, 2, 0], &ends, at, Some([9.0, 9.0]));
        assert_eq!(found.segments, [2]);
        assert_eq!((found.place, found.corner), (Some([9.0, 9.0]), false));
        assert_eq!(
            densest_segments(vec![], &ends, at, None),
            Densest::default()
        );
    }
}
