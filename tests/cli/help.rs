//! Help, error codes, and what the command says when it is called without sense.

use crate::workshop::{PLAIN, Workshop, command};
use std::io::Write;
use std::process::Stdio;

#[test]
fn the_first_page_is_as_reviewed() {
    let run = Workshop::new(&[]).run(&["--help"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_eq!(run.out, include_str!("help.txt"));
    assert_eq!(Workshop::new(&[]).run(&["-h"]).out, run.out);
}

#[test]
fn every_subcommand_shows_an_example() {
    for name in ["check", "build", "render", "cost", "graph", "inspect", "tiles", "fmt", "explain"] {
        let run = Workshop::new(&[]).run(&[name, "--help"]);
        assert_eq!((run.code, run.err.as_str()), (0, ""));
        assert!(run.out.contains("Example") && run.out.contains(&format!("texgraph {name} ")), "{}", run.out);
        assert!(run.out.lines().all(|line| line.chars().count() <= 100), "{}", run.out);
    }
}

#[test]
fn senseless_calls_are_usage_errors() {
    let shop = Workshop::new(&[]);
    shop.run::<&str>(&[]).fails(2, "Usage: texgraph");
    for name in ["check", "build", "render", "cost", "graph", "inspect", "tiles", "fmt"] {
        shop.run(&[name]).fails(2, "Usage: texgraph");
    }
}

#[test]
fn codes_are_explained_however_they_are_written() {
    let shop = Workshop::new(&[]);
    let page = shop.run(&["explain", "E0501"]);
    assert_eq!(page.code, 0, "{page:#?}");
    assert!(page.out.contains("# A file that a resource names is not there"), "{page:#?}");
    for code in ["e0501", "0501", "501", "E501"] {
        assert_eq!(shop.run(&["explain", code]).out, page.out, "{code}");
    }
    let list = shop.run(&["explain"]);
    assert!(list.out.contains("E0501  A file that a resource names is not there\n"), "{list:#?}");
    let warning = shop.run(&["explain", "W0801"]);
    assert!(warning.code == 0 && warning.out == shop.run(&["explain", "w801"]).out, "{warning:#?}");
    shop.run(&["explain", "E9998"]).fails(2, "near it are E0");
    shop.run(&["explain", "grass"]).fails(2, "`grass` is no error code");
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    for (program, code) in [(PLAIN, 0), ("texture", 1)] {
        let mut child = command(&std::env::temp_dir())
            .args(["fmt", "-"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        // It waits for its input, so both readers are gone before it writes.
        drop((child.stdout.take(), child.stderr.take()));
        let mut input = child.stdin.take().expect("a pipe");
        input.write_all(program.as_bytes()).expect("it reads");
        drop(input);
        // A panic would end with 101.
        assert_eq!(child.wait().expect("it ends").code(), Some(code), "{program}");
    }
}
