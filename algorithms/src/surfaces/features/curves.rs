//! Curves near a sheet that do not touch it.

use super::feature::Feature;
use super::plates::square;

/// Half the length of the curve that runs beside the sheet.
const BESIDE: f64 = 0.8;
/// Length of the curve that ends above the sheet.
const ABOVE: f64 = 1.0;

pub(super) const ALL: &[Feature] = &[
    Feature {
        name: "curve-beside",
        betti: [2, 0, 0],
        most: 1.0,
        area: |_| 4.0,
        place: |r, _| Some(square(r)),
        spots: |_| vec![[-BESIDE, 0.0, 0.0], [BESIDE, 0.0, 0.0]],
        curve: Some((2.0 * BESIDE, |r, f| [r.between(-BESIDE, BESIDE), 0.0, f])),
    },
    Feature {
        name: "curve-above",
        betti: [2, 0, 0],
        most: 1.0,
        area: |_| 4.0,
        place: |r, _| Some(square(r)),
        spots: |_| vec![[0.0; 3]],
        curve: Some((ABOVE, |r, f| [0.0, 0.0, f + r.between(0.0, ABOVE)])),
    },
    Feature {
        name: "curve-gap",
        betti: [2, 0, 0],
        most: 1.0,
        area: |_| 4.0,
        place: |r, _| Some(square(r)),
        spots: |_| vec![[0.0; 3]],
        curve: Some((2.0 * ABOVE, |r, f| {
            // on both sides of the sheet: one end touches it, the other stays away
            let t = r.between(-ABOVE, ABOVE);
            [0.0, 0.0, if t > 0.0 { f + t } else { t }]
        })),
    },
];
