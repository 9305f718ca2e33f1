//! All stages of `orient3d` compared with arbitrary-precision integers.

#![no_main]

use delone_fuzz::{check, oracle};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| check(&oracle::ORIENT3D, None, bytes));
