"""Rooms with many lamps and openings: Conference and Dining."""

import math

from .camera import Camera
from .document import Document, place
from .shapes import box, join, quad, sphere
from .solids import arc, cylinder, extrude, lathe, mapped, moved, rod, room, spline, torus


def conference():
    """A long table under 24 small lamps, each in a fixture of its own."""
    document = Document("A conference room under 24 small lamps in fixtures. Stands in for the model of that name.",
                        "Conference (stand-in)")
    x, y, z = 3.0, 2.9, 4.6
    walls = room((-x, 0.0, -z), (x, y, z), without=("ceiling", "left"))
    plaster = document.lambert("plaster", (0.7, 0.69, 0.66))
    document.add_mesh("walls", join(walls["right"], walls["front"], walls["back"]), plaster)
    document.add_mesh("carpet", walls["floor"], document.lambert("carpet", (0.16, 0.22, 0.3)))
    document.add_mesh("wall to the corridor", pierced((-x, 0.0), z, y, ((-3.2, -2.2, 0.0, 2.1), (-1.2, 0.6, 0.9, 2.1),
                                                                        (1.4, 3.2, 0.9, 2.1))), plaster)
    corridor = room((-x - 1.6, 0.0, -z), (-x - 0.11, y, z), without=("right", "floor"))
    document.add_mesh("corridor", join(*corridor.values()), document.lambert("corridor", (0.6, 0.5, 0.38)))
    document.add_mesh("corridor's floor", quad((-x - 0.8, -0.001, 0.0), (0.0, 0.0, z), (0.9, 0.0, 0.0)),
                      document.lambert("stone", (0.4, 0.38, 0.35)))
    lamps(document, x, y, z, plaster)
    document.add_mesh("corridor lamp", quad((-x - 0.8, y - 0.02, -1.2), (0.2, 0.0, 0.0), (0.0, 0.0, 0.5)),
                      document.emitter("corridor lamp", (5.0, 4.2, 3.0)))
    ends = arc((1.9, 0.0), 0.68, -90.0, 90.0, 12) + arc((-1.9, 0.0), 0.68, 90.0, 270.0, 12)
    flat = mapped(extrude(ends, 0.05), (0.0, 0.735, 0.3), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    document.add_mesh("table", flat, document.coated("walnut", (0.26, 0.12, 0.055), 0.6))
    document.add_mesh("table legs", join(box((-0.25, 0.001, -1.35), (0.25, 0.709, -1.25)),
                                         box((-0.25, 0.001, 1.85), (0.25, 0.709, 1.95))),
                      document.lambert("leg", (0.08, 0.08, 0.09)))
    seats = [(side * 1.0, -1.35 + 0.82 * i) for side in (-1, 1) for i in range(5)]
    places = [place((sx, 0.0, sz), yaw=-90.0 if sx < 0 else 90.0) for sx, sz in seats]
    office_chair(document, places + [place((0.0, 0.0, -2.75), yaw=180.0)])
    paper = document.lambert("paper", (0.8, 0.8, 0.78))
    document.add_mesh("paper", box((-0.1, 0.0, -0.14), (0.1, 0.004, 0.14)), paper,
                      [place((0.42 * side, 0.7605, -1.3 + 0.82 * i), yaw=83.0 + 11.0 * ((i * 7 + side) % 3))
                       for side in (-1, 1) for i in (0, 1, 3, 4)])
    jug = lathe([(0.0, 0.0), *spline([(0.05, 0.0), (0.055, 0.012), (0.05, 0.1), (0.035, 0.17), (0.042, 0.22)], 3),
                 *spline([(0.039, 0.22), (0.032, 0.17), (0.046, 0.1), (0.05, 0.02), (0.0, 0.012)], 3)], 24)
    document.add_mesh("jug", jug, document.glass("glass", 1.5),
                      [place((0.05, 0.761, -0.35)), place((-0.06, 0.761, 1.0))])
    document.add_mesh("screen", box((-1.25, 0.95, -z + 0.001), (1.25, 2.3, -z + 0.04)),
                      document.lambert("screen", (0.82, 0.82, 0.82)))
    document.add_mesh("screen's frame", join(*[box(low, high) for low, high in (
        ((-1.3, 0.9, -z + 0.002), (1.3, 0.949, -z + 0.06)), ((-1.3, 2.301, -z + 0.002), (1.3, 2.35, -z + 0.06)),
        ((-1.3, 0.95, -z + 0.002), (-1.251, 2.3, -z + 0.06)), ((1.251, 0.95, -z + 0.002), (1.3, 2.3, -z + 0.06)))]),
                      document.metal("aluminium", (0.9, 0.91, 0.92), 0.4))
    cupboard = join(box((2.45, 0.001, -3.9), (2.999, 0.8, -0.6)), *[
        box((2.43, 0.06, -3.88 + 0.82 * i), (2.449, 0.77, -3.1 + 0.82 * i)) for i in range(4)])
    document.add_mesh("cupboard", cupboard, document.coated("oak", (0.5, 0.33, 0.17), 0.4))
    document.add_mesh("picture", box((2.95, 1.25, -2.9), (2.999, 2.05, -1.6)),
                      document.lambert("canvas", (0.62, 0.18, 0.08)))
    document.add_camera(Camera((1.2, 1.62, 4.45), (-0.25, 0.98, -1.2), math.radians(48.0), (4, 3)))
    return document


def pierced(foot, half, height, holes, thickness=0.1):
    """Wall along z that ends at x = foot[0], from y = foot[1]; holes: (z low, z high, y low, y high), in order of z."""
    parts, low = [], -half
    x0, x1 = foot[0] - thickness, foot[0]
    for z0, z1, y0, y1 in holes:
        parts.append(box((x0, foot[1], low), (x1, foot[1] + height, z0)))
        if y0 > foot[1]:
            parts.append(box((x0, foot[1], z0), (x1, y0, z1)))
        parts.append(box((x0, y1, z0), (x1, foot[1] + height, z1)))
        low = z1
    return join(*parts, box((x0, foot[1], low), (x1, foot[1] + height, half)))


def lamps(document, x, y, z, plaster):
    """A ceiling with 3 x 8 square holes and a lamp in the top of each."""
    side, deep = 0.13, 0.12
    xs, zs = (-1.7, 0.0, 1.7), [-z + z * (2 * i + 1) / 8.0 for i in range(8)]
    strips, edge = [], -x
    for at in xs:
        strips.append((edge, at - side))
        edge = at + side
    strips.append((edge, x))
    parts = [quad(((a + b) / 2.0, y, 0.0), ((b - a) / 2.0, 0.0, 0.0), (0.0, 0.0, z)) for a, b in strips]
    for at in xs:
        edge = -z
        for lamp in [*zs, None]:
            end = z if lamp is None else lamp - side
            parts.append(quad((at, y, (edge + end) / 2.0), (side, 0.0, 0.0), (0.0, 0.0, (end - edge) / 2.0)))
            edge = None if lamp is None else lamp + side
    document.add_mesh("ceiling", join(*parts), plaster)
    shaft = room((-side, 0.0, -side), (side, deep, side), without=("floor",))
    places = [place((at, y, lamp)) for at in xs for lamp in zs]
    document.add_mesh("fixture", join(*shaft.values()), document.lambert("fixture", (0.8, 0.8, 0.8)), places)
    document.add_mesh("lamp", quad((0.0, deep - 0.02, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1)),
                      document.emitter("lamp", (58.0, 52.5, 44.0)), places)


def office_chair(document, places):
    """Seat and back of cloth on a steel foot; it looks along -z."""
    seat = rounded_box(0.25, 0.235, 0.035)
    cloth = [moved(seat, (0.0, 0.46, 0.0)), mapped(seat, (0.0, 0.8, 0.24), (1.0, 0.0, 0.0), (0.0, 0.17, 0.985),
                                                     (0.0, -0.985, 0.17))]
    document.add_mesh("cushions", join(*cloth), document.lambert("cloth", (0.08, 0.11, 0.16)), places)
    feet = [rod((0.0, 0.07, 0.0), (0.27 * math.cos(a), 0.03, 0.27 * math.sin(a)), 0.016, 6)
            for a in (2.0 * math.pi * i / 5.0 for i in range(5))]
    stem = [rod((0.0, 0.06, 0.0), (0.0, 0.43, 0.0), 0.025, 10), rod((0.0, 0.44, 0.1), (0.0, 0.6, 0.255), 0.018, 6)]
    document.add_mesh("chair's foot", join(*feet, *stem), document.metal("steel", (0.72, 0.72, 0.74), 0.35), places)


def rounded_box(x, z, y):
    """Cushion: an upright prism with rounded corners."""
    r = 0.07
    outline = [p for cx, cz, start in ((x - r, z - r, 0.0), (r - x, z - r, 90.0), (r - x, r - z, 180.0),
                                       (x - r, r - z, 270.0)) for p in arc((cx, cz), r, start, start + 90.0, 4)]
    return mapped(extrude(outline, 2.0 * y), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))


