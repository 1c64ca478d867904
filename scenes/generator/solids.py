"""Solids of revolution, extrusions and convex polyhedra. Fronts counter-clockwise and outward."""

import math

from .shapes import Mesh, join, quad
from .vector import add, cross, dot, normalize, scale, sub

CREASE = math.cos(math.radians(40.0))  # edges that turn further stay sharp


def lathe(profile, segments, closed=False):
    """`profile` [(distance from the axis, height)] turned around +y: the front is on the right of the walk along it.

    A solid's profile starts on the axis at its bottom, goes up its outside and ends on the axis; a closed one has no
    ends and goes round counter-clockwise. Normals are smooth where the profile turns by less than 40 degrees.
    """
    count = len(profile)
    steps = count if closed else count - 1
    walls = []  # unit normal of each part of the profile, in its plane
    for i in range(steps):
        (r0, y0), (r1, y1) = profile[i], profile[(i + 1) % count]
        length = math.hypot(r1 - r0, y1 - y0)
        walls.append(((y1 - y0) / length, (r0 - r1) / length))
    mesh = Mesh([], [], [])
    rows = {}  # (point of the profile, part of it) -> the first vertex of its circle

    def row(point, part):
        """The first vertex of the circle of that point, with the normal that `part` sees there."""
        before, after = (point - 1) % steps if closed else point - 1, point % steps if closed else point
        radius, height = profile[point]
        around = [walls[p] for p in (before, after) if 0 <= p < steps]
        smooth = len(around) == 2 and around[0][0] * around[1][0] + around[0][1] * around[1][1] > CREASE
        key = (point, None if smooth else part)
        if key in rows:
            return rows[key]
        out, up = (sum(n[axis] for n in around) for axis in (0, 1)) if smooth else walls[part]
        length = math.hypot(out, up)
        out, up = out / length, up / length
        rows[key] = len(mesh.positions)
        if radius == 0.0:
            mesh.positions.append((0.0, height, 0.0))
            mesh.normals.append((0.0, math.copysign(1.0, up), 0.0))
            return rows[key]
        for i in range(segments):
            c, s = math.cos(2.0 * math.pi * i / segments), math.sin(2.0 * math.pi * i / segments)
            mesh.positions.append((radius * c, height, radius * s))
            mesh.normals.append((out * c, up, out * s))
        return rows[key]

    for part in range(steps):
        last = (part + 1) % count
        low, high = row(part, part), row(last, part)
        for i in range(segments):
            j = (i + 1) % segments
            if profile[part][0] > 0.0:
                top = high + i if profile[last][0] > 0.0 else high
                mesh.triangles.append((low + i, top, low + j))
            if profile[last][0] > 0.0:
                bottom = low + j if profile[part][0] > 0.0 else low
                mesh.triangles.append((bottom, high + i, high + j))
    return mesh


