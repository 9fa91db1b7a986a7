//! Polygon files, `.ply`, ASCII and binary.
//!
//! Written as little-endian binary in double precision, hence lossless. Other programs stumble over
//! edges: meshio over any, most over a third property. So edges are written only when the triangles
//! do not tell where the curves are, and how many cells meet at them stands in comments of the
//! header, `comment cells 4 120`: the next 120 edges have 4. meshio stumbles over any number of a face
//! beside its corners, too: triangles stand piece by piece, and `comment piece 0 1778` tells that the next 1778 are of
//! piece 0.

use super::columns::{ColumnChoice, pick};
use super::error::{Flaw, Parsed, excerpt};
use super::mesh_parts::{Parts, tells_its_curves};
use super::mesh_sheet::Sheet;
use super::npy::{Array, Numbers};
use super::ply_reader::{Element, Reader, Rows, Type};
use crosscap_core::{CurveEdge, PointCloud};

/// Columns of x, y, z among the numbers of a vertex, whatever their case.
fn places(element: &Element) -> Parsed<[usize; 3]> {
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(["x", "y", "z"]) {
        let found = element
            .scalars()
            .position(|p| p.name.eq_ignore_ascii_case(name));
        *column = found.ok_or_else(|| {
            Flaw::new(format!("no number {name}"), "the properties x, y, z").within("vertex")
        })?;
    }
    Ok(columns)
}

/// The vertices as points: x, y, z, or the properties that are wanted.
pub(crate) fn parse_points(bytes: &[u8], wanted: &ColumnChoice) -> Parsed<Array> {
    let mut reader = Reader::open(bytes)?;
    for element in reader.elements.clone() {
        let rows = reader.rows(&element)?;
        if element.name != "vertex" {
            continue;
        }
        let properties: Vec<_> = element.scalars().collect();
        let kept = if *wanted == ColumnChoice::Automatic {
            places(&element)?.to_vec()
        } else {
            let names: Vec<String> = properties.iter().map(|p| p.name.clone()).collect();
            pick(Some(&names), names.len(), wanted)?.kept
        };
        let single = kept.iter().all(|&k| properties[k].kind == Type::F32);
        let numbers = rows.scalars.chunks_exact(rows.width.max(1));
        let numbers = numbers.flat_map(|row| kept.iter().map(|&k| row[k]));
        let numbers = if single {
            // Exact: every one of them was widened from single precision.
            Numbers::F32(numbers.map(|x| x as f32).collect())
        } else {
            Numbers::F64(numbers.collect())
        };
        return Ok(Array::new(vec![element.count, kept.len()], numbers));
    }
    Err(Flaw::new("no element vertex", "one"))
}

/// Vertices, triangles, and curve edges where there are any.
pub(crate) fn parse_mesh(bytes: &[u8]) -> Parsed<Parts> {
    let mut reader = Reader::open(bytes)?;
    let mut parts = Parts::default();
    let mut seen = false;
    for element in reader.elements.clone() {
        let rows = reader.rows(&element)?;
        let labels = |name: &str| {
            let column = element.column(name)?;
            Some(rows.column(column).map(|x| x as i64).collect::<Vec<_>>())
        };
        match element.name.as_str() {
            "vertex" => {
                seen = true;
                let columns = places(&element)?;
                parts.dimension = 3;
                let vertices = rows.scalars.chunks_exact(rows.width);
                parts.coordinates = vertices.flat_map(|v| columns.map(|k| v[k])).collect();
                parts.point_index = labels("point_index");
            }
            "face" => {
                parts.triangles = triangles(&rows)?;
                let told = runs("piece", "triangles", element.count, &reader.comments)?;
                parts.pieces = told.or_else(|| labels("piece"));
            }
            "edge" => parts.curves = Some(curves(&element, &rows, &reader.comments)?),
            _ => {}
        }
    }
    if !seen {
        return Err(Flaw::new("no element vertex", "one"));
    }
    Ok(parts)
}

