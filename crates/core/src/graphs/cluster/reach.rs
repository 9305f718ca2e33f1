//! A minimum spanning tree of all pairs of points by mutual reachability: the maximum of their
//! distance and both core distances (R. J. G. B. Campello, D. Moulavi and J. Sander, 2013).
//!
//! O. Boruvka's algorithm (1926) on a tree of boxes (W. B. March, P. Ram and A. G. Gray, "Fast
//! Euclidean minimum spanning tree", 2010): in each round, components choose their lightest edge to
//! any other. A search skips boxes that are inside the component, or certainly farther than the
//! lightest edge that the component has found. What one round finds for a point remains a lower
//! bound in all later ones, because components only grow; most points are never searched again. The
//! largest component chooses none, as the others reach it.
//!
//! Equal weights need no rule. An edge that would close a cycle of chosen edges is left out.
//! Suppose that a component c chose e, which is in no minimum spanning tree T with the edges chosen
//! before. On the cycle that e closes in T, contracted to the components of the round, the last
//! edge into c is no lighter than e, and no heavier, so it was chosen before (else e could replace
//! it), and not by c. So the component before chose it, the edge before that one is no lighter
//! either, and so on to the other end of e: its ends were joined already.
//!
//! Rounds end because each joins every component but one to another.

use std::sync::atomic::{AtomicU64, Ordering};

use super::cores::Cores;
use super::link::{Link, Span};
use crate::base::boxes::Open;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::graphs::{Tree, certainly_above, squared, squared_gap};

/// Points per task.
const SHARE: usize = 1 << 10;
/// Tests of points between two checks for interruption.
const LOT: usize = 1 << 14;
/// No point, or several components.
const NONE: u32 = u32::MAX;

/// What is known of the lightest edge of a point to another component.
#[derive(Clone, Copy)]
struct Known {
    /// It is not lighter: a square, rounded.
    least: f64,
    /// Its other end, if it was found.
    other: u32,
}

/// A forest that grows to the tree.
struct Forest<'a, const D: usize> {
    tree: &'a Tree<D>,
    cores: &'a Cores,
    /// The component of each place, the first place in it.
    components: Vec<u32>,
    /// The components of boxes by level, or `NONE` for several.
    boxes: Vec<Vec<u32>>,
    /// The smallest core distance in each box, squared.
    least: Vec<Vec<f64>>,
}

