//! Bytes to a case. Few bytes decide much, so that mutations move between regimes.

use percuss::{Parameters, Phase, Start};

/// An input of the solver, within the accepted ranges but for starts that are refused as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    pub parameters: Parameters,
    pub start: Start,
    /// Length of the run in forcing periods, before it is cut to what the check allows.
    pub periods: f64,
    /// The family that the case is drawn from.
    pub family: Family,
}

/// The families of cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Every accepted model, from every start.
    Any,
    /// Contacts that die out next to a threshold: damping from critical on, next to no force, and a
    /// slider that is pulled. Such a contact is decided by what is left of it.
    DyingOut,
    /// Forces so small that their products underflow, and starts at rest, late.
    Underflowing,
}

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    /// The next byte; zero when they are used up.
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes([self.byte(), self.byte(), self.byte(), self.byte()])
    }

    /// In [0, 1], both ends included.
    fn unit(&mut self) -> f64 {
        f64::from(self.word()) / f64::from(u32::MAX)
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        let exponent = low.ln() + self.unit() * (high.ln() - low.ln());
        exponent.exp().clamp(low, high)
    }

    /// A size from 0 to 1e9: exact values that matter, sizes of order 1, and all orders.
    fn size(&mut self) -> f64 {
        match self.byte() % 16 {
            0 => 0.0,
            1 => 1.0,
            2 => 0.5,
            3 => 1e9,
            4 => f64::MIN_POSITIVE,
            5 => 1.0 + (self.unit() - 0.5) * 1e-12,
            6 => 1.0 + f64::EPSILON,
            7 => self.log_uniform(1e-300, 1e9),
            8 | 9 => self.log_uniform(1e-18, 1e9),
            _ => 2.0 * self.unit(),
        }
    }

    fn signed(&mut self) -> f64 {
        let size = self.size();
        if self.byte() % 2 == 0 { size } else { -size }
    }

    /// A time or an angle, up to 1e15.
    fn late_time(&mut self) -> f64 {
        match self.byte() % 8 {
            0 => 0.0,
            1 => std::f64::consts::FRAC_PI_2,
            2 => std::f64::consts::PI,
            3 => -std::f64::consts::FRAC_PI_2,
            4 => (self.unit() - 0.5) * 2e15,
            5 => -self.log_uniform(1e-18, 1e15),
            _ => std::f64::consts::TAU * self.unit(),
        }
    }

    /// xi and omega.
    fn positive(&mut self, low: f64, high: f64) -> f64 {
        match self.byte() % 16 {
            0 => 1.0,
            1 => low,
            2 => high,
            3 => 1.0 + (self.unit() - 0.5) * 1e-6,
            4 => 1.0 + (self.unit() - 0.5) * 1e-14,
            5..=9 => self.log_uniform(0.01, 10.0),
            _ => self.log_uniform(low, high),
        }
    }

    fn phase(&mut self) -> Option<Phase> {
        match self.byte() % 8 {
            1 => Some(Phase::NoContact),
            2 => Some(Phase::Contact),
            3 => Some(Phase::Progression),
            _ => None,
        }
    }

    /// A trial force: on the thresholds, next to them, between, and anywhere.
    fn force(&mut self) -> f64 {
        match self.byte() % 8 {
            0 => 0.0,
            1 => 1.0,
            2 => self.log_uniform(1e-18, 1e-9),
            3 => -self.log_uniform(1e-18, 1e-9),
            4 => 1.0 + (self.unit() - 0.5) * 1e-12,
            5 => self.signed(),
            _ => self.unit(),
        }
    }
}

const MAX_SIZE: f64 = 1e9;

impl Case {
    pub fn decode(bytes: &[u8]) -> Self {
        let mut bytes = Bytes(bytes);
        match bytes.byte() % 8 {
            0 | 1 => dying_case(&mut bytes),
            2 => underflowing_case(&mut bytes),
            _ => any_case(&mut bytes),
        }
    }
}

