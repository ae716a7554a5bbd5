#pragma once

#include <octafront/error.h>
#include <octafront/report.h>

#include <string>
#include <utility>

namespace octafront {

/// The mesh that was made is valid, but not what Options::require asks for. CLI status 4.
class RequirementError : public MeshingError {
 public:
  RequirementError(const std::string& what, Report of_mesh) : MeshingError(what), report(std::move(of_mesh)) {}
  Report report;  ///< what was made; the findings of its last stage say what is missing
};

}  // namespace octafront
