use super::*;

fn with_header(text: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(data);
    bytes
}

fn doubles(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

#[test]
fn the_bytes_are_those_that_numpy_writes() {
    let bytes = bytes(&[2], &[1_u8, 2]);
    let text = "{'descr': '|u1', 'fortran_order': False, 'shape': (2,)}";
    assert_eq!(bytes.len(), 128 + 2);
    assert!(bytes[10..].starts_with(text.as_bytes()));
    assert_eq!(&bytes[126..], [b' ', b'\n', 1, 2]);
    assert_eq!(parse(&bytes).unwrap().shape, [2]);
}

#[test]
fn fortran_order_and_every_integer() {
    for shape in ["(2, 3)", "(1, 2, 3)", "(2, 3, 1)"] {
        let header = format!("{{'descr': '<f8', 'fortran_order': True, 'shape': {shape}}}");
        let bytes = with_header(&header, &doubles(&[1.0, 4.0, 2.0, 5.0, 3.0, 6.0]));
        let back = parse(&bytes).unwrap();
        assert_eq!(back.rows_columns().unwrap(), (2, 3));
        assert_eq!(
            back.numbers,
            Numbers::F64(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
        );
    }
    macro_rules! kind {
        ($($type:ty),*) => {$(
            let a = [0 as $type, 7, <$type>::MAX / 2];
            let back = parse(&bytes(&[3], &a)).unwrap().into_integers().unwrap();
            assert_eq!(back, [0, 7, (<$type>::MAX / 2) as i64]);
        )*};
    }
    kind!(i8, i16, i32, i64, u8, u16, u32, u64);
    let too_large = bytes(&[2], &[1, u64::MAX]);
    assert!(parse(&too_large).unwrap_err().found.contains("entry 1"));
}

#[test]
fn big_endian_and_half_precision() {
    let header = "{'descr': '>i2', 'fortran_order': False, 'shape': (1,), }\n";
    let array = parse(&with_header(header, &[0, 5])).unwrap();
    assert_eq!(array.numbers, Numbers::Integer(vec![5]));
    let half = [0.5, -0.1].map(f16::from_f32);
    let array = parse(&bytes(&[1, 2], &half)).unwrap();
    assert!(array.half);
    assert_eq!(array.numbers, Numbers::F32(half.map(f32::from).to_vec()));
}

#[test]
fn records_become_columns() {
    let header = "{'descr': [('x', '<f4'), ('name', '|S2'), ('n', '<f4', (2,))], \
                  'fortran_order': False, 'shape': (2,)}";
    let mut data = Vec::new();
    for row in [[1.0_f32, 2.0, 3.0], [4.0, 5.0, 6.0]] {
        data.extend(row[0].to_le_bytes());
        data.extend(b"ab");
        data.extend(row[1..].iter().flat_map(|x| x.to_le_bytes()));
    }
    let array = parse(&with_header(header, &data)).unwrap();
    assert_eq!(array.shape, [2, 3]);
    assert_eq!(array.names.unwrap(), ["x", "n[0]", "n[1]"]);
    assert_eq!(
        array.numbers,
        Numbers::F32(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    );
}

#[test]
fn what_is_no_number_is_told_by_its_name() {
    for (kind, width, found) in [
        ("|b1", 1, "truth values"),
        ("<c16", 16, "complex numbers"),
        ("<f16", 16, "long doubles"),
        ("|O", 3, "Python objects"),
        ("<U4", 16, "type \"U4\""),
    ] {
        let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': (1, 1)}}");
        let flaw = parse(&with_header(&header, &vec![0; width])).unwrap_err();
        assert!(flaw.found.contains(found), "{flaw:?}");
    }
}

#[test]
fn a_header_that_lies_is_refused_before_allocation() {
    for shape in [
        "(1000000000000, 3)",
        "(18446744073709551615, 18446744073709551615)",
        "(2, 1)",
    ] {
        let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        let flaw = parse(&with_header(&text, &[0; 8])).unwrap_err();
        assert_eq!(flaw.found, "8 bytes of data");
        assert!(flaw.expected.contains("header promises"), "{flaw:?}");
    }
    let nested = "(".repeat(60_000);
    let flaw = parse(&with_header(&nested, &[])).unwrap_err();
    assert!(flaw.found.contains("nested"), "{flaw:?}");
}
