//! Builds a mesh from arrays of triangles: finds the neighbors and adds the ghosts.

use super::export::OUTSIDE;
use super::{Code, Mesh2, next, prev};
use crate::base::error::{Error, Result};
use crate::base::memory::{filled, with_room, zeroed};
use crate::base::watch::{Pace, Watch};

/// The most triangles: their codes must fit in 32 bits and leave [`OUTSIDE`] free.
const LIMIT: usize = 1 << 29;

/// Triangles, or vertices, between two checks for interruption.
const LOT: usize = 1 << 16;

/// The triangle across the edge opposite each corner, -1 outside, by a sort of the edges: O(m log
/// m), less if no vertex has a high degree. Corners must be below `vertices`.
pub fn adjacency(simplices: &[[i32; 3]], vertices: usize, watch: &Watch) -> Result<Vec<[i32; 3]>> {
    let opposites = opposites(simplices, vertices, watch)?;
    let mut neighbors = with_room(simplices.len())?;
    for lot in opposites.chunks(LOT) {
        watch.check()?;
        neighbors.extend(lot.iter().map(|codes| codes.map(|e| e as i32 >> 3)));
    }
    Ok(neighbors)
}

/// The mesh of triangles that tile the hull of `vertices` vertices, all of which they use, and one
/// of its ghosts. Triangle t becomes record t. `neighbors`, the triangle opposite each corner or -1,
/// are found if they are not given.
pub fn mesh(
    simplices: &[[i32; 3]],
    neighbors: Option<&[[i32; 3]]>,
    vertices: usize,
    watch: &Watch,
) -> Result<(Mesh2, Code)> {
    let mut pace = Pace::new(watch, LOT);
    let broken = || Error::Internal("the triangles do not tile a hull".into());
    let opposites = match neighbors {
        Some(neighbors) => opposites_of(simplices, neighbors, watch)?,
        None => opposites(simplices, vertices, watch)?,
    };
    let mut mesh = Mesh2::with_vertices(vertices)?;
    let outside = opposites.iter().flatten().filter(|&&e| e == OUTSIDE);
    if simplices.len() + outside.count() + 2 != 2 * vertices {
        return Err(broken());
    }
    let mut patch = mesh.patch();
    for s in simplices {
        pace.spend(1)?;
        let t = patch.fresh();
        patch.set(t, s.map(|v| v as u32));
    }
    // For each vertex, the ghost whose hull edge begins there.
    let mut begins = filled(vertices, OUTSIDE)?;
    let mut hull: Vec<Code> = Vec::new();
    for (t, codes) in (0u32..).zip(&opposites) {
        pace.spend(1)?;
        for (e, &across) in (8 * t..).zip(codes) {
            if across != OUTSIDE {
                patch.link(e, across);
                continue;
            }
            let (tail, head) = (patch.vertex(next(e)), patch.vertex(prev(e)));
            let g = patch.fresh();
            patch.set(g, [patch.infinite(), head, tail]);
            patch.link(8 * g, e);
            // On a hull, one boundary edge leaves each vertex.
            if std::mem::replace(&mut begins[tail as usize], 8 * g) != OUTSIDE {
                return Err(broken());
            }
            hull.push(8 * g);
        }
    }
    for &g in &hull {
        let after = begins[patch.head(g) as usize];
        if after == OUTSIDE {
            return Err(broken());
        }
        patch.link(prev(g), next(after));
    }
    let ghost = hull.first().copied().ok_or_else(broken)?;
    Ok((mesh, ghost))
}

/// The code on the other side of each edge, from neighbors that must be triangles or -1. Two sides
/// are linked if they name each other and have the same ends.
fn opposites_of(
    simplices: &[[i32; 3]],
    neighbors: &[[i32; 3]],
    watch: &Watch,
) -> Result<Vec<[Code; 3]>> {
    let mut pace = Pace::new(watch, LOT);
    let mut found = with_room(simplices.len())?;
    for (t, (corners, sides)) in simplices.iter().zip(neighbors).enumerate() {
        pace.spend(1)?;
        let mut codes = [OUTSIDE; 3];
        for k in (0..3).filter(|&k| sides[k] >= 0) {
            let (n, [u, v]) = (sides[k] as usize, edge(*corners, k));
            let back =
                (0..3).find(|&j| neighbors[n][j] == t as i32 && edge(simplices[n], j) == [v, u]);
            codes[k] = match back {
                Some(j) => (8 * n + j) as Code,
                None => {
                    return Err(Error::Shape(format!(
                        "neighbors[{t}] = {sides:?}: simplices[{n}] does not meet simplices[{t}] at \
                         the edge {u} -> {v}"
                    )));
                }
            };
        }
        found.push(codes);
    }
    Ok(found)
}

