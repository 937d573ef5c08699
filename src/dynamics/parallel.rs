//! A map over a slice, on all threads where the feature `parallel` is on; the same result anyway.

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
