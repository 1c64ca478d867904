"""Triangle meshes, fronts counter-clockwise: positions [V], triangles [T], normals [V] or None for flat shading."""

import math
from typing import NamedTuple, Optional

from .vector import add, cross, normalize, scale, sub


class Mesh(NamedTuple):
    positions: list
    triangles: list
    normals: Optional[list] = None


def quad(center, u, v):
    """Parallelogram center +- u +- v whose front faces along u x v."""
    corners = [add(center, add(scale(u, a), scale(v, b))) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return Mesh(corners, [(0, 1, 2), (0, 2, 3)])


def square_towards(center, target, side):
    """Square of that side around `center` that faces `target`."""
    normal = normalize(sub(target, center))
    u = normalize(cross((0.0, 1.0, 0.0), normal))
    return quad(center, scale(u, side / 2.0), scale(cross(normal, u), side / 2.0))


def join(*meshes):
    """One mesh of several, all flat or all with normals."""
    positions, triangles, normals = [], [], []
    for mesh in meshes:
        base = len(positions)
        positions += mesh.positions
        triangles += [tuple(base + i for i in t) for t in mesh.triangles]
        normals += mesh.normals or []
    assert len(normals) in (0, len(positions))
    return Mesh(positions, triangles, normals or None)


def flip(mesh):
    """The same surface with its fronts on the other side."""
    normals = [scale(n, -1.0) for n in mesh.normals] if mesh.normals else None
    return Mesh(mesh.positions, [(a, c, b) for a, b, c in mesh.triangles], normals)


def box(low, high):
    """Closed axis-aligned box, fronts outward."""
    center = scale(add(low, high), 0.5)
    hx, hy, hz = scale(sub(high, low), 0.5)
    x, y, z = (hx, 0, 0), (0, hy, 0), (0, 0, hz)
    faces = [(x, y, z), (y, z, x), (z, x, y)]  # u, v and their normal
    return join(*[quad(add(center, n), u, v) for u, v, n in faces],
                *[quad(sub(center, n), v, u) for u, v, n in faces])


def sphere(center, radius, frequency, smooth=True):
    """Icosahedron whose edges are cut into `frequency` parts, on the sphere: 20 frequency^2 triangles, outward."""
    golden = (1.0 + math.sqrt(5.0)) / 2.0
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0),
               (0, -1, golden), (0, 1, golden), (0, -1, -golden), (0, 1, -golden),
               (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1)]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
             (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
             (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    directions, index = [], {}

    def vertex(weights):
        """weights: ((corner, parts), ...) with parts that sum to frequency; shared between faces."""
        key = tuple(sorted((c, w) for c, w in weights if w))
        if key not in index:
            point = (0.0, 0.0, 0.0)
            for corner, parts in key:
                point = add(point, scale(corners[corner], parts))
            index[key] = len(directions)
            directions.append(normalize(point))
        return index[key]

    triangles = []
    n = frequency
    for a, b, c in faces:
        def at(i, j):
            return vertex(((a, n - i - j), (b, i), (c, j)))
        for i in range(n):
            for j in range(n - i):
                triangles.append((at(i, j), at(i + 1, j), at(i, j + 1)))
                if i + j < n - 1:
                    triangles.append((at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)))
    positions = [add(center, scale(d, radius)) for d in directions]
    return Mesh(positions, triangles, directions if smooth else None)


def ring(center, inner, outer, height, segments, cap_segments):
    """Band that stands on the plane y = center.y, open below, its rim a half circle; smooth normals, fronts outward."""
    rim = (outer - inner) / 2.0
    middle = inner + rim
    profile = [(inner, 0.0, -1.0, 0.0)]  # distance from the axis, height, and the normal in that plane
    for i in range(cap_segments + 1):
        angle = math.pi * (1.0 - i / cap_segments)
        c, s = math.cos(angle), math.sin(angle)
        profile.append((middle + rim * c, height - rim + rim * s, c, s))
    profile.append((outer, 0.0, 1.0, 0.0))
    positions, normals, triangles = [], [], []
    for i in range(segments):
        angle = 2.0 * math.pi * i / segments
        c, s = math.cos(angle), math.sin(angle)
        for distance, y, n_radial, n_up in profile:
            positions.append(add(center, (distance * c, y, distance * s)))
            normals.append((n_radial * c, n_up, n_radial * s))
    rows = len(profile)
    for i in range(segments):
        j = (i + 1) % segments
        for r in range(rows - 1):
            a, b, c, d = i * rows + r, i * rows + r + 1, j * rows + r + 1, j * rows + r
            triangles += [(a, c, b), (a, d, c)]
    mesh = Mesh(positions, triangles, normals)
    assert all(_faces_its_normal(mesh, t) for t in mesh.triangles)
    return mesh


def _faces_its_normal(mesh, triangle):
    p, q, r = (mesh.positions[i] for i in triangle)
    face = cross(sub(q, p), sub(r, p))
    mean = (0.0, 0.0, 0.0)
    for i in triangle:
        mean = add(mean, mesh.normals[i])
    return face[0] * mean[0] + face[1] * mean[1] + face[2] * mean[2] > 0.0
