#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/provenance.h"
#include "app/version.h"
#include "core/error.h"
#include "core/process.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

/// One thing that a render hangs on.
struct Finding {
    std::string what;
    std::string told;    // what there is of it
    std::string advice;  // one line to mend it; empty: nothing is amiss
};

double gigabytes(std::uint64_t bytes) { return double(bytes) * 1e-9; }

std::vector<Finding> examine(bool& can_render) {
    std::vector<Finding> findings;
    findings.push_back({"program", "vkcppm " + version(), ""});
    findings.push_back({"processor", processor(), ""});
    findings.push_back(
        {"memory",
         fmt::format("{:.1f} GB, {:.1f} GB available", gigabytes(total_memory()), gigabytes(available_memory())), ""});
    const VulkanInfo vulkan = vulkan_info();
    findings.push_back({"Vulkan loader", vulkan.loader.empty() ? "none" : vulkan.loader,
                        vulkan.loader.empty() ? "install libvulkan1 (Debian, Ubuntu) or vulkan-loader (Fedora)" : ""});
    const std::vector<DeviceInfo> devices = list_devices();
    for (const DeviceInfo& device : devices) {
        const std::string name = fmt::format("device {}", device.index);
        const std::string told = fmt::format("{} ({}), {}, Vulkan {}, {:.1f} GB", device.name, name_of(device.type),
                                             device.driver, device.api_version, gigabytes(device.memory_bytes));
        const std::string lacks = "it cannot run the kernels: " + device.unusable;
        findings.push_back({name, told, device.unusable.empty() ? "" : lacks});
        if (device.unusable.empty()) findings.push_back({"policy of " + name, device.policy, ""});
        can_render = can_render || device.unusable.empty();
    }
    if (!can_render) findings.push_back({"usable device", "none", driver_advice});
    findings.push_back({"validation layer", vulkan.has_validation_layer ? "there" : "none",
                        vulkan.has_validation_layer ? "" : "only for --validate: install vulkan-validationlayers"});
    return findings;
}

std::string plain_text(const std::vector<Finding>& findings) {
    std::string text;
    for (const auto& [what, told, advice] : findings) {
        text += fmt::format("{}: {}\n", what, told);
        if (!advice.empty()) text += fmt::format("   {}\n", advice);
    }
    return text;
}

nlohmann::ordered_json json_of(const std::vector<Finding>& findings) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const auto& [what, told, advice] : findings) {
        json.push_back({{"what", what}, {"told", told}, {"advice", advice}});
    }
    return json;
}

}  // namespace

void execute(const DoctorOptions& options) {
    bool can_render = false;
    const std::vector<Finding> findings = examine(can_render);
    print_result(options.json ? json_text(json_of(findings), 2) + "\n" : plain_text(findings));
    if (!can_render) throw Error(ExitCode::no_device, fmt::format("nothing here can render; {}", driver_advice));
}

}  // namespace vkcppm