def arc(center, radius, start, end, steps):
    """[steps + 1] points of a circle in the plane, angles in degrees."""
    angles = (math.radians(start + (end - start) * i / steps) for i in range(steps + 1))
    return [(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles]


def spline(points, steps):
    """Catmull-Rom curve through `points`, `steps` parts between two of them."""
    curve = []
    for i in range(len(points) - 1):
        p = [points[max(0, min(len(points) - 1, i + k))] for k in (-1, 0, 1, 2)]
        for step in range(steps):
            t = step / steps
            weights = (-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2)
            curve.append(tuple(sum(w * q[axis] for w, q in zip(weights, p)) / 2.0 for axis in (0, 1)))
    return curve + [points[-1]]


def torus(major, minor, segments, sides):
    """Around the y axis, its middle in the origin."""
    return lathe(arc((major, 0.0), minor, 0.0, 360.0, sides)[:-1], segments, closed=True)


def cylinder(radius, height, segments):
    """Stands on the origin."""
    return lathe([(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)], segments)


def rod(start, end, radius, segments=8):
    """A closed cylinder between two points."""
    axis = sub(end, start)
    length = math.sqrt(dot(axis, axis))
    y = scale(axis, 1.0 / length)
    x = normalize(cross(y, (0.0, 0.0, 1.0) if abs(y[2]) < 0.9 else (1.0, 0.0, 0.0)))
    return mapped(cylinder(radius, length, segments), start, x, y, cross(x, y))


def tube(path, radius, sides):
    """Closed round tube along a path [(x, y, z)] in a plane of constant z; smooth but for its ends."""
    mesh = Mesh([], [], [])
    for i, point in enumerate(path):
        along = normalize(sub(path[min(i + 1, len(path) - 1)], path[max(i - 1, 0)]))
        u, v = cross((0.0, 0.0, 1.0), along), (0.0, 0.0, 1.0)
        for k in range(sides):
            c, s = math.cos(2.0 * math.pi * k / sides), math.sin(2.0 * math.pi * k / sides)
            normal = add(scale(u, c), scale(v, -s))
            mesh.positions.append(add(point, scale(normal, radius)))
            mesh.normals.append(normal)
        if i:
            for k in range(sides):
                a, b = (i - 1) * sides + k, (i - 1) * sides + (k + 1) % sides
                mesh.triangles.extend([(a, a + sides, b), (b, a + sides, b + sides)])
    first, last = list(range(sides)), list(range(len(mesh.positions) - sides, len(mesh.positions)))
    ends = Mesh(mesh.positions, [(first[0], first[k], first[k + 1]) for k in range(1, sides - 1)] +
                [(last[0], last[k + 1], last[k]) for k in range(1, sides - 1)])
    return join(mesh, faceted(ends))


def mapped(mesh, origin, x, y, z):
    """`mesh` with its axes on the right-handed unit vectors x, y and z, its origin on `origin`."""
    def turned(p):
        return add(scale(x, p[0]), add(scale(y, p[1]), scale(z, p[2])))
    normals = [turned(n) for n in mesh.normals] if mesh.normals else None
    return Mesh([add(origin, turned(p)) for p in mesh.positions], mesh.triangles, normals)


def moved(mesh, offset, yaw=0.0):
    """`mesh` turned by `yaw` degrees around +y, then moved."""
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    return mapped(mesh, offset, (c, 0.0, -s), (0.0, 1.0, 0.0), (s, 0.0, c))


def faceted(mesh):
    """The same surface with the normals of its triangles: to join with smooth ones."""
    positions, normals = [], []
    for triangle in mesh.triangles:
        p, q, r = (mesh.positions[i] for i in triangle)
        positions += [p, q, r]
        normals += [normalize(cross(sub(q, p), sub(r, p)))] * 3
    return Mesh(positions, [(i, i + 1, i + 2) for i in range(0, len(positions), 3)], normals)


def ribbon(points, depth):
    """Polyline [(x, y)] drawn out from z = -depth / 2 to depth / 2; its front is on its left.

    Normals are smooth where it turns by less than 40 degrees.
    """
    sides = [normalize((y0 - y1, x1 - x0, 0.0)) for (x0, y0), (x1, y1) in zip(points, points[1:])]
    mesh = Mesh([], [], [])
    for part, side in enumerate(sides):
        base = len(mesh.positions)
        for point, other in ((part, part - 1), (part + 1, part + 1)):
            smooth = 0 <= other < len(sides) and dot(side, sides[other]) > CREASE
            normal = normalize(add(side, sides[other])) if smooth else side
            for z in (-depth / 2.0, depth / 2.0):
                mesh.positions.append((*points[point], z))
                mesh.normals.append(normal)
        mesh.triangles.extend([(base, base + 1, base + 2), (base + 1, base + 3, base + 2)])
    return mesh


def extrude(polygon, depth):
    """Simple polygon [(x, y)], counter-clockwise, drawn out from z = -depth / 2 to depth / 2. Flat, closed."""
    count = len(polygon)
    positions = [(x, y, z) for z in (depth / 2.0, -depth / 2.0) for x, y in polygon]
    front = triangulated(polygon)
    triangles = front + [(c + count, b + count, a + count) for a, b, c in front]
    for i in range(count):
        j = (i + 1) % count
        triangles += [(i, i + count, j + count), (i, j + count, j)]
    return Mesh(positions, triangles)


def triangulated(polygon):
    """Triangles of a simple polygon [(x, y)], counter-clockwise, by cutting ears off."""
    def turn(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = polygon[a], polygon[b], polygon[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def is_ear(a, b, c):
        return turn(a, b, c) > 1e-12 and not any(
            turn(a, b, p) >= 0.0 and turn(b, c, p) >= 0.0 and turn(c, a, p) >= 0.0
            for p in left if p not in (a, b, c) and polygon[p] not in (polygon[a], polygon[b], polygon[c]))

    left, triangles = list(range(len(polygon))), []
    while len(left) > 3:
        i = next(i for i in range(len(left)) if is_ear(left[i - 1], left[i], left[(i + 1) % len(left)]))
        triangles.append((left[i - 1], left[i], left[(i + 1) % len(left)]))
        del left[i]
    return triangles + [tuple(left)]


def arched_wall(width, height, opening, spring, thickness, steps=12):
    """Panel of that width and height from x = -width / 2 and y = 0 with a round arch through it: `opening` wide,
    upright to the height `spring`, open at its foot."""
    curve = arc((0.0, spring), opening / 2.0, 180.0, 0.0, steps)
    outline = [(-width / 2.0, 0.0), (-opening / 2.0, 0.0), *curve, (opening / 2.0, 0.0), (width / 2.0, 0.0),
               (width / 2.0, height), (-width / 2.0, height)]
    return extrude(outline, thickness)


def convex(planes):
    """Flat closed polyhedron: the points p with n.p <= d for every (n, d) of `planes`."""
    positions, triangles, index = [], [], {}
    for plane, (n, d) in enumerate(planes):
        normal = normalize(n)
        u = normalize(cross((0.0, 1.0, 0.0) if abs(normal[1]) < 0.9 else (1.0, 0.0, 0.0), normal))
        v = cross(normal, u)
        foot = scale(n, d / dot(n, n))
        face = [add(foot, add(scale(u, 100.0 * a), scale(v, 100.0 * b)))
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        for other, (m, e) in enumerate(planes):
            if other != plane:
                face = _clipped(face, m, e)
        corners = []
        for p in face:
            key = tuple(round(x, 6) for x in p)
            if index.setdefault(key, len(positions)) == len(positions):
                positions.append(p)
            if index[key] not in corners:
                corners.append(index[key])
        triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    return Mesh(positions, triangles)


def _clipped(face, n, d):
    """The part of a convex polygon with n.p <= d."""
    result = []
    for a, b in zip(face, face[1:] + face[:1]):
        over_a, over_b = dot(n, a) - d, dot(n, b) - d
        if over_a <= 0.0:
            result.append(a)
        if (over_a < 0.0 < over_b) or (over_b < 0.0 < over_a):
            result.append(add(a, scale(sub(b, a), over_a / (over_a - over_b))))
    return result


def room(low, high, without=()):
    """{face: quad} of a box seen from inside: floor, ceiling, left (-x), right (+x), back (-z), front (+z)."""
    c = scale(add(low, high), 0.5)
    hx, hy, hz = scale(sub(high, low), 0.5)
    faces = {"floor": ((0, -hy, 0), (0, 0, hz), (hx, 0, 0)), "ceiling": ((0, hy, 0), (hx, 0, 0), (0, 0, hz)),
             "left": ((-hx, 0, 0), (0, hy, 0), (0, 0, hz)), "right": ((hx, 0, 0), (0, 0, hz), (0, hy, 0)),
             "back": ((0, 0, -hz), (hx, 0, 0), (0, hy, 0)), "front": ((0, 0, hz), (0, hy, 0), (hx, 0, 0))}
    return {name: quad(add(c, o), u, v) for name, (o, u, v) in faces.items() if name not in without}
