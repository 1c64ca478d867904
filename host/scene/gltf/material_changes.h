#pragma once
// What a command line sets of a file's materials, as an exporter may have left it out.

#include <string>
#include <utility>
#include <vector>

#include "scene/gltf/file.h"

namespace vkcppm {

/// Values of members of one material, by glTF's names.
struct MaterialChange {
    std::string material;                                             // by name, which several may have, or by index
    std::vector<std::pair<std::string, std::vector<double>>> values;  // of a table's member, within its range

    /// As it is given: MATERIAL:member=value[:member=value].
    std::string text() const;
};

/// Reads "glass:ior=1.33:attenuationColor=0.9,1,0.9". Throws Error(usage) where a member is none or its value is
/// outside of its range, with what there is.
MaterialChange parse_material_change(const std::string& text);

/// The members that can be set, each with what it takes: lines of at most `width` columns.
std::string material_members(std::size_t width);

/// Writes the values into the file's materials. Throws Error(usage) where it has no such material.
void change_materials(GltfFile& file, const std::vector<MaterialChange>& changes);

}  // namespace vkcppm
