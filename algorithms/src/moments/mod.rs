//! Moments of all balls of a cloud at once: the first step of the method, fast and exact.
//!
//! For every point the ball of radius eps about it (strict), the mean and covariance of what is
//! in it, and from them the dimension (Martin & Watson 2011, section 2.1). Neighborhoods overlap
//! nearly everywhere, so that adding up point after point does the same sums hundreds of times.
//! Here a tree keeps count, mean and scatter of its nodes; centers that lie together share the
//! sum over the nodes that are inside of all their balls, and only the points near the spheres
//! are looked at one by one.
//!
//! | idea | file |
//! | --- | --- |
//! | centering, principal axes, null directions | `placement` |
//! | the tree and the moments of its nodes | `tree`, `node`, `median` |
//! | when a point is inside, to the bit | `reach` |
//! | all balls about a few centers that lie together | `group` |
//! | leading directions of such a group | `frame` |
//! | the dimension from part of the spectrum, with proof | `decide` |
//! | the same in more than 64 coordinates, ball by ball | `wide` |
//! | dimension 2 for many balls at once, with proof | `settle`, `plane` |
//! | moments as they are handed out, in the coordinates of the data | `ball` |
//!
//! **What is exact.** Membership: that of `squared_distance(a, b).sqrt()`, rounded to the scalar of
//! the cloud, `< eps`; a filter in single precision decides where it provably can, the original
//! coordinates everywhere else. The dimension: that of
//! [`PrincipalComponents`](crate::dimension::PrincipalComponents), asked for the ball by itself. Where a tail share
//! equals the tolerance within 1e-9, the points of the ball are summed in the order of their rows, as it does; so the
//! answer is the same, to the bit, in any part of the cloud that holds the ball. In more than six dimensions balls are summed
//! in six directions and the rest is only bounded; where the bound leaves the answer open, the
//! full spectrum is computed. A covariance that would lose more than 1e-10 of its trace to
//! cancellation (points that nearly coincide, in a cloud that is wide) is summed again from the
//! original coordinates.
//!
//! The result depends neither on the number of threads nor on the processor.

mod ball;
mod decide;
mod frame;
mod group;
mod median;
mod node;
mod packed;
mod placement;
mod plane;
mod reach;
mod settle;
mod tree;
mod wide;

#[cfg(test)]
mod tests;

use crate::execute::{self, Execute, Serial};
use crate::spectrum::VarianceTolerance;
pub use ball::BallMoments;
use crosscap_core::{BallDimension, Error, PointCloud, Scalar};
use group::{Group, Sweep};
use reach::Reach;
use settle::{Settled, Settler};
use tree::Tree;

/// Magnitude of coordinates above which squared distances overflow.
const LARGEST_WIDE: f64 = 1e150;
const LARGEST_NARROW: f64 = 1e36;
/// Groups after which a sweep starts afresh, so that threads that start there find the same.
const RUN: usize = 64;

/// A cloud in a tree that knows the moments of its nodes.
///
/// Building takes `O(n log n)` distances, and memory for the coordinates once more and for
/// about `n / 8` matrices of order r(r + 1)/2, where r is the number of directions that the cloud extends in
/// (none of these above 64: there every ball is summed from its points).
///
/// ```
/// use crosscap_algorithms::execute::Serial;
/// use crosscap_algorithms::moments::MomentTree;
/// use crosscap_core::PointCloud;
/// // A square lattice in R^3.
/// let rows = (0..400).flat_map(|k| [f64::from(k % 20), f64::from(k / 20), 7.0]).collect();
/// let cloud = PointCloud::new(3, rows).unwrap();
/// let tree = MomentTree::new(&cloud).unwrap();
/// let found = tree.dimensions(2.0, 0.05, &Serial).unwrap();
/// assert_eq!((found[210].neighbors, found[210].dimension), (9, 2)); // strict: nobody at distance 2
/// ```
pub struct MomentTree<'a, S> {
    cloud: &'a PointCloud<S>,
    tree: Tree,
}

impl<'a, S: Scalar> MomentTree<'a, S> {
    /// Builds the tree in this thread.
    ///
    /// # Errors
    /// Those of [`MomentTree::with`].
    pub fn new(cloud: &'a PointCloud<S>) -> Result<Self, Error> {
        Self::with(cloud, &Serial)
    }

