"""Three scenes of boxes: Cornell, Box and Torus."""

import math

from .camera import Camera
from .document import Document, place
from .shapes import box, join, quad, sphere, square_towards
from .solids import cylinder, lathe, moved, room, torus as ring_of
from .studio import sweep

WHITE, RED, GREEN = (0.73, 0.71, 0.68), (0.57, 0.06, 0.05), (0.12, 0.42, 0.11)


def cornell():
    """A mirror and a glass sphere in the Cornell box."""
    document = Document("A mirror and a glass sphere in a box with a red and a green wall, under a square lamp.",
                        "Cornell")
    walls = room((-1.33, 0.0, -1.0), (1.33, 2.0, 1.0))
    document.add_mesh("walls", join(walls["floor"], walls["ceiling"], walls["back"]), document.lambert("white", WHITE))
    document.add_mesh("left wall", walls["left"], document.lambert("red", RED))
    document.add_mesh("right wall", walls["right"], document.lambert("green", GREEN))
    ball = sphere((0.0, 0.0, 0.0), 0.4, 12)
    document.add_mesh("mirror sphere", ball, document.mirror("silver", (0.95, 0.94, 0.92)),
                      [place((-0.56, 0.401, -0.4))])
    document.add_mesh("glass sphere", ball, document.glass("glass", 1.5), [place((0.52, 0.401, 0.28))])
    document.add_mesh("lamp", quad((0.0, 1.999, 0.0), (0.3, 0.0, 0.0), (0.0, 0.0, 0.25)),
                      document.emitter("lamp", (24.0, 20.5, 16.0)))
    document.add_camera(Camera((0.0, 1.0, 4.25), (0.0, 1.0, 0.0), math.radians(34.0), (4, 3)))
    return document


def box_scene():
    """A mirror and a glass box under two tiny lights, each in a fixture with a mirror behind it and glass before it."""
    document = Document("A mirror box and a glass box in a room that is lit by two tiny lights, each between the "
                        "paraboloid mirror and the glass of a fixture.", "Box")
    walls = room((-1.3, 0.0, -1.2), (1.3, 1.9, 2.6))
    document.add_mesh("walls", join(walls["floor"], walls["ceiling"], walls["back"], walls["front"]),
                      document.lambert("plaster", (0.72, 0.7, 0.66)))
    document.add_mesh("left wall", walls["left"], document.lambert("ochre", (0.68, 0.36, 0.1)))
    document.add_mesh("right wall", walls["right"], document.lambert("blue", (0.12, 0.25, 0.5)))
    document.add_mesh("mirror box", moved(box((-0.28, 0.001, -0.28), (0.28, 1.05, 0.28)), (-0.5, 0.0, -0.45), 22.0),
                      document.mirror("silver", (0.93, 0.92, 0.9)))
    document.add_mesh("glass box", moved(box((-0.27, 0.001, -0.27), (0.27, 0.54, 0.27)), (0.42, 0.0, 0.35), -24.0),
                      document.glass("glass", 1.5))
    fixture(document, [place((-0.75, 1.78, 0.55), yaw=60.0, pitch=-24.0),
                       place((0.85, 1.78, -0.3), yaw=-30.0, pitch=-20.0)])
    document.add_camera(Camera((0.0, 1.0, 2.55), (0.0, 0.86, 0.0), math.radians(52.0), (4, 3)))
    return document


def fixture(document, places):
    """A lamp that shines down: a cube of 16 mm in the focus (40 mm) of a mirror, behind a pane of glass."""
    focus, rim = 0.04, 0.11
    depth = rim * rim / (4.0 * focus)
    radii = [rim * i / 12 for i in range(13)]
    mirror = lathe([(r, -r * r / (4.0 * focus)) for r in radii], 32)
    shell = lathe([(0.0, 0.004), (rim + 0.002, 0.004), (rim + 0.002, -depth - 0.03), (rim + 0.01, -depth - 0.03),
                   (rim + 0.01, 0.014), (0.0, 0.014)], 32)
    document.add_mesh("reflector", mirror, document.mirror("reflector", (0.9, 0.9, 0.9)), places)
    document.add_mesh("housing", shell, document.lambert("enamel", (0.1, 0.1, 0.1)), places)
    document.add_mesh("pane", moved(cylinder(rim + 0.006, 0.008, 32), (0.0, -depth - 0.018, 0.0)),
                      document.glass("pane", 1.5), places)
    document.add_mesh("light", box((-0.008, -focus - 0.008, -0.008), (0.008, -focus + 0.008, 0.008)),
                      document.emitter("light", (4600.0, 4050.0, 3300.0)), places)


def torus():
    """A diffuse torus inside a glass cube, lit from outside: everything one sees of it came and goes through glass."""
    document = Document("A diffuse torus inside a glass cube, lit from outside.", "Torus")
    document.add_mesh("backdrop", sweep(14.0, 9.0, 3.2, 6.0), document.lambert("paper", (0.66, 0.68, 0.7)))
    document.add_mesh("cube", moved(box((-1.0, 0.001, -1.0), (1.0, 2.001, 1.0)), (0.0, 0.0, 0.0), 33.0),
                      document.glass("glass", 1.5))
    document.add_mesh("torus", ring_of(0.56, 0.24, 64, 28), document.lambert("coral", (0.85, 0.36, 0.14)),
                      [place((0.0, 1.0, 0.0), yaw=38.0, pitch=62.0)])
    document.add_mesh("lamp", square_towards((-3.4, 5.2, 2.4), (0.0, 0.8, 0.0), 1.0),
                      document.emitter("lamp", (95.0, 88.0, 78.0)))
    document.add_mesh("fill", square_towards((4.5, 3.5, 5.5), (0.0, 1.0, 0.0), 3.0),
                      document.emitter("fill", (1.1, 1.3, 1.6)))
    document.add_camera(Camera((0.0, 2.9, 6.2), (0.0, 0.92, 0.0), math.radians(32.0), (4, 3)))
    return document
