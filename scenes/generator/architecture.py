"""Buildings that the sun enters through rows of openings: Sibenik and Sponza."""

import math

from .camera import Camera
from .document import Document, place
from .interiors import pierced
from .shapes import box, join, quad
from .solids import arc, arched_wall, extrude, lathe, mapped, moved, ribbon

BAY = 3.5  # m between columns


def sibenik():
    """A nave between two aisles, under a barrel vault; sun through the clerestory, coloured panes in the end wall."""
    document = Document("A nave with columns, arches and a vault, the sun through its high windows. Stands in for the "
                        "model of Sibenik's cathedral.", "Sibenik (stand-in)")
    half, aisle, bays = 2.9, 5.4, 5
    length = bays * BAY / 2.0
    stone = document.lambert("stone", (0.66, 0.6, 0.5))
    centers = [BAY * (i + 0.5) - length for i in range(bays)]
    rows = [BAY * i - length for i in range(bays + 1)]
    arcade(document, stone, [place((side * half, 0.0, z), yaw=90.0) for side in (-1, 1) for z in centers],
           [place((side * half, 0.0, z)) for side in (-1, 1) for z in rows], 3.0, 5.6, 2.7, 0.5)
    high = [(z - 1.0, z + 1.0, 6.2, 8.0) for z in centers]
    low = [(z - 0.7, z + 0.7, 1.6, 4.6) for z in centers]
    document.add_mesh("clerestory", join(pierced((half + 0.25, 5.601), length, 3.0, high, 0.5),
                                         pierced((-half + 0.25, 5.601), length, 3.0, high, 0.5)), stone)
    document.add_mesh("aisle walls", join(pierced((aisle + 0.4, 0.0), length, 5.6, low, 0.4),
                                          pierced((-aisle, 0.0), length, 5.6, low, 0.4)), stone)
    roofs = [quad((side * (half + aisle) / 2.0, 5.599, 0.0), ((aisle - half) / 2.0 + 0.3, 0.0, 0.0), (0.0, 0.0, length))
             for side in (-1, 1)]
    document.add_mesh("aisle roofs", join(*roofs), stone)
    document.add_mesh("vault", moved(ribbon(arc((0.0, 0.0), half, 0.0, 180.0, 24), 2.0 * length), (0.0, 8.55, 0.0)),
                      document.lambert("vault", (0.7, 0.66, 0.58)))
    rib = extrude(arc((0.0, 0.0), half + 0.1, 0.0, 180.0, 20) + arc((0.0, 0.0), half - 0.16, 180.0, 0.0, 20), 0.36)
    document.add_mesh("rib", rib, stone, [place((0.0, 8.5, z)) for z in rows[1:-1]])
    floor(document, aisle, length, ((0.55, 0.5, 0.44), (0.26, 0.12, 0.09)))
    document.add_mesh("west wall", quad((0.0, 5.8, length), (0.0, 5.8, 0.0), (aisle + 0.4, 0.0, 0.0)), stone)
    lights = [(-2.0, -1.1, 2.6, 6.2), (-0.45, 0.45, 2.6, 7.4), (1.1, 2.0, 2.6, 6.2)]
    document.add_mesh("east wall", moved(pierced((0.0, 0.0), aisle + 0.4, 11.6, lights, 0.4),
                                         (0.0, 0.0, -length), -90.0), stone)
    panes(document, lights, -length - 0.3)
    document.add_mesh("altar", join(box((-1.0, 0.3, -length + 0.7), (1.0, 1.25, -length + 1.3)),
                                    box((-2.2, 0.001, -length + 0.1), (2.2, 0.3, -length + 2.4)),
                                    box((-2.6, 0.001, -length + 0.1), (2.6, 0.15, -length + 2.8))),
                      document.lambert("marble", (0.74, 0.72, 0.68)))
    pew = join(box((-0.95, 0.0, -0.03), (0.95, 0.85, 0.03)), box((-0.95, 0.4, 0.031), (0.95, 0.45, 0.4)),
               box((-0.95, 0.0, 0.1), (-0.9, 0.399, 0.36)), box((0.9, 0.0, 0.1), (0.95, 0.399, 0.36)))
    document.add_mesh("pew", pew, document.coated("oak", (0.24, 0.13, 0.06), 0.5),
                      [place((side * 1.4, 0.001, -3.6 + 1.0 * i), yaw=180.0) for side in (-1, 1) for i in range(6)])
    document.add_light("directional", (58.0, 49.0, 36.0), direction=(-0.62, -0.95, -0.3), name="sun")
    sky = document.emitter("sky", (3.0, 3.8, 5.0))
    for number, z in enumerate(centers, 1):
        document.add_mesh(f"sky {number}", join(quad((-aisle - 0.5, 3.1, z), (0.0, 1.7, 0.0), (0.0, 0.0, BAY / 2.0)),
                                                quad((-half - 0.6, 7.5, z), (0.0, 1.6, 0.0), (0.0, 0.0, BAY / 2.0)),
                                                quad((aisle + 2.0, 2.7, z), (0.0, 0.0, BAY / 2.0), (0.0, 1.5, 0.0))),
                          sky)
    document.add_camera(Camera((0.0, 2.3, length - 0.5), (0.0, 3.9, -length), math.radians(56.0), (4, 3)))
    return document


