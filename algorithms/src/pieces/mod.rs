//! What a complex is made of: undoing the immersion and naming the pieces.
