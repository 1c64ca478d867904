#include "render/integrator.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "flat/features.h"
#include "render/error_estimate.h"
#include "render/estimators.h"
#include "render/grid.h"
#include "render/kernels.h"
#include "render/memory.h"
#include "render/status.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t stride_invocations = 16384;  // of kernels that stride over their input, at most
constexpr double radius_cap = 0.2;                   // of the scene's radius
constexpr double footprint_cap = 64.0;               // footprints of the pixel
constexpr std::uint64_t most_sorted_a_lane = 32768;  // well below the loop trips of every driver
constexpr std::uint32_t plan_interval = 16;          // iterations between plans of the grid, after the first few

void set_test(gpu::Params& params, const EstimatorRow& estimator, const Settings& settings) {
    const std::vector<float> thresholds =
        chi_squared_thresholds(estimator, settings.rings, settings.sectors, settings.significance);
    std::copy(thresholds.begin(), thresholds.end(), params.threshold);
    const auto direction = [&](double sector) {
        const double angle = 2.0 * std::numbers::pi * sector / double(settings.sectors);
        return glm::vec2(std::cos(angle), std::sin(angle));
    };
    for (std::uint32_t s = 0; s < settings.sectors; ++s) {
        if (s < settings.sectors / 2) params.sector_edge[s] = direction(s);
        params.sector_centre[s] = direction(s + 0.5);
    }
}

/// What the scene, the camera and the number of light paths decide of them.
gpu::Params first_params(const SceneOnDevice& on_device, const Camera& camera, const Settings& settings,
                         std::uint32_t group) {
    const FlatScene& scene = on_device.flat();
    gpu::Params params = scene_params(on_device.device(), scene, camera, settings, settings.caustics.has_value());
    set_photons(params, settings, on_device.device(), !scene.lights.empty(), group);
    return params;
}

}  // namespace

Integrator::Integrator(const SceneOnDevice& on_device, const Camera& camera, const Settings& settings,
                       std::vector<KernelForm> forms, std::uint64_t most_band_pixels)
    : device_(on_device.device()),
      forms_(forms.empty() ? forms_for(device_.policy()) : std::move(forms)),
      params_(first_params(on_device, camera, settings, forms_.front().group)),
      counts_(counts_of(params_, settings, device_, feature_bits(on_device.flat(), settings), most_band_pixels)),
      bands_(counts_.bands),
      bindings_(device_, bands_.count()),
      commands_(device_, bindings_),
      buffers_(device_, bindings_) {
    const FlatScene& scene = on_device.flat();
    const EstimatorRow& estimator = find_estimator(settings.estimator);
    const std::uint32_t features = feature_bits(scene, settings);
    scale_ = scene.frame.scale;
    measures_area_ = settings.disc_area == area_measured && !settings.caustics;
    set_test(params_, estimator, settings);
    set_estimator_params(scene, settings);

    check_memory(counts_, settings, device_);
    on_device.lend(buffers_);
    buffers_.allocate(
        counts_, [](const BufferRow& row) { return row.entries != Entries::uploaded && row.per != Per::photon_slot; });
    buffers_.upload(Binding::quantiles,
                    f_thresholds(estimator, settings.rings, settings.sectors, settings.significance));
    allocate_photons();

    gpu::PixelState pixel{};
    pixel.batch = float(settings.knn);  // B_1 = k_NN
    const std::vector<gpu::PixelState> states(bands_.each, pixel);
    for (std::uint32_t band = 0; band < bands_.count(); ++band) buffers_.at(Binding::pixels, band).upload(states);
    specialization_ = scene_specialization(scene, features);
    specialization_.merge(Specialization{{SPEC_RINGS, settings.rings},
                                         {SPEC_SECTORS, settings.sectors},
                                         {SPEC_DIGIT_BITS, digits_.bits},
                                         {SPEC_LEVELS, params_.grid_levels},
                                         {SPEC_DEALS, device_.policy().deals_paths ? 1u : 0u}});
    estimator_ = estimator.name;
    std::vector<KernelId> all;
    for (const KernelRow& row : kernel_rows()) {
        if (row.pass == Pass::trace || (row.pass == Pass::area && !measures_area_)) continue;
        all.push_back(row.id);
        kernels_.emplace(row.id, Compiled{KernelChoice(forms_of(row, forms_)), {}, {std::string(row.name)}});
    }
    compile(all);
}