    /// Builds the tree, the same one whatever `execute` is.
    ///
    /// # Errors
    /// [`Error::Shape`] when there are more points than a `u32` can count, [`Error::Parameter`]
    /// when a coordinate is so large (above 1e36 for `f32`, 1e150 for `f64`) that squared distances overflow.
    pub fn with(cloud: &'a PointCloud<S>, execute: &dyn Execute) -> Result<Self, Error> {
        if u32::try_from(cloud.len()).is_err() {
            return Err(Error::Shape {
                found: format!("{} points", cloud.len()),
                expected: format!("at most {} points", u32::MAX),
            });
        }
        let limit = if S::of(1e100).is_finite() {
            LARGEST_WIDE
        } else {
            LARGEST_NARROW
        };
        if let Some(at) = cloud
            .coordinates()
            .iter()
            .position(|c| c.as_f64().abs() > limit)
        {
            let (row, column) = (at / cloud.dimension(), at % cloud.dimension());
            return Err(Error::Parameter {
                name: "coordinates",
                value: format!("{} in row {row}, column {column}", cloud.coordinates()[at]),
                expected: format!("magnitudes up to {limit:e} (rescale the data)"),
            });
        }
        Ok(Self {
            cloud,
            tree: Tree::new(cloud, execute),
        })
    }

    /// Count and dimension of the ball of radius `eps` (strict, unit of the data) about every
    /// point, in the order of the cloud, with tolerance `dt` (a share of the variance, strict).
    ///
    /// # Errors
    /// [`Error::Parameter`] when `eps` is not between 1e-140 and 1e140 or vanishes in `S`, or unless `0 < dt < 1`.
    pub fn dimensions(
        &self,
        eps: f64,
        dt: f64,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        self.decide(eps, dt, false, execute)
    }

    /// The dimensions of [`MomentTree::dimensions`] in less time: where the moments of a node and of what
    /// is around it prove that all balls about its points are 2-dimensional, no ball is summed, and all
    /// of its points get the count of the first. Every other count is exact, and none below 8 is passed over.
    ///
    /// # Errors
    /// Those of [`MomentTree::dimensions`].
    pub fn settled_dimensions(
        &self,
        eps: f64,
        dt: f64,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        self.decide(eps, dt, true, execute)
    }

    fn decide(
        &self,
        eps: f64,
        dt: f64,
        settle: bool,
        execute: &dyn Execute,
    ) -> Result<Vec<BallDimension>, Error> {
        VarianceTolerance::new(dt)?;
        let reach = Reach::new(&self.tree, self.cloud, eps)?;
        let found = if self.tree.n <= 3 {
            self.sweep(&reach, execute, |sweep: &mut Both<'_, S, 8, 3>, g| {
                dimensions_of(sweep, g, dt, settle)
            })
        } else {
            self.sweep(&reach, execute, |sweep: &mut Both<'_, S, 16, 6>, g| {
                dimensions_of(sweep, g, dt, settle)
            })
        };
        let mut dimensions = vec![BallDimension::default(); self.cloud.len()];
        for (&row, found) in self.tree.order.iter().zip(found.into_iter().flatten()) {
            dimensions[row as usize] = found.unwrap_or_default();
        }
        Ok(dimensions)
    }

    /// Calls `each` with the moments of the ball of radius `eps` (strict, unit of the data) about
    /// every point, in any order, possibly at the same time. The covariance is accurate to 1e-10
    /// of its trace. Nothing is kept: neighborhoods and moments of a whole cloud need not fit in memory.
    ///
    /// # Errors
    /// [`Error::Parameter`] when `eps` is not between 1e-140 and 1e140 or vanishes in `S`.
    pub fn balls(
        &self,
        eps: f64,
        execute: &dyn Execute,
        each: &(dyn Fn(&BallMoments) + Sync),
    ) -> Result<(), Error> {
        let reach = Reach::new(&self.tree, self.cloud, eps)?;
        if self.tree.n <= 3 {
            self.sweep(&reach, execute, |both: &mut Both<'_, S, 8, 3>, g| {
                self.hand_out(&reach, &mut both.sweep, g, each)
            });
        } else {
            self.sweep(&reach, execute, |both: &mut Both<'_, S, 16, 6>, g| {
                self.hand_out(&reach, &mut both.sweep, g, each)
            });
        }
        Ok(())
    }

    /// Runs `work` over all groups of centers.
    fn sweep<'r, T: Send + Sync, const L: usize, const M: usize>(
        &self,
        reach: &'r Reach<'r, S>,
        execute: &dyn Execute,
        work: impl Fn(&mut Both<'r, S, L, M>, Group) -> T + Sync,
    ) -> Vec<T> {
        let groups = group::groups(reach);
        let fresh = || Both {
            sweep: Sweep::new(reach),
            settler: Settler::new(reach),
            stack: Vec::new(),
        };
        execute::map_blocks(execute, RUN, groups.len(), fresh, |both, g| {
            if g.is_multiple_of(RUN) {
                both.sweep.forget();
                both.settler.forget();
            }
            work(both, groups[g])
        })
    }

    fn hand_out<const L: usize, const M: usize>(
        &self,
        reach: &Reach<'_, S>,
        sweep: &mut Sweep<'_, S, L, M>,
        group: Group,
        each: &(dyn Fn(&BallMoments) + Sync),
    ) {
        let mut moments = BallMoments::default();
        sweep.balls(group, &mut |position, ball| {
            moments.center = self.tree.order[position] as usize;
            match ball {
                Ok(ball) => moments.lift(&self.tree, reach.unit, &ball),
                Err(rows) => moments.sum(self.cloud, rows),
            }
            each(&moments);
        });
    }
}

