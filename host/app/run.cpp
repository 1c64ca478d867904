#include "app/run.h"

#include <csignal>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <type_traits>
#include <variant>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/console.h"
#include "app/options.h"
#include "core/error.h"

namespace vkcppm {
namespace {

/// Gives a closed standard stream a descriptor that cannot be written to, lest an output file take its number and
/// messages end up in the picture.
void occupy_standard_streams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) == -1) {
            ::open("/dev/null", O_RDONLY);  // takes the lowest free number
        }
    }
}

int fail(ExitCode code, const std::string& message) {
    print_message("error: " + message);
    return int(code);
}

}  // namespace

int run(int argc, const char* const* argv) {
    occupy_standard_streams();
    std::signal(SIGPIPE, SIG_IGN);  // a write into a closed pipe or past the file size limit is an error to report,
    std::signal(SIGXFSZ, SIG_IGN);  // not an end without a word
    try {
        const auto carry_out = [](const auto& options) {
            if constexpr (std::is_void_v<decltype(execute(options))>) {
                execute(options);
                return ExitCode::ok;
            } else {
                return execute(options);
            }
        };
        return int(std::visit(carry_out, parse_options(argc, argv)));
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::filesystem::filesystem_error& error) {  // such as a current folder that has been removed
        return fail(ExitCode::no_input, fmt::format("{}: {}", error.path1().string(), error.code().message()));
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::internal, "out of memory");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, std::string("internal: ") + error.what());
    }
}

}  // namespace vkcppm
