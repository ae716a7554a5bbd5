#include <octafront/size_field.h>

#include "sizing/size_field_impl.h"

#include <algorithm>

namespace octafront {

namespace {

struct Uniform final : SizeField::Impl {
  explicit Uniform(double size) : h(size) {}
  double at(Vec3) const override { return h; }
  double min_size() const override { return h; }
  double max_size() const override { return h; }
  double h;
};

struct FromFunction final : SizeField::Impl {
  FromFunction(std::function<double(Vec3)> function, double low, double high)
      : f(std::move(function)), lo(low), hi(high) {}
  double at(Vec3 p) const override { return std::clamp(f(p), lo, hi); }
  double min_size() const override { return lo; }
  double max_size() const override { return hi; }
  std::function<double(Vec3)> f;
  double lo, hi;
};

}  // namespace

SizeField SizeField::uniform(double h) {
  return SizeField(std::make_shared<Uniform>(h));
}

SizeField SizeField::from_function(std::function<double(Vec3)> h, double lo, double hi) {
  return SizeField(std::make_shared<FromFunction>(std::move(h), lo, hi));
}

double SizeField::at(Vec3 p) const {
  return impl_->at(p);
}
double SizeField::min_size() const {
  return impl_->min_size();
}
double SizeField::max_size() const {
  return impl_->max_size();
}

}  // namespace octafront
