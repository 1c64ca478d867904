"""Still lifes on a backdrop: Diamond, Glass and Clocks."""

import math

from .camera import Camera
from .document import Document, place
from .shapes import box, join, sphere, square_towards
from .solids import arc, convex, lathe, mapped, moved, ribbon, rod, spline, torus


def sweep(width, front, back, height, radius=1.5):
    """A photographer's backdrop: from z = front on the floor to z = -back, there round and up to `height`."""
    curve = arc((back - radius, radius), radius, -90.0, 0.0, 12)
    return moved(ribbon([(-front, 0.0), *curve, (back, height)], width), (0.0, 0.0, 0.0), 90.0)


def brilliant():
    """The round brilliant cut: 57 facets and a girdle of 16, around +y, the girdle's radius 1 in y = 0.

    Table 55 %, crown 34.5 and pavilion 40.75 degrees, stars half way, lower halves 78 %: the facets of a kind meet in
    points, from which their angles follow.
    """
    crown, pavilion, table, thick = math.radians(34.5), math.radians(40.75), 0.55, 0.02
    eighth = math.pi / 8.0
    corner = 1.0 / math.cos(eighth / 2.0)  # distance of the girdle's corners from the axis

    def ring(count, first, slope, distance, height, sign):
        """Facets at `slope` (rad) that pass the `distance` and `height` straight above their azimuth."""
        out, up = math.sin(slope), sign * math.cos(slope)
        azimuths = (first + 2.0 * math.pi * i / count for i in range(count))
        return [((out * math.cos(a), up, out * math.sin(a)), out * distance + up * height) for a in azimuths]

    top = thick + (corner - table) * math.tan(crown)
    star_foot = table * math.cos(eighth)
    star_tip = (star_foot + 1.0) / 2.0
    tip_height = thick + (corner - star_tip * math.cos(eighth)) * math.tan(crown)
    star = math.atan2(top - tip_height, star_tip - star_foot)
    upper = math.atan2(tip_height - thick, 1.0 - star_tip * math.cos(eighth / 2.0))
    low_tip = 1.0 - 0.78
    low_height = (corner - low_tip * math.cos(eighth)) * math.tan(pavilion)
    lower = math.atan2(low_height, 1.0 - low_tip * math.cos(eighth / 2.0))
    return convex([((0.0, 1.0, 0.0), top), *ring(8, 0.0, crown, corner, thick, 1.0),
                   *ring(8, eighth, star, star_foot, top, 1.0), *ring(16, eighth / 2.0, upper, 1.0, thick, 1.0),
                   *ring(16, eighth / 2.0, math.pi / 2.0, 1.0, 0.0, 1.0),
                   *ring(8, 0.0, pavilion, corner, -thick, -1.0),
                   *ring(16, eighth / 2.0, lower, 1.0, -thick, -1.0)])


def diamond():
    """Brilliants on a diffuse ground."""
    document = Document("Brilliants (ior 2.42, dispersion of diamond) on a diffuse ground.", "Diamond")
    document.add_mesh("backdrop", sweep(18.0, 12.0, 4.5, 7.0), document.lambert("paper", (0.36, 0.38, 0.42)))
    lean = 40.75 + 8.0  # a stone that lies on its pavilion and girdle
    document.add_mesh("diamond", brilliant(), document.glass("diamond", 2.42, dispersion=20.0 / 55.3),
                      [place((-0.2, 0.84, 0.0), yaw=20.0, pitch=lean),
                       place((-1.75, 0.42, -1.0), yaw=-35.0, pitch=lean, size=0.5),
                       place((1.25, 0.246, 0.75), yaw=50.0, pitch=180.0, size=0.7)])
    for name, at, side, radiance in (("lamp", (-3.0, 5.5, -1.0), 0.7, (200.0, 190.0, 172.0)),
                                     ("window", (5.5, 4.0, 2.5), 2.6, (7.0, 8.2, 9.8)),
                                     ("strip", (-5.5, 3.0, 5.0), 1.4, (14.0, 12.0, 9.0)),
                                     ("softbox", (1.5, 7.5, 5.5), 1.8, (9.0, 9.0, 9.0))):
        document.add_mesh(name, square_towards(at, (0.0, 0.5, 0.0), side), document.emitter(name, radiance))
    document.add_camera(Camera((0.0, 3.2, 6.0), (-0.1, 0.62, 0.0), math.radians(30.0), (4, 3)))
    return document


