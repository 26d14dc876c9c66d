//! Which files a program may read.

mod common;

use common::{folder, project};
use std::fs;
use texgraph_compiler::module::Loader;
use texgraph_runtime::project::{Problem, Project};

fn problem(project: &Project, path: &str) -> Problem {
    project.read(path).expect_err("it must not be read").problem
}

#[test]
fn files_of_the_folder_are_read() {
    let folder = folder();
    fs::create_dir(folder.path().join("tiles")).expect("it is made");
    fs::write(folder.path().join("tiles/a.bin"), b"abc").expect("it is written");
    let project = project(folder.path());
    assert_eq!(project.read("tiles/a.bin").as_deref(), Ok(&b"abc"[..]));
    assert_eq!(project.read("tiles/../tiles/a.bin").as_deref(), Ok(&b"abc"[..]));
    assert_eq!(project.main(), "main.tex");
}

#[test]
fn paths_that_leave_are_refused_unless_allowed() {
    let folder = folder();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("it is made");
    fs::write(folder.path().join("secret"), b"abc").expect("it is written");
    let refused = Project::new(&inner.join("main.tex"), false);
    let absolute = folder.path().join("secret").display().to_string();
    for path in ["../secret", "x/../../secret", &absolute, "C:\\secret", "\\\\host\\secret"] {
        assert_eq!(problem(&refused, path), Problem::Outside { link: false }, "{path}");
    }
    let sentence = refused.load("../secret").expect_err("it must not be read");
    assert!(sentence.contains("--allow-outside"), "{sentence}");
    let allowed = Project::new(&inner.join("main.tex"), true);
    assert_eq!(allowed.read("../secret").as_deref(), Ok(&b"abc"[..]));
    assert_eq!(allowed.read(&absolute).as_deref(), Ok(&b"abc"[..]));
}

#[cfg(unix)]
#[test]
fn links_that_lead_out_are_refused() {
    let folder = folder();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("it is made");
    fs::write(folder.path().join("secret"), b"abc").expect("it is written");
    fs::write(inner.join("own"), b"xyz").expect("it is written");
    std::os::unix::fs::symlink(folder.path().join("secret"), inner.join("link")).expect("it is linked");
    std::os::unix::fs::symlink(folder.path(), inner.join("up")).expect("it is linked");
    std::os::unix::fs::symlink("own", inner.join("same")).expect("it is linked");
    let project = project(&inner);
    assert_eq!(problem(&project, "link"), Problem::Outside { link: true });
    assert_eq!(problem(&project, "up/secret"), Problem::Outside { link: true });
    assert_eq!(project.read("same").as_deref(), Ok(&b"xyz"[..]));
    assert_eq!(project.read("up/inner/own").as_deref(), Ok(&b"xyz"[..]));
}

#[cfg(unix)]
#[test]
fn the_main_file_may_itself_be_a_link() {
    let folder = folder();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("it is made");
    fs::write(folder.path().join("real.tex"), "// a").expect("it is written");
    std::os::unix::fs::symlink("../real.tex", inner.join("main.tex")).expect("it is linked");
    assert_eq!(project(&inner).load("main.tex").as_deref(), Ok("// a"));
}

#[test]
fn what_is_no_file_is_told() {
    let folder = folder();
    fs::create_dir(folder.path().join("tiles")).expect("it is made");
    fs::write(folder.path().join("tiles/grass.png"), b"").expect("it is written");
    let project = project(folder.path());
    assert_eq!(problem(&project, "tiles"), Problem::Folder);
    assert_eq!(problem(&project, "."), Problem::Folder);
    assert_eq!(
        problem(&project, "tiles/gras.png"),
        Problem::Missing { near: Some("tiles/grass.png".into()) }
    );
    assert_eq!(problem(&project, "tiles/grass.png/x"), Problem::Missing { near: None });
    assert_eq!(problem(&project, "nothing/x"), Problem::Missing { near: None });
    assert!(matches!(problem(&project, "a\0b"), Problem::Unreadable { .. }));
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_is_not_read() {
    let project = Project::new("main.tex".as_ref(), true);
    assert!(matches!(problem(&project, "/dev/zero"), Problem::Unreadable { .. }));
}

#[test]
fn text_is_read_to_a_little_more_than_the_compiler_takes() {
    let folder = folder();
    let project = project(folder.path());
    for filler in ["x", "é", "€", "😀"] {
        fs::write(folder.path().join("long.tex"), filler.repeat(3 << 20)).expect("it is written");
        let text = project.load("long.tex").expect("it is read");
        assert!(text.len() > 1 << 20 && text.len() <= (1 << 20) + 4, "{filler}: {}", text.len());
    }
    fs::write(folder.path().join("bad.tex"), b"ab\xffcd").expect("it is written");
    let sentence = project.load("bad.tex").expect_err("it is no text");
    assert!(sentence.contains("UTF-8") && sentence.contains("byte 2"), "{sentence}");
}
