//! The instruction sets, chosen when the program runs.

use super::batch::{Batch, LaneTask};
use super::work::BatchWork;
use crate::unknown_name::UnknownName;
use pulp::Simd;
use std::fmt;
use std::str::FromStr;

/// How many motions are solved at once, and by which instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instructions(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    One,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Instructions {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let all = Self::available();
        UnknownName::find("instruction set of this processor", &all, Self::as_str, name)
    }
}

/// The processor's permission to use a set.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Permit {
    #[cfg(target_arch = "x86_64")]
    Avx2(pulp::x86::V3),
    #[cfg(target_arch = "x86_64")]
    Avx512(pulp::x86::V4),
    #[cfg(target_arch = "aarch64")]
    Neon(pulp::aarch64::Neon),
}

impl Instructions {
    /// The scalar solver, which follows one motion after the other on every processor.
    pub const ONE: Self = Self(Set::One);

    /// The instruction sets of this processor, the widest last.
    #[must_use]
    pub fn available() -> Vec<Self> {
        #[cfg(target_arch = "x86_64")]
        let sets = [Set::One, Set::Avx2, Set::Avx512];
        #[cfg(target_arch = "aarch64")]
        let sets = [Set::One, Set::Neon];
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let sets = [Set::One];
        let all = sets.into_iter().map(Self);
        all.filter(|it| it.0 == Set::One || it.permit().is_some()).collect()
    }

    /// The widest instruction set of this processor.
    #[must_use]
    pub fn widest() -> Self {
        Self::available().pop().unwrap_or(Self::ONE)
    }

    /// The usual name of the instruction set.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self.0 {
            Set::One => "scalar",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => "AVX-512",
            #[cfg(target_arch = "aarch64")]
            Set::Neon => "NEON",
        }
    }

    pub(crate) fn permit(self) -> Option<Permit> {
        match self.0 {
            Set::One => None,
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => pulp::x86::V3::try_new().map(Permit::Avx2),
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => pulp::x86::V4::try_new().map(Permit::Avx512),
            #[cfg(target_arch = "aarch64")]
            Set::Neon => pulp::aarch64::Neon::try_new().map(Permit::Neon),
        }
    }
}

impl Permit {
    /// Lanes of a batch.
    pub(crate) const fn width(self) -> usize {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(_) => pulp::x86::V3::F64_LANES,
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(_) => pulp::x86::V4::F64_LANES,
            #[cfg(target_arch = "aarch64")]
            Self::Neon(_) => pulp::aarch64::Neon::F64_LANES,
        }
    }

    /// Works a batch off.
    pub(crate) fn work(self, task: LaneTask, batch: &mut Batch) {
        let work = BatchWork { task, batch };
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(simd) => Simd::vectorize(simd, work),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(simd) => Simd::vectorize(simd, work),
            #[cfg(target_arch = "aarch64")]
            Self::Neon(simd) => Simd::vectorize(simd, work),
        }
    }
}
