//! The largest empty disc, and several that are none of them unlikely but no chance together.

use super::chance;
use super::discs::Gap;
use super::search::Search;
use super::tail::{LARGEST, Tail};
use super::tiles::Empty;
use crosscap_core::squared_distance;

/// Discs that are looked at together, at most: each more of them is one more that counts as tried.
const SEVERAL: usize = 5;

impl Search<'_> {
    /// The largest empty disc, and those that lie apart from it, as many of them as are least likely together; the latter only
    /// below `level`.
    pub(super) fn empty_discs(&self, tiles: &[Empty], middles: &[f64], level: f64) -> Vec<Gap> {
        let found = self.largest_apart(tiles, middles, SEVERAL);
        let widest = found.first().map(|(gap, measure)| Gap {
            p: chance::disc(self.points() as f64, *measure),
            ..gap.clone()
        });
        let mut gaps: Vec<Gap> = widest.into_iter().collect();
        gaps.extend(self.together(found).into_iter().filter(|gap| gap.p < level));
        gaps
    }

    /// How the largest empty discs go on, from what is expected in each of them.
    pub(super) fn tail(&self) -> Option<Tail> {
        let (tiles, middles) = &self.far;
        let found = self.largest_apart(tiles, middles, LARGEST);
        let mut measures: Vec<f64> = found.iter().map(|(gap, _)| gap.expected).collect();
        measures.sort_unstable_by(|a, b| b.total_cmp(a));
        Tail::of(&measures, self.points() as f64)
    }

    /// As many discs as are least likely together.
    ///
    /// The k-th largest measure of k discs is compared with the number of discs that chance leaves above it
    /// ([`chance::discs`]); every k from two on counts as tried.
    fn together(&self, mut found: Vec<(Gap, f64)>) -> Vec<Gap> {
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let points = self.points() as f64;
        let tried = (SEVERAL - 1) as f64;
        let together = |k: usize| (tried * chance::discs(points, found[k - 1].1, k)).min(1.0);
        let least = (2..=found.len())
            .map(|k| (k, together(k)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((count, p)) = least else {
            return Vec::new();
        };
        found.truncate(count);
        let told = |(gap, _)| Gap {
            p,
            together: count,
            ..gap
        };
        found.into_iter().map(told).collect()
    }

    /// The largest empty discs, widest first, each with its middle outside twice the others, and their measures.
    fn largest_apart(&self, tiles: &[Empty], middles: &[f64], count: usize) -> Vec<(Gap, f64)> {
        let width = self.mesh.vertices.dimension();
        let at = |k: usize| &middles[k * width..(k + 1) * width];
        let mut found: Vec<(Gap, f64)> = Vec::new();
        while found.len() < count {
            let apart = |k: usize| {
                let near = |gap: &Gap| squared_distance(at(k), &gap.place) < gap.size * gap.size;
                !found.iter().any(|(gap, _)| near(gap))
            };
            let farthest = |&a: &usize, &b: &usize| {
                let further = tiles[a].away.total_cmp(&tiles[b].away);
                further.then(b.cmp(&a))
            };
            let Some(k) = (0..tiles.len()).filter(|&k| apart(k)).max_by(farthest) else {
                break;
            };
            found.push(self.disc(tiles, middles, k));
        }
        found
    }
}
