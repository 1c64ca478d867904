#pragma once
// The punctual lights of a glTF file (KHR_lights_punctual).

#include <optional>
#include <string_view>

#include "scene/gltf/file.h"
#include "scene/gltf/nodes.h"
#include "scene/scene.h"
#include "scene/warnings.h"

namespace vkcppm {

/// What the intensities of a file's lights are: W/sr and W/m^2, candela and lux as KHR_lights_punctual says, or the
/// latter where Blender's exporter wrote it, which makes them of watts, and the former elsewhere.
enum class PunctualUnits { radiometric, photometric, by_generator };

/// The words of --punctual-units.
std::string_view name_of(PunctualUnits units);

/// By what the intensities of a file are divided to be radiometric; a warning says where the file decided it.
double lumens_per_watt(const GltfFile& file, PunctualUnits units, Warnings& warnings);

/// The light of a node, in the world, its intensity divided by `per_watt`. None where the node has none or, with a
/// warning, where the light points nowhere or its intensity is negative. A cone that is no cone becomes the nearest
/// that is, with a warning.
std::optional<PunctualLight> read_light(const GltfFile& file, const tinygltf::Model& model, const PlacedNode& placed,
                                        double per_watt, Warnings& warnings);

}  // namespace vkcppm
