#include "core/input_file.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/error.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/files/unprivileged.h"
#include "support/thrown.h"

namespace vkcppm {
namespace {

TEST(InputFile, IsARegularFileThatMayBeRead) {
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "file", "");
    EXPECT_EQ(why_unreadable(folder / "file"), std::nullopt);
    EXPECT_EQ(why_unreadable(folder / "missing"), "no such file");
    EXPECT_EQ(why_unreadable(folder / "file" / "in a file"), "no such file");
    EXPECT_EQ(why_unreadable(folder.path()), "it is a folder");
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(why_unreadable(folder / "pipe"), "it is not a regular file") << "which would wait for its writer";
    std::filesystem::create_symlink("loop", folder / "loop");
    EXPECT_EQ(why_unreadable(folder / "loop"), "Too many levels of symbolic links");
    std::filesystem::permissions(folder / "file", std::filesystem::perms::none);
    const test::Unprivileged unprivileged(folder.path());
    EXPECT_EQ(why_unreadable(folder / "file"), "Permission denied");
    const auto error = test::thrown_by([&] { require_file(folder / "file"); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::no_input);
    EXPECT_EQ(error->what(), (folder / "file").string() + ": Permission denied");
}

}  // namespace
}  // namespace vkcppm
