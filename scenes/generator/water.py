"""Water: a pool under the sun."""

import math

from .camera import Camera
from .document import Document, place
from .shapes import Mesh, box, join, quad
from .solids import arc, faceted, lathe, room, tube
from .vector import normalize

WAVES = ((0.9, 0.3, 0.016, 0.3), (-0.4, 1.0, 0.014, 1.9), (1.2, -1.6, 0.013, 4.1), (2.3, 1.4, 0.010, 2.2),
         (-2.6, 1.1, 0.008, 0.7), (0.7, 3.6, 0.0065, 5.0), (4.4, -2.7, 0.0045, 3.3))  # 1/3 wave vector, m, phase


def surface(x, z):
    """Height over the mean level and unit normal of the waves."""
    height = slope_x = slope_z = 0.0
    for kx, kz, amplitude, phase in WAVES:
        angle = 3.0 * (kx * x + kz * z) + phase
        height += amplitude * math.sin(angle)
        slope_x += 3.0 * kx * amplitude * math.cos(angle)
        slope_z += 3.0 * kz * amplitude * math.cos(angle)
    return height, normalize((-slope_x, 1.0, -slope_z))


def waves(half_x, half_z, bottom, nx, nz):
    """Closed volume under the waves: x within +- half_x, z within +- half_z, y from `bottom` to about 0."""
    mesh = Mesh([], [], [])
    for j in range(nz + 1):
        for i in range(nx + 1):
            x, z = half_x * (2.0 * i / nx - 1.0), half_z * (2.0 * j / nz - 1.0)
            height, normal = surface(x, z)
            mesh.positions.append((x, height, z))
            mesh.normals.append(normal)
    for j in range(nz):
        for i in range(nx):
            a = j * (nx + 1) + i
            b, c, d = a + 1, a + nx + 2, a + nx + 1
            mesh.triangles.extend([(a, c, b), (a, d, c)])
    rim = ([(i, 0) for i in range(nx)] + [(nx, j) for j in range(nz)] + [(nx - i, nz) for i in range(nx)] +
           [(0, nz - j) for j in range(nz)])
    top = [mesh.positions[j * (nx + 1) + i] for i, j in rim]
    corners = [(sx * half_x, bottom, sz * half_z) for sx, sz in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    walls = Mesh(top + corners, [])
    start = 0
    for side, length in enumerate((nx, nz, nx, nz)):
        foot, next_foot = len(top) + side, len(top) + (side + 1) % 4
        for i in range(start, start + length):
            walls.triangles.append((foot, i, (i + 1) % len(top)))
        start += length
        walls.triangles.append((foot, start % len(top), next_foot))
    a, b, c, d = range(len(top), len(top) + 4)
    walls.triangles.extend([(a, b, c), (a, c, d)])
    return join(mesh, faceted(walls))


def water():
    """A pool whose floor is lit through waves. The water reaches 3 cm behind its walls and under its floor: no gap."""
    document = Document("A pool under the sun: caustics on its floor, seen through the waves.", "Water")
    x, z, depth, rim = 1.7, 1.25, 1.15, 0.12
    document.add_mesh("pool", basin(x, z, depth, rim), document.lambert("plaster", (0.5, 0.76, 0.8)))
    document.add_mesh("lines", lines(x, z, depth), document.lambert("line tiles", (0.05, 0.16, 0.34)))
    document.add_mesh("water", waves(x + 0.03, z + 0.03, -depth - 0.03, 64, 48),
                      document.glass("water", 1.33, ((0.5, 0.88, 0.94), 4.0)))
    document.add_mesh("deck", deck(x, z, rim, 1.35), document.lambert("stone", (0.6, 0.54, 0.46)))
    document.add_mesh("rails", join(*[rail(x, rim, at) for at in (-0.55, -0.15)]),
                      document.mirror("steel", (0.75, 0.76, 0.78)))
    red, white = document.lambert("red", (0.75, 0.08, 0.05)), document.lambert("white", (0.8, 0.8, 0.78))
    wedges = ball(0.24, 12)
    for name, material, mesh in (("red wedges", red, wedges[0]), ("white wedges", white, wedges[1])):
        document.add_mesh(name, mesh, material, [place((-0.62, 0.1, -0.35), yaw=25.0, pitch=35.0)])
    document.add_light("directional", (4.6, 4.2, 3.5), direction=(0.5, -1.0, -0.22), name="sun")
    document.add_mesh("sky", quad((4.2, 3.6, 0.0), (0.9, 1.4, 0.0), (0.0, 0.0, -2.2)),
                      document.emitter("sky", (1.2, 1.7, 2.4)))
    document.add_camera(Camera((-0.15, 2.75, 3.05), (0.0, -0.48, 0.0), math.radians(37.0), (4, 3)))
    return document


def basin(x, z, depth, rim):
    """Floor and walls of the pool, fronts to the water."""
    sides = room((-x, -depth, -z), (x, rim, z), without=("ceiling",))
    return join(*sides.values())


def lines(x, z, depth):
    """Two dark stripes that lie on the floor, 4 mm thick."""
    return join(*[box((-x + 0.45, -depth - 0.01, at - 0.06), (x - 0.45, -depth + 0.004, at + 0.06))
                  for at in (-z / 2.0, z / 2.0)])


def deck(x, z, rim, wide):
    """Slabs around the pool, their inner edges 2 cm behind its walls, with joints of 8 mm."""
    slabs, gap, size = [], 0.008, 0.45
    low, high = rim - 0.2, rim
    inner_x, inner_z = x - 0.025, z - 0.025
    outer_x, outer_z = x + wide, z + wide
    columns = round(2.0 * outer_x / size)
    for i in range(columns):
        x0, x1 = (-outer_x + 2.0 * outer_x * k / columns for k in (i, i + 1))
        for z0, z1 in ((-outer_z, -inner_z - wide / 2.0), (-inner_z - wide / 2.0, -inner_z), (inner_z, outer_z)):
            slabs.append(box((x0, low, z0 + gap), (x1 - gap, high, z1)))
    rows = round(2.0 * inner_z / size)
    for i in range(rows):
        z0, z1 = (-inner_z + 2.0 * inner_z * k / rows for k in (i, i + 1))
        for x0, x1 in ((-outer_x, -inner_x), (inner_x, outer_x)):
            slabs.append(box((x0 + gap, low, z0 + gap), (x1 - gap, high, z1)))
    return join(*slabs)


def rail(x, rim, z):
    """A bent tube from the deck over the wall of the pool into the water."""
    path = [(x + 0.35, rim - 0.1), *arc((x + 0.13, rim + 0.3), 0.22, 0.0, 180.0, 12), (x - 0.09, -0.6)]
    return tube([(px, py, z) for px, py in path], 0.02, 10)


def ball(radius, segments):
    """Wedges of a sphere, every other one: (6 of one colour, 6 of the other)."""
    whole = lathe([(0.0, -radius), *arc((0.0, 0.0), radius, -80.0, 80.0, 16), (0.0, radius)], segments * 3)
    halves = ([], [])
    for triangle in whole.triangles:
        middle = [sum(whole.positions[i][axis] for i in triangle) for axis in range(3)]
        wedge = int((math.atan2(middle[2], middle[0]) + math.pi) / (2.0 * math.pi) * segments)
        halves[wedge % 2].append(triangle)
    return tuple(whole._replace(triangles=half) for half in halves)
