#include "tracer/rendering/tile_shares.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace raywalk {
namespace {

std::vector<int> taken_by(TileShares& shares, int thread) {
    std::vector<int> tiles;
    for (auto some = shares.take(thread); some.begin < some.end; some = shares.take(thread))
        for (int tile = some.begin; tile < some.end; ++tile) tiles.push_back(tile);
    return tiles;
}

TEST(TileShares, EachTileIsTakenOnceHoweverManyTakeThem) {
    for (const int threads : {1, 2, 7, 64})
        for (const int tiles : {0, 1, 5, 63, 1000, 14400}) {
            TileShares shares(tiles, threads);
            std::vector<std::atomic<int>> times(static_cast<std::size_t>(tiles));
            std::vector<std::thread> all;
            all.reserve(static_cast<std::size_t>(threads));
            for (int thread = 0; thread < threads; ++thread)
                all.emplace_back([&, thread] {
                    for (const int tile : taken_by(shares, thread)) ++times[static_cast<std::size_t>(tile)];
                });
            for (std::thread& thread : all) thread.join();
            for (const auto& count : times) ASSERT_EQ(count, 1) << tiles << " tiles, " << threads << " threads";
        }
}

TEST(TileShares, AThreadBeginsWithTheSameBandInEveryPassAndThenHelpsTheOthers) {
    for (int pass = 0; pass < 2; ++pass) {
        TileShares shares(300, 3);
        EXPECT_EQ(shares.take(2).begin, 200);
        EXPECT_EQ(shares.take(0).begin, 0);
        const std::vector<int> rest = taken_by(shares, 1);
        EXPECT_EQ(rest.front(), 100);
        EXPECT_GT(rest.size(), 280u) << "all that nobody has begun";
    }
}

}  // namespace
}  // namespace raywalk
