#include "render/surface.h"

#include <cmath>

#include <fmt/format.h>

namespace vkcppm {
namespace {

std::string text(const glm::vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z); }

std::uint32_t kind_of(const Material& material) {
    // Of a mixture the larger part stands for the whole; left_out() says so.
    if (material.transmission * (1.0f - material.metallic) > 0.5f && material.thickness > 0.0f) return SURFACE_DIELECTRIC;
    if (material.metallic > 0.5f && material.roughness == 0.0f) return SURFACE_MIRROR;
    return SURFACE_DIFFUSE;
}

}  // namespace

gpu::SurfaceMaterial surface_of(const Material& material) {
    gpu::SurfaceMaterial surface{};
    surface.kind = kind_of(material);
    surface.color = material.base_color;
    surface.emission = material.emission;
    surface.ior = material.ior;
    if (material.double_sided) surface.kind |= SURFACE_DOUBLE_SIDED;
    return surface;
}

std::optional<std::string> left_out(const Material& material) {
    switch (kind_of(material)) {
        case SURFACE_MIRROR:
            if (material.metallic < 1.0f) return "its dielectric part";
            return std::nullopt;
        case SURFACE_DIELECTRIC:
            if (material.roughness > 0.0f) return "its roughness";
            if (material.transmission < 1.0f || material.metallic > 0.0f) return "its part that does not transmit";
            if (std::isfinite(material.attenuation_distance)) return "absorption in its volume";
            if (material.specular != 1.0f || material.specular_color != glm::vec3(1.0f)) return "its specular factors";
            return std::nullopt;
        default:
            if (material.transmission > 0.0f) {
                return material.thickness > 0.0f ? "its transmission" : "its transmission (no volume thickness: thin-walled)";
            }
            if (material.metallic > 0.0f) return "its metallic reflection (rough metals are rendered as diffuse)";
            if (material.specular > 0.0f && material.base_color != glm::vec3(0.0f)) return "its dielectric coat";
            return std::nullopt;
    }
}

std::string describe_material(const Material& material) {
    const gpu::SurfaceMaterial surface = surface_of(material);
    std::string line;
    switch (kind_of(material)) {
        case SURFACE_MIRROR: line = fmt::format("mirror, reflectance {}", text(surface.color)); break;
        case SURFACE_DIELECTRIC: line = fmt::format("smooth dielectric, ior {:g}, tint {}", surface.ior, text(surface.color)); break;
        default: line = fmt::format("diffuse, albedo {}", text(surface.color)); break;
    }
    if (surface.emission != glm::vec3(0.0f)) {
        line += fmt::format(", emits {} W m^-2 sr^-1 from {}", text(surface.emission),
                            material.double_sided ? "both sides" : "its front");
    }
    if (const auto missing = left_out(material)) line += fmt::format("; left out: {}", *missing);
    return line;
}

}  // namespace vkcppm
