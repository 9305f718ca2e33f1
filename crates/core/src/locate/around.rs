//! The first of the simplices around a facet or a face of lower dimension, in 3-D and higher.

use std::collections::HashSet;

use super::star::{First, Place};
use crate::base::arrays::{Given, Side};

/// The same point in the simplex across a facet on which it is.
fn across<const D: usize, const N: usize>(
    given: &Given<D, N>,
    place: Place<N>,
    corner: usize,
) -> Option<Place<N>> {
    let simplex = place.simplex;
    let there = given.beyond(Side { simplex, corner })?;
    let (old, new) = (&given.simplices[simplex], &given.simplices[there.simplex]);
    // Common facets keep their signs; the point is also on the facet opposite the new corner.
    let on = |k: usize| {
        let same = old.iter().position(|&v| v == new[k]);
        same.is_none_or(|j| place.on[j])
    };
    Some(Place {
        simplex: there.simplex,
        on: std::array::from_fn(|k| k == there.corner || on(k)),
    })
}

/// The first of the simplices that can be reached from `place`, on whose facets the point is; it is
/// open if one of these is on the boundary. Terminates because each is visited once.
#[inline(never)]
pub fn first_around<const D: usize, const N: usize>(
    given: &Given<D, N>,
    place: Place<N>,
) -> First<N> {
    let mut first = First { place, open: false };
    let mut met = Met::default();
    met.is_new(place.simplex);
    let mut left = vec![place];
    while let Some(at) = left.pop() {
        if at.simplex < first.place.simplex {
            first.place = at;
        }
        for corner in (0..N).filter(|&k| at.on[k]) {
            match across(given, at, corner) {
                None => first.open = true,
                Some(next) if met.is_new(next.simplex) => left.push(next),
                Some(_) => {}
            }
        }
    }
    first
}

/// A set of visited numbers: a list while there are few.
#[derive(Default)]
struct Met {
    few: Vec<usize>,
    many: HashSet<usize>,
}

impl Met {
    /// In 3-D a vertex of uniform points has 27 tetrahedra on average.
    const FEW: usize = 48;

    fn is_new(&mut self, number: usize) -> bool {
        if self.many.is_empty() {
            if self.few.contains(&number) {
                return false;
            }
            if self.few.len() < Self::FEW {
                self.few.push(number);
                return true;
            }
            self.many.extend(self.few.drain(..));
        }
        self.many.insert(number)
    }
}
