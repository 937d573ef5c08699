//! Affine expressions of a system: a reader for `+ - * / ^`, integers, names and
//! parentheses, whose results are exact.

use super::dual::Dual;
use super::form::Form;
use crate::affine::model::rational::Rational;

/// The deepest nesting of parentheses and signs that is read.
const MAX_DEPTH: usize = 64;

/// The largest exponent.
const MAX_EXPONENT: usize = 64;

/// The error of a decimal in an expression, whose coefficients are exact.
const DECIMAL_ERROR: &str = "a decimal is not accepted here: give it as a parameter";

/// The names that an expression may use, with their values.
pub(super) trait Scope {
    /// The value of a name; an error says why it has none.
    fn value(&mut self, name: &str) -> Result<Form, String>;

    /// Number of states.
    fn states(&self) -> usize;
}

/// Reads `left > right` or `left < right`: the form that is positive where the condition holds.
pub(super) fn condition(text: &str, scope: &mut dyn Scope) -> Result<Form, String> {
    let mut sides = text.split(['<', '>']);
    let (left, right) = match (sides.next(), sides.next(), sides.next()) {
        (Some(left), Some(right), None) if !right.starts_with('=') => (left, right),
        _ => return Err("a condition is accepted as `left > right` or `left < right`".to_owned()),
    };
    let (left, right) = (expression(left, scope)?, expression(right, scope)?);
    Ok(if text.contains('>') { left.minus(&right) } else { right.minus(&left) })
}

/// Reads an affine expression.
pub(super) fn expression(text: &str, scope: &mut dyn Scope) -> Result<Form, String> {
    let mut reader = Reader { rest: text.trim_start(), depth: 0, scope };
    let form = reader.sum()?;
    match reader.rest.chars().next() {
        None => Ok(form),
        Some('.') => Err(DECIMAL_ERROR.to_owned()),
        Some('=') => Err("`=` is not accepted here: a condition uses `>` or `<`".to_owned()),
        Some('(') => {
            Err("a name before `(` is not accepted: cos and sin are those of theta and take no \
             argument, and a product is written with `*`"
                .to_owned())
        }
        Some(other) => {
            Err(format!("{other:?} is not accepted here: + - * / ^ or the end is expected"))
        }
    }
}

struct Reader<'a> {
    rest: &'a str,
    depth: usize,
    scope: &'a mut dyn Scope,
}

impl Reader<'_> {
    fn sum(&mut self) -> Result<Form, String> {
        let mut sum = self.product()?;
        loop {
            if self.takes('+') {
                sum = sum.plus(&self.product()?);
            } else if self.takes('-') {
                sum = sum.minus(&self.product()?);
            } else {
                return Ok(sum);
            }
            sum.check_size()?;
        }
    }

    fn product(&mut self) -> Result<Form, String> {
        let mut product = self.signed()?;
        loop {
            if self.takes('*') {
                product = product.times(&self.signed()?)?;
            } else if self.takes('/') {
                product = product.over(&self.signed()?)?;
            } else {
                return Ok(product);
            }
            product.check_size()?;
        }
    }

    fn signed(&mut self) -> Result<Form, String> {
        if self.takes('-') {
            return self.nested(|reader| Ok(reader.signed()?.times_number(&-&Dual::ONE)));
        }
        self.power()
    }

    fn power(&mut self) -> Result<Form, String> {
        let base = self.atom()?;
        if !self.takes('^') {
            return Ok(base);
        }
        let digits = self.digits();
        let exponent = digits.parse().ok().filter(|it| *it <= MAX_EXPONENT);
        let exponent = exponent.ok_or_else(|| {
            format!("an exponent is an integer from 0 to {MAX_EXPONENT}, written as such")
        })?;
        let power = base.to_the(exponent)?;
        if self.takes('^') {
            return Err("a power of a power is accepted with parentheses only".to_owned());
        }
        Ok(power)
    }

    fn atom(&mut self) -> Result<Form, String> {
        if self.takes('(') {
            let inner = self.nested(Self::sum)?;
            return if self.takes(')') { Ok(inner) } else { Err("a `)` is missing".to_owned()) };
        }
        let name = self.name();
        if !name.is_empty() {
            return self.scope.value(&name);
        }
        if self.has_exponent() {
            return Err(DECIMAL_ERROR.to_owned());
        }
        let digits = self.digits();
        let states = self.scope.states();
        match digits.parse::<u64>() {
            Ok(integer) if integer <= 1 << 63 => {
                Ok(Form::number(states, Dual::fixed(Rational::from(integer))))
            }
            _ if digits.is_empty() => Err(self.nothing()),
            _ => Err(format!("{digits} is too large: integers up to 2^63 are accepted")),
        }
    }

    /// Whether an integer with a decimal exponent stands here, as in `5e-3`.
    fn has_exponent(&self) -> bool {
        let after = self.rest.trim_start_matches(|c: char| c.is_ascii_digit());
        let exponent = after.strip_prefix(['e', 'E']);
        after.len() < self.rest.len()
            && exponent.is_some_and(|it| {
                it.strip_prefix(['+', '-']).unwrap_or(it).starts_with(|c: char| c.is_ascii_digit())
            })
    }

    fn nothing(&self) -> String {
        let what = match self.rest.chars().next() {
            None => "the expression ends".to_owned(),
            Some('.') => return DECIMAL_ERROR.to_owned(),
            Some(other) => format!("{other:?} stands"),
        };
        format!("{what} where an integer, a name or `(` is accepted")
    }

    fn nested(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<Form, String>,
    ) -> Result<Form, String> {
        if self.depth == MAX_DEPTH {
            return Err(format!("the expression is nested more than {MAX_DEPTH} deep"));
        }
        self.depth += 1;
        let form = read(self)?;
        self.depth -= 1;
        Ok(form)
    }

    fn takes(&mut self, symbol: char) -> bool {
        match self.rest.strip_prefix(symbol) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }

    fn name(&mut self) -> String {
        let begins = self.rest.starts_with(|c: char| c.is_ascii_alphabetic());
        if !begins {
            return String::new();
        }
        self.word(|c| c.is_ascii_alphanumeric() || c == '_')
    }

    fn digits(&mut self) -> String {
        self.word(|c| c.is_ascii_digit())
    }

    fn word(&mut self, belongs: impl Fn(char) -> bool) -> String {
        let length = self.rest.find(|c| !belongs(c)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(length);
        self.rest = rest.trim_start();
        word.to_owned()
    }
}
