//! Clouds around one feature: a hole, a slit, two sheets close to each other.
//!
//! A [`Feature`] is a surface in R^3 whose one feature has a size that can be chosen, down to below what
//! points can show. What is known of it: its Betti numbers, its area, and the places where the feature is,
//! so that a [`FeatureCloud`] can say how large the feature is in spacings of its own points there.
//! Tests and the hunt for wrong meshes draw from the same list.

mod curves;
mod feature;
mod plates;
mod solids;

pub use feature::{Drawing, Feature, FeatureCloud, Spot};

impl Feature {
    /// All there are.
    pub fn all() -> impl Iterator<Item = Self> {
        let lists = [plates::ALL, solids::ALL, curves::ALL];
        lists.into_iter().flatten().copied()
    }

    /// The one of this name.
    pub fn find(name: &str) -> Option<Self> {
        Self::all().find(|feature| feature.name == name)
    }
}

#[cfg(test)]
mod tests;