/// Starting radii and the estimator's parameters.
void Integrator::set_estimator_params(const FlatScene& scene, const Settings& settings) {
    params_.inverse_paths = params_.photons > 0 ? 1.0f / float(params_.photons) : 0.0f;
    params_.flux_unit = scene.light_power > 0.0 ? float(std::exp2(-std::floor(std::log2(scene.light_power)))) : 1.0f;
    params_.knn = settings.knn;
    params_.radius_cap = float(radius_cap * std::max(scene.radius, 1e-3));
    const double mean_disc = double(settings.knn) * std::max(scene.area, 1e-12) / double(photons_of(settings));
    params_.radius_floor = std::min(params_.radius_cap, float(std::sqrt(mean_disc / std::numbers::pi)));
    params_.footprint_cap = float(settings.caustics.value_or(footprint_cap));
    params_.alpha = float(settings.alpha);
    params_.k = float(settings.k);
    params_.beta = float(settings.beta);
}

/// What the sizes of the buffers follow from now.
Counts Integrator::counts() const {
    Counts counts = counts_;
    counts.photon_slots = std::uint64_t(params_.photon_lanes) * params_.photon_capacity;
    counts.levels = params_.grid_levels;
    return counts;
}

/// Buffers whose size follows the number of photons that a lane can store; again when a render needs more.
void Integrator::allocate_photons() {
    buffers_.allocate(
        counts(), [](const BufferRow& row) { return row.per == Per::photon_slot && row.entries != Entries::levels; });
    const std::uint32_t levels = levels_that_fit(params_.grid_levels);
    if (levels < params_.grid_levels) limit_levels(levels);
    params_.grid_levels = levels;
    allocate_sorted();
}

/// Buffers that hold every photon once a level of the grid.
void Integrator::allocate_sorted() {
    buffers_.allocate(counts(), [](const BufferRow& row) { return row.entries == Entries::levels; });
    buffer(Binding::params).upload_value(params_);
}

/// The levels of the grid, `wanted` or fewer, for which sorted photons fit the device, beside what is on it, and
/// sorting them the loops of its driver. Fewer only where light paths store many more photons than is usual, or memory
/// is short.
std::uint32_t Integrator::levels_that_fit(std::uint32_t wanted) const {
    std::uint64_t bytes = 0;  // a photon slot and level
    for (const BufferRow& row : buffer_rows()) bytes += row.entries == Entries::levels ? row.element_bytes : 0;
    const std::uint64_t slots = counts().photon_slots;
    const std::uint64_t memory = device_.info().memory_bytes;
    const std::uint64_t left = memory - std::min(memory, device_.allocated_bytes());
    const auto fits = [&](std::uint64_t levels) {
        return levels * slots * sizeof(gpu::Photon) <= device_.largest_buffer(Access::records) &&
               levels * slots * bytes <= left / 2 && levels * slots / params_.sort_lanes <= most_sorted_a_lane;
    };
    while (wanted > 1 && !fits(wanted)) --wanted;
    return wanted;
}

/// No more levels from now on, nor of the grid in force.
void Integrator::limit_levels(std::uint32_t levels) {
    params_.most_levels = levels;
    Buffer& grid = buffer(Binding::grid);
    grid.upload_value(coarsest(grid.download_value<gpu::Grid>(), levels));
}

