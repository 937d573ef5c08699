//! A fault: where it is and what it changes.

use std::fmt;
use std::ops::Range;

/// A fault that can be chosen at run time.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Its number, from 1 in the order of the sources.
    pub number: u32,
    /// The file it is in, relative to the root of the repository.
    pub file: String,
    /// The line it is in, from 1.
    pub line: usize,
    /// What kind of change it is.
    pub operator: Operator,
    /// The text without it.
    pub original: String,
    /// The text with it.
    pub replacement: String,
    /// The line it is in, as text.
    pub context: String,
    /// How many faults before it are alike in all of that but the line's number.
    pub alike: usize,
}

impl Fault {
    /// The fault's place in the shuffled list of a seed. It depends on what the fault is and on the
    /// line around it alone: a change of the sources draws the faults of the changed lines anew and
    /// leaves the rest of a sample.
    pub fn place(&self, seed: u64) -> u64 {
        let Self { file, operator, original, replacement, context, alike, .. } = self;
        let name = file.rsplit('/').next().unwrap_or(file);
        let text = format!("{name}|{}|{original}|{replacement}|{context}|{alike}", operator.name());
        fastrand::Rng::with_seed(seed ^ hash(text.as_bytes())).u64(..)
    }

    /// Whether it is in the harness, not in the solver.
    pub fn is_in_validation(&self) -> bool {
        self.file.starts_with("validation/")
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { number, file, line, operator, original, replacement, .. } = self;
        let name = operator.name();
        write!(f, "{number:5} {file}:{line} {name}: {original} -> {replacement}")
    }
}

/// The hash of Fowler, Noll and Vo (1a, 64 bits): the same on every platform and for ever.
fn hash(bytes: &[u8]) -> u64 {
    const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
    const PRIME: u64 = 0x0100_0000_01b3;
    bytes.iter().fold(BASIS, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(PRIME))
}

/// Kinds of faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// A comparison becomes another one.
    Comparison,
    /// An arithmetic operator becomes its opposite.
    Arithmetic,
    /// A sign or an absolute value is dropped.
    Sign,
    /// A constant becomes another number.
    Constant,
    /// A condition is negated.
    Condition,
    /// And becomes or, or becomes and.
    Logic,
    /// A function returns at once.
    Return,
    /// The smaller or larger of two numbers becomes the first of them.
    Bound,
}

impl Operator {
    /// The name in the table.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Comparison => "comparison",
            Self::Arithmetic => "arithmetic",
            Self::Sign => "sign",
            Self::Constant => "constant",
            Self::Condition => "condition",
            Self::Logic => "logic",
            Self::Return => "return",
            Self::Bound => "bound",
        }
    }
}

/// A change of the text at one place, before faults have numbers.
#[derive(Clone, Debug)]
pub struct Change {
    /// The bytes that are replaced: none where statements are put in front of a function's body.
    pub place: Range<usize>,
    /// What kind of change it is.
    pub operator: Operator,
    /// The new text of the place.
    pub replacement: String,
}