fn triangles(rows: &Rows) -> Parsed<Vec<[i64; 3]>> {
    let mut from = 0;
    let face = |(at, &to): (usize, &usize)| {
        let corners = &rows.corners[from..to];
        from = to;
        let &[a, b, c] = corners else {
            return Err(Flaw::row(
                "face",
                at,
                None,
                format!("{} corners", corners.len()),
                "3: split polygons into triangles",
            ));
        };
        Ok([a, b, c])
    };
    rows.ends.iter().enumerate().map(face).collect()
}

/// Numbers of the rows of an element as comments of the header tell them, `comment NAME NUMBER ROWS`; `None` without any.
fn runs(name: &str, what: &str, count: usize, comments: &[&str]) -> Parsed<Option<Vec<i64>>> {
    let mut found = Vec::new();
    for comment in comments {
        let words: Vec<&str> = comment.split_whitespace().collect();
        let [_, number, rows] = words[..] else {
            continue;
        };
        if words[0] == name {
            let (Ok(number), Ok(rows)) = (number.parse::<i64>(), rows.parse::<usize>()) else {
                return Err(Flaw::new(
                    excerpt(comment),
                    format!("a comment {name} with a number and how many {what} have it"),
                ));
            };
            found.push((number, rows));
        }
    }
    let told = found.iter().fold(0_usize, |sum, r| sum.saturating_add(r.1));
    if found.is_empty() {
        return Ok(None);
    }
    if told != count {
        return Err(Flaw::new(
            format!("comments {name} for {told} {what}"),
            count.to_string(),
        ));
    }
    let all = found.into_iter();
    let all = all.flat_map(|(number, rows)| std::iter::repeat_n(number, rows));
    Ok(Some(all.collect()))
}

/// Edges with their cells, from a property of that name or from the comments of the header.
fn curves(
    element: &Element,
    rows: &Rows,
    comments: &[&str],
) -> Parsed<Vec<([i64; 2], Option<i64>)>> {
    let end = |name: &str| {
        element.column(name).ok_or_else(|| {
            Flaw::new(format!("no number {name}"), "vertex1, vertex2").within("edge")
        })
    };
    let (a, b) = (end("vertex1")?, end("vertex2")?);
    let counted = element.column("cells");
    let told = runs("cells", "edges", element.count, comments)?;
    let edges = rows.scalars.chunks_exact(rows.width).enumerate();
    Ok(edges
        .map(|(at, e)| {
            let cells = told.as_ref().map(|told| told[at]);
            let cells = cells.or(counted.map(|k| e[k] as i64));
            ([e[a] as i64, e[b] as i64], cells)
        })
        .collect())
}

