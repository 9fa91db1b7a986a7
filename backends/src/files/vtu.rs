//! Unstructured grids of VTK in XML, `.vtu`: what ParaView opens.
//!
//! Triangles, and lines for the curve edges with the cell data `cells`, the number of cells that
//! meet there (-1 at triangles). What the metadata tell stands in the field data, a number or a
//! text each, with the Betti numbers; and as a whole in `metadata`, a JSON text, byte by byte.

use super::error::{Flaw, Parsed};
use super::mesh_parts::{Parts, RawCurve};
use super::mesh_sheet::Sheet;
use super::vtk_xml::{File, Piece, Source};
use base64::Engine;
use crosscap_algorithms::homology::homology;
use serde_json::Value;
use std::fmt::Write;

/// VTK's number for a line.
const LINE: i64 = 3;
/// VTK's number for a triangle.
const TRIANGLE: i64 = 5;

/// Most numbers in a list of the metadata that becomes an array of its own.
const LONGEST_LIST: usize = 64;

/// A number as VTK stores it.
trait Stored: Copy {
    const TYPE: &'static str;
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! stored {
    ($($type:ty: $name:literal),*) => {$(
        impl Stored for $type {
            const TYPE: &'static str = $name;
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )*};
}
stored!(f64: "Float64", i64: "Int64", i32: "Int32", u8: "UInt8");

/// An array: the number of its bytes and the bytes, in base64.
fn array<T: Stored>(out: &mut String, name: &str, components: usize, all: &[T]) {
    let size = size_of_val(all);
    let mut bytes = Vec::with_capacity(8 + size);
    bytes.extend((size as u64).to_le_bytes());
    all.iter().for_each(|x| x.put(&mut bytes));
    let packed = base64::engine::general_purpose::STANDARD.encode(bytes);
    // Formatting into a string cannot fail.
    let _ = writeln!(
        out,
        "<DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
         format=\"binary\">{packed}</DataArray>",
        T::TYPE
    );
}

/// An array that belongs to the grid as a whole.
fn field<T: Stored + std::fmt::Debug>(out: &mut String, name: &str, all: &[T]) {
    let numbers: Vec<String> = all.iter().map(|x| format!("{x:?}")).collect();
    let _ = writeln!(
        out,
        "<DataArray type=\"{}\" Name=\"{name}\" NumberOfTuples=\"{}\" format=\"ascii\">{}</DataArray>",
        T::TYPE,
        all.len(),
        numbers.join(" ")
    );
}

/// Betti numbers, and what the metadata tell.
fn fields(out: &mut String, sheet: &Sheet<'_>) {
    if let Ok(found) = homology(&sheet.mesh.complex) {
        let all = |numbers: [usize; 3]| numbers.map(|b| b as i64);
        field(out, "betti", &all(found.betti_rational));
        field(out, "betti_mod2", &all(found.betti_mod2));
    }
    if sheet.metadata.is_null() {
        return;
    }
    scalars(out, "", sheet.metadata);
    field(out, "metadata", sheet.metadata.to_string().as_bytes());
}

/// Every number, truth value and list of numbers, under the path that leads to it.
fn scalars(out: &mut String, path: &str, value: &Value) {
    match value {
        Value::Object(all) => {
            for (key, value) in all {
                let clean = |c: char| c.is_alphanumeric() || "_-".contains(c);
                let key: String = key.chars().filter(|&c| clean(c)).collect();
                let path = if path.is_empty() {
                    key
                } else {
                    format!("{path}.{key}")
                };
                scalars(out, &path, value);
            }
        }
        Value::Bool(b) => field(out, path, &[u8::from(*b)]),
        Value::Number(_) => number_list(out, path, std::slice::from_ref(value)),
        Value::Array(all) if all.len() <= LONGEST_LIST => number_list(out, path, all),
        _ => {}
    }
}

fn number_list(out: &mut String, path: &str, all: &[Value]) {
    let integers: Option<Vec<i64>> = all.iter().map(Value::as_i64).collect();
    let floats: Option<Vec<f64>> = all.iter().map(Value::as_f64).collect();
    match (integers, floats) {
        _ if all.is_empty() => {}
        (Some(integers), _) => field(out, path, &integers),
        (None, Some(floats)) => field(out, path, &floats),
        (None, None) => {}
    }
}

/// The bytes of the file.
pub(crate) fn bytes(sheet: &Sheet<'_>) -> Vec<u8> {
    let mesh = sheet.mesh;
    let complex = &mesh.complex;
    let mut connectivity: Vec<i64> = Vec::new();
    let mut offsets: Vec<i64> = Vec::new();
    let mut cells: Vec<i32> = Vec::new();
    for edge in &complex.curve_edges {
        connectivity.extend(edge.ends.map(i64::from));
        offsets.push(connectivity.len() as i64);
        cells.push(i32::from(edge.cells));
    }
    for triangle in &sheet.triangles {
        connectivity.extend(triangle.map(i64::from));
        offsets.push(connectivity.len() as i64);
        cells.push(-1);
    }
    let lines = complex.curve_edges.len();
    let mut types = vec![LINE as u8; lines];
    types.resize(offsets.len(), TRIANGLE as u8);

    let mut out = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n",
    );
    fields(&mut out, sheet);
    let _ = writeln!(
        out,
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>",
        complex.vertices,
        offsets.len()
    );
    array(&mut out, "point_index", 1, &mesh.point_index);
    if sheet.given || mesh.vertices.dimension() != 3 {
        let dimension = mesh.vertices.dimension();
        array(
            &mut out,
            "coordinates",
            dimension,
            mesh.vertices.coordinates(),
        );
    }
    out += "</PointData>\n<CellData>\n";
    array(&mut out, "cells", 1, &cells);
    if let Some(pieces) = sheet.pieces {
        let mut labels = vec![-1; lines];
        labels.extend_from_slice(pieces);
        array(&mut out, "piece", 1, &labels);
    }
    out += "</CellData>\n<Points>\n";
    array(&mut out, "Points", 3, sheet.places.as_flattened());
    out += "</Points>\n<Cells>\n";
    array(&mut out, "connectivity", 1, &connectivity);
    array(&mut out, "offsets", 1, &offsets);
    array(&mut out, "types", 1, &types);
    out += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    out.into_bytes()
}

/// The metadata that we wrote.
fn metadata(file: &File<'_>) -> Parsed<Value> {
    let Some(bytes) = file.field("UnstructuredGrid", "metadata")? else {
        return Ok(Value::Null);
    };
    let bytes: Vec<u8> = bytes.into_f64().iter().map(|&b| b as u8).collect();
    serde_json::from_slice(&bytes)
        .map_err(|e| Flaw::new(format!("bad JSON ({e})"), "a JSON text").within("metadata"))
}

/// Reads the file: a single piece of lines and triangles.
pub(crate) fn parse(bytes: &[u8]) -> Parsed<Parts> {
    let source = Source::new(bytes)?;
    let file = source.open()?;
    let pieces = file.pieces("UnstructuredGrid")?;
    let [piece] = &pieces[..] else {
        return Err(Flaw::new(
            format!("{} pieces of an unstructured grid", pieces.len()),
            "one",
        ));
    };
    let (dimension, coordinates) = coordinates(piece)?;
    let mut parts = Parts {
        metadata: metadata(&file)?,
        dimension,
        coordinates,
        point_index: piece.integers("PointData", "point_index")?,
        ..Parts::default()
    };
    Cells::of(piece)?.sort_into(&mut parts)?;
    Ok(parts)
}

/// The coordinates in the space of the points, and how many each has: the places where there are no others.
fn coordinates(piece: &Piece<'_, '_>) -> Parsed<(usize, Vec<f64>)> {
    let points = piece.points()?.into_f64();
    let Some((dimension, numbers)) = piece.array("PointData", Some("coordinates"))? else {
        return Ok((3, points));
    };
    let (numbers, count) = (numbers.into_f64(), points.len() / 3);
    if dimension == 0 || dimension.checked_mul(count) != Some(numbers.len()) {
        return Err(Flaw::new(
            format!("{} numbers", numbers.len()),
            format!("{dimension} for each of {count} points"),
        )
        .within("coordinates"));
    }
    Ok((dimension, numbers))
}

/// Lines and triangles as they stand in the file.
struct Cells {
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    types: Vec<i64>,
    /// How many cells of the mesh meet at each line.
    met: Option<Vec<i64>>,
    /// The piece of each triangle.
    pieces: Option<Vec<i64>>,
}

impl Cells {
    fn of(piece: &Piece<'_, '_>) -> Parsed<Self> {
        let needed = |name: &str| {
            piece
                .integers("Cells", name)?
                .ok_or_else(|| Flaw::new("no such array", "one in Cells").within(name))
        };
        let cells = Self {
            connectivity: needed("connectivity")?,
            offsets: needed("offsets")?,
            types: needed("types")?,
            met: piece.integers("CellData", "cells")?,
            pieces: piece.integers("CellData", "piece")?,
        };
        for (name, found) in [
            ("types", Some(cells.types.len())),
            ("cells", cells.met.as_ref().map(Vec::len)),
            ("piece", cells.pieces.as_ref().map(Vec::len)),
        ] {
            if let Some(found) = found.filter(|&n| n != cells.offsets.len()) {
                return Err(Flaw::new(
                    format!("{found} entries"),
                    format!("{}, one a cell", cells.offsets.len()),
                )
                .within(name));
            }
        }
        Ok(cells)
    }

