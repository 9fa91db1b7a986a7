//! A page to turn a mesh in.

use super::scene::{Frame, Layout};
use super::view::View;
use super::{CurveKind, Scene, curve_color, piece_color};
use crosscap_core::Error;
use serde_json::{Value, json};
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Writes a scene as one HTML page that needs nothing else: no network, no other file.
///
/// On the page the mesh is turned, zoomed and moved by mouse, touch or keys; pieces and curves are switched on and
/// off by name; it is made transparent, cut open by a plane, shown with edges and sample points,
/// in any of its layouts, colored by piece or by a scalar, on a light or dark ground. A click on a vertex, a point or a mark
/// tells its row, its scalars, its text. Facts stand in a table. It draws with
/// WebGL, or without it on a plain canvas. A content security policy in the page forbids it any request.
///
/// Numbers are embedded as 32-bit values in base64: 16 bytes a triangle for corners, 5.3 for
/// its piece, and for each layout 16 a place. Any text of the scene is shown as text, never as markup.
///
/// # Errors
/// Those of [`Scene::check`].
pub fn page(scene: &Scene) -> Result<String, Error> {
    scene.check()?;
    let title = if scene.title.trim().is_empty() {
        "Surface".to_string()
    } else {
        escape(&scene.title)
    };
    let facts = facts(scene);
    // Within a script element only "<" could end it or open a comment.
    let data = data(scene).to_string().replace('<', "\\u003c");
    Ok(format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{STYLE}</style>
</head>
<body>
<canvas id="view" tabindex="0" aria-label="The mesh: drag to turn, wheel to zoom"></canvas>
<button id="fold" type="button" title="Show or hide the panel">Panel</button>
<aside id="panel">
<h1>{title}</h1>
<label for="layout">Layout <select id="layout"></select></label>
<label for="color">Color by <select id="color"></select></label>
<div id="scale" hidden><span id="low"></span><span id="ramp"></span><span id="high"></span></div>
<div id="picked" aria-live="polite"></div>
<h2>Pieces</h2>
<div id="pieces"></div>
<div id="curves"></div>
<h2>Show</h2>
<div id="shows"></div>
<label>opacity <input id="opacity" type="range" min="0" max="1" step="0.01" value="1"></label>
<label>curve width <input id="width" type="range" min="0" max="3" step="0.05" value="1"></label>
<h2>Cut open</h2>
<label>from <select id="axis"><option value="view">the viewer</option><option value="x">first axis</option><option value="y">second axis</option><option value="z">third axis</option></select></label>
<label>keep <input id="keep" type="range" min="0" max="1" step="0.005" value="1"></label>
{facts}<div class="row"><button id="home" type="button">Reset view</button><button id="theme" type="button">Dark / light</button><button id="save" type="button">Save picture</button></div>
<div id="hint">Drag to turn, click on a vertex or a point for its row, wheel or pinch to zoom, right button or two fingers to move, double click to reset.</div>
<div id="trouble"></div>
</aside>
<noscript>Turning the mesh needs JavaScript.</noscript>
<script type="application/json" id="scene">{data}</script>
<script>
{SCRIPT}</script>
</body>
</html>
"#
    ))
}

/// The table of facts with its heading, nothing where there are none.
fn facts(scene: &Scene) -> String {
    if scene.facts.is_empty() {
        return String::new();
    }
    let mut rows = String::new();
    for (name, value) in &scene.facts {
        let _ = writeln!(
            rows,
            "<tr><th>{}</th><td>{}</td></tr>",
            escape(name),
            escape(value)
        );
    }
    format!("<h2>Facts</h2>\n<table><tbody>\n{rows}</tbody></table>\n")
}

