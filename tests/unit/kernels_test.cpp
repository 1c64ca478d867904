#include "render/kernels.h"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "core/fnv1a.h"
#include "render/estimators.h"

namespace vkcppm {
namespace {

std::vector<std::uint32_t> own_words(KernelId kernel, const EstimatorRow& estimator) {
    const auto words = words_of(kernel, estimator.name);
    return {words.begin(), words.end()};
}

TEST(Kernels, AreRowsInTheOrderOfTheirIds) {
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < kernel_rows().size(); ++i) {
        const KernelRow& row = kernel_rows()[i];
        EXPECT_EQ(std::size_t(row.id), i) << row.name;
        EXPECT_EQ(&row_of(row.id), &row);
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands there twice";
    }
    EXPECT_EQ(row_of(KernelId::radix_scatter).name, "radix_scatter");
}

TEST(Kernels, PassesStandInTheOrderOfAnIteration) {
    EXPECT_TRUE(std::ranges::is_sorted(kernel_rows(), {}, &KernelRow::pass));
}

TEST(Kernels, RunOutOfStepsUnderABitOfTheirOwn) {
    std::uint32_t bits = PASS_CAPACITY | PASS_LEVELS;
    for (const KernelRow& row : kernel_rows()) {
        EXPECT_EQ(row.unfinished & bits, 0u) << row.name;
        EXPECT_EQ(row.unfinished & (row.unfinished - 1), 0u) << row.name << " has several";
        bits |= row.unfinished;
    }
}

TEST(Kernels, OfAnEstimatorAreItsOwn) {
    std::set<std::vector<std::uint32_t>> seen;
    for (const EstimatorRow& estimator : estimators()) {
        EXPECT_EQ(own_words(KernelId::eye, estimator), own_words(KernelId::eye, estimators().front()));
        std::vector<std::uint32_t> both = own_words(KernelId::gather, estimator);
        const auto update = own_words(KernelId::update, estimator);
        both.insert(both.end(), update.begin(), update.end());
        EXPECT_TRUE(seen.insert(both).second) << estimator.name << " is an earlier one";
    }
}

TEST(Kernels, HashCoversEveryModule) {
    std::uint64_t hash = fnv1a_start;
    for (const KernelRow& row : kernel_rows()) {
        const auto of = row.modules == Modules::each ? estimators() : estimators().first(1);
        for (const EstimatorRow& estimator : of) hash = fnv1a_of(words_of(row.id, estimator.name), hash);
    }
    EXPECT_EQ(kernels_hash(), hash);
}

}  // namespace
}  // namespace vkcppm
