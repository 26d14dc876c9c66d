//! Bakes: textures that a program draws for itself, before the texture that reads them.
//!
//! A bake is a pass over the unit square of `uv`, a pixel for each texel, so that its derivatives
//! are those of one texel. What it draws becomes level 0 of its resource's texture; each further
//! level is the mean of the one before, as numbers, whatever they mean. A scene keeps its bakes: one
//! is drawn again only when a param that it depends on, by itself or through another bake, has
//! another value than when it was last drawn. So the frames of an animation share the bakes that
//! their params leave alone.
//!
//! Bakes that depend on no param never change: [`render_fixed`] draws them ahead of time.

use crate::cpu;
use crate::pass::{self, Pass};
use crate::picture::Picture;
use crate::render::{RenderError, Request};
use crate::resource::{Tables, pyramid, table};
use crate::settings::Settings;
use glam::Vec4;
use texgraph_compiler::Program;
use texgraph_compiler::manifest::{Format, Param, Recipe, Resource, Table, Texture, Value};

/// Draws the bakes that depend on no param, on the CPU, and enters their texels into the tables.
/// Renderers take what stands in the tables, and a package holds it as it holds a picture's texels.
/// The others have to be drawn by who uses the program.
///
/// # Errors
/// A table is missing, or a bake is too large or takes too much work.
pub fn render_fixed(program: &Program, tables: &mut Tables) -> Result<(), RenderError> {
    if !all(program, tables)?.iter().any(Bake::is_fixed) {
        return Ok(());
    }
    let mut scene = cpu::Scene::new(program, tables, 0)?;
    for (resource, field, texels) in scene.fixed_bakes()? {
        tables.insert(resource, &field, texels);
    }
    Ok(())
}

/// A bake of a program, and when it was last drawn.
pub(crate) struct Bake<'a> {
    /// What draws it.
    pub pass: Pass<'a>,
    /// Which resource it fills.
    pub resource: usize,
    /// The resource's only texture.
    pub texture: &'a Texture,
    /// The layout of its texels.
    pub table: &'a Table,
    /// What its texels depend on, through other bakes too.
    params: Vec<&'a Param>,
    /// What these were worth when it was last drawn.
    drawn: Option<Vec<Value>>,
}

/// The bakes that have to be drawn, each after those it reads: not those whose texels are in the
/// tables already and depend on no param.
///
/// # Errors
/// The table of one is not as its recipe says, or it is too large.
pub(crate) fn all<'a>(program: &'a Program, tables: &Tables) -> Result<Vec<Bake<'a>>, RenderError> {
    let mut bakes: Vec<Bake<'a>> = Vec::new();
    for pass in pass::all(program) {
        let Some(index) = pass.described.bake else { continue };
        let resource = program.manifest.resources.get(index as usize);
        let Some((resource, texture)) = resource.and_then(|r| Some((r, r.textures.first()?))) else {
            continue;
        };
        let params = params(&pass, &bakes);
        if params.is_empty() && tables.get(index as usize, &texture.field).is_some() {
            continue;
        }
        let table = checked_table(resource, texture)?;
        bakes.push(Bake { pass, resource: index as usize, texture, table, params, drawn: None });
    }
    Ok(bakes)
}

