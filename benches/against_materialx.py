#!/usr/bin/env python3
"""How long MaterialX takes for the mixed graph, beside ours, in the same run.

    pip install MaterialX
    python3 benches/against_materialx.py [NODES ...]

Builds the generator's documents and runs both compilers in turns. MaterialX's time is that of
`generate` alone, with its WGSL generator if there is one and its GLSL generator otherwise; reading
the standard library and the document is not counted. Ours is text to validated WGSL.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import MaterialX as mx
from MaterialX import PyMaterialXGenGlsl as glsl
from MaterialX import PyMaterialXGenShader as shading

ROOT = Path(__file__).resolve().parent.parent
# At least this many times as long as ours, at 1,000 nodes.
BOUND = 24
ROUNDS = 5


def example(*arguments):
    command = ["cargo", "run", "--release", "-q", "-p", "texgraph-compiler", "--example", "mixed", "--"]
    done = subprocess.run(command + list(arguments), cwd=ROOT, check=True, capture_output=True, text=True)
    return done.stdout


def ours(nodes):
    """Milliseconds of the quickest of some runs."""
    times = max(3, 20_000 // nodes)
    return float(re.search(r"([\d.]+) ms", example("compile", str(nodes), str(times))).group(1))


def generator():
    for name in ("WgslShaderGenerator", "GlslShaderGenerator"):
        if hasattr(glsl, name):
            return name, getattr(glsl, name).create()
    raise SystemExit("this MaterialX has no generator for WGSL or GLSL")


class MaterialX:
    def __init__(self):
        start = time.perf_counter()
        self.library = mx.createDocument()
        path = mx.getDefaultDataSearchPath()
        mx.loadLibraries(mx.getDefaultDataLibraryFolders(), path, self.library)
        self.name, self.generator = generator()
        self.context = shading.GenContext(self.generator)
        self.context.registerSourceCodeSearchPath(path)
        self.loading = (time.perf_counter() - start) * 1e3

    def generate(self, file):
        """Milliseconds of one generation, and the bytes of the fragment stage."""
        document = mx.createDocument()
        mx.readFromXmlFile(document, str(file))
        document.setDataLibrary(self.library)
        output = document.getNodeGraph("mixed").getOutput("color")
        start = time.perf_counter()
        shader = self.generator.generate("mixed", output, self.context)
        spent = (time.perf_counter() - start) * 1e3
        return spent, len(shader.getSourceCode(shading.PIXEL_STAGE))


def main():
    sizes = [int(argument) for argument in sys.argv[1:]] or [10, 100, 1_000]
    with tempfile.TemporaryDirectory() as folder:
        example("write", folder)
        theirs = MaterialX()
        print(f"MaterialX {mx.__version__}, {theirs.name}; its library takes {theirs.loading:.0f} ms once")
        print("  nodes   MaterialX ms   ours ms   ratio   bytes of its shader")
        for nodes in sizes:
            runs = []
            for _ in range(ROUNDS):
                spent, size = theirs.generate(Path(folder) / f"mixed{nodes}.mtlx")
                runs.append((spent, ours(nodes), size))
            spent, own = min(run[0] for run in runs), min(run[1] for run in runs)
            print(f"{nodes:7}   {spent:12.2f}   {own:7.3f}   {spent / own:5.1f}   {runs[0][2]:10}")
    print(f"at 1,000 nodes the ratio is to be {BOUND} or more")


if __name__ == "__main__":
    main()
