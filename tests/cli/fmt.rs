//! `fmt`: one layout, reached in one step, and files that are left alone.

use crate::workshop::{PLAIN, WRONG, Workshop};

const UNTIDY: &str = "texture   t(uv:vec2)->(color:color){ color=vec4( uv,0.0,1.0 ) } // end\n";
const BROKEN: &str = "texture t(uv: vec2) -> (color: color) { color = }\n";

#[test]
fn formatting_again_changes_nothing() {
    let shop = Workshop::new(&[("a.tex", UNTIDY)]);
    assert!(shop.run(&["fmt", "a.tex"]).is_silent());
    let once = shop.text("a.tex");
    assert!(once != UNTIDY && once.contains("// end"), "{once}");
    assert!(shop.run(&["fmt", "a.tex"]).is_silent());
    assert_eq!(shop.text("a.tex"), once);
    assert!(shop.run(&["fmt", "--check", "a.tex"]).is_silent());
    assert_eq!(shop.names(), ["a.tex"]);
}

#[test]
fn check_lists_and_writes_nothing() {
    let shop = Workshop::new(&[("a.tex", UNTIDY), ("b.tex", PLAIN), ("sub/c.tex", UNTIDY)]);
    let run = shop.run(&["fmt", "--check", "a.tex", "b.tex", "sub/c.tex"]);
    assert_eq!((run.code, run.out.as_str(), run.err.as_str()), (1, "a.tex\nsub/c.tex\n", ""));
    assert_eq!(shop.text("a.tex"), UNTIDY);
}

#[test]
fn broken_files_are_left_alone_and_others_are_not() {
    let shop = Workshop::new(&[("a.tex", BROKEN), ("b.tex", UNTIDY), ("c.tex", WRONG)]);
    let run = shop.run(&["fmt", "a.tex", "missing.tex", "b.tex", "c.tex"]);
    run.fails(1, "─ a.tex:1:");
    run.fails(1, "there is no file `missing.tex`");
    assert_eq!(shop.text("a.tex"), BROKEN);
    assert_ne!(shop.text("b.tex"), UNTIDY);
    shop.run(&["fmt", "--check", "a.tex"]).fails(1, "─ a.tex:1:");
}

#[test]
fn standard_input_goes_to_standard_output() {
    let shop = Workshop::new(&[("a.tex", UNTIDY)]);
    let run = shop.run_with(&["fmt", "-"], UNTIDY);
    assert!(shop.run(&["fmt", "a.tex"]).is_silent());
    assert_eq!((run.code, run.out, run.err.as_str()), (0, shop.text("a.tex"), ""));
    let check = shop.run_with(&["fmt", "--check", "-"], UNTIDY);
    assert_eq!((check.code, check.out.as_str()), (1, "<stdin>\n"));
    let broken = shop.run_with(&["fmt", "-"], BROKEN);
    broken.fails(1, "<stdin>:1:");
    assert_eq!(broken.out, "");
    shop.run_with(&["fmt", "-"], [0x61, 0xff]).fails(1, "not UTF-8 text (byte 1");
    shop.run_with(&["fmt", "-"], vec![b' '; (1 << 20) + 1]).fails(1, "has more than 1 MiB");
}

#[test]
fn too_long_files_are_pages() {
    let shop = Workshop::new(&[]);
    shop.write("a.tex", "é".repeat((1 << 19) + 1));
    shop.run(&["fmt", "a.tex"]).fails(1, "a.tex:1:");
    assert_eq!(shop.read("a.tex").len(), (1 << 20) + 2);
}

#[cfg(unix)]
#[test]
fn permissions_and_links_stay() {
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};
    let shop = Workshop::new(&[("real.tex", UNTIDY)]);
    let real = shop.path("real.tex");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o604)).expect("permissions are set");
    symlink(&real, shop.path("link.tex")).expect("a link is made");
    assert!(shop.run(&["fmt", "link.tex"]).is_silent());
    assert!(shop.path("link.tex").is_symlink());
    assert_ne!(shop.text("real.tex"), UNTIDY);
    let mode = fs::metadata(&real).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o604);
}
