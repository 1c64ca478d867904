#include "io/atomic_file.h"

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <random>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
    throw Error(ExitCode::cannot_write, "cannot write " + file.string() + ": " + reason);
}

[[noreturn]] void fail_with_errno(const fs::path& file) { fail(file, std::strerror(errno)); }

/// Whether bytes run through it and are gone, as through /dev/null or a named pipe: there is nothing to replace.
bool is_stream(const fs::path& file) {
    std::error_code missing;
    const fs::file_status status = fs::status(file, missing);
    return fs::is_character_file(status) || fs::is_fifo(status);
}

/// The file that a rename would replace: `file`, or what it links to, be that there or not. Throws where that is no
/// file one may replace.
fs::path replaceable(const fs::path& file) {
    if (!file.has_filename()) fail(file, "it names no file");
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) {
        if (!fs::is_symlink(fs::symlink_status(file, error))) return file;
        fs::path target = fs::weakly_canonical(file.parent_path() / fs::read_symlink(file), error);
        if (error || fs::is_symlink(fs::symlink_status(target, error))) fail(file, "it is a link that leads nowhere");
        return target;
    }
    if (!fs::is_regular_file(status)) {
        fail(file, fs::is_directory(status) ? "it is a folder" : "it is not a regular file");
    }
    if (::access(file.c_str(), W_OK) != 0) fail_with_errno(file);
    return fs::canonical(file);
}

void write_all(int descriptor, std::string_view bytes, const fs::path& file) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(std::size_t(written));
        } else if (errno != EINTR) {
            fail_with_errno(file);
        }
    }
}

/// Closes a descriptor at the end of its scope.
class Closed {
public:
    explicit Closed(int descriptor) : descriptor_(descriptor) {}
    Closed(const Closed&) = delete;
    Closed& operator=(const Closed&) = delete;
    ~Closed() { ::close(descriptor_); }

private:
    int descriptor_;
};

/// An open temporary file beside its target; removed on destruction unless committed.
class Part {
public:
    explicit Part(const fs::path& file) : file_(file), target_(replaceable(file)) {
        // By process and by chance: containers that share a folder may each be process 1. Of a name that is as long as
        // names may be there is no room for all.
        const std::string suffix = fmt::format(".{}.{:08x}.part", ::getpid(), std::random_device()());
        const std::string name = target_.filename().string().substr(0, NAME_MAX - suffix.size());
        part_ = target_.parent_path() / (name + suffix);
        descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (descriptor_ < 0) fail_with_errno(file_);
        // Who could read the old file can read the new one, and nobody else.
        struct stat old = {};
        if (::stat(target_.c_str(), &old) == 0) ::fchmod(descriptor_, old.st_mode & 0777);
    }
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;
    ~Part() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!committed_) ::unlink(part_.c_str());
    }

    void write(std::string_view bytes) { write_all(descriptor_, bytes, file_); }

    void commit() {
        // Without it a loss of power may leave the new name to a file without its bytes.
        if (::fsync(descriptor_) != 0) fail_with_errno(file_);
        if (::close(std::exchange(descriptor_, -1)) != 0 || std::rename(part_.c_str(), target_.c_str()) != 0) {
            fail_with_errno(file_);
        }
        committed_ = true;
    }

private:
    fs::path file_;  // as the caller names it, for messages
    fs::path target_;
    fs::path part_;
    int descriptor_ = -1;
    bool committed_ = false;
};

}  // namespace

void write_file(const fs::path& file, std::string_view bytes) { write_file(file, {bytes}); }

bool is_standard_output(const fs::path& file) { return file == "-" || file == "/dev/stdout"; }

void write_file(const fs::path& file, std::initializer_list<std::string_view> parts) {
    if (is_standard_output(file)) {
        for (const std::string_view bytes : parts) write_all(STDOUT_FILENO, bytes, file);
        return;
    }
    if (is_stream(file)) {
        const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor < 0) fail_with_errno(file);
        const Closed closed(descriptor);
        for (const std::string_view bytes : parts) write_all(descriptor, bytes, file);
        return;
    }
    Part part(file);
    for (const std::string_view bytes : parts) part.write(bytes);
    part.commit();
}

void check_writable(const fs::path& file) {
    if (is_standard_output(file)) {
        const int flags = ::fcntl(STDOUT_FILENO, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) fail(file, "standard output is closed");
    } else if (!is_stream(file)) {
        Part part(file);
    } else if (::access(file.c_str(), W_OK) != 0) {  // to open a pipe would wait for its reader
        fail_with_errno(file);
    }
}

}  // namespace vkcppm
