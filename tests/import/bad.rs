//! Bad files of many kinds: each is refused in words, or what is wrong in it is named; none panics or goes on for ever.

use super::by_hand::{found, step};
use super::*;
use std::time::{Duration, Instant};
use strandsnap::base::random::uniform;

const MODELS: [&str; 8] = [
    "curves.step",
    "rational.step",
    "assembly-inch.step",
    "bent-tube.step",
    "splines.dxf",
    "helices.dxf",
    "plane.dxf",
    "polylines-inch.dxf",
];

fn any_unit() -> ImportOptions {
    ImportOptions { unit: Some(1e-3), ..with_diameter() }
}

/// What is told of a file that is refused, in one line.
fn refused(name: &str, text: &str) -> String {
    let error = found(name, text, with_diameter()).expect_err(text);
    assert_eq!(error.exit_code(), 2, "{error:?}");
    format!("{:?}", miette::Report::new(error)).split_whitespace().collect::<Vec<_>>().join(" ").replace(" │ ", " ")
}

#[test]
fn files_that_are_cut_off_are_refused() {
    for name in MODELS {
        let whole = std::fs::read_to_string(model(name)).unwrap();
        let end = whole.trim_end().len();
        for k in 1..40 {
            let at = end * k / 40;
            let cut = found(name, &whole[..at], any_unit());
            let error = cut.err().unwrap_or_else(|| panic!("{name} cut at {at} of {end}"));
            assert!(error.to_string().contains("line "), "{name} cut at {at}: {error}");
        }
        assert!(found(name, &whole[..end - 1], any_unit()).is_err(), "{name} without its last letter");
    }
}

/// Bytes of real files changed at random: whatever comes of it, it comes soon and is no panic.
#[test]
fn files_with_changed_bytes_end_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    for (m, name) in MODELS.into_iter().enumerate() {
        let whole = std::fs::read(model(name)).unwrap();
        for case in 0..40_u64 {
            let mut bytes = whole.clone();
            for k in 0..=(case % 5) {
                let random = |what: u64| uniform(7, case * 100 + k, m as u64 * 10 + what);
                let at = (random(0) * bytes.len() as f64) as usize;
                bytes[at] = b"0123456789#(),.'-E$*\n\0\xff;"[(random(1) * 24.0) as usize];
            }
            std::fs::write(&path, &bytes).unwrap();
            let start = Instant::now();
            let _ = import(&path, &any_unit());
            assert!(start.elapsed() < Duration::from_secs(60), "{name}, case {case}");
        }
    }
}

#[test]
fn what_is_no_model_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.step");
    let garbage: Vec<u8> = (0..5000_u64).map(|i| (uniform(1, i, 0) * 256.0) as u8).collect();
    for (bytes, told) in [
        (&garbage[..], "neither STEP nor DXF"),
        (b"AC1032\0\0\0", "binary drawing"),
        (b"AutoCAD Binary DXF\r\n\x1a\0", "binary drawing"),
        (b"", "holds no wires"),
        (b"ISO-10303-21;", "the file ends here"),
        (b"ISO-10303-21;\nDATA;\nENDSEC;\nEND-ISO-10303-21;", "holds no wire"),
        (b"ISO-10303-21;\nNONSENSE;\n", "begins no section"),
        (b"0\nSECTION\n2\nENTITIES\nx\n1\n", "line 5: `x` stands where a group code is expected"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let error = import(&path, &with_diameter()).unwrap_err();
        assert!(error.to_string().contains(told), "{told}: {error}");
        assert_eq!(error.exit_code(), 2);
    }
    assert_eq!(import(&folder.path().join("none.step"), &with_diameter()).unwrap_err().exit_code(), 1);
    assert_eq!(import(folder.path(), &with_diameter()).unwrap_err().exit_code(), 2);
}

