//! A page or an image of a mesh.

use super::findings::Findings;
use super::layout::LayoutName;
use super::number::{betti, counted};
use super::output::extension;
use super::overlay;
use crosscap_backends::picture::{Layout, Scene, SceneScalar, StillOptions, page, still};
use crosscap_core::{Error, Mesh};
use std::path::Path;

/// Width and height of an image, pixels.
pub const SIZE: [usize; 2] = [1200, 900];

/// The scene of a mesh, colored by piece. `first` is the way to see it that is shown first,
/// `verdict` what the facts beside it say.
pub fn scene(
    title: &str,
    findings: &Findings<'_>,
    verdict: &str,
    first: Option<LayoutName>,
) -> Result<Scene, Error> {
    let mesh = findings.mesh;
    let dimension = mesh.vertices.dimension();
    let suiting = LayoutName::suiting(dimension);
    let first = first.unwrap_or(suiting);
    let mut shown = vec![first];
    // On a page the reader can change over; in R^3 the own coordinates are enough.
    let others = if dimension > 3 {
        &[LayoutName::Isomap, LayoutName::Pca][..]
    } else {
        &[LayoutName::Xyz][..]
    };
    shown.extend(others.iter().filter(|&&l| l != first));
    let layouts = shown.into_iter().map(|l| layout(mesh, l));
    let layouts = layouts.collect::<Result<Vec<_>, Error>>()?;
    let mut scene = Scene::new(title, &mesh.complex, layouts);
    if let Ok(pieces) = findings.pieces
        && !pieces.pieces.is_empty()
    {
        scene.triangle_piece.clone_from(&pieces.triangle_piece);
        scene.piece_names = numbered(pieces.pieces.iter().map(|p| p.name.clone()).collect());
    }
    let h = findings.homology;
    let mut facts = vec![
        ("mesh", findings.size()),
        ("Betti numbers over Q", betti(h.betti_rational)),
        ("Betti numbers over Z/2", betti(h.betti_mod2)),
        ("pieces", findings.description()),
        ("verdict", verdict.into()),
    ];
    if let Ok(pieces) = findings.pieces {
        facts.insert(4, ("double curves", pieces.curves.len().to_string()));
    }
    scene.facts = facts.into_iter().map(|(k, v)| (k.into(), v)).collect();
    let row = |&row: &i64| i32::try_from(row).unwrap_or(-1);
    scene.vertex_rows = mesh.point_index.iter().map(row).collect();
    if dimension == 3 {
        scene.scalars.push(SceneScalar {
            name: overlay::HEIGHT.into(),
            vertices: overlay::heights(&mesh.vertices),
            points: Vec::new(),
        });
    }
    Ok(scene)
}

fn layout(mesh: &Mesh, name: LayoutName) -> Result<Layout, Error> {
    Layout::coordinates(name.title(), &name.places(mesh)?, None, [0, 1, 2])
}

/// Equal names get numbers.
fn numbered(names: Vec<String>) -> Vec<String> {
    let name = |(k, own): (usize, &String)| {
        if names.iter().filter(|other| *other == own).count() == 1 {
            return own.clone();
        }
        let before = names[..k].iter().filter(|other| *other == own).count();
        format!("{own} {}", before + 1)
    };
    names.iter().enumerate().map(name).collect()
}

/// The bytes of a picture; the extension of `path` says of which kind.
pub fn bytes(path: &Path, scene: &Scene, size: [usize; 2]) -> Result<Vec<u8>, Error> {
    match extension(path).as_str() {
        "png" => still(scene, size[0], size[1], &StillOptions::default()),
        _ => page(scene).map(String::into_bytes),
    }
}

/// Whether a picture is a page, which shows points and numbers too, and not an image.
pub fn is_page(path: &Path) -> bool {
    extension(path) != "png"
}

/// Heading of a picture of a file.
pub fn title(path: &Path) -> String {
    let name = path.file_stem().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Width and height, as in 1200x900.
pub fn size(text: &str) -> Result<[usize; 2], String> {
    let wrong = || {
        format!(
            "expected WIDTHxHEIGHT in pixels, each 16 to 8192, such as {}x{}",
            SIZE[0], SIZE[1]
        )
    };
    let (width, height) = text.split_once('x').ok_or_else(wrong)?;
    let side = |text: &str| {
        text.parse()
            .ok()
            .filter(|s| (16..=8192).contains(s))
            .ok_or_else(wrong)
    };
    Ok([side(width)?, side(height)?])
}

/// "3 pieces" for a summary.
pub fn pieces_shown(scene: &Scene) -> String {
    counted(scene.piece_names.len(), "piece")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_names_get_numbers() {
        let names = ["sphere", "torus", "sphere"].map(String::from).to_vec();
        assert_eq!(numbered(names), ["sphere 1", "torus", "sphere 2"]);
    }

    #[test]
    fn sizes_are_two_numbers() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for text in ["640", "0x480", "ax3", "99999x20", "-1x20"] {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
