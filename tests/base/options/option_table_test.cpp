#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/option_table.h>

#include <limits>
#include <set>
#include <sstream>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A value other than `value`, of the same kind.
OptionValue another(const OptionInfo& info, const OptionValue& value) {
  switch (info.kind) {
    case OptionInfo::Kind::kFlag:
      return !std::get<bool>(value);
    case OptionInfo::Kind::kNumber:
      return 0.375;
    case OptionInfo::Kind::kWhole:
      return std::int64_t{7};
    case OptionInfo::Kind::kText:
      return std::string("words");
    case OptionInfo::Kind::kChoice:
      for (const std::string_view choice : info.choices)
        if (std::string(choice) != std::get<std::string>(value)) return std::string(choice);
  }
  return {};
}

template <class All>
void expect_each_by_itself(const std::vector<OptionInfo>& table) {
  for (const OptionInfo& info : table) {
    const All defaults;
    All options;
    const OptionValue value = another(info, option_value(defaults, info.name));
    ASSERT_NE(value, option_value(defaults, info.name)) << info.name;
    set_option(options, info.name, value);
    for (const OptionInfo& other : table) {
      const OptionValue expected = other.name == info.name ? value : option_value(defaults, other.name);
      EXPECT_EQ(option_value(options, other.name), expected) << info.name << " " << other.name;
    }
    set_option(options, info.name, option_value(defaults, info.name));
    EXPECT_EQ(option_value(options, info.name), option_value(defaults, info.name)) << info.name;
  }
}

TEST(OptionTable, WhatIsSetIsThereAndNothingElseChanges) {
  expect_each_by_itself<Options>(option_table());
  expect_each_by_itself<IntakeOptions>(intake_table());
  expect_each_by_itself<WriteOptions>(write_table());
}

TEST(OptionTable, NamesAreThereOnceAndSayWhatTheyAre) {
  std::set<std::string> names;
  std::vector<OptionInfo> all = option_table();
  for (const auto* table : {&intake_table(), &write_table()}) all.insert(all.end(), table->begin(), table->end());
  for (const OptionInfo& info : all) {
    std::istringstream tasks{std::string(info.tasks)};
    for (std::string task; tasks >> task;)
      EXPECT_TRUE(names.insert(fmt::format("{} of {}", info.name, task)).second) << info.name;
    EXPECT_FALSE(info.help.empty() || info.group.empty() || info.tasks.empty()) << info.name;
    EXPECT_FALSE(info.kind == OptionInfo::Kind::kChoice && info.choices.empty()) << info.name;
    EXPECT_TRUE(info.kind == OptionInfo::Kind::kFlag || !info.choices.empty() || !info.letter.empty()) << info.name;
  }
  EXPECT_GT(names.size(), 20u);
}

void refused(std::string_view name, const OptionValue& value, const std::string& words) {
  Options options;
  try {
    set_option(options, name, value);
    ADD_FAILURE() << name << " was taken";
  } catch (const OptionError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(OptionTable, WrongNamesAndValuesAreRefused) {
  refused("sise", 1.0, "there is no option \"sise\"");
  refused("size", std::string("large"), "`size` needs a number");
  refused("size", true, "`size` needs a number");
  refused("automatic_factor", {}, "`automatic_factor` needs a number");
  refused("elements", 1.5, "`elements` needs a whole number");
  refused("elements", 1e300, "`elements` needs a whole number");
  refused("order", std::int64_t{1} << 40, "`order` is out of range");
  refused("facets", 1.0, "`facets` is true or false");
  refused("interior", std::string("large"), "`interior` is one of uniform, graded; \"large\" is none of them");
  refused("interior", 1.0, "`interior` is one of uniform, graded");
}

TEST(OptionTable, RangesAreKeptAndSaid) {
  check_ranges(Options{});
  check_ranges(IntakeOptions{});
  check_ranges(WriteOptions{});
  const auto refuses = [](std::string_view name, double value) {
    Options options;
    set_option(options, name, value);
    try {
      check_ranges(options);
    } catch (const OptionError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refuses("relaxation", 2), "`relaxation` is 2, but must be above 0 and at most 1");
  EXPECT_EQ(refuses("relaxation", 0), "`relaxation` is 0, but must be above 0 and at most 1");
  EXPECT_EQ(refuses("relaxation", 1), "");
  EXPECT_EQ(refuses("feature_angle", 180), "`feature_angle` is 180, but must be above 0 and below 180");
  EXPECT_EQ(refuses("ideal_distance", .2), "`ideal_distance` is 0.2, but must be from 0.3 to 1.5");
  EXPECT_EQ(refuses("order", 5), "`order` is 5, but must be 1 or 2 or 3 or 4");
  EXPECT_EQ(refuses("layers", 101), "`count` is 101, but must be from 0 to 100");
  EXPECT_NE(refuses("size", std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_NE(refuses("size", std::numeric_limits<double>::infinity()), "");
}

TEST(OptionTable, WholeNumbersAreNumbersToo) {
  Options options;
  set_option(options, "size", std::int64_t{3});
  EXPECT_EQ(options.size.size, 3.0);
  set_option(options, "elements", 1e5);
  EXPECT_EQ(options.size.elements, 100000);
  set_option(options, "size", {});
  EXPECT_FALSE(options.size.size);
  IntakeOptions intake;
  EXPECT_THROW(set_option(intake, "series", std::int64_t{-1}), OptionError);
  set_option(intake, "series", std::int64_t{2});
  EXPECT_EQ(intake.image.choice.series, 2u);
}

}  // namespace
}  // namespace octafront
