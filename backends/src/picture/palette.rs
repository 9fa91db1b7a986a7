//! Colors: of pieces, distinguishable also by the color-blind, and of curves.

use super::CurveKind;

/// The first eight pieces. Hues after Okabe and Ito's set for the color-blind (2008), each
/// moved towards a middle lightness, so that shading has room below and above it.
const PIECES: [[u8; 3]; 8] = [
    [222, 92, 60],   // vermilion
    [38, 160, 122],  // bluish green
    [92, 172, 226],  // sky blue
    [240, 196, 72],  // yellow
    [204, 128, 176], // reddish purple
    [58, 110, 190],  // blue
    [160, 160, 166], // grey
    [150, 96, 60],   // brown
];

/// Color of piece number `piece` in red, green, blue. Eight colors, then the same ones
/// lighter, then darker.
///
/// ```
/// use crosscap_backends::picture::piece_color;
/// assert_ne!(piece_color(0), piece_color(1));
/// assert_ne!(piece_color(0), piece_color(8));
/// ```
pub fn piece_color(piece: usize) -> [u8; 3] {
    let base = PIECES[piece % PIECES.len()];
    match (piece / PIECES.len()) % 3 {
        0 => base,
        1 => base.map(|c| c + (255 - c) / 2),
        _ => base.map(|c| c / 2 + c / 8),
    }
}

/// Color of a curve in red, green, blue: double curves black, a boundary dark blue, a curve
/// where three cells meet dark purple, a curve that no surface touches dark brown.
pub fn curve_color(kind: CurveKind) -> [u8; 3] {
    match kind {
        CurveKind::Double => [0, 0, 0],
        CurveKind::Boundary => [16, 36, 128],
        CurveKind::Triple => [104, 12, 96],
        CurveKind::Bare => [96, 56, 12],
    }
}

/// Color of a mark in red, green, blue: the red of the page.
pub const MARK: [u8; 3] = [214, 32, 32];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twenty_four_pieces_are_told_apart() {
        for a in 0..24 {
            for b in 0..a {
                let difference: u32 = piece_color(a)
                    .iter()
                    .zip(piece_color(b))
                    .map(|(x, y)| u32::from(x.abs_diff(y)))
                    .sum();
                assert!(difference > 30, "{a} and {b}");
            }
        }
    }
}
