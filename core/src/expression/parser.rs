//! Text to instructions, by recursive descent; constants are folded on the way.

use super::{FUNCTIONS, Fault, Op, STACK, function};
use crate::names;

/// Nesting of brackets, signs and powers beyond which a text is refused.
const DEPTH: usize = 100;

/// Bytes of a text beyond which it is refused: it is evaluated at each point and time, and a curve belongs into a table.
const LENGTH: usize = 20_000;

/// The instructions of an expression.
pub(super) fn parse(text: &str) -> Result<Vec<Op>, Fault> {
    let mut parser = Parser { text, at: 0, depth: 0, program: Vec::new() };
    if text.len() > LENGTH {
        let what = format!("the expression has {} bytes, and {LENGTH} are the most that are read", text.len());
        return Err(parser.fault(0, what, "write it shorter; a load over time may be a table in a file"));
    }
    parser.comparison()?;
    parser.blanks();
    if parser.at < text.len() {
        return Err(parser.unexpected());
    }
    parser.check_stack()?;
    Ok(parser.program)
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    program: Vec<Op>,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn blanks(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    /// Takes a symbol, if it stands next.
    fn take(&mut self, symbol: &str) -> bool {
        self.blanks();
        let found = self.rest().starts_with(symbol);
        if found {
            self.at += symbol.len();
        }
        found
    }

    /// Takes the next run of characters of a kind.
    fn run(&mut self, kind: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|c| !kind(c)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn fault(&self, offset: usize, what: impl Into<String>, remedy: impl Into<String>) -> Fault {
        Fault { what: what.into(), remedy: remedy.into(), offset }
    }

    fn unexpected(&self) -> Fault {
        match self.rest().chars().next() {
            None => self.fault(self.at, "the expression ends too early", "a number, x, y, t or a function is missing"),
            Some(c) if c.is_alphanumeric() || c == '(' => {
                self.fault(self.at, format!("unexpected `{c}`"), "a product needs its `*`, as in 2*x")
            }
            Some(c) => self.fault(
                self.at,
                format!("unexpected `{c}`"),
                "expressions know numbers, x, y, t, pi, e, + - * / ^, < <= > >= == !=, brackets and functions",
            ),
        }
    }

    fn enter(&mut self) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEPTH { Err(self.too_deep(self.at)) } else { Ok(()) }
    }

    fn too_deep(&self, offset: usize) -> Fault {
        self.fault(offset, "the expression is nested too deeply", "write it with fewer brackets")
    }

    fn comparison(&mut self) -> Result<(), Fault> {
        type Compare = fn(f64, f64) -> f64;
        const SIGNS: [(&str, Compare); 6] = [
            ("<=", |a, b| f64::from(a <= b)),
            (">=", |a, b| f64::from(a >= b)),
            ("==", |a, b| f64::from(a == b)),
            ("!=", |a, b| f64::from(a != b)),
            ("<", |a, b| f64::from(a < b)),
            (">", |a, b| f64::from(a > b)),
        ];
        self.sum()?;
        if let Some((_, compare)) = SIGNS.into_iter().find(|(sign, _)| self.take(sign)) {
            self.sum()?;
            self.emit(Op::Binary(compare));
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<(), Fault> {
        self.product()?;
        loop {
            let op = match () {
                () if self.take("+") => Op::Add,
                () if self.take("-") => Op::Subtract,
                () => return Ok(()),
            };
            self.product()?;
            self.emit(op);
        }
    }

    fn product(&mut self) -> Result<(), Fault> {
        self.signed()?;
        loop {
            let op = match () {
                () if self.take("*") => Op::Multiply,
                () if self.take("/") => Op::Divide,
                () => return Ok(()),
            };
            self.signed()?;
            self.emit(op);
        }
    }

    fn signed(&mut self) -> Result<(), Fault> {
        self.enter()?;
        if self.take("-") {
            self.signed()?;
            self.emit(Op::Unary(|a| -a));
        } else if self.take("+") {
            self.signed()?;
        } else {
            self.power()?;
        }
        self.depth -= 1;
        Ok(())
    }

    fn power(&mut self) -> Result<(), Fault> {
        self.atom()?;
        if !self.take("^") {
            return Ok(());
        }
        let exponent = self.program.len();
        self.signed()?;
        match self.program[exponent..] {
            [Op::Number(n)] if n.fract() == 0.0 && n.abs() <= 16.0 => {
                self.program.pop();
                self.emit(Op::Power(n as i32));
            }
            _ => self.emit(Op::Binary(f64::powf)),
        }
        Ok(())
    }

    fn atom(&mut self) -> Result<(), Fault> {
        self.blanks();
        match self.rest().chars().next() {
            Some('(') => {
                self.at += 1;
                self.comparison()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            _ => Err(self.unexpected()),
        }
    }

    fn close(&mut self) -> Result<(), Fault> {
        if self.take(")") {
            return Ok(());
        }
        if self.rest().is_empty() {
            return Err(self.fault(self.at, "a `(` is not closed", "add the missing `)`"));
        }
        Err(self.unexpected())
    }

    fn number(&mut self) -> Result<(), Fault> {
        let start = self.at;
        self.run(|c| c.is_ascii_digit());
        if self.rest().starts_with('.') {
            self.at += 1;
            self.run(|c| c.is_ascii_digit());
        }
        let mantissa = self.at;
        if self.rest().starts_with(['e', 'E']) {
            self.at += 1;
            self.at += usize::from(self.rest().starts_with(['+', '-']));
            if self.run(|c| c.is_ascii_digit()).is_empty() {
                self.at = mantissa; // not an exponent: the name e, or a mistake
            }
        }
        let text = &self.text[start..self.at];
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.emit(Op::Number(value));
                Ok(())
            }
            _ => Err(self.fault(start, format!("`{text}` is not a number"), "numbers look like 2, 0.5 or 1e-3")),
        }
    }

    fn name(&mut self) -> Result<(), Fault> {
        let start = self.at;
        let name = self.run(|c| c.is_alphanumeric() || c == '_');
        match name {
            "x" => self.emit(Op::X),
            "y" => self.emit(Op::Y),
            "t" => self.emit(Op::T),
            "pi" => self.emit(Op::Number(std::f64::consts::PI)),
            "e" => self.emit(Op::Number(std::f64::consts::E)),
            _ => return self.call(name, start),
        }
        Ok(())
    }

    fn call(&mut self, name: &str, start: usize) -> Result<(), Fault> {
        let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
        let (Some(op), Some(&(_, wanted))) = (function(name), known) else {
            return Err(self.unknown(name, start));
        };
        let mut given = 0;
        if self.take("(") {
            loop {
                self.comparison()?;
                given += 1;
                if !self.take(",") {
                    break;
                }
            }
            self.close()?;
        }
        if given != wanted {
            let arguments = if wanted == 1 { "argument" } else { "arguments" };
            let what = format!("`{name}` takes {wanted} {arguments}, not {given}");
            let remedy = format!("write {name}({})", ["a", "a, b", "c, a, b"][wanted.clamp(1, 3) - 1]);
            return Err(self.fault(start, what, remedy));
        }
        self.emit(op);
        Ok(())
    }

    fn unknown(&self, name: &str, start: usize) -> Fault {
        let functions: Vec<&str> = FUNCTIONS.iter().map(|f| f.0).collect();
        let names: Vec<&str> = ["x", "y", "t", "pi", "e"].into_iter().chain(functions.iter().copied()).collect();
        let hint = names::did_you_mean(name, &names);
        let remedy = format!(
            "{hint}expressions know x, y (m, at t = 0), t (s), pi, e and the functions {}",
            functions.join(", ")
        );
        self.fault(start, format!("unknown name `{name}` in the expression"), remedy)
    }

    /// Appends an instruction, or its value where its arguments are numbers.
    fn emit(&mut self, op: Op) {
        let first = self.program.len().saturating_sub(op.arity());
        let mut stack = [0.0; STACK];
        let numbers: Vec<f64> =
            self.program[first..].iter().map_while(|op| if let Op::Number(n) = op { Some(*n) } else { None }).collect();
        let foldable = op.arity() > 0 && numbers.len() == op.arity();
        if !foldable {
            return self.program.push(op);
        }
        stack[..numbers.len()].copy_from_slice(&numbers);
        op.apply(&mut stack, numbers.len(), [0.0; 2], 0.0);
        self.program.truncate(first);
        self.program.push(Op::Number(stack[0]));
    }

    fn check_stack(&self) -> Result<(), Fault> {
        let mut height = 0;
        for op in &self.program {
            height = height + 1 - op.arity();
            if height > STACK {
                return Err(self.too_deep(0));
            }
        }
        Ok(())
    }
}
