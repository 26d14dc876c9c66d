"""Draws the pictures of the README and the guide that the command draws: python3 docs/images/make.py

Needs target/release/texgraph and Pillow. Every picture but the ground is rendered twice as large as it is shown.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path
from PIL import Image

IMAGES = Path(__file__).parent
ROOT = IMAGES.parent.parent
COMMAND = ROOT / "target/release/texgraph"


def render(what, side):
    """A texture, node or wire (`FILE:NAME`) as a picture of that side."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.png"
        size = f"{2 * side}x{2 * side}"
        subprocess.run([COMMAND, "render", what, "-o", out, "--size", size], cwd=ROOT, check=True)
        return Image.open(out).convert("RGB").resize((side, side), Image.Resampling.BOX)


def save(picture, name):
    """As a PNG where few colours make it small, else as a JPEG."""
    if name.endswith(".png"):
        picture.save(IMAGES / name, optimize=True)
    else:
        picture.save(IMAGES / name, quality=88, optimize=True)


def examples():
    for name in ["stamps", "terrain", "weave", "truchet", "landscape", "flowers", "ground", "decals", "tufts"]:
        save(render(f"examples/{name}.tex", 512), f"{name if name != 'ground' else 'layers'}.jpg")


def rows():
    """The textures of one file side by side, as the paper shows them."""
    files = {
        "distribution": ["uniform", "by_probability", "by_area", "dithered"],
        "leaves": ["basic", "by_probability", "by_density"],
        "rock": ["repeated", "rock"],
        "bombing": ["flowers", "discs", "spheres", "halo"],
        "cells": ["cracked_mud", "giraffe", "scales", "stained"],
        "nature": ["marble_slab", "wood_board", "granite_slab", "rusty_plate", "sky", "starfield", "city"],
    }
    for file, textures in files.items():
        across = min(len(textures), 4)
        down = (len(textures) + 3) // 4
        strip = Image.new("RGB", (across * 328 - 8, down * 328 - 8), "white")
        for i, name in enumerate(textures):
            strip.paste(render(f"examples/{file}.tex:{name}", 320), (i % 4 * 328, i // 4 * 328))
        save(strip, f"{file}.jpg")


def signboard():
    """Before its message changes, while it does, and after."""
    strip = Image.new("RGB", (1152, 3 * 144 + 2 * 8), "white")
    for i, time in enumerate(["1.5", "2.6", "6"]):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.png"
            view = ["--size", "1152x144", "--time", time]
            subprocess.run([COMMAND, "render", "examples/signboard.tex", "-o", out, *view], cwd=ROOT, check=True)
            strip.paste(Image.open(out).convert("RGB"), (0, i * 152))
    save(strip, "signboard.jpg")


def guide():
    """Every block of the guide that declares a texture whose picture the guide shows."""
    text = (ROOT / "docs/guide.md").read_text()
    for block in re.findall(r"```tex\n(.*?)```", text, re.S):
        texture = re.search(r"^texture (\w+)", block, re.M)
        if texture and f"images/{texture[1]}.png" in text:
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "block.tex"
                file.write_text(block)
                save(render(file, 340), f"{texture[1]}.png")


def ground():
    """As it is rendered: how it is filtered is what it shows."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.png"
        view = ["--view", "plane", "--repeat", "0.2", "--size", "680x400"]
        subprocess.run([COMMAND, "render", "examples/tiling.tex", "-o", out, *view], cwd=ROOT, check=True)
        save(Image.open(out).convert("RGB"), "ground.jpg")


def wires():
    names = ["truchet.cell", "truchet.at", "truchet.turn", "truchet"]
    strip = Image.new("RGB", (4 * 240 + 3 * 8, 240), "white")
    for i, name in enumerate(names):
        strip.paste(render(f"examples/truchet.tex:{name}", 240), (i * 248, 0))
    save(strip, "wires.png")


def apart(sheet, side, gap=4):
    """A sheet of 4×4 tiles with gaps between them, each tile as large as is wanted."""
    tile = sheet.width // 4
    picture = Image.new("RGB", (4 * side + 3 * gap, 4 * side + 3 * gap), "white")
    for i in range(16):
        x, y = i % 4, i // 4
        cut = sheet.crop((x * tile, y * tile, (x + 1) * tile, (y + 1) * tile))
        picture.paste(cut.resize((side, side), Image.Resampling.BOX), (x * (side + gap), y * (side + gap)))
    return picture


def tile_sets():
    """The sheets of the landscape; the borders of one of them over a chequer; an empty sheet."""
    sheets = [Image.open(ROOT / f"examples/tiles/{name}_photo.png").convert("RGB") for name in ["sand", "grass", "shore"]]
    strip = Image.new("RGB", (3 * 292 + 2 * 16, 292), "white")
    for i, sheet in enumerate(sheets):
        strip.paste(apart(sheet, 70), (i * 308, 0))
    save(strip, "tile_sets.jpg")
    with tempfile.TemporaryDirectory() as folder:
        border, layout = Path(folder) / "border.png", Path(folder) / "layout.png"
        tiles = [COMMAND, "tiles"]
        photo = ROOT / "examples/tiles/grass_photo.png"
        subprocess.run([*tiles, "transition", photo, "--grid", "4x4", "--border", "-o", border], check=True)
        subprocess.run([*tiles, "layout", "--size", "70", "-o", layout], check=True)
        sheet = Image.open(border).convert("RGBA")
        chequer = Image.new("RGBA", sheet.size)
        for y in range(0, sheet.height, 12):
            for x in range(0, sheet.width, 12):
                light = 208 if (x + y) // 12 % 2 else 240
                chequer.paste((light, light, light, 255), (x, y, x + 12, y + 12))
        strip = Image.new("RGB", (2 * 292 + 16, 292), "white")
        strip.paste(apart(Image.alpha_composite(chequer, sheet).convert("RGB"), 70), (0, 0))
        strip.paste(apart(Image.open(layout).convert("RGB"), 70), (308, 0))
        save(strip, "tile_codes.png")


def row(pictures, name, down=1, gap=8):
    """Pictures of one size side by side, in so many rows."""
    across = len(pictures) // down
    side = pictures[0].width
    strip = Image.new("RGB", (across * (side + gap) - gap, down * (side + gap) - gap), "white")
    for i, picture in enumerate(pictures):
        strip.paste(picture, (i % across * (side + gap), i // across * (side + gap)))
    save(strip, name)


def stochastic():
    """The pictures of docs/stochastic.md: its blocks, over the photographs of the examples and the bench."""
    text = (ROOT / "docs/stochastic.md").read_text()
    blocks = {re.search(r"^texture (\w+)", block, re.M)[1]: block for block in re.findall(r"```tex\n(.*?)```", text, re.S)}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for photo in [*(ROOT / "runtime/benches/photos").iterdir(), *(ROOT / "examples/photos").iterdir()]:
            (folder / photo.name).write_bytes(photo.read_bytes())

        def drawn(block, texture, side=320):
            file, out = folder / "block.tex", folder / "out.png"
            file.write_text(block)
            size = ["--size", f"{2 * side}x{2 * side}"]
            subprocess.run([COMMAND, "render", f"{file}:{texture}", "-o", out, *size], check=True)
            return Image.open(out).convert("RGB").resize((side, side), Image.Resampling.BOX)

        def blends(photo, repeats):
            values = {
                "repeated": "i.sample(at)",
                "linear": "e.stochastic(at, blend: linear)",
                "variance": "e.stochastic(at, blend: variance)",
                "histogram": "e.stochastic(at)",
            }
            return f'let e = exemplar("{photo}")\nlet i = image("{photo}")\n' + "".join(
                f"texture {name}(uv: vec2) -> (color: color) {{ let at = uv * {repeats}\n color = {value} }}\n"
                for name, value in values.items()
            )

        names = ["repeated", "linear", "variance", "histogram"]
        row([drawn(blends("rock.jpg", 3.0), name, 280) for name in names], "stochastic_blends.jpg")
        orderly = ["brick_grey.png", "cobbles.jpg", "planks.jpg"]
        panels = [drawn(blends(photo, 1.5), name) for name in ["repeated", "histogram"] for photo in orderly]
        row(panels, "stochastic_failure.jpg", down=2)
        ice = Image.open(folder / "ice.jpg").convert("RGB")
        for channel, name in zip(ice.split(), ["red", "green", "blue"]):
            channel.save(folder / f"{name}.png")
        plain, axes = [drawn(blends("ice.jpg", 0.5), name) for name in ["repeated", "histogram"]]
        row([plain, drawn(blocks["by_channel"], "by_channel"), axes], "stochastic_axes.jpg")
        afar = ["repeated", "plain", "filtered", "blended"]
        row([drawn(blocks["repeated"], name, 280) for name in afar], "stochastic_levels.jpg")
        row([drawn(blocks["lit_once"], name, 480) for name in ["lit_once", "lit_floor"]], "stochastic_normals.jpg")
        row([drawn(blocks["cut"], name, 480) for name in ["cut", "tileable"]], "stochastic_tileable.jpg")


if __name__ == "__main__":
    if not COMMAND.exists():
        sys.exit("build it first: cargo build --release")
    examples()
    guide()
    ground()
    wires()
    rows()
    signboard()
    tile_sets()
    stochastic()
