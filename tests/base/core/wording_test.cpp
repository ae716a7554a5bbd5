#include "base/core/wording.h"

#include <gmock/gmock.h>

namespace octafront {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Wording, TakesListsOfNamesApart) {
  const std::vector<std::string> known = {"", "wall", "left, upper", "right"};
  EXPECT_THAT(names_listed("wall,right", known), ElementsAre("wall", "right"));
  EXPECT_THAT(names_listed("left, upper", known), ElementsAre("left, upper"));
  EXPECT_THAT(names_listed(",wall,,", known), ElementsAre("wall"));
  EXPECT_THAT(names_listed("", known), IsEmpty()) << "a patch without a name is not asked for by asking for none";
}

}  // namespace
}  // namespace octafront
