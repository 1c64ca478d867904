#pragma once
// How the kernels treat a glTF material: the one place where factors become a kind of surface.

#include <optional>
#include <string>

#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// The surface that stands for the material. A material is a mirror (metal without roughness), a smooth dielectric
/// (transmission with a volume), or diffuse.
gpu::SurfaceMaterial surface_of(const Material& material);

/// What surface_of leaves out of the material, in a few words; none where it is exact.
std::optional<std::string> left_out(const Material& material);

/// One line for `vkcppm info`: the kind of surface, its parameters, its emission, what is left out.
std::string describe_material(const Material& material);

}  // namespace vkcppm
