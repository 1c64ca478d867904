#include "app/load.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/console.h"
#include "core/error.h"
#include "core/fnv1a.h"
#include "io/environment.h"
#include "scene/diagnosis/diagnosis.h"
#include "scene/diagnosis/glass.h"
#include "scene/gltf/gltf.h"

namespace vkcppm {

namespace {

Environment load_environment(const SceneOptions& options, Scene& scene) {
    const std::filesystem::path& file = *options.environment;
    Image image = turned(read_environment(file, scene.hash, scene.warnings), options.environment_rotation);
    const auto strength = float(options.environment_strength);
    for (glm::vec3& radiance : image.rgb) {
        radiance *= strength;
        if (is_finite(radiance)) continue;
        throw Error(ExitCode::usage,
                    fmt::format("--environment-strength {} takes {} out of floats", strength, file.string()));
    }
    if (options.environment_rotation != 0.0 || options.environment_strength != 1.0) {
        scene.hash = fnv1a_of(fmt::format("--environment-rotation {} --environment-strength {}",
                                          options.environment_rotation, options.environment_strength),
                              scene.hash);
    }
    scene.inputs.push_back(file);
    return {image.extent, std::move(image.rgb)};
}

}  // namespace

Scene load_scene(const SceneOptions& options) {
    Scene scene = load_gltf(options.file, {.root = options.root,
                                           .animation = options.animation,
                                           .at = options.at,
                                           .variant = options.variant,
                                           .set = options.set,
                                           .punctual_units = options.punctual_units});
    if (options.environment) scene.environment = load_environment(options, scene);
    if (options.thin_glass == ThinGlass::solid) make_glass_solid(scene);
    for (std::string& line : diagnose(scene)) scene.warnings.push_back(std::move(line));
    return scene;
}

void tell_warnings(const Scene& scene, const SceneOptions& options) {
    std::set<std::string> told;
    tell_warnings(scene, options, told);
}

void tell_warnings(const Scene& scene, const SceneOptions& options, std::set<std::string>& told) {
    std::vector<std::string> lines;
    for (const std::string& line : scene.warnings) {
        if (told.insert(line).second) lines.push_back(line);
    }
    print_warnings(lines);
    if (!options.strict || scene.warnings.empty()) return;
    throw Error(ExitCode::bad_input, fmt::format("{}: {} warnings; with --strict there must be none",
                                                 options.file.string(), scene.warnings.size()));
}

}  // namespace vkcppm
