#include "failure.h"

#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/limits.h>
#include <octafront/ranks.h>
#include <octafront/requirement_error.h>

#include <exception>
#include <new>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

Failure failure_of(const RankFailure& e) {
  using Kind = RankFailure::Kind;
  switch (e.kind) {
    case Kind::kOption:
      return {kUsage, "usage", e.what()};
    case Kind::kInput:
      return {kInputRefused, "input", e.what()};
    case Kind::kMeshing:
      return {kNoMesh, "meshing", e.what()};
    case Kind::kOutput:
      return {kNotWritten, "output", e.what()};
    case Kind::kCancelled:
      return {kInterrupted, "interrupted", e.what()};
    case Kind::kMemory:
      return {kOutOfMemory, "memory", std::string(e.what()) + "; ask for fewer elements (`elements`, `size`)"};
    default:
      return {kInternal, "internal", e.what(), "ranks"};
  }
}

Failure failure_of(const LimitError& e) {
  using Limit = LimitError::Limit;
  if (e.limit == Limit::kMemory) return {kOutOfMemory, "memory", e.what(), "memory_limit"};
  if (e.limit == Limit::kFolders) return {kLimitReached, "limit", e.what(), "outside_folders"};
  return {kLimitReached, "limit", e.what(), e.limit == Limit::kElements ? "max_elements" : "cpu_seconds"};
}

}  // namespace

Failure current_failure() {
  try {
    throw;
  } catch (const OptionError& e) {
    return {kUsage, "usage", e.what()};
  } catch (const LeakError& e) {
    return {kInputRefused, "input", e.what(), "leak"};
  } catch (const InputError& e) {
    return {kInputRefused, "input", e.what()};
  } catch (const LimitError& e) {
    return failure_of(e);
  } catch (const RequirementError& e) {
    return {kNoMesh, "requirement", e.what()};
  } catch (const MeshingError& e) {
    return {kNoMesh, "meshing", e.what()};
  } catch (const OutputError& e) {
    return {kNotWritten, "output", e.what()};
  } catch (const Cancelled&) {
    return {kInterrupted, "interrupted", "interrupted; no result was written"};
  } catch (const RankFailure& e) {
    return failure_of(e);
  } catch (const std::bad_alloc&) {
    return {
        kOutOfMemory, "memory",
        fmt::format("out of memory, of which {} may be taken (`memory`); ask for fewer elements (`elements`, `size`)",
                    bytes_in_words(static_cast<double>(memory_at_most())))};
  } catch (const std::exception& e) {
    return {kInternal, "internal", std::string("unexpected error, which is a bug of ours: ") + e.what()};
  }
}

}  // namespace octafront::cli
