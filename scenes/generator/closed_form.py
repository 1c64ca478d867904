"""Scenes whose picture is known in closed form. Each function returns (Document, Expectation)."""

import math

from . import radiometry
from .camera import Camera
from .document import Document
from .expectation import Expectation
from .shapes import box, flip, quad, sphere
from .vector import add, dot, normalize, scale, sub

UP = (0.0, 1.0, 0.0)
DOWN = (0.0, -1.0, 0.0)


def furnace():
    """Every facet of a closed sphere reflects rho and emits Le inward: Le / (1 - rho) wherever one looks."""
    rho, radiance = (0.3, 0.5, 0.7), (0.35, 0.3, 0.3)
    camera = Camera((0.2, 0.1, 0.3), (-0.4, -0.2, -1.0), math.radians(80.0), (64, 64))
    document = Document("White furnace: a closed diffuse sphere, flat facets, that emits inward.")
    document.add_mesh("furnace", flip(sphere((0.0, 0.0, 0.0), 1.0, 8, smooth=False)),
                      document.lambert("furnace", rho, radiance))
    document.add_camera(camera)
    expected = Expectation(
        "L = Le / (1 - rho), Le = (0.35, 0.3, 0.3), rho = (0.3, 0.5, 0.7), in every pixel",
        camera, lambda direction: [e / (1.0 - r) for e, r in zip(radiance, rho)],
        sampled=(64, 16384), gathered=(64, 16384))
    quadrants(expected, camera)
    return document, expected


def point_plane():
    """A point light over a Lambert plane."""
    half, rho, intensity, light = 4.0, (0.8, 0.6, 0.4), (10.0, 20.0, 45.0), (-0.8, 2.5, 0.5)
    camera = Camera((0.0, 7.0, 3.5), (0.0, 0.0, 0.2), math.radians(28.0), (64, 64))
    document = Document("A point light over a Lambert plane.")
    document.add_mesh("plane", floor(half), document.lambert("plane", rho))
    document.add_light("point", intensity, position=light)
    document.add_camera(camera)

    def radiance(direction):
        point = on_floor(camera, direction, half)
        return [r / math.pi * radiometry.point_irradiance(i, light, point, UP) for r, i in zip(rho, intensity)]

    expected = Expectation(
        "L = rho/pi I cos(theta) / r^2, theta and r at the plane's point from the light at (-0.8, 2.5, 0.5), "
        "I = (10, 20, 45) W/sr, rho = (0.8, 0.6, 0.4), plane y = 0",
        camera, radiance, sampled=(16, 1024), gathered=(80, 131072))
    quadrants(expected, camera)
    return document, expected


def spot_plane():
    """A spot light over a Lambert plane, in its core and in its falloff."""
    half, rho, intensity = 4.0, (0.5, 0.7, 0.9), (40.0, 30.0, 20.0)
    light, target = (1.0, 4.0, 0.6), (0.1, 0.0, 0.0)
    inner, outer = math.radians(12.0), math.radians(35.0)
    axis = normalize(sub(target, light))
    camera = Camera((0.0, 7.0, 3.5), (0.0, 0.0, 0.2), math.radians(28.0), (64, 64))
    document = Document("A spot light over a Lambert plane.")
    document.add_mesh("plane", floor(half), document.lambert("plane", rho))
    document.add_light("spot", intensity, position=light, direction=axis, cones=(inner, outer))
    document.add_camera(camera)

    def radiance(direction):
        point = on_floor(camera, direction, half)
        falloff = radiometry.spot_falloff(dot(axis, normalize(sub(point, light))), inner, outer)
        return [r / math.pi * falloff * radiometry.point_irradiance(i, light, point, UP)
                for r, i in zip(rho, intensity)]

    expected = Expectation(
        "L = rho/pi I s cos(theta) / r^2 with s = clamp((cos(d) - cos(outer)) / (cos(inner) - cos(outer)), 0, 1)^2, "
        "d the angle off the axis from (1, 4, 0.6) to (0.1, 0, 0), inner 12 and outer 35 degrees, "
        "I = (40, 30, 20) W/sr, rho = (0.5, 0.7, 0.9), plane y = 0",
        camera, radiance, sampled=(16, 1024), gathered=(64, 65536))
    expected.add_region("core", (24, 40), (24, 40))
    expected.add_region("falloff left", (12, 24), (20, 44))
    expected.add_region("falloff above", (20, 44), (12, 24))
    expected.add_region("falloff right", (40, 52), (20, 44))
    return document, expected


