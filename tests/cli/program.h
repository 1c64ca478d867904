#pragma once
// The built program under test: its runs, and what is expected of them.

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/files/places.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"

namespace vkcppm::test {

using Words = std::vector<std::string>;

/// A scene of the project.
inline std::string scene(const std::string& name) { return (source_folder() / "scenes" / (name + ".gltf")).string(); }

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Each test in a folder of its own.
class ProgramTest : public testing::Test {
protected:
    ProcessResult run(Words words) const {
        words.insert(words.begin(), program());
        return run_process(words, folder_.path());
    }

    TemporaryFolder folder_;
};

inline constexpr const char* memory_in_files =
    "the driver keeps device memory in files, which such a limit is for, too";

/// True where a limit on the size of files, in blocks of 512 bytes, stops the driver: lavapipe of Mesa 25 keeps device
/// memory in a file without a name. Tried with a picture that is smaller than the limit.
inline bool limit_stops_the_driver(int blocks) {
    const TemporaryFolder folder;
    const std::string script = "ulimit -f " + std::to_string(blocks) +
                               "; exec \"$0\" \"$1\" --size 4x4 --iterations 1 --photons 16 --quiet -o small.exr";
    return run_process({"/bin/sh", "-c", script, program(), scene("slab_floor")}, folder.path()).signal == SIGBUS;
}

inline void expect_done(const ProcessResult& result) {
    EXPECT_FALSE(result.timed_out);
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

/// Exit code `code`, nothing on standard output, and one line of error that holds all of `told`.
inline void expect_failure(const ProcessResult& result, int code, const Words& told, const std::string& what = "") {
    SCOPED_TRACE(what);
    EXPECT_FALSE(result.timed_out);
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(result.out, "");
    const std::vector<std::string> lines = lines_of(result.err);
    const auto is_error = [](const std::string& line) { return line.starts_with("error: "); };
    ASSERT_EQ(std::count_if(lines.begin(), lines.end(), is_error), 1) << result.err;
    EXPECT_TRUE(is_error(lines.back())) << result.err;
    for (const std::string& part : told) {
        EXPECT_TRUE(contains(lines.back(), part)) << "'" << part << "' is not in: " << lines.back();
    }
}

}  // namespace vkcppm::test
