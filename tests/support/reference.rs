//! Reads the proved tables of `reference_data/`.

use percuss::TwoWord;
use percuss::{Parameters, Phase, Start};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// One row of a table; numbers keep two words of their 25 digits.
#[derive(Clone, Debug)]
pub struct Row {
    pub token: String,
    pub elapsed: TwoWord,
    pub state: [TwoWord; 3],
    pub v: TwoWord,
}

impl Row {
    pub fn phase(&self) -> Option<Phase> {
        self.token.parse().ok()
    }
}

/// A table with the model and the start it belongs to.
pub struct Table {
    pub name: String,
    pub parameters: Parameters,
    pub start: Start,
    header: HashMap<String, String>,
    pub rows: Vec<Row>,
}

impl Table {
    pub fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let header: HashMap<String, String> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# ")?.split_once(" = "))
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
            .collect();
        let number = |key: &str| header[key].parse::<f64>().unwrap();
        let parameters = Parameters {
            a: number("a"),
            b: number("b"),
            xi: number("xi"),
            omega: number("omega"),
            g: number("g"),
            phi: number("phi"),
        };
        let start = Start {
            tau: number("start.tau"),
            cycle: header["start.cycle"].parse().unwrap(),
            p: number("start.p"),
            y: number("start.y"),
            q: Some(number("start.q")),
            v: number("start.v"),
            phase: None,
        };
        let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1).map(row).collect();
        let name = header["case"].clone();
        Self { name, parameters, start, header, rows }
    }

    /// The horizon in whole forcing periods, or as a time.
    pub fn horizon(&self) -> Result<u64, f64> {
        match self.header.get("horizon.periods") {
            Some(periods) => Ok(periods.parse().unwrap()),
            None => Err(self.header["horizon.until"].parse().unwrap()),
        }
    }
}

pub fn folder(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reference_data").join(kind)
}

/// All tables of the oscillator of a kind (`events` or `samples`), by name; those of other systems
/// name it in their header.
pub fn tables(kind: &str) -> Vec<Table> {
    let other = |path: &PathBuf| std::fs::read_to_string(path).unwrap().contains("\n# system = ");
    let mut paths: Vec<_> =
        std::fs::read_dir(folder(kind)).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.iter().filter(|path| !other(path)).map(|path| Table::read(path)).collect()
}

fn row(line: &str) -> Row {
    let cells: Vec<&str> = line.split(',').collect();
    let at = |column: usize| two_words(cells[column]);
    Row { token: cells[1].to_owned(), elapsed: at(2), state: [at(4), at(5), at(6)], v: at(7) }
}

/// A decimal of up to 31 digits in two words.
fn two_words(decimal: &str) -> TwoWord {
    let (mantissa, exponent) = decimal.split_once(['e', 'E']).unwrap_or((decimal, "0"));
    let mut exponent: i32 = exponent.parse().unwrap();
    let mut sum = TwoWord::ZERO;
    let mut behind_point = false;
    for digit in mantissa.chars() {
        match digit.to_digit(10) {
            Some(digit) => {
                sum = sum.times(10.0).plus(TwoWord::new(f64::from(digit)));
                exponent -= i32::from(behind_point);
            }
            None => behind_point |= digit == '.',
        }
    }
    // 10^22 is the largest power of ten that one word holds.
    while exponent < 0 {
        let step = exponent.max(-22);
        sum = sum.over(10.0_f64.powi(-step));
        exponent -= step;
    }
    sum = sum.times(10.0_f64.powi(exponent));
    if mantissa.starts_with('-') { TwoWord::ZERO.minus(sum) } else { sum }
}