fn any_case(bytes: &mut Bytes) -> Case {
    let parameters = Parameters {
        a: bytes.size(),
        b: bytes.signed(),
        xi: bytes.positive(1e-8, 1e4),
        omega: bytes.positive(1e-6, 1e6),
        g: bytes.size(),
        phi: bytes.late_time(),
    };
    let start = start(bytes, &parameters);
    let periods = bytes.log_uniform(1e-3, 64.0);
    Case { parameters, start, periods, family: Family::Any }
}

fn dying_case(bytes: &mut Bytes) -> Case {
    let a = match bytes.byte() % 4 {
        0 => bytes.log_uniform(1e-127, 1e-12),
        _ => 0.0,
    };
    let size = bytes.log_uniform(1e-127, 1e-17);
    let b = if bytes.byte() % 2 == 0 { size } else { -size };
    // One in four near the other threshold.
    let b = if bytes.byte() % 4 == 0 { 1.0 + b } else { b };
    let xi = match bytes.byte() % 8 {
        0 => 1.0,
        1 => 1.0 - bytes.log_uniform(1e-15, 0.5),
        _ => bytes.log_uniform(1.0, 8.0),
    };
    let parameters =
        Parameters { a, b, xi, omega: bytes.log_uniform(0.1, 10.0), g: 0.02, phi: 0.0 };
    let q = match bytes.byte() % 8 {
        0 => 2.0 * bytes.unit(),
        _ => -4.0 * bytes.unit(),
    };
    let force = match bytes.byte() % 8 {
        0 => 4.0 * bytes.unit(),
        _ => bytes.unit(),
    };
    let y = (force - q) / (2.0 * xi);
    let gap = if bytes.byte() % 4 == 0 { bytes.unit() } else { 0.0 };
    let start = Start { p: q + 0.02 - gap, y, q: Some(q), ..Start::default() };
    let periods = bytes.log_uniform(0.1, 64.0);
    Case { parameters, start, periods, family: Family::DyingOut }
}

fn underflowing_case(bytes: &mut Bytes) -> Case {
    let a = bytes.log_uniform(1e-300, 1e-270);
    let b = if bytes.byte() % 2 == 0 { 0.0 } else { a * (2.0 * bytes.unit() - 1.0) };
    let parameters = Parameters {
        a,
        b,
        xi: bytes.positive(1e-8, 1e4),
        omega: bytes.positive(1e-6, 1e6),
        g: if bytes.byte() % 2 == 0 { 0.0 } else { 0.02 },
        phi: if bytes.byte() % 2 == 0 { 0.0 } else { std::f64::consts::TAU * bytes.unit() },
    };
    let phase = bytes.phase();
    let cycle = if bytes.byte() % 2 == 0 { 1 << 53 } else { 0 };
    let start = Start { p: parameters.g, q: Some(0.0), cycle, phase, ..Start::default() };
    let periods = bytes.log_uniform(1e-4, 1.0);
    Case { parameters, start, periods, family: Family::Underflowing }
}

fn start(bytes: &mut Bytes, parameters: &Parameters) -> Start {
    let Parameters { g, xi, .. } = *parameters;
    let tau = bytes.late_time();
    let cycle = match bytes.byte() % 8 {
        0 => 1 << 53,
        1 => -(1 << 53),
        2 => i64::from(bytes.word()) << 21,
        _ => 0,
    };
    let phase = bytes.phase();
    let v = bytes.signed();
    let (p, y, q) = match bytes.byte() % 4 {
        // On the surface with a chosen force.
        0 | 1 => {
            let q = bytes.signed();
            let y = (bytes.force() - q) / (2.0 * xi);
            (q + g, y, Some(q))
        }
        // On or below the surface, by a chosen distance.
        2 => {
            let q = bytes.signed();
            (q + g - bytes.size(), bytes.signed(), Some(q))
        }
        // Anything; the slider follows or is at rest.
        _ => (bytes.signed(), bytes.signed(), None),
    };
    let [p, y] = [p, y].map(|x| x.clamp(-MAX_SIZE, MAX_SIZE));
    Start { tau, cycle, p, y, q, v, phase }
}
