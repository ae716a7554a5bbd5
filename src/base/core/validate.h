#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace octafront {

/// Whether working structures check themselves: in the preset `dev` (CMake option OCTAFRONT_VALIDATE), nowhere else.
#ifdef OCTAFRONT_VALIDATION
inline constexpr bool kValidate = true;
#else
inline constexpr bool kValidate = false;
#endif

/// Throws std::logic_error with what is wrong with a working structure; does nothing where kValidate is false.
///
/// A working structure says what is wrong with it in one sentence:
///   std::optional<std::string> first_inconsistency() const;        of all of it, at the end of a pass
///   std::optional<std::string> first_inconsistency(touched) const; of what an operation touched, after each
/// The second costs no more than the operation, so that a pass does not become quadratic; small structures need only
/// the first. A function and not a macro: both builds compile it, only one calls it.
template <class Structure, class... Touched>
void validate(const Structure& structure, const Touched&... touched) {
  if constexpr (kValidate)
    if (const std::optional<std::string> wrong = structure.first_inconsistency(touched...))
      throw std::logic_error(*wrong);
}

}  // namespace octafront
