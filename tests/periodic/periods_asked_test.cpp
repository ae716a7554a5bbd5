#include "periodic/periods_asked.h"

#include <octafront/error.h>

#include "periodic/periodic_cell.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

TEST(PeriodsAsked, AxesAndMaps) {
  const AskedPeriods axes = periods_asked("periodic", "xz");
  EXPECT_EQ(axes.along, (std::array{true, false, true}));
  EXPECT_TRUE(axes.maps.empty());
  const AskedPeriods shifts = periods_asked("periodic", "1,0,-2.5e-1; left:right=0, 3 ,0");
  ASSERT_EQ(shifts.maps.size(), 2u);
  EXPECT_EQ(shifts.maps[0].map.shift(), (Vec3{1, 0, -0.25}));
  EXPECT_EQ(shifts.maps[1].map.shift(), (Vec3{0, 3, 0}));
  EXPECT_EQ(shifts.maps[1].low, "left");
  EXPECT_EQ(shifts.maps[1].high, "right");
  const AskedPeriods turn = periods_asked("periodic", "360/4@1,1,0,0,0,2");
  ASSERT_EQ(turn.maps.size(), 1u);
  EXPECT_TRUE(turn.maps[0].map.turns());
  EXPECT_EQ(turn.maps[0].map.apply({2, 1, 5}), (Vec3{1, 2, 5}));
  EXPECT_TRUE(periods_asked("periodic", "").maps.empty());
}

TEST(PeriodsAsked, OthersAreRefusedByTheNameOfTheOption) {
  for (const char* text : {"xx", "w", "1,2", "0,0,0", "1,2,3,4", "30@w", "0@z", "360@z", "30@0,0,0,0,0,0", "a=1,0,0",
                           ":b=1,0,0", "a:=1,0,0", "1,0,0;;", "30@z;1,0,0", "nan,0,0", "1/0@z"}) {
    SCOPED_TRACE(text);
    try {
      periods_asked("periodic", text);
      FAIL();
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find("`periodic`"), std::string::npos);
    }
  }
}

TEST(PeriodicCell, PlacesComeBackFromRotationsBitForBit) {
  const PeriodicMap map = periods_asked("periodic", "360/7@0.3,-0.2,0,0.1,0.2,1").maps[0].map;
  const PeriodicCell cell = mapped_cell({map}, 3.0);
  unsigned state = 1;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return (static_cast<double>(state) / 4294967296.0 - 0.5) * 6;
  };
  for (int i = 0; i < 10000; ++i) {
    const Vec3 p = cell.on_grid({next(), next(), next()});
    const Vec3 q = cell.to_high(p, 0);
    EXPECT_EQ(cell.to_low(q, 0), p);
    EXPECT_EQ(cell.on_grid(p), p);
  }
  // What lies on the axis stays.
  const Vec3 on_axis = cell.on_grid(Vec3{0.3, -0.2, 0} + Vec3{0.1, 0.2, 1} * 1.7);
  EXPECT_EQ(map.apply(on_axis), on_axis);
}

}  // namespace
}  // namespace octafront
