// Who may include whom under host/: core <- {scene, vk, io} <- flat <- render <- study <- app <- main, no file by a
// circle itself, and the libraries that one place alone may see.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/files/files.h"
#include "support/files/places.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;

/// Folder of the includer ("" for main.cpp) to the folders whose headers it may include. "shared" is shaders/shared,
/// which the kernels are compiled from as well.
const std::map<std::string, std::set<std::string>> allowed = {
    {"core", {"core"}},
    {"scene", {"core", "scene"}},
    {"scene/gltf", {"core", "scene", "scene/gltf"}},
    {"scene/diagnosis", {"core", "scene", "scene/diagnosis"}},
    {"vk", {"core", "vk", "shared"}},
    {"io", {"core", "io"}},
    {"flat", {"core", "scene", "scene/diagnosis", "flat", "shared"}},
    {"render", {"core", "scene", "vk", "flat", "render", "shared"}},
    {"study", {"core", "scene", "vk", "flat", "render", "study"}},
    {"app",
     {"core", "scene", "scene/gltf", "scene/diagnosis", "vk", "io", "flat", "render", "study", "app", "app/race"}},
    {"app/page", {"core", "io", "study", "app", "app/page"}},
    {"app/race", {"core", "scene", "vk", "io", "render", "study", "app", "app/page", "app/race"}},
    {"app/check", {"core", "io", "study", "app", "app/page", "app/check"}},
    {"app/cluster", {}},  // files for engines
    {"", {"app"}},
};

/// A library's headers and the only files that may include them, as patterns of the whole name.
struct Confined {
    const char* header;
    const char* includer;
};
const std::vector<Confined> confined = {
    {R"((.*/)?tiny_gltf\.h)", R"(scene/gltf/[a-z_]*\.cpp)"},
    {R"((vulkan|vk_video|spirv)/.*)", R"(vk/.*)"},
    {R"((OpenEXR/|Imath/)?(Imf|Imath|Iex|half).*\.h)", R"(io/.*)"},
    {R"(png\.h)", R"(io/.*|scene/gltf/picture\.cpp)"},
    {R"(turbojpeg\.h)", R"(scene/gltf/picture\.cpp)"},
    {R"(webp/.*)", R"(scene/gltf/picture\.cpp)"},
    {R"(draco/.*)", R"(scene/gltf/draco\.cpp)"},
    {R"(meshoptimizer\.h)", R"(scene/gltf/meshopt\.cpp)"},
    {R"(CLI/.*)", R"(app/.*)"},
};

struct Include {
    std::string header;
    bool is_ours = false;  // in quotes
};

std::vector<Include> includes_of(const std::string& text) {
    static const std::regex include(R"re(#[ \t]*include[ \t]*(["<])([^">]+)[">])re");
    std::vector<Include> found;
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
        found.push_back({(*it)[2], (*it)[1] == "\""});
    }
    return found;
}

/// What breaks the rules in a file of that name (relative to host/) and text, a line each.
std::vector<std::string> violations(const std::string& name, const std::string& text) {
    std::vector<std::string> found;
    const std::string folder = fs::path(name).parent_path().string();
    for (const auto& [header, is_ours] : includes_of(text)) {
        const std::string told = name + " includes " + header;
        const std::string owner = header.substr(0, header.rfind('/'));
        // What is embedded, SPIR-V and texts, has no folder; everything else of the project is named from host/ or
        // shaders/.
        if (is_ours && !header.ends_with(".inc") && !allowed.at(folder).contains(owner)) {
            found.push_back(told + ": '" + folder + "' may not look into '" + owner + "'");
        }
        for (const Confined& rule : confined) {
            if (std::regex_match(header, std::regex(rule.header)) &&
                !std::regex_match(name, std::regex(rule.includer))) {
                found.push_back(told + ": that is for " + rule.includer + " alone");
            }
        }
    }
    return found;
}

/// A source and its headers, x.cpp, x.h and x_impl.h, are one unit: its name, with the folder.
std::string unit_of(const std::string& file) {
    const std::string name = file.substr(0, file.rfind('.'));
    return name.ends_with("_impl") ? name.substr(0, name.size() - 5) : name;
}

using Units = std::map<std::string, std::set<std::string>>;  // a unit to those that it includes

void add_includes(Units& units, const std::string& name, const std::string& text) {
    std::set<std::string>& included = units[unit_of(name)];
    for (const auto& [header, is_ours] : includes_of(text)) {
        if (is_ours && unit_of(header) != unit_of(name)) included.insert(unit_of(header));
    }
}

