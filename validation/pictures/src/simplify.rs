//! Lines with no more points than the eye can see.

use super::canvas::At;

/// The largest distance by which a line may move, in pixels.
const TOLERANCE: f64 = 0.1;

/// The line through some of its places that passes all others within a tenth of a pixel, by the
/// method of Ramer, Douglas and Peucker.
pub(super) fn simplify_line(places: &[At]) -> Vec<At> {
    let Some(end) = places.len().checked_sub(1) else { return Vec::new() };
    let mut kept = vec![false; places.len()];
    (kept[0], kept[end]) = (true, true);
    let mut open = vec![(0, end)];
    while let Some((first, last)) = open.pop() {
        let far = |n: &usize| distance(places[*n], places[first], places[last]);
        let farthest = (first + 1..last).max_by(|a, b| far(a).total_cmp(&far(b)));
        let Some(farthest) = farthest.filter(|n| far(n) > TOLERANCE) else { continue };
        kept[farthest] = true;
        open.extend([(first, farthest), (farthest, last)]);
    }
    places.iter().zip(kept).filter(|(_, kept)| *kept).map(|(at, _)| *at).collect()
}

/// The distance of a place from the line between two others.
fn distance(at: At, from: At, to: At) -> f64 {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (x, y) = (at.0 - from.0, at.1 - from.1);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return x.hypot(y);
    }
    // Beyond an end of the line it is the distance from that end.
    let along = ((x * dx + y * dy) / (length * length)).clamp(0.0, 1.0);
    (x - along * dx).hypot(y - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_lies_on_the_line() {
        let circle = |n: usize| {
            let angle = n as f64 * 0.01;
            (100.0 * angle.cos(), 100.0 * angle.sin())
        };
        let places: Vec<At> = (0..=628).map(circle).collect();
        let line = simplify_line(&places);
        // A chord that passes within a tenth of a pixel spans 0.0894 radians, so that it takes 71
        // of them; halving what is too long takes at most twice as many.
        assert!(line.len() <= 2 * 71 + 1, "{}", line.len());
        for at in &places {
            let near = line.windows(2).map(|ends| distance(*at, ends[0], ends[1]));
            assert!(near.fold(f64::INFINITY, f64::min) <= TOLERANCE);
        }
        assert_eq!((line.first(), line.last()), (places.first(), places.last()));
    }

    #[test]
    fn a_straight_line_has_two_points_and_a_return_is_kept() {
        let straight: Vec<At> = (0..50).map(|n| (f64::from(n), 2.0 * f64::from(n))).collect();
        assert_eq!(simplify_line(&straight), [(0.0, 0.0), (49.0, 98.0)]);
        let there_and_back = [(0.0, 0.0), (5.0, 0.0), (0.0, 0.0)];
        assert_eq!(simplify_line(&there_and_back), there_and_back);
        assert!(simplify_line(&[]).is_empty());
        assert_eq!(simplify_line(&[(1.0, 2.0)]), [(1.0, 2.0)]);
    }
}
