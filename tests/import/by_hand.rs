//! What other programs write, in few lines: helices drawn on cylinders, trimmed circles, swept disks, mapped items, degrees.

use super::*;
use std::f64::consts::{FRAC_PI_2, TAU};

const HEAD: &str = "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n\
    #1 = (LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));\n\
    #2 = (NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));\n\
    #3 = (GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#1,#2)) REPRESENTATION_CONTEXT('',''));\n\
    #4 = CARTESIAN_POINT('',(0.,0.,0.));\n#5 = DIRECTION('',(0.,0.,1.));\n#6 = DIRECTION('',(1.,0.,0.));\n\
    #7 = AXIS2_PLACEMENT_3D('',#4,#5,#6);\n";

/// A STEP file of these instances.
pub fn step(instances: &str) -> String {
    format!("{HEAD}{instances}\nENDSEC;\nEND-ISO-10303-21;\n")
}

/// What is found in text that is named so.
pub fn found(name: &str, text: &str, options: ImportOptions) -> strandsnap::base::error::Result<Imported> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    import(&path, &options)
}

fn one(instances: &str) -> Imported {
    found("a.step", &step(instances), with_diameter()).unwrap_or_else(|error| panic!("{error:?}"))
}

fn length(found: &Imported, wire: usize) -> f64 {
    found.wires[wire].points.windows(2).map(|two| two[0].distance(two[1])).sum()
}

/// 1.2 turns of radius 2 mm and pitch 10 mm as a straight line in the parameters of a cylinder, between two vertices.
#[test]
fn a_helix_drawn_on_a_cylinder() {
    let end = DVec3::new(2.0 * (1.2 * TAU).cos(), 2.0 * (1.2 * TAU).sin(), 12.0);
    let pitch = 10.0 / TAU;
    let text = format!(
        "#10 = CYLINDRICAL_SURFACE('',#7,2.);\n\
         #11 = CARTESIAN_POINT('',(0.,0.));\n#12 = DIRECTION('',(1.,{pitch}));\n#13 = VECTOR('',#12,1.);\n\
         #14 = LINE('',#11,#13);\n#15 = (GEOMETRIC_REPRESENTATION_CONTEXT(2) PARAMETRIC_REPRESENTATION_CONTEXT() \
         REPRESENTATION_CONTEXT('',''));\n#16 = DEFINITIONAL_REPRESENTATION('',(#14),#15);\n#17 = PCURVE('',#10,#16);\n\
         #18 = CARTESIAN_POINT('',(2.,0.,0.));\n#19 = VERTEX_POINT('',#18);\n\
         #20 = CARTESIAN_POINT('',({},{},{}));\n#21 = VERTEX_POINT('',#20);\n\
         #22 = EDGE_CURVE('',#19,#21,#17,.T.);\n#23 = CONNECTED_EDGE_SET('',(#22));\n\
         #24 = EDGE_BASED_WIREFRAME_MODEL('',(#23));\n\
         #25 = EDGE_BASED_WIREFRAME_SHAPE_REPRESENTATION('',(#24,#7),#3);",
        end.x, end.y, end.z
    );
    let found = one(&text);
    let layer = &found.layers[0];
    assert!((layer.radius - 2e-3).abs() < 1e-9 && (layer.pitch - 10e-3).abs() < 1e-8, "{layer:?}");
    assert!((found.wires[0].points.last().unwrap().z - 12e-3).abs() < 1e-9);
    assert_eq!(layer.lay, 1.0);
}

