"""Writes a glTF scene of many instances of one mesh: bumpy spheres, each turned, scaled and some mirrored, over a floor
under a lamp. By hand: instanced_scene.py OUT.glb INSTANCES TRIANGLES [--nodes]."""

import argparse
import json
import math
import random
import struct


def bumpy_sphere(columns, rows):
    """Positions, normals and triangles of a closed surface of about 2 * columns * rows triangles."""
    positions, normals, triangles = [(0.0, 1.0, 0.0)], [(0.0, 1.0, 0.0)], []
    for row in range(1, rows):
        for column in range(columns):
            theta, phi = math.pi * row / rows, 2.0 * math.pi * column / columns
            n = (math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
            radius = 1.0 + 0.1 * math.sin(7.0 * theta) * math.sin(5.0 * phi) * math.sin(theta) ** 2
            positions.append(tuple(radius * c for c in n))
            normals.append(n)
    positions.append((0.0, -1.0, 0.0))
    normals.append((0.0, -1.0, 0.0))
    last = len(positions) - 1
    ring = lambda row, column: 1 + (row - 1) * columns + column % columns
    for column in range(columns):
        triangles.append((0, ring(1, column + 1), ring(1, column)))
        triangles.append((last, ring(rows - 1, column), ring(rows - 1, column + 1)))
        for row in range(1, rows - 1):
            a, b = ring(row, column), ring(row, column + 1)
            c, d = ring(row + 1, column), ring(row + 1, column + 1)
            triangles += [(a, b, c), (b, d, c)]
    return positions, normals, triangles


def quaternion(rng):
    q = [rng.gauss(0.0, 1.0) for _ in range(4)]
    length = math.sqrt(sum(c * c for c in q))
    return [c / length for c in q]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("instances", type=int)
    parser.add_argument("triangles", type=int, help="of the mesh, about")
    parser.add_argument("--nodes", action="store_true", help="a node an instance, not EXT_mesh_gpu_instancing")
    options = parser.parse_args()
    rng = random.Random(1)
    side = max(3, round(math.sqrt(options.triangles / 2)))
    positions, normals, triangles = bumpy_sphere(side, side + 1)

    data, views, accessors = bytearray(), [], []

    def accessor(values, kind, component, code):
        flat = [x for value in values for x in (value if isinstance(value, (tuple, list)) else (value,))]
        while len(data) % 4:
            data.append(0)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(flat) * struct.calcsize(code)})
        data.extend(struct.pack("<%d%s" % (len(flat), code), *flat))
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values), "type": kind})
        if kind == "VEC3":
            accessors[-1]["min"] = [min(v[c] for v in values) for c in range(3)]
            accessors[-1]["max"] = [max(v[c] for v in values) for c in range(3)]
        return len(accessors) - 1

    def mesh(positions, normals, triangles, material):
        return {"primitives": [{
            "attributes": {"POSITION": accessor(positions, "VEC3", 5126, "f"),
                           "NORMAL": accessor(normals, "VEC3", 5126, "f")},
            "indices": accessor([i for t in triangles for i in t], "SCALAR", 5125, "I"), "material": material}]}

    across = math.ceil(math.sqrt(options.instances))
    half = 1.0
    quad = [(0, 1, 2), (0, 2, 3)]
    up = [(0.0, 1.0, 0.0)] * 4
    floor = [(-1.2 * half, 0, -1.2 * half), (-1.2 * half, 0, 1.2 * half), (1.2 * half, 0, 1.2 * half),
             (1.2 * half, 0, -1.2 * half)]
    lamp = [(-0.4, 1.5, -0.4), (0.4, 1.5, -0.4), (0.4, 1.5, 0.4), (-0.4, 1.5, 0.4)]
    down = [(0.0, -1.0, 0.0)] * 4
    meshes = [mesh(positions, normals, triangles, 0), mesh(floor, up, quad, 1), mesh(lamp, down, quad, 2)]
    step = 2.0 * half / across
    places, turns, scales = [], [], []
    for i in range(options.instances):
        size = 0.45 * step * rng.uniform(0.5, 1.0)
        mirror = -1.0 if i % 5 == 0 else 1.0
        places.append((-half + (i % across + 0.5) * step, size * 1.2, -half + (i // across + 0.5) * step))
        turns.append(quaternion(rng))
        scales.append((mirror * size, size * rng.uniform(0.7, 1.0), size))
    nodes = [{"mesh": 1}, {"mesh": 2}, {"camera": 0, "translation": [0.0, 1.1, 2.4],
                                        "rotation": [-math.sin(0.2), 0.0, 0.0, math.cos(0.2)]}]
    extensions = []
    if options.nodes:
        nodes += [{"mesh": 0, "translation": p, "rotation": q, "scale": s} for p, q, s in zip(places, turns, scales)]
    else:
        extensions = ["EXT_mesh_gpu_instancing"]
        attributes = {"TRANSLATION": accessor(places, "VEC3", 5126, "f"),
                      "ROTATION": accessor(turns, "VEC4", 5126, "f"), "SCALE": accessor(scales, "VEC3", 5126, "f")}
        nodes.append({"mesh": 0, "extensions": {extensions[0]: {"attributes": attributes}}})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
        "meshes": meshes, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.5, 0.3, 1.0], "metallicFactor": 0.0},
             "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}},
            {"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.7, 0.7, 1.0], "metallicFactor": 0.0},
             "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}},
            {"emissiveFactor": [1.0, 1.0, 1.0], "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8.0}}}],
        "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"] + extensions}
    if extensions:
        document["extensionsRequired"] = extensions
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data.extend(b"\0" * (-len(data) % 4))
    document_chunk = struct.pack("<II", len(text), 0x4E4F534A) + text
    data_chunk = struct.pack("<II", len(data), 0x004E4942) + bytes(data)
    with open(options.out, "wb") as out:
        out.write(struct.pack("<III", 0x46546C67, 2, 12 + len(document_chunk) + len(data_chunk)))
        out.write(document_chunk + data_chunk)


if __name__ == "__main__":
    main()
