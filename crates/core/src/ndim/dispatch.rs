//! Dispatches insertion and walks to code compiled for AVX-512, AVX2 or neither.
//!
//! Rows of matrices are padded to 4 or 8 doubles, one vector of AVX2 or AVX-512. The source is the same;
//! no multiply-adds are fused, so all round alike, and what is uncertain is so on every processor. The
//! feature `baseline` leaves out the first two.
//!
//! The `unsafe` here is a call of code compiled for a processor feature that was just detected. It
//! pays: benchmarks/README.md has the times with and without it.

/// Defines a function that calls another one, compiled for the features of the processor.
macro_rules! dispatched {
    (
        $(#[$about:meta])*
        pub fn $name:ident <$(const $C:ident),*> ($($argument:ident : $kind:ty),* $(,)?) -> $out:ty
        = $work:path;
    ) => {
        $(#[$about])*
        #[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
        #[allow(unsafe_code)]
        pub fn $name<$(const $C: usize),*>($($argument: $kind),*) -> $out {
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,bmi2")]
            fn with_avx512<$(const $C: usize),*>($($argument: $kind),*) -> $out {
                $work($($argument),*)
            }

            #[target_feature(enable = "avx2,bmi2")]
            fn with_avx2<$(const $C: usize),*>($($argument: $kind),*) -> $out {
                $work($($argument),*)
            }

            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("bmi2")
            {
                // SAFETY: the processor has these features; every test that builds a triangulation
                // on one that does goes through here.
                unsafe { with_avx512::<$($C),*>($($argument),*) }
            } else if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2") {
                // SAFETY: likewise.
                unsafe { with_avx2::<$($C),*>($($argument),*) }
            } else {
                $work($($argument),*)
            }
        }

        $(#[$about])*
        #[cfg(any(not(target_arch = "x86_64"), feature = "baseline"))]
        pub fn $name<$(const $C: usize),*>($($argument: $kind),*) -> $out {
            $work($($argument),*)
        }
    };
}

use super::cell::Mesh;
use super::{cavity, walk, wrapping};
use crate::arrays::Given;
use crate::error::Result;
use crate::locate::Located;
use crate::watch::Pace;

dispatched! {
    /// Inserts the points of `order` that are not `used` into a mesh.
    pub fn insert_all<const D, const V, const P>(
        mesh: &mut Mesh<D, V, P>,
        order: &[u32],
        used: &[bool],
        pace: &mut Pace,
    ) -> Result<()> = cavity::insert_all::<D, V, P>;
}

dispatched! {
    /// Inserts the points that are outside into the hull of the first ones.
    pub fn wrap<const D, const V, const P>(
        mesh: &mut Mesh<D, V, P>,
        points: &[u32],
        pace: &mut Pace,
    ) -> Result<()> = wrapping::wrap::<D, V, P>;
}

dispatched! {
    /// Walks from simplex `from` to `q`.
    pub fn walk<const D, const N, const P>(
        given: &Given<D, N>,
        from: usize,
        q: &[f64; D],
    ) -> Located<N> = walk::walk::<D, N, P>;
}
