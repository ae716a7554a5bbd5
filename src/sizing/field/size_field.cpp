#include <octafront/size_field.h>

#include "sizing/field/octree_field.h"

#include <algorithm>

namespace octafront {

namespace {

struct Uniform final : SizeFunction {
  explicit Uniform(double size) : h(size) {}
  double at(Vec3) const override { return h; }
  double min_size() const override { return h; }
  double max_size() const override { return h; }
  double h;
};

struct FromFunction final : SizeFunction {
  FromFunction(std::function<double(Vec3)> function, double low, double high, double by)
      : f(std::move(function)), lo(low), hi(high) {
    gradation = by;
  }
  double at(Vec3 p) const override { return std::clamp(f(p), lo, hi); }
  double min_size() const override { return lo; }
  double max_size() const override { return hi; }
  std::function<double(Vec3)> f;
  double lo, hi;
};

}  // namespace

SizeField SizeField::uniform(double h) {
  return SizeFunction::field(std::make_shared<Uniform>(h));
}

SizeField SizeField::from_function(std::function<double(Vec3)> h, double lo, double hi) {
  return SizeFunction::field(std::move(h), lo, hi, kDefaultGradation);
}

SizeField SizeFunction::field(std::function<double(Vec3)> h, double lo, double hi, double gradation) {
  return field(std::make_shared<FromFunction>(std::move(h), lo, hi, gradation));
}

SizeField::SizeField(const SizeFunction& function) noexcept : function_(&function) {
  function_->fields_.fetch_add(1, std::memory_order_relaxed);
}

SizeField::SizeField(const SizeField& other) noexcept : SizeField(*other.function_) {}

SizeField& SizeField::operator=(SizeField other) noexcept {
  std::swap(function_, other.function_);
  return *this;
}

SizeField::~SizeField() {
  // Out of the function before it goes: its own destruction must not find it there.
  if (function_->fields_.fetch_sub(1, std::memory_order_acq_rel) == 1) const auto last = std::move(function_->self_);
}

double SizeField::at(Vec3 p) const {
  return function_->at(p);
}
std::array<std::array<double, 3>, 3> SizeField::metric_at(Vec3 p) const {
  const double h = at(p), m = 1 / (h * h);
  return {{{m, 0, 0}, {0, m, 0}, {0, 0, m}}};
}
double SizeField::min_size() const {
  return function_->min_size();
}
double SizeField::max_size() const {
  return function_->max_size();
}

}  // namespace octafront
