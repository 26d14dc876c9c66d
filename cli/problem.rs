//! What went wrong, how it is shown, and which exit code it makes.
//!
//! A [`Problem`] is a value that travels up to [`Report`], the only place that writes to standard
//! error. What the compiler and the resources say is shown as pages; what has no place in a source
//! text is one sentence.

use crate::args::MessageFormat;
use std::io::{IsTerminal, Write};
use texgraph_compiler::Checked;
use texgraph_compiler::diagnostic::{Diagnostic, Place, render};
use texgraph_compiler::module::{Source, Sources};
use texgraph_runtime::picture::PictureError;
use texgraph_runtime::render::RenderError;
use texgraph_runtime::settings::SettingError;

/// Why a subcommand can't do what was asked.
pub enum Problem {
    /// Errors with places in source texts: exit code 1.
    Pages(texgraph_compiler::Failure),
    /// A file named on the command line has no text: exit code 1.
    Unread {
        /// Its path as the user sees it.
        path: String,
        /// Why, with the path.
        why: String,
    },
    /// A picture named on the command line can't be read: exit code 1.
    Picture {
        /// Its path as the user sees it.
        path: String,
        /// Why.
        diagnostics: Vec<Diagnostic>,
    },
    /// Something else is wrong with the input: exit code 1.
    Input(String),
    /// The command line asks for what makes no sense: exit code 2.
    Usage(String),
    /// The machine can't: exit code 3.
    Machine(String),
}

impl Problem {
    /// A file that can't be read. `why` names it by `name`, which may lack the folder.
    pub fn unread(path: &str, name: &str, why: String) -> Problem {
        let why = if path == name { why } else { format!("can't read `{path}`: {why}") };
        Problem::Unread { path: path.to_owned(), why }
    }

    fn exit_code(&self) -> u8 {
        match self {
            Problem::Pages(_) | Problem::Unread { .. } | Problem::Picture { .. } | Problem::Input(_) => 1,
            Problem::Usage(_) => 2,
            Problem::Machine(_) => 3,
        }
    }
}

impl From<texgraph_compiler::Failure> for Problem {
    fn from(failure: texgraph_compiler::Failure) -> Problem {
        Problem::Pages(failure)
    }
}

impl From<SettingError> for Problem {
    fn from(error: SettingError) -> Problem {
        Problem::Usage(error.to_string())
    }
}

impl From<PictureError> for Problem {
    fn from(error: PictureError) -> Problem {
        Problem::Machine(error.to_string())
    }
}

impl From<RenderError> for Problem {
    fn from(error: RenderError) -> Problem {
        let sentence = error.to_string();
        let cause = if let RenderError::Bake { error, .. } = &error { error } else { &error };
        match cause {
            RenderError::Size { .. } | RenderError::NotFinite => Problem::Usage(sentence),
            RenderError::NoOutput { .. } | RenderError::NoTable { .. } | RenderError::TextureSize { .. } => {
                Problem::Input(sentence)
            }
            RenderError::Memory { .. }
            | RenderError::TooMuchWork { .. }
            | RenderError::NoPass
            | RenderError::Bake { .. }
            | RenderError::NoAdapter { .. }
            | RenderError::Gpu(_) => Problem::Machine(sentence),
        }
    }
}

/// The code of a file that can't be read, as of an imported one.
const UNREAD: &str = "E0601";

/// The code of a picture that is not there: nothing more can be said of it.
const MISSING: &str = "E0501";

/// Shows problems and remembers the worst.
pub struct Report {
    format: MessageFormat,
    is_colored: bool,
    exit_code: u8,
}

impl Report {
    /// Nothing shown yet.
    pub fn new(format: MessageFormat) -> Report {
        Report { format, is_colored: is_colored(), exit_code: 0 }
    }

    /// What the process ends with: the greatest code of all problems.
    pub fn exit_code(&self) -> u8 {
        self.exit_code
    }

    /// Shows a problem on standard error.
    pub fn show(&mut self, problem: &Problem) {
        let text = match problem {
            Problem::Pages(failure) => self.pages(&failure.sources, &failure.diagnostics),
            Problem::Unread { path, why } => self.unread(path, why),
            Problem::Picture { path, diagnostics } => self.picture(path, diagnostics),
            Problem::Input(text) | Problem::Usage(text) | Problem::Machine(text) => self.sentence(text),
        };
        // When even standard error is closed, the exit code is all that can be said.
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
        self.exit_code = self.exit_code.max(problem.exit_code());
    }

    /// Shows warnings, which leave the exit code as it is.
    pub fn warn(&self, checked: &Checked) {
        let text = self.pages(&checked.sources, &checked.warnings);
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
    }

    /// Counts as wrong input what was shown in another way.
    pub fn count_as_wrong(&mut self) {
        self.exit_code = self.exit_code.max(1);
    }

    fn pages(&self, sources: &Sources, diagnostics: &[Diagnostic]) -> String {
        match self.format {
            MessageFormat::Human if self.is_colored => render::human_colored(sources, diagnostics),
            MessageFormat::Human => render::human(sources, diagnostics),
            MessageFormat::Short => render::short(sources, diagnostics),
            MessageFormat::Json => render::json(sources, diagnostics),
        }
    }

    /// For people a sentence: there is nothing to underline. For programs the file at its start.
    fn unread(&self, path: &str, why: &str) -> String {
        if self.format == MessageFormat::Human {
            return self.sentence(why);
        }
        let sources = Sources(vec![Source { path: path.to_owned(), text: "".into() }]);
        self.pages(&sources, &[Diagnostic { code: UNREAD, ..without_code(why) }])
    }

    /// Likewise, with the code and the reason that pages show under a source line.
    fn picture(&self, path: &str, diagnostics: &[Diagnostic]) -> String {
        if self.format != MessageFormat::Human {
            let sources = Sources(vec![Source { path: path.to_owned(), text: "".into() }]);
            return self.pages(&sources, diagnostics);
        }
        let told = |diagnostic: &Diagnostic| match diagnostic.code {
            MISSING => diagnostic.clone(),
            _ => Diagnostic {
                message: format!("{}: {}", diagnostic.message, diagnostic.label),
                ..diagnostic.clone()
            },
        };
        self.pages(&Sources::default(), &diagnostics.iter().map(told).collect::<Vec<_>>())
    }

    fn sentence(&self, text: &str) -> String {
        match self.format {
            MessageFormat::Json => render::json(&Sources::default(), &[without_code(text)]),
            MessageFormat::Human if self.is_colored => {
                format!("\x1b[1;31merror\x1b[0m\x1b[1m: {text}\x1b[0m\n")
            }
            MessageFormat::Human | MessageFormat::Short => format!("error: {text}\n"),
        }
    }
}

/// A sentence as a diagnostic without a code.
fn without_code(text: &str) -> Diagnostic {
    Diagnostic::new("", Place::default(), text, "")
}

/// Colours are for terminals, and for people who want them (<https://no-color.org>).
fn is_colored() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    std::io::stderr().is_terminal() && !is_set("NO_COLOR") && !is_dumb
}
