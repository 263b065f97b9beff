//! Expressions: a text compiles or is refused, and what compiles is evaluated in a time in proportion to its length.
#![no_main]

use dgmpm::parts::expression::Expression;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Expression::compile(text) {
        Ok(expression) => {
            for x in [0.0, -1.5, 1e300, f64::NAN, f64::INFINITY] {
                expression.eval([x, -x], x);
            }
            if let Some(value) = expression.constant() {
                assert_eq!(expression.eval([0.5, 0.5], 0.5).to_bits(), value.to_bits());
            }
        }
        Err(fault) => assert!(fault.offset <= text.len() && !fault.remedy.is_empty(), "{fault}"),
    }
});
