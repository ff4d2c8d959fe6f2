//! STL files in the spelling of many programs.

use super::*;

/// A triangle in height `z`, as text.
fn facet(z: f64) -> String {
    format!(
        "facet normal 0 0 1\n outer loop\n  vertex 0 0 {z}\n  vertex 10 0 {z}\n  vertex 0 10 {z}\n endloop\nendfacet\n"
    )
}

fn count(text: impl AsRef<[u8]>) -> usize {
    read(text.as_ref()).unwrap_or_else(|problem| panic!("{problem}")).triangles.len()
}

#[test]
fn all_solids_of_a_text_are_read() {
    let two = format!("solid a\n{}endsolid a\nsolid b\n{}{}endsolid b\n", facet(0.0), facet(5.0), facet(6.0));
    let all = read(two.as_bytes()).unwrap();
    assert_eq!((all.triangles.len(), all.corners.len()), (3, 9));
    assert!(all.corners.contains(&[10.0, 0.0, 6.0]));
    assert_eq!(read(format!("solid a\n{}{}", facet(0.0), facet(-0.0)).as_bytes()).unwrap().corners.len(), 3);
    // The end of a solid may be missing, between two and at last.
    assert_eq!(count(two.replace("endsolid a\n", "").replace("endsolid b\n", "")), 3);
}

#[test]
fn every_spelling_of_a_text_is_read() {
    let plain = format!("solid a part of a fixture\n{}{}endsolid a part of a fixture\n", facet(0.0), facet(1.0));
    for text in [
        plain.clone(),
        plain.replace(" a part of a fixture", ""),
        format!("\n  \t{plain}"),
        plain.to_uppercase(),
        format!("\u{feff}{plain}"),
        plain.replace("endsolid", "end solid").replace("endloop", "end loop").replace("endfacet", "end facet"),
        plain.replace("normal 0 0 1", "normal nan nan -nan(ind)"),
        plain.replace("normal 0 0 1", "normal"),
        plain.replace("normal 0 0 1", ""),
        plain.replace("endsolid a part of a fixture\n", ""),
        plain.replace('\n', "\r"),
        plain.replace('\n', "\r\n"),
        plain.replace(" 10 ", " 1.0E+01 "),
        plain.replace("\n outer loop\n", " outer loop ").replace("\n  vertex", " vertex"),
    ] {
        assert_eq!(count(&text), 2, "{text:?}");
    }
    let chinese =
        [&b"solid \xbc\xd0\xbe\xdf\r\n"[..], facet(0.0).as_bytes(), b"endsolid \xbc\xd0\xbe\xdf\r\n"].concat();
    assert_eq!(count(chinese), 1);
}

#[test]
fn what_cannot_be_read_names_its_line() {
    let solid = |facets: &str| format!("solid a\n{facets}endsolid a\n");
    let good = facet(0.0);
    for (text, words) in [
        (solid(&good.replace("vertex 10 0 0", "vertex 10 nan 0")), "line 5: expected a finite number, found `nan`"),
        (solid(&good.replace("vertex 10 0 0", "vertex 10 1e39 0")), "line 5: expected a finite number, found `1e39`"),
        (solid(&good.replace("vertex 10 0 0", "vertex 10 0,5 0")), "line 5: expected a finite number, found `0,5`"),
        (solid(&good.replace("vertex 10 0 0", "vertex 10 0")), "line 6: expected a finite number, found `vertex`"),
        (
            solid(&good.replace("vertex 10 0 0", "vertex 10 0 0\r\nvertex 1 1 1")),
            "line 7: expected `endloop`, found `vertex`; STL has triangles only",
        ),
        (solid(&good.replace(" endloop\n", "")), "line 7: expected `endloop`, found `endfacet`"),
        (solid(&good.replace("outer loop", "outer")), "line 4: expected `loop`, found `vertex`"),
        (solid(&good.replace("normal 0 0 1", "normal 0 0 1 1")), "line 2: expected `outer loop`, found `1`"),
        (solid("colour 1 2 3\n"), "line 2: expected `facet` or `endsolid`, found `colour`"),
        (format!("{}<html>", solid(&good)), "line 10: expected `solid`, found `<html>`"),
        (
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 1 2".into(),
            "line 4: the file ends where a number is expected",
        ),
        ("solid a\nendsolid a\n".into(), "it has no triangles"),
        ("solid".into(), "it has no triangles"),
        ("a wrong file".into(), "it is not an STL file: text would begin with `solid`, and 12 bytes are too few"),
        (String::new(), "0 bytes are too few"),
    ] {
        let problem = read(text.as_bytes()).expect_err(words);
        assert!(problem.contains(words), "{problem}\ninstead of {words}");
    }
}

#[test]
fn bytes_are_read_whatever_their_header_says() {
    let bytes = for_viewers(format!("solid a\n{}{}", facet(0.0), facet(1.0)).into_bytes()).unwrap();
    assert_eq!(bytes.len(), HEADER + COUNT + 2 * TRIANGLE);
    let mut named = bytes.clone();
    named[..9].copy_from_slice(b"solid abc");
    // What follows the last triangle does not matter, and viewers get none of it.
    for odd in [&bytes, &named, &[&bytes[..], b"more"].concat()] {
        let all = read(odd).unwrap();
        assert_eq!((all.triangles.len(), all.corners.len()), (2, 6));
        assert_eq!(all.corners[1], [10.0, 0.0, 0.0]);
        assert_eq!(for_viewers(odd.clone()).unwrap(), bytes);
    }
    assert!(read(&bytes[..bytes.len() - 1]).unwrap_err().contains("it announces 2 triangles, but has 1"));
    let mut wrong = bytes.clone();
    wrong[HEADER + COUNT + TRIANGLE + CORNERS..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(read(&wrong).unwrap_err().contains("a corner of triangle 2 is not a finite position: NaN 0 1, "));
    let many = [&[0; HEADER][..], &u32::MAX.to_le_bytes(), &[0; 100]].concat();
    assert!(read(&many).unwrap_err().contains("it announces 4294967295 triangles, but has 2"));
    assert!(read(&[0; 90]).unwrap_err().contains("no triangles"));
}

#[test]
fn viewers_get_bytes() {
    let text = format!("SOLID\r{}", facet(2.0).replace('\n', "\r"));
    let bytes = for_viewers(text.into_bytes()).unwrap();
    assert_eq!(read(&bytes).unwrap().corners, [[0.0, 0.0, 2.0], [10.0, 0.0, 2.0], [0.0, 10.0, 2.0]]);
    assert_eq!(for_viewers(bytes.clone()).unwrap(), bytes);
}
