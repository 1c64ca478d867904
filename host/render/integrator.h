#pragma once
// The iteration as launches: owns the device's buffers and kernels of one render and runs iterations of it.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "render/buffers.h"
#include "render/error_estimate.h"
#include "render/kernel_choice.h"
#include "render/kernels.h"
#include "render/memory.h"
#include "render/report.h"
#include "render/scene_on_device.h"
#include "render/settings.h"
#include "render/sums.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm {

class Integrator {
public:
    /// Allocates the buffers, compiles the pipelines. `scene` must outlive this, `settings` be resolved. forms: in
    /// which kernels are compiled, those of the device where there are none; most_band_pixels: of a band of the
    /// picture, 0: as many as is best. Every form and every number of bands gives the same bits.
    /// Throws Error(out_of_device_memory) where the picture does not fit the device beside what is on it.
    Integrator(const SceneOnDevice& scene, const Camera& camera, const Settings& settings,
               std::vector<KernelForm> forms = {}, std::uint64_t most_band_pixels = 0);

    /// Runs `count` iterations in one submission, or more where work had to be finished in further rounds.
    /// Throws Error(device_lost), Error(internal) where a ray cannot be traced within the device's limits.
    void run(std::uint32_t count);

    /// Hash of what a pass wrote for those after it.
    struct PassHash {
        std::string pass;  // photon, grid, eye, knn, gather or update
        std::uint64_t hash = 0;
    };

    /// Runs one iteration, a submission a pass, and returns the hash of each. Two renders that do the same have the
    /// same, whatever the device's lanes, work groups and budgets: what passes leave for themselves alone is not in it.
    std::vector<PassHash> run_hashed();

    /// All that an iteration leaves to the next on the device, as bytes: pixels, film, statistics, grid. What is hit,
    /// stored or found within an iteration is made anew by each.
    std::vector<std::byte> save() const;

    /// Goes on from what save() and fill() gave: the iterations from there on give the bits they would have given.
    /// Scene, camera and settings must be those of then. Throws Error(bad_input) where `state` cannot be theirs.
    void restore(const Report& report, std::span<const std::byte> state);

    /// Goes on with iteration `first`, after nothing: what is summed begins anew, and pixels take these
    /// states [P], whose radii stay where photons gave them, whatever the estimator's rule. Grid and statistics are
    /// those that stand there. Reports count from here on.
    void begin_slice(std::uint32_t first, std::span<const gpu::PixelState> states);

    std::uint32_t completed() const { return completed_; }

    /// Mean over the completed iterations.
    Image resolve();

    /// The channels of Rendering::aovs. Asserts that the settings asked for them.
    std::map<std::string, std::vector<float>> aovs() const;

    /// What errors are estimated from. Asserts that the settings asked for them.
    ErrorSums error_sums() const;

    /// What the iterations so far have added up to, since begin_slice() where it was called, surfaces and errors where
    /// the settings asked for them.
    IterationSums sums() const;

    /// [P] What pixels remember.
    std::vector<gpu::PixelState> pixel_states() const;

    /// Frame units a metre.
    double scale() const { return scale_; }

    /// [P] m: the radius of every pixel's disc now; 0 where none of its eye paths has gathered yet.
    std::vector<float> radii() const;

    /// How wide discs are that photons gave, in heights of the picture at their depth: the median over the pixels of
    /// the last band that have gathered in the last iteration; 0 where photons gave most of them none.
    double disc_width() const;

    /// Totals so far: passes, iterations, paths, photons, rays, device memory.
    void fill(Report& report) const;

    /// The clock of core/curve.h: device time of the passes so far; resolve() is not on it.
    double seconds() const;

    /// Contributions that were not finite and were dropped.
    std::uint64_t invalid() const { return invalid_; }

    /// For tests, which drive single kernels on states of their own: a buffer, the parameters (uploaded by set_params),
    /// one launch of a kernel. Of pictures of one band.
    Buffer& buffer(Binding binding) { return buffers_.at(binding); }
    const gpu::Params& params() const { return params_; }
    void set_params(const gpu::Params& params);
    void run_kernel(KernelId kernel, std::uint64_t invocations, const gpu::Launch& push);

    /// For tests, which bring hits and photons of their own: one iteration from the grid on.
    void run_from_grid();

private:
    /// A kernel in its forms, and what it has cost.
    struct Compiled {
        KernelChoice choice;
        std::vector<Kernel> forms;  // those of `choice`
        PassReport report;
        std::uint32_t rounds = 1;  // that it has needed so far
    };

    void set_estimator_params(const FlatScene& scene, const Settings& settings);
    Counts counts() const;
    void allocate_photons();
    void allocate_sorted();
    std::uint32_t levels_that_fit(std::uint32_t wanted) const;
    void limit_levels(std::uint32_t levels);
    void add_levels(std::uint32_t levels);
    void compile(const std::vector<KernelId>& ids);
    /// Passes of an iteration: from one in a band, at some round of it, to one in a band that is not before it. What
    /// photons do comes before all bands.
    struct Part {
        Pass from = Pass::photon;
        Pass to = Pass::update;
        std::uint32_t first_band = 0;
        std::uint32_t last_band = 0;
        std::uint32_t first_round = 0;
    };
    Part all_passes() const { return {.last_band = bands_.count() - 1}; }
    void iterate(std::uint32_t iteration, const Part& part);
    void begin();
    void enter(std::uint32_t band);
    void launch(KernelId id, std::uint64_t invocations, const gpu::Launch& push);
    gpu::Launch in_band(gpu::Launch push) const;
    void launch_rounds(KernelId id, std::optional<std::uint64_t> invocations, std::uint32_t iteration,
                       std::uint32_t first_round);
    void build_grid(std::uint32_t iteration);
    void look_for_radii(std::uint32_t iteration, std::uint32_t first_round);
    void update(std::uint32_t iteration, std::uint64_t pixels);
    void scan(std::uint32_t iteration, std::uint32_t offset, std::uint32_t count);
    void finish();
    bool run_to(std::uint32_t target);
    void choose_kernels(std::uint32_t target);
    bool unblock(const Part& part);
    bool plans_grid(std::uint32_t i) const;
    template <typename T> std::vector<T> of_pixels(Binding binding) const;
    template <typename T> void set_pixels(Binding binding, std::span<const T> values);
    IterationSums surface_sums() const;
    std::uint64_t arrays_of(const BufferRow& row) const;
    template <typename Buffers, typename Use> void each_carried(Buffers& buffers, Use use) const;
    class Written;
    void add_written(Written& written, Pass pass, std::uint32_t band) const;
    std::uint64_t state_bytes() const;

    Device& device_;
    std::vector<KernelForm> forms_;
    gpu::Params params_{};
    Counts counts_;  // of what the photons' slots and levels do not change
    Bands bands_;
    bool measures_area_ = false;  // of discs
    Digits digits_ = digits_of(params_);
    Bindings bindings_;
    Commands commands_;
    Buffers buffers_;
    Specialization specialization_;
    std::string_view estimator_;
    std::map<KernelId, Compiled> kernels_;
    std::vector<KernelId> launched_;  // since the last submission, in order
    double scale_ = 1.0;              // frame units a metre
    std::uint32_t band_ = 0;          // of which launches are recorded
    std::uint32_t first_ = 0;         // iteration, since which there are sums
    std::uint32_t completed_ = 0;
    std::uint64_t rays_ = 0;
    std::uint64_t stored_ = 0;
    std::uint64_t invalid_ = 0;
};

}  // namespace vkcppm
