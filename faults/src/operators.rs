//! What each kind of expression is changed into.

use crate::fault::Operator;
use syn::{BinOp, ReturnType, Type};

/// The operators that take the place of this one.
pub fn replacements(operator: &BinOp) -> &'static [(Operator, &'static str)] {
    use Operator::{Arithmetic, Comparison, Logic};
    match operator {
        BinOp::Lt(_) => &[(Comparison, "<="), (Comparison, ">")],
        BinOp::Le(_) => &[(Comparison, "<"), (Comparison, ">")],
        BinOp::Gt(_) => &[(Comparison, ">="), (Comparison, "<")],
        BinOp::Ge(_) => &[(Comparison, ">"), (Comparison, "<")],
        BinOp::Eq(_) => &[(Comparison, "!=")],
        BinOp::Ne(_) => &[(Comparison, "==")],
        BinOp::Add(_) => &[(Arithmetic, "-")],
        BinOp::Sub(_) => &[(Arithmetic, "+")],
        BinOp::Mul(_) => &[(Arithmetic, "/")],
        BinOp::Div(_) => &[(Arithmetic, "*")],
        BinOp::AddAssign(_) => &[(Arithmetic, "-=")],
        BinOp::SubAssign(_) => &[(Arithmetic, "+=")],
        BinOp::MulAssign(_) => &[(Arithmetic, "/=")],
        BinOp::DivAssign(_) => &[(Arithmetic, "*=")],
        BinOp::And(_) => &[(Logic, "||")],
        BinOp::Or(_) => &[(Logic, "&&")],
        _ => &[],
    }
}

/// What a floating-point number with this text becomes.
pub fn instead_of_float(text: &str, is_zero: bool) -> Vec<String> {
    let one_more = format!("({text} + 1.0)");
    if is_zero {
        return vec![one_more];
    }
    vec![format!("({text} * 0.1)"), format!("({text} * 10.0)"), one_more]
}

/// What a function that returns this may return at once.
pub fn early_values(output: &ReturnType) -> &'static [&'static str] {
    let ReturnType::Type(_, returned) = output else { return &[] };
    let Type::Path(path) = returned.as_ref() else { return &[] };
    match path.path.segments.last() {
        Some(segment) if segment.ident == "bool" => &["true", "false"],
        Some(segment) if segment.ident == "Option" => &["None"],
        _ => &[],
    }
}

/// Whether a function or method of this name bounds its first argument by the second.
pub fn bounds_its_argument(name: &str) -> bool {
    ["min", "max", "smaller", "larger", "clamp"].contains(&name)
}
