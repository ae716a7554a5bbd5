#include <octafront/units.h>

#include <array>

namespace octafront {

namespace {

constexpr std::array kUnits{LengthUnit{"um", 1e-6, " micrometers micrometres microns micron "},
                            LengthUnit{"mm", 1e-3, " millimeters millimetres millimeter millimetre "},
                            LengthUnit{"cm", 1e-2, " centimeters centimetres centimeter centimetre "},
                            LengthUnit{"m", 1, " meters metres meter metre "},
                            LengthUnit{"in", 0.0254, " inches inch "},
                            LengthUnit{"ft", 0.3048, " feet foot "}};

}  // namespace

std::span<const LengthUnit> length_units() {
  return kUnits;
}

const LengthUnit* unit_named(const std::string& name) {
  for (const LengthUnit& unit : kUnits)
    if (unit.name == name || (!name.empty() && unit.words.find(" " + name + " ") != std::string_view::npos))
      return &unit;
  return nullptr;
}

// 1 N = 1 kg m/s2: with forces in N and lengths of L metres, a mass of 1 is 1/L kg.
double density_with_newtons(double kilograms_per_cubic_metre, const LengthUnit& unit) {
  return kilograms_per_cubic_metre * (unit.metres * unit.metres) * (unit.metres * unit.metres);
}

}  // namespace octafront
