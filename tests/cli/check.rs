//! `check`: what is right is silent, what is wrong is shown in the wanted format.

use crate::workshop::{PLAIN, WRONG, Workshop};

#[test]
fn right_files_are_silent() {
    let shop = Workshop::new(&[("a.tex", PLAIN), ("b.tex", PLAIN)]);
    assert!(shop.run(&["check", "a.tex", "b.tex"]).is_silent());
    assert_eq!(shop.names(), ["a.tex", "b.tex"]);
}

#[test]
fn all_errors_of_all_files_are_shown() {
    let shop = Workshop::new(&[("a.tex", WRONG), ("b.tex", PLAIN), ("sub/c.tex", WRONG)]);
    let run = shop.run(&["check", "a.tex", "b.tex", "sub/c.tex"]);
    run.fails(1, "─ a.tex:2:");
    run.fails(1, "─ sub/c.tex:2:");
    assert!(!run.err.contains("b.tex") && run.out.is_empty(), "{run:#?}");
}

#[test]
fn warnings_are_shown_and_fail_nothing() {
    let jumps = "texture t(uv: vec2) -> (height: float) {\n    height = footprint(hash(ifloor(uv)).x)\n}\n";
    let shop = Workshop::new(&[("a.tex", jumps)]);
    let run = shop.run(&["check", "a.tex", "--message-format", "short"]);
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{run:#?}");
    assert!(run.err.starts_with("a.tex:2:24: warning[W0801]: "), "{run:#?}");
}

#[test]
fn formats_differ() {
    let shop = Workshop::new(&[("a.tex", WRONG)]);
    let short = shop.run(&["check", "a.tex", "--message-format", "short"]);
    short.fails(1, "a.tex:2:");
    assert_eq!(short.err.lines().count(), 1, "{short:#?}");
    let json = shop.run(&["check", "a.tex", "--message-format=json"]);
    json.fails(1, "\"file_name\":\"a.tex\"");
    assert!(json.err.lines().all(|line| line.starts_with('{') && line.ends_with('}')), "{json:#?}");
}

#[test]
fn no_colours_leave_the_terminal() {
    let shop = Workshop::new(&[("a.tex", WRONG)]);
    assert!(!shop.run(&["check", "a.tex", "missing.tex", ".."]).err.contains('\x1b'));
}

#[test]
fn files_that_are_no_programs() {
    let shop = Workshop::new(&[("tiling.tex", PLAIN)]);
    shop.write("bytes.tex", [0x61, 0xff, 0xfe]);
    shop.write("folder/x.tex", PLAIN);
    shop.run(&["check", "tilling.tex"]).fails(1, "is `tiling.tex` meant?");
    shop.run(&["check", "folder/y.tex"]).fails(1, "can't read `folder/y.tex`");
    shop.run(&["check", "folder"]).fails(1, "`folder` is a folder");
    shop.run(&["check", "folder/"]).fails(1, "`folder` is a folder");
    shop.run(&["check", ".."]).fails(1, "`..` is a folder");
    shop.run(&["check", "bytes.tex"]).fails(1, "not UTF-8 text (byte 1");
    shop.run(&["check", ""]).fails(2, "a value is required");
    shop.run(&["check", "x.tex", "--message-format=short"]).fails(1, "x.tex:1:1: error[E0601]: there is no");
    shop.run(&["check", "x.tex", "--message-format=json"]).fails(1, "\"file_name\":\"x.tex\"");
    shop.run(&["check", "..", "--message-format=json"]).fails(1, "{\"message\":\"`..` is a folder");
}

#[cfg(unix)]
#[test]
fn names_that_are_not_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let shop = Workshop::new(&[]);
    let name = OsStr::from_bytes(b"\xff.tex");
    shop.run(&[OsStr::new("check"), name]).fails(1, "there is no file");
    shop.run(&[OsStr::new("fmt"), name]).fails(1, "there is no file");
    shop.run(&[OsStr::new("render"), name, OsStr::new("-o"), OsStr::new("x.png")]).fails(1, "there is no");
}

#[test]
fn imports_stay_in_the_folder() {
    let inner = "use \"../stone.tex\"\n\ntexture t(uv: vec2) -> (color: color) {\n    color = vec4(uv, shade(), 1.0)\n}\n";
    let outer = "node shade() -> (v: float) {\n    v = 0.5\n}\n";
    let shop = Workshop::new(&[("stone.tex", outer), ("sub/a.tex", inner)]);
    shop.run(&["check", "sub/a.tex"]).fails(1, "--allow-outside");
    assert!(shop.run(&["check", "sub/a.tex", "--allow-outside"]).is_silent());
}
