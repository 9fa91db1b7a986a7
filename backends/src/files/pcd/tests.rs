use super::*;

fn file(data: &str, rest: &[u8]) -> Vec<u8> {
    let head = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x rgb y z\nSIZE 4 4 4 4\nTYPE F U F F\nCOUNT 1 1 1 1\nWIDTH 2\n\
         HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
    );
    [head.as_bytes(), rest].concat()
}

#[test]
fn text_binary_and_packed_are_the_same_points() {
    let places = [1.0_f32, 2.0, 3.0, -4.0, 5.5, 6.0];
    let put = |x: f32| x.to_le_bytes();
    let color = 0x00ff_00ff_u32.to_le_bytes();
    let mut rows = Vec::new();
    for p in places.chunks(3) {
        rows.extend([put(p[0]), color, put(p[1]), put(p[2])].concat());
    }
    let fields: Vec<u8> = [
        put(1.0),
        put(-4.0),
        color,
        color,
        put(2.0),
        put(5.5),
        put(3.0),
        put(6.0),
    ]
    .concat();
    // Bytes as they are, at most 32 of them together.
    let mut packed = Vec::new();
    for chunk in fields.chunks(32) {
        packed.push(chunk.len() as u8 - 1);
        packed.extend(chunk);
    }
    let mut compressed = (packed.len() as u32).to_le_bytes().to_vec();
    compressed.extend((fields.len() as u32).to_le_bytes());
    compressed.extend(packed);
    let expected = places.map(f64::from);
    for (data, rest) in [
        ("ascii", &b"1 9 2 3\n-4 9 5.5 6\n"[..]),
        ("binary", &rows),
        ("binary_compressed", &compressed),
    ] {
        let array = parse(&file(data, rest), &ColumnChoice::Automatic).unwrap();
        assert_eq!(array.shape, [2, 3]);
        assert_eq!(array.numbers.into_f64(), expected, "{data}");
    }
    let chosen = parse(
        &file("ascii", b"1 9 2 3\n4 8 5 6\n"),
        &"rgb,x".parse().unwrap(),
    );
    assert_eq!(chosen.unwrap().numbers.into_f64(), [9.0, 1.0, 8.0, 4.0]);
}

#[test]
fn runs_that_overlap_are_unpacked() {
    // One byte, then nine from one back: ten times the same.
    assert_eq!(unpack(&[0, b'a', 7 << 5, 0, 0], 10).unwrap(), [b'a'; 10]);
    assert!(unpack(&[32, 5], 3).is_err());
    assert!(unpack(&[0, b'a'], 2).is_err());
    assert!(unpack(&[0], usize::MAX).is_err());
}

#[test]
fn lies_and_gaps_are_told() {
    let told = |bytes: &[u8]| parse(bytes, &ColumnChoice::Automatic).unwrap_err();
    assert!(
        told(&file("ascii", b"1 9 2 3\n"))
            .found
            .contains("1 points")
    );
    assert!(
        told(&file("ascii", b"1 9 nan 3\n"))
            .expected
            .contains("not measured")
    );
    assert!(told(&file("binary", b"1234")).found.contains("4 bytes"));
    assert!(told(&file("gzip", b"")).found.contains("gzip"));
    assert!(
        told(b"FIELDS a\nSIZE 4\nTYPE F\nPOINTS 1\nDATA ascii\n1\n")
            .expected
            .contains("--columns")
    );
    assert!(
        told(b"FIELDS x\nDATA ascii\n")
            .found
            .contains("1 fields, 0 sizes")
    );
    assert!(told(b"").found.contains("no line DATA"));
}
