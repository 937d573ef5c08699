//! Numbers and lists as programs may write them, with bounds on how many there are, so that an
//! answer takes no more memory than its line.

use percuss_engines::engine::Numbers;
use percuss_engines::system::{MAX_STATES, Values};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The largest whole number of which an f64 holds every smaller one.
const MAX_COUNT: f64 = 9_007_199_254_740_992.0;

/// A number that counts, 0 to 2^53. Some languages write 3 as 3.0 or 3e0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count(pub(crate) u64);

impl<'de> Deserialize<'de> for Count {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = f64::deserialize(deserializer)?;
        if value.fract() == 0.0 && (0.0..=MAX_COUNT).contains(&value) {
            Ok(Self(value as u64))
        } else {
            Err(D::Error::custom(format!("{value:?} is no count: accepted is 0, 1, 2, ...")))
        }
    }
}

/// A list of at most `MAX` items.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BoundedList<T, const MAX: usize>(pub(crate) Vec<T>);

struct Items<T, const MAX: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const MAX: usize> Visitor<'de> for Items<T, MAX> {
    type Value = BoundedList<T, MAX>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of at most {MAX}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Self::Value, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            if list.len() == MAX {
                return Err(A::Error::custom(format!("a list of more than {MAX}")));
            }
            list.push(item);
        }
        Ok(BoundedList(list))
    }
}

impl<'de, T: Deserialize<'de>, const MAX: usize> Deserialize<'de> for BoundedList<T, MAX> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Items(PhantomData))
    }
}

/// A state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct StateReply(pub(crate) Values);

impl<'de> Deserialize<'de> for StateReply {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let list = BoundedList::<f64, MAX_STATES>::deserialize(deserializer)?;
        Ok(Self(Values::from_slice(&list.0)))
    }
}