def directional_plane():
    """A directional light on a Lambert plane."""
    half, rho, irradiance = 2.0, (0.9, 0.5, 0.2), (2.0, 3.0, 4.0)
    travels = normalize((0.6, -0.7, -0.4))
    camera = Camera((0.5, 3.5, 2.5), (0.0, 0.0, 0.1), math.radians(24.0), (64, 64))
    document = Document("A directional light on a Lambert plane.")
    document.add_mesh("plane", floor(half), document.lambert("plane", rho))
    document.add_light("directional", irradiance, direction=travels)
    document.add_camera(camera)

    def radiance(direction):
        on_floor(camera, direction, half)
        return [r / math.pi * e * dot(UP, scale(travels, -1.0)) for r, e in zip(rho, irradiance)]

    expected = Expectation(
        "L = rho/pi E cos(theta), E = (2, 3, 4) W/m^2 across the light that travels along (0.6, -0.7, -0.4), "
        "rho = (0.9, 0.5, 0.2), plane y = 0",
        camera, radiance, sampled=(16, 1024), gathered=(40, 131072))
    quadrants(expected, camera)
    return document, expected


def square_light():
    """A square emitter over a Lambert plane: its form factor, unoccluded."""
    half, rho, emitted, center, side = 3.0, (0.5, 0.6, 0.7), (4.0, 5.0, 6.0), (-0.6, 2.0, 0.4), 1.0
    camera = Camera((0.0, 4.5, 5.5), (0.0, 0.0, 0.4), math.radians(19.0), (64, 64))
    square = quad(center, (side / 2.0, 0.0, 0.0), (0.0, 0.0, side / 2.0))
    document = Document("A square emitter over a Lambert plane.")
    document.add_mesh("plane", floor(half), document.lambert("plane", rho))
    document.add_mesh("light", square, document.emitter("light", emitted))
    document.add_camera(camera)

    def radiance(direction):
        point = on_floor(camera, direction, half)
        return [r / math.pi * radiometry.polygon_irradiance(e, square.positions, point, UP)
                for r, e in zip(rho, emitted)]

    expected = Expectation(
        "L = rho Le F, F the form factor from the plane's point to the 1 m square at height 2 m around (-0.6, 2, 0.4) "
        "(Lambert's polygon formula), Le = (4, 5, 6), rho = (0.5, 0.6, 0.7), plane y = 0",
        camera, radiance, sampled=(16, 1024), gathered=(192, 65536))
    quadrants(expected, camera)
    return document, expected


def mirror():
    """A tinted mirror as the floor of a closed room whose walls and ceiling emit and do not reflect."""
    base, emitted = (0.9, 0.5, 0.2), (0.6, 0.8, 1.0)
    camera = Camera((0.0, 0.4, 1.9), (0.0, 0.1, 0.0), math.radians(90.0), (64, 64))
    walls = box((-2.0, 0.0, -2.0), (2.0, 3.0, 2.0))
    walls = walls._replace(triangles=[t for t in walls.triangles if any(walls.positions[i][1] > 0.0 for i in t)])
    document = Document("A tinted mirror below uniformly emitting walls.")
    document.add_mesh("walls", flip(walls), document.emitter("walls", emitted))
    document.add_mesh("mirror", floor(2.0), document.mirror("mirror", base))
    document.add_camera(camera)

    def radiance(direction):
        if camera.position[1] + direction[1] * (camera.position[2] + 2.0) / -direction[2] > 0.0:
            return emitted  # the ray meets the back wall above the floor
        return [radiometry.schlick(b, -direction[1]) * e for b, e in zip(base, emitted)]

    expected = Expectation(
        "in the mirror L = F Le with F = b + (1 - b)(1 - cos(theta))^5, theta from the normal (0, 1, 0), "
        "b = (0.9, 0.5, 0.2), Le = (0.6, 0.8, 1); on the wall L = Le",
        camera, radiance, sampled=(16, 1024), gathered=(16, 1024))
    expected.add_region("wall", (16, 48), (2, 14))
    expected.add_region("mirror, grazing", (24, 40), (31, 34))
    expected.add_region("mirror, middle", (16, 48), (36, 40))
    expected.add_region("mirror, steep", (16, 48), (56, 64))
    return document, expected


def slab():
    """A clear glass slab between two emitting walls."""
    return _slab("A glass slab, face on, between two emitting walls.", None,
                 "L = T Lb + (1 - T) Lf with T = (1 - F) / (1 + F), all reflections between the faces")


def coloured_slab():
    """The same of glass that absorbs."""
    return _slab("A coloured glass slab, face on, between two emitting walls.", ((0.8, 0.5, 0.25), 0.3),
                 "L = T Lb + R Lf with T = (1 - F)^2 a / (1 - F^2 a^2), R = F + (1 - F)^2 F a^2 / (1 - F^2 a^2), all "
                 "reflections between the faces, a = c^(0.2 m / (0.3 m cos(theta'))) left on one way, "
                 "c = (0.8, 0.5, 0.25), theta' the angle inside")


