//! glTF 2.0 in one binary file, `.glb`: for web pages, slides and Blender. Written only.
//!
//! One mesh with a primitive of triangles for each piece, in the piece's color and visible from
//! both sides, and a primitive of lines for each kind of curve. Places are stored in single
//! precision, as the format has them, from the middle of the mesh, which the node carries as its
//! translation.

use super::mesh_sheet::Sheet;
use crate::picture::{CurveKind, curve_color, piece_color};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// glTF's numbers for types and modes.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const LINES: u32 = 1;
const TRIANGLES: u32 = 4;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What is appended to the one buffer, and described in the document.
#[derive(Default)]
struct Builder {
    buffer: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    primitives: Vec<Value>,
}

impl Builder {
    fn view(&mut self, bytes: Vec<u8>, target: u32) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.buffer.len(), "byteLength": bytes.len(), "target": target,
        }));
        self.buffer.extend(bytes);
        self.views.len() - 1
    }

    /// Triangles or lines of one color.
    fn primitive(&mut self, mode: u32, corners: &[u32], name: String, color: [u8; 3]) {
        let bytes = corners.iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(bytes, ELEMENT_ARRAY_BUFFER);
        self.accessors.push(json!({
            "bufferView": view, "componentType": UNSIGNED_INT, "count": corners.len(), "type": "SCALAR",
        }));
        let [r, g, b] = color.map(linear);
        self.materials.push(json!({
            "name": name,
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8,
            },
        }));
        self.primitives.push(json!({
            "attributes": { "POSITION": 0 },
            "indices": self.accessors.len() - 1,
            "material": self.materials.len() - 1,
            "mode": mode,
        }));
    }
}

/// A color of a screen as an amount of light, which is what the format wants (IEC 61966-2-1).
fn linear(color: u8) -> f64 {
    let c = f64::from(color) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mut builder = Builder::default();
    let translation = positions(sheet, &mut builder);
    let mut pieces: BTreeMap<i64, Vec<u32>> = BTreeMap::new();
    for (at, triangle) in sheet.triangles.iter().enumerate() {
        let piece = sheet.pieces.map_or(0, |p| p[at]);
        pieces.entry(piece).or_default().extend(triangle);
    }
    for (k, (piece, corners)) in pieces.iter().enumerate() {
        builder.primitive(TRIANGLES, corners, format!("piece {piece}"), piece_color(k));
    }
    let mut curves: BTreeMap<u8, Vec<u32>> = BTreeMap::new();
    for edge in &sheet.mesh.complex.curve_edges {
        curves.entry(edge.cells).or_default().extend(edge.ends);
    }
    for (cells, ends) in &curves {
        let kind = match cells {
            0 => CurveKind::Bare,
            1 => CurveKind::Boundary,
            3 => CurveKind::Triple,
            _ => CurveKind::Double,
        };
        builder.primitive(
            LINES,
            ends,
            format!("curves of {cells} cells"),
            curve_color(kind),
        );
    }
    container(
        &document(&builder, translation, sheet.metadata),
        builder.buffer,
    )
}

/// The places, from the middle of the mesh; the middle.
fn positions(sheet: &Sheet<'_>, builder: &mut Builder) -> [f64; 3] {
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|k| sheet.places.iter().map(|p| p[k]).fold(start, pick))
    };
    if sheet.places.is_empty() {
        return [0.0; 3];
    }
    let (low, high) = (
        bound(f64::min, f64::INFINITY),
        bound(f64::max, f64::NEG_INFINITY),
    );
    let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * low[k] + 0.5 * high[k]);
    let near = |p: &[f64; 3]| -> [f32; 3] { std::array::from_fn(|k| (p[k] - middle[k]) as f32) };
    let places: Vec<[f32; 3]> = sheet.places.iter().map(near).collect();
    let bytes = places.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let bytes = bytes.collect();
    let view = builder.view(bytes, ARRAY_BUFFER);
    builder.accessors.push(json!({
        "bufferView": view, "componentType": FLOAT, "count": places.len(), "type": "VEC3",
        "min": near(&low), "max": near(&high),
    }));
    middle
}

