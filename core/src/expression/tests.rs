use super::*;
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    Expression::compile(text).unwrap().eval([0.3, -2.0], 0.5)
}

#[test]
fn values() {
    let (x, y, t) = (0.3_f64, -2.0_f64, 0.5_f64);
    let pi = std::f64::consts::PI;
    let table = [
        ("-200", -200.0),
        ("1e-3 + .5 + 2. + 1E+2", 102.501),
        ("-x^2", -(x * x)),
        ("exp(-((x-.75)/.12)^2)", (-((x - 0.75) / 0.12).powi(2)).exp()),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("2^x", 2f64.powf(x)),
        ("x-1-1", x - 2.0),
        ("1/2/4", 0.125),
        ("1 + 2*3 - 4/2", 5.0),
        ("(1 + 2)*3", 9.0),
        ("- -x", x),
        ("2*-x", -2.0 * x),
        ("sin(pi*x)*cos(pi*y)", (pi * x).sin() * (pi * y).cos()),
        ("e^t", std::f64::consts::E.powf(t)),
        ("log(e) + ln(1) + sqrt(4)", 3.0),
        ("atan2(y, x)", y.atan2(x)),
        ("min(x, y) + max(x, t)", y + t),
        ("abs(y) + sign(y) + sign(0) + floor(1.7)", 2.0),
        ("step(0) + step(-1e-9) + step(t)", 2.0),
        ("if(x < t, 10, 20)", 10.0),
        ("if(x >= t, 10, 20)", 20.0),
        ("(x == .3) + (x != .3)", 1.0),
        ("if(y > 0, log(y), 7)", 7.0),
        ("tanh(x) + tan(x)", x.tanh() + x.tan()),
        (" x ", x),
    ];
    for (text, expected) in table {
        let found = value(text);
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{text} = {found}, not {expected}");
    }
}

#[test]
fn faults_say_where_and_what_exists() {
    let table = [
        ("", 0, "ends too early"),
        ("1 +", 3, "ends too early"),
        ("2x", 1, "`*`"),
        ("2(x)", 1, "`*`"),
        ("sn(x)", 0, "did you mean `sin`"),
        ("1 + z", 4, "x, y (m, at t = 0), t (s), pi, e"),
        ("sin x", 0, "takes 1 argument, not 0"),
        ("min(1)", 0, "takes 2 arguments, not 1"),
        ("if(1, 2)", 0, "if(c, a, b)"),
        ("(x", 2, "not closed"),
        ("x)", 1, "unexpected `)`"),
        ("x ; y", 2, "unexpected `;`"),
        ("1 < 2 < 3", 6, "unexpected `<`"),
        ("1e999", 0, "not a number"),
        (".", 0, "not a number"),
        ("x = 1", 2, "unexpected `=`"),
    ];
    for (text, offset, words) in table {
        let fault = Expression::compile(text).unwrap_err();
        assert_eq!(fault.offset, offset, "{text}: {fault}");
        assert!(fault.to_string().contains(words), "{text}: {fault}");
    }
}

#[test]
fn nesting_is_bounded() {
    for text in ["(".repeat(100_000), "-".repeat(100_000), "2^".repeat(100_000), "x+(".repeat(50)] {
        assert!(Expression::compile(&text).is_err());
    }
    let deep = format!("{}x{}", "x+(".repeat(40), ")".repeat(40));
    assert!(Expression::compile(&deep).unwrap_err().what.contains("too deeply"));
}

#[test]
fn what_it_depends_on() {
    let compile = |text| Expression::compile(text).unwrap();
    assert_eq!(compile("-2*pi/pi").constant(), Some(-2.0));
    assert_eq!(compile("0*x").constant(), None);
    assert!(compile("x + step(t)").depends_on_time());
    assert!(!compile("x + y").depends_on_time());
    assert_eq!(Expression::number(-0.25).constant(), Some(-0.25));
    assert_eq!(compile(Expression::number(-1.5e300).source()).constant(), Some(-1.5e300));
}

#[test]
#[ignore = "a measurement, to be read with --nocapture"]
fn cost() {
    let pulse = Expression::compile("-1e8*step(1e-4 - t)*exp(-((x - 0.5)/0.1)^2)*sin(pi*y)").unwrap();
    let started = std::time::Instant::now();
    let count = 100_000;
    let sum: f64 = (0..count).map(|i| pulse.eval([i as f64 / count as f64, 0.5], 5e-5)).sum();
    let nanoseconds = started.elapsed().as_nanos() as f64 / count as f64;
    println!("{nanoseconds:.0} ns an evaluation ({sum:.3e})");
    assert!(sum < 0.0);
}

/// A random expression with full brackets, on whose meaning every parser agrees.
fn bracketed() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![Just("x".to_owned()), Just("y".to_owned()), (1u32..100).prop_map(|n| format!("{n}.5"))];
    leaf.prop_recursive(5, 40, 2, |inner| {
        prop_oneof![
            (inner.clone(), prop::sample::select(vec!["+", "-", "*"]), inner.clone())
                .prop_map(|(a, op, b)| format!("(({a}) {op} ({b}))")),
            (prop::sample::select(vec!["sin", "cos", "tanh", "abs", "-"]), inner)
                .prop_map(|(f, a)| format!("({f}({a}))")),
        ]
    })
}

proptest! {
    #[test]
    fn agrees_with_an_independent_parser(text in bracketed(), x in -2.0..2.0f64, y in -2.0..2.0f64) {
        use exmex::prelude::*;
        let other = exmex::parse::<f64>(&text).unwrap();
        let all = [("x", x), ("y", y)];
        let given: Vec<f64> = other.var_names().iter().map(|n| if n == "x" { all[0].1 } else { all[1].1 }).collect();
        let expected = other.eval(&given).unwrap();
        match Expression::compile(&text) {
            Ok(expression) => prop_assert!((expression.eval([x, y], 0.0) - expected).abs() <= 1e-9 * (1.0 + expected.abs())),
            Err(fault) => prop_assert!(fault.what.contains("too deeply")),
        }
    }

    #[test]
    fn no_text_makes_it_panic(text in "[ -~xyt0-9e.+*/^(),<=>-]{0,60}") {
        if let Ok(expression) = Expression::compile(&text) {
            expression.eval([0.3, 0.4], 0.5);
        }
    }

    #[test]
    fn no_unicode_makes_it_panic(text in "\\PC{0,30}") {
        let _ = Expression::compile(&text);
    }
}
