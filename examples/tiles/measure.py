#!/usr/bin/env python3
"""Measures whether a picture of interchangeable tiles shows its grid or repeats itself.

    python3 measure.py                          simulate examples/tiling.tex with grass.png at 16, 64 and 128 pixels per cell
    python3 measure.py PICTURE PIXELS_PER_CELL  measure a rendered picture, for example one that texgraph wrote

Printed for each picture, all on sRGB luma (0..255):

- border: the mean |difference| of two neighbouring pixels that lie in two cells, over that of two in one cell.
  1 is a border that nobody sees; the target is at most 1.1.
- repeat: the largest autocorrelation at any lag (i·P, j·P) other than 0, up to half the picture, P being the pixels per cell.
  The target is at most 0.1. `biased` divides every lag's sum by the energy of the whole picture, the usual estimator;
  `overlap` divides it by the energy of what overlaps at that lag, which is stricter and noisier.
- mean repeat: the mean of `overlap` over these lags: what all cells share, the hash's luck averaged out.
- luck alone (simulated pictures only): the repeat of ideal tiles. The fewer cells, the more often some lag brings equal tiles together: with
  64 cells no sixteen tiles can meet the target, which is why the mean is printed too.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

HERE = Path(__file__).resolve().parent


def decode(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def encode(linear):
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def luma(rgb):
    """Rec. 709 weights on the sRGB-encoded values."""
    return rgb[..., :3].astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722])


def pcg4d(v):
    """Jarzynski & Olano 2020, on the last axis of a uint32 array."""
    x, y, z, w = (v[..., i] * np.uint32(1664525) + np.uint32(1013904223) for i in range(4))
    for turn in range(2):
        x = x + y * w
        y = y + z * x
        z = z + x * y
        w = w + y * z
        if turn == 0:
            x, y, z, w = (c ^ (c >> np.uint32(16)) for c in (x, y, z, w))
    return np.stack([x, y, z, w], axis=-1)


def picks(cells, count, seed=0):
    """A tile number per cell, [y, x]."""
    y, x = np.mgrid[0:cells, 0:cells].astype(np.uint32)
    seeds = np.full_like(x, seed)
    unit = (pcg4d(np.stack([x, y, np.zeros_like(x), seeds], axis=-1))[..., 0] >> np.uint32(8)) * 2.0**-24
    return np.minimum((unit * count).astype(int), count - 1)


def mip_chain(tile):
    """Box-filtered levels of one linear tile."""
    chain = [tile]
    while chain[-1].shape[0] > 1:
        t = chain[-1]
        chain.append((t[0::2, 0::2] + t[1::2, 0::2] + t[0::2, 1::2] + t[1::2, 1::2]) / 4)
    return chain


def bilinear(tile, size):
    """`tile` sampled at the centres of size² pixels, clamped to its edge."""
    n = tile.shape[0]
    at = (np.arange(size) + 0.5) / size * n - 0.5
    i = np.floor(at).astype(int)
    f = at - i
    a, b = np.clip(i, 0, n - 1), np.clip(i + 1, 0, n - 1)
    rows = tile[a] * (1 - f)[:, None, None] + tile[b] * f[:, None, None]
    return rows[:, a] * (1 - f)[None, :, None] + rows[:, b] * f[None, :, None]


def split(picture, grid=4):
    """The tiles of a picture that packs them grid × grid, in row order."""
    n = picture.shape[0] // grid
    return [picture[r * n:(r + 1) * n, c * n:(c + 1) * n] for r in range(grid) for c in range(grid)]


def reduce_tile(tile, pixels):
    """One linear tile as a cell of `pixels`² shows it: trilinear over its own clamped mip chain."""
    chain = mip_chain(tile)
    level = min(max(np.log2(tile.shape[0] / pixels), 0), len(chain) - 1)
    low = int(level)
    high = min(low + 1, len(chain) - 1)
    f = level - low
    return bilinear(chain[low], pixels) * (1 - f) + bilinear(chain[high], pixels) * f


def simulate(path, cells, pixels, seed=0):
    """What examples/tiling.tex draws: sRGB 8 bit."""
    tiles = [reduce_tile(decode(t / 255.0), pixels) for t in split(np.asarray(Image.open(path).convert("RGB")))]
    tiles = np.stack([np.round(encode(t) * 255).astype(np.uint8) for t in tiles])
    chosen = tiles[picks(cells, len(tiles), seed)]
    return chosen.transpose(0, 2, 1, 3, 4).reshape(cells * pixels, cells * pixels, 3)


def luck(cells, seed=0):
    """The largest autocorrelations that sixteen tiles with nothing in common show with these picks."""
    cell = np.eye(16).reshape(16, 4, 4)[picks(cells, 16, seed)]
    found = correlations(cell.transpose(0, 2, 1, 3).reshape(cells * 4, cells * 4), 4)
    return tuple(max(v[n] for v in found.values()) for n in (0, 1))


def border_ratio(grey, pixels):
    inside, across = [], []
    for axis in (0, 1):
        steps = np.abs(np.diff(grey, axis=axis))
        at_border = np.arange(1, grey.shape[axis]) % pixels == 0
        across.append(np.compress(at_border, steps, axis=axis).mean())
        inside.append(np.compress(~at_border, steps, axis=axis).mean())
    return np.mean(inside), np.mean(across)


def correlations(grey, pixels):
    """Autocorrelation at the lags (j·pixels, i·pixels), 0 ≤ j ≤ half, |i| ≤ half: {(i, j): (biased, overlap)}."""
    rows, columns = grey.shape[0] // pixels, grey.shape[1] // pixels
    grey = grey[:rows * pixels, :columns * pixels]
    grey = grey - grey.mean()
    # one vector per cell: a lag by whole cells multiplies vectors with vectors
    cell = grey.reshape(rows, pixels, columns, pixels).transpose(0, 2, 1, 3).reshape(rows, columns, -1).astype(np.float32)
    energy = (cell.astype(np.float64) ** 2).sum(-1)
    total = energy.sum()
    # Gram matrix of the cells (16.7 million products at 64 × 64 cells)
    flat = cell.reshape(rows * columns, -1)
    gram = (flat @ flat.T).reshape(rows, columns, rows, columns)
    found = {}
    for j in range(0, rows // 2 + 1):
        for i in range(-(columns // 2), columns // 2 + 1):
            if j == 0 and i <= 0:
                continue
            x = slice(0, columns - i) if i >= 0 else slice(-i, columns)
            shifted = slice(i, columns) if i >= 0 else slice(0, columns + i)
            ys, xs = np.arange(rows - j), np.arange(columns)[x]
            products = gram[ys[:, None], xs[None, :], ys[:, None] + j, xs[None, :] + i].astype(np.float64).sum()
            overlap = np.sqrt(energy[: rows - j, x].sum() * energy[j:, shifted].sum())
            found[i, j] = (products / total, products / overlap)
    return found


def report(name, rgb, pixels):
    grey = luma(rgb)
    inside, across = border_ratio(grey, pixels)
    found = correlations(grey, pixels)
    biased = max(found, key=lambda k: found[k][0])
    overlap = max(found, key=lambda k: found[k][1])
    mean = np.mean([v[1] for v in found.values()])
    print(f"{name}: {pixels} px per cell, {grey.shape[1] // pixels}×{grey.shape[0] // pixels} cells")
    print(f"  border       |step| {across:.2f} across, {inside:.2f} inside: ratio {across / inside:.3f}")
    print(f"  repeat       biased {found[biased][0]:.3f} at lag {biased}, overlap {found[overlap][1]:.3f} at lag {overlap} (in cells)")
    print(f"  mean repeat  {mean:.3f} over {len(found)} lags")
    return across / inside, found[biased][0], found[overlap][1], mean


def main():
    if len(sys.argv) == 3:
        report(sys.argv[1], np.asarray(Image.open(sys.argv[1]).convert("RGB")), int(sys.argv[2]))
    elif len(sys.argv) == 1:
        for cells, pixels in ((64, 16), (16, 64), (8, 128), (64, 64)):
            report("grass.png, simulated", simulate(HERE / "grass.png", cells, pixels), pixels)
            biased, overlap = luck(cells)
            print(f"  luck alone   biased {biased:.3f}, overlap {overlap:.3f}: from equal tiles meeting at one lag, were nothing shared")
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