def dining():
    """A table laid for six: sun through a window, a chandelier, a dark corner behind a thin wall."""
    document = Document("A table laid for six under a chandelier, sun through a window, a dark corner behind a thin "
                        "wall. Stands in for the model of that name.", "Dining (stand-in)")
    x, y, z = 2.6, 2.8, 3.0
    walls = room((-x, 0.0, -z), (x, y, z), without=("left", "floor"))
    plaster = document.lambert("plaster", (0.74, 0.66, 0.52))
    document.add_mesh("walls", join(walls["right"], walls["back"], walls["front"]), plaster)
    document.add_mesh("ceiling", walls["ceiling"], document.lambert("ceiling", (0.78, 0.77, 0.74)))
    document.add_mesh("window wall", pierced((-x, 0.0), z, y, ((-1.9, -0.5, 0.75, 2.35), (0.4, 1.8, 0.75, 2.35)), 0.18),
                      plaster)
    bars = [box((-x - 0.1, 0.75, at - 0.02), (-x - 0.06, 2.35, at + 0.02)) for at in (-1.2, 1.1)]
    bars += [box((-x - 0.1, 1.53, a), (-x - 0.061, 1.57, b))
             for a, b in ((-1.9, -1.221), (-1.179, -0.5), (0.4, 1.079), (1.121, 1.8))]
    document.add_mesh("window bars", join(*bars), document.lambert("paint", (0.8, 0.8, 0.78)))
    planks = [box((-x + 0.2 * i, -0.02, -z), (-x + 0.2 * (i + 1) - 0.004, 0.0, z)) for i in range(26)]
    for k, tint in enumerate(((0.36, 0.2, 0.1), (0.42, 0.25, 0.13), (0.31, 0.17, 0.085))):
        document.add_mesh(f"planks {k + 1}", join(*planks[k::3]), document.lambert(f"wood {k + 1}", tint))
    document.add_mesh("thin wall", box((1.35, 0.001, -2.999), (1.37, 2.1, -1.5)),
                      document.lambert("screen", (0.2, 0.36, 0.3)))
    document.add_mesh("skirting", join(box((-x + 0.001, 0.001, -z + 0.001), (1.345, 0.12, -z + 0.02)),
                                       box((x - 0.02, 0.001, -2.9), (x - 0.001, 0.12, z - 0.01))),
                      document.lambert("skirting", (0.75, 0.74, 0.7)))
    table(document)
    chandelier(document, (0.0, 1.75, 0.0), y)
    frame = join(*[box(low, high) for low, high in (
        ((-1.0, 1.1, -z + 0.001), (0.6, 1.16, -z + 0.05)), ((-1.0, 2.14, -z + 0.001), (0.6, 2.2, -z + 0.05)),
        ((-1.0, 1.161, -z + 0.001), (-0.94, 2.139, -z + 0.05)), ((0.54, 1.161, -z + 0.001), (0.6, 2.139, -z + 0.05)))])
    document.add_mesh("mirror's frame", frame, document.metal("gilt", (1.0, 0.78, 0.36), 0.35))
    document.add_mesh("mirror", quad((-0.2, 1.65, -z + 0.02), (0.74, 0.0, 0.0), (0.0, 0.489, 0.0)),
                      document.mirror("silver", (0.9, 0.9, 0.88)))
    document.add_light("directional", (24.0, 21.0, 16.0), direction=(0.7, -0.75, -0.2), name="sun")
    document.add_mesh("sky", quad((-x - 1.6, 1.35, 0.6), (0.0, 1.2, 0.0), (0.0, 0.0, 4.6)),
                      document.emitter("sky", (3.0, 3.7, 4.8)))
    document.add_camera(Camera((1.75, 1.75, 2.85), (-0.28, 0.9, -0.6), math.radians(48.0), (4, 3)))
    return document


