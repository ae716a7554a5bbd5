#pragma once

// How one value reaches a field of a struct of options, by the name of the option.

#include <octafront/error.h>
#include <octafront/option_table.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront::options {

using Kind = OptionInfo::Kind;

inline constexpr double kLargestWhole = 9e18;

/// An OptionInfo that is told one thing after the other.
struct About : OptionInfo {
  About(std::string_view its_name, std::string_view its_group, std::string_view its_tasks, std::string_view its_help) {
    name = field = its_name, group = its_group, tasks = its_tasks, help = its_help;
  }
  About& called(std::string_view in_messages) { return field = in_messages, *this; }
  About& takes(std::string_view its_letter) { return letter = its_letter, *this; }
  About& length(std::string_view its_letter) { return is_length = true, letter = its_letter, *this; }
  About& above(double bound) { return least = bound, is_above = true, *this; }
  About& from(double bound) { return least = bound, *this; }
  About& to(double bound) { return most = bound, *this; }
  About& below(double bound) { return most = bound, is_below = true, *this; }
  About& without(std::string_view value) { return unset = value, *this; }
  About& also(std::string_view more_commands) { return commands = more_commands, *this; }
  About& written(std::string_view on_the_line) { return typed = on_the_line, *this; }
  About& common(std::string_view words) { return brief = words, *this; }
};

/// An option of `All`, and how to reach its value.
template <class All>
struct Row {
  OptionInfo info;
  std::function<OptionValue(const All&)> get;
  std::function<void(All&, const OptionValue&)> set;
};

[[noreturn]] inline void refuse(std::string_view name, std::string_view what) {
  throw OptionError(fmt::format("`{}` {}", name, what));
}

inline double number_of(std::string_view name, const OptionValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  refuse(name, "needs a number");
}

inline std::int64_t whole_of(std::string_view name, const OptionValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  const double number = number_of(name, value);
  if (!(std::abs(number) < kLargestWhole) || number != std::floor(number)) refuse(name, "needs a whole number");
  return static_cast<std::int64_t>(number);
}

inline bool flag_of(std::string_view name, const OptionValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag;
  refuse(name, "is true or false");
}

/// How values of a field's type come and go.
template <class Field>
struct Conversion;

template <>
struct Conversion<double> {
  static constexpr Kind kKind = Kind::kNumber;
  static OptionValue shown(double field) { return field; }
  static double taken(std::string_view name, const OptionValue& value) { return number_of(name, value); }
};

template <>
struct Conversion<std::int64_t> {
  static constexpr Kind kKind = Kind::kWhole;
  static OptionValue shown(std::int64_t field) { return field; }
  static std::int64_t taken(std::string_view name, const OptionValue& value) { return whole_of(name, value); }
};

template <class Whole>
struct NarrowConversion {
  static constexpr Kind kKind = Kind::kWhole;
  static OptionValue shown(Whole field) { return std::int64_t{field}; }
  static Whole taken(std::string_view name, const OptionValue& value) {
    const std::int64_t whole = whole_of(name, value);
    if (!std::in_range<Whole>(whole)) refuse(name, "is out of range");
    return static_cast<Whole>(whole);
  }
};
template <>
struct Conversion<int> : NarrowConversion<int> {};
template <>
struct Conversion<std::uint32_t> : NarrowConversion<std::uint32_t> {};

template <>
struct Conversion<bool> {
  static constexpr Kind kKind = Kind::kFlag;
  static OptionValue shown(bool field) { return field; }
  static bool taken(std::string_view name, const OptionValue& value) { return flag_of(name, value); }
};

template <>
struct Conversion<std::string> {
  static constexpr Kind kKind = Kind::kText;
  static OptionValue shown(const std::string& field) { return field; }
  static std::string taken(std::string_view name, const OptionValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    refuse(name, "needs words");
  }
};

template <class Value>
struct Conversion<std::optional<Value>> {
  static constexpr Kind kKind = Conversion<Value>::kKind;
  static OptionValue shown(const std::optional<Value>& field) {
    return field ? Conversion<Value>::shown(*field) : OptionValue{};
  }
  static std::optional<Value> taken(std::string_view name, const OptionValue& value) {
    if (std::holds_alternative<std::monostate>(value)) return std::nullopt;
    return Conversion<Value>::taken(name, value);
  }
};

