//! Large sets in blocks, on several threads, in 2-D and 3-D.
//!
//! Each block is triangulated separately. A simplex of a block is *certain* if no site of another
//! block is below its lifted plane, or on it: then it is in the triangulation of all sites. The
//! other simplices are found again among the *open* sites, the corners of uncertain simplices and
//! of the hulls of blocks. Any other corner is surrounded by certain simplices; and a site that is
//! hidden in its block is hidden among all. So each simplex that is not certain has open corners
//! only, and because it is above no site, it is in the triangulation of the open sites, too. There
//! the two kinds meet at the same facets, and a flood from these finds the simplices between the
//! blocks.
//!
//! # The bound of the filter
//!
//! The center of a power sphere, relative to its first corner, is a quotient of sums. The filter
//! gives up unless the denominator exceeds 10^-6 of the sum of the magnitudes of its monomials,
//! so its relative error is below 10^-9. If S is the quotient of magnitudes, the error of the
//! center is below 10^-8 S, and that of differences of squared distances below 10^-7 (d^2 + S^2),
//! where d is the distance to another block; the filter requires ten times that. S and the
//! denominator are in a range where no underflow matters. A simplex about which the filter gives up
//! is not certain, which costs time but changes nothing.

use std::collections::HashMap;

use super::power::Weighted;
use crate::base::arrays::Arrays;
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, push, with_room};
use crate::base::parallel;
use crate::base::watch::Watch;

/// Simplices or, if there are none, the sites that are not hidden.
pub type Found<const N: usize> = std::result::Result<Arrays<N>, Vec<u32>>;

/// Simplices between two checks for interruption.
const WATCH_EVERY: usize = 1 << 12;

/// The box around the sites of a block, and their largest weight.
#[derive(Clone, Copy)]
struct Ground<const D: usize> {
    low: [f64; D],
    high: [f64; D],
    heaviest: f64,
}

/// The result of a block.
struct Judged {
    /// For each simplex its number among the certain ones of the block, or -1.
    number: Vec<i32>,
    count: usize,
    /// Sites, ascending.
    open: Vec<u32>,
}

/// A facet between a certain simplex and others.
struct Border<const N: usize> {
    key: [i32; N],
    odd: bool,
    simplex: i32,
    corner: usize,
}

/// Triangulates `sites` by `build`, whose sites are numbered from 0; block i has the sites from
/// `starts[i]` to the next. Any two blocks are on two sides of a line or plane parallel to an axis.
pub fn in_blocks<const D: usize, const N: usize>(
    sites: Weighted<D>,
    starts: &[usize],
    workers: usize,
    watch: &Watch,
    build: impl Fn(Weighted<D>) -> Result<Found<N>> + Sync,
) -> Result<Found<N>> {
    let blocks: Vec<(usize, usize)> = starts.windows(2).map(|w| (w[0], w[1])).collect();
    let of = |&(from, to): &(usize, usize)| Weighted {
        points: &sites.points[from..to],
        weights: &sites.weights[from..to],
    };
    let grounds: Vec<Ground<D>> = blocks.iter().map(|block| Ground::of(&of(block))).collect();
    if blocks.len() < 2 || !pay_off(&grounds, sites.weights) {
        return build(sites);
    }
    let found = parallel::map_watched(workers, blocks.iter().collect(), watch, |b| build(of(b)))?;
    let tasks = found.iter().enumerate().collect();
    let judged = parallel::map_watched(workers, tasks, watch, |(i, found)| {
        judge(&of(&blocks[i]), starts[i], found, i, &grounds, watch)
    })?;
    let count = judged.iter().map(|each| each.open.len()).sum();
    let (mut open, mut points, mut weights) =
        (with_room(count)?, with_room(count)?, with_room(count)?);
    for &v in judged.iter().flat_map(|each| &each.open) {
        open.push(v);
        points.push(sites.points[v as usize]);
        weights.push(sites.weights[v as usize]);
    }
    let seam = build(Weighted {
        points: &points,
        weights: &weights,
    })?;
    let seam = match seam {
        // If the open sites span no simplex, no block does.
        Err(rest) => return Ok(Err(rest.iter().map(|&v| open[v as usize]).collect())),
        Ok(mut seam) => {
            for corners in &mut seam.simplices {
                *corners = corners.map(|v| open[v as usize] as i32);
            }
            seam
        }
    };
    let found = found.into_iter().map(|each| each.unwrap_or_default());
    let pieces = found.zip(judged).zip(starts).map(|((f, j), &s)| (f, j, s));
    join(pieces.collect(), &seam, workers, watch).map(Ok)
}

