#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

namespace octafront {

/// What stands behind a SizeField: one subclass per way to answer at().
struct SizeField::Impl {
  virtual ~Impl() = default;
  virtual double at(Vec3 p) const = 0;
  virtual double min_size() const = 0;
  virtual double max_size() const = 0;

  /// The rate at which sizes may change, and caps on the field grow. One that knows of none has the default.
  double gradation = SizeOptions{}.gradation;
};

}  // namespace octafront
