#pragma once

// cad/reader: the program octafront-cad at work: started, asked, watched, ended.

#include <octafront/run_context.h>

#include "cad/model/stream.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace octafront::cad {

/// What the reader is told, and what it may use.
struct ReaderOptions {
  Overlap overlap = Overlap::kRefuse;
  double tolerance = 0;               ///< millimetres; solids that share a layer no thicker touch; 0: fits alone do
  bool heals = true;                  ///< what its check finds fault with
  bool keeps_going = false;           ///< without what cannot be read
  double seconds = 300;               ///< of CPU time, and of silence by the wall clock, > 0
  std::uint64_t memory = 8ull << 30;  ///< bytes, > 0
};

/// A file in the hands of octafront-cad. What goes wrong there, a crash or an endless loop too, is an InputError here,
/// which names the stage, the face and its place; Cancelled ends the program.
class CadReader {
 public:
  /// Called with notes as they come.
  using Tell = std::function<void(const std::string&)>;

  CadReader(const std::string& file, const ReaderOptions& options, Tell tell, const RunContext& context);
  ~CadReader();
  CadReader(const CadReader&) = delete;

  const Opened& opened() const { return opened_; }
  CadModel triangulate(const Fineness& fineness);

 private:
  class Process;
  std::unique_ptr<Process> process_;
  Opened opened_;
};

/// Where octafront-cad is: what OCTAFRONT_CAD names, or beside this program or library, or in PATH. Throws InputError
/// that says what to install where it is nowhere.
std::string reader_program();

}  // namespace octafront::cad
