// Formulas: a text is read by descent into a program for a stack machine.

#include <octafront/error.h>
#include <octafront/formula.h>

#include "base/core/doubles.h"
#include "base/core/elementary.h"
#include "images/formulas/named_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace formulas {

enum class Code : std::uint8_t {
  kNumber,
  kVariable,
  kX,
  kY,
  kZ,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kNegate,
  kSurface,
  kSin,
  kCos,
  kTan,
  kExp,
  kLog,
  kSqrt,
  kAbs,
  kMin,
  kMax,
  kAtan2,
  kMod,
  kHypot
};

struct Command {
  Code code;
  double number = 0;
  NamedSurface surface = nullptr;
};

}  // namespace formulas

namespace {

using formulas::Code;
using formulas::Command;
using formulas::NamedSurface;

constexpr std::size_t kMostCommands = 10'000;
constexpr std::size_t kDeepest = 64;      ///< of the stack
constexpr int kMostNesting = 100;         ///< of parentheses
constexpr double kWholePowers = 1 << 20;  ///< whole exponents up to this are products

/// A function by its name; arguments from the least to the most number. More than two are taken pair by pair.
struct Function {
  std::string_view name;
  Code code;
  std::size_t least, most;
};
constexpr std::array kFunctions{
    Function{"sin", Code::kSin, 1, 1},    Function{"cos", Code::kCos, 1, 1},     Function{"tan", Code::kTan, 1, 1},
    Function{"exp", Code::kExp, 1, 1},    Function{"log", Code::kLog, 1, 1},     Function{"sqrt", Code::kSqrt, 1, 1},
    Function{"abs", Code::kAbs, 1, 1},    Function{"min", Code::kMin, 2, 50},    Function{"max", Code::kMax, 2, 50},
    Function{"pow", Code::kPower, 2, 2},  Function{"atan2", Code::kAtan2, 2, 2}, Function{"mod", Code::kMod, 2, 2},
    Function{"hypot", Code::kHypot, 2, 3}};

/// How many values a command takes off the stack; it leaves one.
std::size_t arguments_of(Code code) {
  switch (code) {
    case Code::kNumber:
    case Code::kVariable:
    case Code::kX:
    case Code::kY:
    case Code::kZ:
      return 0;
    case Code::kNegate:
    case Code::kSin:
    case Code::kCos:
    case Code::kTan:
    case Code::kExp:
    case Code::kLog:
    case Code::kSqrt:
    case Code::kAbs:
      return 1;
    case Code::kSurface:
      return 3;
    default:
      return 2;
  }
}

double power(double base, double exponent) {
  if (exponent == std::floor(exponent) && std::abs(exponent) <= kWholePowers)
    return elementary::pow(base, static_cast<int>(exponent));
  if (base == 0 && exponent > 0) return 0;
  return base > 0 ? elementary::pow(base, exponent) : std::nan("");
}

double modulo(double a, double b) {
  const double rest = std::fmod(a, b);
  return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

double applied(Code code, double a, double b) {
  switch (code) {
    case Code::kAdd:
      return a + b;
    case Code::kSubtract:
      return a - b;
    case Code::kMultiply:
      return a * b;
    case Code::kDivide:
      return a / b;
    case Code::kPower:
      return power(a, b);
    case Code::kMin:
      return std::min(a, b);
    case Code::kMax:
      return std::max(a, b);
    case Code::kAtan2:
      return elementary::atan2(a, b);
    case Code::kMod:
      return modulo(a, b);
    case Code::kHypot:
      return elementary::hypot(a, b);
    default:
      return std::nan("");
  }
}

double applied(Code code, double a) {
  switch (code) {
    case Code::kNegate:
      return -a;
    case Code::kSin:
      return formulas::sine(a);
    case Code::kCos:
      return formulas::cosine(a);
    case Code::kTan:
      return formulas::sine(a) / formulas::cosine(a);
    case Code::kExp:
      return elementary::exp(a);
    case Code::kLog:
      return a >= 0 ? elementary::log(a) : std::nan("");
    case Code::kSqrt:
      return std::sqrt(a);
    case Code::kAbs:
      return std::abs(a);
    default:
      return std::nan("");
  }
}

bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class Parser {
 public:
  Parser(const std::string& text, double period, const std::vector<std::string>& variables)
      : text_(text), period_(period), variables_(variables) {}

  std::vector<Command> run() {
    comparison();
    skip_spaces();
    if (at_ != text_.size()) fail(at_, fmt::format("\"{}\" does not belong here", text_[at_]));
    if (deepest_ > kDeepest) fail(0, "it is nested too deeply");
    return std::move(commands_);
  }

  bool has_surface() const { return has_surface_; }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& why) const {
    throw OptionError(fmt::format("the formula is not understood at character {}: {}\n  {}\n  {}^", at + 1, why, text_,
                                  std::string(at, ' ')));
  }

  void skip_spaces() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }
  char next() {
    skip_spaces();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }

