//! The texgraph runtime: resources from files to tables, and programs to pixels.
//!
//! ```text
//!  files ─project─▶ bytes ─resource─▶ tables ─▶ render ─▶ gpu (wgpu) ─▶ picture ─▶ PNG
//!  NAME=VALUE ─settings─▶ uniform ──────────────┘   └────▶ cpu ────────┘
//! ```
//!
//! [`project::Project`] says which files a program may read, [`resource::load`] makes the bytes of
//! its textures, [`render::render`] makes a [`picture::Picture`] of one of its outputs, and
//! [`render::Scene`] many of them. What a program [`bake`]s is drawn on the way.
//! [`package::Cache`] does the same for who writes files, and makes nothing twice. The GPU is the
//! feature `gpu`; without it everything else stays.

pub mod animation;
pub mod bake;
pub mod cpu;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod inspect;
pub mod package;
pub mod picture;
pub mod project;
pub mod render;
pub mod resource;
pub mod settings;
pub mod tiles;
pub mod uniform;

mod false_color;
mod flat;
mod nearest;
mod pass;
mod progress;
