#include "base/core/validate.h"

#include <gtest/gtest.h>

namespace octafront {
namespace {

struct Counter {
  int value = 0;
  std::optional<std::string> first_inconsistency() const {
    if (value < 0) return "a counter is below 0";
    return std::nullopt;
  }
  std::optional<std::string> first_inconsistency(int touched) const {
    if (touched != value) return "what was touched is not what is there";
    return std::nullopt;
  }
};

TEST(Validate, ThrowsTheSentenceWhereItIsSwitchedOnAndNowhereElse) {
  EXPECT_NO_THROW(validate(Counter{1}));
  EXPECT_NO_THROW(validate(Counter{1}, 1));
  if (kValidate) {
    EXPECT_THROW(validate(Counter{-1}), std::logic_error);
    EXPECT_THROW(validate(Counter{1}, 2), std::logic_error);
  } else {
    EXPECT_NO_THROW(validate(Counter{-1}));
    EXPECT_NO_THROW(validate(Counter{1}, 2));
  }
}

}  // namespace
}  // namespace octafront