/// Whether most simplices of blocks can be certain: where weights differ by more than the square of
/// a block's size, a heavy site affects simplices far away.
fn pay_off<const D: usize>(grounds: &[Ground<D>], weights: &[f64]) -> bool {
    let (least, most) = weights
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &w| {
            (a.min(w), b.max(w))
        });
    let side = |g: &Ground<D>| {
        (0..D)
            .map(|k| g.high[k] - g.low[k])
            .fold(f64::INFINITY, f64::min)
    };
    let mut sides: Vec<f64> = grounds.iter().map(side).collect();
    sides.sort_unstable_by(f64::total_cmp);
    let typical = sides[sides.len() / 2];
    16.0 * (most - least) < typical * typical
}

impl<const D: usize> Ground<D> {
    fn of(sites: &Weighted<D>) -> Self {
        let mut ground = Self {
            low: [f64::INFINITY; D],
            high: [f64::NEG_INFINITY; D],
            heaviest: f64::NEG_INFINITY,
        };
        for (p, &w) in sites.points.iter().zip(sites.weights) {
            for (k, &x) in p.iter().enumerate() {
                ground.low[k] = ground.low[k].min(x);
                ground.high[k] = ground.high[k].max(x);
            }
            ground.heaviest = ground.heaviest.max(w);
        }
        ground
    }
}

/// Finds the certain simplices of block `own` and its open sites.
fn judge<const D: usize, const N: usize>(
    sites: &Weighted<D>,
    start: usize,
    found: &Found<N>,
    own: usize,
    grounds: &[Ground<D>],
    watch: &Watch,
) -> Result<Judged> {
    let mut is_open = filled(sites.points.len(), false)?;
    let (mut number, mut count) = (Vec::new(), 0);
    match found {
        Err(rest) => rest.iter().for_each(|&v| is_open[v as usize] = true),
        Ok(arrays) => {
            number = with_room(arrays.simplices.len())?;
            for (t, corners) in arrays.simplices.iter().enumerate() {
                if t.is_multiple_of(WATCH_EVERY) {
                    watch.check()?;
                }
                let certain = is_certain(sites, corners, own, grounds);
                number.push(if certain { count } else { -1 });
                count += i32::from(certain);
                for k in 0..N {
                    if !certain || arrays.neighbors[t][k] < 0 {
                        let others = (0..N).filter(|&j| j != k);
                        others.for_each(|j| is_open[corners[j] as usize] = true);
                    }
                }
            }
        }
    }
    let mut open = Vec::new();
    for (v, _) in is_open.iter().enumerate().filter(|(_, open)| **open) {
        push(&mut open, (start + v) as u32)?;
    }
    Ok(Judged {
        number,
        count: count as usize,
        open,
    })
}

/// Whether no site of another block is below the lifted plane of a simplex, or on it.
fn is_certain<const D: usize, const N: usize>(
    sites: &Weighted<D>,
    corners: &[i32; N],
    own: usize,
    grounds: &[Ground<D>],
) -> bool {
    let points = corners.map(|v| sites.points[v as usize]);
    let weights = corners.map(|v| sites.weights[v as usize]);
    let Some((center, scale)) = center(&points, &weights) else {
        return false;
    };
    let (first, weight) = (points[0], weights[0]);
    let power = center.iter().map(|x| x * x).sum::<f64>() - weight;
    let clear = |square: f64, heaviest: f64| {
        let size = square + scale * scale + weight.abs() + heaviest.abs();
        square - heaviest - power > 1e-6 * size
    };
    // All other blocks are outside the box of this one.
    let ground = &grounds[own];
    let depth = (0..D)
        .map(|k| {
            let low = center[k] - (ground.low[k] - first[k]);
            low.min((ground.high[k] - first[k]) - center[k])
        })
        .fold(f64::INFINITY, f64::min);
    let nonempty = |ground: &Ground<D>| ground.heaviest > f64::NEG_INFINITY;
    let others = || (0..).zip(grounds).filter(|(i, g)| *i != own && nonempty(g));
    let most = others()
        .map(|(_, g)| g.heaviest)
        .fold(f64::NEG_INFINITY, f64::max);
    depth > 0.0 && clear(depth * depth, most)
        || others().all(|(_, ground)| {
            let square = (0..D).map(|k| {
                let below = (ground.low[k] - first[k]) - center[k];
                let above = center[k] - (ground.high[k] - first[k]);
                let out = below.max(above).max(0.0);
                out * out
            });
            clear(square.sum(), ground.heaviest)
        })
}

