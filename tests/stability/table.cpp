#include "stability/table.h"

#include <cassert>
#include <cmath>
#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

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

double difference(const Image& a, const Image& b) {
    assert(a.rgb.size() == b.rgb.size());
    double squares = 0.0, reference = 0.0;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        const glm::dvec3 x(a.rgb[i]), r(b.rgb[i]);
        squares += glm::dot(x - r, x - r);
        reference += glm::dot(r, r);
    }
    const double error = squares == 0.0 ? 0.0 : std::sqrt(squares / reference);
    return std::isfinite(error) ? error : 1.0;
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