/// Number of points and dimension of the ball of radius `eps` about every point of a cloud:
/// [`MomentTree::with`] and [`MomentTree::dimensions`] in one.
///
/// # Errors
/// Those of the two.
pub fn dimensions<S: Scalar>(
    cloud: &PointCloud<S>,
    eps: f64,
    dt: f64,
    execute: &dyn Execute,
) -> Result<Vec<BallDimension>, Error> {
    MomentTree::with(cloud, execute)?.dimensions(eps, dt, execute)
}

/// Workspace of one thread.
struct Both<'a, S: Scalar, const L: usize, const M: usize> {
    sweep: Sweep<'a, S, L, M>,
    settler: Settler<'a, S>,
    stack: Vec<u32>,
}

/// One group, with wider registers where the processor has them. No sum changes its order and
/// no product is fused with a sum, so both paths give the same bits.
fn dimensions_of<S: Scalar, const L: usize, const M: usize>(
    both: &mut Both<'_, S, L, M>,
    group: Group,
    dt: f64,
    settle: bool,
) -> Vec<Option<BallDimension>> {
    let mut out = vec![None; (group.end - group.start) as usize];
    #[cfg(target_arch = "x86_64")]
    if std::is_x86_feature_detected!("avx2") {
        // SAFETY: the processor has what the function was compiled for.
        #[allow(unsafe_code)]
        unsafe {
            dimensions_wide(both, group, dt, settle, &mut out);
        }
        return out;
    }
    dimensions_plain(both, group, dt, settle, &mut out);
    out
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn dimensions_wide<S: Scalar, const L: usize, const M: usize>(
    both: &mut Both<'_, S, L, M>,
    group: Group,
    dt: f64,
    settle: bool,
    out: &mut [Option<BallDimension>],
) {
    dimensions_plain(both, group, dt, settle, out);
}

#[inline(always)]
fn dimensions_plain<S: Scalar, const L: usize, const M: usize>(
    both: &mut Both<'_, S, L, M>,
    group: Group,
    dt: f64,
    settle: bool,
    out: &mut [Option<BallDimension>],
) {
    if settle {
        let tree = both.settler.reach().tree;
        both.stack.clear();
        both.stack.extend(group.node);
        while let Some(at) = both.stack.pop() {
            let node = &tree.nodes[at as usize];
            match both.settler.settle(at, dt) {
                Settled::Two(count) => {
                    let own =
                        (node.start - group.start) as usize..(node.end - group.start) as usize;
                    out[own].fill(Some(BallDimension {
                        neighbors: count,
                        dimension: 2,
                    }));
                }
                Settled::Open if !node.is_leaf() => both.stack.extend([node.right, at + 1]),
                Settled::Open | Settled::Hopeless => {}
            }
        }
    }
    both.sweep.dimensions(group, dt, out);
}
