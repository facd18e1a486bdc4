#include "app/process/progress.h"

#include <gtest/gtest.h>

#include "app/process/console.h"

namespace raywalk {
namespace {

TEST(Progress, TheLineShowsBarPercentAndRemainingTime) {
    EXPECT_EQ(progress_line(0.5, 12, 44), "[########---------]  50 %, 12.0 s left");
    EXPECT_EQ(progress_line(0.25, 100, 44), "[####-------------]  25 %, 5 min 0 s left");
    EXPECT_EQ(progress_line(0.999, 1, 44), "[################-]  99 %, 0.0 s left");
    EXPECT_EQ(progress_line(0, 3, 44), "[-----------------]   0 %");
    EXPECT_EQ(progress_line(1, 3, 44), "[#################] 100 %");
}

TEST(Progress, TheLineFitsEveryWidth) {
    for (int columns = 0; columns < 200; ++columns)
        for (const double fraction : {0.0, 0.013, 0.5, 1.0})
            EXPECT_LE(progress_line(fraction, 100000, columns).size(), static_cast<std::size_t>(columns));
    EXPECT_EQ(progress_line(0.5, 1, 20), " 50 %, 1.0 s left");
}

TEST(Progress, APauseDoesNotCountAsWork) {
    WorkingTime time;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(time.step(0.1), WorkingTime::Step::worked);
    EXPECT_EQ(time.step(500), WorkingTime::Step::paused);
    EXPECT_EQ(time.step(0.1), WorkingTime::Step::worked);
    EXPECT_NEAR(time.seconds(), 1.1, 1e-9);
}

TEST(Console, DurationsAreShortAndRounded) {
    EXPECT_EQ(duration_text(0.0081), "8.1 ms");
    EXPECT_EQ(duration_text(0.264), "0.26 s");
    EXPECT_EQ(duration_text(12.34), "12.3 s");
    EXPECT_EQ(duration_text(59.96), "1 min 0 s");
    EXPECT_EQ(duration_text(185), "3 min 5 s");
    EXPECT_EQ(duration_text(3599.9), "1 h 0 min");
    EXPECT_EQ(duration_text(3720), "1 h 2 min");
}

TEST(Console, CountsHaveSeparatorsAndTheRightNumber) {
    EXPECT_EQ(count_text(0, "ray"), "0 rays");
    EXPECT_EQ(count_text(1, "ray"), "1 ray");
    EXPECT_EQ(count_text(999, "ray"), "999 rays");
    EXPECT_EQ(count_text(1234567, "mesh", "meshes"), "1,234,567 meshes");
}

}  // namespace
}  // namespace raywalk
