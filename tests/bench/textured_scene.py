#!/usr/bin/env python3
"""Writes a glTF scene of many squares in the sun, each with an image of its own, and its PNGs into a folder: images
that compress little, as photographs do. By hand: textured_scene.py FOLDER IMAGES [--side N]."""

import argparse
import base64
import json
import math
import pathlib
import random
import struct
import sys

sys.dont_write_bytecode = True
import pictures  # noqa: E402


def png(side, seed):
    """An 8-bit RGB PNG of side x side texels: rows of noise, a few that come again and again."""
    rng = random.Random(seed)
    rows = [b"\0" + rng.randbytes(3 * side) for _ in range(16)]
    return pictures.png_of(side, side, b"".join(rows[y % 16] for y in range(side)), level=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("images", type=int)
    parser.add_argument("--side", type=int, default=2048, help="texels (default: %(default)s)")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    across = math.ceil(math.sqrt(options.images))
    corners = struct.pack("<12f", 0, 0, 0, 0.95, 0, 0, 0.95, 0.95, 0, 0, 0.95, 0)
    data = corners + struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    for i in range(options.images):
        (options.folder / f"{i}.png").write_bytes(png(options.side, i))
    numbers = range(options.images)
    places = [{"mesh": i, "translation": [i % across, i // across, 0]} for i in numbers]
    eye = {"camera": 0, "translation": [across / 2, across / 2, 1.2 * across]}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(options.images + 2))}],
        "nodes": places + [eye, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": i}]}
                   for i in numbers],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}, "metallicFactor": 0}}
                      for i in numbers],
        "textures": [{"source": i} for i in numbers], "images": [{"uri": f"{i}.png"} for i in numbers],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0],
             "max": [0.95, 0.95, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": first, "byteLength": length}
                        for first, length in ((0, 48), (48, 32), (80, 12))],
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
    }
    (options.folder / "scene.gltf").write_text(json.dumps(document))


if __name__ == "__main__":
    main()