def wine_glass():
    """(glass, wine) of 21 cm: closed solids of revolution that do not touch: between them are 0.2 mm of air."""
    outside = spline([(0.012, 0.0055), (0.0052, 0.014), (0.0042, 0.04), (0.0046, 0.074), (0.0105, 0.087),
                      (0.0275, 0.103), (0.0395, 0.13), (0.0405, 0.16), (0.034, 0.209)], 4)
    inside = spline([(0.0326, 0.209), (0.0389, 0.16), (0.0378, 0.131), (0.026, 0.1055), (0.011, 0.0945),
                     (0.0, 0.0925)], 4)
    foot = [(0.0, 0.001), (0.03, 0.0), (0.0345, 0.0002), (0.0352, 0.0012), (0.0338, 0.0022), (0.022, 0.0034)]
    glass = lathe([*foot, *outside, (0.0333, 0.2098), *inside], 48)
    surface = 0.131
    fill = [(r - 0.0002 if r > 0.0002 else 0.0, y + 0.0002) for r, y in reversed(inside) if y < surface - 0.0005]
    edge = 0.0376
    return glass, lathe([*fill, (edge, surface), (0.0, surface)], 48)


def glass():
    """Wine glasses and their caustics."""
    document = Document("Three wine glasses, one with wine, and their caustics on a table.", "Glass")
    document.add_mesh("backdrop", sweep(2.4, 1.2, 0.9, 0.9, 0.3), document.lambert("cloth", (0.56, 0.47, 0.4)))
    vessel, drink = wine_glass()
    places = [place((-0.09, 0.0005, 0.02)), place((0.0, 0.0005, -0.08)), place((0.085, 0.0005, 0.0))]
    document.add_mesh("wine glass", vessel, document.glass("glass", 1.5), places)
    document.add_mesh("wine", drink, document.glass("red wine", 1.34, ((0.5, 0.03, 0.05), 0.02)), places[:1])
    document.add_mesh("lamp", square_towards((-0.2, 0.38, -0.52), (0.0, 0.03, 0.0), 0.05),
                      document.emitter("lamp", (620.0, 560.0, 470.0)))
    document.add_mesh("window", square_towards((0.75, 0.6, 0.25), (0.0, 0.12, 0.0), 0.35),
                      document.emitter("window", (3.4, 3.9, 4.6)))
    document.add_camera(Camera((0.06, 0.34, 0.62), (0.02, 0.07, 0.04), math.radians(31.0), (4, 3)))
    return document


