//! Meshes: triangulated surfaces that may cross themselves, with their curves.

use super::error::{FileError, Flaw, Parsed};
use super::whole::{extension, packed_extension, read_bytes, write_bytes_whole};
use super::{any_cloud, glb, mesh_npz, obj, off, ply, stl, vtu};
use crosscap_algorithms::pieces::wound_triangles;
use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
use serde_json::Value;
use std::path::Path;

/// The extensions that [`write_mesh`] knows.
pub const MESH_EXTENSIONS: &str = ".npz, .vtu, .ply, .obj, .off, .stl, .glb";

/// The extensions that [`read_mesh`] knows, each also with `.gz` behind it.
pub const MESH_READ_EXTENSIONS: &str = ".npz, .vtu, .ply, .obj, .off, .stl";

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

/// Writes a mesh in the format that the extension names, whole or not at all.
///
/// The same mesh gives the same bytes.
///
/// | format | places | triangles | curves and their cells | rows of the input | pieces | metadata |
/// | --- | --- | --- | --- | --- | --- | --- |
/// | `.npz` | R^N | yes | yes | yes | yes | yes |
/// | `.vtu` | R^N | yes | yes | yes | yes | yes |
/// | `.ply` | R^3 | yes | yes | yes | yes | no |
/// | `.obj` | R^3 | yes | yes | no | no | no |
/// | `.off` | R^3 | yes | no: deduced from the triangles at an edge | no | no | no |
/// | `.stl` | R^3, single precision | yes | no | no | no | no |
/// | `.glb` | R^3, single precision | yes | yes | no | as colors | yes |
///
/// Corners of triangles are in the order of [`wound_triangles`]: those of a piece agree with each
/// other, and a closed piece in R^3 is seen from outside counter-clockwise. Numbers are kept to the
/// last bit where nothing else is said. `places` are coordinates in R^3 to show the
/// mesh with, one row a vertex; `.ply`, `.obj`, `.off`, `.stl` and `.glb` need them when N is not 3; `.vtu` takes
/// them for its points and keeps all N coordinates in the point data `coordinates`, or takes the
/// first three (or two and 0); `.npz` keeps them beside the vertices.
///
/// # The arrays of `.npz`
/// `vertices` f64 \[V,N\]; `triangles` int64 \[T,3\]; `singular_edges` int64 \[E,2\] where 3 or
/// more cells meet, `singular_cells` int64 \[E\] how many; `boundary_edges` int64 \[E,2\];
/// `curve_edges` int64 \[E,2\] and `curve_cells` int64 \[E\] for curves of 0 or 2 cells, if there
/// are any; `point_index` int64 \[V\]; `pieces` int64 \[T\] and `places` f64 \[V,3\], if given;
/// `metadata` uint8, a JSON text: `json.loads(bytes(file["metadata"]))`.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] when places are needed and not given, when
/// places or pieces do not fit the mesh, or when the mesh is none; those of
/// [`write_bytes_whole`].
///
/// ```
/// use crosscap_backends::files::{MeshExtras, read_mesh, write_mesh};
/// use crosscap_core::{Complex, CurveEdge, Mesh, PointCloud};
/// let boundary = vec![CurveEdge::new(0, 1, 1), CurveEdge::new(1, 2, 1), CurveEdge::new(0, 2, 1)];
/// let mesh = Mesh::new(
///     Complex::new(3, vec![[0, 1, 2]], boundary).unwrap(),
///     PointCloud::new(3, vec![0., 0., 0., 1., 0., 0., 0., 1., 0.]).unwrap(),
///     vec![7, 8, 9],
/// )
/// .unwrap();
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("triangle.npz");
/// write_mesh(&path, &mesh, &MeshExtras::default(), None).unwrap();
/// assert_eq!(read_mesh(&path).unwrap().mesh, mesh);
/// ```
pub fn write_mesh(
    path: impl AsRef<Path>,
    mesh: &Mesh,
    extras: &MeshExtras,
    places: Option<&PointCloud<f64>>,
) -> Result<(), FileError> {
    let path = path.as_ref();
    let extension = extension(path);
    let bytes = mesh_bytes(&extension, mesh, extras, places)
        .ok_or_else(|| unknown(path, &extension))?
        .map_err(|flaw| flaw.of(path))?;
    write_bytes_whole(path, &bytes)
}

/// Reads a mesh in the format that the extension names.
///
/// What a format does not keep (see [`write_mesh`]) comes back so: rows of the input as -1;
/// curves, when the file has none, as the edges with 1 triangle (boundary) or with 3 or more
/// (singular, with their number). Triangles come back in canonical order, pieces with them.
///
/// # Errors
/// [`FileError::Extension`]; [`FileError::Content`] with the place for an index out of range, a
/// repeated corner, a polygon of more than three corners, a number that is not finite, a
/// truncated file; those of reading a file.
pub fn read_mesh(path: impl AsRef<Path>) -> Result<MeshFile, FileError> {
    let path = path.as_ref();
    let extension = packed_extension(path);
    if !MESH_READ_EXTENSIONS
        .split(", ")
        .any(|known| known[1..] == extension)
    {
        return Err(FileError::Extension {
            path: path.into(),
            extension,
            known: MESH_READ_EXTENSIONS,
        });
    }
    let bytes = read_bytes(path)?;
    parse(&extension, &bytes).map_err(|flaw| flaw.of(path))
}