/// Some drivers compile a kernel when it first runs. Each runs once for an iteration that is not due, which leaves all
/// as it is, so that no time of compiling is on the clock.
void Integrator::compile(const std::vector<KernelId>& ids) {
    for (const KernelId id : ids) {
        Compiled& kernel = kernels_.at(id);
        kernel.forms.clear();
        for (const KernelForm& form : kernel.choice.forms()) {
            Specialization specialization = specialization_;
            specialization[SPEC_WORKGROUP] = form.group;
            specialization[SPEC_WAITS] = form.waits;
            kernel.forms.emplace_back(device_, kernel.report.name, words_of(id, estimator_), specialization);
        }
    }
    commands_.begin();
    const gpu::Launch not_due{.iteration = ~0u};
    for (const KernelId id : ids) {
        for (const Kernel& form : kernels_.at(id).forms) commands_.launch(form, 1, not_due);
    }
    commands_.finish();
}

/// Room for so many levels of the grid, and kernels that know of them.
void Integrator::add_levels(std::uint32_t levels) {
    params_.grid_levels = levels;
    allocate_sorted();
    specialization_[SPEC_LEVELS] = levels;
    compile({KernelId::knn, KernelId::gather});
}

/// True where the grid is planned before iteration i: 0, the powers of two, multiples of plan_interval, counted from
/// where a slice begins, with the grid that was there.
bool Integrator::plans_grid(std::uint32_t i) const {
    const std::uint32_t n = i - first_;
    return (n != 0 || first_ == 0) && ((n & (n - 1)) == 0 || n % plan_interval == 0);
}

// The algorithm box: every line is one pass over its buffers, each after the one before it.
void Integrator::iterate(std::uint32_t i, const Part& part) {
    Pass from = part.from;
    const auto runs = [&](Pass pass) { return from <= pass && pass <= part.to; };
    const auto round = [&](Pass pass) { return from == pass ? part.first_round : 0; };
    enter(part.first_band);  // the first of all, where there are passes of photons
    if (runs(Pass::photon)) launch_rounds(KernelId::photon, params_.photon_lanes, i, round(Pass::photon));
    if (runs(Pass::grid)) build_grid(i);
    if (part.to < Pass::eye) return;
    for (std::uint32_t band = part.first_band; band <= part.last_band; ++band) {
        enter(band);
        const std::uint64_t pixels = bands_.size(band);
        if (runs(Pass::eye)) launch_rounds(KernelId::eye, pixels, i, round(Pass::eye));
        if (runs(Pass::knn)) look_for_radii(i, round(Pass::knn));
        if (runs(Pass::area) && measures_area_) launch_rounds(KernelId::area, pixels, i, round(Pass::area));
        if (runs(Pass::gather)) launch_rounds(KernelId::gather, pixels, i, round(Pass::gather));
        if (runs(Pass::update)) update(i, pixels);
        from = Pass::photon;  // the bands that follow go through all
    }
}

void Integrator::look_for_radii(std::uint32_t i, std::uint32_t first_round) {
    gpu::Launch push{.iteration = i, .last_round = 1};
    push.search_group = kernels_.at(KernelId::knn).choice.forms().front().group;  // the form that launch_rounds takes
    if (first_round == 0) launch(KernelId::searches, 1, push);
    launch_rounds(KernelId::knn, std::nullopt, i, first_round);
}

void Integrator::update(std::uint32_t i, std::uint64_t pixels) {
    const std::uint32_t plans_next = plans_grid(i + 1) ? 1u : 0u;
    launch(KernelId::update, pixels,
           {.iteration = i, .last_round = 1, .plans_next = plans_next, .error_group = error_group(i)});
    launch(KernelId::advance, 1, {.iteration = i, .last_round = 1, .last_band = band_ + 1 == bands_.count() ? 1u : 0u});
}

