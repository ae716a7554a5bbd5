#pragma once

#include <octafront/domain.h>
#include <octafront/mesh_field.h>
#include <octafront/no_context.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace octafront {

// Bodies by a function of space: where it is below 0 there is material, and a box ends it.

/// A function of a point, by its text. Numbers, x, y, z, pi, the period L, + - * / ^ (powers go before signs and from
/// right to left), parentheses, and
///   sin cos tan exp log sqrt abs (one argument), min max (two or more), pow atan2 mod (two), hypot (two or three),
///   gyroid schwarz_p diamond iwp neovius lidinoid fischer_koch_s split_p (three coordinates, or none: x, y, z).
/// The named surfaces are the usual level sets of sines and cosines of 2 pi / L times their arguments: those of the
/// Gyroid is sin X cos Y + sin Y cos Z + sin Z cos X. `a < b` at the outermost stands for a - b, `a > b` for b - a:
/// what it says is the body. The same bits on every machine.
///
/// Example: Formula("abs(gyroid) < 0.3", 10) is a sheet along the Gyroid, whose cell is 10 wide.
class Formula {
 public:
  /// Throws OptionError with the place in the text that is not understood. Requires period > 0.
  explicit Formula(const std::string& text, double period = 1);
  /// With further variables, by their names, which come behind those above.
  Formula(const std::string& text, double period, const std::vector<std::string>& variables);
  ~Formula();
  Formula(Formula&&) noexcept;

  double at(Vec3 p) const { return at(p, {}); }
  /// `values`: of the variables, in their order.
  double at(Vec3 p, std::span<const double> values) const;
  /// Whether it knows a surface that repeats itself.
  bool is_periodic() const;

 private:
  struct Program;
  std::unique_ptr<const Program> program_;
};

/// The field `name` of points or elements by a formula of their coordinates (of elements their middles) and of `fields`
/// of the same, one number each, by their names. Throws OptionError as Formula, and where a value is no number.
///
/// Example: with a field "HU", field_by_formula(mesh, "E", "10500 * max(.01, 1.1e-3 * HU)^2.29", fields, true).
MeshField field_by_formula(const TetMesh& mesh, const std::string& name, const std::string& formula,
                           std::span<const MeshField> fields, bool of_elements);

/// Whether an input is meant as a formula: no such file is there, and the text has a coordinate or a named surface, and
/// something else that names of files do not have or nothing else at all.
bool is_formula(const std::string& input);

/// Values of a function in a box, at the middles of equal cells and of one more layer around them: value (i, j, k) of
/// (size[0] + 2) x (size[1] + 2) x (size[2] + 2), the first along i, is that at lo + ((i, j, k) - .5) * cell.
struct SampledFunction {
  Box3 box;
  std::array<std::uint32_t, 3> size = {0, 0, 0};  ///< cells along x, y and z
  std::vector<double> values;                     ///< all finite
};

/// The body where a formula is below 0, in the box of `options.formula`: one region "body", whose surface is smooth
/// between the cells of the box and lies where the formula is 0, up to rounding at most vertices and within half a cell
/// at others; generate() puts nodes there again. Edges that min and max make are rounded within a cell. The faces of
/// the box are exactly flat. Throws OptionError, InputError where there is nothing or no surface; Cancelled.
Domain open_formula(const std::string& formula, const IntakeOptions& options = {},
                    const RunContext& context = no_context());
/// The same of samples: what is between them follows from cubics through them. `options.formula` is not asked.
Domain open_samples(const SampledFunction& samples, const IntakeOptions& options = {},
                    const RunContext& context = no_context());

}  // namespace octafront
