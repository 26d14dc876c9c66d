//! The list of codes and their long explanations.

/// Every code with its page.
pub const PAGES: &[(&str, &str)] = &[];

/// The long explanation of a code; none for an unknown one.
pub fn explain(code: &str) -> Option<&'static str> {
    PAGES.iter().find(|(known, _)| *known == code).map(|(_, page)| *page)
}
