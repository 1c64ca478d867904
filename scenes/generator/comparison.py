"""Whether two glTF texts are the same scene but for what the libm of a machine rounds otherwise."""

import base64
import json
import struct

from .document import FLOAT

# One unit of the last digit of a position (document.py), and the rounding of a float of a few metres: a value half way
# between two digits falls to either side, as sin() and cos() have other last bits in another libm.
TOLERANCE = 1.5e-6


def same_scene(a, b):
    """True where the texts are equal but for numbers that differ by at most TOLERANCE, in JSON and in buffers."""
    return a == b or _same(_with_numbers(json.loads(a)), _with_numbers(json.loads(b)))


def _with_numbers(document):
    """The document with its buffers (one, embedded, views one after the other) as lists of numbers."""
    floats = {a["bufferView"] for a in document.get("accessors", []) if a["componentType"] == FLOAT}
    for buffer in document.get("buffers", []):
        data = base64.b64decode(buffer["uri"].split(",", 1)[1])
        buffer["uri"] = [
            struct.unpack_from(f"<{view['byteLength'] // 4}f" if number in floats else f"<{view['byteLength']}B", data,
                               view["byteOffset"])
            for number, view in enumerate(document["bufferViews"])]
    return document


def _same(a, b):
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return abs(a - b) <= TOLERANCE
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(map(_same, a, b))
    return a == b
