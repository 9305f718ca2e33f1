//! DBSCAN: which points have many others within a distance, and which of these are connected.
//!
//! M. Ester, H.-P. Kriegel, J. Sander and X. Xu, "A density-based algorithm for discovering clusters
//! in large spatial databases with noise" (1996). Rows are counted in a tree of boxes, of which
//! those inside the ball count as a whole. Core points are joined from the lowest boxes up: two
//! boxes whose core points are all in one cluster already, or which are certainly too far from each
//! other, need no comparison. So dense parts, where each point has many neighbors, are not compared
//! pair by pair.
//!
//! Distances are compared with the given number by rounded squares where these differ enough, else
//! exactly. A point at exactly that distance is within it.

use delone_predicates::Sign;
use delone_predicates::proximity::shorter;

use super::cores::multiplicities;
use crate::base::boxes::Open;
use crate::base::error::Result;
use crate::base::memory::{filled, with_room};
use crate::base::parallel;
use crate::base::points::Extent;
use crate::base::sets::Sets;
use crate::base::watch::{Pace, Watch};
use crate::graphs::{Tree, certainly_above, squared, squared_gap};

/// Points per task.
const SHARE: usize = 1 << 10;
/// Tests of points between two checks for interruption.
const LOT: usize = 1 << 14;
/// No place.
const NONE: u32 = u32::MAX;

/// The clusters of one distance.
pub struct Density {
    /// For each row, the first row of its cluster, or -1 for noise.
    pub clusters: Vec<i32>,
    /// Whether each row is a core point.
    pub is_core: Vec<bool>,
}

/// The clusters of `n` rows: core points have `k` rows within a distance, themselves included;
/// others belong to the nearest core point within it, of several the one with the smallest
/// coordinates.
pub fn density<const D: usize>(
    tree: &Tree<D>,
    n: usize,
    eps: f64,
    k: usize,
    workers: usize,
    watch: &Watch,
) -> Result<Density> {
    let starts = starts(tree, n)?;
    let mut found = Density {
        clusters: filled(n, -1)?,
        is_core: filled(n, false)?,
    };
    if tree.is_empty() {
        return Ok(found);
    }
    let ball = Ball::of(tree, eps);
    let is_core = ball.each(workers, watch, |search, place| {
        search.is_core(place, k, &starts)
    })?;
    let cores = Cores::of(tree, is_core)?;
    let mut sets = Sets::of(tree.len())?;
    Joined::of(&ball, &cores, &mut sets, watch)?;
    let homes = ball.each(workers, watch, |search, place| search.home(place, &cores))?;
    // The first row of each cluster: roots are first places only.
    let mut first = filled(tree.len(), i32::MAX)?;
    let mut roots = with_room(tree.len())?;
    for (place, &home) in homes.iter().enumerate() {
        let root = if home == NONE { NONE } else { sets.root(home) };
        roots.push(root);
        if root != NONE {
            let row = tree.rows[place] as i32;
            first[root as usize] = first[root as usize].min(row);
        }
    }
    for (place, &row) in tree.rows.iter().enumerate() {
        found.is_core[row as usize] = cores.is_core[place];
        if roots[place] != NONE {
            found.clusters[row as usize] = first[roots[place] as usize];
        }
    }
    for &[row, of] in &tree.duplicates {
        found.is_core[row as usize] = found.is_core[of as usize];
        found.clusters[row as usize] = found.clusters[of as usize];
    }
    Ok(found)
}

/// Where the rows of each place would begin if all were listed by place, plus the end.
fn starts<const D: usize>(tree: &Tree<D>, n: usize) -> Result<Vec<u32>> {
    let mut starts = with_room(tree.len() + 1)?;
    let mut sum = 0;
    starts.push(sum);
    for count in multiplicities(tree, n)? {
        sum += count;
        starts.push(sum);
    }
    Ok(starts)
}

/// A distance around the points of a tree.
struct Ball<'a, const D: usize> {
    tree: &'a Tree<D>,
    eps: f64,
    square: f64,
}

/// A search in a tree.
struct Search<'a, 'b, const D: usize> {
    ball: &'b Ball<'a, D>,
    open: Open,
    pace: Pace<'b>,
}

impl<'a, const D: usize> Ball<'a, D> {
    fn of(tree: &'a Tree<D>, eps: f64) -> Self {
        Self {
            tree,
            eps,
            square: eps * eps,
        }
    }

    /// Whether two points are within the distance.
    #[inline]
    fn joins(&self, a: [f64; D], b: [f64; D]) -> bool {
        let square = squared(a, b);
        if certainly_above(self.square, square) {
            return true;
        }
        if certainly_above(square, self.square) || self.eps == f64::INFINITY {
            return self.eps == f64::INFINITY;
        }
        let mut end = [0.0; D];
        end[0] = self.eps;
        shorter(a, b, [0.0; D], end) != Sign::Negative
    }

