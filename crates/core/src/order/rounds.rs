//! Insertion in rounds, so that early points are spread out and the curve keeps each round in the
//! cache.
//!
//! N. Amenta, S. Choi and G. Rote, "Incremental constructions con BRIO" (2003), choose the rounds at
//! random; with strides along the curve there are no random choices.

/// The numbers below n in rounds of falling strides, each number once.
pub struct Rounds<const K: usize> {
    /// Falling; each divides the one before, and the last is 1.
    strides: [u32; K],
    n: u32,
    round: usize,
    at: u32,
}

impl<const K: usize> Rounds<K> {
    /// The numbers below `n`.
    pub fn over(n: u32, strides: [u32; K]) -> Self {
        let (round, at) = (0, 0);
        Self {
            strides,
            n,
            round,
            at,
        }
    }
}

impl<const K: usize> Iterator for Rounds<K> {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        loop {
            let stride = *self.strides.get(self.round)?;
            let i = self.at;
            if i >= self.n {
                self.round += 1;
                self.at = 0;
                continue;
            }
            self.at += stride;
            if self.round == 0 || !i.is_multiple_of(self.strides[self.round - 1]) {
                return Some(i);
            }
        }
    }
}

/// A bijection of numbers whose bits serve as coins: the finalizer of G. Steele, D. Lea and
/// C. Flood's "SplitMix" (2014), with Stafford's thirteenth set of constants.
pub fn random(v: u32) -> u64 {
    let x = (u64::from(v) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_name_each_number_once() {
        for n in [0, 1, 2, 15, 16, 17, 63, 64, 65, 1000] {
            let expected: Vec<u32> = (0..n).collect();
            let mut three: Vec<u32> = Rounds::over(n, [64, 8, 1]).collect();
            let mut two: Vec<u32> = Rounds::over(n, [16, 1]).collect();
            assert!(n < 17 || (two[1], three[1]) == (16, if n > 64 { 64 } else { 8 }));
            three.sort_unstable();
            two.sort_unstable();
            assert_eq!((&two, &three), (&expected, &expected));
        }
    }
}
