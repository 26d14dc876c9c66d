#!/usr/bin/env python3
"""Makes grass.png: sixteen interchangeable tiles of lawn, packed 4×4, from the photograph source/grass_grey.png.

    pip install numpy pillow
    python3 make.py

All tiles share one toroidal border ring, so any tile may stand beside any other. The ring is thin: what lies in it appears in every
cell, and too much of it would show as a lattice. Steps:

1. flatten      take the large-scale light and shade out of the photograph, so that no tile is lighter or darker than its neighbours
2. make_ring    a plus-shaped piece of lawn whose arms close on themselves; seen from a tile, its four borders
3. choose       out of some 70,000 places and turns, sixteen patches that already fit the ring and show no clover or fallen leaf
4. insert       cut each patch into the ring along the least visible path (Efros & Freeman's minimum error cut, one for each side), and
                let its first texels follow the ring as the photograph's own autocovariance says
5. paint        grey to greens, in Oklab
"""

from pathlib import Path

import numpy as np
from PIL import Image

from measure import decode, encode

HERE = Path(__file__).resolve().parent
SIZE = 128  # texels along a tile
GRID = 4  # tiles along the picture
BAND = 8  # texels from the border within which a cut may run
THINNEST = 1  # texels of ring that every tile keeps
CALM = 2.5  # texels along the ring over which its brightness is made even
CONTRAST = 0.95  # deviation of the ring, that of the photograph being 1
THICKNESS_COST = 1.0  # what one texel of ring more costs, in units of the photograph's variance
DULL_COST = 0.8  # what a patch of average saliency costs


# ---- filters -------------------------------------------------------------------------------------------------------------------


def blur(picture, sigma):
    """Gaussian, mirrored at the edges."""
    radius = int(3 * sigma + 0.5)
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        pad = [(radius, radius) if a == axis else (0, 0) for a in (0, 1)]
        wide = np.pad(picture, pad, mode="symmetric")
        n = picture.shape[axis]
        picture = sum(k * np.take(wide, range(i, i + n), axis=axis) for i, k in enumerate(kernel))
    return picture


def flatten(grey):
    """Mean 0, deviation 1; lighting and contrast made even; blotches toned down, and the spots that would stand out from afar."""
    grey = grey - blur(grey, 24)
    grey = grey / np.sqrt(blur(grey**2, 32))
    grey = grey - 0.3 * blur(grey, 6)
    spots = blur(grey, 3)
    most = 1.5 * spots.std()
    grey = grey + most * np.tanh(spots / most) - spots
    return grey / grey.std()


def saliency(grey):
    """Where an eye would recognise a place again: broad light or dark spots, and smooth leaves among the blades."""
    spots = blur(grey, 5) ** 2
    detail = blur((grey - blur(grey, 1.5)) ** 2, 5)
    smooth = np.maximum(1 - detail / np.median(detail), 0) ** 2
    return blur(spots / spots.mean() + smooth / smooth.mean(), 3)


# ---- cuts ----------------------------------------------------------------------------------------------------------------------


def best_path(cost):
    """For a batch of cost maps [..., along, depth]: the cheapest path's depth at each step, moving at most one texel a step; its cost."""
    total = [cost[..., 0, :]]
    for s in range(1, cost.shape[-2]):
        last = total[-1]
        wall = np.full_like(last[..., :1], np.inf)
        left = np.concatenate([wall, last[..., :-1]], -1)
        right = np.concatenate([last[..., 1:], wall], -1)
        total.append(cost[..., s, :] + np.minimum(np.minimum(left, right), last))
    depth = np.argmin(total[-1], -1)
    path = [depth]
    for last in total[-2::-1]:
        near = np.stack([depth - 1, depth, depth + 1], -1)
        values = np.take_along_axis(last, np.clip(near, 0, last.shape[-1] - 1), -1)
        values = np.where((near < 0) | (near >= last.shape[-1]), np.inf, values)
        depth = depth - 1 + np.argmin(values, -1)
        path.append(depth)
    return np.stack(path[::-1], -1), total[-1].min(-1)


def cut_cost(difference):
    """Of squared differences [..., along, depth]: the cost of cutting before each depth from THINNEST up."""
    pair = difference[..., THINNEST - 1:-1] + difference[..., THINNEST:]
    return pair / 2 + THICKNESS_COST * np.arange(pair.shape[-1])