/// Three quarters of a circle of radius 3 mm by parameters in degrees, and a quarter backwards by points.
#[test]
fn trimmed_circles_in_degrees_and_against_their_sense() {
    let text = "#10 = (CONVERSION_BASED_UNIT('DEGREE',#11) NAMED_UNIT(*) PLANE_ANGLE_UNIT());\n\
        #11 = PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.0174532925199433),#2);\n\
        #12 = (GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#1,#10)) REPRESENTATION_CONTEXT('',''));\n\
        #13 = CIRCLE('',#7,3.);\n\
        #14 = TRIMMED_CURVE('',#13,(PARAMETER_VALUE(90.)),(PARAMETER_VALUE(360.)),.T.,.PARAMETER.);\n\
        #15 = CARTESIAN_POINT('',(10.,0.,0.));\n#16 = AXIS2_PLACEMENT_3D('',#15,#5,#6);\n#17 = CIRCLE('',#16,3.);\n\
        #18 = CARTESIAN_POINT('',(13.,0.,0.));\n#19 = CARTESIAN_POINT('',(10.,-3.,0.));\n\
        #20 = TRIMMED_CURVE('',#17,(#18),(#19),.F.,.CARTESIAN.);\n\
        #21 = GEOMETRIC_CURVE_SET('',(#14,#20));\n\
        #22 = GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#21),#12);";
    let found = one(text);
    assert!((length(&found, 0) - 9e-3 * FRAC_PI_2).abs() < 1e-6, "{}", length(&found, 0));
    assert!((length(&found, 1) - 3e-3 * FRAC_PI_2).abs() < 1e-6, "{}", length(&found, 1));
    assert!(found.wires[1].points.iter().all(|p| p.x > 9.999e-3 && p.y < 1e-9), "the quarter below");
}

/// A disk swept along a composite of a polyline and an arc.
#[test]
fn swept_disks_along_composite_curves() {
    let text = "#10 = CARTESIAN_POINT('',(3.,0.,-5.));\n#11 = CARTESIAN_POINT('',(3.,0.,0.));\n#12 = POLYLINE('',(#10,#11));\n\
        #13 = DIRECTION('',(0.,-1.,0.));\n#14 = AXIS2_PLACEMENT_3D('',#4,#13,#6);\n#15 = CIRCLE('',#14,3.);\n\
        #16 = TRIMMED_CURVE('',#15,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n\
        #17 = COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#12);\n#18 = COMPOSITE_CURVE_SEGMENT(.DISCONTINUOUS.,.T.,#16);\n\
        #19 = COMPOSITE_CURVE('',(#17,#18),.F.);\n#20 = SWEPT_DISK_SOLID('',#19,0.25,$,0.,2.);\n\
        #21 = SHAPE_REPRESENTATION('',(#20),#3);";
    let found = found("a.step", &step(text), ImportOptions::default()).unwrap();
    assert_eq!((found.wires.len(), found.wires[0].pieces, found.wires[0].diameter), (1, 2, Some(0.5e-3)));
    assert!((length(&found, 0) - 8e-3).abs() < 1e-6, "{}", length(&found, 0));
}

/// What is read of a swept disk is all of it, or nothing, and that is said.
#[test]
fn disks_that_are_swept_in_part_or_hollow_are_named() {
    let line = "#10 = CARTESIAN_POINT('',(0.,0.,30.));\n#11 = POLYLINE('',(#4,#10));\n";
    for (disk, why) in
        [("0.25,0.1,$,$", "hollow"), ("0.25,$,0.5,1.", "whole directrix"), ("0.25,$,$,0.5", "whole directrix")]
    {
        let text = format!("{line}#20 = SWEPT_DISK_SOLID('',#11,{disk});\n#21 = SHAPE_REPRESENTATION('',(#20),#3);");
        let told = format!("{:?}", found("a.step", &step(&text), ImportOptions::default()).unwrap_err());
        assert!(told.contains(why), "{disk}: {told}");
    }
    let text = format!("{line}#20 = SWEPT_DISK_SOLID('',#11,0.25,$,0.,1.);\n#21 = SHAPE_REPRESENTATION('',(#20),#3);");
    assert!((length(&found("a.step", &step(&text), ImportOptions::default()).unwrap(), 0) - 30e-3).abs() < 1e-9);
}

/// A polygon that turns back keeps the point where it does.
#[test]
fn a_line_that_turns_back_is_not_straight() {
    let found = found("a.txt", "0 0 0\n0 0 40\n0 0 20\n", with_diameter()).unwrap();
    assert!((length(&found, 0) - 60e-3).abs() < 1e-9, "{}", length(&found, 0));
    assert_eq!(found.wires[0].points.len(), 3);
}

