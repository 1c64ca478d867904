#include "app/load.h"

#include <utility>

#include "io/environment.h"
#include "scene/diagnosis/diagnosis.h"
#include "scene/diagnosis/glass.h"
#include "scene/gltf/gltf.h"

namespace vkcppm {

Scene load_scene(const SceneOptions& options) {
    Scene scene = load_gltf(options.file);
    if (options.environment) {
        Image image = read_environment(*options.environment, scene.hash);
        scene.environment = Environment{image.extent, std::move(image.rgb)};
    }
    if (options.thin_glass == ThinGlass::solid) make_glass_solid(scene);
    for (std::string& line : diagnose(scene)) scene.warnings.push_back(std::move(line));
    return scene;
}

}  // namespace vkcppm
