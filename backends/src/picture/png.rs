//! A still image.

mod compose;
mod options;
mod stage;

pub use options::{Cut, StillOptions};

use super::Scene;
use compose::compose;
use crosscap_core::Error;
use rayon::prelude::*;

/// Image rows of one band.
const BAND: usize = 24;

/// Draws a scene into a PNG image of `width` by `height` pixels; the same scene and options give
/// the same bytes, on any number of threads.
///
/// Triangles are colored by piece and lit from both sides, curves are tubes of constant width on
/// the screen: double curves black, boundary curves dark blue.
///
/// # Errors
/// Those of [`Scene::check`]; [`Error::Parameter`] for a size outside of 1 to 16,384, an option out of
/// range or not finite; [`Error::Index`] for a layout that is not there.
///
/// # Complexity
/// O(samples covered + t log t) for t triangles; about 0.4 s for 10,000 triangles on
/// 800 x 600 pixels on two processors.
pub fn still(
    scene: &Scene,
    width: usize,
    height: usize,
    options: &StillOptions,
) -> Result<Vec<u8>, Error> {
    scene.check()?;
    options.check(scene, width, height)?;
    let samples = options.supersampling;
    let picture = compose(scene, width, height, options);
    let rows: Vec<Vec<u8>> = (0..height.div_ceil(BAND))
        .into_par_iter()
        .map(|band| {
            let first = band * BAND;
            let count = BAND.min(height - first);
            let colors = picture.band(first * samples, count * samples);
            average(&colors, width, count, samples)
        })
        .collect();
    Ok(encode(width, height, &rows.concat()))
}

/// Means over `samples` by `samples` blocks, as bytes.
fn average(colors: &[[f32; 3]], width: usize, rows: usize, samples: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(width * rows * 3);
    let share = (samples * samples) as f32;
    for row in 0..rows {
        for column in 0..width {
            let mut sum = [0.0_f32; 3];
            for y in 0..samples {
                let start = (row * samples + y) * width * samples + column * samples;
                for color in &colors[start..start + samples] {
                    for (s, c) in sum.iter_mut().zip(color) {
                        *s += c;
                    }
                }
            }
            out.extend(sum.map(|s| (s / share).round() as u8));
        }
    }
    out
}

/// The bytes of a PNG file.
fn encode(width: usize, height: usize, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder
        .write_header()
        .expect("the size was checked and memory takes every write");
    writer
        .write_image_data(pixels)
        .expect("there are width x height pixels of three bytes");
    writer
        .finish()
        .expect("the image is complete and memory takes every write");
    bytes
}

#[cfg(test)]
mod tests;
