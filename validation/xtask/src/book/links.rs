//! The links of a page of Markdown.

use anyhow::{Context, Result};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;

/// The page with each target of a link or a picture replaced by what `moved` makes of it; an
/// address of the web stays.
pub fn replaced(page: &str, mut moved: impl FnMut(&str) -> Result<String>) -> Result<String> {
    let mut targets = Vec::new();
    for (event, range) in Parser::new_ext(page, Options::ENABLE_TABLES).into_offset_iter() {
        if let Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) = event {
            if dest_url.contains("://") {
                continue;
            }
            let before = "](";
            let at = page[range.clone()].rfind(&format!("{before}{dest_url}"));
            let at = at.with_context(|| format!("the link to {dest_url} is not written inline"))?;
            let begin = range.start + at + before.len();
            targets.push((begin..begin + dest_url.len(), moved(&dest_url)?));
        }
    }
    // A picture in a link comes after the link and before the link's target.
    targets.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let mut page = page.to_owned();
    for (range, target) in targets {
        page.replace_range(range, &target);
    }
    Ok(page)
}

/// The targets of a page's links but for addresses of the web, in their order.
pub fn targets(page: &str) -> Result<Vec<String>> {
    let mut found = Vec::new();
    replaced(page, |target| {
        found.push(target.to_owned());
        Ok(target.to_owned())
    })?;
    Ok(found)
}

/// The anchors of a page's headings, as the repository's site and mdBook make them.
pub fn anchors(page: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let mut heading: Option<String> = None;
    for event in Parser::new(page) {
        match (event, &mut heading) {
            (Event::Start(Tag::Heading { .. }), _) => heading = Some(String::new()),
            (Event::Text(text) | Event::Code(text), Some(heading)) => heading.push_str(&text),
            (Event::End(TagEnd::Heading(_)), _) => {
                anchors.extend(heading.take().map(|it| anchor(&it)))
            }
            _ => {}
        }
    }
    anchors
}

/// The anchor of a heading.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let lower = heading.to_lowercase();
    lower.chars().filter(kept).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn links_in_code_stay() {
        let page =
            "[one](a.md) and `[no](b.md)`\n\n```\n[no](c.md)\n```\n\n| [two](d.md#e) |\n|--|\n";
        assert_eq!(targets(page).unwrap(), ["a.md", "d.md#e"]);
        let page = replaced(page, |target| Ok(format!("../{target}"))).unwrap();
        assert!(page.starts_with("[one](../a.md) and `[no](b.md)`"), "{page}");
        assert!(page.contains("[no](c.md)") && page.contains("[two](../d.md#e)"), "{page}");
    }

    #[test]
    fn anchors_are_those_of_headings_alone() {
        let found = anchors("# `percuss` and *you*, 2\n\n```\n# no\n```\n");
        assert_eq!(found.into_iter().collect::<Vec<_>>(), ["percuss-and-you-2"]);
    }

    #[test]
    fn a_picture_may_be_a_link() {
        let page = replaced("[![p](p.png)](q.html)", |target| Ok(format!("x/{target}"))).unwrap();
        assert_eq!(page, "[![p](x/p.png)](x/q.html)");
    }
}
