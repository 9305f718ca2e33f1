//! All stages of `insphere`, and its canonical ties, compared with arbitrary-precision integers.

#![no_main]

use delone_fuzz::{check, oracle};
use delone_predicates::insphere_canonical;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let canonical = |[a, b, c, d, e]: [_; 5]| insphere_canonical(a, b, c, d, e);
    check(&oracle::INSPHERE, Some(canonical), bytes);
});