    /// Whether all points of a box are certainly within the distance of a point.
    #[inline]
    fn holds(&self, q: [f64; D], extent: &Extent<D>) -> bool {
        let square = (0..D).fold(0.0, |sum, k| {
            let (down, up) = (q[k] - extent.min[k], extent.max[k] - q[k]);
            let most = if down > up { down } else { up };
            sum + most * most
        });
        certainly_above(self.square, square)
    }

    /// Whether no point of a box is within the distance of a point, by a squared gap.
    #[inline]
    fn misses(&self, gap: f64) -> bool {
        certainly_above(gap, self.square)
    }

    /// What `of` finds for each place.
    fn each<T: Send + Copy>(
        &self,
        workers: usize,
        watch: &Watch,
        of: impl Fn(&mut Search<'a, '_, D>, usize) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        let n = self.tree.len();
        let shares = (0..n).step_by(SHARE).collect();
        let parts = parallel::map_watched(workers, shares, watch, |first| {
            let mut search = Search {
                ball: self,
                open: Vec::with_capacity(64),
                pace: Pace::new(watch, LOT),
            };
            let end = n.min(first + SHARE);
            let mut found = with_room(end - first)?;
            for place in first..end {
                found.push(of(&mut search, place)?);
            }
            Ok(found)
        })?;
        let mut all = with_room(n)?;
        parts.iter().for_each(|part| all.extend_from_slice(part));
        Ok(all)
    }
}

