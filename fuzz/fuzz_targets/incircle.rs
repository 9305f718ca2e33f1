//! All stages of `incircle`, and its canonical ties, compared with arbitrary-precision integers.

#![no_main]

use delone_fuzz::{check, oracle};
use delone_predicates::incircle_canonical;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let canonical = |[a, b, c, d]: [_; 4]| incircle_canonical(a, b, c, d);
    check(&oracle::INCIRCLE, Some(canonical), bytes);
});
