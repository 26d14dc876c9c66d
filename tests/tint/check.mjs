// Compiles WGSL with Tint, Chromium's compiler, on a device without a GPU: what it refuses, Chrome refuses.
//
//   npm ci                           once, in this folder
//   node check.mjs PATH…             files, and folders with all the *.wgsl and *.shaders below them
//   node check.mjs --self-test       shows that the judge itself works
//
// A file of shaders (*.shaders) holds many, each behind a line `//// NAME`.
//
// Exit status: 0 all accepted, 1 some refused or none found, 2 the check could not run.

import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { create } from 'webgpu';

function shadersBelow(path) {
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path, { withFileTypes: true })
    .filter((entry) => entry.name !== 'node_modules' && !entry.name.startsWith('.'))
    .sort((a, b) => (a.name < b.name ? -1 : 1))
    .flatMap((entry) => {
      const inner = join(path, entry.name);
      if (entry.isDirectory()) return shadersBelow(inner);
      return entry.isFile() && /\.(wgsl|shaders)$/.test(entry.name) ? [inner] : [];
    });
}

/** The shaders of a file, as `[name, code]`. */
function shadersOf(file) {
  const text = readFileSync(file, 'utf8');
  if (!file.endsWith('.shaders')) return [[file, text]];
  return text
    .split(/^\/\/\/\/ /m)
    .slice(1)
    .map((part) => {
      const end = part.indexOf('\n');
      return [`${file}, ${part.slice(0, end)}`, part.slice(end + 1)];
    });
}

/** What Tint has against a shader, as `{line, column, message}`; empty if it takes it. */
async function complaints(device, code) {
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code });
  const info = await module.getCompilationInfo();
  const refused = await device.popErrorScope();
  const found = info.messages
    .filter((message) => message.type === 'error')
    .map(({ lineNum, linePos, message }) => ({ line: lineNum, column: linePos, message }));
  // a refusal without a place, such as a limit passed
  if (refused && found.length === 0) found.push({ line: 0, column: 0, message: refused.message });
  return found;
}

async function check(device, paths) {
  let accepted = 0;
  let refused = 0;
  for (const [name, code] of paths.flatMap(shadersBelow).flatMap(shadersOf)) {
    const found = await complaints(device, code);
    if (found.length > 0) refused += 1;
    else accepted += 1;
    for (const { line, column, message } of found) console.log(`${name}:${line}:${column}: ${message}`);
  }
  console.log(`${accepted} shaders accepted, ${refused} refused`);
  if (accepted + refused === 0) console.error(`no shader below ${paths.join(', ')}`);
  return accepted > 0 && refused === 0;
}

const SAMPLES = `
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var smooth_sampler: sampler;
`;

// name, whether Tint takes it, code
const SELF_TEST = [
  ['plain fragment shader', true, `${SAMPLES}
@fragment fn main(@location(0) uv: vec2f) -> @location(0) vec4f {
  return textureSample(picture, smooth_sampler, uv);
}`],
  ['textureSampleGrad under a condition that differs between pixels', true, `${SAMPLES}
@fragment fn main(@location(0) uv: vec2f) -> @location(0) vec4f {
  let dx = dpdx(uv);
  let dy = dpdy(uv);
  if (uv.x > 0.5) { return textureSampleGrad(picture, smooth_sampler, uv, dx, dy); }
  return vec4f();
}`],
  ['functions without an entry point', true, 'fn twice(x: f32) -> f32 { return x * 2.0; }'],
  ['textureSample under a condition that differs between pixels', false, `${SAMPLES}
@fragment fn main(@location(0) uv: vec2f) -> @location(0) vec4f {
  if (uv.x > 0.5) { return textureSample(picture, smooth_sampler, uv); }
  return vec4f();
}`],
  ['i32 divided by a constant 0', false, 'fn broken(i: i32) -> i32 { return i / 0; }'],
  ['unknown name', false, 'fn broken() -> f32 { return nowhere; }'],
  ['not WGSL', false, 'void main() {}'],
];

async function selfTest(device) {
  let good = true;
  for (const [name, accepted, code] of SELF_TEST) {
    const found = await complaints(device, code);
    const right = (found.length === 0) === accepted && (accepted || found[0].line > 0);
    good &&= right;
    console.log(`${right ? 'ok' : 'WRONG'}: ${found.length === 0 ? 'accepted' : 'refused'}: ${name}`);
  }
  return good;
}

async function main(args) {
  if (args.length === 0 || args.some((arg) => arg.startsWith('--') && arg !== '--self-test')) {
    console.error('usage: node check.mjs PATH… | --self-test');
    return 2;
  }
  const gpu = create(['backend=null']);
  const adapter = await gpu.requestAdapter();
  const device = await adapter.requestDevice();
  try {
    const paths = args.filter((arg) => arg !== '--self-test');
    const works = paths.length === args.length || (await selfTest(device));
    const clean = paths.length === 0 || (await check(device, paths));
    return works && clean ? 0 : 1;
  } finally {
    device.destroy();
  }
}

try {
  process.exitCode = await main(process.argv.slice(2));
} catch (error) {
  console.error(error.message);
  process.exitCode = 2;
}