fn document(builder: &Builder, translation: [f64; 3], metadata: &Value) -> Value {
    let mut all = json!({
        "asset": { "version": "2.0", "generator": "Crosscap" },
    });
    if !metadata.is_null() {
        all["asset"]["extras"] = metadata.clone();
    }
    // A mesh without a primitive, and an empty list, are not allowed.
    if !builder.primitives.is_empty() {
        all["scene"] = json!(0);
        all["scenes"] = json!([{ "nodes": [0] }]);
        all["nodes"] = json!([{ "mesh": 0, "translation": translation }]);
        all["meshes"] = json!([{ "primitives": builder.primitives }]);
        all["accessors"] = json!(builder.accessors);
        all["materials"] = json!(builder.materials);
        all["bufferViews"] = json!(builder.views);
        all["buffers"] = json!([{ "byteLength": builder.buffer.len() }]);
    }
    all
}

/// The document and the buffer as chunks of a file, each filled up to whole words.
fn container(document: &Value, mut buffer: Vec<u8>) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let has_buffer = document.get("buffers").is_some();
    let total = 12 + 8 + text.len() + if has_buffer { 8 + buffer.len() } else { 0 };
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((total as u32).to_le_bytes());
    let mut chunk = |kind: &[u8; 4], data: &[u8]| {
        bytes.extend((data.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(data);
    };
    chunk(b"JSON", &text);
    if has_buffer {
        chunk(b"BIN\0", &buffer);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::super::mesh::mesh_bytes;
    use super::super::{MeshExtras, MeshFile};
    use super::*;
    use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};

    fn file() -> MeshFile {
        let curves = vec![CurveEdge::new(0, 1, 2), CurveEdge::new(1, 2, 1)];
        let complex = Complex::new(4, vec![[0, 1, 2], [0, 1, 3]], curves).unwrap();
        // Far from the origin: single precision alone would lose the shape.
        let far = 4e6;
        let places = vec![far, 0., 0., far + 0.1, 0., 0., far, 0.1, 0., far, 0., 0.3];
        let places = PointCloud::new(3, places).unwrap();
        MeshFile {
            mesh: Mesh::new(complex, places, vec![0; 4]).unwrap(),
            extras: MeshExtras {
                metadata: json!({ "verified": true }),
                pieces: Some(vec![0, 1]),
            },
        }
    }

    #[test]
    fn the_document_describes_the_buffer() {
        let file = file();
        let bytes = mesh_bytes("glb", &file.mesh, &file.extras, None)
            .unwrap()
            .unwrap();
        let word = |at: usize| u32::from_le_bytes(*bytes[at..].first_chunk().unwrap()) as usize;
        assert_eq!(
            (&bytes[..4], word(4), word(8)),
            (&b"glTF"[..], 2, bytes.len())
        );
        let length = word(12);
        let all: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let buffer = &bytes[20 + length + 8..];
        assert_eq!(all["buffers"][0]["byteLength"], buffer.len());
        // Two pieces, two kinds of curves, and the places of all of them.
        assert_eq!(all["meshes"][0]["primitives"].as_array().unwrap().len(), 4);
        assert_eq!(all["asset"]["extras"]["verified"], true);
        let middle = all["nodes"][0]["translation"][0].as_f64().unwrap();
        for v in 0..4 {
            let x = f32::from_le_bytes(*buffer[12 * v..].first_chunk().unwrap());
            let error = middle + f64::from(x) - file.mesh.vertices.point(v)[0];
            assert!(error.abs() < 1e-8, "{error}");
        }
        for view in all["bufferViews"].as_array().unwrap() {
            let end = view["byteOffset"].as_u64().unwrap() + view["byteLength"].as_u64().unwrap();
            assert!(end as usize <= buffer.len());
        }
    }
}