fn unknown(path: &Path, extension: &str) -> FileError {
    FileError::Extension {
        path: path.into(),
        extension: extension.into(),
        known: MESH_EXTENSIONS,
    }
}

/// Reads the bytes of a mesh file with a known extension.
pub(crate) fn parse(extension: &str, bytes: &[u8]) -> Parsed<MeshFile> {
    match extension {
        "npz" => mesh_npz::parse(bytes),
        "vtu" => vtu::parse(bytes),
        "ply" => ply::parse_mesh(bytes),
        "obj" => obj::parse(bytes),
        "stl" => stl::parse(bytes),
        _ => off::parse(bytes),
    }?
    .finish()
}

/// The bytes of a mesh file; `None` for an unknown extension.
pub(crate) fn mesh_bytes(
    extension: &str,
    mesh: &Mesh,
    extras: &MeshExtras,
    places: Option<&PointCloud<f64>>,
) -> Option<Parsed<Vec<u8>>> {
    let write: fn(&Sheet<'_>) -> Vec<u8> = match extension {
        "npz" => mesh_npz::bytes,
        "vtu" => vtu::bytes,
        "ply" => ply::mesh_bytes,
        "obj" => obj::bytes,
        "off" => off::bytes,
        "stl" => stl::bytes,
        "glb" => glb::bytes,
        _ => return None,
    };
    let any_dimension = matches!(extension, "npz" | "vtu");
    Some(Sheet::new(mesh, extras, places, any_dimension).map(|sheet| write(&sheet)))
}

/// A mesh that was checked and given places, as the writers take it.
pub(crate) struct Sheet<'a> {
    pub(crate) mesh: &'a Mesh,
    /// The triangles of the complex in their order, wound.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Places in R^3, one a vertex.
    pub(crate) places: Vec<[f64; 3]>,
    /// Whether the caller gave the places.
    pub(crate) given: bool,
    pub(crate) pieces: Option<&'a [i64]>,
    pub(crate) metadata: &'a Value,
}

impl<'a> Sheet<'a> {
    fn new(
        mesh: &'a Mesh,
        extras: &'a MeshExtras,
        places: Option<&PointCloud<f64>>,
        any_dimension: bool,
    ) -> Parsed<Self> {
        let complex = &mesh.complex;
        let count = complex.vertices;
        Complex::new(
            count,
            complex.triangles.clone(),
            complex.curve_edges.clone(),
        )
        .map_err(|e| Flaw::new(format!("no mesh ({e})"), "a mesh").within("complex"))?;
        if mesh.vertices.len() != count || mesh.point_index.len() != count {
            return Err(Flaw::new(
                format!(
                    "{} places and {} rows",
                    mesh.vertices.len(),
                    mesh.point_index.len()
                ),
                format!("{count} of each, one a vertex"),
            )
            .within("vertices"));
        }
        let triangles = wound_triangles(mesh)
            .map_err(|e| Flaw::new(format!("no mesh ({e})"), "a mesh").within("complex"))?;
        if let Some(pieces) = &extras.pieces
            && pieces.len() != complex.triangles.len()
        {
            return Err(Flaw::new(
                format!("{} labels", pieces.len()),
                format!("{}, one a triangle", complex.triangles.len()),
            )
            .within("pieces"));
        }
        let shown = match places {
            Some(places) if places.len() == count && places.dimension() == 3 => places,
            Some(places) => {
                return Err(Flaw::new(
                    format!("{} places in R^{}", places.len(), places.dimension()),
                    format!("{count} in R^3, one a vertex"),
                )
                .within("places"));
            }
            None if any_dimension || mesh.vertices.dimension() == 3 => &mesh.vertices,
            None => {
                return Err(Flaw::new(
                    format!("a mesh in R^{}", mesh.vertices.dimension()),
                    "places in R^3, which this format holds: give some (a projection), or write \
                     .npz or .vtu",
                ));
            }
        };
        let places = shown
            .iter()
            .map(|p| std::array::from_fn(|k| p.get(k).copied().unwrap_or(0.0)))
            .collect();
        Ok(Self {
            mesh,
            triangles,
            places,
            given: !std::ptr::eq(shown, &mesh.vertices),
            pieces: extras.pieces.as_deref(),
            metadata: &extras.metadata,
        })
    }
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
        let triangles = self
            .triangles
            .iter()
            .enumerate()
            .map(|(at, corners)| {
                let mut t = indices(*corners, count, "triangles", at)?;
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
            })
            .collect::<Parsed<Vec<_>>>()?;
        let census = census(&triangles);
        let curves = match self.curves {
            Some(raw) => raw
                .iter()
                .enumerate()
                .map(|(at, (ends, cells))| {
                    let [a, b] = indices(*ends, count, "curve edges", at)?;
                    let cells = cells.unwrap_or_else(|| triangles_at(&census, a, b));
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
                })
                .collect::<Parsed<Vec<_>>>()?,
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
