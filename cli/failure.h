#pragma once

#include <string>

namespace octafront::cli {

/// Status codes of the command line, by cause.
enum Status {
  kDone = 0,
  kInternal = 1,
  kUsage = 2,
  kInputRefused = 3,
  kNoMesh = 4,
  kNotWritten = 5,
  kOutOfMemory = 6,
  kInterrupted = 130
};

/// How a run failed.
struct Failure {
  Status status;
  const char* kind;  ///< a word for programs that read the JSON file
  std::string message;
};

/// What is being handled in a catch clause.
Failure current_failure();

}  // namespace octafront::cli
