use super::*;

fn table(text: &str) -> Table {
    parse(text.as_bytes(), &ColumnChoice::Automatic).unwrap_or_else(|f| panic!("{text:?}: {f:?}"))
}

#[test]
fn separators_comments_and_headers() {
    let expected = [1.0, 2.5, -3e4, 4.0];
    for text in [
        "1,2.5\n-3e4,4\n",
        "1;2.5\n-3e4;4",
        "1 2.5\r\n-3e4\t 4\r\n",
        "1\t2.5\r\n-3e4 4\r\n",
        "x,y\n\n1, 2.5\n# between\n-3e4 ,4 # behind\n",
        "\u{feff}# first\n  x y\n 1   2.5\n-3e4 4\n\n",
        "# a, b; c\n\"1\",\"2.5\"\n-3e4,4\n",
        "# a, b; c\n1 2.5\n-3e4 4\n",
        "% of MATLAB\n1 2.5\n-3e4 4\n",
        "// of a scanner\n1 2.5\n-3e4 4\n",
        "X [m],Y [m]\n(local),(local)\n1,2.5\n-3e4,4\n",
        "x,y,\n1,2.5,\n-3e4,4,\n",
        "X of it\tY of it\n1\t2.5\n-3e4\t4\n",
        "1;2,5\n-3e4;4",
        "1,0 2,5\n-3e4 4",
        "1,0\t2,5\n-3e4\t4",
        "2\n1,2.5\n-3e4,4\n",
    ] {
        assert_eq!(table(text).numbers, expected, "{text:?}");
    }
}

#[test]
fn named_positions_are_taken_alone() {
    for text in [
        ",x,y,z\n0,1,2,3\n1,4,5,6\n",
        "x,y,z,r,g,b\n1,2,3,9,9,9\n4,5,6,9,9,9\n",
        "x,y,z,class\n1,2,3,ground\n4,5,6,\"tall, green\"\n",
        "Z;X;name;Y\n3;1;a;2\n6;4;b;5\n",
        "\"x\" \"y\" \"z\"\n\"row 1\" 1 2 3\n\"row 2\" 4 5 6\n",
        "//X Y Z R\n1 2 3 9\n4 5 6 9\n",
        "# x, y, z, time\n1 2 3 9\n4 5 6 9\n",
        "Points:0,Points:1,Points:2,t\n1,2,3,0\n4,5,6,0\n",
    ] {
        assert_eq!(
            table(text).numbers,
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            "{text:?}"
        );
    }
    let four = table("x,y,z,w\n1,2,3,4\n");
    assert_eq!(four.columns, 4);
}

#[test]
fn columns_are_chosen_by_number_and_name() {
    let text = "time,name,Height (m),x\n0,a,1,2\n1,b,3,4\n";
    let chosen = |wanted: &str| parse(text.as_bytes(), &wanted.parse().unwrap());
    assert_eq!(chosen("3,height").unwrap().numbers, [2.0, 1.0, 4.0, 3.0]);
    assert_eq!(chosen("0,2-3").unwrap().columns, 3);
    for (wanted, found) in [
        ("4,0", "4 columns: time"),
        ("x,y", "4 columns"),
        ("0,0", "twice"),
    ] {
        assert!(
            chosen(wanted).unwrap_err().found.contains(found),
            "{wanted}"
        );
    }
    let flaw = chosen("all").unwrap_err();
    assert!(flaw.expected.contains("--columns"), "{flaw:?}");
}

#[test]
fn names_line_and_column() {
    for (text, line, field, found) in [
        ("1,2\n3,x\n", 2, Some(2), "\"x\""),
        ("1,2\n\n# c\n3,\n", 4, Some(2), "an empty field"),
        ("1 2\n3 4 5\n", 2, None, "3 columns"),
        ("1 2\n3 inf\n", 2, Some(2), "inf"),
        ("nan;2\n", 1, Some(1), "NaN"),
        ("1,5;2,5\n1.5;2\n", 2, Some(1), "\"1.5\""),
        ("x,y,z\n1,2\n", 2, None, "2 columns"),
        ("a\nb\nc\n1 2\n", 3, Some(1), "\"c\""),
        ("5\n1 2\n3 4\n", 1, None, "the promise of 5 rows"),
    ] {
        let flaw = parse(text.as_bytes(), &ColumnChoice::Automatic).unwrap_err();
        let place = crate::files::Place::Line { line, field };
        assert_eq!(
            (&flaw.place, flaw.found.as_str()),
            (&place, found),
            "{text:?}"
        );
    }
}
