#!/usr/bin/env python3
"""Writes the glTF scenes of this folder and their closed-form answers; --check compares them instead, but for what
another machine rounds otherwise."""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True

from generator import architecture, boxes, closed_form, interiors, metals, studio, water  # noqa: E402
from generator.caustic import caustic  # noqa: E402
from generator.comparison import same_scene  # noqa: E402

CLOSED_FORM = (closed_form.furnace, closed_form.point_plane, closed_form.spot_plane, closed_form.directional_plane,
               closed_form.square_light, closed_form.mirror, closed_form.slab, closed_form.slab_floor,
               closed_form.coloured_slab, closed_form.coloured_slab_floor, metals.focus, metals.rough_metal)

# The benchmarks of the paper (Lin et al. 2020, supplementary, Table 1).
PAPER = {"box": boxes.box_scene, "clocks": studio.clocks, "conference": interiors.conference, "cornell": boxes.cornell,
         "diamond": studio.diamond, "dining": interiors.dining, "glass": studio.glass,
         "sibenik": architecture.sibenik, "sponza": architecture.sponza, "torus": boxes.torus, "water": water.water}


def files():
    """{name: text} of everything this script owns."""
    result = {"caustic.gltf": caustic().text()}
    for name, scene in PAPER.items():
        result[f"{name}.gltf"] = scene().text()
    for scene in CLOSED_FORM:
        document, expected = scene()
        name = scene.__name__
        result[f"{name}.gltf"] = document.text()
        result[f"{name}.expect.json"] = expected.text(f"{name}.gltf")
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="write nothing, exit with 1 where a file differs")
    check = parser.parse_args().check
    folder = pathlib.Path(__file__).resolve().parent
    differ = []
    for name, text in files().items():
        path = folder / name
        if check:
            if not path.is_file() or not same_scene(path.read_text(encoding="utf-8"), text):
                differ.append(name)
        else:
            path.write_text(text, encoding="utf-8")
    for name in differ:
        print(f"{name}: differs from what scenes/generate.py writes", file=sys.stderr)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
