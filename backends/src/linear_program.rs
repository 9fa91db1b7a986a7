//! The paper's linear program (6), on microlp.
