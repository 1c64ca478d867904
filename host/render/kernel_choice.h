#pragma once
// Kernels in several forms that give the same bits, of which the fastest is found by measurement: what is best on
// software Vulkan need not be so on a GPU.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/kernels.h"
#include "vk/policy.h"

namespace vkcppm {

/// Invocations of a work group, unless measured otherwise.
inline constexpr std::uint32_t workgroup = 64;

/// One way to compile a kernel.
struct KernelForm {
    std::uint32_t group = workgroup;  // invocations of a work group, a power of two
    bool waits = false;               // lanes of the photon pass wait for the longest ray of their SIMD group

    bool operator==(const KernelForm&) const = default;
};

/// "groups of 64" or "groups of 64, lanes wait".
std::string text_of(const KernelForm& form);

/// The forms worth trying on a device, the likeliest first: the one that was measured on software Vulkan, or all.
std::vector<KernelForm> forms_for(const DevicePolicy& policy);

/// Those of `forms` that are worth it for a kernel of that row, each once.
std::vector<KernelForm> forms_of(const KernelRow& kernel, const std::vector<KernelForm>& forms);

/// Finds the fastest form of one kernel while it does its work: forms take turns from iteration to iteration until each
/// has run `rounds` times, and the one with the shortest run is kept.
class KernelChoice {
public:
    static constexpr std::uint32_t rounds = 3;

    /// At least one form.
    explicit KernelChoice(std::vector<KernelForm> forms);

    const std::vector<KernelForm>& forms() const { return forms_; }
    /// The index of the form that runs in an iteration.
    std::size_t index(std::uint32_t iteration) const { return chosen_.value_or(iteration % forms_.size()); }
    bool decided() const { return chosen_.has_value(); }
    /// The form that was chosen; none while it is measured.
    std::optional<KernelForm> chosen() const;
    /// Device seconds of all launches in one iteration, which ran undisturbed.
    void book(std::uint32_t iteration, double seconds);

private:
    struct Runs {
        std::uint32_t count = 0;
        double least = 0.0;  // seconds
    };
    std::vector<KernelForm> forms_;
    std::vector<Runs> runs_;
    std::optional<std::size_t> chosen_;
};

}  // namespace vkcppm
