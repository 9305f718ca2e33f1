//! Whether the boundary of a tiling is convex, so that nothing lies beyond what is strictly outside.

use delone_predicates::{Sign, orient3d};

use super::tiling::{FACES, Side, Tetrahedra};

/// Whether the boundary faces are one surface that is convex at each edge: then it is the convex hull
/// (Tietze's theorem), and all other tetrahedra are inside of it.
pub fn is_convex(given: &Tetrahedra) -> bool {
    let sides: Vec<Side> = (0..given.simplices.len())
        .flat_map(|simplex| (0..4).map(move |corner| Side { simplex, corner }))
        .filter(|side| given.neighbors[side.simplex][side.corner] < 0)
        .collect();
    let Some(&first) = sides.first() else {
        return false;
    };
    let mut met = vec![false; sides.len()];
    let mut open = vec![first];
    met[0] = true;
    let mut count = 1;
    while let Some(side) = open.pop() {
        let [a, b, c] = FACES[side.corner].map(|corner| Side { corner, ..side });
        for (u, v, w) in [(a, b, c), (b, c, a), (c, a, b)] {
            let Some(next) = around_edge(given, side, w) else {
                return false;
            };
            let [u, v, w] = [u, v, w].map(|s| given.point(given.vertex(s)));
            let shared = given.simplices[side.simplex];
            for corner in FACES[next.corner] {
                let far = given.vertex(Side { corner, ..next });
                // Seen from outside, faces are counter-clockwise; what is positive is beyond.
                let beyond = orient3d(u, v, w, given.point(far));
                if !shared.contains(&far) && beyond == Sign::Positive {
                    return false;
                }
            }
            let Ok(i) = sides.binary_search(&next) else {
                return false;
            };
            if !met[i] {
                met[i] = true;
                count += 1;
                open.push(next);
            }
        }
    }
    count == sides.len()
}

/// The boundary face on the other side of the edge of `side` opposite its corner `w`, through the
/// tetrahedra around the edge; nothing where these go in circles.
fn around_edge(given: &Tetrahedra, side: Side, w: Side) -> Option<Side> {
    // The edge is opposite the corners side.corner and w.corner: leave across the face opposite w.
    let mut exit = w.corner;
    let mut entry = side.corner;
    let mut simplex = side.simplex;
    for _ in 0..given.simplices.len() {
        let leave = Side {
            simplex,
            corner: exit,
        };
        let Some(next) = given.beyond(leave) else {
            return Some(leave);
        };
        // In the next one the edge is opposite the corner across, and the vertex at the old entry.
        let pivot = given.simplices[simplex][entry];
        exit = given.simplices[next.simplex]
            .iter()
            .position(|&v| v == pivot)?;
        entry = next.corner;
        simplex = next.simplex;
    }
    None
}