void Integrator::build_grid(std::uint32_t i) {
    const gpu::Launch plain{.iteration = i, .last_round = 1};
    if (plans_grid(i)) launch(KernelId::grid_plan, 1, plain);
    scan(i, COUNTERS_OF_PATHS(params_), params_.photons + 1);  // photons before each path, and in all
    // Else a small render spends a third of its time on invocations that find nothing. No lights: no photons.
    const std::uint32_t striding = std::clamp(params_.photons, 1u, stride_invocations);
    launch(KernelId::grid_clear, striding, plain);
    for (std::uint32_t level = 0; level < params_.grid_levels; ++level) {
        gpu::Launch push = plain;
        push.level = level;
        launch(KernelId::grid_key, params_.photon_lanes, push);
    }
    for (std::uint32_t digit = 0; digit < digits_.count; ++digit) {
        gpu::Launch push = plain;
        push.digit_shift = digit * digits_.bits;
        push.reads_b = digit % 2;
        launch(KernelId::radix_count, params_.sort_lanes, push);
        scan(i, COUNTERS_OF_RADIX(params_), params_.sort_lanes << digits_.bits);
        launch(KernelId::radix_scatter, params_.sort_lanes, push);
    }
    launch(KernelId::grid_order, striding, plain);
    scan(i, COUNTERS_OF_CELLS, params_.cells + 1);  // photons before each cell
}

/// Exclusive scan of counters[first .. first + count).
void Integrator::scan(std::uint32_t i, std::uint32_t first, std::uint32_t count) {
    const gpu::Launch push{.iteration = i, .last_round = 1, .scan_first = first, .scan_count = count};
    launch(KernelId::scan_sums, params_.scan_blocks, push);
    launch(KernelId::scan_blocks, 1, push);
    launch(KernelId::scan_apply, params_.scan_blocks, push);
}

/// Begins to record launches, those of no band and of the first.
void Integrator::begin() {
    commands_.begin();
    launched_.clear();  // what was recorded last may never have been submitted
    band_ = 0;
}

/// What is launched from here on is of that band.
void Integrator::enter(std::uint32_t band) {
    if (band != band_) commands_.use(band);
    band_ = band;
}

gpu::Launch Integrator::in_band(gpu::Launch push) const {
    push.band = band_;
    push.first_pixel = std::uint32_t(bands_.first(band_));
    push.pixels = std::uint32_t(bands_.size(band_));
    return push;
}

void Integrator::launch(KernelId id, std::uint64_t invocations, const gpu::Launch& push) {
    const Compiled& kernel = kernels_.at(id);
    commands_.launch(kernel.forms[kernel.choice.index(push.iteration)], invocations, in_band(push));
    launched_.push_back(id);
}

/// As many rounds as it has needed so far; the last one blocks what follows where work is left. invocations: none
/// for those that the device has counted.
void Integrator::launch_rounds(KernelId id, std::optional<std::uint64_t> invocations, std::uint32_t i,
                               std::uint32_t first_round) {
    const Compiled& kernel = kernels_.at(id);
    for (std::uint32_t r = 0; r < kernel.rounds; ++r) {
        const std::uint32_t last = r + 1 == kernel.rounds ? 1 : 0;
        const gpu::Launch push{.iteration = i, .round = first_round + r, .last_round = last};
        if (invocations) {
            launch(id, *invocations, push);
        } else {
            commands_.launch_indirect(kernel.forms.front(), buffer(Binding::status),
                                      offsetof(gpu::Status, search_groups), in_band(push));
            launched_.push_back(id);
        }
    }
}

/// Submits, waits, and books the times by kernel.
void Integrator::finish() {
    const std::vector<KernelId> launched = std::exchange(launched_, {});
    const std::vector<Timing> timings = commands_.finish();  // in the order of the launches
    for (std::size_t i = 0; i < timings.size(); ++i) {
        PassReport& report = kernels_.at(launched[i]).report;
        ++report.calls;
        report.device_seconds += timings[i].seconds;
    }
}

/// Iterations one by one until every kernel's form is chosen, or up to `target`.
void Integrator::choose_kernels(std::uint32_t target) {
    const auto undecided = [](const auto& kernel) { return !kernel.second.choice.decided(); };
    while (completed_ < target && std::ranges::any_of(kernels_, undecided)) {
        const std::uint32_t iteration = completed_;
        std::map<KernelId, double> before;
        for (const auto& [id, kernel] : kernels_) before[id] = kernel.report.device_seconds;
        if (!run_to(iteration + 1)) continue;
        for (auto& [id, kernel] : kernels_) kernel.choice.book(iteration, kernel.report.device_seconds - before[id]);
    }
}

