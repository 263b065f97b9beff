//! Expressions of x, y and t, as scenes give them for data that varies: compiled once, then evaluated
//! at every face point and time node (a travelling pulse with exp and sin: 110 ns).
//!
//! Grammar, with the usual ranks (`^` binds tighter than a minus in front: `-x^2` is `-(x^2)`, and
//! is right-associative): numbers (`2`, `.5`, `1e-3`), `x`, `y`, `t`, `pi`, `e`, `+ - * / ^`, the
//! comparisons `< <= > >= == !=` (1 where true, 0 else) and the functions of [`FUNCTIONS`]. Both branches of
//! `if(c, a, b)` are evaluated, one is taken. Angles are in radians, `log` is the natural logarithm; `step(s)` is
//! 0 for s < 0, else 1; `sign(0)` is 0. The parser is our own since that of `exmex` reads `-x^2` as `(-x)^2`, so
//! that `exp(-(x/a)^2)` would grow, and has no functions of three arguments; `exmex` is the oracle of the tests.
//!
//! ```
//! let pulse = dgmpm_core::expression::Expression::compile("-1e8*step(1e-4 - t)*exp(-(x/0.1)^2)").unwrap();
//! assert_eq!(pulse.eval([0.0, 0.0], 5e-5), -1e8);
//! assert_eq!(pulse.eval([0.0, 0.0], 2e-4), 0.0);
//! ```

mod parser;

/// The functions of expressions, with their number of arguments.
pub const FUNCTIONS: &[(&str, usize)] = &[
    ("sin", 1),
    ("cos", 1),
    ("tan", 1),
    ("asin", 1),
    ("acos", 1),
    ("atan", 1),
    ("sinh", 1),
    ("cosh", 1),
    ("tanh", 1),
    ("exp", 1),
    ("log", 1),
    ("ln", 1),
    ("sqrt", 1),
    ("abs", 1),
    ("floor", 1),
    ("sign", 1),
    ("step", 1),
    ("min", 2),
    ("max", 2),
    ("atan2", 2),
    ("if", 3),
];

/// The largest number of intermediate values of an expression; more is refused when it is compiled.
const STACK: usize = 32;

/// One instruction of the stack machine.
#[derive(Debug, Clone, Copy)]
enum Op {
    Number(f64),
    X,
    Y,
    T,
    Add,
    Subtract,
    Multiply,
    Divide,
    /// To a whole power, by multiplication.
    Power(i32),
    Unary(fn(f64) -> f64),
    Binary(fn(f64, f64) -> f64),
    /// `if(c, a, b)`: a where c is not 0.
    If,
}

/// A compiled expression of x, y (reference coordinates, in m) and t (in s).
#[derive(Debug, Clone)]
pub struct Expression {
    source: String,
    program: Vec<Op>,
}

/// Why a text is not an expression.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}\n  {remedy}")]
pub struct Fault {
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub remedy: String,
    /// Where in the text, in bytes from 0.
    pub offset: usize,
}

impl Expression {
    /// Compiles a text.
    pub fn compile(source: &str) -> Result<Self, Fault> {
        let program = parser::parse(source)?;
        Ok(Self { source: source.to_owned(), program })
    }

    /// The same number everywhere.
    pub fn number(value: f64) -> Self {
        Self { source: format!("{value:?}"), program: vec![Op::Number(value)] }
    }

    /// The value at reference coordinates x (m) and time t (s); not finite where the mathematics is not.
    pub fn eval(&self, x: [f64; 2], t: f64) -> f64 {
        let mut stack = [0.0; STACK];
        let mut top = 0; // one past the last value; the compiler has checked it against STACK
        for op in &self.program {
            top = op.apply(&mut stack, top, x, t);
        }
        stack[0]
    }

    /// The value, where it depends on neither x, y nor t.
    pub fn constant(&self) -> Option<f64> {
        match self.program[..] {
            [Op::Number(value)] => Some(value),
            _ => None,
        }
    }

    /// Whether t stands in it.
    pub fn depends_on_time(&self) -> bool {
        self.program.iter().any(|op| matches!(op, Op::T))
    }

    /// Whether x or y stands in it.
    pub fn depends_on_place(&self) -> bool {
        self.program.iter().any(|op| matches!(op, Op::X | Op::Y))
    }

    /// The text that it was compiled from.
    pub fn source(&self) -> &str {
        &self.source
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.source == other.source
    }
}

impl serde::Serialize for Expression {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.source)
    }
}

impl Op {
    /// Number of values taken from the stack; one is left.
    fn arity(self) -> usize {
        match self {
            Op::Number(_) | Op::X | Op::Y | Op::T => 0,
            Op::Power(_) | Op::Unary(_) => 1,
            Op::Add | Op::Subtract | Op::Multiply | Op::Divide | Op::Binary(_) => 2,
            Op::If => 3,
        }
    }

    #[inline]
    fn apply(self, stack: &mut [f64; STACK], top: usize, x: [f64; 2], t: f64) -> usize {
        let first = top - self.arity();
        stack[first] = match self {
            Op::Number(value) => value,
            Op::X => x[0],
            Op::Y => x[1],
            Op::T => t,
            Op::Add => stack[first] + stack[first + 1],
            Op::Subtract => stack[first] - stack[first + 1],
            Op::Multiply => stack[first] * stack[first + 1],
            Op::Divide => stack[first] / stack[first + 1],
            Op::Power(n) => stack[first].powi(n),
            Op::Unary(f) => f(stack[first]),
            Op::Binary(f) => f(stack[first], stack[first + 1]),
            Op::If if stack[first] != 0.0 => stack[first + 1],
            Op::If => stack[first + 2],
        };
        first + 1
    }
}

/// The instruction of a function of [`FUNCTIONS`].
fn function(name: &str) -> Option<Op> {
    let unary: fn(f64) -> f64 = match name {
        "sin" => f64::sin,
        "cos" => f64::cos,
        "tan" => f64::tan,
        "asin" => f64::asin,
        "acos" => f64::acos,
        "atan" => f64::atan,
        "sinh" => f64::sinh,
        "cosh" => f64::cosh,
        "tanh" => f64::tanh,
        "exp" => f64::exp,
        "log" | "ln" => f64::ln,
        "sqrt" => f64::sqrt,
        "abs" => f64::abs,
        "floor" => f64::floor,
        "sign" => |s| if s == 0.0 { 0.0 } else { s.signum() },
        "step" => |s| if s < 0.0 { 0.0 } else { 1.0 },
        "min" => return Some(Op::Binary(f64::min)),
        "max" => return Some(Op::Binary(f64::max)),
        "atan2" => return Some(Op::Binary(f64::atan2)),
        "if" => return Some(Op::If),
        _ => return None,
    };
    Some(Op::Unary(unary))
}

#[cfg(test)]
mod tests;
