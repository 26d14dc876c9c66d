//! The command as its users meet it: what it prints, what it writes, which exit code it ends with.
//!
//! Every test runs the real binary in a folder of its own. Pictures are small: debug builds are slow.

#[path = "cli/build.rs"]
mod build;
#[path = "cli/cache.rs"]
mod cache;
#[path = "cli/check.rs"]
mod check;
#[path = "cli/cost.rs"]
mod cost;
#[path = "cli/fmt.rs"]
mod fmt;
#[path = "cli/graph.rs"]
mod graph;
#[path = "cli/help.rs"]
mod help;
#[path = "cli/inspect.rs"]
mod inspect;
#[path = "cli/profile.rs"]
mod profile;
#[path = "cli/render.rs"]
mod render;
#[path = "cli/tiles.rs"]
mod tiles;
#[path = "cli/workshop.rs"]
mod workshop;
