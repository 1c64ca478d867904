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


def slab_transmittance(ior, cosine):
    """(1 - F) / (1 + F): the sum over all reflections between the two faces of a slab."""
    reflectance = fresnel(ior, cosine)
    return (1.0 - reflectance) / (1.0 + reflectance)
