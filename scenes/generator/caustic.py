"""The picture of the README: a glass sphere and a gold ring in a small room under a small square lamp."""

import math

from .camera import Camera
from .document import Document
from .shapes import join, quad, ring, sphere, square_towards


def caustic():
    """A Document; the picture has no closed form."""
    document = Document("A glass sphere and a gold ring on the floor of a small room, under a small square lamp.")
    x, y, z = 1.5, 2.6, 1.4  # the room: half width, height, half depth
    floor = quad((0.0, 0.0, 0.0), (0.0, 0.0, z), (x, 0.0, 0.0))
    ceiling = quad((0.0, y, 0.0), (x, 0.0, 0.0), (0.0, 0.0, z))
    back = quad((0.0, y / 2.0, -z), (x, 0.0, 0.0), (0.0, y / 2.0, 0.0))
    left = quad((-x, y / 2.0, 0.0), (0.0, y / 2.0, 0.0), (0.0, 0.0, z))
    right = quad((x, y / 2.0, 0.0), (0.0, 0.0, z), (0.0, y / 2.0, 0.0))
    document.add_mesh("room", join(floor, ceiling, back), document.lambert("plaster", (0.75, 0.73, 0.7)))
    document.add_mesh("left wall", left, document.lambert("brick", (0.62, 0.2, 0.12)))
    document.add_mesh("right wall", right, document.lambert("teal", (0.1, 0.36, 0.42)))
    document.add_mesh("sphere", sphere((-0.5, 0.34, 0.5), 0.34, 14), document.glass("glass", 1.5))
    document.add_mesh("ring", ring((0.45, 0.0, -0.25), 0.5, 0.54, 0.24, 192, 6),
                      document.mirror("gold", (1.0, 0.78, 0.36)))
    # Low enough for the ring's cardioid; turned up a little, so that the floor next to it stays dark.
    document.add_mesh("lamp", square_towards((-1.35, 1.35, 0.75), (0.9, 0.4, -0.2), 0.14),
                      document.emitter("lamp", (560.0, 500.0, 420.0)))
    document.add_camera(Camera((0.0, 2.9, 3.3), (0.0, 0.2, 0.0), math.radians(31.0), (4, 3)))
    return document
