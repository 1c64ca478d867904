#pragma once
// The command line as a value.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/option_values.h"
#include "core/display.h"
#include "io/png.h"
#include "render/settings.h"
#include "scene/gltf/lights.h"
#include "scene/gltf/material_changes.h"
#include "study/check.h"
#include "study/race.h"
#include "study/reference.h"
#include "vk/device.h"

namespace vkcppm {

/// The scene and what is done to it before anything else.
struct SceneOptions {
    std::filesystem::path file;
    std::optional<std::filesystem::path> root{};  // what the file names lies below
    std::string animation{};                      // by name or index, or "all"; empty: at rest
    double at = 0.0;                              // s, of the animation
    std::string variant{};                        // by name or index; empty: none
    std::vector<MaterialChange> set{};            // values of materials, one after the other
    PunctualUnits punctual_units = PunctualUnits::by_generator;
    std::optional<std::filesystem::path> environment{};  // EXR or Radiance
    double environment_rotation = 0.0;                   // degrees about the vertical, counter-clockwise from above
    double environment_strength = 1.0;                   // a factor of its radiance
    ThinGlass thin_glass = ThinGlass::thin;
    bool strict = false;  // warnings of the scene are errors
};

/// How pictures for the eye are made.
struct DisplayOptions {
    ToneMap tone_map = ToneMap::none;
    std::optional<double> exposure = 0.0;  // stops; absent: by the median luminance
};

/// vkcppm SCENE ...
struct RenderOptions {
    SceneOptions scene;
    Settings settings;             // ranges unchecked: resolve_settings does that
    std::filesystem::path output;  // EXR
    std::optional<std::filesystem::path> png;
    DisplayOptions display;  // for the PNG
    PngDepth png_depth = PngDepth::eight;
    std::optional<std::filesystem::path> stats;       // JSON
    std::optional<std::filesystem::path> reference;   // EXR that the render is measured against
    std::optional<StopAt> stop_at;                    // only with a reference
    std::optional<Target> target;                     // then settings.error
    double confidence = Target().confidence;          // for the target
    std::optional<std::filesystem::path> resume;      // checkpoint to go on from
    std::optional<std::filesystem::path> checkpoint;  // where checkpoints go: `resume` where no other is named
    double checkpoint_every = 60.0;                   // s
    std::optional<double> snapshot;                   // s of rendering between two pictures that are written on the way
    std::optional<LiveAddress> live;                  // of a viewer that is sent the picture on its way
    std::optional<FrameRange> frames;                 // of scene.animation; the files are patterns then
    double fps = 24.0;                                // of the frames
    bool hash = false;                                // print the hash of every pass
    Device::Options device;
    bool quiet = false;
    bool verbose = false;
};

/// vkcppm reference SCENE ...
struct ReferenceOptions {
    SceneOptions scene;
    ReferenceSettings settings;                  // ranges unchecked: resolve_reference does that
    std::filesystem::path output;                // EXR
    bool half = false;                           // half floats
    std::optional<std::filesystem::path> stats;  // JSON
    Device::Options device;
    bool quiet = false;
    bool json = false;
};

/// vkcppm compare IMAGE REFERENCE
struct CompareOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    bool json = false;
};

/// vkcppm check IMAGE REFERENCE
struct CheckOptions {
    std::filesystem::path image;
    std::filesystem::path reference;
    CheckSettings settings;                       // level: where it was asked for
    bool update = false;                          // the reference becomes the image
    std::optional<std::filesystem::path> junit;   // XML
    std::optional<std::filesystem::path> report;  // folder of the page
    DisplayOptions display;                       // for the pictures of the page
    bool json = false;
};

