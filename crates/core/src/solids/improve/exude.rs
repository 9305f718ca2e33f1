//! Sliver exudation: gives a vertex the weight that makes its tetrahedra in the regular
//! triangulation best.
//!
//! S.-W. Cheng, T. K. Dey, H. Edelsbrunner, M. A. Facello and S.-H. Teng, "Sliver exudation",
//! Journal of the ACM 47 (2000). As the weight of one vertex grows, tetrahedra around its star join
//! it, each at the weight that equals the power of the vertex with respect to the sphere orthogonal
//! to its corners. The star then joins the vertex to the boundary of the joined tetrahedra. A
//! weight below a quarter of the squared distance to the nearest vertex hides no vertex; the
//! largest weight here is a fifth of it.
//!
//! Powers are rounded. They only decide which changes are tried and in which order: each change
//! must pass the same proof as any other.

use std::collections::BTreeSet;

use super::edge::Plan;
use super::measure::{cross, dot, minus, quality};
use super::store::{Corners, FACES, NONE, Store};
use crate::base::error::Result;

/// The largest weight, relative to the squared distance to the nearest vertex.
const MOST: f64 = 0.2;
/// The most tetrahedra that join a star; a few suffice.
const LONGEST: usize = 40;

/// The best weight of a vertex, whose star is `star` at its present weight: the changes and the
/// weight. `None` if nothing is better than `above`.
pub fn pump(
    store: &Store,
    weights: &[f64],
    v: u32,
    star: &[u32],
    above: f64,
) -> Result<Option<(Plan, f64)>> {
    let nearest = nearest(store, v, star);
    let mut cavity = star.to_vec();
    let mut before = least(store, star);
    let mut best: Option<(Plan, f64)> = None;
    let mut value = above;
    while cavity.len() < star.len() + LONGEST {
        // The tetrahedron that joins the cavity at the smallest weight from here on.
        let Some((power, next)) = first(store, weights, v, &cavity) else {
            break;
        };
        if power >= MOST * nearest {
            break;
        }
        cavity.push(next);
        before = before.min(store.quality[next as usize]);
        // If others join at the same weight, there is no triangulation in between.
        let until = first(store, weights, v, &cavity).map_or(f64::INFINITY, |(power, _)| power);
        let weight = 0.5 * (power.max(weights[v as usize]) + until.min(MOST * nearest));
        if !(weight > power && weight < until) {
            continue;
        }
        // The star that the vertex has between the two weights, if it is better than all before.
        let new = cone(store, v, &cavity);
        let after = new
            .iter()
            .fold(f64::INFINITY, |m, &c| m.min(quality(store.places_of(c))));
        if after > value.max(before) && keeps_vertices(store, &cavity, &new) {
            value = after;
            let plan = Plan {
                old: cavity.clone(),
                new,
                least: after,
                turning: false,
            };
            best = Some((plan, weight));
        }
    }
    Ok(best)
}

fn least(store: &Store, all: &[u32]) -> f64 {
    let qualities = all.iter().map(|&t| store.quality[t as usize]);
    qualities.fold(f64::INFINITY, f64::min)
}

/// The squared distance to the nearest vertex of the star.
fn nearest(store: &Store, v: u32, star: &[u32]) -> f64 {
    let here = store.points[v as usize];
    let others = star.iter().flat_map(|&t| store.corners[t as usize]);
    let squares = others.filter(|&u| u != v).map(|u| {
        let e = minus(store.points[u as usize], here);
        dot(e, e)
    });
    squares.fold(f64::INFINITY, f64::min)
}

/// The faces of the boundary of a cavity that do not contain the vertex: tetrahedron and corner.
fn boundary<'a>(store: &'a Store, v: u32, cavity: &'a [u32]) -> impl Iterator<Item = (u32, usize)> {
    let faces = cavity.iter().flat_map(|&t| (0..4).map(move |k| (t, k)));
    faces.filter(move |&(t, k)| {
        let beyond = store.across[t as usize][k];
        let has = (0..4).any(|i| i != k && store.corners[t as usize][i] == v);
        !has && (beyond == NONE || !cavity.contains(&beyond))
    })
}

/// The first tetrahedron to join a cavity, and its power.
fn first(store: &Store, weights: &[f64], v: u32, cavity: &[u32]) -> Option<(f64, u32)> {
    let beyond = boundary(store, v, cavity).filter_map(|(t, k)| store.beyond(t, k));
    let powers = beyond.map(|u| (power(store, weights, v, u), u));
    powers
        .filter(|(power, _)| power.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
}

/// The power of a vertex with respect to the sphere orthogonal to the corners of a tetrahedron.
fn power(store: &Store, weights: &[f64], v: u32, t: u32) -> f64 {
    let corners = store.corners[t as usize];
    let [a, b, c, d] = store.places_of(corners);
    let [wa, wb, wc, wd] = corners.map(|u| weights[u as usize]);
    let x = minus(store.points[v as usize], a);
    let (b, c, d) = (minus(b, a), minus(c, a), minus(d, a));
    let sides = [cross(c, d), cross(d, b), cross(b, c)];
    let lifted = [(b, wb), (c, wc), (d, wd)].map(|(e, w)| dot(e, e) - w + wa);
    let sum: f64 = (0..3).map(|k| dot(sides[k], x) * lifted[k]).sum();
    dot(x, x) + wa - sum / dot(sides[0], b)
}

/// The tetrahedra formed by a vertex and each boundary face of a cavity.
fn cone(store: &Store, v: u32, cavity: &[u32]) -> Vec<Corners> {
    let tetrahedron = |(t, k): (u32, usize)| {
        let [p, q, r] = FACES[k].map(|i: usize| store.corners[t as usize][i]);
        [p, q, r, v]
    };
    boundary(store, v, cavity).map(tetrahedron).collect()
}

fn keeps_vertices(store: &Store, old: &[u32], new: &[Corners]) -> bool {
    let before = old.iter().flat_map(|&t| store.corners[t as usize]);
    let after: BTreeSet<u32> = new.iter().flatten().copied().collect();
    before.collect::<BTreeSet<u32>>().len() == after.len()
}
