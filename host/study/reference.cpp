#include "study/reference.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "core/blocks.h"
#include "core/error.h"
#include "core/metrics.h"
#include "core/process.h"
#include "core/srgb.h"
#include "flat/material.h"
#include "render/integrator.h"
#include "render/path_tracer.h"
#include "render/render.h"
#include "study/batch_mean.h"
#include "study/significance.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t iterations_a_batch = 4;
constexpr std::uint32_t least_batches = least_error_batches;  // of each half, before an error is told
constexpr double least_share = 0.1;                           // of the time, for a half that may not know its error yet
// The starting radius, in footprints of the pixel (discs of a pixel's area), and its schedule, R^2 ~ N^(schedule - 1):
// the bias that the kernel leaves, at edges, goes to 0 with R, and variance ~ 1 / (N R^2) with N.
constexpr double first_radius = 4.0;
constexpr double schedule = 0.8;
constexpr std::uint32_t other_seed = 0x9e3779b9u;  // the halves must not share random numbers

/// Settings of the caustics' integrator.
Settings caustic_settings(const Settings& render) {
    Settings settings = render;
    settings.estimator = "sppm-kz";
    settings.alpha = schedule;
    settings.caustics = first_radius;
    settings.aovs = false;
    settings.error = false;
    settings.seed ^= other_seed;
    return settings;
}

/// One half of the light: batches, the light they add up to, and their time.
class Half {
public:
    Half(Extent extent, std::uint32_t bound) : extent_(extent), light_(extent), bound_(bound) {
        for (const std::uint32_t side : block_sides(extent)) blocks_.emplace_back(side, blocks_of(extent, side));
    }
    virtual ~Half() = default;

    void add_batch() {
        const double start = wall_now();
        const std::vector<glm::dvec3> batch = render_batch();
        light_.add(batch);
        for (auto& [side, means] : blocks_) means.add(block_means(extent_, side, batch));
        seconds_ += wall_now() - start;
    }
    const BatchMean& light() const { return light_; }
    const std::vector<std::pair<std::uint32_t, BatchMean>>& blocks() const { return blocks_; }  // by their sides
    std::size_t batches() const { return light_.batches(); }
    bool done() const { return batches() >= bound_; }
    double seconds() const { return seconds_; }
    double seconds_a_batch() const { return seconds_ / double(batches()); }

protected:
    virtual std::vector<glm::dvec3> render_batch() = 0;  // [pixels]

private:
    Extent extent_;
    BatchMean light_;
    std::vector<std::pair<std::uint32_t, BatchMean>> blocks_;
    std::size_t bound_;
    double seconds_ = 0.0;
};

class Paths : public Half {
public:
    Paths(const SceneOnDevice& on_device, const Camera& camera, const ReferenceSettings& settings)
        : Half(*settings.render.size, settings.samples / PathTracer::batch),
          tracer(on_device, camera, settings.render, PathTracer::Light::split) {}

    PathTracer tracer;

private:
    std::vector<glm::dvec3> render_batch() override {
        const Image batch = tracer.trace();
        return {batch.rgb.begin(), batch.rgb.end()};
    }
};

class Caustics : public Half {
public:
    Caustics(const SceneOnDevice& on_device, const Camera& camera, const ReferenceSettings& settings)
        : Half(*settings.render.size, settings.render.iterations / iterations_a_batch),
          integrator(on_device, camera, caustic_settings(settings.render)),
          sum_(settings.render.size->pixels(), glm::dvec3(0.0)) {}

    Integrator integrator;

private:
    /// A batch is what the integrator's sums grew by. Not its picture, which is nowhere below 0: the kernel's weights
    /// are, and cutting off what noise leaves below would be a bias.
    std::vector<glm::dvec3> render_batch() override {
        integrator.run(iterations_a_batch);
        std::vector<glm::dvec3> sum = integrator.sums().film;
        std::vector<glm::dvec3> batch;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            batch.push_back((sum[i] - sum_[i]) / double(iterations_a_batch));
        }
        sum_ = std::move(sum);
        return batch;
    }

    std::vector<glm::dvec3> sum_;
};

double mean_channel(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// Squared error a pixel over r^2 + epsilon, the mean over channels, as relMSE weighs it.
std::vector<double> relative_errors(const BatchMean& half, const std::vector<glm::dvec3>& mean) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        errors.push_back(mean_channel(half.squared_error(i) / (mean[i] * mean[i] + relmse_epsilon)));
    }
    return errors;
}

double average(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / double(values.size());
}