/// vkcppm race SCENE
struct RaceOptions {
    SceneOptions scene;
    RaceSettings race;                               // ranges unchecked: resolve_race does that
    std::optional<std::filesystem::path> reference;  // EXR; by default references/NAME.exr beside the scene
    std::optional<double> make_reference;            // s: one is made for the race, in at most that time
    std::filesystem::path folder;                    // of all that is written
    bool checkpoint = false;                         // keeps the states of entrants there
    std::optional<std::filesystem::path> resume;     // folder of a race that kept its states; then checkpoint
    DisplayOptions display;                          // for the pictures
    Device::Options device;
    bool quiet = false;
    std::string command;  // this command line, to be given to a shell again
};

/// vkcppm plan SCENE
struct PlanOptions {
    SceneOptions scene;
    Settings settings;                    // ranges unchecked: resolve_settings does that
    std::filesystem::path job;            // folder
    std::optional<std::uint32_t> pilot;   // iterations; absent: by those in all
    std::optional<std::uint32_t> slice;   // iterations; absent: by those in all and by the shards
    std::optional<std::uint32_t> shards;  // that it is meant for
    std::optional<std::uint32_t> extend;  // iterations that a job is to have more; then without a scene
    Device::Options device;
    bool quiet = false;
    std::vector<std::string> words;  // those of this command line behind the command
    std::string folder;              // where files that are not absolute are looked for, as seen from the job
};

/// vkcppm render-shard JOB
struct ShardOptions {
    std::filesystem::path job;
    Shard shard;
    Device::Options device;
    bool quiet = false;
};

/// vkcppm merge JOB
struct MergeOptions {
    std::filesystem::path job;
    std::filesystem::path output;  // EXR
    std::optional<std::filesystem::path> png;
    DisplayOptions display;  // for the PNG
    PngDepth png_depth = PngDepth::eight;
    bool complete = false;  // nothing may be missing
    bool quiet = false;
};

/// vkcppm status JOB
struct StatusOptions {
    std::filesystem::path job;
    bool json = false;
};

/// vkcppm info SCENE
struct InfoOptions {
    SceneOptions scene;
    bool memory = false;  // what a render with these settings takes on this device is told as well
    Settings settings;
    Device::Options device;
    bool json = false;
};

/// vkcppm devices
struct DevicesOptions {
    bool json = false;
};

/// vkcppm doctor
struct DoctorOptions {
    bool json = false;
};

/// --help and --version
struct TextOptions {
    std::string text;
};

using Options =
    std::variant<RenderOptions, PlanOptions, ShardOptions, MergeOptions, StatusOptions, RaceOptions, ReferenceOptions,
                 CompareOptions, CheckOptions, InfoOptions, DevicesOptions, DoctorOptions, TextOptions>;

/// CheckSettings::level of a check without bounds where none is given.
inline constexpr double usual_level = 0.01;

/// Iterations where --time is given and --iterations is not.
inline constexpr std::uint32_t unbounded_iterations = max_iterations;
inline constexpr std::uint32_t usual_pilot = 16;  // iterations of a job's, at least, where --pilot is not given
inline constexpr std::uint32_t unbounded_samples = 1u << 24;  // of ReferenceSettings, likewise

/// Reads the command line; argv[0] is the program. The first word chooses the command where it is that of one
/// (command_texts()), and is the scene otherwise. Throws Error(usage) with the option, its value
/// and what it takes.
Options parse_options(int argc, const char* const* argv);

/// Those of a plan again, from its words.
PlanOptions parse_plan(const std::vector<std::string>& words);

/// What --help says of an option, in parts.
struct OptionText {
    std::vector<std::string> names;    // with their dashes; of what is given by its place: as in the help
    bool positional = false;           // given by its place
    std::string value;                 // what stands for its value; empty: it takes none
    std::string help;                  // lines
    std::vector<std::string> choices;  // names that its value is one of; empty: not a list
};

/// What --help says of a command.
struct CommandText {
    std::string name;  // empty: vkcppm SCENE
    std::string about;
    std::string footer;
    std::vector<OptionText> options;
};

/// All commands, vkcppm SCENE first.
std::vector<CommandText> command_texts();

}  // namespace vkcppm