/// By where the field is: compiled once for each type of field, not for each option.
template <class All, class Field>
Row<All> row_at(OptionInfo info, const Field& (*of)(const All&), Field& (*in)(All&)) {
  info.kind = Conversion<Field>::kKind;
  return {info, [of](const All& o) { return Conversion<Field>::shown(of(o)); },
          [in, name = info.name](All& o, const OptionValue& v) { in(o) = Conversion<Field>::taken(name, v); }};
}

/// `field` maps All, const or not, to the field; it captures nothing.
template <class All, class Access>
Row<All> row_of_field(OptionInfo info, Access) {
  using Field = std::remove_cvref_t<decltype(Access{}(std::declval<All&>()))>;
  // Clang 14 makes no pointer of a generic one that returns auto&.
  return row_at<All, Field>(
      std::move(info), [](const All& all) -> const Field& { return Access{}(all); },
      [](All& all) -> Field& { return Access{}(all); });
}

template <class Value>
using Names = std::vector<std::pair<std::string_view, Value>>;

template <class All, class Value, class Access>
Row<All> row_of_choice(OptionInfo info, Access field, const Names<Value>& names) {
  info.kind = Kind::kChoice;
  std::string listed;
  for (const auto& [name, value] : names) {
    info.choices.push_back(name);
    listed += (listed.empty() ? "" : ", ") + std::string(name);
  }
  const auto get = [field, names](const All& o) -> OptionValue {
    for (const auto& [name, value] : names)
      if (value == field(o)) return std::string(name);
    return {};
  };
  const auto set = [field, names, listed, option = info.name](All& o, const OptionValue& given) {
    const auto* typed = std::get_if<std::string>(&given);
    for (const auto& [name, value] : names)
      if (typed != nullptr && *typed == name) {
        field(o) = value;
        return;
      }
    refuse(option, fmt::format("is one of {}{}", listed,
                               typed != nullptr ? fmt::format("; \"{}\" is none of them", *typed) : ""));
  };
  return {info, get, set};
}

/// A flag whose name says the opposite of its field.
template <class All, class Access>
Row<All> row_of_opposite(OptionInfo info, Access field) {
  info.kind = Kind::kFlag;
  return {info, [field](const All& o) -> OptionValue { return !field(o); },
          [field, name = info.name](All& o, const OptionValue& v) { field(o) = !flag_of(name, v); }};
}

/// The rows of several groups as one list.
template <class All>
std::vector<Row<All>> all_of(std::initializer_list<std::vector<Row<All>>> groups) {
  std::vector<Row<All>> list;
  for (const auto& group : groups) list.insert(list.end(), group.begin(), group.end());
  return list;
}

/// Throws OptionError for the first number that is not in its range.
template <class All>
void check_rows(const std::vector<Row<All>>& rows, const All& options) {
  for (const Row<All>& r : rows) {
    const OptionValue value = r.get(options);
    const auto* whole = std::get_if<std::int64_t>(&value);
    const auto* number = std::get_if<double>(&value);
    if (whole == nullptr && number == nullptr) continue;
    const double x = whole != nullptr ? static_cast<double>(*whole) : *number;
    const OptionInfo& info = r.info;
    const bool is_low = info.least && !(info.is_above ? x > *info.least : x >= *info.least);
    const bool is_choice = info.choices.empty() || std::find(info.choices.begin(), info.choices.end(),
                                                             fmt::format("{}", x)) != info.choices.end();
    const bool is_high = info.most && !(info.is_below ? x < *info.most : x <= *info.most);
    if (std::isfinite(x) && !is_low && !is_high && is_choice) continue;
    throw OptionError(
        fmt::format("`{}` is {}, but must be {}", info.field, x, info.range().empty() ? "a number" : info.range()));
  }
}

/// What is known of each row.
template <class All>
std::vector<OptionInfo> infos_of(const std::vector<Row<All>>& rows) {
  std::vector<OptionInfo> list;
  for (const Row<All>& r : rows) list.push_back(r.info);
  return list;
}

/// Throws OptionError if there is no row of that name.
template <class All>
const Row<All>& row_named(const std::vector<Row<All>>& rows, std::string_view name) {
  for (const Row<All>& r : rows)
    if (r.info.name == name) return r;
  throw OptionError(fmt::format("there is no option \"{}\"", name));
}

}  // namespace octafront::options