/// The picture so far: both halves together.
class Picture {
public:
    Picture(Extent extent, std::vector<Half*> halves) : extent_(extent), halves_(std::move(halves)) {}

    std::vector<glm::dvec3> mean() const {
        std::vector<glm::dvec3> sum(extent_.pixels(), glm::dvec3(0.0));
        for (const Half* half : halves_) {
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += half->light().mean()[i];
        }
        return sum;
    }

    bool tells_error() const {
        return std::ranges::all_of(halves_, [](const Half* half) { return half->batches() >= least_batches; });
    }

    /// The half for which the next batch lowers the expected relMSE most in its time; nullptr where all are done.
    Half* next() {
        std::vector<Half*> open;
        std::ranges::copy_if(halves_, std::back_inserter(open), [](const Half* half) { return !half->done(); });
        if (open.empty()) return nullptr;
        for (Half* half : open) {
            if (half->batches() < least_batches) return half;
        }
        double seconds = 0.0;
        for (const Half* half : halves_) seconds += half->seconds();
        for (Half* half : open) {
            if (half->seconds() < least_share * seconds) return half;
        }
        const std::vector<glm::dvec3> r = mean();
        relmse_ = 0.0;
        Half* best = open.front();
        double best_gain = -1.0;
        for (Half* half : halves_) {
            const double error = average(relative_errors(half->light(), r));
            relmse_ += error;
            const double gain = error / double(half->batches() + 1) / half->seconds_a_batch();
            if (!half->done() && gain > best_gain) {
                best = half;
                best_gain = gain;
            }
        }
        return best;
    }

    double relmse() const { return relmse_; }

private:
    Extent extent_;
    std::vector<Half*> halves_;
    double relmse_ = 0.0;
};

/// Mean of the values over the pixel and its neighbours within the picture.
double around(const std::vector<double>& values, Extent extent, std::size_t pixel) {
    const auto x = std::int64_t(pixel % extent.width), y = std::int64_t(pixel / extent.width);
    double sum = 0.0, count = 0.0;
    for (std::int64_t v = std::max<std::int64_t>(y - 1, 0); v <= std::min<std::int64_t>(y + 1, extent.height - 1);
         ++v) {
        for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= std::min<std::int64_t>(x + 1, extent.width - 1);
             ++u) {
            sum += values[std::size_t(v) * extent.width + std::size_t(u)];
            ++count;
        }
    }
    return sum / count;
}

double quantile(std::vector<double> values, double q) {
    const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Squares, a channel, of what an error of one standard error does to the 8-bit sRGB encoding, before it is rounded.
glm::dvec3 srgb_squares(const glm::dvec3& mean, const glm::dvec3& standard_error) {
    glm::dvec3 squares;
    for (int c = 0; c < 3; ++c) {
        const auto level = [&](double x) { return 255.0 * srgb_encode(std::clamp(x, 0.0, 1.0)); };
        const double half = 0.5 * (level(mean[c] + standard_error[c]) - level(mean[c] - standard_error[c]));
        squares[c] = half * half;
    }
    return squares;
}

void fill_statistics(Reference& result, const Paths& paths, const Caustics* caustics,
                     const std::vector<glm::dvec3>& mean) {
    const Extent extent = *result.settings.render.size;
    std::vector<double> relative = relative_errors(paths.light(), mean);
    result.relmse_paths = average(relative);
    double light = 0.0, caustic_light = 0.0;
    std::vector<double> errors;
    if (caustics) {
        const std::vector<double> more = relative_errors(caustics->light(), mean);
        result.relmse_caustics = average(more);
        for (std::size_t i = 0; i < more.size(); ++i) {
            relative[i] += more[i];
            caustic_light += mean_channel(caustics->light().mean()[i]);
        }
    }
    result.relmse = result.relmse_paths + result.relmse_caustics;
    result.mean.extent = result.standard_error.extent = extent;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        glm::dvec3 squared = paths.light().squared_error(i);
        if (caustics) squared += caustics->light().squared_error(i);
        result.mean.rgb.emplace_back(mean[i]);
        result.standard_error.rgb.emplace_back(glm::sqrt(squared));
        result.mse += mean_channel(squared) / double(mean.size());
        result.srgb_mse += mean_channel(srgb_squares(mean[i], glm::sqrt(squared))) / double(mean.size());
        errors.push_back(std::sqrt(relative[i]));
        light += mean_channel(mean[i]);
        const bool trusted = std::sqrt(around(relative, extent, i)) <= result.settings.trust;
        result.trusted.push_back(trusted ? 1.0f : 0.0f);
        result.untrusted += trusted ? 0 : 1;
    }
    for (std::size_t level = 0; level < paths.blocks().size(); ++level) {
        BlockErrors& blocks = result.block_errors.emplace_back();
        blocks.side = paths.blocks()[level].first;
        for (std::size_t block = 0; block < blocks_of(extent, blocks.side).pixels(); ++block) {
            glm::dvec3 squared = paths.blocks()[level].second.squared_error(block);
            if (caustics) squared += caustics->blocks()[level].second.squared_error(block);
            blocks.standard_error.emplace_back(glm::sqrt(squared));
        }
    }
    result.batches = std::uint32_t(paths.batches());
    if (caustics) result.batches = std::min(result.batches, std::uint32_t(caustics->batches()));
    result.caustic_share = light > 0.0 ? caustic_light / light : 0.0;
    result.median_error = quantile(errors, 0.5);
    result.error_99 = quantile(errors, 0.99);
}

}  // namespace

