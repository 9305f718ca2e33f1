//! Orders of points along a space-filling curve: neighbours in the order are near in the plane, so
//! what walks from one to the next stays in the cache. Knows no mesh.

pub mod curve;
mod hilbert;
mod radix;
