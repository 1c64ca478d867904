// The main function of every test program; the header that nearly every test reads is compiled here once for all.

#include <gtest/gtest.h>

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    const int failed = RUN_ALL_TESTS();
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    constexpr int skipped = 77;  // as ctest is told by CMakeLists.txt
    return failed == 0 && tests.successful_test_count() == 0 && tests.skipped_test_count() > 0 ? skipped : failed;
}
