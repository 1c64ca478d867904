"""Pinhole camera: the rays of a picture."""

import math

from .vector import add, cross, normalize, scale, sub


class Camera:
    """At `position`, looks at `target`; `yfov` in rad; `size` = (width, height) of the picture the answers are for."""

    def __init__(self, position, target, yfov, size, up=(0.0, 1.0, 0.0)):
        self.position, self.yfov, self.size = position, yfov, size
        self.aspect = size[0] / size[1]
        self.back = normalize(sub(position, target))
        self.right = normalize(cross(up, self.back))
        self.up = cross(self.back, self.right)

    def ray(self, x, y):
        """Unit direction through the film at (x, y) in pixels, (0, 0) the upper left corner of the picture."""
        half = math.tan(self.yfov / 2.0)
        u = (2.0 * x / self.size[0] - 1.0) * half * self.aspect
        v = (1.0 - 2.0 * y / self.size[1]) * half
        return normalize(sub(add(scale(self.right, u), scale(self.up, v)), self.back))