def _slab(about, attenuation, formula):
    ior, thickness, behind, front = 1.5, 0.2, (1.0, 1.0, 0.4), (0.2, 1.0, 1.6)
    camera = Camera((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), math.radians(95.0), (96, 96))
    document = Document(about)
    document.add_mesh("slab", box((-4.0, -4.0, -thickness), (4.0, 4.0, 0.0)),
                      document.glass("glass", ior, attenuation))
    document.add_mesh("behind", quad((0.0, 0.0, -1.0), (12.0, 0.0, 0.0), (0.0, 12.0, 0.0)),
                      document.emitter("behind", behind))
    document.add_mesh("front", quad((0.0, 0.0, 2.0), (0.0, 12.0, 0.0), (12.0, 0.0, 0.0)),
                      document.emitter("front", front))
    document.add_camera(camera)

    def radiance(direction):
        values = [radiometry.slab(ior, -direction[2], a) for a in left_of(attenuation, thickness, ior, -direction[2])]
        return [t * b + r * f for (t, r), b, f in zip(values, behind, front)]

    expected = Expectation(
        formula + ", F the exact Fresnel reflectance of unpolarised light at the pixel's angle, ior 1.5, "
        "Lb = (1, 1, 0.4) behind, Lf = (0.2, 1, 1.6) on the camera's side",
        camera, radiance, sampled=(160, 1024), gathered=(96, 1024))
    expected.add_region("centre", (32, 64), (32, 64))
    expected.add_region("left", (0, 32), (32, 64))
    expected.add_region("lower right", (64, 96), (64, 96))
    return document, expected


def slab_floor():
    """Sunlight through a clear glass slab onto a Lambert floor."""
    return _slab_floor("Sunlight through a glass slab onto a Lambert floor.", None,
                       "L = rho/pi E cos(60 deg) T with T = (1 - F) / (1 + F)")


def coloured_slab_floor():
    """The same through glass that absorbs."""
    return _slab_floor("Sunlight through a coloured glass slab onto a Lambert floor.", ((0.8, 0.5, 0.25), 0.3),
                       "L = rho/pi E cos(60 deg) T with T = (1 - F)^2 a / (1 - F^2 a^2), "
                       "a = c^(0.2 m / (0.3 m cos(theta'))) left on one way, c = (0.8, 0.5, 0.25), "
                       "theta' the angle inside")


def _slab_floor(about, attenuation, formula):
    """Light that falls at 60 degrees through a slab.

    The slab stands aside by what the slanted light travels: its light covers the whole floor, and what the floor gets
    back from the slab is only what its side faces return, 1e-4 of the sun.
    """
    ior, thickness, half, rho, irradiance = 1.5, 0.2, 1.0, (0.8, 0.6, 0.4), (4.0, 5.0, 6.0)
    angle = math.radians(60.0)
    travels = (-math.sin(angle), -math.cos(angle), 0.0)
    camera = Camera((-1.0, 3.2, 0.0), (0.0, 0.0, 0.0), math.radians(20.0), (64, 64))
    document = Document(about)
    document.add_mesh("floor", floor(half), document.lambert("floor", rho))
    document.add_mesh("slab", box((2.2, 2.0, -1.2), (5.3, 2.0 + thickness, 1.2)),
                      document.glass("glass", ior, attenuation))
    document.add_light("directional", irradiance, direction=travels)
    document.add_camera(camera)

    def radiance(direction):
        on_floor(camera, direction, half)
        left = left_of(attenuation, thickness, ior, math.cos(angle))
        return [r / math.pi * e * math.cos(angle) * radiometry.slab(ior, math.cos(angle), a)[0]
                for r, e, a in zip(rho, irradiance, left)]

    expected = Expectation(
        formula + ", F the exact Fresnel reflectance at 60 degrees, ior 1.5, E = (4, 5, 6) W/m^2 across the light, "
        "rho = (0.8, 0.6, 0.4), floor y = 0",
        camera, radiance, sampled=(128, 65536), gathered=(192, 65536))
    expected.add_region("floor", (0, 64), (0, 64))
    return document, expected


def left_of(attenuation, thickness, ior, cosine):
    """rgb that absorption leaves of light on one way through the slab."""
    return radiometry.absorbed_once(attenuation, thickness, ior, cosine) if attenuation else (1.0, 1.0, 1.0)


# -- shared ----------------------------------------------------------------------------------------------------


def floor(half):
    """Square of that half size in y = 0 that faces up."""
    return quad((0.0, 0.0, 0.0), (0.0, 0.0, half), (half, 0.0, 0.0))


def on_floor(camera, direction, half):
    """Where the ray meets y = 0: far from the floor's edges, where photon density estimation has no boundary bias."""
    point = add(camera.position, scale(direction, -camera.position[1] / direction[1]))
    assert max(abs(point[0]), abs(point[2])) < 0.7 * half, point
    return point


def quadrants(expected, camera):
    """The four quarters of the picture."""
    width, height = camera.size
    for name, x, y in (("upper left", 0, 0), ("upper right", 1, 0), ("lower left", 0, 1), ("lower right", 1, 1)):
        expected.add_region(name, (x * width // 2, (x + 1) * width // 2), (y * height // 2, (y + 1) * height // 2))