  void emit(Code code, double number = 0, NamedSurface surface = nullptr) {
    commands_.push_back({code, number, surface});
    depth_ = depth_ - arguments_of(code) + 1;
    deepest_ = std::max(deepest_, depth_);
    if (commands_.size() > kMostCommands) fail(0, "it is too long");
  }

  void comparison() {
    sum();
    const char sign = next();
    if (sign != '<' && sign != '>') return;
    ++at_;
    if (at_ < text_.size() && text_[at_] == '=') ++at_;
    sum();
    emit(Code::kSubtract);
    if (sign == '>') emit(Code::kNegate);
  }

  void sum() {
    product();
    for (;;) {
      if (take('+')) {
        product();
        emit(Code::kAdd);
      } else if (take('-')) {
        product();
        emit(Code::kSubtract);
      } else {
        return;
      }
    }
  }

  void product() {
    signed_power();
    for (;;) {
      if (take('*')) {
        signed_power();
        emit(Code::kMultiply);
      } else if (take('/')) {
        signed_power();
        emit(Code::kDivide);
      } else {
        return;
      }
    }
  }

  void signed_power() {
    if (take('+')) return signed_power();
    if (!take('-')) return raised();
    signed_power();
    emit(Code::kNegate);
  }

  void raised() {
    atom();
    const bool is_raised = take('^') || (text_.compare(at_, 2, "**") == 0 && (at_ += 2) > 0);
    if (!is_raised) return;
    signed_power();
    emit(Code::kPower);
  }

  void atom() {
    const char c = next();
    const std::size_t at = at_;
    if (++nesting_ > kMostNesting) fail(at, "it is nested too deeply");
    if (is_digit(c) || c == '.') {
      number();
    } else if (is_name_start(c)) {
      name();
    } else if (take('(')) {
      sum();
      if (!take(')')) fail(at_, fmt::format("the parenthesis of character {} is not closed", at + 1));
    } else if (c == '\0') {
      fail(at, "it ends where a number, a name or a parenthesis should be");
    } else {
      fail(at, fmt::format("\"{}\" stands where a number, a name or a parenthesis should be", c));
    }
    --nesting_;
  }

  void number() {
    double value = 0;
    const auto [end, error] = io::double_from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) fail(at_, "this is no number");
    at_ = static_cast<std::size_t>(end - text_.data());
    emit(Code::kNumber, value);
  }

  void name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_name_start(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view word(text_.data() + begin, at_ - begin);
    if (word == "x") return emit(Code::kX);
    if (word == "y") return emit(Code::kY);
    if (word == "z") return emit(Code::kZ);
    if (word == "pi") return emit(Code::kNumber, std::numbers::pi);
    if (word == "L") return emit(Code::kNumber, period_);
    if (const auto v = std::ranges::find(variables_, word); v != variables_.end())
      return emit(Code::kVariable, static_cast<double>(v - variables_.begin()));
    if (const NamedSurface surface = formulas::named_surface(word)) return named_surface(begin, word, surface);
    const auto found =
        std::find_if(kFunctions.begin(), kFunctions.end(), [&](const Function& f) { return f.name == word; });
    if (found == kFunctions.end()) refuse_name(begin, word);
    const bool in_pairs = found->least == 2;
    const std::size_t count = arguments(begin, word, false, in_pairs ? &*found : nullptr);
    if (count < found->least || count > found->most)
      fail(begin, fmt::format("{} takes {}{} argument{}, not {}", word, found->least,
                              found->most > found->least ? " or more" : "", found->most > 1 ? "s" : "", count));
    if (!in_pairs) emit(found->code);
  }

  [[noreturn]] void refuse_name(std::size_t at, std::string_view word) const {
    std::string all = "x, y, z, pi, L";
    for (const std::string& variable : variables_) all += ", " + variable;
    for (const Function& f : kFunctions) all += ", " + std::string(f.name);
    for (const std::string& surface : formulas::names_of_surfaces()) all += ", " + surface;
    fail(at, fmt::format("there is no \"{}\"; there are {}", word, all));
  }

  /// How many there are. From the second on each is put together with what is before, by the function `in_pairs` if
  /// there is one; `scaled`: by the period.
  std::size_t arguments(std::size_t begin, std::string_view word, bool scaled, const Function* in_pairs) {
    if (!take('(')) fail(at_, fmt::format("{} needs its arguments in parentheses", word));
    std::size_t count = 0;
    do {
      sum();
      if (scaled) {
        emit(Code::kNumber, 2 * std::numbers::pi / period_);
        emit(Code::kMultiply);
      }
      ++count;
      if (in_pairs != nullptr && count > 1) emit(in_pairs->code);
    } while (take(','));
    if (!take(')')) fail(at_, fmt::format("the parenthesis behind {} of character {} is not closed", word, begin + 1));
    return count;
  }

  void named_surface(std::size_t begin, std::string_view word, NamedSurface surface) {
    has_surface_ = true;
    if (next() == '(') {
      const std::size_t count = arguments(begin, word, true, nullptr);
      if (count != 3) fail(begin, fmt::format("{} takes three coordinates, or none, not {}", word, count));
    } else {
      for (const Code axis : {Code::kX, Code::kY, Code::kZ}) {
        emit(axis);
        emit(Code::kNumber, 2 * std::numbers::pi / period_);
        emit(Code::kMultiply);
      }
    }
    emit(Code::kSurface, 0, surface);
  }

  const std::string& text_;
  double period_;
  const std::vector<std::string>& variables_;
  std::size_t at_ = 0;
  int nesting_ = 0;
  std::size_t depth_ = 0, deepest_ = 0;
  bool has_surface_ = false;
  std::vector<Command> commands_;
};

