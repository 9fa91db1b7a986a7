//! Empty regions of the points that the mesh covers, against those that chance leaves.

use super::discs::Gap;
use super::search::Search;

impl Search<'_> {
    /// Largest gaps first by how unlikely they are: the least likely one, and all below `level`.
    pub fn run(&self, level: f64) -> Vec<Gap> {
        if self.points() < 2 {
            return Vec::new();
        }
        let (tiles, middles) = &self.far;
        let mut gaps = self.empty_discs(tiles, middles, level);
        gaps.extend(self.overhang());
        self.chains(tiles, middles, level, &mut gaps);
        gaps.sort_by(|a, b| a.p.total_cmp(&b.p).then(b.expected.total_cmp(&a.expected)));
        let shown = gaps.iter().filter(|g| g.p < level).count().max(1);
        gaps.truncate(shown);
        gaps
    }
}
