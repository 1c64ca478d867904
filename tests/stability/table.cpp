#include "stability/table.h"

#include <cassert>
#include <cmath>
#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "support/files/evidence.h"

namespace vkcppm::test {
namespace {

struct Row {
    std::string name;
    double error, tolerance;
    bool holds() const { return error <= tolerance; }
};

std::vector<Row> rows;

class Printer : public testing::Environment {
public:
    void TearDown() override {
        if (rows.empty()) return;
        std::puts("| case | error | tolerance | verdict |\n|---|---|---|---|");
        for (const Row& row : rows) {
            std::puts(fmt::format("| {} | {:.2g} | {:.2g} | {} |", row.name, row.error, row.tolerance,
                                  row.holds() ? "holds" : "FAILS")
                          .c_str());
        }
    }
};

// Owned and called by GoogleTest.
const testing::Environment* const printer = testing::AddGlobalTestEnvironment(new Printer);

double sum(const Image& image) {
    double total = 0.0;
    for (const glm::vec3& rgb : image.rgb) total += double(rgb.x) + double(rgb.y) + double(rgb.z);
    return total;
}

}  // namespace

void expect_error(const std::string& name, double error, double tolerance) {
    rows.push_back({name, error, tolerance});
    EXPECT_LE(error, tolerance) << name;
}

void expect_picture(const std::string& name, const Image& got, const Image& easy, double tolerance) {
    assert(got.rgb.size() == easy.rgb.size());
    double difference = 0.0, square = 0.0;
    for (std::size_t i = 0; i < got.rgb.size(); ++i) {
        const glm::dvec3 x(got.rgb[i]), r(easy.rgb[i]);
        difference += glm::dot(x - r, x - r);
        square += glm::dot(r, r);
    }
    const double error = difference == 0.0 ? 0.0 : std::sqrt(difference / square);
    expect_error(name, std::isfinite(error) ? error : 1.0, tolerance);
    if (!(error <= tolerance)) leave_pictures(got, easy, name);
}

double mean_difference(const Image& a, const Image& b) {
    const double error = std::abs(sum(a) / sum(b) - 1.0);
    return std::isfinite(error) ? error : 1.0;
}

Image scaled(Image image, double factor) {
    for (glm::vec3& rgb : image.rgb) rgb = glm::vec3(glm::dvec3(rgb) * factor);
    return image;
}

}  // namespace vkcppm::test
