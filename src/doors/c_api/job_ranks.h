#pragma once

#include <octafront/octafront_c.h>
#include <octafront/ranks.h>

#include <cstddef>
#include <functional>
#include <span>

namespace octafront::c_api {

/// The processes of a job, which talk to each other by their callers.
class JobRanks : public Ranks {
 public:
  /// `ask` returns once the caller has answered. `most_bytes`: of all that is said at a time; more goes in parts.
  JobRanks(int rank, int size, std::function<void(const octafront_event&)> ask,
           std::size_t most_bytes = std::size_t{1} << 30);

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) override;
  void exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                std::span<const std::size_t> in_sizes) override;

 private:
  void say(int kind, const std::byte* out, const std::size_t* out_sizes, std::byte* in, const std::size_t* in_sizes);
  void exchange_in_parts(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                         std::span<const std::size_t> in_sizes, std::size_t longest);

  int rank_, size_;
  std::function<void(const octafront_event&)> ask_;
  std::size_t most_bytes_;
};

}  // namespace octafront::c_api