/// The names in a text, and whether it has signs that formulas have and names of files hardly do.
struct Looks {
  bool has_place = false, has_sign = false;
};

Looks looks_of(std::string_view text) {
  Looks looks;
  for (std::size_t at = 0; at < text.size();) {
    if (is_name_start(text[at])) {
      const std::size_t begin = at;
      while (at < text.size() && (is_name_start(text[at]) || is_digit(text[at]))) ++at;
      const std::string_view word = text.substr(begin, at - begin);
      const bool is_axis = word == "x" || word == "y" || word == "z";
      looks.has_place = looks.has_place || is_axis || formulas::named_surface(word) != nullptr;
      continue;
    }
    constexpr std::string_view kSigns = "()<>*^+", kOthers = " \t.,-/=0123456789";
    looks.has_sign = looks.has_sign || kSigns.find(text[at]) != std::string_view::npos ||
                     (text[at] == '-' && at > 0 && text[at - 1] == ' ');
    if (kSigns.find(text[at]) == std::string_view::npos && kOthers.find(text[at]) == std::string_view::npos) return {};
    ++at;
  }
  return looks;
}

/// ".stl" at the end: a dot and letters.
bool ends_like_a_file(std::string_view text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos || dot + 1 >= text.size() || !is_name_start(text[dot + 1])) return false;
  return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(dot) + 1, text.end(),
                     [](char c) { return is_name_start(c) || is_digit(c); });
}

}  // namespace

struct Formula::Program {
  std::vector<formulas::Command> commands;
  bool is_periodic = false;
};

Formula::Formula(const std::string& text, double period) : Formula(text, period, {}) {}

Formula::Formula(const std::string& text, double period, const std::vector<std::string>& variables) {
  if (!(period > 0) || !std::isfinite(period))
    throw OptionError(fmt::format("`cell` is {}: the period must be a length above 0", period));
  Parser parser(text, period, variables);
  std::vector<Command> commands = parser.run();
  program_ = std::make_unique<const Program>(Program{std::move(commands), parser.has_surface()});
}

Formula::~Formula() = default;
Formula::Formula(Formula&&) noexcept = default;

bool Formula::is_periodic() const {
  return program_->is_periodic;
}

double Formula::at(Vec3 p, std::span<const double> values) const {
  std::array<double, kDeepest> stack;
  std::size_t top = 0;
  for (const Command& command : program_->commands) {
    switch (command.code) {
      case Code::kNumber:
        stack[top++] = command.number;
        break;
      case Code::kVariable:
        stack[top++] = values[static_cast<std::size_t>(command.number)];
        break;
      case Code::kX:
        stack[top++] = p.x;
        break;
      case Code::kY:
        stack[top++] = p.y;
        break;
      case Code::kZ:
        stack[top++] = p.z;
        break;
      case Code::kSurface:
        top -= 2;
        stack[top - 1] = command.surface(stack[top - 1], stack[top], stack[top + 1]);
        break;
      default:
        if (arguments_of(command.code) == 1) {
          stack[top - 1] = applied(command.code, stack[top - 1]);
        } else {
          --top;
          stack[top - 1] = applied(command.code, stack[top - 1], stack[top]);
        }
    }
  }
  return stack[0];
}

bool is_formula(const std::string& input) {
  std::error_code error;
  if (input.empty() || std::filesystem::exists(input, error)) return false;
  if (formulas::named_surface(input) != nullptr) return true;
  if (ends_like_a_file(input)) return false;
  const Looks looks = looks_of(input);
  return looks.has_place && looks.has_sign;
}

}  // namespace octafront
