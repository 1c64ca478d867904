#include "render/kernel_choice.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

namespace vkcppm {

std::string text_of(const KernelForm& form) {
    return fmt::format("groups of {}{}", form.group, form.waits ? ", lanes wait" : "");
}

std::vector<KernelForm> forms_for(const DevicePolicy& policy) {
    if (!policy.tries_forms) return {KernelForm{}};
    return {{workgroup, false}, {workgroup, true}, {32, false}, {128, false}};
}

std::vector<KernelForm> forms_of(const KernelRow& kernel, const std::vector<KernelForm>& forms) {
    std::vector<KernelForm> own;
    for (const KernelForm& form : forms) {
        const KernelForm worth{form.group, form.waits && kernel.forms == Forms::groups_and_waits};
        if (std::ranges::find(own, worth) == own.end()) own.push_back(worth);
    }
    if (kernel.forms == Forms::one) own.resize(1);
    return own;
}

KernelChoice::KernelChoice(std::vector<KernelForm> forms) : forms_(std::move(forms)), runs_(forms_.size()) {
    assert(!forms_.empty());
    if (forms_.size() == 1) chosen_ = 0;
}

std::optional<KernelForm> KernelChoice::chosen() const {
    if (!chosen_) return std::nullopt;
    return forms_[*chosen_];
}

void KernelChoice::book(std::uint32_t iteration, double seconds) {
    if (chosen_) return;
    Runs& run = runs_[index(iteration)];
    run.least = run.count == 0 ? seconds : std::min(run.least, seconds);
    ++run.count;
    if (std::ranges::any_of(runs_, [](const Runs& r) { return r.count < rounds; })) return;
    chosen_ = std::size_t(std::ranges::min_element(runs_, {}, &Runs::least) - runs_.begin());
}

}  // namespace vkcppm
