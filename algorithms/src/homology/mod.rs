//! Homology of complexes: Betti numbers over Q and prime fields, integral torsion.
