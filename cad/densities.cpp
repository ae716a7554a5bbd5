#include "densities.h"

#include <STEPConstruct_UnitContext.hxx>
#include <StepBasic_ConversionBasedUnit.hxx>
#include <StepBasic_DerivedUnit.hxx>
#include <StepBasic_DerivedUnitElement.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_NamedUnit.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_SiUnit.hxx>
#include <StepBasic_Unit.hxx>
#include <StepRepr_CharacterizedDefinition.hxx>
#include <StepRepr_MeasureRepresentationItem.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_PropertyDefinitionRepresentation.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentedDefinition.hxx>
#include <TopoDS_Shape.hxx>
#include <TransferBRep.hxx>
#include <cmath>

namespace octafront::cad {

namespace {

/// So many kilograms or metres.
struct UnitOfMass {
  enum Kind { kOther, kMass, kLength };
  double factor = 1;
  Kind kind = kOther;
};

UnitOfMass unit_of_si(const StepBasic_SiUnit& unit) {
  const double prefix = unit.HasPrefix() ? STEPConstruct_UnitContext::ConvertSiPrefix(unit.Prefix()) : 1;
  switch (unit.Name()) {
    case StepBasic_sunMetre:
      return {prefix, UnitOfMass::kLength};
    case StepBasic_sunGram:
      return {prefix / 1000, UnitOfMass::kMass};
    default:
      return {};
  }
}

UnitOfMass unit_of(const Handle(StepBasic_NamedUnit) & unit, int depth = 0) {
  constexpr int kDeepest = 8;  // a file may define an inch by itself
  if (const auto si = Handle(StepBasic_SiUnit)::DownCast(unit); !si.IsNull()) return unit_of_si(*si);
  const auto converted = Handle(StepBasic_ConversionBasedUnit)::DownCast(unit);
  if (converted.IsNull() || converted->ConversionFactor().IsNull() || depth > kDeepest) return {};
  UnitOfMass base = unit_of(converted->ConversionFactor()->UnitComponent().NamedUnit(), depth + 1);
  base.factor *= converted->ConversionFactor()->ValueComponent();
  return base;
}

/// How many kg/m3 a unit is; 0: it is none of densities. OpenCASCADE writes theirs as g3 cm2.
double kilograms_per_cubic_metre(const StepBasic_DerivedUnit& unit) {
  UnitOfMass mass, length;
  double of_mass = 0, of_length = 0;
  for (int k = 1; k <= unit.NbElements(); ++k) {
    const UnitOfMass one = unit_of(unit.ElementsValue(k)->Unit());
    if (one.kind == UnitOfMass::kOther) return 0;
    (one.kind == UnitOfMass::kMass ? mass : length) = one;
    (one.kind == UnitOfMass::kMass ? of_mass : of_length) += unit.ElementsValue(k)->Exponent();
  }
  const bool is_density = (of_mass == 1 && of_length == -3) || (of_mass == 3 && of_length == 2);
  return is_density ? mass.factor / (length.factor * length.factor * length.factor) : 0;
}

/// In kg/m3; 0: it is no density. Its unit tells, for its name is the writing program's own.
double density_of(const Handle(StepBasic_MeasureWithUnit) & measure) {
  if (measure.IsNull() || measure->UnitComponent().IsNull()) return 0;
  const Handle(StepBasic_DerivedUnit) derived = measure->UnitComponent().DerivedUnit();
  if (derived.IsNull() || derived->Elements().IsNull()) return 0;
  const double density = measure->ValueComponent() * kilograms_per_cubic_metre(*derived);
  return std::isfinite(density) && density > 0 ? density : 0;
}

double density_of(const StepRepr_Representation& of) {
  for (int k = 1; k <= of.NbItems(); ++k) {
    const auto item = Handle(StepRepr_MeasureRepresentationItem)::DownCast(of.ItemsValue(k));
    if (item.IsNull()) continue;
    if (const double density = density_of(item->Measure()); density > 0) return density;
  }
  return 0;
}

Handle(StepBasic_ProductDefinition) product_of(const StepRepr_RepresentedDefinition& property) {
  if (property.PropertyDefinition().IsNull()) return {};
  const StepRepr_CharacterizedDefinition of = property.PropertyDefinition()->Definition();
  if (!of.ProductDefinition().IsNull()) return of.ProductDefinition();
  return of.ProductDefinitionShape().IsNull() ? Handle(StepBasic_ProductDefinition)()
                                              : of.ProductDefinitionShape()->Definition().ProductDefinition();
}

}  // namespace

DensitiesOfShapes read_densities(const StepData_StepModel& model, const Handle(Transfer_TransientProcess) & process) {
  DensitiesOfShapes all;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const auto said = Handle(StepRepr_PropertyDefinitionRepresentation)::DownCast(model.Value(i));
    if (said.IsNull() || said->UsedRepresentation().IsNull()) continue;
    const double density = density_of(*said->UsedRepresentation());
    const Handle(StepBasic_ProductDefinition) product = product_of(said->Definition());
    if (!(density > 0) || product.IsNull()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, product);
    if (!shape.IsNull()) all.try_emplace(shape.TShape().get(), density);
  }
  return all;
}

}  // namespace octafront::cad