void Integrator::run(std::uint32_t count) {
    const std::uint32_t target = completed_ + count;
    choose_kernels(target);
    if (completed_ < target) run_to(target);
}

/// One submission, and more where work had to be finished: returns false then.
bool Integrator::run_to(std::uint32_t target) {
    bool undisturbed = true;
    const auto submit = [&] {
        begin();
        for (std::uint32_t i = completed_; i < target; ++i) iterate(i, all_passes());
        finish();
    };
    submit();
    while (unblock(all_passes())) {
        undisturbed = false;
        // The blocked iteration has been finished; those behind it did nothing.
        if (completed_ >= target) break;
        submit();
    }
    // Else an endless loop, as on drivers that stand for a card which is not there.
    if (completed_ != target) {
        throw Error(ExitCode::device_lost, fmt::format("the device '{}' does not run its kernels: {} of {} iterations "
                                                       "are complete",
                                                       device_.info().name, completed_, target));
    }
    return undisturbed;
}

/// Reads the status. Where a pass ran out of its budget: gives it more and finishes the iteration to where `part` ends.
/// Returns true where there was such a pass, so that iterations behind it have yet to run.
bool Integrator::unblock(const Part& part) {
    bool was_blocked = false;
    while (true) {
        gpu::Status status = buffer(Binding::status).download_value<gpu::Status>();
        const std::uint32_t blocked = status.blocked;
        const StatusCounts counts = take_counts(status, params_.step_budget, device_.info().name);
        rays_ += counts.rays + bands_.pixels * (status.completed - completed_);
        stored_ += counts.stored;
        invalid_ += counts.invalid;
        completed_ = status.completed;
        buffer(Binding::status).upload_value(status);
        if (blocked == 0) return was_blocked;
        was_blocked = true;

        const auto cut =
            std::ranges::find_if(kernel_rows(), [&](const KernelRow& row) { return (row.unfinished & blocked) != 0; });
        const bool out_of_steps = cut != kernel_rows().end();
        Part rest = part;
        rest.from = out_of_steps ? cut->pass : Pass::update;
        rest.first_band = status.band;
        rest.first_round = 1;
        if (blocked & PASS_CAPACITY) {
            params_.photon_capacity = std::max(params_.photon_capacity, status.capacity) * 5 / 4;
            allocate_photons();
            rest.from = Pass::photon;
            rest.first_round = 0;  // the paths start again and are the same
        }
        if (blocked & PASS_LEVELS) {
            rest.from = Pass::grid;
            rest.first_round = 0;
            const std::uint32_t levels = levels_that_fit(status.levels);
            if (levels < status.levels) limit_levels(levels);  // the grid is planned again
            add_levels(levels);
        }
        begin();
        iterate(completed_, rest);
        if (out_of_steps) kernels_.at(cut->id).rounds *= 2;
        finish();
    }
}

Image Integrator::resolve() {
    Image image;
    image.extent = {params_.width, params_.height};
    image.rgb.resize(bands_.pixels);
    for (std::uint32_t band = 0; band < bands_.count(); ++band) {
        begin();
        enter(band);
        launch(KernelId::resolve, bands_.size(band), {});
        finish();
        buffer(Binding::image).download_to(std::span(image.rgb).subspan(bands_.first(band), bands_.size(band)));
    }
    return image;
}

/// Of a buffer with one entry for every pixel of the picture.
template <typename T> std::vector<T> Integrator::of_pixels(Binding binding) const {
    std::vector<T> all(bands_.pixels);
    for (std::uint32_t band = 0; band < bands_.count(); ++band) {
        buffers_.at(binding, band).download_to(std::span(all).subspan(bands_.first(band), bands_.size(band)));
    }
    return all;
}

