#include "io/atomic_file.h"

#include <csignal>
#include <set>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/files/unprivileged.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

/// While it lives, no file of this process may grow past `bytes`: a full disk for everybody.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &previous_);
        rlimit limit = previous_;
        limit.rlim_cur = bytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &previous_);
        std::signal(SIGXFSZ, previous_handler_);
    }

private:
    rlimit previous_{};
    void (*previous_handler_)(int);
};

void expect_cannot_write(const std::optional<Error>& error, const std::string& file) {
    ASSERT_TRUE(error) << file << " was written";
    EXPECT_EQ(error->code(), ExitCode::cannot_write) << error->what();
    EXPECT_NE(std::string(error->what()).find(file), std::string::npos) << error->what();
}

TEST(AtomicFile, ReplacesWhatIsThere) {
    const test::TemporaryFolder folder;
    const std::string bytes("new\0bytes\n", 10);
    test::write_bytes(folder / "a", "old and longer than the new ones");
    write_file(folder / "a", bytes);
    EXPECT_EQ(test::read_bytes(folder / "a"), bytes);
    EXPECT_EQ(test::names_in(folder.path()), Names{"a"});
}

TEST(AtomicFile, TakesNamesAsLongAsTheyMayBe) {
    const test::TemporaryFolder folder;
    for (const std::size_t bytes : {230u, 244u, 255u}) {
        const std::string name(bytes, 'n');
        write_file(folder / name, "new");
        EXPECT_EQ(test::read_bytes(folder / name), "new") << bytes;
    }
    EXPECT_EQ(test::names_in(folder.path()).size(), 3u);
}

TEST(AtomicFile, KeepsTheOldFileWhereTheDiskIsFull) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a", "good");
    std::optional<Error> error;
    {
        const FileSizeLimit limit(1000);
        error = test::thrown_by([&] { write_file(folder / "a", std::string(5000, 'x')); });
    }
    expect_cannot_write(error, (folder / "a").string());
    EXPECT_EQ(test::read_bytes(folder / "a"), "good");
    EXPECT_EQ(test::names_in(folder.path()), Names{"a"}) << "the temporary file was left behind";
}

TEST(AtomicFile, LeavesSymbolicLinksInPlace) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "file", "old");
    fs::create_symlink("file", folder / "link");
    write_file(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(test::read_bytes(folder / "file"), "new");
}

TEST(AtomicFile, FollowsALinkToAFileThatIsNotThereYet) {
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    fs::create_symlink("sub/file", folder / "link");
    check_writable(folder / "link");
    write_file(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(test::read_bytes(folder / "sub/file"), "new");
    fs::create_symlink("loop", folder / "loop");
    expect_cannot_write(test::thrown_by([&] { write_file(folder / "loop", "x"); }), (folder / "loop").string());
    EXPECT_TRUE(fs::is_symlink(folder / "loop"));
}

TEST(AtomicFile, KeepsWhoMayReadAFile) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a", "secret");
    fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
    write_file(folder / "a", "new");
    EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, WritesThroughDevicesAndPipes) {
    check_writable("/dev/null");
    write_file("/dev/null", "x");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    expect_cannot_write(test::thrown_by([] { write_file("/dev/full", "x"); }), "/dev/full");
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    check_writable(folder / "pipe");
    std::string read;
    std::thread reader([&] { read = test::read_bytes(folder / "pipe"); });
    write_file(folder / "pipe", {"one ", "two"});
    reader.join();
    EXPECT_EQ(read, "one two");
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(AtomicFile, RefusesWhatIsNoFile) {
    const test::TemporaryFolder folder;
    for (const std::string& file : {folder.path().string(), (folder / "missing/a").string(), (folder / "a/").string(),
                                    std::string("/proc/a"), std::string()}) {
        expect_cannot_write(test::thrown_by([&] { write_file(file, "x"); }), file);
        expect_cannot_write(test::thrown_by([&] { check_writable(file); }), file);
    }
    EXPECT_TRUE(test::names_in(folder.path()).empty());
}

TEST(AtomicFile, RefusesWhatIsProtected) {
    const test::TemporaryFolder folder;
    const test::Unprivileged unprivileged(folder.path());
    test::write_bytes(folder / "a", "good");
    fs::permissions(folder / "a", fs::perms::owner_read);
    expect_cannot_write(test::thrown_by([&] { check_writable(folder / "a"); }), (folder / "a").string());
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    expect_cannot_write(test::thrown_by([&] { check_writable(folder / "b"); }), (folder / "b").string());
    expect_cannot_write(test::thrown_by([&] { write_file(folder / "b", "x"); }), (folder / "b").string());
    fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(AtomicFile, CheckingLeavesNoTrace) {
    const test::TemporaryFolder folder;
    check_writable(folder / "a");
    EXPECT_TRUE(test::names_in(folder.path()).empty());
    test::write_bytes(folder / "a", "good");
    check_writable(folder / "a");
    EXPECT_EQ(test::read_bytes(folder / "a"), "good");
    EXPECT_EQ(test::names_in(folder.path()), Names{"a"});
}

}  // namespace
}  // namespace vkcppm
