#pragma once

#include "cad/model/stream.h"

#include <optional>
#include <string>
#include <vector>

namespace octafront::testing {

/// What octafront-cad sent, and how it ended.
struct Answer {
  std::optional<cad::Opened> opened;
  std::vector<cad::CadModel> models;
  std::vector<std::string> notes, errors, stages;
  std::string bytes;  ///< all that it sent
  int signal = 0;     ///< that ended it; 0: none
  int status = 0;
  bool complete = true;  ///< false: its last frame is cut off
  double seconds = 0;
};

/// Runs the program on a file with lines on its standard input. It is killed after `seconds` of wall time.
Answer run_reader(const std::string& file, const std::vector<std::string>& options, const std::string& lines,
                  double seconds = 100);

}  // namespace octafront::testing