/// The same way back.
template <typename T> void Integrator::set_pixels(Binding binding, std::span<const T> values) {
    for (std::uint32_t band = 0; band < bands_.count(); ++band) {
        buffers_.at(binding, band).upload(values.subspan(bands_.first(band), bands_.size(band)));
    }
}

void Integrator::begin_slice(std::uint32_t first, std::span<const gpu::PixelState> states) {
    assert(states.size() == bands_.pixels);
    set_pixels(Binding::pixels, states);
    for (const BufferRow& row : buffer_rows()) {
        const std::uint64_t entries = entries_of(row, counts_);
        if (row.life != Life::summed || entries == 0) continue;
        const std::vector<std::byte> zeros(entries * row.element_bytes);
        for (std::uint32_t band = 0; band < bands_.count(); ++band) buffers_.at(row.binding, band).upload(zeros);
    }
    auto status = buffer(Binding::status).download_value<gpu::Status>();
    status.completed = first;
    buffer(Binding::status).upload_value(status);
    params_.keeps_radii = 1;
    buffer(Binding::params).upload_value(params_);
    first_ = completed_ = first;
    rays_ = stored_ = invalid_ = 0;
}

std::vector<gpu::PixelState> Integrator::pixel_states() const { return of_pixels<gpu::PixelState>(Binding::pixels); }

std::vector<float> Integrator::radii() const {
    std::vector<float> radii;
    radii.reserve(bands_.pixels);
    for (const gpu::PixelState& state : pixel_states()) {
        radii.push_back(float(std::sqrt(double(state.radius2)) / scale_));
    }
    return radii;
}

double Integrator::disc_width() const {
    const std::uint32_t band = bands_.count() - 1;
    const std::uint64_t count = bands_.size(band);
    const auto states = buffers_.at(Binding::pixels, band).download<gpu::PixelState>(count);
    const auto positions = buffers_.at(Binding::hit_position).download<gpu::HitPosition>(count);
    const auto emissions = buffers_.at(Binding::hit_emission).download<gpu::HitEmission>(count);
    std::vector<double> widths;
    for (std::uint64_t i = 0; i < count; ++i) {
        if ((positions[i].state & HIT_DIFFUSE) == 0 || !(emissions[i].footprint > 0.0f)) continue;
        const double pixel = double(emissions[i].footprint) * std::sqrt(std::numbers::pi);  // its side
        const double width = 2.0 * std::sqrt(double(states[i].radius2)) / (pixel * params_.height);
        widths.push_back(states[i].seeded != 0 ? width : 0.0);
    }
    if (widths.empty()) return 0.0;
    const auto middle = widths.begin() + std::ptrdiff_t(widths.size() / 2);
    std::ranges::nth_element(widths, middle);
    return *middle;
}

/// Without errors.
IterationSums Integrator::surface_sums() const {
    IterationSums sums{{params_.width, params_.height}, completed_ - first_, {}, {}, {}};
    const auto both = [](const auto& sum, const auto& low) { return glm::dvec3(sum) + glm::dvec3(low); };
    sums.film.reserve(bands_.pixels);
    for (const gpu::Film& film : of_pixels<gpu::Film>(Binding::film)) sums.film.push_back(both(film.sum, film.low));
    if (!counts_.aovs) return sums;
    const auto states = pixel_states();
    const auto aovs = of_pixels<gpu::Aovs>(Binding::aovs);
    sums.surfaces.resize(bands_.pixels);
    for (std::uint64_t i = 0; i < bands_.pixels; ++i) {
        SurfaceSums& sum = sums.surfaces[i];
        sum.albedo = both(aovs[i].albedo, aovs[i].albedo_low);
        sum.normal = both(aovs[i].normal, aovs[i].normal_low);
        sum.depth = double(aovs[i].depth) + double(aovs[i].depth_low);
        sum.hits = aovs[i].hits;
        for (std::uint32_t l = 0; l < LAYERS; ++l) sum.layer[l] = both(aovs[i].layer[l], aovs[i].layer_low[l]);
        sum.seen = states[i].seen;
        sum.photons = states[i].photons;
        sum.radius2 = states[i].radius2;
        sum.batch = states[i].batch;
        sum.rejections = float(states[i].rejections);
        sum.statistic = states[i].statistic;
    }
    return sums;
}

