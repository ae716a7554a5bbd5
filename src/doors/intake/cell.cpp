#include "doors/intake/cell.h"

#include <octafront/error.h>

#include "base/core/doubles.h"
#include "periodic/repeated_bodies.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

std::array<bool, 3> repeated_axes(const IntakeOptions& options) {
  return axes_named("repeat", options.repeat.value_or(""));
}

}  // namespace

bool asks_for_cell(const IntakeOptions& options) {
  return !options.box.empty();
}

Box3 box_of_option(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    while (at < end && *at == ' ') ++at;
    double value = 0;
    const auto [next, error] = io::double_from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) break;
    numbers.push_back(value);
    at = next;
    while (at < end && *at == ' ') ++at;
    if (at < end && *at == ',') ++at;
  }
  Box3 box;
  if (at == end && numbers.size() == 6)
    box = {{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
  if (!(box.lo.x < box.hi.x && box.lo.y < box.hi.y && box.lo.z < box.hi.z))
    throw OptionError(
        fmt::format("`box` is \"{}\": write X0,Y0,Z0,X1,Y1,Z1, the low corner and the high one, or first", text));
  return box;
}

Body box_body(const std::string& name, const Box3& box) {
  Body body{name, {}};
  for (int i = 0; i < 8; ++i)
    body.surface.points.push_back(
        {(i & 1 ? box.hi : box.lo).x, (i & 2 ? box.hi : box.lo).y, (i & 4 ? box.hi : box.lo).z});
  body.surface.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                            {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return body;
}

std::vector<Body> bodies_in_cell(std::vector<Body> bodies, const IntakeOptions& options,
                                 std::vector<std::string>& notes) {
  const std::array<bool, 3> along = repeated_axes(options);
  std::vector<Body> all;
  PeriodicCell cell;
  if (options.box == "first") {
    all.push_back(std::move(bodies.front()));
    bodies.erase(bodies.begin());
    cell = cell_of(bounding_box(all.front().surface.points), along);
  } else {
    cell = cell_of(box_of_option(options.box), along);
    all.push_back(box_body(kMatrixName, cell.box));
  }
  for (Body& body : bodies) {
    if (body.name == all.front().name) body.name += "_2";
    all.push_back(repeated_in_cell(std::move(body), cell, notes));
  }
  return all;
}

}  // namespace octafront::intake