def arcade(document, material, bays, columns, column, top, opening, thickness):
    """Round arches on columns: the arches start at the height `column`, their wall ends at `top`."""
    panel = moved(arched_wall(BAY - 0.002, top - column - 0.001, opening, 0.06, thickness), (0.0, column + 0.001, 0.0))
    name = f"arch {column + top:g}"
    document.add_mesh(name, panel, material, bays)
    document.add_mesh(f"column of {name}", pillar(column), material, columns)


def pillar(height):
    """Round column with base and capital."""
    return lathe([(0.0, 0.001), (0.48, 0.001), (0.48, 0.16), *arc((0.4, 0.22), 0.06, -90.0, 90.0, 3), (0.33, 0.3),
                  (0.29, height - 0.5), (0.33, height - 0.48), (0.3, height - 0.42), (0.33, height - 0.3),
                  (0.44, height - 0.16), (0.5, height - 0.14), (0.5, height - 0.001), (0.0, height - 0.001)], 20)


def floor(document, half_x, half_z, tints, size=0.9):
    """Slabs of two colours, chequered."""
    nx, nz = round(2.0 * half_x / size), round(2.0 * half_z / size)
    slabs = ([], [])
    for i in range(nx):
        for j in range(nz):
            x, z = half_x * ((2 * i + 1) / nx - 1.0), half_z * ((2 * j + 1) / nz - 1.0)
            slabs[(i + j) % 2].append(quad((x, 0.0, z), (0.0, 0.0, half_z / nz), (half_x / nx, 0.0, 0.0)))
    for number, tint in enumerate(tints):
        document.add_mesh(f"slabs {number + 1}", join(*slabs[number]), document.lambert(f"marble {number + 1}", tint))


