//! Where smoothing moves the vertices of triangles and tetrahedra.

/// Where vertices move to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The centroid of the Voronoi cell, as far as the simplices of the vertex cover it.
    Lloyd,
    /// The mean of the circumcenters of its simplices, weighted by area or volume.
    Odt,
    /// The mean of its neighbors.
    Laplace,
}

impl Target {
    /// The names of the targets.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("lloyd", Self::Lloyd),
        ("odt", Self::Odt),
        ("laplace", Self::Laplace),
    ];

    /// The target with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES
            .iter()
            .find(|(n, _)| *n == name)
            .map(|&(_, target)| target)
    }
}
