#include "base/core/utf8.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

std::string cleaned(std::string name) {
  NameCleaning cleaning;
  cleaning.clean(name);
  return name;
}

std::string note_on(std::vector<std::string> names) {
  NameCleaning cleaning;
  cleaning.clean(names);
  return cleaning.note();
}

TEST(Utf8, KnowsWellFormedSequences) {
  for (const char* good :
       {"", "abc", "K\xc3\xb6rper", "\xe2\x82\xac", "\xf0\x9f\xa6\xb4", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_utf8(good)) << good;
  for (const char* bad :
       {"K\xf6rper", "\xc3", "a\x80", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(NameCleaning, LeavesUtf8Alone) {
  for (const char* name : {"liver", "K\xc3\xb6rper", "\xf0\x9f\xa6\xb4 bone", "a <b> & \"c\""})
    EXPECT_EQ(cleaned(name), name);
  EXPECT_EQ(note_on({"liver", "K\xc3\xb6rper"}), "");
}

TEST(NameCleaning, TakesOtherBytesAsLatin1) {
  EXPECT_EQ(cleaned("K\xf6rper"), "K\xc3\xb6rper");
  EXPECT_EQ(cleaned("5 \x80"), "5 \xe2\x82\xac");
  EXPECT_NE(note_on({"a", "K\xf6rper", "\xfc"})
                .find("2 names were not in UTF-8 and taken as Latin-1; the first is "
                      "\"K\xc3\xb6rper\""),
            std::string::npos);
}

TEST(NameCleaning, BlanksControlCharacters) {
  EXPECT_EQ(cleaned(std::string("a\x01\t\n\x7f"
                                "b\0c",
                                8)),
            "a    b c");
  EXPECT_EQ(cleaned("a\xef\xbf\xbe"
                    "b\xc2\x85"
                    "c"),
            "a b c");
  EXPECT_NE(note_on({"a\x01"}).find("1 name had control characters"), std::string::npos);
}

// Whatever the bytes are, what comes out is UTF-8 and stays as it is when it is cleaned again.
TEST(NameCleaning, EndsInUtf8ForAllPairsOfBytes) {
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) {
      const std::string once = cleaned(std::string{'x', static_cast<char>(a), static_cast<char>(b), 'y'});
      ASSERT_TRUE(is_utf8(once)) << a << " " << b;
      ASSERT_EQ(cleaned(once), once) << a << " " << b;
    }
}

}  // namespace
}  // namespace octafront
