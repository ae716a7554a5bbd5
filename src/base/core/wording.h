#pragma once

#include <octafront/vec.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// "hole", "holes"; `many` where it is not `one` with an s.
std::string noun(std::uint64_t n, const std::string& one, const std::string& many = "");

/// "1 hole", "3 holes"; `many` where it is not `one` with an s.
std::string counted(std::uint64_t n, const std::string& one, const std::string& many = "");

/// " (face 17)", " (faces 3, 8 and 12)", " (first: faces 3, 8, 12, 14 and 20)"; empty for no faces.
std::string in_faces(std::span<const std::uint32_t> faces);

/// The names in a list with commas. Names themselves may hold commas: one of `known` that is called like the whole list
/// comes first. None of an empty list.
std::vector<std::string> names_listed(const std::string& list, std::span<const std::string> known);

/// What a region of so many is called: `name`, or "body_3" the third where it has none, "body" the only one.
std::string region_label(const std::string& name, std::size_t region, std::size_t regions);

/// "(0.31, 2, 0.5)"
std::string at_point(Vec3 p);

}  // namespace octafront
