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
  kLimitReached = 7,
  kInterrupted = 130
};

/// How a run failed. Words for programs that read the JSON file stay what they are from version to version.
struct Failure {
  Status status;
  const char* kind;  ///< one for each status
  std::string message;
  std::string code = kind;  ///< what it was, where programs may want to know more
};

/// What is being handled in a catch clause.
Failure current_failure();

}  // namespace octafront::cli