/// One layout: places, points and marks in its frame, and the side from which most is seen.
fn layout(scene: &Scene, index: usize, layout: &Layout) -> Value {
    let wide = |p: &[f32; 3]| p.map(f64::from);
    let used = scene.used(layout.places.len());
    let of_places = layout.places.iter().zip(&used).filter(|(_, u)| **u);
    let frame = Frame::of(of_places.map(|(p, _)| wide(p)))
        .or_else(|| Frame::of(layout.points.iter().map(wide)))
        .unwrap_or_default();
    let place = |p: &[f32; 3]| frame.place(wide(p)).into();
    let places: Vec<_> = layout.places.iter().map(place).collect();
    let points: Vec<_> = layout.points.iter().map(place).collect();
    let view = View::of_scene(scene, &places, &points, &used);
    let rows: Vec<f64> = [view.right, view.up, view.toward]
        .iter()
        .flat_map(|r| [r.x, r.y, r.z])
        .collect();
    let marks = || scene.marks.iter().filter(|mark| mark.layout == index);
    let [x, y, z] = frame.middle();
    json!({
        "name": layout.name,
        "places": base64(layout.places.iter().flatten().flat_map(|c| c.to_le_bytes())),
        "points": base64(layout.points.iter().flatten().flat_map(|c| c.to_le_bytes())),
        "marks": base64(marks().flat_map(|m| m.place).flat_map(|c| c.to_le_bytes())),
        "mark_texts": marks().map(|m| m.text.as_str()).collect::<Vec<_>>(),
        "frame": [x, y, z, frame.half()],
        "view": rows,
    })
}

/// The scene as the script reads it.
fn data(scene: &Scene) -> Value {
    let layouts = scene.layouts.iter().enumerate();
    let layouts: Vec<Value> = layouts
        .map(|(index, of)| layout(scene, index, of))
        .collect();
    let pieces: Vec<Value> = scene
        .piece_names
        .iter()
        .enumerate()
        .map(|(k, name)| json!({ "name": name, "color": piece_color(k) }))
        .collect();
    let curves: Vec<Value> = scene
        .curves
        .iter()
        .map(|curve| {
            json!({
                "name": curve.kind.name(),
                "color": curve_color(curve.kind),
                "wide": curve.kind == CurveKind::Double,
                "edges": base64(curve.edges.iter().flatten().flat_map(|v| v.to_le_bytes())),
            })
        })
        .collect();
    let floats = |list: &[f32]| base64(list.iter().flat_map(|x| x.to_le_bytes()));
    let scalars: Vec<Value> = scene
        .scalars
        .iter()
        .map(|s| json!({ "name": s.name, "vertices": floats(&s.vertices), "points": floats(&s.points) }))
        .collect();
    json!({
        "scalars": scalars,
        "vertex_rows": base64(scene.vertex_rows.iter().flat_map(|r| r.to_le_bytes())),
        "point_rows": base64(scene.point_rows.iter().flat_map(|r| r.to_le_bytes())),
        "layouts": layouts,
        "triangles": base64(scene.triangles.iter().flatten().flat_map(|v| v.to_le_bytes())),
        "triangle_piece": base64(scene.triangle_piece.iter().flat_map(|v| v.to_le_bytes())),
        "pieces": pieces,
        "curves": curves,
    })
}

/// Text as it stands in HTML, in an element or in a quoted attribute.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Not allowed in HTML in any form.
            '\0' => out.push('\u{fffd}'),
            _ => out.push(c),
        }
    }
    out
}