/// Points of R^3.
pub(crate) fn point_bytes(cloud: &PointCloud<f64>) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header\n",
        cloud.len()
    )
    .into_bytes();
    bytes.extend(cloud.coordinates().iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// A mesh with places in R^3.
pub(crate) fn mesh_bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mesh = sheet.mesh;
    let complex = &mesh.complex;
    // The format has no integer of 64 bits; rows beyond 32 are kept as doubles, exactly.
    let narrow = |all: &[i64]| all.iter().all(|&i| i32::try_from(i).is_ok());
    let name = |narrow| if narrow { "int" } else { "double" };
    let put = |bytes: &mut Vec<u8>, narrow: bool, i: i64| {
        if narrow {
            bytes.extend((i as i32).to_le_bytes());
        } else {
            bytes.extend((i as f64).to_le_bytes());
        }
    };
    let narrow_rows = narrow(&mesh.point_index);
    let mut header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nproperty {} point_index\n\
         element face {}\nproperty list uchar int vertex_indices\n",
        complex.vertices,
        name(narrow_rows),
        complex.triangles.len(),
    );
    let mut order: Vec<usize> = (0..sheet.triangles.len()).collect();
    if let Some(pieces) = sheet.pieces {
        if order.is_empty() {
            header += "comment piece 0 0\n";
        }
        order.sort_by_key(|&at| pieces[at]);
        for run in order.chunk_by(|&a, &b| pieces[a] == pieces[b]) {
            header += &format!("comment piece {} {}\n", pieces[run[0]], run.len());
        }
    }
    let mut curves: Vec<&CurveEdge> = complex.curve_edges.iter().collect();
    if tells_its_curves(complex) {
        curves.clear();
    } else {
        header += &format!(
            "element edge {}\nproperty int vertex1\nproperty int vertex2\n",
            curves.len()
        );
    }
    curves.sort_by_key(|e| e.cells);
    for run in curves.chunk_by(|a, b| a.cells == b.cells) {
        header += &format!("comment cells {} {}\n", run[0].cells, run.len());
    }
    header += "end_header\n";
    let mut bytes = header.into_bytes();
    for (place, &row) in sheet.places.iter().zip(&mesh.point_index) {
        bytes.extend(place.iter().flat_map(|x| x.to_le_bytes()));
        put(&mut bytes, narrow_rows, row);
    }
    for at in order {
        bytes.push(3);
        bytes.extend(sheet.triangles[at].iter().flat_map(|v| v.to_le_bytes()));
    }
    for edge in curves {
        bytes.extend(edge.ends.iter().flat_map(|v| v.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::super::mesh::mesh_bytes as mesh_file;
    use super::*;
    use crate::files::{MeshExtras, Place};
    use crosscap_core::{Complex, Mesh};

    #[test]
    fn ascii_with_other_properties_keeps_single_precision() {
        let text = "ply\nformat ascii 1.0\ncomment c\nelement vertex 2\nproperty float x\n\
                    property float y\nproperty uchar red\nproperty float z\n\
                    element face 0\nproperty list uchar int vertex_indices\nend_header\n\
                    0.1 2e+0 255 3\n4 5 0 -6E-05\n";
        let numbers = |wanted: &str| {
            let wanted = wanted.parse().unwrap();
            parse_points(text.as_bytes(), &wanted).unwrap().numbers
        };
        let plain = parse_points(text.as_bytes(), &ColumnChoice::Automatic).unwrap();
        let places = Numbers::F32(vec![0.1, 2.0, 3.0, 4.0, 5.0, -6e-5]);
        assert_eq!(plain.numbers, places);
        assert_eq!(numbers("x,y,z"), places);
        assert_eq!(
            numbers("red,x"),
            Numbers::F64(vec![255.0, 0.1_f32.into(), 0.0, 4.0])
        );
    }

    #[test]
    fn a_header_that_lies_is_refused() {
        for element in [
            "element vertex 1000000000000\nproperty float x\n",
            "element vertex 1000000000000\n",
            "element vertex 18446744073709551615\nproperty double x\nproperty double y\n",
        ] {
            for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
                let text = format!("ply\nformat {encoding} 1.0\n{element}end_header\n1\n");
                let flaw = parse_points(text.as_bytes(), &ColumnChoice::Automatic).unwrap_err();
                assert_eq!(flaw.place, Place::Part("vertex".into()), "{flaw:?}");
            }
        }
    }

    #[test]
    fn edges_are_written_only_when_triangles_do_not_tell_them() {
        let written = |curves: Vec<CurveEdge>| {
            let complex = Complex::new(4, vec![[0, 1, 2], [1, 2, 3]], curves).unwrap();
            let places = PointCloud::new(3, vec![0.5; 12]).unwrap();
            let mesh = Mesh::new(complex, places, vec![-1; 4]).unwrap();
            let extras = MeshExtras::default();
            let bytes = mesh_file("ply", &mesh, &extras, None).unwrap().unwrap();
            assert_eq!(parse_mesh(&bytes).unwrap().finish().unwrap().mesh, mesh);
            bytes.windows(12).any(|w| w == b"element edge")
        };
        let rim = [[0, 1], [0, 2], [1, 3], [2, 3]].map(|[a, b]| CurveEdge::new(a, b, 1));
        assert!(!written(rim.to_vec()));
        assert!(written(rim[1..].to_vec()));
        assert!(written(vec![]));
        assert!(written([&rim[..], &[CurveEdge::new(0, 3, 0)]].concat()));
    }

    #[test]
    fn polygons_are_refused() {
        let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                    property float z\nelement face 1\nproperty list uchar int vertex_index\n\
                    end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
        let flaw = parse_mesh(text.as_bytes()).unwrap_err();
        assert_eq!(flaw.found, "4 corners");
    }
}
