//! No reader takes memory for what a header merely promises.
//!
//! One test in a process of its own: the allocator counts for everybody.

use crosscap_backends::files::{
    POINT_EXTENSIONS, PointOptions, read_distances, read_indices, read_mesh, read_points,
};
use proptest::test_runner::{Config, TestRunner};
use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator with a record of the largest block asked for.
struct Counting;

static LARGEST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LARGEST.fetch_max(layout.size(), Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        LARGEST.fetch_max(layout.size(), Relaxed);
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        LARGEST.fetch_max(size, Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Largest block that a file of a few hundred bytes may cost: buffers of the libraries included.
const LIMIT: usize = 8 << 20;

fn npy(shape: &str, data: usize) -> Vec<u8> {
    let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.resize(bytes.len() + data, 0);
    bytes
}

fn mat(dimensions: [u32; 2], size: u32) -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes.extend([0, 1, b'I', b'M']);
    for word in [14, size, 6, 8, 6, 0, 5, 8] {
        bytes.extend(u32::to_le_bytes(word));
    }
    for word in dimensions {
        bytes.extend(word.to_le_bytes());
    }
    for word in [1 | 1 << 16, u32::from(b'X'), 9, size, 0, 0] {
        bytes.extend(u32::to_le_bytes(word));
    }
    bytes
}

/// A scan of four thousand million points of 65535 bytes.
fn las() -> Vec<u8> {
    let mut bytes = b"LASF".to_vec();
    bytes.resize(300, 0);
    bytes[105..111].fill(255);
    bytes
}

fn liars() -> Vec<Vec<u8>> {
    let ply = |encoding: &str, property: &str| {
        format!(
            "ply\nformat {encoding} 1.0\nelement vertex 1000000000000\n{property}\
             property list uint float l\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}"
        )
        .into_bytes()
    };
    vec![
        npy("(1000000000000, 3)", 24),
        npy("(1000000000000,)", 24),
        npy("(1000000, 1000000)", 24),
        npy("(0, 1000000000000)", 0),
        mat([2_000_000_000, 3], 56),
        mat([3, 3], u32::MAX - 8),
        ply("ascii", ""),
        ply("binary_little_endian", "property double x\n"),
        ply("binary_big_endian", ""),
        b"OFF\n1000000000000 1000000000000 0\n0 0 0\n".to_vec(),
        b"1000000000000\n\nC 0 0 0\n".to_vec(),
        b"nOFF\n1000000000000\n1000000000000 1 0\n0 0 0\n".to_vec(),
        b"# .PCD\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nPOINTS 1000000000000\nDATA binary\n12345678".to_vec(),
        b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 9\nDATA binary_compressed\n\x04\0\0\0\xff\xff\xff\xff1234".to_vec(),
        b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1000000000000 double\n1234".to_vec(),
        [vec![b' '; 80], vec![255; 54]].concat(),
        las(),
        b"v 0 0 0\nf 1 1000000000000 2\n".to_vec(),
        b"<VTKFile><UnstructuredGrid><Piece NumberOfPoints=\"4000000000\"><Points>\
          <DataArray type=\"Float64\" NumberOfComponents=\"4000000000\" format=\"binary\">\
          ////fw==</DataArray></Points></Piece></UnstructuredGrid></VTKFile>"
            .to_vec(),
    ]
}

fn read_all(folder: &Path, bytes: &[u8]) {
    for extension in POINT_EXTENSIONS.split(", ").map(|e| &e[1..]) {
        let path = folder.join(format!("file.{extension}"));
        std::fs::write(&path, bytes).unwrap();
        let _ = read_points(&path, &PointOptions::default());
        let _ = read_mesh(&path);
        let _ = read_indices(&path);
        let _ = read_distances(&path);
    }
}

#[test]
fn a_promise_costs_no_memory() {
    let folder = tempfile::tempdir().unwrap();
    let liars = liars();
    for bytes in &liars {
        LARGEST.store(0, Relaxed);
        read_all(folder.path(), bytes);
        let largest = LARGEST.load(Relaxed);
        assert!(largest < LIMIT, "{largest} bytes at once");
        assert!(largest > 0, "the allocator counts");
    }
    // The same files with a few bytes changed.
    let mut runner = TestRunner::new(Config {
        cases: 100,
        failure_persistence: None,
        ..Config::default()
    });
    let changes = proptest::collection::vec((0..200_usize, proptest::num::u8::ANY), 1..5);
    runner
        .run(&(0..liars.len(), changes), |(which, changes)| {
            let mut bytes = liars[which].clone();
            for (at, byte) in changes {
                let at = at % bytes.len();
                bytes[at] = byte;
            }
            LARGEST.store(0, Relaxed);
            read_all(folder.path(), &bytes);
            let largest = LARGEST.load(Relaxed);
            proptest::prop_assert!(largest < LIMIT, "{largest} bytes at once");
            Ok(())
        })
        .unwrap();
}
