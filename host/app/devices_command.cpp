#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/console.h"
#include "app/provenance.h"
#include "vk/device.h"

namespace vkcppm {
namespace {

nlohmann::ordered_json json_of(const std::vector<DeviceInfo>& devices) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const DeviceInfo& device : devices) {
        json.push_back({{"index", device.index},
                        {"name", device.name},
                        {"type", name_of(device.type)},
                        {"driver", device.driver},
                        {"api_version", device.api_version},
                        {"uuid", device.uuid},
                        {"memory_bytes", device.memory_bytes},
                        {"usable", device.unusable.empty()},
                        {"unusable_because", device.unusable},
                        {"first_choice", device.first_choice}});
    }
    return json;
}

std::string plain_text(const std::vector<DeviceInfo>& devices) {
    if (devices.empty()) return "no Vulkan devices: vkcppm doctor tells why\n";
    std::string text;
    for (const DeviceInfo& device : devices) {
        text += fmt::format("{}: {} ({})\n   {}, Vulkan {}, {:.1f} GiB\n   uuid:{}\n", device.index, device.name,
                            name_of(device.type), device.driver, device.api_version,
                            double(device.memory_bytes) / (1024.0 * 1024.0 * 1024.0), device.uuid);
        if (!device.unusable.empty()) {
            text += fmt::format("   unusable: {}\n", device.unusable);
        } else {
            text +=
                device.first_choice ? "   used where --device names no other\n" : "   used where --device names it\n";
        }
    }
    return text;
}

}  // namespace

void execute(const DevicesOptions& options) {
    const std::vector<DeviceInfo> devices = list_devices();
    print_result(options.json ? json_text(json_of(devices), 2) + "\n" : plain_text(devices));
}

}  // namespace vkcppm
