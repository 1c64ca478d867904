"""Closed-form scenes of metals. Each function returns (Document, Expectation)."""

import math

from . import radiometry
from .camera import Camera
from .closed_form import on_floor
from .document import Document
from .expectation import Expectation
from .shapes import Mesh, box, flip, quad
from .vector import add, normalize, scale


def focus():
    """Sunlight that a paraboloid mirror sends through its focus onto a Lambert square behind it.

    The mirror y = r^2 / (4 f) sends light that falls along -y through (0, f, 0). In the plane y = f + s it arrives at
    rho = 4 f s r / (4 f^2 - r^2) on the other side of the axis. The ring of width dr carries E F 2 pi r dr and becomes
    one of width d rho, so that the irradiance there is E F r dr / (rho d rho) =
    E F (4 f^2 - r^2)^3 / (16 f^2 s^2 (4 f^2 + r^2)); the angle at the mirror has cos(theta) = 2 f / sqrt(4 f^2 + r^2).
    Only a piece of the mirror aside from the square's shadow is there.
    """
    f, s, base, irradiance, rho = 1.0, 0.5, (0.9, 0.6, 0.3), (3.0, 4.0, 5.0), (0.4, 0.4, 0.4)
    square = quad((-0.72, f + s, 0.0), (0.5, 0.0, 0.0), (0.0, 0.0, 0.4))  # faces down
    camera = Camera((-0.71, 0.2, 0.0), (-0.71, f + s, 0.0), math.radians(11.5), (64, 64), up=(0.0, 0.0, 1.0))
    document = Document("Sunlight that a piece of a paraboloid mirror sends through its focus onto a Lambert square.")
    document.add_mesh("paraboloid", paraboloid(f, (0.7, 1.3), (-0.3, 0.3), 32), document.mirror("mirror", base))
    document.add_mesh("square", square, document.lambert("square", rho))
    document.add_light("directional", irradiance, direction=(0.0, -1.0, 0.0))
    document.add_camera(camera)

    def radiance(direction):
        point = add(camera.position, scale(direction, (f + s - camera.position[1]) / direction[1]))
        away = math.hypot(point[0], point[2])
        r = 2.0 * f * (math.sqrt(s * s + away * away) - s) / away
        focused = (4.0 * f * f - r * r) ** 3 / (16.0 * f * f * s * s * (4.0 * f * f + r * r))
        cosine = 2.0 * f / math.sqrt(4.0 * f * f + r * r)
        return [p / math.pi * e * radiometry.schlick(b, cosine) * focused for p, e, b in zip(rho, irradiance, base)]

    expected = Expectation(
        "L = rho/pi E F (4 f^2 - r^2)^3 / (16 f^2 s^2 (4 f^2 + r^2)), F = b + (1 - b)(1 - cos(theta))^5, "
        "cos(theta) = 2 f / sqrt(4 f^2 + r^2), r the distance from the axis at which the mirror y = r^2 / (4 f) was "
        "met by light that arrives at the pixel's point: 2 f (sqrt(s^2 + d^2) - s) / d, d its distance from the axis "
        "in the plane y = f + s; f = 1 m, s = 0.5 m, E = (3, 4, 5) W/m^2 along -y, b = (0.9, 0.6, 0.3), rho = 0.4",
        camera, radiance, sampled=(128, 131072), gathered=(256, 131072))
    expected.add_region("nearer the focus", (32, 64), (0, 64))
    expected.add_region("further from it", (0, 32), (0, 64))
    return document, expected


def paraboloid(f, xs, zs, steps):
    """Piece of y = (x^2 + z^2) / (4 f), front and smooth normals upwards."""
    mesh = Mesh([], [], [])
    for j in range(steps + 1):
        for i in range(steps + 1):
            x, z = (low + (high - low) * k / steps for (low, high), k in ((xs, i), (zs, j)))
            mesh.positions.append((x, (x * x + z * z) / (4.0 * f), z))
            mesh.normals.append(normalize((-x / (2.0 * f), 1.0, -z / (2.0 * f))))
    for j in range(steps):
        for i in range(steps):
            a = j * (steps + 1) + i
            b, c, d = a + 1, a + steps + 2, a + steps + 1
            mesh.triangles.extend([(a, c, b), (a, d, c)])
    return mesh


def rough_metal():
    """Two plates of rough metal as the floor of a closed room whose walls and ceiling emit and do not reflect."""
    base, emitted, roughness = (0.9, 0.5, 0.2), (0.6, 0.8, 1.0), (0.5, 0.8)
    camera = Camera((0.0, 1.5, 1.75), (0.0, 0.0, -0.05), math.radians(30.0), (64, 64))
    walls = box((-2.0, 0.0, -2.0), (2.0, 2.2, 2.0))
    walls = walls._replace(triangles=[t for t in walls.triangles if any(walls.positions[i][1] > 0.0 for i in t)])
    document = Document("Two plates of rough metal below uniformly emitting walls.")
    document.add_mesh("walls", flip(walls), document.emitter("walls", emitted))
    for name, side, rough in (("left plate", -1.0, roughness[0]), ("right plate", 1.0, roughness[1])):
        document.add_mesh(name, quad((side, 0.0, 0.0), (0.0, 0.0, 2.0), (1.0, 0.0, 0.0)),
                          document.metal(name, base, rough))
    document.add_camera(camera)
    albedo = [interpolated(lambda c, alpha=rough * rough: radiometry.rough_metal_albedo(alpha, c), 0.4, 0.9, 10)
              for rough in roughness]

    def radiance(direction):
        on_floor(camera, direction, 2.0)
        a, b = albedo[0 if direction[0] < 0.0 else 1](-direction[1])
        return [e * (c * a + (1.0 - c) * b) for e, c in zip(emitted, base)]

    expected = Expectation(
        "L = Le (b A + (1 - b) B), A the mean of G2/G1 and B that of G2/G1 (1 - |wo.h|)^5 over the normals h of GGX "
        "that are visible from the pixel (height-correlated Smith, single scattering), integrated in double; alpha "
        "0.25 left and 0.64 right, b = (0.9, 0.5, 0.2), Le = (0.6, 0.8, 1)",
        camera, radiance, sampled=(256, 131072), gathered=(256, 131072))
    for name, x in (("alpha 0.25", (2, 30)), ("alpha 0.64", (34, 62))):
        expected.add_region(f"{name}, slanted", x, (6, 32))
        expected.add_region(f"{name}, steep", x, (32, 62))
    return document, expected


def interpolated(function, low, high, count):
    """Barycentric Chebyshev interpolant of a function of pairs on [low, high]."""
    angles = [math.pi * (2 * i + 1) / (2 * count) for i in range(count)]
    nodes = [(low + high) / 2.0 + (high - low) / 2.0 * math.cos(a) for a in angles]
    values = [function(x) for x in nodes]
    weights = [(-1) ** i * math.sin(a) for i, a in enumerate(angles)]

    def at(x):
        assert low <= x <= high, x
        terms = [w / (x - n) for w, n in zip(weights, nodes)]
        return tuple(sum(t * v[k] for t, v in zip(terms, values)) / sum(terms) for k in (0, 1))

    return at
