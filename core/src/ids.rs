//! Numbers that name things, as types.
//!
//! A row of the cloud, a landmark and a label of a fit are small whole numbers, all counted from 0. Two of them
//! often stand side by side (the row that a landmark stands for, the label of a row), and the mistake that follows is
//! always the same: an array of one kind is asked with a number of the other, which is in range, so that nothing fails
//! and a mesh is wrong. As types they cannot be mixed up: a [`Table`] that has one entry for every landmark
//! is asked with a [`Landmark`] alone.
//!
//! # Where there are types, and where there are none
//! Types begin where two numberings meet. A metric, an oracle, an estimator and a selector see one set of points, which they
//! number from 0 as slices do; there is nothing to mix up, so their traits take `usize`, and the stages behind
//! them say what the numbers are ([`Neighbor::row`](crate::Neighbor::row)). A [`Complex`](crate::Complex) has one kind of number too, its own vertices.
//!
//! An id is as large as the number in it, and is written to files as that number.

use serde::{Deserialize, Serialize};
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Index, IndexMut};

/// A number that names one of many things of a kind, counted from 0.
pub trait Id: Copy + Ord + Debug {
    /// The id of the thing at a position.
    fn new(index: usize) -> Self;

    /// The position that it names.
    fn index(self) -> usize;
}

/// Makes a type of its own out of a number: `id! { /// What it names. pub struct Name(u32); }`.
#[macro_export]
macro_rules! id {
    ($(#[$doc:meta])* $visible:vis struct $name:ident($number:ty);) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        $visible struct $name($number);

        #[allow(dead_code)]
        impl $name {
            /// The id of the thing at a position.
            #[inline]
            $visible const fn new(index: usize) -> Self {
                debug_assert!(index <= <$number>::MAX as usize);
                Self(index as $number)
            }

            /// The position that it names.
            #[inline]
            $visible const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl $crate::Id for $name {
            #[inline]
            fn new(index: usize) -> Self {
                Self::new(index)
            }

            #[inline]
            fn index(self) -> usize {
                self.index()
            }
        }

        impl From<$number> for $name {
            #[inline]
            fn from(number: $number) -> Self {
                Self(number)
            }
        }

        impl From<$name> for $number {
            #[inline]
            fn from(id: $name) -> Self {
                id.0
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(&self.0, f)
            }
        }
    };
}

id! {
    /// A row of the cloud that is worked on: a point.
    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Row(u32);
}

id! {
    /// A landmark, by its place in the waist.
    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Landmark(u32);
}

id! {
    /// Which stratum of a decomposition a point is in, by its place in the list of strata. It is neither a dimension nor
    /// a number of cells, which are small numbers too.
    #[derive(Serialize, Deserialize)]
    #[serde(transparent)]
    pub struct Label(u8);
}

/// One entry for every thing of a kind, in the order of their ids: a list that only that kind of id can ask.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Table<I, T> {
    entries: Vec<T>,
    #[serde(skip)]
    asked_by: PhantomData<I>,
}

impl<I: Id, T> Table<I, T> {
    /// So many entries, all the same.
    pub fn filled(count: usize, entry: T) -> Self
    where
        T: Clone,
    {
        vec![entry; count].into()
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is no entry.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds an entry, and returns what it is asked with.
    pub fn push(&mut self, entry: T) -> I {
        self.entries.push(entry);
        I::new(self.entries.len() - 1)
    }

    /// The entry of `id`; `None` where there is none.
    pub fn get(&self, id: I) -> Option<&T> {
        self.entries.get(id.index())
    }

    /// The entry of `id`, to be changed; `None` where there is none.
    pub fn get_mut(&mut self, id: I) -> Option<&mut T> {
        self.entries.get_mut(id.index())
    }

    /// What the entries are asked with, in order.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = I> + DoubleEndedIterator + use<I, T> {
        (0..self.entries.len()).map(I::new)
    }

    /// The entries in order.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.entries.iter()
    }

    /// The entries in order, to be changed.
    pub fn iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
        self.entries.iter_mut()
    }

    /// The entries in order, each with what it is asked with.
    pub fn each(&self) -> impl ExactSizeIterator<Item = (I, &T)> + DoubleEndedIterator {
        let ids = (0..self.entries.len()).map(I::new);
        ids.zip(&self.entries)
    }

    /// Whether one of the entries is this one. O(n).
    pub fn contains(&self, entry: &T) -> bool
    where
        T: PartialEq,
    {
        self.entries.contains(entry)
    }

    /// Leaves so many entries, the first ones.
    pub fn truncate(&mut self, count: usize) {
        self.entries.truncate(count);
    }

    /// The entries, for whoever needs no ids.
    pub fn as_slice(&self) -> &[T] {
        &self.entries
    }

    /// The entries, for whoever needs no ids, to be changed.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.entries
    }
}

impl<I, T> Default for Table<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T> From<Vec<T>> for Table<I, T> {
    fn from(entries: Vec<T>) -> Self {
        Self {
            entries,
            asked_by: PhantomData,
        }
    }
}

impl<I, T> FromIterator<T> for Table<I, T> {
    fn from_iter<E: IntoIterator<Item = T>>(entries: E) -> Self {
        Vec::from_iter(entries).into()
    }
}

impl<I, T> Extend<T> for Table<I, T> {
    fn extend<E: IntoIterator<Item = T>>(&mut self, entries: E) {
        self.entries.extend(entries);
    }
}

impl<'t, I, T> IntoIterator for &'t Table<I, T> {
    type Item = &'t T;
    type IntoIter = std::slice::Iter<'t, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.entries.iter()
    }
}

impl<I, T> IntoIterator for Table<I, T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.entries.into_iter()
    }
}

impl<I: Id, T> Index<I> for Table<I, T> {
    type Output = T;

    #[inline]
    fn index(&self, id: I) -> &T {
        &self.entries[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for Table<I, T> {
    #[inline]
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.entries[id.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_its_number_in_memory_and_in_files() {
        assert_eq!(size_of::<Row>(), size_of::<u32>());
        let table: Table<Row, Row> = [3, 1].map(Row::new).into_iter().collect();
        let file = serde_json::to_string(&table).unwrap();
        assert_eq!(file, "[3,1]");
        assert_eq!(
            serde_json::from_str::<Table<Row, Row>>(&file).unwrap(),
            table
        );
        assert_eq!(Row::new(7).to_string(), "7");
    }

    #[test]
    fn a_table_is_asked_with_ids() {
        let mut table: Table<Row, char> = Table::filled(2, 'a');
        let last = table.push('b');
        assert_eq!((last, table[last], table.len()), (Row::new(2), 'b', 3));
        table[Row::new(0)] = 'c';
        assert_eq!(table.get(Row::new(3)), None);
        let each: Vec<(usize, char)> = table.each().map(|(row, &x)| (row.index(), x)).collect();
        assert_eq!(each, [(0, 'c'), (1, 'a'), (2, 'b')]);
        assert!(table.ids().map(Row::index).eq(0..3));
    }
}