def clocks():
    """Alarm clocks: every face is lit and seen through its glass."""
    document = Document("Three alarm clocks: every face is lit and seen through its glass.", "Clocks")
    document.add_mesh("backdrop", sweep(2.4, 1.2, 0.7, 0.8, 0.25), document.lambert("wall", (0.42, 0.5, 0.52)))
    document.add_mesh("shelf", box((-0.5, 0.0005, -0.22), (0.5, 0.02, 0.22)),
                      document.lambert("oak", (0.45, 0.27, 0.13)))
    places = [place((-0.138, 0.0205, 0.03), yaw=24.0), place((0.01, 0.0205, -0.05), yaw=-6.0),
              place((0.145, 0.0205, 0.03), yaw=-27.0)]
    case, rim, glass, face = clock_solids()
    brass = document.metal("brass", (0.91, 0.78, 0.42), 0.25)
    for number, (at, tint) in enumerate(zip(places, ((0.55, 0.05, 0.04), (0.04, 0.2, 0.3), (0.7, 0.62, 0.45))), 1):
        document.add_mesh(f"case {number}", case, document.coated(f"enamel {number}", tint, 0.25), [at])
    document.add_mesh("face", face, document.lambert("face", (0.8, 0.78, 0.7)), places)
    ticks = [_on_face(box((-w, 0.046 - l, 0.0), (w, 0.046, 0.0008)), 30.0 * i)
             for i in range(12) for w, l in (((0.0022, 0.011) if i % 3 == 0 else (0.0011, 0.007)),)]
    ink = document.lambert("ink", (0.03, 0.03, 0.035))
    document.add_mesh("ticks", join(*ticks), ink, places)
    for number, (at, hour, minute) in enumerate(zip(places, (305.0, 62.0, 215.0), (60.0, 24.0, 300.0)), 1):
        hands = join(_on_face(box((-0.0022, -0.006, 0.0015), (0.0022, 0.026, 0.0023)), hour),
                     _on_face(box((-0.0015, -0.008, 0.003), (0.0015, 0.039, 0.0038)), minute))
        document.add_mesh(f"hands {number}", hands, ink, [at])
    document.add_mesh("rim", rim, brass, places)
    document.add_mesh("glass", glass, document.glass("glass", 1.5), places)
    bell = lathe([*arc((0.0, 0.0), 0.023, 0.0, 80.0, 8), (0.0, 0.023), ], 24)
    inner = lathe([(0.0, 0.0205), *arc((0.0, 0.0), 0.0205, 80.0, 0.0, 8), (0.023, 0.0)], 24)
    bells = [mapped(join(bell, inner), (side * 0.036, 0.128, 0.0), (0.8, -side * 0.6, 0.0), (side * 0.6, 0.8, 0.0),
                    (0.0, 0.0, 1.0)) for side in (-1, 1)]
    posts = [rod((side * 0.034, 0.118, 0.0), (side * 0.0465, 0.138, 0.0), 0.003, 8) for side in (-1, 1)]
    handle = mapped(torus(0.022, 0.0028, 32, 8), (0.0, 0.142, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
    document.add_mesh("bells", join(*bells, *posts, handle), brass, places)
    feet = [rod((side * 0.028, 0.024, 0.0), (side * 0.044, 0.003, 0.0), 0.005, 8) for side in (-1, 1)]
    balls = [moved(sphere((0.0, 0.0, 0.0), 0.0065, 3), (side * 0.0445, 0.0065, 0.0)) for side in (-1, 1)]
    document.add_mesh("feet", join(*feet, *balls), brass, places)
    document.add_mesh("lamp", square_towards((-0.42, 0.55, 0.5), (0.0, 0.08, 0.0), 0.22),
                      document.emitter("lamp", (38.0, 33.5, 27.0)))
    document.add_mesh("window", square_towards((0.8, 0.55, 0.5), (0.0, 0.08, 0.0), 0.45),
                      document.emitter("window", (1.6, 2.0, 2.6)))
    document.add_camera(Camera((0.03, 0.24, 0.6), (0.005, 0.086, 0.0), math.radians(31.0), (4, 3)))
    return document


def clock_solids():
    """(case, rim, glass, face) of a clock of 12 cm that looks along +z, its middle 7.5 cm up; the glass is bent."""
    def up(mesh):
        return mapped(mesh, (0.0, 0.075, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))
    case = lathe([(0.0, -0.03), (0.04, -0.03), *arc((0.045, -0.02), 0.01, -60.0, 0.0, 4), (0.055, 0.016),
                  (0.0505, 0.016), (0.0505, 0.004), (0.0, 0.004)], 48)
    rim = lathe(arc((0.0535, 0.018), 0.0042, 0.0, 360.0, 12)[:-1], 48, closed=True)
    outer = [(0.0515 * i / 8, 0.024 - 0.006 * (i / 8) ** 2) for i in range(9)]
    inner = [(r, h - 0.002) for r, h in outer]
    glass = lathe([*inner, *reversed(outer)], 48)
    face = lathe([(0.0502, 0.0042), (0.0, 0.0042)], 48)
    return up(case), up(rim), up(glass), up(face)


def _on_face(mesh, clockwise):
    """`mesh`, drawn on the clock's face at 12 o'clock around the origin, turned to its place."""
    c, s = math.cos(math.radians(clockwise)), math.sin(math.radians(clockwise))
    return mapped(mesh, (0.0, 0.075, 0.0052), (c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))
