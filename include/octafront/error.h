#pragma once

#include <stdexcept>
#include <string>

namespace octafront {

/// Base of what the library throws on purpose. what() is a sentence for users: what is wrong, where, what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Options that contradict each other or lie outside their range. CLI status 2.
class OptionError : public Error {
 public:
  using Error::Error;
};

/// The input cannot be read or meshed as it is. CLI status 3.
class InputError : public Error {
 public:
  using Error::Error;
};

/// The run ended without a valid mesh; on valid input that is a bug of ours. CLI status 4.
class MeshingError : public Error {
 public:
  using Error::Error;
};

/// The output could not be written. CLI status 5.
class OutputError : public Error {
 public:
  using Error::Error;
};

/// The user, or a stop token, asked the run to end. CLI status 130.
class Cancelled : public Error {
 public:
  Cancelled() : Error("interrupted") {}
};

}  // namespace octafront
