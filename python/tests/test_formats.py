"""Files of meshes in the programs that people open them with: every cell of the table in the guide."""

import pytest

import crosscap

# Formats that a program has a reader for.
OPENS = {
    "trimesh": ("ply", "obj", "off", "stl", "glb"),
    "meshio": ("ply", "vtu", "obj", "off", "stl"),
    "pyvista": ("ply", "vtu", "obj", "off", "stl", "glb"),
    "open3d": ("ply", "obj", "off", "stl", "glb"),
    "bpy": ("ply", "obj", "stl", "glb"),
}


def in_trimesh(trimesh, path):
    return len(trimesh.load_mesh(path).faces)


def in_meshio(meshio, path):
    return len(meshio.read(path).cells_dict["triangle"])


def in_pyvista(pyvista, path):
    mesh = pyvista.read(path)
    if isinstance(mesh, pyvista.MultiBlock):
        mesh = mesh.combine()
    surface = mesh if isinstance(mesh, pyvista.PolyData) else mesh.extract_cells_by_type(5)
    return surface.n_faces_strict if isinstance(surface, pyvista.PolyData) else surface.n_cells


def in_open3d(open3d, path):
    return len(open3d.io.read_triangle_mesh(str(path)).triangles)


def in_bpy(bpy, path):
    """Blender."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    wm = bpy.ops.wm
    readers = {"ply": wm.ply_import, "obj": wm.obj_import, "stl": wm.stl_import}
    readers.get(path.suffix[1:], bpy.ops.import_scene.gltf)(filepath=str(path))
    return sum(len(o.data.polygons) for o in bpy.data.objects if o.type == "MESH")


@pytest.fixture(scope="session")
def strip():
    """With a rim, and rows of the input."""
    cloud = crosscap.sample("moebius", 4000, random_state=2, boundary=True)
    return crosscap.SurfaceReconstruction(
        eps=0.4, dl=0.2, surface=True, models=["two-planes"], boundary=cloud.boundary
    ).fit(cloud.points)


@pytest.mark.parametrize(
    ("program", "extension"), [(p, e) for p, extensions in OPENS.items() for e in extensions]
)
def test_a_program_opens_a_format(program, extension, spheres, strip, tmp_path):
    library = pytest.importorskip(program, reason=f"{program} is not installed: not tried")
    read = globals()[f"in_{program}"]
    for name, surface in [("spheres", spheres), ("strip", strip)]:
        path = tmp_path / f"{name}.{extension}"
        crosscap.write_mesh(path, surface.mesh_)
        assert read(library, path) == len(surface.triangles_), name