/// Units that need one another, by way of others or not: in the order of their includes, the first again at the end.
/// Empty where there are none.
std::vector<std::string> circle_in(const Units& units) {
    std::set<std::string> done;
    std::vector<std::string> path;
    const std::function<bool(const std::string&)> closes = [&](const std::string& unit) {
        const auto before = std::ranges::find(path, unit);
        const bool met = before != path.end();
        if (met) path.erase(path.begin(), before);
        if (!met && (done.contains(unit) || !units.contains(unit))) return false;
        path.push_back(unit);
        if (met || std::ranges::any_of(units.at(unit), closes)) return true;
        path.pop_back();
        done.insert(unit);
        return false;
    };
    for (const auto& [unit, included] : units) {
        if (closes(unit)) return path;
    }
    return {};
}

TEST(Layering, CirclesOfFilesAreFound) {
    Units units;
    add_includes(units, "flat/a.cpp", "#include \"flat/a.h\"\n#include \"flat/b.h\"\n#include <a.h>\n");
    add_includes(units, "flat/b.h", "#include \"flat/c.h\"\n#include \"shared/types.h\"\n");
    add_includes(units, "flat/c_impl.h", "#include \"flat/c.h\"\n");
    EXPECT_EQ(circle_in(units), std::vector<std::string>());
    add_includes(units, "flat/c.cpp", "#include \"flat/c.h\"\n#include \"flat/b.h\"\n");
    EXPECT_EQ(circle_in(units), (std::vector<std::string>{"flat/b", "flat/c", "flat/b"}));
    add_includes(units, "flat/b.cpp", "#include \"flat/a.h\"\n");
    EXPECT_EQ(circle_in(units), (std::vector<std::string>{"flat/a", "flat/b", "flat/a"}));
}

TEST(Layering, TheRulesCatchWhatTheyForbid) {
    EXPECT_EQ(violations("scene/a.cpp", "#include \"vk/device.h\"\n").size(), 1u);
    EXPECT_EQ(violations("vk/a.cpp", "  #  include \"scene/scene.h\"\n").size(), 1u);
    EXPECT_EQ(violations("io/a.h", "#include \"render/render.h\"\n").size(), 1u);
    EXPECT_EQ(violations("core/a.h", "#include \"io/exr.h\"\n").size(), 1u);
    EXPECT_EQ(violations("render/a.h", "#include \"app/run.h\"\n").size(), 1u);
    EXPECT_EQ(violations("main.cpp", "#include \"render/render.h\"\n").size(), 1u);
    EXPECT_EQ(violations("render/a.cpp", "#include <vulkan/vulkan_raii.hpp>\n").size(), 1u);
    EXPECT_EQ(violations("scene/scene.cpp", "#include <tiny_gltf.h>\n").size(), 1u);
    EXPECT_EQ(violations("render/a.cpp", "#include <ImfHeader.h>\n#include <half.h>\n#include <png.h>\n").size(), 3u);
    EXPECT_EQ(violations("scene/a.cpp", "#include <png.h>\n#include <turbojpeg.h>\n").size(), 2u);
    EXPECT_EQ(violations("io/a.cpp", "#include <meshoptimizer.h>\n").size(), 1u);
    EXPECT_EQ(violations("io/a.cpp", "#include <CLI/CLI.hpp>\n").size(), 1u);
    EXPECT_EQ(violations("scene/a.cpp", "#include \"sibling.h\"\n").size(), 1u);
}

TEST(Layering, TheRulesAllowWhatTheDesignDoes) {
    EXPECT_TRUE(violations("scene/gltf/gltf.cpp", "#include <tiny_gltf.h>\n#include \"core/error.h\"\n").empty());
    EXPECT_TRUE(violations("scene/gltf/nodes.cpp", "#include <tiny_gltf.h>\n").empty());
    EXPECT_TRUE(violations("vk/a.cpp", "#include <vulkan/vulkan_raii.hpp>\n").empty());
    EXPECT_TRUE(violations("render/a.cpp", "#include \"shared/camera.h\"\n#include \"eye.spv.inc\"\n").empty());
    EXPECT_TRUE(violations("main.cpp", "#include \"app/run.h\"\n").empty());
}

TEST(Layering, EveryFileOfTheHostKeepsTheRules) {
    const fs::path host = test::source_folder() / "host";
    std::set<std::string> folders;
    Units units;
    for (const auto& entry : fs::recursive_directory_iterator(host)) {
        if (!entry.is_regular_file()) continue;
        const fs::path name = fs::relative(entry.path(), host);
        const std::string folder = name.parent_path().string();
        ASSERT_TRUE(allowed.contains(folder)) << name << " lies in a folder that the design does not know";
        folders.insert(folder);
        const std::string text = test::read_bytes(entry.path());
        for (const std::string& violation : violations(name.string(), text)) ADD_FAILURE() << violation;
        add_includes(units, name.string(), text);
    }
    EXPECT_EQ(circle_in(units), std::vector<std::string>()) << "each includes the next";
    EXPECT_EQ(folders.size(), allowed.size()) << "not every folder of the design was seen";
}

}  // namespace
}  // namespace vkcppm
