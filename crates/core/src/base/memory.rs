//! Fallible allocation: if memory is not available, the core reports an error and never aborts.
//!
//! Large arrays ask the kernel for huge pages. In a triangulation of a million points, the first
//! touch of fresh memory costs 40 ns per point with 4 KiB pages and 20 ns with 2 MiB pages: hence
//! the `unsafe` below.

use std::collections::HashMap;
use std::hash::Hash;

use crate::base::error::{Error, Result};

/// Arrays smaller than this, a huge page, do not ask for huge pages.
const HUGE_FROM: usize = 1 << 21;

/// An empty vector with room for `n` items.
pub fn with_room<T>(n: usize) -> Result<Vec<T>> {
    let bytes = n.saturating_mul(size_of::<T>());
    let mut v = Vec::new();
    v.try_reserve_exact(n)
        .map_err(|_| Error::Memory { bytes })?;
    if bytes >= HUGE_FROM {
        huge::advise(v.spare_capacity_mut());
    }
    Ok(v)
}

/// Appends `x` to `v`.
#[inline]
pub fn push<T>(v: &mut Vec<T>, x: T) -> Result<()> {
    make_room(v, 1)?;
    v.push(x);
    Ok(())
}

/// Reserves room for `n` more items at the end of `v`. Growth is amortized, as for `Vec::push`.
#[inline]
pub fn make_room<T>(v: &mut Vec<T>, n: usize) -> Result<()> {
    if v.capacity() - v.len() < n {
        let bytes = (v.len() + n).saturating_mul(size_of::<T>());
        v.try_reserve(n).map_err(|_| Error::Memory { bytes })?;
    }
    Ok(())
}

/// Reserves room for one more entry.
pub fn room_for_one<K: Eq + Hash, V>(map: &mut HashMap<K, V>) -> Result<()> {
    let bytes = (map.len() + 1).saturating_mul(size_of::<(K, V)>());
    map.try_reserve(1).map_err(|_| Error::Memory { bytes })
}

/// A copy of `items`.
pub fn copied<T: Clone>(items: &[T]) -> Result<Vec<T>> {
    let mut v = with_room(items.len())?;
    v.extend_from_slice(items);
    Ok(v)
}

/// Empties `v` and gives it room for `n` items.
pub fn clear_with_room<T>(v: &mut Vec<T>, n: usize) -> Result<()> {
    v.clear();
    if v.capacity() < n {
        *v = with_room(n)?;
    }
    Ok(())
}

/// A vector of `n` copies of `value`.
pub fn filled<T: Clone>(n: usize, value: T) -> Result<Vec<T>> {
    let mut v = with_room(n)?;
    v.resize(n, value);
    Ok(v)
}

/// `value` on the heap.
pub fn boxed<T>(value: T) -> Result<Box<[T; 1]>> {
    let mut v = with_room(1)?;
    v.push(value);
    let bytes = size_of::<T>();
    v.into_boxed_slice()
        .try_into()
        .map_err(|_| Error::Memory { bytes })
}

/// Whether `bytes` more seem to be available. A system may promise memory that it does not have,
/// and kill the process that uses it. Known on Linux only; elsewhere the allocator decides.
pub fn is_plausible(bytes: usize) -> bool {
    let Ok(text) = std::fs::read_to_string("/proc/meminfo") else {
        return true;
    };
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"));
    let kilobytes = line.and_then(|l| l.split_whitespace().next()?.parse::<usize>().ok());
    kilobytes.is_none_or(|available| bytes / 1024 <= available)
}

/// Types for which all zero bytes are a valid value, namely zero.
///
/// # Safety
/// Zero bytes must be a valid value.
#[allow(unsafe_code)]
pub unsafe trait Zero: Copy {}

#[allow(unsafe_code)]
mod zero {
    // SAFETY: an integer.
    unsafe impl super::Zero for u16 {}
    // SAFETY: an integer.
    unsafe impl super::Zero for u32 {}
    // SAFETY: an integer.
    unsafe impl super::Zero for u64 {}
    // SAFETY: an integer.
    unsafe impl super::Zero for i32 {}
    // SAFETY: a double, whose zero bytes are 0.0.
    unsafe impl super::Zero for f64 {}
    // SAFETY: items of which zero bytes are a value, without padding between them.
    unsafe impl<T: super::Zero, const N: usize> super::Zero for [T; N] {}
}

