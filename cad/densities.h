#pragma once

#include "read.h"

#include <StepData_StepModel.hxx>
#include <Transfer_TransientProcess.hxx>

namespace octafront::cad {

/// What a STEP file says its products weigh, in kg/m3, by their shapes. By the units of its own entities: OpenCASCADE's
/// material has a number that counts in whatever the file had, and takes any measure for it.
DensitiesOfShapes read_densities(const StepData_StepModel& model, const Handle(Transfer_TransientProcess) & process);

}  // namespace octafront::cad
