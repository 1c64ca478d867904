// The file of compiled kernels: where it lies, and that damage is told.

#include "app/pipeline_cache.h"

#include <string>

#include <gtest/gtest.h>

#include "support/files/variable.h"

namespace vkcppm {
namespace {

using test::Variable;

std::vector<std::byte> some_bytes() {
    std::vector<std::byte> bytes;
    for (int i = 0; i < 300; ++i) bytes.push_back(std::byte(i * i));
    return bytes;
}

TEST(PipelineCache, WhatWasSealedComesBack) {
    EXPECT_EQ(unsealed(sealed(some_bytes())), some_bytes());
    EXPECT_EQ(unsealed(sealed({})), std::vector<std::byte>());
}

TEST(PipelineCache, DamageAnywhereIsTold) {
    const std::string text = sealed(some_bytes());
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string damaged = text;
        damaged[i] ^= 1;
        EXPECT_FALSE(unsealed(damaged)) << "byte " << i << " of " << text.size();
        EXPECT_FALSE(unsealed(text.substr(0, i))) << "cut to " << i << " bytes of " << text.size();
    }
    EXPECT_FALSE(unsealed(text + "x"));
}

TEST(PipelineCache, TheFileIsOneOfTheDeviceAndItsDriver) {
    const Variable cache("XDG_CACHE_HOME", "/somewhere");
    DeviceInfo info;
    info.uuid = "6d657361-3232-2e33-2e36-000000000000";
    info.driver = "driver 1.0";
    const auto file = pipeline_file(info);
    ASSERT_TRUE(file);
    EXPECT_EQ(file->parent_path(), "/somewhere/vkcppm");
    DeviceInfo other = info;
    other.uuid.back() = '1';
    EXPECT_NE(pipeline_file(other), file);
    other = info;
    other.driver = "driver 1.1";
    EXPECT_NE(pipeline_file(other), file);
}

TEST(PipelineCache, TheFolderIsThatOfTheXdgSpecification) {
    const Variable home("HOME", "/home/someone");
    const auto folder = [] {
        const auto file = pipeline_file(DeviceInfo());
        return file ? file->parent_path().string() : "none";
    };
    for (const char* not_absolute : {"", "relative"}) {
        const Variable cache("XDG_CACHE_HOME", not_absolute);
        EXPECT_EQ(folder(), "/home/someone/.cache/vkcppm") << "XDG_CACHE_HOME '" << not_absolute << "'";
    }
    const Variable cache("XDG_CACHE_HOME", nullptr);
    EXPECT_EQ(folder(), "/home/someone/.cache/vkcppm");
    const Variable no_home("HOME", nullptr);
    EXPECT_EQ(folder(), "none");
}

}  // namespace
}  // namespace vkcppm