/// A vector of `n` zeros that touches no page: each is touched first by the thread that fills it.
#[allow(unsafe_code)]
pub fn zeroed<T: Zero>(n: usize) -> Result<Vec<T>> {
    use std::alloc::{Layout, alloc_zeroed};
    let bytes = n.saturating_mul(size_of::<T>());
    if n == 0 {
        return Ok(Vec::new());
    }
    let layout = Layout::array::<T>(n).map_err(|_| Error::Memory { bytes })?;
    // SAFETY: the layout is not empty. Zero bytes are a valid T, the pointer comes from the
    // global allocator with the layout of a vector of n items, and null is caught before use.
    let mut v = unsafe {
        let start = alloc_zeroed(layout).cast::<T>();
        if start.is_null() {
            return Err(Error::Memory { bytes });
        }
        Vec::from_raw_parts(start, n, n)
    };
    if bytes >= HUGE_FROM {
        huge::advise(&mut v);
    }
    Ok(v)
}

/// The same rows in the same memory, as signed numbers with the same bits.
#[allow(unsafe_code)]
pub fn signed<const N: usize>(rows: Vec<[u32; N]>) -> Vec<[i32; N]> {
    let mut rows = std::mem::ManuallyDrop::new(rows);
    let (start, length, capacity) = (rows.as_mut_ptr(), rows.len(), rows.capacity());
    // SAFETY: u32 and i32 have the same size and alignment, and each bit pattern of one is a value
    // of the other; so a vector of one is a vector of the other. The first one is never dropped.
    unsafe { Vec::from_raw_parts(start.cast(), length, capacity) }
}

#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
mod huge {
    /// Asks for huge pages for `memory`; a refusal affects speed only.
    pub fn advise<T>(memory: &mut [T]) {
        const PAGE: usize = 4096;
        let range = memory.as_mut_ptr_range();
        let start = range.start.addr().next_multiple_of(PAGE);
        let end = range.end.addr() & !(PAGE - 1);
        let first = range.start.with_addr(start);
        // SAFETY: the range consists of whole pages inside memory that this call borrows mutably,
        // and MADV_HUGEPAGE changes neither contents nor protection. The test below guards this.
        let _ =
            unsafe { libc::madvise(first.cast(), end.saturating_sub(start), libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
mod huge {
    /// On other systems, the system decides.
    pub fn advise<T>(_memory: &mut [T]) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_arrays_hold_what_is_written() {
        let v = filled(HUGE_FROM / 4 + 3, 0x1234_5678u32).unwrap();
        assert!(v.iter().all(|&x| x == 0x1234_5678));
        assert!(
            zeroed(HUGE_FROM / 4 + 3)
                .unwrap()
                .iter()
                .all(|&x: &u32| x == 0)
        );
        assert!(zeroed::<u64>(0).unwrap().is_empty());
    }

    #[test]
    fn signed_rows_have_the_same_bits() {
        let mut rows = with_room(9).unwrap();
        rows.extend([[0, 1], [u32::MAX, 1 << 31]]);
        let start = rows.as_ptr().addr();
        let rows = signed(rows);
        assert_eq!(rows, [[0, 1], [-1, i32::MIN]]);
        assert_eq!((rows.as_ptr().addr(), rows.capacity()), (start, 9));
        assert!(signed::<3>(Vec::new()).is_empty());
    }

    #[test]
    fn a_boxed_value_is_where_it_was_put() {
        assert_eq!(boxed([7u64; 9]).unwrap()[0], [7; 9]);
        assert_eq!(*boxed(()).unwrap(), [()]);
    }

    #[test]
    fn no_machine_has_all_memory() {
        assert!(is_plausible(1 << 20));
        assert!(!is_plausible(usize::MAX) || cfg!(not(target_os = "linux")));
    }

    #[test]
    fn refused_memory_is_an_error() {
        assert!(matches!(
            with_room::<u64>(1 << 60),
            Err(Error::Memory { .. })
        ));
        assert!(matches!(
            filled(usize::MAX, 0u64),
            Err(Error::Memory { .. })
        ));
    }
}
