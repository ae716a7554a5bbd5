#include <octafront/error.h>
#include <octafront/units.h>

#include "doors/intake/intake.h"

#include <cstdint>

#include <fmt/core.h>

namespace octafront::intake {

namespace {

cad::Overlap overlap_of_solids(ComplexOptions::Overlap asked) {
  switch (asked) {
    case ComplexOptions::Overlap::kAuto:
      break;
    case ComplexOptions::Overlap::kFirst:
      return cad::Overlap::kFirst;
    case ComplexOptions::Overlap::kLater:
      return cad::Overlap::kLater;
    case ComplexOptions::Overlap::kNew:
      return cad::Overlap::kNew;
  }
  return cad::Overlap::kRefuse;
}

}  // namespace

void check_cad_intake(const CadIntake& asked) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw OptionError(fmt::format("`{}` must be above 0", what));
  };
  require(!asked.size || *asked.size > 0, "cad_size");
  require(!asked.elements || *asked.elements > 0, "cad_elements");
  require(asked.seconds > 0, "cad_seconds");
  require(asked.memory_gigabytes > 0, "cad_memory");
  if (unit_named(asked.unit) == nullptr) throw OptionError(fmt::format("`cad_unit` \"{}\" is not known", asked.unit));
}

cad::ReaderOptions reader_options(const IntakeOptions& options) {
  const CadIntake& asked = options.cad;
  return {overlap_of_solids(options.complex.overlap),
          options.complex.tolerance.value_or(0) * millimetres_of(asked),
          asked.heal,
          asked.keep_going,
          asked.seconds,
          static_cast<std::uint64_t>(asked.memory_gigabytes * 1e9)};
}

double millimetres_of(const CadIntake& asked) {
  return unit_named(asked.unit)->metres / unit_named("mm")->metres;
}

double unit_of(const cad::CadModel& model, const CadIntake& asked) {
  return model.per_millimetre * millimetres_of(asked);
}

}  // namespace octafront::intake