ReferenceSettings resolve_reference(const ReferenceSettings& wanted, const Scene& scene) {
    ReferenceSettings settings = wanted;
    settings.render = resolve_settings(wanted.render, scene);
    constexpr std::uint32_t least_samples = least_batches * PathTracer::batch, most_samples = 1u << 24;
    constexpr std::uint32_t least_iterations = least_batches * iterations_a_batch;
    if (settings.samples < least_samples || settings.samples > most_samples) {
        throw Error(ExitCode::usage,
                    fmt::format("--samples {} is outside {}..{}", settings.samples, least_samples, most_samples));
    }
    if (settings.render.iterations < least_iterations) {
        throw Error(ExitCode::usage,
                    fmt::format("--iterations {} is less than {}", settings.render.iterations, least_iterations));
    }
    if (!(settings.trust > 0.0)) {
        throw Error(ExitCode::usage, fmt::format("--trust {} is not greater than 0", settings.trust));
    }
    return settings;
}

Reference make_reference(const Scene& scene, const ReferenceSettings& resolved, Device& device,
                         const KeepRefining& keep_refining) {
    const double setup = wall_now();
    Reference result;
    result.settings = resolved;
    const Settings& settings = result.settings.render;
    const Camera& camera = camera_of(settings, scene);
    const SceneOnDevice on_device = put_on_device(scene, settings, device);
    Paths paths(on_device, camera, result.settings);
    std::unique_ptr<Caustics> caustics;
    if (splits_near_lamps(on_device.flat()) || std::ranges::any_of(traits_of(scene), &MaterialTraits::smooth)) {
        caustics = std::make_unique<Caustics>(on_device, camera, result.settings);
    }
    std::vector<Half*> halves{&paths};
    if (caustics) halves.push_back(caustics.get());
    Picture picture(*settings.size, halves);
    const auto samples = [&] { return std::uint32_t(paths.batches()) * PathTracer::batch; };
    const auto iterations = [&] { return caustics ? caustics->integrator.completed() : 0; };
    result.report.setup_seconds = wall_now() - setup;

    const double start = wall_now(), cpu_start = cpu_now();
    bool going = true;
    while (Half* half = picture.next()) {
        // Batches in proportion to those that there are: a half is chosen again and again only so often.
        const std::size_t target = half->batches() + 1 + half->batches() / 8;
        while (half->batches() < target && !half->done() && (going || !picture.tells_error())) {
            half->add_batch();
            const double wall = wall_now() - start;
            going = keep_refining({samples(), iterations(), picture.relmse(), wall}) && going &&
                    !(settings.seconds && wall >= *settings.seconds);
        }
        if (!going && picture.tells_error()) break;
    }
    Report& report = result.report;
    report.wall_seconds = wall_now() - start;
    report.cpu_seconds = cpu_now() - cpu_start;
    if (caustics) caustics->integrator.fill(report);
    report.passes.insert(report.passes.begin(), paths.tracer.pass());
    report.rays += paths.tracer.rays();
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.device_memory_bytes = device.peak_bytes();
    report.memory.clear();  // that of the caustics alone
    report.peak_memory_bytes = peak_memory();
    result.samples = samples();
    result.iterations = iterations();
    fill_statistics(result, paths, caustics.get(), picture.mean());
    const std::uint64_t invalid = paths.tracer.invalid() + (caustics ? caustics->integrator.invalid() : 0);
    if (invalid > 0) {
        result.warnings.push_back(fmt::format("{} contributions were not finite and were dropped", invalid));
    }
    return result;
}

}  // namespace vkcppm
