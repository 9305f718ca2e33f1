//! Surfaces of triangles in 3-D: whether they are closed, oriented and manifold, which volume and
//! regions they enclose, and all pairs of triangles that cross or touch, exactly.
//!
//! Equal points are one vertex. Degenerate triangles and repeated ones are reported and left out.
//! If no pair crosses, triangles that touch are subdivided at vertices first, so that triangles
//! have only vertices and edges in common; edges, fans, components and regions are those of the
//! result. Otherwise they are those of the triangles as given.

mod clean;
mod contact;
pub(crate) mod edges;
mod fans;
pub(crate) mod meeting;
mod pairs;
mod resolve;
mod sides;
mod volume;

use delone_predicates::{Point3, Sign};

pub use self::clean::Clean;
pub use self::contact::{Contact, KINDS, Kind, Place, Triangle, contact};
pub use self::edges::EdgeFaults;
pub use self::pairs::{Pair, Pairs};
pub use self::resolve::{NONE, Resolved};

use self::edges::Edges;
use crate::base::error::{Error, Result};
use crate::base::memory::with_room;
use crate::base::watch::Watch;

/// The most triangles: half-edges are numbered with 32 bits.
const LIMIT: usize = 1 << 30;

/// Options of the caller.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The maximum number of pairs that are returned; all are counted.
    pub limit: usize,
    /// The number of threads.
    pub workers: usize,
}

/// What a surface is.
#[derive(Debug)]
pub struct Checked {
    /// Faults of single rows.
    pub clean: Clean,
    /// Pairs that cross or touch.
    pub pairs: Pairs,
    /// The triangles, subdivided if no pair crosses.
    pub resolved: Resolved,
    /// The number of edges.
    pub nedges: usize,
    /// Faults of edges.
    pub edges: EdgeFaults,
    /// Vertices whose triangles do not form one fan, ascending.
    pub not_fans: Vec<u32>,
    /// The component of each row of the input, -1 for degenerate triangles.
    pub component: Vec<i32>,
    /// The number of components.
    pub components: u32,
    /// The number of regions that are separated from the outside; `None` if pairs cross.
    pub regions: Option<u32>,
    /// The rows of which a part has the same region on both sides, ascending.
    pub dangling: Vec<u32>,
    /// The signed volume, correctly rounded.
    pub volume: f64,
    /// The exact sign of the volume.
    pub sign: Sign,
}

/// Checks a surface; `faces` must be rows of `points`.
pub fn check(
    points: &[Point3],
    faces: &[[i32; 3]],
    options: Options,
    watch: &Watch,
) -> Result<Checked> {
    let workers = options.workers;
    let (clean, pairs) = prepared(points, faces, options, watch)?;
    let crosses = pairs.crossing > 0;
    let resolved = if crosses {
        resolve::as_given(&clean, &clean.with_collinear(watch)?)?
    } else {
        resolve::resolve(points, &clean, &pairs.touching, workers, watch)?
    };
    let parts = &resolved.faces;
    let edges = Edges::of(parts, points.len(), watch)?;
    let not_fans = fans::not_fans(parts, &edges, points.len(), watch)?;
    let (labels, components) = sides::components(parts.len(), &edges, watch)?;
    let (regions, dangling) = if crosses {
        (None, Vec::new())
    } else {
        let (sets, dangling) = sides::regions(points, parts, &edges, watch)?;
        (Some(sets - components), rows_of(&resolved, dangling))
    };
    let mut component = with_room(faces.len())?;
    component.extend(resolved.place.iter().map(|&part| match part {
        NONE => -1,
        part => labels[part as usize],
    }));
    let (volume, sign) = volume::volume(points, &clean.faces, workers, watch)?;
    Ok(Checked {
        nedges: edges.each().count(),
        edges: edges.faults(parts, &resolved.net, watch)?,
        clean,
        pairs,
        resolved,
        not_fans,
        component,
        components,
        regions,
        dangling,
        volume,
        sign,
    })
}

/// Faults of single rows, and the pairs.
pub(crate) fn prepared(
    points: &[Point3],
    faces: &[[i32; 3]],
    Options { limit, workers }: Options,
    watch: &Watch,
) -> Result<(Clean, Pairs)> {
    if faces.len() > LIMIT {
        let found = faces.len();
        let message = format!("{found} faces exceed the limit of {LIMIT} for one surface");
        return Err(Error::Shape(message));
    }
    let clean = clean::clean(points, faces, watch)?;
    let pairs = pairs::pairs(points, &clean.faces, &clean.kept, limit, workers, watch)?;
    Ok((clean, pairs))
}

/// The triangles subdivided at vertices of others on them, each only once, without degenerate ones;
/// `None` if pairs cross, which are returned.
pub fn resolve_touches(
    points: &[Point3],
    faces: &[[i32; 3]],
    options: Options,
    watch: &Watch,
) -> Result<(Option<Resolved>, Pairs)> {
    let (clean, pairs) = prepared(points, faces, options, watch)?;
    if pairs.crossing > 0 {
        return Ok((None, pairs));
    }
    let made = resolve::resolve(points, &clean, &pairs.touching, options.workers, watch)?;
    Ok((Some(made), pairs))
}

/// The sources of parts, ascending, each once.
fn rows_of(resolved: &Resolved, mut parts: Vec<u32>) -> Vec<u32> {
    for part in &mut parts {
        *part = resolved.source[*part as usize];
    }
    parts.dedup();
    parts
}
