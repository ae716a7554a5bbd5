#pragma once

// What long stages make is kept in a folder, each in a file of its own, so that a run that was ended can go on. As the
// same input and options make the same mesh, what is read is what would be made, whoever wrote it: the number of ranks
// and threads may be another.

#include <octafront/generate.h>

#include "base/comm/packing.h"
#include "pipeline/stages/packed.h"
#include "pipeline/stages/run.h"

#include <cstdint>
#include <optional>
#include <string>

namespace octafront {

struct Prepared;

/// Begins a new folder for this input and these options, or finds that what is in it was made of them. Throws
/// InputError, OutputError.
void open_checkpoint(const Checkpoints& where, const Domain& domain, const Options& options, const RunContext& context);

/// The results of one run's stages, in the order in which they come up.
class Checkpoint {
 public:
  /// What is kept hangs on all of these.
  Checkpoint(const Checkpoints& where, const Prepared& input, const SizeField& sizes, Run& run);

  bool keeps() const { return !where_.folder.empty(); }

  /// make(), or what an earlier run has kept of it, with what that told in its report. Makes and results come up in the
  /// same order in each run.
  template <class Result, class Make>
  Result kept(const char* name, const Make& make);

 private:
  std::string file_of(const char* name, std::uint64_t number) const;
  std::optional<Bytes> read(const std::string& file) const;
  void write(const std::string& file, Bytes content) const;

  const Checkpoints& where_;
  Run& run_;
  std::uint64_t key_ = 0, number_ = 0;
};

template <class Result, class Make>
Result Checkpoint::kept(const char* name, const Make& make) {
  if (where_.folder.empty()) return make();
  const std::string file = file_of(name, ++number_);
  if (const std::optional<Bytes> content = read(file)) {
    Unpacker from(*content);
    for (auto stages = from.take<std::uint64_t>(); stages > 0; --stages)
      run_.report.stages.push_back(unpacked<StageReport>(from));
    run_.report.expected_tets = from.take<double>();
    return unpacked<Result>(from);
  }
  const std::size_t first = run_.report.stages.size();
  Result made = make();
  Packer to;
  to.add(static_cast<std::uint64_t>(run_.report.stages.size() - first));
  for (std::size_t s = first; s < run_.report.stages.size(); ++s) pack(run_.report.stages[s], to);
  to.add(run_.report.expected_tets);
  pack(made, to);
  write(file, std::move(to.bytes()));
  return made;
}

}  // namespace octafront