def sides(tile):
    """The four bands of a batch of tiles [..., y, x], each [..., along, depth]."""
    t = np.swapaxes(tile, -1, -2)
    return tile[..., :BAND], tile[..., ::-1][..., :BAND], t[..., :BAND], t[..., ::-1][..., :BAND]


# ---- ring ----------------------------------------------------------------------------------------------------------------------


def arm(picture, y, x, overlap):
    """A vertical strip of SIZE + overlap texels at (y, x), 2·BAND wide, closed on itself by a cut across `overlap` rows."""
    strip = picture[y:y + SIZE + overlap, x:x + 2 * BAND]
    head, tail = strip[:overlap], strip[SIZE:]
    path, cost = best_path(((head - tail) ** 2).T[None])
    return strip, path[0], cost[0] / (2 * BAND)


def close_arm(strip, path, overlap):
    """The strip's first SIZE rows, whose beginning continues its end."""
    rows = np.arange(overlap)[:, None]
    weight = np.clip((rows - path[None] + 1.5) / 3, 0, 1)  # 0: the end runs on, 1: the beginning
    weight = weight.reshape(weight.shape + (1,) * (strip.ndim - 2))
    closed = strip[:SIZE].copy()
    closed[:overlap] = mix(strip[SIZE:], strip[:overlap], weight)
    return closed


def mix(a, b, weight):
    """Blend that keeps the variance of what it blends."""
    return (a * (1 - weight) + b * weight) / np.sqrt((1 - weight) ** 2 + weight**2)


def calm(arm):
    """Takes the slow changes along an arm out, which would show in every cell of a far view, and sets its contrast."""
    middle = arm[:, BAND - 2:BAND + 2, 0].mean(1)
    slow = blur(np.tile(middle, 3)[:, None], CALM)[SIZE:2 * SIZE]
    arm = arm.copy()
    arm[..., 0] -= slow
    arm[..., 0] -= arm[..., 0].mean(0)
    arm[..., 0] *= CONTRAST / arm[:, BAND - 2:BAND + 2, 0].std()
    return arm


