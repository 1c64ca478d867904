#pragma once
// A race as files for other programs: all that it was, and its curves.

#include <string>

#include <nlohmann/json.hpp>

#include "app/options.h"
#include "app/race/pictures.h"
#include "io/exr.h"
#include "scene/scene.h"
#include "study/race.h"

namespace vkcppm {

/// The name of an entrant's files, without a suffix: "cppm:beta=1.5" becomes "cppm-beta-1.5".
std::string file_stem(const Entrant& entrant);

/// The name of the PNG of a view of entrant_views(): "cppm.png" of the picture, else "cppm-radius.png".
std::string view_file(const Entrant& entrant, const std::string& view);

/// What a race was given besides its options.
struct RaceInput {
    const Scene& scene;
    std::filesystem::path reference;
    ExrAttributes reference_attributes;  // of that file
};

/// Version, command, scene, device, reference, what each got, names of the parameters, and of every entrant: settings,
/// colour, files, shares of pixels won, totals and seconds of the passes, and, by the metrics' names, its error at the
/// end, its bands against iterations and seconds with slopes, and its equal errors. Numbers that do not exist are null.
/// Member "curves" of an entrant's "runs" holds every snapshot of every seed; all else is derived from them.
nlohmann::ordered_json race_json(const RaceOptions& options, const RaceInput& input, const RaceResult& result,
                                 const RacePictures& pictures);

/// A line a snapshot: entrant, seed, iterations, seconds, and every metric; after one with their names. Numbers have
/// the digits that give the same bits when they are read.
std::string curves_csv(const RaceResult& result);

}  // namespace vkcppm
