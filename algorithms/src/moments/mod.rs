//! Moments of all balls of a cloud at once: the first step of the method, fast and exact.
mod decide;
mod frame;
mod group;
mod packed;
mod placement;
mod reach;
mod tree;
#[cfg(test)]
mod tests;

use crate::dimension::PrincipalComponents;
use crate::execute::{self, Execute};
use crosscap_core::{Error, PointCloud, Scalar};
use group::{Group, Sweep, groups};
use reach::Reach;
use tree::Tree;

/// Number of points and dimension of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LocalDimension {
    /// Points in the ball, its center among them.
    pub count: u32,
    /// Smallest d whose tail share of the variance is below the tolerance; 0 where all points coincide.
    pub dimension: u32,
}

/// A tree.
pub struct MomentTree<'a, S> {
    cloud: &'a PointCloud<S>,
    tree: Tree,
}

impl<'a, S: Scalar> MomentTree<'a, S> {
    /// Builds.
    pub fn new(cloud: &'a PointCloud<S>) -> Result<Self, Error> {
        Ok(Self { cloud, tree: Tree::new(cloud) })
    }

    /// Dimensions.
    pub fn dimensions(&self, eps: f64, dt: f64, execute: &dyn Execute) -> Result<Vec<LocalDimension>, Error> {
        PrincipalComponents::<f64>::new(dt)?;
        let reach = Reach::new(&self.tree, self.cloud, eps)?;
        match self.tree.leaf {
            8 => Ok(self.dimensions_in::<8>(&reach, dt, execute)),
            _ => Ok(self.dimensions_in::<16>(&reach, dt, execute)),
        }
    }

    fn dimensions_in<const L: usize>(&self, reach: &Reach<'_, S>, dt: f64, execute: &dyn Execute) -> Vec<LocalDimension> {
        let groups = groups(reach);
        let found = execute::map(
            execute,
            groups.len(),
            || Sweep::<S, L>::new(reach),
            |sweep, g| {
                if g % 64 == 0 {
                    sweep.forget();
                }
                let mut out = Vec::with_capacity((groups[g].end - groups[g].start) as usize);
                sweep.dimensions(groups[g], dt, &mut out);
                out
            },
        );
        let mut dimensions = vec![LocalDimension { count: 0, dimension: 0 }; self.cloud.len()];
        for (&row, (count, dimension)) in self.tree.order.iter().zip(found.into_iter().flatten()) {
            dimensions[row as usize] = LocalDimension { count, dimension };
        }
        dimensions
    }
}

/// The dimension test on a spectrum, largest variance first.
fn dimension_of(variances: &[f64], dt: f64) -> u32 {
    PrincipalComponents::<f64>::new(dt).map_or(0, |test| test.dimension_of(variances).0 as u32)
}
