//! Source text as it stands in a block: on one line, without comments, parts replaced.

use texgraph_grammar::syntax::{Comment, Span};

/// The text of a span with parts replaced by others, comments left out and white space as the
/// formatter has it within a line. The parts lie apart from each other, in source order.
pub fn excerpt(source: &str, comments: &[Comment], span: Span, parts: &[(Span, String)]) -> String {
    let within = |part: &Span| part.start >= span.start && part.end <= span.end;
    let first = comments.partition_point(|comment| comment.span.start < span.start);
    let comments = comments[first..].iter().map(|comment| comment.span).take_while(within);
    let mut cuts: Vec<(Span, &str)> = comments.map(|span| (span, " ")).collect();
    cuts.extend(parts.iter().map(|(span, text)| (*span, text.as_str())));
    cuts.sort_by_key(|(span, _)| *span);
    let mut line = Line::default();
    let mut at = span.start;
    for (cut, text) in cuts {
        // A comment inside a replaced part is gone with it.
        if cut.start >= at {
            line.push(source.get(Span { start: at, end: cut.start }.range()).unwrap_or_default());
            line.push(text);
            at = cut.end;
        }
    }
    line.push(source.get(Span { start: at, end: span.end }.range()).unwrap_or_default());
    line.text
}

/// Text with its white space put in order.
#[derive(Default)]
struct Line {
    text: String,
    /// White space was met since the last character.
    gap: bool,
    in_string: bool,
    escaped: bool,
}

impl Line {
    fn push(&mut self, text: &str) {
        text.chars().for_each(|c| self.push_char(c));
    }

    fn push_char(&mut self, c: char) {
        if self.in_string {
            self.in_string = self.escaped || c != '"';
            self.escaped = !self.escaped && c == '\\';
            self.text.push(c);
            return;
        }
        if c.is_whitespace() {
            self.gap = true;
            return;
        }
        if matches!(c, ')' | ']') && self.text.ends_with(',') {
            self.text.pop();
        }
        let touches = matches!(c, ')' | ']' | ',') || self.text.is_empty() || self.text.ends_with(['(', '[']);
        if self.gap && !touches {
            self.text.push(' ');
        }
        self.gap = false;
        self.in_string = c == '"';
        self.text.push(c);
    }
}

/// Lines of at most so many columns where there are blanks to break at, continued with an indent;
/// after `most` lines the rest is left out, with a mark.
pub fn wrap(text: &str, columns: usize, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(line) + 1 + width(word) <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            Some(_) => lines.push(format!("  {word}")),
            None => lines.push(word.to_owned()),
        }
        if lines.len() > most {
            lines.truncate(most);
            lines.push("  …".to_owned());
            break;
        }
    }
    lines.iter().map(|line| shorten(line, columns * 2)).collect()
}

/// The text, or its beginning with a mark.
pub fn shorten(text: &str, columns: usize) -> String {
    if width(text) <= columns {
        return text.to_owned();
    }
    let mut left = columns.saturating_sub(1);
    let fits = |c: &char| {
        let fits = char_width(*c) <= left;
        left = left.saturating_sub(char_width(*c));
        fits
    };
    let mut short: String = text.chars().take_while(fits).collect();
    short.push('…');
    short
}

/// Columns of a text in a monospaced font: an upper bound, as a glyph outside ASCII may be wide.
pub fn width(text: &str) -> usize {
    text.chars().map(char_width).sum()
}

fn char_width(c: char) -> usize {
    match c {
        '…' | '₀'..='₉' | '·' => 1,
        _ if c.is_ascii() => 1,
        _ => 2,
    }
}

/// A number as subscript digits.
pub fn subscript(number: usize) -> String {
    let digit = |c: char| char::from_u32('₀' as u32 + c.to_digit(10).unwrap_or(0)).unwrap_or(c);
    number.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::{excerpt, shorten, subscript, width, wrap};
    use texgraph_grammar::syntax::{Comment, CommentKind, Span};

    #[test]
    fn white_space_and_comments_go_and_strings_stay() {
        let source = "f(\n    a ,  // first\n    \"two  blanks \\\" )\",\n    [ 1,\n 2, ],\n)";
        let start = source.find("//").unwrap_or_default();
        let end = source.find("first").unwrap_or_default() + "first".len();
        let comments = [Comment { span: Span::new(start, end), kind: CommentKind::Line }];
        let all = Span::new(0, source.len());
        assert_eq!(excerpt(source, &comments, all, &[]), "f(a, \"two  blanks \\\" )\", [1, 2])");
    }

    #[test]
    fn parts_are_replaced() {
        let source = "1.0 - g(x /* odd */ + 1) * h";
        let start = source.find("/*").unwrap_or_default();
        let comments = [Comment { span: Span::new(start, start + 9), kind: CommentKind::Block }];
        let call = source.find('g').unwrap_or_default();
        let part = (Span::new(call, source.find(" * h").unwrap_or_default()), "g".to_owned());
        let all = Span::new(0, source.len());
        assert_eq!(excerpt(source, &comments, all, &[part]), "1.0 - g * h");
    }

    #[test]
    fn lines_end() {
        assert_eq!(wrap("one two three", 8, 9), ["one two", "  three"]);
        assert_eq!(wrap("a b c d e f", 3, 2), ["a b", "  c", "  …"]);
        assert_eq!(wrap("", 8, 9), [""]);
        assert_eq!(shorten("abcdef", 4), "abc…");
        assert_eq!(shorten("日本語", 4), "日…");
        assert_eq!(width("日a…"), 4);
        assert_eq!(subscript(102), "₁₀₂");
    }
}