/// The code on the other side of each edge: a counting sort puts edges at their smaller end, and a
/// sort by the larger end brings the two sides together.
fn opposites(simplices: &[[i32; 3]], vertices: usize, watch: &Watch) -> Result<Vec<[Code; 3]>> {
    let mut pace = Pace::new(watch, LOT);
    if simplices.len() > LIMIT {
        let found = simplices.len();
        return Err(Error::Shape(format!(
            "{found} simplices exceed the limit of {LIMIT}"
        )));
    }
    let mut start = zeroed::<u32>(vertices + 1)?;
    for (t, s) in simplices.iter().enumerate() {
        pace.spend(1)?;
        for [u, v] in [0, 1, 2].map(|k| edge(*s, k)) {
            if u == v {
                return Err(Error::Shape(format!(
                    "simplices[{t}] = {s:?} has vertex {u} twice"
                )));
            }
            start[u.min(v) as usize + 1] += 1;
        }
    }
    for v in 0..vertices {
        start[v + 1] += start[v];
    }
    let mut sides = zeroed::<u64>(3 * simplices.len())?;
    for (t, s) in (0u64..).zip(simplices) {
        pace.spend(1)?;
        for k in 0..3 {
            let [u, v] = edge(*s, k);
            let at = &mut start[u.min(v) as usize];
            // Sorted by the larger end, then by direction.
            let key = 2 * u.max(v) as u64 + u64::from(u > v);
            sides[*at as usize] = key << 32 | (8 * t + k as u64);
            *at += 1;
        }
    }
    let mut opposites = filled(simplices.len(), [OUTSIDE; 3])?;
    let mut from = 0;
    for &to in &start[..vertices] {
        pace.spend(1)?;
        let list = &mut sides[from as usize..to as usize];
        list.sort_unstable();
        pair(list, simplices, &mut opposites)?;
        from = to;
    }
    Ok(opposites)
}

/// The ends of edge k, counterclockwise.
fn edge(s: [i32; 3], k: usize) -> [i32; 2] {
    [s[(k + 1) % 3], s[(k + 2) % 3]]
}

/// Links the two sides of each edge in the sorted `list` of one smaller end.
fn pair(list: &[u64], simplices: &[[i32; 3]], opposites: &mut [[Code; 3]]) -> Result<()> {
    for w in list.windows(2) {
        let [e, f] = [w[0] as Code, w[1] as Code];
        let [[t, j], [s, k]] = [e, f].map(|e| [(e >> 3) as usize, (e & 7) as usize]);
        if w[0] >> 32 == w[1] >> 32 {
            let [u, v] = edge(simplices[t], j);
            return Err(Error::Shape(format!(
                "the directed edge {u} -> {v} occurs twice: in simplices[{t}] and simplices[{s}]"
            )));
        }
        if w[0] >> 33 == w[1] >> 33 {
            opposites[t][j] = f;
            opposites[s][k] = e;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[i32; 3]; 2] = [[0, 1, 3], [1, 2, 3]];

    #[test]
    fn neighbors_share_their_edge() {
        let neighbors = adjacency(&SQUARE, 4, &Watch::idle()).unwrap();
        assert_eq!(neighbors, [[1, -1, -1], [-1, 0, -1]]);
        assert!(adjacency(&[], 0, &Watch::idle()).unwrap().is_empty());
        // Triangles that share only a vertex are not neighbors.
        let neighbors = adjacency(&[[0, 1, 2], [2, 3, 4]], 5, &Watch::idle()).unwrap();
        assert_eq!(neighbors, [[-1; 3]; 2]);
    }

    #[test]
    fn an_edge_used_twice_is_named() {
        let fold = [[0, 1, 3], [1, 2, 3], [4, 3, 1]];
        assert_eq!(
            adjacency(&fold, 5, &Watch::idle()).unwrap_err(),
            Error::Shape(
                "the directed edge 3 -> 1 occurs twice: in simplices[1] and simplices[2]".into()
            )
        );
        let flat = adjacency(&[[0, 1, 1]], 2, &Watch::idle()).unwrap_err();
        assert_eq!(
            flat,
            Error::Shape("simplices[0] = [0, 1, 1] has vertex 1 twice".into())
        );
    }

    #[test]
    fn a_mesh_has_ghosts_all_around() {
        let (mut mesh, ghost) = mesh(&SQUARE, None, 4, &Watch::idle()).unwrap();
        let patch = mesh.patch();
        patch.check(6).unwrap();
        let ring: Vec<_> = (0..4)
            .scan(ghost, |at, _| Some(std::mem::replace(at, patch.after(*at))))
            .collect();
        assert_eq!(patch.after(ring[3]), ghost);
        let mut heads: Vec<_> = ring.iter().map(|&g| patch.head(g)).collect();
        heads.sort_unstable();
        assert_eq!(heads, [0, 1, 2, 3]);
    }

    #[test]
    fn given_neighbors_make_the_same_mesh_if_they_are_right() {
        let right = [[1, -1, -1], [-1, 0, -1]];
        let (mut given, _) = mesh(&SQUARE, Some(&right), 4, &Watch::idle()).unwrap();
        let (mut found, _) = mesh(&SQUARE, None, 4, &Watch::idle()).unwrap();
        let (given, found) = (given.patch(), found.patch());
        for code in (0..6).flat_map(|t| [8 * t, 8 * t + 1, 8 * t + 2]) {
            assert_eq!(given.opposite(code), found.opposite(code));
        }
        for wrong in [[[-1, 1, -1], [-1, 0, -1]], [[1, -1, -1], [0, -1, -1]]] {
            assert!(mesh(&SQUARE, Some(&wrong), 4, &Watch::idle()).is_err());
        }
    }

    #[test]
    fn triangles_that_do_not_tile_a_hull_are_rejected() {
        assert!(mesh(&[[0, 1, 2], [2, 3, 4]], None, 5, &Watch::idle()).is_err());
    }
}
