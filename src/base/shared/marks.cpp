#include "base/shared/marks.h"

#include "base/shared/packing.h"
#include "base/shared/shares.h"

#include <cstddef>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// Numbers of those that are marked, or a bit for each, whichever is less.
void pack_marks(std::span<const std::uint8_t> marks, Packer& to) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) numbers.push_back(i);
  const bool are_few = numbers.size() * sizeof(numbers[0]) < marks.size() / 8;
  to.add(are_few);
  if (are_few) return to.add(numbers);
  std::vector<std::uint8_t> bits((marks.size() + 7) / 8, 0);
  for (const std::uint32_t i : numbers) bits[i / 8] |= static_cast<std::uint8_t>(1u << i % 8);
  to.add(bits);
}

/// Calls visit(number) for each.
template <class Visit>
void for_each_mark(Unpacker& from, std::size_t count, const Visit& visit) {
  if (from.take<bool>()) {
    std::vector<std::uint32_t> numbers;
    from.take(numbers);
    for (const std::uint32_t i : numbers) visit(i);
    return;
  }
  std::vector<std::uint8_t> bits;
  from.take(bits);
  for (std::size_t i = 0; i < count; ++i)
    if ((bits[i / 8] >> i % 8 & 1) != 0) visit(i);
}

/// Each rank puts together what all say of a range, fold(marks so far, number), and tells all ranks.
template <class Fold>
std::vector<std::uint8_t> folded(const Comm& comm, const std::vector<std::uint8_t>& marks, std::string_view what,
                                 const Fold& fold) {
  const auto ranks = static_cast<std::size_t>(comm.size());
  const auto begin = [&](std::size_t rank) { return begin_of_stretch(rank, ranks, marks.size()); };
  std::vector<Bytes> out(ranks);
  comm.attempt(what, Comm::Telling::kNamesRank, [&] {
    for (std::size_t r = 0; r < ranks; ++r) {
      Packer to;
      pack_marks(std::span(marks).subspan(begin(r), begin(r + 1) - begin(r)), to);
      out[r] = std::move(to.bytes());
    }
  });
  const auto here = static_cast<std::size_t>(comm.rank());
  std::vector<std::uint8_t> mine(begin(here + 1) - begin(here), 0);
  comm.exchange(std::move(out), what).for_each([&](int, std::span<const std::byte> bytes) {
    Unpacker from(bytes);
    for_each_mark(from, mine.size(), [&](std::size_t i) { fold(mine, i); });
  });
  Packer joined;
  pack_marks(mine, joined);
  std::vector<std::uint8_t> all(marks.size(), 0);
  comm.gather(joined.bytes(), what).for_each([&](int r, std::span<const std::byte> bytes) {
    const std::size_t first = begin(static_cast<std::size_t>(r));
    Unpacker from(bytes);
    for_each_mark(from, begin(static_cast<std::size_t>(r) + 1) - first, [&](std::size_t i) { all[first + i] = 1; });
  });
  return all;
}

}  // namespace

void join_marks(const Comm& comm, std::vector<std::uint8_t>& marks, std::string_view what) {
  if (comm.alone()) return;
  marks = folded(comm, marks, what, [](std::vector<std::uint8_t>& mine, std::size_t i) { mine[i] = 1; });
}

std::vector<std::uint8_t> marked_by_several(const Comm& comm, const std::vector<std::uint8_t>& marks,
                                            std::string_view what) {
  std::vector<std::uint8_t> none(marks.size(), 0);
  if (comm.alone()) return none;
  std::vector<std::uint8_t> is_known;
  return folded(comm, marks, what, [&](std::vector<std::uint8_t>& mine, std::size_t i) {
    is_known.resize(mine.size(), 0);
    mine[i] |= std::exchange(is_known[i], std::uint8_t{1});
  });
}

}  // namespace octafront
