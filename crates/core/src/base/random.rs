//! Numbers for tests, the same on all systems.

/// Numbers from 0 to 1, with 53 bits, by D. E. Knuth's linear congruential generator MMIX.
pub fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}
