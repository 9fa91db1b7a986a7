//! Why the pieces of a mesh cannot be told.

use crosscap_core::Error;

/// Why the pieces of a mesh cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PiecesError {
    /// The complex is not as [`crosscap_core::Complex::new`] leaves it, or its places do not
    /// fit it.
    #[error(transparent)]
    Mesh(#[from] Error),
    /// The geometry does not say which triangles continue each other across a double curve.
    #[error(
        "along the {edges} double curve edges that hang together with edge {} {} it is not clear \
         which triangles continue each other: the best pairing is straighter than the next by \
         {margin:.1e} (at least {limit:.0e} is needed) and is the best on {:.0} % of the length (more \
         than half is needed); the sheets are nearly tangent or the triangles too coarse, so use a \
         smaller landmark separation",
        edge[0], edge[1], 100.0 * agreement
    )]
    Ambiguous {
        /// The first edge of the chain of edges that was decided together.
        edge: [u32; 2],
        /// How many edges the chain has.
        edges: usize,
        /// By how much the best pairing is straighter than the next, see
        /// [`super::LEAST_MARGIN`]; NaN when all its triangles are degenerate.
        margin: f64,
        /// The least margin.
        limit: f64,
        /// Share of the length on which the best pairing is the best, 0 to 1.
        agreement: f64,
    },
    /// Around a closed double curve three of its four rims trade places in a cycle, so that no
    /// pairing goes all the way round.
    #[error(
        "around the closed double curve through edge {} {} no pairing of triangles returns to itself: the \
         complex is not the image of a surface there, check the triangles beside this curve",
        edge[0], edge[1]
    )]
    Twisted {
        /// An edge of the curve.
        edge: [u32; 2],
    },
}
