//! Finds the places of a file at which a fault can be put in.
//!
//! Left out are contexts in which nothing can be chosen at run time (constants, constant functions,
//! lengths, patterns, types), test code, the insides of macros, and literal indices, whose faults
//! all panic at once.

use crate::fault::{Change, Operator};
use crate::operators::{bounds_its_argument, early_values, instead_of_float, replacements};
use std::collections::BTreeMap;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Block, Expr, ItemConst, Lit, Meta, Signature, Type};

/// A numeric constant that is defined in a file, and where it is used.
#[derive(Clone, Debug)]
pub struct Named {
    /// Where its value stands.
    pub value: Range<usize>,
    /// Whether it is a floating-point number.
    pub is_float: bool,
}

/// What was found in one file.
pub struct Places<'a> {
    source: &'a str,
    /// Changes at one place each.
    pub changes: Vec<Change>,
    /// Numeric constants defined here.
    pub constants: BTreeMap<String, Named>,
    /// Where names of constants are used at run time.
    pub uses: Vec<(String, Range<usize>)>,
}

impl<'a> Places<'a> {
    /// Reads a file.
    pub fn find(source: &'a str) -> syn::Result<Self> {
        let mut places =
            Self { source, changes: Vec::new(), constants: BTreeMap::new(), uses: Vec::new() };
        places.visit_file(&syn::parse_file(source)?);
        Ok(places)
    }

    fn text(&self, of: &impl Spanned) -> &'a str {
        &self.source[of.span().byte_range()]
    }

    fn change(&mut self, place: Range<usize>, operator: Operator, replacement: String) {
        self.changes.push(Change { place, operator, replacement });
    }

    fn function(&mut self, signature: &Signature, body: &Block) {
        if signature.constness.is_some() {
            return;
        }
        let start = body.brace_token.span.open().byte_range().end;
        for value in early_values(&signature.output) {
            self.change(start..start, Operator::Return, format!("return {value};"));
        }
        self.visit_block(body);
    }

    fn binary(&mut self, it: &syn::ExprBinary) {
        if holds_a_let(&it.left) || holds_a_let(&it.right) {
            return;
        }
        let (left, right) = (self.text(&it.left), self.text(&it.right));
        for (operator, instead) in replacements(&it.op) {
            let replacement = format!("{left} {instead} {right}");
            self.change(it.span().byte_range(), *operator, replacement);
        }
    }

    fn literal(&mut self, it: &syn::ExprLit) {
        let place = it.span().byte_range();
        let text = self.text(it);
        match &it.lit {
            Lit::Float(number) => {
                let is_zero = number.base10_parse::<f64>().is_ok_and(|value| value == 0.0);
                for instead in instead_of_float(text, is_zero) {
                    self.change(place.clone(), Operator::Constant, instead);
                }
            }
            Lit::Int(_) => self.change(place, Operator::Constant, format!("({text} + 1)")),
            _ => {}
        }
    }

    fn unary(&mut self, it: &syn::ExprUnary) {
        let operator = match it.op {
            syn::UnOp::Neg(_) => Operator::Sign,
            syn::UnOp::Not(_) => Operator::Condition,
            _ => return,
        };
        let replacement = format!("({})", self.text(&it.expr));
        self.change(it.span().byte_range(), operator, replacement);
    }

    fn method_call(&mut self, it: &syn::ExprMethodCall) {
        let name = it.method.to_string();
        let operator = match name.as_str() {
            "abs" => Operator::Sign,
            _ if bounds_its_argument(&name) && !it.args.is_empty() => Operator::Bound,
            _ => return,
        };
        let replacement = format!("({})", self.text(&it.receiver));
        self.change(it.span().byte_range(), operator, replacement);
    }

    fn call(&mut self, it: &syn::ExprCall) {
        let Expr::Path(function) = it.func.as_ref() else { return };
        let bounds =
            function.path.get_ident().is_some_and(|it| bounds_its_argument(&it.to_string()));
        if let (true, Some(first)) = (bounds, it.args.first()) {
            let replacement = format!("({})", self.text(first));
            self.change(it.span().byte_range(), Operator::Bound, replacement);
        }
    }

    fn condition(&mut self, condition: &Expr) {
        if !holds_a_let(condition) {
            let replacement = format!("!({})", self.text(condition));
            self.change(condition.span().byte_range(), Operator::Condition, replacement);
        }
    }
}

/// Whether `if let` chains reach into this expression, which then is no value.
fn holds_a_let(it: &Expr) -> bool {
    match it {
        Expr::Let(_) => true,
        Expr::Binary(binary) => holds_a_let(&binary.left) || holds_a_let(&binary.right),
        Expr::Paren(inner) => holds_a_let(&inner.expr),
        _ => false,
    }
}

fn is_test_only(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string() == "test",
        meta => meta.path().is_ident("test"),
    })
}

impl<'ast> Visit<'ast> for Places<'_> {
    fn visit_item_mod(&mut self, it: &'ast syn::ItemMod) {
        if !is_test_only(&it.attrs) {
            visit::visit_item_mod(self, it);
        }
    }

    fn visit_item_fn(&mut self, it: &'ast syn::ItemFn) {
        if !is_test_only(&it.attrs) {
            self.function(&it.sig, &it.block);
        }
    }

    fn visit_impl_item_fn(&mut self, it: &'ast syn::ImplItemFn) {
        if !is_test_only(&it.attrs) {
            self.function(&it.sig, &it.block);
        }
    }

    fn visit_trait_item_fn(&mut self, it: &'ast syn::TraitItemFn) {
        if let Some(body) = &it.default {
            self.function(&it.sig, body);
        }
    }

    fn visit_item_const(&mut self, it: &'ast ItemConst) {
        let Type::Path(path) = it.ty.as_ref() else { return };
        let Some(name) = path.path.get_ident().map(ToString::to_string) else { return };
        let is_float = name == "f64";
        if is_float || ["usize", "u8", "u32", "u64", "i32", "i64"].contains(&name.as_str()) {
            let value = it.expr.span().byte_range();
            self.constants.insert(it.ident.to_string(), Named { value, is_float });
        }
    }

    fn visit_expr(&mut self, it: &'ast Expr) {
        match it {
            Expr::Binary(it) => self.binary(it),
            Expr::Lit(it) => self.literal(it),
            Expr::Unary(it) => self.unary(it),
            Expr::MethodCall(it) => self.method_call(it),
            Expr::Call(it) => self.call(it),
            Expr::If(it) => self.condition(&it.cond),
            Expr::While(it) => self.condition(&it.cond),
            Expr::Path(it) => {
                if let Some(name) = it.path.segments.last().map(|it| &it.ident) {
                    self.uses.push((name.to_string(), it.span().byte_range()));
                }
            }
            _ => {}
        }
        visit::visit_expr(self, it);
    }

    fn visit_expr_repeat(&mut self, it: &'ast syn::ExprRepeat) {
        self.visit_expr(&it.expr);
    }

    fn visit_expr_index(&mut self, it: &'ast syn::ExprIndex) {
        self.visit_expr(&it.expr);
        if !matches!(it.index.as_ref(), Expr::Lit(_)) {
            self.visit_expr(&it.index);
        }
    }

    fn visit_arm(&mut self, it: &'ast syn::Arm) {
        if let Some((_, guard)) = &it.guard {
            self.condition(guard);
            self.visit_expr(guard);
        }
        self.visit_expr(&it.body);
    }

    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast Type) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_angle_bracketed_generic_arguments(
        &mut self,
        _: &'ast syn::AngleBracketedGenericArguments,
    ) {
    }
}
