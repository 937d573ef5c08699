//! Rewrites a file so that its faults are chosen at run time.

use std::collections::BTreeMap;
use std::ops::Range;

/// A fault's text at one place.
#[derive(Clone, Debug)]
pub struct Edit {
    /// The bytes of the original file; none where statements are inserted.
    pub place: Range<usize>,
    /// The fault's number.
    pub number: u32,
    /// What stands there with the fault.
    pub replacement: String,
}

/// A rewritten file.
#[derive(Debug, Default)]
pub struct Rewritten {
    /// Its text.
    pub text: String,
    /// Where in it the faults are: outer places follow the ones inside them.
    pub places: Vec<(Range<usize>, Vec<u32>)>,
}

/// Rewrites a source with all of these edits, each of which acts only if its fault is the chosen
/// one.
///
/// A place inside another place is rewritten in the original's branch only: one fault is active at
/// a time.
pub fn rewrite(source: &str, edits: &[Edit]) -> Rewritten {
    let mut nodes: BTreeMap<(usize, std::cmp::Reverse<usize>), Vec<&Edit>> = BTreeMap::new();
    for edit in edits {
        let key = (edit.place.start, std::cmp::Reverse(edit.place.end));
        nodes.entry(key).or_default().push(edit);
    }
    let nodes: Vec<Vec<&Edit>> = nodes.into_values().collect();
    let mut out = Rewritten::default();
    render(source, 0..source.len(), &nodes, &mut out);
    out
}

/// Appends this range of the source, in which these places lie, sorted with outer ones first.
fn render(source: &str, range: Range<usize>, mut nodes: &[Vec<&Edit>], out: &mut Rewritten) {
    let mut at = range.start;
    while let Some((node, rest)) = nodes.split_first() {
        let place = &node[0].place;
        let inside = rest.iter().take_while(|it| it[0].place.end <= place.end).count();
        let (inner, later) = if place.is_empty() { (&[][..], rest) } else { rest.split_at(inside) };
        out.text.push_str(&source[at..place.start]);
        let start = out.text.len();
        if place.is_empty() {
            insert(node, out);
        } else {
            choose(source, node, inner, out);
        }
        let numbers = node.iter().map(|edit| edit.number).collect();
        out.places.push((start..out.text.len(), numbers));
        (at, nodes) = (place.end, later);
    }
    out.text.push_str(&source[at..range.end]);
}

fn insert(node: &[&Edit], out: &mut Rewritten) {
    for Edit { number, replacement, .. } in node {
        out.text.push_str(&format!(" if crate::fault::is({number}) {{ {replacement} }} "));
    }
}

fn choose(source: &str, node: &[&Edit], inner: &[Vec<&Edit>], out: &mut Rewritten) {
    out.text.push('(');
    for Edit { number, replacement, .. } in node {
        out.text.push_str(&format!("if crate::fault::is({number}) {{ {replacement} }} else "));
    }
    out.text.push_str("{ ");
    render(source, node[0].place.clone(), inner, out);
    out.text.push_str(" })");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edit(source: &str, part: &str, number: u32, replacement: &str) -> Edit {
        let start = source.find(part).unwrap_or_default();
        Edit { place: start..start + part.len(), number, replacement: replacement.to_owned() }
    }

    #[test]
    fn places_inside_others_are_rewritten_in_the_branch_without_a_fault() {
        let source = "x = a * b + c;";
        let edits = [edit(source, "a * b + c", 1, "a * b - c"), edit(source, "a * b", 2, "a / b")];
        let rewritten = rewrite(source, &edits);
        let expected = "x = (if crate::fault::is(1) { a * b - c } else \
                        { (if crate::fault::is(2) { a / b } else { a * b }) + c });";
        assert_eq!(rewritten.text, expected);
        let inner = &rewritten.places[0];
        assert_eq!(inner.1, [2]);
        assert!(rewritten.text[inner.0.clone()].starts_with("(if crate::fault::is(2)"));
    }

    #[test]
    fn faults_at_one_place_are_alternatives_and_statements_are_inserted() {
        let source = "{ 2.0 }";
        let at_start = Edit { place: 1..1, number: 3, replacement: "return None;".to_owned() };
        let edits =
            [at_start, edit(source, "2.0", 1, "(2.0 * 0.1)"), edit(source, "2.0", 2, "3.0")];
        let expected = "{ if crate::fault::is(3) { return None; }  \
                        (if crate::fault::is(1) { (2.0 * 0.1) } else \
                        if crate::fault::is(2) { 3.0 } else { 2.0 }) }";
        assert_eq!(rewrite(source, &edits).text, expected);
    }
}
