#!/usr/bin/env python3
"""decimesh beside martini and delatin on terrain: the RMS and the largest vertical error at the same number of vertices.

    python3 -m venv venv && venv/bin/pip install -r benches/terrain/requirements.txt
    cargo build --release -p decimesh-cli
    venv/bin/python benches/terrain/compare.py [--decimesh target/release/decimesh] NAME=FILE[,SIZE[,SCALE,OFFSET]] ...

FILE is a .npy, a .png with 16 bits or a .i16 of SIZE times SIZE samples; of the first two the north-west corner of SIZE
rows and columns is taken, height = SCALE * value + OFFSET. SIZE is 2^d + 1, which martini needs. All surfaces are
measured in the same way, over all samples, by this script; decimesh is given the heights as a .npy file.

Prints a table in Markdown.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import numpy as np
import pydelatin
import pymartini
from PIL import Image

RATES = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005]


def read(spec):
    """The name and the heights that an argument asks for."""
    name, _, rest = spec.partition("=")
    path, *numbers = rest.split(",")
    size = int(numbers[0]) if numbers else None
    scale, offset = (float(number) for number in numbers[1:3]) if len(numbers) > 2 else (1.0, 0.0)
    if path.endswith(".npy"):
        heights = np.load(path)
    elif path.endswith(".i16"):
        heights = np.fromfile(path, dtype="<i2").reshape(size, size)
    else:
        heights = np.array(Image.open(path))
    size = size or heights.shape[0]
    heights = heights[:size, :size].astype(np.float32) * np.float32(scale) + np.float32(offset)
    if heights.shape != (size, size) or (size - 1) & (size - 2) != 0:
        raise SystemExit(f"{name}: {heights.shape[1]} columns, {heights.shape[0]} rows are no 2^d + 1")
    return name, np.ascontiguousarray(heights)


def errors(heights, x, y, z, triangles):
    """RMS and maximum of the vertical error over all samples; x are columns, y rows, all of them samples'."""
    corners = np.stack([np.rint(x), np.rint(y)], axis=-1).astype(np.int64)[triangles]
    at = np.asarray(z, dtype=np.float64)[triangles]
    low = corners.min(axis=1)
    size = corners.max(axis=1) - low
    error = np.full(heights.shape, np.nan)
    # Triangles with boxes of one size are looked through together, sample by sample of the box.
    keys = size[:, 0] * (heights.shape[1] + 1) + size[:, 1]
    order = np.argsort(keys, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(keys[order])) + 1)
    for group in groups:
        width, height = size[group[0]] + 1
        # Some hundred thousand samples at a time.
        for part in np.array_split(group, -(-len(group) * width * height // 400_000)):
            (ax, ay), (bx, by), (cx, cy) = (corners[part, k].T[:, :, None] for k in range(3))
            px = low[part, 0, None] + np.tile(np.arange(width), height)
            py = low[part, 1, None] + np.repeat(np.arange(height), width)
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            of_a = ((bx - px) * (cy - py) - (by - py) * (cx - px)) * np.sign(area)
            of_b = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) * np.sign(area)
            of_c = np.abs(area) - of_a - of_b
            inside = (of_a >= 0) & (of_b >= 0) & (of_c >= 0) & (area != 0)
            surface = (of_a * at[part, 0, None] + of_b * at[part, 1, None] + of_c * at[part, 2, None])[inside]
            surface /= np.broadcast_to(np.abs(area), inside.shape)[inside]
            error[py[inside], px[inside]] = surface - heights[py[inside], px[inside]]
    if np.isnan(error).any():
        raise SystemExit(f"{np.isnan(error).sum()} samples are not covered")
    return float(np.sqrt((error**2).mean())), float(np.abs(error).max())


def martini(heights, wanted):
    """The martini mesh with the most vertices that are not more than wanted: its error is what is asked for."""
    started = time.perf_counter()
    tile = pymartini.Martini(heights.shape[0]).create_tile(heights)
    seconds = time.perf_counter() - started
    low, high = 0.0, float(np.ptp(heights))
    best = None
    for _ in range(40):
        middle = (low + high) / 2
        vertices, triangles = tile.get_mesh(middle)
        if len(vertices.reshape(-1, 2)) > wanted:
            low = middle
        else:
            high, best = middle, (vertices.reshape(-1, 2), triangles.reshape(-1, 3))
    vertices, triangles = best
    x, y = vertices[:, 0].astype(int), vertices[:, 1].astype(int)
    return x, y, heights[y, x], triangles, seconds


def delatin(heights, wanted):
    """The delatin mesh of so many vertices."""
    started = time.perf_counter()
    found = pydelatin.Delatin(heights.copy(), max_error=0, max_points=wanted)
    seconds = time.perf_counter() - started
    x, y, z = found.vertices.T
    # Its rows count from the south.
    return x, heights.shape[0] - 1 - y, z, found.triangles, seconds


def decimesh(command, heights, wanted, *options):
    """What the command makes of the heights."""
    with tempfile.TemporaryDirectory() as directory:
        directory = pathlib.Path(directory)
        np.save(directory / "heights.npy", heights)
        subprocess.run(
            [command, "terrain", directory / "heights.npy", directory / "mesh.obj", "--vertices", str(wanted)]
            + ["--report", directory / "report.json", *options],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        report = json.loads((directory / "report.json").read_text())
        positions, triangles = [], []
        for line in (directory / "mesh.obj").open():
            kind, *rest = line.split()
            if kind == "v":
                positions.append([float(part) for part in rest[:3]])
            elif kind == "f":
                triangles.append([int(part.split("/")[0]) - 1 for part in rest])
    x, y, z = np.array(positions).T
    return x, heights.shape[0] - 1 - y, z, np.array(triangles), report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--decimesh", default="target/release/decimesh", help="the command")
    parser.add_argument("--rates", type=lambda text: [float(part) for part in text.split(",")], default=RATES)
    parser.add_argument("fields", nargs="+", metavar="NAME=FILE[,SIZE[,SCALE,OFFSET]]")
    arguments = parser.parse_args()
    print("| field | rate | vertices | | RMS | maximum | dB of the 4-8 mesh over it | seconds |")
    print("| --- | --: | --: | --- | --: | --: | --: | --: |")
    for name, heights in map(read, arguments.fields):
        for rate in arguments.rates:
            wanted = round(rate * heights.size)
            rows = []
            for label, options in [("4-8", []), ("TIN", ["--tin"]), ("TIN, least squares", ["--tin", "--least-squares"])]:
                x, y, z, triangles, report = decimesh(arguments.decimesh, heights, wanted, *options)
                rows.append((label, len(x), *errors(heights, x, y, z, triangles), report["seconds"]))
            for label, peer in [("martini", martini), ("delatin", delatin)]:
                x, y, z, triangles, seconds = peer(heights, wanted)
                rows.append((label, len(x), *errors(heights, x, y, z, triangles), seconds))
            ours = rows[0][2]
            for label, vertices, rms, largest, seconds in rows:
                gain = f"{20 * np.log10(rms / ours):+.2f}" if ours > 0 and rms > 0 else ""
                print(
                    f"| {name} | {100 * rate:g} % | {vertices} | {label} | {rms:.4g} | {largest:.4g} | {gain} | {seconds:.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