impl<const D: usize> Search<'_, '_, D> {
    /// Whether there are `k` rows within the distance of a place.
    fn is_core(&mut self, place: usize, k: usize, starts: &[u32]) -> Result<bool> {
        let tree = self.ball.tree;
        let q = tree.points[place];
        let mut rows = 0;
        tree.boxes.open(&mut self.open, 0.0);
        while let Some((_, level, i)) = self.open.pop() {
            let (level, i) = (level as usize, i as usize);
            let extent = &tree.boxes.at(level)[i];
            self.pace.spend(1)?;
            if self.ball.misses(squared_gap(extent, q)) {
                continue;
            }
            let places = tree.boxes.items(level, i);
            if self.ball.holds(q, extent) {
                rows += (starts[places.end] - starts[places.start]) as usize;
            } else if level > 0 {
                let below = tree.boxes.below(level, i);
                self.open
                    .extend(below.map(|child| (0.0, level as u32 - 1, child as u32)));
            } else {
                self.pace.spend(places.len())?;
                for other in places {
                    if self.ball.joins(q, tree.points[other]) {
                        rows += (starts[other + 1] - starts[other]) as usize;
                    }
                }
            }
            if rows >= k {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The nearest core point within the distance of a place, itself if it is one.
    fn home(&mut self, place: usize, cores: &Cores) -> Result<u32> {
        if cores.is_core[place] {
            return Ok(place as u32);
        }
        let tree = self.ball.tree;
        let q = tree.points[place];
        let mut best = NONE;
        let mut bound = self.ball.square;
        tree.boxes.open(&mut self.open, 0.0);
        while let Some((gap, level, i)) = self.open.pop() {
            let (level, i) = (level as usize, i as usize);
            if certainly_above(gap, bound) || !cores.any[level][i] {
                continue;
            }
            if level > 0 {
                self.pace.spend(1)?;
                let gap = |extent: &Extent<D>, _| Some(squared_gap(extent, q));
                tree.boxes.open_below(&mut self.open, level, i, gap);
                continue;
            }
            let places = tree.boxes.items(0, i);
            self.pace.spend(places.len())?;
            for other in places {
                let p = tree.points[other];
                if !cores.is_core[other] || certainly_above(squared(q, p), bound) {
                    continue;
                }
                let is_nearer = self.ball.joins(q, p)
                    && (best == NONE || {
                        let old = tree.points[best as usize];
                        let sign = shorter(q, p, q, old);
                        sign == Sign::Positive || (sign == Sign::Zero && p < old)
                    });
                if is_nearer {
                    best = other as u32;
                    bound = bound.min(squared(q, p));
                }
            }
        }
        Ok(best)
    }
}

/// Which places are core points, and which boxes have any.
struct Cores {
    is_core: Vec<bool>,
    any: Vec<Vec<bool>>,
}

impl Cores {
    fn of<const D: usize>(tree: &Tree<D>, is_core: Vec<bool>) -> Result<Self> {
        let any = |below: &[bool]| below.contains(&true);
        Ok(Self {
            any: tree.boxes.values(|places| any(&is_core[places]), any)?,
            is_core,
        })
    }
}

/// Core points that are joined while boxes are compared.
struct Joined<'a, 'b, const D: usize> {
    ball: &'b Ball<'a, D>,
    cores: &'b Cores,
    sets: &'b mut Sets,
    /// A core point of each box whose core points are known to be in one cluster, or `NONE`.
    one: Vec<Vec<u32>>,
    pace: Pace<'b>,
}

/// A box: its level and number.
type Node = (usize, usize);

impl<'a, 'b, const D: usize> Joined<'a, 'b, D> {
    /// Joins all core points within the distance of each other.
    fn of(
        ball: &'b Ball<'a, D>,
        cores: &'b Cores,
        sets: &'b mut Sets,
        watch: &'b Watch<'b>,
    ) -> Result<()> {
        let tree = ball.tree;
        let mut all = Self {
            ball,
            cores,
            sets,
            one: tree.boxes.values(|_| NONE, |_| NONE)?,
            pace: Pace::new(watch, LOT),
        };
        for i in 0..tree.boxes.at(0).len() {
            all.within_leaf(i)?;
        }
        for level in 1..=tree.boxes.top() {
            for i in 0..tree.boxes.at(level).len() {
                let below = tree.boxes.below(level, i);
                for a in below.clone() {
                    for b in a + 1..below.end {
                        all.between((level - 1, a), (level - 1, b))?;
                    }
                }
                all.mark((level, i));
            }
        }
        Ok(())
    }

    /// Joins the core points of a lowest box.
    fn within_leaf(&mut self, i: usize) -> Result<()> {
        let tree = self.ball.tree;
        let places = tree.boxes.items(0, i);
        self.pace.spend(places.len() * places.len() / 2)?;
        for a in places.clone().filter(|&a| self.cores.is_core[a]) {
            for b in a + 1..places.end {
                if self.cores.is_core[b] && self.ball.joins(tree.points[a], tree.points[b]) {
                    self.sets.join(a as u32, b as u32);
                }
            }
        }
        self.mark((0, i));
        Ok(())
    }

    /// Notes whether all core points of a box are in one cluster.
    fn mark(&mut self, (level, i): Node) {
        let mut root = None;
        let mut place = NONE;
        let mut see = |sets: &mut Sets, other: u32| {
            place = other;
            let found = sets.root(other);
            *root.get_or_insert(found) == found
        };
        let is_one = if level == 0 {
            let places = self.ball.tree.boxes.items(0, i);
            let mut inside = places.filter(|&place| self.cores.is_core[place]);
            inside.all(|place| see(self.sets, place as u32))
        } else {
            let mut below = self.ball.tree.boxes.below(level, i);
            below.all(|child| match self.one[level - 1][child] {
                NONE => !self.cores.any[level - 1][child],
                other => see(self.sets, other),
            })
        };
        self.one[level][i] = if is_one { place } else { NONE };
    }

    /// Joins core points of one box to those of another.
    fn between(&mut self, a: Node, b: Node) -> Result<()> {
        let tree = self.ball.tree;
        self.pace.spend(1)?;
        if !self.cores.any[a.0][a.1] || !self.cores.any[b.0][b.1] || self.are_one(a, b) {
            return Ok(());
        }
        let (one, other) = (&tree.boxes.at(a.0)[a.1], &tree.boxes.at(b.0)[b.1]);
        if self.ball.misses(gap_between(one, other)) {
            return Ok(());
        }
        if a.0 == 0 && b.0 == 0 {
            return self.between_leaves(a.1, b.1);
        }
        // The larger box is split.
        let (a, b) = if a.0 >= b.0 { (a, b) } else { (b, a) };
        for child in tree.boxes.below(a.0, a.1) {
            self.between((a.0 - 1, child), b)?;
        }
        self.mark(a);
        Ok(())
    }

    /// Whether the core points of two boxes are in one cluster, as far as that is known.
    fn are_one(&mut self, a: Node, b: Node) -> bool {
        let (a, b) = (self.one[a.0][a.1], self.one[b.0][b.1]);
        a != NONE && b != NONE && self.sets.root(a) == self.sets.root(b)
    }

    /// Joins core points of two lowest boxes.
    fn between_leaves(&mut self, a: usize, b: usize) -> Result<()> {
        let tree = self.ball.tree;
        let (ones, others) = (tree.boxes.items(0, a), tree.boxes.items(0, b));
        self.pace.spend(ones.len() * others.len())?;
        for p in ones.filter(|&p| self.cores.is_core[p]) {
            for q in others.clone().filter(|&q| self.cores.is_core[q]) {
                if self.sets.root(p as u32) != self.sets.root(q as u32)
                    && self.ball.joins(tree.points[p], tree.points[q])
                {
                    self.sets.join(p as u32, q as u32);
                    if self.are_one((0, a), (0, b)) {
                        return Ok(());
                    }
                }
            }
        }
        self.mark((0, a));
        self.mark((0, b));
        Ok(())
    }
}

/// The squared distance of two boxes, rounded.
fn gap_between<const D: usize>(one: &Extent<D>, other: &Extent<D>) -> f64 {
    (0..D).fold(0.0, |sum, k| {
        let (before, after) = (one.min[k] - other.max[k], other.min[k] - one.max[k]);
        let gap = if before > after { before } else { after };
        sum + if gap > 0.0 { gap * gap } else { 0.0 }
    })
}
