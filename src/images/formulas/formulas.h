#pragma once

// images/formulas: functions of space, whose values below 0 are a body. Takes a formula as text, or samples of a
// function; leaves values, gradients, the nearest places where it is 0, and the true geometry of the body in a box.

#include <octafront/formula.h>
#include <octafront/vec.h>

namespace octafront::formulas {

/// A function of space. Const and safe on any number of threads.
class SpaceFunction {
 public:
  virtual ~SpaceFunction() = default;
  virtual double at(Vec3 p) const = 0;
  virtual Vec3 gradient(Vec3 p) const = 0;
};

/// A formula; its gradient by central differences over `step`, input units.
class FormulaFunction : public SpaceFunction {
 public:
  FormulaFunction(Formula formula, double step) : formula_(std::move(formula)), step_(step) {}
  double at(Vec3 p) const override { return formula_.at(p); }
  Vec3 gradient(Vec3 p) const override;

 private:
  Formula formula_;
  double step_;
};

/// Cubics through samples (E. Catmull, R. Rom, "A Class of Local Interpolating Splines", 1974), in the box and no more
/// than half a cell beyond.
class SampledSpace : public SpaceFunction {
 public:
  explicit SampledSpace(SampledFunction samples);
  double at(Vec3 p) const override { return value(p, -1); }
  Vec3 gradient(Vec3 p) const override { return {value(p, 0), value(p, 1), value(p, 2)}; }

 private:
  /// The value, or its derivative along an axis.
  double value(Vec3 p, int derived) const;
  double sample(int i, int j, int k) const;

  SampledFunction samples_;
  Vec3 cell_;
};

/// The place near p where the function is 0, moving along the axes that are not `fixed` (a bit each, x first): Newton's
/// steps along the gradient, each no farther than `reach` from p in all, then bisection where they swing. p itself
/// where there is none. After a step no longer than `near_enough` it is as near as was asked; 0: up to rounding.
Vec3 nearest_zero(const SpaceFunction& function, Vec3 p, unsigned fixed, double reach, double near_enough = 0);

}  // namespace octafront::formulas
