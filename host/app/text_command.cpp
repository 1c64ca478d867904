#include "app/commands.h"
#include "app/console.h"

namespace vkcppm {

void execute(const TextOptions& options) { print_result(options.text); }

}  // namespace vkcppm
