//! A mesh as it is read: parts that are checked and put together.

use super::any_cloud;
use super::error::{Flaw, Parsed};
use crosscap_core::{Complex, CurveEdge, Mesh};
use serde_json::Value;

/// What belongs to a mesh beside the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshExtras {
    /// Anything about how the mesh came to be: parameters, seed, verdict; `Null` for nothing.
    pub metadata: Value,
    /// For each triangle of [`Complex::triangles`] the piece of the surface it belongs to.
    pub pieces: Option<Vec<i64>>,
}

/// A mesh as it was read.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshFile {
    /// The mesh.
    pub mesh: Mesh,
    /// What was kept beside it.
    pub extras: MeshExtras,
}

/// A curve edge as a file has it: ends, and the number of cells where the file tells.
pub(crate) type RawCurve = ([i64; 2], Option<i64>);

/// What a file says, before anything of it is believed.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub(crate) dimension: usize,
    pub(crate) coordinates: Vec<f64>,
    pub(crate) triangles: Vec<[i64; 3]>,
    /// `None` when the file says nothing about curves.
    pub(crate) curves: Option<Vec<RawCurve>>,
    pub(crate) point_index: Option<Vec<i64>>,
    pub(crate) pieces: Option<Vec<i64>>,
    pub(crate) metadata: Value,
}

impl Parts {
    /// Checks everything and puts the mesh together.
    pub(crate) fn finish(self) -> Parsed<MeshFile> {
        let vertices = any_cloud::points(self.dimension, self.coordinates)
            .map_err(|flaw| flaw.within("vertices"))?;
        let count = vertices.len();
        let triangles = triangles(&self.triangles, count)?;
        let census = census(&triangles);
        let curves = match &self.curves {
            Some(raw) => curves(raw, count, &census)?,
            None => deduced(&census)?,
        };
        let of_length = |name: &str, all: Vec<i64>, wanted: usize| {
            if all.len() == wanted {
                Ok(all)
            } else {
                Err(Flaw::new(format!("{} entries", all.len()), wanted.to_string()).within(name))
            }
        };
        let point_index = match self.point_index {
            Some(rows) => of_length("point_index", rows, count)?,
            None => vec![-1; count],
        };
        // The canonical order of the triangles is not that of the file: labels go along.
        let pieces = match self.pieces {
            Some(labels) => {
                let labels = of_length("pieces", labels, triangles.len())?;
                let mut labelled: Vec<_> = triangles.iter().zip(labels).collect();
                labelled.sort_unstable();
                Some(labelled.into_iter().map(|(_, label)| label).collect())
            }
            None => None,
        };
        let none = |e: crosscap_core::Error| Flaw::new(format!("no mesh ({e})"), "a mesh");
        let complex = Complex::new(count, triangles, curves).map_err(none)?;
        let mesh = Mesh::new(complex, vertices, point_index).map_err(none)?;
        Ok(MeshFile {
            mesh,
            extras: MeshExtras {
                metadata: self.metadata,
                pieces,
            },
        })
    }
}

/// Triangles of so many vertices, the corners of each in order.
fn triangles(raw: &[[i64; 3]], vertices: usize) -> Parsed<Vec<[u32; 3]>> {
    let one = |(at, corners): (usize, &[i64; 3])| {
        let mut t = indices(*corners, vertices, "triangles", at)?;
        t.sort_unstable();
        if t[0] == t[1] || t[1] == t[2] {
            return Err(Flaw::row(
                "triangles",
                at,
                None,
                format!("corners {corners:?}"),
                "three different ones",
            ));
        }
        Ok(t)
    };
    raw.iter().enumerate().map(one).collect()
}

/// Curve edges of so many vertices; where a file does not say how many cells meet in one, as many as it has triangles.
fn curves(raw: &[RawCurve], vertices: usize, census: &[([u32; 2], i64)]) -> Parsed<Vec<CurveEdge>> {
    let one = |(at, (ends, cells)): (usize, &RawCurve)| {
        let [a, b] = indices(*ends, vertices, "curve edges", at)?;
        let cells = cells.unwrap_or_else(|| triangles_at(census, a, b));
        let cells = u8::try_from(cells).map_err(|_| {
            Flaw::row(
                "curve edges",
                at,
                None,
                format!("{cells} cells"),
                "0 to 255 cells that meet",
            )
        })?;
        Ok(CurveEdge::new(a, b, cells))
    };
    raw.iter().enumerate().map(one).collect()
}

fn indices<const K: usize>(
    raw: [i64; K],
    count: usize,
    what: &str,
    row: usize,
) -> Parsed<[u32; K]> {
    let mut good = [0; K];
    for (k, &i) in raw.iter().enumerate() {
        good[k] = u32::try_from(i)
            .ok()
            .filter(|&i| (i as usize) < count)
            .ok_or_else(|| {
                Flaw::row(
                    what,
                    row,
                    Some(k),
                    format!("vertex {i}"),
                    format!("a vertex from 0 to {}", count as i64 - 1),
                )
            })?;
    }
    Ok(good)
}

/// Every edge of the triangles, sorted, with the number of triangles at it.
fn census(triangles: &[[u32; 3]]) -> Vec<([u32; 2], i64)> {
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [a, c], [b, c]])
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .map(|run| (run[0], run.len() as i64))
        .collect()
}

/// The curves that triangles alone tell: edges with any number of them but two.
fn deduced(census: &[([u32; 2], i64)]) -> Parsed<Vec<CurveEdge>> {
    census
        .iter()
        .filter(|(_, triangles)| *triangles != 2)
        .map(|&([a, b], triangles)| {
            let cells = u8::try_from(triangles).map_err(|_| {
                Flaw::new(
                    format!("{triangles} triangles at the edge [{a}, {b}]"),
                    "at most 255",
                )
            })?;
            Ok(CurveEdge::new(a, b, cells))
        })
        .collect()
}

/// Whether the curves of a complex are those that its triangles alone tell.
pub(crate) fn tells_its_curves(complex: &Complex) -> bool {
    deduced(&census(&complex.triangles)).is_ok_and(|curves| curves == complex.curve_edges)
}

fn triangles_at(census: &[([u32; 2], i64)], a: u32, b: u32) -> i64 {
    let edge = [a.min(b), a.max(b)];
    census
        .binary_search_by_key(&edge, |&(edge, _)| edge)
        .map_or(0, |at| census[at].1)
}