/// Bytes in base64 (RFC 4648, section 4, with padding).
fn base64(bytes: impl Iterator<Item = u8>) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    let mut bytes = bytes.fuse();
    while let Some(first) = bytes.next() {
        let (second, third) = (bytes.next(), bytes.next());
        let word = u32::from(first) << 16
            | u32::from(second.unwrap_or(0)) << 8
            | u32::from(third.unwrap_or(0));
        let digit = |shift: u32| DIGITS[(word >> shift) as usize & 63] as char;
        out.push(digit(18));
        out.push(digit(12));
        out.push(if second.is_some() { digit(6) } else { '=' });
        out.push(if third.is_some() { digit(0) } else { '=' });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::{Layout, gallery};
    use super::*;

    /// Names of elements as they open and close, text of script and style left out; panics where they do not match.
    fn check_balance(html: &str) -> usize {
        let mut open: Vec<String> = Vec::new();
        let mut elements = 0;
        let mut rest = html;
        while let Some(at) = rest.find('<') {
            rest = &rest[at + 1..];
            let end = rest.find('>').expect("a tag ends");
            let tag = &rest[..end];
            rest = &rest[end + 1..];
            let name = |t: &str| -> String {
                t.chars()
                    .take_while(char::is_ascii_alphanumeric)
                    .collect::<String>()
            };
            if tag.starts_with('!') {
                continue;
            }
            if let Some(closing) = tag.strip_prefix('/') {
                assert_eq!(open.pop().as_deref(), Some(name(closing).as_str()));
                continue;
            }
            let name = name(tag);
            assert!(!name.is_empty(), "a bare < before {tag:?}");
            elements += 1;
            if ["meta", "input"].contains(&name.as_str()) {
                continue;
            }
            if ["script", "style"].contains(&name.as_str()) {
                let close = format!("</{name}>");
                rest = &rest[rest.find(&close).expect("a script ends") + close.len()..];
                continue;
            }
            open.push(name);
        }
        assert!(open.is_empty(), "{open:?}");
        elements
    }

    #[test]
    fn a_page_is_balanced_and_asks_nobody() {
        let html = page(&gallery::two_spheres(2)).unwrap();
        assert!(check_balance(&html) > 30);
        assert_eq!(html, page(&gallery::two_spheres(2)).unwrap());
        let low = html.to_lowercase();
        for word in [
            "http:",
            "https:",
            "//cdn",
            "src=",
            "@import",
            " url(",
            ":url(",
            "fetch(",
            "xmlhttprequest",
            "import(",
            "<link",
            "<iframe",
        ] {
            assert!(!low.contains(word), "{word}");
        }
        assert!(low.contains("default-src 'none'"));
        assert!(html.contains("<td>1, 0, 3</td>") && html.contains("second sphere"));
    }

    #[test]
    fn text_of_the_user_stays_text() {
        let evil = "</script><script>alert(1)</script><!-- \"'&\0 ]]>";
        let mut scene = gallery::two_spheres(1);
        let plain = check_balance(&page(&scene).unwrap());
        scene.title = evil.into();
        scene.facts = vec![(evil.into(), evil.into()); 3];
        scene.piece_names = vec![evil.into(), evil.into()];
        scene.layouts[0].name = evil.into();
        let html = page(&scene).unwrap();
        assert_eq!(check_balance(&html), plain);
        assert!(!html.contains("<script>alert"));
        assert!(html.contains("&lt;script&gt;alert(1)"));
    }

    #[test]
    fn the_data_are_those_of_the_scene() {
        let scene = gallery::two_spheres(1);
        let html = page(&scene).unwrap();
        let (_, rest) = html.split_once("id=\"scene\">").unwrap();
        let (text, _) = rest.split_once("</script>").unwrap();
        let value: Value = serde_json::from_str(text).unwrap();
        let read = |text: &Value| -> Vec<u32> {
            let bytes = decode(text.as_str().unwrap());
            bytes
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
                .collect()
        };
        assert_eq!(read(&value["triangles"]), scene.triangles.concat());
        assert_eq!(read(&value["triangle_piece"]), scene.triangle_piece);
        assert_eq!(
            read(&value["curves"][0]["edges"]),
            scene.curves[0].edges.concat()
        );
        let places: Vec<u32> = scene.layouts[0]
            .places
            .iter()
            .flatten()
            .map(|c| c.to_bits())
            .collect();
        assert_eq!(read(&value["layouts"][0]["places"]), places);
    }

    /// The inverse of `base64`, written from the table of the standard.
    fn decode(text: &str) -> Vec<u8> {
        let digit = |c: u8| -> u32 {
            u32::from(match c {
                b'A'..=b'Z' => c - b'A',
                b'a'..=b'z' => c - b'a' + 26,
                b'0'..=b'9' => c - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => 0,
            })
        };
        let mut out = Vec::new();
        for block in text.as_bytes().chunks(4) {
            let word = block.iter().fold(0, |w, &c| w << 6 | digit(c));
            let padding = block.iter().filter(|c| **c == b'=').count();
            out.extend(&word.to_be_bytes()[1..4 - padding]);
        }
        out
    }

    #[test]
    fn base64_as_the_standard_gives_it() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.bytes()), coded);
            assert_eq!(decode(coded), plain.as_bytes());
        }
    }

    #[test]
    fn degenerate_scenes_make_pages() {
        let layout = |places: Vec<[f32; 3]>, points: Vec<[f32; 3]>| Scene {
            layouts: vec![Layout {
                name: String::new(),
                places,
                points,
            }],
            ..Scene::default()
        };
        let far = f32::MAX;
        for scene in [
            layout(vec![], vec![]),
            layout(vec![[1.0, 2.0, 3.0]], vec![]),
            layout(vec![], vec![[far, -far, 0.0], [-far, far, 0.0]]),
        ] {
            check_balance(&page(&scene).unwrap());
        }
        assert!(page(&Scene::default()).is_err());
        assert!(page(&layout(vec![[f32::NAN, 0.0, 0.0]], vec![])).is_err());
    }
}