#[test]
fn values_and_references_that_are_wrong_are_named() {
    let set = |curve: &str| {
        step(&format!("{curve}\n#90 = GEOMETRIC_CURVE_SET('',(#20));\n#91 = SHAPE_REPRESENTATION('',(#90),#3);"))
    };
    for (curve, told) in [
        ("#20 = POLYLINE('',(#4,#77));", "POLYLINE #20, line 13 refers to #77, which the file does not have"),
        ("#20 = POLYLINE('',(#4,#5));", "refers to #5, which is not a point"),
        ("#20 = POLYLINE('',(#4));", "cannot be used for its points: two at least"),
        ("#20 = POLYLINE('',(#4,#4));", "has no length"),
        ("#20 = POLYLINE('',#4);", "cannot be used for its points"),
        ("#20 = POLYLINE();", "cannot be used for its points"),
        ("#20 = CIRCLE('',#7,2.);", "CIRCLE #20, line 13 is closed"),
        ("#20 = CIRCLE('',#7,-2.);", "radius: a number greater than 0"),
        ("#20 = HYPERBOLA('',#7,2.,3.);", "HYPERBOLA #20, line 13 is of a kind that is not read"),
        ("#20 = TRIMMED_CURVE('',#20,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);", "holds itself"),
        ("#20 = COMPOSITE_CURVE('',(#21),.F.);\n#21 = COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#20);", "holds itself"),
        ("#20 = GEOMETRIC_SET('',(#20));", "holds itself"),
        ("#20 = LINE('',#4,#21);\n#21 = VECTOR('',#5,1.);", "a line without them is no wire"),
        (
            "#20 = B_SPLINE_CURVE_WITH_KNOTS('',1,(#4,#4),.U.,.F.,.F.,(2,9999999),(0.,1.),.U.);",
            "multiplicities: one per knot",
        ),
        ("#20 = B_SPLINE_CURVE_WITH_KNOTS('',3,(#4,#4),.U.,.F.,.F.,(3,3),(0.,1.),.U.);", "degree:"),
        (
            "#20 = B_SPLINE_CURVE_WITH_KNOTS('',1,(#4,#4),.U.,.F.,.F.,(2,2),(1.,0.),.U.);",
            "knots: they are finite and never fall",
        ),
        ("#20 = POLYLINE('',(#4,#21));\n#21 = CARTESIAN_POINT('',(1.E300,0.,0.));", "within 1000 km"),
        ("#20 = POLYLINE('',(#4,#21));\n#21 = CARTESIAN_POINT('',(1.,2.,3.,4.));", "two or three numbers"),
        ("#20 = POLYLINE('',(#4,#21));\n#21 = CARTESIAN_POINT('',(NAN,0.,0.));", "line 14: `NAN` is no value"),
        ("#20 = POLYLINE('',(#4,#21));\n#21 = CARTESIAN_POINT('',(1.E999,0.,0.));", "`1.E999` is no finite number"),
    ] {
        let message = refused("a.step", &set(curve));
        assert!(message.contains(told), "{curve}\n{told}\n{message}");
    }
    let without_unit = "#20 = POLYLINE('',(#4,#21));\n#21 = CARTESIAN_POINT('',(1.,0.,0.));\n\
        #30 = (GEOMETRIC_REPRESENTATION_CONTEXT(3) REPRESENTATION_CONTEXT('',''));\n#90 = GEOMETRIC_CURVE_SET('',(#20));\n\
        #91 = SHAPE_REPRESENTATION('',(#90),#30);";
    assert!(refused("a.step", &step(without_unit)).contains("gives no unit of length: give --unit"));
    assert_eq!(found("a.step", &step(without_unit), any_unit()).unwrap().wires.len(), 1);
}

/// Parts that hold themselves, and assemblies whose nesting doubles their parts at each of forty levels.
#[test]
fn assemblies_without_an_end_are_refused() {
    let relation = |number: usize, inner: usize, outer: usize| {
        format!(
            "#{number} = (REPRESENTATION_RELATIONSHIP('','',#{inner},#{outer}) \
             REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#8) SHAPE_REPRESENTATION_RELATIONSHIP());\n"
        )
    };
    let line = "#8 = ITEM_DEFINED_TRANSFORMATION('','',#7,#7);\n#10 = CARTESIAN_POINT('',(0.,0.,9.));\n\
        #11 = POLYLINE('',(#4,#10));\n#12 = GEOMETRIC_CURVE_SET('',(#11));\n#100 = SHAPE_REPRESENTATION('',(#12),#3);\n";
    let circle =
        format!("{line}#101 = SHAPE_REPRESENTATION('',(#7),#3);\n{}{}", relation(50, 100, 101), relation(51, 101, 100));
    assert!(refused("a.step", &step(&circle)).contains("holds itself"));
    let mut doubled = line.to_owned();
    for k in 1..=40 {
        doubled += &format!("#{} = SHAPE_REPRESENTATION('',(#7),#3);\n", 100 + k);
        doubled += &(relation(1000 + 2 * k, 99 + k, 100 + k) + &relation(1001 + 2 * k, 99 + k, 100 + k));
    }
    let start = Instant::now();
    assert!(refused("a.step", &step(&doubled)).contains("nested too deep"));
    assert!(start.elapsed() < Duration::from_secs(60));
    let mut deep = line.to_owned();
    for k in 1..=20_000 {
        deep +=
            &format!("#{} = SHAPE_REPRESENTATION('',(#7),#3);\n{}", 100 + k, relation(100_000 + k, 99 + k, 100 + k));
    }
    assert!(refused("a.step", &step(&deep)).contains("nested too deep"));
}

