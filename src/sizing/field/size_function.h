#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

namespace octafront {

/// What stands behind a SizeField: one subclass per way to answer at(). Immutable once it is in a field. A function
/// counts the fields that refer to it and holds itself as long as there are any, so that the public header gets by
/// without <memory>.
class SizeFunction {
 public:
  SizeFunction() = default;
  /// A copy is in no field yet.
  SizeFunction(const SizeFunction& other) : gradation(other.gradation) {}
  virtual ~SizeFunction() = default;
  virtual double at(Vec3 p) const = 0;
  virtual double min_size() const = 0;
  virtual double max_size() const = 0;

  /// The rate at which sizes may change, and caps on the field grow. One that knows of none has the default.
  double gradation = kDefaultGradation;

  static SizeField field(std::shared_ptr<const SizeFunction> function) {
    const SizeFunction& f = *function;
    f.self_ = std::move(function);
    return SizeField(f);
  }
  /// As SizeField::from_function(), of this gradation.
  static SizeField field(std::function<double(Vec3)> h, double lo, double hi, double gradation);
  static const SizeFunction& behind(const SizeField& sizes) { return *sizes.function_; }

 private:
  friend class SizeField;
  mutable std::atomic<std::size_t> fields_ = 0;
  mutable std::shared_ptr<const SizeFunction> self_;
};

}  // namespace octafront
