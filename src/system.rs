//! The parts of a [`System`](crate::System), for those who build or inspect one.
//!
//! [`SystemBuilder`] makes a system of equations in text or in numbers and names the item of a
//! mistake. The fields of a [`System`](crate::System) are public: its modes with their matrices,
//! guards and resets in exact [`Rational`](crate::Rational) numbers. A system that was changed by
//! hand is checked when a [`Solver`](crate::Solver) is made of it.
//!
//! ```
//! use percuss::{System, gallery};
//!
//! let oscillator = System::from_toml(gallery::IMPACT_OSCILLATOR)?;
//! let free = &oscillator.modes[0];
//! assert_eq!((free.name.as_str(), free.until[0].name.as_str()), ("free", "impact"));
//! // The entries of z are x, v, cos theta, sin theta and 1.
//! let row: Vec<f64> = free.matrix[1].iter().map(|entry| entry.to_f64()).collect();
//! assert_eq!(row, [-1.0, -0.1, 1.0, 0.0, 0.0]);
//! # Ok::<(), percuss::SystemError>(())
//! ```

pub use crate::affine::{
    BifurcationCurve, BifurcationPoint, CurveEnding, Direction, Exponents, Expression, Forcing,
    Guard, LARGEST_DIMENSION, LeftOut, Limit, LimitBuilder, Mode, ModeBuilder, Name, NoOrbit,
    NoReturn, Observable, Orbit, Passage, Place, Plane, RationalError, Return, ReturnAttractor,
    ReturnBasins, ReturnBifurcation, ReturnBranch, ReturnDiagram, ReturnDiagramStep, ReturnFamily,
    ReturnPlane, Returns, Row, Section, SectionMap, StartPoint, Successor, SystemBuilder,
    SystemFile, TROUBLE, Tangent, UnresolvedReturn, Until, UntilBuilder, ValueError, Watch,
};