    /// The corners of cell `at`, which begin at `from`.
    fn corners(&self, at: usize, from: usize) -> Parsed<&[i64]> {
        let to = self.offsets[at];
        let found = usize::try_from(to).ok();
        let corners = found.and_then(|to| self.connectivity.get(from..to));
        corners.ok_or_else(|| {
            let expected = format!("a number from {from} to {}", self.connectivity.len());
            Flaw::row("offsets", at, None, to.to_string(), expected)
        })
    }

    fn sort_into(self, parts: &mut Parts) -> Parsed<()> {
        let mut curves: Vec<RawCurve> = Vec::new();
        let mut pieces = Vec::new();
        let mut from = 0;
        for (at, &kind) in self.types.iter().enumerate() {
            let corners = self.corners(at, from)?;
            from += corners.len();
            match (kind, corners) {
                (LINE, &[a, b]) => curves.push(([a, b], self.met.as_ref().map(|c| c[at]))),
                (TRIANGLE, &[a, b, c]) => {
                    parts.triangles.push([a, b, c]);
                    pieces.extend(self.pieces.as_ref().map(|l| l[at]));
                }
                _ => {
                    return Err(Flaw::row(
                        "cells",
                        at,
                        None,
                        format!("a cell of type {kind} with {} corners", corners.len()),
                        "lines (type 3) of 2 and triangles (type 5) of 3",
                    ));
                }
            }
        }
        // Without lines and without the array that we write, the file says nothing about curves.
        parts.curves = (self.met.is_some() || !curves.is_empty()).then_some(curves);
        parts.pieces = self.pieces.is_some().then_some(pieces);
        Ok(())
    }
}
