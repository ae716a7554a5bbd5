#pragma once

#include <octafront/size_field.h>

namespace octafront {

/// What stands behind a SizeField: one subclass per way to answer at().
struct SizeField::Impl {
  virtual ~Impl() = default;
  virtual double at(Vec3 p) const = 0;
  virtual double min_size() const = 0;
  virtual double max_size() const = 0;
};

}  // namespace octafront
