#include "render/kernel_choice.h"

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

const std::vector<KernelForm> three = {{64, false}, {64, true}, {32, false}};

TEST(KernelChoice, OneFormIsChosenFromTheStart) {
    KernelChoice choice({{64, false}});
    EXPECT_TRUE(choice.decided());
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(choice.index(i), 0u);
    choice.book(0, 1.0);
    EXPECT_EQ(choice.chosen(), KernelForm{});
}

TEST(KernelChoice, FormsTakeTurnsAndTheShortestRunWins) {
    KernelChoice choice(three);
    std::uint32_t iteration = 0;
    for (; iteration < KernelChoice::rounds * three.size(); ++iteration) {
        ASSERT_FALSE(choice.decided()) << "after " << iteration;
        EXPECT_FALSE(choice.chosen().has_value());
        ASSERT_EQ(choice.index(iteration), iteration % three.size());
        // The second form is the fastest but in its first run, which something disturbed.
        const double seconds = iteration % three.size() == 1 ? 1.0 : 2.0;
        choice.book(iteration, iteration == 1 ? 100.0 : seconds);
    }
    ASSERT_TRUE(choice.decided());
    EXPECT_EQ(choice.chosen(), three[1]);
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(choice.index(iteration + i), 1u);
    for (std::uint32_t i = 0; i < 20; ++i) choice.book(iteration + i, 1e-9);
    EXPECT_EQ(choice.chosen(), three[1]) << "a choice stands";
}

TEST(KernelChoice, WaitsForEveryFormHoweverOftenOneIsDisturbed) {
    KernelChoice choice(three);
    for (std::uint32_t i = 0; i < 30; ++i) {
        if (i % 3 != 2) choice.book(i, 1.0);  // iterations of the last form are not booked
    }
    EXPECT_FALSE(choice.decided());
    for (std::uint32_t i = 32; i < 32 + 3 * KernelChoice::rounds; i += 3) choice.book(i, 0.5);
    EXPECT_EQ(choice.chosen(), three[2]);
}

TEST(KernelChoice, SoftwareVulkanHasOneFormAndLightKernelsToo) {
    DevicePolicy policy;
    EXPECT_EQ(forms_for(policy), std::vector<KernelForm>{{}});
    policy.tries_forms = true;
    const std::vector<KernelForm> forms = forms_for(policy);
    EXPECT_EQ(forms.front(), KernelForm{}) << "what is not measured runs in the form of software Vulkan";
    EXPECT_EQ(forms_of(row_of(KernelId::photon), forms), forms);
    for (const KernelId kernel : {KernelId::update, KernelId::scan_blocks, KernelId::knn}) {
        EXPECT_EQ(forms_of(row_of(kernel), forms), std::vector<KernelForm>{{}}) << row_of(kernel).name;
    }
    EXPECT_EQ(forms_of(row_of(KernelId::eye), three), (std::vector<KernelForm>{{64, false}, {32, false}}))
        << "eye paths always wait";
    EXPECT_EQ(text_of(KernelForm{128, false}), "groups of 128");
    EXPECT_EQ(text_of(KernelForm{64, true}), "groups of 64, lanes wait");
}

}  // namespace
}  // namespace vkcppm
