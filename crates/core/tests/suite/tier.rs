//! How many cases a test takes: some in `make test`, more in `make test-deep`.

/// `usual` cases, or `deep` ones where the environment variable `DELONE_DEEP` is set.
pub fn cases(usual: u32, deep: u32) -> u32 {
    match std::env::var_os("DELONE_DEEP") {
        Some(word) if !word.is_empty() => deep,
        _ => usual,
    }
}