std::map<std::string, std::vector<float>> Integrator::aovs() const {
    assert(counts_.aovs);
    return surface_channels(surface_sums(), scale_);
}

ErrorSums Integrator::error_sums() const {
    assert(counts_.errors);
    ErrorSums sums{{params_.width, params_.height}, group_sizes(completed_), {}};
    const auto before = group_sizes(first_);
    for (std::uint32_t group = 0; group < ERROR_GROUPS; ++group) {
        sums.sizes[group] -= before[group];
        if (sums.sizes[group] == 0) continue;
        for (std::uint32_t band = 0; band < bands_.count(); ++band) {
            const std::uint64_t bytes = bands_.size(band) * sizeof(glm::vec4);
            const auto part = buffers_.at(Binding::errors, band).download<glm::vec4>(bands_.size(band), group * bytes);
            sums.of_group[group].insert(sums.of_group[group].end(), part.begin(), part.end());
        }
    }
    return sums;
}

IterationSums Integrator::sums() const {
    IterationSums sums = surface_sums();
    if (counts_.errors) sums.errors = error_sums();
    return sums;
}

void Integrator::set_params(const gpu::Params& params) {
    params_ = params;
    buffer(Binding::params).upload_value(params_);
}

void Integrator::run_kernel(KernelId kernel, std::uint64_t invocations, const gpu::Launch& push) {
    assert(bands_.count() == 1);
    begin();
    launch(kernel, invocations, push);
    finish();
}

void Integrator::run_from_grid() {
    assert(bands_.count() == 1);
    // In place of the eye pass.
    const auto hits = buffer(Binding::hit_position).download<gpu::HitPosition>(bands_.pixels);
    const auto states = of_pixels<gpu::PixelState>(Binding::pixels);
    std::vector<std::uint32_t> searches;
    for (std::uint32_t pixel = 0; pixel < bands_.pixels; ++pixel) {
        if ((hits[pixel].state & HIT_DIFFUSE) && states[pixel].seeded == 0) searches.push_back(pixel);
    }
    buffer(Binding::searches).upload(searches);
    auto status = buffer(Binding::status).download_value<gpu::Status>();
    status.searches = std::uint32_t(searches.size());
    buffer(Binding::status).upload_value(status);
    for (const Part& part : {Part{.from = Pass::grid, .to = Pass::grid}, Part{.from = Pass::knn}}) {
        begin();
        iterate(completed_, part);
        finish();
        unblock(part);
    }
}

double Integrator::seconds() const {
    double sum = 0.0;
    for (const auto& [id, kernel] : kernels_) {
        if (row_of(id).pass != Pass::picture) sum += kernel.report.device_seconds;
    }
    return sum;
}

void Integrator::fill(Report& report) const {
    report.passes.clear();
    for (const auto& [id, kernel] : kernels_) {
        if (kernel.report.calls == 0) continue;
        PassReport& pass = report.passes.emplace_back(kernel.report);
        const KernelChoice& choice = kernel.choice;
        if (choice.forms().size() > 1) pass.form = choice.decided() ? text_of(*choice.chosen()) : "being measured";
    }
    report.iterations = completed_ - first_;
    report.emitted_paths = std::uint64_t(report.iterations) * params_.photons;
    report.stored_photons = stored_;
    report.rays = rays_;
    report.invalid = invalid_;
    report.device_memory_bytes = device_.peak_bytes();
    report.memory = memory_of(buffers_.bytes(), bands_.count());
    report.device = device_.info().name;
    report.driver = device_.info().driver;
}

}  // namespace vkcppm