/// The links of the tree, between rows; duplicates are joined to first rows.
pub fn reach_tree<const D: usize>(
    tree: &Tree<D>,
    cores: &Cores,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Link>> {
    let mut links = spanning(tree, cores, workers, watch)?;
    for link in &mut links {
        link.ends = link.ends.map(|place| tree.rows[place as usize]);
        link.span.between = link.span.between.map(|place| tree.rows[place as usize]);
    }
    if tree.duplicates.is_empty() {
        return Ok(links);
    }
    let mut places = filled(tree.len() + tree.duplicates.len(), 0u32)?;
    for (place, &row) in (0..).zip(&tree.rows) {
        places[row as usize] = place;
    }
    let mut all = with_room(links.len() + tree.duplicates.len())?;
    all.extend_from_slice(&links);
    for &ends in &tree.duplicates {
        let mut span = cores.span(places[ends[1] as usize] as usize);
        span.between = span.between.map(|place| tree.rows[place as usize]);
        all.push(Link { ends, span });
    }
    Ok(all)
}

/// The same for distinct points, between places.
fn spanning<const D: usize>(
    tree: &Tree<D>,
    cores: &Cores,
    workers: usize,
    watch: &Watch,
) -> Result<Vec<Link>> {
    let n = tree.len();
    let mut links = with_room(n.saturating_sub(1))?;
    let mut sets = Sets::of(n)?;
    let mut forest = Forest::of(tree, cores)?;
    let start = Known {
        least: 0.0,
        other: NONE,
    };
    let mut known = filled(n, start)?;
    let mut sizes = filled(n, 1u32)?;
    while links.len() + 1 < n {
        let largest = largest(&sizes);
        let limits = forest.search(&mut known, largest, workers, watch)?;
        let chosen = forest.chosen(&known, largest, &limits, watch)?;
        let before = links.len();
        for &place in &chosen {
            let ends = [place, known[place as usize].other];
            if sets.join(ends[0], ends[1]) {
                let span = forest.span(ends[0], ends[1]);
                links.push(Link { ends, span });
            }
        }
        if links.len() == before {
            return Err(Error::Internal("a round joined no components".into()));
        }
        forest.relabel(&mut sets, &mut sizes, watch)?;
    }
    Ok(links)
}

impl<'a, const D: usize> Forest<'a, D> {
    /// Each place by itself.
    fn of(tree: &'a Tree<D>, cores: &'a Cores) -> Result<Self> {
        let mut components = with_room(tree.len())?;
        components.extend(0..tree.len() as u32);
        let smallest = |squares: &[f64]| squares.iter().copied().fold(f64::INFINITY, f64::min);
        // A box of one point is its component.
        let single = |below: &[u32]| if let [one] = *below { one } else { NONE };
        let boxes = &tree.boxes;
        Ok(Self {
            tree,
            cores,
            boxes: boxes.values(|places| single(&components[places]), single)?,
            least: boxes.values(|places| smallest(&cores.squares[places]), smallest)?,
            components,
        })
    }

    /// The weight of an edge; a core distance of the first end, if it is that.
    #[inline]
    fn span(&self, a: u32, b: u32) -> Span {
        let points = &self.tree.points;
        let apart = Span::of(points, a, b);
        let there = self.cores.span(b as usize);
        let most = if there.compare(&apart, points).is_gt() {
            there
        } else {
            apart
        };
        let here = self.cores.span(a as usize);
        if most.compare(&here, points).is_gt() {
            most
        } else {
            here
        }
    }

    /// Completes what is known of points that may have the lightest edge of their component; and
    /// for each component, a square that this edge does not exceed.
    fn search(
        &self,
        known: &mut [Known],
        largest: u32,
        workers: usize,
        watch: &Watch,
    ) -> Result<Vec<AtomicU64>> {
        let n = known.len();
        let mut limits: Vec<AtomicU64> = with_room(n)?;
        limits.extend((0..n).map(|_| AtomicU64::new(f64::INFINITY.to_bits())));
        for (place, known) in known.iter_mut().enumerate() {
            if known.other == NONE {
                continue;
            }
            let component = self.components[place];
            if self.components[known.other as usize] == component {
                known.other = NONE;
            } else {
                lower(&limits[component as usize], known.least);
            }
        }
        let shares = (0..).step_by(SHARE).zip(known.chunks_mut(SHARE)).collect();
        parallel::map_watched(workers, shares, watch, |(first, share)| {
            self.search_share(first, share, largest, &limits, watch)
        })?;
        Ok(limits)
    }

    /// The same for some places in a row.
    fn search_share(
        &self,
        first: usize,
        share: &mut [Known],
        largest: u32,
        limits: &[AtomicU64],
        watch: &Watch,
    ) -> Result<()> {
        let mut open = Vec::with_capacity(64);
        let mut pace = Pace::new(watch, LOT);
        for (place, known) in (first..).zip(share) {
            let component = self.components[place];
            if component == largest || known.other != NONE {
                continue;
            }
            let limit = &limits[component as usize];
            let bound = f64::from_bits(limit.load(Ordering::Relaxed));
            if certainly_above(known.least.max(self.cores.squares[place]), bound) {
                continue;
            }
            *known = self.nearest_outside(place, bound, &mut open, &mut pace)?;
            if known.other != NONE {
                lower(limit, known.least);
            }
        }
        Ok(())
    }

    /// The lightest edge of a place to another component, if it is not certainly above a bound.
    fn nearest_outside(
        &self,
        place: usize,
        mut bound: f64,
        open: &mut Open,
        pace: &mut Pace<'_>,
    ) -> Result<Known> {
        let (tree, own) = (self.tree, self.components[place]);
        let q = tree.points[place];
        let here = self.cores.span(place);
        let mut best: Option<(Span, u32)> = None;
        tree.boxes.open(open, here.square);
        while let Some((away, level, i)) = open.pop() {
            if certainly_above(away, bound) {
                continue;
            }
            let (level, i) = (level as usize, i as usize);
            if level > 0 {
                pace.spend(1)?;
                tree.boxes.open_below(open, level, i, |extent, child| {
                    let gap = squared_gap(extent, q);
                    let away = gap.max(self.least[level - 1][child]).max(here.square);
                    let is_out = self.boxes[level - 1][child] == own;
                    (!is_out && !certainly_above(away, bound)).then_some(gap)
                });
                continue;
            }
            let places = tree.boxes.items(0, i);
            pace.spend(places.len())?;
            for other in places {
                if self.components[other] == own {
                    continue;
                }
                let away = squared(q, tree.points[other]).max(self.cores.squares[other]);
                if certainly_above(away.max(here.square), bound) {
                    continue;
                }
                let span = self.span(place as u32, other as u32);
                if best.is_none_or(|(best, _)| span.compare(&best, &tree.points).is_lt()) {
                    best = Some((span, other as u32));
                    bound = bound.min(span.square);
                    if span.between == here.between {
                        // No edge of this point is lighter.
                        open.clear();
                        break;
                    }
                }
            }
        }
        Ok(match best {
            Some((span, other)) => Known {
                least: span.square,
                other,
            },
            None => Known {
                least: bound,
                other: NONE,
            },
        })
    }

    /// The place with the lightest edge of each component but the largest.
    fn chosen(
        &self,
        known: &[Known],
        largest: u32,
        limits: &[AtomicU64],
        watch: &Watch,
    ) -> Result<Vec<u32>> {
        let mut best = filled(known.len(), NONE)?;
        let mut pace = Pace::new(watch, LOT);
        for (place, one) in known.iter().enumerate() {
            pace.spend(1)?;
            let component = self.components[place] as usize;
            let limit = f64::from_bits(limits[component].load(Ordering::Relaxed));
            let is_skipped = one.other == NONE || component as u32 == largest;
            if is_skipped || certainly_above(one.least, limit) {
                continue;
            }
            let old = best[component];
            let is_lighter = old == NONE || {
                let span = self.span(place as u32, one.other);
                let least = self.span(old, known[old as usize].other);
                span.compare(&least, &self.tree.points).is_lt()
            };
            if is_lighter {
                best[component] = place as u32;
            }
        }
        best.retain(|&place| place != NONE);
        Ok(best)
    }

    /// Numbers the components after some were joined.
    fn relabel(&mut self, sets: &mut Sets, sizes: &mut [u32], watch: &Watch) -> Result<()> {
        let mut pace = Pace::new(watch, LOT);
        sizes.fill(0);
        for (place, component) in self.components.iter_mut().enumerate() {
            pace.spend(1)?;
            *component = sets.root(place as u32);
            sizes[*component as usize] += 1;
        }
        for level in 0..self.boxes.len() {
            let (below, boxes) = self.boxes.split_at_mut(level);
            for (i, component) in boxes[0].iter_mut().enumerate() {
                pace.spend(1)?;
                let parts = match level {
                    0 => &self.components[self.tree.boxes.items(0, i)],
                    _ => &below[level - 1][self.tree.boxes.below(level, i)],
                };
                let is_one = parts.iter().all(|part| *part == parts[0]);
                *component = if is_one { parts[0] } else { NONE };
            }
        }
        Ok(())
    }
}

/// The component with the most points; none in the first round.
fn largest(sizes: &[u32]) -> u32 {
    let most = sizes.iter().copied().max().unwrap_or(0);
    let at = sizes.iter().position(|&size| size == most && size > 1);
    at.map_or(NONE, |component| component as u32)
}

/// Lowers a limit, a square, to another one.
#[inline]
fn lower(limit: &AtomicU64, square: f64) {
    // Bits of doubles from 0 on are in the order of the doubles.
    limit.fetch_min(square.to_bits(), Ordering::Relaxed);
}
