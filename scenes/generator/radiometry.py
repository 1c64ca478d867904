"""The closed forms. Angles in rad, radiance in W m^-2 sr^-1, irradiance in W m^-2."""

import math

from .vector import cross, dot, normalize, scale, sub


def point_irradiance(intensity, light, point, normal):
    """I cos(theta) / r^2 of a point light of `intensity` W/sr."""
    to_light = sub(light, point)
    squared = dot(to_light, to_light)
    return intensity * max(0.0, dot(normal, to_light)) / squared ** 1.5


def spot_falloff(cosine, inner, outer):
    """KHR_lights_punctual's recommended falloff at the cosine of the angle off the axis."""
    t = (cosine - math.cos(outer)) / (math.cos(inner) - math.cos(outer))
    return min(1.0, max(0.0, t)) ** 2


def polygon_irradiance(radiance, corners, point, normal):
    """Lambert's formula for a uniform polygon wholly above the horizon of `point`, corners in order."""
    directions = [normalize(sub(c, point)) for c in corners]
    total = 0.0
    for a, b in zip(directions, directions[1:] + directions[:1]):
        edge = cross(a, b)
        length = math.sqrt(dot(edge, edge))
        total += math.atan2(length, dot(a, b)) * dot(normal, scale(edge, 1.0 / length))
    return radiance * abs(total) / 2.0


def schlick(base, cosine):
    """glTF's reflectance of a metal."""
    return base + (1.0 - base) * (1.0 - cosine) ** 5


def fresnel(ior, cosine):
    """Exact reflectance of unpolarised light that enters a dielectric."""
    inside = math.sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior))
    parallel = (ior * cosine - inside) / (ior * cosine + inside)
    perpendicular = (cosine - ior * inside) / (cosine + ior * inside)
    return (parallel * parallel + perpendicular * perpendicular) / 2.0


def slab(ior, cosine, passed=1.0):
    """(transmittance, reflectance) of a slab, all reflections between its faces; `passed`: what absorption leaves of
    light on one way through it."""
    reflectance = fresnel(ior, cosine)
    inside = (1.0 - reflectance) ** 2 / (1.0 - (reflectance * passed) ** 2)
    return inside * passed, reflectance + inside * reflectance * passed ** 2


def absorbed_once(attenuation, thickness, ior, cosine):
    """rgb that is left of light on its slanted way through a slab; attenuation: (rgb that is left, after m)."""
    color, distance = attenuation
    way = thickness / math.sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior))
    return [c ** (way / distance) for c in color]


def rough_metal_albedo(alpha, cosine, steps=128):
    """(a, b): under light of radiance 1 from everywhere a metal of Schlick base c looks c a + (1 - c) b.

    The integral of D G2 F / (4 cos) over the hemisphere, single scattering, height-correlated Smith, by the midpoint
    rule over the distribution of visible normals (Heitz 2018, JCGT 7(4)), where it is the mean of F G2 / G1.
    """
    sine = math.sqrt(1.0 - cosine * cosine)
    length = math.hypot(alpha * sine, cosine)
    view = (alpha * sine / length, 0.0, cosine / length)  # stretched, so that the surface is a hemisphere

    def smith(c):
        return (math.sqrt(1.0 + alpha * alpha * (1.0 - c * c) / (c * c)) - 1.0) / 2.0

    first = second = 0.0
    for i in range(steps):
        radius = math.sqrt((i + 0.5) / steps)
        for k in range(steps):
            angle = math.pi * ((k + 0.5) / steps - 0.5)  # one half: the other is its mirror image
            t1, t2 = radius * math.cos(angle), radius * math.sin(angle)
            s = 0.5 * (1.0 + view[2])
            t2 = (1.0 - s) * math.sqrt(1.0 - t1 * t1) + s * t2
            up = math.sqrt(max(0.0, 1.0 - t1 * t1 - t2 * t2))
            half = normalize((alpha * (up * view[0] - t2 * view[2]), alpha * t1,
                              max(1e-9, up * view[2] + t2 * view[0])))
            between = sine * half[0] + cosine * half[2]
            leaves = 2.0 * between * half[2] - cosine
            if leaves > 0.0:
                masked = (1.0 + smith(cosine)) / (1.0 + smith(cosine) + smith(leaves))
                first += masked
                second += masked * (1.0 - between) ** 5
    return first / steps**2, second / steps**2
