#include <octafront/error.h>
#include <octafront/generate.h>

#include "support/named_surfaces.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

void expect_refused(const Options& options, const std::string& fragment) {
  try {
    generate_sizes(testing::cube(), options);
    ADD_FAILURE() << "accepted; expected a refusal with: " << fragment;
  } catch (const OptionError& e) {
    EXPECT_NE(std::string(e.what()).find(fragment), std::string::npos) << e.what();
  }
}

TEST(Options, RefusesWhatContradictsItself) {
  Options o;
  o.size.size = 0.1;
  o.size.elements = 1000;
  expect_refused(o, "contradict");
  o = {};
  o.size.min_size = 2;
  o.size.max_size = 1;
  expect_refused(o, "larger than `max_size`");
}

TEST(Options, RefusesValuesOutOfRange) {
  for (const double h : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Options o;
    o.size.size = h;
    expect_refused(o, "but must be above 0");
  }
  Options o;
  o.size.curvature = 2;
  expect_refused(o, "at least 3");
  o = {};
  o.size.gradation = 0;
  expect_refused(o, "`gradation` is 0");
  o = {};
  o.surface.feature_angle = 180;
  expect_refused(o, "`feature_angle`");
  o = {};
  o.size.elements = 0;
  expect_refused(o, "`elements` is 0, but must be at least 1");
}

// Before any work: not when improvement begins, after the volume was filled.
TEST(Options, RefusesImprovementOutOfRange) {
  Options o;
  o.improve.relaxation = 1.5;
  expect_refused(o, "`relaxation` is 1.5");
  o = {};
  o.improve.sweeps = -1;
  expect_refused(o, "`sweeps` is -1");
  for (const double seconds : {-1.0, std::nan("")}) {
    o = {};
    o.improve.seconds = seconds;
    expect_refused(o, "`seconds` is ");
  }
}

}  // namespace
}  // namespace octafront
