//! The kinds of natural neighbor interpolation.

/// The kind of weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Areas.
    Sibson,
    /// Lengths over distances.
    Laplace,
    /// Areas and gradients, by Sibson's blend: C1 except at the sites.
    Sibson1,
    /// Areas and gradients, by Farin's cubic: C1.
    Farin,
}

impl Kind {
    /// The kinds by name.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("sibson", Self::Sibson),
        ("laplace", Self::Laplace),
        ("sibson1", Self::Sibson1),
        ("farin", Self::Farin),
    ];

    /// The kind of that name.
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMES.iter().find(|(n, _)| *n == name);
        found.map(|&(_, kind)| kind)
    }

    /// Whether it takes gradients.
    pub fn is_smooth(self) -> bool {
        matches!(self, Self::Sibson1 | Self::Farin)
    }
}
