//! Disjoint sets whose members are related by a sign.

/// Disjoint sets in which every member is plus or minus its representative.
///
/// Fewer than 2^31 members. Amortized O(log n) an operation.
pub(crate) struct SignedUnion {
    /// Parent and, in the lowest bit, whether the sign changes on the way to it.
    links: Vec<u32>,
}

/// What joining two members found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joined {
    /// They were in different sets, which are one now.
    New,
    /// They were in one set, and related as asked for.
    Consistent,
    /// They were in one set, and related the other way.
    Contradiction,
}

impl SignedUnion {
    pub fn new(count: usize) -> Self {
        Self {
            links: (0..count as u32).map(|x| x << 1).collect(),
        }
    }

    /// Representative, and whether the sign differs from it.
    pub fn find(&mut self, mut x: u32) -> (u32, bool) {
        let mut flipped = 0;
        loop {
            let link = self.links[x as usize];
            let parent = link >> 1;
            if parent == x {
                return (x, flipped == 1);
            }
            let above = self.links[parent as usize];
            let grandparent = above >> 1;
            let flip = (link ^ above) & 1;
            self.links[x as usize] = grandparent << 1 | flip;
            flipped ^= flip;
            x = grandparent;
        }
    }

    /// Makes `a` equal to `b`, or to minus `b` when `opposite`. The smaller representative
    /// stays one.
    pub fn join(&mut self, a: u32, b: u32, opposite: bool) -> Joined {
        let (a, flip_a) = self.find(a);
        let (b, flip_b) = self.find(b);
        let flip = flip_a ^ flip_b ^ opposite;
        if a == b {
            return if flip {
                Joined::Contradiction
            } else {
                Joined::Consistent
            };
        }
        self.links[a.max(b) as usize] = a.min(b) << 1 | u32::from(flip);
        Joined::New
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_multiply_along_the_way() {
        let mut sets = SignedUnion::new(5);
        assert_eq!(sets.join(3, 4, true), Joined::New);
        assert_eq!(sets.join(2, 3, true), Joined::New);
        assert_eq!(sets.join(0, 4, true), Joined::New);
        assert_eq!(sets.join(2, 4, false), Joined::Consistent);
        assert_eq!(sets.join(0, 2, false), Joined::Contradiction);
        assert_eq!(sets.find(1), (1, false));
        assert_eq!((sets.find(4), sets.find(3)), ((0, true), (0, false)));
    }
}
