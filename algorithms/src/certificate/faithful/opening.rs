//! Whether a short boundary goes round a hole of the points.
//!
//! A boundary of few edges is a hole that the landmarks do not resolve, or a triangle that is missing. The points decide: where
//! they leave a disc empty that chance does not explain, the hole is theirs, however few edges go round it.

use super::chance;
use super::ground::COUNTED;
use super::search::Search;
use crosscap_core::{Mesh, PointCloud, squared_distance};
use std::f64::consts::PI;

impl Search<'_> {
    /// Whether chance does not explain, at `significance`, how far the points are from a place amid the vertices `around` of a
    /// boundary. O(points) for each of the places: the mean of the vertices and the middles between two.
    pub fn is_opening(&self, points: &PointCloud<f64>, around: &[u32], significance: f64) -> bool {
        let density = around.iter().map(|&v| self.ground.density[v as usize]);
        let least = density.fold(f64::INFINITY, f64::min) / (self.finer * self.finer);
        // A hole may be no larger than gaps that follow from others: then the points allow it, and need not prove it.
        let even = self.even.with_tail(None);
        places_amid(self.mesh, around).any(|place| {
            let squares = points.iter().map(|p| squared_distance(p, &place));
            let expected = PI * least * squares.fold(f64::INFINITY, f64::min);
            let measure = chance::known(even.random(expected), COUNTED);
            chance::disc(self.of as f64, measure) < significance
        })
    }
}

/// Places amid the vertices of a boundary: their mean and the middles between two.
pub(in crate::certificate) fn places_amid<'a>(
    mesh: &'a Mesh,
    around: &'a [u32],
) -> impl Iterator<Item = Vec<f64>> + 'a {
    let corner = |v: u32| mesh.vertices.point(v as usize);
    let mean = move |of: &[u32]| -> Vec<f64> {
        let sum = |k: usize| of.iter().map(|&v| corner(v)[k]).sum::<f64>();
        let width = mesh.vertices.dimension();
        (0..width).map(|k| sum(k) / of.len() as f64).collect()
    };
    let pairs = (0..around.len()).flat_map(move |k| (0..k).map(move |l| [around[k], around[l]]));
    std::iter::once(mean(around)).chain(pairs.map(move |pair| mean(&pair)))
}
