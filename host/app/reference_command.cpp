#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/load.h"
#include "app/outputs.h"
#include "app/pipeline_cache.h"
#include "app/progress.h"
#include "app/reference_provenance.h"
#include "app/validation.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "study/reference.h"

namespace vkcppm {
namespace {

Reference refine_with_progress(const Scene& scene, const ReferenceSettings& settings, const ReferenceOptions& options,
                               Device& device) {
    ProgressLine line(stderr, ::isatty(STDERR_FILENO) == 1, settings.render.seconds);
    return make_reference(scene, settings, device, [&](const ReferenceProgress& progress) {
        if (!options.quiet) {
            line.update(progress.wall_seconds, fmt::format("{}: {} paths a pixel, {} iterations of caustics{}",
                                                           duration_text(progress.wall_seconds), progress.samples,
                                                           progress.iterations, relmse_text(progress)));
        }
        return !interrupted();
    });
}

}  // namespace

void execute(const ReferenceOptions& options) {
    catch_interrupts();
    const std::vector<Output> outputs = {{"-o", options.output, ".exr"}, {"--stats", options.stats, ".json"}};
    check_outputs({options.scene.file, options.scene.environment}, outputs, true);
    const Scene scene = load_scene(options.scene);
    check_outputs({scene.inputs.begin(), scene.inputs.end()}, outputs, true);
    tell_warnings(scene, options.scene);
    // A bad value is told before the device is asked for.
    const ReferenceSettings settings = resolve_reference(options.settings, scene);
    Device device(options.device);
    const PipelineCache cache(device, options.device.cache);
    const Reference reference = refine_with_progress(scene, settings, options, device);
    print_warnings(reference.warnings);
    const ExrChannels channels = reference_channels(reference);
    if (const std::size_t count = options.half ? beyond_halves(channels) : 0) {
        print_warnings(
            std::vector{fmt::format("{} numbers of the picture are beyond 65504, which they become by --half", count)});
    }
    write_exr(options.output, channels, reference_attributes(options, scene, reference),
              options.half ? ExrDepth::half : ExrDepth::full);
    if (options.stats) write_file(*options.stats, reference_json(options, scene, reference, true));
    print_result(options.json ? reference_json(options, scene, reference, false) : reference_summary(reference));
    check_validation(device);
}

}  // namespace vkcppm