def table(document):
    """Round table with a cloth, six chairs, plates and glasses."""
    radius, top = 0.82, 0.75
    document.add_mesh("table", lathe([(0.0, 0.001), (0.28, 0.001), (0.26, 0.05), (0.06, 0.09), (0.055, 0.6), (0.2, 0.7),
                                      (0.0, 0.7)], 24), document.coated("mahogany", (0.2, 0.07, 0.035), 0.3))
    cloth = lathe([(radius + 0.06, top - 0.2), (radius + 0.03, top - 0.08), (radius + 0.012, top - 0.02), (radius, top),
                   (0.0, top)], 96)

    def fold(p):
        drop = max(0.0, (top - 0.02 - p[1]) / 0.18)
        wide = 1.0 + 0.035 * drop * math.sin(16.0 * math.atan2(p[2], p[0]))
        return p[0] * wide, p[1], p[2] * wide

    document.add_mesh("cloth", cloth._replace(positions=[fold(p) for p in cloth.positions]),
                      document.lambert("linen", (0.8, 0.79, 0.75)))
    around = [60.0 * i + 30.0 for i in range(6)]

    def at(distance, angle, height, turn=0.0):
        a = math.radians(angle)
        return place((distance * math.sin(a), height, distance * math.cos(a)), yaw=angle + turn)

    plate = lathe([(0.0, 0.0), (0.075, 0.0), (0.125, 0.016), (0.127, 0.018), (0.124, 0.0185), (0.08, 0.006),
                   (0.0, 0.005)], 32)
    document.add_mesh("plate", plate, document.coated("china", (0.78, 0.78, 0.76), 0.2),
                      [at(0.6, a, top + 0.0005) for a in around])
    glass = lathe([(0.0, 0.0), (0.026, 0.0), *spline([(0.027, 0.003), (0.031, 0.05), (0.036, 0.11)], 3),
                   *spline([(0.0345, 0.11), (0.0295, 0.05), (0.025, 0.008)], 3), (0.0, 0.007)], 24)
    document.add_mesh("tumbler", glass, document.glass("glass", 1.5),
                      [at(0.46, a - 17.0, top + 0.0005) for a in around])
    fruit = sphere((0.0, 0.0, 0.0), 0.04, 4)
    bowl = lathe([(0.0, 0.0), (0.06, 0.0), (0.07, 0.01), *arc((0.0, 0.127), 0.14, -50.0, -15.0, 5),
                  *arc((0.0, 0.127), 0.134, -15.0, -80.0, 8), (0.0, 0.006)], 32)
    document.add_mesh("bowl", bowl, document.metal("silver", (0.95, 0.93, 0.88), 0.25),
                      [place((0.0, top + 0.0005, 0.0))])
    for name, tint, spots in (("orange", (0.85, 0.32, 0.03), ((0.05, 0.06, 0.0), (-0.05, 0.062, 0.03))),
                              ("apple", (0.55, 0.06, 0.03), ((0.0, 0.065, -0.06), (0.0, 0.125, 0.0)))):
        document.add_mesh(name, fruit, document.coated(name, tint, 0.35),
                          [place((px, top + py, pz)) for px, py, pz in spots])
    legs = [rod((sx * 0.19, 0.001, 0.19), (sx * 0.18, 0.44, 0.18), 0.018, 6) for sx in (-1, 1)]
    legs += [rod((sx * 0.19, 0.001, -0.2), (sx * 0.18, 0.95, -0.23), 0.018, 6) for sx in (-1, 1)]
    slats = [box((-0.18, h, -0.235), (0.18, h + 0.06, -0.215)) for h in (0.6, 0.73, 0.86)]
    seat = box((-0.21, 0.44, -0.21), (0.21, 0.475, 0.21))
    document.add_mesh("chair", join(*[leg._replace(normals=None) for leg in legs], *slats, seat),
                      document.lambert("beech", (0.3, 0.14, 0.06)), [at(1.02, a, 0.0, 180.0) for a in around])