/// The params that a pass reads, and those of the bakes that it reads.
fn params<'a>(pass: &Pass<'a>, earlier: &[Bake<'a>]) -> Vec<&'a Param> {
    let reads = |bake: &&Bake<'a>| pass.described.reads.iter().any(|(r, _)| *r as usize == bake.resource);
    let through: Vec<&Param> = earlier.iter().filter(reads).flat_map(|bake| bake.params.clone()).collect();
    let is_needed = |param: &&Param| {
        pass.described.params.contains(&param.name) || through.iter().any(|other| other.name == param.name)
    };
    pass.manifest.params.iter().filter(is_needed).collect()
}

/// The table of a bake's texture.
fn checked_table<'a>(resource: &'a Resource, texture: &'a Texture) -> Result<&'a Table, RenderError> {
    let broken = || RenderError::NoTable { resource: resource.name.clone(), field: texture.field.clone() };
    let Recipe::Bake { size, format } = &resource.recipe else { return Err(broken()) };
    if !size.iter().all(|side| (1..=table::MAX_SIDE).contains(side)) {
        let error = Box::new(RenderError::TextureSize { size: *size });
        return Err(RenderError::Bake { name: resource.name.clone(), error });
    }
    let layout = Table::mipmapped(*format, *size, 1);
    let is_right = |table: &&Table| {
        let Table { file: _, key: _, format, width, height, layers, levels } = table;
        (format, width, height, layers, levels)
            == (&layout.format, &layout.width, &layout.height, &layout.layers, &layout.levels)
    };
    texture.table.as_ref().filter(is_right).filter(|_| limits(*format).is_some()).ok_or_else(broken)
}

/// Has the bakes drawn again that read a resource, themselves or through others, in their order.
pub(crate) fn forget<'b, 'a: 'b>(bakes: impl Iterator<Item = &'b mut Bake<'a>>, resource: usize) {
    let mut changed = vec![resource];
    for bake in bakes {
        if bake.reads(&changed) {
            bake.drawn = None;
            changed.push(bake.resource);
        }
    }
}

impl Bake<'_> {
    /// Whether its texels are other ones for these params than when it was last drawn.
    pub fn is_stale(&self, settings: &Settings) -> bool {
        self.drawn.as_ref() != Some(&self.values(settings))
    }

    /// Whether it reads one of these resources.
    fn reads(&self, resources: &[usize]) -> bool {
        self.pass.described.reads.iter().any(|(resource, _)| resources.contains(&(*resource as usize)))
    }

    /// Whether it is the same for all params.
    pub fn is_fixed(&self) -> bool {
        self.params.is_empty()
    }

    /// Remembers that it has been drawn for these params.
    pub fn keep(&mut self, settings: &Settings) {
        self.drawn = Some(self.values(settings));
    }

    fn values(&self, settings: &Settings) -> Vec<Value> {
        self.params.iter().map(|param| settings.value(param)).collect()
    }

    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        [self.table.width, self.table.height]
    }

    /// What to draw.
    pub fn request(&self, settings: &Settings) -> Request {
        Request { settings: settings.clone(), ..Request::new(self.size()) }
    }

    /// The bytes of all levels of what has been drawn. What the format can't hold is as near as
    /// it can, what is no number is 0.
    pub fn texels(&self, picture: &Picture) -> Vec<u8> {
        let [width, height] = self.size();
        let (low, high) = limits(self.table.format).unwrap_or_default();
        let texel = |x: u32, y: u32| {
            let pixel = picture.pixels.get(y as usize * width as usize + x as usize);
            let held = |x: f32| if x.is_nan() { 0.0 } else { x.clamp(low, high) };
            Vec4::from_array(pixel.copied().unwrap_or_default().map(held))
        };
        pyramid::build("pixels", self.table.format, [width, height], 1, |_, x, y| texel(x, y)).bytes
    }

    /// An error with the bake's name.
    pub fn failed(&self, error: RenderError) -> RenderError {
        RenderError::Bake { name: self.pass.described.name.clone(), error: Box::new(error) }
    }
}

/// The least and the greatest number that a format holds; none for formats that aren't drawn to.
fn limits(format: Format) -> Option<(f32, f32)> {
    match format {
        Format::Rgba8UnormSrgb | Format::Rgba8Unorm => Some((0.0, 1.0)),
        Format::Rgba8Snorm => Some((-1.0, 1.0)),
        Format::Rgba16Float => Some((half::f16::MIN.to_f32(), half::f16::MAX.to_f32())),
        Format::R32Sint | Format::Rgba32Sint | Format::Bc1RgbaUnorm | Format::Bc7RgbaUnorm => None,
    }
}
