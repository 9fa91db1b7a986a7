//! Verdict on a mesh: levels of validity, each a typed report.
