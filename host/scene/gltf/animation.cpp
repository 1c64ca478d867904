#include "scene/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>
#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/choice.h"

namespace vkcppm {

namespace {

using nlohmann::json;
using Values = std::vector<double>;

/// Two key frames, and where between them; both are one before the first, after the last, and on a step.
struct Span {
    std::size_t before, after;
    double share;    // 0..1
    double seconds;  // that it lasts
};

/// times: [n >= 1] not falling.
Span span_at(const Values& times, double seconds) {
    const auto next = std::size_t(std::ranges::upper_bound(times, seconds) - times.begin());
    if (next == 0) return {0, 0, 0.0, 0.0};
    if (next == times.size()) return {next - 1, next - 1, 0.0, 0.0};
    const double lasts = times[next] - times[next - 1];
    return {next - 1, next, (seconds - times[next - 1]) / lasts, lasts};
}

glm::dquat quaternion(const Values& v) { return {v[3], v[0], v[1], v[2]}; }  // glm: w first

Values normalised(const Values& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * x;
    Values unit = v;
    for (double& x : unit) x /= std::sqrt(sum);  // of a zero no number, which the transform is refused for
    return unit;
}

/// Along the shorter great circle (glTF 2.0, appendix C.4).
Values slerped(const Values& a, const Values& b, double share) {
    const glm::dquat q = glm::slerp(quaternion(normalised(a)), quaternion(normalised(b)), share);
    return {q.x, q.y, q.z, q.w};
}

/// A channel of an animation: its key frames, read.
class Channel {
public:
    /// width: numbers of a key frame; 1 to 4 or, of weights, how many a mesh has.
    Channel(const GltfFile& file, GltfAccessors& accessors, const json& sampler, const std::string& object,
            std::size_t width, bool is_weights, Warnings& warnings)
        : width_(width), interpolation_(sampler.value("interpolation", "LINEAR")) {
        const int input = sampler["input"].get<int>(), output = sampler["output"].get<int>();
        times_ = accessors.numbers(input, 1, "input");
        for (std::size_t i = 0; i < times_.size(); ++i) {
            if (std::isfinite(times_[i]) && (i == 0 || times_[i] >= times_[i - 1])) continue;
            bad_scene(file.name, fmt::format("accessors[{}] element {} (input of {})", input, i, object),
                      fmt::to_string(times_[i]), "the times must be finite and rise");
        }
        // Exporters that round times leave some: a jump.
        if (std::ranges::adjacent_find(times_) != times_.end()) {
            warnings.add("two key frames at one time, the later one holds from there on", object);
        }
        values_ = accessors.numbers(output, is_weights ? 1 : int(width), "output");
        const std::size_t wanted = times_.size() * width * (is_cubic() ? 3 : 1);
        if (values_.size() != wanted) {
            bad_scene(file.name, fmt::format("accessors[{}] (output of {})", output, object),
                      fmt::format("{} numbers", values_.size()), fmt::format("its key frames need {}", wanted));
        }
    }

    Values at(double seconds, bool is_rotation) const {
        const auto [before, after, share, lasts] = span_at(times_, seconds);
        if (before == after || interpolation_ == "STEP") return value(before);
        if (!is_cubic() && is_rotation) return slerped(value(before), value(after), share);
        // The weights of a cubic Hermite spline (appendix C.5), or of a straight line.
        const double t = share, t2 = t * t, t3 = t2 * t;
        Values values(width_);
        for (std::size_t i = 0; i < width_; ++i) {
            const double from = value(before)[i], to = value(after)[i];
            values[i] = is_cubic()
                            ? (2.0 * t3 - 3.0 * t2 + 1.0) * from + (t3 - 2.0 * t2 + t) * lasts * tangent(before, 2)[i] +
                                  (3.0 * t2 - 2.0 * t3) * to + (t3 - t2) * lasts * tangent(after, 0)[i]
                            : from + t * (to - from);
        }
        return is_rotation ? normalised(values) : values;
    }

private:
    bool is_cubic() const { return interpolation_ == "CUBICSPLINE"; }

    Values numbers(std::size_t first) const {
        return Values(values_.begin() + std::ptrdiff_t(first * width_),
                      values_.begin() + std::ptrdiff_t((first + 1) * width_));
    }
    Values value(std::size_t key) const { return numbers(is_cubic() ? 3 * key + 1 : key); }

    /// side: 0 into the key frame, 2 out of it.
    Values tangent(std::size_t key, std::size_t side) const { return numbers(3 * key + side); }

    std::size_t width_;
    std::string interpolation_;
    Values times_;
    Values values_;
};

/// How many weights a node's mesh has; 0 where it has no morph targets.
std::size_t target_count(const tinygltf::Model& model, int node) {
    const int mesh = model.nodes[node].mesh;
    if (mesh < 0 || model.meshes[mesh].primitives.empty()) return 0;
    return model.meshes[mesh].primitives.front().targets.size();
}

void set(GltfFile& file, tinygltf::Model& model, int node, const std::string& path, const Values& values,
         Warnings& warnings) {
    tinygltf::Node& posed = model.nodes[node];
    if (path != "weights" && !posed.matrix.empty()) {
        warnings.add("ignored, its transform is animated", fmt::format("nodes[{}].matrix", node));
        posed.matrix.clear();
    }
    if (path == "translation") posed.translation = values;
    if (path == "rotation") posed.rotation = values;
    if (path == "scale") posed.scale = values;
    file.document["nodes"][node][path] = values;
}

}  // namespace

void pose_nodes(GltfFile& file, tinygltf::Model& model, GltfAccessors& accessors, const std::string& animation,
                double seconds, Warnings& warnings) {
    const json animations = file.document.value("animations", json::array());
    std::vector<std::size_t> chosen;
    if (animation == "all") {
        if (animations.empty()) warnings.add("there are none, --animation all moves nothing", "animations");
        for (std::size_t i = 0; i < animations.size(); ++i) chosen.push_back(i);
    } else {
        chosen.push_back(choose("--animation", animation, animations, "animations", file.name));
    }
    for (const std::size_t a : chosen) {
        const json& samplers = animations[a]["samplers"];
        const json& channels = animations[a]["channels"];
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const json& target = channels[c]["target"];
            const auto path = target["path"].get<std::string>();
            const std::string object = fmt::format("animations[{}].channels[{}]", a, c);
            if (path == "pointer" || !target.contains("node")) {
                warnings.add(
                    path == "pointer" ? "ignored, this program moves nodes alone" : "ignored, it moves no node",
                    object);
                continue;
            }
            const int node = target["node"].get<int>();
            const auto sampler = channels[c]["sampler"].get<std::size_t>();
            if (sampler >= samplers.size()) {
                bad_scene(file.name, object + ".sampler", fmt::to_string(sampler),
                          fmt::format("the animation has {}", samplers.size()));
            }
            const bool is_weights = path == "weights";
            const std::size_t width = is_weights ? target_count(model, node) : path == "rotation" ? 4 : 3;
            if (width == 0) {
                warnings.add("ignored, its node has no morph targets", object);
                continue;
            }
            if (accessors.count(samplers[sampler]["input"].get<int>()) == 0) {
                warnings.add("ignored, it has no key frames", object);
                continue;
            }
            const Channel channel(file, accessors, samplers[sampler], object, width, is_weights, warnings);
            set(file, model, node, path, channel.at(seconds, path == "rotation"), warnings);
        }
    }
}

}  // namespace vkcppm
