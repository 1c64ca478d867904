"""Writes a glTF scene of many lamps: a closed hall of 12 m x 4 m x 30 m with eight cubes, and square lamps of up to
12 cm below its ceiling and before two walls. By hand: many_lamps.py OUT.gltf LAMPS [--decades N], where powers differ
by up to N decades; or --table: one lamp over a table beside a point light outside of a million times its power."""

import argparse
import base64
import json
import math
import random
import struct

WIDTH, HEIGHT, LENGTH = 12.0, 4.0, 30.0
WATTS = 3000.0  # of all lamps


class Hall:
    """Quadrilaterals of one mesh, a primitive a material."""

    def __init__(self):
        self.positions, self.indices, self.materials = [], {}, []

    def material(self, color, radiance=None):
        material = {"pbrMetallicRoughness": {"baseColorFactor": [*color, 1.0], "metallicFactor": 0.0},
                    "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}}}
        if radiance:
            material["emissiveFactor"] = [1.0, 0.9, 0.8]
            material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": radiance}
        self.materials.append(material)
        return len(self.materials) - 1

    def quad(self, corner, a, b, material):
        """Its front is towards a x b."""
        first = len(self.positions)
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            self.positions.append(tuple(c + s * u + t * v for c, u, v in zip(corner, a, b)))
        self.indices.setdefault(material, []).extend(first + i for i in (0, 1, 2, 0, 2, 3))

    def cube(self, x, z, side, material):
        h = side / 2
        self.quad((x - h, 0, z + h), (side, 0, 0), (0, side, 0), material)
        self.quad((x + h, 0, z - h), (-side, 0, 0), (0, side, 0), material)
        self.quad((x + h, 0, z + h), (0, 0, -side), (0, side, 0), material)
        self.quad((x - h, 0, z - h), (0, 0, side), (0, side, 0), material)
        self.quad((x - h, side, z + h), (side, 0, 0), (0, 0, -side), material)

    def write(self, path, lights):
        data = b"".join(struct.pack("<3f", *p) for p in self.positions)
        views = [{"buffer": 0, "byteLength": len(data)}]
        low, high = ([f(c) for c in zip(*self.positions)] for f in (min, max))
        accessors = [{"bufferView": 0, "componentType": 5126, "count": len(self.positions), "type": "VEC3",
                      "min": low, "max": high}]
        primitives = []
        for material, indices in self.indices.items():
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(indices)})
            data += struct.pack(f"<{len(indices)}I", *indices)
            accessors.append({"bufferView": len(views) - 1, "componentType": 5125, "count": len(indices),
                              "type": "SCALAR"})
            primitives.append({"attributes": {"POSITION": 0}, "indices": len(accessors) - 1, "material": material})
        nodes = [{"mesh": 0}, {"camera": 0, "translation": [2.0, 1.7, -0.4], "rotation": [-0.05, 0.08, 0.0, 0.9955]}]
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "meshes": [{"primitives": primitives}],
                "materials": self.materials, "accessors": accessors, "bufferViews": views, "nodes": nodes,
                "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.01}}],
                "extensionsUsed": ["KHR_materials_emissive_strength", "KHR_materials_specular"],
                "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," +
                             base64.b64encode(data).decode()}]}
        if lights:
            gltf["extensionsUsed"].append("KHR_lights_punctual")
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
            nodes.append({"translation": [0.0, 3.5, -400.0], "extensions": {"KHR_lights_punctual": {"light": 0}}})
        gltf["scenes"] = [{"nodes": list(range(len(nodes)))}]
        with open(path, "w", encoding="utf-8") as file:
            json.dump(gltf, file)


def add_lamps(hall, rng, count, decades):
    side = min(0.12, 0.5 * math.sqrt(WIDTH * LENGTH / count))
    levels = 12 if decades else 1
    relative = [10.0 ** (decades * (k / 11 - 0.5)) if decades else 1.0 for k in range(levels)]
    of = [rng.randrange(levels) for _ in range(count)]
    unit = WATTS / (math.pi * side * side * sum(relative[k] for k in of))
    materials = [hall.material((0, 0, 0), r * unit) for r in relative]
    for k in of:
        where = rng.random()
        z = rng.uniform(-LENGTH + 0.1, -0.2)
        if where < 0.7:
            x = rng.uniform(-WIDTH / 2 + 0.1, WIDTH / 2 - 0.2)
            hall.quad((x, HEIGHT - 0.03, z), (side, 0, 0), (0, 0, side), materials[k])
        elif where < 0.85:
            y = rng.uniform(0.5, HEIGHT - 0.3)
            hall.quad((-WIDTH / 2 + 0.03, y, z), (0, 0, -side), (0, side, 0), materials[k])
        else:
            y = rng.uniform(0.5, HEIGHT - 0.3)
            hall.quad((WIDTH / 2 - 0.03, y, z - side), (0, 0, side), (0, side, 0), materials[k])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("lamps", type=int, nargs="?", default=1)
    parser.add_argument("--decades", type=float, default=0.0)
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    rng = random.Random(7)
    hall = Hall()
    wall, floor, cube = (hall.material(c) for c in ((0.7, 0.7, 0.7), (0.5, 0.4, 0.3), (0.3, 0.5, 0.6)))
    x = WIDTH / 2
    hall.quad((-x, 0, 0), (WIDTH, 0, 0), (0, 0, -LENGTH), floor)
    hall.quad((-x, HEIGHT, -LENGTH), (WIDTH, 0, 0), (0, 0, LENGTH), wall)
    hall.quad((-x, 0, -LENGTH), (WIDTH, 0, 0), (0, HEIGHT, 0), wall)
    hall.quad((x, 0, 0), (-WIDTH, 0, 0), (0, HEIGHT, 0), wall)
    hall.quad((-x, 0, 0), (0, 0, -LENGTH), (0, HEIGHT, 0), wall)
    hall.quad((x, 0, -LENGTH), (0, 0, LENGTH), (0, HEIGHT, 0), wall)
    for i in range(8):
        hall.cube(rng.uniform(-4, 4), -3 - 3 * i, rng.uniform(0.6, 1.8), cube)
    lights = []
    if options.table:
        hall.quad((-1, 1.6, -5), (0.2, 0, 0), (0, 0, 0.2), hall.material((0, 0, 0), 20.0))
        lights = [{"type": "point", "intensity": 20.0 * 0.04 * 1e6 / 4}]
    else:
        add_lamps(hall, rng, options.lamps, options.decades)
    hall.write(options.out, lights)


if __name__ == "__main__":
    main()
