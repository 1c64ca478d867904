#pragma once
// Rights that root does not heed.

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

namespace vkcppm::test {

/// While it lives, root is nobody, who owns `folder`; anybody else stays who he is.
class Unprivileged {
public:
    explicit Unprivileged(const std::filesystem::path& folder) {
        if (!was_root_) return;
        EXPECT_EQ(::chown(folder.c_str(), nobody, nobody), 0);
        EXPECT_EQ(::setresuid(nobody, nobody, 0), 0);
    }
    ~Unprivileged() {
        if (was_root_) {
            EXPECT_EQ(::setresuid(0, 0, 0), 0);
        }
    }

private:
    static constexpr uid_t nobody = 65534;
    const bool was_root_ = ::geteuid() == 0;
};

}  // namespace vkcppm::test
