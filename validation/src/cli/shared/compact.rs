//! JSON for people and programs: indented, but a list of plain values, as a point, on one line.

use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{Formatter, PrettyFormatter};
use std::io::{self, Write};

/// Writes a value.
pub(in crate::cli) fn write(value: &impl Serialize, out: impl Write) -> serde_json::Result<()> {
    value.serialize(&mut Serializer::with_formatter(out, CompactLines::default()))
}

/// Indents by the library's own formatter, except in lists that hold no list and no object.
#[derive(Default)]
struct CompactLines {
    indented: PrettyFormatter<'static>,
    /// Whether each list or object that is open stands on lines of its own.
    open: Vec<bool>,
    /// Whether a value of a list comes next whose separator is not written yet; true for the first.
    waiting: Option<bool>,
}

impl CompactLines {
    /// Before a list's plain value: the separator on the same line.
    fn plain<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        match (self.waiting.take(), self.open.last()) {
            (Some(first), Some(true)) => self.indented.begin_array_value(out, first),
            (Some(false), _) => out.write_all(b", "),
            _ => Ok(()),
        }
    }

    /// Before a list or object inside of another: the separator on a line of its own.
    fn nested<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        let Some(first) = self.waiting.take() else { return Ok(()) };
        if let Some(own_lines) = self.open.last_mut() {
            *own_lines = true;
        }
        self.indented.begin_array_value(out, first)
    }
}

/// Plain values of a list go through [`CompactLines::plain`] first.
macro_rules! plain {
    ($($method:ident: $kind:ty),*) => {
        $(fn $method<W: ?Sized + Write>(&mut self, out: &mut W, value: $kind) -> io::Result<()> {
            self.plain(out)?;
            self.indented.$method(out, value)
        })*
    };
}

impl Formatter for CompactLines {
    plain!(write_i8: i8, write_i16: i16, write_i32: i32, write_i64: i64, write_i128: i128);
    plain!(write_u8: u8, write_u16: u16, write_u32: u32, write_u64: u64, write_u128: u128);
    plain!(write_bool: bool, write_f32: f32, write_f64: f64, write_number_str: &str);
    plain!(write_raw_fragment: &str);

    fn write_null<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.plain(out)?;
        self.indented.write_null(out)
    }

    fn begin_string<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.plain(out)?;
        self.indented.begin_string(out)
    }

    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.nested(out)?;
        self.open.push(false);
        self.indented.begin_array(out)
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        if self.open.pop() == Some(true) {
            return self.indented.end_array(out);
        }
        // The library's formatter keeps count of the indentation; its line break is not wanted
        // here.
        self.indented.end_array(&mut io::sink())?;
        out.write_all(b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, _: &mut W, first: bool) -> io::Result<()> {
        self.waiting = Some(first);
        Ok(())
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.indented.end_array_value(out)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.nested(out)?;
        self.open.push(true);
        self.indented.begin_object(out)
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open.pop();
        self.indented.end_object(out)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.indented.begin_object_key(out, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.indented.begin_object_value(out)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.indented.end_object_value(out)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn to_text(value: &Value) -> String {
        let mut out = Vec::new();
        write(value, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_point_is_a_line() {
        let text = to_text(&json!({"points": [[0.5, -1.0, null], [2, 3, 4]], "words": ["a", "b"]}));
        let expected = "{\n  \"points\": [\n    [0.5, -1.0, null],\n    [2, 3, 4]\n  ],\n  \"words\": [\"a\", \"b\"]\n}";
        assert_eq!(text, expected);
    }

    #[test]
    fn every_shape_reads_back() {
        for value in [
            json!([]),
            json!({}),
            json!([[], {}, [[]], 1]),
            json!([1, [2, 3], 4, {"a": [true, {"b": []}]}, "x"]),
            json!({"a": {"b": [{"c": [1.5e-300, -0.0]}]}, "d": null}),
        ] {
            assert_eq!(serde_json::from_str::<Value>(&to_text(&value)).unwrap(), value);
        }
    }
}
