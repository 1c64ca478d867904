#include "app/validation.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/console.h"
#include "core/error.h"

namespace vkcppm {

void check_validation(const Device& device) {
    const std::vector<std::string> messages = device.validation_messages();
    for (const std::string& message : messages) print_message("validation: " + message);
    if (!messages.empty()) {
        throw Error(ExitCode::internal, fmt::format("{} messages of the validation layer", messages.size()));
    }
}

}  // namespace vkcppm
