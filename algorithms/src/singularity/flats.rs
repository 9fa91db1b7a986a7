//! Planes that hold most of the points, one after the other.

use nalgebra::{DMatrix, SVector, SymmetricEigen};

/// A plane of R^D: a point of it and D - 2 orthonormal normals.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Flat<const D: usize> {
    pub(super) origin: SVector<f64, D>,
    pub(super) normals: Vec<SVector<f64, D>>,
}

/// Times that a plane is fitted to the points near it before the next one is looked for, and that all
/// planes are fitted to the points nearest to each.
const ROUNDS: usize = 4;
/// Smallest share of the largest gradient that still has a direction.
const LEAST_GRADIENT: f64 = 0.05;

impl<const D: usize> Flat<D> {
    /// The plane through `origin` whose normal space is spanned best by `gradients`.
    pub(super) fn normal_to(origin: SVector<f64, D>, gradients: &[SVector<f64, D>]) -> Self {
        let mut spread = DMatrix::<f64>::zeros(D, D);
        for g in gradients {
            for a in 0..D {
                for b in 0..D {
                    spread[(a, b)] += g[a] * g[b];
                }
            }
        }
        Self {
            origin,
            normals: axes::<D>(spread).into_iter().take(D - 2).collect(),
        }
    }

    pub(super) fn squared_distance(&self, x: &SVector<f64, D>) -> f64 {
        let d = x - self.origin;
        self.normals.iter().map(|n| n.dot(&d).powi(2)).sum()
    }

    /// Principal plane of points; `None` for fewer than three.
    pub(super) fn of(points: impl Iterator<Item = SVector<f64, D>> + Clone) -> Option<Self> {
        let mut origin = SVector::<f64, D>::zeros();
        let mut count = 0;
        for x in points.clone() {
            origin += x;
            count += 1;
        }
        if count < 3 {
            return None;
        }
        origin /= f64::from(count);
        let mut spread = DMatrix::<f64>::zeros(D, D);
        for x in points {
            let d = x - origin;
            for a in 0..D {
                for b in 0..D {
                    spread[(a, b)] += d[a] * d[b];
                }
            }
        }
        let normals = axes::<D>(spread).into_iter().skip(2).collect();
        Some(Self { origin, normals })
    }
}

/// Eigenvectors in order of falling eigenvalues.
fn axes<const D: usize>(matrix: DMatrix<f64>) -> Vec<SVector<f64, D>> {
    let eigen = SymmetricEigen::new(matrix);
    let mut order: Vec<usize> = (0..D).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    order
        .into_iter()
        .map(|k| SVector::from_iterator(eigen.eigenvectors.column(k).iter().copied()))
        .collect()
}

/// Candidate planes: at every point the one normal to the gradients there, where they are not small.
pub(super) fn candidates<const D: usize>(
    points: &[SVector<f64, D>],
    mut gradients: impl FnMut(&SVector<f64, D>, &mut Vec<SVector<f64, D>>),
) -> Vec<Flat<D>> {
    let mut all: Vec<(f64, Vec<SVector<f64, D>>)> = Vec::with_capacity(points.len());
    for x in points {
        let mut out = Vec::new();
        gradients(x, &mut out);
        let size = out.iter().map(|g| g.norm_squared()).sum::<f64>().sqrt();
        all.push((size, out));
    }
    let largest = all.iter().map(|g| g.0).fold(0.0, f64::max);
    points
        .iter()
        .zip(&all)
        .filter(|(_, g)| g.0 > LEAST_GRADIENT * largest)
        .map(|(x, g)| Flat::normal_to(*x, &g.1))
        .collect()
}

/// `count` planes: each is the candidate that most of the points left over lie near, fitted to them;
/// then all are fitted to the points nearest to each, where they are several. `None` when there are not so many.
///
/// O(p c) distances a plane for p points and c candidates.
pub(super) fn greedy<const D: usize>(
    points: &[SVector<f64, D>],
    candidates: &[Flat<D>],
    count: usize,
    tolerance: f64,
) -> Option<Vec<Flat<D>>> {
    let limit = tolerance * tolerance;
    let mut left: Vec<SVector<f64, D>> = points.to_vec();
    let mut flats: Vec<Flat<D>> = Vec::with_capacity(count);
    for _ in 0..count {
        // A weight that falls with the distance has no ties but those of equal planes.
        let weight = |flat: &Flat<D>| -> f64 {
            left.iter()
                .map(|x| (1.0 - flat.squared_distance(x) / limit).max(0.0))
                .sum()
        };
        let mut best: Option<(f64, &Flat<D>)> = None;
        for candidate in candidates {
            let w = weight(candidate);
            if best.is_none_or(|b| w > b.0) {
                best = Some((w, candidate));
            }
        }
        let mut flat = best?.1.clone();
        for _ in 0..ROUNDS {
            let near = left
                .iter()
                .copied()
                .filter(|x| flat.squared_distance(x) < limit);
            flat = Flat::of(near)?;
        }
        left.retain(|x| flat.squared_distance(x) >= limit);
        flats.push(flat);
    }
    // One plane alone would be fitted to all points, those included that it was chosen to leave out.
    let rounds = if count > 1 { ROUNDS } else { 0 };
    for _ in 0..rounds {
        let owner: Vec<usize> = points.iter().map(|x| nearest(&flats, x)).collect();
        for (k, flat) in flats.iter_mut().enumerate() {
            let own = points.iter().zip(&owner).filter(|&(_, &o)| o == k);
            *flat = Flat::of(own.map(|(x, _)| *x))?;
        }
    }
    Some(flats)
}

/// Which plane is nearest.
pub(super) fn nearest<const D: usize>(flats: &[Flat<D>], x: &SVector<f64, D>) -> usize {
    let mut best = (f64::INFINITY, 0);
    for (k, flat) in flats.iter().enumerate() {
        let d = flat.squared_distance(x);
        if d < best.0 {
            best = (d, k);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn one_plane_keeps_off_what_is_off_it() {
        // A disc, and a line across it that spreads farther than the disc.
        let disc = (0..100).map(|k| {
            let (r, angle) = (0.02 * f64::from(k).sqrt(), 2.4 * f64::from(k));
            Vector3::new(r * angle.cos(), r * angle.sin(), 0.0)
        });
        let line = (0..40).map(|k| Vector3::new(0.0, 0.0, -0.02 * f64::from(k)));
        let points: Vec<_> = disc.chain(line).collect();
        let found = [Flat::normal_to(Vector3::zeros(), &[Vector3::z()])];
        let planes = greedy(&points, &found, 1, 0.03).unwrap();
        assert!(
            points[..100]
                .iter()
                .all(|x| planes[0].squared_distance(x) < 1e-3 * 1e-3)
        );
        assert!(planes[0].squared_distance(&points[139]) > 0.7 * 0.7);
    }
}
