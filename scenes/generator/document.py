"""A glTF 2.0 document with one embedded buffer. Every number is rounded, so that the text hardly depends on libm."""

import base64
import json
import math
import struct

from .vector import add, cross, normalize

FLOAT, USHORT = 5126, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def rounded(values, digits=9):
    return [round(float(v), digits) + 0.0 for v in values]


class Document:
    def __init__(self, about, title=None):
        self._buffer = bytearray()
        self._views, self._accessors = [], []
        self._materials, self._meshes, self._nodes, self._lights = [], [], [], []
        self._camera = None
        self._extensions = set()
        self._about, self._title = about, title
        self._stored = {}  # id of a mesh -> (the mesh, its accessors): drawn twice, it is stored once

    # -- materials: each returns its index --------------------------------------------------------------------------

    def lambert(self, name, reflectance, radiance=None, double_sided=False):
        """Diffuse surface without a coat; emits `radiance` (W m^-2 sr^-1) where that is given."""
        return self._material(name, reflectance, 0.0, 1.0, {"KHR_materials_specular": {"specularFactor": 0.0}},
                              radiance, double_sided)

    def emitter(self, name, radiance):
        """One-sided black surface of that radiance."""
        return self.lambert(name, (0.0, 0.0, 0.0), radiance)

    def mirror(self, name, tint):
        """Perfectly smooth metal; `tint` is its reflectance at normal incidence."""
        return self._material(name, tint, 1.0, 0.0, {})

    def metal(self, name, tint, roughness):
        """Metal whose microfacets have alpha = roughness^2; `tint` is its reflectance at normal incidence."""
        return self._material(name, tint, 1.0, roughness, {})

    def coated(self, name, reflectance, roughness):
        """Diffuse surface under a clear coat of ior 1.5: glTF's default dielectric."""
        return self._material(name, reflectance, 0.0, roughness, {})

    def glass(self, name, ior, attenuation=None, dispersion=None):
        """Smooth and solid: it needs a closed mesh with fronts outward. attenuation: (rgb that is left, after m);
        dispersion: 20 / Abbe number."""
        volume = {"thicknessFactor": 1.0}
        if attenuation:
            volume |= {"attenuationColor": rounded(attenuation[0]), "attenuationDistance": attenuation[1]}
        extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
                      "KHR_materials_ior": {"ior": ior},
                      "KHR_materials_volume": volume}
        if dispersion:
            extensions["KHR_materials_dispersion"] = {"dispersion": dispersion}
        return self._material(name, (1.0, 1.0, 1.0), 0.0, 0.0, extensions)

    def _material(self, name, base_color, metallic, roughness, extensions, radiance=None, double_sided=False):
        material = {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": rounded(base_color) + [1.0],
            "metallicFactor": metallic, "roughnessFactor": roughness}}
        extensions = dict(extensions)
        if radiance:
            strength = max(1.0, *radiance)
            material["emissiveFactor"] = rounded(r / strength for r in radiance)
            if strength > 1.0:
                extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if double_sided:
            material["doubleSided"] = True
        if extensions:
            material["extensions"] = extensions
            self._extensions.update(extensions)
        self._materials.append(material)
        return len(self._materials) - 1

    # -- nodes ------------------------------------------------------------------------------------------------------

    def add_mesh(self, name, mesh, material, places=None):
        """A node that draws `mesh` (shapes.Mesh) in world space, or one at each of `places` (place())."""
        self._meshes.append({"name": name, "primitives": [{**self._geometry(mesh), "material": material}]})
        for number, transform in enumerate(places or [{}], 1):
            numbered = name if len(places or [{}]) == 1 else f"{name} {number}"
            self._nodes.append({"name": numbered, "mesh": len(self._meshes) - 1, **transform})

    def _geometry(self, mesh):
        if id(mesh) not in self._stored:
            attributes = {"POSITION": self._floats(mesh.positions, bounds=True)}
            if mesh.normals:
                attributes["NORMAL"] = self._floats(mesh.normals)
            indices = [i for triangle in mesh.triangles for i in triangle]
            assert max(indices) < 65535
            view = self._view(struct.pack(f"<{len(indices)}H", *indices), ELEMENT_ARRAY_BUFFER)
            self._accessors.append({"bufferView": view, "componentType": USHORT, "count": len(indices),
                                    "type": "SCALAR"})
            self._stored[id(mesh)] = mesh, {"attributes": attributes, "indices": len(self._accessors) - 1}
        return self._stored[id(mesh)][1]

    def add_camera(self, camera):
        """A perspective camera (camera.Camera)."""
        assert self._camera is None
        self._camera = {"type": "perspective", "perspective": {
            "aspectRatio": camera.aspect, "yfov": round(camera.yfov, 12), "znear": 0.01}}
        axes = [*camera.right, 0.0, *camera.up, 0.0, *camera.back, 0.0, *camera.position, 1.0]
        self._nodes.append({"name": "camera", "camera": 0, "matrix": rounded(axes, 12)})

    def add_light(self, kind, intensity, position=None, direction=None, cones=None, name=None):
        """point, spot (W/sr) or directional (W/m^2); cones: inner and outer half angle in rad."""
        strength = max(intensity)
        light = {"type": kind, "color": rounded(i / strength for i in intensity), "intensity": strength}
        if cones:
            light["spot"] = {"innerConeAngle": round(cones[0], 12), "outerConeAngle": round(cones[1], 12)}
        self._lights.append(light)
        self._extensions.add("KHR_lights_punctual")
        node = {"name": name or kind, "extensions": {"KHR_lights_punctual": {"light": len(self._lights) - 1}}}
        if position:
            node["translation"] = rounded(position)
        if direction:
            node["rotation"] = rounded(_rotation_from_minus_z(direction), 12)
        self._nodes.append(node)

    def text(self):
        """The file's text."""
        document = {
            "asset": {"version": "2.0", "generator": "scenes/generate.py", "extras": {"about": self._about}},
            "extensionsUsed": sorted(self._extensions),
            "scene": 0, "scenes": [{**({"name": self._title} if self._title else {}),
                                    "nodes": list(range(len(self._nodes)))}],
            "nodes": self._nodes, "cameras": [self._camera], "materials": self._materials, "meshes": self._meshes,
            "accessors": self._accessors, "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._buffer), "uri":
                         "data:application/octet-stream;base64," + base64.b64encode(self._buffer).decode("ascii")}]}
        if self._lights:
            document["extensions"] = {"KHR_lights_punctual": {"lights": self._lights}}
        lines = (f"{json.dumps(key)}:{json.dumps(value, separators=(',', ':'))}" for key, value in document.items())
        return "{" + ",\n".join(lines) + "}\n"

    # -- buffer -----------------------------------------------------------------------------------------------------

    def _view(self, data, target):
        self._views.append({"buffer": 0, "byteOffset": len(self._buffer), "byteLength": len(data), "target": target})
        self._buffer += data + b"\0" * (-len(data) % 4)
        return len(self._views) - 1

    def _floats(self, vectors, bounds=False):
        values = [v for vector in vectors for v in rounded(vector, 6)]
        data = struct.pack(f"<{len(values)}f", *values)
        accessor = {"bufferView": self._view(data, ARRAY_BUFFER), "componentType": FLOAT, "count": len(vectors),
                    "type": "VEC3"}
        if bounds:
            stored = struct.unpack(f"<{len(values)}f", data)
            accessor["min"] = [min(stored[axis::3]) for axis in range(3)]
            accessor["max"] = [max(stored[axis::3]) for axis in range(3)]
        self._accessors.append(accessor)
        return len(self._accessors) - 1


def place(at, yaw=0.0, pitch=0.0, size=1.0):
    """Transform of a node: scaled by `size`, turned by `pitch` around +x, then by `yaw` around +y (degrees), moved."""
    y, p = math.radians(yaw) / 2.0, math.radians(pitch) / 2.0
    transform = {"translation": rounded(at)}
    if yaw or pitch:
        transform["rotation"] = rounded((math.cos(y) * math.sin(p), math.sin(y) * math.cos(p),
                                         -math.sin(y) * math.sin(p), math.cos(y) * math.cos(p)), 12)
    if size != 1.0:
        transform["scale"] = [size] * 3
    return transform


def _rotation_from_minus_z(direction):
    """Unit quaternion (x, y, z, w) that turns (0, 0, -1) into `direction`."""
    target = normalize(direction)
    start = (0.0, 0.0, -1.0)
    half = add(start, target)
    assert math.hypot(*half) > 1e-6, "direction +z needs another axis"
    half = normalize(half)
    axis = cross(start, half)
    return (*axis, half[2] * start[2])