fn dxf(entities: &str) -> String {
    format!(
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n0\nINSERT\n2\nB\n\
         0\nINSERT\n2\nB\n0\nENDBLK\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}\n0\nENDSEC\n0\nEOF\n"
    )
}

#[test]
fn drawings_with_wrong_values_are_named() {
    for (entities, told) in [
        ("0\nLINE\n10\n0\n20\n0\n11\nnan\n21\n1", "line 42: `nan` (group code 11) is no finite number"),
        ("0\nLINE\n10\n0\n20\n0\n11\n1e999\n21\n1", "`1e999` (group code 11) is no finite number"),
        ("0\nLINE\n10\n1\n20\n1\n11\n1\n21\n1", "LINE, line 36 has no length"),
        ("0\nINSERT\n2\nB", "INSERT (line 20, line 24): each holds itself"),
        ("0\nINSERT\n2\nC", "block: its name is that of a BLOCK"),
        ("0\nINSERT\n2\nB\n70\n1000000\n71\n1000000", "array: at most 10000"),
        ("0\nCIRCLE\n10\n1\n20\n1\n40\n3", "is closed"),
        ("0\nARC\n10\n1\n20\n1\n40\n1e300", "within 1000 km"),
        ("0\nSPLINE\n71\n3\n11\n1\n21\n1\n11\n2\n21\n2", "only points to go through"),
        ("0\nSPLINE\n71\n3\n40\n1\n10\n1\n20\n1", "degree:"),
        ("0\n3DSOLID\n1\nacis", "3DSOLID, line 36 is of a kind that is not read"),
        ("0\nHELIX\n100\nAcDbHelix\n10\n0\n20\n0\n11\n1\n21\n0\n40\n1\n41\n1e300\n42\n1", "turns: at most 25000"),
    ] {
        let message = refused("a.dxf", &dxf(entities));
        assert!(message.contains(told), "{entities}\n{told}\n{message}");
    }
}

/// Blocks that hold the next one twice, thirty times over, and nothing else.
#[test]
fn blocks_without_an_end_are_refused() {
    let block = |k: usize| {
        let inner = format!("0\nINSERT\n2\nB{}\n", k + 1);
        format!("0\nBLOCK\n2\nB{k}\n{inner}{inner}0\nENDBLK\n")
    };
    let blocks: String = (0..30).map(block).collect();
    let text = format!(
        "0\nSECTION\n2\nBLOCKS\n{blocks}0\nBLOCK\n2\nB30\n0\nENDBLK\n0\nENDSEC\n\
         0\nSECTION\n2\nENTITIES\n0\nINSERT\n2\nB0\n0\nENDSEC\n0\nEOF\n"
    );
    let start = Instant::now();
    let error = found("a.dxf", &text, any_unit()).unwrap_err();
    assert!(error.to_string().contains("has more than 1000000 entities"), "{error}");
    assert!(start.elapsed() < Duration::from_secs(60));
}

/// Numbers that are possible and mad: a helix of a million turns, a metre for a millimetre.
#[test]
fn wires_of_too_many_points_are_refused() {
    let helix = "0\nHELIX\n100\nAcDbHelix\n10\n0\n20\n0\n11\n1\n21\n0\n40\n1\n41\n1e6\n42\n1e-3";
    let error = found("a.dxf", &dxf(helix), ImportOptions { diameter: Some(1e-7), ..with_diameter() }).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
    let long = "0\nLINE\n10\n0\n20\n0\n11\n1e8\n21\n1";
    assert_eq!(found("a.dxf", &dxf(long), with_diameter()).unwrap().clearance, Clearance::NotLookedAt);
}

#[test]
fn diameters_that_contradict_the_model_are_refused() {
    let error = import(&model("tubes.step"), &ImportOptions { diameter: Some(0.5e-3), ..with_diameter() }).unwrap_err();
    assert!(error.to_string().contains("has a diameter of"), "{error}");
}
