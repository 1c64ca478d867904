#include "support/files/process.h"

#include <chrono>
#include <csignal>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/files/files.h"

namespace vkcppm::test {
namespace {

/// Asks every few milliseconds until `done`; false where five minutes pass before.
bool poll(const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!done()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

}  // namespace

Process::Process(const std::vector<std::string>& words, const std::filesystem::path& folder) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const std::string out = (outputs_ / "out").string();
    const std::string err = (outputs_ / "err").string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int error = posix_spawn(&id_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " + words[0] + ": " + std::strerror(error));
}

Process::~Process() {
    if (!reaped_) {
        ::kill(id_, SIGKILL);
        ::waitpid(id_, &status_, 0);
    }
}

void Process::send(int signal) { ::kill(id_, signal); }

bool Process::ended() {
    reaped_ = reaped_ || ::waitpid(id_, &status_, WNOHANG) == id_;
    return reaped_;
}

bool Process::wait_for_message(std::string_view text) {
    const auto said = [&] { return read_bytes(outputs_ / "err").find(text) != std::string::npos; };
    poll([&] { return said() || ended(); });
    return said();
}

ProcessResult Process::wait() {
    ProcessResult result;
    if (!poll([&] { return ended(); })) {
        result.timed_out = true;
        ::kill(id_, SIGKILL);
        ::waitpid(id_, &status_, 0);
        reaped_ = true;
    }
    if (WIFEXITED(status_)) {
        result.exit_code = WEXITSTATUS(status_);
    } else if (WIFSIGNALED(status_)) {
        result.signal = WTERMSIG(status_);
    }
    result.out = read_bytes(outputs_ / "out");
    result.err = read_bytes(outputs_ / "err");
    return result;
}

ProcessResult run_process(const std::vector<std::string>& words, const std::filesystem::path& folder) {
    return Process(words, folder).wait();
}

}  // namespace vkcppm::test
