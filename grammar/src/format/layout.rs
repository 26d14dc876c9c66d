//! Where lines break.
//!
//! A text to print is a row of [`Piece`]s. Groups nest; a group is printed on one line if it fits
//! there together with what follows it up to the next place to break, and otherwise all its own
//! breaks become line breaks. Everything is done in a few passes over the row, without recursion.

use std::borrow::Cow;

/// The widest line, in characters, where there is a choice.
const WIDTH: usize = 100;
/// Spaces per level.
const INDENT: usize = 4;

/// A piece of the text to print.
pub(super) enum Piece<'s> {
    /// Something that is printed as it is.
    Text(Cow<'s, str>),
    /// A `//` comment: it may stick out of its line.
    Note(Cow<'s, str>),
    /// A line break where the group is broken, and else this text.
    Break(&'static str),
    /// A line break in any case, with an empty line or without.
    Line {
        blank: bool,
    },
    /// Printed only where the group is broken.
    IfBroken(&'static str),
    /// Spaces that align an `=` with those of its neighbours.
    Pad(usize),
    /// A group begins.
    Open(Style),
    /// The innermost group ends.
    Close,
    /// The next lines are one level deeper.
    Indent,
    /// And back.
    Dedent,
    /// The same, where the group is broken.
    IndentIfBroken,
    DedentIfBroken,
}

/// How a group behaves.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Style {
    /// Breaks everywhere or nowhere.
    Even,
    /// The same, but breaks before a later group on its line does.
    Early,
    /// Breaks only where a line is full.
    Fill,
    /// Breaks everywhere if that is enough to make each part fit its line, else nowhere, and leaves
    /// it to the groups inside.
    Links,
}

/// What can be told of each piece before printing.
pub(super) struct Measures {
    /// The width of all pieces before, were everything on one line.
    before: Vec<usize>,
    /// The forced line breaks among all pieces before.
    lines: Vec<usize>,
}

impl Measures {
    pub fn new(pieces: &[Piece<'_>]) -> Measures {
        let (mut before, mut lines) = (vec![0], vec![0]);
        let (mut width, mut count) = (0, 0);
        for piece in pieces {
            width += piece.width();
            count += usize::from(piece.is_multiline());
            before.push(width);
            lines.push(count);
        }
        Measures { before, lines }
    }

    /// The width of some pieces, were they on one line.
    fn width(&self, start: usize, end: usize) -> usize {
        self.before[end] - self.before[start]
    }

    /// The width of some pieces on one line, if they may stand on one.
    pub fn flat(&self, start: usize, end: usize) -> Option<usize> {
        (self.lines[start] == self.lines[end]).then(|| self.width(start, end))
    }
}

impl Piece<'_> {
    fn width(&self) -> usize {
        match self {
            Piece::Text(text) => text.chars().count(),
            Piece::Break(text) => text.len(),
            Piece::Pad(width) => *width,
            _ => 0,
        }
    }

    fn is_multiline(&self) -> bool {
        match self {
            Piece::Line { .. } => true,
            Piece::Text(text) => text.contains('\n'),
            _ => false,
        }
    }
}

/// Whether a piece of this width, with this indentation before it, fits on a line.
pub(super) fn fits(level: usize, width: usize) -> bool {
    level * INDENT + width <= WIDTH
}

/// Prints the pieces.
pub(super) fn render(pieces: &[Piece<'_>]) -> String {
    let measures = Measures::new(pieces);
    let mut printer = Printer { out: String::new(), column: 0, level: 0, groups: Vec::new() };
    let groups = groups(pieces, &measures);
    let stops = Stops::new(pieces);
    for (index, piece) in pieces.iter().enumerate() {
        match piece {
            Piece::Text(text) | Piece::Note(text) => printer.text(text),
            Piece::Pad(width) => printer.text(&" ".repeat(*width)),
            Piece::Line { blank } => printer.line(*blank),
            Piece::Indent => printer.level += 1,
            Piece::Dedent => printer.level -= 1,
            Piece::IndentIfBroken => printer.level += usize::from(printer.mode() == Mode::Broken),
            Piece::DedentIfBroken => printer.level -= usize::from(printer.mode() == Mode::Broken),
            Piece::IfBroken(text) if printer.mode() != Mode::Flat => printer.text(text),
            Piece::IfBroken(_) => {}
            Piece::Close => {
                printer.groups.pop();
            }
            Piece::Open(style) => {
                let group = &groups[index];
                let stop = stops.after(group.end, *style);
                let is_simple = measures.flat(index, group.end).is_some();
                let is_flat = is_simple && printer.has_room(measures.width(index, stop));
                let links_fit = is_simple
                    && printer.has_room(group.first)
                    && fits(printer.level + 1, group.widest + measures.width(group.end, stop));
                printer.open(*style, is_flat, links_fit);
            }
            Piece::Break(flat) => {
                let stop = stops.after(index + 1, Style::Even);
                let is_full = !printer.has_room(measures.width(index, stop));
                match printer.mode() {
                    Mode::Broken => printer.line(false),
                    // What breaks without a space stands next to a bracket.
                    Mode::Fill if is_full || flat.is_empty() => printer.line(false),
                    Mode::Fill | Mode::Flat | Mode::Loose => printer.text(flat),
                }
            }
        }
    }
    printer.out.push('\n');
    printer.out
}

/// What can be told of a group before printing.
#[derive(Clone, Default)]
struct Group {
    /// Its last piece.
    end: usize,
    /// The width of what is before its first break.
    first: usize,
    /// The width of the widest part behind a break.
    widest: usize,
    /// Its last break so far.
    last_break: Option<usize>,
}

impl Group {
    /// Takes the part that ends here.
    fn end_part(&mut self, start: usize, end: usize, measures: &Measures) {
        match self.last_break {
            None => self.first = measures.width(start, end),
            Some(before) => self.widest = self.widest.max(measures.width(before + 1, end)),
        }
        self.last_break = Some(end);
    }
}

/// The groups, by the piece that opens them.
fn groups(pieces: &[Piece<'_>], measures: &Measures) -> Vec<Group> {
    let mut groups = vec![Group::default(); pieces.len()];
    let mut open: Vec<usize> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        match (piece, open.last().copied()) {
            (Piece::Open(_), _) => open.push(index),
            (Piece::Break(_), Some(start)) => groups[start].end_part(start, index, measures),
            (Piece::Close, Some(start)) => {
                groups[start].end_part(start, index, measures);
                groups[start].end = index;
                open.pop();
            }
            _ => {}
        }
    }
    groups
}

/// For each piece, the next one where a line may end, and where it must.
struct Stops {
    may: Vec<usize>,
    must: Vec<usize>,
}

impl Stops {
    fn new(pieces: &[Piece<'_>]) -> Stops {
        let end = pieces.len();
        let (mut may, mut must) = (vec![end; end + 1], vec![end; end + 1]);
        for (index, piece) in pieces.iter().enumerate().rev() {
            let is_line = piece.is_multiline();
            must[index] = if is_line { index } else { must[index + 1] };
            let is_break = is_line || matches!(piece, Piece::Break(_));
            may[index] = if is_break { index } else { may[index + 1] };
        }
        Stops { may, must }
    }

    fn after(&self, index: usize, style: Style) -> usize {
        if style == Style::Early { self.must[index] } else { self.may[index] }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Flat,
    Broken,
    Fill,
    /// Itself on one line, but not what is inside.
    Loose,
}

struct Printer {
    out: String,
    /// Characters on the current line.
    column: usize,
    level: usize,
    groups: Vec<Mode>,
}

impl Printer {
    fn mode(&self) -> Mode {
        self.groups.last().copied().unwrap_or(Mode::Broken)
    }

    fn open(&mut self, style: Style, is_flat: bool, links_fit: bool) {
        self.groups.push(match (self.mode(), style) {
            (Mode::Flat, _) => Mode::Flat,
            _ if is_flat => Mode::Flat,
            (_, Style::Fill) => Mode::Fill,
            (_, Style::Links) if !links_fit => Mode::Loose,
            _ => Mode::Broken,
        });
    }

    fn has_room(&self, width: usize) -> bool {
        let column = if self.column == 0 { self.level * INDENT } else { self.column };
        column + width <= WIDTH
    }

    fn text(&mut self, text: &str) {
        if text.is_empty() {
            return;
        }
        if self.column == 0 {
            self.column = self.level * INDENT;
            self.out.push_str(&" ".repeat(self.column));
        }
        self.out.push_str(text);
        match text.rsplit_once('\n') {
            // A comment that ends at the margin still stands on its line.
            Some((_, last)) => self.column = last.chars().count().max(1),
            None => self.column += text.chars().count(),
        }
    }

    fn line(&mut self, blank: bool) {
        self.out.push_str(if blank { "\n\n" } else { "\n" });
        self.column = 0;
    }
}
