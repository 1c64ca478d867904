"""Still lifes on a backdrop: Diamond, Glass and Clocks."""

import math

from .camera import Camera
from .document import Document, place
from .shapes import join, square_towards
from .solids import arc, convex, lathe, moved, ribbon, spline


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
    document.add_mesh("backdrop", sweep(2.4, 1.2, 0.9, 0.9, 0.3), document.lambert("cloth", (0.5, 0.42, 0.36)))
    vessel, drink = wine_glass()
    places = [place((-0.09, 0.0005, 0.02)), place((0.0, 0.0005, -0.08)), place((0.085, 0.0005, 0.0))]
    document.add_mesh("wine glass", vessel, document.glass("glass", 1.5), places)
    document.add_mesh("wine", drink, document.glass("red wine", 1.34, ((0.5, 0.03, 0.05), 0.02)), places[:1])
    document.add_mesh("lamp", square_towards((-0.28, 0.5, -0.62), (0.0, 0.05, 0.0), 0.07),
                      document.emitter("lamp", (430.0, 385.0, 320.0)))
    document.add_mesh("window", square_towards((0.75, 0.6, 0.25), (0.0, 0.12, 0.0), 0.35),
                      document.emitter("window", (3.4, 3.9, 4.6)))
    document.add_camera(Camera((0.0, 0.33, 0.6), (0.0, 0.075, 0.02), math.radians(31.0), (4, 3)))
    return document
