#pragma once
// The commands of the program. Each throws Error where it cannot do what was asked.

#include "app/options.h"
#include "core/error.h"

namespace vkcppm {

// "Interrupted" below: after SIGINT, SIGTERM or SIGHUP.

/// Renders the scene and writes the EXR, and the PNG and the statistics where asked for. Interrupted, the iteration is
/// finished and what there is is written. Throws Error(internal) after writing where the validation layer was asked for
/// and had something to say.
void execute(const RenderOptions& options);

/// Renders the pilot of a job that many machines share and writes its folder, or extends one. A job that is there and
/// is the same is left as it is, another one is refused. Interrupted, it writes nothing: Error(interrupted).
void execute(const PlanOptions& options);

/// Renders the slices of a shard that are not there, or are damaged, and writes each as it is done. Interrupted, it
/// loses the slice that was begun: Error(interrupted).
void execute(const ShardOptions& options);

/// Adds up what there is of a job and writes the picture. Throws Error(no_input) where something is missing and none
/// may be, Error(usage) where there is a slice of another job.
void execute(const MergeOptions& options);

/// Prints how far a job is.
void execute(const StatusOptions& options);

/// Races estimators and writes the folder: page, curves, settings, pictures. Interrupted, the submission is finished
/// and what there is is written. Throws Error(usage) where there is no reference for the scene.
void execute(const RaceOptions& options);

/// Makes a reference, writes its EXR, and the statistics where asked for, and prints what is known of its error.
/// Interrupted, it ends as soon as an error can be told.
void execute(const ReferenceOptions& options);

/// Prints the measures of study/measures.h.
void execute(const CompareOptions& options);

/// Says in a line whether the image is still what the reference is, writes what was asked for, and gives ok or differs;
/// or puts the image in the place of the reference.
ExitCode execute(const CheckOptions& options);

/// Prints what is in the scene and how each material will be treated.
void execute(const InfoOptions& options);

/// Prints the Vulkan devices, usable or not.
void execute(const DevicesOptions& options);

/// Prints what a render hangs on: processor, memory, Vulkan, devices, and of what is amiss a line to mend it. Throws
/// Error(no_device) after that where no device can render.
void execute(const DoctorOptions& options);

/// Prints the text.
void execute(const TextOptions& options);

}  // namespace vkcppm
