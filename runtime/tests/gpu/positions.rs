//! Positions that are edited while a scene draws.

use crate::common::decals::{DECALS, SPRITES, decals, edited};
use crate::common::folder;
use libtest_mimic::Failed;
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::Gpu;
use texgraph_runtime::render::Request;

/// As the CPU renderer draws them, bakes that read them too.
pub fn edited_positions_agree(gpu: &Gpu) -> Result<(), Failed> {
    let folder = folder();
    let (program, tables, mut map) = decals(folder.path(), &SPRITES);
    let mut ours = cpu::Scene::new(&program, &tables, 0).map_err(|error| error.to_string())?;
    let mut theirs = gpu.prepare(&program, &tables, 0).map_err(|error| error.to_string())?;
    let request = Request { region: [0.003, 0.007, 2.003, 1.007], ..Request::new([240, 110]) };
    for round in 0..2 {
        let expected = ours.render(&request, &|_| {}).map_err(|error| error.to_string())?;
        let found = theirs.render(&request, &|_| {}).map_err(|error| error.to_string())?;
        let difference = expected.difference(&found, crate::FILTERED);
        if difference.within < crate::AGREE {
            return Err(format!("{difference:?} in round {round}").into());
        }
        if round == 0 {
            edited(&mut map);
            let writes = map.take_writes();
            ours.write(DECALS, "cells", &writes).map_err(|error| error.to_string())?;
            theirs.write(DECALS, "cells", &writes).map_err(|error| error.to_string())?;
        }
    }
    if theirs.write(DECALS + 7, "cells", &[]).is_ok() {
        return Err("a texture that is not there was written".into());
    }
    Ok(())
}
