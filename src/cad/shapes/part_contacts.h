#pragma once

#include "cad/model/cad_model.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront::cad {

/// Where two solids touch, nearly touch or overlap.
struct Contact {
  std::array<std::uint32_t, 2> solids{};  ///< ascending
  /// That they share, of one patch; where they nearly touch those of both that face each other; none where they overlap
  /// and have no common faces.
  std::vector<std::uint32_t> faces;
  double area = 0;               ///< of these; where they nearly touch what lies face to face, about
  double gap = 0;                ///< > 0: between planes, or cylinders of one axis
  double volume = 0, depth = 0;  ///< of the space that they had in common
};

/// By solids: what touches, by the first faces; what nearly does; what overlaps. Two parts nearly touch where less than
/// a fifth of the thickness of the thinner one lies between them.
std::vector<Contact> contacts_of(const CadModel& model);

/// What the faces are: "plane", "cylinder of radius 3", "plane and free face"; `unit`: of lengths, in the model's.
std::string shape_in_words(const CadModel& model, const std::vector<std::uint32_t>& faces, double unit);

}  // namespace octafront::cad
