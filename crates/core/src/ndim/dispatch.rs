//! Dispatches the insertion of points, and walks to queries, to code compiled for AVX-512, AVX2 or neither.
//!
//! Rows of matrices are padded to 4 or 8 doubles, one register of AVX2 or AVX-512. The source is the same;
//! no multiply-adds are fused, so all round alike, and an uncertain test is uncertain on every processor.
//! The feature `baseline` leaves out the first two.
//!
//! The `unsafe` here is a call of code compiled for a processor feature that was just detected. It
//! is worthwhile: 5,000 uniform points in 5-D take 2.33 s without it, and 1.95 s with AVX-512.
//! In 4-D and 8-D it saves about 4 %, in 6-D nothing that can be measured. With AVX2, and with the steps of
//! `walk` that invert no matrix, queries take 0.85, 0.70, 0.49 and 0.60 of the time in 4-D, 5-D, 6-D and 8-D.

use super::cavity;
use super::cell::Mesh;
use super::walk;
use crate::base::arrays::Given;
use crate::base::error::Result;
use crate::base::watch::Pace;
use crate::locate::Located;

/// Inserts the points of `order` that are not `used` into a mesh.
#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
#[allow(unsafe_code)]
pub fn insert_all<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    order: &[u32],
    used: &[bool],
    pace: &mut Pace,
) -> Result<()> {
    if has_avx512() {
        // SAFETY: the processor has these features; every test that builds a triangulation on one
        // that does goes through here.
        unsafe { insert_with_avx512(mesh, order, used, pace) }
    } else if has_avx2() {
        // SAFETY: likewise.
        unsafe { insert_with_avx2(mesh, order, used, pace) }
    } else {
        cavity::insert_all(mesh, order, used, pace)
    }
}

#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,bmi2")]
fn insert_with_avx512<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    order: &[u32],
    used: &[bool],
    pace: &mut Pace,
) -> Result<()> {
    cavity::insert_all(mesh, order, used, pace)
}

#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
#[target_feature(enable = "avx2,bmi2")]
fn insert_with_avx2<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    order: &[u32],
    used: &[bool],
    pace: &mut Pace,
) -> Result<()> {
    cavity::insert_all(mesh, order, used, pace)
}

/// Walks from simplex `from` to `q`.
#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
#[allow(unsafe_code)]
pub fn walk<const D: usize, const N: usize, const P: usize>(
    given: &Given<D, N>,
    from: usize,
    q: &[f64; D],
) -> Located<N> {
    if has_avx512() {
        // SAFETY: the processor has these features; every test that locates points on one that does
        // goes through here.
        unsafe { walk_with_avx512::<D, N, P>(given, from, q) }
    } else if has_avx2() {
        // SAFETY: likewise.
        unsafe { walk_with_avx2::<D, N, P>(given, from, q) }
    } else {
        walk::walk::<D, N, P>(given, from, q)
    }
}

/// Walks from simplex `from` to `q`.
#[cfg(any(not(target_arch = "x86_64"), feature = "baseline"))]
pub fn walk<const D: usize, const N: usize, const P: usize>(
    given: &Given<D, N>,
    from: usize,
    q: &[f64; D],
) -> Located<N> {
    walk::walk::<D, N, P>(given, from, q)
}

/// Whether the processor has what `insert_with_avx512` and `walk_with_avx512` use.
#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("bmi2")
}

/// The same for AVX2.
#[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2")
}

/// Inserts the points of `order` that are not `used` into a mesh.
#[cfg(any(not(target_arch = "x86_64"), feature = "baseline"))]
pub fn insert_all<const D: usize, const V: usize, const P: usize>(
    mesh: &mut Mesh<D, V, P>,
    order: &[u32],
    used: &[bool],
    pace: &mut Pace,
) -> Result<()> {
    cavity::insert_all(mesh, order, used, pace)
}

macro_rules! walks {
    ($name:ident, $features:literal) => {
        #[cfg(all(target_arch = "x86_64", not(feature = "baseline")))]
        #[target_feature(enable = $features)]
        fn $name<const D: usize, const N: usize, const P: usize>(
            given: &Given<D, N>,
            from: usize,
            q: &[f64; D],
        ) -> Located<N> {
            walk::walk::<D, N, P>(given, from, q)
        }
    };
}

walks!(walk_with_avx512, "avx512f,avx512vl,avx512dq,avx512bw,bmi2");
walks!(walk_with_avx2, "avx2,bmi2");
