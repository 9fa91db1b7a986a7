//! Geodesic distances over a neighbor graph, on petgraph.