def chandelier(document, center, ceiling):
    """Eight small lamps on a brass ring."""
    brass = document.metal("brass", (0.91, 0.78, 0.42), 0.3)
    ring = torus(0.42, 0.014, 48, 8)
    document.add_mesh("ring", ring, brass, [place(center)])
    arms = [(0.42 * math.cos(a), 0.42 * math.sin(a)) for a in (math.pi * i / 4.0 for i in range(8))]
    rods = [rod((0.0, 0.34, 0.0), (ax, 0.012, az), 0.006, 6) for ax, az in arms[::2]]
    rods += [rod((0.0, 0.33, 0.0), (0.0, ceiling - center[1], 0.0), 0.01, 8)]
    rods += [moved(cylinder(0.03, 0.012, 12), (ax, 0.012, az)) for ax, az in arms]
    document.add_mesh("arms", join(*rods), brass, [place(center)])
    document.add_mesh("candle", cylinder(0.014, 0.09, 12), document.lambert("wax", (0.8, 0.76, 0.66)),
                      [place((center[0] + ax, center[1] + 0.0245, center[2] + az)) for ax, az in arms])
    document.add_mesh("bulb", sphere((0.0, 0.0, 0.0), 0.034, 3), document.emitter("bulb", (80.0, 57.0, 32.0)),
                      [place((center[0] + ax, center[1] + 0.149, center[2] + az)) for ax, az in arms])