/// The center of the power sphere of a simplex relative to its first corner, and the sum of the
/// magnitudes of what it is computed from; `None` if its error may be large.
fn center<const D: usize, const N: usize>(
    points: &[[f64; D]; N],
    weights: &[f64; N],
) -> Option<([f64; D], f64)> {
    // In 2-D, the third edge is a unit vector upward, whose plane keeps the center at height zero.
    let mut edges = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let (mut lifts, mut sizes) = ([0.0; 3], [0.0; 3]);
    for i in 0..D {
        let mut square = 0.0;
        for k in 0..D {
            edges[i][k] = points[i + 1][k] - points[0][k];
            square += edges[i][k] * edges[i][k];
        }
        let more = weights[i + 1] - weights[0];
        (lifts[i], sizes[i]) = (square - more, square + more.abs());
    }
    let cross = |a: [f64; 3], b: [f64; 3], sign: f64| {
        let term = |i: usize, j: usize| a[i] * b[j] - sign * (a[j] * b[i]);
        [term(1, 2), term(2, 0), term(0, 1)]
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let planes =
        |[b, c, d]: [[f64; 3]; 3], sign| [cross(c, d, sign), cross(d, b, sign), cross(b, c, sign)];
    let magnitudes = edges.map(|edge| edge.map(f64::abs));
    let (normals, larger) = (planes(edges, 1.0), planes(magnitudes, -1.0));
    let det = dot(edges[0], normals[0]);
    let least = 1e-6 * dot(magnitudes[0], larger[0]);
    if !(det.abs() > least && det.abs() > 1e-250) {
        return None;
    }
    let (mut center, mut scale) = ([0.0; D], 0.0);
    for k in 0..D {
        let column = |of: [[f64; 3]; 3]| [of[0][k], of[1][k], of[2][k]];
        center[k] = dot(lifts, column(normals)) / (2.0 * det);
        scale += dot(sizes, column(larger)) / (2.0 * det.abs());
    }
    (scale > 1e-60 && scale < 1e60).then_some((center, scale))
}

/// The vertices of the facet opposite a corner, ascending, and the parity of their order, which is
/// different on its two sides.
fn facet<const N: usize>(corners: &[i32; N], k: usize) -> ([i32; N], bool) {
    let (mut key, mut odd) = (*corners, false);
    key[k] = i32::MAX;
    for i in 1..N {
        for j in (1..=i).rev() {
            if key[j] < key[j - 1] {
                key.swap(j - 1, j);
                odd = !odd;
            }
        }
    }
    (key, odd)
}

/// The certain simplices of all blocks, and between them those of the open sites.
fn join<const N: usize>(
    pieces: Vec<(Arrays<N>, Judged, usize)>,
    seam: &Arrays<N>,
    workers: usize,
    watch: &Watch,
) -> Result<Arrays<N>> {
    let certain: usize = pieces.iter().map(|(_, judged, _)| judged.count).sum();
    let most = certain + seam.simplices.len();
    let mut out: Arrays<N> = Arrays {
        simplices: with_room(most)?,
        neighbors: with_room(most)?,
    };
    out.simplices.resize(certain, [0; N]);
    out.neighbors.resize(certain, [0; N]);
    let mut tasks = Vec::with_capacity(pieces.len());
    let (mut simplices, mut neighbors) = (&mut out.simplices[..], &mut out.neighbors[..]);
    let mut base = 0;
    for (arrays, judged, start) in pieces {
        let count = judged.count;
        let (here, rest) = simplices.split_at_mut(count);
        let (around, others) = neighbors.split_at_mut(count);
        (simplices, neighbors) = (rest, others);
        tasks.push((arrays, judged.number, start as i32, base, here, around));
        base += count as i32;
    }
    let borders = parallel::map_watched(workers, tasks, watch, |task| {
        let (arrays, number, start, base, here, around) = task;
        copy(&arrays, &number, [start, base], here, around)
    })?;
    let mut facets = HashMap::new();
    let count = borders.iter().map(Vec::len).sum();
    let bytes = count * size_of::<Border<N>>();
    facets
        .try_reserve(count)
        .map_err(|_| Error::Memory { bytes })?;
    for border in borders.into_iter().flatten() {
        facets.insert(border.key, border);
    }
    flood(&mut out, seam, &facets, watch)?;
    Ok(out)
}

/// Copies the certain simplices of a block; returns their facets that lead to others.
fn copy<const N: usize>(
    arrays: &Arrays<N>,
    number: &[i32],
    [start, base]: [i32; 2],
    simplices: &mut [[i32; N]],
    neighbors: &mut [[i32; N]],
) -> Result<Vec<Border<N>>> {
    let mut borders = Vec::new();
    for (t, &own) in number.iter().enumerate().filter(|(_, own)| **own >= 0) {
        let corners = arrays.simplices[t].map(|v| v + start);
        simplices[own as usize] = corners;
        for (corner, &other) in arrays.neighbors[t].iter().enumerate() {
            let other = if other < 0 {
                -1
            } else {
                number[other as usize]
            };
            neighbors[own as usize][corner] = if other < 0 { -1 } else { base + other };
            if other < 0 {
                let (key, odd) = facet(&corners, corner);
                let simplex = base + own;
                push(
                    &mut borders,
                    Border {
                        key,
                        odd,
                        simplex,
                        corner,
                    },
                )?;
            }
        }
    }
    Ok(borders)
}

/// Adds the simplices of the open sites that are connected with `facets` from outside, or all of
/// them if no simplex is certain.
fn flood<const N: usize>(
    out: &mut Arrays<N>,
    seam: &Arrays<N>,
    facets: &HashMap<[i32; N], Border<N>>,
    watch: &Watch,
) -> Result<()> {
    let border = |t: usize, k: usize| {
        let (key, odd) = facet(&seam.simplices[t], k);
        facets.get(&key).map(|border| (border, border.odd != odd))
    };
    let all = facets.is_empty();
    let mut number = filled(seam.simplices.len(), -1_i32)?;
    let mut stack = Vec::new();
    for (t, own) in number.iter_mut().enumerate() {
        if t.is_multiple_of(WATCH_EVERY) {
            watch.check()?;
        }
        if all || (0..N).any(|k| border(t, k).is_some_and(|(_, outside)| outside)) {
            *own = 0;
            push(&mut stack, t)?;
        }
    }
    while let Some(t) = stack.pop() {
        for k in 0..N {
            let other = seam.neighbors[t][k];
            if other >= 0 && number[other as usize] < 0 && border(t, k).is_none() {
                number[other as usize] = 0;
                push(&mut stack, other as usize)?;
            }
        }
    }
    let kept = number.iter_mut().filter(|number| **number == 0);
    for (number, next) in kept.zip(out.simplices.len() as i32..) {
        *number = next;
    }
    for (t, &own) in number.iter().enumerate().filter(|(_, own)| **own >= 0) {
        let mut around = [-1; N];
        for (k, beyond) in around.iter_mut().enumerate() {
            let other = seam.neighbors[t][k];
            *beyond = match border(t, k) {
                Some((border, _)) => {
                    out.neighbors[border.simplex as usize][border.corner] = own;
                    border.simplex
                }
                None if other >= 0 => number[other as usize],
                None => -1,
            };
        }
        out.simplices.push(seam.simplices[t]);
        out.neighbors.push(around);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use delone_predicates::{Point2, Point3};

    use super::super::insertion::insert_all;
    use super::*;
    use crate::base::watch::IDLE;

    fn numbers(n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n).map(|_| next()).collect()
    }

    /// Triangles as sorted rows; each neighbor must share the edge, and know it.
    fn checked(arrays: &Arrays<3>) -> Vec<[i32; 3]> {
        for (t, around) in arrays.neighbors.iter().enumerate() {
            for k in (0..3).filter(|&k| around[k] >= 0) {
                let other = around[k] as usize;
                let (key, odd) = facet(&arrays.simplices[t], k);
                let back = (0..3).find(|&j| facet(&arrays.simplices[other], j) == (key, !odd));
                assert_eq!(arrays.neighbors[other][back.unwrap()], t as i32);
            }
        }
        let smallest = |[a, b, c]: [i32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
        let mut rows: Vec<_> = arrays
            .simplices
            .iter()
            .filter_map(|&r| smallest(r))
            .collect();
        rows.sort_unstable();
        rows
    }

    /// Compares slabs of sorted points with a single block; returns how many were reused.
    fn compare(mut points: Vec<Point2>, weights: &[f64], cuts: &[usize]) -> usize {
        points.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap());
        let sites = Weighted {
            points: &points,
            weights,
        };
        let alone = insert_all(&sites, points.len(), &IDLE).unwrap();
        let before = alone.map(|arrays| checked(&arrays));
        let starts: Vec<usize> = [0]
            .iter()
            .chain(cuts)
            .chain([&points.len()])
            .copied()
            .collect();
        let (calls, largest) = (std::sync::Mutex::new(Vec::new()), points.len());
        for workers in [1, 3] {
            let found = in_blocks(sites, &starts, workers, &IDLE, |sites| {
                calls.lock().unwrap().push(sites.points.len());
                insert_all(&sites, sites.points.len(), &IDLE)
            });
            assert_eq!(found.unwrap().map(|arrays| checked(&arrays)), before);
        }
        largest - calls.into_inner().unwrap().last().unwrap()
    }

    fn scattered(n: usize, seed: u64) -> Vec<Point2> {
        numbers(2 * n, seed)
            .chunks(2)
            .map(|p| [p[0], p[1]])
            .collect()
    }

    #[test]
    fn blocks_of_scattered_sites() {
        for (range, seed) in [(0.0, 1), (1e-3, 2), (3e-3, 3)] {
            let weights: Vec<f64> = numbers(3000, seed)
                .iter()
                .map(|w| range * (w - 0.5))
                .collect();
            let reused = compare(scattered(3000, seed + 10), &weights, &[700, 1500, 2400]);
            assert!(reused > if range < 3e-3 { 1000 } else { 0 }, "{reused}");
        }
    }

    #[test]
    fn blocks_of_ties() {
        let grid =
            |side: usize| (0..side * side).map(move |i| [(i % side) as f64, (i / side) as f64]);
        let weights = vec![2.5; 1600];
        assert!(compare(grid(40).collect(), &weights, &[400, 801, 1199]) > 500);
        // Single columns are lines, without triangles.
        compare(grid(12).collect(), &weights[..144], &[12, 24, 36, 48, 60]);
    }

    #[test]
    fn blocks_where_little_is_certain() {
        let circle = numbers(500, 7).into_iter().map(|t| {
            let (s, c) = (6.3 * t).sin_cos();
            [c, s]
        });
        compare(circle.collect(), &[0.0; 500], &[100, 250]);
        let line = numbers(500, 8).iter().map(|&t| [t, 0.0]).collect();
        compare(line, &[0.0; 500], &[100, 250]);
        let mut weights = vec![0.0; 500];
        weights[250] = 1e6;
        compare(scattered(500, 9), &weights, &[100, 250]);
    }

    #[test]
    fn hidden_sites_may_hide_no_one() {
        // Heavy sites in one block hide those across the border.
        let mut weights: Vec<f64> = numbers(4000, 4).iter().map(|w| 1e-3 * w).collect();
        for w in weights.iter_mut().skip(1990).step_by(5).take(20) {
            *w = 5e-3;
        }
        compare(scattered(4000, 5), &weights, &[2000]);
    }

    #[test]
    fn centers_have_equal_power_at_all_corners() {
        let corners: [Point3; 4] = [
            [1.0, 2.0, 3.0],
            [4.0, 2.5, 3.0],
            [1.5, 6.0, 2.0],
            [2.0, 3.0, 7.0],
        ];
        let weights = [0.5, -0.25, 1.0, 0.0];
        let (found, _) = center(&corners, &weights).unwrap();
        let power = |i: usize| {
            let apart = (0..3).map(|k| corners[0][k] + found[k] - corners[i][k]);
            apart.map(|x| x * x).sum::<f64>() - weights[i]
        };
        assert!((1..4).all(|i| (power(i) - power(0)).abs() < 1e-12));
        let flat = [corners[0], corners[1], corners[2], corners[0]];
        assert!(center(&flat, &weights).is_none());
    }
}
