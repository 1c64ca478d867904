#pragma once
// Values of the command line's options: read from a word, or refused with the option, the word and what it takes.

#include <cstdint>
#include <optional>
#include <string>

#include "app/live.h"
#include "core/curve.h"
#include "core/display.h"
#include "core/image.h"
#include "io/png.h"
#include "render/error_estimate.h"
#include "scene/gltf/lights.h"
#include "study/check.h"

namespace vkcppm {

/// How glass without a volume is taken: as glTF says, or as solid where its mesh is closed.
enum class ThinGlass { thin, solid };

/// Frames of an animation, both ends included.
struct FrameRange {
    std::uint32_t first = 0, last = 0;  // first <= last
};

/// One of so many parts of a job.
struct Shard {
    std::uint32_t number = 1, of = 1;  // 1 <= number <= of
};

/// Throws Error(usage): that of `option` is not `wanted`.
[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& wanted);

// Each throws like refuse() where the word is none.
std::uint32_t parse_whole(const std::string& option, const std::string& text);
double parse_real(const std::string& option, const std::string& text);
double parse_factor(const std::string& option, const std::string& text);                   // 0 or more, within floats
double parse_rate(const std::string& option, const std::string& text);                     // above 0, to 1e6
FrameRange parse_frames(const std::string& option, const std::string& text);               // 0..47
Shard parse_shard(const std::string& option, const std::string& text);                     // 2/5
std::string parse_name(const std::string& option, const std::string& text);                // not empty
std::optional<double> parse_exposure(const std::string& option, const std::string& text);  // stops; auto: absent
ToneMap parse_tone_map(const std::string& option, const std::string& text);                // none, reinhard, aces, agx
PngDepth parse_png_depth(const std::string& option, const std::string& text);              // 8 or 16
double parse_share(const std::string& option, const std::string& text);                    // 0.001 or 0.1 %; >= 0
Bound parse_bound(const std::string& option, const std::string& text);                     // flip=0.05
Extent parse_size(const std::string& option, const std::string& text);                     // 512x384
double parse_seconds(const std::string& option, const std::string& text);     // of 90, 90s, 2m, 1.5h or 500ms; > 0
double parse_moment(const std::string& option, const std::string& text);      // the same, of any sign
LiveAddress parse_live(const std::string& option, const std::string& text);   // HOST, HOST:PORT, [HOST] or [HOST]:PORT
StopAt parse_stop_at(const std::string& option, const std::string& text);     // relmse_trimmed=0.0035
Target parse_target(const std::string& option, const std::string& text);      // relmse=0.001, noise=2%
double parse_confidence(const std::string& option, const std::string& text);  // 90 or 90 % as 0.9
PunctualUnits parse_punctual_units(const std::string& option, const std::string& text);
ThinGlass parse_thin_glass(const std::string& option, const std::string& text);  // thin or solid

}  // namespace vkcppm