def panes(document, lights, z):
    """Glowing coloured panes outside the windows of the wall at z."""
    colors = ((1.5, 0.12, 0.08), (0.1, 0.3, 1.6), (1.6, 0.95, 0.12), (0.15, 0.8, 0.35))
    groups = [[] for _ in colors]
    for window, (x0, x1, y0, y1) in enumerate(lights):
        across, up = 3, round((y1 - y0) / 0.3)
        for i in range(across):
            for j in range(up):
                w, h = (x1 - x0) / across / 2.0, (y1 - y0) / up / 2.0
                center = (x0 + w * (2 * i + 1), y0 + h * (2 * j + 1), z)
                kind = (abs(i - 1) + 2 * ((j + window) % 3) + j // 3) % len(colors)
                groups[kind].append(quad(center, (w - 0.014, 0.0, 0.0), (0.0, h - 0.014, 0.0)))
    for number, (color, group) in enumerate(zip(colors, groups), 1):
        document.add_mesh(f"panes {number}", join(*group), document.emitter(f"pane {number}", color))


def sponza():
    """A court under the open sky between two storeys of arches, with drapes."""
    document = Document("A court between two storeys of arches under the sun and a strip of sky. Stands in for the "
                        "model of Sponza's atrium.", "Sponza (stand-in)")
    half_x, bays, deep = BAY, 5, 2.6
    half_z = bays * BAY / 2.0
    stone = document.lambert("sandstone", (0.68, 0.58, 0.45))
    plaster = document.lambert("plaster", (0.72, 0.63, 0.5))
    centers = [BAY * (i + 0.5) - half_z for i in range(bays)]
    rows = [BAY * i - half_z for i in range(bays + 1)]
    for level, column, top in ((0.0, 2.6, 4.6), (5.0, 1.7, 3.6)):
        ends = [place((x, level, -half_z)) for x in (-BAY / 2.0, BAY / 2.0)]
        corners = [place((side * half_x, level, z)) for side in (-1, 1) for z in rows]
        sides = [place((side * half_x, level, z), yaw=90.0) for side in (-1, 1) for z in centers]
        arcade(document, stone, sides + ends, corners + [place((0.0, level, -half_z))], column, top, 2.6, 0.45)
    outer_x, outer_z = half_x + deep, half_z + deep
    slabs = []
    for low, high in ((4.601, 4.999), (8.601, 8.901)):
        slabs += [box((-outer_x, low, -outer_z), (-half_x + 0.35, high, half_z)),
                  box((half_x - 0.35, low, -outer_z), (outer_x, high, half_z)),
                  box((-half_x + 0.351, low, -outer_z), (half_x - 0.351, high, -half_z + 0.35))]
    document.add_mesh("galleries", join(*slabs), stone)
    doors = [(z - 0.55, z + 0.55, 0.0, 2.3) for z in centers[::2]]
    document.add_mesh("outer walls", join(
        pierced((outer_x + 0.3, 0.0), outer_z, 8.6, doors, 0.299),
        pierced((-outer_x - 0.001, 0.0), outer_z, 8.6, doors, 0.299),
        box((-outer_x, 0.0, -outer_z - 0.3), (outer_x, 8.6, -outer_z - 0.001)),
        box((-outer_x, 0.0, half_z + 0.5), (outer_x, 8.9, half_z + 0.8))), plaster)
    floor(document, outer_x, outer_z, ((0.5, 0.44, 0.36), (0.42, 0.35, 0.28)))
    rail = join(box((-BAY / 2.0 + 0.35, 0.62, -0.1), (BAY / 2.0 - 0.35, 0.74, 0.1)),
                *[box((-1.25 + 0.25 * i, 0.0, -0.05), (-1.15 + 0.25 * i, 0.619, 0.05)) for i in range(11)])
    document.add_mesh("balustrade", rail, stone,
                      [place((side * half_x, 5.0, z), yaw=90.0) for side in (-1, 1) for z in centers] +
                      [place((x, 5.0, -half_z)) for x in (-BAY / 2.0, BAY / 2.0)])
    cloth = drape(2.0, 3.1)
    for name, tint, spots in (("red drape", (0.6, 0.04, 0.04), ((-1, 3), (1, 2), (-1, 0))),
                              ("blue drape", (0.05, 0.1, 0.42), ((-1, 2), (1, 1))),
                              ("green drape", (0.08, 0.32, 0.07), ((-1, 1), (1, 3), (1, 0)))):
        document.add_mesh(name, cloth, document.lambert(name, tint, double_sided=True),
                          [place((side * (half_x + 0.05), 0.75, centers[bay]), yaw=90.0) for side, bay in spots])
    vase = lathe([(0.0, 0.0), (0.22, 0.0), (0.24, 0.05), (0.2, 0.1), (0.34, 0.4), (0.36, 0.6), (0.26, 0.85),
                  (0.31, 0.95), (0.28, 0.95), (0.23, 0.85), (0.2, 0.7), (0.0, 0.7)], 24)
    document.add_mesh("vase", vase, document.lambert("terracotta", (0.55, 0.24, 0.13)),
                      [place((side * (half_x - 0.95), 0.001, z)) for side in (-1, 1) for z in rows[1:-1]])
    document.add_light("directional", (11.5, 10.0, 7.9), direction=(0.42, -1.0, -0.3), name="sun")
    document.add_mesh("sky", quad((0.0, 12.4, -outer_z - 1.2), (9.5, 0.0, 0.0), (0.0, 3.8, 1.0)),
                      document.emitter("sky", (0.62, 0.9, 1.4)))
    document.add_camera(Camera((0.9, 1.9, half_z - 0.1), (-0.35, 3.9, -half_z), math.radians(56.0), (4, 3)))
    return document


def drape(width, height):
    """A hanging cloth in folds, around x = 0, from y = 0 up; thin: both its sides are the one surface."""
    points = [(width * (i / 40.0 - 0.5), 0.07 * math.sin(2.0 * math.pi * i / 8.0)) for i in range(41)]
    return mapped(ribbon(points, height), (0.0, height / 2.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
