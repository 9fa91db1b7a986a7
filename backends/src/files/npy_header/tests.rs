use super::*;

fn header_of(text: &str) -> Parsed<Header> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    parse(&bytes).map(|(header, rest)| {
        assert!(rest.is_empty());
        header
    })
}

#[test]
fn arrays_and_records() {
    let plain = header_of("{'descr': '>f4', 'fortran_order': True, 'shape': (3, 4), }    \n");
    let plain = plain.unwrap();
    assert!(plain.fortran && !plain.record && plain.fields[0].big);
    assert_eq!((plain.shape.as_slice(), plain.entry()), (&[3, 4][..], 4));
    let record = header_of(
        "{\"shape\": (7,), 'fortran_order': False, 'descr': [('x', '<f8'), ('', '|V4'), \
         (('Normal', 'n'), '<f4', (3,)), ('c', [('r', '|u1'), ('g', '|u1')]), ('s', '<U2')]}",
    )
    .unwrap();
    let names: Vec<_> = record
        .fields
        .iter()
        .map(|f| (f.name.as_str(), f.count))
        .collect();
    assert_eq!(
        names,
        [
            ("x", 1),
            ("", 1),
            ("n", 3),
            ("c.r", 1),
            ("c.g", 1),
            ("s", 1)
        ]
    );
    assert_eq!(record.entry(), 8 + 4 + 12 + 2 + 8);
}

#[test]
fn what_is_no_header_is_refused() {
    for (text, found) in [
        ("", "a truncated header"),
        ("  ", "a bad header"),
        ("{'descr': '<f8'", "comma"),
        ("{'descr': '<f8', 'shape': (1,)}", "entry fortran_order"),
        (
            "{'descr': '<f', 'fortran_order': False, 'shape': ()}",
            "width",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
            "-1",
        ),
        (
            "{'descr': '<f8', 'fortran_order': False, 'shape': (1,)} x",
            "\"x\"",
        ),
        (
            "{'descr': '|S999999999', 'fortran_order': False, 'shape': (1,)}",
            "entries of more bytes",
        ),
        ("((((((((((", "nested"),
    ] {
        let flaw = header_of(text).unwrap_err();
        assert!(flaw.found.contains(found), "{text}: {flaw:?}");
    }
}
