//! The first of the tetrahedra that contain a point.
//!
//! A query on a face, an edge or a vertex is in several tetrahedra. The one with the smallest
//! number is the answer, so it is independent of where a walk came from, and thus of the other
//! queries and the threads.

use std::collections::HashSet;

use delone_predicates::Sign;

use super::tiling::{Side, Tetrahedra};

/// A point in a closed tetrahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// The tetrahedron, the first one that contains the point.
    pub simplex: usize,
    /// Whether the point is on the face opposite each corner.
    pub on: [bool; 4],
}

impl Place {
    /// The place given by signs, none of which is negative.
    pub fn of(simplex: usize, signs: [Sign; 4]) -> Self {
        Self {
            simplex,
            on: signs.map(|s| s == Sign::Zero),
        }
    }

    /// The corner at which the point is.
    #[inline]
    pub fn site(&self) -> Option<usize> {
        let off = self.on.iter().filter(|&&on| !on).count();
        (off == 1).then(|| self.on.iter().position(|&on| !on))?
    }

    /// The same point in the tetrahedron across a face on which it is.
    fn across(&self, given: &Tetrahedra, corner: usize) -> Option<Self> {
        let here = Side {
            simplex: self.simplex,
            corner,
        };
        let there = given.beyond(here)?;
        let (old, new) = (
            &given.simplices[here.simplex],
            &given.simplices[there.simplex],
        );
        // Common faces keep their signs; the point is also on the face opposite the new corner.
        let on = |k: usize| {
            let same = old.iter().position(|&v| v == new[k]);
            same.is_none_or(|j| self.on[j])
        };
        let on = std::array::from_fn(|k| k == there.corner || on(k));
        Some(Self {
            simplex: there.simplex,
            on,
        })
    }
}

/// The answer for the last vertex: equal queries are consecutive along the curve, and a vertex may
/// have very many tetrahedra.
#[derive(Debug, Default)]
pub struct Star {
    last: Option<First>,
}

/// The first of the tetrahedra that can be reached around a vertex, an edge or a face.
#[derive(Debug, Clone, Copy)]
pub struct First {
    /// The place in that tetrahedron.
    pub place: Place,
    /// Whether the point is on the boundary: if the boundary is not convex, there may be tetrahedra
    /// that touch it without being reached.
    pub open: bool,
}

impl Star {
    /// The first of the tetrahedra that contain the point at `place`.
    #[inline]
    pub fn first(&mut self, given: &Tetrahedra, place: Place) -> First {
        if place.on == [false; 4] {
            return First { place, open: false };
        }
        if let Some(last) = self.last
            && last.place == place
            && place.site().is_some()
        {
            return last;
        }
        let first = first_around(given, place);
        self.last = Some(first);
        first
    }
}

#[inline(never)]
fn first_around(given: &Tetrahedra, place: Place) -> First {
    let mut first = place;
    let mut open = false;
    around(given, place, |place| {
        if let Some(place) = place {
            if place.simplex < first.simplex {
                first = place;
            }
        } else {
            open = true;
        }
        true
    });
    First { place: first, open }
}

/// Calls `visit` on each tetrahedron that contains the point at `place`, and with `None` for each
/// boundary face that does, until it answers `false`. Terminates because each is visited once.
pub fn around(given: &Tetrahedra, place: Place, mut visit: impl FnMut(Option<Place>) -> bool) {
    let mut met = Met::default();
    met.is_new(place.simplex);
    let mut open = vec![place];
    while let Some(at) = open.pop() {
        if !visit(Some(at)) {
            return;
        }
        for corner in (0..4).filter(|&k| at.on[k]) {
            match at.across(given, corner) {
                None => {
                    if !visit(None) {
                        return;
                    }
                }
                Some(next) => {
                    if met.is_new(next.simplex) {
                        open.push(next);
                    }
                }
            }
        }
    }
}

/// A set of visited numbers: a list while there are few.
#[derive(Default)]
struct Met {
    few: Vec<usize>,
    many: HashSet<usize>,
}

impl Met {
    /// A vertex of uniform points has 27 tetrahedra on average.
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
