//! A map over a slice, and two pieces of work at once, on all threads where the feature `parallel`
//! is on; the same result anyway.

/// `each(item)` of every item, in order.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], each: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        items.par_iter().map(each).collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        items.iter().map(each).collect()
    }
}

/// The results of two pieces of work that do not wait for each other.
#[cfg(feature = "affine")]
pub(crate) fn join<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "parallel")]
    {
        rayon::join(first, second)
    }
    #[cfg(not(feature = "parallel"))]
    {
        (first(), second())
    }
}
