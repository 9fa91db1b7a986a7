use super::*;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// A grid of two points whose array stands in the file in one of the ways there are.
fn grid(root: &str, array: &str, content: &[u8], appended: &[u8]) -> Vec<u8> {
    let mut bytes = format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" {root}><PolyData><Piece><Points>\
         <DataArray type=\"Float32\" NumberOfComponents=\"3\" {array}>"
    )
    .into_bytes();
    bytes.extend(content);
    bytes.extend(b"</DataArray></Points></Piece></PolyData>");
    bytes.extend(appended);
    bytes.extend(b"</VTKFile>");
    bytes
}

#[test]
fn arrays_are_read_however_they_are_stored() {
    let numbers = [0.5_f32, 1.0, 2.0, 3.0, 4.0, -5.0];
    let data: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let plain = [&24_u32.to_le_bytes()[..], &data].concat();
    let mut blocks = Vec::new();
    for half in data.chunks(12) {
        let mut packer = ZlibEncoder::new(Vec::new(), Compression::fast());
        packer.write_all(half).unwrap();
        blocks.push(packer.finish().unwrap());
    }
    let sizes = [2, 12, 0, blocks[0].len() as u64, blocks[1].len() as u64];
    let head: Vec<u8> = sizes.iter().flat_map(|s| s.to_le_bytes()).collect();
    let body = blocks.concat();
    let zlib = "compressor=\"vtkZLibDataCompressor\" header_type=\"UInt64\"";
    let at = "format=\"appended\" offset=\"2\"";
    let base64 = |b: &[u8]| STANDARD.encode(b).into_bytes();
    let packed = [base64(&head), base64(&body)].concat();
    let append = |encoding: &str, data: &[u8]| {
        let mut all = format!("<AppendedData encoding=\"{encoding}\">\n _xx").into_bytes();
        all.extend(data);
        all.extend(b"\n</AppendedData>");
        all
    };
    let raw = [&head[..], &body].concat();
    for (name, bytes) in [
        (
            "ascii",
            grid("", "format=\"ascii\"", b" 0.5 1\n2 3 4 -5 ", b""),
        ),
        (
            "binary",
            grid("", "format=\"binary\"", &base64(&plain), b""),
        ),
        ("packed", grid(zlib, "format=\"binary\"", &packed, b"")),
        ("raw", grid("", at, b"", &append("raw", &plain))),
        ("packed raw", grid(zlib, at, b"", &append("raw", &raw))),
        (
            "base64",
            grid("", at, b"", &append("base64", &base64(&plain))),
        ),
        (
            "packed base64",
            grid(zlib, at, b"", &append("base64", &packed)),
        ),
    ] {
        let array = parse_points(&bytes, "PolyData").unwrap_or_else(|f| panic!("{name}: {f:?}"));
        assert_eq!(array.shape, [2, 3], "{name}");
        let expected = numbers.map(f64::from);
        assert_eq!(array.numbers.into_f64(), expected, "{name}");
    }
}

#[test]
fn nesting_is_counted_as_the_parser_sees_it() {
    for (text, deepest) in [
        ("<?xml version=\"1.0\"?><a><b/><b x='/>'/><c></c></a>", 2),
        ("<a><!-- </a><b><c> --><d e=\">\"><f/></d></a>", 3),
        ("<a><![CDATA[</a></a>]]><b><c/></b></a>", 3),
        ("<a><a><a", 3),
        ("", 0),
    ] {
        assert_eq!(nesting(text), deepest, "{text}");
    }
}
