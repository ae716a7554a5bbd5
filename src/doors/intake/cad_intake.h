#pragma once

// How a CAD file is read, by the options of the way in.

#include <octafront/domain.h>

#include "cad/reader/cad_reader.h"

namespace octafront::intake {

/// Throws OptionError.
void check_cad_intake(const CadIntake& asked);

cad::ReaderOptions reader_options(const IntakeOptions& options);

/// How many millimetres the unit has that is asked for.
double millimetres_of(const CadIntake& asked);
/// The same in the unit that a model's lengths are in.
double unit_of(const cad::CadModel& model, const CadIntake& asked);

}  // namespace octafront::intake
