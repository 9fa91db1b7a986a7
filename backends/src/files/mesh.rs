//! Meshes: triangulated surfaces that may cross themselves, with their curves.

use super::error::{FileError, Parsed};
use super::mesh_parts::{MeshExtras, MeshFile};
use super::mesh_sheet::Sheet;
use super::whole::{extension, packed_extension, read_bytes, write_bytes_whole};
use super::{glb, mesh_npz, obj, off, ply, stl, vtu};
use crosscap_core::{Mesh, PointCloud};
use std::path::Path;

/// The extensions that [`write_mesh`] knows.
pub const MESH_EXTENSIONS: &str = ".npz, .vtu, .ply, .obj, .off, .stl, .glb";

/// The extensions that [`read_mesh`] knows, each also with `.gz` behind it.
pub const MESH_READ_EXTENSIONS: &str = ".npz, .vtu, .ply, .obj, .off, .stl";

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
/// Corners of triangles are in the order of [`wound_triangles`](crosscap_algorithms::pieces::wound_triangles): those of a piece agree with each
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
