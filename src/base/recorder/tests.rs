use super::*;

macro_rules! formula {
    ($name:ident, |$x:ident, $y:ident| $body:expr) => {
        struct $name;
        impl Formula for $name {
            fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
                let ($x, $y) = (take("x"), take("y"));
                put("result", $body);
            }
        }
    };
}

formula!(Everything, |x, y| {
    let positive = x.abs() + 1e-3;
    let picked = R::select(x.simd_gt(y) & !y.simd_gt(x) | x.simd_gt(x * 2.0), positive.ln(), (y * 0.1).exp());
    let rounded = (x * 3.0).round_ties_even() / positive.sqrt() - positive.inverse() * -positive.inverse_sqrt();
    let [[p0, s0], [p1, s1]] = y.rows_around(&[[0.0, 1.0], [0.5, 4.0], [2.0, 2.0], [3.0, 9.0]]);
    picked + rounded.simd_min(x).mul_add(y.simd_max(x), positive.powf(0.3)) + (s1 - s0) / (p1 - p0) * y
});

#[test]
fn what_is_recorded_has_the_bits_of_the_formula() {
    let function = Function::record("everything", &Everything).unwrap();
    assert_eq!(
        (function.inputs(), function.outputs().collect::<Vec<_>>()),
        (&["x".into(), "y".into()][..], vec!["result"])
    );
    for k in 0..2000 {
        let at = |stream| (crate::base::random::uniform(1, stream, k) - 0.3) * 10.0;
        let inputs = [at(0), if k % 5 == 0 { at(0) } else { at(1) }];
        let (own, recorded) = (Everything.evaluate(&inputs)[0], function.evaluate(&inputs)[0]);
        assert_eq!(own.to_bits(), recorded.to_bits(), "{inputs:?}: {own} {recorded}");
    }
}

formula!(Repeated, |x, y| {
    let unused = x.exp() * y;
    let _ = unused;
    (x * y + y * x) * (x.splat(2.0) * 3.0 - 5.0)
});

#[test]
fn nothing_is_done_twice_or_in_vain_and_constants_are_worked_out() {
    let function = Function::record("repeated", &Repeated).unwrap();
    assert_eq!(function.operations(), 3);
    let expected = "struct repeated_results {\n    result: f64,\n}\n\nfn repeated(x: f64, y: f64) -> repeated_results {\n    \
                    let n44 = x * y;\n    let n45 = n44 + n44;\n    let n50 = 1e0lf * n45;\n    return repeated_results(n50);\n}\n";
    let text = function.wgsl();
    let plain = |text: &str| text.replace(|c: char| c.is_ascii_digit(), "");
    assert_eq!(plain(&text), plain(expected), "{text}");
}

/// The root of y by Newton's rule from x.
struct Root<R>(R);

impl<R: Real> Refinement<R> for Root<R> {
    type Point = R;
    fn at(&self, number: R) -> R {
        number * number - self.0 * 3.0
    }
    fn unsettled(&self, rest: &R) -> R::Mask {
        !(self.0 * 1e-13).simd_gt(rest.abs())
    }
    fn next(&self, number: R, rest: &R) -> R {
        number - *rest / (number * 2.0)
    }
}

formula!(Refined, |x, y| {
    let (root, rest) = x.refine(&Root(y), y.simd_gt(x.splat(1.0)), 40);
    root + rest * 1e-3
});

#[test]
fn a_refinement_is_a_loop_with_the_bits_of_the_rounds() {
    let function = Function::record("refined", &Refined).unwrap();
    for inputs in [[1.0, 2.0], [7.0, 0.5], [1e9, 3.0], [1e-9, 3.0], [3.0, 3.0], [1.0, f64::NAN]] {
        assert_eq!(Refined.evaluate(&inputs)[0].to_bits(), function.evaluate(&inputs)[0].to_bits(), "{inputs:?}");
    }
    // What does not change in the loop stands before it.
    let text = function.wgsl();
    let (before, after) = text.split_once("for (").unwrap();
    assert!(before.contains(" = y * 3e0lf;") && before.contains(" = y * 1e-13lf;"), "{text}");
    let inside = after.split_once("break").unwrap().0;
    assert!(inside.contains("abs(") && !inside.contains('/'), "{text}");
}

struct Outer<R>(R);

impl<R: Real> Refinement<R> for Outer<R> {
    type Point = R;
    fn at(&self, number: R) -> R {
        number.refine(&Root(self.0), number.simd_gt(self.0), 5).0
    }
    fn unsettled(&self, point: &R) -> R::Mask {
        point.simd_gt(self.0)
    }
    fn next(&self, number: R, point: &R) -> R {
        number - *point
    }
}

formula!(Nested, |x, y| x.refine(&Outer(y), y.simd_gt(x), 5).0);
formula!(Looking, |x, y| {
    let mut sum = x;
    sum.put(0, x.at(0) + y.at(0));
    sum
});

#[test]
fn what_cannot_be_recorded_is_refused_with_the_reason() {
    assert_eq!(Function::record("nested", &Nested).unwrap_err(), Unrecordable::NestedLoop);
    assert_eq!(Function::record("looking", &Looking).unwrap_err(), Unrecordable::Value);
}

formula!(Constants, |x, y| {
    let all = [f64::INFINITY, f64::NEG_INFINITY, 5e-324, -0.0, 1.0 / 3.0, f64::MAX, -2.5e-300];
    all.into_iter().fold(x, |sum, value| R::select(y.simd_gt(sum), sum, x.splat(value)))
});

#[test]
fn constants_keep_their_bits_in_the_text() {
    let text = Function::record("constants", &Constants).unwrap().wgsl();
    for literal in [
        "bitcast<f64>(0x7ff0000000000000lu)",
        "bitcast<f64>(0xfff0000000000000lu)",
        "bitcast<f64>(0x0000000000000001lu)",
        "bitcast<f64>(0x8000000000000000lu)",
        "3.333333333333333e-1lf",
        "1.7976931348623157e308lf",
        "(-2.5e-300lf)",
    ] {
        assert!(text.contains(literal), "{literal} is not in {text}");
    }
}
