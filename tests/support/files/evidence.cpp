#include "support/files/evidence.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/png.h"
#include "support/files/places.h"
#include "support/names.h"

namespace vkcppm::test {
namespace {

Image absolute_difference(const Image& a, const Image& b) {
    Image difference = a;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) difference.rgb[i] = glm::abs(a.rgb[i] - b.rgb[i]);
    return difference;
}

std::string name_of_running_test() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    return identifier(std::string(test.test_suite_name()) + "." + test.name());
}

bool same_bits(const glm::vec3& a, const glm::vec3& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

}  // namespace

void leave_pictures(const Image& got, const Image& wanted, const std::string& part) {
    const std::string name = fmt::format("{}{}{}", name_of_running_test(), part.empty() ? "" : "_", identifier(part));
    const std::string base = (failure_folder() / name).string();
    std::vector<std::pair<std::string, Image>> pictures = {{"got", got}, {"wanted", wanted}};
    if (got.extent == wanted.extent) pictures.emplace_back("difference", absolute_difference(got, wanted));
    for (const auto& [kind, picture] : pictures) {
        write_exr(base + "_" + kind + ".exr", picture);
        write_png(base + "_" + kind + ".png", picture);
    }
    ADD_FAILURE() << "the pictures are " << base << "_{got,wanted,difference}.{exr,png}";
}

void expect_same_picture(const Image& got, const Image& wanted, const std::string& part) {
    if (got.extent == wanted.extent && std::ranges::equal(got.rgb, wanted.rgb, same_bits)) return;
    std::size_t differing = 0, first = 0;
    for (std::size_t i = 0; i < std::min(got.rgb.size(), wanted.rgb.size()); ++i) {
        if (same_bits(got.rgb[i], wanted.rgb[i])) continue;
        if (differing++ == 0) first = i;
    }
    ADD_FAILURE() << part << ": of " << got.rgb.size() << " pixels " << differing << " differ, the first is " << first;
    leave_pictures(got, wanted, part);
}

}  // namespace vkcppm::test
