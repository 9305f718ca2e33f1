//! Union-find: disjoint sets that are joined (R. E. Tarjan, "Efficiency of a good but not linear set union
//! algorithm", 1975).

use crate::base::error::Result;
use crate::base::memory::{filled, with_room};

/// Disjoint sets of the numbers from 0 on. The smallest number of a set is its root.
#[derive(Debug, Clone, Default)]
pub struct Sets {
    /// The parent of each number, which is not larger; a root is its own.
    parents: Vec<u32>,
}

impl Sets {
    /// A set for each of `n` numbers.
    pub fn of(n: usize) -> Result<Self> {
        let mut parents = with_room(n)?;
        parents.extend(0..n as u32);
        Ok(Self { parents })
    }

    /// Sets by the parent of each number, which is not larger.
    pub fn with_parents(parents: Vec<u32>) -> Self {
        debug_assert!(
            parents
                .iter()
                .zip(0..)
                .all(|(&parent, number)| parent <= number)
        );
        Self { parents }
    }

    /// The root of a number; paths are halved.
    #[inline]
    pub fn root(&mut self, mut number: u32) -> u32 {
        loop {
            let above = self.parents[number as usize];
            if above == number {
                return number;
            }
            let next = self.parents[above as usize];
            self.parents[number as usize] = next;
            number = next;
        }
    }

    /// The root of a number, where paths stay as they are.
    #[inline]
    pub fn root_of(&self, mut number: u32) -> u32 {
        while self.parents[number as usize] != number {
            number = self.parents[number as usize];
        }
        number
    }

    /// Joins the sets of two numbers; returns whether they were different.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Makes the root the parent of each number: then all paths are as short as possible.
    pub fn flatten(&mut self) {
        for number in 0..self.parents.len() {
            // Parents are smaller, so this one has its root already.
            self.parents[number] = self.parents[self.parents[number] as usize];
        }
    }

    /// The set of each number that is kept, numbered by their first members, otherwise -1; and how many
    /// sets there are. The root of a number that is kept must be kept.
    pub fn numbered(&mut self, is_kept: impl Fn(usize) -> bool) -> Result<(Vec<i32>, usize)> {
        let mut found = filled(self.parents.len(), -1)?;
        let mut count = 0;
        for number in (0..self.parents.len()).filter(|&i| is_kept(i)) {
            let root = self.root(number as u32) as usize;
            found[number] = if root == number {
                count += 1;
                count - 1
            } else {
                found[root]
            };
        }
        Ok((found, count as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_numbered_by_their_first_members() {
        let mut sets = Sets::of(9).unwrap();
        let joined = [[7, 3], [3, 5], [8, 7], [1, 2], [5, 8]].map(|[a, b]| sets.join(a, b));
        assert_eq!(joined, [true, true, true, true, false]);
        let mut other = sets.clone();
        other.flatten();
        for number in 0..9 {
            let root = [0, 1, 1, 3, 4, 3, 6, 3, 3][number as usize];
            assert_eq!(sets.root_of(number), root);
            assert_eq!(other.parents[number as usize], root);
            assert_eq!(sets.root(number), root);
        }
        let (numbers, count) = sets.numbered(|i| i != 4).unwrap();
        assert_eq!(numbers, [0, 1, 1, 2, -1, 2, 3, 2, 2]);
        assert_eq!(count, 4);
    }

    #[test]
    fn many_sets_are_numbered_as_few() {
        // Numbers with the same remainder are one set.
        let mut sets = Sets::of(20_000).unwrap();
        for number in 7..20_000 {
            sets.join(number, number - 7);
        }
        let (numbers, count) = sets.numbered(|_| true).unwrap();
        assert_eq!(count, 7);
        assert!(
            numbers
                .iter()
                .enumerate()
                .all(|(i, &set)| set as usize == i % 7)
        );
    }
}
