//! Live triangulations: points are inserted, removed and moved, and every state is canonical.

pub mod chunks;