/// A representation within another twice, the second time twice as large.
#[test]
fn mapped_items_are_placed_and_scaled() {
    let text = "#10 = CARTESIAN_POINT('',(0.,0.,8.));\n#11 = POLYLINE('',(#4,#10));\n#12 = GEOMETRIC_CURVE_SET('',(#11));\n\
        #13 = SHAPE_REPRESENTATION('',(#12,#7),#3);\n#14 = REPRESENTATION_MAP(#7,#13);\n\
        #15 = CARTESIAN_POINT('',(1.,2.,3.));\n#16 = AXIS2_PLACEMENT_3D('',#15,#5,#6);\n#17 = MAPPED_ITEM('',#14,#16);\n\
        #18 = CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',$,$,#15,2.,$);\n#19 = MAPPED_ITEM('',#14,#18);\n\
        #20 = SHAPE_REPRESENTATION('',(#17,#19),#3);";
    let options = ImportOptions { as_drawn: true, ..with_diameter() };
    let found = found("a.step", &step(text), options).unwrap();
    // One wire hides the other but for what it is longer.
    let mut ends: Vec<f64> = found.wires.iter().map(|wire| wire.points[1].z * 1e3).collect();
    ends.sort_by(f64::total_cmp);
    assert_eq!(found.wires.len(), 2);
    assert!((ends[0] - 11.0).abs() < 1e-12 && (ends[1] - 19.0).abs() < 1e-12, "{ends:?}");
    assert!(found.wires.iter().all(|wire| wire.points[0].distance(DVec3::new(1e-3, 2e-3, 3e-3)) < 1e-15));
}

/// Kinds of B-splines without knots of their own: Bézier, uniform, quasi-uniform; each a straight line of 3 mm.
#[test]
fn knots_that_a_name_implies() {
    let points = "#10 = CARTESIAN_POINT('',(1.,0.,0.));\n#11 = CARTESIAN_POINT('',(2.,0.,0.));\n\
        #12 = CARTESIAN_POINT('',(3.,0.,0.));\n#13 = CARTESIAN_POINT('',(4.,0.,0.));\n";
    for (curve, expected) in [
        ("BEZIER_CURVE('',3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", 3e-3),
        ("QUASI_UNIFORM_CURVE('',2,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", 3e-3),
        ("UNIFORM_CURVE('',1,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", 3e-3),
        // A uniform cubic of four points runs from the mean of the first three to that of the last three.
        ("UNIFORM_CURVE('',3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.)", 1e-3),
        (
            "(BEZIER_CURVE() BOUNDED_CURVE() B_SPLINE_CURVE(3,(#10,#11,#12,#13),.UNSPECIFIED.,.F.,.F.) CURVE() \
             GEOMETRIC_REPRESENTATION_ITEM() RATIONAL_B_SPLINE_CURVE((1.,2.,2.,1.)) REPRESENTATION_ITEM(''))",
            3e-3,
        ),
    ] {
        let text = format!(
            "{points}#20 = {curve};\n#21 = GEOMETRIC_CURVE_SET('',(#20));\n#22 = SHAPE_REPRESENTATION('',(#21),#3);"
        );
        let found = one(&text);
        assert!((length(&found, 0) - expected).abs() < 1e-9, "{curve}: {}", length(&found, 0));
    }
}

/// A HELIX without the spline that programs add.
#[test]
fn a_helix_by_its_own_numbers() {
    for (sense, lay) in [(1, 1.0), (0, -1.0)] {
        let text = format!(
            "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n0\nHELIX\n100\nAcDbHelix\n\
             10\n0\n20\n0\n30\n0\n11\n2\n21\n0\n31\n0\n12\n0\n22\n0\n32\n1\n40\n2\n41\n1.5\n42\n10\n290\n{sense}\n0\nENDSEC\n0\nEOF\n"
        );
        let found = found("a.dxf", &text, with_diameter()).unwrap();
        let layer = &found.layers[0];
        assert!((layer.radius - 2e-3).abs() < 1e-9 && (layer.pitch - 10e-3).abs() < 1e-8, "{layer:?}");
        assert_eq!(layer.lay, lay);
    }
}