def make_ring(grey, layers, dull):
    """Borders for all tiles [SIZE, SIZE, layer] (only the outer BAND texels are of use): the calmest plus of the photograph that closes well.

    The plus stands with its crossing at the tiles' common corner, so a tile sees one half of each arm at each of its borders."""
    overlap = 24
    reach = SIZE + overlap
    best = None
    for y in range(reach // 2, grey.shape[0] - reach // 2, 3):
        for x in range(reach // 2, grey.shape[1] - reach // 2, 3):
            # both arms are centred on the crossing (y, x)
            up = arm(grey, y - reach // 2, x - BAND, overlap)
            across = arm(grey.T, x - reach // 2, y - BAND, overlap)
            strips = np.stack([up[0], across[0]])
            # blocks of 8: what remains at the size of a cell in a far view
            blocks = strips.reshape(2, reach // 8, 8, 2, BAND).mean((2, 4))
            halves = strips.reshape(2, reach, 2, BAND).mean((1, 3))
            score = up[2] + across[2] + 3 * blocks.var() + 20 * (halves**2).mean() + 0.3 * strips.var() + 0.15 * (
                dull[y - reach // 2:y + reach // 2, x - BAND:x + BAND].mean()
                + dull[y - BAND:y + BAND, x - reach // 2:x + reach // 2].mean())
            if best is None or score < best[0]:
                best = (score, y, x, up[1], across[1])
    _, y, x, path_up, path_across = best
    half = reach // 2
    up = close_arm(layers[y - half:y + half, x - BAND:x + BAND], path_up, overlap)
    across = close_arm(layers.swapaxes(0, 1)[x - half:x + half, y - BAND:y + BAND], path_across, overlap)
    up, across = calm(up), calm(across)
    # rows of `up` run from y - half; the crossing is at row `half`: roll it to row 0
    up = np.roll(up, -half, 0)
    across = np.roll(across, -half, 0)
    ring = np.zeros((SIZE, SIZE, layers.shape[-1]))
    ring[:, :BAND], ring[:, -BAND:] = up[:, BAND:], up[:, :BAND]
    across = across.swapaxes(0, 1)
    ring[:BAND, BAND:-BAND], ring[-BAND:, BAND:-BAND] = across[BAND:, BAND:-BAND], across[:BAND, BAND:-BAND]
    return ring, (y, x)


# ---- patches -------------------------------------------------------------------------------------------------------------------


def turned(tile, turn):
    """One of the eight turns and flips."""
    tile = np.rot90(tile, turn % 4)
    return tile[:, ::-1] if turn >= 4 else tile


def choose(grey, ring, dull, count, step=4):
    """Places and turns [(y, x, turn)] of the patches."""
    targets = [s[None] for s in sides(ring)]
    places, costs = [], []
    span = range(0, grey.shape[0] - SIZE + 1, step)
    for y in span:
        batch, names = [], []
        for x in span:
            patch = grey[y:y + SIZE, x:x + SIZE]
            for turn in range(8):
                batch.append(turned(patch, turn))
                names.append((y, x, turn))
        batch = np.stack(batch)
        cost = sum(best_path(cut_cost((s - t) ** 2))[1] for s, t in zip(sides(batch), targets)) / (4 * SIZE)
        look = np.array([dull[b:b + SIZE, a:a + SIZE].mean() for b, a, _ in names])
        places += names
        costs.append(cost + DULL_COST * look)
    costs = np.concatenate(costs)
    used = np.zeros(grey.shape)
    chosen = []
    for _ in range(count):
        area = np.pad(used.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
        y, x, turn = np.array(places).T
        shared = (area[y + SIZE, x + SIZE] - area[y, x + SIZE] - area[y + SIZE, x] + area[y, x]) / SIZE**2
        same_turn = np.zeros(len(places))
        for t in range(8):
            same_turn[turn == t] = sum(c[2] == t for c in chosen)
        again = np.zeros(len(places), bool)  # two tiles must not show much of one place
        for b, a, _ in chosen:
            again |= np.maximum(SIZE - abs(y - b), 0) * np.maximum(SIZE - abs(x - a), 0) > 0.35 * SIZE**2
        best = int(np.argmin(np.where(again, np.inf, costs + 0.6 * shared + 0.05 * same_turn)))
        by, bx, bt = places[best]
        chosen.append((by, bx, bt))
        used[by:by + SIZE, bx:bx + SIZE] += 1
    return chosen


def covariance(grey, reach=12):
    """The photograph's autocovariance by distance, [0..reach], faded to 0 over its last half."""
    near = [1.0]
    for d in range(1, reach):
        near.append((np.mean(grey[d:] * grey[:-d]) + np.mean(grey[:, d:] * grey[:, :-d])) / 2 / np.mean(grey**2))
    return np.maximum(np.array(near + [0.0]), 0) * np.clip(2 - 2 * np.arange(reach + 1) / reach, 0, 1)


def insert(ring, patch, near):
    """A patch [y, x, layer] in the ring. Also the ring's share of every texel."""
    inside = np.ones((SIZE, SIZE), bool)
    names = ("left", "right", "top", "bottom")
    for name, a, b in zip(names, sides(ring[..., 0]), sides(patch[..., 0])):
        path = best_path(cut_cost((a - b) ** 2))[0] + THINNEST  # the first depth that shows the patch
        edge = np.arange(SIZE)[None, :] >= path[:, None]
        inside &= {"left": edge, "right": edge[:, ::-1], "top": edge.T, "bottom": edge[:, ::-1].T}[name]
    # what of the ring touches the patch
    wide = np.pad(inside, 1)
    touching = ~inside & (wide[:-2, 1:-1] | wide[2:, 1:-1] | wide[1:-1, :-2] | wide[1:-1, 2:])
    known = np.argwhere(touching)

    def between(a, b):
        d = np.sqrt(((a[:, None] - b[None]) ** 2).sum(-1))
        return np.interp(d, np.arange(len(near)), near)

    # conditional simulation (kriging): the patch plus what one expects of it, from the photograph's own autocovariance, when its
    # values at the cut change to the ring's. Variance and gradients stay those of the photograph right up to the ring.
    # The layers share one covariance.
    change = (ring - patch)[touching]
    weights = np.linalg.solve(between(known, known) + 1e-3 * np.eye(len(known)), np.concatenate([change, np.ones((len(known), 1))], 1))
    spread = between(np.argwhere(np.ones_like(inside)), known) @ weights
    spread = spread.reshape(SIZE, SIZE, -1)
    tile = np.where(inside[..., None], patch + spread[..., :-1], ring)
    return tile, np.where(inside, np.clip(spread[..., -1], 0, 1), 1)


# ---- colour --------------------------------------------------------------------------------------------------------------------


def from_oklab(lab):
    to_lms = np.array([[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.2914855480]])
    to_rgb = np.array([[4.0767416621, -3.3077115913, 0.2309699292], [-1.2684380046, 2.6097574011, -0.3413193965],
                       [-0.0041960863, -0.7034186147, 1.7076147010]])
    return (lab @ to_lms.T) ** 3 @ to_rgb.T


def paint(light, warmth):
    """sRGB 0..1 of grey values and of a value that makes them more straw (above 0) or more blue-green (below)."""
    l = np.clip(0.50 + 0.125 * light, 0.13, 0.92)
    stops = [0.10, 0.30, 0.50, 0.70, 0.95]
    hue = np.interp(l, stops, [136, 133, 129, 121, 110]) - 4 * np.clip(warmth, -2, 2)
    chroma = np.interp(l, stops, [0.025, 0.07, 0.105, 0.115, 0.07])
    angle = np.radians(hue)
    return encode(from_oklab(np.stack([l, chroma * np.cos(angle), chroma * np.sin(angle)], -1)))


def linear_luma(rgb):
    return decode(rgb) @ np.array([0.2126, 0.7152, 0.0722])


def level_out(tiles, hold):
    """Shift each tile's grey, less where `hold` is near 1, until all tiles have one mean brightness."""
    goal = np.mean([linear_luma(paint(t[..., 0], t[..., 1])).mean() for t in tiles])
    for t in tiles:
        for _ in range(6):
            now = linear_luma(paint(t[..., 0], t[..., 1])).mean()
            t[..., 0] += 4.0 * (goal - now) / goal * (1 - hold) / 2


# ---- all together --------------------------------------------------------------------------------------------------------------


def main():
    photo = np.asarray(Image.open(HERE / "source/grass_grey.png").convert("L")).astype(np.float64)
    grey = flatten(photo)
    warmth = blur(grey, 1.2) - blur(grey, 7)
    warmth = warmth / warmth.std()
    layers = np.stack([grey, warmth], -1)
    dull = saliency(grey)
    dull = dull / dull.mean()

    ring, at = make_ring(grey, layers, dull)
    print("ring at", at)
    chosen = choose(grey, ring[..., 0], dull, GRID * GRID)
    print("patches at", chosen)
    patches = [turned(layers[y:y + SIZE, x:x + SIZE], turn) for y, x, turn in chosen]
    # what the patches have in common would repeat in every cell: take it out, and make up for the contrast lost
    common = np.mean(patches, 0)
    common[..., 1] = 0
    patches = [(p - common) * np.array([np.sqrt(len(patches) / (len(patches) - 1)), 1]) for p in patches]
    near = covariance(grey)
    pairs = [insert(ring, p, near) for p in patches]
    tiles = [p[0] for p in pairs]
    print(f"{np.mean([p[1] == 1 for p in pairs]):.3f} of the texels are ring")
    hold = np.clip(np.max([p[1] for p in pairs], 0), 0, 1)
    level_out(tiles, hold)
    for level in range(4):
        n = SIZE >> level
        small = np.stack([t[..., 0] for t in tiles]).reshape(len(tiles), n, 1 << level, n, 1 << level).mean((2, 4))
        print(f"level {level}: {small.mean(0).var() / small.var():.3f} of the variance is in all tiles, {1 / len(tiles):.3f} would be by chance")

    rows = [np.concatenate(tiles[r * GRID:(r + 1) * GRID], 1) for r in range(GRID)]
    sheet = np.concatenate(rows, 0)
    rgb = np.round(paint(sheet[..., 0], sheet[..., 1]) * 255).astype(np.uint8)
    # a palette halves the file
    packed = Image.fromarray(rgb).quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    packed.save(HERE / "grass.png", optimize=True)
    print("grass.png:", (HERE / "grass.png").stat().st_size, "bytes")


if __name__ == "__main__":
    main()
