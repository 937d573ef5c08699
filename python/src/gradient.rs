//! The derivatives of a run's rows by names.

use percuss::{Event, Gradient, NoGradient};

/// Derivatives, or the reason why there are none.
pub(crate) type Found<V> = Result<Gradient<V>, NoGradient>;

/// The derivatives of a row by a name.
#[derive(Clone)]
pub(crate) struct ByName<V> {
    both: Found<V>,
    /// Those below and above the name's value, where they differ.
    pub(crate) sides: Option<Box<[Found<V>; 2]>>,
}

impl<V> ByName<V> {
    /// The derivatives on a side, 0 below and 1 above the name's value, or on both.
    pub(crate) fn on(&self, side: Option<usize>) -> &Found<V> {
        let one = side.zip(self.sides.as_deref());
        one.and_then(|(side, sides)| sides.get(side)).unwrap_or(&self.both)
    }
}

/// The derivatives of an event by each name, in the order of the names.
pub(crate) fn by_name<V: Clone>(event: &Event<'_, V>, names: &[String]) -> Vec<ByName<V>> {
    let one = |name: &String| ByName {
        both: event.gradient(name).unwrap_or(Err(NoGradient::Unknown)).cloned(),
        sides: event.one_sided(name).map(|it| Box::new(it.map(Result::<&_, _>::cloned))),
    };
    names.iter().map(one).collect()
}
