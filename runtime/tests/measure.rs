mod common;
use common::programs::*;
use common::*;
use texgraph_compiler::manifest::*;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::render::Request;
use texgraph_runtime::cpu;

#[test]
fn measure() {
    let gpu = Gpu::new(Preference::Hardware).unwrap();
    println!("{}", gpu.name());
    let folder = folder();
    for f in ["sand.png", "rock.jpg","cobbles.jpg"] { std::fs::copy(format!("/work/shared/data/photos/{f}"), folder.path().join(f)).unwrap(); }
    let noise: Vec<u8> = (0..100*60*4u32).map(|i| (i.wrapping_mul(2654435761) >> 24) as u8).collect();
    write_picture(&folder.path().join("noise.png"), [100, 60], &noise);
    let noise: Vec<u8> = (0..128*128*4u32).map(|i| (i.wrapping_mul(2654435761) >> 24) as u8).collect();
    write_picture(&folder.path().join("noise2.png"), [128, 128], &noise);
    for (path, enc) in [("rock.jpg", Encoding::Srgb), ("rock.jpg", Encoding::Linear), ("noise.png", Encoding::Linear), ("noise2.png", Encoding::Linear)] {
      for (what, wrap, filter) in [("repeat linear", Wrap::Repeat, Filter::Linear), ("repeat nearest", Wrap::Repeat, Filter::Nearest), ("clamp linear", Wrap::Clamp, Filter::Linear), ("mirror linear", Wrap::Mirror, Filter::Linear)] {
        let (program, tables) = sampled(folder.path(), Recipe::Image { path: path.into(), encoding: enc }, wrap, filter);
        let scene = gpu.prepare(&program, &tables, 0).unwrap();
        let table = program.manifest.resources[0].textures[0].table.as_ref().unwrap();
        let s = [table.width as f32 / 256.0, table.height as f32 / 256.0];
        for (name, k) in [("mag 4x", [0.25,0.25]), ("1:1", [1.0,1.0]), ("min 1.5", [1.5,1.5]), ("min 2", [2.0,2.0]), ("min 3", [3.0,3.0]), ("min 5.3",[5.3,5.3]), ("min 16", [16.0,16.0]), ("aniso 8x1", [8.0,1.0]), ("aniso 1x6", [1.0,6.0])] {
          let mut request = Request::new([256,256]);
          let scale = vec![1.0f32/s[0]*k[0]*s[0]*s[0], 1.0/s[1]*k[1]*s[1]*s[1]];
          let scale = vec![scale[0]/s[0]/s[0]*1.0*s[0]*256.0*0.0 + k[0]*256.0/table.width as f32, k[1]*256.0/table.height as f32 + scale[1]*0.0];
          request.region = [0.013, 0.007, 1.013, 1.007];
          request.settings.set(&program.manifest, "scale", Value::Float(scale)).unwrap();
          let a = scene.render(&request, &|_| {}).unwrap();
          let b = cpu::render(&program, &tables, &request, &|_| {}).unwrap();
          let d = a.difference(&b, 1.0/255.0);
          println!("{path} {enc:?} {what:15} {name:10} within 1/255 {:.4} 4/255 {:.4} max {:.4} mean {:.5}", d.within, a.difference(&b, 4.0/255.0).within, d.max, d.mean);
        }
      }
    }
    let (program, tables) = tiled(folder.path(), Recipe::Patterns { paths: vec!["rock.jpg".into()], grid: [4,4], encoding: Encoding::Srgb }, Wrap::Repeat, Filter::Linear);
    let scene = gpu.prepare(&program, &tables, 0).unwrap();
    for (name, size) in [("mag 4x", 2048), ("1:1", 512), ("min 2", 256), ("min 3", 171), ("min 16", 32)] {
      let mut request = Request::new([size, size]);
      request.settings.set(&program.manifest, "scale", Value::Float(vec![1.0,1.0])).unwrap();
      let a = scene.render(&request, &|_| {}).unwrap();
      let b = cpu::render(&program, &tables, &request, &|_| {}).unwrap();
      let d = a.difference(&b, 1.0/255.0);
      println!("patterns {name:10} within 1/255 {:.4} 4/255 {:.4} max {:.4} mean {:.5}", d.within, a.difference(&b, 4.0/255.0).within, d.max, d.mean);
    }
}
