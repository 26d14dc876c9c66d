//! `texgraph graph`: the node diagram of a texture, as a picture or as text for Graphviz.

use crate::args::Graph;
use crate::output;
use crate::problem::Problem;
use crate::program::{self, Program};
use std::path::Path;
use texgraph_compiler::diagram::{Diagram, DrawError};

/// Draws a texture or node.
///
/// # Errors
/// The syntax is wrong, there is no such node, or it is too large for a picture.
pub fn run(args: &Graph) -> Result<(), Problem> {
    let form = args.output.as_deref().map_or(Ok(Form::Dot), form)?;
    if let Some(path) = &args.output {
        output::try_out(path)?;
    }
    let (file, name) = program::split(&args.file);
    let library = program::library()?;
    let program = Program::open(&library, &file, args.common.allow_outside)?;
    let diagram = program.diagram(name.as_deref())?;
    let text = match form {
        Form::Dot => diagram.to_dot(),
        Form::Svg => picture(&diagram)?,
    };
    match &args.output {
        Some(path) => output::write(&[(path.clone(), text)]),
        None => output::print(&text),
    }
}

/// What is written.
enum Form {
    Svg,
    Dot,
}

fn form(path: &Path) -> Result<Form, Problem> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("svg") => Ok(Form::Svg),
        Some("dot" | "gv") => Ok(Form::Dot),
        _ => {
            let path = path.display();
            Err(Problem::Usage(format!("`{path}` must end in `.svg` (a picture) or `.dot` (for Graphviz)")))
        }
    }
}

fn picture(diagram: &Diagram) -> Result<String, Problem> {
    diagram.to_svg().map_err(|error| {
        let mend = match error {
            DrawError::TooLarge(_) => "draw one of its nodes (`FILE:NODE`), or write a `.dot`",
            DrawError::TooEntangled(_) => "write a `.dot` and let Graphviz lay it out",
        };
        Problem::Input(format!("the diagram can't be drawn: {error}; {mend}"))
    })
}
