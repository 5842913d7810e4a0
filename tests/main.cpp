// SPDX-License-Identifier: MIT
// Runs the tests of one executable. A run that had to leave tests out ends with its own exit status, so that ctest
// lists it as skipped and never as passed.
#include <iostream>

#include <gtest/gtest.h>

int main(int argc, char** argv) {
    constexpr int k_skipped = 77; // SKIP_RETURN_CODE in CMakeLists.txt
    testing::InitGoogleTest(&argc, argv);
    const int failed = RUN_ALL_TESTS();
    if (failed != 0) return failed;
    const int skipped = testing::UnitTest::GetInstance()->skipped_test_count();
    if (skipped == 0) return 0;
    std::cerr << "NOT TESTED: " << skipped << " tests, for the reasons above\n";
    return k_skipped;
}
